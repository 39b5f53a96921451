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

from trunnion.arrays import Flags, Floats, Floats2, Ints
from trunnion.jit import inner, kernel
from trunnion.machines import KinematicParameters, Machine, kinematic_parameters
from trunnion.machines.forward import KinematicChain, forward_row, kinematic_chain
from trunnion.machines.inverse import POLE, branch_angles, solve_slides, solve_tilt

#: Share of a tolerance that is used: the samples within a span miss the worst place by less than the rest.
_USABLE_SHARE: Final = 0.96

#: Where a span is looked at first, closer together towards its ends: there the tip may go back along its line. Where
#: not so much is off, that is all: in between it is no more than two thirds above it.
_COARSE_SHARES: Final = 0.5 - 0.5 * np.cos(np.pi * np.arange(1, 6) / 6.0)
_SURELY_LARGEST: Final = 0.6

#: Where it is looked at again if it turns but little, so that what it is off by is nearly a curve of the third degree;
#: and if it turns more, where a pole nearby bends it most.
_CUBIC_SHARES: Final = np.array([0.03, 0.125, 0.19, 0.375, 0.625, 0.81, 0.875, 0.97])
_DENSE_SHARES: Final = 0.5 - 0.5 * np.cos(np.pi * np.arange(1, 32) / 32.0)

#: As far as this a rotary axis turns but little within a span, degrees.
_SMALL_TURN: Final = 3.0

#: Sine of the angle between the two solutions of the second axis below which they are one.
_SAME_BRANCH_SINE: Final = 1e-9

#: A span shorter than this fraction of the way between two CL points turns in its place.
_SHORTEST_PART: Final = 1e-7

#: A step is long enough from this share of what is allowed on, and it is looked for so many times.
_LONG_ENOUGH: Final = 0.96
_MAX_TRIES: Final = 24

#: Added rows for which there is room at first.
_FIRST_CAPACITY: Final = 1024

#: Pieces into which a turn in its place is cut at most.
_MAX_PIECES: Final = 100_000


@dataclass(frozen=True, slots=True, eq=False)
class DividedPath:
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


def divide_path(
    machine: Machine,
    tip: Floats,
    axis: Floats,
    rotary: Floats,
    divisible: Flags,
    *,
    tcp: bool,
    tip_tolerance: float,
    axis_tolerance: float,
) -> DividedPath:
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
    allowed = np.array(
        [math.inf if tcp else _USABLE_SHARE * tip_tolerance, _USABLE_SHARE * math.radians(axis_tolerance)]
    )
    kit = kinematic_chain(machine), kinematic_parameters(machine), np.array(machine.rotary, np.int64)
    copies = np.ones(len(tip), np.int64)
    rows = tip, axis, rotary
    added = np.empty((_FIRST_CAPACITY, 3)), np.empty((_FIRST_CAPACITY, 3)), np.empty((_FIRST_CAPACITY, 2))
    row, count = _divide_rows(*kit, *rows, divisible, allowed, 0, 0, copies, *added)
    while row < len(tip):
        added = _doubled(added[0]), _doubled(added[1]), _doubled(added[2])
        row, count = _divide_rows(*kit, *rows, divisible, allowed, row, count, copies, *added)
    if not count:
        return DividedPath(np.arange(len(tip)), *rows)
    own = np.zeros(int(copies.sum()), np.bool_)
    own[np.cumsum(copies) - 1] = True
    merged = (_merged(own, old, new[:count]) for old, new in zip(rows, added, strict=True))
    return DividedPath(np.repeat(np.arange(len(tip)), copies), *merged)


def _doubled(rows: Floats) -> Floats:
    """Rows with as many empty ones behind them."""
    return np.concatenate((rows, np.empty_like(rows)))


def _merged(own: Flags, rows: Floats, added: Floats) -> Floats:
    """Rows where ``own``, the added ones elsewhere."""
    merged = np.empty((len(own), rows.shape[1]))
    merged[own], merged[~own] = rows, added
    return merged


