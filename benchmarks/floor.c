/* The one-core C limit: what the same bytes cost when nothing else is done.
 *
 *     cc -O2 floor.c -o floor -lm && ./floor FILE.cls FILE.mpf
 *
 * Does:     reads a CL file whole; parses the numbers of GOTO by hand; B = acos(k), C = atan2(j, i) in degrees,
 *           0 to 360; rounds to five decimals; writes the motion blocks of the YL569 with TCP on, numbered by tens, words
 *           left out that print as they last did, and writes them at once. One thread, no printf.
 * Does not: any statement but GOTO, RAPID and FEDRAT; comments, `$` continuations, exponents, arcs, cycles; head and foot of
 *           a program; a machine definition, limits, other branches, other formats; checks of any kind, except that the
 *           files can be opened and written. It is a floor under a post, not a post.
 *
 * Rounding: a number of six decimals is often half-way between two of five. `value * 1e5` is then rounded once by the
 *           multiplication and again by llrint, which is not what printf("%.5f") does. So where the product has a fraction
 *           of exactly one half, and only there, the remainder of the product, exact by fma, decides. The digits are
 *           those of "%.5f", half to even on the exact binary value; minus zero is zero.
 */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SCALE 1e5
#define NONE INT64_MIN

static const double DEGREES = 180.0 / 3.14159265358979323846;

static const double POWER[] = {1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};

static char pair[200]; /* "00" "01" ... "99" */

/* What the words last printed, as counts of the last digit. */
static int64_t last_x = NONE, last_y = NONE, last_z = NONE, last_b = NONE, last_c = NONE, last_f = NONE;
static int last_g = -1;
static uint32_t block_number;

/* The number at *at, and *at behind it. Exact up to 15 digits: one integer divided by one power of ten. */
static inline double parse(const char **at)
{
    const char *p = *at;
    int negative = *p == '-';
    p += negative | (*p == '+');
    uint64_t digits = 0;
    unsigned d;
    while ((d = (unsigned)(*p - '0')) < 10) {
        digits = digits * 10 + d;
        p++;
    }
    double value;
    if (*p == '.') {
        const char *point = ++p;
        while ((d = (unsigned)(*p - '0')) < 10) {
            digits = digits * 10 + d;
            p++;
        }
        long decimals = p - point;
        if (decimals > 15 || digits >= (uint64_t)1 << 53)
            return strtod(*at, (char **)at);
        value = (double)(int64_t)digits / POWER[decimals];
    } else {
        value = (double)(int64_t)digits;
    }
    *at = p;
    return negative ? -value : value;
}

/* A value as a whole count of its fifth decimal. */
static inline int64_t count_of(double value)
{
    double product = value * SCALE;
    int64_t count = llrint(product);
    double over = product - (double)count; /* exact, -0.5 to 0.5 */
    if (over == 0.5 || over == -0.5) {
        double rest = fma(value, SCALE, -product);
        if (over > 0.0 && rest > 0.0)
            count++;
        else if (over < 0.0 && rest < 0.0)
            count--;
    }
    return count;
}

/* Digits of a whole number, without zeros before it. */
static inline char *put_whole(char *o, uint32_t n)
{
    char digits[10];
    char *d = digits + sizeof digits;
    while (n >= 100) {
        uint32_t rest = n % 100;
        n /= 100;
        d -= 2;
        memcpy(d, pair + 2 * rest, 2);
    }
    if (n >= 10) {
        d -= 2;
        memcpy(d, pair + 2 * n, 2);
    } else {
        *--d = (char)('0' + n);
    }
    size_t length = (size_t)(digits + sizeof digits - d);
    memcpy(o, d, length);
    return o + length;
}

