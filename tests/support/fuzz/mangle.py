"""Mangled files: changes to the bytes of a file, each drawn from a seeded random number generator.

A mangled file keeps most of its contents, so that faults hide behind valid blocks.
"""

import random
import re
from collections.abc import Callable, Sequence
from typing import Final

#: A mangled file is no longer than this, so that no test is slow because of its size.
LARGEST: Final = 60_000

#: Numbers at the ends of what formats, doubles and whole numbers hold.
NUMBERS: Final[tuple[bytes, ...]] = (
    b"0", b"-0", b"1", b"-1", b".", b"-", b"1.", b".5", b"999", b"1000", b"32768", b"65536", b"99999999", b"2147483648",
    b"9223372036854775808", b"18446744073709551616", b"1000000000000000000000000000000000000000000000000", b"0.1e5",
    b"1e300", b"-1e308", b"1e-320", b"1e999", b"1EX300", b"-1EX308", b"1EX-320", b"1EX999", b"NAN", b"INF", b"-INF",
    b"'HFFFFFFFFFFFFF'", b"'B2'", b"1_000", b"0x10", b"1d308", b"\xb2", b"1,5", b"1..5", b"--1", b"360000000",
)  # fmt: skip

#: What editors, other systems and people with bad intentions put into files.
TOKENS: Final[tuple[bytes, ...]] = (
    b"\0", b"\0" * 8, b"\r", b"\r\n", b"\n", b"\t", b"\x0b", b"\x0c", b"\x1a", b"\x7f", b"\xff", b"\xef\xbb\xbf",
    b"\xff\xfe", b"\xfe\xff", b"\xc3", b"\xe2\x80\xa8", b"\xc2\x85", b"\xed\xa0\x80", "轮毂".encode("gbk"),
    "ſK²٣".encode(), b"$", b"$$", b"/", b"/9 ", b",", b",,,,", b"(", b")", b"[", b"]", b"=", b'"', b"'", b";", b":",
    b"%", b"<<", b"N", b"R", b"../", b"$P_X", b"M30 ", b"M17 ", b"G91 ", b"G500 ", b"G700 ", b"TRAORI ", b"TRAFOOF ",
    b"MCALL ", b"RET\n", b"ENDFOR\n", b"ENDIF\n", b"ELSE\n", b"LOOP\n", b"ENDLOOP\n", b"UNTIL 0\n", b"GOTOS\n",
    b"GOTOB MARK\n", b"MARK:\n", b"L10 P1000000000\n", b"MAIN\n", b'EXTCALL("MAIN")\n', b"TURN=1EX9 ", b"CR=1EX200 ",
    b"CYCLE83(50,0,2,-2EX9,,-.001,,0)\n", b"SCALE X1EX-9\n", b"AROT Z1EX300\n", b"CYCLE800(1,,57,57,1,2,3,4,5,6)\n",
    b"A3=0 B3=0 C3=0 ", b"SUPA ", b"RAPID\n", b"END-OF-PATH\n", b"TOOL PATH/A,TOOL,B\n", b"CIRCLE/", b"GODLTA/",
    b"GOTO/", b"FROM/", b"MSYS/", b"CYCLE/ON\n", b"UNITS/INCHES\n", b"PPRINT/", b"PAINT/COLOR,", b",TIMES,1e12",
    b"SPINDL/SFM,1e300\n",
)  # fmt: skip

_NUMBER = re.compile(rb"-?\d+\.?\d*")

Change = Callable[[bytes, random.Random], bytes]


def mangle(data: bytes, others: Sequence[bytes], rng: random.Random) -> bytes:
    """Change a file once or a few times; ``others`` are files that pieces may come from."""

    def splice(data: bytes, rng: random.Random) -> bytes:
        at = rng.randint(0, len(data))
        return data[:at] + _piece(rng.choice(others), rng, 2000) + data[at:]

    for _ in range(rng.choice((1, 1, 2, 3, 5, 9))):
        change = rng.choice((*CHANGES, splice))
        data = change(data, rng)[:LARGEST]
    return data


def _piece(data: bytes, rng: random.Random, longest: int = 200) -> bytes:
    start = rng.randint(0, len(data))
    return data[start : start + rng.randint(1, longest)]