def branches_of_rows(machine: Machine, rotary: Floats) -> Ints:
    """(n,) int64: which of the two solutions rows stand in; -1 where they are one: in the pole, at the edge of reach.

    ``rotary`` (n, 2) in degrees. The second angle says it: ``trunnion.machines.inverse`` has phi and -phi there.
    """
    found = np.empty(len(rotary), np.int64)
    _fill_branches(kinematic_parameters(machine), rotary, found)
    return found


@kernel(writes="found")
def _fill_branches(kinematics: KinematicParameters, rotary: Floats2, found: Ints) -> None:
    for row in range(rotary.shape[0]):
        found[row] = _branch_of(kinematics, rotary[row, 1])


@inner
def _branch_of(kinematics: KinematicParameters, second: float) -> int:
    """Which of the two solutions has this second angle, degrees; -1 where they are one."""
    angle = math.radians(second)
    sine = math.sin(angle) * kinematics.phase[0] + math.cos(angle) * kinematics.phase[1]
    return -1 if abs(sine) < _SAME_BRANCH_SINE else 0 if sine > 0.0 else 1


@kernel(writes="copies new_tip new_axis new_rotary")
def _divide_rows(
    chain: KinematicChain,
    kinematics: KinematicParameters,
    columns: Ints,
    tip: Floats2,
    axis: Floats2,
    rotary: Floats2,
    divisible: Flags,
    allowed: Floats,
    first: int,
    count: int,
    copies: Ints,
    new_tip: Floats2,
    new_axis: Floats2,
    new_rotary: Floats2,
) -> tuple[int, int]:
    """Write the rows that are added from row ``first`` on behind the ``count`` that there are, and into how many rows
    each row becomes; returns the row before which there was no more room, and how many have been added."""
    begin, end, here, work = np.empty(5), np.empty(5), np.empty(5), np.empty((4, 5))
    axes, tips = np.empty((3, 3)), np.empty((3, 3))
    placed = -1
    for row in range(max(first, 1), tip.shape[0]):
        if not divisible[row]:
            continue
        if placed == row - 1:
            begin[:] = end
        else:
            _axis_values(kinematics, columns, tip[row - 1], rotary[row - 1], begin)
        _axis_values(kinematics, columns, tip[row], rotary[row], end)
        placed = row
        if _surely_within(chain, columns, begin, end, allowed):
            continue
        axes[0, :], axes[1, :], axes[2, 0] = axis[row - 1], axis[row], _angle_between(axis[row - 1], axis[row])
        tips[0, :], tips[1, :] = tip[row - 1], tip[row]
        branch, other = _branch_of(kinematics, rotary[row - 1, 1]), _branch_of(kinematics, rotary[row, 1])
        if branch < 0:
            branch = other  # from a pole on, the solution is that of the end
        elif other >= 0 and branch != other:
            branch = -1
        done, step, made = 0.0, 0.0, count
        while done < 1.0:
            error = _span_error(chain, columns, begin, end, done, 1.0, tips, axes, allowed, work)
            if error <= 1.0:
                break
            if step == 0.0 or step >= 1.0 - done:
                step = (1.0 - done) * math.sqrt(_LONG_ENOUGH / error)
            step = _longest_step(
                chain, kinematics, columns, tips, axes, done, step, branch, begin, end, allowed, here, work
            )
            pieces = 1
            if step == 0.0:  # nothing but a turn in its place is left: over it, and on
                over = min(_SHORTEST_PART, 1.0 - done)
                here[:] = end
                if done + over < 1.0:
                    _axis_values_at(kinematics, columns, tips, axes, done + over, branch, begin, end, here, work[0])
                pieces = _turn_pieces(chain, kinematics, columns, begin, here, done + over, tips, axes, allowed, work)
                done += over
            done += step
            pieces -= 0 if done < 1.0 else 1
            if made + pieces > new_tip.shape[0]:
                return row, count
            of = pieces + (0 if done < 1.0 else 1)
            for piece in range(1, pieces + 1):
                _write_added_row(
                    columns, tips, axes, done, begin, here, piece / of, new_tip[made], new_axis[made], new_rotary[made]
                )
                made += 1
            begin[:] = here
        copies[row] = 1 + made - count
        count = made
    return tip.shape[0], count


