"""Angles of a program survive as tool axes in a CL file: they print the same again."""

import io
from pathlib import Path

import numpy as np
import pytest

from trunnion.arrays import Floats
from trunnion.cl import read_cl
from trunnion.cl.write import write_cl
from trunnion.machines import forward, inverse, load_machine
from trunnion.model.toolpath import Arcs, Frame, Moves, Operation, Tool, Toolpath

MACHINE = load_machine("yl569")
B, C = MACHINE.column("B"), MACHINE.column("C")
N = 20_000

#: Half of the fifth decimal of a degree.
HALF = 5e-6


def axes(b: Floats, c: Floats) -> Floats:
    """(n, 3): tool axes at angles in degrees."""
    joints = np.zeros((len(b), 5))
    joints[:, B], joints[:, C] = b, c
    return forward(MACHINE, joints)[1]


def angles_off(axis: Floats, b: Floats, c: Floats) -> float:
    """Largest difference between the angles of the tool axes and those given, degrees."""
    joints = inverse(MACHINE, np.zeros((len(axis), 3)), np.ascontiguousarray(axis)).joints[0]
    round_c = np.abs((joints[:, C] - c + 180) % 360 - 180)
    return float(np.maximum(np.abs(joints[:, B] - b), round_c).max())


def through_a_file(axis: Floats, folder: Path) -> Floats:
    """The tool axes written to a CL file and read from it."""
    n = len(axis)
    tip = np.arange(3 * n, dtype=float).reshape(n, 3)
    feed, line = np.full(n, 100.0), np.arange(1, n + 1, dtype=np.int32)
    moves = Moves(tip, axis, np.ones(n, np.uint8), np.full(n, 4, np.uint8), feed, np.zeros(n, bool), line)
    sink = io.BytesIO()
    write_cl(Toolpath("a", (Operation("O", Tool(), Frame(), moves, Arcs.empty(), (), 1),)), sink)
    (folder / "a.cls").write_bytes(sink.getvalue())
    return read_cl(folder / "a.cls").operations[0].moves.axis


@pytest.mark.parametrize("where", ["anywhere", "C near 0", "C near 360"])
@pytest.mark.parametrize(
    ("low", "high"), [(0.00001, 0.0001), (0.0001, 0.01), (0.01, 1.0), (1.0, 89.9), (89.9, 90.1), (90.0, 99.0)]
)
def test_five_decimals_survive_from_a_hundred_thousandth_of_a_degree_on(
    low: float, high: float, where: str, tmp_path: Path
) -> None:
    random = np.random.default_rng(1)
    b = np.round(random.uniform(low, high, N), 5)
    near = np.round(random.uniform(1e-5, 2e-4, N), 5)
    c = {"anywhere": np.round(random.uniform(0, 360, N), 5), "C near 0": near, "C near 360": 360 - near}[where]
    assert angles_off(through_a_file(axes(b, c), tmp_path), b, c) < 0.01 * HALF


@pytest.mark.parametrize(
    ("low", "high", "enough"), [(0.00001, 0.0003, False), (0.0006, 0.01, True), (0.01, 99.0, True)]
)
def test_twelve_decimals_alone_would_do_from_half_a_thousandth_of_a_degree_on(
    low: float, high: float, enough: bool
) -> None:
    random = np.random.default_rng(2)
    b, c = np.round(random.uniform(low, high, N), 5), np.round(random.uniform(0, 360, N), 5)
    assert (angles_off(np.round(axes(b, c), 12), b, c) < HALF) is enough
