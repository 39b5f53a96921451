"""Records of Mastercam's NCI that move the tool: lines, arcs, five-axis lines; and dwells.

The scan reads plain lines by itself (``trunnion.cl.pair_scan``); these are for those that change something.
"""

from typing import Final

from trunnion.cl.diagnostics import StatementError
from trunnion.cl.pair_scan import FIVE_AXIS_VALUES, LINE_VALUES, SECOND_POINT_TOLERANCE
from trunnion.cl.state import ReaderState
from trunnion.cl.statement import Statement
from trunnion.cl.statements import events, motion
from trunnion.cl.statements.cutcom_points import CutcomPoints
from trunnion.cl.statements.nci_records import Contour, ToolNow, ToolPlane, begin_motion, record, values_of
from trunnion.messages import Wording
from trunnion.model.toolpath import CycleOff

_UNCHANGED: Final = -1.0
_RAPID: Final = -2.0

#: Compensation words; 0 leaves it as it is.
_SIDES: Final = {0.0: "", 40.0: "OFF", 41.0: "LEFT", 42.0: "RIGHT", 140.0: "OFF"}

#: Flags of records: within a contour, at its beginning, at its end.
_FLAGS: Final = (0.0, 1000.0, 100.0)

#: Places in the contour: the first and the last record of it, and the flag that goes with them.
_FLAG_AT: Final = {12: 1000.0, 32: 100.0}

#: What has been seen to follow upon a place; 0 stands for the beginning of an operation.
_FOLLOWS: Final = {
    0: (42, 12), 42: (42, 12), 12: (22, 32), 22: (22, 32), 32: (52,), 52: (52, 42),
}  # fmt: skip

#: How far two points may be from each other to be one, in units of the file.
_SAME_POINT: Final = 1e-6

#: Planes of arcs: which coordinates the first and the second number of a point are, and which one is across.
_PLANES: Final = {0.0: (0, 1, 2), 1.0: (1, 2, 0), 2.0: (0, 2, 1)}


def line(state: ReaderState, statement: Statement) -> None:
    """Move along a line, the tool upright: record 1 with a feed, record 0 at rapid."""
    contour = _begin_path(state)
    side, x, y, z, feed, flag = values_of(state, statement, LINE_VALUES)
    if statement.major == "0" and feed != _RAPID:
        raise StatementError(Wording("CL710", "rapid_with_feed", record=record(state, statement), feed=feed))
    if statement.major == "1" and feed == _RAPID:
        raise StatementError(Wording("CL710", "line_at_rapid", record=record(state, statement), feed=feed))
    check_flag(state, statement, flag)
    _compensate(state, statement, side)
    _take_feed(state, statement, contour, feed)
    motion.write_row(state, (x, y, z))


def five_axis(state: ReaderState, statement: Statement) -> None:
    """Move along a line to a tip with a tool axis: the vector from the tip to the second point."""
    contour = _begin_path(state)
    values = values_of(state, statement, FIVE_AXIS_VALUES)
    tip, second, (feed, place, flag), vector = values[:3], values[3:6], values[6:9], values[9:]
    off = max(abs(t + v - s) for t, v, s in zip(tip, vector, second, strict=True))
    if not off <= SECOND_POINT_TOLERANCE:
        raise StatementError(Wording("CL540", "second_point", record=record(state, statement), off=off))
    check_flag(state, statement, flag)
    _note_place(state, statement, contour, place, flag)
    _take_feed(state, statement, contour, feed)
    motion.write_row(state, (*tip, *vector))


def arc(state: ReaderState, statement: Statement) -> None:
    """Move along an arc or a helix: record 2 clockwise, record 3 counter-clockwise about the axis across its plane.

    Descriptions have compensation word and plane in either order; but for 0 their values differ.
    """
    contour = _begin_path(state)
    first, second, *numbers, height, feed, flag, full = values_of(state, statement, 10)
    if first in _SIDES and second in _PLANES:
        side, plane = first, second
    elif first in _PLANES and second in _SIDES:
        side, plane = second, first
    else:
        raise StatementError(Wording("CL250", "arc_plane", record=record(state, statement), first=first, second=second))
    start = None if state.own(ToolPlane).row == state.row else motion.current_tip(state)
    if start is None:
        raise StatementError(Wording("CL250", "arc_without_start", record=record(state, statement)))
    one, other, across = _PLANES[plane]
    end, centre, normal = [0.0] * 3, [0.0] * 3, [0.0] * 3
    end[one], end[other], centre[one], centre[other] = numbers
    end[across], centre[across] = height, start[across]
    normal[across] = -1.0 if statement.major == "2" else 1.0
    is_closed = max(abs(start[one] - end[one]), abs(start[other] - end[other])) <= _SAME_POINT
    if full not in (0.0, 1.0) or is_closed is not (full == 1.0):
        raise StatementError(Wording("CL250", "arc_full", record=record(state, statement), full=full))
    if feed == _RAPID:
        raise StatementError(Wording("CL710", "line_at_rapid", record=record(state, statement), feed=feed))
    check_flag(state, statement, flag)
    _compensate(state, statement, side)
    _take_feed(state, statement, contour, feed)
    motion.begin_circle(state, (*centre, *normal, float("nan")), 1)
    motion.write_row(state, tuple(end))


