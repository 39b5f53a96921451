"""How many draws a property has: all in ``make.py nightly``, a third elsewhere."""

from hypothesis import settings

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
