"""Which of the possible axis positions the machine takes, row after row.

First version of the choice: of the two branches, and of the turns of each, the one nearest to the last position that
keeps every axis within its limits. At the pole the free angle stays as it was.
"""

from dataclasses import dataclass

import numpy as np
from numba import njit

from trunnion.arrays import Codes, Flags, Floats, Ints
from trunnion.machine import Machine, Packed, pack
from trunnion.machine.inverse import POLE, UNREACHABLE, branch_angles, place_slides, solve_tilt

#: A value beyond a limit by less than this, mm or degrees, prints as the limit and is put onto it.
LIMIT_TOLERANCE = 1e-5

#: What became of a row: nothing to say; 1 + index of the axis that is beyond its limit; or one of these.
FINE, TURNED_OVER, OUT_OF_REACH = 0, 100, 200


@dataclass(frozen=True, slots=True)
class Poses:
    """What ``follow`` found.

    rotary    (n, 2) float64  positions of the rotary axes as they display them, degrees
    outcome   (n,) uint8      as listed above
    beyond    (n,) float64    where an axis is beyond its limit: its value, mm or degrees; not written elsewhere
    extremes  (5, 2) float64  least and greatest value of every axis, mm or degrees
    where     (5, 2) int64    the rows where they are
    """

    rotary: Floats
    outcome: Codes
    beyond: Floats
    extremes: Floats
    where: Ints


@njit(cache=True)
def _nearest_turn(angle: float, last: float, low: float, high: float) -> float:
    """``angle`` plus the whole turns that bring it nearest to ``last`` within the limits, or nearest at all."""
    nearest: float = np.rint((last - angle) / 360.0)
    turns = nearest
    if np.isfinite(low) and np.isfinite(high):
        fewest = np.ceil((low - LIMIT_TOLERANCE - angle) / 360.0)
        most = np.floor((high + LIMIT_TOLERANCE - angle) / 360.0)
        if fewest <= most:
            turns = min(max(nearest, fewest), most)
    return angle + 360.0 * turns


@njit(cache=True)
def _follow(
    packed: Packed,
    rotary: Ints,
    low: Floats,
    high: Floats,
    display_low: Floats,
    tip: Floats,
    axis: Floats,
    start: Floats,
    found: Floats,
    outcome: Codes,
    excess: Floats,
    extremes: Floats,
    where: Ints,
) -> None:
    """Fill the columns of ``Poses`` row by row.

    rotary       (2,) int64     columns of the rotary axes, the one next to the workpiece first
    low, high    (5,) float64   limits, infinite where none is to be kept
    display_low  (5,) float64   lower end of the 360 degrees that an axis displays, NaN: as it is
    start        (2,) float64   rotary positions before the first row
    """
    first_column, second_column = rotary[0], rotary[1]
    candidate, joints = np.empty(5), np.empty(5)
    last_first, last_second = start[0], start[1]
    chosen, known = 0, False
    status, u0, u1, cos, sin = 0, 0.0, 0.0, 0.0, 0.0
    for row in range(tip.shape[0]):
        x, y, z = tip[row, 0], tip[row, 1], tip[row, 2]
        i, j, k = axis[row, 0], axis[row, 1], axis[row, 2]
        if row == 0 or i != axis[row - 1, 0] or j != axis[row - 1, 1] or k != axis[row - 1, 2]:
            status, u0, u1, cos, sin = solve_tilt(packed, i, j, k)
        if status & UNREACHABLE:
            outcome[row] = OUT_OF_REACH
            found[row, :] = np.nan
            continue
        best_cost, best_beyond, before = np.inf, 99, chosen
        for turn in range(2):
            branch = before if turn == 0 else 1 - before
            if turn == 1 and best_beyond == 0 and best_cost < np.degrees(sin):
                break  # the branches' second angles lie 2 phi apart, so the other one is farther away
            first, second, cos_1, sin_1, cos_2, sin_2 = branch_angles(
                packed, u0, u1, cos, sin if branch == 0 else -sin, status
            )
            if status & POLE:
                first = last_first
                cos_1, sin_1 = np.cos(np.radians(first)), packed.sense_1 * np.sin(np.radians(first))
            first = _nearest_turn(first, last_first, low[first_column], high[first_column])
            second = _nearest_turn(second, last_second, low[second_column], high[second_column])
            cost = abs(first - last_first) + abs(second - last_second)
            candidate[first_column], candidate[second_column] = first, second
            place_slides(packed, cos_1, sin_1, cos_2, sin_2, x, y, z, candidate)
            beyond, which = 0, 0
            for column in range(5):
                value = candidate[column]
                if value < low[column] - LIMIT_TOLERANCE or value > high[column] + LIMIT_TOLERANCE:
                    beyond += 1
                    which = column + 1
                elif value < low[column]:
                    candidate[column] = low[column]
                elif value > high[column]:
                    candidate[column] = high[column]
            if beyond < best_beyond or (beyond == best_beyond and cost < best_cost - 1e-9):
                best_cost, best_beyond, chosen = cost, beyond, branch
                joints[:] = candidate
                outcome[row] = which
        if outcome[row] == FINE and known and chosen != before and best_cost > 90.0:
            outcome[row] = TURNED_OVER
        known = not status & POLE
        if FINE < outcome[row] <= 5:
            excess[row] = joints[outcome[row] - 1]
        for column in range(5):
            if joints[column] < extremes[column, 0]:
                extremes[column, 0] = joints[column]
                where[column, 0] = row
            if joints[column] > extremes[column, 1]:
                extremes[column, 1] = joints[column]
                where[column, 1] = row
        last_first, last_second = joints[first_column], joints[second_column]
        for r in range(2):
            value, begin = joints[rotary[r]], display_low[rotary[r]]
            found[row, r] = value if np.isnan(begin) else value - 360.0 * np.floor((value - begin) / 360.0)


def follow(machine: Machine, tip: Floats, axis: Floats, keep_slides: bool) -> Poses:
    """Axis positions for every row, starting from the home position of the rotary axes.

    Parameters
    ----------
    machine
        Its limits are kept; those of the slides only with ``keep_slides``.
    tip : (n, 3) float64
        mm, workpiece frame.
    axis : (n, 3) float64
        Unit vectors, workpiece frame.
    """
    packed = pack(machine)
    rotary = np.array(machine.rotary, np.int64)
    low = np.array([a.low for a in machine.axes])
    high = np.array([a.high for a in machine.axes])
    if not keep_slides:
        slides = np.array(machine.linear)
        low[slides], high[slides] = -np.inf, np.inf
    display = np.array([a.display_low for a in machine.axes])
    start = np.array([machine.axes[c].home for c in rotary])
    poses = Poses(
        rotary=np.empty((len(tip), 2)),
        outcome=np.zeros(len(tip), np.uint8),
        beyond=np.empty(len(tip)),
        extremes=np.tile([np.inf, -np.inf], (5, 1)),
        where=np.zeros((5, 2), np.int64),
    )
    _follow(
        packed, rotary, low, high, display, tip, axis, start,
        poses.rotary, poses.outcome, poses.beyond, poses.extremes, poses.where,
    )  # fmt: skip
    return poses


def beyond_fit(machine: Machine, extremes: Floats) -> Flags:
    """(5,) bool: the slide needs more room than its whole travel has, wherever the workpiece may sit."""
    span = extremes[:, 1] - extremes[:, 0]
    travel = np.array([a.high - a.low for a in machine.axes])
    slides = np.zeros(5, bool)
    slides[list(machine.linear)] = True
    return np.asarray(slides & (span > travel + LIMIT_TOLERANCE))
