"""Where an operation is not made as its CL file has it, because a rotary axis would have to be too fast.

Two things help, and both are asked for by name: near the pole the tool axis leans (``trunnion.planning.pole.pole``),
and the feed is lowered (``trunnion.planning.speed.rotary_speed``). Without being asked, the planner says where an axis
would be too fast, and what helps. Whatever departs from the CL file is written down row by row, so that a proof can
hold a program against it.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.errors import Problem, Severity
from trunnion.machines import Machine, pack
from trunnion.model.motion import Decision, Departures, Pole, Why
from trunnion.model.toolpath import Kind, Operation
from trunnion.planning.options import Wishes
from trunnion.planning.pole.cone import off_pole
from trunnion.planning.pole.pole import Leaning, Place, leaning
from trunnion.planning.poses.selection import Poses
from trunnion.planning.retracts.rewind import Rewind
from trunnion.planning.speed.rotary_speed import Loose, fastest, lowered

#: Places that are named one by one.
_NAMED = 20

#: Angles that are tried for what would do, each twice the one before.
_TRIED = 6


@dataclass(frozen=True, slots=True, eq=False)
class Asked:
    """An operation in the program's coordinate system, and what is asked of it.

    original  the operation as the CL file has it: its arcs are arcs
    """

    machine: Machine
    file: str
    operation: Operation
    original: Operation
    wishes: Wishes
    keep_slides: bool

    @property
    def source(self) -> Ints:
        """(n,) int64: the CL row that each row belongs to; rows that share one are lines for its arc."""
        return source_rows(self.original, self.operation)

    def decision(self, row: int, why: Why, text: str) -> Decision:
        """What was decided at a row."""
        operation = self.operation
        return Decision(self.file, operation.name, int(operation.moves.line[row]), row, why, text)


def source_rows(before: Operation, after: Operation) -> Ints:
    """(n,) int64: the row of ``before`` that each row of ``after``, whose arcs may have become lines, belongs to.

    Lines for an arc carry the arc's line; where several rows of ``before`` have that line, they all count as its last.
    """
    count = len(before.moves)
    if len(after.moves) == count:
        return np.arange(count)
    starts = np.flatnonzero(np.diff(before.moves.line, prepend=before.moves.line[:1] - 1))
    begins = np.flatnonzero(np.diff(after.moves.line, prepend=after.moves.line[:1] - 1))
    rows, lines = np.diff(starts, append=count), np.diff(begins, append=len(after.moves))
    return np.concatenate(
        [
            np.arange(first, first + had) if had == has else np.full(has, first + had - 1)
            for first, had, has in zip(starts.tolist(), rows.tolist(), lines.tolist(), strict=True)
        ]
    )


def near_pole(asked: Asked, poses: Poses) -> tuple[Operation, Poses, Departures, list[Decision], list[Problem]]:
    """The operation and its poses with the pole looked after as the wishes say."""
    wishes, operation = asked.wishes, asked.operation
    if wishes.pole is Pole.OFF:
        return operation, poses, Departures.none(), [], []
    found = _leaning(asked, poses, wishes.pole, wishes.pole_angle)
    log = [_place(asked, place) for place in found.places if place.found][:_NAMED]
    problems = []
    lacking = [place for place in found.places if not place.found]
    if lacking:
        cure = _enough(asked, poses, wishes.pole_angle)
        problems = [_no_way(asked, place, cure) for place in lacking[:_NAMED]]
    rows = found.rows
    departures = replace(
        Departures.none(), lean=wishes.pole_angle, leaned=asked.source[rows], rotary=found.poses.rotary[rows]
    )
    return replace(operation, moves=found.moves), found.poses, departures, log, problems


def _leaning(asked: Asked, poses: Poses, mode: Pole, angle: float) -> Leaning:
    return leaning(asked.machine, asked.operation, poses, asked.keep_slides, mode, angle, _steady(asked))


def _steady(asked: Asked) -> Flags:
    """Rows whose tool axis stays: the ends of arcs, and lines that stand for arcs."""
    source = asked.source
    arc = asked.operation.moves.kind == Kind.ARC
    pieces = np.diff(source, prepend=-1) == 0
    arc |= pieces | np.append(pieces[1:], False)
    return np.asarray(arc | np.append(arc[1:], False))


def _place(asked: Asked, place: Place) -> Decision:
    line = asked.operation.moves.line
    what = {
        Pole.HOLD: "holds its angle",
        Pole.SPREAD: "turns evenly",
        Pole.LEAN: "keeps within its speed",
    }[asked.wishes.pole]
    name = asked.machine.axes[asked.machine.rotary[0]].name
    ways = f"lines {line[place.first]} to {line[place.end - 1]}"
    text = f"axis {name} {what} near the pole, {ways}; the tool axis leans by up to {place.lean:.4f} degrees"
    return asked.decision(place.first, Why.POLE, text)


def _enough(asked: Asked, poses: Poses, angle: float) -> str:
    """What would do where ``angle``, degrees, is too small."""
    for more in angle * 2.0 ** np.arange(1, _TRIED):
        if all(place.found for place in _leaning(asked, poses, Pole.LEAN, float(more)).places):
            return f"--set pole=lean --set pole_angle={more:.4g} would do, or --set lower_feed=yes"
    return "--set lower_feed=yes lowers the feed there"


def _no_way(asked: Asked, place: Place, cure: str) -> Problem:
    line = asked.operation.moves.line
    name = asked.machine.axes[asked.machine.rotary[0]].name
    what = (
        f"no lean of the tool axis by up to {asked.wishes.pole_angle:g} degrees keeps axis {name} within its speed"
        f" up to line {line[place.end - 1]}"
    )
    return Problem(asked.file, int(line[place.first]), what, cure, Severity.WARNING)


def slower(asked: Asked, poses: Poses, rewinds: Sequence[Rewind]) -> tuple[Operation, Departures, list[Decision]]:
    """The operation with the feeds that it is made with; said where they are lowered, or where an axis is too fast.

    ``asked`` has the operation, ``poses`` the positions with which it is made, ``rewinds`` what goes in between.
    """
    operation = asked.operation
    rows = np.array([rewind.row for rewind in rewinds], np.int64)
    loose = Loose(rows, np.array([rewind.after for rewind in rewinds]).reshape(-1, 2))
    if not asked.wishes.lower_feed:
        return operation, Departures.none(), list(_too_fast(asked, poses, loose))
    moves, rows = lowered(asked.machine, operation, poses.rotary, loose, asked.source)
    slow = replace(operation, moves=moves)
    cl, last = np.unique(asked.source[rows], return_index=True)
    departures = replace(Departures.none(), slowed=cl, feed=moves.feed[rows[last]])
    log = list(_lowered(asked, rows, moves.feed))
    return slow, departures, [*log, *_too_fast(replace(asked, operation=slow), poses, loose)]


def _lowered(asked: Asked, rows: Ints, feed: Floats) -> Iterator[Decision]:
    """One decision for each unbroken stretch of rows."""
    stretches: Sequence[Ints] = np.split(rows, np.flatnonzero(np.diff(rows) != 1) + 1) if len(rows) else []
    moves = asked.operation.moves
    for stretch in stretches[:_NAMED]:
        least = stretch[np.argmin(feed[stretch])]
        text = (
            f"feed lowered from {moves.feed[least]:g} to {feed[least]:.2f} and more, lines {moves.line[stretch[0]]} to"
            f" {moves.line[stretch[-1]]}, so that the rotary axes can follow"
        )
        yield asked.decision(int(stretch[0]), Why.FEED, text)
    if len(stretches) > _NAMED:
        text = f"feed lowered in {len(stretches) - _NAMED} further places, the last here"
        yield asked.decision(int(stretches[-1][0]), Why.FEED, text)


def _too_fast(asked: Asked, poses: Poses, loose: Loose) -> Iterator[Decision]:
    """Where a rotary axis would have to be faster than it can, and what helps; looked for if somebody asks."""
    machine, operation, wishes = asked.machine, asked.operation, asked.wishes
    if not (wishes.explain or wishes.lower_feed or wishes.pole is not Pole.OFF):
        return
    worst = fastest(machine, operation, poses.rotary, loose)
    if not worst.count:
        return
    axis = machine.axes[machine.rotary[worst.axis]]
    off = float(off_pole(pack(machine), operation.moves.axis[worst.row : worst.row + 1])[0])
    cure = "--set lower_feed=yes"
    if wishes.pole is Pole.OFF:
        cure = "--set pole=lean, or --set lower_feed=yes, helps"
        if wishes.explain and not wishes.lower_feed:
            cure = _enough(asked, poses, 0.01)
    rows = f"{worst.count} rows are" if worst.count > 1 else "1 row is"
    yield asked.decision(
        worst.row,
        Why.SPEED,
        f"axis {axis.name} would need {100.0 * worst.share:.0f} % of its rapid speed, {axis.rapid:g} degrees/min,"
        f" {off:.3f} degrees off the pole; {rows} too fast, and the control slows down there: {cure}",
    )
