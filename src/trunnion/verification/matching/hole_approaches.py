"""Motions from hole to hole: rapids that only lead to a hole, and how high the tip stays on its way."""

from collections.abc import Sequence

import numpy as np

from trunnion.model.programmed_words import POSITION_WORDS
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind
from trunnion.verification.expected.holes import Hole
from trunnion.verification.kinematics.positioning_moves import approach_rows
from trunnion.verification.matching.hole_matching import MatchedHole

#: A motion is along the tool axis, or across it, when it is off by less than this, mm.
_STRAIGHT = 1e-6

#: With TCP, points and axes of the CL file are rounded each by itself, to four decimals: the same, mm, and by this
#: share of the height above the hole.
_STRAIGHT_TCP, _STRAIGHT_TCP_SHARE = 2e-4, 1e-4

#: Tool axes are the same when no component differs by more than this.
_SAME_AXIS = 1e-6

#: The direction between two rounded points is off by so many times the tolerance of a coordinate.
_BOTH_ENDS = 2.0 * 3.0**0.5

#: Legs that may be made in pieces, so many, each of whose ends is off the straight line by less than this, mm.
_STRAIGHT_LEGS, _MOST_PIECES, _ON_THE_WAY = ("up", "down", "across"), 8, 2e-3

#: Legs before which there may be another one.
_LEGS_WITH_MORE = ("down", "across", "turned", "nowhere")


def hole_approach_rows(run: Run, extra: Sequence[int], holes: Sequence[MatchedHole], tip_tolerance: float) -> set[int]:
    """Which of the motions without a CL point only lead to a hole.

    They are rapids right before the motion to the hole: straight up along the tool axis from where the tool was, over
    the hole at that height, and straight down; or, from home or while the tool turns, over the hole itself. A straight
    leg may be made in pieces.

    extra          rows without a CL point
    tip_tolerance  how far each coordinate of motions that belong to no cycle may be off, mm
    """
    approaches, candidates = set(approach_rows(run).tolist()), set(extra)
    found = set()
    for hole in holes:
        if hole.shares_first_row:
            continue
        row = hole.first - 1
        if hole.by_motion:  # which the last leg leads to, if it is not straight down
            pieces = _pieces(run, hole.first, candidates, approaches)
            found.update(pieces)
            row -= len(pieces)
        rounding = _BOTH_ENDS * tip_tolerance if hole.by_motion else 0.0
        while row > 0 and row in candidates and run.kind[row] == Kind.RAPID:
            leg = _approach_leg(run, row, hole, approaches, rounding)
            if leg:
                found.add(row)
            pieces = _pieces(run, row, candidates, approaches) if leg in _STRAIGHT_LEGS else []
            found.update(pieces)
            if leg not in _LEGS_WITH_MORE:
                break
            row -= len(pieces) + 1
    return found


def _pieces(run: Run, row: int, candidates: set[int], approaches: set[int]) -> list[int]:
    """Rows right before one that goes on straight from them."""
    found = list[int]()
    while row - len(found) - 1 in candidates and len(found) < _MOST_PIECES:
        if not _is_on_the_way(run, row, len(found) + 1, approaches):
            break
        found.append(row - len(found) - 1)
    return found


def _is_on_the_way(run: Run, row: int, pieces: int, approaches: set[int]) -> bool:
    """Whether a row and the ``pieces`` right before it are rapids along one straight line."""
    first = row - pieces
    rows = np.arange(first - 1, row + 1)
    if first < 1 or (run.kind[rows[1:]] != Kind.RAPID).any() or _comes_from_home(run, first, approaches):
        return False
    if any(event.kind in ("retract", "tool_change") and first <= event.before_row <= row for event in run.events):
        return False
    positions = run.positions(rows)
    way = positions.tip[-1] - positions.tip[0]
    length = float(np.linalg.norm(way))
    if length < _STRAIGHT or np.abs(positions.axis - positions.axis[0]).max() > _SAME_AXIS:
        return False
    along = (positions.tip - positions.tip[0]) @ way / length
    aside = positions.tip - positions.tip[0] - along[:, None] * way / length
    return bool((np.diff(along) > 0.0).all() and np.abs(aside).max() < _ON_THE_WAY)


def _comes_from_home(run: Run, row: int, approaches: set[int]) -> bool:
    """Whether nothing says where in the workpiece a row begins."""
    return (
        row - 1 in approaches
        or bool(run.state.machine_frame[row - 1])
        or (int(run.programmed[row - 1]) & int(POSITION_WORDS)) == 0
    )


def _approach_leg(run: Run, row: int, hole: MatchedHole, approaches: set[int], rounding: float) -> str:
    """Which leg of the approach to a hole a rapid is; empty if none. ``rounding`` is that of directions, mm."""
    positions = run.positions(np.array([row - 1, row, hole.first]))
    step, rest, axis = positions.tip[1] - positions.tip[0], positions.tip[2] - positions.tip[1], positions.axis[1]
    up, left = float(step @ axis), float(rest @ axis)
    near, share = (_STRAIGHT_TCP, _STRAIGHT_TCP_SHARE) if run.state.tcp[row] else (_STRAIGHT, 0.0)
    near, level = max(near, rounding), max(_STRAIGHT, rounding)
    straight = float(np.linalg.norm(step - up * axis)) < near + share * (abs(up) + abs(left))
    over_hole = float(np.linalg.norm(rest - left * axis)) < near + share * abs(left) and left < near
    from_home = _comes_from_home(run, row, approaches)
    turned = float(np.abs(positions.axis[0] - axis).max()) > _SAME_AXIS
    if float(np.abs(step).max()) < near and not turned:
        return "nowhere"  # a program that goes on in another file repeats the position of the tool
    if straight and up > 0.0:
        return "up"
    if from_home and (float(np.abs(rest).max()) < level or (hole.by_motion and over_hole)):
        return "from home"
    if straight and over_hole:
        return "down"
    if over_hole and turned:
        return "turned"
    return "across" if over_hole and abs(up) < level else ""


def clearance_between_holes(
    run: Run, first: Hole, first_match: MatchedHole, second: Hole, second_match: MatchedHole
) -> float | None:
    """How high the tip stays between two holes along different axes while the tool turns under TCP, mm.

    At each position the height counts from the clearance height of that hole over which the tip is higher; the result
    is the lowest of these. None if the tool does not turn between the holes.
    """
    rows = np.arange(first_match.end, second_match.first + 1)
    turns = float(np.abs(first.axis - second.axis).max()) > _SAME_AXIS
    if not turns or not len(rows) or not run.state.tcp.at(rows).all():
        return None
    tips = run.positions(np.concatenate(([first_match.end - 1], rows))).tip
    heights = np.stack([(tips - hole.tip) @ hole.axis - hole.cycle.clearance for hole in (first, second)])
    lowest = float(heights.max(axis=0).min())
    apart = heights[0] - heights[1]
    for k in np.flatnonzero(apart[:-1] * apart[1:] < 0.0).tolist():  # in between it is as high over both
        part = apart[k] / (apart[k] - apart[k + 1])
        lowest = min(lowest, float(heights[0, k] + part * (heights[0, k + 1] - heights[0, k])))
    return lowest
