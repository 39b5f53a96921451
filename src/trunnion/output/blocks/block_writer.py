"""Blocks out of columns: one compiled kernel for the dense ones, text lines between them.

The kernel compares what would be printed, word by word, with what was last printed, and writes what differs. It
knows words, digits and block numbers; it does not know any control.
"""

from collections.abc import Iterable, Mapping, Sequence
from typing import BinaryIO

import numpy as np

from trunnion.arrays import Bytes, Flags, Ints
from trunnion.controls.words import ABSENT, BlockNumbers, Word
from trunnion.errors import Problem, RefusedError
from trunnion.jit import ONE, njit, signed, unsigned

#: Rows that a caller best hands over at a time: the table of one chunk stays in the processor's cache.
CHUNK = 16384

_TWO = ONE + ONE
_U10, _U100, _U103, _ZERO = unsigned(10), unsigned(100), unsigned(103), unsigned(48)

_DIGITS = 20  # of an int64, with sign and point
_LETTERS = 12
_WIDEST_WORD = _DIGITS + _LETTERS + 2

#: Bytes that a block number takes at most, with its blank and the sign of skipped blocks.
BLOCK_NUMBER_BYTES = 12

# columns of the table that describes the words to the kernel
_MODAL, _DECIMALS, _SCALE, _POINT, _LEADING, _TRAILING, _PLUS, _LETTER_LENGTH, _ZERO_LENGTH, _CLOSING, _BARE = range(11)


@njit(cache=True, inline="always")
def _put_pair(pair: int, out: Bytes, at: int) -> None:
    """Write two digits at ``at``: (pair * 103) >> 10 is pair // 10 for pairs below 100."""
    tens = (pair * _U103) >> _U10
    out[at] = _ZERO + tens
    out[at + ONE] = _ZERO + pair - tens * _U10


@njit(cache=True, inline="always")
def _put_whole(number: int, out: Bytes, at: int) -> int:
    """Write the digits of a number from 0 up at ``at``, two at a time; returns where they end."""
    rest, power = unsigned(number), _U10
    end: int = at + ONE
    while rest >= power:
        end += ONE
        power *= _U10
    place = end
    while rest >= _U100:
        quotient = rest // _U100
        place -= _TWO
        _put_pair(rest - quotient * _U100, out, place)
        rest = quotient
    if rest >= _U10:
        _put_pair(rest, out, at)
    else:
        out[at] = _ZERO + rest
    return end


@njit(cache=True, inline="always")
def _put_fraction(fraction: int, decimals: int, out: Bytes, at: int) -> int:
    """Write exactly so many digits at ``at``, with zeros in front; returns where they end."""
    rest = unsigned(fraction)
    end: int = at + unsigned(decimals)
    place = end
    while place - at >= _TWO:
        quotient = rest // _U100
        place -= _TWO
        _put_pair(rest - quotient * _U100, out, place)
        rest = quotient
    if place > at:
        out[at] = _ZERO + rest
    return end


@njit(cache=True, inline="always")
def _put_number(
    count: int,
    decimals: int,
    scale: int,
    point: bool,
    leading: bool,
    trailing: bool,
    plus: bool,
    out: Bytes,
    at: int,
) -> int:
    """Write a count of last digits as ``NumberFormat.text_of_count`` does; returns where it ends."""
    rest = count
    if count < 0:
        out[at] = 45
        at += ONE
        rest = -count
    elif plus:
        out[at] = 43
        at += ONE
    # A product is quicker than a division by a number that the compiler does not know; it is one off at most.
    whole = int(rest * (1.0 / scale))
    fraction = rest - whole * scale
    if fraction < 0:
        whole -= 1
        fraction += scale
    elif fraction >= scale:
        whole += 1
        fraction -= scale
    trailing = trailing and decimals > 0
    if whole > 0 or leading or (fraction == 0 and not trailing):
        at = _put_whole(whole, out, at)
    if fraction > 0 or trailing:
        out[at] = 46
        at = _put_fraction(fraction, decimals, out, at + ONE)
        while not trailing and out[at - ONE] == 48:
            at -= ONE
    elif decimals > 0 and point:
        out[at] = 46
        at += ONE
    return at


