"""A run as it would be with another workpiece zero and another tool length, where nobody has stated them.

In:     a run, read with a zero and a length of 0 in place of those that are not known.
Out:    the same run with nominal ones.

Two programs do the same only if they do so wherever the workpiece stands and however long the tool is. With a zero in
the middle of the table a position in a tilted plane and one of the linear axes are the same place. No second run is
read: the positions of linear axes move with the zero and the length.
"""

from dataclasses import replace
from typing import Final

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.machines import Machine
from trunnion.machines.inverse import kinematic_parameters
from trunnion.messages import Wording
from trunnion.model.axis_positions import joints_from_rows
from trunnion.model.run import Run
from trunnion.model.run_columns import BY_PARAMETER
from trunnion.model.stated_tips import turns_without_tcp
from trunnion.model.toolpath import Kind
from trunnion.verification.kinematics.machine_positions import MachinePositions

#: What stands for values that nobody has stated, mm: in no direction in the middle of anything.
ZERO: Final = (137.0, -91.0, 53.0)
LENGTH: Final = 100.0

#: Tips that move by less do not depend on these values, mm.
_STILL: Final = 1e-6


def missing_values(machine: Machine) -> list[Wording]:
    """Return the nominal values of what nobody has stated."""
    no_zero, no_length = _missing(machine)
    zero = Wording("comparison", "zero", values=tuple(f"{value:g}" for value in ZERO))
    length = Wording("comparison", "length", length=LENGTH)
    return [*([zero] if no_zero else []), *([length] if no_length else [])]


def cuts_by_place(run: Run) -> bool:
    """Whether the tip of a cut depends on where the workpiece stands and how long the tool is, which nobody stated:
    at its end, or on the way to it where the axes go straight between tips that blocks state (M114).
    """
    if _bends_by_place(run):
        return True
    other = with_nominal_values(run)
    if other is run:
        return False
    rows = np.flatnonzero((run.kind != Kind.RAPID) & ~run.state.machine_frame.column())
    return bool((np.abs(other.tip[rows] - run.tip[rows]) > _STILL).any())


def _bends_by_place(run: Run) -> bool:
    machine = run.machine
    no_zero, no_length = _missing(machine)
    if not (no_zero or (no_length and machine.has_rotary_head)):
        return False
    rows = np.flatnonzero((run.kind == Kind.LINEAR) & run.state.xyz_is_tip.column())
    return bool(turns_without_tcp(run, rows).any())


def with_nominal_values(run: Run) -> Run:
    """Return a run with nominal values in place of those not stated; itself if no tip depends on them."""
    machine = run.machine
    no_zero, no_length = _missing(machine)
    rows = np.flatnonzero(~run.state.xyz_is_tip.column() & ~run.state.machine_frame.column())
    if not (no_zero or no_length) or not len(rows):
        return run
    nominal = replace(
        machine,
        workpiece_zero=ZERO if no_zero else machine.workpiece_zero,
        tool_length=LENGTH if no_length else machine.tool_length,
    )
    xyz = run.xyz.copy()
    xyz[rows] += _moved_axes(run, nominal, rows)
    moved = replace(run, machine=nominal, xyz=xyz)
    away = moved.tip - run.tip
    if (np.abs(away[rows]) <= _STILL).all():
        return run
    arcs = replace(run.arcs, centre=run.arcs.centre + away[run.arcs.row])
    return replace(moved, arcs=arcs)


def _moved_axes(run: Run, nominal: Machine, rows: Ints) -> Floats:
    """How far linear axes X, Y, Z are elsewhere in rows with nominal values, (k, 3); 0 where machine coordinates put
    them.
    """
    moved = np.tile(_zero_of(nominal) - _zero_of(run.machine), (len(rows), 1))
    if run.machine.tool_length is None:
        along = run.state.length_axis.at(rows)
        counts = np.flatnonzero(along >= 0)
        moved[counts, along[counts] % BY_PARAMETER] += nominal.tool_length or 0.0
    columns = [run.machine.column(name) for name in "XYZ"]
    moved[MachinePositions.of(run).at(rows)[:, columns]] = 0.0
    return moved


def _missing(machine: Machine) -> tuple[bool, bool]:
    """Whether nobody has stated a workpiece zero, and a tool length."""
    return (
        machine.workpiece_zero is None and not machine.zeros,
        machine.tool_length is None and not machine.tool_lengths,
    )


def _zero_of(machine: Machine) -> Floats:
    """Return where the linear axes stand at the workpiece zero without a tool, (3,) mm."""
    without_tool = replace(machine, tool_length=None)
    at_zero = np.ones(1, np.bool_), np.zeros((1, 3)), np.zeros((1, 2))
    joints = joints_from_rows(without_tool, kinematic_parameters(without_tool), *at_zero)[0]
    return np.asarray(np.nan_to_num(joints[[machine.column(name) for name in "XYZ"]]))
