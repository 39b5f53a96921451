"""Events of a statement by itself, without a file around it: what a definition puts in place of words of a shop."""

from trunnion.cl.builder import MoveColumns, SurfaceSpeed
from trunnion.cl.diagnostics import Diagnostics, StatementError
from trunnion.cl.dialects.clsf import CLSF
from trunnion.cl.state import ReaderState
from trunnion.cl.statement import parse
from trunnion.model.toolpath import CycleOff, CycleOn, Event, UnknownStatement

_CURE = "write a statement that switches something or carries text, such as COOLNT/AIR, or nothing"

#: Events that say what later rows mean, so that they cannot stand for a word alone.
_ABOUT_ROWS = (CycleOn, CycleOff, SurfaceSpeed, UnknownStatement)


def events_of(text: str) -> tuple[Event, ...]:
    """The events of one statement; none for an empty text.

    Raises
    ------
    StatementError
        If it is no known statement, or one about motion, tools' forms, feeds or coordinates.
    """
    if not text.strip():
        return ()
    diagnostics = Diagnostics("")
    state = ReaderState(MoveColumns.allocate(0), diagnostics, CLSF, strict=True, in_operation=True)
    statement = parse(text.encode(), "utf-8")
    handler = CLSF.handlers.get(statement.major)
    if handler is None:
        raise StatementError(f"{text} is not a statement that is known", _CURE)
    handler(state, statement)
    events = state.builder.events
    if diagnostics.has_errors or not events or any(isinstance(event, _ABOUT_ROWS) for event in events):
        raise StatementError(f"{text} is not an event by itself", _CURE)
    return tuple(events)