@njit(cache=True, nogil=True)
def write_blocks(
    table: Ints,
    forced: Ints,
    line_before: Ints,
    line_of: Ints,
    text_bytes: Bytes,
    text_ends: Ints,
    bare_text: Flags,
    rule: Ints,
    spelling: Bytes,
    last: Ints,
    number: Ints,
    number_letter: Bytes,
    numbered: bool,
    skip: Bytes,
    out: Bytes,
) -> int:
    """Write the blocks of one table into ``out``; returns the bytes written.

    table        (w, n) int64   counts, ABSENT where a word is not wanted
    forced       (n,)   int64   bit k set: word k is written even if it prints as before
    line_before  (n + 1,) int64 how many lines stand before the row and all rows above it, from 0
    line_of      (l,)   int64   which text each of these lines is
    text_bytes, text_ends       the texts, end to end
    bare_text    (t,)   bool    the text stands without skip sign and number
    rule         (w, 11) int64  modal, decimals, 10**decimals, point, leading, trailing, plus, length of letter, of
                                zero, byte that closes the word or 0, bare
    spelling     (w, 24) uint8  letter in the first 12 bytes, spelling of zero in the last 12
    last         (w,)   int64   what was last printed; kept up to date
    number       (4,)   int64   next block number, step, first, highest; the first is kept up to date
    """
    words, rows = table.shape
    at = unsigned(0)
    for row in range(rows):
        for piece in range(line_before[row], line_before[row + 1] + 1):  # the lines, then the row itself
            # skip sign and block number are written first, and taken back when nothing follows them
            block_start = at
            headed = piece == line_before[row + 1] or not bare_text[line_of[piece]]
            for k in range(skip.shape[0] if headed else 0):
                out[at] = skip[k]
                at += ONE
            if numbered and headed:
                for k in range(number_letter.shape[0]):
                    out[at] = number_letter[k]
                    at += ONE
                at = _put_whole(number[0], out, at)
                out[at] = 32
                at += ONE
            has_number = False
            if piece < line_before[row + 1]:
                has_number = True
                line = line_of[piece]
                for k in range(0 if line == 0 else text_ends[line - 1], text_ends[line]):
                    out[at] = text_bytes[k]
                    at += ONE
                at += ONE  # stands for the blank that every word leaves behind it
            else:
                for word in range(words):
                    count = table[word, row]
                    if count == ABSENT:
                        continue
                    if count == last[word] and rule[word, _MODAL] == 1 and (forced[row] >> word) & 1 == 0:
                        continue
                    last[word] = count
                    for k in range(rule[word, _LETTER_LENGTH]):
                        out[at] = spelling[word, k]
                        at += ONE
                    if rule[word, _BARE] == 1:
                        out[at] = 32
                        at += ONE
                        continue
                    has_number = True
                    if count == 0 and rule[word, _ZERO_LENGTH] > 0:
                        for k in range(rule[word, _ZERO_LENGTH]):
                            out[at] = spelling[word, _LETTERS + k]
                            at += ONE
                    else:
                        at = _put_number(
                            count,
                            rule[word, _DECIMALS],
                            rule[word, _SCALE],
                            rule[word, _POINT] == 1,
                            rule[word, _LEADING] == 1,
                            rule[word, _TRAILING] == 1,
                            rule[word, _PLUS] == 1,
                            out,
                            at,
                        )
                    if rule[word, _CLOSING]:
                        out[at] = rule[word, _CLOSING]
                        at += ONE
                    out[at] = 32
                    at += ONE
            if not has_number:
                at = block_start
                continue
            out[at - ONE] = 10
            if numbered and headed:
                number[0] += number[1]
                if number[0] > number[3]:
                    number[0] = number[2]
    written: int = signed(at)
    return written


