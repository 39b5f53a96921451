"""The way between CL points: where points are put in so that the tool stays on it.

In:     a motion as the poses and rewinds have it.
Out:    the same motion with the points that ``trunnion.planning.linearization.intermediate_points`` asks for, in their
rows, events and arcs.

With TCP the control holds the tip, and points are put in only if somebody asks for a tolerance of the tool axis, in
cuts. Without TCP slides and rotary axes are led, each evenly from point to point, and the tool leaves its line on every
way that turns an axis, rapids too. There circles stay circles only where the slides by themselves make them.

Where the way leads to the other side of the machine, through its pole in a cut or anyhow in a rapid, the rotary axes
turn evenly and points only hold the tip on its line. In a cut the tool axis must stay within its tolerance there. So it
is with the turn of a rewind: the slides follow it, and the tip rests at the clearance.
"""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.errors import InputError, Problem
from trunnion.machines import Machine, forward, slide_positions
from trunnion.model.motion import Decision, DecisionTopic, MachiningMode, Motion
from trunnion.model.toolpath import Kind, LoadTool, Moves, Operation
from trunnion.planning.linearization.arc_chords import arc_piece_counts, great_circle_points, lines_for_arcs
from trunnion.planning.linearization.intermediate_points import branches_of_rows, divide_path
from trunnion.planning.linearization.row_insertion import insert_rows
from trunnion.planning.options import PlanOptions
from trunnion.planning.poses.limit_lookahead import limit_remedy, limit_violation_text
from trunnion.planning.poses.states import LIMIT_TOLERANCE, limits_of

#: Directions are taken as along a slide within this sine.
_PARALLEL_SINE: Final = 1e-6

#: Rotary motion below this, degrees, is none.
_NO_MOTION: Final = 1e-9

#: Places at which a turn to the other side is looked at, as parts of it.
_BEND_SHARES: Final = np.linspace(0.0, 1.0, 65)

#: Pieces into which a turn to the other side is cut at most.
_MAX_PIECES: Final = 50_000

#: Share of a tolerance that is used, as in ``trunnion.planning.linearization.intermediate_points``.
_USABLE_SHARE: Final = 0.96

#: Places that are named one by one.
_NAMED: Final = 5


@dataclass(frozen=True, slots=True, eq=False)
class LinearizedMotion:
    """A motion with its points put in, what speaks against it, and what there is to tell."""

    motion: Motion
    problems: tuple[Problem, ...] = ()
    log: tuple[Decision, ...] = ()


def check_slides_are_known(file: str, operations: Sequence[Operation], machine: Machine) -> None:
    """See that all is known that slide positions depend on.

    Raises
    ------
    InputError
        If something is missing: not even ``--force`` writes positions that are nobody's.
    """
    problems = []
    line = operations[0].line
    if machine.workpiece_zero is None:
        what = "without TCP the program holds positions of the slides, and nobody said where the workpiece sits"
        problems.append(Problem(file, line, what, "write --set zero=X,Y,Z, or zero_mm under [workpiece]"))
    if {machine.axes[column].name for column in machine.linear} != set("XYZ"):
        what = f"without TCP the words X, Y and Z are slides, and those of {machine.key} have other names"
        problems.append(Problem(file, line, what, "name the slides X, Y and Z in the definition"))
    elif machine.has_rotary_head:
        problems += _length_problems(file, operations, machine)
    if problems:
        raise InputError(problems)


def _length_problems(file: str, operations: Sequence[Operation], machine: Machine) -> Iterable[Problem]:
    """Where the head turns the tool, its length decides where the slides must be."""
    line, z = operations[0].line, machine.axis("Z")
    if machine.tool_length is None:
        what = "without TCP the slides follow the tool's length where the head turns it, and nobody said how long it is"
        yield Problem(file, line, what, "write --set tool_length=MM, as in the control's tool offset")
    if z.sense * float(np.dot(z.direction, machine.spindle_direction)) < 1.0 - _PARALLEL_SINE:
        what = "without TCP the control adds the tool's length along Z, and the spindle does not point there at zero"
        yield Problem(file, line, what, "post with TCP (--set tcp=on)")
    tools: dict[tuple[int | None, str], int] = {}
    number = None
    for operation in operations:
        loads = [event.number for event in operation.events if isinstance(event, LoadTool)]
        number = loads[-1] if loads else number
        tools.setdefault((number, operation.tool.name), operation.line)
    if len(tools) > 1:
        what = f"{len(tools)} tools in a program without TCP, and one tool length for all"
        yield Problem(file, list(tools.values())[1], what, "post one program for each tool")


