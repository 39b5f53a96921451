"""The block kernel against its reference implementation, and what the writer remembers."""

import io

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from trunnion.controls.words import ABSENT, BlockNumbers, NumberFormat, Word, WordRangeError, round_to_counts
from trunnion.encoding import TextForm
from trunnion.errors import InputError
from trunnion.output.blocks.block_writer import BlockWriter

COORDINATE = NumberFormat(5, zero="0.0", least=-1e11, greatest=1e11)
WORDS = [
    Word("motion", "G", NumberFormat(0, least=-1e11, greatest=1e11)),
    Word("X", "X", COORDINATE),
    Word("I", "I=AC", COORDINATE, modal=False),
    Word("fast", "FMAX", NumberFormat(0), bare=True),
    Word("feed", "F", NumberFormat(2, plus=True, leading_zero=True, least=-1e11, greatest=1e11)),
]

cell = st.one_of(st.just(ABSENT), st.integers(-(10**10), 10**10), st.integers(-3, 3))
bare = st.sampled_from([ABSENT, 0, 1])
line = st.sampled_from(["", "CC X+1 Y-2"])
tables = st.lists(st.tuples(cell, cell, cell, bare, cell, st.integers(0, 31), st.integers(-1, 1), line), max_size=30)
TEXTS = ["; a line", ";叶片"]


Row = tuple[int, int, int, int, int, int, int, str]


def slow_blocks(rows: list[Row], numbers: BlockNumbers, form: TextForm) -> bytes:
    """What the writer must write, in the most obvious way."""
    last: dict[str, int] = {}
    number, blocks, lines = numbers.start, 0, []

    def block(text: str) -> None:
        nonlocal number, blocks
        is_due = blocks == 0 if numbers.at_operations else blocks % numbers.every == 0
        blocks += 1
        if not (numbers.numbered and is_due):
            lines.append(text)
            return
        lines.append(f"{numbers.letter}{number} " + text)
        number = numbers.start if number + numbers.step > numbers.highest else number + numbers.step

    for *values, forced, text, single in rows:
        if text >= 0:
            block(TEXTS[text])
        if single:
            block(single)
        words = []
        for k, (word, count) in enumerate(zip(WORDS, values, strict=True)):
            modal = word.modal and not word.bare
            if count == ABSENT or (modal and last.get(word.key) == count and not forced >> k & 1):
                continue
            last[word.key] = count
            words.append(word.letter if word.bare else word.letter + word.format.text_of_count(count))
        if set(words) - {"FMAX"}:
            block(" ".join(words))
    return "".join(line + form.line_end.decode() for line in lines).encode(form.encoding)


@settings(deadline=None)
@given(
    tables,
    st.sampled_from(
        [
            BlockNumbers(),
            BlockNumbers(numbered=False),
            BlockNumbers("N", 1, 1, 7),
            BlockNumbers("", 0, 1),
            BlockNumbers("N", 5, 5, 15, every=4),
            BlockNumbers("N", 1, 1, at_operations=True),
        ]
    ),
    st.sampled_from([TextForm(), TextForm("gbk", b"\r\n")]),
)
def test_the_kernel_writes_what_its_slow_twin_writes(rows: list[Row], numbers: BlockNumbers, form: TextForm) -> None:
    sink = io.BytesIO()
    writer = BlockWriter(sink, WORDS, numbers, form)
    writer.begin_operation()
    for part in (rows[:7], rows[7:]):  # memory goes on from table to table
        if part:
            table = np.array([row[:-1] for row in part], np.int64)
            writer.write_table(
                {word.key: table[:, k] for k, word in enumerate(WORDS)},
                {word.key: table[:, 5] >> k & 1 for k, word in enumerate(WORDS)},
                table[:, 6],
                TEXTS,
                {k: row[-1] for k, row in enumerate(part) if row[-1]},
            )
    assert sink.getvalue() == slow_blocks(rows, numbers, form)


def written(writer: BlockWriter, sink: io.BytesIO, x: float) -> str:
    """The text of one block with an X word."""
    sink.seek(0)
    sink.truncate()
    writer.write_table({"X": round_to_counts(np.array([x]), 5)})
    return sink.getvalue().decode()


def test_what_was_forgotten_is_written_again() -> None:
    sink = io.BytesIO()
    writer = BlockWriter(sink, WORDS, BlockNumbers(numbered=False))
    assert written(writer, sink, 1.0) == "X1.\n"
    assert written(writer, sink, 1.0) == ""
    writer.forget("X")
    assert written(writer, sink, 1.0) == "X1.\n"
    writer.forget()
    assert written(writer, sink, 1.0) == "X1.\n"


def test_what_is_remembered_is_not_written() -> None:
    sink = io.BytesIO()
    writer = BlockWriter(sink, WORDS, BlockNumbers(numbered=False))
    writer.remember("X", 100000)
    assert written(writer, sink, 1.0) == ""


def test_a_change_of_format_makes_the_word_new_again() -> None:
    sink = io.BytesIO()
    writer = BlockWriter(sink, WORDS, BlockNumbers(numbered=False))
    written(writer, sink, 1.0)
    writer.use_words([Word("X", "X", NumberFormat(3, zero="0.0"))])
    writer.write_table({"X": round_to_counts(np.array([1.0]), 3)})
    assert sink.getvalue().decode() == "X1.\nX1.\n"


