"""What a file is by marks of its content: programs of controls and machines, listings and texts.

A guess for messages, where a program is not understood; nothing is read otherwise because of it.
"""

import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Final

from trunnion.errors import Problem
from trunnion.families import FAMILIES
from trunnion.machines import Machine
from trunnion.messages import Wording, phrase
from trunnion.model.run import Diagnostic, Run
from trunnion.readers.program.settings import family_of
from trunnion.records import dataclass

#: So much of a file is looked at, bytes, and so many letters of each line.
_HEAD: Final = 200_000
_MOST_LETTERS: Final = 300

#: A file is of a kind with so many different marks of it, or lines with one of them.
_ENOUGH: Final = 2

#: Fewer lines that are not understood say nothing of the program.
_FEW_ERRORS: Final = 5

#: Share of the lines that a text has without a single word of a program.
_MOSTLY: Final = 0.5


@dataclass(frozen=True, slots=True)
class ProgramKind:
    """A kind of files, and the marks of one, patterns in capitals or not: the letters of a line that match are shown.

    languages  in which readers read it; empty: none does
    """

    name: Wording
    marks: tuple[str, ...]
    languages: tuple[str, ...] = ()

    @property
    def patterns(self) -> list[re.Pattern[str]]:
        """The marks, compiled when a file is looked at: most programs are understood."""
        return [re.compile(mark, re.IGNORECASE) for mark in self.marks]

    @property
    def readers(self) -> tuple[str, ...]:
        """Folders of the readers of its languages."""
        return tuple(map(str.lower, self.languages))


@dataclass(frozen=True, slots=True)
class Recognized:
    """What a file is, and by what: the first line with each mark, and its letters."""

    kind: ProgramKind
    found: tuple[tuple[int, str], ...]


def _kind(name: Wording, *marks: str, languages: tuple[str, ...] = ()) -> ProgramKind:
    return ProgramKind(name, marks, languages)


_N: Final = r"^/? ?(?:N\d+ ?)?"

#: The kinds, the most telling marks first; where two have as many, the first one counts.
KINDS: Final = (
    _kind(
        phrase("program_is_listing"),
        r"^[^(;\w]{0,5}[=_*]{20,}", r"\b(?:ISN|CLREC|CLDATA|CL REC)\b", r"\bPAGE +\d+",
        r"^ {0,9}\d+ +\d+ +N\d+ ?G\d",
    ),
    _kind(
        phrase("program_of_heidenhain"),
        r"^\d* ?(?:BEGIN|END) PGM ", r"^\d+ +TOOL CALL ", r"^\d+ +CYCL (?:DEF|CALL)", r"^\d+ +L +[XYZABC][+-]",
        r"^\d+ +(?:CC|LBL|FN \d+:|PLANE|FUNCTION|STOP M)\b", languages=("Heidenhain",),
    ),
    _kind(
        phrase("program_of_fagor"),
        r"^%[^,]{1,30},M?X?M?,", r"#(?:TEE|RTCP|CS ON|MCS|HSC|MPOLY|ACS|TOOL AX|TLC)\b",
        r"\((?:IF|CALL|PCALL|RPT|MSG)\b[^)]*P?\d",
        r"\(P\d+ ?= ?",
    ),
    _kind(
        phrase("program_of_wire_eroding"),
        r"^H\d{3} ?=", r"\bT8[46]\b", r"^ ?C\d{3}\b", r"\bG5[12] ?A-?[\d.]", r"\b[UV]-?[\d.]+ ?[UV]-?[\d.]+",
    ),
    _kind(
        phrase("program_of_lathe"),
        _N + r"G50 ?S\d", _N + r"G96 ?S\d", r"G7[0-3] ?P\d+ ?Q\d", r"G7[0-6] ?[UXZ]-?[\d.]+ ?[RWZ]", r"\bT0\d0\d\b",
        r"G28 ?U0?\.? ?W0", r"\b[UX]-?[\d.]+ ?W-?[\d.]", r"\bLIMS(?:\[\d\])? ?=", r"\bDIAM(?:ON|OF|90)\b",
        r"\bCYCLE9[3-8] ?\(",
    ),
    _kind(
        phrase("program_of_okuma"),
        r"^\$[\w-]+\.(?:MIN|SUB|SSB|LIB)%", r"\bG15 ?H\d", r"\bG56 ?H\d", r"\bCALL O\w", r"\bV[CSO]\d+ ?=",
        r"\bG116 ?T",
    ),
    _kind(
        phrase("program_of_fadal"),
        r"^N?\d* ?#(?:CLEAR|PRINT|IF|GOTO|R\d|[A-Z]\d* ?=)", r"\bE\d+ [XY]", _N + r"L\d{3,4}\b", r"\bE0\b.*\bH0\b",
        _N + r"M4[59]\b",
    ),
    _kind(
        phrase("program_of_acramatic"),
        r"\(PGM, ?NAME=", r"^: ?[GT]\d+\b",
    ),
    _kind(
        phrase("program_of_heidenhain_iso"),
        r"^% ?\w+ G7[01]\b", r"^Q2\d\d ?= ?[-+\d.]", r"^N\d+ G2\d\d (?:[A-Z]{4}|Q2\d\d)", r"^N\d+ G99 T\d+ L",
        r"^N\d+ G30 G17 X",
    ),
    _kind(
        phrase("program_of_millplus"),
        r"\bG7 ?[ABC]5=", r"\b[ABC]5=-?[\d.]+ [ABC]5=", r"\bG174\b", r"\bG54 ?I\d",
    ),
    _kind(phrase("program_of_mach"), r"\bMach ?[34]\b", r"\bG40\.1\b", r"\bG80 ?G50\b", r"^M998\b"),
    _kind(
        phrase("program_on_tape"),
        r"^N?\d*[GXYZFSTM][^$]*\$ *$", r"^(?:N\d+)?G0?[01]X[+-]?\d{4,}Y?[^$]*\$ *$",
    ),
    _kind(
        phrase("program_of_sinumerik"),
        r"^%_N_\w+_(?:MPF|SPF)", r"\b(?:TRAORI|TRAFOOF|SUPA|ORIWKS|ORIAXES)\b", r"\bCYCLE\d{2,3} ?\(",
        r"^(?:N\d+ )?MSG ?\(\"",
        r"\bR\d+ ?= ?", r"^;\$PATH=", r"\bD\d+ ?M6\b|\bT ?= ?\"", languages=("Sinumerik",),
    ),
    _kind(
        phrase("program_of_linuxcnc"),
        r"\bO ?(?:<\w+>|\d+) (?:sub|endsub|call|if|while|return)\b", r"#<\w+>", r"\bG64 ?P", r"\bG43\.1 ?Z",
        r"\bM6[2-8] ?[PE]\d",
        languages=("LinuxCNC",),
    ),
    _kind(
        phrase("program_of_fanuc"),
        r"^:?O\d{1,8}\b", r"\bG5\.1 ?Q|\bG05\.1 ?Q", r"\bG43\.4\b|\bG68\.2\b|\bG234\b|\bG254\b",
        r"\bG154 ?P|\bG54\.1 ?P",
        languages=("Fanuc",),
    ),
)  # fmt: skip

