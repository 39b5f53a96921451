"""What is wrong with a plan, in messages: axes beyond their limits, rewinds, and slides without enough travel."""

import math
from collections.abc import Iterable, Sequence
from typing import Final

import numpy as np

from trunnion.arrays import Floats, distinct
from trunnion.errors import Problem, warning
from trunnion.machines import Machine, inverse, spindle_speed_fault
from trunnion.messages import Wording, phrase
from trunnion.model.motion import PoleStrategy
from trunnion.model.toolpath import Kind, Moves, Operation, SpindleOn
from trunnion.planning.axis_limits import exceeds_travel, limit_remedy, limit_violation_text, limits_of, outside_limits
from trunnion.planning.holes.operations import cycle_row_ranges
from trunnion.planning.poses.decision_log import ChosenPoses, describe_pose
from trunnion.planning.poses.limit_lookahead import degrees_out_of_reach
from trunnion.planning.poses.placement import BLOCKED, OUT_OF_REACH, REWIND
from trunnion.planning.poses.selection import PlannedPoses
from trunnion.planning.request import PlanRequest
from trunnion.planning.retracts.rewind import Rewind, is_radius_compensated, retract_positions, slide_beyond_limits
from trunnion.planning.rotary_positions import wound_turns
from trunnion.wording import format_duration

#: How many rows with the same trouble are named one by one.
_NAMED: Final = 5


def unknown_speed_problems(file: str, request: PlanRequest) -> Iterable[Problem]:
    """Yield a warning if speeds of rotary axes are to be limited, and the definition does not state them."""
    machine, options = request.machine, request.options
    names = [machine.axes[column].name for column in machine.own_rotary if machine.axes[column].rapid is None]
    if names and (options.pole_strategy is not PoleStrategy.OFF or options.lower_feed):
        yield warning(file, 0, Wording("PLN420", "definition_no_rapid", machine=machine.key, names=tuple(names)))


def spindle_speed_problems(file: str, operation: Operation, machine: Machine) -> Iterable[Problem]:
    """Spindle speeds that the machine does not have."""
    for event in operation.events:
        if isinstance(event, SpindleOn) and (fault := spindle_speed_fault(machine, event.rpm)):
            yield Problem(file, event.line, Wording("PLN430", "no_such_speed", fault=fault))


def rewind_problems(chosen: ChosenPoses, rewinds: Sequence[Rewind], request: PlanRequest) -> Iterable[Problem]:
    """One warning about all rewinds, or errors where they are not allowed or have no room."""
    machine, moves, options = chosen.machine, chosen.operation.moves, request.options
    made: list[Rewind] = []
    for rewind in rewinds:
        line = int(moves.line[rewind.row])
        if not options.allow_rewinds:
            yield _forbidden_rewind(chosen, rewind)
            continue
        if not math.isfinite(rewind.retract_distance):
            yield Problem(chosen.file, line, Wording("PLN230", "tool_must_rewind", clearance=options.clearance))
            continue
        made.append(rewind)
        if is_radius_compensated(chosen.operation, rewind.row):
            yield Problem(chosen.file, line, Wording("PLN230", "rewind_within_cutter"))
        joints = retract_positions(machine, moves, rewind)
        column = slide_beyond_limits(machine, joints) if chosen.keep_slide_limits else None
        if column is not None:
            values = joints[:, column]
            value = values.max() if values.max() > machine.axes[column].high else values.min()
            yield Problem(
                chosen.file,
                line,
                Wording(
                    "PLN230", "retract_rewind", limit_violation_text=limit_violation_text(machine, column, float(value))
                ),
            )
    if made:
        yield _made_rewinds(chosen, made, options.reengage_feed_share)


def _made_rewinds(chosen: ChosenPoses, rewinds: Sequence[Rewind], feed_share: float) -> Problem:
    """Return the warning about rewinds: where they are, what they cost, and why the first one is needed."""
    moves, first = chosen.operation.moves, rewinds[0]
    said: dict[str, object] = {"distance": max(one.retract_distance for one in rewinds), "reason": first.reason}
    variant = "one_rewind"
    if len(rewinds) > 1:
        lines = [str(moves.line[one.row]) for one in rewinds]
        named = ", ".join(lines[:_NAMED]) + (f" … {lines[-1]}" if len(lines) > _NAMED else "")
        per_min = [not moves.per_rev[one.row] for one in rewinds]
        seconds = sum(one.seconds(chosen.machine, float(moves.feed[one.row]), feed_share) for one in rewinds)
        said |= {"count": len(rewinds), "lines": named}
        variant = "rewinds"
        if all(per_min):
            said["time"], variant = format_duration(seconds), "rewinds_of_time"
    wording = Wording("PLN220", variant, **said)
    return warning(chosen.file, int(moves.line[first.row]), wording)


def winding_problems(chosen: ChosenPoses, request: PlanRequest) -> Iterable[Problem]:
    """Yield a warning for each rotary axis that ends some turns from home, where it has to go back through all
    of them.
    """
    machine = request.machine
    for column, turns in wound_turns(machine, chosen.rotary):
        axis = machine.axes[column]
        yield warning(
            chosen.file,
            int(chosen.operation.moves.line[-1]),
            (
                Wording(
                    "PLN240",
                    "axis_ends_turns" if axis.endless else "axis_ends_turns_from",
                    operation=chosen.operation.name,
                    axis=axis.name,
                    turns=turns,
                )
            )
            if axis.rapid is None
            else (
                Wording(
                    "PLN240",
                    "axis_ends_turns_from_home" if axis.endless else "axis_ends",
                    operation=chosen.operation.name,
                    axis=axis.name,
                    turns=turns,
                    format_duration=format_duration(60.0 * 360.0 * turns / axis.rapid),
                )
            ),
        )


