"""Lines that a program writes for an arc: none may be missing, reversed or doubled."""

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import trunnion
from tests.support.verifying import Verifier
from trunnion.errors import TrunnionError
from trunnion.model.toolpath import Operation
from trunnion.planning import preparation
from trunnion.planning.linearization.arc_chords import lines_for_arcs
from trunnion.verification import Verification

UPRIGHT, TILTED = "0,0,1", "0.5,0,0.866025404"

#: The tool axis, the point before the arc, the arc, its end; each becomes lines on the machine beside it.
ARCS = {
    "yl569": (UPRIGHT, "-2,0,0", "CIRCLE/0,0,0,0,1,0,2,0.06,0.5,10,0", "2,0,0"),
    "dmu65": (UPRIGHT, "-2,0,0", "CIRCLE/0,0,0,0,1,0,2,0.06,0.5,10,0", "2,0,0"),
    "hs664rt": (UPRIGHT, "2,0,0", "CIRCLE/0,0,0,0,0,1,2,0.06,0.5,10,0,TIMES,2", "2,0,-1"),
    "xyzac_trt": (TILTED, "1.732051,0,-1", f"CIRCLE/0,0,0,{TILTED},2,0.06,0.5,10,0", "0,-2,0"),
}

#: What may happen to the lines of an arc.
Fault = Callable[[list[str]], list[str]]
FAULTS: dict[str, Fault] = {
    "one left out": lambda lines: [*lines[:20], *lines[21:]],
    "ten left out": lambda lines: [*lines[:20], *lines[30:]],
    "the first left out": lambda lines: lines[1:],
    "the last three left out": lambda lines: lines[:-3],
    "a straight way": lambda lines: lines[:1],
    "reversed": lambda lines: [*lines[:20], *reversed(lines[20:25]), *lines[25:]],
    "doubled": lambda lines: [*lines[:20], *lines[15:20], *lines[20:]],
}


def cl_file(folder: Path, machine: str) -> Path:
    axis, start, arc, end = ARCS[machine]
    path = folder / f"{machine}.cls"
    path.write_text(
        f"UNITS/MM\nTOOL PATH/ARC,TOOL,EM\nTLDATA/MILL,6,0,80,20,0\nLOAD/TOOL,1\nSPINDL/RPM,3000,CLW\n"
        f"RAPID\nGOTO/-5,0,40,{axis}\nFEDRAT/MMPM,300\nGOTO/-5,0,5\nGOTO/{start}\n{arc}\nGOTO/{end}\n"
        "RAPID\nGOTO/5,0,40\nEND-OF-PATH\n"
    )
    return path


