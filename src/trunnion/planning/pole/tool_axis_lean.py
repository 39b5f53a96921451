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
(``trunnion.planning.pole.lean_limits``). From the last row backwards the values from which the rest of the way can be
made are intervals too; forwards, each row takes the value nearest to the CAM's among them. The least angle is found by
halving.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from trunnion.arrays import Codes, Flags, Floats, Ints
from trunnion.machines import KinematicParameters, Machine, forward, kinematic_parameters, slide_positions
from trunnion.machines.inverse import inverse
from trunnion.model.motion import PoleStrategy
from trunnion.model.toolpath import Moves, Operation
from trunnion.planning.pole.lean_limits import (
    PolePassage,
    closest_second_angles,
    degrees_off_pole,
    least_lean,
    second_angles_within,
)
from trunnion.planning.poses.placement import OUT_OF_REACH, REWIND, WITHIN_LIMITS
from trunnion.planning.poses.selection import PlannedPoses, cheapest_states, choose_poses, poses_of_states
from trunnion.planning.poses.states import LIMIT_TOLERANCE, REWIND_STEP, limits_of
from trunnion.planning.speed.rotary_speed import (
    USABLE_SHARE,
    continuous_positions,
    displayed_positions,
    is_endless,
    max_rotary_steps,
)

#: Degrees that an axis can turn before and after a place that asks too much of it, in which a way is looked for first.
_WINDOW_DEGREES: Final = 400.0

#: The most that an axis without limits can be sent in one row, degrees: it goes the shorter way.
_LONGEST_SHORT_WAY: Final = 179.999

#: Cones, by how many times the wished angle, within which the side may change where there is no way otherwise.
_WIDER_FACTORS: Final = (1.0, 2.0, 4.0, 8.0)

#: A tool axis that leans by less than this, degrees, stands as the CAM has it: the rounding of CL files is more.
_NO_LEAN: Final = 1e-7


@dataclass(frozen=True, slots=True)
class PoleRegion:
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
class LeanedMoves:
    """An operation whose tool axis leans near the pole.

    moves   with the tool axes as the machine will have them
    poses   as ``trunnion.planning.poses.selection.poses_of_states`` gives them
    rows    (k,) int64   rows with other rotary positions than the CAM's tool axis asks for, growing
    lean    (k,) float64 by how much the tool axis leans there, degrees
    """

    moves: Moves
    poses: PlannedPoses
    rows: Ints
    lean: Floats
    regions: tuple[PoleRegion, ...]


def lean_tool_axis(
    machine: Machine,
    operation: Operation,
    poses: PlannedPoses,
    keep_slides: bool,
    strategy: PoleStrategy,
    angle: float,
    fixed: Flags,
) -> LeanedMoves:
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
    max_step, unbound = max_rotary_steps(machine, operation)
    task = _LeanTask(machine, kinematic_parameters(machine), moves, max_step, unbound, fixed, angle)
    too_fast = task.exceeds_speed(continuous_positions(machine, poses.rotary), poses.state)
    if not too_fast.any():
        return LeanedMoves(moves, poses, np.zeros(0, np.int64), np.zeros(0), ())
    leaned = _lean_path(
        task, strategy, *_poses_through_pole(task, poses, list(_passages(task, too_fast, angle)), keep_slides)
    )
    if strategy is PoleStrategy.LEAN and leaned.unresolved:
        stay = _lean_path(task, strategy, poses, [])
        leaned = stay if stay.unresolved < leaned.unresolved else leaned
        leaned = _lean_on_other_side(task, poses, too_fast, keep_slides) or leaned
    return _apply(task, leaned, keep_slides)


def _lean_on_other_side(
    task: "_LeanTask", poses: PlannedPoses, too_fast: Flags, keep_slides: bool
) -> "_LeanedPath | None":
    """A way that leads to the other side past the pole, whichever side is usual, and also farther off from it."""
    for times in _WIDER_FACTORS:
        passages = list(_passages(task, too_fast, times * task.angle))
        leaned = (
            _lean_path(task, PoleStrategy.LEAN, *_poses_through_pole(task, poses, passages, keep_slides, usual=False))
            if passages
            else None
        )
        if leaned is not None and not leaned.unresolved:
            return leaned
    return None


