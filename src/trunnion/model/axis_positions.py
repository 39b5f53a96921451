"""Positions of the five axes from what blocks program.

In:     per row the tip or the slide positions, and a vector or rotary words, or neither, which keeps the angles.
Out:    rotary positions with all their turns, and with them five joints per row.
Units:  mm and degrees.

The turn rule of a row determines in which turn its rotary words end: the rule of the first rotary axis
in the low four bits, that of the second in the high four.
"""

import math
from functools import lru_cache
from typing import Final, NamedTuple

import numpy as np

from trunnion.arrays import Codes, Flags, Floats, Floats2, Floats3
from trunnion.jit import inner, kernel
from trunnion.machines import Machine, inverse
from trunnion.machines.inverse import KinematicParameters, solve_slides

#: Turn rule: the programmed number itself, as on an axis with end stops.
PLAIN: Final = 0
#: The shorter way, at most half a turn.
SHORTEST: Final = 1
#: In the positive direction only.
POSITIVE_DIRECTION: Final = 2
#: In the negative direction only.
NEGATIVE_DIRECTION: Final = 3
#: Within the turn in which the axis stands, as an endless axis takes absolute positions.
SAME_TURN: Final = 4

#: Status bits of a row: a rotary axis leaves its travel, no rotary position gives the vector (the angles stay), and no
#: position of the slides gives the tip.
OUT_OF_TRAVEL: Final = 1
NO_ROTARY_SOLUTION: Final = 2
NO_SLIDE_SOLUTION: Final = 4

#: How far beyond its travel a rotary axis may stand before a solution counts as outside, degrees.
TRAVEL_TOLERANCE: Final = 1e-6

#: Instead of a deciding axis: the rotation of both axes together decides between the two solutions for a vector.
TOTAL_ROTATION: Final = -1

#: Rotations that differ by no more than this are equal, degrees.
_EQUAL_ROTATION: Final = 1e-6


class RotaryWords(NamedTuple):
    """What n consecutive blocks program for the rotary axes.

    rotary     (n, 2) float64  values, deg, NaN where a block has none; replaced by the positions that they lead to
    turn_rule  (n,) uint8      see the module
    vector     (n, 3) float64  tool axes of any length, workpiece frame; NaN where a block has none
    """

    rotary: Floats
    turn_rule: Codes
    vector: Floats


def resolve_rotary(
    machine: Machine,
    kinematics: KinematicParameters,
    words: RotaryWords,
    start: Floats,
    tips: Floats | None,
    deciding_axis: int = TOTAL_ROTATION,
) -> Codes:
    """Replace the rotary values of consecutive rows by the positions that the axes take.

    words          rotary words and vectors; ``words.rotary`` is changed
    start          (2,) float64, deg: rotary positions before the first row
    tips           (n, 3) float64, mm: tool tips in the workpiece frame; None if linear axes are programmed
    deciding_axis  the rotary axis, 0 or 1, whose rotation decides between the two solutions for a vector. If it is
                   equal in both, the rotation of the other axis decides, then the solution nearer to 0.
                   ``TOTAL_ROTATION``: the sum of both

    (n,) uint8  bits OUT_OF_TRAVEL, NO_ROTARY_SOLUTION and NO_SLIDE_SOLUTION
    """
    status = np.zeros(len(words.rotary), np.uint8)
    resolve_angles(machine, words, start, status, deciding_axis)
    # The slides can only fail where a rotary axis turns one of them against another.
    if tips is not None and len(set(kinematics.rotary_below)) > 1:
        joints = joints_from_rows(machine, kinematics, np.ones(len(tips), np.bool_), tips, words.rotary)
        status[np.isnan(joints).any(axis=1)] |= NO_SLIDE_SOLUTION
    return status


