"""Programs of shops that are sound as they are: nothing about them is an error."""

from pathlib import Path

import pytest

from tests.support.locations import TESTS
from trunnion.errors import Severity
from trunnion.machines import load_machine
from trunnion.readers import run_program

CASES = TESTS / "data" / "cases" / "pile"


def notes(program: Path, machine: str) -> list[tuple[Severity, str]]:
    """Severity and text of everything that a reader says about a program."""
    return [(note.severity, note.text) for note in run_program(program, load_machine(machine)).diagnostics]


def changed(name: str, folder: Path, old: str, new: str) -> Path:
    """A case with another text in one place."""
    program = folder / name
    text = (CASES / name).read_text(encoding="utf-8")
    assert old in text
    program.write_text(text.replace(old, new), encoding="utf-8")
    return program


def test_m127_as_a_safe_start_asks_for_none_at_the_end(tmp_path: Path) -> None:
    assert notes(CASES / "R1_m126_header.h", "ucp800") == []
    both = changed(
        "R1_m126_header.h", tmp_path, "11 L Z+200 R0 FMAX\n", "11 L Z+200 R0 FMAX M127\n12 L C+0 FMAX M126\n"
    )
    assert [severity for severity, _ in notes(both, "ucp800")] == [Severity.ERROR]


@pytest.mark.parametrize(
    ("first", "what"),
    [("(PART 12)", "the program begins without its number"), ("<PART-12>", ""), ("O0012", "")],
)
def test_a_fanuc_program_may_have_a_name_or_be_given_its_number(first: str, what: str, tmp_path: Path) -> None:
    program = changed("R2_fanuc_nonumber.nc", tmp_path, "(PART 12)", first)
    # It ends with its tool length on, of which every such program is warned.
    found = [each for each in notes(program, "matsuura_mx330") if not each[1].startswith("ends with G43 on")]
    assert [severity for severity, _ in found] == [Severity.WARNING] * bool(what)
    assert all(text.startswith(what) for _, text in found)


def test_a_name_within_a_fanuc_program_is_no_word(tmp_path: Path) -> None:
    program = changed("R2_fanuc_nonumber.nc", tmp_path, "Z5.\n", "<PART>\nZ5.\n")
    assert Severity.ERROR in [severity for severity, _ in notes(program, "matsuura_mx330")]


def test_m110_lowers_a_feed_and_leaves_the_path(tmp_path: Path) -> None:
    assert [severity for severity, _ in notes(CASES / "R6_m110.h", "dmu65")] == [Severity.WARNING]
    raised = changed("R6_m110.h", tmp_path, "M110", "M109")
    assert [severity for severity, _ in notes(raised, "dmu65")] == [Severity.ERROR]
