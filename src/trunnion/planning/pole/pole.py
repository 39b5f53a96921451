"""Near the pole: the free angle is planned there, and the tool axis may lean a little so that it can be.

Where the tool axis passes close by the first rotary axis, that axis must turn far within a short way. The tool axis may
lean off the CAM's by a given angle, and no more: within a cone of so much about the pole the first angle is free then.

    hold    it holds within the cone, and turns in the step that leads out of it
    spread  it turns evenly over the cone, by the length of the tip's way
    lean    it and the second axis turn no faster than they can, in the cone and around it, and the tool axis leans by
            the least angle with which there is such a way; where there is none within the given angle, nothing is done

Only cones and places where an axis would exceed its rapid speed are looked after. In a cone the tool axis counts as
standing in the pole, so that either side goes on behind it (``trunnion.planning.poses.optimizer``). Whatever the first
angle becomes, the second one follows: it brings the tool axis as near to the CAM's as that angle lets it. The tip
stays.

For the way with limited speed, what is within the angle is an interval of first angles in each row
(``trunnion.planning.pole.cone``). From the last row backwards the values from which the rest of the way can be made are
intervals too; forwards, each row takes the value nearest to the CAM's among them. The least angle is found by halving.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from trunnion.arrays import Codes, Flags, Floats, Ints
from trunnion.machines import Machine, Packed, forward, pack, slide_positions
from trunnion.machines.inverse import inverse
from trunnion.model.motion import Pole
from trunnion.model.toolpath import Moves, Operation
from trunnion.planning.pole.cone import Cone, leanest, nearest_second, off_pole, way_of_second
from trunnion.planning.poses.placement import FINE, OUT_OF_REACH, REWIND
from trunnion.planning.poses.selection import Poses, follow, least_cost, take
from trunnion.planning.poses.states import LIMIT_TOLERANCE, REWOUND, limits_of
from trunnion.planning.speed.rotary_speed import USED, displayed, reach, turns_freely, wound

#: Degrees that an axis can turn before and after a place that asks too much of it, in which a way is looked for first.
_AROUND: Final = 400.0

#: The most that an axis without limits can be sent in one row, degrees: it goes the shorter way.
_SHORTER: Final = 179.999

#: Cones, by how many times the wished angle, within which the side may change where there is no way otherwise.
_WIDER: Final = (1.0, 2.0, 4.0, 8.0)

#: A tool axis that leans by less than this, degrees, stands as the CAM has it: the rounding of CL files is more.
_UPRIGHT: Final = 1e-7


@dataclass(frozen=True, slots=True)
class Place:
    """One place that was looked after.

    first, end  its rows, ``end`` left out
    lean        by how much the tool axis leans at most, degrees
    found       whether an axis keeps within its speed, if that was asked for
    """

    first: int
    end: int
    lean: float
    found: bool


@dataclass(frozen=True, slots=True, eq=False)
class Leaning:
    """An operation whose tool axis leans near the pole.

    moves   with the tool axes as the machine will have them
    poses   as ``trunnion.planning.poses.selection.take`` gives them
    rows    (k,) int64   rows with other rotary positions than the CAM's tool axis asks for, growing
    lean    (k,) float64 by how much the tool axis leans there, degrees
    """

    moves: Moves
    poses: Poses
    rows: Ints
    lean: Floats
    places: tuple[Place, ...]


def leaning(
    machine: Machine, operation: Operation, poses: Poses, keep_slides: bool, mode: Pole, angle: float, steady: Flags
) -> Leaning:
    """Look after the pole.

    Parameters
    ----------
    poses
        As the operation would be made without.
    mode
        Not OFF.
    angle
        By which the tool axis may lean, degrees.
    steady : (n,) bool
        Rows whose tool axis must stay, such as those of arcs.
    """
    moves = operation.moves
    far, begins = reach(machine, operation)
    work = _Work(machine, pack(machine), moves, far, begins, steady, angle)
    quick = work.too_fast(wound(machine, poses.rotary), poses.state)
    if not quick.any():
        return Leaning(moves, poses, np.zeros(0, np.int64), np.zeros(0), ())
    made = _made(work, mode, *_through(work, poses, list(_cones(work, quick, angle)), keep_slides))
    if mode is Pole.LEAN and made.lacking:
        stay = _made(work, mode, poses, [])
        made = stay if stay.lacking < made.lacking else made
        made = _wider(work, poses, quick, keep_slides) or made
    return _taken(work, made, keep_slides)


def _wider(work: "_Work", poses: Poses, quick: Flags, keep_slides: bool) -> "_Made | None":
    """A way that leads to the other side past the pole, whichever side is usual, and also farther off from it."""
    for times in _WIDER:
        cones = list(_cones(work, quick, times * work.angle))
        made = _made(work, Pole.LEAN, *_through(work, poses, cones, keep_slides, usual=False)) if cones else None
        if made is not None and not made.lacking:
            return made
    return None


@dataclass(frozen=True, slots=True, eq=False)
class _Work:
    """What all steps need.

    far     (n, 2) how far the axes get in each row
    begins  (n,)   rows that no feed binds to the one before
    steady  (n,)   rows whose tool axis stays
    """

    machine: Machine
    packed: Packed
    moves: Moves
    far: Floats
    begins: Flags
    steady: Flags
    angle: float

    def too_fast(self, turning: Floats, state: Codes) -> Flags:
        """(n,) bool: rows in which an axis would go farther than it gets."""
        step = np.abs(np.diff(turning, axis=0, prepend=turning[:1]))
        return np.asarray((step > self.far + 1e-9).any(axis=1) & ~self.begins & (state & REWOUND == 0))


@dataclass(frozen=True, slots=True, eq=False)
class _Made:
    """New positions ``rotary`` (n, 2), as they wind, in the place of ``exact`` ones, under which nothing leans."""

    poses: Poses
    exact: Floats
    rotary: Floats
    places: list[Place]

    @property
    def lacking(self) -> int:
        """Places without a way."""
        return sum(not place.found for place in self.places)


def _made(work: _Work, mode: Pole, poses: Poses, cones: list[Cone]) -> _Made:
    exact = _exact(work, wound(work.machine, poses.rotary), cones)
    if mode is not Pole.LEAN:
        return _Made(poses, exact, *_in_cones(work, exact, cones, even=mode is Pole.SPREAD))
    rotary, places, left = _limited(work, exact, poses.state, cones)
    rotary, _ = _in_cones(work, rotary, left, even=True)
    places = [*places, *_missed(work, rotary, poses.state, places)]
    lean = [float(_off(work.machine, rotary[p.first : p.end], work.moves.axis[p.first : p.end]).max()) for p in places]
    return _Made(poses, exact, rotary, [replace(p, lean=most) for p, most in zip(places, lean, strict=True)])


def _missed(work: _Work, rotary: Floats, state: Codes, places: list[Place]) -> Iterator[Place]:
    """Rows in which an axis is too fast after all, such as those between two places: they are places without a way."""
    fast = replace(work, far=work.far / USED).too_fast(rotary, state)
    for place in places:
        fast[place.first : place.end] &= place.found
    edges = np.flatnonzero(np.diff(fast, prepend=False, append=False))
    for first, end in edges.reshape(-1, 2).tolist():
        yield Place(first, end, 0.0, False)


# ---------------------------------------------------------------------------------------------------------------------
# Cones


def _cones(work: _Work, quick: Flags, angle: float) -> Iterator[Cone]:
    """Unbroken rows within ``angle`` of the pole, where a step into one of them or out of them is too fast."""
    inside = (off_pole(work.packed, work.moves.axis) <= angle) & ~work.steady
    edges = np.flatnonzero(np.diff(inside, prepend=False, append=False)).reshape(-1, 2)
    for first, end in edges.tolist():
        if quick[first : end + 1].any():
            yield Cone(first, end)


def _through(
    work: _Work, poses: Poses, cones: list[Cone], keep_slides: bool, usual: bool = True
) -> tuple[Poses, list[Cone]]:
    """Poses with the tool axis in the pole within the cones, where nothing speaks against them; else those there were.

    In these poses the first angle holds within the cones. Without ``usual`` no side is preferred but the definition's.
    """
    if not cones:
        return poses, cones
    line = np.array(work.packed.frame_1[6:])
    axis = work.moves.axis.copy()
    for cone in cones:
        part = slice(cone.first, cone.end)
        axis[part] = np.where(axis[part] @ line > 0.0, 1.0, -1.0)[:, None] * line
    moves = replace(work.moves, axis=axis)
    solutions = inverse(work.machine, moves.tip[: cones[0].end], moves.axis[: cones[0].end])
    if not solutions.reachable[cones[0].first]:
        return poses, []
    if usual:
        through = follow(work.machine, moves, keep_slides)
    else:
        through = take(work.machine, moves, least_cost(work.machine, moves, keep_slides), keep_slides)
    if (through.outcome == OUT_OF_REACH).any() or np.count_nonzero(through.outcome) > np.count_nonzero(poses.outcome):
        return poses, cones
    return through, cones


def _exact(work: _Work, turning: Floats, cones: list[Cone]) -> Floats:
    """(n, 2): positions under the CAM's tool axes; in cones, of all within limits, those nearest to an even turn."""
    exact = turning.copy()
    for cone in cones:
        first, last = _ends(turning, cone)
        asked = first + _share(work.moves.tip, cone) * (last - first)
        rows = slice(cone.first, cone.end)
        solutions = inverse(work.machine, work.moves.tip[rows], work.moves.axis[rows])
        found = solutions.joints[:, :, list(work.machine.rotary)]
        found[:, solutions.pole, 0] = asked[solutions.pole]
        around = found - np.stack((asked, turning[rows, 1]), axis=1)
        around -= 360.0 * np.rint(around / 360.0)
        places = np.stack((asked, turning[rows, 1]), axis=1) + around
        low, high = work.machine.limits[list(work.machine.rotary)].T
        outside = ((places < low - LIMIT_TOLERANCE) | (places > high + LIMIT_TOLERANCE)).any(axis=2)
        best = np.argmin(np.abs(around[:, :, 0]) + np.where(outside, 1e6, 0.0), axis=0)
        near = around[best, np.arange(len(best))]
        exact[rows, 0] = asked + near[:, 0]
        exact[rows, 1] = turning[rows, 1] + near[:, 1]
    return exact


