"""Which kind of operation it is: three-axis, in a tilted plane, or simultaneous.

In:     an operation in the program's coordinate system, and the coordinate system that it had of its own.
Out:    how the machine is to make it, and its plane if it is tilted.

By rule: a tool axis that is +Z of the program throughout is three-axis, one that stands still otherwise is a tilted
plane, one that changes is simultaneous. A tilt that the control's own digits print as none is none. The user's word
is stronger than the rule. A tilted plane for which the control has no words is made as a simultaneous operation, where
it has words for that.
"""

from dataclasses import replace
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.errors import Problem, Severity
from trunnion.machines import Machine, forward
from trunnion.model.frames import frame_from_vectors
from trunnion.model.motion import MachiningMode
from trunnion.model.toolpath import Frame, Operation
from trunnion.planning.options import ControlCapabilities, PlanOptions

_UP: Final = np.array([0.0, 0.0, 1.0])

#: Tool axes are the same when no component differs by more than this; CL files print seven decimals or more.
_SAME_AXIS = 1e-7

#: A coordinate system stands on the tool axis when they differ by no more than this sine; seven decimals twice.
_PARALLEL_SINE = 1e-6

#: Decimals of a plane's origin, mm: any point of the plane serves, so that it is one which prints whole.
_ORIGIN_DECIMALS = 4

#: X of the program is too close to the tool axis to point the way in the plane below this sine.
_MIN_SINE = 1e-3


def mode_of(operation: Operation, requested: MachiningMode | None, negligible_tilt: float = 0.0) -> MachiningMode:
    """How an operation is to be made; ``requested``: the user's word, or None; ``negligible_tilt`` as in
    ``ControlCapabilities``."""
    if requested is not None:
        return requested
    axis = operation.moves.axis
    if not _is_constant(axis, axis[0]):
        return MachiningMode.TCP
    upright = _is_constant(axis[:1], _UP) or (
        axis[0, 2] > 0.0 and float(np.hypot(axis[0, 0], axis[0, 1])) < negligible_tilt
    )
    return MachiningMode.THREE_AXIS if upright else MachiningMode.TILTED


def with_exact_upright_axis(operation: Operation) -> Operation:
    """A three-axis operation with its tool axis right on +Z, from which it is off by what nobody prints."""
    moves = operation.moves
    if (moves.axis[0] == _UP).all() and (moves.axis == _UP).all():
        return operation
    return replace(operation, moves=replace(moves, axis=np.tile(_UP, (len(moves), 1))))


def supported_mode(
    file: str, operation: Operation, mode: MachiningMode, options: PlanOptions, capabilities: ControlCapabilities
) -> tuple[MachiningMode, list[Problem]]:
    """The mode in which the control can make an operation, with a warning if that is not the mode by the rule."""
    replaceable = options.mode_for(operation.name) is None and options.simultaneous_mode in capabilities.modes
    if mode is MachiningMode.TILTED and mode not in capabilities.modes and replaceable:
        what = f"operation {operation.name} stands in a {mode}, for which the control has no words"
        how = f"it is made {'with TCP' if options.tcp else 'without TCP'}"
        return options.simultaneous_mode, [Problem(file, operation.line, what, how, Severity.WARNING)]
    return options.simultaneous_mode if mode is MachiningMode.TCP else mode, []


def mode_conflicts(
    file: str, operation: Operation, mode: MachiningMode, capabilities: ControlCapabilities
) -> list[Problem]:
    """Why an operation cannot be made in a mode, whether the control lacks it or the tool axis does not fit it."""
    modes = capabilities.modes
    axis, line = operation.moves.axis, operation.moves.line
    if mode not in modes:
        what = f"operation {operation.name}: the control has no words for {mode}"
        cure = capabilities.mode_remedies.get(mode, f"it has words for {', '.join(sorted(modes))}")
        return [Problem(file, operation.line, what, cure)]
    if mode is MachiningMode.THREE_AXIS:
        expected, what = _UP, "the tool axis is not +Z of the program, and mode is three-axis"
    elif mode is MachiningMode.TILTED:
        expected, what = axis[0], "the tool axis changes, and mode is tilted"
    else:
        return []
    off = max(_SAME_AXIS, capabilities.negligible_tilt if mode is MachiningMode.THREE_AXIS else 0.0)
    wrong = np.flatnonzero(np.abs(axis - expected).max(axis=1) > off)
    cure = "leave the setting mode out, or split the operation"
    return [Problem(file, int(line[wrong[0]]), f"operation {operation.name}: {what}", cure)] if len(wrong) else []


def tilted_plane(axis: Floats, own_frame: Frame, along: Floats | None = None) -> Frame:
    """The tilted plane under a tool axis, in the program's coordinate system.

    Parameters
    ----------
    axis : (3,) float64
        The tool axis, which becomes exactly the plane's Z.
    own
        The operation's own coordinate system. If it stands on the tool axis, the plane has its origin and its X;
        otherwise the program's zero, and X as ``along`` falls onto the plane.
    along : (3,) float64, optional
        A direction; without it that of the program's X.
    """
    if (
        float(np.linalg.norm(np.cross(own_frame.matrix()[:, 2], axis))) < _PARALLEL_SINE
        and own_frame.matrix()[:, 2] @ axis > 0.0
    ):
        y, origin = np.cross(axis, np.array(own_frame.x)), np.array(own_frame.origin)
    else:
        y, origin = np.cross(axis, [1.0, 0.0, 0.0] if along is None else along), np.zeros(3)
        if float(np.linalg.norm(y)) < _MIN_SINE:
            y = np.cross(axis, [0.0, 0.0, -1.0])
    y = y / np.linalg.norm(y)
    return frame_from_vectors(np.round(origin, _ORIGIN_DECIMALS) + 0.0, np.cross(y, axis), y)


def machine_x_direction(machine: Machine, rotary: Floats) -> Floats:
    """(3,): the machine's X as the workpiece sees it, with the rotary axes at positions (2,), degrees."""
    joints = np.zeros((2, len(machine.axes)))
    joints[:, list(machine.rotary)] = rotary
    joints[1, machine.column("X")] = 1.0
    tip, _ = forward(machine, joints)
    return np.asarray(tip[1] - tip[0])


def _is_constant(axis: Floats, expected: Floats) -> bool:
    if np.abs(axis[-1] - expected).max() > _SAME_AXIS:  # the usual case decides itself without looking at all rows
        return False
    return bool(np.abs(axis - expected).max() <= _SAME_AXIS)
