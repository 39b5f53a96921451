"""How far slides go between the ends of lines on which rotary axes turn under TCP.

In:     rows of a run that are such lines, with the positions at their ends.
Out:    places on their ways at which slides go beyond both ends of the row and beyond what has been found so far.
Units:  mm and degrees.

On such a line a slide is s(u) = a(u) . p(u) with the angles and the tip even in u, from 0 to 1. With the angle w that
both rotary axes turn together, the tip's way d, and the longest arm L from a rotary axis to the tip,

    |s''| <= k (w^2 L + 2 w d)

where k is the norm of the slide's normal. A curve leaves its chord by at most an eighth of that. Where the tool axis
moves on a great circle instead, rotary axes turn unevenly, by 2 w at most, and a slide goes beyond its ends by
k (d / 2 + w L) at most, and far from the poles by no more than sixteen times as much as with even angles: there their
second derivatives are below 16 w^2. Lines whose bound stays within what has been found are done; the others are cut
into eight pieces with bounds of their own, and these again.
"""

import math
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Floats2, Ints
from trunnion.jit import kernel
from trunnion.machines import KinematicParameters, Machine, inverse, kinematic_parameters
from trunnion.model.axis_positions import joints_from_rows
from trunnion.model.subdivision import slerp
from trunnion.records import dataclass

#: Rotary axes that turn by less stand, degrees.
STANDS: Final = 1e-9

#: On great circles the bound for angles that are nearly even holds for turns up to so many radians, where two tool axes
#: that differ by one rotary axis each are this share as independent as at best; and what it allows for.
_SMALL_TURN: Final = 0.1
_FROM_POLE: Final = 0.2
_UNEVEN: Final = 16.0

#: Slides that may go on by less, mm, are not looked at.
_NEGLIGIBLE: Final = 1e-3

#: Pieces into which a line or a piece is cut, and how often.
_PIECES: Final = 8
_ROUNDS: Final = 3

#: Lines that are searched at a time: the likeliest first, so that most others need no look.
_AT_A_TIME: Final = 512

#: Where rotary axes stand between slides, directions of slides turn against each other, and the bound is an estimate.
_BETWEEN_SLIDES: Final = 4.0


def longest_arms(kinematics: KinematicParameters, tip: Floats) -> Floats:
    """(n,): the longest arms from a rotary axis to tips (n, 3), mm, for the workpiece zero of ``kinematics``."""
    arm = np.linalg.norm(tip - np.array(kinematics.first_point), axis=1)
    others = np.linalg.norm(kinematics.second_offset) + np.linalg.norm(kinematics.tool_offset)
    return np.asarray(arm + others)


def chord_excursion(turn: Floats, way: Floats, arm: Floats) -> Floats:
    """How far a slide with a normal of length 1 leaves its chord at most, (n,) mm.

    turn      (n,) float64: angles that both rotary axes turn together, evenly, radians
    way, arm  (n,) float64: of the tip, and from a rotary axis to it, mm
    """
    return np.asarray((turn**2 * arm + 2.0 * turn * way) / 8.0)


@kernel(writes="beyond")
def write_beyond(
    tip: Floats2,
    joints: Floats2,
    counts: Flags,
    great_circle: Flags,
    kinematics: KinematicParameters,
    normals: Floats,
    columns: Ints,
    pole: Floats,
    extremes: Floats2,
    beyond: Floats,
) -> None:
    """Write how far slides may go beyond what has been found in rows, mm; 0 where they do not.

    normals  (3,)  lengths of the normals of the slides
    columns  (5,)  of the rotary axes and of the slides
    pole     (2,)  as ``_pole_distance`` has it
    """
    point, second, tool = kinematics.first_point, kinematics.second_offset, kinematics.tool_offset
    others = math.sqrt(second[0] ** 2 + second[1] ** 2 + second[2] ** 2)
    others += math.sqrt(tool[0] ** 2 + tool[1] ** 2 + tool[2] ** 2)
    for row in range(counts.shape[0]):
        beyond[row] = 0.0
        first = abs(joints[row + 1, columns[0]] - joints[row, columns[0]])
        turn = first + abs(joints[row + 1, columns[1]] - joints[row, columns[1]])
        if not counts[row] or not turn > STANDS:
            continue
        turn = math.radians(turn)
        way, arm, arm_before = 0.0, 0.0, 0.0
        for k in range(3):
            way += (tip[row + 1, k] - tip[row, k]) ** 2
            arm += (tip[row + 1, k] - point[k]) ** 2
            arm_before += (tip[row, k] - point[k]) ** 2
        way, arm = math.sqrt(way), math.sqrt(max(arm, arm_before)) + others
        bound = (turn * turn * arm + 2.0 * turn * way) / 8.0
        if great_circle[row]:
            angle, after = math.radians(joints[row, columns[1]]), math.radians(joints[row + 1, columns[1]])
            away = abs(pole[0] * math.cos(angle) + pole[1] * math.sin(angle))
            away = min(away, abs(pole[0] * math.cos(after) + pole[1] * math.sin(after)))
            uneven = _UNEVEN * bound if turn <= _SMALL_TURN and away >= _FROM_POLE else np.inf
            bound = min(0.5 * way + turn * arm, uneven)
        for k in range(3):
            column = columns[2 + k]
            low, high = joints[row, column], joints[row + 1, column]
            if low > high:
                low, high = high, low
            room = bound * normals[k]
            beyond[row] = max(beyond[row], high + room - extremes[column, 1], extremes[column, 0] - low + room)


