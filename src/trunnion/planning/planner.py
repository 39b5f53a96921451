"""From operations to motions: the stages, in their order."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from trunnion.arrays import Floats
from trunnion.errors import InputError, Problem, RefusedError, Severity
from trunnion.machines import Machine, inverse
from trunnion.model.deviations import Deviations
from trunnion.model.frames import into_frame, into_plane, relative_frame
from trunnion.model.motion import Decision, DecisionTopic, MachiningMode, Motion, Plan, PoleStrategy
from trunnion.model.toolpath import CycleOn, Frame, Kind, Moves, Operation, Toolpath
from trunnion.planning.holes.cycles import (
    HoleCycleError,
    SpindleState,
    axis_change_rows,
    extract_rows,
    normalize_cycles,
    row_ranges,
    spindle_state_at,
    split_by_axis,
)
from trunnion.planning.linearization.arc_chords import arcs_a_control_takes, arcs_about_tool, flat_arcs, lines_for_arcs
from trunnion.planning.linearization.point_insertion import check_slides_are_known, linearize
from trunnion.planning.machining_mode import (
    machine_x_direction,
    mode_conflicts,
    mode_of,
    supported_mode,
    tilted_plane,
    with_exact_upright_axis,
)
from trunnion.planning.options import ControlCapabilities, PlanOptions
from trunnion.planning.pole.deviations import OperationTask, handle_pole, limit_speeds
from trunnion.planning.poses.decision_log import PlannedOperation, describe_pose, pose_decisions
from trunnion.planning.poses.limit_lookahead import degrees_out_of_reach, limit_remedy, limit_violation_text
from trunnion.planning.poses.placement import BLOCKED, OUT_OF_REACH, REWIND
from trunnion.planning.poses.selection import PlannedPoses, choose_poses, exceeds_travel
from trunnion.planning.poses.states import LIMIT_TOLERANCE, limits_of
from trunnion.planning.retracts.clearance import Clearance
from trunnion.planning.retracts.rewind import (
    Rewind,
    insert_rewinds,
    is_radius_compensated,
    parts_after_rewinds,
    plan_rewind,
    retract_positions,
    slide_beyond_limits,
)

#: How many rows of one kind of trouble are named one by one.
_NAMED = 5


def plan(
    toolpaths: Sequence[Toolpath],
    machine: Machine,
    chord_tolerance: float,
    options: PlanOptions | None = None,
    capabilities: ControlCapabilities | None = None,
) -> Plan:
    """Plan all operations of one program.

    Parameters
    ----------
    toolpaths
        In the order in which they are cut. The coordinate system of the first operation is the program's; operations
        in other coordinate systems are carried over into it.
    machine
        With a known workpiece zero the slides keep their limits; without, they must have room enough somewhere.
    chord_tolerance
        For arcs that become lines, mm.
    wishes
        How to rewind, with TCP or without, what is allowed between the points, and whether to explain.

    Raises
    ------
    InputError
        When there is nothing to plan, a wish is about an operation that there is not, or without TCP something is not
        known that slide positions depend on.
    RefusedError
        When no position of the machine gives a tool axis, or an operation cannot be made in the manner that is wished
        for; of that no program can be made at all.
    """
    options, capabilities = options or PlanOptions(), capabilities or ControlCapabilities()
    pairs = [(path, operation) for path in toolpaths for operation in path.operations if len(operation.moves)]
    if not pairs:
        raise InputError(Problem(toolpaths[0].file, 0, "there is no motion in it", "output the toolpath again"))
    _check_names(options, [operation.name for _, operation in pairs])
    program_frame = Frame() if options.absolute_frame else pairs[0][1].frame
    keep_slides = machine.workpiece_zero is not None
    planned_operations: list[_PlannedOperation] = []
    against: list[Problem] = []
    said: list[Problem] = []
    spindle: SpindleState | None = None
    for path, original in pairs:
        try:
            operation = into_frame(normalize_cycles(original), program_frame)
        except HoleCycleError as error:
            against.append(Problem(path.file, error.line, error.what, error.cure))
            continue
        own_frame = relative_frame(original.frame, program_frame)
        mode = mode_of(operation, options.mode_for(original.name), capabilities.negligible_tilt)
        mode, reworded = supported_mode(path.file, operation, mode, options, capabilities)
        said += reworded
        contradicting = mode_conflicts(path.file, operation, mode, capabilities)
        against += contradicting
        if mode is MachiningMode.THREE_AXIS and not contradicting:
            operation = with_exact_upright_axis(operation)
        plane = tilted_plane(operation.moves.axis[0], own_frame) if mode is MachiningMode.TILTED else None
        there = operation if plane is None else into_plane(operation, plane)
        kept = arcs_a_control_takes(there, capabilities.only_arcs_about_z, capabilities.helices_by_angle)
        if not capabilities.helices:
            kept &= flat_arcs(operation)
        if not capabilities.multi_turn_arcs:
            kept &= operation.arcs.full_turns == 0
        if mode is MachiningMode.TCP and not capabilities.arcs_with_tcp:
            kept[:] = False
        if plane is not None and capabilities.planes_from_pose:
            kept &= arcs_about_tool(operation)
        operation = lines_for_arcs(operation, kept, chord_tolerance)
        planes = MachiningMode.TILTED in capabilities.modes and options.mode_for(original.name) is None
        planes &= mode is MachiningMode.WITHOUT_TCP or not capabilities.turns_between_holes
        parts = split_by_axis(operation) if mode in (MachiningMode.TCP, MachiningMode.WITHOUT_TCP) and planes else None
        try:
            holes = _plan_holes(
                path.file,
                operation,
                options,
                capabilities,
                mode if parts is None else MachiningMode.TILTED,
                parts,
                spindle,
            )
        except HoleCycleError as error:
            against.append(Problem(path.file, error.line, error.what, error.cure))
            continue
        finally:
            spindle = spindle_state_at(original.events, len(original.moves), spindle)
        said += holes.said
        planned_operation = _plan_operation(
            OperationTask(machine, path.file, holes.operation, original, options, keep_slides)
        )
        if plane is not None and capabilities.plane_x_from_machine:
            plane = tilted_plane(
                operation.moves.axis[0], own_frame, machine_x_direction(machine, planned_operation.poses.rotary[0])
            )
        kind = replace(planned_operation, mode=mode, plane=plane, parts=holes.parts, ends_in_hole=holes.ends_in_hole)
        kind = replace(kind, log=(*planned_operation.log, *holes.log))
        planned_operations.append(kind if parts is None else replace(kind, mode=MachiningMode.TILTED, plane=own_frame))
    if against:
        raise RefusedError(against)
    problems = [*said, *_unknown_speeds(pairs[0][0].file, machine, options)]
    problems += [problem for planned_operation in planned_operations for problem in planned_operation.problems]
    if any((planned_operation.poses.outcome == OUT_OF_REACH).any() for planned_operation in planned_operations):
        raise RefusedError(problems)
    if machine.workpiece_zero is None:
        problems += _fit_problems(planned_operations, machine)
    motions = [
        (planned_operation, motion)
        for planned_operation in planned_operations
        for motion in planned_operation.motions(machine, options, capabilities)
    ]
    lacking = [motion.operation for _, motion in motions if motion.mode is MachiningMode.WITHOUT_TCP]
    if lacking:
        check_slides_are_known(pairs[0][0].file, lacking, machine)
    log = [decision for planned_operation in planned_operations for decision in planned_operation.log]
    linearized = [
        linearize(planned_operation.file, motion, machine, options, chord_tolerance)
        for planned_operation, motion in motions
    ]
    # What is wrong between points follows from what is wrong at them, where anything is.
    sound = (
        one for one, (planned_operation, _) in zip(linearized, motions, strict=True) if not planned_operation.refused
    )
    problems += [problem for one in sound for problem in one.problems]
    log += [decision for one in linearized for decision in one.log]
    return Plan(tuple(one.motion for one in linearized), tuple(problems), tuple(log))


def _check_names(options: PlanOptions, names: Sequence[str]) -> None:
    """Raise ``InputError`` for wishes about operations that there are not."""
    unknown = [name for name in options.mode_by_operation if name not in names]
    cure = f"write one of {', '.join(dict.fromkeys(names))}"
    if unknown:
        what = "mode is set for operation {}, and the program has none of that name"
        raise InputError([Problem("--set", 0, what.format(name), cure) for name in unknown])


@dataclass(frozen=True, slots=True, eq=False)
class _PlannedOperation:
    """An operation with its poses, as it is before rewinds are put in, the file that it came from, and its kind.

    ``parts`` are the rows of its planes, where holes make it one in several of them; ``plane`` is then its own frame.
    With TCP, or without, they are the rows between which the tool goes home. ``ends_in_hole`` says of each whether it
    ends in a hole that is motion.
    """

    file: str
    operation: Operation
    poses: PlannedPoses
    rewinds: tuple[Rewind, ...]
    problems: tuple[Problem, ...]
    log: tuple[Decision, ...]
    deviations: Deviations
    mode: MachiningMode = MachiningMode.TCP
    plane: Frame | None = None
    parts: Sequence[tuple[int, int]] = ()
    ends_in_hole: Sequence[bool] = ()

    @property
    def refused(self) -> bool:
        return any(problem.severity is Severity.ERROR for problem in self.problems)

    def motions(self, machine: Machine, options: PlanOptions, capabilities: ControlCapabilities) -> list[Motion]:
        """What is to be written."""
        operation, rotary = insert_rewinds(self.operation, self.poses.rotary, self.rewinds, options)
        if not self.parts:
            return [Motion(operation, rotary, self.mode, self.plane, self.deviations)]
        return [
            Motion(
                extract_rows(operation, first, end),
                rotary[first:end].copy(),
                self.mode,
                self._plane_at(operation.moves.axis[first], rotary[first], machine, capabilities),
                self.deviations if begin == 0 else Deviations.none(),
                starts_operation=begin == 0,
                ends_in_hole=ends_in_hole,
            )
            for (begin, _), (first, end), ends_in_hole in zip(
                self.parts, parts_after_rewinds(self.parts, self.rewinds), self.ends_in_hole, strict=True
            )
        ]

    def _plane_at(
        self, axis: Floats, rotary: Floats, machine: Machine, capabilities: ControlCapabilities
    ) -> Frame | None:
        """The plane of one of the parts, under a tool axis (3,) with the rotary axes at (2,), degrees."""
        if self.mode is not MachiningMode.TILTED:
            return None
        assert self.plane is not None
        return tilted_plane(
            axis, self.plane, machine_x_direction(machine, rotary) if capabilities.plane_x_from_machine else None
        )


@dataclass(frozen=True, slots=True, eq=False)
class _HolePlan:
    """An operation with the holes as motion that must be, its parts, and what there is to say about it."""

    operation: Operation
    parts: Sequence[tuple[int, int]]
    ends_in_hole: Sequence[bool] = ()
    said: Sequence[Problem] = ()
    log: Sequence[Decision] = ()


def _plan_holes(
    file: str,
    operation: Operation,
    options: PlanOptions,
    capabilities: ControlCapabilities,
    mode: MachiningMode,
    parts: Sequence[tuple[int, int]] | None,
    spindle: SpindleState | None,
) -> _HolePlan:
    """Make holes as motion where they have to be; ``parts``: rows of the planes of the operation, as it is."""
    if not any(isinstance(event, CycleOn) for event in operation.events):
        return _HolePlan(operation, ())
    from trunnion.planning.holes.hole_motion import (  # holes are seldom, and few of them are motion
        REQUESTED,
        convert_holes_to_motion,
    )

    moves, why = operation.moves, ""
    along_tool = mode is MachiningMode.TCP and capabilities.turns_between_holes and not options.holes_as_motion
    if mode in (MachiningMode.TCP, MachiningMode.WITHOUT_TCP) and not along_tool:
        why = f"no cycle goes along a tilted axis {'with TCP' if mode is MachiningMode.TCP else 'without TCP'}"
        turns = axis_change_rows(operation)
        parts = row_ranges(turns[moves.kind[turns] == Kind.RAPID], len(moves))
    home = np.zeros(len(moves), np.bool_)
    home[[first for first, _ in parts or ()]] = True
    drilled = convert_holes_to_motion(operation, options, capabilities, spindle, home, why)
    begins = drilled.first
    kept = [(int(begins[first]), int(begins[end])) for first, end in parts or ()]
    ends_in_hole = [bool(begins[end] - begins[end - 1] > 1) for _, end in parts or ()]
    said, log = [], []
    for one in drilled.converted:
        holes = "1 hole" if one.holes == 1 else f"{one.holes} holes"
        text = f"{holes} of CYCLE/{one.method} made as motion: {one.why}"
        log.append(Decision(file, operation.name, one.line, -1, DecisionTopic.HOLES, text))
        if one.why != REQUESTED:
            said.append(
                Problem(file, one.line, one.why, f"{holes} of CYCLE/{one.method} made as motion", Severity.WARNING)
            )
    return _HolePlan(drilled.operation, kept, ends_in_hole, said, log)


def _plan_operation(task: OperationTask) -> _PlannedOperation:
    """Plan one operation in the program's coordinate system."""
    file, operation, machine, options = task.file, task.operation, task.machine, task.options
    moves = operation.moves
    poses = choose_poses(machine, moves, task.keep_slides)
    if (poses.outcome == OUT_OF_REACH).any():
        problems = tuple(_row_problems(file, moves, poses, machine))
        return _PlannedOperation(file, operation, poses, (), problems, (), Deviations.none())
    operation, poses, leaned, log, lacking = handle_pole(task, poses)
    planned = PlannedOperation(machine, file, operation, poses.rotary, poses.state, task.keep_slides)
    needed = _rewinds(planned, poses, options.clearance)
    operation, slowed, too_fast = limit_speeds(replace(task, operation=operation), poses, needed)
    deviations = replace(leaned, slowed_rows=slowed.slowed_rows, slowed_feed=slowed.slowed_feed)
    problems = (*lacking, *_row_problems(file, moves, poses, machine), *_rewind_problems(planned, needed, options))
    if options.allow_rewinds:
        _include_retracts(poses, machine, moves, needed)
    if options.explain:
        log = [*pose_decisions(planned, poses.changes, {rewind.row: rewind.reason for rewind in needed}), *log]
    log = [*log, *too_fast]
    return _PlannedOperation(
        file, operation, poses, needed if options.allow_rewinds else (), problems, tuple(log), deviations
    )