@pytest.fixture(scope="module", params=sorted(ARCS))
def posted(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> "Posted":
    folder = tmp_path_factory.mktemp("arc")
    return Posted(folder, request.param)


class Posted:
    """A sound program with lines for an arc, and where these lines are (numbers from 0; the end of the arc not)."""

    def __init__(self, folder: Path, machine: str) -> None:
        self.machine, self.cl, self.nc = machine, cl_file(folder, machine), folder / "arc.nc"
        trunnion.post(self.cl, machine=machine, output=self.nc)
        self.lines = self.nc.read_text().splitlines()
        found = trunnion.verify(self.nc, machine=machine, cl=self.cl)
        assert found.passed
        arc = max(set(found.cl_line.tolist()), key=found.cl_line.tolist().count)
        rows = np.flatnonzero(found.cl_line == arc)[:-1]
        self.first, self.end = int(found.run.lines[rows[0]]) - 1, int(found.run.lines[rows[-1]])
        assert self.end - self.first == len(rows) > 40

    def with_fault(self, fault: Fault, span_tip: float | None = None) -> Verification:
        lines = [*self.lines[: self.first], *fault(self.lines[self.first : self.end]), *self.lines[self.end :]]
        path = self.nc.with_name("fault.nc")
        path.write_text("\n".join(lines) + "\n")
        return trunnion.verify(path, machine=self.machine, cl=self.cl, span_tip=span_tip, columns=False)


def faults_of(found: Verification) -> dict[str, str]:
    return {check.key: check.summary for check in found.checks if not check.passed}


def test_each_line_is_within_the_chord_tolerance_of_its_arc_and_none_goes_back(posted: Posted) -> None:
    found = {name: faults_of(posted.with_fault(fault)) for name, fault in FAULTS.items()}
    # One line in place of two turns is none of the helix for the check of the order.
    assert {name for name, faults in found.items() if not faults.keys() & {"span", "order"}} == set()
    assert [name for name, faults in found.items() if "span" not in faults] in ([], ["a straight way"])
    back = next(check for check in posted.with_fault(FAULTS["reversed"]).checks if check.key == "span")
    assert {place.cl_line for place in back.places if "the arc" in place.text} == {12}
    assert any("goes back along the arc" in place.text for place in back.places)


def test_a_coarser_limit_for_the_tip_is_that_of_the_lines_too(posted: Posted) -> None:
    assert "span" not in faults_of(posted.with_fault(FAULTS["one left out"], span_tip=0.01))
    assert ", 0.010" in faults_of(posted.with_fault(FAULTS["ten left out"], span_tip=0.01))["span"]


def test_a_turn_of_a_helix_may_not_be_left_out(tmp_path: Path) -> None:
    posted = Posted(tmp_path, "hs664rt")
    count = (posted.end - posted.first + 1) // 2
    assert faults_of(posted.with_fault(lambda lines: [*lines[:20], *lines[20 + count :]]))


def test_lines_round_the_other_side_of_an_arc_are_none_of_it(verified: Verifier) -> None:
    cl = (
        "UNITS/MM\nTOOL PATH/A,TOOL,EM\nTLDATA/MILL,6,0,80,20,0\nLOAD/TOOL,1\nSPINDL/RPM,3000,CLW\nRAPID\n"
        "GOTO/10,0,5,0,0,1\nFEDRAT/MMPM,300\nGOTO/10,0,0\nCIRCLE/0,0,0,0,0,1,10,0.06,0.5,10,0\nGOTO/0,10,0\nEND-OF-PATH\n"
    )

    def program(sweep: float, count: int) -> str:
        angles = sweep * np.arange(1, count + 1) / count
        ways = [f"G1 X{10 * math.cos(a):.4f} Y{10 * math.sin(a):.4f}" for a in angles.tolist()]
        return "\n".join(["G54", "T1 D1 M6", "S3000 M3", "G0 X10 Y0 Z5", "G1 Z0 F300", *ways, "M30"])

    judged = ("order", "tip", "kind", "span")
    assert not faults_of(verified(program(0.5 * math.pi, 60), cl)).keys() & set(judged)
    assert faults_of(verified(program(-1.5 * math.pi, 180), cl)).keys() & set(judged)


def test_the_chord_tolerance_is_that_of_the_definition(tmp_path: Path) -> None:
    coarse = tmp_path / "coarse.toml"
    coarse.write_text('extends = "yl569"\n\n[control.arcs]\nchord_tolerance = 0.02\n')
    nc, cl = tmp_path / "coarse.mpf", cl_file(tmp_path, "yl569")
    assert trunnion.post(cl, machine=coarse, output=nc).passed
    assert trunnion.verify(nc, machine=coarse, cl=cl, columns=False).passed
    assert list(faults_of(trunnion.verify(nc, machine="yl569", cl=cl, columns=False))) == ["span"]


def test_the_proof_of_post_finds_chords_that_planning_makes_too_long(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def coarse(operation: Operation, keep: np.ndarray, chord_tolerance: float) -> Operation:
        return lines_for_arcs(operation, keep, 3.0 * chord_tolerance)

    monkeypatch.setattr(preparation, "lines_for_arcs", coarse)
    output = tmp_path / "arc.mpf"
    with pytest.raises(TrunnionError, match="is allowed"):
        trunnion.post(cl_file(tmp_path, "yl569"), machine="yl569", output=output)
    assert not output.exists()
