"""Splines of NX: NURBS, KNOT and CNTRL, a cubic B-spline from the point before it to its last control point.

That it is cubic and begins in the point before it is settled by real files: each spline has two control points more
than knots, and only so its speed is continuous. The knot 0 is not written, the knot 1 once.
"""

from trunnion.cl.builder import SplineStatement
from trunnion.cl.diagnostics import StatementError
from trunnion.cl.state import ReaderState
from trunnion.cl.statement import Statement
from trunnion.cl.statements import motion
from trunnion.messages import Wording


def nurbs(state: ReaderState, statement: Statement) -> None:
    """Begin a spline in the last point."""
    splines = state.own(motion.SplineState)
    splines.spline, splines.is_refused = None, True  # until it is certain that this one can be read
    if not state.in_operation:
        raise StatementError(Wording("CL350", "nurbs_outside_any"))
    if statement.values:
        raise StatementError(Wording("CL600", "nurbs_spline_degree", listed=statement.listed()))
    motion.refuse_in_circle(state, "NURBS")
    if state.cycle_line:
        raise StatementError(Wording("CL620", "nurbs_within_cycle", cycle_line=state.cycle_line))
    if state.operation_row in state.builder.rapids:
        raise StatementError(Wording("CL580", "rapid_before_nurbs"))
    if motion.current_tip(state) is None:
        raise StatementError(Wording("CL510", "nurbs_without_point"))
    splines.spline, splines.is_refused = SplineStatement(state.operation_row, state.line), False
    state.builder.splines.append(splines.spline)


def knot(state: ReaderState, statement: Statement) -> None:
    """Add knots to the spline that has begun."""
    splines = state.own(motion.SplineState)
    if splines.is_refused:
        return
    if splines.spline is None or splines.spline.points:
        raise StatementError(Wording("CL600", "knot_without_nurbs"))
    splines.spline.knots += _numbers(state, statement)


def cntrl(state: ReaderState, statement: Statement) -> None:
    """Add a control point, in a row of its own until the spline is evaluated."""
    splines = state.own(motion.SplineState)
    if splines.is_refused:
        return
    if len(statement.values) == 6:
        _give_up(state)
        raise StatementError(Wording("CL600", "cntrl_tool_axis"))
    values = _numbers(state, statement, 3)
    motion.write_row(state, values)
    spline = splines.spline
    if spline is None or state.operation_row != spline.row + spline.points:
        _give_up(state)
        raise StatementError(Wording("CL600", "cntrl_follows_neither"))
    spline.points += 1


def _numbers(state: ReaderState, statement: Statement, *counts: int) -> tuple[float, ...]:
    """Return the numbers of a statement; without them the spline is given up."""
    try:
        return statement.numbers(*counts)
    except StatementError:
        _give_up(state)
        raise


def _give_up(state: ReaderState) -> None:
    """Report no more of a spline that an error has named."""
    splines = state.own(motion.SplineState)
    splines.is_refused = True
    if splines.spline is not None:
        state.builder.splines.remove(splines.spline)
        splines.spline = None
