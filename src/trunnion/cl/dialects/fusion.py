"""APT exports of Autodesk Fusion and HSMWorks.

Their posts write the points of a tilted operation in the coordinates of its plane, and do not state the plane.
"""

from typing import Final

from trunnion.cl.builder import NoAxis
from trunnion.cl.diagnostics import StatementError
from trunnion.cl.dialect import Dialect, marks
from trunnion.cl.dialects.apt import APT_HANDLERS, CYCLES
from trunnion.cl.state import ReaderState
from trunnion.cl.statement import Statement
from trunnion.cl.statements import apt_tools, events, operations
from trunnion.messages import Wording

_POST: Final = "output the NC program by the CAM system's post, or CL data with a tool axis at each point"


def _partno(state: ReaderState, statement: Statement) -> None:
    """Set the name of the part, and warn of tilted operations, which the file may not show."""
    state.diagnostics.remark(state.line, Wording("CL460", "some_revisions_export"))
    operations.partno(state, statement._replace(text=statement.text.strip("'")))


def _units(state: ReaderState, statement: Statement) -> None:
    """Read the length unit, which old revisions repeat for each operation."""
    if state.length_unit is not None:
        raise StatementError(Wording("CL460", "units_each_operation"))
    operations.units(state, statement)


def _loadtl(state: ReaderState, statement: Statement) -> None:
    """Read the tool, at the beginning of each operation."""
    if "IN" in statement.words():
        raise StatementError(Wording("CL460", "loadtl_export_writes"))
    state.split_operation()
    apt_tools.loadtl(state, statement)


def _spindl(state: ReaderState, statement: Statement) -> None:
    """Read the spindle; the words alone are the wrong way round in all revisions of these posts."""
    if statement.values in (("ON",), ("OFF",)):
        raise StatementError(Wording("CL740", "spindl_alone_these", listed=statement.listed()))
    events.spindl(state, statement)


FUSION: Final = Dialect(
    name="fusion",
    title="Autodesk Fusion or HSMWorks APT",
    marks=marks(rb"PARTNO[ \t]*/[ \t]*'"),
    handlers={
        **APT_HANDLERS,
        "PARTNO": _partno,
        "UNITS": _units,
        "LOADTL": _loadtl,
        "SPINDL": _spindl,
    },
    cycles=CYCLES,
    no_axis=NoAxis.Z,
    multax_off=NoAxis.Z,
    upright=_POST + "; if points and tool axes are in one system, write setting dialect=apt",
)