def resolve_angles(
    machine: Machine, words: RotaryWords, start: Floats, status: Codes, deciding_axis: int = TOTAL_ROTATION
) -> None:
    """Replace ``words.rotary`` by positions, beginning at ``start`` (2,), and set bits of ``status`` (n,)."""
    columns = list(machine.rotary)
    axes = [machine.axes[column] for column in columns]
    turn_start = np.array([-180.0 if axis.output == "-180..180" else 0.0 for axis in axes])
    has_vector = ~np.isnan(words.vector[:, 0])
    if not has_vector.any():
        resolve_turns(words.rotary, words.turn_rule, start, turn_start)
        return
    n = len(words.rotary)
    solutions, pole = np.full((2, n, 2), np.nan), np.zeros(n, np.bool_)
    solved = inverse(machine, np.zeros((int(has_vector.sum()), 3)), words.vector[has_vector])
    solutions[:, has_vector] = solved.joints[:, :, columns]
    pole[has_vector] = solved.pole
    endless = np.array([axis.endless for axis in axes])
    travel = np.array([[axis.low, axis.high] for axis in axes])
    resolve_vectors(
        words.rotary, words.turn_rule, has_vector, solutions, pole, start, endless, travel, turn_start,
        deciding_axis, status,
    )  # fmt: skip


def joints_from_rows(
    machine: Machine, kinematics: KinematicParameters, xyz_is_tip: Flags, xyz: Floats, rotary: Floats
) -> Floats:
    """Return all five axis values, (n, 5), mm and degrees, in the order of ``machine.axes``.

    xyz_is_tip  (n,) bool     ``xyz`` is the tool tip in the workpiece frame, not the positions of the slides X, Y and Z
    xyz         (n, 3)        mm
    rotary      (n, 2)        positions with all their turns, degrees, in the order of ``machine.rotary``

    Slides that cannot bring the tip there are NaN.
    """
    joints = np.empty((len(xyz), 5))
    write_joints(kinematics, slide_columns(machine), machine.rotary, xyz_is_tip, xyz, rotary, joints)
    return joints


@lru_cache(maxsize=16)
def slide_columns(machine: Machine) -> tuple[int, int, int]:
    """Return the columns of the slides X, Y and Z."""
    return machine.column("X"), machine.column("Y"), machine.column("Z")


@kernel(writes="rotary")
def resolve_turns(rotary: Floats2, turn_rule: Codes, start: Floats, turn_start: Floats) -> None:
    """Replace the values of ``rotary`` (n, 2), NaN where none is programmed, by the positions that the axes take.

    All angles are in degrees, in the order of ``machine.rotary``.

    turn_rule   (n,) uint8    see the module
    start       (2,) float64  positions before the first row
    turn_start  (2,) float64  where the displayed turn of an axis begins, 0 or -180
    """
    a, b = start[0], start[1]
    for row in range(rotary.shape[0]):
        rule = int(turn_rule[row])
        a = rotary_position(a, rotary[row, 0], rule & 15, turn_start[0])
        b = rotary_position(b, rotary[row, 1], rule >> 4, turn_start[1])
        rotary[row, 0] = a
        rotary[row, 1] = b


@kernel(writes="rotary status")
def resolve_vectors(
    rotary: Floats2,
    turn_rule: Codes,
    has_vector: Flags,
    solutions: Floats3,
    pole: Flags,
    start: Floats,
    endless: Flags,
    travel: Floats2,
    turn_start: Floats,
    deciding_axis: int,
    status: Codes,
) -> None:
    """Do as ``resolve_turns``, with rows that program the tool axis as a vector.

    solutions   (2, n, 2) float64  both solutions of rows with a vector, in (-180, 180]
    pole        (n,) bool          the first angle is free: the axis stays
    start       (2,) float64       positions before the first row
    endless     (2,) bool
    travel      (2, 2) float64     lowest and highest value of each axis
    turn_start  (2,) float64       where the displayed turn of an axis begins, 0 or -180
    deciding_axis                  as in ``resolve_rotary``
    """
    a, b = start[0], start[1]
    for row in range(rotary.shape[0]):
        if not has_vector[row]:
            rule = int(turn_rule[row])
            a = rotary_position(a, rotary[row, 0], rule & 15, turn_start[0])
            b = rotary_position(b, rotary[row, 1], rule >> 4, turn_start[1])
        else:
            found = False
            best_a, best_b = a, b
            in_travel = False
            for branch in range(2):
                p, q = solutions[branch, row, 0], solutions[branch, row, 1]
                if math.isnan(q):
                    continue
                p = a if pole[row] else nearest_turn(a, p, endless[0], travel[0, 0], travel[0, 1])
                q = nearest_turn(b, q, endless[1], travel[1, 0], travel[1, 1])
                fits = (
                    travel[0, 0] - TRAVEL_TOLERANCE <= p <= travel[0, 1] + TRAVEL_TOLERANCE
                    and travel[1, 0] - TRAVEL_TOLERANCE <= q <= travel[1, 1] + TRAVEL_TOLERANCE
                )
                if (
                    not found
                    or (fits and not in_travel)
                    or (fits == in_travel and preferred(p, q, best_a, best_b, a, b, deciding_axis))
                ):
                    best_a, best_b, in_travel, found = p, q, fits, True
            if not found:
                status[row] |= NO_ROTARY_SOLUTION
            elif not in_travel:
                status[row] |= OUT_OF_TRAVEL
            a, b = best_a, best_b
        rotary[row, 0] = a
        rotary[row, 1] = b