#: A text that is no program.
TEXT: Final = ProgramKind(phrase("program_is_text"), ())

_WORD: Final = re.compile(r"(?:^|[\s(])[GMXYZFSTNO] ?(?:[-+]?\.?\d|=)", re.IGNORECASE)


def recognize(file: Path) -> Recognized | None:
    """Return what a file is by its first lines; None where it says too little, or cannot be read."""
    lines = list(_lines(file))
    best: Recognized | None = None
    for kind in KINDS:
        patterns = kind.patterns
        found = [_first(mark, lines) for mark in patterns]
        marks = tuple({each[0]: each for each in sorted(filter(None, found), reverse=True)}.values())[::-1]
        repeated = len(marks) == 1 and _count(patterns[[bool(each) for each in found].index(True)], lines) >= _ENOUGH
        if (len(marks) >= _ENOUGH or repeated) and (best is None or len(marks) > len(best.found)):
            best = Recognized(kind, marks)
    if best is None and lines and sum(not _WORD.search(line) for _, line in lines) >= _MOSTLY * len(lines):
        return Recognized(TEXT, ())
    return best


def with_kind(run: Run, program: Path) -> Run:
    """Return a run with errors that says first what its program seems to be, if that is nothing for its control."""
    lines = len({(each.file, each.line) for each in run.errors})
    doubt = _doubt(program, run.language, not len(run), lines >= max(_FEW_ERRORS, len(run)))
    first = () if doubt is None else (Diagnostic(1, doubt, file=run.files[0]),)
    return replace(run, diagnostics=(*first, *run.diagnostics)) if first else run


def kind_problem(program: Path, machine: Machine) -> Problem | None:
    """Return what a program that cannot be read seems to be, if that is nothing for the control of the machine."""
    doubt = _doubt(program, FAMILIES[family_of(machine)].reader or "", True, False)
    return None if doubt is None else Problem(str(program), 1, doubt)


def program_for_cl_file(file: Path) -> Problem | None:
    """Return that a file is a program, where it was to be a CL file."""
    found = recognize(file)
    if found is None or not found.found:
        return None
    line, letters = found.found[0]
    variant = "is_program" if found.kind.languages else "is_foreign_program"
    return Problem(str(file), 0, Wording("CL110", variant, kind=found.kind.name, mark=letters, line=line))


def _doubt(program: Path, language: str, is_still: bool, is_certain: bool) -> Wording | None:
    """Return what a program seems to be.

    is_still    it has no motion, so that it may be a text
    is_certain  at any rate it is none for the control
    """
    found = recognize(program)
    reader = language.rsplit(".", 2)[-2]
    if found and reader not in found.kind.readers and (found.found or is_still or is_certain):
        said: dict[str, object] = {"kind": found.kind.name}
        for name, (line, letters) in zip(("first", "second"), found.found, strict=False):
            said |= {name: letters, f"{name}_line": line}
        return Wording("NC113", ("is_text", "is_kind_by_one", "is_kind")[min(len(found.found), 2)], **said)
    return Wording("NC113", "is_for_other_control") if is_certain and found is None else None


def _lines(file: Path) -> Iterator[tuple[int, str]]:
    """Lines of the head of a text that are not empty, with their numbers; a pipe is not opened, and data are none."""
    try:
        if not file.is_file():
            return
        with file.open("rb") as opened:
            head = opened.read(_HEAD)
    except OSError:
        return
    if b"\0" in head:
        return
    for number, line in enumerate(head.decode("utf-8", "replace").splitlines(), 1):
        if line.strip(" \t%"):
            yield number, line[:_MOST_LETTERS].rstrip()


def _first(mark: re.Pattern[str], lines: list[tuple[int, str]]) -> tuple[int, str] | None:
    """Return the first line with a mark, and its letters."""
    hits = ((number, found[0].strip()) for number, line in lines if (found := mark.search(line)))
    return next(hits, None)


def _count(mark: re.Pattern[str], lines: list[tuple[int, str]]) -> int:
    return sum(mark.search(line) is not None for _, line in lines)
