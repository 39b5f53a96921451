"""Tools of APT dialects: CUTTER with its seven parameters, LOADTL in its forms, names."""

from dataclasses import replace
from typing import Any, Final

from trunnion.cl.diagnostics import StatementError
from trunnion.cl.state import ReaderState
from trunnion.cl.statement import Statement, numbers, whole_number
from trunnion.cl.statements import events
from trunnion.messages import Wording, phrase
from trunnion.model.apt_cutter import stated_centre
from trunnion.model.toolpath import SelectTool, Tool
from trunnion.records import dataclass

#: A tip flatter than this, degrees from the horizontal, is that of a mill.
_FLATTEST_DRILL: Final = 1.0

#: How far the corner's centre of a drill may be off its edge, as a part of its diameter: numbers are rounded.
_AT_EDGE: Final = 1e-3

#: What CUTTER says of a tool; all else, other statements say.
_OF_CUTTER: Final = ("kind", "diameter", "corner_radius", "length", "taper_angle", "tip_angle", "corner_centre")

#: Words of LOADTL with a number that is the register of the tool's length.
_REGISTERS: Final = frozenset({"OSETNO", "OFFSET", "ADJUST"})


@dataclass(slots=True)
class _Stated:
    """Rows before which a statement last described a tool: its form, its name, its length in the spindle; -1: none."""

    form: int = -1
    name: int = -1
    length: int = -1


def cutter(state: ReaderState, statement: Statement) -> None:
    """Set the form of the tool: CUTTER/d[,r[,e,f,a,b,h]].

    d diameter; r corner radius; e, f centre of the corner's circle from the axis and above the tip; h height.
    a is the angle of the tip from the horizontal, b that of the side from the axis, both in degrees.
    """
    tool, stated = _form(statement), state.own(_Stated)
    now = state.builder.tool
    form = Tool(**{field: getattr(now, field) for field in _OF_CUTTER})
    if form != tool:
        state.split_operation()
    state.state_once("tool", tool)
    if form != tool:
        if stated.name == state.row:
            tool = replace(tool, name=now.name, holder=now.holder)
        if stated.length == state.row:
            tool = replace(tool, set_length=now.set_length)
        state.builder.tool = tool
    stated.form = state.row


def cutter_in_section(state: ReaderState, statement: Statement) -> None:
    """Set the form of the tool of an operation in a CLSF, unless its TLDATA has stated it."""
    tool = _form(statement)
    state.state_once("cutter", statement.values)
    state.state_once("diameter of the tool", tool.diameter)
    if state.builder.tool.kind == "UNKNOWN":
        state.builder.tool = replace(tool, name=state.builder.tool.name)


def _form(statement: Statement) -> Tool:
    """Return the tool that a CUTTER describes; zeros describe none."""
    values = statement.values[:-1] if statement.values[-1:] == ("",) else statement.values
    given = statement._replace(values=values).numbers(1, 2, 7)
    if not any(given):
        return Tool()
    d, r, e, f, a, b, h = (*given, *(0.0,) * (7 - len(given)))
    is_drill = r == 0.0 and a > _FLATTEST_DRILL and abs(e - 0.5 * d) <= _AT_EDGE * d
    return Tool(
        kind="DRILL" if is_drill else "MILL",
        diameter=d,
        corner_radius=r,
        length=h,
        taper_angle=0.0 if is_drill else b,
        tip_angle=180.0 - 2.0 * a if is_drill else a,
        corner_centre=stated_centre(d, r, e, f),
    )


def name_tool(state: ReaderState, name: str, holder: str = "") -> None:
    """Set the name of the tool and that of its holder."""
    tool = state.builder.tool
    if (name, holder) != (tool.name, tool.holder):
        state.split_operation()
        state.builder.tool = replace(state.builder.tool, name=name, holder=holder)
    state.state_once("name of the tool", name)
    state.own(_Stated).name = state.row


