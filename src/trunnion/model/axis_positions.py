"""From what blocks say to where the five axes are.

In:     per row the tip or the slide values, and a vector or rotary values, or neither: then the angles stay.
Out:    rotary values as they wind from row to row, and with them five joints a row.
Units:  mm and degrees.

How a rotary word is reached (``way``): the first rotary axis in the low four bits, the second in the high four.
"""

import math
from typing import Final

import numpy as np

from trunnion.arrays import Codes, Flags, Floats
from trunnion.jit import njit
from trunnion.machines import Machine, inverse
from trunnion.machines.inverse import Packed, solve_slides

#: The number itself, as an axis with an end takes it.
PLAIN: Final = 0
#: By whichever way is shorter, up to half a turn.
SHORTEST: Final = 1
#: Only with growing values.
POSITIVE: Final = 2
#: Only with falling values.
NEGATIVE: Final = 3
#: Inside the turn in which the axis stands, as an endless axis takes an absolute position.
SAME_TURN: Final = 4

#: Row status.
OUT_OF_TRAVEL: Final = 1
UNREACHABLE: Final = 2
STUCK: Final = 4

#: How far past its travel a rotary axis may stand before a branch is refused, degrees.
SLACK: Final = 1e-6

#: Which rotary axis decides between the two positions for a vector: neither, but the sum of both ways.
BOTH: Final = -1

#: Ways that differ by no more than this are the same, degrees.
_SAME_WAY: Final = 1e-6


def settle(
    machine: Machine,
    packed: Packed,
    place: Floats,
    rotary: Floats,
    way: Codes,
    vector: Floats,
    held: Floats,
    tips: bool,
    deciding: int = BOTH,
) -> Codes:
    """Work out where the rotary axes stand after consecutive rows.

    Parameters
    ----------
    place : (n, 3) float64, mm
        Tool tips in the workpiece frame if ``tips``, else slide values in the order X, Y, Z.
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
        same for both, the other's way decides, then which position is nearer to 0. ``BOTH``: the sum of both ways.

    Returns
    -------
    (n,) uint8
        Bits OUT_OF_TRAVEL, UNREACHABLE (the angles stayed) and STUCK.
    """
    status = np.zeros(len(place), np.uint8)
    angles(machine, rotary, way, vector, held, status, deciding)
    # Slides get stuck only where a rotary axis turns one of them against another.
    if tips and len(set(packed.inside)) > 1:
        joints = joints_of(machine, packed, np.ones(len(place), np.bool_), place, rotary)
        status[np.isnan(joints).any(axis=1)] |= STUCK
    return status


def angles(
    machine: Machine,
    rotary: Floats,
    way: Codes,
    axis: Floats,
    held: Floats,
    status: Codes,
    deciding: int = BOTH,
) -> None:
    """Turn ``rotary`` (n, 2) from programmed values or NaN to positions, winding on from ``held`` (2,)."""
    vector = ~np.isnan(axis[:, 0])
    branches = np.full((2, len(rotary), 2), np.nan) if vector.any() else np.empty((2, 0, 2))
    pole = np.zeros(len(rotary), np.bool_)
    columns = list(machine.rotary)
    if vector.any():
        solved = inverse(machine, np.zeros((int(vector.sum()), 3)), axis[vector])
        branches[:, vector] = solved.joints[:, :, columns]
        pole[vector] = solved.pole
    axes = [machine.axes[column] for column in columns]
    wind(
        rotary,
        way,
        vector,
        branches,
        pole,
        held,
        np.array([a.endless for a in axes]),
        np.array([[a.low, a.high] for a in axes]),
        np.array([-180.0 if a.output == "-180..180" else 0.0 for a in axes]),
        deciding,
        status,
    )


def joints_of(machine: Machine, packed: Packed, by_tip: Flags, place: Floats, rotary: Floats) -> Floats:
    """All five axis values, (n, 5), of rows whose ``place`` is the tip where ``by_tip``, else the slides X, Y, Z.

    Slides that cannot bring the tip there are NaN.
    """
    joints = np.empty((len(place), 5))
    x, y, z = xyz(machine)
    # Numba compiles once more for what may be written to: columns that still grow are the same as those of a run here.
    place, rotary = place.view(), rotary.view()
    place.setflags(write=False)
    rotary.setflags(write=False)
    joint_rows(packed, (x, y, z), machine.rotary, by_tip, place, rotary, joints)
    return joints


def xyz(machine: Machine) -> list[int]:
    """Columns of the slides X, Y and Z."""
    return [machine.column(name) for name in "XYZ"]


