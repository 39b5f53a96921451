"""Statements that the reader does not know: their words, and the problems that they are."""

from trunnion.cl.diagnostics import StatementError
from trunnion.cl.statement import parse
from trunnion.errors import Problem, Severity, merge_repeated
from trunnion.model.toolpath import Toolpath, UnknownStatement

_CURE = "a program is refused unless the control's definition says what becomes of it ([control.statements])"


def statement_words(text: str) -> tuple[str, frozenset[str]]:
    """The major word of a statement, and its values as text; no words if it cannot be read."""
    try:
        statement = parse(text.encode(), "utf-8")
    except StatementError:
        return text, frozenset()
    return statement.major, frozenset(statement.listed().split(",")) - {""}


def unknown_statements(toolpath: Toolpath) -> list[list[UnknownStatement]]:
    """The statements of a toolpath that are not known, those alike together, by their first lines."""
    alike: dict[str, list[UnknownStatement]] = {}
    for operation in toolpath.operations:
        for event in operation.events:
            if isinstance(event, UnknownStatement):
                alike.setdefault(event.what, []).append(event)
    return list(alike.values())


def unknown_statement_problems(toolpath: Toolpath, cure: str = "") -> tuple[Problem, ...]:
    """What is not known in a toolpath, one problem for all statements alike.

    They are errors with the ``cure``, and the remarks of the reader without one.
    """
    severity = Severity.ERROR if cure else Severity.WARNING
    return merge_repeated(
        Problem(toolpath.file, event.line, event.what, cure or _CURE, severity)
        for operation in toolpath.operations
        for event in operation.events
        if isinstance(event, UnknownStatement)
    )
