"""BEGIN PGM and END PGM, between which all blocks of a Klartext program stand: no control loads it otherwise."""

import re
from typing import Final

from trunnion.errors import Severity
from trunnion.readers.control.row_recorder import Note
from trunnion.readers.families.heidenhain.flow import ActiveProgram
from trunnion.readers.families.heidenhain.lexer import split_line
from trunnion.readers.program.source_text import SourceText

_UNITS: Final = ("MM", "INCH")
_LABEL: Final = re.compile(r"[ \t]*(?:/[ \t]*)?(?:[0-9]+[ \t]*)?LBL(?![A-Z])", re.IGNORECASE)
_SKIPPED: Final = re.compile(r"[ \t]*(?:[0-9]+[ \t]*)?/")
_PROGRAM_END: Final = re.compile(r"(?<![A-Z])M0*(?:2|30)(?![0-9])", re.IGNORECASE)
_END: Final = re.compile(r"[ \t]*(?:[0-9]+[ \t]*)?END[ \t]+PGM(?![A-Z])", re.IGNORECASE)


def begin(active: ActiveProgram, words: list[str], row: int, note: Note) -> None:
    """Begin a program; ``words`` are those behind BEGIN."""
    if active.name is not None:
        note("a second program begins: it needs a file of its own", Severity.ERROR, "NC160")
    elif active.has_blocks or row > active.source.first_row:
        note("BEGIN PGM is not the first block: no control loads the program", Severity.ERROR, "NC160")
    active.name = _name(words)


def end(active: ActiveProgram, words: list[str], note: Note) -> None:
    """End a program; ``words`` are those behind END."""
    active.ended = True
    name = _name(words)
    if active.name is None:
        note("the program has no BEGIN PGM: no control loads it", Severity.ERROR, "NC160")
    elif name != active.name:
        note(f"END PGM {name} ends the program that began as {active.name}", Severity.ERROR, "NC160")


def check_end_of_file(active: ActiveProgram, note: Note) -> None:
    """Report a program whose file has no BEGIN PGM, or ends before END PGM."""
    if active.name is None and not active.ended:
        active.ended = True
        what = "the program has neither BEGIN PGM nor END PGM: no control loads it"
        note(what, Severity.ERROR, "NC160")
    elif active.name is not None and not active.ended:
        active.ended = True
        note("the program has no END PGM: no control loads it", Severity.ERROR, "NC160")


def check_rest(active: ActiveProgram, source: SourceText, note: Note, end: str) -> None:
    """Look for END PGM behind the block ``end`` of the run; report blocks before it, up to a label, and behind it."""
    # An error ends the run too; what follows it would run if that were not there.
    ends = _PROGRAM_END.search(end) is not None and _SKIPPED.match(end) is None
    reachable = active.name is None or not ends
    while source.fill():
        raw = source.next_line()
        if not active.ended:
            active.source.pass_label(raw, source.line - 1)
            active.ended = _END.match(raw) is not None
            if active.ended and active.name is None:
                note("the program has no BEGIN PGM: no control loads it", Severity.ERROR, "NC160")
            if active.ended or reachable or not split_line(raw).statement:
                continue
            reachable = True
            if not _LABEL.match(raw):
                note("stands behind the end of the program: it never runs", Severity.ERROR, "NC161")
        elif active.ended and split_line(raw).statement:
            note("stands behind END PGM: another program needs a file of its own", Severity.ERROR, "NC161")
            return


def _name(words: list[str]) -> str:
    """Return the name of a program, in capitals."""
    return " ".join(words[1:-1] if words[-1:] and words[-1] in _UNITS else words[1:]).upper()
