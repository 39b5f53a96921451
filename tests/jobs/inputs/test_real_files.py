"""CL files that CAM systems wrote, posted and proven; and compared with the programs of another post.

The author of these programs scales feeds and speeds, and sets a datum of his own for each setup; neither is compared.
"""

import re
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
import pytest

import trunnion
from tests.support.locations import SHARED, TESTS
from trunnion.arrays import Floats

PROGRAMS = SHARED / "data" / "heidenhain"
CL_FILES = SHARED / "data" / "solidworks"

needs_programs = pytest.mark.skipif(not PROGRAMS.exists(), reason="the files of others are not beside the project")

_WORD = re.compile(r"([XYZ]) ?([-+]?[.\d]+)")


@dataclass
class Cut:
    """What the blocks of a Klartext program say, read with a few lines of text.

    ends     end points of lines and arcs at feed
    centres  centres of arcs, at the height of their ends; senses  DR+ or DR-
    holes    places of M99
    tools    numbers of TOOL CALL, each once while it stays
    """

    ends: list[tuple[float, ...]] = field(default_factory=list)
    centres: list[tuple[float, ...]] = field(default_factory=list)
    senses: list[str] = field(default_factory=list)
    holes: list[tuple[float, ...]] = field(default_factory=list)
    tools: list[int] = field(default_factory=list)


def plain_read(text: str) -> Cut:
    """Read blocks in the order in which they stand."""
    cut, here, centre = Cut(), dict.fromkeys("XYZ", 0.0), (0.0, 0.0)
    for line in text.splitlines():
        block = re.sub(r"^\d+ ", "", line)
        if tool := re.match(r"TOOL CALL (\d+)", block):
            number = int(tool[1]) % 100  # this post adds 100
            cut.tools += [number] if cut.tools[-1:] != [number] else []
        if "M91" in block or not re.match(r"(L|C|CC) ", block):
            continue
        words = {letter: float(number) for letter, number in _WORD.findall(block)}
        if block.startswith("CC"):
            centre = (words["X"], words["Y"])
            continue
        here |= words
        if "M99" in block:
            cut.holes.append((here["X"], here["Y"]))
        elif "FMAX" not in block and (words or block.startswith("C ")):
            cut.ends.append(tuple(here.values()))
        if block.startswith("C "):
            cut.centres.append((*centre, here["Z"]))
            cut.senses.append(re.findall("DR([-+])", block)[0])
    return cut


def setups(text: str) -> list[str]:
    """The parts of a program in one coordinate system each: upright, and behind each PLANE SPATIAL."""
    parts = re.split(r"(?=\n\d+ PLANE (?:SPATIAL|RESET))", text)
    upright = "".join(part for part in parts if "PLANE SPATIAL" not in part)
    return [upright, "".join(part for part in parts if "PLANE SPATIAL" in part)]


def turned_about_z(points: Floats, others: Floats) -> tuple[Floats, Floats]:
    """Rotation about Z and shift that bring ``points`` (n, 3) closest to ``others`` (n, 3)."""
    a, b = points[:, :2] - points[:, :2].mean(axis=0), others[:, :2] - others[:, :2].mean(axis=0)
    angle = np.arctan2((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum(), (a * b).sum())
    c, s = np.cos(angle), np.sin(angle)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    return turn, others.mean(axis=0) - turn @ points.mean(axis=0)


@pytest.mark.parametrize("file", ["bohren_1.ncl.8", "profilfraesen_2.ncl.1"])
@pytest.mark.parametrize("machine", ["dmu65", "xyzac_trt"])
def test_a_real_file_of_creo_is_posted_and_proven(file: str, machine: str) -> None:
    assert trunnion.post(TESTS / "cl" / "real" / file, machine=machine, columns=False).passed


@needs_programs
@pytest.mark.parametrize(
    ("part", "setup", "program", "counts"),
    [
        # The program of its second setup has "nan" for coordinates.
        ("Sacrifice-Board", 0, "11.h", (144, 30, 12)),
        ("Teste-Metrologia", 0, "11.h", (98, 6, 0)),
        ("Teste-Metrologia", 1, "12.h", (264, 59, 0)),
    ],
)
def test_a_program_agrees_with_that_of_another_post(
    part: str, setup: int, program: str, counts: tuple[int, int, int], posted: dict[str, str]
) -> None:
    ours = plain_read(setups(posted[part])[setup])
    theirs = plain_read((PROGRAMS / part / program).read_text(encoding="latin-1"))
    assert (len(ours.ends), len(ours.centres), len(ours.holes)) == counts
    turn, shift = turned_about_z(np.array(theirs.ends), np.array(ours.ends))
    for points, others in ((ours.ends, theirs.ends), (ours.centres, theirs.centres)):
        np.testing.assert_allclose(points, np.array(others) @ turn.T + shift, atol=2e-3)
    np.testing.assert_allclose(
        np.reshape(ours.holes, (-1, 2)), np.reshape(theirs.holes, (-1, 2)) @ turn[:2, :2].T + shift[:2], atol=2e-3
    )
    assert ours.senses == theirs.senses
    assert ours.tools == (theirs.tools if setup == 0 else [])  # the tool of the first setup stays


@pytest.fixture(scope="module")
def posted(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """The programs for a TNC, of all that its machine can reach: not of a setup from below."""
    texts = {}
    for part in ("Sacrifice-Board", "Teste-Metrologia"):
        toolpath = trunnion.read_cl(CL_FILES / f"{part}.apt")
        above = tuple(o for o in toolpath.operations if len(o.moves) and o.moves.axis[0, 2] >= 0.0)
        output = tmp_path_factory.mktemp("posted") / f"{part}.h"
        assert trunnion.post(replace(toolpath, operations=above), machine="dmu65", output=output, columns=False).passed
        texts[part] = Path(output).read_text(encoding="utf-8")
    return texts
