"""CL statements that the reader does not know: a definition says what becomes of each.

In:     toolpaths, and the tables ``[cl.words]`` and ``[control.statements]`` of a definition.
Out:    toolpaths with the events or the lines of the definition in place of these statements. One that may change the
        machine, and of which the definition says nothing, is an error; any other is left out, with a warning.
"""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from functools import lru_cache
from typing import Final

from trunnion.cl import (
    StatementError,
    can_be_unknown,
    events_of,
    shop_statement,
    statement_words,
    unknown_statement_errors,
    unknown_statement_remarks,
)
from trunnion.controls.definition import Control
from trunnion.controls.loading import control_library
from trunnion.controls.places import EVENT_PLACE
from trunnion.definitions import resolve_extends
from trunnion.errors import InputError, Problem
from trunnion.machines import Machine
from trunnion.messages import Wording
from trunnion.model.toolpath import Event, Insert, Operation, Toolpath, UnknownStatement

#: Statements by their parts: the major word, what is behind it, and the events in their place.
_Entries = Sequence[tuple[str, frozenset[str], tuple[Event, ...]]]

#: More statements than this are counted, not listed.
_MOST_LISTED: Final = 100

#: Statements of texts, which templates may print in another way.
_TEXT_STATEMENTS: Final = ("PPRINT", "DISPLY", "INSERT")


@lru_cache(maxsize=8)
def check_statements(machine: Machine) -> None:
    """Check that what a definition says of CL statements can count.

    Raises ``InputError`` with each entry of ``[control.statements]`` and ``[cl.words]`` whose statement is always read,
    and each of ``[cl.words]`` that is no event, at its place in the definition.
    """
    table = resolve_extends(machine.control.unread_copy(), control_library()).table("statements")
    for name in [name for name in list(table.keys()) if not can_be_unknown(name)]:
        table.add_problem(name, Wording("DEF550", "statement_always_read"))
    templates = resolve_extends(machine.control.unread_copy(), control_library()).table("templates")
    for name in [name for name in list(templates.keys()) if name.startswith(EVENT_PLACE)]:
        word = name.removeprefix(EVENT_PLACE)
        if word not in _TEXT_STATEMENTS and not can_be_unknown(word):
            templates.add_problem(name, Wording("DEF590", "template_never_used", statements=_TEXT_STATEMENTS))
        elif word != word.upper():
            templates.add_problem(name, Wording("DEF590", "template_not_in_capitals", capitals=name.upper()))
    problems = [
        *table.problems,
        *templates.problems,
        *(problem for word in machine.cl_words for problem in _word_problems(machine, word)),
    ]
    if problems:
        raise InputError(problems)


def replace_unknown_statements(
    toolpaths: Iterable[Toolpath], control: Control | None, machine: Machine
) -> list[Toolpath]:
    """Replace the statements that the reader does not know by what a definition makes of them.

    A statement that has a template, and is in neither table, becomes a ``ShopStatement``.

    Raises ``InputError`` with every statement that may change the machine and of which the definition says nothing, or
    if what it says is no event.
    """
    statements, templates = (control.statements, control.templates) if control else ({}, {})
    lines = {statement: (Insert(0, 0, line),) if line else () for statement, line in statements.items()}
    found_words = {word: _events(machine, word, text) for word, text in machine.cl_words.items()}
    entries = [(*statement_words(name), events) for name, events in (*found_words.items(), *lines.items())]
    entries.sort(key=lambda entry: -len(entry[1]))  # the one that says most comes first
    words = frozenset(name.removeprefix(EVENT_PLACE) for name in templates if name.startswith(EVENT_PLACE))
    found = [(toolpath, _replaced(toolpath, entries, words)) for toolpath in toolpaths]
    problems = [problem for _, new in found for problem in unknown_statement_errors(new)]
    if len(problems) > _MOST_LISTED:
        more = Problem(
            problems[0].file, 0, Wording("CL180", "more_unknown_statements", count=len(problems) - _MOST_LISTED)
        )
        problems = [*problems[:_MOST_LISTED], more]
    if problems:
        raise InputError(problems)
    return [_without_unknown(new) for _, new in found]


def _replaced(toolpath: Toolpath, entries: _Entries, words: frozenset[str]) -> Toolpath:
    """Return the toolpath without the statements that ``entries`` or templates have; its remarks are about those left.

    words  those of statements that have templates
    """
    before = frozenset(unknown_statement_remarks(toolpath))
    operations = tuple(_replaced_in_operation(operation, entries, words) for operation in toolpath.operations)
    others = [remark for remark in toolpath.remarks if remark not in before]
    left = unknown_statement_remarks(replace(toolpath, operations=operations))
    remarks = sorted((*others, *left), key=lambda remark: remark.line) if before else toolpath.remarks
    return replace(toolpath, operations=operations, remarks=tuple(remarks))


def _without_unknown(toolpath: Toolpath) -> Toolpath:
    """Return the toolpath without the statements that nothing becomes of; its remarks name them."""
    operations = tuple(
        replace(each, events=tuple(event for event in each.events if not isinstance(event, UnknownStatement)))
        if any(isinstance(event, UnknownStatement) for event in each.events)
        else each
        for each in toolpath.operations
    )
    return replace(toolpath, operations=operations)


def _replaced_in_operation(operation: Operation, entries: _Entries, words: frozenset[str]) -> Operation:
    if not any(isinstance(event, UnknownStatement) for event in operation.events):
        return operation
    events = (new for old in operation.events for new in _replaced_event(old, entries, words))
    return replace(operation, events=tuple(events))


def _replaced_event(event: Event, entries: _Entries, templates: frozenset[str]) -> list[Event]:
    if not isinstance(event, UnknownStatement):
        return [event]
    major, words = statement_words(event.text)
    for entry_major, entry_words, events in entries:
        if entry_major == major and entry_words <= words and entry_words.issuperset(event.words):
            return [replace(new, row=event.row, line=event.line) for new in events]
    return [shop_statement(event)] if major in templates else [event]


def _events(machine: Machine, word: str, text: str) -> tuple[Event, ...]:
    """Return what an entry of ``[cl.words]`` is."""
    try:
        return events_of(text)
    except StatementError as error:
        raise InputError(_word_problem(machine, word, error.wording)) from None


def _word_problems(machine: Machine, word: str) -> list[Problem]:
    """Return what is wrong with an entry of ``[cl.words]``."""
    if not can_be_unknown(word):
        return [_word_problem(machine, word, Wording("DEF550", "statement_always_read"))]
    try:
        _events(machine, word, machine.cl_words[word])
    except InputError as error:
        return [*error.problems]
    return []


def _word_problem(machine: Machine, word: str, wording: Wording) -> Problem:
    """Return a fault in an entry of ``[cl.words]``, at its place."""
    file, line = machine.cl_word_places.get(word, (machine.key, 0))
    return Problem(file, line, wording.of_key(f"cl.words.{word}"))
