"""Trunnion's own APT profile, for those who write CL files themselves: sections of NX, tools and stock in words.

It is read strictly: a statement that is not known, or misspelt, is an error. Its first line names it and its version;
without that line it would be NX CLSF, which refuses its commands: what they say would be lost.
"""

import re
from dataclasses import replace
from typing import Any, Final

from trunnion.cl.conventions import CycleWords
from trunnion.cl.diagnostics import StatementError
from trunnion.cl.dialect import Dialect
from trunnion.cl.dialects.clsf import CLSF
from trunnion.cl.state import ReaderState
from trunnion.cl.statement import Statement, joined_lines, numbers, whole_number
from trunnion.cl.statements import HANDLERS, apt_tools, operations
from trunnion.cl.text_format import APT_TEXT
from trunnion.messages import Wording, phrase
from trunnion.model.toolpath import Tool, UnknownStatement
from trunnion.records import dataclass

_VERSION: Final = 1.0

#: Statements that mean what they mean in an NX CLSF.
_OF_CLSF: Final = (
    "PARTNO", "END-OF-PATH", "MSYS", "INTOL", "OUTTOL", "FINI", "RAPID", "GOTO", "GOHOME", "FROM", "CIRCLE", "FEDRAT",
    "SPINDL", "LOADTL", "COOLNT", "CUTCOM", "CYCLE", "DELAY", "STOP", "OPSTOP", "PPRINT", "DISPLY", "INSERT", "OPSKIP",
)  # fmt: skip

_FORMS: Final = ("MILL", "DRILL", "TCUTTER", "BARREL", "UNKNOWN")

#: Words of a tool with one number, and those with two: the fields of ``Tool`` that these are.
_SIZES: Final = {
    "DIAMETER": "diameter", "CORNER": "corner_radius", "LENGTH": "length", "FLUTE": "flute_length",
    "TAPER": "taper_angle", "TIP": "tip_angle", "UPPER": "upper_radius", "EXTENSION": "extension",
    "GAUGE": "set_length",
}  # fmt: skip
_CENTRES: Final = {"CENTRE": "corner_centre", "UPPER-CENTRE": "upper_centre"}

#: Kinds of stock, and how many numbers each has.
_STOCKS: Final = {"BOX": 6, "CYLINDER": 3}


@dataclass(slots=True)
class _Head:
    """Whether the first line of the file has named the profile."""

    is_named: bool = False


def _version(state: ReaderState, statement: Statement) -> None:
    """Read the first line."""
    if statement.values != (_VERSION,):
        raise StatementError(Wording("CL330", "profile_version", listed=statement.listed()))
    if state.line != 1:
        raise StatementError(Wording("CL350", "profile_first_line"))
    state.own(_Head).is_named = True


def _tool_path(state: ReaderState, statement: Statement) -> None:
    """Begin an operation; by then the file has named the profile and its unit."""
    if not state.own(_Head).is_named:
        state.own(_Head).is_named = True
        state.diagnostics.error(1, Wording("CL350", "profile_first_line"))
    if state.length_unit is None:
        raise StatementError(Wording("CL410", "profile_units"))
    operations.tool_path(state, statement)


def _units(state: ReaderState, statement: Statement) -> None:
    """Set the length unit, in the head."""
    _stay_in_head(state, statement)
    operations.units(state, statement)


def _stock(state: ReaderState, statement: Statement) -> None:
    """Note the stock, in units of the file."""
    _stay_in_head(state, statement)
    kind = statement.values[0] if statement.values else ""
    if kind not in _STOCKS:
        raise StatementError(Wording("CL330", "profile_stock", listed=statement.listed()))
    sizes = numbers("STOCK", statement.values[1:], _STOCKS[str(kind)])
    if min(sizes[: 3 if kind == "BOX" else 2]) <= 0.0:
        raise StatementError(Wording("CL330", "profile_stock", listed=statement.listed()))
    if state.stock and state.stock != (str(kind), sizes):
        raise StatementError(Wording("CL320", "stock_twice"))
    state.stock = (str(kind), sizes)


