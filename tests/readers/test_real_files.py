"""Real programs and their published positions, where the shared data is at hand."""

import csv

import numpy as np
import pytest

from tests.support.locations import SHARED
from trunnion.arrays import Floats
from trunnion.machines import Machine, load_machine
from trunnion.readers import run_program

FOLDER = SHARED / "data" / "sinumerik"

pytestmark = pytest.mark.skipif(not FOLDER.is_dir(), reason="shared/data/sinumerik is not beside the repository")

#: Words of these files that belong to another machine or to nobody, by file.
EXPECTED = {
    "edge_cases": {"A0 ", "E=", "ELX", "E_MULTIPLIER", "F_MULTI", "MATERIAL_UPDATE"},
    "simple": {"no centre", "X is twice in this block"},
    "arc": {"K has no meaning"},
    "multiple_m_codes": {f"M{code} belongs" for code in (101, 102, 103)},
}

#: Words of the machine's builder, which the reader tells of.
OF_THE_BUILDER = {f"M{code} belongs to the machine" for code in (27, 29, 50, 51, 65)}


def machine() -> Machine:
    """Return a machine whose tip is where its slides are, which is what the tables list."""
    return load_machine("yl569")


def names() -> list[str]:
    """Return the programs."""
    return sorted(path.stem for path in FOLDER.glob("*.mpf"))


@pytest.mark.parametrize("name", names())
def test_real_programs_hold_no_word_that_the_reader_does_not_know(name: str) -> None:
    run = run_program(FOLDER / f"{name}.mpf", machine())
    odd = EXPECTED.get(name, set()) | OF_THE_BUILDER
    assert [f for f in run.diagnostics if not any(text in f.text for text in odd)] == []
    assert np.isfinite(run.joints).all()


@pytest.mark.parametrize("name", [n for n in names() if (FOLDER / f"{n}.csv").is_file()])
def test_positions_are_those_of_the_table(name: str) -> None:
    run = run_program(FOLDER / f"{name}.mpf", machine())
    with (FOLDER / f"{name}.csv").open(encoding="utf-8") as file:
        table = [[row.get(axis) or "" for axis in "XYZ"] for row in csv.DictReader(file)]
    wanted = np.array([[float(text or 0) for text in row] for row in table if any(row)])
    got = run.joints[:, [run.machine.column(axis) for axis in "XYZ"]]
    # Tables have a row for every block, programs of the reader one for every motion: repeated rows are one position.
    np.testing.assert_allclose(distinct(got), distinct(wanted), rtol=0, atol=5.1e-4)


def distinct(rows: Floats) -> Floats:
    """Rows that differ from the one before them."""
    fresh = np.ones(len(rows), bool)
    fresh[1:] = np.abs(np.diff(rows, axis=0)).max(axis=1) > 1e-9
    return rows[fresh]


def test_planes_of_the_axis_cross_stand_where_its_frames_turn_them() -> None:
    run = run_program(FOLDER / "Coordinate_system_representation_Achskreuz.mpf", machine())
    # N10330: B90 C0, TRAORI, AROT Y90, then X31 Y-15.001 Z165.236 in that frame.
    row = int(np.flatnonzero(run.block_number == 10330)[0])
    np.testing.assert_allclose(run.tip[row], [165.236, -15.001, -31.0], atol=1e-9)
    np.testing.assert_allclose(run.axis[row], [1.0, 0.0, 0.0], atol=1e-12)