def _unknown_speeds(file: str, machine: Machine, options: PlanOptions) -> Iterable[Problem]:
    """What was wished for and cannot be done, for nobody says how fast the rotary axes are."""
    names = [machine.axes[column].name for column in machine.rotary if machine.axes[column].rapid is None]
    if names and (options.pole_strategy is not PoleStrategy.OFF or options.lower_feed):
        what = f"the definition of {machine.key} has no rapid speed of {' and '.join(names)}: it is never too fast"
        yield Problem(file, 0, what, "write rapid_deg_min into the definition", Severity.WARNING)


def _rewinds(planned: PlannedOperation, poses: PlannedPoses, clearance: Clearance) -> tuple[Rewind, ...]:
    """All rewinds of an operation, with the limit that asks for each."""
    rewinds = []
    for row in np.flatnonzero(poses.outcome == REWIND).tolist():
        before, after = int(planned.branch(row - 1)), int(planned.branch(row))
        end = planned.limit_ahead(row, before, poses.rotary[row - 1])
        moves = planned.operation.moves
        reason = "the path asks for it" if end is None else f"otherwise {end.describe(planned.machine, moves)}"
        found = plan_rewind(planned.machine, moves, row, after, poses.rotary, clearance)
        turn = f"{planned.describe(found.before)} to {planned.describe(found.after)}, {reason}"
        rewinds.append(replace(found, reason=turn, limit_hit=end))
    return tuple(rewinds)


