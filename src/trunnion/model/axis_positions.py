"""From what blocks say to where the five axes are.

In:     per row the tip or the slide values, and a vector or rotary values, or neither: then the angles stay.
Out:    rotary values as they wind from row to row, and with them five joints a row.
Units:  mm and degrees.

How a rotary word is reached (``turn_rule``): the first rotary axis in the low four bits, the second in the high four.
"""

import math
from typing import Final

import numpy as np

from trunnion.arrays import Codes, Flags, Floats, Floats2, Floats3
from trunnion.jit import inner, kernel
from trunnion.machines import Machine, inverse
from trunnion.machines.inverse import KinematicParameters, solve_slides

#: The number itself, as an axis with an end takes it.
PLAIN: Final = 0
#: By whichever way is shorter, up to half a turn.
SHORTEST: Final = 1
#: Only with growing values.
POSITIVE_DIRECTION: Final = 2
#: Only with falling values.
NEGATIVE_DIRECTION: Final = 3
#: Inside the turn in which the axis stands, as an endless axis takes an absolute position.
SAME_TURN: Final = 4

#: Row status.
OUT_OF_TRAVEL: Final = 1
NO_ROTARY_SOLUTION: Final = 2
NO_SLIDE_SOLUTION: Final = 4

#: How far past its travel a rotary axis may stand before a branch is refused, degrees.
TRAVEL_TOLERANCE: Final = 1e-6

#: Which rotary axis decides between the two positions for a vector: neither, but the sum of both ways.
TOTAL_ROTATION: Final = -1

#: Ways that differ by no more than this are the same, degrees.
_EQUAL_ROTATION: Final = 1e-6


def resolve_rotary(
    machine: Machine,
    kinematics: KinematicParameters,
    xyz: Floats,
    rotary: Floats,
    turn_rule: Codes,
    vector: Floats,
    current: Floats,
    xyz_is_tip: bool,
    deciding_axis: int = TOTAL_ROTATION,
) -> Codes:
    """Work out where the rotary axes stand after consecutive rows.

    Parameters
    ----------
    place : (n, 3) float64, mm
        Tool tips in the workpiece frame if ``xyz_is_tip``, else slide values in the order X, Y, Z.
    rotary : (n, 2) float64, deg
        In: programmed values, NaN where the block has none. Out: positions as they wind.
    way : (n,) uint8
        See the module.
    vector : (n, 3) float64
        Programmed vectors of any length, workpiece frame; NaN where the block has none.
    held : (2,) float64
        Rotary axes before the first row.
    deciding
        The rotary axis, 0 or 1, by whose way a control chooses between two positions for a vector; where that is the
        same for both, the other's way decides, then which position is nearer to 0. ``TOTAL_ROTATION``: the sum of both
        ways.

    Returns
    -------
    (n,) uint8
        Bits OUT_OF_TRAVEL, UNREACHABLE (the angles stayed) and SLIDES_DEPENDENT.
    """
    status = np.zeros(len(xyz), np.uint8)
    resolve_angles(machine, rotary, turn_rule, vector, current, status, deciding_axis)
    # Slides get stuck only where a rotary axis turns one of them against another.
    if xyz_is_tip and len(set(kinematics.rotary_below)) > 1:
        joints = joints_from_rows(machine, kinematics, np.ones(len(xyz), np.bool_), xyz, rotary)
        status[np.isnan(joints).any(axis=1)] |= NO_SLIDE_SOLUTION
    return status


def resolve_angles(
    machine: Machine,
    rotary: Floats,
    turn_rule: Codes,
    axis: Floats,
    current: Floats,
    status: Codes,
    deciding_axis: int = TOTAL_ROTATION,
) -> None:
    """Turn ``rotary`` (n, 2) from programmed values or NaN to positions, winding on from ``current`` (2,)."""
    vector = ~np.isnan(axis[:, 0])
    branches = np.full((2, len(rotary), 2), np.nan) if vector.any() else np.empty((2, 0, 2))
    pole = np.zeros(len(rotary), np.bool_)
    columns = list(machine.rotary)
    if vector.any():
        solved = inverse(machine, np.zeros((int(vector.sum()), 3)), axis[vector])
        branches[:, vector] = solved.joints[:, :, columns]
        pole[vector] = solved.pole
    axes = [machine.axes[column] for column in columns]
    resolve_turns(
        rotary,
        turn_rule,
        vector,
        branches,
        pole,
        current,
        np.array([a.endless for a in axes]),
        np.array([[a.low, a.high] for a in axes]),
        np.array([-180.0 if a.output == "-180..180" else 0.0 for a in axes]),
        deciding_axis,
        status,
    )


def joints_from_rows(
    machine: Machine, kinematics: KinematicParameters, xyz_is_tip: Flags, xyz: Floats, rotary: Floats
) -> Floats:
    """All five axis values, (n, 5), of rows whose ``xyz`` is the tip where ``xyz_is_tip``, else the slides X, Y, Z.

    Slides that cannot bring the tip there are NaN.
    """
    joints = np.empty((len(xyz), 5))
    x, y, z = slide_columns(machine)
    write_joints(kinematics, (x, y, z), machine.rotary, xyz_is_tip, xyz, rotary, joints)
    return joints


