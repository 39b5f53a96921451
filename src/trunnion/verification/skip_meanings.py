"""What else a program means: with the switches of block skip on, blocks with ``/`` are left out.

In:     runs of programs, each with what it is in its other meanings (``Run.skipped``).
Out:    the levels that are on in each other meaning; and checks that fail in one of them.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

from trunnion.messages import Wording
from trunnion.model.run import Run
from trunnion.verification.results import Check, Verification


def other_meanings(*runs: Run) -> list[frozenset[int]]:
    """Return the levels that are on: all that the programs use, and each alone; none where no block may be skipped."""
    each = [skipped.levels for run in runs for skipped in run.skipped]
    return list(dict.fromkeys([_used(*runs), *each])) if each else []


def words_of(levels: frozenset[int], *runs: Run) -> Wording:
    """Name a meaning, and the first block that is skipped in it."""
    lines = [
        event.line
        for run in runs
        for event in run.events
        if event.kind == "block_skip" and isinstance(event.value, int | float) and int(event.value) in levels
    ]
    if levels == _used(*runs):
        return Wording("all", "blocks_skipped", line=min(lines))
    return Wording("all", "levels_skipped", levels=tuple(map(str, sorted(levels))), line=min(lines))


def with_other_meanings(
    proof: Verification, verify: Callable[[Run, bool], Verification], *, has_toolpaths: bool
) -> Verification:
    """Return a proof that fails where the program fails with blocks skipped.

    Without all blocks that may be skipped it is compared with the CL files without all that they let the operator skip.
    What a single level is no CL file says, nor what else a program lets him skip: it is judged by itself there.

    verify         of a run, and whether it is compared with the CL files without what they let the operator skip
    has_toolpaths  whether the proof has compared the program with CL files
    """
    used, others = _used(proof.run), list[tuple[Wording, Sequence[Check]]]()
    as_asked_for = all(check.passed for check in proof.checks if check.key == "stops")
    for each in proof.run.skipped:
        compared = has_toolpaths and as_asked_for and each.levels == used
        others.append((words_of(each.levels, proof.run), verify(each.run, compared).checks))
    return replace(proof, checks=tuple(_worse_checks(proof.checks, others))) if others else proof


def _worse_checks(checks: Sequence[Check], others: Sequence[tuple[Wording, Sequence[Check]]]) -> Iterator[Check]:
    """Yield each check, or what it is in the first other meaning in which it fails; ``others``: words and checks."""
    failed = [(words, {check.key: check for check in found if not check.passed}) for words, found in others]
    for check in checks:
        wrong = next(((words, found[check.key]) for words, found in failed if check.key in found), None)
        if wrong is None or not check.passed:
            yield check
            continue
        words, fault = wrong
        places = tuple(replace(each, row=-1, wording=_with(words, each.wording)) for each in fault.places)
        yield replace(fault, answer=fault.answer and _with(words, fault.answer), places=places)


def _with(words: Wording, said: Wording) -> Wording:
    return said.within("with_skips", meaning=words)


def _used(*runs: Run) -> frozenset[int]:
    """Return all levels that programs use."""
    return frozenset(level for run in runs for each in run.skipped for level in each.levels)