@dataclass(frozen=True, slots=True, eq=False)
class _LeanTask:
    """What all steps need.

    far     (n, 2) how far the axes get in each row
    begins  (n,)   rows that no feed binds to the one before
    steady  (n,)   rows whose tool axis stays
    """

    machine: Machine
    kinematics: KinematicParameters
    moves: Moves
    max_step: Floats
    unbound: Flags
    fixed: Flags
    angle: float

    def exceeds_speed(self, turning: Floats, state: Codes) -> Flags:
        """(n,) bool: rows in which an axis would go farther than it gets."""
        step = np.abs(np.diff(turning, axis=0, prepend=turning[:1]))
        return np.asarray((step > self.max_step + 1e-9).any(axis=1) & ~self.unbound & (state & REWIND_STEP == 0))


@dataclass(frozen=True, slots=True, eq=False)
class _LeanedPath:
    """New positions ``rotary`` (n, 2), as they wind, in the place of ``exact`` ones, under which nothing leans."""

    poses: PlannedPoses
    exact: Floats
    rotary: Floats
    regions: list[PoleRegion]

    @property
    def unresolved(self) -> int:
        """Places without a way."""
        return sum(not region.found for region in self.regions)


def _lean_path(
    task: _LeanTask, strategy: PoleStrategy, poses: PlannedPoses, passages: list[PolePassage]
) -> _LeanedPath:
    exact = _exact_positions(task, continuous_positions(task.machine, poses.rotary), passages)
    if strategy is not PoleStrategy.LEAN:
        return _LeanedPath(poses, exact, *_hold_or_spread(task, exact, passages, even=strategy is PoleStrategy.SPREAD))
    rotary, regions, left = _limit_speed(task, exact, poses.state, passages)
    rotary, _ = _hold_or_spread(task, rotary, left, even=True)
    regions = [*regions, *_still_too_fast(task, rotary, poses.state, regions)]
    lean = [
        float(_axis_deviation(task.machine, rotary[p.first : p.end], task.moves.axis[p.first : p.end]).max())
        for p in regions
    ]
    return _LeanedPath(poses, exact, rotary, [replace(p, lean=most) for p, most in zip(regions, lean, strict=True)])


def _still_too_fast(task: _LeanTask, rotary: Floats, state: Codes, regions: list[PoleRegion]) -> Iterator[PoleRegion]:
    """Rows in which an axis is too fast after all, such as those between two places: they are places without a way."""
    fast = replace(task, max_step=task.max_step / USABLE_SHARE).exceeds_speed(rotary, state)
    for region in regions:
        fast[region.first : region.end] &= region.found
    edges = np.flatnonzero(np.diff(fast, prepend=False, append=False))
    for first, end in edges.reshape(-1, 2).tolist():
        yield PoleRegion(first, end, 0.0, False)


# ---------------------------------------------------------------------------------------------------------------------
# Cones


def _passages(task: _LeanTask, too_fast: Flags, angle: float) -> Iterator[PolePassage]:
    """Unbroken rows within ``angle`` of the pole, where a step into one of them or out of them is too fast."""
    inside = (degrees_off_pole(task.kinematics, task.moves.axis) <= angle) & ~task.fixed
    edges = np.flatnonzero(np.diff(inside, prepend=False, append=False)).reshape(-1, 2)
    for first, end in edges.tolist():
        if too_fast[first : end + 1].any():
            yield PolePassage(first, end)


