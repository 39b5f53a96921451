"""From operations to motions: the stages, in their order."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from trunnion.arrays import Floats
from trunnion.errors import InputError, Problem, Refused, Severity
from trunnion.machines import Machine, inverse
from trunnion.model.frames import into_frame, into_plane, seen_from
from trunnion.model.motion import Decision, Departures, Manner, Motion, Plan, Pole, Why
from trunnion.model.toolpath import CycleOn, Frame, Kind, Moves, Operation, Toolpath
from trunnion.planning.holes.cycles import CycleError, Turning, between, by_axis, part_of, turned, turning, with_holes
from trunnion.planning.linearization.arc_chords import arcs_about_tool, flat_arcs, lines_for_arcs, plain_arcs
from trunnion.planning.linearization.inserted_points import check_without_tcp, with_points
from trunnion.planning.machining_mode import contradictions, in_other_words, machine_x, manner_of, plane_of, uprighted
from trunnion.planning.options import Wishes
from trunnion.planning.pole.deviations import Asked, near_pole, slower
from trunnion.planning.poses.decision_log import Planned, decisions, pose_words
from trunnion.planning.poses.limit_lookahead import beyond_words, cure_words, out_of_reach_by
from trunnion.planning.poses.placement import BLOCKED, OUT_OF_REACH, REWIND
from trunnion.planning.poses.selection import Poses, beyond_fit, follow
from trunnion.planning.poses.states import LIMIT_TOLERANCE, limits_of
from trunnion.planning.retracts.clearance import Clearance
from trunnion.planning.retracts.rewind import (
    Rewind,
    compensated,
    joints_of,
    lacks_room,
    rewind_at,
    rewound,
    with_rewinds,
)

#: How many rows of one kind of trouble are named one by one.
_NAMED = 5


def plan(toolpaths: Sequence[Toolpath], machine: Machine, chord_tolerance: float, wishes: Wishes | None = None) -> Plan:
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
    Refused
        When no position of the machine gives a tool axis, or an operation cannot be made in the manner that is wished
        for; of that no program can be made at all.
    """
    wishes = wishes or Wishes()
    pairs = [(path, operation) for path in toolpaths for operation in path.operations if len(operation.moves)]
    if not pairs:
        raise InputError(Problem(toolpaths[0].file, 0, "there is no motion in it", "output the toolpath again"))
    _check_names(wishes, [operation.name for _, operation in pairs])
    program_frame = Frame() if wishes.absolute else pairs[0][1].frame
    keep_slides = machine.workpiece_zero is not None
    stretches: list[_Stretch] = []
    against: list[Problem] = []
    said: list[Problem] = []
    held: Turning | None = None
    for path, original in pairs:
        try:
            operation = into_frame(with_holes(original), program_frame)
        except CycleError as error:
            against.append(Problem(path.file, error.line, error.what, error.cure))
            continue
        wished, own = wishes.of(original.name), seen_from(original.frame, program_frame)
        manner = manner_of(operation, wished.manner, wishes.level)
        manner, reworded = in_other_words(path.file, operation, manner, wished)
        said += reworded
        contradicting = contradictions(path.file, operation, manner, wishes)
        against += contradicting
        if manner is Manner.THREE_AXIS and not contradicting:
            operation = uprighted(operation)
        plane = plane_of(operation.moves.axis[0], own) if manner is Manner.TILTED else None
        there = operation if plane is None else into_plane(operation, plane)
        kept = plain_arcs(there, wishes.arcs_about_z, wishes.helices_by_angle)
        if not wishes.helices:
            kept &= flat_arcs(operation)
        if not wishes.turns:
            kept &= operation.arcs.turns == 0
        if manner is Manner.TCP and not wishes.arcs_with_tcp:
            kept[:] = False
        if plane is not None and wishes.pose_planes:
            kept &= arcs_about_tool(operation)
        operation = lines_for_arcs(operation, kept, chord_tolerance)
        planes = Manner.TILTED in wishes.manners and wished.manner is None
        planes &= manner is Manner.WITHOUT_TCP or not wishes.turns_between_holes
        parts = by_axis(operation) if manner in (Manner.TCP, Manner.WITHOUT_TCP) and planes else None
        try:
            holes = _holes(path.file, operation, wishes, manner if parts is None else Manner.TILTED, parts, held)
        except CycleError as error:
            against.append(Problem(path.file, error.line, error.what, error.cure))
            continue
        finally:
            held = turning(original.events, len(original.moves), held)
        said += holes.said
        stretch = _stretch(Asked(machine, path.file, holes.operation, original, wishes, keep_slides))
        if plane is not None and wishes.machine_x:
            plane = plane_of(operation.moves.axis[0], own, machine_x(machine, stretch.poses.rotary[0]))
        kind = replace(stretch, manner=manner, plane=plane, parts=holes.parts, in_hole=holes.in_hole)
        kind = replace(kind, log=(*stretch.log, *holes.log))
        stretches.append(kind if parts is None else replace(kind, manner=Manner.TILTED, plane=own))
    if against:
        raise Refused(against)
    problems = [*said, *_unknown_speeds(pairs[0][0].file, machine, wishes)]
    problems += [problem for stretch in stretches for problem in stretch.problems]
    if any((stretch.poses.outcome == OUT_OF_REACH).any() for stretch in stretches):
        raise Refused(problems)
    if machine.workpiece_zero is None:
        problems += _fit_problems(stretches, machine)
    motions = [(stretch, motion) for stretch in stretches for motion in stretch.motions(machine, wishes)]
    lacking = [motion.operation for _, motion in motions if motion.manner is Manner.WITHOUT_TCP]
    if lacking:
        check_without_tcp(pairs[0][0].file, lacking, machine)
    log = [decision for stretch in stretches for decision in stretch.log]
    led = [with_points(stretch.file, motion, machine, wishes, chord_tolerance) for stretch, motion in motions]
    # What is wrong between points follows from what is wrong at them, where anything is.
    sound = (one for one, (stretch, _) in zip(led, motions, strict=True) if not stretch.refused)
    problems += [problem for one in sound for problem in one.problems]
    log += [decision for one in led for decision in one.log]
    return Plan(tuple(one.motion for one in led), tuple(problems), tuple(log))


