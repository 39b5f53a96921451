"""Statements that are refused by their names: motion that is not points, and statements of APT part programs."""

from typing import Final

from trunnion.cl.diagnostics import StatementError
from trunnion.cl.state import ReaderState
from trunnion.cl.statement import Statement
from trunnion.messages import Wording

#: Statements that the APT processor executes, and that CL data never have.
PART_PROGRAM_WORDS: Final = (
    "MACRO", "TERMAC", "CALL", "LOOPST", "LOOPND", "JUMPTO", "RESERV", "IF", "DO", "ZSURF", "GO", "GOLFT",
    "GORGT", "GOUP", "GODOWN", "GOBACK", "TLLFT", "TLRGT", "TLONPS", "TLOFPS", "THICK", "INDIRP", "CUT",
    "DNTCUT", "POCKET", "SCURV", "POINT", "LINE", "PLANE", "VECTOR",
    "INCLUD", "INCLUDE", "*INCLUD", "*INCLUDE", "WHILE", "UNTIL", "UNDEF",
)  # fmt: skip

_ROTARY: Final = Wording("CL480", "turns_rotary_axis")
_SYSTEM: Final = Wording("CL480", "repeats_motion")
_SUBPROGRAM: Final = Wording("CL260", "subprogram")
_MOTION: Final = Wording("CL250", "unreadable_motion")
_TURNING: Final = Wording("CL260", "turning")
_PROBING: Final = Wording("CL260", "probing")

#: Statements that move the machine, or change what the points behind them mean: what is said of them.
REFUSED_WORDS: Final = {
    "ROTABL": _ROTARY,
    "ROTATE": _ROTARY,
    "ROTHED": _ROTARY,
    "POSITN": Wording("CL250", "no_point"),
    "MOVE": _MOTION,
    "CONT": _MOTION,
    "ARC": _MOTION,
    **dict.fromkeys(("HELICAL", "HELIX", "SPLINE", "BSPLINE"), _MOTION),
    "TURRET": _TURNING,
    "THREAD": _TURNING,
    "SWITCH": _TURNING,
    "PROBE": _PROBING,
    "REFSYS": _SYSTEM,
    "SCALE": _SYSTEM,
    "COPY": _SYSTEM,
    "INDEX": _SYSTEM,
    "TRACUT": _SYSTEM,
    "MIRROR": _SYSTEM,
    "CALSUB": _SUBPROGRAM,
    "DEFSUB": _SUBPROGRAM,
    "ENDSUB": _SUBPROGRAM,
    "SYN": Wording("CL120", "other_meanings"),
}


def part_program(state: ReaderState, statement: Statement) -> None:
    """Refuse a statement of an APT part program."""
    raise StatementError(Wording("CL120", "statement_apt_part", major=statement.major))


def refuse(state: ReaderState, statement: Statement) -> None:
    """Refuse motion that cannot be read."""
    word = statement.major.removeprefix("->")
    raise StatementError(REFUSED_WORDS[word].of_key(word))
