"""CATIA V5 and 3DEXPERIENCE APTSOURCE."""

import re
from collections.abc import Sequence
from typing import Final

import numpy as np

from trunnion.cl.builder import NoAxis
from trunnion.cl.conventions import CycleWords
from trunnion.cl.diagnostics import StatementError
from trunnion.cl.dialect import Dialect, marks
from trunnion.cl.dialects.apt import APT_HANDLERS, CYCLES
from trunnion.cl.state import TOOL_NUMBER, ReaderState
from trunnion.cl.statement import Statement, whole_number
from trunnion.cl.statements import apt_motion, apt_refused, events, motion
from trunnion.cl.text_format import CATIA_TEXT
from trunnion.messages import Wording, phrase
from trunnion.model.frames import frame_from_vectors, relative_frame
from trunnion.model.toolpath import Frame
from trunnion.records import dataclass

_NAME: Final = re.compile(r"\s*OPERATION NAME\s*:\s*(.*)", re.IGNORECASE)
_MATRIX: Final = re.compile(r"\*CATIA(\d)\s*", re.IGNORECASE)
#: A line of the matrix, or what is left of it.
_ROW: Final = re.compile(r"[-+.\deEdD\s]*\d[-+.\deEdD\s]*")
#: Greatest error of a product of two axes, which are printed with five decimals.
_SQUARE: Final = 1e-4
#: Greatest number of a matrix, in units of the file: no part is as large.
_FARTHEST: Final = 1e7
#: The statement ends where ``$$`` begins a comment.
_AXIS_AS_COMMENT: Final = "SYN/'TLAXIS','"
_NUMBER: Final = re.compile(r"[-+.]?\d")


@dataclass(slots=True)
class _Matrix:
    """A machining axis system while its comments are read: those behind ``$$*CATIA0``, and the line of this one."""

    lines: list[str] | None = None
    line: int = 0


def _comment(state: ReaderState, text: str) -> None:
    """Lines of comment that name an operation, or give the machining axis system."""
    matrix = state.own(_Matrix)
    if matrix.lines is not None and state.line != matrix.line + 1 + len(matrix.lines):
        _end_matrix(state)
    if name := _NAME.fullmatch(text):
        _end_matrix(state)
        state.name_operation(name[1].strip())
    elif begin := _MATRIX.fullmatch(text):
        _end_matrix(state)
        if begin[1] != "0":
            raise StatementError(Wording("CL430", "only_catia0_known", text=text))
        matrix.lines, matrix.line = [], state.line
    elif matrix.lines is not None:
        matrix.lines.append(text)
        if len(matrix.lines) == 2 and not _NUMBER.search(text):
            _miss_system(state)
        elif len(matrix.lines) == 4:  # an identifier, and three lines of four numbers
            numbers = _numbers_of(matrix.lines[1:])
            matrix.lines = None
            _set_system(state, numbers)


def _numbers_of(lines: Sequence[str]) -> tuple[float, ...]:
    """Return the twelve numbers of a machining axis system."""
    rows = [row.split() for row in lines]
    try:
        numbers = tuple(float(number) for row in rows for number in row)
    except ValueError:
        numbers = ()
    if [len(row) for row in rows] != [4, 4, 4] or len(numbers) != 12:
        raise _damaged_matrix()
    return numbers


def _damaged_matrix() -> StatementError:
    return StatementError(Wording("CL430", "catia0_not_followed"))


def _end_matrix(state: ReaderState) -> None:
    """Check the lines behind ``$$*CATIA0`` where other lines follow: the matrix is whole, or missing altogether."""
    matrix = state.own(_Matrix)
    if matrix.lines is None:
        return
    lines, matrix.lines = matrix.lines, None
    try:
        if any(_ROW.fullmatch(line) for line in lines) or len(lines) > 1:
            raise _damaged_matrix()
        _miss_system(state)
    except StatementError as error:
        state.diagnostics.error(matrix.line, error.wording)


def _miss_system(state: ReaderState) -> None:
    """Go on without the matrix that a table of words leaves out; refuse that where it may be another one."""
    state.own(_Matrix).lines = None
    if state.system or state.row:
        raise StatementError(Wording("CL430", "catia0_without_matrix"))


