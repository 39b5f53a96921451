"""Tool axes, clearance planes and coordinate systems of APT dialects."""

from trunnion.cl.builder import NoAxis
from trunnion.cl.diagnostics import StatementError
from trunnion.cl.state import ReaderState
from trunnion.cl.statement import Statement, numbers
from trunnion.cl.statements import events, motion
from trunnion.messages import Wording, phrase

_IDENTITY = (1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0)


def tlaxis(state: ReaderState, statement: Statement) -> None:
    """Set the tool axis of the points that follow without one."""
    i, j, k = statement.numbers(3)
    state.set_axis((i, j, k), NoAxis.MODAL)


def multax(state: ReaderState, statement: Statement) -> None:
    """Say whether points have tool axes. After OFF, a dialect may keep the last one or go back to (0, 0, 1)."""
    if statement.values not in ((), ("ON",), ("OFF",)):
        state.note_unknown(statement, phrase("not_known", statement=f"MULTAX/{statement.listed()}"), *statement.words())
        return
    off = statement.values == ("OFF",)
    state.vectors = state.dialect.vectors or not off
    state.set_axis(None, state.dialect.multax_off if off else NoAxis.MODAL)


def clearance(state: ReaderState, statement: Statement) -> None:
    """Set the clearance plane: CLRSRF/z, CLEARP/XYPLAN,z, or CLEARP/0,0,1,z."""
    values = statement.values[1:] if statement.values[:1] == ("XYPLAN",) else statement.values
    if len(values) == 4 and values[:3] == (0.0, 0.0, 1.0):
        values = values[3:]
    if len(values) != 1 or isinstance(values[0], str):
        raise StatementError(Wording("CL590", "not_plane_constant", major=statement.major, listed=statement.listed()))
    state.clearance = numbers(statement.major, values, 1)[0]


def retrct(state: ReaderState, statement: Statement) -> None:
    """Retract at rapid to the clearance plane; a tool above it stays where it is."""
    if statement.values or not state.has_row:
        raise StatementError(Wording("CL590", "retrct_where_tool", listed=statement.listed()))
    start = motion.current_tip(state)
    if state.clearance is None or start is None:
        raise StatementError(
            Wording("CL590", "retrct_without_clearance" if state.clearance is None else "retrct_before_any")
        )
    motion.refuse_in_circle(state, "RETRCT")
    state.builder.rapids.append(state.operation_row)
    state.builder.upright.append((state.row, state.line, "RETRCT"))
    motion.write_row(state, (start[0], start[1], max(start[2], state.clearance)))
    motion.keep_axis(state)


def cutcom(state: ReaderState, statement: Statement) -> None:
    """Switch radius compensation; in space, the numbers of the points that follow are not tip and axis."""
    if not {"NORMDS", "NORMPS", "ENDPT"}.isdisjoint(statement.words()):
        raise StatementError(Wording("CL470", "cutcom_radius_compensation", listed=statement.listed()))
    events.cutcom(state, statement)


def gohome(state: ReaderState, statement: Statement) -> None:
    """Go home; motion after it is another operation."""
    motion.gohome(state, statement)
    if not statement.values:
        state.split_operation()


def no_shift(state: ReaderState, statement: Statement) -> None:
    """Take a shift of coordinates that shifts nothing, and refuse any other."""
    values = statement.values
    if values in (_IDENTITY, _IDENTITY[:3] + _IDENTITY[4:7]) or (values and set(values) == {0.0} and len(values) <= 3):
        return
    raise StatementError(Wording("CL480", "shifts_turns_points", major=statement.major, listed=statement.listed()))
