"""Events of a statement by itself, without a file around it: what a definition puts in place of words of a shop."""

from trunnion.cl.builder import MoveColumns, SurfaceSpeed
from trunnion.cl.diagnostics import Diagnostics, StatementError
from trunnion.cl.dialect import Dialect
from trunnion.cl.dialects import DIALECTS
from trunnion.cl.dialects.clsf import CLSF
from trunnion.cl.state import ReaderState
from trunnion.cl.statement import parse
from trunnion.cl.unknown import statement_words
from trunnion.messages import Wording
from trunnion.model.toolpath import CycleOff, CycleOn, Event, UnknownStatement

#: Events that say what later rows mean, so that they cannot stand for a word alone.
_ABOUT_ROWS = (CycleOn, CycleOff, SurfaceSpeed, UnknownStatement)


def events_of(text: str) -> tuple[Event, ...]:
    """Return the events of one statement; none for an empty text.

    Raises ``StatementError`` if it is no known statement, or one about motion, tools' forms, feeds or coordinates.
    """
    if not text.strip():
        return ()
    diagnostics = Diagnostics("")
    state = ReaderState(MoveColumns.allocate(0), diagnostics, CLSF, strict=True, in_operation=True)
    statement = parse(text.encode(), "utf-8")
    handler = CLSF.handlers.get(statement.major)
    if handler is None:
        raise StatementError(Wording("DEF550", "not_statement_known", text=text))
    if statement.major == "GOTO":
        raise StatementError(Wording("DEF550", "not_event_itself", text=text))
    handler(state, statement)
    events = state.builder.events
    if diagnostics.has_errors or not events or any(isinstance(event, _ABOUT_ROWS) for event in events):
        raise StatementError(Wording("DEF550", "not_event_itself", text=text))
    return tuple(events)


def can_be_unknown(text: str) -> bool:
    """Whether there can be statements that an entry of a definition stands for: some that the reader does not know.

    An entry stands for statements with its words at least, and only if it has the words that are not known.
    """
    major, words = statement_words(text)
    return any(_can_be_unknown(dialect, major, words) for dialect in DIALECTS.values())


def _can_be_unknown(dialect: Dialect, major: str, words: frozenset[str]) -> bool:
    if dialect.text.has_words == major.isdigit():
        return False  # records have numbers for codes, statements have words
    if major not in dialect.handlers:
        return not dialect.is_strict
    listed = ",".join(sorted(words))
    alone = _leaves_unknown(dialect, f"{major}/{listed}" if listed else major, words)
    if alone is not None:
        return alone
    # The words stand behind numbers that a statement of the kind must have, or before them.
    others = ",".join(sorted(words - {"TOOL"}))
    return any(
        _leaves_unknown(dialect, f"{major}/{values}", words)
        for values in (f"1,{listed}", f"{listed},1", f"TOOL,1,{others}")
    )


def _leaves_unknown(dialect: Dialect, text: str, words: frozenset[str]) -> bool | None:
    """Whether reading a statement leaves an unknown one that an entry with these words stands for; None: an error."""
    state = ReaderState(MoveColumns.allocate(0), Diagnostics(""), dialect, strict=False, in_operation=True)
    try:
        statement = parse(text.encode(), "utf-8")
        dialect.handlers[statement.major](state, statement)
        failed = state.diagnostics.has_errors
    except StatementError:
        failed = True
    events = state.builder.events
    found = any(isinstance(event, UnknownStatement) and words.issuperset(event.words) for event in events)
    return None if failed and not found else found