def linearize(
    file: str, motion: Motion, machine: Machine, options: PlanOptions, chord_tolerance: float
) -> LinearizedMotion:
    """Put in the points that a motion needs.

    Parameters
    ----------
    file
        Of the operation, for what is said.
    motion
        With TCP or without; any other comes back as it is.
    machine
        Without TCP with its workpiece zero and, where the head turns the tool, the tool's length.
    wishes
        The tolerances.
    chord_tolerance
        For circles that the slides do not make, mm.
    """
    without = motion.mode is MachiningMode.WITHOUT_TCP
    if not without and (motion.mode is not MachiningMode.TCP or math.isinf(options.axis_tolerance_between_points)):
        return LinearizedMotion(motion)
    operation, rotary = motion.operation, motion.rotary
    if without:
        operation, rotary = _keep_slide_arcs(machine, operation, rotary, chord_tolerance)
    moves = operation.moves
    continuous = _continuous_positions(machine, rotary)
    side = branches_of_rows(machine, continuous)
    continuous, stray = _follow_great_circle(machine, moves.axis, continuous, side)
    stray |= _turns_in_place(moves, continuous)
    bend = _branch_change_bend(machine, moves.axis, continuous, side, stray)
    crosses, bent = bend >= 0.0, bend > options.axis_tolerance_between_points
    ways = (moves.kind != Kind.ARC) & ~crosses
    if not without:
        ways &= moves.kind == Kind.LINEAR
    ways[0] = False
    spans = divide_path(
        machine, moves.tip, moves.axis, continuous, ways,
        tcp=not without, tip_tolerance=options.tip_tolerance, axis_tolerance=options.axis_tolerance_between_points,
    )  # fmt: skip
    source, tip, axis, continuous = spans.source, spans.tip, spans.axis, spans.rotary
    over = np.flatnonzero(crosses & ~(bent & (moves.kind != Kind.RAPID))) if without else np.zeros(0, np.int64)
    at = np.searchsorted(source, over)
    held = [_points_holding_tip(machine, tip[k - 1 : k + 1], continuous[k - 1 : k + 1], options) for k in at.tolist()]
    if held:
        more = np.array([len(one[0]) for one in held])
        before = np.repeat(at, more)
        source = np.insert(source, before, np.repeat(over, more))
        new = (np.concatenate(part) for part in zip(*held, strict=True))
        tip, axis, continuous = (
            np.insert(old, before, one, axis=0) for old, one in zip((tip, axis, continuous), new, strict=True)
        )
    problems = [*_bend_problems(file, operation, np.flatnonzero(bent & (moves.kind == Kind.LINEAR)), options)]
    if len(source) == len(moves):
        return LinearizedMotion(replace(motion, operation=operation, rotary=rotary), tuple(problems))
    copies = np.bincount(source, minlength=len(moves))
    problems += _limit_problems(file, operation, machine, source, tip, continuous)
    linearized = replace(
        motion,
        operation=insert_rows(operation, copies, tip, axis, moves.kind[source]),
        rotary=_displayed_positions(machine, continuous),
    )
    return LinearizedMotion(linearized, tuple(problems), tuple(_log_added_points(file, operation, copies)))


def _log_added_points(file: str, operation: Operation, copies: Ints) -> Iterable[Decision]:
    added = copies - 1
    most = int(np.argmax(added))
    if added[most]:
        line = int(operation.moves.line[most])
        text = (
            f"{int(added.sum())} points put in between CL points, most of them ({int(added[most])}) before line {line}"
        )
        yield Decision(file, operation.name, line, most, DecisionTopic.POINTS, text)


# Circles


def _keep_slide_arcs(
    machine: Machine, operation: Operation, rotary: Floats, chord_tolerance: float
) -> tuple[Operation, Floats]:
    """Leave the arcs that the slides X and Y make by themselves, with the rotary axes at rest; lines for the others."""
    arcs = operation.arcs
    if not len(arcs.row):
        return operation, rotary
    turn = np.abs(rotary[arcs.row] - rotary[arcs.row - 1]).max(axis=1)
    about = np.array([_is_about_z(machine, rotary[row], arcs.normal[k]) for k, row in enumerate(arcs.row.tolist())])
    keep = (turn <= _NO_MOTION) & about
    copies = arc_piece_counts(operation, keep, chord_tolerance)
    return lines_for_arcs(operation, keep, chord_tolerance), np.repeat(rotary, copies, axis=0)


def _is_about_z(machine: Machine, rotary: Floats, normal: Floats) -> bool:
    """Whether a circle about ``normal`` (workpiece frame) is one about Z of the slides, which stand square."""
    ways = slide_directions(machine, rotary)
    square = bool(np.abs(ways.T @ ways - np.eye(3)).max() < _PARALLEL_SINE)
    return square and abs(float(ways[:, 2] @ normal)) > 1.0 - 0.5 * _PARALLEL_SINE**2


