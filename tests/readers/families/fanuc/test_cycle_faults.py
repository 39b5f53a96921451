"""Drilling cycles that drill upwards, cut a thread of the wrong hand, or wait less than no time."""

from pathlib import Path

import pytest

from trunnion.machines import load_machine
from trunnion.readers import run_program

UPWARDS = "R of the cycle lies below its depth"


def _errors(machine: str, lines: str, folder: Path) -> list[str]:
    path = folder / "p.nc"
    path.write_text(f"%\nO0001\nG21 G17 G90 G94 G54\nG0 X0. Y0. Z30.\n{lines}\nG80\nM30\n%\n", encoding="utf-8")
    return [each.text for each in run_program(path, load_machine(machine)).errors]


@pytest.mark.parametrize("machine", ["matsuura_mx330", "haas_umc750"])
@pytest.mark.parametrize(
    ("block", "count"),
    [
        ("G98 G81 X1. Z10. R2. F100.", 1),
        ("G99 G83 X1. Z10. R2. Q1. F100.", 1),
        ("G91 G99 G81 X1. Z5. R-20. F100.", 1),
        ("G91 G99 G81 X1. Z-5. R-20. F100.", 0),
    ],
)
def test_a_cycle_does_not_drill_upwards(machine: str, block: str, count: int, tmp_path: Path) -> None:
    assert [UPWARDS in each for each in _errors(machine, block, tmp_path)] == [True] * count


@pytest.mark.parametrize(
    ("machine", "lines", "fault"),
    [
        ("matsuura_mx330", "S500 M4\nG99 G84 X1. Z-5. R2. F500.", "G84"),
        ("matsuura_mx330", "S500 M3\nG99 G74 X1. Z-5. R2. F500.", "G74"),
        ("matsuura_mx330", "S500 M3\nG99 G84 X1. Z-5. R2. F500.", ""),
        ("matsuura_mx330", "S500 M4\nM29 S500\nG99 G84 X1. Z-5. R2. F500.\nX5.", ""),
        ("haas_umc750", "S500 M3\nG99 G74 X1. Z-5. R2. F500.", ""),
        ("xyzac_trt", "S500 M4\nG99 G84 X1. Z-5. R2. F500.", "G84"),
        ("xyzac_trt", "S500 M3\nG99 G74 X1. Z-5. R2. F500.", "G74"),
    ],
)
def test_a_thread_has_the_hand_of_the_spindle(machine: str, lines: str, fault: str, tmp_path: Path) -> None:
    path = tmp_path / "p.nc"
    path.write_text(f"%\nG21 G17 G90 G94 G54\nG0 X0. Y0. Z30.\n{lines}\nG80\nM30\n%\n", encoding="utf-8")
    found = [each.text for each in run_program(path, load_machine(machine)).errors if each.wording.code == "NC370"]
    assert found == ([f"{fault} cuts a thread of the other hand than the spindle turns"] if fault else [])


@pytest.mark.parametrize("machine", ["matsuura_mx330", "haas_umc750"])
@pytest.mark.parametrize("cycle", ["G81", "G84", "G85"])
def test_a_cycle_has_no_inverse_time(machine: str, cycle: str, tmp_path: Path) -> None:
    block = f"S500 M3\n{{}}G98 {cycle} X1. Z-5. R2. F500."
    assert any("inverse time" in each for each in _errors(machine, block.format("G93\n"), tmp_path))
    assert _errors(machine, block.format(""), tmp_path) == []


@pytest.mark.parametrize("machine", ["matsuura_mx330", "haas_umc750"])
@pytest.mark.parametrize("word", ["X--1.", "X-+1.", "X+-1.", "X[--1.]"])
def test_a_value_has_one_sign(machine: str, word: str, tmp_path: Path) -> None:
    assert any("a number is missing" in each for each in _errors(machine, f"G0 {word}", tmp_path))
    assert _errors(machine, "G0 X-1.\nX-[1.]\nX[2.-1.]", tmp_path) == []


def test_a_dwell_below_zero_is_refused(tmp_path: Path) -> None:
    (found,) = _errors("matsuura_mx330", "G98 G82 X1. Z-5. R2. P-500 F100.", tmp_path)
    assert "a dwell below zero" in found
