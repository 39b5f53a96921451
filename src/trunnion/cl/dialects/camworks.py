"""CAMWorks CL data (``.clt``): milling operations in the system of their setup, without tool numbers."""

import math
import re
from typing import Final

from trunnion.cl.builder import NoAxis
from trunnion.cl.diagnostics import StatementError
from trunnion.cl.dialect import Dialect, marks
from trunnion.cl.dialects.apt import APT_HANDLERS
from trunnion.cl.dialects.solidworks import SOLIDWORKS, pecking_cycle
from trunnion.cl.state import ReaderState
from trunnion.cl.statement import Statement, numbers
from trunnion.cl.statements import events, motion, operations
from trunnion.messages import Wording
from trunnion.records import dataclass

_AXES: Final = ("AAXIS", "BAXIS", "CAXIS")
#: Angles, radians, and unit vectors are printed with six decimals.
_ALIKE: Final = 2e-5

_NUMBER: Final = r"\s*([-+.0-9]+)\s*"
#: Depth, first and other pecks, feed, clearance, and twice the height of the rapid before; blanks stand for commas.
_CYCLE: Final = re.compile(
    rf"CYCLE/\s*DRILL,G98,{_NUMBER},PECKING,{_NUMBER},{_NUMBER},MMPM,{_NUMBER},{_NUMBER},{_NUMBER}{_NUMBER}DWELL,{_NUMBER}"
)


@dataclass(slots=True)
class _Setup:
    """The setup of an operation: where its Z points in the model, empty if unknown, and the angles that turn it."""

    axis: tuple[float, ...] = ()
    turned: tuple[float, ...] = ()


def _begin(state: ReaderState, statement: Statement) -> None:
    """Begin an operation under its name, in a setup that is not turned yet."""
    state.name_operation(statement.source.partition("/")[2].strip())
    state.own(_Setup).turned = ()


def _end(state: ReaderState, statement: Statement) -> None:
    """Refuse an operation whose setup is not known: its points may belong to another one."""
    if len(state.own(_Setup).turned) < len(_AXES):
        raise StatementError(Wording("CL430", "opfeatend_operation_without"))


def _tlaxis(state: ReaderState, statement: Statement) -> None:
    """Note where the Z of the setup points in the model; points are in the setup, where the tool stands upright."""
    i, j, k = statement.numbers(3)
    state.own(_Setup).axis = (i, j, k)


def _rotabl(state: ReaderState, statement: Statement) -> None:
    """Turn the setup in the model by radians: three axes at the beginning of an operation, and back at its end."""
    values = statement.values
    if len(values) != 4 or values[1] not in _AXES or values[2:] != ("TABLE", "CCLW"):
        raise StatementError(Wording("CL430", "rotabl_not_known", listed=statement.listed()))
    angles = numbers("ROTABL", values[:1], 1)
    setup = state.own(_Setup)
    if len(setup.turned) == len(_AXES):
        return  # the setup is turned back
    if values[1] != _AXES[len(setup.turned)]:
        raise StatementError(Wording("CL430", "rotabl_turns_other"))
    setup.turned += angles
    if len(setup.turned) == len(_AXES):
        state.set_system(_system(setup.turned, setup.axis))


def _system(angles: tuple[float, ...], axis: tuple[float, ...]) -> tuple[float, ...]:
    """Return the axes of a setup in the model, in rows of four; its origin is not in the file.

    angles  A, B, C in radians, of which one may turn: the order of several is not settled
    axis    where its Z points, which must agree
    """
    turning = [k for k, angle in enumerate(angles) if abs(angle) > _ALIKE]
    if len(turning) > 1:
        raise StatementError(Wording("CL430", "rotabl_turns_setup"))
    about = turning[0] if turning else 0
    c, s = (round(part, 6) + 0.0 for part in (math.cos(angles[about]), math.sin(angles[about])))
    one, two = (about + 1) % 3, (about + 2) % 3
    rows = [[float(i == k) for k in range(3)] for i in range(3)]
    rows[one][one] = rows[two][two] = c
    rows[one][two], rows[two][one] = -s, s
    z = tuple(row[2] for row in rows)
    if not axis or math.dist(z, axis) > _ALIKE:
        raise StatementError(Wording("CL440", "rotabl_does_not"))
    return (*rows[0], 0.0, *rows[1], 0.0, *rows[2], 0.0)


def _circle(state: ReaderState, statement: Statement) -> None:
    """Read an arc by centre, axis and radius; a word gives its sense."""
    given, sense = statement.values[:-1], statement.values[-1:]
    if sense not in (("CLOCKWISE",), ("COUNTERCLOCKWISE",)):
        raise StatementError(Wording("CL330", "circle_not_known", listed=statement.listed()))
    x, y, z, i, j, k, r = numbers("CIRCLE", given, 7)
    turn = -1.0 if sense == ("CLOCKWISE",) else 1.0
    motion.begin_circle(state, (x, y, z, turn * i, turn * j, turn * k, r), 1)


def _cycle(state: ReaderState, statement: Statement) -> None:
    """Drilling with pecks; CYCLE/ON announces it."""
    if statement.values == ("ON",):
        return
    if statement.values != ("OFF",):
        found = _CYCLE.fullmatch(" ".join(statement.source.split()).upper())
        if not found:
            raise StatementError(Wording("CL820", "cycle_not_known", listed=statement.listed()))
        try:
            depth, first, others, feed, clearance, height, again, dwell = map(float, found.groups())
        except ValueError:
            raise StatementError(Wording("CL820", "cycle_no_number")) from None
        if height != again:
            raise StatementError(Wording("CL320", "cycle_two_heights"))
        statement = statement._replace(
            values=(
                "DEEP2", "FEDTO", depth, "1STPECK", first, "SUBPECK", others, "MMPM", feed, "RAPTO", clearance,
                "RTRCTO", height, *(("DWELL", dwell) if dwell else ()),
            )
        )  # fmt: skip
    pecking_cycle(state, statement)


def _cutcom(state: ReaderState, statement: Statement) -> None:
    """CUTCOM/ON announces the side."""
    if statement.values != ("ON",):
        events.cutcom(state, statement)


CAMWORKS: Final = Dialect(
    name="clt",
    title="CAMWorks CL data",
    marks=marks(rb"OPFEATSTART[ \t]*/", rb"OPFEATEND[ \t]*/", rb"ROTABL[ \t]*/[^,\n]*,[ABC]AXIS,TABLE\b"),
    handlers={
        **APT_HANDLERS,
        "OPFEATSTART": _begin,
        "OPFEATEND": _end,
        "BOX": operations.ignore,
        "MOVE_ATTRIB": operations.ignore,
        "TLAXIS": _tlaxis,
        "ROTABL": _rotabl,
        "CIRCLE": _circle,
        "CYCLE": _cycle,
        "CUTCOM": _cutcom,
    },
    cycles=SOLIDWORKS.cycles,
    no_axis=NoAxis.Z,
    upright="output APT (.apt)",
)
