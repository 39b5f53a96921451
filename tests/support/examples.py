"""How many draws a property has: all in ``make.py nightly``, a third elsewhere."""

from hypothesis import settings

#: A draw is seldom too few: the first one is the simplest.
FEWEST = 3

#: Profiles of Hypothesis -> draws of a property that says no number.
DRAWS = {"trunnion": 34, "nightly": 100}


def examples(count: int) -> int:
    """Of the draws that a property asks for, those that the profile gives it."""
    share = settings().max_examples / DRAWS["nightly"]
    return max(min(count, FEWEST), round(count * share))
