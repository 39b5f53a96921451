"""The block writer: columns of words and lines of text in, the bytes of numbered blocks out."""

import re
from collections.abc import Iterable, Mapping, Sequence
from typing import BinaryIO, Final, NamedTuple

import numpy as np

from trunnion.arrays import Bytes, Flags, Ints
from trunnion.controls.words import ABSENT, BlockNumbers, IncrementWords, Word, WordRangeError
from trunnion.encoding import TextForm
from trunnion.messages import Wording
from trunnion.output.blocks.block_kernel import BARE, DIGITS, LETTERS, MODAL, NUMBER, WAIT, write_blocks
from trunnion.output.blocks.increments import AXES, PositionTable, with_increments, words_with_increments
from trunnion.output.blocks.line_heads import GivenNumbers, LineHeads

#: Rows of a table at most: one chunk stays in the processor's cache.
CHUNK: Final = 16384

#: Bytes of a block number at most, with its blank and the block-skip sign.
BLOCK_NUMBER_BYTES: Final = 12

_WORD_BYTES: Final = DIGITS + LETTERS + 2

_LF: Final = ord("\n")

_PLAIN_FORM: Final = TextForm()


class _WordColumns(NamedTuple):
    """The words of a table for the kernel; see ``write_blocks``."""

    rule: Ints
    spelling: Bytes
    last: Ints


class _Lines(NamedTuple):
    """The lines of text between the rows of a table for the kernel; see ``write_blocks``."""

    before: Ints
    of: Ints
    texts: Sequence[str]


