"""Ways behind blocks that may be skipped: safe with the skip switch on and off.

In:     an operation, and which of its rows are holes.
Out:    the operation with the rows that state place and posture again, and what no rows can make safe.

With the switch on the tool goes from the last row before the skipped ones straight to the first one behind them. Where
it would leave a cut sideways, or come down aslant, rows behind the skipped ones lead it: up along the tool, above all
cuts of the operation; to where the skipped rows end; and from there on, as with the switch off. With the switch off
they change nothing but a rapid above all cuts, from where the skipped rows end and back.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Final, NamedTuple

import numpy as np

from trunnion.arrays import Flags, Floats
from trunnion.errors import Problem
from trunnion.messages import Wording
from trunnion.model.toolpath import BlockSkip, Coolant, CutterComp, Event, Kind, Moves, Operation, Phase, SpindleOn
from trunnion.planning.linearization.row_insertion import insert_rows
from trunnion.records import dataclass

#: Smaller motion is none, mm and as the length of a vector.
_STILL: Final = 1e-3
_SAME_AXIS: Final = 1e-6


class Stretch(NamedTuple):
    """Rows ``first`` to ``end`` (exclusive) that may be skipped, and the lines of their OPSKIP/ON and OPSKIP/OFF."""

    first: int
    end: int
    on: int
    off: int


class _Row(NamedTuple):
    """A row that states a place again: where, mm; the row whose tool axis and other columns it has; its phase."""

    tip: Floats
    source: int
    phase: int


class _UnsafeError(Exception):
    """No rows lead the tool safely."""


class SkipRows(NamedTuple):
    """What rows (n,) bool of an operation are.

    holes      made by a cycle
    from_home  the tool comes to them from home
    """

    holes: Flags
    from_home: Flags


def with_safe_ways(file: str, operation: Operation, rows: SkipRows) -> tuple[Operation, list[Problem]]:
    """Return the operation with rows that state again where the skipped ones lead, and what they cannot make safe.

    The first point behind home is never skipped: the way to it is what the program relies on. Holes have ways of their
    own (``trunnion.planning.holes.skipped_holes``).
    """
    if not any(isinstance(event, BlockSkip) and event.on for event in operation.events):
        return operation, []
    added, problems = dict[Stretch, list[_Row]](), list(_skipped_starts(file, operation))
    for stretch in skipped_stretches(operation):
        path = _Path(operation, rows)
        if rows.from_home[stretch.first]:
            if not path.may_begin_behind(stretch):
                said = Wording("CTL460", "first_point_skipped", operation=operation.name)
                problems.append(Problem(file, stretch.on, said))
                continue
            operation = _begun_behind(operation, stretch)
            stretch = stretch._replace(first=stretch.first + 1)
            path = _Path(operation, rows)
        if not 0 < stretch.first < stretch.end < len(operation.moves):
            continue
        if rows.holes[stretch.end] and (
            rows.from_home[stretch.first : stretch.end].any() or path.turns_to_hole(stretch)
        ):
            line = int(operation.moves.line[stretch.end])
            problems.append(Problem(file, line, Wording("CTL460", "tool_axis_turns")))
            continue
        try:
            new = path.rows_behind(stretch)
            if not new and path.begins_circle(stretch):
                raise _UnsafeError
            if new:
                added[stretch] = new
        except _UnsafeError:
            problems.append(way_skipped(file, operation, stretch))
    return (_with_rows(operation, added) if added else operation), problems


def _skipped_starts(file: str, operation: Operation) -> Iterator[Problem]:
    """Yield spindle and coolant before the first point that an OPSKIP holds: their words are those of the way to it,
    which is never skipped.
    """
    on: BlockSkip | None = None
    for event in operation.events:
        if event.row > 0:
            return
        if isinstance(event, BlockSkip):
            on = event if event.on else None
        elif on is not None and isinstance(event, SpindleOn | Coolant):
            word = "SPINDL" if isinstance(event, SpindleOn) else "COOLNT"
            said = Wording("CTL460", "start_skipped", word=word, on=on.line, operation=operation.name)
            yield Problem(file, event.line, said)


def _begun_behind(operation: Operation, stretch: Stretch) -> Operation:
    """Return the operation with an OPSKIP/ON one row later."""
    moved = [
        replace(event, row=event.row + 1)
        if isinstance(event, BlockSkip) and event.on and event.row == stretch.first
        else event
        for event in operation.events
    ]
    return replace(operation, events=tuple(sorted(moved, key=lambda event: event.row)))


def way_skipped(file: str, operation: Operation, stretch: Stretch) -> Problem:
    """Return the error of a way past skipped blocks that no rows make safe."""
    before, behind = (int(operation.moves.line[row]) for row in (stretch.first - 1, stretch.end))
    return Problem(file, behind, Wording("CTL460", "way_skipped", on=stretch.on, before=before, behind=behind))


def skipped_stretches(operation: Operation) -> list[Stretch]:
    """Return the rows that may be skipped; with nothing between two stretches they are one."""
    found = list[Stretch]()
    began: BlockSkip | None = None
    for event in operation.events:
        if not isinstance(event, BlockSkip):
            continue
        if event.on and began is None:
            began = event
        elif not event.on and began is not None:
            if found and found[-1].end == began.row:
                found[-1] = found[-1]._replace(end=event.row, off=event.line)
            else:
                found.append(Stretch(began.row, event.row, began.line, event.line))
            began = None
    if began is not None:
        found.append(Stretch(began.row, len(operation.moves), began.line, 0))
    return [stretch for stretch in found if stretch.first < stretch.end]


@dataclass(frozen=True, eq=False)
class _Path:
    """The rows of an operation."""

    operation: Operation
    rows: SkipRows

    def may_begin_behind(self, stretch: Stretch) -> bool:
        """Whether the first row of a stretch may be gone to in any case: at rapid, above all cuts, a point behind."""
        operation, row = self.operation, stretch.first
        if stretch.end == len(operation.moves) or self.rows.holes[stretch.end]:
            return False
        within = [event for event in operation.events if event.row == row]
        at = [isinstance(event, BlockSkip) and event.line == stretch.on for event in within].index(True)
        high = self._is_high(row, operation.moves.axis[row])
        return operation.moves.kind[row] == Kind.RAPID and not self.rows.holes[row] and high and at == len(within) - 1

    def turns_to_hole(self, stretch: Stretch) -> bool:
        """Whether a hole is right behind a stretch without holes in which the tool turns to it, and not at home."""
        if self.rows.holes[stretch.first - 1 : stretch.end].any() or self.rows.from_home[stretch.end]:
            return False
        return _turns(self.operation.moves, stretch.first - 1, stretch.end)

    def begins_circle(self, stretch: Stretch) -> bool:
        """Whether a circle begins where a stretch ends, and the tool is elsewhere without the stretch."""
        moves = self.operation.moves
        is_circle = moves.kind[stretch.end] == Kind.ARC
        return bool(is_circle) and not _is_same_place(moves, stretch.first - 1, stretch.end - 1)

    def rows_behind(self, stretch: Stretch) -> list[_Row]:
        """Return the rows that lead the tool behind a stretch. Raises ``_UnsafeError`` where none can."""
        moves, before, last, behind = self.operation.moves, stretch.first - 1, stretch.end - 1, stretch.end
        if self.rows.holes[[before, behind]].any() or _is_same_place(moves, before, last):
            return []
        if self.rows.holes[last]:
            if moves.kind[before] != Kind.RAPID and self._is_unsafe_from_cut(stretch):
                raise _UnsafeError
            return []
        if moves.kind[last] != Kind.RAPID:
            if self._is_unsafe_from_cut(stretch):
                raise _UnsafeError
            return []
        home = self.rows.from_home[stretch.first : stretch.end + 1]
        if home[:-1].any():
            return []  # a turn over home is not skipped
        stays = moves.kind[behind] != Kind.RAPID and _is_same_place(moves, last, behind)
        if stays and self._is_aslant(before, behind):
            raise _UnsafeError
        plunges = not home[-1] and not stays and self._comes_down(last, behind)
        plunges = plunges and not _goes_along_tool(moves, before, behind)
        goes_up = not home[-1] and _goes_up_tool(moves, before, last if plunges else behind)
        leaves = self._leaves_low(stretch) and not goes_up
        if leaves and not self._is_high(last, moves.axis[before]):
            raise _UnsafeError
        rows = [self._raised(before, last)] if leaves else []
        if plunges and not leaves and last > stretch.first and not self._is_high(last, moves.axis[last]):
            rows = [self._raised(last, before)]
        rows += [_Row(moves.tip[last], last, int(moves.phase[last]))] if plunges else []
        if rows and (self._is_compensated(before) or self._is_compensated(behind)):
            raise _UnsafeError  # compensation is neither begun nor ended on the way
        if rows and not self._is_high(before, moves.axis[before]) and not _rises(moves, before, rows[0].tip):
            raise _UnsafeError
        if rows and moves.kind[behind] != Kind.RAPID and _turns(moves, last, behind):
            raise _UnsafeError  # the points of that turn begin at a row that may be skipped
        return rows

    def _is_unsafe_from_cut(self, stretch: Stretch) -> bool:
        """Whether the way past a stretch that ends in a cut or a hole may lead through the part."""
        moves, before, last, behind = self.operation.moves, stretch.first - 1, stretch.end - 1, stretch.end
        from_cut, to_cut = (moves.kind[row] != Kind.RAPID for row in (before, behind))
        if not from_cut and to_cut:  # at a feed; aslant as well where the CL file comes to the skipped cuts so
            return self._plunges(stretch) and self._is_aslant(before, behind)
        if not from_cut:
            return self._leaves_low(stretch)
        retracts = not to_cut and _goes_along_tool(moves, last, behind)
        return (retracts or self._leaves_low(stretch)) and not _goes_up_tool(moves, before, behind)

    def _plunges(self, stretch: Stretch) -> bool:
        """Whether the last cuts of a stretch begin straight down along the tool."""
        moves, rows = self.operation.moves, np.arange(stretch.first, stretch.end)
        begins = rows[(moves.kind[rows - 1] == Kind.RAPID) & (moves.kind[rows] != Kind.RAPID)]
        return bool(len(begins)) and _goes_along_tool(moves, int(begins[-1]) - 1, int(begins[-1]))

    def _is_aslant(self, first: int, row: int) -> bool:
        """Whether the way from one row to another leads down, and not straight along the tool."""
        return self._goes_down(first, row) and not _goes_along_tool(self.operation.moves, first, row)

    def _comes_down(self, first: int, row: int) -> bool:
        """Whether the way from one row to another cuts, or leads down along the tool."""
        moves = self.operation.moves
        cuts_from_rapid = moves.kind[row] != Kind.RAPID and moves.kind[first] == Kind.RAPID
        return bool(cuts_from_rapid) or self._goes_down(first, row)

    def _goes_down(self, first: int, row: int) -> bool:
        """Whether the way from one row to another leads down along the tool of the latter."""
        moves = self.operation.moves
        return float((moves.tip[row] - moves.tip[first]) @ moves.axis[row]) < -_STILL

    def _leaves_low(self, stretch: Stretch) -> bool:
        """Whether the skipped rows lead the tool up from a cut, or from a place below the top of the cuts."""
        moves, before = self.operation.moves, stretch.first - 1
        axis = moves.axis[before]
        if moves.kind[before] == Kind.RAPID and self._is_high(before, axis):
            return False
        heights = (moves.tip[stretch.first : stretch.end] - moves.tip[before]) @ axis
        return float(heights.max()) > _STILL

    def _is_high(self, row: int, along: Floats) -> bool:
        """Whether a row is as high as all cuts, along its own tool axis and along another one (3,)."""
        tip, own = self.operation.moves.tip[row], self.operation.moves.axis[row]
        return all(float(tip @ axis) >= self._highest(axis) - _STILL for axis in (own, along))

    def _highest(self, axis: Floats) -> float:
        """How high the cuts of the operation come along a direction (3,), mm; circles with their radius."""
        operation = self.operation
        cuts = (operation.moves.kind != Kind.RAPID) | self.rows.holes
        heights = operation.moves.tip[cuts] @ axis
        arcs = operation.arcs
        bulge = arcs.centre @ axis + arcs.radius * np.sqrt(np.maximum(1.0 - (arcs.normal @ axis) ** 2, 0.0))
        return float(np.concatenate((heights, bulge, [-np.inf])).max())

    def _raised(self, row: int, other: int) -> _Row:
        """Return the place above a row, along the tool, as high as another one and above all cuts."""
        moves = self.operation.moves
        axis, tip = moves.axis[row], moves.tip[row]
        height = max(self._highest(axis), float(moves.tip[other] @ axis))
        raised = tip + max(height - float(tip @ axis), 0.0) * axis
        is_there = float(np.abs(raised - moves.tip[other]).max()) <= _STILL  # but for the noise of the CL file
        return _Row(moves.tip[other] if is_there else raised, row, int(Phase.RETRACT))

    def _is_compensated(self, row: int) -> bool:
        """Whether radius compensation is on at a row."""
        sides = [event.side for event in self.operation.events if isinstance(event, CutterComp) and event.row <= row]
        return bool(sides) and sides[-1] != "OFF"


def _goes_along_tool(moves: Moves, first: int, row: int) -> bool:
    axis, step = moves.axis[first], moves.tip[row] - moves.tip[first]
    return not _turns(moves, first, row) and float(np.linalg.norm(step - float(step @ axis) * axis)) <= _STILL


def _turns(moves: Moves, first: int, row: int) -> bool:
    return float(np.abs(moves.axis[row] - moves.axis[first]).max()) > _SAME_AXIS


def _rises(moves: Moves, row: int, tip: Floats) -> bool:
    """Whether the way from a row to a place (3,) is straight up along the tool."""
    step, axis = tip - moves.tip[row], moves.axis[row]
    up = float(step @ axis)
    return up >= -_STILL and float(np.linalg.norm(step - up * axis)) <= _STILL


def _goes_up_tool(moves: Moves, first: int, row: int) -> bool:
    """Whether the way from one row to another is straight up along the tool."""
    up = float((moves.tip[row] - moves.tip[first]) @ moves.axis[first])
    return _goes_along_tool(moves, first, row) and up >= -_STILL


def _is_same_place(moves: Moves, first: int, row: int) -> bool:
    step = np.abs(moves.tip[row] - moves.tip[first]).max()
    return bool(step <= _STILL and np.abs(moves.axis[row] - moves.axis[first]).max() <= _SAME_AXIS)


def _with_rows(operation: Operation, added: dict[Stretch, list[_Row]]) -> Operation:
    """Return the operation with rows behind stretches: behind their OPSKIP/OFF, and before all other events there."""
    moves = operation.moves
    copies = np.ones(len(moves), np.int64)
    for stretch, rows in added.items():
        copies[stretch.end] += len(rows)
    source = np.repeat(np.arange(len(moves)), copies)
    result = insert_rows(operation, copies, moves.tip[source], moves.axis[source], moves.kind[source])
    first = np.cumsum(copies) - copies
    source, tip, kind = source.copy(), result.moves.tip.copy(), result.moves.kind.copy()
    phase, line = result.moves.phase.copy(), result.moves.line.copy()
    for stretch, rows in added.items():
        at = slice(int(first[stretch.end]), int(first[stretch.end]) + len(rows))
        source[at] = [row.source for row in rows]
        tip[at], kind[at], phase[at] = [row.tip for row in rows], Kind.RAPID, [row.phase for row in rows]
        line[at] = moves.line[stretch.end - 1]
    changed = replace(
        result.moves, tip=tip, axis=moves.axis[source], kind=kind, phase=phase, feed=moves.feed[source],
        per_rev=moves.per_rev[source], line=line,
    )  # fmt: skip
    shifts = {stretch.off: len(rows) for stretch, rows in added.items()}
    return replace(result, moves=changed, events=tuple(_behind_rows(result.events, shifts)))


def _behind_rows(events: Sequence[Event], shifts: Mapping[int, int]) -> Iterator[Event]:
    """Yield the events; those at the row of an OPSKIP/OFF, and behind it, so many rows farther.

    shifts  by the lines of OPSKIP/OFF
    """
    row, rows = -1, 0
    for event in events:
        if event.row != row:
            rows = 0
        yield replace(event, row=event.row + rows) if rows else event
        if isinstance(event, BlockSkip) and not event.on and event.line in shifts:
            row, rows = event.row, shifts[event.line]