def _forbidden_rewind(chosen: ChosenPoses, rewind: Rewind) -> Problem:
    row = rewind.row
    if rewind.limit_hit is not None:
        row, hit = rewind.limit_hit.row, rewind.limit_hit
    return Problem(
        chosen.file,
        int(chosen.operation.moves.line[row]),
        Wording("PLN210", "cut", limit_violation_text=limit_violation_text(chosen.machine, hit.column, hit.value))
        if rewind.limit_hit is not None
        else Wording("PLN210", "rotary_axes_would"),
    )


def pose_problems(file: str, operation: Operation, poses: PlannedPoses, request: PlanRequest) -> Iterable[Problem]:
    """Errors of poses: each kind of trouble at its first few rows, then how many more there are."""
    outcome, moves = poses.outcome, operation.moves
    for code in distinct(outcome[outcome > 0]).tolist() if outcome.any() else []:
        if code == REWIND:
            continue
        rows = np.flatnonzero(outcome == code)
        for row in rows[:_NAMED].tolist():
            yield _pose_problem(file, operation, poses, request, row)
        if len(rows) > _NAMED:
            yield Problem(
                file,
                int(moves.line[rows[_NAMED]]),
                Wording("PLN160", "same_further_points", count=len(rows) - _NAMED, moves_line=moves.line[rows[-1]]),
            )


def _pose_problem(file: str, operation: Operation, poses: PlannedPoses, request: PlanRequest, row: int) -> Problem:
    machine, remedy, moves = request.machine, request.frame_remedy, operation.moves
    line, code = int(moves.line[row]), int(poses.outcome[row])
    if code == OUT_OF_REACH:
        return Problem(file, line, _unreachable(machine, moves.axis[row], remedy))
    if code == BLOCKED:
        return Problem(
            file,
            line,
            Wording(
                "PLN130",
                "rotary_axes_flip",
                pose_before=describe_pose(machine, poses.rotary[row - 1]),
                pose=describe_pose(machine, poses.rotary[row]),
            ),
        )
    column, value = code - 1, float(poses.beyond_value[row])
    cure = limit_remedy(machine, column, value, _other_pose_remark(machine, moves, poses, row))
    is_hole = any(event.row <= row < end for event, end in cycle_row_ranges(operation))
    variant = "in_hole" if is_hole else "on_arc" if moves.kind[row] == Kind.ARC else "at_point"
    violation = limit_violation_text(machine, column, value)
    return Problem(file, line, Wording("PLN120", variant, violation=violation, cure=cure, remedy=remedy))


def _unreachable(machine: Machine, axis: Floats, remedy: object) -> Wording:
    """Return what is to be said of a tool axis (3,) that no rotary position gives."""
    i, j, k = axis
    own = [machine.names[column] for column in machine.own_rotary]
    variant = ("needs_rotary_axis", "needs_second_axis", "no_rotary_position")[len(own)]
    said = {"rotary": own[0]} if len(own) == 1 else {}
    degrees = degrees_out_of_reach(machine, axis)
    return Wording(
        "PLN110", variant, machine=machine.key, i=i, j=j, k=k, degrees_out_of_reach=degrees, remedy=remedy, **said
    )


def _other_pose_remark(machine: Machine, moves: Moves, poses: PlannedPoses, row: int) -> Wording | str:
    """Why the other pose does not help either, in brackets; empty if there is none, or it does."""
    joints = inverse(machine, moves.tip[row : row + 1], moves.axis[row : row + 1]).joints[:, 0]
    difference = joints[:, list(machine.rotary)] - poses.rotary[row]
    difference -= 360.0 * np.rint(difference / 360.0)
    distance = np.abs(difference).sum(axis=1)
    other = joints[int(np.argmax(distance))]
    outside = np.flatnonzero(outside_limits(other, *limits_of(machine, machine.workpiece_zero is not None)))
    if not len(outside) or distance.max() < 1e-6:
        return ""
    return phrase("other_pose_would", axes=machine.axes[outside[0]].name, other=other[outside[0]])


def travel_problems(operations: Sequence[tuple[str, Moves, PlannedPoses]], machine: Machine) -> Iterable[Problem]:
    """Slides whose travel is too short for the whole program wherever the workpiece sits, at the point farthest out.

    ``operations``: CL file, moves and poses of each.
    """
    extremes = np.array([poses.extremes for _, _, poses in operations])
    extremes = np.column_stack((extremes[:, :, 0].min(axis=0), extremes[:, :, 1].max(axis=0)))
    for column in np.flatnonzero(exceeds_travel(machine, extremes)).tolist():
        axis = machine.axes[column]
        low, high = extremes[column].tolist()
        end = 1 if abs(high) >= abs(low) else 0
        file, moves, poses = next(one for one in operations if one[2].extremes[column, end] == extremes[column, end])
        yield Problem(
            file,
            int(moves.line[poses.extreme_rows[column, end]]),
            Wording(
                "PLN125",
                "axis_would_go",
                axis=axis.name,
                low=low,
                high=high,
                length=high - low,
                limit_low=axis.low,
                limit_high=axis.high,
                room=axis.high - axis.low,
            ),
        )
