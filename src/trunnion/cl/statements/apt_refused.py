"""Statements that are refused by their names: motion that is not points, and statements of APT part programs."""

from typing import Final

from trunnion.cl.diagnostics import StatementError
from trunnion.cl.state import ReaderState
from trunnion.cl.statement import Statement

#: Statements that the APT processor executes, and that CL data never have.
PART_PROGRAM_WORDS: Final = (
    "MACRO", "TERMAC", "CALL", "LOOPST", "LOOPND", "JUMPTO", "RESERV", "IF", "DO", "ZSURF", "GO", "GOLFT",
    "GORGT", "GOUP", "GODOWN", "GOBACK", "TLLFT", "TLRGT", "TLONPS", "TLOFPS", "THICK", "INDIRP", "CUT",
    "DNTCUT", "POCKET", "SCURV", "POINT", "LINE", "PLANE", "VECTOR",
    "INCLUD", "INCLUDE", "*INCLUD", "*INCLUDE", "WHILE", "UNTIL", "UNDEF",
)  # fmt: skip

_ROTARY: Final = (
    "turns a rotary axis itself, and does not say in which coordinates the points behind it are",
    "output the points with tool axes (i, j, k) in the coordinates of the workpiece",
    "CL480",
)
_SYSTEM: Final = (
    "repeats, shifts or turns motion",
    "output all motion itself, in one coordinate system",
    "CL480",
)
_SUBPROGRAM: Final = ("belongs to a subprogram", "output the motion itself, without subprograms", "CL260")
_MOTION: Final = (
    "is motion that cannot be read",
    "write GOTO/ with each point, and CIRCLE/ or GOFWD/ for arcs",
    "CL250",
)
_TURNING: Final = ("belongs to turning, which is not read", "output the milling operations alone", "CL260")
_PROBING: Final = ("moves the tool until it touches the part", "output the cutting operations alone", "CL260")

#: Statements that move the machine, or change what the points behind them mean: why, how to do without, and the code.
REFUSED_WORDS: Final = {
    "ROTABL": _ROTARY,
    "ROTATE": _ROTARY,
    "ROTHED": _ROTARY,
    "POSITN": ("moves the tool to a point that it does not give", "write GOTO/ with the point", "CL250"),
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
    "SYN": ("gives words other meanings", "leave it out of the table of the CAM system", "CL120"),
}


def part_program(state: ReaderState, statement: Statement) -> None:
    """Refuse a statement of an APT part program."""
    what = f"{statement.major} is a statement of an APT part program, and not of CL data"
    raise StatementError(what, "run the part program through the APT system, and give its CL data", code="CL120")


def refuse(state: ReaderState, statement: Statement) -> None:
    """Refuse motion that cannot be read."""
    word = statement.major.removeprefix("->")
    why, cure, code = REFUSED_WORDS[word]
    raise StatementError(f"{word} {why}", cure, code=code)
