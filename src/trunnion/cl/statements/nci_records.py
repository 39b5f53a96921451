"""Records of Mastercam's NCI about operations: header, planes, tool changes, texts, and what is not followed.

Records about an operation stand before the tool change (1000 to 1002) that begins it.
"""

from collections.abc import Sequence
from dataclasses import field, replace
from pathlib import PureWindowsPath
from typing import Final

from trunnion.cl.builder import NoAxis, PlaneStatement
from trunnion.cl.diagnostics import StatementError
from trunnion.cl.pair_statement import code_of
from trunnion.cl.state import ReaderState
from trunnion.cl.statement import Statement, is_whole
from trunnion.cl.statements import apt_tools, events, operations
from trunnion.cl.tool_planes import TOP, squared
from trunnion.messages import Wording, phrase
from trunnion.records import dataclass

#: The numbers of a work coordinate system that turns and shifts nothing.
_NO_SHIFT: Final = (*TOP, 0.0, 0.0, 0.0)

#: Coolants of a tool change.
_COOLANTS: Final = {0.0: "OFF", 1.0: "FLOOD", 2.0: "MIST", 3.0: "THRU"}

#: Values of a tool change that something becomes of: tool, length offset, plane, speed and coolant, places from 1.
_TOOL_CHANGE_VALUES: Final = 13
_FOLLOWED: Final = frozenset({4, 5, 6, 7, 8, 10})  # 5, the number of the diameter, with compensation alone

#: No number of a tool or an offset is higher.
_HIGHEST: Final = 99_999_999


@dataclass(slots=True)
class Contour:
    """Where the motion of an operation is.

    feed   last feed that a record gave, 0 before the first one
    cuts   the record before was no rapid
    place  position word of the record 11 before, 0 if there is none
    """

    feed: float = 0.0
    cuts: bool = False
    place: int = 0


@dataclass(slots=True)
class Pending:
    """What records before a tool change say of its operation: the first of their lines, 0 if there is none."""

    line: int = 0
    name: str = ""
    tool_name: str = ""
    size: tuple[float, float] | None = None
    lengths: tuple[float, float] | None = None
    plane: tuple[float, ...] | None = None


@dataclass(slots=True)
class ToolPlane:
    """The tool plane, and the row from which on it is another one than that before."""

    axes: tuple[float, ...] = TOP
    row: int = -1


@dataclass(slots=True)
class ToolNow:
    """What the last tool change says.

    register   number of the diameter, 0 for none; ``is_used``: compensation is or has been on with it
    side       of the compensation that is on
    coolant    the one that is on
    statement  the record, and its line, while it is not said what of it is not followed
    """

    register: int = 0
    is_used: bool = False
    side: str = "OFF"
    coolant: str = "OFF"
    statement: tuple[int, Statement] | None = None


@dataclass(slots=True)
class Unread:
    """Codes of pairs of which nothing becomes, with how many there are, and the line of the first one."""

    line: int = 0
    counts: dict[int, int] = field(default_factory=dict)


def record(state: ReaderState, statement: Statement) -> Wording:
    """Return the name of a record in messages: its code, and the line of its values, below that of the message."""
    return phrase("nci_record", code=code_of(statement), line=state.line + 1)


def values_of(state: ReaderState, statement: Statement, least: int, most: int | None = None) -> tuple[float, ...]:
    """Return the values of a record, all of them numbers, as many as it has.

    Raises ``StatementError`` otherwise.
    """
    most = least if most is None else most
    values = statement.values
    if not least <= len(values) <= most:
        raise StatementError(
            Wording("CL165", "values", record=record(state, statement), count=len(values), least=least)
        )
    found = []
    for place, value in enumerate(values, 1):
        if isinstance(value, str) or abs(value) > 1e12:
            shown = value[:24] if isinstance(value, str) else f"{value:g}"
            raise StatementError(
                Wording("CL165", "no_number", record=record(state, statement), found=repr(shown), place=place)
            )
        found.append(value)
    return tuple(found)


def whole(state: ReaderState, statement: Statement, values: Sequence[float], place: int) -> int:
    """Return the value at a place, from 1, which must be 0, 1, 2 and so on."""
    value = values[place - 1]
    if not is_whole(value, 0) or value > _HIGHEST:
        raise StatementError(
            Wording("CL165", "no_whole_number", record=record(state, statement), value=value, place=place)
        )
    return int(value)


def header(state: ReaderState, statement: Statement) -> None:
    """Take the name of the part from the path behind the numbers of the header."""
    unread(state, statement)
    words = statement.text.split(None, 8)
    if len(words) > 8 and not state.part:
        state.part = PureWindowsPath(words[8]).stem


