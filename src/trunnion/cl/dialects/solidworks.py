"""SolidWorks CAM and CAMWorks APT."""

import re
from typing import Final

import numpy as np

from trunnion.cl.builder import NoAxis
from trunnion.cl.conventions import CycleParts, CycleWords
from trunnion.cl.diagnostics import StatementError
from trunnion.cl.dialect import Dialect, marks
from trunnion.cl.dialects.apt import APT_HANDLERS
from trunnion.cl.state import COORDINATE_SYSTEM, ReaderState
from trunnion.cl.statement import Statement
from trunnion.cl.statements import apt_tools, events, motion, operations
from trunnion.cl.statements.cycles import cycle
from trunnion.messages import Wording
from trunnion.records import dataclass

#: How far columns of a CSYS may be off unit length and off square: they are printed with six decimals or more.
_SQUARE: Final = 1e-3

_Z: Final = (0.0, 0.0, 1.0)

#: A note that names a tool: ``[HOLDER=C40-M20EM3] 20MM CRB 2FL 38 LOC``.
_NAME_IN_NOTE: Final = re.compile(r"(?:\[HOLDER=([^\]]*)\]\s*)?(.*)", re.DOTALL)


@dataclass(slots=True)
class _Note:
    """The last note, and its line."""

    line: int = 0
    text: str = ""


def _insert(state: ReaderState, statement: Statement) -> None:
    """Read a note: it begins an operation, and names the tool if CUTTER follows. It never goes into the program as it
    is.
    """
    state.split_operation()
    note = state.own(_Note)
    note.line, note.text = state.line, statement.text.strip()
    events.message(state, statement._replace(major="PPRINT", text=note.text))


def _cutter(state: ReaderState, statement: Statement) -> None:
    """Read the tool, under the name of the note before it, which may begin with its holder."""
    apt_tools.cutter(state, statement)
    note = state.own(_Note)
    if note.line and note.line + 1 == state.line:
        holder, name = _NAME_IN_NOTE.findall(note.text)[0]
        apt_tools.name_tool(state, name, holder)


def _trntyp(state: ReaderState, statement: Statement) -> None:
    """Points are those of the world's coordinate system; anything else cannot be read."""
    if statement.values != ("WORLD", 0.0, 0.0, 0.0):
        raise StatementError(Wording("CL430", "trntyp_coordinate_system", listed=statement.listed()))
    state.split_operation()


def _csys(state: ReaderState, statement: Statement) -> None:
    """Read the coordinate system of the operation: Z, its third column, is the tool axis; the points stay in the
    world's.
    """
    numbers = statement.numbers(12)
    columns = np.array(numbers).reshape(3, 4)[:, :3]
    if np.abs(columns.T @ columns - np.eye(3)).max() > _SQUARE:
        raise StatementError(Wording("CL440", "columns_csys_not"))
    state.split_operation()
    state.state_once(COORDINATE_SYSTEM, numbers)
    z = (numbers[2], numbers[6], numbers[10])
    # A point without an axis is written only where Z is the world's.
    state.set_axis(None, NoAxis.Z if z == _Z else NoAxis.NEVER)


def _spindl(state: ReaderState, statement: Statement) -> None:
    """Read the spindle speed, which stands at the beginning of each operation."""
    state.split_operation()
    events.spindl(state, statement)


def _circle(state: ReaderState, statement: Statement) -> None:
    """Read an arc by centre and normal; its radius is the distance of its start."""
    motion.begin_circle(state, (*statement.numbers(6), float("nan")), 1)


def _cycle(state: ReaderState, statement: Statement) -> None:
    """CYCLE/INIT and CYCLE/CLEAR announce a cycle, and say nothing about it."""
    if statement.values not in (("INIT",), ("CLEAR",)):
        pecking_cycle(state, statement)


def pecking_cycle(state: ReaderState, statement: Statement) -> None:
    """Read a cycle with pecks, and a remark where the later ones are longer than the first."""
    cycle(state, statement)
    pecks = dict(zip(statement.values, statement.values[1:], strict=False))
    first, others = pecks.get("1STPECK", 0.0), pecks.get("SUBPECK", 0.0)
    if isinstance(first, float) and isinstance(others, float) and others > first > 0.0:
        state.diagnostics.remark(state.line, Wording("CL860", "pecks_behind_first", others=others, first=first))


def _flute_length(state: ReaderState, statement: Statement) -> None:
    apt_tools.set_length_of(state, "flute_length", statement)


def _extension(state: ReaderState, statement: Statement) -> None:
    apt_tools.set_length_of(state, "extension", statement)


def _settle_cycle(found: CycleParts) -> None:
    """Read the first peck, and then pecks of one length: as first, decrease and minimum.

    Pecks that grow have no words; shorter ones are safe for the drill.
    """
    first, others = found.take("1STPECK"), found.take("SUBPECK")
    if first is not None and others is not None:
        if not others[0] > 0.0:
            raise StatementError(Wording("CL830", "cycle_subpeck_not"))
        alike = others[0] >= first[0]
        found.couplets.append(("STEP", first if alike else (first[0], first[0] - others[0], others[0])))
    elif first is not None or others is not None:
        raise StatementError(Wording("CL820", "cycle_one_1stpeck"))


SOLIDWORKS: Final = Dialect(
    name="solidworks",
    title="SolidWorks CAM APT",
    marks=marks(rb"CSI_SET_", rb"TRNTYP[ \t]*/", rb"CYCLE[ \t]*/[ \t]*INIT\b", rb"SETUP[ \t]*/[ \t]*(?:START|END)\b"),
    handlers={
        **APT_HANDLERS,
        "INSERT": _insert,
        "CUTTER": _cutter,
        "TRNTYP": _trntyp,
        "CSYS": _csys,
        "SPINDL": _spindl,
        "CIRCLE": _circle,
        "CYCLE": _cycle,
        "CSI_SET_FLUTE_LENGTH": _flute_length,
        "CSI_SET_EXTENSION_LENGTH": _extension,
        "SETUP": operations.ignore,
    },
    cycles=CycleWords(
        modes={"DRILL": ("DRILL",), "DEEP": ("DRILL", "DEEP"), "DEEP2": ("DRILL", "DEEP")},
        words={"INCR": "STEP"},
        numbers=frozenset({"1STPECK", "SUBPECK"}),
        settle=_settle_cycle,
    ),
    no_axis=NoAxis.Z,
)
