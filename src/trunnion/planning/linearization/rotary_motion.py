"""How the rotary axes turn from row to row, and where that cannot follow the great circle of the tool axis."""

import math
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.machines import Machine
from trunnion.model.toolpath import Kind, Moves
from trunnion.planning.linearization.arc_chords import great_circle_points
from trunnion.planning.linearization.intermediate_points import branches_of_rows
from trunnion.planning.rotary_positions import continuous_positions, tool_axes
from trunnion.records import dataclass

#: Rotary axes that turn by less than this, degrees, are at rest.
_NO_MOTION: Final = 1e-9

#: Where the bend of a branch change is looked at, as shares of it.
_BEND_SHARES: Final = np.linspace(0.0, 1.0, 65)


@dataclass(frozen=True, slots=True, eq=False)
class RotaryMotion:
    """The turn of the rotary axes into each row.

    positions  (n, 2) float64  as they wind, degrees
    bend       (n,) float64    how far the tool axis leaves its great circle, degrees, in rows into which the axes can
                               only turn evenly, as they change the branch there; -1 elsewhere
    """

    positions: Floats
    bend: Floats

    @property
    def changes_branch(self) -> Flags:
        """(n,) bool: rows into which the axes can only turn evenly."""
        return np.asarray(self.bend >= 0.0)


def rotary_motion(machine: Machine, moves: Moves, rotary: Floats) -> RotaryMotion:
    """Return the motion between displayed positions (n, 2), degrees."""
    positions = continuous_positions(machine, rotary)
    branch = branches_of_rows(machine, positions)
    positions, off_path = _follow_great_circle(machine, moves.axis, positions, branch)
    off_path |= _turns_in_place(moves, positions)
    return RotaryMotion(positions, _branch_change_bend(machine, moves.axis, positions, branch, off_path))


def _follow_great_circle(machine: Machine, axis: Floats, positions: Floats, branch: Ints) -> tuple[Floats, Flags]:
    """Positions with which an endless first axis turns to the side on which the great circle passes the pole.

    From row to row that is the shorter way, except in coarse steps close by the pole. On a great circle of less than
    half a turn the azimuth of the tool axis changes by less than half a turn. The first axis turns by as much, less
    what the tilt of the second one turns the tool about the first.

    positions, off_path  (n, 2) degrees; and (n,) bool: rows into which an axis with limits turns to the other side
    """
    first, _ = machine.rotary
    sense, pole = machine.axes[first].sense, np.array(machine.axes[first].direction)
    steps = np.diff(positions[:, 0])
    rows = 1 + np.flatnonzero((np.abs(steps) > 90.0) & (branch[1:] == branch[:-1]) & (branch[1:] >= 0))
    off_path = np.zeros(len(positions), np.bool_)
    if not len(rows):
        return positions, off_path
    ends = np.concatenate((rows - 1, rows))
    tilted = tool_axes(machine, np.column_stack((np.zeros(len(ends)), positions[ends, 1])))
    by_path, by_tilt = (
        _wrapped(np.diff(_azimuths(vectors, pole).reshape(2, -1), axis=0)[0]) for vectors in (axis[ends], tilted)
    )
    turn = sense * (by_path - by_tilt)
    turns = np.rint((turn - steps[rows - 1]) / 360.0) * (np.abs(by_path) < 180.0 - 1e-6)
    if not machine.axes[first].endless:
        off_path[rows[turns != 0.0]] = True
        return positions, off_path
    more = np.zeros(len(positions))
    more[rows] = 360.0 * turns
    return np.column_stack((positions[:, 0] + np.cumsum(more), positions[:, 1])), off_path


def _azimuths(vectors: Floats, pole: Floats) -> Floats:
    """(n,) float64: angles of vectors (n, 3) about an axis (3,), from an arbitrary direction, degrees."""
    across = np.cross(pole, np.eye(3)[int(np.argmin(np.abs(pole)))])
    across /= np.linalg.norm(across)
    return np.asarray(np.degrees(np.arctan2(vectors @ np.cross(pole, across), vectors @ across)))


def _wrapped(angle: Floats) -> Floats:
    """Angles in [-180, 180], degrees."""
    return np.asarray(angle - 360.0 * np.rint(angle / 360.0))


def _turns_in_place(moves: Moves, positions: Floats) -> Flags:
    """(n,) bool: rapids in which only the rotary axes turn, as on the retract of a rewind."""
    rows = np.flatnonzero(moves.kind[1:] == Kind.RAPID) + 1
    rests = (moves.tip[rows] == moves.tip[rows - 1]).all(axis=1)
    rests &= (moves.axis[rows] == moves.axis[rows - 1]).all(axis=1)
    found = np.zeros(len(moves), np.bool_)
    found[rows] = rests & (np.abs(positions[rows] - positions[rows - 1]) > _NO_MOTION).any(axis=1)
    return found


def _branch_change_bend(machine: Machine, axis: Floats, positions: Floats, branch: Ints, off_path: Flags) -> Floats:
    """``RotaryMotion.bend``: at changes of branch, turns of a limited axis by more than half, and at ``off_path``."""
    bend = np.full(len(axis), -1.0)
    changes = (branch[1:] != branch[:-1]) & (branch[1:] >= 0) & (branch[:-1] >= 0)
    limited = [not machine.axes[column].endless for column in machine.rotary]
    far = np.abs(np.diff(positions, axis=0))[:, limited].max(axis=1, initial=0.0) > 180.0 + 1e-6
    for row in (1 + np.flatnonzero(changes | far | off_path[1:])).tolist():
        turning = positions[row - 1] + _BEND_SHARES[:, None] * (positions[row] - positions[row - 1])
        circle = great_circle_points(axis[row - 1], axis[row], _BEND_SHARES)
        chord = np.linalg.norm(tool_axes(machine, turning) - circle, axis=1).max()
        bend[row] = math.degrees(2.0 * math.asin(min(0.5 * float(chord), 1.0)))
    return bend
