"""Creo and Pro/ENGINEER NCL: APT with commands of its own in ``$$->`` comments."""

from typing import Final

from trunnion.cl.builder import NoAxis, StatedPoints
from trunnion.cl.conventions import CycleParts, CycleWords
from trunnion.cl.diagnostics import StatementError
from trunnion.cl.dialect import Dialect, marks
from trunnion.cl.dialects.apt import APT_HANDLERS
from trunnion.cl.state import ReaderState
from trunnion.cl.statement import Statement, parse
from trunnion.cl.statements import apt_refused, apt_tools, events, motion, operations
from trunnion.cl.statements.cutcom_points import CutcomPoints
from trunnion.messages import Wording


def _csys(state: ReaderState, statement: Statement) -> None:
    """Read the coordinate system of the points in that of the model: it may not change."""
    state.set_system(statement.numbers(12))


def _alias(state: ReaderState, statement: Statement) -> None:
    """Read the coordinate system under a name of the shop's own: an NC alias may stand for ``$$-> CSYS``."""
    state.diagnostics.remark(state.line, Wording("CL240", "taken_csys_under", major=statement.major))
    _csys(state, statement)


def _featno(state: ReaderState, statement: Statement) -> None:
    """Read the number of the sequence names the operation."""
    state.name_operation(f"FEATNO {statement.listed()}")


def _mfgno(state: ReaderState, statement: Statement) -> None:
    """Read the number of the manufacturing model names the part, if PARTNO does not."""
    state.part = state.part or statement.listed()


def _geometry_type(state: ReaderState, statement: Statement) -> None:
    """Read what the points are from here on: those of the tool's centre, or of the contour (profile)."""
    lost = Wording("CL470", "cutcom_geometry_type", listed=statement.listed())
    if statement.values not in (("OUTPUT_ON_CENTER",), ("OUTPUT_ON_PROFILE",)):
        state.diagnostics.remark(state.line, lost)
        return
    of_contour = statement.values == ("OUTPUT_ON_PROFILE",)
    words = f"CUTCOM_GEOMETRY_TYPE/{statement.listed()}"
    state.own(CutcomPoints).take(state, StatedPoints(of_contour, state.line, words, lost))


def _comment(state: ReaderState, text: str) -> None:
    """Read a comment, which is a command also where blanks stand in front of its arrow."""
    _command(state, text.strip())


def _remark(state: ReaderState, statement: Statement) -> None:
    """Read a comment, in which an alias may put what otherwise stands behind ``$$->``."""
    _command(state, statement.text)


def _command(state: ReaderState, text: str) -> None:
    if not text.startswith("->"):
        return
    found = parse(text.encode(), "utf-8")
    handler = NCL.handlers.get(found.major)
    if handler is not None:
        handler(state, found)


def _fedrat(state: ReaderState, statement: Statement) -> None:
    """INVERS,AUTO and INVERS,OFF say how a post-processor should write feeds, and change none of them."""
    if statement.values not in (("INVERS", "AUTO"), ("INVERS", "OFF")):
        events.fedrat(state, statement)


def _settle_cycle(found: CycleParts) -> None:
    """CLEAR is where feeding begins, RAPTO how far rapid goes on from there, RETURN,0 the retract plane."""
    clear, rapto, back = found.take("CLEAR"), found.take("RAPTO"), found.take("RETURN")
    if clear is None:
        raise StatementError(Wording("CL820", "cycle_without_clear"))
    height = clear[0] - (rapto[0] if rapto else 0.0)
    if not height >= 0.0:
        raise StatementError(Wording("CL830", "cycle_rapto_passes"))
    found.couplets.append(("RAPTO", (height,)))
    if back is None:
        found.couplets.append(("RTRCTO", clear))
    elif back[0] == 0.0:
        found.words.append(("RTRCTO", "AUTO"))
    else:
        found.couplets.append(("RTRCTO", back))


_UNCONFIRMED: Final = "no real file of this dialect confirms its meaning"

NCL: Final = Dialect(
    name="ncl",
    title="Creo NCL",
    marks=marks(rb"\$\$\*?[ \t]*Pro/CLfile\b", rb"\$\$[ \t]*->", rb"REMARK[ \t]*(?:->|\*[ \t]*Pro/CLfile\b)"),
    handlers={
        **APT_HANDLERS,
        **{f"->{word}": apt_refused.refuse for word in apt_refused.REFUSED_WORDS},
        "->CSYS": _csys,
        "->CUTTER": apt_tools.cutter,
        "->FEATNO": _featno,
        "->MFGNO": _mfgno,
        "->CUTCOM_GEOMETRY_TYPE": _geometry_type,
        "->END": operations.ignore,
        "CIRCLE": motion.circle_with_points,
        "MULTAX": operations.ignore,
        "PPWORD": operations.ignore,
        "REMARK": _remark,
        "FEDRAT": _fedrat,
    },
    cycles=CycleWords(
        modes={
            "DRILL": ("DRILL",),
            "DEEP": ("DRILL", "DEEP"),
            "BRKCHP": ("DRILL", "BRKCHP"),
            "FACE": ("FACE",),
            "TAP": ("TAP",),
            "REAM": ("REAM",),
        },
        words={"DEPTH": "FEDTO"},
        numbers=frozenset({"RETURN"}),
        refused=dict.fromkeys(("THRU", "BORE", "CSINK", "TIMES", "BACK", "TPI"), _UNCONFIRMED),
        settle=_settle_cycle,
    ),
    alias=_alias,
    comment=_comment,
    # The tool axis is written only where it is not parallel to Z.
    no_axis=NoAxis.Z,
)
