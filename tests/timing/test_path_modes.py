"""What programs say about their corners, from their words to the times."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from trunnion.machines import load_machine
from trunnion.model.run import Run
from trunnion.readers import run_program
from trunnion.timing import CORNER_TOLERANCE, time_run
from trunnion.timing.path_modes import corner_tolerances, exact_stop_rows

#: Machine, head and end of a program, and its blocks: four corners of a square.
FAMILIES = {
    "sinumerik": ("generic_head_table_bc", "G710 G90 G54\nG1 X0 Y0 Z10 F6000\n{0}X10\n{1}Y10\n{2}X0\nY0\nM30\n"),
    "linuxcnc": ("xyzbc_trt", "G21 G90 G54\nG1 X0 Y0 Z10 F6000\n{0}X10\n{1}Y10\n{2}X0\nY0\nM2\n"),
    "fanuc": ("matsuura_mx330", "%\nO1\nG21 G90 G54\nG1 X0. Y0. Z10. F6000.\n{0}X10.\n{1}Y10.\n{2}X0.\nY0.\nM30\n%\n"),
}


def run_of(folder: Path, family: str, *words: str) -> Run:
    """The program with words before its second, third and fourth motion."""
    name, text = FAMILIES[family]
    machine = load_machine(name)
    axes = tuple(replace(axis, rapid=30000.0, acceleration=2000.0) for axis in machine.axes)
    path = folder / "a.nc"
    path.write_text(text.format(*(f"{word} " if word else "" for word in (*words, "", "", "")[:3])), encoding="utf-8")
    run = run_program(path, replace(machine, axes=axes))
    assert not run.errors
    return run


@pytest.mark.parametrize(
    ("family", "words", "stops"),
    [
        ("sinumerik", ("G9",), [1]),
        ("sinumerik", ("G60", "", "G64"), [1, 2]),
        ("sinumerik", ("G60", "G642"), [1]),
        # CYCLE832 with a machining type is continuous path; off goes back to what the program had before.
        ("sinumerik", ("G60\nCYCLE832(0.05,_ORI_FINISH,1)\n",), []),
        ("sinumerik", ("G60\nCYCLE832(0.05,112101)\n", "", "CYCLE832()\n"), [3, 4]),
        ("sinumerik", ("G60\nCYCLE832(0.05,3,1)\n", "CYCLE832(0,_OFF,1)\n", "G64"), [2]),
        ("sinumerik", ("G60\nCYCLE832(0.05,0,1)\n", "G64"), [1]),
        ("sinumerik", ("G60\nCYCLE832(0.05,1,1)\n", "G9", ""), [2]),
        ("sinumerik", ("CYCLE832(0.05,1,1)\n", "G60", "CYCLE832()\n"), [2, 3, 4]),
        ("sinumerik", ("CYCLE832(0.05,1,1)\n", "CYCLE832()\n"), []),
        ("sinumerik", ("G60\nCYCLE832(0.05,1,1)\n", "CYCLE832(0.01,2,1)\n", "CYCLE832()\n"), [3, 4]),
        ("fanuc", ("G9",), [1]),
        ("fanuc", ("G61", "G64"), [1]),
        ("linuxcnc", ("G61.1", "", "G64 P0.1"), [1, 2]),
        ("linuxcnc", ("G61",), []),
        ("sinumerik", (), []),
    ],
)
def test_exact_stops_are_where_the_program_has_them(
    tmp_path: Path, family: str, words: tuple[str, ...], stops: list[int]
) -> None:
    run = run_of(tmp_path, family, *words)
    assert np.flatnonzero(exact_stop_rows(run)).tolist() == stops
    timed = time_run(run)
    resting = np.abs(timed.at(timed.ends[:-1]).velocity).max(axis=1) < 1e-9
    if family == "linuxcnc" and words == ("G61",):
        assert resting[1:].all()  # square corners, which a path without any rounding stops at
    else:
        assert np.flatnonzero(resting).tolist() == [row for row in stops if row < len(run) - 1]


@pytest.mark.parametrize(
    ("family", "words", "tolerances"),
    [
        ("sinumerik", ("G60\nCYCLE832(0.05,1)\n",), [CORNER_TOLERANCE, 0.05, 0.05, 0.05, 0.05]),
        ("sinumerik", ("CYCLE832(0.05,1)\n",), [CORNER_TOLERANCE, 0.05, 0.05, 0.05, 0.05]),
        ("sinumerik", ("CTOL=0.1", "", "CYCLE832(0,_OFF,1)\n"), [CORNER_TOLERANCE, 0.1, 0.1, *[CORNER_TOLERANCE] * 2]),
        ("linuxcnc", ("G64 P0.2", "G61", "G64"), [CORNER_TOLERANCE, 0.2, 0.0, np.inf, np.inf]),
        ("fanuc", ("G5.1 Q1 R1\n",), [CORNER_TOLERANCE] * 5),
    ],
)
def test_the_tolerance_is_that_of_the_program(
    tmp_path: Path, family: str, words: tuple[str, ...], tolerances: list[float]
) -> None:
    run = run_of(tmp_path, family, *words)
    assert corner_tolerances(run).column().tolist() == tolerances


def test_a_wider_tolerance_is_faster_through_corners(tmp_path: Path) -> None:
    seconds = [
        time_run(run_of(tmp_path, "linuxcnc", word)).duration for word in ("G61", "G64 P0.01", "G64 P0.5", "G64")
    ]
    assert seconds == sorted(seconds, reverse=True)
    assert len(set(seconds)) == 4
