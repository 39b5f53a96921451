"""Statements of motion: points, circles, and motion that cannot be read."""

import math

from trunnion.cl.builder import CircleStatement, FromStatement, NoAxis, SplineStatement
from trunnion.cl.diagnostics import StatementError
from trunnion.cl.state import ReaderState
from trunnion.cl.statement import Statement, is_whole, numbers
from trunnion.messages import Wording, phrase
from trunnion.model.toolpath import GoHome
from trunnion.records import dataclass

#: Points no farther from each other, in units of the file, are the same: they are printed with three decimals or more.
_SAME_POINT = 2e-3

#: No helix has more turns; a larger TIMES is a mistake in the file.
MAX_TURNS = 10000

#: Turns of all arcs of a file: in any case, besides for each line, and how many the latter may be.
TURNS_IN_ANY_CASE = 50_000
TURNS_PER_LINE = 50
MOST_TURNS = 2_000_000


@dataclass(slots=True)
class SplineState:
    """The spline that KNOT and CNTRL go on; ``is_refused``: those that follow belong to one that an error has named."""

    spline: SplineStatement | None = None
    is_refused: bool = False


def rapid(state: ReaderState, statement: Statement) -> None:
    """Make the next row a rapid."""
    if statement.values:
        state.note_unknown(statement, phrase("not_known", statement=f"RAPID/{statement.listed()}"), *statement.words())
    state.builder.rapids.append(state.operation_row)


def goto(state: ReaderState, statement: Statement) -> None:
    """Write a row. The scan reads plain GOTO lines by itself; this is for all others."""
    write_row(state, statement.numbers(3, 6))


def godlta(state: ReaderState, statement: Statement) -> None:
    """Write a row relative to the last point."""
    x, y, z = statement.numbers(3)
    start = current_tip(state)
    if start is None:
        raise StatementError(Wording("CL510", "godlta_without_point"))
    refuse_in_circle(state, "GODLTA")
    write_row(state, (start[0] + x, start[1] + y, start[2] + z))
    keep_axis(state)


def gohome(state: ReaderState, statement: Statement) -> None:
    """Write a rapid row; without a point, go to the home of the machine."""
    refuse_in_circle(state, "GOHOME")
    if not statement.values:
        state.add(GoHome(state.operation_row, state.line))
        return
    if not state.has_row:
        state.note_unknown(statement, phrase("not_known", statement=f"GOHOME/{statement.listed()}"), *statement.words())
        return
    state.builder.rapids.append(state.operation_row)
    write_row(state, statement.numbers(3, 6))


def from_(state: ReaderState, statement: Statement) -> None:
    """Note where the path begins."""
    x, y, z, *axis = statement.numbers(3, 6)
    vector = (axis[0], axis[1], axis[2]) if axis else None
    for start in state.builder.starts:
        if start.row == state.operation_row and start.tip != (x, y, z):
            raise StatementError(Wording("CL520", "from_another_point", start_line=start.line))
    row = state.operation_row
    if row and not any(isinstance(event, GoHome) and event.row == row for event in state.builder.events):
        last = state.columns.tip[state.row - 1].tolist()
        if max(abs(a - b) for a, b in zip(last, (x, y, z), strict=True)) > _SAME_POINT:
            raise StatementError(Wording("CL520", "from_another_point_one"))
    state.builder.starts.append(FromStatement(state.operation_row, state.line, (x, y, z), vector))


def circle(state: ReaderState, statement: Statement) -> None:
    """Make the next row an arc."""
    if not state.in_operation:
        raise StatementError(Wording("CL350", "circle_outside_any"))
    values = statement.values
    turns = 1.0
    if "TIMES" in values:
        index = values.index("TIMES")
        (turns,) = numbers("CIRCLE TIMES", values[index + 1 :], 1)
        values = values[:index]
    given = numbers("CIRCLE", values, 7, 8, 11, 12)
    if len(given) in (8, 12):
        turns = given[-1]
    if not is_whole(turns, 1) or turns > MAX_TURNS:
        raise StatementError(Wording("CL570", "circle_turns", turns=turns))
    begin_circle(state, given[:7], int(turns))