def _ends(turning: Floats, cone: Cone) -> tuple[float, float]:
    """First angle before and behind a cone; at the operation's ends the other one: there is nothing to turn from."""
    before = turning[cone.first - 1, 0] if cone.first else np.nan
    after = turning[cone.end, 0] if cone.end < len(turning) else before
    before = after if np.isnan(before) else before
    return (turning[0, 0], turning[0, 0]) if np.isnan(before) else (float(before), float(after))


def _share(tip: Floats, cone: Cone) -> Floats:
    """(k,): how much of the tip's way from before a cone to behind it is done at its rows."""
    begin, end = max(cone.first - 1, 0), min(cone.end + 1, len(tip))
    way = np.linalg.norm(np.diff(tip[begin:end], axis=0), axis=1)
    total = way.sum()
    if not total > 0.0:
        return np.zeros(cone.end - cone.first)
    done = np.concatenate(([0.0], np.cumsum(way) / total))
    return np.asarray(done[cone.first - begin : cone.first - begin + cone.end - cone.first])


def _in_cones(work: _Work, exact: Floats, cones: list[Cone], even: bool) -> tuple[Floats, list[Place]]:
    """Hold or spread."""
    made, places = exact.copy(), []
    for cone in cones:
        rows = np.arange(cone.first, cone.end)
        first, last = _ends(exact, cone)
        made[rows, 0] = first + (_share(work.moves.tip, cone) * (last - first) if even else 0.0)
        made[rows, 1] = nearest_second(work.machine, work.packed, work.moves.axis[rows], made[rows, 0], exact[rows, 1])
        off = _off(work.machine, made[rows], work.moves.axis[rows])
        places.append(Place(cone.first, cone.end, float(off.max()), True))
    return made, places


