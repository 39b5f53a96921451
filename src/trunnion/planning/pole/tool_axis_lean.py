"""Near the pole the first rotary axis is led on its own, and the tool axis may lean a little so that this is possible.

Where the tool axis passes close by the first rotary axis, that axis must turn far within a short path. The tool axis
may leave the CAM's by a given angle and no more, so the first angle is free within a cone of that angle about the pole.

    hold    the first axis holds within the cone, and turns in the step that leads out of it
    spread  it turns evenly over the cone, along the tip's path
    lean    both axes turn no faster than they can, in the cone and around it, and the tool axis leans by the least
            angle that allows it; where no lean within the given angle does, the turn is spread over the cone

Only passages and rows in which an axis would exceed its rapid speed are looked after.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from trunnion.arrays import Codes, Flags, Floats, Ints
from trunnion.machines import slide_positions
from trunnion.model.motion import PoleStrategy
from trunnion.planning.axis_limits import limits_of, outside_limits
from trunnion.planning.pole.lean_task import LeanedMoves, LeanTask, PoleRegion, axis_deviation
from trunnion.planning.pole.passages import (
    PolePassage,
    exact_positions,
    find_passages,
    hold_or_spread,
    poses_through_pole,
)
from trunnion.planning.pole.speed_limited_path import limit_speed
from trunnion.planning.poses.placement import REWIND, WITHIN_LIMITS
from trunnion.planning.poses.selection import PlannedPoses
from trunnion.planning.rotary_positions import continuous_positions, displayed_positions, tool_axes
from trunnion.planning.speed.rotary_speed import USABLE_SHARE
from trunnion.records import dataclass

#: Cones about the pole, as multiples of the given angle, in which the branch may change where nothing else helps.
_CONE_FACTORS: Final = (1.0, 2.0, 4.0, 8.0)

#: A tool axis that leans by less than this, degrees, is the CAM's: CL files are rounded by more.
_NO_LEAN: Final = 1e-7

#: Positions differ from this on, degrees.
_CHANGED: Final = 1e-9


@dataclass(frozen=True, slots=True, eq=False)
class _LeanedPath:
    """New positions in place of the exact ones.

    exact   (n, 2) float64  under which nothing leans, degrees as they wind
    rotary  (n, 2) float64  the new ones
    """

    poses: PlannedPoses
    exact: Floats
    rotary: Floats
    regions: list[PoleRegion]

    @property
    def unsolved(self) -> int:
        """How many regions are not solved."""
        return sum(not region.is_solved for region in self.regions)


def lean_tool_axis(task: LeanTask, poses: PlannedPoses, strategy: PoleStrategy) -> LeanedMoves:
    """Apply a strategy.

    poses     those under the CAM's tool axes
    strategy  any but OFF
    """
    too_fast = task.exceeds_speed(continuous_positions(task.machine, poses.rotary), poses.state)
    if not too_fast.any():
        return LeanedMoves(task.moves, poses, np.zeros(0, np.int64), np.zeros(0), ())
    path = _lean(task, strategy, *poses_through_pole(task, poses, find_passages(task, too_fast, task.angle)))
    if strategy is PoleStrategy.LEAN and path.unsolved:
        without_passages = _lean(task, strategy, poses, [])
        path = without_passages if without_passages.unsolved < path.unsolved else path
        path = _lean_to_other_branch(task, poses, too_fast) or path
    return _apply(task, path)


def _lean_to_other_branch(task: LeanTask, poses: PlannedPoses, too_fast: Flags) -> _LeanedPath | None:
    """Return a path that changes to the other branch at the pole or, in wider cones, farther from it; None if none
    solves.
    """
    for factor in _CONE_FACTORS:
        passages = find_passages(task, too_fast, factor * task.angle)
        if not passages:
            continue
        path = _lean(task, PoleStrategy.LEAN, *poses_through_pole(task, poses, passages, choose_branch=False))
        if not path.unsolved:
            return path
    return None


def _lean(task: LeanTask, strategy: PoleStrategy, poses: PlannedPoses, passages: Sequence[PolePassage]) -> _LeanedPath:
    exact = exact_positions(task, continuous_positions(task.machine, poses.rotary), passages)
    if strategy is not PoleStrategy.LEAN:
        rotary, regions = hold_or_spread(task, exact, passages, spread=strategy is PoleStrategy.SPREAD)
        return _LeanedPath(poses, exact, rotary, regions)
    rotary, regions, unsolved = limit_speed(task, exact, poses.state, passages)
    rotary, _ = hold_or_spread(task, rotary, unsolved, spread=True)
    regions += _regions_still_too_fast(task, rotary, poses.state, regions)
    lean = [_greatest_lean(task, rotary, region) for region in regions]
    return _LeanedPath(
        poses, exact, rotary, [replace(region, lean=most) for region, most in zip(regions, lean, strict=True)]
    )


def _greatest_lean(task: LeanTask, rotary: Floats, region: PoleRegion) -> float:
    rows = slice(region.first, region.end)
    return float(axis_deviation(task.machine, rotary[rows], task.moves.axis[rows]).max())


def _regions_still_too_fast(
    task: LeanTask, rotary: Floats, state: Codes, regions: Sequence[PoleRegion]
) -> Iterator[PoleRegion]:
    """Rows in which an axis is too fast all the same, such as those between two regions."""
    too_fast = task.exceeds_speed(rotary, state, USABLE_SHARE)
    for region in regions:
        too_fast[region.first : region.end] &= region.is_solved
    edges = np.flatnonzero(np.diff(too_fast, prepend=False, append=False))
    for first, end in edges.reshape(-1, 2).tolist():
        yield PoleRegion(first, end, 0.0, False)


def _apply(task: LeanTask, path: _LeanedPath) -> LeanedMoves:
    """Poses, tool axes and limits with the new positions."""
    machine, moves, poses = task.machine, task.moves, path.poses
    rows = np.flatnonzero((np.abs(path.rotary - path.exact) > _CHANGED).any(axis=1))
    lean = axis_deviation(machine, path.rotary[rows], moves.axis[rows])
    axis = moves.axis.copy()
    leaning = rows[lean > _NO_LEAN]
    axis[leaning] = tool_axes(machine, path.rotary[leaning])
    rotary = displayed_positions(machine, path.rotary)
    changed = np.flatnonzero((np.abs(rotary - poses.rotary) > _CHANGED).any(axis=1))
    checked = _recheck_limits(task, replace(poses, rotary=rotary), changed)
    return LeanedMoves(replace(moves, axis=axis), checked, rows, lean, tuple(path.regions))


def _recheck_limits(task: LeanTask, poses: PlannedPoses, rows: Ints) -> PlannedPoses:
    """Check limits again at ``rows``, and find the extremes of all axes."""
    joints = slide_positions(task.machine, task.moves.tip, poses.rotary)
    outside = outside_limits(joints[rows], *limits_of(task.machine, task.keep_slide_limits))
    outcome, beyond = poses.outcome.copy(), poses.beyond_value.copy()
    outcome[rows] = np.where(outcome[rows] < REWIND, WITHIN_LIMITS, outcome[rows])
    for k in np.flatnonzero(outside.any(axis=1)).tolist():
        column = int(np.argmax(outside[k]))
        outcome[rows[k]], beyond[rows[k]] = column + 1, joints[rows[k], column]
    extreme_rows = np.column_stack((joints.argmin(axis=0), joints.argmax(axis=0)))
    extremes = np.column_stack((joints.min(axis=0), joints.max(axis=0)))
    return replace(poses, outcome=outcome, beyond_value=beyond, extremes=extremes, extreme_rows=extreme_rows)
