"""Real Klartext programs, where the shared data is at hand: extents and holes as a plain scan of the text has them."""

import math
import re

import numpy as np
import pytest

from tests.support.locations import SHARED
from tests.support.reading import close
from trunnion.machines import load_machine
from trunnion.readers import run_program

FOLDER = SHARED / "data" / "heidenhain"

pytestmark = pytest.mark.skipif(not FOLDER.is_dir(), reason="shared/data/heidenhain is not beside the repository")

DMU65 = load_machine("dmu65")

#: Programs whose positions are all in the text.
PLAIN = ["Sacrifice-Board/11.h", "Teste-Metrologia/11.h", "Teste-Metrologia/12.h"]

#: What the others ask of the control alone, or do not know themselves.
EXPECTED = {"TOOL DEF gives", "SYSREAD", "FN 15", "has no value that the program says", "NAN", "no CC before it"}

#: What programs that only set a datum for those after them leave on, and are told of.
EXPECTED |= {"ends with a datum of cycles 7"}


def names() -> list[str]:
    """All programs."""
    return sorted(path.relative_to(FOLDER).as_posix() for path in FOLDER.rglob("*.h"))


@pytest.mark.parametrize("name", names())
def test_every_block_is_known_or_named(name: str) -> None:
    run = run_program(FOLDER / name, DMU65)
    odd = [f for f in run.diagnostics if not any(text in f.text for text in EXPECTED)]
    # Pecking is called where a position is no number.
    assert [f for f in odd if "the cycle" not in f.text] == []
    assert np.isfinite(run.joints).all()
    if name in PLAIN:
        told = ("TOOL DEF gives", "ends with a datum of cycles 7")
        assert [each for each in run.diagnostics if not any(text in each.text for text in told)] == []


@pytest.mark.parametrize("name", PLAIN)
def test_extents_and_holes_are_those_of_the_text(name: str) -> None:
    run = run_program(FOLDER / name, DMU65)
    ends, holes = scanned((FOLDER / name).read_text(encoding="ascii"))
    tip = run.tip[~run.machine_frame]
    # Holes go deeper than any block says; everything else is in the blocks.
    for axis in range(3):
        low = min(ends[:, axis].min(), min((hole[2] for hole in holes), default=math.inf)) if axis == 2 else None
        assert tip[:, axis].min() == pytest.approx(ends[:, axis].min() if low is None else low, abs=1e-9)
        assert tip[:, axis].max() == pytest.approx(ends[:, axis].max(), abs=1e-9)
    written = {tuple(row) for row in np.round(ends, 6).tolist()}
    assert written <= {tuple(row) for row in np.round(run.tip, 6).tolist()}
    bottoms = [row for row in np.round(run.tip, 6).tolist() if any(abs(row[2] - hole[2]) < 1e-6 for hole in holes)]
    for hole in holes:
        assert any(row == pytest.approx(hole, abs=1e-6) for row in bottoms)


def scanned(text: str) -> tuple[np.ndarray[tuple[int, int], np.dtype[np.float64]], list[list[float]]]:
    """Ends of all blocks with axes that are no machine positions, and bottoms of holes."""
    place, shift = [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]
    ends: list[list[float]] = []
    holes: list[list[float]] = []
    distance = depth = 0.0
    for raw in text.splitlines():
        line = re.sub(r"^\s*\d+\s+(?=\S)", "", raw).split(";")[0].strip()
        cycle = re.match(r"CYCL DEF 1\.([12]) \w+?([-+]?[\d.]+)$", line)
        if cycle:
            distance, depth = (float(cycle[2]), depth) if cycle[1] == "1" else (distance, float(cycle[2]))
        datum = re.match(r"CYCL DEF 7\.[123]\s+([XYZ])([-+\d.]+)$", line)
        if datum:
            # The axes stand still: the shift stands in the head, before any motion.
            assert not ends
            shift["XYZ".index(datum[1])] = float(datum[2])
        if not re.match(r"(L|C|CP) ", line) or "M91" in line:
            continue
        words = re.findall(r"(?<![A-Z])([XYZ])\s*([-+]?\d*\.?\d+)", line)
        for axis, value in words:
            place["XYZ".index(axis)] = float(value) + shift["XYZ".index(axis)]
        if words and not line.startswith("CP"):
            ends.append(list(place))
        if "M99" in line:
            holes.append([place[0], place[1], place[2] - distance + depth])
    return np.array(ends), holes


def test_arcs_turn_about_the_centres_of_the_text() -> None:
    name = "Teste-Metrologia/12.h"
    run = run_program(FOLDER / name, DMU65)
    text = (FOLDER / name).read_text(encoding="ascii")
    x, y = (float(re.findall(rf"CYCL DEF 7\.\d\s+{axis}([-+\d.]+)", text)[0]) for axis in "XY")
    centres = [[float(a) + x, float(b) + y] for a, b in re.findall(r"CC X([-+\d.]+) Y([-+\d.]+)", text)]
    arcs = len(re.findall(r"^\s*\d+\s+C .*DR[-+]", text, re.MULTILINE))
    assert len(run.arcs.row) == arcs
    close(np.unique(np.round(run.arcs.centre[:, :2], 6), axis=0), np.unique(np.round(centres, 6), axis=0))
