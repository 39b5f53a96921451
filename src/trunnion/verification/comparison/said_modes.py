"""Modes that one program says and the other relies on, and those that no path shows.

In:     two runs of one language, on the same machine.
Out:    for each mode that they do not say alike a state of their cuts: ``G17`` that only one of them has, ``SOFT``
        against ``BRISK``. What a program does not say holds as the one before it has left it, and nobody knows how.
"""

from collections.abc import Iterator
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Ints
from trunnion.messages import Wording
from trunnion.model.columns import StepColumn
from trunnion.model.mode_words import END_OF_CYCLES, OF_COMPENSATION, UNDER_TCP
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind
from trunnion.verification.comparison.states import ComparedState

#: Modes that count only where both programs say them: what calls for them shows in the path.
_OF_BOTH: Final = frozenset({"swivel data"})

#: Modes of cycles, with their words: they count where a cycle relies on one that its program does not say.
_OF_CYCLES: Final = {END_OF_CYCLES: frozenset({"G98", "G99"})}


def said_modes(one: Run, two: Run) -> Iterator[ComparedState]:
    """Yield the modes that two runs say otherwise, or elsewhere."""
    if one.language != two.language or one.machine.key != two.machine.key:
        return
    yield _working_planes(one, two)
    said = [_by_mode(run) for run in (one, two)]
    for mode in sorted(said[0].keys() | said[1].keys()):
        found = [each.get(mode, []) for each in said]
        if mode in _OF_CYCLES and _OF_CYCLES[mode].isdisjoint((*one.assumed_modes, *two.assumed_modes)):
            continue
        if not (_from_the_start(one, found[0]) and _from_the_start(two, found[1]) and found[0][0][1] == found[1][0][1]):
            yield _state(mode, (one, two), (found[0], found[1]))


def _working_planes(one: Run, two: Run) -> ComparedState:
    """Return the plane in which arcs, cycles and compensation work: that of lines matters to what follows."""
    planes = [run.state.working_plane for run in (one, two)]

    def name(plane: int) -> str:
        return f"G{19 - plane}"

    return ComparedState(
        lambda a, b: np.asarray((one.kind[a] != Kind.RAPID) & (two.kind[b] != Kind.RAPID)),
        lambda a, b: np.asarray(planes[0].at(a) == planes[1].at(b)),
        lambda a, b: (planes[0].at(a), planes[1].at(b)),
        lambda a, b: Wording("comparison", "modes", mode="plane", one=name(planes[0][a]), two=name(planes[1][b])),
    )


def _by_mode(run: Run) -> dict[str, list[tuple[int, str]]]:
    """Return the words of each mode, and from which row on they hold."""
    found: dict[str, list[tuple[int, str]]] = {}
    for each in run.mode_words:
        found.setdefault(each.mode, []).append((each.before_row, each.word))
    return found


def _from_the_start(run: Run, words: list[tuple[int, str]]) -> bool:
    """Whether one word holds in every cut."""
    cuts = np.flatnonzero(run.kind != Kind.RAPID)
    return len(words) == 1 and (not len(cuts) or words[0][0] <= int(cuts[0]))


def _state(
    mode: str, runs: tuple[Run, Run], said: tuple[list[tuple[int, str]], list[tuple[int, str]]]
) -> ComparedState:
    texts = sorted({word for each in said for _, word in each})
    columns = [_column(run, each, texts) for run, each in zip(runs, said, strict=True)]

    def counts(a: Ints, b: Ints) -> Flags:
        cuts = np.asarray((runs[0].kind[a] != Kind.RAPID) & (runs[1].kind[b] != Kind.RAPID))
        if mode in OF_COMPENSATION:
            sides = [run.state.compensation for run in runs]
            return np.asarray(cuts & (sides[0].at(a) != 0) & (sides[1].at(b) != 0))
        if mode in UNDER_TCP:
            return np.asarray(cuts & runs[0].state.tcp.at(a) & runs[1].state.tcp.at(b))
        return cuts & (columns[0].at(a) >= 0) & (columns[1].at(b) >= 0) if mode in _OF_BOTH else cuts

    def name(number: int) -> Wording | str:
        said = texts[number] if number >= 0 else ""
        return said or Wording("comparison", "not_stated" if number < 0 else "stated")

    return ComparedState(
        counts,
        lambda a, b: np.asarray(columns[0].at(a) == columns[1].at(b)),
        lambda a, b: (columns[0].at(a), columns[1].at(b)),
        lambda a, b: Wording("comparison", "modes", mode=mode, one=name(columns[0][a]), two=name(columns[1][b])),
    )


def _column(run: Run, words: list[tuple[int, str]], texts: list[str]) -> StepColumn:
    """Return the word in force by its number in ``texts``; -1 where the program has said none."""
    last = dict([(0, -1), *((row, texts.index(word)) for row, word in words)])
    return StepColumn(len(run), np.array(list(last), np.int64), np.array(list(last.values()), np.int64))