def slide_directions(machine: Machine, rotary: Floats) -> Floats:
    """(3, 3): columns are the ways of the tip, in the workpiece frame, as X, Y and Z grow by 1 mm; ``rotary`` (2,)."""
    joints = np.zeros((4, 5))
    joints[:, list(machine.rotary)] = rotary
    for k, name in enumerate("XYZ"):
        joints[k + 1, machine.column(name)] = 1.0
    tip, _ = forward(machine, joints)
    return np.asarray((tip[1:] - tip[0]).T)


# Rotary positions


def _continuous_positions(machine: Machine, rotary: Floats) -> Floats:
    """Positions as they wind (n, 2), from those within the turn that an endless axis displays: the shorter way on."""
    continuous = rotary.copy()
    for r, column in enumerate(machine.rotary):
        if not np.isnan(machine.axes[column].display_low):
            step = np.diff(rotary[:, r])
            continuous[1:, r] = rotary[1:, r] - 360.0 * np.cumsum(np.rint(step / 360.0))
    return continuous


def _displayed_positions(machine: Machine, continuous: Floats) -> Floats:
    """Positions as the axes display them, (n, 2)."""
    shown = continuous.copy()
    for r, column in enumerate(machine.rotary):
        low = machine.axes[column].display_low
        if not np.isnan(low):
            shown[:, r] -= 360.0 * np.floor((shown[:, r] - low) / 360.0)
    return shown


def _follow_great_circle(machine: Machine, axis: Floats, continuous: Floats, side: Ints) -> tuple[Floats, Flags]:
    """Positions such that an endless first axis goes the way round that the great circle past the pole goes.

    From row to row that is the shorter way but for coarse steps close by the pole. On a great circle of less than half
    a turn the azimuth of the tool axis changes by less than half a turn, and the first axis by this less what the tilt
    of the second turns the tool about it.

    Returns
    -------
    wound, stray
        (n, 2) degrees; and (n,) bool: rows to which an axis with limits goes the other way round.
    """
    first, second = machine.rotary
    sense, line = machine.axes[first].sense, np.array(machine.axes[first].direction)
    steps = np.diff(continuous[:, 0])
    rows = 1 + np.flatnonzero((np.abs(steps) > 90.0) & (side[1:] == side[:-1]) & (side[1:] >= 0))
    stray = np.zeros(len(continuous), np.bool_)
    if not len(rows):
        return continuous, stray
    ends = np.concatenate((rows - 1, rows))
    joints = np.zeros((len(ends), 5))
    joints[:, second] = continuous[ends, 1]
    asked, tilted = (
        np.diff(_azimuths(vectors, line).reshape(2, -1), axis=0)[0]
        for vectors in (axis[ends], forward(machine, joints)[1])
    )
    by_path = _wrapped(asked)
    turn = sense * (by_path - _wrapped(tilted))
    turns = np.rint((turn - steps[rows - 1]) / 360.0) * (np.abs(by_path) < 180.0 - 1e-6)
    if not machine.axes[first].endless:
        stray[rows[turns != 0.0]] = True
        return continuous, stray
    again = np.zeros(len(continuous))
    again[rows] = 360.0 * turns
    return np.column_stack((continuous[:, 0] + np.cumsum(again), continuous[:, 1])), stray


def _azimuths(axis: Floats, line: Floats) -> Floats:
    """(n,) degrees: angles of vectors about a line, from anywhere."""
    across = np.cross(line, np.eye(3)[int(np.argmin(np.abs(line)))])
    across /= np.linalg.norm(across)
    return np.asarray(np.degrees(np.arctan2(axis @ np.cross(line, across), axis @ across)))


def _wrapped(angle: Floats) -> Floats:
    return np.asarray(angle - 360.0 * np.rint(angle / 360.0))


def _turns_in_place(moves: Moves, continuous: Floats) -> Flags:
    """(n,) bool: rapids in which nothing but the rotary axes turns, as on the retreat of a rewind."""
    rows = np.flatnonzero(moves.kind[1:] == Kind.RAPID) + 1
    rests = (moves.tip[rows] == moves.tip[rows - 1]).all(axis=1) & (moves.axis[rows] == moves.axis[rows - 1]).all(
        axis=1
    )
    found = np.zeros(len(moves), np.bool_)
    found[rows] = rests & (np.abs(continuous[rows] - continuous[rows - 1]) > _NO_MOTION).any(axis=1)
    return found