def _check_names(wishes: Wishes, names: Sequence[str]) -> None:
    """Raise ``InputError`` for wishes about operations that there are not."""
    unknown = [name for name in wishes.own_manner if name not in names]
    cure = f"write one of {', '.join(dict.fromkeys(names))}"
    if unknown:
        what = "manner is said of operation {}, and the program has none of that name"
        raise InputError([Problem("--set", 0, what.format(name), cure) for name in unknown])


@dataclass(frozen=True, slots=True, eq=False)
class _Stretch:
    """An operation with its poses, as it is before rewinds are put in, the file that it came from, and its kind.

    ``parts`` are the rows of its planes, where holes make it one in several of them; ``plane`` is then its own frame.
    With TCP, or without, they are the rows between which the tool goes home. ``in_hole`` says of each whether it ends
    in a hole that is motion.
    """

    file: str
    operation: Operation
    poses: Poses
    rewinds: tuple[Rewind, ...]
    problems: tuple[Problem, ...]
    log: tuple[Decision, ...]
    departures: Departures
    manner: Manner = Manner.TCP
    plane: Frame | None = None
    parts: Sequence[tuple[int, int]] = ()
    in_hole: Sequence[bool] = ()

    @property
    def refused(self) -> bool:
        return any(problem.severity is Severity.ERROR for problem in self.problems)

    def motions(self, machine: Machine, wishes: Wishes) -> list[Motion]:
        """What is to be written."""
        operation, rotary = with_rewinds(self.operation, self.poses.rotary, self.rewinds, wishes)
        if not self.parts:
            return [Motion(operation, rotary, self.manner, self.plane, self.departures)]
        return [
            Motion(
                part_of(operation, first, end),
                rotary[first:end].copy(),
                self.manner,
                self._plane_at(operation.moves.axis[first], rotary[first], machine, wishes),
                self.departures if begin == 0 else Departures.none(),
                begins=begin == 0,
                in_hole=in_hole,
            )
            for (begin, _), (first, end), in_hole in zip(
                self.parts, rewound(self.parts, self.rewinds), self.in_hole, strict=True
            )
        ]

    def _plane_at(self, axis: Floats, rotary: Floats, machine: Machine, wishes: Wishes) -> Frame | None:
        """The plane of one of the parts, under a tool axis (3,) with the rotary axes at (2,), degrees."""
        if self.manner is not Manner.TILTED:
            return None
        assert self.plane is not None
        return plane_of(axis, self.plane, machine_x(machine, rotary) if wishes.machine_x else None)


@dataclass(frozen=True, slots=True, eq=False)
class _Holes:
    """An operation with the holes as motion that must be, its parts, and what there is to say about it."""

    operation: Operation
    parts: Sequence[tuple[int, int]]
    in_hole: Sequence[bool] = ()
    said: Sequence[Problem] = ()
    log: Sequence[Decision] = ()


