"""Last stage: points between CL points, where the control would otherwise lead the tool off its path.

With TCP the control keeps the tip on its line, so points are inserted only for the tool axis, and only in cuts; without
a requested tolerance only in few steps (``trunnion.planning.linearization.default_points``).

Without TCP every axis moves evenly from point to point, and the tool leaves its line wherever a rotary axis turns, in
rapids too; arcs stay arcs only where the slides make them by themselves.

Where the rotary axes change to their other branch, through the pole in a cut or anywhere in a rapid, they turn evenly
and points only keep the tip on its line. In a cut the tool axis must stay within its tolerance there. The turn of a
rewind is such a change: the slides follow it, and the tip rests at the clearance.
"""

import math
from collections.abc import Iterable
from dataclasses import replace
from typing import Final

import numpy as np

from trunnion.arrays import Floats, Ints, distinct
from trunnion.errors import Problem
from trunnion.machines import Machine, forward, slide_positions
from trunnion.messages import Wording
from trunnion.model.motion import Decision, DecisionTopic, MachiningMode, Motion
from trunnion.model.toolpath import Kind, Operation
from trunnion.planning.axis_limits import limit_remedy, limit_violation_text, limits_of, outside_limits
from trunnion.planning.linearization.default_points import default_points
from trunnion.planning.linearization.intermediate_points import USABLE_SHARE, DividedPath, divide_path
from trunnion.planning.linearization.leg_division import PathRows
from trunnion.planning.linearization.rotary_motion import rotary_motion
from trunnion.planning.linearization.row_insertion import insert_rows
from trunnion.planning.linearization.slide_arcs import keep_slide_arcs
from trunnion.planning.options import PlanOptions
from trunnion.planning.request import PlanRequest
from trunnion.planning.rotary_positions import displayed_positions
from trunnion.records import dataclass

#: Pieces into which an even turn is cut: at first, and at most.
_FIRST_PIECES: Final = 8
_MAX_PIECES: Final = 50_000


#: Rows that are named one by one.
_NAMED: Final = 5


@dataclass(frozen=True, slots=True, eq=False)
class LinearizedMotion:
    """A motion with the points that it needs, what is wrong with them, and a decision about them."""

    motion: Motion
    problems: tuple[Problem, ...] = ()
    log: tuple[Decision, ...] = ()


def linearize(file: str, motion: Motion, request: PlanRequest) -> LinearizedMotion:
    """Insert the points that a motion needs.

    file     CL file, for messages
    motion   in modes other than TCP and without TCP it is returned as it is
    request  without TCP its machine must have a workpiece zero and, if a head turns the tool, the tool's length
    """
    options, machine = request.options, request.machine
    without_tcp = motion.mode.goes_straight
    tolerance = options.axis_tolerance_between_points
    if not without_tcp and motion.mode is not MachiningMode.TCP:
        return LinearizedMotion(motion)
    operation, rotary = motion.operation, motion.rotary
    if math.isinf(tolerance):
        found = default_points(file, machine, motion, options.default_axis_tolerance.of(operation))
        if found.path is None:
            return LinearizedMotion(motion, found.problems)
        return _with_points(file, motion, operation, machine, found.path, list(found.problems))
    if without_tcp:
        operation, source = keep_slide_arcs(machine, operation, rotary, request.chord_tolerance)
        rotary, motion = rotary[source], _with_cl_rows(motion, source)
    moves = operation.moves
    turning = rotary_motion(machine, moves, rotary)
    leaves_path = turning.bend > tolerance
    divisible = (moves.kind != Kind.ARC) & ~turning.changes_branch
    if not without_tcp:
        divisible &= moves.kind == Kind.LINEAR
    divisible[0] = False
    path = divide_path(
        machine, PathRows(moves.tip, moves.axis, turning.positions), divisible,
        tcp=not without_tcp, tip_tolerance=options.tip_tolerance, axis_tolerance=tolerance,
    )  # fmt: skip
    if without_tcp:
        even_turns = turning.changes_branch & ~(leaves_path & (moves.kind != Kind.RAPID))
        path = _hold_tip(machine, path, np.flatnonzero(even_turns), options)
    problems = [*_bend_problems(file, operation, np.flatnonzero(leaves_path & (moves.kind == Kind.LINEAR)), options)]
    if len(path.source) == len(moves):
        return LinearizedMotion(replace(motion, operation=operation, rotary=rotary), tuple(problems))
    return _with_points(file, motion, operation, machine, path, problems)


def _with_cl_rows(motion: Motion, source: Ints) -> Motion:
    """Return the motion with the CL rows of its rows ``source`` (n,)."""
    return motion if motion.cl_rows is None else replace(motion, cl_rows=motion.cl_rows[source])


def _with_points(
    file: str, motion: Motion, operation: Operation, machine: Machine, path: DividedPath, problems: list[Problem]
) -> LinearizedMotion:
    """Return the motion along a path with points between the rows of its ``operation``."""
    copies = np.bincount(path.source, minlength=len(operation.moves))
    problems += _limit_problems(file, operation, machine, path)
    linearized = replace(
        _with_cl_rows(motion, path.source),
        operation=insert_rows(operation, copies, path.tip, path.axis, operation.moves.kind[path.source]),
        rotary=displayed_positions(machine, path.rotary),
    )
    return LinearizedMotion(linearized, tuple(problems), tuple(_decisions(file, operation, copies)))