def end_of_file(state: ReaderState, statement: Statement) -> None:
    """Note that the file is whole, and say what has not been followed."""
    _refuse_pending(state)
    note_end_of_operation(state)
    values_of(state, statement, 3)
    remark_values(state, state.line, statement)
    operations.end_of_file(state, statement)
    unread = state.own(Unread)
    if unread.counts:
        said = Wording("CL220", "parameters", count=sum(unread.counts.values()), codes=_ranges(sorted(unread.counts)))
        state.diagnostics.remark(unread.line, said)
        unread.counts.clear()


def _ranges(codes: Sequence[int]) -> tuple[str, ...]:
    """Codes in order, those that follow one upon the other as a range."""
    runs: list[list[int]] = []
    for code in codes:
        if runs and code == runs[-1][1] + 1:
            runs[-1][1] = code
        else:
            runs.append([code, code])
    return tuple(str(a) if a == b else f"{a}–{b}" for a, b in runs)


def unread(state: ReaderState, statement: Statement) -> None:
    """Count a record of which nothing becomes."""
    found = state.own(Unread)
    found.line = found.line or state.line
    code = int(code_of(statement))
    found.counts[code] = found.counts.get(code, 0) + 1


def tool_name(state: ReaderState, statement: Statement) -> None:
    """Name the tool of the next tool change."""
    pending = _pend(state)
    pending.tool_name = statement.text


def tool_lengths(state: ReaderState, statement: Statement) -> None:
    """Take length and cutting length of the next tool, in units of the file; those of its holder are not settled."""
    unread(state, statement)
    _, cutting, overall, *_ = values_of(state, statement, 3, 40)
    if not 0.0 <= cutting <= overall:
        said = Wording("CL770", "nci_lengths", record=record(state, statement), cutting=cutting, overall=overall)
        raise StatementError(said)
    _pend(state).lengths = (overall, cutting)


def comment(state: ReaderState, statement: Statement) -> None:
    """Write a comment into the program."""
    events.message(state, statement)


def operation_comment(state: ReaderState, statement: Statement) -> None:
    """Name the operation that the next tool change begins."""
    _pend(state).name = statement.text


def literal(state: ReaderState, statement: Statement) -> None:
    """Put a text into the program as it stands."""
    events.insert(state, statement)


def miscellaneous(state: ReaderState, statement: Statement) -> None:
    """Say that nothing becomes of miscellaneous reals and integers: each post has meanings of its own for them."""
    values_of(state, statement, 10)
    remark_values(state, state.line, statement)


def cutter(state: ReaderState, statement: Statement) -> None:
    """Take diameter and corner radius of the next tool, in units of the file; a path may stand behind the numbers."""
    if len(statement.values) < 3:
        values_of(state, statement, 3)
    side, diameter, corner = values_of(state, statement._replace(values=statement.values[:3]), 3)
    _pend(state).size = (diameter, corner)
    unread(state, statement)
    if side:
        remark_values(state, state.line, statement._replace(source=f"1013/{side:g}"))


def tool_plane(state: ReaderState, statement: Statement) -> None:
    """Take the tool plane of the next tool change: points of the operation are in its coordinates."""
    numbers = values_of(state, statement, 9)
    pending = _pend(state)
    pending.plane = squared(numbers)
    if pending.plane is None:
        raise StatementError(Wording("CL430", "tool_plane", record=record(state, statement)))


def work_system(state: ReaderState, statement: Statement) -> None:
    """Refuse a work coordinate system that turns or shifts: how its points are to be moved is not settled."""
    numbers = values_of(state, statement, 12)
    _pend(state)
    if numbers != _NO_SHIFT:
        raise StatementError(Wording("CL430", "work_system", record=record(state, statement)))


def canned_text(state: ReaderState, statement: Statement) -> None:
    """Note a text of the post, which may switch something."""
    if any(values_of(state, statement, 10)):
        state.note_unknown(statement, phrase("calls_text_of_post", record=statement.major))


def lathe(state: ReaderState, statement: Statement) -> None:
    """Refuse turning."""
    raise StatementError(Wording("CL260", "lathe_record", record=record(state, statement)))


def subprogram(state: ReaderState, statement: Statement) -> None:
    """Refuse the beginning and the end of a subprogram."""
    raise StatementError(Wording("CL260", "subprogram_record", record=record(state, statement)))


