"""Splines that a program writes as such: the proof compares them with those of the CL file as curves."""

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings

import trunnion
from tests.support.examples import examples
from tests.support.naive.splines import points_of, splines
from tests.support.verifying import check
from trunnion.model.splines import Spline, SplineRows, Splines
from trunnion.verification.expected.splines import dense_points, span_counts

PART = """TOOL PATH/OP1,TOOL,D10
TLDATA/MILL,10.0000,5.0000,75.0000,0.0000,0.0000
MSYS/0,0,0,1,0,0,0,1,0
LOAD/TOOL,1
SPINDL/RPM,900,CLW
RAPID
GOTO/0,0,50,0,0,1
FEDRAT/MMPM,80
GOTO/0,0,5
FEDRAT/MMPM,100
NURBS/
KNOT/0.25,0.5,1.0000000
CNTRL/0,10,5
CNTRL/10,20,5
CNTRL/20,20,5
CNTRL/30,10,6
CNTRL/30,0,5
GOTO/30,-5,5
COOLNT/ON
NURBS/
KNOT/0.3333333,1.0000000
CNTRL/30.5,-10,5
CNTRL/10.2345,-20,5
CNTRL/20,-20,4
CNTRL/30,-10,6
RAPID
GOTO/30,-10,50
END-OF-PATH
"""

#: Settings by machine, and by what a spline of the program begins.
WRITTEN = {"yl569": ({"splines": "polynomial"}, "POLY"), "matsuura_mx330": ({"splines": "nurbs"}, "G06.2")}

#: Blocks of splines.
BLOCKS = re.compile(r"PO\[|G06\.2|\bK\d")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("splines")
    (folder / "part.cls").write_text(PART)
    for machine, (setting, _) in WRITTEN.items():
        trunnion.post(folder / "part.cls", machine=machine, settings=setting, output=folder / f"{machine}.nc")
    return folder


@pytest.fixture(params=WRITTEN)
def machine(request: pytest.FixtureRequest) -> str:
    return str(request.param)


Verify = Callable[[str], trunnion.Verification]


@pytest.fixture
def verify(folder: Path, machine: str, tmp_path: Path) -> Verify:
    def verify(text: str) -> trunnion.Verification:
        (tmp_path / "mutant.nc").write_text(text)
        return trunnion.verify(tmp_path / "mutant.nc", machine=machine, cl=folder / "part.cls")

    return verify


def test_splines_are_written_and_proven(folder: Path, machine: str, verify: Verify) -> None:
    text = (folder / f"{machine}.nc").read_text()
    assert text.count(WRITTEN[machine][1]) == 2
    found = verify(text)
    assert found.passed, [each.summary for each in found.checks if not each.passed]
    assert "6 points" in check(found, "order").summary
    assert float(re.findall(r"tip ([0-9.]+) mm", check(found, "span").summary)[0]) < 0.0005
    operation = trunnion.read_cl(folder / "part.cls").operations[0]
    for k in range(2):
        _, last, spline = operation.splines[k]
        lines = found.cl_line[found.run.splines.first[0] : found.run.splines.last[-1] + 1]
        assert int(operation.moves.line[last]) in lines
        wanted = points_of(spline, np.linspace(0.0, 1.0, 33))
        near = np.linalg.norm(found.run.tip[:, None] - wanted, axis=2).min(axis=0)
        assert near.max() < 0.2


def changed_numbers(text: str, begin: str, by: float) -> list[str]:
    """The program with one number of its splines changed, for each of them."""
    lines, mutants, inside = text.splitlines(), [], False
    for k, line in enumerate(lines):
        inside = begin in line or (inside and BLOCKS.search(line) is not None)
        if not inside:
            continue
        for found in re.finditer(r"(?<=[(,XYZKR])-?\d*\.\d*", line):
            off = 50.0 if line[found.start() - 1] == "K" else by  # knots go to 10000
            other = f"{line[: found.start()]}{float(found.group()) + off:.5f}{line[found.end() :]}"
            mutants.append("\n".join([*lines[:k], other, *lines[k + 1 :]]) + "\n")
    return mutants


def test_changed_numbers_are_caught(folder: Path, machine: str, verify: Verify) -> None:
    mutants = changed_numbers((folder / f"{machine}.nc").read_text(), WRITTEN[machine][1], 0.02)[2::6]
    assert len(mutants) > 6
    found = [verify(mutant) for mutant in mutants]
    assert [k for k, each in enumerate(found) if each.passed] == []
    faults = [check(each, "span").summary for each in found]
    assert any("mm off that of the CL file, 0.00102 is allowed" in fault for fault in faults), faults


