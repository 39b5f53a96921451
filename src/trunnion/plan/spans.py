"""Points between CL points, where a control would lead the tool off the CAM's path.

From one CL point to the next the CAM means the tip on a straight line and the tool axis on a great circle, each in step
with the other. A control moves its axes evenly instead. With TCP it keeps the tip on the line, and only the tool axis
bends; without, the tip leaves the line as well. Points are put where they are needed: each as far from the one before
as the tolerances let it, which is the fewest points that can be, as the error of a span grows with its length.

Where the first rotary axis must turn while the tool axis stands in its pole, no point between helps; there the turn is
cut into pieces at rest.
"""

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.kernels import njit
from trunnion.machine import Machine, Packed, pack
from trunnion.machine.chain import Chain, chain_row, pack_chain
from trunnion.machine.inverse import POLE, UNREACHABLE, branch_angles, solve_slides, solve_tilt

#: Share of a tolerance that is used: the samples within a span miss the worst place by less than the rest.
_USED: Final = 0.97

#: At how many places a span is looked at: closer together towards its ends, where a pole nearby bends it most.
_LOOKS: Final = 5
_CLOSE_LOOKS: Final = 31

#: A span shorter than this fraction of the way between two CL points turns in its place.
_SHORT: Final = 1e-7

#: Halvings by which the end of a span is found: its length to a thousandth.
_HALVINGS: Final = 10

#: Pieces into which a turn in its place is cut at most.
_PIECES: Final = 100_000


@dataclass(frozen=True, slots=True, eq=False)
class Spans:
    """Rows with those added that the tolerances ask for.

    source  (m,) int64      the row that each of them belongs to: added rows come before it
    tip     (m, 3) float64  mm, workpiece frame
    axis    (m, 3) float64  unit vectors, workpiece frame
    rotary  (m, 2) float64  deg, as they wind
    """

    source: Ints
    tip: Floats
    axis: Floats
    rotary: Floats


def divide(
    machine: Machine,
    tip: Floats,
    axis: Floats,
    rotary: Floats,
    among: Flags,
    *,
    tcp: bool,
    tip_tolerance: float,
    axis_tolerance: float,
) -> Spans:
    """Add the points that keep the tool on the way from CL point to CL point.

    Parameters
    ----------
    machine
        With ``tcp`` off its workpiece zero must be the one that the program runs at.
    tip : (n, 3) float64
        mm, workpiece frame.
    axis : (n, 3) float64
        Unit vectors, workpiece frame.
    rotary : (n, 2) float64
        Rotary positions as they wind, deg; the way from row to row is the one between these values.
    among : (n,) bool
        Rows whose way from the row before is kept; the first row has no way. Rows in which the rotary axes turn over
        to their other solution are not for this: no points make that a way.
    tcp
        The control keeps the tip on the line between points.
    tip_tolerance, axis_tolerance
        mm and degrees.
    """
    chain, packed = pack_chain(machine), pack(machine)
    columns = np.array(machine.rotary, np.int64)
    allowed = np.array([math.inf if tcp else _USED * tip_tolerance, _USED * math.radians(axis_tolerance)])
    counts = np.ones(len(tip), np.int64)
    empty = np.empty((0, 3)), np.empty((0, 3)), np.empty((0, 2))
    _divide(chain, packed, columns, tip, axis, rotary, among, allowed, counts, False, *empty)
    total = int(counts.sum())
    spans = Spans(
        np.repeat(np.arange(len(tip)), counts), np.empty((total, 3)), np.empty((total, 3)), np.empty((total, 2))
    )
    _divide(
        chain, packed, columns, tip, axis, rotary, among, allowed, counts, True, spans.tip, spans.axis, spans.rotary
    )
    return spans


def branches(machine: Machine, axis: Floats, rotary: Floats) -> Ints:
    """(n,) int64: which of the two solutions each row stands in; -1 in the pole, where they are one.

    ``axis`` (n, 3) in the workpiece frame, ``rotary`` (n, 2) in degrees.
    """
    found = np.empty(len(axis), np.int64)
    _branches(pack(machine), axis, rotary, found)
    return found


@njit(cache=True)
def _branches(packed: Packed, axis: Floats, rotary: Floats, found: Ints) -> None:
    for row in range(axis.shape[0]):
        found[row] = _branch_of(packed, axis[row], rotary[row])


