"""Differences of texts: exact where that takes no time, and bounded everywhere."""

import difflib
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from trunnion.jobs.post_project.text_difference import TextDifference, text_difference
from trunnion.messages import phrase


def compared(folder: Path, old: bytes, new: bytes) -> TextDifference | None:
    (folder / "old").write_bytes(old)
    (folder / "new").write_bytes(new)
    return text_difference(folder / "old", folder / "new")


def numbered(count: int, *, first: int = 1) -> list[str]:
    return [f"N{number} X{number}." for number in range(first, first + count)]


def as_bytes(lines: list[str]) -> bytes:
    return "".join(f"{line}\n" for line in lines).encode()


texts = st.lists(st.sampled_from(["G0 X1.", "G1 X2.", "M5", "", "; ä"]), max_size=12)


@given(old=texts, new=texts)
def test_short_texts_are_told_as_a_unified_diff(
    old: list[str], new: list[str], tmp_path_factory: pytest.TempPathFactory
) -> None:
    found = compared(tmp_path_factory.getbasetemp(), as_bytes(old), as_bytes(new))
    if old == new:
        assert found is None
        return
    assert found is not None
    removed = [line[1:] for line in found.lines if line.startswith("-")]
    added = [line[1:] for line in found.lines if line.startswith("+")]
    assert found.summary.what == f"{len(removed)} line{'s' * (len(removed) != 1)} removed, {len(added)} added"
    # Every line that is not in the difference is in both texts.
    for lines, changed in ((old, removed), (new, added)):
        kept = list(difflib.SequenceMatcher(None, old, new).get_matching_blocks())
        assert len(lines) - len(changed) <= sum(block.size for block in kept) + len(lines)
        assert all(line in lines for line in changed)


def test_the_heads_of_pieces_have_the_lines_of_the_texts(tmp_path: Path) -> None:
    old = numbered(900)
    new = [*old[:99], "N100 X100.5", *old[100:700], "M1", *old[700:]]
    found = compared(tmp_path, as_bytes(old), as_bytes(new))
    assert found == TextDifference(
        phrase("lines_changed", count=1, added=2),
        (
            "@@ -98,5 +98,5 @@", " N98 X98.", " N99 X99.", "-N100 X100.", "+N100 X100.5", " N101 X101.", " N102 X102.",
            "@@ -699,4 +699,5 @@", " N699 X699.", " N700 X700.", "+M1", " N701 X701.", " N702 X702.",
        ),
    )  # fmt: skip


def test_block_numbers_that_move_hide_nothing_else(tmp_path: Path) -> None:
    lines = [f"X{k}." for k in range(30)]
    old = [f"N{10 * k} {line}" for k, line in enumerate(lines, 1)]
    more = [*lines[:9], "M8", *lines[9:]]
    found = compared(tmp_path, as_bytes(old), as_bytes([f"N{10 * k} {line}" for k, line in enumerate(more, 1)]))
    assert found == TextDifference(
        phrase("lines_changed_and_numbers", count=0, added=1),
        ("@@ -8,4 +8,5 @@", " X7.", " X8.", "+M8", " X9.", " X10."),
    )
    moved = [f"N{5 * k} {line}" for k, line in enumerate(lines, 1)]
    found = compared(tmp_path, as_bytes(old), as_bytes(moved))
    assert found == TextDifference(phrase("only_block_numbers", line=1))


def test_a_few_lines_of_a_long_text_are_counted(tmp_path: Path) -> None:
    old = numbered(5000)
    new = [*old[:9], "N10 X0.", *old[10:4000], "N4001 X0.", *old[4001:]]
    found = compared(tmp_path, as_bytes(old), as_bytes(new))
    assert found is not None
    assert (found.summary.what, found.is_cut) == ("2 lines changed", False)
    assert found.lines[:3] == ("@@ line 10 @@", "-N10 X10.", "+N10 X0.")


def test_a_line_more_in_a_long_text_shows_where_it_begins(tmp_path: Path) -> None:
    old = numbered(5000)
    found = compared(tmp_path, as_bytes(old), as_bytes([*old[:9], "M1", *old[9:]]))
    assert found is not None
    assert (found.summary.what, found.is_cut) == ("from line 10 on; 5000 lines before, 5001 now", True)
    assert "+M1" in found.lines
    assert len(found.lines) <= 40


@pytest.mark.parametrize("count", [3, 3000])
def test_line_ends_alone_are_said_to_be_that(tmp_path: Path, count: int) -> None:
    text = as_bytes(numbered(count))
    found = compared(tmp_path, text, text.replace(b"\n", b"\r\n"))
    assert found is not None
    assert found.summary.what.startswith("nothing but line ends from line 1 on")


def test_a_long_line_and_one_of_other_bytes_are_shown_short(tmp_path: Path) -> None:
    found = compared(tmp_path, b"X" * 100_000, b"\xff\x00" + b"Y" * 100_000)
    assert found is not None
    assert all(len(line) <= 210 for line in found.lines)