def _tool(state: ReaderState, statement: Statement) -> None:
    """Set the form of the tool and its sizes: words in any order, each with its numbers."""
    _stay_in_operation(state, statement)
    values = statement.values
    if not values or values[0] not in _FORMS:
        raise StatementError(Wording("CL330", "profile_tool", word=_shown(values[:1])))
    now = state.builder.tool
    given: dict[str, Any] = {"kind": values[0], "name": now.name, "holder": now.holder}
    at = 1
    while at < len(values):
        word = values[at]
        field = _SIZES.get(str(word)) or _CENTRES.get(str(word))
        if field is None or not isinstance(word, str):
            raise StatementError(Wording("CL330", "profile_tool", word=_shown((word,))))
        if field in given:
            raise StatementError(Wording("CL320", "tool_word_twice", word=word))
        count = 1 if word in _SIZES else 2
        found = numbers(f"TOOL {word}", values[at + 1 : at + 1 + count], count)
        given[field] = found[0] if count == 1 else found
        at += 1 + count
    tool = Tool(**given)
    state.state_once("tool", values)
    state.state_once("diameter of the tool", tool.diameter)
    state.builder.tool = tool


def _shown(values: tuple[str | float, ...]) -> str:
    return next((value if isinstance(value, str) else f"{value:g}" for value in values), "")


def _holder(state: ReaderState, statement: Statement) -> None:
    """Name the holder of the tool."""
    _stay_in_operation(state, statement)
    name = joined_lines(statement.source).partition("/")[2].strip()
    tool = state.builder.tool
    state.state_once("holder", name)
    state.builder.tool = replace(tool, holder=name)


def _work_offset(state: ReaderState, statement: Statement) -> None:
    """Set which work offset of the control the operation is made in, before its motion."""
    _stay_in_operation(state, statement)
    if state.operation_row:
        raise StatementError(Wording("CL350", "profile_behind_motion", major=statement.major.removeprefix("->")))
    number = whole_number("WORK-OFFSET", statement.values)
    if number < 1:
        raise StatementError(Wording("CL330", "profile_work_offset", listed=statement.listed()))
    state.state_once("work offset", number)
    state.builder.work_offset = number


def _end_of_file(state: ReaderState, statement: Statement) -> None:
    """End the file: where an operation states its work offset, those that move do, too."""
    if any(builder.work_offset for builder in state.builders):
        for builder in state.builders:
            if not builder.work_offset and builder.stop > builder.first:
                state.diagnostics.error(builder.line, Wording("CL490", "not_stated", operation=builder.name))
    operations.end_of_file(state, statement)


def _probe(state: ReaderState, statement: Statement) -> None:
    """Keep a probing cycle: what becomes of it only the definition of a machine can say."""
    _stay_in_operation(state, statement)
    what = phrase("not_known", statement=statement.major)
    state.add(UnknownStatement(state.operation_row, state.line, statement.source, what=what))


def _paint(state: ReaderState, statement: Statement) -> None:
    """Note the colour of the path, which gives the phase of motion."""
    if statement.values[:1] != ("COLOR",):
        raise StatementError(Wording("CL330", "profile_paint", listed=statement.listed()))
    operations.paint(state, statement)


def _stay_in_head(state: ReaderState, statement: Statement) -> None:
    """Refuse a statement about the file behind the first TOOL PATH: what stands before it would mean another thing."""
    if state.in_operation or state.builders:
        raise StatementError(Wording("CL350", "profile_behind_head", major=statement.major.removeprefix("->")))


def _stay_in_operation(state: ReaderState, statement: Statement) -> None:
    """Refuse a statement about a tool outside of an operation."""
    if not state.in_operation:
        raise StatementError(Wording("CL350", "profile_outside", major=statement.major.removeprefix("->")))


def _comment(state: ReaderState, text: str) -> None:
    """Refuse a comment that looks like a command: one with a blank before its arrow."""
    if text.lstrip().startswith("->"):
        raise StatementError(Wording("CL160", "blank_before_arrow", text=text.strip()[:40]))


_COMMANDS: Final = {
    "->TRUNNION": _version, "->STOCK": _stock, "->TOOL": _tool, "->HOLDER": _holder, "->WORK-OFFSET": _work_offset,
}  # fmt: skip

TRUNNION: Final = Dialect(
    name="trunnion",
    title="Trunnion APT",
    first_line=re.compile(rb"\$\$->[ \t]*TRUNNION[ \t]*/", re.IGNORECASE),
    marks=(),
    handlers={
        **{word: HANDLERS[word] for word in _OF_CLSF},
        **_COMMANDS,
        "TOOLPATH": _tool_path,
        "UNITS": _units,
        "SELCTL": apt_tools.select,
        "PAINT": _paint,
        "PROBE": _probe,
        "FINI": _end_of_file,
    },
    cycles=CycleWords(CLSF.cycles.modes),
    text=APT_TEXT,
    in_sections=True,
    has_end=True,
    is_strict=True,
    comment=_comment,
)