def _poses_through_pole(
    task: _LeanTask, poses: PlannedPoses, passages: list[PolePassage], keep_slides: bool, usual: bool = True
) -> tuple[PlannedPoses, list[PolePassage]]:
    """Poses with the tool axis in the pole within the cones, where nothing speaks against them; else those there were.

    In these poses the first angle holds within the cones. Without ``usual`` no side is preferred but the definition's.
    """
    if not passages:
        return poses, passages
    line = np.array(task.kinematics.basis_1[6:])
    axis = task.moves.axis.copy()
    for passage in passages:
        part = slice(passage.first, passage.end)
        axis[part] = np.where(axis[part] @ line > 0.0, 1.0, -1.0)[:, None] * line
    moves = replace(task.moves, axis=axis)
    solutions = inverse(task.machine, moves.tip[: passages[0].end], moves.axis[: passages[0].end])
    if not solutions.reachable[passages[0].first]:
        return poses, []
    if usual:
        through = choose_poses(task.machine, moves, keep_slides)
    else:
        through = poses_of_states(task.machine, moves, cheapest_states(task.machine, moves, keep_slides), keep_slides)
    if (through.outcome == OUT_OF_REACH).any() or np.count_nonzero(through.outcome) > np.count_nonzero(poses.outcome):
        return poses, passages
    return through, passages


def _exact_positions(task: _LeanTask, turning: Floats, passages: list[PolePassage]) -> Floats:
    """(n, 2): positions under the CAM's tool axes; in cones, of all within limits, those nearest to an even turn."""
    exact = turning.copy()
    for passage in passages:
        first, last = _angles_at_ends(turning, passage)
        asked = first + _path_share(task.moves.tip, passage) * (last - first)
        rows = slice(passage.first, passage.end)
        solutions = inverse(task.machine, task.moves.tip[rows], task.moves.axis[rows])
        found = solutions.joints[:, :, list(task.machine.rotary)]
        found[:, solutions.pole, 0] = asked[solutions.pole]
        around = found - np.stack((asked, turning[rows, 1]), axis=1)
        around -= 360.0 * np.rint(around / 360.0)
        regions = np.stack((asked, turning[rows, 1]), axis=1) + around
        low, high = task.machine.limits[list(task.machine.rotary)].T
        outside = ((regions < low - LIMIT_TOLERANCE) | (regions > high + LIMIT_TOLERANCE)).any(axis=2)
        best = np.argmin(np.abs(around[:, :, 0]) + np.where(outside, 1e6, 0.0), axis=0)
        near = around[best, np.arange(len(best))]
        exact[rows, 0] = asked + near[:, 0]
        exact[rows, 1] = turning[rows, 1] + near[:, 1]
    return exact


def _angles_at_ends(turning: Floats, passage: PolePassage) -> tuple[float, float]:
    """First angle before and behind a cone; at the operation's ends the other one: there is nothing to turn from."""
    before = turning[passage.first - 1, 0] if passage.first else np.nan
    after = turning[passage.end, 0] if passage.end < len(turning) else before
    before = after if np.isnan(before) else before
    return (turning[0, 0], turning[0, 0]) if np.isnan(before) else (float(before), float(after))


def _path_share(tip: Floats, passage: PolePassage) -> Floats:
    """(k,): how much of the tip's way from before a cone to behind it is done at its rows."""
    begin, end = max(passage.first - 1, 0), min(passage.end + 1, len(tip))
    way = np.linalg.norm(np.diff(tip[begin:end], axis=0), axis=1)
    total = way.sum()
    if not total > 0.0:
        return np.zeros(passage.end - passage.first)
    done = np.concatenate(([0.0], np.cumsum(way) / total))
    return np.asarray(done[passage.first - begin : passage.first - begin + passage.end - passage.first])


def _hold_or_spread(
    task: _LeanTask, exact: Floats, passages: list[PolePassage], even: bool
) -> tuple[Floats, list[PoleRegion]]:
    """Hold or spread."""
    leaned, regions = exact.copy(), []
    for passage in passages:
        rows = np.arange(passage.first, passage.end)
        first, last = _angles_at_ends(exact, passage)
        leaned[rows, 0] = first + (_path_share(task.moves.tip, passage) * (last - first) if even else 0.0)
        leaned[rows, 1] = closest_second_angles(
            task.machine, task.kinematics, task.moves.axis[rows], leaned[rows, 0], exact[rows, 1]
        )
        off = _axis_deviation(task.machine, leaned[rows], task.moves.axis[rows])
        regions.append(PoleRegion(passage.first, passage.end, float(off.max()), True))
    return leaned, regions


# ---------------------------------------------------------------------------------------------------------------------
# Ways with limited speed


