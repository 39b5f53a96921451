"""Legs divided into the fewest spans: each span as long as the tolerances allow, as its error grows with its length.

Where the first rotary axis must turn while the tool axis is in its pole, no point between helps. There the turn is cut
into pieces at rest.
"""

import math
from typing import Final, NamedTuple

import numpy as np

from trunnion.arrays import Flags, Floats, Floats2, Ints
from trunnion.jit import inner, kernel
from trunnion.machines import KinematicParameters
from trunnion.machines.forward import KinematicChain
from trunnion.machines.inverse import Pair
from trunnion.planning.linearization.leg_error import (
    Leg,
    angle_between,
    axis_on_leg,
    axis_values,
    axis_values_on_leg,
    branch_of,
    in_place_error,
    is_surely_within,
    span_error,
)

#: A span shorter than this part of its leg is a turn in place.
_SHORTEST_PART: Final = 1e-7

#: A step is long enough if its error is this share of the tolerances, and it is looked for so many times.
_LONG_ENOUGH: Final = 0.96
_MAX_TRIES: Final = 24

#: The most pieces into which a turn in place is cut.
_MAX_PIECES: Final = 100_000


class PathRows(NamedTuple):
    """Rows of a path.

    tip     (n, 3) float64  mm, workpiece frame
    axis    (n, 3) float64  unit vectors, workpiece frame
    rotary  (n, 2) float64  as they wind, degrees
    """

    tip: Floats2
    axis: Floats2
    rotary: Floats2


@kernel(writes="copies added")
def divide_rows(
    chain: KinematicChain,
    kinematics: KinematicParameters,
    tolerances: Pair,
    rows: PathRows,
    divisible: Flags,
    first: int,
    count: int,
    copies: Ints,
    added: PathRows,
) -> tuple[int, int]:
    """Divide the legs to the divisible rows from ``first`` on.

    tolerances  of the tip, mm, and of the tool axis, rad
    count       rows that have been added so far
    copies      (n,) becomes the number of rows that stand for each row
    added       takes the new rows

    Returns the row before which there was no more space in ``added``, or n, and the number of added rows.
    """
    begin, end, here, work = np.empty(5), np.empty(5), np.empty(5), np.empty((4, 5))
    tips, axes = np.empty((2, 3)), np.empty((2, 3))
    placed = -1
    for row in range(max(first, 1), rows.tip.shape[0]):
        if not divisible[row]:
            continue
        if placed == row - 1:
            _copy(end, begin)
        else:
            axis_values(kinematics, rows.tip[row - 1], rows.rotary[row - 1], begin)
        axis_values(kinematics, rows.tip[row], rows.rotary[row], end)
        placed = row
        if is_surely_within(chain, kinematics, tolerances, begin, end):
            continue
        for side in range(2):
            _copy(rows.tip[row - 1 + side], tips[side])
            _copy(rows.axis[row - 1 + side], axes[side])
        leg = Leg(tips, axes, angle_between(axes[0], axes[1]))
        branch = _leg_branch(kinematics, rows.rotary[row - 1, 1], rows.rotary[row, 1])
        total = _divide_leg(chain, kinematics, tolerances, leg, branch, begin, end, count, added, here, work)
        if total < 0:
            return row, count
        copies[row] = 1 + total - count
        count = total
    return rows.tip.shape[0], count


@inner
def _copy(source: Floats, target: Floats) -> None:
    """Write the values of one array into another: ``target[:] = source`` takes seconds to compile at each place."""
    for k in range(len(target)):
        target[k] = source[k]


@inner
def _leg_branch(kinematics: KinematicParameters, second_before: float, second: float) -> int:
    """Return the branch of a leg between these second angles, degrees; -1 if it has none of its own.

    From a pole on it is the branch of the end.
    """
    branch, other = branch_of(kinematics, second_before), branch_of(kinematics, second)
    if branch < 0:
        return other
    return -1 if other >= 0 and branch != other else branch