def _insert(data: bytes, new: bytes, rng: random.Random) -> bytes:
    at = rng.randint(0, len(data))
    return data[:at] + new + data[at:]


def flip_a_bit(data: bytes, rng: random.Random) -> bytes:
    """Flip one bit of one byte."""
    if not data:
        return data
    at = rng.randrange(len(data))
    return data[:at] + bytes([data[at] ^ 1 << rng.randrange(8)]) + data[at + 1 :]


def cut(data: bytes, rng: random.Random) -> bytes:
    """Take a piece out."""
    at = rng.randint(0, len(data))
    return data[:at] + data[at + rng.randint(1, 60) :]


def truncate(data: bytes, rng: random.Random) -> bytes:
    """Cut the file off somewhere."""
    return data[: rng.randint(0, len(data))]


def insert_token(data: bytes, rng: random.Random) -> bytes:
    """Put a nasty token anywhere."""
    return _insert(data, rng.choice(TOKENS), rng)


def begin_line(data: bytes, rng: random.Random) -> bytes:
    """Put a nasty token at the beginning of a line, where control words count."""
    starts = [0, *(match.end() for match in re.finditer(rb"\n", data))]
    at = rng.choice(starts)
    return data[:at] + rng.choice(TOKENS) + data[at:]


def change_number(data: bytes, rng: random.Random) -> bytes:
    """Replace a number with a nasty one."""
    found = list(_NUMBER.finditer(data))
    if not found:
        return _insert(data, rng.choice(NUMBERS), rng)
    match = rng.choice(found)
    return data[: match.start()] + rng.choice(NUMBERS) + data[match.end() :]


def nest(data: bytes, rng: random.Random) -> bytes:
    """Nest parentheses, brackets, signs or functions very deeply."""
    depth = rng.choice((5, 39, 41, 300, 3000))
    opening, closing = rng.choice(((b"(", b")"), (b"[", b"]"), (b"-", b""), (b"SIN(", b")"), (b"R[", b"]")))
    return _insert(data, b"X=" + opening * depth + b"1" + closing * depth + b"\n", rng)


def lengthen(data: bytes, rng: random.Random) -> bytes:
    """Repeat a piece many times in one line, for long lines, words and numbers."""
    piece = _piece(data, rng, 12).replace(b"\n", b"") or b"1"
    return _insert(data, piece * (rng.choice((50, 600, 5000, LARGEST)) // len(piece)), rng)


def repeat_lines(data: bytes, rng: random.Random) -> bytes:
    """Repeat a few lines many times."""
    lines = data.splitlines(keepends=True) or [b"\n"]
    at = rng.randrange(len(lines))
    some = lines[at : at + rng.randint(1, 3)]
    return b"".join([*lines[:at], *some * rng.choice((2, 70, 500)), *lines[at:]])


def shuffle_lines(data: bytes, rng: random.Random) -> bytes:
    """Change the order of a few lines."""
    lines = data.splitlines(keepends=True)
    for _ in range(min(len(lines) // 2, 3)):
        one, two = rng.randrange(len(lines)), rng.randrange(len(lines))
        lines[one], lines[two] = lines[two], lines[one]
    return b"".join(lines)


def change_line_ends(data: bytes, rng: random.Random) -> bytes:
    """End lines as other systems do, or not at all."""
    return data.replace(b"\n", rng.choice((b"\r", b"\r\n", b"\n\r", b"", b" ", b"\n\n")))


def change_encoding(data: bytes, rng: random.Random) -> bytes:
    """Write the file in another encoding."""
    text = data.decode("utf-8", "replace")
    return text.encode(rng.choice(("utf-16", "utf-16-le", "utf-32", "gbk", "latin-1", "utf-8-sig", "cp500")), "replace")


def noise(data: bytes, rng: random.Random) -> bytes:
    """Put random bytes in."""
    return _insert(data, rng.randbytes(rng.choice((1, 4, 64, 700))), rng)


CHANGES: Final[tuple[Change, ...]] = (
    flip_a_bit, flip_a_bit, cut, cut, truncate, insert_token, insert_token, begin_line, begin_line, begin_line,
    change_number, change_number, change_number, nest, lengthen, repeat_lines, shuffle_lines, change_line_ends,
    change_encoding, noise,
)  # fmt: skip
