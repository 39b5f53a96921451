"""With TCP and without a requested tolerance: the few steps of a cut in which the tool axis would leave its path far.

Such a step is one through the pole, where the rotary axis next to the part must turn, or an unusually coarse one. At
the pole that axis turns in a block of its own, in which neither the tip nor the tool axis moves. A step from one side
of the pole to the other is led through it, where that is no farther off its path than the tolerance.
"""

import math
from collections.abc import Iterable
from dataclasses import replace
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.errors import Problem
from trunnion.machines import Machine, inverse
from trunnion.messages import Wording
from trunnion.model.axis_tolerance import allowed_deviation
from trunnion.model.motion import Motion
from trunnion.model.toolpath import Kind, Moves
from trunnion.planning.linearization.arc_chords import great_circle_points
from trunnion.planning.linearization.intermediate_points import DividedPath, divide_path
from trunnion.planning.linearization.leg_division import PathRows
from trunnion.planning.linearization.rotary_motion import rotary_motion
from trunnion.planning.poses.contact import NO_CONTACT, contact_of
from trunnion.planning.rotary_positions import continuous_positions, tool_axes
from trunnion.records import dataclass

#: Where a step is looked at, as shares of it.
_SHARES: Final = np.linspace(0.0, 1.0, 17)[1:-1]

#: Part of a tolerance that inserted points use; the rest is for the way through the pole, and for rounding.
_USED_PART: Final = 0.5

#: Sine of the angle to the pole below which a tool axis is in it.
_AT_POLE: Final = 1e-7

#: Rows that are looked at together, so that their columns stay in the processor's cache.
_CHUNK: Final = 16384

#: Rows that are named one by one.
_NAMED: Final = 5


@dataclass(frozen=True, slots=True, eq=False)
class DefaultPoints:
    """The path with its points, None where it needs none; and what cannot be mended."""

    path: DividedPath | None
    problems: tuple[Problem, ...] = ()


def default_points(file: str, machine: Machine, motion: Motion, tolerance: float) -> DefaultPoints:
    """Insert points where the tool axis would leave its path farther than is allowed by default.

    file       CL file, for messages
    motion     with TCP
    tolerance  of the tool axis in this operation, degrees
    """
    moves = motion.operation.moves
    if moves.normal is not None:  # between CL points no surface normal is known
        return DefaultPoints(None)
    if not _leaves_path(machine, motion, tolerance):
        return DefaultPoints(None)
    turning = rotary_motion(machine, moves, motion.rotary)
    positions = turning.positions
    rows = rows_off_path(machine, moves, positions, tolerance)
    across = set(rows[turning.changes_branch[rows]].tolist())
    divisible = np.zeros(len(moves), np.bool_)
    added, failed = list[_Added](), list[int]()
    for row in rows.tolist():
        if _is_at_pole(machine, moves.axis[row - 1]):
            turned = np.array([positions[row, 0], positions[row - 1, 1]])
            added.append(_Added(row, moves.tip[row - 1], moves.axis[row - 1], turned, divisible=False))
            divisible[row] = True
        elif _is_at_pole(machine, moves.axis[row]):
            held = np.array([positions[row - 1, 0], positions[row, 1]])
            added.append(_Added(row, moves.tip[row], moves.axis[row], held, divisible=True))
        else:
            poles = _through_pole(machine, moves, positions, row, _USED_PART * tolerance)
            added += poles
            failed += [row] if row in across and not poles else []
            divisible[row] = bool(poles) or row not in across
    path = _divided(machine, moves, positions, divisible, added, _USED_PART * tolerance)
    return DefaultPoints(path, tuple(_problems(file, moves.line[failed].tolist(), tolerance)))


def _leaves_path(machine: Machine, motion: Motion, tolerance: float) -> bool:
    """Whether a step does; asked of a chunk of rows at a time, as few toolpaths have such a step."""
    moves = motion.operation.moves
    chunks = (slice(max(0, first - 1), first + _CHUNK) for first in range(0, len(moves), _CHUNK))
    return any(
        len(rows_off_path(machine, moves.select(rows), continuous_positions(machine, motion.rotary[rows]), tolerance))
        for rows in chunks
    )


def rows_off_path(machine: Machine, moves: Moves, positions: Floats, tolerance: float) -> Ints:
    """Return the rows of a cut in which the rotary axes, turning evenly, lead the tool axis too far off its circle.

    positions  (n, 2) of the rotary axes, without jumps of whole turns, degrees
    tolerance  of the tool axis from its great circle, degrees
    """
    cuts = (moves.kind[1:] == Kind.LINEAR) & (contact_of(moves)[1:] != NO_CONTACT)
    turns = np.abs(np.diff(positions, axis=0))
    turn = np.radians(turns[:, 0] + turns[:, 1])
    # A curve with a second derivative of the square of the turn is off its chord by an eighth of it; so is the circle.
    rows = 1 + np.flatnonzero(cuts & (0.25 * turn * turn > math.radians(_USED_PART * tolerance)))
    if not len(rows):
        return rows
    off = np.zeros(len(rows))
    for share in _SHARES:
        turned = tool_axes(machine, positions[rows - 1] + share * (positions[rows] - positions[rows - 1]))
        chord = np.linalg.norm(turned - _on_circle(moves.axis[rows - 1], moves.axis[rows], share), axis=1)
        off = np.maximum(off, np.degrees(2.0 * np.arcsin(np.minimum(0.5 * chord, 1.0))))
    return np.asarray(rows[off > allowed_deviation(tolerance, _turns(moves, rows))])