/* A blank, the letter and the number, unless it prints as it last did. */
static inline char *put_word(char *o, char letter, int64_t count, int64_t *last)
{
    if (count == *last)
        return o;
    *last = count;
    *o++ = ' ';
    *o++ = letter;
    if (count == 0) {
        memcpy(o, "0.0", 3);
        return o + 3;
    }
    if (count < 0) {
        *o++ = '-';
        count = -count;
    }
    uint32_t whole = (uint32_t)((uint64_t)count / 100000);
    uint32_t decimals = (uint32_t)((uint64_t)count % 100000);
    if (whole)
        o = put_whole(o, whole);
    *o++ = '.';
    *o = (char)('0' + decimals / 10000);
    memcpy(o + 1, pair + 2 * (decimals / 100 % 100), 2);
    memcpy(o + 3, pair + 2 * (decimals % 100), 2);
    o += 5;
    while (o[-1] == '0')
        o--;
    return o;
}

static inline char *put_number(char *o)
{
    block_number += 10;
    *o++ = 'N';
    return put_whole(o, block_number);
}

static void fail(const char *name)
{
    perror(name);
    exit(2);
}

int main(int argc, char **argv)
{
    if (argc != 3) {
        fputs("usage: floor FILE.cls FILE.mpf\n", stderr);
        return 2;
    }
    FILE *source = fopen(argv[1], "rb");
    if (!source)
        fail(argv[1]);
    FILE *target = fopen(argv[2], "wb");
    if (!target)
        fail(argv[2]);
    fseek(source, 0, SEEK_END);
    size_t size = (size_t)ftell(source);
    rewind(source);
    /* room for a line end and a keyword past it; a block is at most twice as long as its line, and 100 bytes */
    char *in = malloc(size + 16), *out = malloc(2 * size + 4096);
    if (!in || !out || fread(in, 1, size, source) != size)
        fail(argv[1]);
    memset(in + size, '\n', 16);
    for (int n = 0; n < 100; n++) {
        pair[2 * n] = (char)('0' + n / 10);
        pair[2 * n + 1] = (char)('0' + n % 10);
    }

    int64_t b = 0, c = 0, f = 0;
    int rapid = 0, first = 1;
    char *o = out;
    const char *end = in + size;
    for (const char *p = in; p < end; p++) {
        if (memcmp(p, "GOTO/", 5) == 0) {
            p += 5;
            double x = parse(&p);
            p++;
            double y = parse(&p);
            p++;
            double z = parse(&p);
            if (*p == ',') { /* without a vector the last one stands */
                p++;
                double i = parse(&p);
                p++;
                double j = parse(&p);
                p++;
                double k = parse(&p);
                double angle = atan2(j, i) * DEGREES;
                b = count_of(acos(k) * DEGREES);
                c = count_of(angle < 0.0 ? angle + 360.0 : angle);
                if (c == 36000000)
                    c = 0;
            }
            if (first) { /* the rotary axes go to their place before TCP comes on */
                o = put_number(o);
                memcpy(o, " G0", 3);
                o = put_word(o + 3, 'B', b, &last_b);
                o = put_word(o, 'C', c, &last_c);
                *o++ = '\n';
                first = 0;
            }
            char *start = o;
            o = put_number(o);
            char *words = o;
            if (last_g != !rapid) {
                last_g = !rapid;
                memcpy(o, rapid ? " G0" : " G1", 3);
                o += 3;
            }
            o = put_word(o, 'X', count_of(x), &last_x);
            o = put_word(o, 'Y', count_of(y), &last_y);
            o = put_word(o, 'Z', count_of(z), &last_z);
            o = put_word(o, 'B', b, &last_b);
            o = put_word(o, 'C', c, &last_c);
            if (!rapid)
                o = put_word(o, 'F', f, &last_f);
            rapid = 0;
            if (o == words) { /* nothing changed: no block */
                o = start;
                block_number -= 10;
            } else {
                *o++ = '\n';
            }
        } else if (memcmp(p, "RAPID", 5) == 0) {
            rapid = 1;
        } else if (memcmp(p, "FEDRAT/", 7) == 0) {
            const char *number = p + 7;
            for (const char *q = number; *q != '\n'; q++)
                if (*q == ',')
                    number = q + 1;
            f = count_of(parse(&number));
        }
        while (*p != '\n')
            p++;
    }
    if (fwrite(out, 1, (size_t)(o - out), target) != (size_t)(o - out) || fclose(target) != 0)
        fail(argv[2]);
    fclose(source);
    return 0;
}