class BlockWriter:
    """Writes blocks to a binary sink, and knows what each word printed last.

    A block has its words in the order in which they are given. Only the writer knows the modal state; a line of text
    does not change it unless the caller calls ``remember`` or ``forget``.

    size              bytes written to the present sink since ``switch_file``
    operation_starts  the sinks, lines and block numbers at which operations begin; -1 for no number
    """

    def __init__(
        self,
        sink: BinaryIO,
        words: Sequence[Word],
        numbers: BlockNumbers,
        form: TextForm = _PLAIN_FORM,
        increment_words: IncrementWords | None = None,
    ) -> None:
        """Write to ``sink``; with ``increment_words``, X, Y and Z are increments where ``write_table`` is told so."""
        self._numbers, self._form = numbers, form
        self._increments, self._counts_on = increment_words, False  # whether the control counts from the last position
        self._line_end = np.frombuffer(form.line_end, np.uint8)
        self._next_numbers: dict[BinaryIO, Ints] = {}
        self._given_numbers: dict[BinaryIO, GivenNumbers] = {}
        self._line_counts: dict[BinaryIO, int] = {}
        self.operation_starts: list[tuple[BinaryIO, int, int]] = []
        self._begins = False
        self.switch_file(sink)
        self._letter = np.frombuffer(numbers.letter.encode(), np.uint8)
        self._heads = LineHeads(numbers)
        self._skip = np.zeros(0, np.uint8)
        self._words: dict[str, Word] = {}
        self._keys: list[str] = []
        self._last = np.zeros(0, np.int64)
        self.use_words(words)

    # Files

    def switch_file(self, sink: BinaryIO) -> None:
        """Write to another sink from here on; its block numbers continue where they stopped, or start.

        The modal state stays known, whatever the file contains.
        """
        numbers = self._numbers
        first = [numbers.start, numbers.step, numbers.start, numbers.highest, *_first_wait(numbers)]
        self.end_increments()
        self._sink = sink
        self._number = self._next_numbers.setdefault(sink, np.array(first, np.int64))
        self._given = self._given_numbers.setdefault(sink, GivenNumbers(numbers))
        self.size = 0

    @property
    def widest_row(self) -> int:
        """Most bytes of the block of a row, without lines before it."""
        return BLOCK_NUMBER_BYTES + len(self._letter) + 2 + len(self._line_end) + len(self._keys) * _WORD_BYTES

    @property
    def skips_blocks(self) -> bool:
        """Whether blocks get the block-skip sign."""
        return len(self._skip) > 0

    def begin_operation(self) -> None:
        """Give the next block a number, where operations have the numbers.

        Where blocks switch increments on, one switches them off: a run may be entered here that stopped within them.
        """
        self.end_increments()
        self.operation_starts.append((*self.place, -1))
        self._begins = True
        if self._numbers.numbered and self._numbers.at_operations:
            self._number[WAIT] = 0
        self._counts_on = self._increments is not None and bool(self._increments.off)

    def set_block_skip(self, on: bool) -> None:
        """Start the next blocks with the block-skip sign, or no longer; none of these has increments."""
        self.end_increments()
        self._skip = np.frombuffer(b"/" if on else b"", np.uint8)

    @property
    def place(self) -> tuple[BinaryIO, int]:
        """The present sink, and the line that is written next, from 1."""
        return self._sink, self._line_counts.get(self._sink, 0) + 1

    # Words and their modal state

    def use_words(self, words: Sequence[Word]) -> None:
        """Change the set of words. The state of words that print as before stays known."""
        if self._increments is not None:
            words = words_with_increments(words, self._increments)
        printed = dict(zip(self._keys, self._last, strict=True))
        kept = {word.key: printed[word.key] for word in words if self._words.get(word.key) == word}
        self._words = {word.key: word for word in words}
        self._keys = [word.key for word in words]
        self._last = np.array([kept.get(key, ABSENT) for key in self._keys], np.int64)
        self._rule = np.array([_rule(word) for word in words], np.int64).reshape(len(words), BARE + 1)
        self._spelling = np.zeros((len(words), 2 * LETTERS), np.uint8)
        for row, word in zip(self._spelling, words, strict=True):
            row[: len(word.letter)] = np.frombuffer(word.letter.encode(), np.uint8)
            row[LETTERS : LETTERS + len(word.format.zero)] = np.frombuffer(word.format.zero.encode(), np.uint8)

    @property
    def words(self) -> tuple[Word, ...]:
        """The words of motion blocks."""
        return tuple(self._words.values())

    def word(self, key: str) -> Word:
        """Return the word with this key."""
        return self._words[key]

    def to_count(self, key: str, value: float) -> int:
        """Return a value as a count of the word with this key."""
        return self._words[key].format.count(value)

    def modal_state(self) -> dict[str, int]:
        """Return the modal words that are known to be active, with their counts."""
        last = self._last.tolist()
        return {
            key: count
            for k, (key, count) in enumerate(zip(self._keys, last, strict=True))
            if count != ABSENT and self._rule[k, MODAL]
        }

    def last_count(self, key: str) -> int:
        """Return the count that a word printed last, ``ABSENT`` if it is not known."""
        return int(self._last[self._keys.index(key)])

    def remember(self, key: str, count: int) -> None:
        """Take it that the word has just been printed with this count."""
        self._last[self._keys.index(key)] = count

    def forget(self, *keys: str) -> None:
        """Write these words (all, if none is named) at their next occasion, even if they are unchanged."""
        for k, key in enumerate(self._keys):
            if not keys or key in keys:
                self._last[k] = ABSENT

    # Output

    def print_word(self, key: str, count: int) -> str:
        """Return a word as text for a line of the caller; it counts as printed."""
        word = self._words[key]
        _check_range(word, np.array([count], np.int64))
        self.remember(key, count)
        return word.letter + word.format.text_of_count(count) + word.closing

    def write_lines(self, lines: Iterable[str]) -> None:
        """Write lines of text, a block each; a block number of their own is judged as ``write_table`` does."""
        texts = list(lines)
        if not texts:
            return
        self.end_increments()
        self._write_texts(texts)

    def end_increments(self) -> None:
        """Let positions be absolute again, if they are not."""
        if self._counts_on and self._increments is not None:
            self._counts_on = False
            self._write_texts([self._increments.off])

    def _write_texts(self, texts: Sequence[str]) -> None:
        before = np.arange(len(texts) + 1)
        no_words = _WordColumns(self._rule[:0], self._spelling[:0], self._last[:0])
        empty, unforced = np.zeros((0, len(texts)), np.int64), np.zeros(len(texts), np.int64)
        self._write(empty, unforced, no_words, _Lines(before, before[:-1], texts))

    def write_words(self, words: Mapping[str, int]) -> None:
        """Write one block of words, as counts; none if all of them are active."""
        self.write_table({word: np.array([count], np.int64) for word, count in words.items()})

    def write_table(
        self,
        columns: Mapping[str, Ints],
        forced: Mapping[str, bool | Ints] | None = None,
        text_before: Ints | None = None,
        texts: Sequence[str] = (),
        lines: Mapping[int, str] | None = None,
        relative: Flags | None = None,
    ) -> None:
        """Write one block a row. A row with nothing to print, or only bare words, makes no block.

        columns      word key -> (n,) int64 counts, ``ABSENT`` where the row lacks the word. Missing keys are absent
        forced       word key -> (n,) 0 or 1, or one flag for all rows: write the word even if it is modal and unchanged
        text_before  (n,) int64, optional: index into ``texts`` of a line before the row, -1 for none
        lines        row -> a line of its own right before it, after the one of ``text_before``
        relative     (n,) bool: rows in which X, Y and Z may be increments; none without it

        Raises ``WordRangeError`` if a number is beyond the limits of its word's format.

        Raises ``InputError`` if a line brings a block number that automatic numbering gives to another block.
        """
        rows = len(next(iter(columns.values())))
        (columns, forced, lines), ends = self._with_increments(PositionTable(columns, forced, lines), relative)
        present = [k for k, key in enumerate(self._keys) if key in columns]
        table = np.empty((len(present), rows), np.int64)
        flags = np.zeros(rows, np.int64)
        for k, index in enumerate(present):
            key = self._keys[index]
            table[k] = columns[key]
            _check_range(self._words[key], table[k])
            if forced and key in forced:
                flags |= np.int64(1 << k) * np.asarray(forced[key], np.int64)
        words = _WordColumns(self._rule[present], self._spelling[present], self._last[present])
        self._write(table, flags, words, _lines_before(rows, text_before, texts, lines or {}))
        self._last[present] = words.last
        for key, count in ends.items():
            self.remember(key, count)

    def _with_increments(self, table: PositionTable, relative: Flags | None) -> tuple[PositionTable, Mapping[str, int]]:
        """Return a table with its increments, and the positions behind it."""
        if self._increments is None or not any(key in table.columns for key in AXES):
            return table, {}
        last = {key: self.last_count(key) for key in AXES}
        may = None if self.skips_blocks else relative
        found, ends, self._counts_on = with_increments(table, last, may, self._increments, on=self._counts_on)
        return found, ends

    def _write(self, table: Ints, forced: Ints, words: _WordColumns, lines: _Lines) -> None:
        """Run the kernel and write its bytes; ``words.last`` is updated."""
        signs, rests = self._split_skips(lines.texts)
        own = [self._heads.own_number(text) for text in rests]
        bare = [number is not None or self._is_remark(text) for number, text in zip(own, lines.texts, strict=True)]
        skip = self._skip.tobytes().decode()
        # A line that brings its number gets neither sign nor number from the kernel.
        signs = [skip + sign if number is not None else sign for number, sign in zip(own, signs, strict=True)]
        texts = [sign + text for sign, text in zip(signs, rests, strict=True)]
        encoded = [text.encode(self._form.encoding).replace(b"\n", self._form.line_end) for text in texts]
        text_bytes = np.frombuffer(b"".join(encoded) or b" ", np.uint8)
        ends = np.cumsum([len(text) for text in encoded], dtype=np.int64) if encoded else np.zeros(1, np.int64)
        head = BLOCK_NUMBER_BYTES + len(self._letter) + len(self._line_end)
        row_bytes = head + len(words.rule) * _WORD_BYTES + 1
        text_room = sum(len(encoded[k]) + head + 1 for k in lines.of)
        out = np.empty(table.shape[1] * row_bytes + text_room, np.uint8)
        written = write_blocks(
            table,
            forced,
            lines.before,
            lines.of,
            text_bytes,
            ends,
            np.array(bare or [False], np.bool_),
            np.array([len(sign) for sign in signs] or [0], np.int64),
            words.rule,
            words.spelling,
            words.last,
            self._number,
            self._letter,
            self._line_end,
            self._skip,
            out,
        )
        self._sink.write(out[:written].data)
        self._given.add({n for n in own if n is not None}, int(self._number[NUMBER]), len(lines.of) + table.shape[1])
        self.size += written
        self._line_counts[self._sink] = self._line_counts.get(self._sink, 0) + int(
            np.count_nonzero(out[:written] == _LF)
        )
        if self._begins and written:
            self._note_number(out[:written].tobytes())

    def _is_remark(self, text: str) -> bool:
        """Whether a line is a remark where these have neither a number nor a skip sign."""
        return bool(self._numbers.unnumbered) and text.startswith(tuple(self._numbers.unnumbered))

    def _split_skips(self, texts: Sequence[str]) -> tuple[list[str], list[str]]:
        """Return the skip signs of lines, none where all blocks get one, and the lines without them."""
        pairs = [("", text) if self._is_remark(text) else self._heads.split_skip(text) for text in texts]
        return ["" if self.skips_blocks else sign for sign, _ in pairs], [rest for _, rest in pairs]

    def _note_number(self, data: bytes) -> None:
        """Find the number of an operation's first block; comments without numbers may stand above it."""
        letter, unnumbered = self._numbers.letter.encode(), tuple(sign.encode() for sign in self._numbers.unnumbered)
        block = next((line for line in data.splitlines() if not (unnumbered and line.startswith(unnumbered))), None)
        if block is None:
            return
        self._begins = False
        match = re.match(rb"(?:/(?:[0-9] )?)?" + re.escape(letter) + rb"(\d+) ", block)
        if match is not None and self._numbers.numbered:
            sink, line, _ = self.operation_starts[-1]
            self.operation_starts[-1] = sink, line, int(match[1])


