"""Rewinds in the cut: off the part, turn, and back to where the cut was left.

Three rows go in before the row that the rewind leads to: a line along the tool axis to the clearance, a rapid in which
only the rotary axes turn and the tip is held, and a line back to the same point under the same tool axis at a reduced
feed. What is cut before and after is what would have been cut without.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.machines import Machine, slide_positions
from trunnion.model.toolpath import CutterComp, Event, Kind, Message, Moves, Operation, Phase
from trunnion.planning.options import PlanOptions
from trunnion.planning.poses.limit_lookahead import LimitHit, continue_in_branch
from trunnion.planning.poses.states import LIMIT_TOLERANCE, limits_of
from trunnion.planning.retracts.clearance import MIN_RETRACT, Clearance

#: Rows that a rewind adds.
ROWS_PER_REWIND = 3

#: Poses on the way of a turn that are checked against the limits of the slides.
_CHECKED_POSES = 33


@dataclass(frozen=True, slots=True, eq=False)
class Rewind:
    """One rewind.

    row     row of the operation before which it takes place, at the point of the row before
    before  (2,) float64   rotary axes until then, degrees as they display them
    after   (2,) float64   and from then on, under the same tool axis
    retract_distance     how far the tool draws back, mm; infinite where its axis does not lead to the clearance
    reason  why, in words
    limit_hit     where it would go wrong without
    """

    row: int
    before: Floats
    after: Floats
    retract_distance: float
    reason: str = ""
    limit_hit: LimitHit | None = None

    def tip(self, moves: Moves) -> Floats:
        """(3,) where the tool turns, mm."""
        way = self.retract_distance if math.isfinite(self.retract_distance) else MIN_RETRACT
        return np.asarray(moves.tip[self.row - 1] + way * moves.axis[self.row - 1])


def plan_rewind(machine: Machine, moves: Moves, row: int, branch: int, rotary: Floats, clearance: Clearance) -> Rewind:
    """The rewind before a row that is reached in ``branch``; ``rotary`` (n, 2) as in ``Motion``."""
    after = continue_in_branch(machine, moves, slice(row - 1, row), branch, rotary[row])[0]
    for r, column in enumerate(machine.rotary):
        axis = machine.axes[column]
        if not np.isnan(axis.display_low):
            after[r] -= 360.0 * np.floor((after[r] - axis.display_low) / 360.0)
        after[r] = min(max(after[r], axis.low), axis.high)
    return Rewind(row, rotary[row - 1], after, clearance.retract_distance(moves.tip[row - 1], moves.axis[row - 1]))


def retract_positions(machine: Machine, moves: Moves, rewind: Rewind) -> Floats:
    """Axis positions on the way of a rewind, (k, 5), mm and degrees."""
    part = np.linspace(0.0, 1.0, _CHECKED_POSES)[:, None]
    before, after = np.array(rewind.before), np.array(rewind.after)
    for r, column in enumerate(machine.rotary):
        if machine.axes[column].endless:
            after[r] = before[r] + (after[r] - before[r]) - 360.0 * np.rint((after[r] - before[r]) / 360.0)
    rotary = before + part * (after - before)
    tip = np.repeat(rewind.tip(moves)[None], _CHECKED_POSES, axis=0)
    return slide_positions(machine, tip, rotary)


def slide_beyond_limits(machine: Machine, joints: Floats) -> int | None:
    """Column of a slide that a rewind takes beyond its limits; None where it has room."""
    low, high = limits_of(machine, True)
    outside = np.any((joints < low - LIMIT_TOLERANCE) | (joints > high + LIMIT_TOLERANCE), axis=0)
    slides = set(np.flatnonzero(outside).tolist()) & set(machine.linear)
    return min(slides, default=None)


def is_radius_compensated(operation: Operation, row: int) -> bool:
    """Whether cutter radius compensation is on at a row."""
    sides = [e.side for e in operation.events if isinstance(e, CutterComp) and e.row <= row]
    return bool(sides) and sides[-1] != "OFF"


def insert_rewinds(
    operation: Operation, rotary: Floats, rewinds: Sequence[Rewind], options: PlanOptions
) -> tuple[Operation, Floats]:
    """The operation and its rotary positions (n, 2), degrees, with all rewinds put in."""
    if not rewinds:
        return operation, rotary
    rows = np.array([rewind.row for rewind in rewinds], np.int64)
    moves = _with_rows(operation.moves, rewinds, rows, options)
    poses = np.concatenate([(rewind.before, rewind.after, rewind.after) for rewind in rewinds])
    shifted = [replace(event, row=int(_shifted_row(rows, event.row))) for event in operation.events]
    notes = [
        _rewind_message(operation, rewind, int(_shifted_row(rows, rewind.row)) - ROWS_PER_REWIND) for rewind in rewinds
    ]
    return (
        replace(
            operation,
            moves=moves,
            arcs=replace(operation.arcs, row=np.asarray(_shifted_row(rows, operation.arcs.row))),
            events=tuple(sorted([*shifted, *notes], key=lambda event: event.row)),
        ),
        np.insert(rotary, np.repeat(rows, ROWS_PER_REWIND), poses, axis=0),
    )


def parts_after_rewinds(parts: Sequence[tuple[int, int]], rewinds: Sequence[Rewind]) -> list[tuple[int, int]]:
    """Rows from, to, of parts of an operation once all rewinds are put in; none is before the first row of a part."""
    rows = np.array([rewind.row for rewind in rewinds], np.int64)
    return [(int(_shifted_row(rows, first)), int(_shifted_row(rows, end))) for first, end in parts]


def _shifted_row(rewound: Ints, row: int | Ints) -> Ints:
    """New index of a row, or of rows."""
    return np.asarray(row + ROWS_PER_REWIND * np.searchsorted(rewound, row, side="right"))


def _rewind_message(operation: Operation, rewind: Rewind, row: int) -> Event:
    return Message(row, int(operation.moves.line[rewind.row - 1]), f"Rewind: {rewind.reason}")


def _with_rows(moves: Moves, rewinds: Sequence[Rewind], rows: Ints, options: PlanOptions) -> Moves:
    at = np.repeat(rows, ROWS_PER_REWIND)
    source = rows - 1
    away = np.array([rewind.tip(moves) for rewind in rewinds])
    tip = np.stack((away, away, moves.tip[source]), axis=1).reshape(-1, 3)
    feed = moves.feed[rows]
    return Moves(
        np.insert(moves.tip, at, tip, axis=0),
        np.insert(moves.axis, at, np.repeat(moves.axis[source], ROWS_PER_REWIND, axis=0), axis=0),
        np.insert(moves.kind, at, np.tile([Kind.LINEAR, Kind.RAPID, Kind.LINEAR], len(rows))),
        np.insert(moves.phase, at, np.tile([Phase.RETRACT, Phase.TRAVERSE, Phase.ENGAGE], len(rows))),
        np.insert(moves.feed, at, np.stack((feed, feed, options.reengage_feed_share * feed), axis=1).ravel()),
        np.insert(moves.per_rev, at, np.repeat(moves.per_rev[rows], ROWS_PER_REWIND)),
        np.insert(moves.line, at, np.repeat(moves.line[source], ROWS_PER_REWIND)),
        None
        if moves.normal is None
        else np.insert(moves.normal, at, _normals_of_rewinds(moves.normal[source]), axis=0),
    )


def _normals_of_rewinds(normal: Floats) -> Floats:
    """(3 n, 3): normals (n, 3) of rows behind which three are put in, of which the third is back there."""
    away = np.full_like(normal, np.nan)
    return np.stack((away, away, normal), axis=1).reshape(-1, 3)