def plain_circle(state: ReaderState, statement: Statement) -> None:
    """Make the next row an arc: centre, normal and radius."""
    begin_circle(state, statement.numbers(7), 1)


def circle_with_points(state: ReaderState, statement: Statement) -> None:
    """Make the next row an arc, of which more points may follow."""
    begin_circle(state, statement.numbers(7), 1, may_go_on=True)


def begin_circle(
    state: ReaderState, numbers: tuple[float, ...], turns: int, *, may_go_on: bool = False, angle: float = math.nan
) -> None:
    """Make the next row an arc, or this one if the statement is a motion.

    numbers  xc, yc, zc, i, j, k, r; r is NaN if it is the distance of the start point
    turns    turns that the arc begins
    angle    degrees by which it turns, NaN if the file does not say
    """
    refuse_in_circle(state, "another CIRCLE")
    _count_turns(state, turns)
    if state.cycle_line:
        raise StatementError(Wording("CL620", "circle_within_cycle", cycle_line=state.cycle_line))
    if state.operation_row == 0 and state.builder.continues:
        start = current_tip(state)
        if start is not None and not state.builder.starts:
            state.builder.starts.append(FromStatement(0, state.line, start, None))
    state.builder.circles.append(CircleStatement(state.operation_row, state.line, numbers, turns, may_go_on, angle))


def _count_turns(state: ReaderState, turns: int) -> None:
    """Refuse more turns than any job has: each of them takes time."""
    most = TURNS_IN_ANY_CASE + min(TURNS_PER_LINE * state.line, MOST_TURNS)
    state.turns += turns
    if state.turns > most >= state.turns - turns:
        raise StatementError(Wording("CL575", "arcs_file_have", most=most))


def unsupported(state: ReaderState, statement: Statement) -> None:
    """Refuse a spline of an APT dialect, once for all of its statements."""
    splines = state.own(SplineState)
    if statement.major in ("KNOT", "CNTRL", "MOVNRB") and splines.is_refused:
        return
    splines.is_refused = True
    raise StatementError(Wording("CL250", "motion_cannot", major=statement.major))


def driven(state: ReaderState, statement: Statement) -> None:
    """Refuse motion along geometry, which only APT dialects have."""
    raise StatementError(Wording("CL250", "motion_cannot_read", major=statement.major))


def write_row(state: ReaderState, values: tuple[float, ...]) -> None:
    """Write the row that the scan has reserved; the scan has set its axis to NaN, that is "not given"."""
    if not state.has_row:
        raise StatementError(Wording("CL250", "unreadable_motion").of_key("GOTO"))
    state.columns.tip[state.row] = values[:3]
    if len(values) == 6:
        state.columns.axis[state.row] = values[3:]


def keep_axis(state: ReaderState) -> None:
    """Give the row of a motion that cannot give a tool axis that of the row before it, and never (0, 0, 1)."""
    if state.no_axis is NoAxis.Z and (state.operation_row or state.builder.continues):
        state.columns.axis[state.row] = state.columns.axis[max(state.row - 1, 0)]


def current_tip(state: ReaderState) -> tuple[float, float, float] | None:
    """Return the last point, of the operation before if this one continues it; None before the first."""
    starts = state.builder.starts
    if starts and starts[-1].row == state.operation_row:
        return starts[-1].tip
    if state.row == 0 or (state.operation_row == 0 and not state.builder.continues):
        return None
    x, y, z = state.columns.tip[state.row - 1].tolist()
    return x, y, z


def refuse_in_circle(state: ReaderState, what: str) -> None:
    """Refuse ``what`` in place of the end point of an arc."""
    circles = state.builder.circles
    if circles and circles[-1].row == state.operation_row:
        begun = circles.pop()
        raise StatementError(Wording("CL560", "where_goto_circle", subject=what, begun_line=begun.line))