def _pole_distance(machine: Machine) -> Floats:
    """(2,): with cosine and sine of the second rotary position, how far tool axes are from where axes turn fast.

    That is how independent the ways are that both rotary axes turn the tool, as a share of the most. With the lines of
    the axes a and b and the tool t that is |t . (a x b)|, as the first axis turns all of them together.
    """
    first, second = (np.array(machine.axes[column].direction) for column in machine.rotary)
    tool, square = np.array(machine.spindle_direction), np.cross(first, second)
    pair = np.array([square @ tool, machine.axes[machine.rotary[1]].sense * (square @ np.cross(second, tool))])
    return np.asarray(pair / max(float(np.linalg.norm(pair)), 1e-12))


@dataclass(frozen=True, slots=True, eq=False)
class TurningLines:
    """n lines on which rotary axes turn under TCP.

    row                 (n,)    of the run
    tip                 (n, 2, 3)  at the ends, mm, workpiece frame
    axis                (n, 2, 3)  tool axes there
    joints              (n, 2, 5)  axis values there, mm and degrees
    great_circle        (n,)    bool: the tool axis moves on one, else both angles move evenly
    """

    row: Ints
    tip: Floats
    axis: Floats
    joints: Floats
    great_circle: Flags

    def select(self, which: Ints | Flags) -> "TurningLines":
        """Return some of them."""
        return TurningLines(
            self.row[which], self.tip[which], self.axis[which], self.joints[which], self.great_circle[which]
        )


@dataclass(frozen=True, slots=True, eq=False)
class _Pieces:
    """m pieces of lines: line (m,), shares of it (m, 2), and axis values (m, 2, 5) at both ends."""

    line: Ints
    share: Floats
    joints: Floats

    def select(self, which: Ints | Flags) -> "_Pieces":
        return _Pieces(self.line[which], self.share[which], self.joints[which])


