"""From operations to motions: the stages, in their order."""

from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np

from trunnion.arrays import Codes, Floats
from trunnion.errors import InputError, Problem, Refused, Severity
from trunnion.machine import Machine
from trunnion.plan.arcs import lines_for_arcs, plain_arcs
from trunnion.plan.motion import Motion, Plan
from trunnion.plan.poses import OUT_OF_REACH, TURNED_OVER, beyond_fit, follow
from trunnion.toolpath import Frame, From, Kind, Operation, Toolpath

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
    motions: list[Motion] = []
    problems: list[Problem] = []
    reachable = True
    for path, original in pairs:
        operation = into_frame(original, program_frame)
        operation = lines_for_arcs(operation, plain_arcs(operation), chord_tolerance)
        moves = operation.moves
        poses = follow(machine, moves.tip, moves.axis, keep_slides=machine.workpiece_zero is not None)
        if poses.outcome.any():
            problems += _row_problems(path.file, operation, machine, poses.joints, poses.outcome)
            reachable = reachable and not bool((poses.outcome == OUT_OF_REACH).any())
        upright = _is_upright(moves.axis)
        motions.append(Motion(operation, poses.joints, upright))
    if not reachable:
        raise Refused(problems)
    if machine.workpiece_zero is None:
        problems += _fit_problems(pairs[0][0].file, motions, machine)
    return Plan(tuple(motions), tuple(problems))


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


def _row_problems(
    file: str, operation: Operation, machine: Machine, joints: Floats, outcome: Codes
) -> Iterable[Problem]:
    """Say what is wrong with which rows: each kind of trouble at its first few places, then how many there are."""
    problems: list[Problem] = []
    line, kind = operation.moves.line, operation.moves.kind
    for code in np.unique(outcome[outcome > 0]):
        rows = np.flatnonzero(outcome == code)
        if code == TURNED_OVER:
            rows = rows[kind[rows] != Kind.RAPID]
        for row in rows[:_NAMED]:
            problems.append(_row_problem(file, int(line[row]), int(code), machine, joints[row], operation, int(row)))
        if len(rows) > _NAMED:
            more = f"the same at {len(rows) - _NAMED} further points, the last in line {line[rows[-1]]}"
            problems.append(Problem(file, int(line[rows[_NAMED]]), more, severity=problems[-1].severity))
    return problems


def _row_problem(
    file: str, line: int, code: int, machine: Machine, joints: Floats, operation: Operation, row: int
) -> Problem:
    if code == OUT_OF_REACH:
        i, j, k = operation.moves.axis[row]
        return Problem(
            file,
            line,
            f"no rotary position of {machine.key} gives the tool axis {i:.6f}, {j:.6f}, {k:.6f}",
            "tilt the workpiece or use a machine that reaches it",
        )
    if code == TURNED_OVER:
        return Problem(
            file,
            line,
            "the rotary axes turn over to their other solution while cutting",
            "split the operation there or tilt the workpiece",
            Severity.WARNING,
        )
    axis = machine.axes[code - 1]
    value = float(joints[code - 1])
    limit, word = (axis.low, "below") if value < axis.low else (axis.high, "above")
    unit = "degrees" if axis.is_rotary else "mm"
    return Problem(
        file,
        line,
        f"axis {axis.name} would go to {value:.5f}, {word} its limit {limit:g} {unit}",
        "move or tilt the workpiece, or post for another machine",
    )


def _fit_problems(file: str, motions: Sequence[Motion], machine: Machine) -> Iterable[Problem]:
    """The slides that have no room for the whole program, with the line of the point farthest out."""
    joints = np.array([[m.joints.min(axis=0), m.joints.max(axis=0)] for m in motions]).reshape(-1, 5)
    problems = []
    for column in np.flatnonzero(beyond_fit(machine, joints)):
        axis = machine.axes[column]
        low, high = float(joints[:, column].min()), float(joints[:, column].max())
        outermost = high if abs(high) >= abs(low) else low
        motion = next(m for m in motions if outermost in (m.joints[:, column].min(), m.joints[:, column].max()))
        row = int(np.flatnonzero(motion.joints[:, column] == outermost)[0])
        problems.append(
            Problem(
                file,
                int(motion.operation.moves.line[row]),
                f"axis {axis.name} would go from {low:.3f} to {high:.3f}, {high - low:.3f} mm;"
                f" its travel from {axis.low:g} to {axis.high:g} has room for {axis.high - axis.low:g} mm",
                "move or turn the workpiece, or post for another machine",
            )
        )
    return problems