# ---------------------------------------------------------------------------------------------------------------------
# Ways with limited speed


def _limited(work: _Work, exact: Floats, state: Codes, cones: list[Cone]) -> tuple[Floats, list[Place], list[Cone]]:
    """Lean: each place by itself in what is around it, or in all up to the next rapids where that is not enough.

    Cones in which too much is asked for and no way is found are left.
    """
    made, places, done = exact.copy(), [], 0
    quick = work.too_fast(exact, state)
    solved = np.zeros(len(quick), bool)
    for first, end in _around(work, quick, state, _AROUND):
        if first < done:  # all rows up to there were planned together
            continue
        way, lean = _way(work, exact, np.arange(first, end), work.angle)
        if way is None:
            begin, stop = _whole(work, state, first)
            way, lean = _way(work, exact, np.arange(begin, stop), work.angle)
            if way is None:
                at = first + np.flatnonzero(quick[first:end])
                inside = [
                    cone for cone in cones if first <= cone.first < end and quick[cone.first : cone.end + 1].any()
                ]
                begin = min([int(at[0]), *(cone.first for cone in inside)])
                stop = max([int(at[-1]), *(cone.end for cone in inside)]) + 1
                places.append(Place(begin, min(stop, len(quick)), 0.0, False))
                continue
            first, end, done = begin, stop, stop
            places = [place for place in places if place.end <= begin]
        made[first:end] = way
        changed = first + np.flatnonzero(np.abs(way - exact[first:end]).max(axis=1) > 1e-9)
        places.append(Place(int(changed[0]), int(changed[-1]) + 1, lean, True))
        quick[first:end], solved[first:end] = False, True
    return made, places, list(_left(cones, quick, solved))


