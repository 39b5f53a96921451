"""Positions of the machine while an edge is in force: machine data say whether the length of the tool counts."""

from dataclasses import replace
from pathlib import Path

import pytest

import trunnion
from trunnion.machines import load_machine
from trunnion.model.run import Run

#: The length of the tool, mm, and how the definition says that the machine is set.
LENGTH = 80.0


def read(folder: Path, blocks: str, setting: str = "", length: float | None = LENGTH) -> Run:
    machine = folder / "ours.toml"
    reading = f'[control.reading]\nmachine_positions = "{setting}"\n' if setting else ""
    machine.write_text(f'extends = "yl569"\n{reading}', encoding="utf-8")
    program = folder / "part.mpf"
    program.write_text(f"G710 G90 G94 G17 G54\nT1\nM6\nD1\n{blocks}\nM30\n", encoding="utf-8")
    return trunnion.read_program(program, machine=replace(load_machine(str(machine)), tool_length=length))


def slide(run: Run, axis: str) -> float:
    return float(run.joints[-1, run.machine.column(axis)])


@pytest.mark.parametrize("word", ["SUPA", "G53", "G153"])
@pytest.mark.parametrize(
    ("block", "axis"), [("Z-10", "Z"), ("X5 Z-10", "Z"), ("G18 Y-10", "Y"), ("G19 X-10", "X"), ("D1 Z-10", "Z")]
)
def test_a_position_along_the_tool_with_an_edge_is_refused(tmp_path: Path, word: str, block: str, axis: str) -> None:
    for length in (None, LENGTH):
        (error,) = read(tmp_path, f"{word} G0 {block}", length=length).errors
        assert error.code == "NC224"
        assert error.text.startswith(f"{axis} in machine positions with D1: MD10760")
        assert error.text.endswith("write D0 in this block")


@pytest.mark.parametrize("block", ["Z-10 D0", "X5 Y5 D1", "B10 C20 D1", "G18 Z-10"])
def test_what_does_not_depend_on_the_setting_passes(tmp_path: Path, block: str) -> None:
    assert read(tmp_path, f"SUPA G0 {block}").errors == ()


@pytest.mark.parametrize(("setting", "added"), [("with_length", LENGTH), ("without_length", 0.0)])
def test_a_definition_says_how_the_machine_is_set(tmp_path: Path, setting: str, added: float) -> None:
    run = read(tmp_path, "SUPA G0 Z-10", setting)
    assert run.errors == ()
    assert slide(run, "Z") == pytest.approx(-10.0 + added)
    assert slide(read(tmp_path, "SUPA G0 Z-10 D0", setting), "Z") == pytest.approx(-10.0)
    assert slide(read(tmp_path, "G700 SUPA G0 Z-1", setting), "Z") == pytest.approx(-25.4 + added)
    assert slide(read(tmp_path, "SUPA G0 Z-10 D0\nD1\nSUPA G0 Z=IC(-5)", setting), "Z") == pytest.approx(-15.0)
    assert slide(read(tmp_path, "SUPA G0 X-10", setting), "X") == pytest.approx(-10.0)


def test_another_setting_is_a_mistake(tmp_path: Path) -> None:
    with pytest.raises(trunnion.InputError, match="write one of"):
        read(tmp_path, "SUPA G0 Z-10", "sometimes")
