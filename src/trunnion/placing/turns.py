"""A path at turns of the part about Z, for one choice of branches."""

from collections.abc import Iterator
from dataclasses import replace
from enum import StrEnum
from functools import cached_property
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.machines import Machine
from trunnion.model.rotations import about_z
from trunnion.placing.axis_equations import AxisEquations, axis_equations
from trunnion.placing.extremes import Extremes
from trunnion.placing.largest_margin import linear_program
from trunnion.placing.moving_samples import arc_samples, turning_samples
from trunnion.placing.path_rows import PathRows
from trunnion.placing.rotary_angles import Obstacle, RotaryAngles, rotary_angles
from trunnion.placing.table_limits import Standing, TableLimits
from trunnion.placing.travel_limits import FARTHEST, CutSet, slide_limits
from trunnion.placing.turning import (
    Turning,
    outermost,
    reaches_any_turn,
    rows_that_stand,
    turned_head,
    turning_of,
)
from trunnion.records import dataclass

#: An outline that is larger by less is as large as the table, mm.
_ROUNDING: Final = 1e-9

_MOST_ROUNDS: Final = 200


class Choice(StrEnum):
    """Which solutions of the inverse map rows take; values are words for messages."""

    AS_PLANNED = "as planned"
    FIRST = "first branch"
    SECOND = "second branch"


def choices_of(rows: PathRows) -> Iterator[tuple[Choice, PathRows]]:
    """Yield the choices that differ, with their rows: as the planner or the program has it, and each branch
    throughout.
    """
    first, last = int(rows.branch.min()), int(rows.branch.max())
    yield Choice.AS_PLANNED, rows
    for branch, choice in enumerate((Choice.FIRST, Choice.SECOND)):
        if not first == last == branch:
            yield choice, rows.with_branch(branch)


@dataclass(frozen=True, eq=False)
class TurnedPath:
    """A path with one choice, which can be turned.

    machine  without a workpiece zero
    near     (3,) mm: a place of the zero near which there will be most questions
    standing  what must stand on the table; None: nothing is known of it
    """

    machine: Machine
    choice: Choice
    rows: PathRows
    near: Floats
    standing: Standing | None = None

    @staticmethod
    def of(
        machine: Machine, choice: Choice, rows: PathRows, near: Floats, standing: Standing | None = None
    ) -> "TurnedPath":
        """Return a path on a machine, wherever its workpiece zero is."""
        return TurnedPath(replace(machine, workpiece_zero=None), choice, rows, near, standing)

    def at(self, turn: float) -> CutSet | Obstacle:
        """Return the half-spaces of the path at a turn, degrees; or why it is out of reach there, or the table too
        small.
        """
        if self.standing is None:
            return self._reached_at(turn)
        table = self.standing.turned(about_z(turn)).limits()
        if not has_room(table):
            return Obstacle(-1, outline=table.extent)
        found = self._reached_at(turn)
        return found if isinstance(found, Obstacle) else CutSet(found.parts, found.limits, table)

    def _reached_at(self, turn: float) -> CutSet | Obstacle:
        if self._turning is Turning.OTHER:
            return self._whole_at(turn)
        base = self._base
        if isinstance(base, Obstacle) and (turn == 0.0 or base.axis != self.machine.rotary[0]):
            return base
        if isinstance(base, Obstacle):
            return self._whole_at(turn)
        if not reaches_any_turn(self.machine):
            angles = rotary_angles(self.machine, self.rows.turned(about_z(turn)))
            if isinstance(angles, Obstacle):
                return angles
        return self._of_parts(base, about_z(turn))

    def _of_parts(self, base: "_Base", turn: Floats) -> CutSet | Obstacle:
        """Return the half-spaces of rows that turn along, and of those at the pole that do not."""
        parts = []
        if base.free is not None and self._turning is Turning.TABLE:
            parts.append(base.free.turned(turn, self._pivot))
        elif base.free is not None:
            parts.append(Extremes.of(turned_head(base.free.forms, turn, self._pivot), self.near))
        if len(base.standing_rows):
            found = self._forms_of(self.rows.select(base.standing).turned(turn))
            if isinstance(found, Obstacle):
                return Obstacle(int(base.standing_rows[found.row]), found.axis)
            forms = AxisEquations(found.normals, found.offsets, base.standing_rows[found.row])
            parts.append(Extremes.of(forms, self.near))
        return CutSet(tuple(parts), slide_limits(self.machine))

    def angles_at(self, turn: float) -> RotaryAngles | Obstacle:
        """Positions of the rotary axes at a turn."""
        return rotary_angles(self.machine, self.rows.turned(about_z(turn)))

    def rows_at(self, turn: float) -> tuple[PathRows, Floats]:
        """Return the rows at a turn that is within reach, and the positions (n, 2) of the rotary axes in them,
        degrees.
        """
        angles = self.angles_at(turn)
        assert not isinstance(angles, Obstacle)
        return self.rows.turned(about_z(turn)), angles.positions

    @property
    def has_like_rotary_room(self) -> bool:
        """Whether no turn changes what is left to the rotary axes: the first, which turns along, has no limits."""
        first = self.machine.axes[self.machine.rotary[0]]
        return self._turning is not Turning.OTHER and np.isinf(first.low) and np.isinf(first.high)

    @cached_property
    def _turning(self) -> Turning:
        return turning_of(self.machine)

    @property
    def _pivot(self) -> Floats:
        return np.array(self.machine.axes[self.machine.rotary[0]].point)

    def _whole_at(self, turn: float) -> CutSet | Obstacle:
        forms = self._forms_of(self.rows.turned(about_z(turn)))
        if isinstance(forms, Obstacle):
            return forms
        return CutSet((Extremes.of(forms, self.near),), slide_limits(self.machine))

    def _forms_of(self, rows: PathRows) -> AxisEquations | Obstacle:
        angles = rotary_angles(self.machine, rows)
        return angles if isinstance(angles, Obstacle) else path_forms(self.machine, rows, angles.positions)

    @cached_property
    def _base(self) -> "_Base | Obstacle":
        """The path as it is: what holds for all turns."""
        angles = rotary_angles(self.machine, self.rows)
        if isinstance(angles, Obstacle):
            return angles
        forms = path_forms(self.machine, self.rows, angles.positions)
        if isinstance(forms, Obstacle):
            return forms
        standing = rows_that_stand(self.rows, angles.held)
        free = _without(forms, self.rows, angles.held)
        if len(free) and self._turning is Turning.HEAD:
            free = outermost(free)
        return _Base(Extremes.of(free, self.near) if len(free) else None, standing, np.flatnonzero(standing))


