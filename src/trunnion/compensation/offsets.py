"""The path of a tool's centre beside a programmed path.

In:     a path in a plane, how far beside it the centre goes, and how the control does so.
Out:    the path of the centre, element by element, with what the control inserts at corners; where no tool fits.
Units:  mm, radians.

Inner corners end where both equidistants meet. The first element is the line on which compensation begins, the last
may be the one on which it ends.
"""

from dataclasses import replace
from enum import StrEnum
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.compensation.plane_path import PlanePath, Points, meetings
from trunnion.compensation.styles import CompensationStyle, Corner, Entry
from trunnion.records import dataclass

#: A path that turns round by less than this short of half a turn goes back where it came from, radians.
_ROUNDING: Final = 1e-6

#: An element may be run backwards by so much, mm: what is lost in rounding.
_BACK: Final = 1e-3


class Fault(StrEnum):
    """Why a control stops with an alarm, or cuts what it should not."""

    TIGHT = "tight"
    ON_CIRCLE = "on_circle"
    SHORT_ENTRY = "short_entry"
    NO_CONTOUR = "no_contour"
    UNSURE = "unsure"


@dataclass(frozen=True, slots=True, eq=False)
class CentrePath:
    """The path of the centre: elements of the programmed path and what was inserted before them, in order.

    path    (k,) elements
    of      (k,) int64: the programmed element to which each belongs
    own     (k,) bool: it is that element itself, and not inserted before it
    faults  programmed elements, each with what is wrong there, in their order
    """

    path: PlanePath
    of: Ints
    own: Flags
    faults: tuple[tuple[int, Fault], ...] = ()


@dataclass(frozen=True, slots=True, eq=False)
class _Joints:
    """Between each element and the next, (m - 1,): the end of the one, the begin of the other, and what is between.

    corners  (m - 1, 2): points between both on lines; NaN for none
    rounded  both are joined by a circle about the corner
    """

    ends: Points
    begins: Points
    corners: Points
    rounded: Flags


def centre_path(path: PlanePath, left: float, style: CompensationStyle, *, leaves: bool) -> CentrePath:
    """Return the path of the centre ``left`` mm to the left of a path (right: negative).

    leaves  the last element is the line on which compensation ends
    """
    count = len(path)
    bounds = [0, *([count - 1] if leaves and count > 1 else [])]
    faults = [(k, Fault.ON_CIRCLE) for k in bounds if path.sense[k]]
    if count - len(bounds) < 1:
        faults.append((0, Fault.NO_CONTOUR))
    if faults:
        return _unchanged(path, faults)
    if style.entry is Entry.OWN and abs(path.end[0] - path.start[0]) <= abs(left):
        faults.append((0, Fault.SHORT_ENTRY))
    beside = _beside(path, left)
    joints = _with_bounds(path, _joints(path, beside, left, style), left, style, leaves=leaves)
    faults += _misfits(path, beside, joints, left, bounds)
    if style.corner is Corner.MEET:
        curved = (path.sense[:-1] != 0) | (path.sense[1:] != 0)
        faults += [(int(k), Fault.UNSURE) for k in np.flatnonzero(joints.rounded & curved)]
    lost = np.isnan(joints.ends)  # a fault, at which the tool is taken to stay beside the element that ends there
    nearest = np.where(lost, beside.end[:-1], joints.ends), np.where(lost, beside.end[:-1], joints.begins)
    joints = _Joints(*nearest, joints.corners, joints.rounded)
    end_point = path.end[-1] if leaves else beside.end[-1]
    return _assembled(path, joints, left, end_point, sorted(faults, key=lambda fault: fault[0]))


def _unchanged(path: PlanePath, faults: list[tuple[int, Fault]]) -> CentrePath:
    rows = np.arange(len(path))
    return CentrePath(path, rows, np.ones(len(path), np.bool_), tuple(faults))


def _beside(path: PlanePath, left: float) -> PlanePath:
    """Return each element beside itself, without regard to its neighbours."""
    begin, end = path.directions()
    return replace(path, start=path.start + 1j * left * begin, end=path.end + 1j * left * end)