def _branch_change_bend(machine: Machine, axis: Floats, continuous: Floats, side: Ints, stray: Flags) -> Floats:
    """How far the tool axis leaves its great circle where the rotary axes turn evenly to their other side.

    Returns (n,) degrees, -1 for rows on the way to which they keep their side. They turn so on a way through the pole,
    when they go round by another turn, and in the rows ``stray``; no points make that another way.
    """
    bend = np.full(len(axis), -1.0)
    other = (side[1:] != side[:-1]) & (side[1:] >= 0) & (side[:-1] >= 0)
    ended = [not machine.axes[column].endless for column in machine.rotary]
    far = np.abs(np.diff(continuous, axis=0))[:, ended].max(axis=1, initial=0.0) > 180.0 + 1e-6
    for row in (1 + np.flatnonzero(other | far | stray[1:])).tolist():
        joints = np.zeros((len(_BEND_SHARES), 5))
        joints[:, list(machine.rotary)] = continuous[row - 1] + _BEND_SHARES[:, None] * (
            continuous[row] - continuous[row - 1]
        )
        wanted = great_circle_points(axis[row - 1], axis[row], _BEND_SHARES)
        chord = np.linalg.norm(forward(machine, joints)[1] - wanted, axis=1).max()
        bend[row] = math.degrees(2.0 * math.asin(min(0.5 * float(chord), 1.0)))
    return bend


def _points_holding_tip(
    machine: Machine, tip: Floats, continuous: Floats, options: PlanOptions
) -> tuple[Floats, Floats, Floats]:
    """Points between two rows (2, …) that hold the tip on its line while the rotary axes turn evenly.

    Returns
    -------
    tip, axis, rotary
        (k, 3), (k, 3) and (k, 2), the two rows themselves left out.
    """
    pieces = 8
    while True:
        part = np.linspace(0.0, 1.0, pieces + 1)[:, None]
        tips, rotary = tip[0] + part * (tip[1] - tip[0]), continuous[0] + part * (continuous[1] - continuous[0])
        joints = slide_positions(machine, tips, rotary)
        half_tip, half_axis = forward(machine, 0.5 * (joints[1:] + joints[:-1]))
        axis = forward(machine, joints)[1]
        off = np.linalg.norm(half_tip - 0.5 * (tips[1:] + tips[:-1]), axis=1).max() / options.tip_tolerance
        middle = axis[1:] + axis[:-1]
        middle /= np.linalg.norm(middle, axis=1)[:, None]
        bend = np.degrees(np.linalg.norm(half_axis - middle, axis=1).max()) / options.axis_tolerance_between_points
        error = max(float(off), float(bend))
        if error <= _USABLE_SHARE or pieces >= _MAX_PIECES:
            return tips[1:-1], axis[1:-1], rotary[1:-1]
        # What a piece is off by shrinks with the square of its length.
        pieces = min(math.ceil(pieces * min(max(1.02 * math.sqrt(error / _USABLE_SHARE), 1.05), 8.0)), _MAX_PIECES)


# What speaks against it


def _bend_problems(file: str, operation: Operation, rows: Ints, options: PlanOptions) -> Iterable[Problem]:
    """Steps of a cut across the pole in which the axis leaves its great circle whatever is done."""
    for row in rows[:_NAMED].tolist():
        tolerance = f"{options.axis_tolerance_between_points:g} degrees"
        what = f"in this step of the cut the tool axis leaves its path by more than {tolerance}"
        cure = "--set axis_tolerance=DEGREES allows more; or output the toolpath with points nearer to each other"
        yield Problem(file, int(operation.moves.line[row]), f"{what}: the rotary axes change their side", cure)


def _limit_problems(
    file: str, operation: Operation, machine: Machine, source: Ints, tip: Floats, continuous: Floats
) -> Iterable[Problem]:
    """Points put in at which an axis is beyond its limits although it is not at the CL points."""
    added = np.flatnonzero(np.append(source[1:] == source[:-1], False))
    low, high = limits_of(machine, machine.workpiece_zero is not None)

    def beyond(joints: Floats) -> Flags:
        return np.asarray((joints < low - LIMIT_TOLERANCE) | (joints > high + LIMIT_TOLERANCE))

    joints = slide_positions(machine, tip[added], continuous[added])
    outside = beyond(joints)
    found = np.flatnonzero(outside.any(axis=1))
    rows = source[added]
    for away in (0, 1):  # both ends of the way
        ends = np.searchsorted(source, rows[found] - away, "right") - 1
        found = found[~beyond(slide_positions(machine, tip[ends], continuous[ends])).any(axis=1)]
    for row in np.unique(rows[found])[:_NAMED].tolist():
        k = int(found[np.argmax(rows[found] == row)])
        column = int(np.argmax(outside[k]))
        value = float(joints[k, column])
        what = f"on the way to this point {limit_violation_text(machine, column, value)}"
        yield Problem(file, int(operation.moves.line[row]), what, limit_remedy(machine, column, value))
