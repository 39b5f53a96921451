"""Files that CAM systems wrote, where they are at hand beside the project."""

import re
from pathlib import Path

import pytest

from tests.support.locations import SHARED
from trunnion.cl import read_cl
from trunnion.model.toolpath import Kind, Phase

FILES = sorted([*SHARED.glob("golden/*/*.cls"), *SHARED.glob("data/nx/*.cls")])

pytestmark = pytest.mark.skipif(not FILES, reason="the files of others are not beside the project")

NAMES = {
    "Initial Move": {Phase.INITIAL},
    "Approach Move": {Phase.APPROACH},
    "Engage Move": {Phase.ENGAGE},
    "Cutting": {Phase.CUT},
    "Retract Move": {Phase.RETRACT},
    "Departure Move": {Phase.DEPARTURE},
}


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_a_real_file_is_read_without_a_remark(path: Path) -> None:
    toolpath = read_cl(path, strict=True)
    assert toolpath.remarks == ()
    assert all(len(operation.moves) for operation in toolpath.operations)


def test_the_points_of_a_real_file_are_those_of_its_lines() -> None:
    path = SHARED / "data" / "nx" / "toolpath-contact.cls"
    lines = path.read_text(encoding="gb18030").splitlines()
    (operation,) = read_cl(path).operations
    assert operation.name == "SEMI-凹"
    expected = [
        [float(field) for field in line[5:].partition("$$")[0].split(",")[:3]]
        for line in lines
        if line.startswith("GOTO/")
    ]
    assert operation.moves.tip.tolist() == expected


def test_the_phases_are_those_that_the_machine_s_program_names() -> None:
    """Each row of this path is one motion block of the program that ran."""
    folder = SHARED / "golden" / "yl569"
    (operation,) = read_cl(folder / "1_contour_rough.cls").operations
    phases: list[set[Phase]] = []
    now: set[Phase] | None = None
    for block in (folder / "1_contour_rough.expected.mpf").read_text(encoding="utf-8").splitlines():
        if comment := re.search(r";(.*)$", block):
            now = NAMES.get(comment[1].strip())
        elif now and re.search(r"[XYZ]-?\.?\d", block):
            phases.append(now)
    assert len(phases) == len(operation.moves)
    assert all(phase in named for phase, named in zip(operation.moves.phase.tolist(), phases, strict=True))
    assert operation.moves.kind.tolist().count(Kind.ARC) == len(operation.arcs.row)