def _rewind_problems(planned: PlannedOperation, rewinds: Sequence[Rewind], options: PlanOptions) -> Iterable[Problem]:
    """What there is to say about each rewind."""
    machine, operation = planned.machine, planned.operation
    for rewind in rewinds:
        line = int(operation.moves.line[rewind.row])
        if not options.allow_rewinds:
            at = line if rewind.limit_hit is None else int(operation.moves.line[rewind.limit_hit.row])
            what = "the rotary axes would have to rewind in the cut"
            if rewind.limit_hit is not None:
                what = f"{limit_violation_text(machine, rewind.limit_hit.column, rewind.limit_hit.value)} in the cut"
            cure = "allow rewinds (--set rewind=insert), split the operation, or turn the workpiece"
            yield Problem(planned.file, at, what, cure)
            continue
        if not math.isfinite(rewind.retract_distance):
            what = f"the tool must rewind here, and its axis does not lead to the clearance {options.clearance}"
            yield Problem(planned.file, line, what, "--set clearance=MM draws back by a distance")
            continue
        what = f"the tool draws back {rewind.retract_distance:g} mm in the cut to rewind, {rewind.reason}"
        yield Problem(planned.file, line, what, "--set rewind=none refuses it", Severity.WARNING)
        if is_radius_compensated(operation, rewind.row):
            what = "a rewind within cutter radius compensation"
            yield Problem(planned.file, line, what, "output the path without CUTCOM, or split the operation")
        joints = retract_positions(machine, operation.moves, rewind)
        column = slide_beyond_limits(machine, joints) if planned.keep_slides else None
        if column is not None:
            values = joints[:, column]
            value = values.max() if values.max() > machine.axes[column].high else values.min()
            what = f"on the retreat for a rewind {limit_violation_text(machine, column, float(value))}"
            yield Problem(planned.file, line, what, "--set clearance=MM draws back less; or move the workpiece")


