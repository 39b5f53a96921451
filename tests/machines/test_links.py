"""Where the links of a machine stand, against the forward map."""

import numpy as np
import pytest
from hypothesis import given, settings

from tests.support.examples import examples
from tests.support.machine_strategies import joints, machines
from trunnion.machines import Machine, forward, load_machine, shipped_machines
from trunnion.machines.links import axes_between, carrier, link_transforms


def tool_at_workpiece(machine: Machine, values: list[float]) -> tuple[np.ndarray, np.ndarray]:
    """Tip and tool axis in workpiece coordinates, by way of workpiece and spindle in the machine frame."""
    links = link_transforms(machine, np.array([values]))
    seen = np.linalg.inv(links["workpiece"][0]) @ links["spindle"][0]
    tip = seen @ np.array([*machine.spindle_point, 1.0])
    zero = np.array(machine.workpiece_zero or (0.0, 0.0, 0.0))
    return tip[:3] - zero, seen[:3, :3] @ np.array(machine.spindle_direction)


@given(machines(), joints)
@settings(max_examples=examples(60), deadline=None)
def test_spindle_and_workpiece_give_tip_and_tool_axis(machine: Machine, values: list[float]) -> None:
    tip, axis = forward(machine, np.array([values]))
    found_tip, found_axis = tool_at_workpiece(machine, values)
    np.testing.assert_allclose(found_tip, tip[0], atol=1e-8)
    np.testing.assert_allclose(found_axis, axis[0], atol=1e-12)


@pytest.mark.third
@pytest.mark.parametrize("name", shipped_machines())
def test_links_of_shipped_machines_agree_with_the_forward_map(name: str) -> None:
    machine = load_machine(name)
    for values in np.random.default_rng(5).uniform(-400.0, 400.0, (5, 5)):
        tip, axis = forward(machine, values[None])
        found_tip, found_axis = tool_at_workpiece(machine, values.tolist())
        np.testing.assert_allclose(found_tip, tip[0], atol=1e-8)
        np.testing.assert_allclose(found_axis, axis[0], atol=1e-12)


@given(machines(), joints)
@settings(max_examples=examples(25), deadline=None)
def test_an_axis_moves_what_stands_on_it_and_nothing_below(machine: Machine, values: list[float]) -> None:
    still, moved = np.array([values]), np.array([values])
    for column, axis in enumerate(machine.axes):
        moved[:] = still
        moved[0, column] += 7.0
        before, after = link_transforms(machine, still), link_transforms(machine, moved)
        for link in (*machine.names, "bed"):
            goes = bool(np.abs(before[link] - after[link]).max() > 1e-9)
            assert goes == (column in axes_between(machine, link, "bed")), (link, axis.name)


def test_the_links_of_a_yl569_are_those_of_its_table_and_its_head() -> None:
    machine = load_machine("yl569")
    assert (carrier(machine, "workpiece"), carrier(machine, "spindle"), carrier(machine, "bed")) == ("C", "Z", "bed")
    assert [machine.names[k] for k in axes_between(machine, "B", "spindle")] == ["B", "X", "Y", "Z"]
    assert [machine.names[k] for k in axes_between(machine, "spindle", "X")] == ["Z", "Y", "X"]
    with pytest.raises(KeyError):
        carrier(machine, "A")
    # X + 100 takes the table, which carries the part, to -X; Z + 50 takes the head up.
    links = link_transforms(machine, np.array([[0.0, 0.0, 100.0, 0.0, 50.0]]))
    np.testing.assert_allclose(links["workpiece"][0, :3, 3], [-100.0, 0.0, 0.0])
    np.testing.assert_allclose(links["spindle"][0, :3, 3], [0.0, 0.0, 50.0])
