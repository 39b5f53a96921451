"""Splines of NX: NURBS, KNOT and CNTRL, a cubic B-spline from the point before it to its last control point.

That it is cubic and begins in the point before it is settled by real files: each spline has two control points more
than knots, and only so its speed is continuous. The knot 0 is not written, the knot 1 once.
"""

from typing import Final

from trunnion.cl.builder import SplineStatement
from trunnion.cl.diagnostics import StatementError
from trunnion.cl.state import ReaderState
from trunnion.cl.statement import Statement
from trunnion.cl.statements import motion

_CURE: Final = "output splines as NX does for three axes, or turn spline output off in the CAM system"


def nurbs(state: ReaderState, statement: Statement) -> None:
    """Begin a spline in the last point."""
    splines = state.own(motion.SplineState)
    splines.spline, splines.is_refused = None, True  # until it is certain that this one can be read
    if not state.in_operation:
        raise StatementError("NURBS outside any operation", "write TOOL PATH/name,TOOL,tool before it", code="CL350")
    if statement.values:
        what = f"NURBS/{statement.listed()}: the spline has a degree, weights or a form whose meaning is not known"
        raise StatementError(what, _CURE, code="CL600")
    motion.refuse_in_circle(state, "NURBS")
    if state.cycle_line:
        what = f"NURBS within the cycle of line {state.cycle_line}, where each point is a hole"
        raise StatementError(what, "write CYCLE/OFF before it", code="CL620")
    if state.operation_row in state.builder.rapids:
        raise StatementError("RAPID before a NURBS", "remove the RAPID", code="CL580")
    if motion.current_tip(state) is None:
        raise StatementError("NURBS without a point to begin in", "write FROM/ or GOTO/ before it", code="CL510")
    splines.spline, splines.is_refused = SplineStatement(state.operation_row, state.line), False
    state.builder.splines.append(splines.spline)


def knot(state: ReaderState, statement: Statement) -> None:
    """Add knots to the spline that has begun."""
    splines = state.own(motion.SplineState)
    if splines.is_refused:
        return
    if splines.spline is None or splines.spline.points:
        raise StatementError("KNOT without a NURBS before it", _CURE, code="CL600")
    splines.spline.knots += _numbers(state, statement)


def cntrl(state: ReaderState, statement: Statement) -> None:
    """Add a control point, in a row of its own until the spline is evaluated."""
    splines = state.own(motion.SplineState)
    if splines.is_refused:
        return
    if len(statement.values) == 6:
        _give_up(state)
        raise StatementError("CNTRL with a tool axis: what it means along a spline is not known", _CURE, code="CL600")
    values = _numbers(state, statement, 3)
    motion.write_row(state, values)
    spline = splines.spline
    if spline is None or state.operation_row != spline.row + spline.points:
        _give_up(state)
        raise StatementError("CNTRL that follows neither KNOT nor another CNTRL", _CURE, code="CL600")
    spline.points += 1


def _numbers(state: ReaderState, statement: Statement, *counts: int) -> tuple[float, ...]:
    """The numbers of a statement; without them the spline is given up."""
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