def _include_retracts(poses: PlannedPoses, machine: Machine, moves: Moves, rewinds: Sequence[Rewind]) -> None:
    """Take the retreats into the extremes of the slides, at the rows where they begin."""
    for rewind in rewinds:
        joints = retract_positions(machine, moves, rewind)
        for column in machine.linear:
            least, most = float(joints[:, column].min()), float(joints[:, column].max())
            if least < poses.extremes[column, 0]:
                poses.extremes[column, 0], poses.extreme_rows[column, 0] = least, rewind.row - 1
            if most > poses.extremes[column, 1]:
                poses.extremes[column, 1], poses.extreme_rows[column, 1] = most, rewind.row - 1


def _row_problems(file: str, moves: Moves, poses: PlannedPoses, machine: Machine) -> Iterable[Problem]:
    """Say what is wrong with which rows: each kind of trouble at its first few places, then how many there are."""
    problems: list[Problem] = []
    outcome = poses.outcome
    for code in np.unique(outcome[outcome > 0]).tolist() if outcome.any() else []:
        if code == REWIND:
            continue
        rows = np.flatnonzero(outcome == code)
        problems += [_row_problem(file, moves, poses, machine, code, row) for row in rows[:_NAMED].tolist()]
        if len(rows) > _NAMED:
            more = f"the same at {len(rows) - _NAMED} further points, the last in line {moves.line[rows[-1]]}"
            problems.append(Problem(file, int(moves.line[rows[_NAMED]]), more))
    return problems