@dataclass(frozen=True, slots=True, eq=False)
class _Base:
    """What holds for all turns of a path.

    free           extremes of the samples that turn along; None: there are none
    standing       (n,) bool, and their numbers: rows that are looked at for each turn
    """

    free: Extremes | None
    standing: Flags
    standing_rows: Ints


def path_forms(machine: Machine, rows: PathRows, positions: Floats) -> AxisEquations | Obstacle:
    """Return the slides in all rows, and after them in samples between them; ``positions`` (n, 2) degrees."""
    normals, offsets, failed = axis_equations(machine, rows.tip, positions, rows.length)
    if failed >= 0:
        return Obstacle(failed)
    parts, row = [(normals, offsets)], [np.arange(len(rows))]
    for tip, angles, of in (turning_samples(rows, positions), arc_samples(rows, positions, normals)):
        if len(of):
            normals, offsets, failed = axis_equations(machine, tip, angles, rows.length_at(of))
            if failed >= 0:
                return Obstacle(int(of[failed]))
            parts.append((normals, offsets))
            row.append(of)
    if len(parts) == 1:
        return AxisEquations(*parts[0], row[0])
    normals, offsets = (np.concatenate([part[k] for part in parts]) for k in range(2))
    return AxisEquations(normals, offsets, np.concatenate(row))


def _without(forms: AxisEquations, rows: PathRows, held: Flags) -> AxisEquations:
    """Return the samples that neither belong to held rows nor to ways from these."""
    if not held.any():
        return forms
    keep = ~held[forms.row]
    between = np.arange(len(forms)) >= len(rows)
    comes = np.append(False, held[:-1]) & ~rows.begins
    keep &= ~(between & comes[forms.row])
    return AxisEquations(
        np.ascontiguousarray(forms.normals[keep]), np.ascontiguousarray(forms.offsets[keep]), forms.row[keep]
    )


def has_room(limits: TableLimits) -> bool:
    """Whether there is a zero at which the whole outline is on the table.

    The place with the most left to the edges is the solution of a linear program. It is held against the rim, and gets
    one more tangent, until they agree.
    """
    edges = [*limits.straight_edges(), *limits.rim_around()]
    for _ in range(_MOST_ROUNDS):
        table = np.array([(*edge.normal, 1.0) for edge in edges])
        bounds = np.array([edge.bound for edge in edges])
        ranges = [(-FARTHEST, FARTHEST)] * 2 + [(None, None)]
        solved = linear_program(np.array([0.0, 0.0, -1.0]), table, bounds, ranges)
        left, most = limits.left(solved.x), float(solved.x[2])
        if left >= -_ROUNDING:
            return True
        tangent = limits.rim_at(solved.x)
        if most < -_ROUNDING or tangent is None:
            return False
        edges.append(tangent)
    return False