def _hold_tip(machine: Machine, path: DividedPath, rows: Ints, options: PlanOptions) -> DividedPath:
    """Insert points that keep the tip on its line while the rotary axes turn evenly into ``rows``."""
    at = np.searchsorted(path.source, rows)
    added = [
        _points_holding_tip(machine, path.tip[k - 1 : k + 1], path.rotary[k - 1 : k + 1], options) for k in at.tolist()
    ]
    if not added:
        return path
    counts = np.array([len(tip) for tip, _, _ in added])
    before = np.repeat(at, counts)
    tip, axis, rotary = (
        np.insert(old, before, np.concatenate(new), axis=0)
        for old, new in zip((path.tip, path.axis, path.rotary), zip(*added, strict=True), strict=True)
    )
    return DividedPath(np.insert(path.source, before, np.repeat(rows, counts)), tip, axis, rotary)


def _points_holding_tip(
    machine: Machine, tip: Floats, rotary: Floats, options: PlanOptions
) -> tuple[Floats, Floats, Floats]:
    """Tip (k, 3), tool axis (k, 3) and rotary positions (k, 2) of the points between two rows.

    ``tip`` (2, 3) and ``rotary`` (2, 2) are those of the rows.
    """
    pieces = _FIRST_PIECES
    while True:
        share = np.linspace(0.0, 1.0, pieces + 1)[:, None]
        tips, turned = tip[0] + share * (tip[1] - tip[0]), rotary[0] + share * (rotary[1] - rotary[0])
        joints = slide_positions(machine, tips, turned)
        half_tip, half_axis = forward(machine, 0.5 * (joints[1:] + joints[:-1]))
        axis = forward(machine, joints)[1]
        off = np.linalg.norm(half_tip - 0.5 * (tips[1:] + tips[:-1]), axis=1).max() / options.tip_tolerance
        middle = axis[1:] + axis[:-1]
        middle /= np.linalg.norm(middle, axis=1)[:, None]
        bend = np.degrees(np.linalg.norm(half_axis - middle, axis=1).max()) / options.axis_tolerance_between_points
        error = max(float(off), float(bend))
        if error <= USABLE_SHARE or pieces >= _MAX_PIECES:
            return tips[1:-1], axis[1:-1], turned[1:-1]
        # The error of a piece shrinks with the square of its length.
        pieces = min(math.ceil(pieces * min(max(1.02 * math.sqrt(error / USABLE_SHARE), 1.05), 8.0)), _MAX_PIECES)


def _decisions(file: str, operation: Operation, copies: Ints) -> Iterable[Decision]:
    added = copies - 1
    most = int(np.argmax(added))
    if added[most]:
        line = int(operation.moves.line[most])
        said = Wording("decision", "points", count=int(added.sum()), most=int(added[most]), line=line)
        yield Decision(file, operation.name, line, most, DecisionTopic.POINTS, said)


def _bend_problems(file: str, operation: Operation, rows: Ints, options: PlanOptions) -> Iterable[Problem]:
    """Yield steps of a cut through the pole in which no point keeps the tool axis within its tolerance."""
    for row in rows[:_NAMED].tolist():
        yield Problem(
            file,
            int(operation.moves.line[row]),
            Wording(
                "PLN140", "step_cut_tool_axis", axis_tolerance_between_points=options.axis_tolerance_between_points
            ),
        )


def _limit_problems(file: str, operation: Operation, machine: Machine, path: DividedPath) -> Iterable[Problem]:
    """Yield inserted points at which an axis is beyond its limits, if it is not so at the rows around them.

    Of each row, the point at which the axis is farthest beyond its limit: that is how far it must come back.
    """
    source = path.source
    added = np.flatnonzero(np.append(source[1:] == source[:-1], False))
    limits = limits_of(machine, machine.workpiece_zero is not None)
    joints = slide_positions(machine, path.tip[added], path.rotary[added])
    outside = outside_limits(joints, *limits)
    found = np.flatnonzero(outside.any(axis=1))
    rows = source[added]
    for before in (0, 1):  # the row that a point leads to, and the one before
        ends = np.searchsorted(source, rows[found] - before, "right") - 1
        at_ends = slide_positions(machine, path.tip[ends], path.rotary[ends])
        found = found[~outside_limits(at_ends, *limits).any(axis=1)]
    for row in distinct(rows[found])[:_NAMED].tolist():
        of_row = found[rows[found] == row]
        column = int(np.argmax(outside[of_row[0]]))
        values = joints[of_row, column]
        beyond = np.maximum(values - machine.axes[column].high, machine.axes[column].low - values)
        value = float(values[np.argmax(beyond)])
        violation, remedy = limit_violation_text(machine, column, value), limit_remedy(machine, column, value)
        wording = Wording("PLN120", "on_the_way", violation=violation, remedy=remedy)
        yield Problem(file, int(operation.moves.line[row]), wording)
