"""What a simulation finds while the operator skips blocks (``/``): the stock is cut again in each other meaning.

In:     the results of set-ups in which no block is skipped, and what cuts the stock once more.
Out:    these results with what is found besides, each thing with the blocks that must be skipped for it.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TypeVar

import numpy as np

from trunnion.errors import InputError, Problem
from trunnion.jobs.inputs.simulation_input import SetupInput
from trunnion.jobs.observer import Observer
from trunnion.jobs.simulate.result import SimulationResult
from trunnion.jobs.simulate.setups import skipping_setup
from trunnion.messages import Wording
from trunnion.simulation.prepared_setup import PreparedSetup
from trunnion.simulation.setup_findings import NearMiss, SimulationFinding
from trunnion.verification.skip_meanings import other_meanings, words_of

_Found = TypeVar("_Found", SimulationFinding, NearMiss)


def in_other_meanings(
    results: list[SimulationResult],
    setups: Sequence[tuple[SetupInput, PreparedSetup]],
    cut: Callable[[Sequence[PreparedSetup], Sequence[list[Problem]]], Iterable[SimulationResult]],
    observer: Observer,
) -> list[SimulationResult]:
    """Return the results of set-ups with what is found with blocks skipped.

    cut  cuts the stock from the beginning in set-ups, of which remarks are noted
    """
    runs = [run for _, own in setups for run in own.runs]
    for levels in other_meanings(*runs):
        words, told = words_of(levels, *runs), [list[Problem]() for _ in setups]
        wrong, found = tuple[Problem, ...](), list[SimulationResult]()
        try:
            others = [
                skipping_setup(own, given, levels, own_told)
                for (given, own), own_told in zip(setups, told, strict=True)
            ]
        except InputError as error:
            wrong = tuple(error.problems)
        else:
            found += cut(others, told)
        joined = [_joined(one, other, words) for one, other in zip(results, found, strict=False)]
        joined += results[len(joined) :]
        joined[0] = _with_remarks(joined[0], wrong, words)
        for before, after in zip(results, joined, strict=True):
            observer.problems(after.remarks[len(before.remarks) :])
        results = [replace(each, skip_meanings=(*each.skip_meanings, words)) for each in joined]
    return results


def _joined(one: SimulationResult, other: SimulationResult, words: Wording) -> SimulationResult:
    """Return the result of a set-up with what another meaning of its programs does besides."""
    gouges = [each for each in (one.gouge, other.gouge) if each is not None]
    result = replace(
        one,
        findings=(*one.findings, *_new(one, one.findings, other.findings, words)),
        near=(*one.near, *_new(one, one.near, other.near, words)),
        gouge=max(gouges, key=lambda each: each.largest, default=None),
        cuts_unknown=tuple(dict.fromkeys((*one.cuts_unknown, *other.cuts_unknown))),
    )
    return _with_remarks(result, other.remarks, words)


def _new(one: SimulationResult, known: Sequence[_Found], others: Iterable[_Found], words: Wording) -> Iterator[_Found]:
    """Yield what is found at another place, or is deeper or nearer there, with its row in the run of no skipped
    block.
    """
    for each in others:
        worst = max((_severity(own) for own in known if _place(own) == _place(each)), default=-np.inf)
        if _severity(each) > worst + one.limit:
            yield replace(each, when=words, row=_row(one, each))


def _place(found: _Found) -> tuple[object, ...]:
    kind = found.kind if isinstance(found, SimulationFinding) else ""
    return kind, found.between, found.file, found.line


def _severity(found: _Found) -> float:
    return found.depth if isinstance(found, SimulationFinding) else -found.distance


def _row(one: SimulationResult, found: _Found) -> int:
    """Return the row of the run of a program at or behind a line; the last one where there is none."""
    for program in one.simulation.programs:
        run = program.run
        names = [Path(file).name for file in run.files]
        if (name := Path(found.file).name) in names:
            rows = np.flatnonzero((run.file == names.index(name)) & (run.line >= found.line))
            return int(rows[0]) if len(rows) else len(run) - 1
    return -1


def _with_remarks(result: SimulationResult, remarks: Iterable[Problem], words: Wording) -> SimulationResult:
    """Return a result with the remarks that it has not, each with the blocks that are skipped."""
    known = set(result.remarks)
    new = [replace(each, wording=each.wording.within("of", name=words)) for each in remarks if each not in known]
    return replace(result, remarks=(*result.remarks, *new))
