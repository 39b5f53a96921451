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
from trunnion.jit import njit
from trunnion.machines import Machine, Packed, pack
from trunnion.machines.forward import Chain, chain_row, pack_chain
from trunnion.machines.inverse import POLE, branch_angles, solve_slides, solve_tilt

#: Share of a tolerance that is used: the samples within a span miss the worst place by less than the rest.
_USED: Final = 0.96

#: Where a span is looked at first, closer together towards its ends: there the tip may go back along its line. Where
#: not so much is off, that is all: in between it is no more than two thirds above it.
_FIRST: Final = 0.5 - 0.5 * np.cos(np.pi * np.arange(1, 6) / 6.0)
_SURE: Final = 0.6

#: Where it is looked at again if it turns but little, so that what it is off by is nearly a curve of the third degree;
#: and if it turns more, where a pole nearby bends it most.
_MORE: Final = np.array([0.03, 0.125, 0.19, 0.375, 0.625, 0.81, 0.875, 0.97])
_CLOSE: Final = 0.5 - 0.5 * np.cos(np.pi * np.arange(1, 32) / 32.0)

#: As far as this a rotary axis turns but little within a span, degrees.
_LITTLE: Final = 3.0

#: Sine of the angle between the two solutions of the second axis below which they are one.
_ONE: Final = 1e-9

#: A span shorter than this fraction of the way between two CL points turns in its place.
_SHORT: Final = 1e-7

#: A step is long enough from this share of what is allowed on, and it is looked for so many times.
_ENOUGH: Final = 0.96
_TRIES: Final = 24

#: Added rows for which there is room at first.
_ROOM: Final = 1024

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
    allowed = np.array([math.inf if tcp else _USED * tip_tolerance, _USED * math.radians(axis_tolerance)])
    kit = pack_chain(machine), pack(machine), np.array(machine.rotary, np.int64)
    copies = np.ones(len(tip), np.int64)
    rows = tip, axis, rotary
    added = np.empty((_ROOM, 3)), np.empty((_ROOM, 3)), np.empty((_ROOM, 2))
    row, count = _divide(*kit, *rows, among, allowed, 0, 0, copies, *added)
    while row < len(tip):
        added = _roomier(added[0]), _roomier(added[1]), _roomier(added[2])
        row, count = _divide(*kit, *rows, among, allowed, row, count, copies, *added)
    if not count:
        return Spans(np.arange(len(tip)), *rows)
    own = np.zeros(int(copies.sum()), np.bool_)
    own[np.cumsum(copies) - 1] = True
    merged = (_merged(own, old, new[:count]) for old, new in zip(rows, added, strict=True))
    return Spans(np.repeat(np.arange(len(tip)), copies), *merged)


def _roomier(rows: Floats) -> Floats:
    """Rows with as many empty ones behind them."""
    return np.concatenate((rows, np.empty_like(rows)))


def _merged(own: Flags, rows: Floats, added: Floats) -> Floats:
    """Rows where ``own``, the added ones elsewhere."""
    merged = np.empty((len(own), rows.shape[1]))
    merged[own], merged[~own] = rows, added
    return merged


def branches(machine: Machine, rotary: Floats) -> Ints:
    """(n,) int64: which of the two solutions rows stand in; -1 where they are one: in the pole, at the edge of reach.

    ``rotary`` (n, 2) in degrees. The second angle says it: ``trunnion.machines.inverse`` has phi and -phi there.
    """
    found = np.empty(len(rotary), np.int64)
    _branches(pack(machine), rotary, found)
    return found


@njit(cache=True)
def _branches(packed: Packed, rotary: Floats, found: Ints) -> None:
    for row in range(rotary.shape[0]):
        found[row] = _branch_of(packed, rotary[row, 1])