@njit(cache=True, nogil=True)
def wind(
    rotary: Floats,
    way: Codes,
    vector: Flags,
    branches: Floats,
    pole: Flags,
    held: Floats,
    endless: Flags,
    travel: Floats,
    lowest: Floats,
    deciding: int,
    status: Codes,
) -> None:
    """Take the values of ``rotary`` (n, 2), NaN where nothing was programmed, to the turns that the control takes.

    branches  (2, n, 2) float64  both solutions of rows with a vector, in (-180, 180]; may be empty if there are none
    pole      (n,) bool          the first angle is free: it stays
    held      (2,) float64       angles before the first row
    endless   (2,) bool
    travel    (2, 2) float64     lowest and highest value of each axis
    lowest    (2,) float64       where the turn that the axis displays begins, 0 or -180
    deciding  as in ``settle``
    """
    a, b = held[0], held[1]
    for row in range(rotary.shape[0]):
        if not vector[row]:
            a = reach(a, rotary[row, 0], way[row] & 15, lowest[0])
            b = reach(b, rotary[row, 1], way[row] >> 4, lowest[1])
        else:
            found = False
            one, two = a, b
            inside = False
            for branch in range(2):
                p, q = branches[branch, row, 0], branches[branch, row, 1]
                if math.isnan(q):
                    continue
                p = a if pole[row] else nearest(a, p, endless[0], travel[0, 0], travel[0, 1])
                q = nearest(b, q, endless[1], travel[1, 0], travel[1, 1])
                fits = (
                    travel[0, 0] - SLACK <= p <= travel[0, 1] + SLACK
                    and travel[1, 0] - SLACK <= q <= travel[1, 1] + SLACK
                )
                if not found or (fits and not inside) or (fits == inside and sooner(p, q, one, two, a, b, deciding)):
                    one, two, inside, found = p, q, fits, True
            if not found:
                status[row] |= UNREACHABLE
            elif not inside:
                status[row] |= OUT_OF_TRAVEL
            a, b = one, two
        rotary[row, 0] = a
        rotary[row, 1] = b


@njit(cache=True)
def sooner(p: float, q: float, one: float, two: float, a: float, b: float, deciding: int) -> bool:
    """Whether a control whose axes stand at ``a`` and ``b`` takes ``p`` and ``q`` rather than ``one`` and ``two``."""
    if deciding == BOTH:
        return abs(p - a) + abs(q - b) < abs(one - a) + abs(two - b) - 1e-9
    if deciding == 1:
        p, q, one, two, a, b = q, p, two, one, b, a
    for way in (
        abs(p - a) - abs(one - a),
        abs(q - b) - abs(two - b),
        from_zero(p) - from_zero(one),
        from_zero(q) - from_zero(two),
    ):
        if abs(way) > _SAME_WAY:
            return way < 0.0
    return False


@njit(cache=True)
def from_zero(angle: float) -> float:
    """How far an angle is from the nearest whole turn, degrees."""
    return abs(angle - 360.0 * math.floor(angle / 360.0 + 0.5))


@njit(cache=True)
def reach(held: float, value: float, way: int, lowest: float) -> float:
    """Position of a rotary axis that stands at ``held`` after a word with ``value`` (NaN: no word), deg."""
    if math.isnan(value):
        return held
    if way == PLAIN:
        return value
    if way == SAME_TURN:
        inside = value - 360.0 * math.floor((value - lowest) / 360.0)
        return inside + 360.0 * math.floor((held - lowest) / 360.0)
    # Counted in whole turns added to the number, so that the digits written are the digits reached.
    turns = (held - value) / 360.0
    if way == POSITIVE:
        return value + 360.0 * math.ceil(turns - 1e-12)
    if way == NEGATIVE:
        return value + 360.0 * math.floor(turns + 1e-12)
    return value + 360.0 * math.floor(turns + 0.5)


@njit(cache=True)
def nearest(held: float, value: float, endless: bool, low: float, high: float) -> float:
    """The angle equal to ``value`` but for whole turns that is nearest to ``held``; inside the travel if any is."""
    close = value + 360.0 * math.floor((held - value) / 360.0 + 0.5)
    if endless or low <= close <= high:
        return close
    for turns in range(1, 4):
        for sign in (-1.0, 1.0):
            other = close + sign * turns * 360.0
            if low <= other <= high:
                return other
    return close


@njit(cache=True, nogil=True)
def joint_rows(
    packed: Packed,
    slides: tuple[int, int, int],
    turning: tuple[int, int],
    by_tip: Flags,
    place: Floats,
    rotary: Floats,
    joints: Floats,
) -> None:
    """Write ``joints`` (n, 5) of rows, as ``joints_of`` says.

    slides    columns of X, Y and Z in ``joints``
    turning   columns of the rotary axes
    """
    for row in range(place.shape[0]):
        a, b = rotary[row, 0], rotary[row, 1]
        if by_tip[row]:
            solve_slides(packed, a, b, place[row, 0], place[row, 1], place[row, 2], joints[row])
        else:
            joints[row, turning[0]] = a
            joints[row, turning[1]] = b
            for k in range(3):
                joints[row, slides[k]] = place[row, k]