def test_every_other_mutant_is_caught(folder: Path, machine: str, verify: Verify) -> None:
    text = (folder / f"{machine}.nc").read_text()
    lines = text.splitlines()
    spline = [k for k, line in enumerate(lines) if BLOCKS.search(line)]
    dropped = ["\n".join([*lines[:k], *lines[k + 1 :]]) + "\n" for k in spline[::3]]
    doubled = ["\n".join([*lines[: k + 1], *lines[k:]]) + "\n" for k in spline[1::4]]
    second = spline[1]
    inside = ["\n".join([*lines[:second], word, *lines[second:]]) + "\n" for word in ("F50", "M9", "G4 F1", "M1")]
    in_block = [text.replace(lines[second], f"{lines[second]} {word}") for word in ("PL=2", "F50", "M9", "R2")]
    for mutant in (*dropped, *doubled, *inside, *in_block):
        assert not verify(mutant).passed, mutant


def test_a_straight_way_along_the_control_points_is_caught(folder: Path, machine: str, verify: Verify) -> None:
    text = (folder / f"{machine}.nc").read_text()
    assert not verify(text.replace(WRITTEN[machine][1], "G1", 1)).passed


def test_the_same_splines_as_lines_come_first(folder: Path, machine: str, tmp_path: Path) -> None:
    first = PART.replace("OP1", "OP0").replace("GOTO/0,0,5\n", "CUTCOM/LEFT\nGOTO/0,0,5\n")
    first = first.replace("RAPID\nGOTO/30,-10,50", "CUTCOM/OFF\nRAPID\nGOTO/30,-10,50")
    cl, output = tmp_path / "both.cls", tmp_path / "both.nc"
    cl.write_text(first + PART)
    found = trunnion.post(cl, machine=machine, settings=WRITTEN[machine][0], output=output).verification
    assert found is not None
    assert found.passed
    assert output.read_text().count(WRITTEN[machine][1]) == 2


def test_a_conversion_carries_over_their_points(folder: Path, machine: str, tmp_path: Path) -> None:
    path = tmp_path / "back.cls"
    converted = trunnion.convert(folder / f"{machine}.nc", machine=machine, to_cl=True, output=path)
    assert any("splines of the program as the lines of their points" in each.what for each in converted.problems)
    points = trunnion.read_cl(path).operations[0].moves.tip
    spline = trunnion.read_cl(folder / "part.cls").operations[0].splines[0].spline
    dense = points_of(spline, np.linspace(0.0, 1.0, 33))
    assert np.linalg.norm(points[:, None] - dense, axis=2).min(axis=0).max() < 0.2


def test_by_default_and_where_it_is_not_certain_splines_are_lines(folder: Path, tmp_path: Path) -> None:
    tilted = tmp_path / "tilted.cls"
    tilted.write_text(PART.replace("0,0,50,0,0,1", "0,0,50,0,0.6,0.8"))
    compensated = tmp_path / "compensated.cls"
    compensated.write_text(PART.replace("GOTO/30,-5,5", "GOTO/30,-5,5\nCUTCOM/LEFT"))
    asked = {"splines": "polynomial"}
    cases = [
        (folder / "part.cls", {}, 0),
        (tilted, asked, 0),
        (compensated, asked, 0),
        (folder / "part.cls", {**asked, "programs": "operations", "split": "1000"}, 0),
    ]
    for cl, setting, count in cases:
        planned = trunnion.plan(cl, machine="yl569", settings=setting)
        assert [len(motion.operation.splines) for motion in planned.motions] == [count], setting


@settings(max_examples=examples(15), deadline=None)
@given(splines(weights=(0.25, 1.0, 3.0)))
def test_dense_points_are_those_of_the_recursion(spline: Spline) -> None:
    twice = Splines.of([SplineRows(1, 3, spline), SplineRows(4, 5, spline)])
    counts = span_counts(twice).tolist()
    assert counts == 2 * [len(spline.spans)]
    found = dense_points(twice, 0, 2)
    np.testing.assert_array_equal(found[: counts[0]], found[counts[0] :])
    np.testing.assert_array_equal(found[: counts[0]], dense_points(twice, 1, 2))
    for span, points in zip(spline.spans.tolist(), found[: counts[0]], strict=True):
        at = np.linspace(spline.knots[span], spline.knots[span + 1], 9)
        # The recursion is open at the end of each span, where knots may be several.
        np.testing.assert_allclose(points[:-1], points_of(spline, at[:-1]), atol=1e-9)
        if span == spline.spans[-1]:
            np.testing.assert_allclose(points[-1], spline.poles[-1], atol=1e-9)
