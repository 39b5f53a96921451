"""The switches of block skip (``/``) that an operator may have on while a program runs.

In:     the levels of the blocks that programs let him skip.
Out:    which of them are on, in each other meaning of the programs.
"""

from collections.abc import Collection
from itertools import combinations
from typing import Final

#: Levels of which every combination is a meaning of its own: seven at most.
_EVERY_COMBINATION: Final = 3


def skip_combinations(levels: Collection[int]) -> list[frozenset[int]]:
    """Return all levels together, each alone, and the others where no more than three levels are used."""
    used = sorted(set(levels))
    alone = range(1, len(used) if has_every_combination(used) else min(len(used), 2))
    sizes = ([len(used)] if used else []) + list(alone)
    return [frozenset(some) for size in sizes for some in combinations(used, size)]


def has_every_combination(levels: Collection[int]) -> bool:
    """Whether ``skip_combinations`` has all of them."""
    return len(set(levels)) <= _EVERY_COMBINATION
