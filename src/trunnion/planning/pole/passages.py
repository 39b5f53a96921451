"""Passages: stretches of rows near the pole, in which the first rotary axis is led on its own.

In a passage the tool axis counts as standing in the pole, so that either branch goes on behind it
(``trunnion.planning.poses.optimizer``). Whatever the first angle becomes, the second one follows: it brings the tool
axis as near to the CAM's as that angle allows. The tip stays where it is.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from trunnion.arrays import Flags, Floats
from trunnion.machines.inverse import inverse
from trunnion.planning.axis_limits import outside_limits
from trunnion.planning.pole.lean_limits import closest_second_angles, degrees_off_pole
from trunnion.planning.pole.lean_task import LeanTask, PoleRegion, axis_deviation
from trunnion.planning.poses.placement import OUT_OF_REACH
from trunnion.planning.poses.selection import PlannedPoses, cheapest_states, choose_poses, poses_of_states
from trunnion.records import dataclass


@dataclass(frozen=True, slots=True)
class PolePassage:
    """Rows ``first`` to ``end`` (exclusive) with tool axes near the pole."""

    first: int
    end: int

    @property
    def rows(self) -> slice:
        """The same as a slice."""
        return slice(self.first, self.end)


def find_passages(task: LeanTask, too_fast: Flags, angle: float) -> list[PolePassage]:
    """Unbroken rows within ``angle`` degrees of the pole, if a step in them or out of them is ``too_fast`` (n,)."""
    inside = (degrees_off_pole(task.kinematics, task.moves.axis) <= angle) & ~task.fixed
    edges = np.flatnonzero(np.diff(inside, prepend=False, append=False)).reshape(-1, 2)
    return [PolePassage(first, end) for first, end in edges.tolist() if too_fast[first : end + 1].any()]


def remaining_passages(passages: Sequence[PolePassage], too_fast: Flags, solved: Flags) -> Iterator[PolePassage]:
    """Yield the rows that are not ``solved`` (n,) of passages in which a step is still ``too_fast`` (n,)."""
    for passage in passages:
        if too_fast[passage.first : passage.end + 1].any():
            edges = np.flatnonzero(np.diff(~solved[passage.rows], prepend=False, append=False))
            for first, end in (passage.first + edges).reshape(-1, 2).tolist():
                yield PolePassage(first, end)


def poses_through_pole(
    task: LeanTask, poses: PlannedPoses, passages: list[PolePassage], choose_branch: bool = True
) -> tuple[PlannedPoses, list[PolePassage]]:
    """Poses with the tool axis in the pole within the passages, unless limits or reach forbid them.

    In these poses the first angle holds within the passages. Without ``choose_branch`` the branch in which most cuts
    begin is not preferred.

    poses, passages  the poses as they were if the others are no better; and no passages if the pole cannot be reached
    """
    if not passages:
        return poses, passages
    pole = np.array(task.kinematics.basis_1[6:])
    axis = task.moves.axis.copy()
    for passage in passages:
        axis[passage.rows] = np.where(axis[passage.rows] @ pole > 0.0, 1.0, -1.0)[:, None] * pole
    machine, moves, keep = task.machine, replace(task.moves, axis=axis), task.keep_slide_limits
    solutions = inverse(machine, moves.tip[: passages[0].end], moves.axis[: passages[0].end])
    if not solutions.reachable[passages[0].first]:
        return poses, []
    if choose_branch:
        through = choose_poses(machine, moves, keep)
    else:
        through = poses_of_states(machine, moves, cheapest_states(machine, moves, keep), keep)
    if (through.outcome == OUT_OF_REACH).any() or np.count_nonzero(through.outcome) > np.count_nonzero(poses.outcome):
        return poses, passages
    return through, passages


def exact_positions(task: LeanTask, continuous: Floats, passages: Sequence[PolePassage]) -> Floats:
    """Positions under which nothing leans; in passages those within limits that are nearest to an even turn.

    ``continuous`` and the result are (n, 2), degrees, as the axes wind.
    """
    exact = continuous.copy()
    low, high = task.machine.limits[list(task.machine.rotary)].T
    for passage in passages:
        rows = passage.rows
        first, last = _angles_at_ends(continuous, passage)
        even = first + _path_share(task.moves.tip, passage) * (last - first)
        target = np.stack((even, continuous[rows, 1]), axis=1)
        solutions = inverse(task.machine, task.moves.tip[rows], task.moves.axis[rows])
        found = solutions.joints[:, :, list(task.machine.rotary)]
        found[:, solutions.pole, 0] = even[solutions.pole]
        offset = found - target
        offset -= 360.0 * np.rint(offset / 360.0)
        outside = outside_limits(target + offset, low, high).any(axis=2)
        best = np.argmin(np.abs(offset[:, :, 0]) + np.where(outside, 1e6, 0.0), axis=0)
        exact[rows] = target + offset[best, np.arange(len(best))]
    return exact


def hold_or_spread(
    task: LeanTask, exact: Floats, passages: Sequence[PolePassage], spread: bool
) -> tuple[Floats, list[PoleRegion]]:
    """Positions (n, 2) with the first angle held in each passage, or turning evenly along the tip's path."""
    leaned, regions = exact.copy(), []
    for passage in passages:
        rows = passage.rows
        first, last = _angles_at_ends(exact, passage)
        leaned[rows, 0] = first + (_path_share(task.moves.tip, passage) * (last - first) if spread else 0.0)
        axis = task.moves.axis[rows]
        leaned[rows, 1] = closest_second_angles(task.machine, task.kinematics, axis, leaned[rows, 0], exact[rows, 1])
        lean = float(axis_deviation(task.machine, leaned[rows], axis).max())
        regions.append(PoleRegion(passage.first, passage.end, lean, True))
    return leaned, regions


def _angles_at_ends(continuous: Floats, passage: PolePassage) -> tuple[float, float]:
    """First angle before and after a passage; at an end of the operation the other one, as nothing turns there."""
    before = continuous[passage.first - 1, 0] if passage.first else np.nan
    after = continuous[passage.end, 0] if passage.end < len(continuous) else before
    before = after if np.isnan(before) else before
    return (continuous[0, 0], continuous[0, 0]) if np.isnan(before) else (float(before), float(after))


def _path_share(tip: Floats, passage: PolePassage) -> Floats:
    """(k,): share of the tip's path, from before a passage to after it, that is done at each of its rows."""
    start, stop = max(passage.first - 1, 0), min(passage.end + 1, len(tip))
    length = np.linalg.norm(np.diff(tip[start:stop], axis=0), axis=1)
    total = length.sum()
    if not total > 0.0:
        return np.zeros(passage.end - passage.first)
    share = np.concatenate(([0.0], np.cumsum(length) / total))
    return np.asarray(share[passage.first - start : passage.end - start])