def _first_wait(numbers: BlockNumbers) -> tuple[int, int]:
    """Blocks up to the first number, and from one to the next; -1 for none before ``begin_operation``."""
    if not numbers.numbered or numbers.at_operations:
        return -1, 0
    return 0, numbers.every


def _lines_before(rows: int, text_before: Ints | None, texts: Sequence[str], lines: Mapping[int, str]) -> _Lines:
    """Return the lines of a table; arguments as ``BlockWriter.write_table``."""
    at = np.full(rows, -1, np.int64) if text_before is None else text_before
    first = np.flatnonzero(at >= 0)
    single = np.array(sorted(lines), np.int64)
    row = np.concatenate((first, single))
    text = np.concatenate((at[first], len(texts) + np.arange(len(single))))
    order = np.argsort(row, kind="stable")
    before = np.searchsorted(row[order], np.arange(rows + 1))
    return _Lines(before, text[order], [*texts, *(lines[k] for k in single.tolist())])


def _check_range(word: Word, column: Ints) -> None:
    """Raise ``WordRangeError`` if a number is beyond the limits of the word's format."""
    scale, unit = 10**word.format.decimals, word.format.unit
    highest, lowest = int(column.max()), int(column.min())
    if lowest == ABSENT and highest != ABSENT:
        lowest = int(column[column != ABSENT].min())
    for count, limit, beyond in (
        (highest, word.format.greatest, highest > word.format.greatest / unit * scale),
        (lowest, word.format.least, lowest < word.format.least / unit * scale),
    ):
        if beyond and count != ABSENT:
            wording = Wording(
                "CTL110", "word_beyond_format", letter=word.letter, value=count / scale, limit=limit / unit
            )
            raise WordRangeError(wording, int(np.argmax(column == count)))


def _rule(word: Word) -> list[int]:
    """Return the columns of a word for the kernel: ``MODAL`` to ``BARE``."""
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