class BlockWriter:
    """Writes blocks to a binary sink and remembers what each word last printed.

    ``words`` stand in the order in which a block holds them. The writer is the only place that knows the modal state
    of the words; text lines do not touch it unless the caller says so with ``remember`` or ``forget``.

    size   bytes written since the file was turned to
    """

    def __init__(self, sink: BinaryIO, words: Sequence[Word], numbers: BlockNumbers) -> None:
        self._numbers = numbers
        self._next_numbers: dict[BinaryIO, Ints] = {}
        self.switch_file(sink)
        self._letter = np.frombuffer(numbers.letter.encode(), np.uint8)
        self._skip = np.zeros(0, np.uint8)
        self._words: dict[str, Word] = {}
        self._keys: list[str] = []
        self._last = np.zeros(0, np.int64)
        self.use_words(words)

    def switch_file(self, sink: BinaryIO) -> None:
        """Write into another file from here on, whose block numbers go on where they were left, or begin.

        What was last printed stays known, whatever the file says.
        """
        numbers = self._numbers
        first = [numbers.start, numbers.step, numbers.start, numbers.highest]
        self._sink = sink
        self._number = self._next_numbers.setdefault(sink, np.array(first, np.int64))
        self.size = 0

    @property
    def widest_row(self) -> int:
        """Bytes that the block of a row takes at most, without lines before it."""
        return BLOCK_NUMBER_BYTES + len(self._letter) + 2 + len(self._keys) * _WIDEST_WORD

    def modal_state(self) -> dict[str, int]:
        """Modal words that are known to be in force, with the counts that were last printed."""
        last = self._last.tolist()
        return {
            key: count
            for k, (key, count) in enumerate(zip(self._keys, last, strict=True))
            if count != ABSENT and self._rule[k, _MODAL]
        }

    def use_words(self, words: Sequence[Word]) -> None:
        """Take up another set of words. What was last printed stays known for the words that print as before."""
        printed = dict(zip(self._keys, self._last, strict=True))
        kept = {word.key: printed[word.key] for word in words if self._words.get(word.key) == word}
        self._words = {word.key: word for word in words}
        self._keys = [word.key for word in words]
        self._last = np.array([kept.get(key, ABSENT) for key in self._keys], np.int64)
        self._rule = np.array([_rule(word) for word in words], np.int64).reshape(len(words), _BARE + 1)
        self._spelling = np.zeros((len(words), 2 * _LETTERS), np.uint8)
        for row, word in zip(self._spelling, words, strict=True):
            row[: len(word.letter)] = np.frombuffer(word.letter.encode(), np.uint8)
            row[_LETTERS : _LETTERS + len(word.format.zero)] = np.frombuffer(word.format.zero.encode(), np.uint8)

    def word(self, key: str) -> Word:
        """The word of that key."""
        return self._words[key]

    def forget(self, *keys: str) -> None:
        """Have these words (all, if none is named) written again at their next occasion."""
        for k, key in enumerate(self._keys):
            if not keys or key in keys:
                self._last[k] = ABSENT

    def remember(self, key: str, count: int) -> None:
        """Take it that the word has just been printed with this count."""
        self._last[self._keys.index(key)] = count

    def last_count(self, key: str) -> int:
        """The count with which the word was last printed, ``ABSENT`` where that is not known."""
        return int(self._last[self._keys.index(key)])

    def print_word(self, key: str, count: int) -> str:
        """The word as a text that the caller puts into a line of his own; it counts as printed."""
        word = self._words[key]
        _check_range(word, np.array([count], np.int64))
        self.remember(key, count)
        return word.letter + word.format.text_of_count(count) + word.closing

    @property
    def skips_blocks(self) -> bool:
        """Whether blocks begin with the block-skip sign."""
        return len(self._skip) > 0

    def set_block_skip(self, on: bool) -> None:
        """Begin the blocks that follow with the block-skip sign, or no longer."""
        self._skip = np.frombuffer(b"/" if on else b"", np.uint8)

    def write_lines(self, lines: Iterable[str]) -> None:
        """Write lines of text, a block each."""
        texts = list(lines)
        if not texts:
            return
        no_words = np.zeros((0, len(texts)), np.int64)
        none = np.zeros(len(texts), np.int64)
        before = np.arange(len(texts) + 1)
        self._emit(no_words, none, before, before[:-1], texts, self._rule[:0], self._spelling[:0], self._last[:0])

    def write_table(
        self,
        columns: Mapping[str, Ints],
        forced: Mapping[str, bool | Ints] | None = None,
        text_before: Ints | None = None,
        texts: Sequence[str] = (),
        lines: Mapping[int, str] | None = None,
    ) -> None:
        """Write one block a row.

        Parameters
        ----------
        columns
            Word key -> (n,) int64 counts, ``ABSENT`` where the row lacks the word. Keys that are missing are absent.
        forced
            Word key -> (n,) 0 or 1, or one flag for all rows: write the word even where it prints as before.
        text_before : (n,) int64, optional
            Index into ``texts`` of a line that stands before the row, -1 for none.
        lines
            Row -> a line of its own that stands right before it, after the one of ``text_before``.

        A row of which nothing is left to print, or nothing but bare words, makes no block.
        """
        rows = len(next(iter(columns.values())))
        present = [k for k, key in enumerate(self._keys) if key in columns]
        table = np.empty((len(present), rows), np.int64)
        flags = np.zeros(rows, np.int64)
        for k, index in enumerate(present):
            key = self._keys[index]
            table[k] = columns[key]
            _check_range(self._words[key], table[k])
            if forced and key in forced:
                flags |= np.int64(1 << k) * np.asarray(forced[key], np.int64)
        before, line_of, texts = _lines_before(rows, text_before, texts, lines or {})
        last = self._last[present]
        self._emit(table, flags, before, line_of, texts, self._rule[present], self._spelling[present], last)
        self._last[present] = last

    def _emit(
        self,
        table: Ints,
        forced: Ints,
        before: Ints,
        line_of: Ints,
        texts: Sequence[str],
        rule: Ints,
        spelling: Bytes,
        last: Ints,
    ) -> None:
        encoded = [text.encode() for text in texts]
        text_bytes = np.frombuffer(b"".join(encoded) or b" ", np.uint8)
        ends = np.cumsum([len(text) for text in encoded], dtype=np.int64) if encoded else np.zeros(1, np.int64)
        heads = BLOCK_NUMBER_BYTES + len(self._letter) + 1
        width = heads + len(rule) * _WIDEST_WORD + 1
        text_room = sum(len(encoded[k]) + heads + 1 for k in line_of)
        out = np.empty(table.shape[1] * width + text_room, np.uint8)
        bare = tuple(self._numbers.unnumbered)
        written = write_blocks(
            table,
            forced,
            before,
            line_of,
            text_bytes,
            ends,
            np.array([text.startswith(bare) for text in texts] or [False], np.bool_),
            rule,
            spelling,
            last,
            self._number,
            self._letter,
            self._numbers.numbered,
            self._skip,
            out,
        )
        self._sink.write(out[:written].data)
        self.size += written


