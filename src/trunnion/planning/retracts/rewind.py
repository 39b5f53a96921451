"""Rewinds in the cut: retract, turn the rotary axes, and return to where the cut was left.

Rows are inserted before the row that needs the rewind: along the tool axis to the clearance, a rapid in which only the
rotary axes turn while the tip stays, and back to the same point under the same tool axis. The first mm from the cut and
the last mm to it are lines, these at a reduced feed. What is beyond them is rapids with TCP, under which rapids are
straight, and lines without. What is cut before and after is what would have been cut without the rewind.
"""

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Final, NamedTuple

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.machines import Machine, slide_positions
from trunnion.messages import Wording, foreign, phrase
from trunnion.model.splines import Splines
from trunnion.model.toolpath import CutterComp, Event, Kind, Moves, Operation, Phase, RewindMessage
from trunnion.planning.axis_limits import limits_of, outside_limits
from trunnion.planning.poses.decision_log import ChosenPoses
from trunnion.planning.poses.limit_lookahead import LimitHit, continue_in_branch
from trunnion.planning.poses.placement import REWIND
from trunnion.planning.poses.selection import PlannedPoses
from trunnion.planning.retracts.clearance import MIN_RETRACT, Clearance
from trunnion.planning.rotary_positions import displayed_positions, is_endless
from trunnion.records import dataclass

#: So near to the cut the tool moves at a feed in any case, mm; a shorter retract than twice that has no rapid.
_NEAR_CUT: Final = 2.0

#: Poses during the turn that are checked against the limits of the slides.
_CHECKED_POSES: Final = 33


class _Row(NamedTuple):
    """A row that a rewind adds.

    distance  from the cut at its end, mm
    share     of the feed of the cut
    turned    the rotary axes have turned at its end
    """

    distance: float
    kind: Kind
    phase: Phase
    share: float
    turned: bool


#: Of a rewind of which nobody has said why.
_NO_REASON: Final = foreign("")


@dataclass(frozen=True, slots=True, eq=False)
class Rewind:
    """One rewind.

    row               row of the operation before which it takes place, at the point of the row before
    before            (2,) float64  displayed rotary positions until then, degrees
    after             (2,) float64  and from then on, under the same tool axis
    retract_distance  mm; infinite if the tool axis does not lead to the clearance
    at_rapid          whether the tool moves at rapid away from the cut
    reason            why it is needed, for messages
    limit_hit         what would happen without it
    """

    row: int
    before: Floats
    after: Floats
    retract_distance: float
    at_rapid: bool
    reason: Wording = _NO_REASON
    limit_hit: LimitHit | None = None

    @property
    def distance(self) -> float:
        """How far the tool retracts, mm; finite."""
        return self.retract_distance if math.isfinite(self.retract_distance) else MIN_RETRACT

    def turning_point(self, moves: Moves) -> Floats:
        """(3,) float64: where the tip is while the rotary axes turn, mm."""
        return np.asarray(moves.tip[self.row - 1] + self.distance * moves.axis[self.row - 1])

    def rows(self, reengage_feed_share: float) -> list[_Row]:
        """Return the rows that are added."""
        far, near = self.distance, _NEAR_CUT
        turn = _Row(far, Kind.RAPID, Phase.TRAVERSE, 1.0, turned=True)
        back = _Row(0.0, Kind.LINEAR, Phase.ENGAGE, reengage_feed_share, turned=True)
        if not self.at_rapid or far < 2.0 * near:
            return [_Row(far, Kind.LINEAR, Phase.RETRACT, 1.0, turned=False), turn, back]
        return [
            _Row(near, Kind.LINEAR, Phase.RETRACT, 1.0, turned=False),
            _Row(far, Kind.RAPID, Phase.RETRACT, 1.0, turned=False),
            turn,
            _Row(near, Kind.RAPID, Phase.TRAVERSE, 1.0, turned=True),
            back,
        ]

    def seconds(self, machine: Machine, feed: float, reengage_feed_share: float) -> float:
        """How long it takes at a feed in mm/min, without acceleration; rapids count where the machine states theirs."""
        slides = [axis.rapid for axis in machine.own_axes if not axis.is_rotary and axis.rapid]
        minutes = at = 0.0
        for row in self.rows(reengage_feed_share):
            speed = row.share * feed if row.kind is Kind.LINEAR else min(slides, default=math.inf)
            minutes += abs(row.distance - at) / speed if speed > 0.0 else 0.0
            at = row.distance
        rapids = [machine.axes[column].rapid or math.inf for column in machine.rotary]
        turning = float(np.max(np.abs(self.turns(machine)) / rapids))
        return 60.0 * (minutes + turning)

    def turns(self, machine: Machine) -> Floats:
        """How far the rotary axes turn, degrees, (2,): endless ones by the shorter way."""
        turns = self.after - self.before
        return np.where(is_endless(machine), turns - 360.0 * np.rint(turns / 360.0), turns)