def _row_problem(file: str, moves: Moves, poses: PlannedPoses, machine: Machine, code: int, row: int) -> Problem:
    place = file, int(moves.line[row])
    if code == OUT_OF_REACH:
        i, j, k = moves.axis[row]
        what = f"no rotary position of {machine.key} gives the tool axis {i:.6f}, {j:.6f}, {k:.6f}"
        lacking = f"{degrees_out_of_reach(machine, moves.axis[row]):.3f} degrees"
        return Problem(*place, what, f"tilt the workpiece by {lacking}, or post for a machine that reaches it")
    if code == BLOCKED:
        ways = f"{describe_pose(machine, poses.rotary[row - 1])} to {describe_pose(machine, poses.rotary[row])}"
        what = f"the rotary axes must turn over within one step of the cut, {ways}, and no pose serves both its ends"
        return Problem(*place, what, "output the toolpath with points nearer to each other, or tilt the workpiece")
    value = float(poses.beyond_value[row])
    cure = limit_remedy(machine, code - 1, value, _other_pose(machine, moves, poses, row))
    return Problem(*place, limit_violation_text(machine, code - 1, value), cure)


def _other_pose(machine: Machine, moves: Moves, poses: PlannedPoses, row: int) -> str:
    """Why the other solution is no way out, in brackets; empty where there is none."""
    joints = inverse(machine, moves.tip[row : row + 1], moves.axis[row : row + 1]).joints[:, 0]
    apart = joints[:, list(machine.rotary)] - poses.rotary[row]
    apart -= 360.0 * np.rint(apart / 360.0)
    other = joints[int(np.argmax(np.abs(apart).sum(axis=1)))]
    low, high = limits_of(machine, machine.workpiece_zero is not None)
    outside = np.flatnonzero((other < low - LIMIT_TOLERANCE) | (other > high + LIMIT_TOLERANCE))
    if not len(outside) or np.abs(apart).sum(axis=1).max() < 1e-6:
        return ""
    axis = machine.axes[outside[0]]
    return f" (in the other pose {axis.name} would go to {other[outside[0]]:.5f})"


def _fit_problems(planned_operations: Sequence[_PlannedOperation], machine: Machine) -> Iterable[Problem]:
    """The slides that have no room for the whole program, with the line of the point farthest out."""
    extremes = np.array([s.poses.extremes for s in planned_operations])
    extremes = np.column_stack((extremes[:, :, 0].min(axis=0), extremes[:, :, 1].max(axis=0)))
    problems = []
    for column in np.flatnonzero(exceeds_travel(machine, extremes)).tolist():
        axis = machine.axes[column]
        low, high = extremes[column].tolist()
        end = 1 if abs(high) >= abs(low) else 0
        planned_operation = next(
            s for s in planned_operations if s.poses.extremes[column, end] == extremes[column, end]
        )
        line = int(planned_operation.operation.moves.line[planned_operation.poses.extreme_rows[column, end]])
        what = (
            f"axis {axis.name} would go from {low:.3f} to {high:.3f}, {high - low:.3f} mm;"
            f" its travel from {axis.low:g} to {axis.high:g} has room for {axis.high - axis.low:g} mm"
        )
        problems.append(
            Problem(planned_operation.file, line, what, "move or turn the workpiece, or post for another machine")
        )
    return problems
