"""The machining mode of an operation, and its plane if it is tilted.

In:     an operation in the program's coordinate system, and its own coordinate system.
Out:    its mode, and the tilted plane.

By rule, a tool axis along +Z of the program throughout is three-axis, any other constant one is a tilted plane, and one
that changes is simultaneous: with TCP, or without. A tilt that the control's rotary words print as zero counts as none.
The user's setting takes precedence over the rule. A tilted plane is made as a simultaneous operation if the control
supports only that.
"""

from dataclasses import replace
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.errors import Problem, warning
from trunnion.machines import Machine, forward
from trunnion.messages import Wording
from trunnion.model.frames import frame_from_vectors
from trunnion.model.motion import MachiningMode
from trunnion.model.toolpath import Frame, Operation
from trunnion.planning.options import ControlCapabilities, PlanOptions

_UP: Final = np.array([0.0, 0.0, 1.0])

#: Tool axes are the same if no component differs by more than this; CL files print seven decimals or more.
_SAME_AXIS: Final = 1e-7

#: Z of a coordinate system is the tool axis within this sine: both are printed with seven decimals.
_PARALLEL_SINE: Final = 1e-6

#: Decimals of a plane's origin, mm. Any point of the plane can be its origin, so one is taken that prints exactly.
_ORIGIN_DECIMALS: Final = 4

#: Below this sine of the angle between X and the tool axis, X is no use as X of the plane.
_MIN_SINE: Final = 1e-3


def mode_of(operation: Operation, requested: MachiningMode | None, negligible_tilt: float = 0.0) -> MachiningMode:
    """Return the mode of an operation: the ``requested`` one, or else that by rule.

    ``negligible_tilt`` as in ``ControlCapabilities``.
    """
    if requested is not None:
        return requested
    axis = operation.moves.axis
    if not _is_constant(axis, axis[0]):
        return MachiningMode.TCP
    tilt = float(np.hypot(axis[0, 0], axis[0, 1]))
    is_upright = _is_constant(axis[:1], _UP) or (axis[0, 2] > 0.0 and tilt < negligible_tilt)
    return MachiningMode.THREE_AXIS if is_upright else MachiningMode.TILTED


def with_exact_upright_axis(operation: Operation) -> Operation:
    """Return a three-axis operation with its tool axis exactly along +Z; it may be off by a tilt that prints
    as zero.
    """
    moves = operation.moves
    if (moves.axis[0] == _UP).all() and (moves.axis == _UP).all():
        return operation
    return replace(operation, moves=replace(moves, axis=np.tile(_UP, (len(moves), 1))))


def supported_mode(
    file: str, operation: Operation, mode: MachiningMode, options: PlanOptions, capabilities: ControlCapabilities
) -> tuple[MachiningMode, list[Problem]]:
    """Return the mode in which the control can make an operation, with a warning if it is not ``mode``."""
    replaceable = options.mode_for(operation.name) is None and options.simultaneous_mode in capabilities.modes
    if mode is MachiningMode.TILTED and mode not in capabilities.modes and replaceable:
        return options.simultaneous_mode, [
            warning(
                file,
                operation.line,
                Wording("PLN320", "operation_control_does", operation=operation.name, mode=mode)
                if options.tcp
                else Wording("PLN320", "operation_control_does_not", operation=operation.name, mode=mode),
            )
        ]
    return options.simultaneous_mode if mode is MachiningMode.TCP else mode, []


def mode_conflicts(
    file: str, operation: Operation, mode: MachiningMode, capabilities: ControlCapabilities
) -> list[Problem]:
    """Why an operation cannot be made in a mode: the control does not support it, or the tool axis does not fit it."""
    axis, line = operation.moves.axis, operation.moves.line
    if mode not in capabilities.modes:
        remedy = capabilities.mode_remedies.get(mode)
        if remedy:
            wording = Wording("PLN310", "not_supported_but", operation=operation.name, mode=mode, remedy=remedy)
        else:
            known = tuple(sorted(capabilities.modes))
            wording = Wording("PLN310", "not_supported", operation=operation.name, mode=mode, known=known)
        return [Problem(file, operation.line, wording)]
    if mode is MachiningMode.THREE_AXIS:
        expected, variant = _UP, "not_upright"
    elif mode is MachiningMode.TILTED:
        expected, variant = axis[0], "changes"
    else:
        return []
    tolerance = max(_SAME_AXIS, capabilities.negligible_tilt if mode is MachiningMode.THREE_AXIS else 0.0)
    wrong = np.flatnonzero(np.abs(axis - expected).max(axis=1) > tolerance)
    return (
        [Problem(file, int(line[wrong[0]]), Wording("PLN330", variant, operation=operation.name))] if len(wrong) else []
    )


def tilted_plane(axis: Floats, own_frame: Frame, x_direction: Floats | None = None) -> Frame:
    """Return the tilted plane under a tool axis, in the program's coordinate system.

    axis         (3,) float64: the tool axis, which becomes exactly the plane's Z
    own_frame    the operation's own coordinate system. If its Z is the tool axis, the plane has its origin and its X;
                 otherwise the program's zero, and as X the projection of ``x_direction``
    x_direction  (3,) float64, optional: by default X of the program
    """
    own_z = own_frame.matrix()[:, 2]
    if float(np.linalg.norm(np.cross(own_z, axis))) < _PARALLEL_SINE and own_z @ axis > 0.0:
        y, origin = np.cross(axis, np.array(own_frame.x)), np.array(own_frame.origin)
    else:
        y, origin = np.cross(axis, [1.0, 0.0, 0.0] if x_direction is None else x_direction), np.zeros(3)
        if float(np.linalg.norm(y)) < _MIN_SINE:
            y = np.cross(axis, [0.0, 0.0, -1.0])
    y = y / np.linalg.norm(y)
    return frame_from_vectors(np.round(origin, _ORIGIN_DECIMALS) + 0.0, np.cross(y, axis), y)


def machine_x_direction(machine: Machine, rotary: Floats) -> Floats:
    """(3,) float64: the machine's X seen from the workpiece, at rotary positions (2,), degrees."""
    joints = np.zeros((2, len(machine.axes)))
    joints[:, list(machine.rotary)] = rotary
    joints[1, machine.column("X")] = 1.0
    tip, _ = forward(machine, joints)
    return np.asarray(tip[1] - tip[0])


def _is_constant(axis: Floats, expected: Floats) -> bool:
    """Whether all tool axes (n, 3) are the expected one."""
    if np.abs(axis[-1] - expected).max() > _SAME_AXIS:  # usually the last row decides without a look at the others
        return False
    return bool(np.abs(axis - expected).max() <= _SAME_AXIS)
