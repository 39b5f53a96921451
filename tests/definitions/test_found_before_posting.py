"""Mistakes that no key shows by itself, and that a program would only show when it is posted."""

from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from trunnion.controls import load_control
from trunnion.controls.definition_files import load_control_table
from trunnion.controls.loading import shipped_controls
from trunnion.definitions import load_draft
from trunnion.families import load_writer
from trunnion.jobs.describe.definition_checks import machine_problems
from trunnion.machines import load_machine
from trunnion.machines.loading import machine_library


def told(text: str, base: str = "yl569") -> list[str]:
    """What a machine is told that says something else than a shipped one."""
    table = load_draft(f'extends = "{base}"\nname = "Ours"\n{text}', Path("ours.toml"), machine_library())
    return [f"{problem.key}: {problem.cure}" for problem in machine_problems(table, "ours")]


def axis(name: str, *lines: str) -> str:
    return f'[[axis]]\nname = "{name}"\n' + "\n".join(lines) + "\n"


@pytest.mark.parametrize("name", ["X", "Y", "Z"])
@pytest.mark.parametrize("base", ["yl569", "generic_head_head_ca", "xyzac_trt"])
def test_a_slide_that_counts_against_programs_is_told(name: str, base: str) -> None:
    number = [each.name for each in load_machine(base).axes].index(name)
    (problem,) = told(axis(name, 'positive = "reversed"'), base)
    assert problem.startswith(f'axis[{number}].positive: write "standard"')


def test_a_slide_along_another_letter_is_told() -> None:
    swapped = axis("X", "direction = [0, 1, 0]") + axis("Y", "direction = [-1, 0, 0]")
    assert [problem.partition(":")[0] for problem in told(swapped)] == ["axis[2].direction", "axis[3].direction"]
    assert told(axis("Y", "direction = [0, 1, 0.7]")) == []  # a slanting slide still goes to +Y
    assert told(axis("X", "direction = [-1, 0, 0]", 'positive = "reversed"')) == []


@pytest.mark.parametrize(
    ("output", "home", "cure"),
    [
        ("0..360", 400, "write 40"), ("0..360", -1, "write 359"), ("0..360", 0, None), ("0..360", 360, None),
        ("-180..180", 190, "write -170"), ("-180..180", -180, None), ("-180..180", 180, None), ("none", 400, None),
    ],
)  # fmt: skip
def test_a_home_that_an_endless_axis_never_shows_is_told(output: str, home: int, cure: str | None) -> None:
    found = told(axis("C", f'output = "{output}"', f"home_deg = {home}"))
    assert found == ([] if cure is None else [f"axis[0].home_deg: {cure}"])


def zero_told(text: str) -> list[str]:
    return told(f'[[control.format]]\nname = "coordinate"\nzero = "{text}"\n')


@settings(max_examples=examples(25))
@given(st.text("0123456789+-. eX", max_size=9))
def test_zero_is_written_as_what_a_control_reads_as_0(text: str) -> None:
    try:
        is_zero = float(text) == 0.0 and "e" not in text and " " not in text and len(text) <= 8
    except ValueError:
        is_zero = text == ""  # as other numbers
    if is_zero and (text.lstrip("+-").startswith("000") or len(text.partition(".")[2]) > 4):
        return  # more zeros than anybody writes
    assert (zero_told(text) == []) == is_zero


@pytest.mark.parametrize("zero", ["1", "O", "0,0", "0.0.", "+-0"])
def test_another_text_for_zero_is_told(zero: str) -> None:
    assert zero_told(zero)[0].startswith("control.format[0].zero: write 0 as the control has it")


@pytest.mark.parametrize("letter", ["L", "X", "G", "O", "n", "NN"])
@pytest.mark.parametrize("base", ["yl569", "dmu65", "matsuura_mx330", "hs664rt", "xyzac_trt"])
def test_a_letter_that_begins_no_block_number_is_told(base: str, letter: str) -> None:
    problems = told(f'[control.block_numbers]\nletter = "{letter}"\n', base)
    assert problems[0].startswith("control.block_numbers.letter: ")


def test_numbers_want_a_letter_where_the_language_has_one() -> None:
    without = '[control.block_numbers]\nletter = ""\nnumbered = true\n'
    assert told(without) == ["control.block_numbers.numbered: write letter"]
    assert told(without, "dmu65") == []
    assert told(without.replace("true", "false")) == []


@pytest.mark.parametrize(
    ("base", "text", "found"),
    [
        ("dmu65", "start = 100\nstep = 10\nhighest = 500", ["start: write 0", "step: write 1"]),
        ("dmu65", "start = 100\nnumbered = false", []),
        ("matsuura_mx330", "start = 900000\nhighest = 99999999", ["highest: write 99999 or less"]),
        ("haas_umc750", "highest = 100000", ["highest: write 99999 or less"]),
        ("linuxcnc_5axis", "highest = 100000", ["highest: write 99999 or less"]),
        ("linuxcnc_5axis", "highest = 99999", []),
        ("matsuura_mx330", 'unnumbered = "("', ['unnumbered: write "%O" with what else has none']),
        ("matsuura_mx330", 'unnumbered = "%O"', []),
    ],
)
def test_block_numbers_are_those_that_the_control_takes(base: str, text: str, found: list[str]) -> None:
    problems = told(f"[control.block_numbers]\n{text}\n", base)
    assert problems == [f"control.block_numbers.{each}" for each in found]


@pytest.mark.parametrize("key", shipped_controls())
def test_shipped_controls_number_blocks_by_letters_of_their_family(key: str) -> None:
    control = load_control(load_control_table(key))
    assert control.block_numbers.letter in load_writer(control.family_name).BLOCK_NUMBER_LETTERS
