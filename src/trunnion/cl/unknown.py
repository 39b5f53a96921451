"""Statements that the reader does not know: their words, and the problems that they are."""

from collections.abc import Iterator

from trunnion.cl.diagnostics import StatementError
from trunnion.cl.statement import parse
from trunnion.errors import Problem, merge_repeated, warning
from trunnion.messages import Wording
from trunnion.model.toolpath import ShopStatement, Toolpath, UnknownStatement


def statement_words(text: str) -> tuple[str, frozenset[str]]:
    """Return the major word of a statement, and its values as text; no words if it cannot be read."""
    try:
        statement = parse(text.encode(), "utf-8")
    except StatementError:
        return text, frozenset()
    return statement.major, frozenset(statement.listed().split(",")) - {""}


def shop_statement(event: UnknownStatement) -> ShopStatement:
    """Return a statement that is not known, with its values in order, for the template of a shop."""
    try:
        statement = parse(event.text.encode(), "utf-8")
    except StatementError:
        word, _, text = event.text.partition("/")
        return ShopStatement(event.row, event.line, text.strip(), word.strip().upper())
    text = event.text.partition("/")[2].strip()
    numbers = statement.plain_numbers()
    return ShopStatement(event.row, event.line, text, statement.major, tuple(statement.words()), numbers)


def unknown_statements(toolpath: Toolpath) -> list[list[UnknownStatement]]:
    """Return the statements of a toolpath that are not known, those alike together, by their first lines."""
    alike: dict[Wording, list[UnknownStatement]] = {}
    for event in _unknown_events(toolpath):
        alike.setdefault(event.what, []).append(event)
    return list(alike.values())


def unknown_statement_remarks(toolpath: Toolpath) -> tuple[Problem, ...]:
    """Return what is not known in a toolpath, as warnings: one for all statements alike."""
    return merge_repeated(
        warning(toolpath.file, event.line, _said(event, Wording("CL210", "unknown", unknown=event.what)))
        if event.acts
        else warning(toolpath.file, event.line, Wording("CL220", "unknown", unknown=event.what))
        for event in _unknown_events(toolpath)
    )


def unknown_statement_errors(toolpath: Toolpath) -> tuple[Problem, ...]:
    """Why no program is made of a toolpath: statements that are not known and may change the machine."""
    return merge_repeated(
        Problem(toolpath.file, event.line, _said(event, Wording("CL210", "unknown_refused", unknown=event.what)))
        for event in _unknown_events(toolpath)
        if event.acts
    )


def _said(event: UnknownStatement, otherwise: Wording) -> Wording:
    """Return what is said of a statement: without the word that is meant, a program would lack what it does."""
    if "" in event.words:
        return Wording("CL210", "empty_value", unknown=event.what)
    if not event.meant:
        return otherwise
    if len(event.meant) > 1 and not _lacks_slash(event):
        return Wording("CL210", "in_one_line", unknown=event.what, meant=event.meant)
    return Wording("CL210", "damaged", unknown=event.what, meant=event.meant[0])


def _lacks_slash(event: UnknownStatement) -> bool:
    """Whether a cycle begins the statement, of which the other words are values: CYCLE,DRILL,DEPTH,9,DWELL,1."""
    first, comma, _ = event.text.partition(",")
    return bool(comma) and "/" not in event.text and first.strip().upper() == event.meant[0] == "CYCLE"


def _unknown_events(toolpath: Toolpath) -> Iterator[UnknownStatement]:
    for operation in toolpath.operations:
        for event in operation.events:
            if isinstance(event, UnknownStatement):
                yield event