@inner
def _divide_leg(
    chain: KinematicChain,
    kinematics: KinematicParameters,
    tolerances: Pair,
    leg: Leg,
    branch: int,
    begin: Floats,
    end: Floats,
    count: int,
    added: PathRows,
    here: Floats,
    work: Floats2,
) -> int:
    """Add the rows of one leg behind ``count`` others; return how many there are then, -1 without enough space.

    begin, end  (5,) axis values at both ends; ``begin`` moves along
    here, work  (5,) and (4, 5) for the work
    """
    done, step = 0.0, 0.0
    while done < 1.0:
        error = span_error(chain, kinematics, tolerances, leg, begin, end, done, 1.0, work)
        if error <= 1.0:
            break
        if step == 0.0 or step >= 1.0 - done:
            step = (1.0 - done) * math.sqrt(_LONG_ENOUGH / error)
        step = _longest_step(chain, kinematics, tolerances, leg, branch, begin, end, done, step, here, work)
        pieces = 1
        if step == 0.0:  # only a turn in place is left: over it, and on
            part = done + min(_SHORTEST_PART, 1.0 - done)
            _copy(end, here)
            if part < 1.0:
                axis_values_on_leg(kinematics, leg, part, branch, begin, end, here, work[0])
            pieces = _pieces_in_place(chain, kinematics, tolerances, leg, begin, here, part, work)
            done = part
        done += step
        is_end = done >= 1.0
        new = pieces - 1 if is_end else pieces  # the end of the leg is a row already
        if count + new > added.tip.shape[0]:
            return -1
        for piece in range(1, new + 1):
            _write_row(kinematics, leg, done, begin, here, piece / pieces, added, count)
            count += 1
        _copy(here, begin)
    return count


@inner
def _write_row(
    kinematics: KinematicParameters,
    leg: Leg,
    done: float,
    begin: Floats,
    end: Floats,
    share: float,
    added: PathRows,
    at: int,
) -> None:
    """Write row ``at``: the place at ``done``, with the rotary axes at a ``share`` between two positions.

    A turn in place at an end of the leg is exactly at that end.
    """
    done = 0.0 if done < 2.0 * _SHORTEST_PART else 1.0 if done > 1.0 - 2.0 * _SHORTEST_PART else done
    tips = leg.tips
    for k in range(3):
        added.tip[at, k] = tips[0, k] + done * (tips[1, k] - tips[0, k])
    axis_on_leg(leg, done, added.axis[at])
    for k in range(2):
        column = kinematics.columns[k]
        added.rotary[at, k] = begin[column] + share * (end[column] - begin[column])


@inner
def _longest_step(
    chain: KinematicChain,
    kinematics: KinematicParameters,
    tolerances: Pair,
    leg: Leg,
    branch: int,
    begin: Floats,
    end: Floats,
    done: float,
    guess: float,
    here: Floats,
    work: Floats2,
) -> float:
    """Return the longest step from ``done`` on that keeps the tolerances, as a part of the leg; 0.0 if none does.

    ``here`` becomes its end. The error of a span grows nearly with the square of its length, which gives the next try,
    between the longest step that keeps the tolerances and the shortest one that does not.
    """
    low, high, step = 0.0, 1.0 - done, guess
    for tries in range(_MAX_TRIES):
        if low == 0.0 and high < _SHORTEST_PART:
            return 0.0
        axis_values_on_leg(kinematics, leg, done + step, branch, begin, end, here, work[0])
        error = span_error(chain, kinematics, tolerances, leg, begin, here, done, done + step, work)
        if error > 1.0:
            high = step
        else:
            low = step
            if error >= _LONG_ENOUGH or high - low < 1e-3 * low:
                return low
        by_square = step * math.sqrt(0.5 * (1.0 + _LONG_ENOUGH) / max(error, 1e-9))
        if low == 0.0:
            step = max(by_square, 0.1 * high) if tries < _MAX_TRIES // 4 else 0.1 * high
        elif low < by_square < high:
            step = by_square
        else:
            step = 0.5 * (low + high)
    if low > 0.0:
        axis_values_on_leg(kinematics, leg, done + low, branch, begin, end, here, work[0])
    return low


@inner
def _pieces_in_place(
    chain: KinematicChain,
    kinematics: KinematicParameters,
    tolerances: Pair,
    leg: Leg,
    begin: Floats,
    end: Floats,
    part: float,
    work: Floats2,
) -> int:
    """Return the number of pieces into which a turn in place is cut."""
    joints, tip, rotary = np.empty(5), np.empty(3), np.empty(2)
    for k in range(3):
        tip[k] = leg.tips[0, k] + part * (leg.tips[1, k] - leg.tips[0, k])
    pieces = 1.0
    while pieces < _MAX_PIECES:
        for k in range(2):
            column = kinematics.columns[k]
            rotary[k] = begin[column] + (end[column] - begin[column]) / pieces
        axis_values(kinematics, tip, rotary, joints)
        error = in_place_error(chain, tolerances, leg, begin, joints, part, work)
        if not error > 1.0:
            break
        # The error of a piece shrinks with the square of its length.
        pieces = math.ceil(pieces * min(max(math.sqrt(error), 1.02), 8.0))
    return int(pieces)
