"""What else a program means: with the switches of block skip on, blocks with ``/`` are left out.

In:     runs of programs with all switches off, of which every such block is an event.
Out:    the levels that are on in each other meaning; and checks that fail in one of them.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

from trunnion.model.run import Run
from trunnion.verification.results import Check


def other_meanings(*runs: Run) -> list[frozenset[int]]:
    """Return the levels that are on: all that the programs use, and each alone; none where no block may be skipped."""
    levels = sorted({_level(value) for run in runs for value in _values(run)})
    every = [frozenset(levels)] if levels else []
    return every + [frozenset({level}) for level in levels] if len(levels) > 1 else every


def words_of(levels: frozenset[int], *runs: Run) -> str:
    """Name a meaning, and the first block that is skipped in it."""
    used = {_level(value) for run in runs for value in _values(run)}
    lines = [
        event.line
        for run in runs
        for event in run.events
        if event.kind == "block_skip" and _level(event.value) in levels
    ]
    which = "" if levels == used else f" of level {', '.join(map(str, sorted(levels)))}"
    return f"with blocks{which} skipped (/, first in line {min(lines)})"


def worse_checks(checks: Sequence[Check], others: Iterable[tuple[str, Sequence[Check]]]) -> Iterator[Check]:
    """Yield each check, or what it is in the first other meaning in which it fails; ``others``: words and checks."""
    failed = [(words, {check.key: check for check in found if not check.passed}) for words, found in others]
    for check in checks:
        wrong = next(((words, found[check.key]) for words, found in failed if check.key in found), None)
        if wrong is None or not check.passed:
            yield check
            continue
        words, fault = wrong
        places = tuple(replace(place, row=-1, text=f"{words}: {place.text}") for place in fault.places)
        yield replace(fault, summary=f"{words}: {fault.summary}", places=places)


def _values(run: Run) -> Iterator[object]:
    return (event.value for event in run.events if event.kind == "block_skip")


def _level(value: object) -> int:
    return int(value) if isinstance(value, int | float) else 0