def _holes(
    file: str,
    operation: Operation,
    wishes: Wishes,
    manner: Manner,
    parts: Sequence[tuple[int, int]] | None,
    held: Turning | None,
) -> _Holes:
    """Make holes as motion where they have to be; ``parts``: rows of the planes of the operation, as it is."""
    if not any(isinstance(event, CycleOn) for event in operation.events):
        return _Holes(operation, ())
    from trunnion.planning.holes.hole_motion import ASKED, as_motion  # holes are seldom, and few of them are motion

    moves, why = operation.moves, ""
    along_tool = manner is Manner.TCP and wishes.turns_between_holes and not wishes.holes_as_motion
    if manner in (Manner.TCP, Manner.WITHOUT_TCP) and not along_tool:
        why = f"no cycle goes along a tilted axis {'with TCP' if manner is Manner.TCP else 'without TCP'}"
        turns = turned(operation)
        parts = between(turns[moves.kind[turns] == Kind.RAPID], len(moves))
    home = np.zeros(len(moves), np.bool_)
    home[[first for first, _ in parts or ()]] = True
    drilled = as_motion(operation, wishes, held, home, why)
    begins = drilled.first
    kept = [(int(begins[first]), int(begins[end])) for first, end in parts or ()]
    in_hole = [bool(begins[end] - begins[end - 1] > 1) for _, end in parts or ()]
    said, log = [], []
    for one in drilled.resolved:
        holes = "1 hole" if one.holes == 1 else f"{one.holes} holes"
        text = f"{holes} of CYCLE/{one.making} made as motion: {one.why}"
        log.append(Decision(file, operation.name, one.line, -1, Why.HOLES, text))
        if one.why != ASKED:
            said.append(
                Problem(file, one.line, one.why, f"{holes} of CYCLE/{one.making} made as motion", Severity.WARNING)
            )
    return _Holes(drilled.operation, kept, in_hole, said, log)


def _stretch(asked: Asked) -> _Stretch:
    """Plan one operation in the program's coordinate system."""
    file, operation, machine, wishes = asked.file, asked.operation, asked.machine, asked.wishes
    moves = operation.moves
    poses = follow(machine, moves, asked.keep_slides)
    if (poses.outcome == OUT_OF_REACH).any():
        problems = tuple(_row_problems(file, moves, poses, machine))
        return _Stretch(file, operation, poses, (), problems, (), Departures.none())
    operation, poses, leaned, log, lacking = near_pole(asked, poses)
    planned = Planned(machine, file, operation, poses.rotary, poses.state, asked.keep_slides)
    needed = _rewinds(planned, poses, wishes.clearance)
    operation, slowed, too_fast = slower(replace(asked, operation=operation), poses, needed)
    departures = replace(leaned, slowed=slowed.slowed, feed=slowed.feed)
    problems = (*lacking, *_row_problems(file, moves, poses, machine), *_rewind_problems(planned, needed, wishes))
    if wishes.rewind:
        _widen(poses, machine, moves, needed)
    if wishes.explain:
        log = [*decisions(planned, poses.changes, {rewind.row: rewind.reason for rewind in needed}), *log]
    log = [*log, *too_fast]
    return _Stretch(file, operation, poses, needed if wishes.rewind else (), problems, tuple(log), departures)


def _unknown_speeds(file: str, machine: Machine, wishes: Wishes) -> Iterable[Problem]:
    """What was wished for and cannot be done, for nobody says how fast the rotary axes are."""
    names = [machine.axes[column].name for column in machine.rotary if machine.axes[column].rapid is None]
    if names and (wishes.pole is not Pole.OFF or wishes.lower_feed):
        what = f"the definition of {machine.key} has no rapid speed of {' and '.join(names)}: it is never too fast"
        yield Problem(file, 0, what, "write rapid_deg_min into the definition", Severity.WARNING)


def _rewinds(planned: Planned, poses: Poses, clearance: Clearance) -> tuple[Rewind, ...]:
    """All rewinds of an operation, with the limit that asks for each."""
    rewinds = []
    for row in np.flatnonzero(poses.outcome == REWIND).tolist():
        before, after = int(planned.branch(row - 1)), int(planned.branch(row))
        end = planned.ahead(row, before, poses.rotary[row - 1])
        moves = planned.operation.moves
        reason = "the path asks for it" if end is None else f"otherwise {end.words(planned.machine, moves)}"
        found = rewind_at(planned.machine, moves, row, after, poses.rotary, clearance)
        turn = f"{planned.words(found.before)} to {planned.words(found.after)}, {reason}"
        rewinds.append(replace(found, reason=turn, end=end))
    return tuple(rewinds)


