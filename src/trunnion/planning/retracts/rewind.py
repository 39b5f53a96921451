"""Rewinds in the cut: retract, turn the rotary axes, and return to where the cut was left.

Three rows are inserted before the row that needs the rewind: a line along the tool axis to the clearance, a rapid in
which only the rotary axes turn while the tip stays, and a line back to the same point under the same tool axis at a
reduced feed. What is cut before and after is what would have been cut without the rewind.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.machines import Machine, slide_positions
from trunnion.model.splines import Splines
from trunnion.model.toolpath import CutterComp, Event, Kind, Message, Moves, Operation, Phase
from trunnion.planning.axis_limits import limits_of, outside_limits
from trunnion.planning.poses.decision_log import ChosenPoses
from trunnion.planning.poses.limit_lookahead import LimitHit, continue_in_branch
from trunnion.planning.poses.placement import REWIND
from trunnion.planning.poses.selection import PlannedPoses
from trunnion.planning.retracts.clearance import MIN_RETRACT, Clearance
from trunnion.planning.rotary_positions import displayed_positions

#: Rows that a rewind adds.
ROWS_PER_REWIND: Final = 3

#: Poses during the turn that are checked against the limits of the slides.
_CHECKED_POSES: Final = 33


@dataclass(frozen=True, slots=True, eq=False)
class Rewind:
    """One rewind.

    row               row of the operation before which it takes place, at the point of the row before
    before            (2,) float64  displayed rotary positions until then, degrees
    after             (2,) float64  and from then on, under the same tool axis
    retract_distance  mm; infinite if the tool axis does not lead to the clearance
    reason            why it is needed, for messages
    limit_hit         what would happen without it
    """

    row: int
    before: Floats
    after: Floats
    retract_distance: float
    reason: str = ""
    limit_hit: LimitHit | None = None

    def turning_point(self, moves: Moves) -> Floats:
        """(3,) float64: where the tip is while the rotary axes turn, mm."""
        distance = self.retract_distance if math.isfinite(self.retract_distance) else MIN_RETRACT
        return np.asarray(moves.tip[self.row - 1] + distance * moves.axis[self.row - 1])


def find_rewinds(chosen: ChosenPoses, poses: PlannedPoses, clearance: Clearance) -> tuple[Rewind, ...]:
    """The rewinds that the chosen poses need, each with the limit that makes it necessary."""
    machine, moves = chosen.machine, chosen.operation.moves
    rewinds = []
    for row in np.flatnonzero(poses.outcome == REWIND).tolist():
        before, after = int(chosen.branch(row - 1)), int(chosen.branch(row))
        hit = chosen.limit_ahead(row, before, poses.rotary[row - 1])
        reason = "the path asks for it" if hit is None else f"otherwise {hit.describe(machine, moves)}"
        rewind = _rewind_at(machine, moves, row, after, poses.rotary, clearance)
        turn = f"{chosen.describe(rewind.before)} to {chosen.describe(rewind.after)}, {reason}"
        rewinds.append(replace(rewind, reason=turn, limit_hit=hit))
    return tuple(rewinds)


def _rewind_at(machine: Machine, moves: Moves, row: int, branch: int, rotary: Floats, clearance: Clearance) -> Rewind:
    """The rewind before a row whose pose is in ``branch``; ``rotary`` (n, 2) displayed, degrees."""
    after = displayed_positions(machine, continue_in_branch(machine, moves, slice(row - 1, row), branch, rotary[row]))
    low, high = machine.limits[list(machine.rotary)].T
    distance = clearance.retract_distance(moves.tip[row - 1], moves.axis[row - 1])
    return Rewind(row, rotary[row - 1], np.clip(after[0], low, high), distance)


def retract_positions(machine: Machine, moves: Moves, rewind: Rewind) -> Floats:
    """(k, 5) float64: positions of all axes during the turn of a rewind, mm and degrees."""
    share = np.linspace(0.0, 1.0, _CHECKED_POSES)[:, None]
    before, after = np.array(rewind.before), np.array(rewind.after)
    for r, column in enumerate(machine.rotary):
        if machine.axes[column].endless:
            after[r] = before[r] + (after[r] - before[r]) - 360.0 * np.rint((after[r] - before[r]) / 360.0)
    rotary = before + share * (after - before)
    tip = np.repeat(rewind.turning_point(moves)[None], _CHECKED_POSES, axis=0)
    return slide_positions(machine, tip, rotary)


def slide_beyond_limits(machine: Machine, joints: Floats) -> int | None:
    """Column of the first slide that joints (k, 5) take beyond its limits; None if there is none."""
    outside = outside_limits(joints, *limits_of(machine, True)).any(axis=0)
    slides = set(np.flatnonzero(outside).tolist()) & set(machine.linear)
    return min(slides, default=None)


def widen_extremes(poses: PlannedPoses, machine: Machine, moves: Moves, rewinds: Sequence[Rewind]) -> None:
    """Take retracts into the extremes of the slides in ``poses``, at the rows where they begin."""
    for rewind in rewinds:
        joints = retract_positions(machine, moves, rewind)
        for column in machine.linear:
            least, most = float(joints[:, column].min()), float(joints[:, column].max())
            if least < poses.extremes[column, 0]:
                poses.extremes[column, 0], poses.extreme_rows[column, 0] = least, rewind.row - 1
            if most > poses.extremes[column, 1]:
                poses.extremes[column, 1], poses.extreme_rows[column, 1] = most, rewind.row - 1


def is_radius_compensated(operation: Operation, row: int) -> bool:
    """Whether cutter radius compensation is on at a row."""
    sides = [e.side for e in operation.events if isinstance(e, CutterComp) and e.row <= row]
    return bool(sides) and sides[-1] != "OFF"


def insert_rewinds(
    operation: Operation, rotary: Floats, rewinds: Sequence[Rewind], reengage_feed_share: float
) -> tuple[Operation, Floats]:
    """The operation and its rotary positions (n, 2), degrees, with the rows of all rewinds."""
    if not rewinds:
        return operation, rotary
    rows = _rows(rewinds)
    poses = np.concatenate([(rewind.before, rewind.after, rewind.after) for rewind in rewinds])
    shifted = [replace(event, row=int(_new_row(rows, event.row))) for event in operation.events]
    messages = [_message(operation, rewind, int(_new_row(rows, rewind.row)) - ROWS_PER_REWIND) for rewind in rewinds]
    return (
        replace(
            operation,
            moves=_with_rows(operation.moves, rewinds, reengage_feed_share),
            arcs=replace(operation.arcs, row=np.asarray(_new_row(rows, operation.arcs.row))),
            splines=Splines.empty(),  # operations with rewinds are simultaneous, and their splines lines
            events=tuple(sorted([*shifted, *messages], key=lambda event: event.row)),
        ),
        np.insert(rotary, np.repeat(rows, ROWS_PER_REWIND), poses, axis=0),
    )


def row_after_rewinds(row: int, rewinds: Sequence[Rewind]) -> int:
    """The index of a row of the operation once the rows of all rewinds are in."""
    return int(_new_row(_rows(rewinds), row))


def _rows(rewinds: Sequence[Rewind]) -> Ints:
    return np.array([rewind.row for rewind in rewinds], np.int64)


def _new_row(rewind_rows: Ints, row: int | Ints) -> Ints:
    return np.asarray(row + ROWS_PER_REWIND * np.searchsorted(rewind_rows, row, side="right"))


def _message(operation: Operation, rewind: Rewind, row: int) -> Event:
    return Message(row, int(operation.moves.line[rewind.row - 1]), f"Rewind: {rewind.reason}")


def _with_rows(moves: Moves, rewinds: Sequence[Rewind], reengage_feed_share: float) -> Moves:
    rows = _rows(rewinds)
    at, source = np.repeat(rows, ROWS_PER_REWIND), rows - 1
    away = np.array([rewind.turning_point(moves) for rewind in rewinds])
    tip = np.stack((away, away, moves.tip[source]), axis=1).reshape(-1, 3)
    feed = moves.feed[rows]
    return Moves(
        np.insert(moves.tip, at, tip, axis=0),
        np.insert(moves.axis, at, np.repeat(moves.axis[source], ROWS_PER_REWIND, axis=0), axis=0),
        np.insert(moves.kind, at, np.tile([Kind.LINEAR, Kind.RAPID, Kind.LINEAR], len(rows))),
        np.insert(moves.phase, at, np.tile([Phase.RETRACT, Phase.TRAVERSE, Phase.ENGAGE], len(rows))),
        np.insert(moves.feed, at, np.stack((feed, feed, reengage_feed_share * feed), axis=1).ravel()),
        np.insert(moves.per_rev, at, np.repeat(moves.per_rev[rows], ROWS_PER_REWIND)),
        np.insert(moves.line, at, np.repeat(moves.line[source], ROWS_PER_REWIND)),
        None if moves.normal is None else np.insert(moves.normal, at, _normals(moves.normal[source]), axis=0),
    )


def _normals(normal: Floats) -> Floats:
    """(3 n, 3): surface normals of the inserted rows; only the third, back at the point, has that of its source."""
    away = np.full_like(normal, np.nan)
    return np.stack((away, away, normal), axis=1).reshape(-1, 3)