def _set_system(state: ReaderState, numbers: tuple[float, ...]) -> None:
    """Set the machining axis system of the points that follow; that of the file is the first one.

    Columns are axes and origin in the model. Operations of a later system have their frame in the first one, and
    nothing in the coordinates before goes on: last point, tool axis, clearance plane.
    """
    if not state.system and state.row:
        raise StatementError(Wording("CL430", "catia0_behind_points"))
    frame = _frame(numbers)
    own = Frame() if not state.system or numbers == state.system else relative_frame(frame, _frame(state.system))
    if not state.system:
        state.set_system(numbers)
    if own == state.builder.frame:
        return
    if state.cycle_line or state.direction is not None:
        raise StatementError(Wording("CL430", "catia0_within_cycle"))
    state.split_operation()
    state.builder.frame, state.builder.continues = own, False
    state.clearance = None
    state.set_axis(None, NoAxis.NEVER)
    state.diagnostics.remark(state.line, Wording("CL450", "machining_axis_system"))


def _frame(numbers: tuple[float, ...]) -> Frame:
    """Return a machining axis system in the model, made exactly unit and square."""
    matrix = np.array(numbers).reshape(3, 4)
    x, y, z = matrix[:, :3].T
    is_near = np.abs(matrix).max() <= _FARTHEST
    if not is_near or np.abs(matrix[:, :3].T @ matrix[:, :3] - np.eye(3)).max() > _SQUARE or np.cross(x, y) @ z < 0:
        raise StatementError(Wording("CL440", "machining_axis_system"))
    x = x / np.linalg.norm(x)
    y = y - (x @ y) * x
    return frame_from_vectors(matrix[:, 3], x, y / np.linalg.norm(y))


def _goto(state: ReaderState, statement: Statement) -> None:
    """Read a point: tip, and tool axis. More numbers are a vector of compensation, or a contact point with its
    normal.
    """
    if len(statement.values) in (9, 12):
        raise StatementError(Wording("CL470", "goto_numbers_compensation", count=len(statement.values)))
    motion.goto(state, statement)


def _tlaxis(state: ReaderState, statement: Statement) -> None:
    """Read the tool axis of the points behind it, which then have none of their own until the next MULTAX."""
    state.vectors = False
    apt_motion.tlaxis(state, statement)


def _toolno(state: ReaderState, statement: Statement) -> None:
    """Read the number of the tool, which LOADTL must have as well, and its kind: turning points are not those of a
    mill.
    """
    if "TURN" in statement.words():
        raise StatementError(Wording("CL260", "toolno_belongs_turning", listed=statement.listed()))
    number = whole_number("TOOLNO", statement.values[:1])
    if state.tool is not None and state.tool.number != number:
        state.split_operation()
    state.state_once(TOOL_NUMBER, number)


def _syn(state: ReaderState, statement: Statement) -> None:
    """Read SYN/'TLAXIS','$$…' of ICAM's table, where TLAXIS is a comment since each point has its axis as well."""
    if statement.source.replace(" ", "").upper() != _AXIS_AS_COMMENT:
        apt_refused.refuse(state, statement)
        return
    state.diagnostics.remark(state.line, Wording("CL230", "syn_makes_tlaxis"))


def _ppfun(state: ReaderState, statement: Statement) -> None:
    """Read PPFUN/15,number,OFF, which switches a message of ICAM's post-processor off; others may be anything."""
    if len(statement.values) == 3 and statement.values[0] == 15 and statement.values[2] in ("ON", "OFF"):
        return
    state.note_unknown(statement, phrase("not_known", statement="PPFUN"))


def _mode(state: ReaderState, statement: Statement) -> None:
    """Read MODE/CIRCUL of ICAM, which fits arcs to points, and MODE/LINEAR, which ends that: points stay points."""
    if statement.values[:1] not in (("CIRCUL",), ("LINEAR",)):
        events.set_mode(state, statement)
        return
    state.diagnostics.remark(state.line, Wording("CL230", "mode_tells_icam", values=statement.values[0]))


CATIA: Final = Dialect(
    name="catia",
    title="CATIA APTSOURCE",
    marks=marks(
        rb"\$\$[ \t]*CATIA APT VERSION\b", rb"\$\$\*CATIA\d", rb"\$\$[ \t]*OPERATION NAME[ \t]*:",
        rb"\$\$[ \t]*TOOLCHANGE(?:BEGINNING|END)\b",
    ),
    handlers={
        **APT_HANDLERS,
        "GOTO": _goto,
        "MODE": _mode,
        "PPFUN": _ppfun,
        "SYN": _syn,
        "TLAXIS": _tlaxis,
        "TOOLNO": _toolno,
    },
    text=CATIA_TEXT,
    cycles=CycleWords(
        modes=CYCLES.modes,
        words=CYCLES.words,
        positions=("FEDTO", "RAPTO"),
        refused=CYCLES.refused,
    ),
    comment=_comment,
    after_comment=_end_matrix,
    # After MULTAX/OFF points have no axis, and the last one stays; points have vectors after MULTAX only.
    multax_off=NoAxis.MODAL,
    vectors=False,
)  # fmt: skip