@njit(cache=True)
def _divide(
    chain: Chain,
    packed: Packed,
    columns: Ints,
    tip: Floats,
    axis: Floats,
    rotary: Floats,
    among: Flags,
    allowed: Floats,
    counts: Ints,
    fill: bool,
    new_tip: Floats,
    new_axis: Floats,
    new_rotary: Floats,
) -> None:
    """Count the rows that every row becomes or, with ``fill``, write them."""
    begin, end, here = np.empty(5), np.empty(5), np.empty(5)
    look, at = np.empty((3, 3)), np.empty((3, 3))
    at_row = 0
    for row in range(tip.shape[0]):
        made = 0
        if among[row] and row > 0 and (not fill or counts[row] > 1):
            branch = _branch_of(packed, axis[row - 1], rotary[row - 1])
            other = _branch_of(packed, axis[row], rotary[row])
            if branch < 0:
                branch = other  # from a pole on, the solution is that of the end
            elif other >= 0 and branch != other:
                branch = -1
            _place(packed, columns, tip[row - 1], rotary[row - 1], begin)
            _place(packed, columns, tip[row], rotary[row], end)
            look[0, :], look[1, :], look[2, 0] = axis[row - 1], axis[row], _angle_between(axis[row - 1], axis[row])
            at[0, :], at[1, :] = tip[row - 1], tip[row]
            done = 0.0
            if _surely_within(chain, columns, begin, end, allowed):
                done = 1.0
            while done < 1.0 and _error(chain, begin, end, done, 1.0, at, look, allowed, _CLOSE_LOOKS) > 1.0:
                step = _farthest(chain, packed, columns, at, look, done, branch, begin, end, allowed, here)
                pieces = 1
                if step == 0.0:  # nothing but a turn in its place is left: over it, and on
                    step = min(_SHORT, 1.0 - done)
                    here[:] = end
                    if done + step < 1.0:
                        _between(packed, columns, at, look, done + step, branch, begin, end, here)
                    pieces = _turn_pieces(chain, packed, columns, begin, here, done + step, at, look, allowed)
                done += step
                for piece in range(1, pieces + 1 if done < 1.0 else pieces):
                    if fill:
                        k = at_row + made
                        _write(
                            columns, at, look, done, begin, here, piece / pieces, new_tip[k], new_axis[k], new_rotary[k]
                        )
                    made += 1
                begin[:] = here
                if done >= 1.0:
                    break
        if fill:
            last = at_row + made
            new_tip[last, :], new_axis[last, :], new_rotary[last, :] = tip[row], axis[row], rotary[row]
        else:
            counts[row] = made + 1
        at_row += made + 1


@njit(cache=True)
def _surely_within(chain: Chain, columns: Ints, begin: Floats, end: Floats, allowed: Floats) -> bool:
    """Whether so little turns that nothing can be off by more than is allowed; most spans of a dense path are such.

    A curve whose second derivative is at most s is off its chord by at most s/8. Here s is, of the tip, the square of
    the angles turned together times its distance from the rotary axes, and twice the angles times the way of the
    slides; of the tool axis the square alone, and the great circle may be as far off the chord on the other side.
    """
    turn, way, reach = 0.0, 0.0, 0.0
    for k in range(5):
        moved = abs(end[k] - begin[k])
        if k == columns[0] or k == columns[1]:
            turn += math.radians(moved)
        else:
            way += moved
            reach += max(abs(begin[k]), abs(end[k]))
    if not 0.25 * turn * turn <= allowed[1]:
        return False
    if allowed[0] == math.inf:
        return True
    for k in range(3):
        one, two = chain.point[columns[0], k], chain.point[columns[1], k]
        reach += abs(chain.tip_at_zero[k] - one) + abs(chain.tip_at_zero[k] - two) + 2.0 * abs(one - two)
    within: bool = 0.125 * (turn * turn * reach + 2.0 * turn * way) <= allowed[0]
    return within


@njit(cache=True)
def _place(packed: Packed, columns: Ints, tip: Floats, rotary: Floats, out: Floats) -> None:
    """Write all five axis values."""
    solve_slides(packed, rotary[0], rotary[1], tip[0], tip[1], tip[2], out)
    out[columns[0]], out[columns[1]] = rotary[0], rotary[1]