def _rewind_problems(planned: Planned, rewinds: Sequence[Rewind], wishes: Wishes) -> Iterable[Problem]:
    """What there is to say about each rewind."""
    machine, operation = planned.machine, planned.operation
    for rewind in rewinds:
        line = int(operation.moves.line[rewind.row])
        if not wishes.rewind:
            at = line if rewind.end is None else int(operation.moves.line[rewind.end.row])
            what = "the rotary axes would have to rewind in the cut"
            if rewind.end is not None:
                what = f"{beyond_words(machine, rewind.end.column, rewind.end.value)} in the cut"
            cure = "allow rewinds (--set rewind=insert), split the operation, or turn the workpiece"
            yield Problem(planned.file, at, what, cure)
            continue
        if not math.isfinite(rewind.way):
            what = f"the tool must rewind here, and its axis does not lead to the clearance {wishes.clearance}"
            yield Problem(planned.file, line, what, "--set clearance=MM draws back by a distance")
            continue
        what = f"the tool draws back {rewind.way:g} mm in the cut to rewind, {rewind.reason}"
        yield Problem(planned.file, line, what, "--set rewind=none refuses it", Severity.WARNING)
        if compensated(operation, rewind.row):
            what = "a rewind within cutter radius compensation"
            yield Problem(planned.file, line, what, "output the path without CUTCOM, or split the operation")
        joints = joints_of(machine, operation.moves, rewind)
        column = lacks_room(machine, joints) if planned.keep_slides else None
        if column is not None:
            values = joints[:, column]
            value = values.max() if values.max() > machine.axes[column].high else values.min()
            what = f"on the retreat for a rewind {beyond_words(machine, column, float(value))}"
            yield Problem(planned.file, line, what, "--set clearance=MM draws back less; or move the workpiece")


def _widen(poses: Poses, machine: Machine, moves: Moves, rewinds: Sequence[Rewind]) -> None:
    """Take the retreats into the extremes of the slides, at the rows where they begin."""
    for rewind in rewinds:
        joints = joints_of(machine, moves, rewind)
        for column in machine.linear:
            least, most = float(joints[:, column].min()), float(joints[:, column].max())
            if least < poses.extremes[column, 0]:
                poses.extremes[column, 0], poses.where[column, 0] = least, rewind.row - 1
            if most > poses.extremes[column, 1]:
                poses.extremes[column, 1], poses.where[column, 1] = most, rewind.row - 1


def _row_problems(file: str, moves: Moves, poses: Poses, machine: Machine) -> Iterable[Problem]:
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


def _row_problem(file: str, moves: Moves, poses: Poses, machine: Machine, code: int, row: int) -> Problem:
    place = file, int(moves.line[row])
    if code == OUT_OF_REACH:
        i, j, k = moves.axis[row]
        what = f"no rotary position of {machine.key} gives the tool axis {i:.6f}, {j:.6f}, {k:.6f}"
        lacking = f"{out_of_reach_by(machine, moves.axis[row]):.3f} degrees"
        return Problem(*place, what, f"tilt the workpiece by {lacking}, or post for a machine that reaches it")
    if code == BLOCKED:
        ways = f"{pose_words(machine, poses.rotary[row - 1])} to {pose_words(machine, poses.rotary[row])}"
        what = f"the rotary axes must turn over within one step of the cut, {ways}, and no pose serves both its ends"
        return Problem(*place, what, "output the toolpath with points nearer to each other, or tilt the workpiece")
    value = float(poses.beyond[row])
    cure = cure_words(machine, code - 1, value, _other_pose(machine, moves, poses, row))
    return Problem(*place, beyond_words(machine, code - 1, value), cure)


def _other_pose(machine: Machine, moves: Moves, poses: Poses, row: int) -> str:
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


def _fit_problems(stretches: Sequence[_Stretch], machine: Machine) -> Iterable[Problem]:
    """The slides that have no room for the whole program, with the line of the point farthest out."""
    extremes = np.array([s.poses.extremes for s in stretches])
    extremes = np.column_stack((extremes[:, :, 0].min(axis=0), extremes[:, :, 1].max(axis=0)))
    problems = []
    for column in np.flatnonzero(beyond_fit(machine, extremes)).tolist():
        axis = machine.axes[column]
        low, high = extremes[column].tolist()
        end = 1 if abs(high) >= abs(low) else 0
        stretch = next(s for s in stretches if s.poses.extremes[column, end] == extremes[column, end])
        line = int(stretch.operation.moves.line[stretch.poses.where[column, end]])
        what = (
            f"axis {axis.name} would go from {low:.3f} to {high:.3f}, {high - low:.3f} mm;"
            f" its travel from {axis.low:g} to {axis.high:g} has room for {axis.high - axis.low:g} mm"
        )
        problems.append(Problem(stretch.file, line, what, "move or turn the workpiece, or post for another machine"))
    return problems