def test_block_skip_goes_before_the_block_number() -> None:
    sink = io.BytesIO()
    writer = BlockWriter(sink, WORDS, BlockNumbers())
    writer.set_block_skip(True)
    writer.write_lines([";off"])
    writer.set_block_skip(False)
    writer.write_lines([";on"])
    assert sink.getvalue().decode() == "/N10 ;off\nN20 ;on\n"


def test_a_number_beyond_its_word_is_refused_and_names_the_limit() -> None:
    writer = BlockWriter(io.BytesIO(), [Word("S", "S", NumberFormat(0, greatest=99999))], BlockNumbers())
    with pytest.raises(WordRangeError, match="word S100000 is beyond 99999") as caught:
        writer.write_table({"S": np.array([5, 100000, 7])})
    assert caught.value.row == 1


@pytest.mark.parametrize(
    ("numbers", "expected"),
    [
        (BlockNumbers(), "N10 M8\nN9000 M9\n/N9001 M5\nN20 NUT\n"),
        (BlockNumbers(every=2), "N10 M8\nN9000 M9\n/N9001 M5\nNUT\n"),
        (BlockNumbers(numbered=False), "M8\nN9000 M9\n/N9001 M5\nNUT\n"),
        (BlockNumbers(letter=""), "10 M8\n20 N9000 M9\n/30 N9001 M5\n40 NUT\n"),
    ],
)
def test_a_block_that_brings_its_number_gets_no_second_one(numbers: BlockNumbers, expected: str) -> None:
    sink = io.BytesIO()
    writer = BlockWriter(sink, WORDS, numbers)
    writer.write_lines(["M8", "N9000 M9"])
    writer.set_block_skip(True)
    writer.write_lines(["N9001 M5"])
    writer.set_block_skip(False)
    writer.write_lines(["NUT"])
    assert sink.getvalue().decode() == expected


@pytest.mark.parametrize(
    ("numbers", "expected"),
    [
        (BlockNumbers(), "N10 M8\n/N20 G4 X1.\n/2 N30 G4 X2.\n/N9001 M5\nn9002 M9\nN40 M7\n/N50 M3\n"),
        (BlockNumbers(every=2), "N10 M8\n/G4 X1.\n/2 N20 G4 X2.\n/N9001 M5\nn9002 M9\nM7\n/N30 M3\n"),
        (BlockNumbers(numbered=False), "M8\n/G4 X1.\n/2 G4 X2.\n/N9001 M5\nn9002 M9\nM7\n/M3\n"),
        (BlockNumbers(letter=""), "10 M8\n/20 G4 X1.\n/30 2 G4 X2.\n/40 N9001 M5\n50 n9002 M9\n60 M7\n/70 M3\n"),
    ],
)
def test_the_skip_sign_of_a_line_goes_before_its_number(numbers: BlockNumbers, expected: str) -> None:
    sink = io.BytesIO()
    writer = BlockWriter(sink, WORDS, numbers)
    writer.write_lines(["M8", "/G4 X1.", "/2 G4 X2.", "/N9001 M5", "n9002 M9", "M7"])
    writer.set_block_skip(True)
    writer.write_lines(["/M3"])
    assert sink.getvalue().decode() == expected


def numbered_lines(numbers: BlockNumbers, before: int, own: str, behind: int) -> None:
    writer = BlockWriter(io.BytesIO(), WORDS, numbers)
    writer.write_lines(["M8"] * before)
    writer.write_lines([own])
    writer.write_lines(["M8"] * behind)


@pytest.mark.parametrize(
    ("numbers", "before", "own", "behind"),
    [
        (BlockNumbers(), 5, "N50 M9", 0), (BlockNumbers(), 0, "N50 M9", 5), (BlockNumbers(), 5, "/n0050 M9", 0),
        (BlockNumbers(every=3), 4, "N20 M9", 0), (BlockNumbers(start=1, step=1), 3, "N4 M9", 1),
        (BlockNumbers(highest=50), 0, "N50 M9", 100), (BlockNumbers(highest=50), 7, "N50 M9", 0),
    ],
)  # fmt: skip
def test_a_number_that_automatic_numbering_gives_too_is_refused(
    numbers: BlockNumbers, before: int, own: str, behind: int
) -> None:
    with pytest.raises(InputError, match="automatic numbering") as caught:
        numbered_lines(numbers, before, own, behind)
    assert [each.code for each in caught.value.problems] == ["CTL115"]


@pytest.mark.parametrize(
    ("numbers", "before", "own", "behind"),
    [
        (BlockNumbers(), 4, "N50 M9", 0), (BlockNumbers(), 0, "N50 M9", 4), (BlockNumbers(), 9, "N55 M9", 9),
        (BlockNumbers(), 9, "N9 M9", 9), (BlockNumbers(numbered=False), 5, "N50 M9", 5),
        (BlockNumbers(highest=50), 9, "N60 M9", 99), (BlockNumbers(at_operations=True), 9, "N10 M9", 9),
        (BlockNumbers(every=3), 3, "N20 M9", 0),
    ],
)  # fmt: skip
def test_a_number_that_no_other_block_gets_is_written(
    numbers: BlockNumbers, before: int, own: str, behind: int
) -> None:
    numbered_lines(numbers, before, own, behind)