@inner
def preferred(p: float, q: float, best_a: float, best_b: float, a: float, b: float, deciding_axis: int) -> bool:
    """Whether a control whose axes stand at ``a``, ``b`` moves to ``p``, ``q`` rather than ``best_a``, ``best_b``."""
    if deciding_axis == TOTAL_ROTATION:
        return abs(p - a) + abs(q - b) < abs(best_a - a) + abs(best_b - b) - 1e-9
    if deciding_axis == 1:
        p, q, best_a, best_b, a, b = q, p, best_b, best_a, b, a
    for difference in (
        abs(p - a) - abs(best_a - a),
        abs(q - b) - abs(best_b - b),
        from_whole_turn(p) - from_whole_turn(best_a),
        from_whole_turn(q) - from_whole_turn(best_b),
    ):
        if abs(difference) > _EQUAL_ROTATION:
            return difference < 0.0
    return False


@inner
def from_whole_turn(angle: float) -> float:
    """Return the distance of an angle from the nearest whole turn, degrees."""
    return abs(angle - 360.0 * math.floor(angle / 360.0 + 0.5))


@inner
def rotary_position(current: float, value: float, turn_rule: int, turn_start: float) -> float:
    """Return where a rotary axis at ``current`` goes for a word with ``value`` (NaN: no word), degrees."""
    if math.isnan(value):
        return current
    if turn_rule == PLAIN:
        return value
    if turn_rule == SAME_TURN:
        in_first_turn = value - 360.0 * math.floor((value - turn_start) / 360.0)
        return in_first_turn + 360.0 * math.floor((current - turn_start) / 360.0)
    # Whole turns are added to the programmed number, so that the position has its digits.
    turns = (current - value) / 360.0
    if turn_rule == POSITIVE_DIRECTION:
        return value + 360.0 * math.ceil(turns - 1e-12)
    if turn_rule == NEGATIVE_DIRECTION:
        return value + 360.0 * math.floor(turns + 1e-12)
    return value + 360.0 * math.floor(turns + 0.5)


@inner
def nearest_turn(current: float, value: float, endless: bool, low: float, high: float) -> float:
    """Return ``value``, degrees, plus the turns that bring it nearest to ``current``, within the travel if possible."""
    close = value + 360.0 * math.floor((current - value) / 360.0 + 0.5)
    if endless or low <= close <= high:
        return close
    for turns in range(1, 4):
        for sign in (-1.0, 1.0):
            other = close + sign * turns * 360.0
            if low <= other <= high:
                return other
    return close


@kernel(writes="joints")
def write_joints(
    kinematics: KinematicParameters,
    slides: tuple[int, int, int],
    rotary_columns: tuple[int, int],
    xyz_is_tip: Flags,
    xyz: Floats2,
    rotary: Floats2,
    joints: Floats2,
) -> None:
    """Write ``joints`` (n, 5) of rows as ``joints_from_rows`` returns them.

    slides, rotary_columns   columns of X, Y and Z and of the rotary axes in ``joints``
    """
    for row in range(xyz.shape[0]):
        a, b = rotary[row, 0], rotary[row, 1]
        if xyz_is_tip[row]:
            solve_slides(kinematics, a, b, xyz[row, 0], xyz[row, 1], xyz[row, 2], joints[row])
        else:
            joints[row, rotary_columns[0]] = a
            joints[row, rotary_columns[1]] = b
            for k in range(3):
                joints[row, slides[k]] = xyz[row, k]