def _limit_speed(
    task: _LeanTask, exact: Floats, state: Codes, passages: list[PolePassage]
) -> tuple[Floats, list[PoleRegion], list[PolePassage]]:
    """Lean: each place by itself in what is around it, or in all up to the next rapids where that is not enough.

    Cones in which too much is asked for and no way is found are left.
    """
    leaned, regions, done = exact.copy(), [], 0
    too_fast = task.exceeds_speed(exact, state)
    solved = np.zeros(len(too_fast), bool)
    for first, end in _windows(task, too_fast, state, _WINDOW_DEGREES):
        if first < done:  # all rows up to there were planned together
            continue
        way, lean = _speed_limited_path(task, exact, np.arange(first, end), task.angle)
        if way is None:
            begin, stop = _unbroken_rows(task, state, first)
            way, lean = _speed_limited_path(task, exact, np.arange(begin, stop), task.angle)
            if way is None:
                at = first + np.flatnonzero(too_fast[first:end])
                inside = [
                    passage
                    for passage in passages
                    if first <= passage.first < end and too_fast[passage.first : passage.end + 1].any()
                ]
                begin = min([int(at[0]), *(passage.first for passage in inside)])
                stop = max([int(at[-1]), *(passage.end for passage in inside)]) + 1
                regions.append(PoleRegion(begin, min(stop, len(too_fast)), 0.0, False))
                continue
            first, end, done = begin, stop, stop
            regions = [region for region in regions if region.end <= begin]
        leaned[first:end] = way
        changed = first + np.flatnonzero(np.abs(way - exact[first:end]).max(axis=1) > 1e-9)
        regions.append(PoleRegion(int(changed[0]), int(changed[-1]) + 1, lean, True))
        too_fast[first:end], solved[first:end] = False, True
    return leaned, regions, list(_remaining_passages(passages, too_fast, solved))


def _remaining_passages(passages: list[PolePassage], too_fast: Flags, solved: Flags) -> Iterator[PolePassage]:
    """What is left of cones in which too much is asked for."""
    for passage in passages:
        if too_fast[passage.first : passage.end + 1].any():
            edges = np.flatnonzero(np.diff(~solved[passage.first : passage.end], prepend=False, append=False))
            for first, end in (passage.first + edges).reshape(-1, 2).tolist():
                yield PolePassage(first, end)


def _breaks(task: _LeanTask, state: Codes) -> Flags:
    return np.asarray(task.unbound | (state & REWIND_STEP != 0))


def _windows(task: _LeanTask, too_fast: Flags, state: Codes, degrees: float) -> list[tuple[int, int]]:
    """Rows around those that are too fast, no two overlapping: so many that both axes can turn by ``degrees``."""
    breaks = _breaks(task, state)
    max_step = np.cumsum(np.where(breaks, 0.0, np.minimum(task.max_step.min(axis=1), degrees)))
    starts = np.append(np.flatnonzero(breaks), len(breaks))
    at = np.flatnonzero(too_fast)
    segment = np.searchsorted(starts, at, "right") - 1
    first = np.maximum(np.searchsorted(max_step, max_step[at] - degrees), starts[segment])
    end = np.minimum(np.searchsorted(max_step, max_step[at] + degrees, "right"), starts[segment + 1])
    parts: list[tuple[int, int]] = []
    for begin, stop in zip(first.tolist(), end.tolist(), strict=True):
        if parts and begin < parts[-1][1]:
            parts[-1] = (parts[-1][0], max(stop, parts[-1][1]))
        else:
            parts.append((begin, stop))
    return parts


def _unbroken_rows(task: _LeanTask, state: Codes, first: int) -> tuple[int, int]:
    """All rows from the last break before a row to the next one behind."""
    breaks = np.flatnonzero(_breaks(task, state))
    k = int(np.searchsorted(breaks, first, "right"))
    return int(breaks[k - 1]), int(breaks[k]) if k < len(breaks) else len(task.moves)


