"""Rapids that go sideways below the height to which the tool was last retracted.

A height in machine coordinates is compared with one of the workpiece only where zero and tool length are known.
"""

import math
from collections.abc import Iterator
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.messages import Wording
from trunnion.model.programmed_words import POSITION_WORDS
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind
from trunnion.verification.checks.skipped_ways import points_behind_ways, ways_behind_skipped
from trunnion.verification.context import ComparedContext, Context
from trunnion.verification.kinematics.machine_positions import MachinePositions
from trunnion.verification.kinematics.positioning_moves import approach_rows
from trunnion.verification.matching.hole_approaches import hole_approach_rows
from trunnion.verification.matching.hole_matching import hole_rows, match_holes
from trunnion.verification.results import Place

#: Smaller motion, mm, is none.
_STILL: Final = 1e-3


def low_rapids(context: Context) -> Iterator[Place]:
    """Places of low rapids that no CL file asks for."""
    run = context.run
    suspects = _suspects(context)
    if not suspects.any():
        return
    rapids = np.flatnonzero((run.kind == Kind.RAPID) & ((run.programmed & int(POSITION_WORDS)) != 0))
    rapids = rapids[~run.state.machine_frame.at(rapids)]
    before, after, tools = run.positions(np.maximum(rapids - 1, 0)), run.positions(rapids), run.state.tool.at(rapids)
    begins_known, ends_known = ~_unknown_heights(run, np.maximum(rapids - 1, 0)), ~_unknown_heights(run, rapids)
    retracts = np.sort(np.array([event.before_row for event in run.events if event.kind == "retract"], np.int64))
    count = np.searchsorted(retracts, rapids, side="right")  # retracts up to each rapid
    retracted_before = np.diff(count, prepend=0) > 0
    height: float | None = None
    axis, tool, entry = np.zeros(3), -1, -math.inf
    for k, row in enumerate(rapids.tolist()):
        if np.abs(after.axis[k] - axis).max() > 1e-6 or tools[k] != tool or retracted_before[k]:
            height, axis, tool = None, after.axis[k], int(tools[k])
        if not ends_known[k]:
            continue  # as high as a machine position, which nobody can compare with the workpiece
        start, end = before.tip[k], after.tip[k]
        step = end - start
        up = float(step @ axis)
        aside = float(np.linalg.norm(step - up * axis))
        highest = max(float(start @ axis), float(end @ axis))
        if height is not None and (left := _height_left_at(run, row, axis, entry)) is not None:
            height = min(height, left)
        if height is None or (begins_known[k] and aside <= _STILL and up > _STILL):
            height = float(end @ axis)
        elif begins_known[k] and suspects[row] and aside > _STILL and highest < height - _STILL:
            yield context.place(row, height - highest, Wording("modal", "sideways", below=height - highest))
        entry = float(end @ axis)


def rapids_at_unknown_heights(context: Context) -> Ints:
    """Return the rapids that ``low_rapids`` cannot judge, as they stand at a machine position that nobody can compare
    with the workpiece, (k,), increasing; first legs of approaches are none.
    """
    run = context.run
    rapids = np.flatnonzero((run.kind == Kind.RAPID) & ((run.programmed & int(POSITION_WORDS)) != 0))
    rapids = rapids[_unknown_heights(run, rapids)]
    return np.asarray(rapids[_suspects(context)[rapids]] if len(rapids) else rapids, np.int64)


def skipped_retracts(context: Context) -> Iterator[Place]:
    """Places that leave the cut sideways as the CL file lets the operator skip the retract before them.

    The CL file without what is skipped asks for that motion, so that nothing else would tell.
    """
    if not isinstance(context, ComparedContext) or not context.expected.without_retract:
        return
    expected, safe = context.expected, points_behind_ways(context)
    for nc, cl in context.matching.all_pair_chunks():
        for row, point in zip(nc.tolist(), cl.tolist(), strict=True):
            line = (expected.section_at(point).file, expected.point(point).line)
            if line in expected.without_retract and row not in safe:
                is_rapid, comes_down = context.run.kind[row] == Kind.RAPID, _comes_from_rapid(context, row)
                at_feed = "plunge_skipped" if comes_down else "retract_skipped_at_feed"
                how = "retract_skipped_at_rapid" if is_rapid else at_feed
                yield context.place(row, 0.0, Wording("modal", how))


def _comes_from_rapid(context: ComparedContext, row: int) -> bool:
    """Whether the motion to the CL point before that of a row is a rapid."""
    k = context.matching.nc.count_before(row)
    return k > 0 and bool(context.run.kind[int(context.matching.nc[k - 1])] == Kind.RAPID)


def _height_left_at(run: Run, row: int, axis: Floats, entry: float) -> float | None:
    """Return the height to which a cycle, or a motion at feed, has retracted the tool straight up right before a rapid.

    A motion at feed is a retract if it ends no lower than the last rapid before it did (``entry``).
    """
    if row < 2 or (run.kind[row - 1] == Kind.RAPID and run.programmed[row - 1]):
        return None
    rows = np.array([row - 2, row - 1])
    if _unknown_heights(run, rows).any():
        return None
    tip = run.positions(rows).tip
    step = tip[1] - tip[0]
    up = float(step @ axis)
    height = float(tip[1] @ axis)
    straight = up > _STILL and float(np.linalg.norm(step - up * axis)) <= _STILL
    by_cycle = not run.programmed[row - 1]
    return height if straight and (by_cycle or height >= entry - _STILL) else None


def _unknown_heights(run: Run, rows: Ints) -> Flags:
    """After which rows the tool is as high as a slide at a machine position, which nobody can compare with the
    workpiece, (k,) bool.
    """
    unplaced = MachinePositions.of(run).unplaced(rows)
    found = np.zeros(len(rows), np.bool_)
    if not unplaced.any():
        return found
    positions = run.positions(rows)
    tip = run.forward_at(rows, positions.joints)[0]
    for column in run.machine.linear:
        joints = positions.joints.copy()
        joints[:, column] += 1.0
        rise = np.einsum("ij,ij->i", run.forward_at(rows, joints)[0] - tip, positions.axis)
        found |= unplaced[:, column] & (np.abs(rise) > _STILL)
    return found


def _suspects(context: Context) -> Flags:
    """Which rows may be low rapids, (n,) bool: not those of holes, and not those that the CL file asks for."""
    run = context.run
    suspects = np.zeros(len(run), np.bool_)
    rapids = np.flatnonzero(run.kind == Kind.RAPID)
    suspects[rapids[~run.state.machine_frame.at(rapids)]] = True
    if isinstance(context, ComparedContext):
        expected, matching = context.expected, context.matching
        for nc, cl in matching.all_pair_chunks():
            suspects[nc[expected.kind(cl) == Kind.RAPID]] = False
        holes = match_holes(run, expected)
        suspects[list(hole_approach_rows(run, matching.extra, holes, expected.max_tip_tolerance))] = False
        suspects[list(ways_behind_skipped(context))] = False
    else:
        holes = match_holes(run)
    suspects[hole_rows(holes)] = False
    suspects[approach_rows(run)] = False  # as high as home, which nothing in the program determines
    return suspects
