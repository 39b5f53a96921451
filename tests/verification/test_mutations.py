"""Faults in programs that ran are reported at the right block, or do not change the work.

The tests take a sample; ``benchmarks/mutations.py`` puts in every fault that there is.
"""

import random
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.support.examples import THIRDS, examples
from tests.support.mutations import (
    AFTER,
    AGAIN,
    CASES,
    DRIVES,
    HOME,
    REASONS,
    SMOOTHING,
    START,
    Mutation,
    checked,
    golden,
    judge,
    mutations,
    sample,
    sweep,
    untouched,
)

#: Mutations of each kind in each program.
MOST = 25

#: Kinds that fit into every program; the last ones only into those with TCP.
EVERYWHERE = {
    *("change a digit", "drop a block", "double a block", "swap two blocks", "swap two words", "swap two values"),
    *("flip a sign", "G0 becomes G1", "G1 becomes G0", "another tool", "another speed", "M3 becomes M4"),
    *("another feed", "no feed", "another work offset", "no work offset", "inches", "incremental", "feed per turn"),
    *("cutter compensation", "another edge", "no end"),
}
WITH_TCP = {"no TRAORI", "TRAORI before the placing", "TRAFOOF in the cut"}


@pytest.mark.parametrize("name", CASES)
def test_a_golden_program_is_proven_within_half_its_last_digit(name: str) -> None:
    found = checked(name, untouched(name))
    assert [check.key for check in found.checks if not check.passed] == []
    by_key = {check.key: check for check in found.checks}
    for key in ("tip", "axis"):
        worst, limit = by_key[key].worst, by_key[key].limit
        assert worst is not None
        assert limit is not None
        assert worst <= limit
    assert (found.cl_line > 0).sum() == len(golden(name)[1].operations[0].moves)


@pytest.mark.parametrize("name", CASES)
def test_every_kind_of_fault_is_put_in(name: str) -> None:
    kinds = {mutation.kind for mutation in mutations(name, 1, random.Random(1))}
    assert kinds >= (EVERYWHERE if name == "1_contour_rough" else EVERYWHERE | WITH_TCP)


@pytest.mark.parametrize("third", THIRDS)
@pytest.mark.parametrize("name", CASES)
def test_every_fault_that_changes_the_work_is_reported_at_its_block(name: str, third: int, tmp_path: Path) -> None:
    table = sweep(name, sample(name, MOST, random.Random(569))[third::3], tmp_path)
    for kind, tally in table.items():
        assert tally.outcomes["MISSED"] == tally.outcomes["MISPLACED"] == 0, (kind, tally.not_caught)
        assert set(tally.outside) <= set(REASONS), (kind, tally.not_caught)
        if kind not in ("change a digit", "drop a block", "swap two blocks"):
            assert not tally.outside, (kind, tally.not_caught)
    caught = sum(tally.outcomes["CAUGHT"] for tally in table.values())
    told = sum(tally.outcomes.total() - tally.outcomes["SAME"] for tally in table.values())
    assert caught > 0.9 * told  # of a third of the faults; 0.95 of all of them


@pytest.mark.third
@pytest.mark.parametrize(
    ("line", "new", "verdict", "what"),
    [
        (48, "N480 G1 X52.29363 Y-.65697 Z-16.30837 F250.", "CAUGHT", "BLOCK"),
        (48, "N480 G1 X52.29363 Y-.65697 Z-16.30836 F251.", "CAUGHT", "BLOCK"),
        (48, "N480 F250. Y-.65697 X52.29363 Z-16.30836 G1", "SAME", ""),
        (48, "N480 G01 X=52.29363 Y-0.65697 Z-16.308360 F250 ; engage", "SAME", ""),
        (57, "N570 X45.47319 Y-5.26489 Z-21.28881 C371.03388", "SAME", ""),
        (35, "N350 ;", "SAME", ""),
        (36, "", "SAME", ""),
        (10, "N100 G40 G17 G710 G94 G90 G60 G602 FNORM", "OUTSIDE", DRIVES),
        (44, "N440 ORIMKS", "OUTSIDE", DRIVES),
        (23, "N230 _camtolerance=.07", "OUTSIDE", SMOOTHING),
        (23, "N230 _camtolerance=.96", "CAUGHT", "SHOWS"),
        (29, "", "OUTSIDE", AGAIN),
        (31, "", "OUTSIDE", START),
        (38, "", "OUTSIDE", HOME),
        (201, "", "OUTSIDE", AFTER),
        (10, "N100 G40 G17 G710 G54 G90 G60 G601 FNORM", "OUTSIDE", HOME),
        # The rotary axes are placed in it before G54 is selected, three blocks before the tool comes to the part.
        (10, "N100 G40 G17 G510 G94 G90 G60 G601 FNORM", "CAUGHT", "SHOWS"),
        (34, "N340 M2", "CAUGHT", "BLOCK"),
    ],
)
def test_what_a_fault_comes_to_is_judged_without_the_checks(
    line: int, new: str, verdict: str, what: str, tmp_path: Path
) -> None:
    lines = golden("3_blade_finish")[0]
    mutation = Mutation("", line, (*lines[: line - 1], new, *lines[line:]))
    outcome = judge("3_blade_finish", mutation, tmp_path)
    assert (outcome.verdict, outcome.what) == (verdict, what)


@st.composite
def _faults(draw: st.DrawFn) -> tuple[str, Mutation]:
    """A golden program with one character changed somewhere."""
    name = draw(st.sampled_from(CASES))
    lines = golden(name)[0]
    places = [
        (k, at)
        for k, line in enumerate(lines)
        if ";" not in line
        for at in range(line.index(" ") + 1, len(line))
        if line[at].isdigit() or line[at] == "-"
    ]
    k, at = draw(st.sampled_from(places))
    old = lines[k][at]
    new = draw(st.sampled_from([char for char in "0123456789" if char != old]))
    changed = lines[k][:at] + new + lines[k][at + 1 :]
    return name, Mutation("change a character", k + 1, (*lines[:k], changed, *lines[k + 1 :]))


@settings(max_examples=examples(50), deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(fault=_faults())
def test_any_one_character_of_a_number_is_proven_or_harmless(fault: tuple[str, Mutation], tmp_path: Path) -> None:
    name, mutation = fault
    outcome = judge(name, mutation, tmp_path)
    assert outcome.verdict in ("CAUGHT", "SAME", "OUTSIDE"), (outcome, mutation.lines[mutation.line - 1])
    assert not outcome.what or outcome.verdict == "CAUGHT" or outcome.what in REASONS


@settings(max_examples=examples(15), deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(seed=st.integers(0, 2**32), name=st.sampled_from(CASES))
def test_several_faults_at_once_do_not_hide_each_other(seed: int, name: str, tmp_path: Path) -> None:
    rng = random.Random(seed)
    lines = list(golden(name)[0])
    cut = [k for k, line in enumerate(lines) if " X" in line and "SUPA" not in line and ";" not in line]
    dropped, doubled = sorted(rng.sample(cut[1:-1], 2))
    text = (*lines[:dropped], *lines[dropped + 1 : doubled], lines[doubled], *lines[doubled:])
    outcome = judge(name, Mutation("drop one, double another", dropped + 1, text), tmp_path)
    assert outcome.verdict in ("CAUGHT", "SAME")
