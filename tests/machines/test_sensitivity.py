"""The derivative of the forward map by each geometry number, against differences of changed definitions."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings

from tests.support.examples import examples
from tests.support.machine_strategies import joints, machines
from trunnion.arrays import Floats
from trunnion.machines import Machine, forward, load_machine
from trunnion.machines.machine import Vector
from trunnion.machines.sensitivity import GeometryNumber, NumberKind, derivatives, idle_numbers

#: Half of the difference by which a number is changed: mm, or radians. Lengths act linearly.
_LENGTH = 0.5
_ANGLE = 2e-5

_LENGTH_OF_TOOL = 137.5


def turned(vector: Vector, component: str, angle: float) -> Vector:
    """A vector turned about X, Y or Z, by its two other coordinates."""
    k = "XYZ".index(component)
    i, j = (k + 1) % 3, (k + 2) % 3
    new = list(vector)
    new[i] = vector[i] * math.cos(angle) - vector[j] * math.sin(angle)
    new[j] = vector[i] * math.sin(angle) + vector[j] * math.cos(angle)
    return new[0], new[1], new[2]


def shifted(vector: Vector, component: str, by: float) -> Vector:
    new = list(vector)
    new["XYZ".index(component)] += by
    return new[0], new[1], new[2]


def changed(machine: Machine, number: GeometryNumber, by: float) -> Machine:
    """The definition with another number."""
    at = number.component
    if number.axis:
        column = machine.column(number.axis)
        axis = machine.axes[column]
        if number.kind is NumberKind.POINT:
            axis = replace(axis, point=shifted(axis.point, at, by))
        else:
            axis = replace(axis, direction=turned(axis.direction, at, by))
        return replace(machine, axes=(*machine.axes[:column], axis, *machine.axes[column + 1 :]))
    match number.kind:
        case NumberKind.GAUGE_POINT:
            return replace(machine, spindle_point=shifted(machine.spindle_point, at, by))
        case NumberKind.SPINDLE:
            return replace(machine, spindle_direction=turned(machine.spindle_direction, at, by))
        case NumberKind.TOOL_LENGTH:
            return replace(machine, tool_length=(machine.tool_length or 0.0) + by)
        case _:
            return replace(machine, workpiece_zero=shifted(machine.workpiece_zero or (0.0, 0.0, 0.0), at, by))


def difference(machine: Machine, number: GeometryNumber, values: Floats) -> tuple[Floats, Floats]:
    """Tip and tool axis by one number: central differences of the forward map."""
    step = _ANGLE if number.is_angle else _LENGTH
    if number.kind is NumberKind.READING:
        more, less = values.copy(), values.copy()
        more[:, machine.column(number.axis)] += math.degrees(step)
        less[:, machine.column(number.axis)] -= math.degrees(step)
        high, low = forward(machine, more), forward(machine, less)
    else:
        high = forward(changed(machine, number, step), values)
        low = forward(changed(machine, number, -step), values)
    return (high[0] - low[0]) / (2.0 * step), (high[1] - low[1]) / (2.0 * step)


@settings(deadline=None, max_examples=examples(60))
@given(machines(), joints)
def test_derivatives_are_those_of_the_forward_map_with_another_definition(
    machine: Machine, values: list[float]
) -> None:
    machine = replace(machine, tool_length=_LENGTH_OF_TOOL)
    rows = np.array([values, [0.5 * value + 10.0 for value in values]])
    for found in derivatives(machine, rows):
        tip, axis = difference(machine, found.number, rows)
        # Angles move the tip by its distance, which is some metres on these machines.
        size = 1e3 if found.number.is_angle else 1.0
        assert found.tip == pytest.approx(tip, rel=1e-6, abs=1e-6 * size), found.number.name
        assert found.axis == pytest.approx(axis, rel=1e-6, abs=1e-6), found.number.name


@settings(deadline=None, max_examples=examples(60))
@given(machines(), joints)
def test_numbers_that_are_left_out_move_nothing(machine: Machine, values: list[float]) -> None:
    machine = replace(machine, tool_length=_LENGTH_OF_TOOL)
    rows = np.array([values])
    told = [found.number for found in derivatives(machine, rows)]
    for number in idle_numbers(machine):
        tip, axis = difference(machine, number, rows)
        assert np.abs(tip).max() < 1e-4
        assert np.abs(axis).max() < 1e-6
        assert number not in told


@given(machines())
@settings(deadline=None, max_examples=examples(40))
def test_every_number_is_either_derived_or_idle(machine: Machine) -> None:
    told = [found.number.name for found in derivatives(machine, np.zeros((1, 5)))]
    told += [number.name for number in idle_numbers(machine)]
    # Two rotary axes with points, directions and angles; three slides; gauge point, spindle, length, zero.
    assert len(told) == len(set(told)) == 2 * 7 + 3 * 3 + 3 + 3 + 1 + 3


def test_by_hand_a_table_off_its_centre() -> None:
    """C of a table-table machine half a turn round: a centre that is 0.01 mm off puts the part 0.02 mm off."""
    machine = load_machine("dmu65")
    found = {each.number.name: each for each in derivatives(machine, np.array([[180.0, 0.0, 20.0, 0.0, 100.0]]))}
    assert machine.names == ("C", "A", "X", "Y", "Z")
    assert found["C point X"].tip == pytest.approx(np.array([[2.0, 0.0, 0.0]]))
    assert "C point Z" not in found
    assert found["A point Y"].tip == pytest.approx(np.zeros((1, 3)))  # A has not turned
    # Half a turn back about Z takes +X to -X.
    assert found["gauge point X"].tip == pytest.approx(np.array([[-1.0, 0.0, 0.0]]))
    assert found["tool length"].tip == pytest.approx(np.array([[0.0, 0.0, -1.0]]))
    assert found["workpiece zero Z"].tip == pytest.approx(np.array([[0.0, 0.0, -1.0]]))


def test_by_hand_a_head_whose_angle_is_off() -> None:
    """At zero a B of a head moves the tip by tool length and pivot length together, and its axis by the angle."""
    machine = replace(load_machine("yl569"), tool_length=100.0)
    b = machine.axis("B")
    arm = np.array(machine.spindle_point) - 100.0 * np.array(machine.spindle_direction) - np.array(b.point)
    found = {each.number.name: each for each in derivatives(machine, np.zeros((1, 5)))}
    line = b.sense * np.array(b.direction)
    assert found["B displayed angle"].tip[0] == pytest.approx(np.cross(line, arm))
    assert np.linalg.norm(found["B displayed angle"].axis[0]) == pytest.approx(1.0)
