"""Files that CAM systems wrote, where they are at hand beside the project."""

import csv
import hashlib
import os
import re
from pathlib import Path

import numpy as np
import pytest

from tests.support.locations import SHARED, TESTS
from tests.support.plain_cl_scan import counts_of, plain_scan
from trunnion.cl import ClReading, read_cl
from trunnion.errors import InputError
from trunnion.model.toolpath import Kind, Phase

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
    toolpath = read_cl(path, ClReading(strict=True))
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


ALL_FILES = sorted(
    [
        *FILES,
        *SHARED.glob("data/creo/*"),
        *SHARED.glob("data/solidworks/*.apt"),
        *(TESTS / "cl" / "real").glob("*.ncl.*"),
    ]
)
DIALECT_OF = {".cls": "clsf", ".apt": "solidworks"}


@pytest.mark.parametrize("path", ALL_FILES, ids=lambda path: f"{path.parent.name}/{path.name}")
def test_a_real_file_is_read_whole(path: Path) -> None:
    """Points, arcs, holes, tools and extents are those of a scan that shares nothing with the reader."""
    toolpath = read_cl(path, ClReading(strict=True))
    assert toolpath.dialect == DIALECT_OF.get(path.suffix, "ncl")
    assert counts_of(toolpath) == plain_scan(path)


LISTED = list(csv.DictReader((TESTS / "cl" / "real" / "others.csv").open(encoding="utf-8", newline="")))


@pytest.mark.skipif(
    "TRUNNION_REAL_CL" not in os.environ, reason="TRUNNION_REAL_CL names no folder with the files of the list"
)
def test_the_files_of_the_list_are_read_as_it_says() -> None:
    """Each file of the list that is anywhere in the folder, told by its content."""
    found = {}
    names = {Path(row["path"]).name for row in LISTED}
    for path in Path(os.environ["TRUNNION_REAL_CL"]).rglob("*"):
        if path.name in names and path.is_file():
            found[hashlib.sha256(path.read_bytes()).hexdigest()] = path
    rows = [row for row in LISTED if row["sha256"] in found]
    assert rows, "no file of the list is in the folder"
    for row in rows:
        path = found[row["sha256"]]
        scanned = plain_scan(path)
        for name in ("points", "arcs", "holes"):
            assert row[name] == ("" if scanned[name] is None else str(scanned[name])), (path, name)
        if not row["read as"]:
            with pytest.raises(InputError):
                read_cl(path)
            continue
        toolpath = read_cl(path)
        assert toolpath.dialect == row["read as"], path
        counts = counts_of(toolpath)
        known = {name: value for name, value in scanned.items() if value is not None}
        np.testing.assert_allclose(
            counts.pop("extents"), known.pop("extents", counts_of(toolpath)["extents"]), atol=1e-6
        )
        assert {name: counts[name] for name in known} == known, path