def _left(cones: list[Cone], quick: Flags, solved: Flags) -> Iterator[Cone]:
    """What is left of cones in which too much is asked for."""
    for cone in cones:
        if quick[cone.first : cone.end + 1].any():
            edges = np.flatnonzero(np.diff(~solved[cone.first : cone.end], prepend=False, append=False))
            for first, end in (cone.first + edges).reshape(-1, 2).tolist():
                yield Cone(first, end)


def _breaks(work: _Work, state: Codes) -> Flags:
    return np.asarray(work.begins | (state & REWOUND != 0))


def _around(work: _Work, quick: Flags, state: Codes, degrees: float) -> list[tuple[int, int]]:
    """Rows around those that are too fast, no two overlapping: so many that both axes can turn by ``degrees``."""
    breaks = _breaks(work, state)
    far = np.cumsum(np.where(breaks, 0.0, np.minimum(work.far.min(axis=1), degrees)))
    starts = np.append(np.flatnonzero(breaks), len(breaks))
    at = np.flatnonzero(quick)
    segment = np.searchsorted(starts, at, "right") - 1
    first = np.maximum(np.searchsorted(far, far[at] - degrees), starts[segment])
    end = np.minimum(np.searchsorted(far, far[at] + degrees, "right"), starts[segment + 1])
    parts: list[tuple[int, int]] = []
    for begin, stop in zip(first.tolist(), end.tolist(), strict=True):
        if parts and begin < parts[-1][1]:
            parts[-1] = (parts[-1][0], max(stop, parts[-1][1]))
        else:
            parts.append((begin, stop))
    return parts


def _whole(work: _Work, state: Codes, first: int) -> tuple[int, int]:
    """All rows from the last break before a row to the next one behind."""
    breaks = np.flatnonzero(_breaks(work, state))
    k = int(np.searchsorted(breaks, first, "right"))
    return int(breaks[k - 1]), int(breaks[k]) if k < len(breaks) else len(work.moves)