def slide_columns(machine: Machine) -> list[int]:
    """Columns of the slides X, Y and Z."""
    return [machine.column(name) for name in "XYZ"]


@kernel(writes="rotary status")
def resolve_turns(
    rotary: Floats2,
    turn_rule: Codes,
    vector: Flags,
    branches: Floats3,
    pole: Flags,
    current: Floats,
    endless: Flags,
    travel: Floats2,
    turn_start: Floats,
    deciding_axis: int,
    status: Codes,
) -> None:
    """Take the values of ``rotary`` (n, 2), NaN where nothing was programmed, to the turns that the control takes.

    branches  (2, n, 2) float64  both solutions of rows with a vector, in (-180, 180]; may be empty if there are none
    pole      (n,) bool          the first angle is free: it stays
    held      (2,) float64       angles before the first row
    endless   (2,) bool
    travel    (2, 2) float64     lowest and highest value of each axis
    lowest    (2,) float64       where the turn that the axis displays begins, 0 or -180
    deciding  as in ``resolve_rotary``
    """
    a, b = current[0], current[1]
    for row in range(rotary.shape[0]):
        if not vector[row]:
            a = _rotary_position(a, rotary[row, 0], turn_rule[row] & 15, turn_start[0])
            b = _rotary_position(b, rotary[row, 1], turn_rule[row] >> 4, turn_start[1])
        else:
            found = False
            one, two = a, b
            in_travel = False
            for branch in range(2):
                p, q = branches[branch, row, 0], branches[branch, row, 1]
                if math.isnan(q):
                    continue
                p = a if pole[row] else _nearest_turn(a, p, endless[0], travel[0, 0], travel[0, 1])
                q = _nearest_turn(b, q, endless[1], travel[1, 0], travel[1, 1])
                fits = (
                    travel[0, 0] - TRAVEL_TOLERANCE <= p <= travel[0, 1] + TRAVEL_TOLERANCE
                    and travel[1, 0] - TRAVEL_TOLERANCE <= q <= travel[1, 1] + TRAVEL_TOLERANCE
                )
                if (
                    not found
                    or (fits and not in_travel)
                    or (fits == in_travel and preferred(p, q, one, two, a, b, deciding_axis))
                ):
                    one, two, in_travel, found = p, q, fits, True
            if not found:
                status[row] |= NO_ROTARY_SOLUTION
            elif not in_travel:
                status[row] |= OUT_OF_TRAVEL
            a, b = one, two
        rotary[row, 0] = a
        rotary[row, 1] = b


@inner
def preferred(p: float, q: float, one: float, two: float, a: float, b: float, deciding_axis: int) -> bool:
    """Whether a control whose axes stand at ``a`` and ``b`` takes ``p`` and ``q`` rather than ``one`` and ``two``."""
    if deciding_axis == TOTAL_ROTATION:
        return abs(p - a) + abs(q - b) < abs(one - a) + abs(two - b) - 1e-9
    if deciding_axis == 1:
        p, q, one, two, a, b = q, p, two, one, b, a
    for turn_rule in (
        abs(p - a) - abs(one - a),
        abs(q - b) - abs(two - b),
        from_whole_turn(p) - from_whole_turn(one),
        from_whole_turn(q) - from_whole_turn(two),
    ):
        if abs(turn_rule) > _EQUAL_ROTATION:
            return turn_rule < 0.0
    return False


@inner
def from_whole_turn(angle: float) -> float:
    """How far an angle is from the nearest whole turn, degrees."""
    return abs(angle - 360.0 * math.floor(angle / 360.0 + 0.5))


def rotary_position(current: float, value: float, turn_rule: int, turn_start: float) -> float:
    """Position of a rotary axis that stands at ``current`` after a word with ``value`` (NaN: no word), deg."""
    if math.isnan(value):
        return current
    if turn_rule == PLAIN:
        return value
    if turn_rule == SAME_TURN:
        in_travel = value - 360.0 * math.floor((value - turn_start) / 360.0)
        return in_travel + 360.0 * math.floor((current - turn_start) / 360.0)
    # Counted in whole turns added to the number, so that the digits written are the digits reached.
    turns = (current - value) / 360.0
    if turn_rule == POSITIVE_DIRECTION:
        return value + 360.0 * math.ceil(turns - 1e-12)
    if turn_rule == NEGATIVE_DIRECTION:
        return value + 360.0 * math.floor(turns + 1e-12)
    return value + 360.0 * math.floor(turns + 0.5)


_rotary_position = inner(rotary_position)


def nearest_turn(current: float, value: float, endless: bool, low: float, high: float) -> float:
    """The angle equal to ``value`` but for whole turns that is nearest to ``current``; inside the travel if any is."""
    close = value + 360.0 * math.floor((current - value) / 360.0 + 0.5)
    if endless or low <= close <= high:
        return close
    for turns in range(1, 4):
        for sign in (-1.0, 1.0):
            other = close + sign * turns * 360.0
            if low <= other <= high:
                return other
    return close


_nearest_turn = inner(nearest_turn)


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
    """Write ``joints`` (n, 5) of rows, as ``joints_from_rows`` says.

    slides    columns of X, Y and Z in ``joints``
    turning   columns of the rotary axes
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