def _begin_path(state: ReaderState) -> Contour:
    """Return where the motion is; a motion that is no hole ends a cycle."""
    contour = begin_motion(state)
    if state.cycle_line:
        state.add(CycleOff(state.operation_row, state.line))
        state.cycle_line = 0
    return contour


def dwell(state: ReaderState, statement: Statement) -> None:
    """Wait for seconds; the speed of the spindle behind them must be the one that it has."""
    begin_motion(state)
    seconds, *speed = values_of(state, statement, 1, 2)
    now = getattr(state.spindle, "rpm", 0.0)
    if speed and speed[0] not in (0.0, now, -now):
        raise StatementError(Wording("CL320", "dwell_speed", record=record(state, statement), speed=speed[0], now=now))
    events.delay(state, statement._replace(major="DELAY", values=(seconds,)))


def compensation_off(state: ReaderState, statement: Statement) -> None:
    """Switch the compensation of the radius off."""
    _compensate(state, statement, 40.0)


def check_flag(state: ReaderState, statement: Statement, flag: float) -> None:
    """Refuse a flag of a motion that is not known."""
    if flag not in _FLAGS:
        raise StatementError(Wording("CL165", "unknown_value", record=record(state, statement), value=flag,
                                     known=("0", "100", "1000")))  # fmt: skip


def _compensate(state: ReaderState, statement: Statement, side: float) -> None:
    """Switch compensation by the word of a record; what its points are must be stated."""
    if side not in _SIDES:
        known = tuple(f"{word:g}" for word in _SIDES)
        raise StatementError(
            Wording("CL165", "unknown_value", record=record(state, statement), value=side, known=known)
        )
    word, now = _SIDES[side], state.own(ToolNow)
    if not word or word == now.side:
        return
    if word != "OFF" and state.own(CutcomPoints).asked is None:
        raise StatementError(Wording("CL470", "points_of_compensation", record=record(state, statement)))
    values = (word, float(now.register)) if now.register and word != "OFF" else (word,)
    events.cutcom(state, statement._replace(major="CUTCOM", values=values))
    now.side, now.is_used = word, now.is_used or word != "OFF"


def _take_feed(state: ReaderState, statement: Statement, contour: Contour, feed: float) -> None:
    """Take the feed of a record: a value, that of the cut before it, or rapid."""
    if feed == _RAPID:
        state.builder.rapids.append(state.operation_row)
        contour.cuts = False
        return
    if feed == _UNCHANGED:
        if not contour.cuts:
            raise StatementError(Wording("CL710", "unchanged_behind_rapid", record=record(state, statement)))
        return
    if not feed > 0.0:
        raise StatementError(Wording("CL710", "no_feed", record=record(state, statement), feed=feed))
    if feed != contour.feed:
        events.fedrat(state, statement._replace(major="FEDRAT", values=(feed, "PERMIN")))
    contour.feed, contour.cuts = feed, True


def _note_place(state: ReaderState, statement: Statement, contour: Contour, place: float, flag: float) -> None:
    """Check the position word of a record against the one before, and its flag against both."""
    if place not in _FOLLOWS or not place:
        known = tuple(str(word) for word in _FOLLOWS if word)
        raise StatementError(
            Wording("CL165", "unknown_value", record=record(state, statement), value=place, known=known)
        )
    word = int(place)
    if word not in _FOLLOWS[contour.place]:
        before = contour.place
        state.diagnostics.remark(state.line, Wording("CL225", "place", record=record(state, statement), place=word,
                                                     before=before))  # fmt: skip
    if flag != _FLAG_AT.get(word, 0.0):
        state.diagnostics.remark(state.line, Wording("CL225", "flag", record=record(state, statement), place=word,
                                                     flag=flag))  # fmt: skip
    contour.place = word