def _way(work: _Work, exact: Floats, rows: Ints, angle: float) -> tuple[Floats | None, float]:
    """Positions (k, 2) for consecutive rows, and by how much the tool axis leans at most; None and NaN without any.

    Both ends stay where they are, unless a rapid is before or behind them.
    """
    axis, wanted = work.moves.axis[rows], exact[rows]
    far = np.where(turns_freely(work.machine), np.minimum(work.far[rows], _SHORTER), work.far[rows])
    steady = work.steady[rows].copy()
    steady[0] |= not work.begins[rows[0]]
    behind = int(rows[-1]) + 1
    steady[-1] |= behind < len(exact) and not work.begins[behind]
    bounds = [(work.machine.axes[c].low, work.machine.axes[c].high) for c in work.machine.rotary]
    first, lean = leanest(work.packed, axis, wanted[:, 0], far[:, 0], steady, bounds[0], angle)
    if first is None:
        return None, np.nan
    for most in (lean, angle):
        second = way_of_second(work.packed, axis, first, wanted[:, 1], far[:, 1], steady, bounds[1], most)
        if second is not None:
            made = np.column_stack((first, second))
            off = float(_off(work.machine, made, axis).max())
            if off <= angle + 1e-9:
                return made, off
    return None, np.nan


# ---------------------------------------------------------------------------------------------------------------------
# The result


def _off(machine: Machine, rotary: Floats, axis: Floats) -> Floats:
    """(k,): degrees between the tool axes of rotary positions and others."""
    joints = np.zeros((len(rotary), 5))
    joints[:, list(machine.rotary)] = rotary
    apart = np.linalg.norm(forward(machine, joints)[1] - axis, axis=1)
    return np.asarray(np.degrees(2.0 * np.arcsin(np.minimum(0.5 * apart, 1.0))))


def _taken(work: _Work, made: _Made, keep_slides: bool) -> Leaning:
    """Put the new positions in the place of the others, with their slides and limits."""
    machine, moves, poses = work.machine, work.moves, made.poses
    rows = np.flatnonzero((np.abs(made.rotary - made.exact) > 1e-9).any(axis=1))
    lean = _off(machine, made.rotary[rows], moves.axis[rows])
    axis = moves.axis.copy()
    leans = rows[lean > _UPRIGHT]
    joints = np.zeros((len(leans), 5))
    joints[:, list(machine.rotary)] = made.rotary[leans]
    axis[leans] = forward(machine, joints)[1]
    rotary = displayed(machine, made.rotary)
    taken = _judged(machine, moves.tip, replace(poses, rotary=rotary), np.abs(rotary - poses.rotary), keep_slides)
    return Leaning(replace(moves, axis=axis), taken, rows, lean, tuple(made.places))


def _judged(machine: Machine, tip: Floats, poses: Poses, changed: Floats, keep_slides: bool) -> Poses:
    """Slides and limits of poses in rows whose rotary positions have ``changed`` (n, 2)."""
    rows = np.flatnonzero((changed > 1e-9).any(axis=1))
    joints = slide_positions(machine, tip, poses.rotary)
    low, high = limits_of(machine, keep_slides)
    outside = (joints[rows] < low - LIMIT_TOLERANCE) | (joints[rows] > high + LIMIT_TOLERANCE)
    outcome, beyond = poses.outcome.copy(), poses.beyond.copy()
    outcome[rows] = np.where(outcome[rows] < REWIND, FINE, outcome[rows])
    for k in np.flatnonzero(outside.any(axis=1)).tolist():
        column = int(np.argmax(outside[k]))
        outcome[rows[k]], beyond[rows[k]] = column + 1, joints[rows[k], column]
    where = np.column_stack((joints.argmin(axis=0), joints.argmax(axis=0)))
    extremes = np.column_stack((joints.min(axis=0), joints.max(axis=0)))
    return replace(poses, outcome=outcome, beyond=beyond, extremes=extremes, where=where)
