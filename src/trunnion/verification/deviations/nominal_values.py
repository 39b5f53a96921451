"""What changes at the part if the tool were longer, or the workpiece zero elsewhere, and nobody has stated them.

In:     a run, and rows of it.
Out:    rows at which the tip moves with the length of the tool although it must not; and whether there are rows whose
        tip depends on a value that nobody has stated.

Where the program has positions of the tip, the control knows the length. Where it has positions of the linear axes, the
length is added along one of them, and the tip is right if that is the axis along which the tool points. No second run
is read: the same rows are evaluated with another length.
"""

from dataclasses import replace
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.machines import Machine, Mount, forward
from trunnion.messages import Wording
from trunnion.model.run import Run
from trunnion.model.run_columns import BY_PARAMETER
from trunnion.model.unknown_setups import stated_rows
from trunnion.records import dataclass

#: How much longer the tool is taken to be, mm.
LONGER: Final = 100.0

#: The tip stands if it moves by less than this, mm; rotary axes at less are at zero, degrees.
_STILL: Final = 1e-6

_NAMES: Final = "XYZ"


@dataclass(frozen=True, slots=True)
class MovedTip:
    """A row whose tip moves with the length of the tool: ``share`` of it."""

    row: int
    share: float
    said: Wording


def with_linear_positions(run: Run, rows: Ints) -> Ints:
    """Those of rows whose positions are those of the linear axes, counted from a work offset, (k,)."""
    return np.asarray(rows[~run.state.xyz_is_tip.at(rows) & ~run.state.machine_frame.at(rows)])


def moved_tips(run: Run, rows: Ints) -> list[MovedTip]:
    """Return the rows whose tip moves with the length because that counts along another axis than the tool.

    ``rows`` are some of ``with_linear_positions``.
    """
    axes, along = run.state.length_axis.at(rows), _along(run.machine)
    counts_somewhere = bool((run.state.length_axis.values >= 0).any())
    elsewhere = (axes != along) & (counts_somewhere | (axes >= 0))
    suspects = np.where(stated_rows(run)[1].at(rows), axes >= BY_PARAMETER, elsewhere)
    if not suspects.any():
        return []
    rows, axes = rows[suspects], axes[suspects]
    moved = zip(rows.tolist(), axes.tolist(), _moved(run, rows, axes).tolist(), strict=True)
    return [MovedTip(row, share, _said(axis, _NAMES[along])) for row, axis, share in moved if share > _STILL]


def depends_on_length(run: Run, rows: Ints) -> bool:
    """Whether a head turns the tool in one of these rows, and its length is not stated."""
    if not run.machine.has_rotary_head:
        return False
    return _turned(run, rows[~stated_rows(run)[1].at(rows)], Mount.TOOL)


def depends_on_zero(run: Run, rows: Ints) -> bool:
    """Whether a table turns the part in one of these rows, and the zero is not stated."""
    return _turned(run, rows[~stated_rows(run)[0].at(rows)], Mount.PART)


def _turned(run: Run, rows: Ints, mount: Mount) -> bool:
    columns = [k for k, column in enumerate(run.machine.rotary) if run.machine.axes[column].mount is mount]
    return bool((np.abs(run.rotary[rows][:, columns]) > _STILL).any()) if columns else False


def _along(machine: Machine) -> int:
    """Index of the linear axis along the tool, all axes at zero."""
    along = [abs(float(np.dot(machine.axis(name).direction, machine.spindle_direction))) for name in _NAMES]
    return int(np.argmax(along))


def _moved(run: Run, rows: Ints, axes: Ints) -> Floats:
    """How far the tip moves for each millimetre of length, (k,)."""
    machine = run.machine
    longer = replace(machine, tool_length=(machine.tool_length or 0.0) + LONGER)
    joints = run.positions(rows).joints
    shifted = joints.copy()
    counts: Flags = axes >= 0
    columns = np.array([machine.column(name) for name in _NAMES])[axes % BY_PARAMETER]
    shifted[np.flatnonzero(counts), columns[counts]] += LONGER
    away = forward(longer, shifted)[0] - forward(machine, joints)[0]
    return np.asarray(np.linalg.norm(away, axis=1) / LONGER)


def _said(axis: int, along: str) -> Wording:
    if axis < 0:
        return Wording("tip", "no_length_here", along=along)
    variant = "length_along_other"
    if axis >= BY_PARAMETER:
        variant = "length_by_parameter_or_z" if along == "Z" else "length_by_parameter"
    return Wording("tip", variant, axis=_NAMES[axis % BY_PARAMETER], along=along)
