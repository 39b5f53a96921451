"""From operations to motions: the stages, in their order."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from trunnion.arrays import Floats
from trunnion.errors import InputError, Problem, Refused, Severity
from trunnion.machine import Machine
from trunnion.plan.arcs import lines_for_arcs, plain_arcs
from trunnion.plan.motion import Motion, Plan
from trunnion.plan.optimum import BLOCKED, OUT_OF_REACH, REWIND
from trunnion.plan.poses import Poses, beyond_fit, choose, take
from trunnion.toolpath import Frame, From, Operation, Toolpath

#: An operation is three-axis when no component of its tool axis differs from +Z by more than this.
_UPRIGHT = 1e-7

#: How many rows of one kind of trouble are named one by one.
_NAMED = 5


def plan(toolpaths: Sequence[Toolpath], machine: Machine, chord_tolerance: float) -> Plan:
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

    Raises
    ------
    InputError
        When there is nothing to plan.
    Refused
        When no position of the machine gives a tool axis; of that no program can be made at all.
    """
    pairs = [(path, operation) for path in toolpaths for operation in path.operations if len(operation.moves)]
    if not pairs:
        raise InputError(Problem(toolpaths[0].file, 0, "there is no motion in it", "output the toolpath again"))
    program_frame = pairs[0][1].frame
    stretches: list[_Stretch] = []
    problems: list[Problem] = []
    for path, original in pairs:
        operation = into_frame(original, program_frame)
        operation = lines_for_arcs(operation, plain_arcs(operation), chord_tolerance)
        moves = operation.moves
        keep_slides = machine.workpiece_zero is not None
        poses = take(machine, moves, choose(machine, moves, keep_slides), keep_slides)
        stretches.append(_Stretch(path.file, operation, poses))
        if poses.outcome.any():
            problems += _row_problems(stretches[-1], machine)
    if any((stretch.poses.outcome == OUT_OF_REACH).any() for stretch in stretches):
        raise Refused(problems)
    if machine.workpiece_zero is None:
        problems += _fit_problems(stretches, machine)
    motions = tuple(Motion(s.operation, s.poses.rotary, _is_upright(s.operation.moves.axis)) for s in stretches)
    return Plan(motions, tuple(problems))


@dataclass(frozen=True, slots=True, eq=False)
class _Stretch:
    """An operation with its poses, and the file that it came from."""

    file: str
    operation: Operation
    poses: Poses


def _is_upright(axis: Floats) -> bool:
    if axis[0, 2] < 1.0 - _UPRIGHT:  # the usual case decides itself at the first row
        return False
    return bool(np.abs(axis - [0.0, 0.0, 1.0]).max() < _UPRIGHT)


def into_frame(operation: Operation, frame: Frame) -> Operation:
    """The operation as seen from another coordinate system; itself when it is the same one.

    With M the matrix and o the origin of a frame in the CAM's absolute system, a point is
    M_to^T (M_from p + o_from - o_to) and a direction M_to^T M_from u.
    """
    if operation.frame == frame:
        return operation
    turn = frame.matrix().T @ operation.frame.matrix()
    shift = frame.matrix().T @ (np.array(operation.frame.origin) - np.array(frame.origin))
    moves, arcs = operation.moves, operation.arcs
    return replace(
        operation,
        frame=frame,
        moves=replace(moves, tip=moves.tip @ turn.T + shift, axis=moves.axis @ turn.T),
        arcs=replace(arcs, centre=arcs.centre @ turn.T + shift, normal=arcs.normal @ turn.T),
        events=tuple(
            replace(event, tip=tuple(turn @ event.tip + shift), axis=tuple(turn @ event.axis))
            if isinstance(event, From)
            else event
            for event in operation.events
        ),
    )


def _row_problems(stretch: _Stretch, machine: Machine) -> Iterable[Problem]:
    """Say what is wrong with which rows: each kind of trouble at its first few places, then how many there are."""
    problems: list[Problem] = []
    moves, outcome = stretch.operation.moves, stretch.poses.outcome
    for code in np.unique(outcome[outcome > 0]).tolist():
        rows = np.flatnonzero(outcome == code)
        problems += [_row_problem(stretch, machine, code, row) for row in rows[:_NAMED].tolist()]
        if len(rows) > _NAMED:
            more = f"the same at {len(rows) - _NAMED} further points, the last in line {moves.line[rows[-1]]}"
            line = int(moves.line[rows[_NAMED]])
            problems.append(Problem(stretch.file, line, more, severity=problems[-1].severity))
    return problems


def _row_problem(stretch: _Stretch, machine: Machine, code: int, row: int) -> Problem:
    moves = stretch.operation.moves
    place = stretch.file, int(moves.line[row])
    if code == OUT_OF_REACH:
        i, j, k = moves.axis[row]
        what = f"no rotary position of {machine.key} gives the tool axis {i:.6f}, {j:.6f}, {k:.6f}"
        return Problem(*place, what, "tilt the workpiece or use a machine that reaches it")
    if code in (REWIND, BLOCKED):
        what = "the rotary axes turn over to their other solution while cutting"
        return Problem(*place, what, "split the operation there or tilt the workpiece", Severity.WARNING)
    axis, value = machine.axes[code - 1], float(stretch.poses.beyond[row])
    limit, word = (axis.low, "below") if value < axis.low else (axis.high, "above")
    unit = "degrees" if axis.is_rotary else "mm"
    what = f"axis {axis.name} would go to {value:.5f}, {word} its limit {limit:g} {unit}"
    return Problem(*place, what, "move or tilt the workpiece, or post for another machine")


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
