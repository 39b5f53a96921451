"""Passes by the pole of a machine."""

import math
from dataclasses import replace

import numpy as np
from hypothesis import strategies as st

from tests.support.machines import five_axis_machines
from tests.support.operations import moves_of, operation_of, rapids_at
from trunnion.arrays import Floats
from trunnion.machines import Machine, kinematic_parameters, load_machine
from trunnion.model.toolpath import Operation


def with_speeds(name: str) -> Machine:
    """A shipped machine; rotary axes of unknown speed get 3600 degrees/min."""
    machine = load_machine(name)
    axes = (replace(axis, rapid=axis.rapid or 3600.0) if axis.is_rotary else axis for axis in machine.axes)
    return replace(machine, axes=tuple(axes))


MACHINES = {name: with_speeds(name) for name in five_axis_machines()}


def pole_of(machine: Machine) -> Floats:
    """The tool axis along the first rotary axis, on the side where the spindle is at zero."""
    line = np.array(kinematic_parameters(machine).basis_1[6:])
    return line if line @ np.array(machine.spindle_direction) >= 0.0 else -line


def around_pole(machine: Machine, x: Floats, y: Floats) -> Floats:
    """(n, 3) tool axes x and y degrees off the pole, in two directions across it."""
    line = pole_of(machine)
    across = np.cross(line, np.eye(3)[int(np.argmin(np.abs(line)))])
    across /= np.linalg.norm(across)
    axis = line + np.tan(np.radians(x))[:, None] * across + np.tan(np.radians(y))[:, None] * np.cross(line, across)
    return np.asarray(axis / np.linalg.norm(axis, axis=1, keepdims=True))


@st.composite
def passes(draw: st.DrawFn, machine: Machine) -> Operation:
    """One or two passes by the pole, more or less near, straight or curved, slow or fast; some rapids."""
    n = draw(st.integers(20, 160))
    along = np.linspace(-draw(st.floats(0.3, 6.0)), draw(st.floats(0.3, 6.0)), n)
    off = draw(st.sampled_from([0.0, 0.01, 0.05, 0.2]) | st.floats(0.0, 1.0)) + draw(st.floats(-0.1, 0.1)) * along**2
    if draw(st.booleans()):
        along, off = np.concatenate((along, along[::-1])), np.concatenate((off, -off[::-1]))
    turn = draw(st.floats(0.0, 2.0 * math.pi))
    x, y = along * math.cos(turn) - off * math.sin(turn), along * math.sin(turn) + off * math.cos(turn)
    tip = np.column_stack((draw(st.floats(0.5, 5.0)) * along, off, np.zeros(len(along))))
    moves = moves_of(tip, around_pole(machine, x, y))
    moves = replace(moves, feed=np.full(len(moves), draw(st.floats(50.0, 5000.0))))
    return operation_of(rapids_at(moves, [row for row in range(len(moves)) if draw(st.integers(0, 60)) == 0]))
