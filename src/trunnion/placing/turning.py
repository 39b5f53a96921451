"""What a turn of the part about Z does to the slides: nothing new where a rotary axis about Z turns with it.

    TABLE  the first rotary axis is parallel to Z and carries the part, below all slides: it turns with the part, and
           the slides stand as before if the zero turns about it too
    HEAD   it is parallel to Z and carries the tool, above all slides: each slide position turns about Z
    OTHER  it is not: each turn is a path of its own

Rows at the pole are the exception, as long as their stretch has not left it: the first rotary axis stands where it
stood before, however the part is turned.
"""

from enum import Enum, auto
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints, distinct
from trunnion.extras import import_extra
from trunnion.machines import Machine, kinematic_parameters
from trunnion.machines.machine import Axis
from trunnion.placing.axis_equations import AxisEquations
from trunnion.placing.path_rows import PathRows

#: Sine of the angle within which an axis is parallel to Z.
_PARALLEL: Final = 1e-12

#: Points of which hulls are worth their time.
_FEW: Final = 64


class Turning(Enum):
    """How a machine takes a turn of the part."""

    TABLE = auto()
    HEAD = auto()
    OTHER = auto()


def turning_of(machine: Machine) -> Turning:
    """How a machine takes a turn of the part about Z."""
    if not is_upright(machine.axes[machine.rotary[0]]):
        return Turning.OTHER
    below = kinematic_parameters(machine).rotary_below
    if min(below) >= 1:
        return Turning.TABLE
    return Turning.HEAD if max(below) == 0 else Turning.OTHER


def is_upright(axis: Axis) -> bool:
    """Whether an axis is parallel to Z."""
    x, y, _ = axis.direction
    return bool(np.hypot(x, y) <= _PARALLEL)


def reaches_any_turn(machine: Machine) -> bool:
    """Whether the first rotary axis has some position for every angle."""
    axis = machine.axes[machine.rotary[0]]
    return bool(axis.endless or axis.high - axis.low >= 360.0)


def rows_that_stand(rows: PathRows, held: Flags) -> Flags:
    """Return the rows that must be looked at for each turn, (n,) bool: of those held at the pole, hulls of their tips.

    The first row after them is among them, for the way to it.
    """
    keep = np.zeros(len(rows), np.bool_)
    if not held.any():
        return keep
    keep[rows.arc_row] = held[rows.arc_row]
    ends = held & ~np.append(held[1:], False)
    keep |= ends
    leaves = np.flatnonzero(ends[:-1] & ~rows.begins[1:])
    keep[leaves + 1] = True
    firsts = [stretch.first for stretch in rows.stretches]
    for first, end in zip(firsts, [*firsts[1:], len(rows)], strict=True):
        inside = first + np.flatnonzero(held[first:end])
        length = rows.length_at(inside)
        for own in [None] if length is None else distinct(length).tolist():
            like = inside if own is None or length is None else inside[_is_like(length, own)]
            keep[like[hull_points(rows.tip[like])]] = True
    return keep


def _is_like(length: Floats, own: float) -> Flags:
    return np.asarray(np.isnan(length) if np.isnan(own) else length == own)


def hull_points(points: Floats) -> Ints:
    """Numbers of points (k, 3) among which are the farthest in every direction."""
    every = np.arange(len(points))
    if len(points) <= _FEW:
        return every
    scipy_spatial = import_extra("scipy.spatial", "place")
    try:
        return np.asarray(scipy_spatial.ConvexHull(points).vertices, np.int64)
    except scipy_spatial.QhullError:  # flat, or a line
        return _flat_hull(points)


def _flat_hull(points: Floats) -> Ints:
    """Return the same for points of a plane or a line."""
    scipy_spatial = import_extra("scipy.spatial", "place")
    middle = points.mean(axis=0)
    plane = np.linalg.svd(points - middle, full_matrices=False)[2]
    flat = (points - middle) @ plane.T
    if np.ptp(flat[:, 2]) > 1e-9:  # nearly flat: all of them
        return np.arange(len(points))
    try:
        return np.asarray(scipy_spatial.ConvexHull(flat[:, :2]).vertices, np.int64)
    except scipy_spatial.QhullError:
        return np.array([np.argmin(flat[:, 0]), np.argmax(flat[:, 0])])


def turned_head(forms: AxisEquations, turn: Floats, pivot: Floats) -> AxisEquations:
    """Return the slides of a head that turns with the part, at a turn (3, 3), for a first rotary axis at ``pivot`` (3,)
    mm.

    All normals are the same matrix M, so that offsets o are those of a point v with o = M (v - pivot): v turns.
    """
    matrix = forms.normals[0]
    points = np.linalg.solve(matrix, forms.offsets.T).T + pivot
    offsets = (points @ turn.T - pivot) @ matrix.T
    return AxisEquations(forms.normals, np.ascontiguousarray(offsets), forms.row)


def outermost(forms: AxisEquations) -> AxisEquations:
    """Of forms with one normal for each slide those that count at any turn."""
    keep = np.sort(hull_points(np.linalg.solve(forms.normals[0], forms.offsets.T).T))
    return AxisEquations(forms.normals[keep], forms.offsets[keep], forms.row[keep])
