"""Tool axes of an operation: those of its points, and of statements about points that give none.

In:     the columns with a vector or NaN in each row, and what the statements said.
Out:    a unit vector in each row, and the FROM events with theirs.
"""

import numpy as np

from trunnion.arrays import Floats
from trunnion.cl.builder import AxisStatement, FromStatement, MoveColumns, NoAxis, OperationBuilder
from trunnion.cl.diagnostics import MAX_LISTED, Diagnostics
from trunnion.cl.scan import fill_modal_axes
from trunnion.messages import Wording
from trunnion.model.toolpath import From

#: A tool axis no farther off (0, 0, 1) than this is taken for it.
_UPRIGHT = 1e-6

_Z = np.array([0.0, 0.0, 1.0])


def fill_tool_axes(
    columns: MoveColumns, builder: OperationBuilder, unit: float, modal_axis: Floats, diagnostics: Diagnostics
) -> list[From]:
    """Write the tool axis into each row; return the FROM events with theirs.

    unit        length unit of the file, mm
    modal_axis  (3,) float64, the tool axis of the row before, if the operation continues; on return that of its end
    """
    if not builder.continues:
        modal_axis[:] = _Z
    events = []
    no_axis, vectors = NoAxis.MODAL, True
    at = builder.first
    statements: list[FromStatement | AxisStatement] = [*builder.starts, *builder.axes]
    statements.sort(key=lambda statement: (statement.row, statement.line))
    for statement in statements:
        stop = min(builder.first + statement.row, builder.stop)
        _check_vectors(columns, at, stop, vectors, modal_axis, diagnostics)
        _fill(columns, at, stop, no_axis, modal_axis, diagnostics)
        at = stop
        if statement.axis:
            _set_axis(statement.axis, statement.line, modal_axis, diagnostics)
        if isinstance(statement, AxisStatement):
            no_axis, vectors = statement.no_axis, statement.vectors
        else:
            x, y, z = statement.tip
            i, j, k = modal_axis.tolist()
            events.append(From(statement.row, statement.line, (x * unit, y * unit, z * unit), (i, j, k)))
    _check_vectors(columns, at, builder.stop, vectors, modal_axis, diagnostics)
    _fill(columns, at, builder.stop, no_axis, modal_axis, diagnostics)
    if builder.tilted:
        _check_upright(columns, builder, diagnostics)
    for row, line, word in builder.upright:
        if row < builder.stop and not _is_upright(columns.axis[row]):
            diagnostics.error(line, Wording("CL550", "tilted_tool_axis", word=word))
    return events


def _check_vectors(
    columns: MoveColumns, begin: int, stop: int, vectors: bool, modal_axis: Floats, diagnostics: Diagnostics
) -> None:
    """Refuse what rows ``begin:stop`` give behind their points, if it need not be a tool axis; the same one may be."""
    if vectors:
        return
    axis = columns.axis[begin:stop]
    others = np.flatnonzero(np.abs(axis - modal_axis).max(axis=1, initial=0.0) > _UPRIGHT)
    for row in others[:1].tolist():
        diagnostics.error(int(columns.line[begin + row]), Wording("CL530", "three_more_numbers"))


def _fill(
    columns: MoveColumns, begin: int, stop: int, no_axis: NoAxis, modal_axis: Floats, diagnostics: Diagnostics
) -> None:
    """Fill rows ``begin:stop``, in which points without a tool axis have that of ``no_axis``."""
    axis = columns.axis
    bare = np.flatnonzero(np.isnan(axis[begin:stop, 0])) + begin if no_axis is not NoAxis.MODAL else None
    if bare is not None and no_axis is NoAxis.Z:
        axis[bare] = _Z
    bad_rows = np.empty(MAX_LISTED + 1, np.int64)
    bad_count = fill_modal_axes(axis, begin, stop, modal_axis, bad_rows)
    for row in bad_rows[: min(bad_count, len(bad_rows))].tolist():
        _report_bad_axis(axis[row], int(columns.line[row]), diagnostics)
    if bare is None or no_axis is NoAxis.Z:
        return
    for row in bare[: MAX_LISTED + 1].tolist():
        if no_axis is NoAxis.NEVER:
            diagnostics.error(int(columns.line[row]), Wording("CL530", "point_without_tool"))
        elif not _is_upright(axis[row]):
            never = no_axis is NoAxis.UPRIGHT
            said = Wording("CL530", "line_behind_tilted") if never else Wording("CL530", "point_without_tool_axis")
            diagnostics.error(int(columns.line[row]), said)
            return


def _check_upright(columns: MoveColumns, builder: OperationBuilder, diagnostics: Diagnostics) -> None:
    """Refuse a tilted tool axis where the file does not give the coordinates of such points."""
    tilted = np.flatnonzero(np.abs(columns.axis[builder.first : builder.stop] - _Z).max(axis=1, initial=0.0) > _UPRIGHT)
    for row in tilted[:1].tolist():
        diagnostics.error(
            int(columns.line[builder.first + row]), Wording("CL550", "plane_not_given", cure=builder.tilted)
        )


def _is_upright(axis: Floats) -> bool:
    return bool(np.abs(axis - _Z).max() <= _UPRIGHT)


def _set_axis(given: tuple[float, float, float], line: int, modal_axis: Floats, diagnostics: Diagnostics) -> None:
    """Make ``modal_axis`` (3,) the tool axis that a statement gives."""
    vector = np.array([given])
    if fill_modal_axes(vector, 0, 1, modal_axis, np.empty(1, np.int64)):
        _report_bad_axis(vector[0], line, diagnostics)


def _report_bad_axis(vector: Floats, line: int, diagnostics: Diagnostics) -> None:
    length = float(np.sqrt(np.sum(vector * vector)))
    diagnostics.error(
        line,
        Wording("CL540", "tool_axis_vector")
        if length == 0
        else Wording("CL540", "tool_axis_vector_length", length=length),
    )