def set_length_of(state: ReaderState, field: str, statement: Statement) -> None:
    """Set ``flute_length`` or ``extension`` where a tool has just been described."""
    (length,) = statement.numbers(1)
    if state.own(_Stated).form == state.row:
        state.state_once(field.replace("_", " "), length)
        sizes: dict[str, Any] = {field: length}
        state.builder.tool = replace(state.builder.tool, **sizes)


def tprint(state: ReaderState, statement: Statement) -> None:
    """Name the tool; names of its assembly and its holder may follow."""
    name, *others = (part.strip() for part in statement.text.split(","))
    name_tool(state, name, ", ".join(filter(None, dict.fromkeys(others))))


def loadtl(state: ReaderState, statement: Statement) -> None:
    """Load a tool: LOADTL/n[,register], and couplets of a word and a number."""
    values = list(statement.values)
    number = whole_number("LOADTL", tuple(values[:1]))
    adjust, length, unknown, at = 0, 0.0, [], 1
    if len(values) > 1 and not isinstance(values[1], str):
        # LOADTL/n,register, or LOADTL/n,0,length,register.
        plain = [value for value in values[1:] if not isinstance(value, str)]
        if len(plain) != len(values) - 1 or len(plain) not in (1, 2, 3) or (len(plain) == 3 and plain[0] != 0):
            raise StatementError(Wording("CL330", "loadtl_not_known", listed=statement.listed()))
        if len(plain) == 2 and plain[0] != plain[1]:
            raise StatementError(Wording("CL330", "loadtl_not_known", listed=statement.listed()))
        adjust, at = whole_number("LOADTL", tuple(plain[-1:])), len(values)
        length = plain[1] if len(plain) == 3 else 0.0
    statement.refuse_contradictions(_REGISTERS)
    if twice := next((word for word in (*_REGISTERS, "LENGTH") if values.count(word) > 1), ""):
        raise StatementError(Wording("CL320", "loadtl_twice", twice=twice))
    while at < len(values):
        word = values[at]
        if word in _REGISTERS:
            adjust = whole_number(f"LOADTL {word}", tuple(values[at + 1 : at + 2]))
            at += 2
        elif word == "LENGTH" and at + 1 < len(values) and not isinstance(values[at + 1], str):
            (length,) = numbers("LOADTL LENGTH", (values[at + 1],), 1)
            at += 2
        else:
            unknown.append(str(word) if isinstance(word, str) else f"{word:g}")
            at += 1
    _load(state, number, adjust)
    if length:
        state.state_once("length of the tool in the spindle", length)
        state.builder.tool = replace(state.builder.tool, set_length=length)
        state.own(_Stated).length = state.row
    if unknown:
        state.note_unknown(statement, phrase("not_known_with", statement="LOADTL", words=",".join(unknown)), *unknown)


def load(state: ReaderState, statement: Statement) -> None:
    """Load a tool by LOAD/TOOL,n; LOAD/n is the same."""
    rest = statement.values[1:] if statement.values[:1] == ("TOOL",) else statement.values
    loadtl(state, statement._replace(values=rest))


def select(state: ReaderState, statement: Statement) -> None:
    """Preselect a tool."""
    if statement.values[:1] == ("TOOL",):
        events.load(state, statement._replace(major="SELECT"))
    else:
        number = whole_number(statement.major, statement.values)
        state.add(SelectTool(state.operation_row, state.line, number))


def _load(state: ReaderState, number: int, adjust: int) -> None:
    """Load a tool; without a description of its own, nothing is known of it."""
    before = state.tool
    state.load_tool(number, adjust)
    if before is None or before.number == number:
        return
    stated = state.own(_Stated)
    if stated.form != state.row:
        state.builder.tool = Tool(name=state.builder.tool.name, holder=state.builder.tool.holder)
    if stated.name != state.row:
        state.builder.tool = replace(state.builder.tool, name="", holder="")
