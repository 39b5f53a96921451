"""Paths in five axes for planning, and machines with other limits."""

from dataclasses import replace

import numpy as np
from hypothesis import strategies as st

from tests.support.operations import moves_of, rapids_at
from trunnion.arrays import Floats
from trunnion.machines import Machine, load_machine
from trunnion.model.toolpath import Moves


def with_limits(machine: Machine, **limits: tuple[float, float]) -> Machine:
    """The machine with other limits of its rotary axes, degrees."""
    axes = tuple(
        replace(axis, low=limits[axis.name][0], high=limits[axis.name][1], endless=False)
        if axis.name in limits
        else axis
        for axis in machine.axes
    )
    return replace(machine, axes=axes)


def directions(tilt: Floats, azimuth: Floats) -> Floats:
    """(n, 3) tool axes at a tilt from Z and an azimuth about it, degrees."""
    t, a = np.radians(tilt), np.radians(azimuth)
    return np.column_stack((np.sin(t) * np.cos(a), np.sin(t) * np.sin(a), np.cos(t)))


def winding(tilt: float, first: float, last: float, n: int = 400) -> Moves:
    """A cut whose tool axis turns about Z from one azimuth to another."""
    return moves_of(np.zeros((n, 3)), directions(np.full(n, tilt), np.linspace(first, last, n)))


BC = load_machine("generic_head_table_bc")
CA = load_machine("generic_head_head_ca")


@st.composite
def short_paths(draw: st.DrawFn, rows: int = 6) -> Moves:
    """A few rows, smooth or rough, often near the pole or at it, some of them rapids."""
    n = draw(st.integers(1, rows))
    rough = draw(st.booleans())
    tilts = st.sampled_from([0.0, 0.3, 3.0, 12.0]) | st.floats(0.0, 80.0)
    if rough:
        tilt = np.array([draw(tilts) for _ in range(n)])
        azimuth = np.array([draw(st.floats(-180.0, 180.0)) for _ in range(n)])
    else:
        tilt = np.linspace(draw(tilts), draw(tilts), n)
        azimuth = draw(st.floats(-180.0, 180.0)) + np.linspace(0.0, draw(st.floats(-500.0, 500.0)), n)
    moves = moves_of(np.zeros((n, 3)), directions(tilt, azimuth))
    return rapids_at(moves, [row for row in range(n) if draw(st.integers(0, 3)) == 0])


@st.composite
def smooth_paths(draw: st.DrawFn, most: float = 80.0) -> Moves:
    """A path whose tool axis turns evenly through a few directions, with some rapids."""
    corners = draw(st.integers(1, 4))
    n = draw(st.integers(2, 80))
    at = np.linspace(0.0, corners, n)
    tilt = np.interp(at, range(corners + 1), [draw(st.floats(0.0, most)) for _ in range(corners + 1)])
    azimuth = np.interp(at, range(corners + 1), [draw(st.floats(-720.0, 720.0)) for _ in range(corners + 1)])
    tips = np.column_stack((np.linspace(-40.0, 40.0, n), np.zeros(n), np.linspace(0.0, 5.0, n)))
    moves = moves_of(tips, directions(tilt, azimuth))
    return rapids_at(moves, [0, *draw(st.lists(st.integers(0, n - 1), max_size=3))])