def tool_change(state: ReaderState, statement: Statement) -> None:
    """Begin an operation: its tool, spindle and coolant, with what the records before say of it."""
    values = values_of(state, statement, _TOOL_CHANGE_VALUES, 40)
    number, diameter, length = (whole(state, statement, values, place) for place in (4, 5, 6))
    if values[6] != 0.0:
        raise StatementError(Wording("CL430", "plane_number", record=record(state, statement), value=values[6]))
    if values[9] not in _COOLANTS:
        raise StatementError(Wording("CL330", "coolant_number", record=record(state, statement), value=values[9]))
    is_null = statement.major == "1000"
    if is_null and (state.tool is None or state.tool.number != number):
        raise StatementError(Wording("CL780", "null_change", record=record(state, statement), number=number))
    note_end_of_operation(state)
    state.split_operation()
    pending = state.own(Pending)
    if pending.name:
        state.name_operation(pending.name)
    if pending.size is not None:
        apt_tools.cutter(state, statement._replace(major="CUTTER", values=pending.size))
    if pending.lengths is not None:
        overall, cutting = pending.lengths
        state.builder.tool = replace(state.builder.tool, length=overall, flute_length=cutting)
    if pending.tool_name:
        apt_tools.name_tool(state, pending.tool_name)
    if not is_null:
        state.own(Contour).feed, state.own(Contour).cuts = 0.0, False
        given = (float(number), float(length)) if length else (float(number),)
        apt_tools.loadtl(state, statement._replace(major="LOADTL", values=given))
    plane = state.own(ToolPlane)
    if pending.plane is not None and pending.plane != plane.axes:
        plane.axes, plane.row = pending.plane, state.row
    state.builder.planes.append(PlaneStatement(state.operation_row, plane.axes))
    state.own(Pending).__init__()  # type: ignore[misc]
    now = state.own(ToolNow)
    now.register, now.is_used, now.statement = diameter, now.side != "OFF", (state.line, statement)
    state.set_axis((0.0, 0.0, 1.0), NoAxis.UPRIGHT)
    _switch(state, statement, values[7], _COOLANTS[values[9]])


def _switch(state: ReaderState, statement: Statement, rpm: float, coolant: str) -> None:
    """Switch spindle and coolant as a tool change says; a negative speed turns counter-clockwise."""
    words: tuple[str | float, ...] = (abs(rpm), "RPM", "CLW" if rpm > 0.0 else "CCLW") if rpm else ("OFF",)
    if rpm or state.spindle is not None:
        events.spindl(state, statement._replace(major="SPINDL", values=words))
    now = state.own(ToolNow)
    if coolant != "OFF" or now.coolant != "OFF":
        events.coolnt(state, statement._replace(major="COOLNT", values=(coolant,)))
    now.coolant = coolant


def remark_values(state: ReaderState, line: int, statement: Statement, followed: frozenset[int] = frozenset()) -> None:
    """Say of which values of a record nothing becomes: their places, from 1, and what they are."""
    fields = statement.source.partition("/")[2].split(",")
    left = tuple(
        f"{place}: {value}"
        for place, value in enumerate(fields, 1)
        if place not in followed and (place > _TOOL_CHANGE_VALUES or value.strip("+-0."))
    )
    if left:
        name = phrase("nci_record", code=code_of(statement), line=line + 1)
        state.diagnostics.remark(line, Wording("CL220", "values", record=name, values=left))


def _pend(state: ReaderState) -> Pending:
    pending = state.own(Pending)
    pending.line = pending.line or state.line
    return pending


def _refuse_pending(state: ReaderState) -> None:
    """Refuse motion, or an end, behind records that want a tool change first: it would belong to none."""
    pending = state.own(Pending)
    if pending.line:
        line, pending.line = pending.line, 0
        raise StatementError(Wording("CL430", "no_tool_change", line=line))


def begin_motion(state: ReaderState) -> Contour:
    """Return where the motion is; refuse motion that no tool change goes before."""
    _refuse_pending(state)
    return state.own(Contour)


def note_end_of_operation(state: ReaderState) -> None:
    """Say what of its tool change is not followed, and where it ends at a place of the contour at which none ends."""
    now = state.own(ToolNow)
    if now.statement is not None:
        (line, statement), now.statement = now.statement, None
        followed = _FOLLOWED if now.is_used else _FOLLOWED - {5}
        remark_values(state, line, statement, followed)
    contour = state.own(Contour)
    if contour.place not in (0, 32, 52):
        state.diagnostics.remark(state.line, Wording("CL225", "ends_within", place=contour.place))
    contour.place = 0