def _turns(moves: Moves, rows: Ints) -> Floats:
    """How far the tool axis turns into rows, (k,) degrees."""
    chord = np.linalg.norm(moves.axis[rows] - moves.axis[rows - 1], axis=1)
    return np.asarray(np.degrees(2.0 * np.arcsin(np.minimum(0.5 * chord, 1.0))))


def _on_circle(start: Floats, end: Floats, share: float) -> Floats:
    """Vectors (k, 3) at a share of the great circles between unit vectors."""
    angle = 2.0 * np.arcsin(np.minimum(0.5 * np.linalg.norm(end - start, axis=1), 1.0))
    sine = np.where(np.sin(angle) < 1e-9, 1.0, np.sin(angle))
    still = np.sin(angle) < 1e-9
    first = np.where(still, 1.0 - share, np.sin((1.0 - share) * angle) / sine)
    last = np.where(still, share, np.sin(share * angle) / sine)
    return np.asarray(first[:, None] * start + last[:, None] * end)


@dataclass(frozen=True, slots=True, eq=False)
class _Added:
    """A row before ``row``; further points may be put before it where it is ``divisible``."""

    row: int
    tip: Floats
    axis: Floats
    rotary: Floats
    divisible: bool


def _is_at_pole(machine: Machine, axis: Floats) -> bool:
    """Whether the rotary axis next to the part may turn under a tool axis (3,) and leave it where it is."""
    return float(np.linalg.norm(np.cross(axis, machine.axes[machine.rotary[0]].direction))) < _AT_POLE


def _through_pole(machine: Machine, moves: Moves, positions: Floats, row: int, tolerance: float) -> list[_Added]:
    """Two rows at the pole beside the step into a row, before and behind the turn there.

    None if the step does not pass it within the tolerance, degrees, or the machine cannot stand there.
    """
    axis = np.array(machine.axes[machine.rotary[0]].direction)
    circle = great_circle_points(moves.axis[row - 1], moves.axis[row], np.linspace(0.0, 1.0, 257))
    if float((circle @ axis).mean()) < 0.0:
        axis = -axis
    nearest = int(np.argmax(circle @ axis))
    off = math.degrees(2.0 * math.asin(min(0.5 * float(np.linalg.norm(circle[nearest] - axis)), 1.0)))
    share = nearest / 256.0
    tip = moves.tip[row - 1] + share * (moves.tip[row] - moves.tip[row - 1])
    found = inverse(machine, tip[None], axis[None])
    if off > tolerance or nearest in (0, 256) or not found.reachable[0]:
        return []
    second = found.joints[:, 0, machine.rotary[1]]
    middle = 0.5 * (positions[row - 1, 1] + positions[row, 1])
    second = second - 360.0 * np.rint((second - middle) / 360.0)
    there = second[np.argmin(np.abs(second - middle))]
    before, behind = (np.array([positions[k, 0], there]) for k in (row - 1, row))
    return [_Added(row, tip, axis, before, divisible=True), _Added(row, tip, axis, behind, divisible=False)]


def _divided(
    machine: Machine, moves: Moves, positions: Floats, divisible: Flags, added: list[_Added], tolerance: float
) -> DividedPath:
    """Return the path with added rows, and with the points that it then needs."""
    before = np.array([each.row for each in added], np.int64)
    source = np.insert(np.arange(len(moves)), before, before)
    tip, axis, rotary = moves.tip, moves.axis, positions
    if added:
        tip = np.insert(tip, before, np.array([each.tip for each in added]), axis=0)
        axis = np.insert(axis, before, np.array([each.axis for each in added]), axis=0)
        rotary = np.insert(rotary, before, np.array([each.rotary for each in added]), axis=0)
    path = divide_path(
        machine, PathRows(tip, axis, rotary), np.insert(divisible, before, [each.divisible for each in added]),
        tcp=True, tip_tolerance=math.inf, axis_tolerance=tolerance,
    )  # fmt: skip
    return replace(path, source=source[path.source])


def _problems(file: str, lines: list[int], tolerance: float) -> Iterable[Problem]:
    for line in lines[:_NAMED]:
        yield Problem(file, line, Wording("PLN140", "step_cut_tool", tolerance=tolerance))
