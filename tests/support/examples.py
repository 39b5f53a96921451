"""How many draws a property has, and how many faults a sweep: all in ``make.py nightly``, a part elsewhere."""

from collections.abc import Sequence
from typing import Any

import pytest
from hypothesis import settings

#: Which thirds of all faults a sweep tries: the one that ``make.py test`` has, and those that are left to nightly.
THIRDS = (0, *(pytest.param(part, marks=pytest.mark.nightly) for part in (1, 2)))

#: A draw is seldom too few: the first one is the simplest.
FEWEST = 3

#: Profiles of Hypothesis -> draws of a property that says no number.
DRAWS = {"trunnion": 25, "nightly": 100}


def examples(count: int) -> int:
    """Of the draws that a property asks for, those that the profile gives it."""
    return part_of(count, settings().max_examples)


def part_of(count: int, percent: int) -> int:
    """A part of some draws."""
    return max(min(count, FEWEST), round(0.01 * count * percent))


def seeds_of(count: int) -> list[Any]:
    """Parameters 0, 1, …: the first third of them for ``make.py test``, the rest for nightly."""
    return [pytest.param(seed, marks=[pytest.mark.nightly] * (3 * seed >= count)) for seed in range(count)]


def leave_thirds(items: Sequence[pytest.Item]) -> None:
    """Leave two thirds of the cases of each test that is marked ``third`` to nightly.

    The third is a diagonal, so that each value of two parameters is in it; tests begin at different cases, so that not
    all of them have the same controls.
    """
    known: dict[tuple[str, int], dict[tuple[int, ...], int]] = {}
    for item in items:
        if item.get_closest_marker("third") is None:
            continue
        test, (name, _, _) = item.nodeid.partition("[")[0], item.name.partition("[")
        number = len(name)
        for k, mark in enumerate(item.iter_markers("parametrize")):
            names = mark.args[0].split(",") if isinstance(mark.args[0], str) else mark.args[0]
            values = tuple(id(item.callspec.params[each.strip()]) for each in names)  # type: ignore[attr-defined]
            of_values = known.setdefault((test, k), {})
            number += of_values.setdefault(values, len(of_values))
        if number % 3:
            item.add_marker(pytest.mark.nightly)