@inner
def _surely_within(chain: KinematicChain, columns: Ints, begin: Floats, end: Floats, allowed: Floats) -> bool:
    """Whether so little turns that nothing can be off by more than is allowed; most spans of a dense path are such.

    A curve whose second derivative is at most s is off its chord by at most s/8. Here s is, of the tip, the square of
    the angles turned together times its distance from the rotary axes, and twice the angles times the way of the
    slides; of the tool axis the square alone, and the great circle may be as far off the chord on the other side.
    """
    turn, way, max_rotary_steps = 0.0, 0.0, 0.0
    for k in range(5):
        moved = abs(end[k] - begin[k])
        if k == columns[0] or k == columns[1]:
            turn += math.radians(moved)
        else:
            way += moved
            max_rotary_steps += max(abs(begin[k]), abs(end[k]))
    if not 0.25 * turn * turn <= allowed[1]:
        return False
    if allowed[0] == math.inf:
        return True
    for k in range(3):
        one, two = chain.point[columns[0], k], chain.point[columns[1], k]
        max_rotary_steps += abs(chain.tip_at_zero[k] - one) + abs(chain.tip_at_zero[k] - two) + 2.0 * abs(one - two)
    within: bool = 0.125 * (turn * turn * max_rotary_steps + 2.0 * turn * way) <= allowed[0]
    return within


@inner
def _axis_values(kinematics: KinematicParameters, columns: Ints, tip: Floats, rotary: Floats, out: Floats) -> None:
    """Write all five axis values."""
    solve_slides(kinematics, rotary[0], rotary[1], tip[0], tip[1], tip[2], out)
    out[columns[0]], out[columns[1]] = rotary[0], rotary[1]