@njit(cache=True)
def _write(
    columns: Ints,
    at: Floats,
    look: Floats,
    done: float,
    begin: Floats,
    end: Floats,
    share: float,
    tip: Floats,
    axis: Floats,
    rotary: Floats,
) -> None:
    """Write one added row: the place at ``done``, with the rotary axes at a share of the way between two positions.

    A turn at an end of the way is at rest right there.
    """
    done = 0.0 if done < 2.0 * _SHORT else 1.0 if done > 1.0 - 2.0 * _SHORT else done
    for k in range(3):
        tip[k] = at[0, k] + done * (at[1, k] - at[0, k])
    _slerp(look, done, axis)
    for k in range(2):
        rotary[k] = begin[columns[k]] + share * (end[columns[k]] - begin[columns[k]])


@njit(cache=True)
def _angle_between(a: Floats, b: Floats) -> float:
    """Angle between unit vectors, rad, with all digits when it is small."""
    less = math.sqrt((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2 + (a[2] - b[2]) ** 2)
    more = math.sqrt((a[0] + b[0]) ** 2 + (a[1] + b[1]) ** 2 + (a[2] + b[2]) ** 2)
    return 2.0 * math.atan2(less, more)


@njit(cache=True)
def _slerp(look: Floats, part: float, out: Floats) -> None:
    """Write the tool axis on the great circle from ``look[0]`` to ``look[1]``, ``look[2, 0]`` radians apart."""
    angle = look[2, 0]
    sine = math.sin(angle)
    if sine < 1e-9:
        first, second = 1.0 - part, part
    else:
        first, second = math.sin((1.0 - part) * angle) / sine, math.sin(part * angle) / sine
    total = 0.0
    for k in range(3):
        out[k] = first * look[0, k] + second * look[1, k]
        total += out[k] * out[k]
    total = math.sqrt(total)
    for k in range(3):
        out[k] /= total


@njit(cache=True)
def _branch_of(packed: Packed, axis: Floats, rotary: Floats) -> int:
    """Which of the two solutions a row has; -1 where they are one."""
    status, u0, u1, cos, sin = solve_tilt(packed, axis[0], axis[1], axis[2])
    if status & (POLE | UNREACHABLE):
        return -1
    best, chosen = math.inf, -1
    for branch in range(2):
        found = branch_angles(packed, u0, u1, cos, sin if branch == 0 else -sin, status)
        away = 0.0
        for k in range(2):
            off = found[k] - rotary[k]
            away += abs(off - 360.0 * math.floor(off / 360.0 + 0.5))
        if away < best:
            best, chosen = away, branch
    return chosen


@njit(cache=True)
def _between(
    packed: Packed,
    columns: Ints,
    at: Floats,
    look: Floats,
    part: float,
    only: int,
    before: Floats,
    goal: Floats,
    out: Floats,
) -> None:
    """Write all five axis values at a part of the way: of one solution, or of the one nearest to the values before.

    Where the first axis turns half-way round, as it does across the pole, it goes the way round that leads to ``goal``.
    """
    axis = np.empty(3)
    _slerp(look, part, axis)
    status, u0, u1, cos, sin = solve_tilt(packed, axis[0], axis[1], axis[2])
    best = math.inf
    first, second = before[columns[0]], before[columns[1]]
    for branch in range(2):
        if branch != only and only >= 0:
            continue
        found = branch_angles(packed, u0, u1, cos, sin if branch == 0 else -sin, status)
        one = before[columns[0]] if status & POLE else _wound(found[0], before[columns[0]])
        if abs(one - before[columns[0]]) > 90.0:
            one = _wound(found[0], goal[columns[0]])
        two = _wound(found[1], before[columns[1]])
        away = abs(one - before[columns[0]]) + abs(two - before[columns[1]])
        if away < best:
            best, first, second = away, one, two
    x = at[0, 0] + part * (at[1, 0] - at[0, 0])
    y = at[0, 1] + part * (at[1, 1] - at[0, 1])
    z = at[0, 2] + part * (at[1, 2] - at[0, 2])
    solve_slides(packed, first, second, x, y, z, out)
    out[columns[0]], out[columns[1]] = first, second


@njit(cache=True)
def _wound(angle: float, near: float) -> float:
    """The angle with the whole turns that bring it nearest."""
    wound: float = angle + 360.0 * math.floor((near - angle) / 360.0 + 0.5)
    return wound


@njit(cache=True)
def _error(
    chain: Chain,
    begin: Floats,
    end: Floats,
    first: float,
    last: float,
    at: Floats,
    look: Floats,
    allowed: Floats,
    looks: int,
) -> float:
    """How far the tool is off between two axis positions, as a share of what is allowed.

    The positions stand at the parts ``first`` and ``last`` of the way. The tip is held against its line, the tool axis
    against the one that the great circle has at the same share of the span.
    """
    joints, tip, axis, wanted = np.empty(5), np.empty(3), np.empty(3), np.empty(3)
    ways = 0.0
    for k in range(3):
        ways += (at[1, k] - at[0, k]) ** 2
    worst = 0.0
    for look_at in range(1, looks + 1):
        share = 0.5 - 0.5 * math.cos(math.pi * look_at / (looks + 1.0))
        for k in range(5):
            joints[k] = begin[k] + share * (end[k] - begin[k])
        chain_row(chain, joints, tip, axis)
        part = first + share * (last - first)
        if allowed[0] < math.inf:
            along, off = 0.0, 0.0
            for k in range(3):
                along += (tip[k] - at[0, k]) * (at[1, k] - at[0, k])
            along = min(max(along / ways, first), last) if ways > 1e-12 else part
            for k in range(3):
                off += (tip[k] - at[0, k] - along * (at[1, k] - at[0, k])) ** 2
            worst = max(worst, math.sqrt(off) / allowed[0])
        _slerp(look, part, wanted)
        worst = max(worst, _angle_between(axis, wanted) / allowed[1])
    return worst


@njit(cache=True)
def _farthest(
    chain: Chain,
    packed: Packed,
    columns: Ints,
    at: Floats,
    look: Floats,
    done: float,
    branch: int,
    begin: Floats,
    end: Floats,
    allowed: Floats,
    here: Floats,
) -> float:
    """The longest step from ``done`` on that keeps the tolerances, as a part of the way; 0.0 if none does."""
    low, high = 0.0, 1.0 - done
    while low == 0.0:
        step = 0.25 * high
        if step < _SHORT:
            return 0.0
        _between(packed, columns, at, look, done + step, branch, begin, end, here)
        if _error(chain, begin, here, done, done + step, at, look, allowed, _LOOKS) > 1.0:
            high = step
        else:
            low = step
    for _ in range(_HALVINGS):
        step = 0.5 * (low + high)
        _between(packed, columns, at, look, done + step, branch, begin, end, here)
        if _error(chain, begin, here, done, done + step, at, look, allowed, _LOOKS) > 1.0:
            high = step
        else:
            low = step
    for _ in range(_HALVINGS):  # what those looks missed near a pole, closer ones see
        _between(packed, columns, at, look, done + low, branch, begin, end, here)
        if _error(chain, begin, here, done, done + low, at, look, allowed, _CLOSE_LOOKS) <= 1.0:
            break
        low *= 0.9
    return low


@njit(cache=True)
def _turn_pieces(
    chain: Chain,
    packed: Packed,
    columns: Ints,
    begin: Floats,
    end: Floats,
    part: float,
    at: Floats,
    look: Floats,
    allowed: Floats,
) -> int:
    """Pieces into which a turn at rest is cut."""
    joints, tip, rotary = np.empty(5), np.empty(3), np.empty(2)
    for k in range(3):
        tip[k] = at[0, k] + part * (at[1, k] - at[0, k])
    pieces = 1.0
    while pieces < _PIECES:
        for k in range(2):
            rotary[k] = begin[columns[k]] + (end[columns[k]] - begin[columns[k]]) / pieces
        _place(packed, columns, tip, rotary, joints)
        error = _error(chain, begin, joints, part, part, at, look, allowed, _LOOKS)
        if not error > 1.0:
            break
        # what a piece is off by shrinks with the square of its length
        pieces = math.ceil(pieces * min(max(math.sqrt(error), 1.02), 8.0))
    return int(pieces)
