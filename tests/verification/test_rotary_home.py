"""Rotary axes that the definition wants at home at the end, or at a tool change, are judged there."""

import re
from pathlib import Path

import pytest

import trunnion
from tests.support.posting import FOOT, HEAD
from trunnion.machines import load_machine
from trunnion.verification.results import Check

START = HEAD.partition("RAPID")[0]
MACHINES = ["yl569", "dmu65", "matsuura_mx330", "haas_umc750", "hs664rt", "xyzac_trt"]


def home_of(folder: Path, name: str, turn: str) -> Check:
    """The check of a program that stands upright, with one rotary axis turned before its end."""
    cl, machine = folder / "part.cls", folder / "own.toml"
    output = folder / ("part.h" if name == "dmu65" else "part.nc")
    cl.write_text(
        START + "RAPID\nGOTO/0,0,40,0,0,1\nFEDRAT/MMPM,800\nGOTO/0,0,0\nGOTO/5,0,0\nRAPID\nGOTO/5,0,40\n" + FOOT,
        encoding="utf-8",
    )
    axes = ", ".join(f'"{axis}"' for axis in load_machine(name).names)
    machine.write_text(f'extends = "{name}"\n[proof]\nhome_at_end = [{axes}]\n', encoding="utf-8")
    trunnion.post(cl, machine=machine, output=output)
    lines = output.read_text(encoding="utf-8").splitlines()
    if turn:
        end = max(k for k, line in enumerate(lines) if re.search(r"\bM0?5\b|\bM30\b|\bM0?2\b", line))
        lines.insert(end, f"{lines[end].partition(' ')[0]} {turn}" if name == "dmu65" else turn)
        if name == "dmu65":
            lines = [f"{k} {line.partition(' ')[2]}" for k, line in enumerate(lines)]
    output.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return next(check for check in trunnion.verify(output, machine=machine, cl=cl).checks if check.key == "home")


@pytest.mark.parametrize("name", MACHINES)
def test_rotary_axes_at_home_pass(name: str, tmp_path: Path) -> None:
    assert home_of(tmp_path, name, "").passed


@pytest.mark.parametrize("name", MACHINES)
def test_a_rotary_axis_that_is_left_turned_fails(name: str, tmp_path: Path) -> None:
    letter = load_machine(name).axes[load_machine(name).rotary[1]].name
    check = home_of(tmp_path, name, f"L {letter}+30 FMAX" if name == "dmu65" else f"G0 {letter}30.")
    assert not check.passed
    assert any(f"with {letter} not at home" in place.text for place in check.places)


@pytest.mark.parametrize("name", ["matsuura_mx330", "haas_umc750"])
def test_whole_turns_of_an_endless_axis_are_at_home(name: str, tmp_path: Path) -> None:
    model = load_machine(name)
    letter, endless = model.axes[model.rotary[1]].name, model.axes[model.rotary[1]].endless
    assert home_of(tmp_path, name, f"G0 {letter}360.").passed is endless
