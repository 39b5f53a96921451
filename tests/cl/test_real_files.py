"""Files that CAM systems wrote, where they are at hand beside the project."""

import re
from pathlib import Path

import numpy as np
import pytest

from tests.support.locations import SHARED, TESTS
from trunnion.cl import read_cl
from trunnion.model.toolpath import CycleOff, CycleOn, Kind, LoadTool, Operation, Phase

FILES = sorted([*SHARED.glob("golden/*/*.cls"), *SHARED.glob("data/nx/*.cls")])

needs_files = pytest.mark.skipif(not FILES, reason="the files of others are not beside the project")

NAMES = {
    "Initial Move": {Phase.INITIAL},
    "Approach Move": {Phase.APPROACH},
    "Engage Move": {Phase.ENGAGE},
    "Cutting": {Phase.CUT},
    "Retract Move": {Phase.RETRACT},
    "Departure Move": {Phase.DEPARTURE},
}


@needs_files
@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_a_real_file_is_read_without_a_remark(path: Path) -> None:
    toolpath = read_cl(path, strict=True)
    assert toolpath.remarks == ()
    assert all(len(operation.moves) for operation in toolpath.operations)


@needs_files
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


@needs_files
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


APT_FILES = sorted(
    [*SHARED.glob("data/creo/*"), *SHARED.glob("data/solidworks/*.apt"), *(TESTS / "cl" / "real").glob("*.ncl.*")]
)
_NUMBER = re.compile(r"[-+]?[0-9]*\.?[0-9]+")


def plain_scan(path: Path) -> dict[str, object]:
    """Points, arcs, holes and tools of an APT file, counted with a few lines of text."""
    text = re.sub(r"\$[ \t]*\r?\n", " ", path.read_text(encoding="latin-1"))
    points: list[list[float]] = []
    loaded: list[int] = []
    arcs, holes, is_hole = 0, 0, False
    for line in text.splitlines():
        word = re.sub(r"\s", "", line.partition("/")[0]).upper()
        rest = line.partition("/")[2]
        if word == "GOTO":
            points.append([float(number) for number in _NUMBER.findall(rest)[:3]])
            holes += is_hole
        elif word == "CIRCLE":
            arcs += 1
        elif word == "CYCLE":
            is_hole = not re.match(r"\s*(OFF|INIT|CLEAR)", rest)
        elif word in ("LOAD", "LOADTL"):
            number = int(_NUMBER.findall(rest)[0])
            if loaded[-1:] != [number]:
                loaded.append(number)
    low, high = np.min(points, axis=0).tolist(), np.max(points, axis=0).tolist()
    return {"points": len(points), "arcs": arcs, "holes": holes, "tools": loaded, "extents": (low, high)}


def hole_rows(operation: Operation) -> int:
    """Rows of an operation that are holes."""
    count, row, is_hole = 0, 0, False
    for event in [*operation.events, CycleOff(len(operation.moves), 0)]:
        if isinstance(event, CycleOn | CycleOff):
            count += is_hole * int((operation.moves.kind[row : event.row] != Kind.RAPID).sum())
            row, is_hole = event.row, isinstance(event, CycleOn)
    return count


@pytest.mark.parametrize("path", APT_FILES, ids=lambda path: f"{path.parent.name}/{path.name}")
def test_a_real_apt_file_is_read_whole(path: Path) -> None:
    toolpath = read_cl(path, strict=True)
    assert toolpath.dialect == ("ncl" if ".ncl" in path.name else "solidworks")
    tip = np.concatenate([operation.moves.tip for operation in toolpath.operations])
    events = [event for operation in toolpath.operations for event in operation.events]
    assert plain_scan(path) == {
        "points": len(tip),
        "arcs": sum(len(operation.arcs.row) for operation in toolpath.operations),
        "holes": sum(hole_rows(operation) for operation in toolpath.operations),
        "tools": [event.number for event in events if isinstance(event, LoadTool)],
        "extents": (tip.min(axis=0).tolist(), tip.max(axis=0).tolist()),
    }
