"""The length in force where the tool leaves the part, and stops and dwells beside the points of the CL file."""

import re
from pathlib import Path

import pytest

from tests.support.verifying import CL_FOOT, CL_HEAD, check
from trunnion import post, verify

_CL = CL_HEAD + "GOTO/0.0,0.0,5.0\nSTOP\nGOTO/20.0,0.0,5.0\n" + CL_FOOT

#: The line with which the program leaves the part, and the last one that starts the spindle before the first cut.
_LEAVES = {
    "yl569": r"SUPA G0 Z=_Z_HOME D0",
    "dmu65": r"L Z\+560 R0 FMAX M91",
    "matsuura_mx330": r"G49 G53 G0 Z0\.",
    "haas_umc750": r"G49 G53 G0 Z0\.",
    "hs664rt": "M242",
    "xyzac_trt": "G49\nN\\d+ G53 G0 Z0\\.",
}
_STARTS = {"dmu65": r"M3\n", "hs664rt": r"S1000 M3\n", "matsuura_mx330": r"S1000 M3\n", "haas_umc750": r"S1000 M3\n"}

#: Machine, what stands before the line with which it leaves, and the check that fails.
_FAULTS = [
    ("matsuura_mx330", "G49\nG0 Z0.", "modal"),
    ("matsuura_mx330", "G49\nG28 Z0.", "modal"),
    ("matsuura_mx330", "G43 H0 G0 Z50.", "modal"),
    ("matsuura_mx330", "G43 H2 G0 Z50.", "tool"),
    ("haas_umc750", "G49\nG0 Z0.", "modal"),
    ("haas_umc750", "G0 H2 Z50.", "tool"),
    ("xyzac_trt", "G49\nG0 Z0.", "modal"),
    ("xyzac_trt", "G43 H2\nG0 Z50.", "tool"),
    ("yl569", "G0 Z0 D0", "modal"),
    ("yl569", "D0\nG0 Z50", "modal"),
    ("yl569", "G0 Z50 D2", "tool"),
    ("yl569", "G4 F3", "stops"),
    ("matsuura_mx330", "G4 P3000", "stops"),
    ("haas_umc750", "G4 P3.", "stops"),
    ("xyzac_trt", "G4 P3.", "stops"),
    ("dmu65", "CYCL DEF 9.0 DWELL TIME\nCYCL DEF 9.1 DWELL 3", "stops"),
]


def _program(machine: str, folder: Path) -> tuple[Path, str]:
    cl = folder / "part.cls"
    cl.write_text(_CL, encoding="utf-8")
    found = post(cl, machine=machine)
    assert found.text is not None
    return cl, found.text


def _verified(cl: Path, text: str, machine: str, key: str) -> str:
    """Return the state of a check of a program."""
    program = cl.with_name("part.nc")
    program.write_text(text, encoding="utf-8")
    return check(verify(program, machine=machine, cl=cl), key).state


@pytest.mark.parametrize(("machine", "fault", "key"), _FAULTS)
def test_a_tool_that_would_dive_or_rub_behind_its_last_point_fails(
    machine: str, fault: str, key: str, tmp_path: Path
) -> None:
    cl, text = _program(machine, tmp_path)
    last = [*re.finditer(rf"(?m)^(?:N?\d+ )?{_LEAVES[machine]}", text)][-1].start()
    assert _verified(cl, text, machine, key) == "ok"
    assert _verified(cl, f"{text[:last]}{fault}\n{text[last:]}", machine, key) == "FAIL"


@pytest.mark.parametrize("machine", sorted(_STARTS))
def test_a_stop_behind_the_start_of_the_spindle_wants_it_started_again(machine: str, tmp_path: Path) -> None:
    """Whether it turns on behind M0 depends on the machine."""
    cl, text = _program(machine, tmp_path)
    place = re.search(_STARTS[machine], text)
    assert place is not None
    for words, state in (("M0\n", "FAIL"), ("M0\nM3\n", "ok")):
        assert _verified(cl, text[: place.end()] + words + text[place.end() :], machine, "stops") == state


def test_coolant_may_be_off_while_the_program_stops(tmp_path: Path) -> None:
    machine = "matsuura_mx330"
    cl = tmp_path / "part.cls"
    cl.write_text(_CL.replace("RAPID\n", "COOLNT/FLOOD\nRAPID\n", 1), encoding="utf-8")
    text = post(cl, machine=machine).text or ""
    assert re.search(r"M5\nN\d+ M0\n", text)
    off = re.sub(r"(M5\nN\d+ M0\n)", r"M9\n\1", text)
    assert _verified(cl, text, machine, "coolant") == "ok"
    on_again = off if re.search(r"M0\n(.*\n){0,2}.*M8", off) else re.sub(r"(M0\n)", r"\1M8\n", off)
    assert _verified(cl, on_again, machine, "coolant") == "ok"
    assert _verified(cl, re.sub(r"M0\n(.*\n){0,2}.*M8.*\n", "M0\nM3\n", off), machine, "coolant") == "FAIL"