@njit(cache=True)
def _branch_of(packed: Packed, second: float) -> int:
    """Which of the two solutions has this second angle, degrees; -1 where they are one."""
    angle = math.radians(second)
    sine = math.sin(angle) * packed.phase[0] + math.cos(angle) * packed.phase[1]
    return -1 if abs(sine) < _ONE else 0 if sine > 0.0 else 1


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
    first: int,
    count: int,
    copies: Ints,
    new_tip: Floats,
    new_axis: Floats,
    new_rotary: Floats,
) -> tuple[int, int]:
    """Write the rows that are added from row ``first`` on behind the ``count`` that there are, and into how many rows
    each row becomes; returns the row before which there was no more room, and how many have been added."""
    begin, end, here, work = np.empty(5), np.empty(5), np.empty(5), np.empty((4, 5))
    look, at = np.empty((3, 3)), np.empty((3, 3))
    placed = -1
    for row in range(max(first, 1), tip.shape[0]):
        if not among[row]:
            continue
        if placed == row - 1:
            begin[:] = end
        else:
            _place(packed, columns, tip[row - 1], rotary[row - 1], begin)
        _place(packed, columns, tip[row], rotary[row], end)
        placed = row
        if _surely_within(chain, columns, begin, end, allowed):
            continue
        look[0, :], look[1, :], look[2, 0] = axis[row - 1], axis[row], _angle_between(axis[row - 1], axis[row])
        at[0, :], at[1, :] = tip[row - 1], tip[row]
        branch, other = _branch_of(packed, rotary[row - 1, 1]), _branch_of(packed, rotary[row, 1])
        if branch < 0:
            branch = other  # from a pole on, the solution is that of the end
        elif other >= 0 and branch != other:
            branch = -1
        done, step, made = 0.0, 0.0, count
        while done < 1.0:
            error = _error(chain, columns, begin, end, done, 1.0, at, look, allowed, work)
            if error <= 1.0:
                break
            if step == 0.0 or step >= 1.0 - done:
                step = (1.0 - done) * math.sqrt(_ENOUGH / error)
            step = _farthest(chain, packed, columns, at, look, done, step, branch, begin, end, allowed, here, work)
            pieces = 1
            if step == 0.0:  # nothing but a turn in its place is left: over it, and on
                over = min(_SHORT, 1.0 - done)
                here[:] = end
                if done + over < 1.0:
                    _between(packed, columns, at, look, done + over, branch, begin, end, here, work[0])
                pieces = _turn_pieces(chain, packed, columns, begin, here, done + over, at, look, allowed, work)
                done += over
            done += step
            pieces -= 0 if done < 1.0 else 1
            if made + pieces > new_tip.shape[0]:
                return row, count
            of = pieces + (0 if done < 1.0 else 1)
            for piece in range(1, pieces + 1):
                _write(
                    columns, at, look, done, begin, here, piece / of, new_tip[made], new_axis[made], new_rotary[made]
                )
                made += 1
            begin[:] = here
        copies[row] = 1 + made - count
        count = made
    return tip.shape[0], count


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
    axis: Floats,
) -> None:
    """Write all five axis values at a part of the way: of one solution, or of the one nearest to the values before.

    Where the first axis turns half-way round, as it does across the pole, it goes the way round that leads to ``goal``.
    """
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
    columns: Ints,
    begin: Floats,
    end: Floats,
    first: float,
    last: float,
    at: Floats,
    look: Floats,
    allowed: Floats,
    work: Floats,
) -> float:
    """How far the tool is off between two axis positions, as a share of what is allowed: as often as it is needed."""
    few = abs(end[columns[0]] - begin[columns[0]]) < _LITTLE and abs(end[columns[1]] - begin[columns[1]]) < _LITTLE
    worst = _seen_error(chain, begin, end, first, last, at, look, allowed, _FIRST, work)
    if worst > 1.0 or (few and worst < _SURE):
        return worst
    return max(worst, _seen_error(chain, begin, end, first, last, at, look, allowed, _MORE if few else _CLOSE, work))


@njit(cache=True)
def _seen_error(
    chain: Chain,
    begin: Floats,
    end: Floats,
    first: float,
    last: float,
    at: Floats,
    look: Floats,
    allowed: Floats,
    shares: Floats,
    work: Floats,
) -> float:
    """How far the tool is off in some places between two axis positions, as a share of what is allowed.

    The positions stand at the parts ``first`` and ``last`` of the way. The tip is held against its line, the tool axis
    against the one that the great circle has at the same share of the span.
    """
    joints, tip, axis, wanted = work[0], work[1], work[2], work[3]
    ways = 0.0
    for k in range(3):
        ways += (at[1, k] - at[0, k]) ** 2
    worst = 0.0
    for share in shares:
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
    guess: float,
    branch: int,
    begin: Floats,
    end: Floats,
    allowed: Floats,
    here: Floats,
    work: Floats,
) -> float:
    """The longest step from ``done`` on that keeps the tolerances, as a part of the way; 0.0 if none does.

    ``here`` is where it ends. What a span is off by grows with the square of its length, or nearly so: the next try
    follows from the last one, between the longest step that does and the shortest one that does not.
    """
    low, high, step = 0.0, 1.0 - done, guess
    for tries in range(_TRIES):
        if low == 0.0 and high < _SHORT:
            return 0.0
        _between(packed, columns, at, look, done + step, branch, begin, end, here, work[0])
        error = _error(chain, columns, begin, here, done, done + step, at, look, allowed, work)
        if error > 1.0:
            high = step
        else:
            low = step
            if error >= _ENOUGH or high - low < 1e-3 * low:
                return low
        by_square = step * math.sqrt(0.5 * (1.0 + _ENOUGH) / max(error, 1e-9))
        if low == 0.0:
            step = max(by_square, 0.1 * high) if tries < _TRIES // 4 else 0.1 * high
        elif low < by_square < high:
            step = by_square
        else:
            step = 0.5 * (low + high)
    if low > 0.0:
        _between(packed, columns, at, look, done + low, branch, begin, end, here, work[0])
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
    work: Floats,
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
        error = _seen_error(chain, begin, joints, part, part, at, look, allowed, _FIRST, work)
        if not error > 1.0:
            break
        # what a piece is off by shrinks with the square of its length
        pieces = math.ceil(pieces * min(max(math.sqrt(error), 1.02), 8.0))
    return int(pieces)