def find_rewinds(
    chosen: ChosenPoses, poses: PlannedPoses, clearance: Clearance, *, at_rapid: bool
) -> tuple[Rewind, ...]:
    """Return the rewinds that the chosen poses need, each with the limit that makes it necessary.

    ``at_rapid``: rapids are straight, so that the tool may move at rapid away from the cut.
    """
    machine, moves = chosen.machine, chosen.operation.moves
    rewinds = []
    for row in np.flatnonzero(poses.outcome == REWIND).tolist():
        before, after = int(chosen.branch(row - 1)), int(chosen.branch(row))
        hit = chosen.limit_ahead(row, before, poses.rotary[row - 1])
        reason = phrase("path_asks") if hit is None else phrase("otherwise", limit=hit.said(machine, moves))
        rewind = replace(_rewind_at(machine, moves, row, after, poses.rotary, clearance), at_rapid=at_rapid)
        turn = {"before": chosen.describe(rewind.before), "after": chosen.describe(rewind.after)}
        rewinds.append(replace(rewind, reason=phrase("turn_and_reason", reason=reason, **turn), limit_hit=hit))
    return tuple(rewinds)


def _rewind_at(machine: Machine, moves: Moves, row: int, branch: int, rotary: Floats, clearance: Clearance) -> Rewind:
    """Return the rewind before a row whose pose is in ``branch``; ``rotary`` (n, 2) displayed, degrees."""
    after = displayed_positions(machine, continue_in_branch(machine, moves, slice(row - 1, row), branch, rotary[row]))
    low, high = machine.limits[list(machine.rotary)].T
    distance = clearance.retract_distance(moves.tip[row - 1], moves.axis[row - 1])
    return Rewind(row, rotary[row - 1], np.clip(after[0], low, high), distance, at_rapid=False)


def retract_positions(machine: Machine, moves: Moves, rewind: Rewind) -> Floats:
    """(k, 5) float64: positions of all axes during the turn of a rewind, mm and degrees."""
    share = np.linspace(0.0, 1.0, _CHECKED_POSES)[:, None]
    rotary = rewind.before + share * rewind.turns(machine)
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
    """Return the operation and its rotary positions (n, 2), degrees, with the rows of all rewinds."""
    if not rewinds:
        return operation, rotary
    added = [rewind.rows(reengage_feed_share) for rewind in rewinds]
    counts = np.array([len(rows) for rows in added])
    poses = np.array(
        [r.after if row.turned else r.before for r, rows in zip(rewinds, added, strict=True) for row in rows]
    )
    shifted = [replace(event, row=int(_new_row(rewinds, event.row))) for event in operation.events]
    firsts = [int(_new_row(rewinds, rewind.row)) - int(count) for rewind, count in zip(rewinds, counts, strict=True)]
    messages = [_message(operation, rewind, first) for rewind, first in zip(rewinds, firsts, strict=True)]
    return (
        replace(
            operation,
            moves=_with_rows(operation.moves, rewinds, added),
            arcs=replace(operation.arcs, row=np.asarray(_new_row(rewinds, operation.arcs.row))),
            splines=Splines.empty(),  # operations with rewinds are simultaneous, and their splines lines
            events=tuple(sorted([*shifted, *messages], key=lambda event: event.row)),
        ),
        np.insert(rotary, np.repeat(_rows(rewinds), counts), poses, axis=0),
    )


def row_after_rewinds(row: int, rewinds: Sequence[Rewind]) -> int:
    """Return the index of a row of the operation once the rows of all rewinds are in."""
    return int(_new_row(rewinds, row))


def rows_with_rewinds(rows: Ints, rewinds: Sequence[Rewind]) -> Ints:
    """Return a column of row numbers, (n,), with -1 at the rows of all rewinds."""
    return np.asarray(np.insert(rows, np.repeat(_rows(rewinds), [len(one.rows(1.0)) for one in rewinds]), -1))


def _rows(rewinds: Sequence[Rewind]) -> Ints:
    return np.array([rewind.row for rewind in rewinds], np.int64)


def _new_row(rewinds: Sequence[Rewind], row: int | Ints) -> Ints:
    before = np.cumsum([0, *(len(rewind.rows(1.0)) for rewind in rewinds)])
    return np.asarray(row + before[np.searchsorted(_rows(rewinds), row, side="right")])


def _message(operation: Operation, rewind: Rewind, row: int) -> Event:
    return RewindMessage(row, int(operation.moves.line[rewind.row - 1]), f"Rewind: {rewind.reason}")


def _with_rows(moves: Moves, rewinds: Sequence[Rewind], added: Sequence[Sequence[_Row]]) -> Moves:
    rows = [row for each in added for row in each]
    at = np.repeat(_rows(rewinds), [len(each) for each in added])
    source = at - 1
    away = np.array([row.distance for row in rows])[:, None]
    share = np.array([row.share for row in rows])
    return Moves(
        np.insert(moves.tip, at, moves.tip[source] + away * moves.axis[source], axis=0),
        np.insert(moves.axis, at, moves.axis[source], axis=0),
        np.insert(moves.kind, at, [row.kind for row in rows]),
        np.insert(moves.phase, at, [row.phase for row in rows]),
        np.insert(moves.feed, at, share * moves.feed[at]),
        np.insert(moves.per_rev, at, moves.per_rev[at]),
        np.insert(moves.line, at, moves.line[source]),
        None if moves.normal is None else np.insert(moves.normal, at, _normals(moves.normal[source], away), axis=0),
    )


def _normals(normal: Floats, away: Floats) -> Floats:
    """(n, 3): surface normals of the inserted rows; only those back at the point have that of their source."""
    return np.where(away > 0.0, np.nan, normal)
