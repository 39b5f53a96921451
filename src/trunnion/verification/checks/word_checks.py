"""Words of a program that the reader does not know or cannot act upon."""

import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Final

from trunnion.encoding import decode
from trunnion.errors import InputError, Problem, Severity, first_of_kinds
from trunnion.messages import Wording, phrase
from trunnion.model.run import Diagnostic, Run
from trunnion.verification.block_names import block_name, block_name_of
from trunnion.verification.context import MAX_PLACES, ComparedContext, Context, Faults
from trunnion.verification.expected.path import ExpectedPath
from trunnion.verification.results import Check, Place

#: The code of words that belong to the machine.
_OF_MACHINE: Final = "NC225"

_MOST_NAMED: Final = 10

#: What a word is looked for by in templates and texts: its name without values, axes and arguments.
_NAME: Final = re.compile(r"[#A-Z]+ ?[0-9.]*")

#: What a call states for nothing is no word of the program.
_OF_CALL: Final = "NC228"


def check_words(context: Context) -> Check:
    """Every word is known; texts that the CL file inserts (INSERT) may have any.

    With a CL file it is not checked where words change how the machine runs, and nobody asked for them.
    """
    check = _known_words(context)
    if not isinstance(context, ComparedContext):
        return check
    values = tuple(_unasked_words(context))
    return replace(check, missing=(phrase("unasked_values", values=values),)) if values else check


def _unasked_words(context: ComparedContext) -> Iterator[Wording]:
    """Yield words that neither the CL files nor the definition's templates ask for, each where it stands first."""
    run, texts = context.run, "\n".join((*context.settings.texts, *context.expected.insert_texts))
    seen = set[str]()
    for event in run.events:
        value = str(event.value)
        if event.kind != "unasked" or value in seen:
            continue
        seen.add(value)
        name = _NAME.match(value)
        if name is None or re.search(rf"(?<![A-Z0-9_]){re.escape(name[0])}(?![A-Z0-9_])", texts) is None:
            row = min(event.before_row, len(run) - 1)
            same = row >= 0 and run.lines[row] == event.line and run.state.file[row] == event.file
            block = block_name_of(run, row) if same else block_name(-1, event.line)
            yield phrase("unasked_value", value=value, block=block)


def _known_words(context: Context) -> Check:
    diagnostics = [each for each in context.run.diagnostics if each.code != _OF_CALL]
    errors = [diagnostic for diagnostic in diagnostics if diagnostic.severity is Severity.ERROR]
    if isinstance(context, ComparedContext):
        errors = _compared_errors(context.expected, context.run, errors)
    remarks = len(diagnostics) - len(errors)
    others = remarks - sum(each.code == _OF_MACHINE for each in diagnostics)
    good = _known(diagnostics)
    if others:
        good = Wording("words", "with_remarks", known=good, count=others)
    if not errors and remarks:
        return Check("words", True, good, places=tuple(_place(context, each) for each in diagnostics[:MAX_PLACES]))
    faults = Faults(list(_places(context, errors)), len(errors))
    return faults.check("words", good)


def _places(context: Context, errors: Sequence[Diagnostic]) -> Iterator[Place]:
    """Yield the places of errors; of more than a check names those of the first of each kind."""
    problems = [Problem(each.file, each.line, each.wording) for each in errors]
    shown, _ = first_of_kinds(problems, MAX_PLACES)
    yield from (_place(context, Diagnostic(each.line, each.wording, file=each.file)) for each in shown)


def _known(diagnostics: Sequence[Diagnostic]) -> Wording:
    """Return what is known: every word, or all but those of the machine's builder that the definition leaves out."""
    own = [each.text for each in diagnostics if each.code == _OF_MACHINE]
    names = list(dict.fromkeys(text.partition(" ")[0] for text in own))
    if not names:
        return Wording("words", "known")
    if len(names) > _MOST_NAMED:
        return Wording("words", "known_but_more", names=tuple(names[:_MOST_NAMED]), count=len(names) - _MOST_NAMED)
    return Wording("words", "known_but", names=tuple(names))


def _place(context: Context, diagnostic: Diagnostic) -> Place:
    of_subprogram = diagnostic.file in context.run.files[1:]
    nc_file = diagnostic.file if of_subprogram else ""
    return Place(diagnostic.line, -1, 0.0, diagnostic.wording.with_cure(), nc_file=nc_file, code=diagnostic.code)


def _compared_errors(expected: ExpectedPath, run: Run, errors: list[Diagnostic]) -> list[Diagnostic]:
    """Errors that the CL file does not explain, and radius compensation that it never asks for."""
    inserted = expected.insert_texts
    if errors and inserted:
        lines = {file: _lines_of(file, run.encoding) for file in {error.file for error in errors}}
        errors = [error for error in errors if not _is_inserted(error, lines[error.file], inserted)]
    if expected.uses_compensation:
        return errors
    return errors + [each for each in run.diagnostics if each not in errors and each.text.startswith(("G41", "G42"))]


def _lines_of(file: str, encoding: str) -> list[str]:
    try:
        return [decode(line, encoding) for line in Path(file).read_bytes().split(b"\n")]
    except OSError as error:
        raise InputError(Problem(file, 0, Wording("NC111", "cannot_read_again", strerror=error.strerror))) from error


def _is_inserted(diagnostic: Diagnostic, lines: Sequence[str], texts: set[str]) -> bool:
    """Whether the block is a text that the CL file inserts; its block number may precede it."""
    if not 0 < diagnostic.line <= len(lines):
        return False
    line = lines[diagnostic.line - 1].lstrip("/").strip()
    return line in texts or line.partition(" ")[2].strip() in texts
