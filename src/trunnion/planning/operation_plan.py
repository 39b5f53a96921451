"""Second stage: the axis positions of one operation, its rewinds, and what deviates from the CL file near the pole."""

from dataclasses import field

from trunnion.errors import Problem, Severity
from trunnion.model.deviations import Deviations
from trunnion.model.motion import Decision, MachiningMode, Motion
from trunnion.model.toolpath import Operation
from trunnion.planning.holes.operations import extract_rows
from trunnion.planning.plan_problems import pose_problems, rewind_problems, winding_problems
from trunnion.planning.pole.handling import handle_pole
from trunnion.planning.poses.decision_log import ChosenPoses, pose_decisions
from trunnion.planning.poses.placement import OUT_OF_REACH
from trunnion.planning.poses.reach_limits import judge_reach
from trunnion.planning.poses.selection import PlannedPoses, choose_poses
from trunnion.planning.request import PreparedOperation
from trunnion.planning.retracts.rewind import (
    Rewind,
    find_rewinds,
    insert_rewinds,
    row_after_rewinds,
    rows_with_rewinds,
    widen_extremes,
)
from trunnion.planning.speed.feed_limits import limit_feeds
from trunnion.records import dataclass


@dataclass(frozen=True, slots=True, eq=False)
class PlannedOperation:
    """An operation with its axis positions, before the rows of rewinds are in.

    operation  with the tool axes and feeds that the machine will have
    rewinds    those to be inserted
    """

    prepared: PreparedOperation
    operation: Operation
    poses: PlannedPoses
    rewinds: tuple[Rewind, ...] = ()
    deviations: Deviations = field(default_factory=Deviations.none)
    problems: tuple[Problem, ...] = ()
    log: tuple[Decision, ...] = ()

    @property
    def is_out_of_reach(self) -> bool:
        """Whether no pose gives some tool axis."""
        return bool((self.poses.outcome == OUT_OF_REACH).any())

    @property
    def has_errors(self) -> bool:
        """Whether the operation must not run."""
        return any(problem.severity is Severity.ERROR for problem in self.problems)

    def motions(self) -> list[Motion]:
        """Return the operation as motions, with the rows of rewinds: one, or one for each part."""
        prepared = self.prepared
        feed_share = prepared.request.options.reengage_feed_share
        operation, rotary = insert_rewinds(self.operation, self.poses.rotary, self.rewinds, feed_share)
        is_wanted = prepared.request.options.fastest_feed
        cl_rows = rows_with_rewinds(prepared.source_rows, self.rewinds) if is_wanted else None
        if not prepared.parts:
            plane = prepared.plane(prepared.operation.moves.axis[0], self.poses.rotary[0])
            return [Motion(operation, rotary, prepared.mode, plane, self.deviations, cl_rows=cl_rows)]
        motions = []
        for part in prepared.parts:
            first, end = (row_after_rewinds(row, self.rewinds) for row in (part.first, part.end))
            motions.append(
                Motion(
                    extract_rows(operation, first, end),
                    rotary[first:end].copy(),
                    prepared.mode,
                    prepared.plane(operation.moves.axis[first], rotary[first]),
                    self.deviations if part.first == 0 else Deviations.none(),
                    starts_operation=part.first == 0,
                    ends_in_hole=part.ends_in_hole,
                    cl_rows=None if cl_rows is None else cl_rows[first:end],
                )
            )
        return motions


def plan_operation(prepared: PreparedOperation) -> PlannedOperation:
    """Choose the axis positions of an operation."""
    request, file, moves = prepared.request, prepared.file, prepared.operation.moves
    machine, options, keep_slide_limits = request.machine, request.options, request.keeps_slide_limits
    poses = choose_poses(machine, moves, keep_slide_limits)
    if (poses.outcome == OUT_OF_REACH).any():
        problems = tuple(pose_problems(file, prepared.operation, poses, request))
        return PlannedOperation(prepared, prepared.operation, poses, problems=problems, log=tuple(prepared.log))
    near_pole = handle_pole(prepared, poses)
    poses = near_pole.poses
    judge_reach(poses, machine, near_pole.operation, keep_slide_limits)
    chosen = ChosenPoses(machine, file, near_pole.operation, poses.rotary, poses.state, keep_slide_limits)
    # Rapids are straight under TCP; without it each slide may arrive in its own time.
    rewinds = find_rewinds(chosen, poses, options.clearance, at_rapid=prepared.mode is MachiningMode.TCP)
    feeds = limit_feeds(prepared.with_operation(near_pole.operation), poses, rewinds, near_pole.deviations)
    problems = (
        *near_pole.problems,
        *pose_problems(file, prepared.operation, poses, request),
        *rewind_problems(chosen, rewinds, request),
        *winding_problems(chosen, request),
    )
    if options.allow_rewinds:
        widen_extremes(poses, machine, moves, rewinds)
    reasons = {rewind.row: rewind.reason for rewind in rewinds}
    decisions = pose_decisions(chosen, poses.changes, reasons) if options.explain else []
    return PlannedOperation(
        prepared,
        feeds.operation,
        poses,
        rewinds if options.allow_rewinds else (),
        feeds.deviations,
        problems,
        (*decisions, *near_pole.log, *feeds.log, *prepared.log),
    )