class LineSearch:
    """Searches how far slides go on lines of a machine.

    extremes  (5, 2) float64  least and greatest values so far, mm, as ``machine.axes`` has them; raised by the search
    rows      (5, 2) int64    the rows that have them
    within    (5, 2) bool     whether that is between the ends of a line
    """

    def __init__(self, machine: Machine, extremes: Floats, rows: Ints, within: Flags) -> None:
        self._machine, self._kinematics = machine, kinematic_parameters(machine)
        self._extremes, self._rows, self._within = extremes, rows, within
        self._slides, self._rotary = list(machine.linear), list(machine.rotary)
        below = len(set(self._kinematics.rotary_below)) > 1
        inverse_slides = np.array(self._kinematics.slides_inverse).reshape(3, 3)
        lengths = np.full(3, _BETWEEN_SLIDES) if below else np.linalg.norm(inverse_slides, axis=1)
        columns = self._kinematics.columns[2:]
        self._normals = np.array([lengths[columns.index(column)] for column in self._slides])
        self._columns = np.array([*self._rotary, *self._slides])
        self._pole = _pole_distance(machine)

    def likely(self, tip: Floats, joints: Floats, counts: Flags, great_circle: Flags) -> Ints:
        """Which of n consecutive rows may go beyond what has been found, the farthest first.

        tip, joints           (n + 1, 3), (n + 1, 5) float64: the position before the rows comes first
        counts, great_circle  (n,) bool: which rows are lines under TCP, and on which of these the tool axis moves on a
                              great circle
        """
        beyond = np.empty(len(counts))
        write_beyond(
            tip, joints, counts, great_circle, self._kinematics, self._normals, self._columns,
            self._pole, self._extremes, beyond,
        )  # fmt: skip
        found = np.flatnonzero(beyond > _NEGLIGIBLE)
        return np.asarray(found[np.argsort(-beyond[found], kind="stable")])

    def add(self, lines: TurningLines) -> None:
        """Search lines, which should come in the order of ``likely``."""
        order = np.arange(len(lines.row))
        for first in range(0, len(order), _AT_A_TIME):
            some = lines.select(order[first : first + _AT_A_TIME])
            cut = _Pieces(np.arange(len(some.row)), np.tile([0.0, 1.0], (len(some.row), 1)), some.joints)
            for _ in range(_ROUNDS):
                cut = cut.select(self._beyond(some, cut) > _NEGLIGIBLE)
                if not len(cut.line):
                    break
                cut = self._cut(some, cut)

    def _beyond(self, lines: TurningLines, pieces: _Pieces) -> Floats:
        """(m,): how far slides may go on pieces beyond what has been found, mm; NaN counts as not at all."""
        tip, line = lines.tip[pieces.line], pieces.line
        share = pieces.share[:, 1] - pieces.share[:, 0]
        turn = np.radians(np.abs(np.diff(pieces.joints[:, :, self._rotary], axis=1)).sum(axis=(1, 2)))
        way = np.linalg.norm(tip[:, 1] - tip[:, 0], axis=1) * share
        arm = np.maximum(*(longest_arms(self._kinematics, tip[:, end]) for end in (0, 1)))
        bound = np.where(lines.great_circle[line], 0.5 * way + turn * arm, chord_excursion(turn, way, arm))
        room = bound[:, None] * self._normals
        slides = pieces.joints[:, :, self._slides]
        low, high = self._extremes[self._slides].T
        over = np.maximum(slides.max(axis=1) + room - high, low - slides.min(axis=1) + room)
        return np.asarray(np.nan_to_num(over.max(axis=1), nan=-np.inf))

    def _cut(self, lines: TurningLines, pieces: _Pieces) -> _Pieces:
        """Cut pieces, and keep what their ends show."""
        steps = np.linspace(0.0, 1.0, _PIECES + 1)
        shares = pieces.share[:, :1] + steps * (pieces.share[:, 1:] - pieces.share[:, :1])
        inner = shares[:, 1:-1]
        line = np.repeat(pieces.line, _PIECES - 1)
        joints = np.empty((len(pieces.line), _PIECES + 1, 5))
        joints[:, [0, -1]] = pieces.joints
        joints[:, 1:-1] = self._joints_at(lines, line, inner.ravel()).reshape(len(pieces.line), _PIECES - 1, 5)
        self._keep(lines, pieces.line, joints[:, 1:-1])
        ends = np.stack((joints[:, :-1], joints[:, 1:]), axis=2).reshape(-1, 2, 5)
        between = np.stack((shares[:, :-1], shares[:, 1:]), axis=2).reshape(-1, 2)
        return _Pieces(np.repeat(pieces.line, _PIECES), between, ends)

    def _joints_at(self, lines: TurningLines, line: Ints, share: Floats) -> Floats:
        """(k, 5): axis values at shares of lines; slides that cannot follow are NaN."""
        part = share[:, None]
        begin, end = lines.joints[line][:, :, self._rotary].transpose(1, 0, 2)
        rotary = begin + part * (end - begin)
        bent = lines.great_circle[line]
        if bent.any():
            vector = slerp(lines.axis[line[bent], 0], lines.axis[line[bent], 1], share[bent])
            rotary[bent] = self._nearest_rotary(vector, rotary[bent])
        tip = lines.tip[line, 0] + part * (lines.tip[line, 1] - lines.tip[line, 0])
        return joints_from_rows(self._machine, self._kinematics, np.ones(len(line), np.bool_), tip, rotary)

    def _nearest_rotary(self, vector: Floats, near: Floats) -> Floats:
        """(k, 2): the rotary positions of tool axes nearest to given ones, degrees; those where there are none."""
        solved = inverse(self._machine, np.zeros((len(vector), 3)), vector)
        angles = solved.joints[:, :, self._rotary]
        angles += 360.0 * np.rint((near - angles) / 360.0)
        angles[:, solved.pole, 0] = near[solved.pole, 0]
        off = np.abs(angles - near).sum(axis=2)
        best = np.argmin(np.where(np.isnan(off), np.inf, off), axis=0)
        found = angles[best, np.arange(len(vector))]
        return np.where(np.isnan(found), near, found)

    def _keep(self, lines: TurningLines, line: Ints, joints: Floats) -> None:
        """Raise the extremes to values (m, p, 5) on lines (m,) that are beyond both ends of their line."""
        for column in self._slides:
            ends = lines.joints[line][:, :, column]
            for side, sign in ((0, -1.0), (1, 1.0)):
                values = np.nan_to_num(sign * joints[:, :, column], nan=-np.inf).max(axis=1)
                values[values <= np.nan_to_num(sign * ends, nan=np.inf).max(axis=1)] = -np.inf
                at = int(np.argmax(values))
                if values[at] > sign * self._extremes[column, side]:
                    self._extremes[column, side] = sign * values[at]
                    self._rows[column, side], self._within[column, side] = lines.row[line[at]], True
