"""A mistake in the loader is found, also where everything that writes and proves a program would share it."""

import csv
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Final

import numpy as np
import pytest

from tests.support import machine_mutants
from tests.support.fifty_machines import CONTRADICTIONS, ROWS, load
from tests.support.known_poses import FACTS, LENGTH, POSES, SLIDES, check_facts, check_known_poses
from tests.support.locations import DOCS, TESTS
from tests.support.machines import five_axis_machines
from trunnion.definitions import Table, load_table
from trunnion.errors import InputError
from trunnion.machines import (
    Axis,
    Machine,
    Mount,
    PositiveDirection,
    PreferredSign,
    forward,
    load_machine,
    loading,
)
from trunnion.machines.jog_table import rotary_pose

THIRD_PARTY: Final = {
    row["name"]: row for row in csv.DictReader((TESTS / "data" / "machine_poses.csv").open(newline=""))
}


def is_caught(machine: Machine) -> bool:
    """Whether the literal numbers notice that a machine is not what it is known to be."""
    try:
        check_facts(machine)
        check_known_poses(machine)
    except (AssertionError, KeyError):
        return True
    return False


def test_every_shipped_machine_has_known_poses_and_facts() -> None:
    assert set(POSES) == set(FACTS) == set(five_axis_machines())


@pytest.mark.parametrize("key", five_axis_machines())
def test_the_tool_is_where_it_is_known_to_be(key: str) -> None:
    check_known_poses(load_machine(key))
    check_facts(load_machine(key))


def all_mutants() -> list[tuple[str, str, Machine]]:
    return [
        (key, name, machine)
        for key in five_axis_machines()
        for name, machine in machine_mutants.mutants(load_machine(key))
    ]


def test_every_mistake_in_a_machine_is_caught() -> None:
    made = all_mutants()
    assert [(key, name) for key, name, machine in made if not is_caught(machine)] == []
    assert len(made) > 40 * len(POSES)
    told = " ".join((DOCS / "checks.md").read_text(encoding="utf-8").split())
    assert f"Of {len(made)} mistakes in the {len(POSES)} shipped machines" in told


def on_axes(mutate: Callable[[Axis], Axis], which: Callable[[Axis], bool] = lambda _: True) -> Callable[..., Axis]:
    """The loader's function for an axis with a mistake in it."""
    original = loading._axis

    def read(entry: Table) -> Axis:
        axis = original(entry)
        return mutate(axis) if which(axis) else axis

    return read


def negated(function: Callable[..., machine_mutants.Vector]) -> Callable[..., machine_mutants.Vector]:
    return lambda *arguments: machine_mutants.negative(function(*arguments))


def rolled(function: Callable[..., machine_mutants.Vector]) -> Callable[..., machine_mutants.Vector]:
    def read(*arguments: object) -> machine_mutants.Vector:
        x, y, z = function(*arguments)
        return z, x, y

    return read


#: Mistakes in the loader: the function with the mistake, and how to make it.
LOADER_MUTANTS: Final[dict[str, tuple[str, Callable[[], object]]]] = {
    "all senses": ("_axis", lambda: on_axes(machine_mutants.flip_sense)),
    "senses of tables": ("_axis", lambda: on_axes(machine_mutants.flip_sense, lambda a: a.mount is Mount.PART)),
    "senses of heads": ("_axis", lambda: on_axes(machine_mutants.flip_sense, lambda a: a.mount is Mount.TOOL)),
    "senses of rotary axes": ("_axis", lambda: on_axes(machine_mutants.flip_sense, lambda a: a.is_rotary)),
    "senses of slides": ("_axis", lambda: on_axes(machine_mutants.flip_sense, lambda a: not a.is_rotary)),
    "reversed is ignored": (
        "_axis",
        lambda: on_axes(lambda a: replace(a, positive=PositiveDirection.STANDARD)),
    ),
    "sides exchanged": ("_axis", lambda: on_axes(machine_mutants.exchange_sides)),
    "points mirrored": ("_axis", lambda: on_axes(machine_mutants.mirror_point)),
    "points ignored": ("_axis", lambda: on_axes(lambda a: replace(a, point=(0.0, 0.0, 0.0)))),
    "limits mirrored": ("_axis", lambda: on_axes(machine_mutants.mirror_limits)),
    "homes mirrored": ("_axis", lambda: on_axes(lambda a: replace(a, home=-a.home))),
    "preferred sign ignored": ("_axis", lambda: on_axes(lambda a: replace(a, prefer=PreferredSign.EITHER))),
    "directions the other way": ("_direction", lambda: negated(loading._direction)),
    "directions rolled": ("_direction", lambda: rolled(loading._direction)),
    "vectors the other way": ("_vector", lambda: negated(loading._vector)),
    "vectors rolled": ("_vector", lambda: rolled(loading._vector)),
}


@pytest.mark.parametrize("mutant", LOADER_MUTANTS)
def test_a_mistake_in_the_loader_is_caught_by_at_least_one_shipped_machine(
    mutant: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    function, make = LOADER_MUTANTS[mutant]
    monkeypatch.setattr(loading, function, make())
    caught = []
    for key in five_axis_machines():
        try:
            machine = loading.read_machine(load_table(key, loading.machine_library()), key)
        except InputError:  # the chain itself is refused
            caught.append(key)
            continue
        caught += [key] if is_caught(machine) else []
    assert caught
    if mutant.startswith(("all senses", "senses of tables", "senses of rotary", "directions")):
        assert len(caught) >= len(five_axis_machines()) - (2 if mutant == "senses of tables" else 0)


def test_every_third_party_machine_has_a_known_pose() -> None:
    assert set(THIRD_PARTY) == set(ROWS) - set(CONTRADICTIONS)


@pytest.mark.third
@pytest.mark.parametrize("name", sorted(THIRD_PARTY))
def test_a_third_party_machine_puts_its_tool_where_it_is_known_to_be(name: str, tmp_path: Path) -> None:
    row, machine = THIRD_PARTY[name], load(ROWS[name], tmp_path)
    values = dict(SLIDES)
    values |= {ROWS[name][which]: float(row[f"{which}_deg"]) for which in ("axis4", "axis5")}
    expected = np.array([float(row[column]) for column in "xyzijk"])
    tip, axis = forward(machine, np.array([[values[each] for each in machine.names]]), 120.0)
    pose = rotary_pose(machine, values)
    own_tip = np.array(pose.gauge_point) - 120.0 * np.array(pose.tool_axis)
    np.testing.assert_allclose([*tip[0], *axis[0]], expected, rtol=0, atol=6e-6)
    np.testing.assert_allclose([*own_tip, *pose.tool_axis], expected, rtol=0, atol=6e-6)


def test_known_poses_are_of_a_tool_and_of_slides_that_are_not_at_zero() -> None:
    assert LENGTH
    assert len(set(SLIDES.values())) == 3
    assert 0.0 not in SLIDES.values()


@pytest.mark.parametrize("name", five_axis_machines())
def test_a_zero_of_whole_numbers_is_one_of_millimetres(name: str) -> None:
    machine = load_machine(name)
    joints = np.full((2, 5), 20.0)
    whole, broken = (
        forward(replace(machine, workpiece_zero=zero), joints, 100) for zero in ((0, 0, -160), (0.0, 0.0, -160.0))
    )
    for one, other in zip(whole, broken, strict=True):
        np.testing.assert_array_equal(one, other)
