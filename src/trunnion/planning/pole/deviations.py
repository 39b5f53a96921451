"""Where an operation is not made as its CL file has it, because a rotary axis would have to be too fast.

Two things help, and both are asked for by name: near the pole the tool axis leans
(``trunnion.planning.pole.tool_axis_lean``), and the feed is lowered (``trunnion.planning.speed.rotary_speed``).
Without being asked, the planner says where an axis would be too fast, and what helps. Whatever departs from the CL
file is written down row by row, so that a proof can hold a program against it.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.errors import Problem, Severity
from trunnion.machines import Machine, kinematic_parameters
from trunnion.model.deviations import Deviations
from trunnion.model.motion import Decision, DecisionTopic, PoleStrategy
from trunnion.model.toolpath import Kind, Operation
from trunnion.planning.options import PlanOptions
from trunnion.planning.pole.lean_limits import degrees_off_pole
from trunnion.planning.pole.tool_axis_lean import LeanedMoves, PoleRegion, lean_tool_axis
from trunnion.planning.poses.selection import PlannedPoses
from trunnion.planning.retracts.rewind import Rewind
from trunnion.planning.speed.rotary_speed import OffPartTurns, find_fastest_row, lower_feeds

#: Places that are named one by one.
_NAMED = 20

#: Angles that are tried for what would do, each twice the one before.
_TRIED = 6


@dataclass(frozen=True, slots=True, eq=False)
class OperationTask:
    """An operation in the program's coordinate system, and what is asked of it.

    original  the operation as the CL file has it: its arcs are arcs
    """

    machine: Machine
    file: str
    operation: Operation
    original: Operation
    options: PlanOptions
    keep_slides: bool

    @property
    def source(self) -> Ints:
        """(n,) int64: the CL row that each row belongs to; rows that share one are lines for its arc."""
        return source_rows(self.original, self.operation)

    def decision(self, row: int, topic: DecisionTopic, text: str) -> Decision:
        """What was decided at a row."""
        operation = self.operation
        return Decision(self.file, operation.name, int(operation.moves.line[row]), row, topic, text)


def source_rows(before: Operation, after: Operation) -> Ints:
    """(n,) int64: the row of ``before`` that each row of ``after``, whose arcs may have become lines, belongs to.

    Lines for an arc carry the arc's line; where several rows of ``before`` have that line, they all count as its last.
    """
    count = len(before.moves)
    if len(after.moves) == count:
        return np.arange(count)
    starts = np.flatnonzero(np.diff(before.moves.line, prepend=before.moves.line[:1] - 1))
    unbound = np.flatnonzero(np.diff(after.moves.line, prepend=after.moves.line[:1] - 1))
    rows, lines = np.diff(starts, append=count), np.diff(unbound, append=len(after.moves))
    return np.concatenate(
        [
            np.arange(first, first + had) if had == has else np.full(has, first + had - 1)
            for first, had, has in zip(starts.tolist(), rows.tolist(), lines.tolist(), strict=True)
        ]
    )


def handle_pole(
    task: OperationTask, poses: PlannedPoses
) -> tuple[Operation, PlannedPoses, Deviations, list[Decision], list[Problem]]:
    """The operation and its poses with the pole looked after as the wishes say."""
    options, operation = task.options, task.operation
    if options.pole_strategy is PoleStrategy.OFF:
        return operation, poses, Deviations.none(), [], []
    found = _lean(task, poses, options.pole_strategy, options.pole_angle)
    log = [_pole_decision(task, region) for region in found.regions if region.found][:_NAMED]
    problems = []
    lacking = [region for region in found.regions if not region.found]
    if lacking:
        cure = _sufficient_setting(task, poses, options.pole_angle)
        problems = [_no_lean_problem(task, region, cure) for region in lacking[:_NAMED]]
    rows = found.rows
    deviations = replace(
        Deviations.none(),
        max_lean=options.pole_angle,
        leaned_rows=task.source[rows],
        leaned_rotary=found.poses.rotary[rows],
    )
    return replace(operation, moves=found.moves), found.poses, deviations, log, problems


def _lean(task: OperationTask, poses: PlannedPoses, strategy: PoleStrategy, angle: float) -> LeanedMoves:
    return lean_tool_axis(task.machine, task.operation, poses, task.keep_slides, strategy, angle, _fixed_rows(task))


def _fixed_rows(task: OperationTask) -> Flags:
    """Rows whose tool axis stays: the ends of arcs, and lines that stand for arcs."""
    source = task.source
    arc = task.operation.moves.kind == Kind.ARC
    pieces = np.diff(source, prepend=-1) == 0
    arc |= pieces | np.append(pieces[1:], False)
    return np.asarray(arc | np.append(arc[1:], False))


def _pole_decision(task: OperationTask, region: PoleRegion) -> Decision:
    line = task.operation.moves.line
    what = {
        PoleStrategy.HOLD: "holds its angle",
        PoleStrategy.SPREAD: "turns evenly",
        PoleStrategy.LEAN: "keeps within its speed",
    }[task.options.pole_strategy]
    name = task.machine.axes[task.machine.rotary[0]].name
    ways = f"lines {line[region.first]} to {line[region.end - 1]}"
    text = f"axis {name} {what} near the pole, {ways}; the tool axis leans by up to {region.lean:.4f} degrees"
    return task.decision(region.first, DecisionTopic.POLE, text)


def _sufficient_setting(task: OperationTask, poses: PlannedPoses, angle: float) -> str:
    """What would do where ``angle``, degrees, is too small."""
    for more in angle * 2.0 ** np.arange(1, _TRIED):
        if all(region.found for region in _lean(task, poses, PoleStrategy.LEAN, float(more)).regions):
            return f"--set pole=lean --set pole_angle={more:.4g} would do, or --set lower_feed=yes"
    return "--set lower_feed=yes lowers the feed there"


def _no_lean_problem(task: OperationTask, region: PoleRegion, cure: str) -> Problem:
    line = task.operation.moves.line
    name = task.machine.axes[task.machine.rotary[0]].name
    what = (
        f"no lean of the tool axis by up to {task.options.pole_angle:g} degrees keeps axis {name} within its speed"
        f" up to line {line[region.end - 1]}"
    )
    return Problem(task.file, int(line[region.first]), what, cure, Severity.WARNING)


def limit_speeds(
    task: OperationTask, poses: PlannedPoses, rewinds: Sequence[Rewind]
) -> tuple[Operation, Deviations, list[Decision]]:
    """The operation with the feeds that it is made with; said where they are lowered, or where an axis is too fast.

    ``task`` has the operation, ``poses`` the positions with which it is made, ``rewinds`` what goes in between.
    """
    operation = task.operation
    rows = np.array([rewind.row for rewind in rewinds], np.int64)
    off_part = OffPartTurns(rows, np.array([rewind.after for rewind in rewinds]).reshape(-1, 2))
    if not task.options.lower_feed:
        return operation, Deviations.none(), list(_speed_decisions(task, poses, off_part))
    moves, rows = lower_feeds(task.machine, operation, poses.rotary, off_part, task.source)
    slow = replace(operation, moves=moves)
    cl, last = np.unique(task.source[rows], return_index=True)
    deviations = replace(Deviations.none(), slowed_rows=cl, slowed_feed=moves.feed[rows[last]])
    log = list(_feed_decisions(task, rows, moves.feed))
    return slow, deviations, [*log, *_speed_decisions(replace(task, operation=slow), poses, off_part)]


def _feed_decisions(task: OperationTask, rows: Ints, feed: Floats) -> Iterator[Decision]:
    """One decision for each unbroken stretch of rows."""
    stretches: Sequence[Ints] = np.split(rows, np.flatnonzero(np.diff(rows) != 1) + 1) if len(rows) else []
    moves = task.operation.moves
    for stretch in stretches[:_NAMED]:
        least = stretch[np.argmin(feed[stretch])]
        text = (
            f"feed lowered from {moves.feed[least]:g} to {feed[least]:.2f} and more, lines {moves.line[stretch[0]]} to"
            f" {moves.line[stretch[-1]]}, so that the rotary axes can follow"
        )
        yield task.decision(int(stretch[0]), DecisionTopic.FEED, text)
    if len(stretches) > _NAMED:
        text = f"feed lowered in {len(stretches) - _NAMED} further places, the last here"
        yield task.decision(int(stretches[-1][0]), DecisionTopic.FEED, text)


def _speed_decisions(task: OperationTask, poses: PlannedPoses, off_part: OffPartTurns) -> Iterator[Decision]:
    """Where a rotary axis would have to be faster than it can, and what helps; looked for if somebody asks."""
    machine, operation, options = task.machine, task.operation, task.options
    if not (options.explain or options.lower_feed or options.pole_strategy is not PoleStrategy.OFF):
        return
    worst = find_fastest_row(machine, operation, poses.rotary, off_part)
    if not worst.count:
        return
    axis = machine.axes[machine.rotary[worst.axis]]
    off = float(degrees_off_pole(kinematic_parameters(machine), operation.moves.axis[worst.row : worst.row + 1])[0])
    cure = "--set lower_feed=yes"
    if options.pole_strategy is PoleStrategy.OFF:
        cure = "--set pole=lean, or --set lower_feed=yes, helps"
        if options.explain and not options.lower_feed:
            cure = _sufficient_setting(task, poses, 0.01)
    rows = f"{worst.count} rows are" if worst.count > 1 else "1 row is"
    yield task.decision(
        worst.row,
        DecisionTopic.SPEED,
        f"axis {axis.name} would need {100.0 * worst.share:.0f} % of its rapid speed, {axis.rapid:g} degrees/min,"
        f" {off:.3f} degrees off the pole; {rows} too fast, and the control slows down there: {cure}",
    )