def _lines_before(
    rows: int, text_before: Ints | None, texts: Sequence[str], lines: Mapping[int, str]
) -> tuple[Ints, Ints, Sequence[str]]:
    """Where lines stand, as the kernel takes it, which they are, and all texts."""
    at = np.full(rows, -1, np.int64) if text_before is None else text_before
    first = np.flatnonzero(at >= 0)
    single = np.array(sorted(lines), np.int64)
    row = np.concatenate((first, single))
    text = np.concatenate((at[first], len(texts) + np.arange(len(single))))
    order = np.argsort(row, kind="stable")
    before = np.searchsorted(row[order], np.arange(rows + 1))
    return before, text[order], [*texts, *(lines[k] for k in single.tolist())]


def _check_range(word: Word, column: Ints) -> None:
    """Refuse a number that the word's format has no room for."""
    scale = 10**word.format.decimals
    most, fewest = int(column.max()), int(column.min())
    if fewest == ABSENT and most != ABSENT:
        fewest = int(column[column != ABSENT].min())
    for count, limit, beyond in (
        (most, word.format.greatest, most > word.format.greatest * scale),
        (fewest, word.format.least, fewest < word.format.least * scale),
    ):
        if beyond and count != ABSENT:
            what = f"word {word.letter}{count / scale:g} is beyond {limit:g}"
            raise RefusedError(Problem("program", 0, what, "see the limits of the word's format in the definition"))


def _rule(word: Word) -> list[int]:
    number = word.format
    return [
        int(word.modal and not word.bare),
        number.decimals,
        10**number.decimals,
        int(number.point),
        int(number.leading_zero),
        int(number.trailing_zeros),
        int(number.plus),
        len(word.letter.encode()),
        len(number.zero.encode()),
        ord(word.closing or "\0"),
        int(word.bare),
    ]
