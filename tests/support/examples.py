"""How many draws a property has, and how many faults a sweep: all in ``make.py nightly``, a third elsewhere."""

from typing import Any

import pytest
from hypothesis import settings

#: Which thirds of all faults a sweep tries: the one that ``make.py test`` has, and those that are left to nightly.
THIRDS = (0, *(pytest.param(part, marks=pytest.mark.nightly) for part in (1, 2)))

#: A draw is seldom too few: the first one is the simplest.
FEWEST = 3

#: Profiles of Hypothesis -> draws of a property that says no number.
DRAWS = {"trunnion": 34, "nightly": 100}


def examples(count: int) -> int:
    """Of the draws that a property asks for, those that the profile gives it."""
    return part_of(count, settings().max_examples)


def part_of(count: int, percent: int) -> int:
    """A part of some draws."""
    return max(min(count, FEWEST), round(0.01 * count * percent))


def seeds_of(count: int) -> list[Any]:
    """Parameters 0, 1, …: the first third of them for ``make.py test``, the rest for nightly."""
    return [pytest.param(seed, marks=[pytest.mark.nightly] * (3 * seed >= count)) for seed in range(count)]