def _joints(path: PlanePath, beside: PlanePath, left: float, style: CompensationStyle) -> _Joints:
    begin, end = path.directions()
    turn = np.angle(begin[1:] * np.conj(end[:-1]))
    ends, begins = beside.end[:-1].copy(), beside.start[1:].copy()
    smooth = np.abs(turn) <= style.smooth
    # A path that goes back where it came from is rounded on the side of the tool.
    outer = ~smooth & ((turn * left < 0.0) | (np.abs(turn) >= np.pi - _ROUNDING))
    inner = ~smooth & ~outer & (left != 0.0)
    begins[smooth] = ends[smooth]
    met = meetings(_part(beside, slice(None, -1)), _part(beside, slice(1, None)))
    ends[inner] = begins[inner] = met[inner]
    corners = np.full((len(turn), 2), complex(np.nan, np.nan))
    rounded = outer & (left != 0.0)
    if style.corner is not Corner.ARC:
        meet = rounded & (np.abs(turn) <= style.sharpest + _ROUNDING)
        straight = (path.sense[:-1] == 0) & (path.sense[1:] == 0)
        if style.corner is Corner.MEET:
            meet &= straight
        along = abs(left) * np.tan(0.5 * np.abs(turn[meet]))
        corners[meet, 0] = ends[meet] + along * end[:-1][meet]
        rounded &= ~meet
        if style.corner is Corner.CHAMFER:
            corners[rounded, 0] = ends[rounded] + abs(left) * end[:-1][rounded]
            corners[rounded, 1] = begins[rounded] - abs(left) * begin[1:][rounded]
            rounded = np.zeros_like(rounded)
    return _Joints(ends, begins, corners, rounded)


def _part(path: PlanePath, part: slice) -> PlanePath:
    return PlanePath(path.start[part], path.end[part], path.centre[part], path.sense[part])


def _with_bounds(path: PlanePath, joints: _Joints, left: float, style: CompensationStyle, *, leaves: bool) -> _Joints:
    """Return the joints with those behind the first line and before the last one as the control makes them."""
    begin, end = path.directions()
    ends, begins, corners = joints.ends.copy(), joints.begins.copy(), joints.corners.copy()
    rounded = joints.rounded.copy()
    if style.entry is Entry.SQUARE:
        ends[0] = begins[0] = path.start[1] + 1j * left * begin[1]
        corners[0], rounded[0] = np.nan, False
    if leaves:
        ends[-1] = begins[-1] = path.end[-2] + 1j * left * end[-2]
        corners[-1], rounded[-1] = np.nan, False
    return _Joints(ends, begins, corners, rounded)


def _misfits(
    path: PlanePath, beside: PlanePath, joints: _Joints, left: float, bounds: list[int]
) -> list[tuple[int, Fault]]:
    """Return elements along which the centre cannot go: circles smaller than the tool, and ways that turn round."""
    starts, ends = np.append(beside.start[0], joints.begins), np.append(joints.ends, beside.end[-1])
    begin, _ = path.directions()
    lost = np.isnan(starts) | np.isnan(ends)
    with np.errstate(invalid="ignore"):
        backwards = ((ends - starts) * np.conj(begin)).real < -_BACK
        tight = (path.sense != 0) & (path.radius - path.sense * left < _BACK)
        cut = _angle_cut(path, starts, path.start) - _angle_cut(path, ends, path.end)
        over = (path.sense != 0) & (cut > path.swept() + _BACK / np.maximum(path.radius, _BACK))
    bad = lost | np.where(path.sense == 0, backwards, tight | over)
    bad[bounds] = lost[bounds]
    return [(int(k), Fault.TIGHT) for k in np.flatnonzero(bad)]


def _angle_cut(path: PlanePath, point: Points, own: Points) -> Floats:
    """Return how far points lie behind those of their circles, along them, radians."""
    return np.asarray(path.sense * np.angle((point - path.centre) * np.conj(own - path.centre)))


def _assembled(
    path: PlanePath, joints: _Joints, left: float, end_point: complex, faults: list[tuple[int, Fault]]
) -> CentrePath:
    """Put the elements and what is inserted before them one behind the other; ``end_point`` is that of the last."""
    count = len(path)
    has = np.concatenate((np.zeros((1, 2), np.bool_), ~np.isnan(joints.corners)))
    linked = has.any(axis=1)
    arc = np.append(False, joints.rounded)
    # Inserted before each element: lines over the corners and on to its begin, or a circle.
    inserted = has.sum(axis=1) + linked + arc
    of = np.repeat(np.arange(count), inserted + 1)
    last = np.cumsum(inserted + 1) - 1
    own = np.zeros(len(of), np.bool_)
    own[last] = True
    end, centre, sense = np.zeros(len(of), complex), np.zeros(len(of), complex), np.zeros(len(of), np.int64)
    end[last] = np.append(joints.ends, end_point)
    centre[last], sense[last] = path.centre, path.sense
    begins = np.append(path.start[0], joints.begins)
    at = last[inserted > 0] - 1
    end[at] = begins[inserted > 0]
    for k in (1, 0):
        rows = np.flatnonzero(has[:, k])
        end[last[rows] - inserted[rows] + k] = joints.corners[rows - 1, k]
    round_at = last[arc] - 1
    # An outer corner turns away from the tool.
    centre[round_at], sense[round_at] = path.start[arc], -int(np.sign(left))
    start = np.append(path.start[0], end[:-1])
    return CentrePath(PlanePath(start, end, centre, sense), of, own, tuple(faults))