@inner
def _write_added_row(
    columns: Ints,
    tips: Floats,
    axes: Floats,
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
    done = 0.0 if done < 2.0 * _SHORTEST_PART else 1.0 if done > 1.0 - 2.0 * _SHORTEST_PART else done
    for k in range(3):
        tip[k] = tips[0, k] + done * (tips[1, k] - tips[0, k])
    _slerp(axes, done, axis)
    for k in range(2):
        rotary[k] = begin[columns[k]] + share * (end[columns[k]] - begin[columns[k]])


@inner
def _angle_between(a: Floats, b: Floats) -> float:
    """Angle between unit vectors, rad, with all digits when it is small."""
    less = math.sqrt((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2 + (a[2] - b[2]) ** 2)
    more = math.sqrt((a[0] + b[0]) ** 2 + (a[1] + b[1]) ** 2 + (a[2] + b[2]) ** 2)
    return 2.0 * math.atan2(less, more)


@inner
def _slerp(axes: Floats, part: float, out: Floats) -> None:
    """Write the tool axis on the great circle from ``axes[0]`` to ``axes[1]``, ``axes[2, 0]`` radians apart."""
    angle = axes[2, 0]
    sine = math.sin(angle)
    if sine < 1e-9:
        first, second = 1.0 - part, part
    else:
        first, second = math.sin((1.0 - part) * angle) / sine, math.sin(part * angle) / sine
    total = 0.0
    for k in range(3):
        out[k] = first * axes[0, k] + second * axes[1, k]
        total += out[k] * out[k]
    total = math.sqrt(total)
    for k in range(3):
        out[k] /= total


@inner
def _axis_values_at(
    kinematics: KinematicParameters,
    columns: Ints,
    tips: Floats,
    axes: Floats,
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
    _slerp(axes, part, axis)
    status, u0, u1, cos, sin = solve_tilt(kinematics, axis[0], axis[1], axis[2])
    best = math.inf
    first, second = before[columns[0]], before[columns[1]]
    for branch in range(2):
        if branch != only and only >= 0:
            continue
        found = branch_angles(kinematics, u0, u1, cos, sin if branch == 0 else -sin, status)
        one = before[columns[0]] if status & POLE else _nearest_turn(found[0], before[columns[0]])
        if abs(one - before[columns[0]]) > 90.0:
            one = _nearest_turn(found[0], goal[columns[0]])
        two = _nearest_turn(found[1], before[columns[1]])
        away = abs(one - before[columns[0]]) + abs(two - before[columns[1]])
        if away < best:
            best, first, second = away, one, two
    x = tips[0, 0] + part * (tips[1, 0] - tips[0, 0])
    y = tips[0, 1] + part * (tips[1, 1] - tips[0, 1])
    z = tips[0, 2] + part * (tips[1, 2] - tips[0, 2])
    solve_slides(kinematics, first, second, x, y, z, out)
    out[columns[0]], out[columns[1]] = first, second


@inner
def _nearest_turn(angle: float, near: float) -> float:
    """The angle with the whole turns that bring it nearest."""
    wound: float = angle + 360.0 * math.floor((near - angle) / 360.0 + 0.5)
    return wound


@inner
def _span_error(
    chain: KinematicChain,
    columns: Ints,
    begin: Floats,
    end: Floats,
    first: float,
    last: float,
    tips: Floats,
    axes: Floats,
    allowed: Floats,
    work: Floats,
) -> float:
    """How far the tool is off between two axis positions, as a share of what is allowed: as often as it is needed."""
    few = (
        abs(end[columns[0]] - begin[columns[0]]) < _SMALL_TURN
        and abs(end[columns[1]] - begin[columns[1]]) < _SMALL_TURN
    )
    worst = _sampled_error(chain, begin, end, first, last, tips, axes, allowed, _COARSE_SHARES, work)
    if worst > 1.0 or (few and worst < _SURELY_LARGEST):
        return worst
    return max(
        worst,
        _sampled_error(
            chain, begin, end, first, last, tips, axes, allowed, _CUBIC_SHARES if few else _DENSE_SHARES, work
        ),
    )


@inner
def _sampled_error(
    chain: KinematicChain,
    begin: Floats,
    end: Floats,
    first: float,
    last: float,
    tips: Floats,
    axes: Floats,
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
        ways += (tips[1, k] - tips[0, k]) ** 2
    worst = 0.0
    for share in shares:
        for k in range(5):
            joints[k] = begin[k] + share * (end[k] - begin[k])
        forward_row(chain, joints, tip, axis)
        part = first + share * (last - first)
        if allowed[0] < math.inf:
            along, off = 0.0, 0.0
            for k in range(3):
                along += (tip[k] - tips[0, k]) * (tips[1, k] - tips[0, k])
            along = min(max(along / ways, first), last) if ways > 1e-12 else part
            for k in range(3):
                off += (tip[k] - tips[0, k] - along * (tips[1, k] - tips[0, k])) ** 2
            worst = max(worst, math.sqrt(off) / allowed[0])
        _slerp(axes, part, wanted)
        worst = max(worst, _angle_between(axis, wanted) / allowed[1])
    return worst


@inner
def _longest_step(
    chain: KinematicChain,
    kinematics: KinematicParameters,
    columns: Ints,
    tips: Floats,
    axes: Floats,
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
    for tries in range(_MAX_TRIES):
        if low == 0.0 and high < _SHORTEST_PART:
            return 0.0
        _axis_values_at(kinematics, columns, tips, axes, done + step, branch, begin, end, here, work[0])
        error = _span_error(chain, columns, begin, here, done, done + step, tips, axes, allowed, work)
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
        _axis_values_at(kinematics, columns, tips, axes, done + low, branch, begin, end, here, work[0])
    return low


@inner
def _turn_pieces(
    chain: KinematicChain,
    kinematics: KinematicParameters,
    columns: Ints,
    begin: Floats,
    end: Floats,
    part: float,
    tips: Floats,
    axes: Floats,
    allowed: Floats,
    work: Floats,
) -> int:
    """Pieces into which a turn at rest is cut."""
    joints, tip, rotary = np.empty(5), np.empty(3), np.empty(2)
    for k in range(3):
        tip[k] = tips[0, k] + part * (tips[1, k] - tips[0, k])
    pieces = 1.0
    while pieces < _MAX_PIECES:
        for k in range(2):
            rotary[k] = begin[columns[k]] + (end[columns[k]] - begin[columns[k]]) / pieces
        _axis_values(kinematics, columns, tip, rotary, joints)
        error = _sampled_error(chain, begin, joints, part, part, tips, axes, allowed, _COARSE_SHARES, work)
        if not error > 1.0:
            break
        # what a piece is off by shrinks with the square of its length
        pieces = math.ceil(pieces * min(max(math.sqrt(error), 1.02), 8.0))
    return int(pieces)