def _speed_limited_path(task: _LeanTask, exact: Floats, rows: Ints, angle: float) -> tuple[Floats | None, float]:
    """Positions (k, 2) for consecutive rows, and by how much the tool axis leans at most; None and NaN without any.

    Both ends stay where they are, unless a rapid is before or behind them.
    """
    axis, wanted = task.moves.axis[rows], exact[rows]
    max_step = np.where(
        is_endless(task.machine), np.minimum(task.max_step[rows], _LONGEST_SHORT_WAY), task.max_step[rows]
    )
    fixed = task.fixed[rows].copy()
    fixed[0] |= not task.unbound[rows[0]]
    behind = int(rows[-1]) + 1
    fixed[-1] |= behind < len(exact) and not task.unbound[behind]
    bounds = [(task.machine.axes[c].low, task.machine.axes[c].high) for c in task.machine.rotary]
    first, lean = least_lean(task.kinematics, axis, wanted[:, 0], max_step[:, 0], fixed, bounds[0], angle)
    if first is None:
        return None, np.nan
    for most in (lean, angle):
        second = second_angles_within(
            task.kinematics, axis, first, wanted[:, 1], max_step[:, 1], fixed, bounds[1], most
        )
        if second is not None:
            leaned = np.column_stack((first, second))
            off = float(_axis_deviation(task.machine, leaned, axis).max())
            if off <= angle + 1e-9:
                return leaned, off
    return None, np.nan


# ---------------------------------------------------------------------------------------------------------------------
# The result


def _axis_deviation(machine: Machine, rotary: Floats, axis: Floats) -> Floats:
    """(k,): degrees between the tool axes of rotary positions and others."""
    joints = np.zeros((len(rotary), 5))
    joints[:, list(machine.rotary)] = rotary
    apart = np.linalg.norm(forward(machine, joints)[1] - axis, axis=1)
    return np.asarray(np.degrees(2.0 * np.arcsin(np.minimum(0.5 * apart, 1.0))))


def _apply(task: _LeanTask, leaned: _LeanedPath, keep_slides: bool) -> LeanedMoves:
    """Put the new positions in the place of the others, with their slides and limits."""
    machine, moves, poses = task.machine, task.moves, leaned.poses
    rows = np.flatnonzero((np.abs(leaned.rotary - leaned.exact) > 1e-9).any(axis=1))
    lean = _axis_deviation(machine, leaned.rotary[rows], moves.axis[rows])
    axis = moves.axis.copy()
    leans = rows[lean > _NO_LEAN]
    joints = np.zeros((len(leans), 5))
    joints[:, list(machine.rotary)] = leaned.rotary[leans]
    axis[leans] = forward(machine, joints)[1]
    rotary = displayed_positions(machine, leaned.rotary)
    taken = _recheck_limits(
        machine, moves.tip, replace(poses, rotary=rotary), np.abs(rotary - poses.rotary), keep_slides
    )
    return LeanedMoves(replace(moves, axis=axis), taken, rows, lean, tuple(leaned.regions))


def _recheck_limits(
    machine: Machine, tip: Floats, poses: PlannedPoses, changed: Floats, keep_slides: bool
) -> PlannedPoses:
    """Slides and limits of poses in rows whose rotary positions have ``changed`` (n, 2)."""
    rows = np.flatnonzero((changed > 1e-9).any(axis=1))
    joints = slide_positions(machine, tip, poses.rotary)
    low, high = limits_of(machine, keep_slides)
    outside = (joints[rows] < low - LIMIT_TOLERANCE) | (joints[rows] > high + LIMIT_TOLERANCE)
    outcome, beyond = poses.outcome.copy(), poses.beyond_value.copy()
    outcome[rows] = np.where(outcome[rows] < REWIND, WITHIN_LIMITS, outcome[rows])
    for k in np.flatnonzero(outside.any(axis=1)).tolist():
        column = int(np.argmax(outside[k]))
        outcome[rows[k]], beyond[rows[k]] = column + 1, joints[rows[k], column]
    where = np.column_stack((joints.argmin(axis=0), joints.argmax(axis=0)))
    extremes = np.column_stack((joints.min(axis=0), joints.max(axis=0)))
    return replace(poses, outcome=outcome, beyond_value=beyond, extremes=extremes, extreme_rows=where)
