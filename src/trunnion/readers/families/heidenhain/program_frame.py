"""BEGIN PGM and END PGM, between which all blocks of a Klartext program stand: no control loads it otherwise."""

import re
from typing import Final

from trunnion.errors import Severity
from trunnion.messages import Wording
from trunnion.readers.control.event_recorder import Note
from trunnion.readers.families.heidenhain.flow import ActiveProgram
from trunnion.readers.families.heidenhain.lexer import split_line
from trunnion.readers.program.source_text import SourceText

_UNITS: Final = ("MM", "INCH")
_LABEL: Final = re.compile(r"[ \t]*(?:/[ \t]*)?(?:[0-9]+[ \t]*)?LBL(?![A-Z])", re.IGNORECASE)
_LABEL_END: Final = re.compile(rf"{_LABEL.pattern}[ \t]+0(?![0-9])", re.IGNORECASE)
_SKIPPED: Final = re.compile(r"[ \t]*(?:[0-9]+[ \t]*)?/")
_PROGRAM_END: Final = re.compile(r"(?<![A-Z])M0*(?:2|30)(?![0-9])", re.IGNORECASE)
_SECOND_END: Final = re.compile(rb"^[^;\n]*?(?<![A-Z])M0*(?:2|30)(?![0-9])", re.IGNORECASE | re.MULTILINE)
_BEGIN: Final = re.compile(r"[ \t]*(?:[0-9]+[ \t]*)?BEGIN[ \t]+PGM(?![A-Z])", re.IGNORECASE)
_END: Final = re.compile(r"[ \t]*(?:[0-9]+[ \t]*)?END[ \t]+(PGM(?![A-Z]).*)", re.IGNORECASE)


def begin(active: ActiveProgram, words: list[str], row: int, note: Note) -> None:
    """Begin a program; ``words`` are those behind BEGIN."""
    if active.name is not None:
        note(Wording("NC160", "second_program_begins_needs_file"), Severity.ERROR)
    elif active.has_blocks or row > active.source.first_row:
        note(Wording("NC160", "begin_pgm_not_first_block"), Severity.ERROR)
    active.name, active.unit = _name(words), _unit(words)


def end(active: ActiveProgram, words: list[str], note: Note) -> None:
    """End a program; ``words`` are those behind END."""
    active.ended = True
    name = _name(words)
    if active.name is None:
        note(Wording("NC160", "program_no_begin_pgm_no"), Severity.ERROR)
    elif active.unit and _unit(words) not in ("", active.unit):
        note(Wording("NC160", "end_pgm_in_other_unit", begun=active.unit, ended=_unit(words)), Severity.ERROR)
    elif name != active.name:
        note(Wording("NC160", "end_pgm_ends_program_began", name=name, active=active.name), Severity.ERROR)


def check_end_of_file(active: ActiveProgram, note: Note) -> None:
    """Report a program whose file has no BEGIN PGM, or ends before END PGM."""
    if active.name is None and not active.ended:
        active.ended = True
        note(Wording("NC160", "program_neither_begin_pgm_nor"), Severity.ERROR)
    elif active.name is not None and not active.ended:
        active.ended = True
        note(Wording("NC160", "program_no_end_pgm_no"), Severity.ERROR)


def check_rest(active: ActiveProgram, source: SourceText, note: Note, last: str) -> None:
    """Look for END PGM behind the block ``last`` of the run; report blocks that no label begins, and any behind it."""
    # An error ends the run too; what follows it would run if that were not there.
    ends = _PROGRAM_END.search(last) is not None and _SKIPPED.match(last) is None
    always = active.name is None or not ends
    reachable, told = always, False
    behind_label = False
    while source.fill():
        raw = source.next_line()
        if not active.ended:
            active.source.pass_label(raw, source.line - 1)
            match = _END.match(split_line(raw).statement)
            if match is not None:
                end(active, match[1].split(), note)
            if active.ended or not split_line(raw).statement:
                continue
            if _LABEL.match(raw):
                # What stands behind LBL 0 belongs to no subprogram.
                reachable, behind_label = always or _LABEL_END.match(raw) is None, True
            elif not reachable and not told:
                told = True
                source.load()
                again = not behind_label and source.search(_SECOND_END, source.line - 1) is not None
                variant = "another_program" if again else "behind_end"
                note(Wording("NC161", variant), Severity.ERROR if again else Severity.WARNING)
        elif active.ended and split_line(raw).statement:
            if _BEGIN.match(split_line(raw).statement):
                note(Wording("NC161", "stands_behind_end_pgm_another"), Severity.ERROR)
            else:
                note(Wording("NC161", "behind_end"), Severity.WARNING)
            return


def _unit(words: list[str]) -> str:
    return words[-1] if words[-1:] and words[-1] in _UNITS else ""


def _name(words: list[str]) -> str:
    """Return the name of a program, in capitals."""
    return " ".join(words[1:-1] if _unit(words) else words[1:]).upper()
