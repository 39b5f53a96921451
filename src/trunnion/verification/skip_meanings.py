"""What else a program means: with the switches of block skip on, blocks with ``/`` are left out.

In:     runs of programs, each with what it is in its other meanings (``Run.skipped``).
Out:    the levels that are on in each other meaning; checks that fail in one of them; and the OPSKIP that a program has
        lost: none of its blocks may be skipped.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import islice

from trunnion.messages import Wording, phrase
from trunnion.model.run import Run
from trunnion.model.skip_switches import has_every_combination, skip_combinations
from trunnion.verification.context import MAX_PLACES, check_from_places
from trunnion.verification.results import Check, Place, Verification


def other_meanings(*runs: Run) -> list[frozenset[int]]:
    """Return the levels that are on in each other meaning of the programs; none where no block may be skipped."""
    return skip_combinations(_used(*runs))


def words_of(levels: frozenset[int], *runs: Run) -> Wording:
    """Name a meaning, and the first block that is skipped in it."""
    line = _first_line(levels, *runs)
    if levels == _used(*runs):
        return Wording("all", "blocks_skipped", line=line)
    return Wording("all", "levels_skipped", **_which(levels), line=line)


def with_other_meanings(
    proof: Verification, verify: Callable[[Run, frozenset[int] | None], Verification], *, has_toolpaths: bool
) -> Verification:
    """Return a proof that fails where the program fails with blocks skipped, or does not let them be skipped.

    It is compared with the CL files without those of their OPSKIP whose blocks are left out in the program. Where an
    OPSKIP is left out only in part, and where blocks without an OPSKIP may be skipped, it is judged by itself.

    verify         of a run, and the numbers of the OPSKIP that are left out; None: it is not compared
    has_toolpaths  whether the proof has compared the program with CL files
    """
    used, others = _used(proof.run), list[tuple[Wording, Sequence[Check]]]()
    as_asked_for = all(check.passed for check in proof.checks if check.key == "stops")
    alone = list[Wording]()
    for each in proof.run.skipped:
        left_out = None
        if has_toolpaths and as_asked_for:
            left_out = _left_out(proof.skip_levels, each.levels, used)
            if left_out is None:
                line = _first_line(each.levels, proof.run)
                alone.append(phrase("skipped_in_part", **_which(each.levels), line=line))
        others.append((words_of(each.levels, proof.run), verify(each.run, left_out).checks))
    if has_toolpaths and not has_every_combination(used):
        alone.append(phrase("other_combinations", count=len(used)))
    checks = _worse_checks(proof.checks, others) if others else iter(proof.checks)
    lost = _lost(proof, verify) if has_toolpaths else []
    return replace(proof, checks=tuple(_with_lost(_with_missing(checks, alone), lost)))


def _lost(proof: Verification, verify: Callable[[Run, frozenset[int] | None], Verification]) -> list[Place]:
    """Return the places of the OPSKIP without which the CL files ask for another program, and of which no block has /.

    What changes nothing, such as a mode that holds already, has no block of its own.
    """

    def matters(numbers: Iterable[int]) -> bool:
        found = verify(proof.run, frozenset(numbers)).checks
        return any(not check.passed and passed.get(check.key, False) for check in found)

    passed = {check.key: check.passed for check in proof.checks}
    if not proof.lost_skips or not matters(proof.lost_skips):
        return []
    first = dict(islice(proof.lost_skips.items(), MAX_PLACES))
    found = [place for number, place in first.items() if matters([number])]
    return found or list(first.values())


def _with_lost(checks: Iterable[Check], lost: Sequence[Place]) -> Iterator[Check]:
    """Yield the checks; that of block skip fails where an OPSKIP is lost."""
    for check in checks:
        if check.key == "stops" and lost:
            yield check_from_places(check.key, [*([] if check.passed else check.places), *lost], None)
        else:
            yield check


def _left_out(
    skip_levels: Sequence[frozenset[int]], levels: frozenset[int], used: frozenset[int]
) -> frozenset[int] | None:
    """Return the numbers of the OPSKIP that are left out while some levels are on; None: one of them only in part."""
    if levels == used:
        return frozenset(range(len(skip_levels)))
    if any(each & levels and not each <= levels for each in skip_levels):
        return None
    return frozenset(number for number, each in enumerate(skip_levels) if each and each <= levels)


def _with_missing(checks: Iterator[Check], missing: Sequence[Wording]) -> Iterator[Check]:
    """Yield the checks; that of block skip with what was not compared."""
    for check in checks:
        yield replace(check, missing=(*check.missing, *missing)) if check.key == "stops" else check


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


def _which(levels: frozenset[int]) -> dict[str, object]:
    """Return which blocks are skipped: how many levels, and which."""
    return {"count": len(levels), "levels": tuple(map(str, sorted(levels)))}


def _first_line(levels: frozenset[int], *runs: Run) -> int:
    """Return the line of the first block that is skipped while some levels are on."""
    return min(
        event.line
        for run in runs
        for event in run.events
        if event.kind == "block_skip" and isinstance(event.value, int | float) and int(event.value) in levels
    )


def _used(*runs: Run) -> frozenset[int]:
    """Return all levels that programs use."""
    return frozenset(level for run in runs for each in run.skipped for level in each.levels)
