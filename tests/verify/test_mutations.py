"""Faults in programs that ran are reported at the right block, or change nothing that the machine does."""

import random
from collections import Counter
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.verify.mutations import CASES, Mutation, checked, golden, judge, sweep, untouched

#: Digits changed in each program by the sweep, besides every other fault there is.
DIGITS = 120


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
def test_every_fault_that_changes_what_the_machine_does_is_reported_at_its_block(name: str, tmp_path: Path) -> None:
    not_caught: list[str] = []
    table = sweep(name, DIGITS, tmp_path, not_caught.append)
    total: Counter[str] = sum(table.values(), Counter())
    print(
        f"\n{name}: {total['CAUGHT']} of {sum(total.values()) - total['SAME']} faults caught, {total['SAME']} harmless"
    )
    for kind, counts in table.items():
        print(f"  {kind}: {counts['CAUGHT']} of {counts.total() - counts['SAME']}, {counts['SAME']} harmless")
    assert not_caught == []
    assert total["CAUGHT"] > total["SAME"] / 2


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


@settings(max_examples=120, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(fault=_faults())
def test_any_one_character_of_a_number_is_proven_or_harmless(fault: tuple[str, Mutation], tmp_path: Path) -> None:
    name, mutation = fault
    outcome = judge(name, mutation, tmp_path)
    assert outcome.verdict in ("CAUGHT", "SAME"), (outcome, mutation.lines[mutation.line - 1])


@settings(max_examples=30, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(seed=st.integers(0, 2**32), name=st.sampled_from(CASES))
def test_several_faults_at_once_do_not_hide_each_other(seed: int, name: str, tmp_path: Path) -> None:
    rng = random.Random(seed)
    lines = list(golden(name)[0])
    cut = [k for k, line in enumerate(lines) if " X" in line and "SUPA" not in line and ";" not in line]
    dropped, doubled = sorted(rng.sample(cut[1:-1], 2))
    text = (*lines[:dropped], *lines[dropped + 1 : doubled], lines[doubled], *lines[doubled:])
    outcome = judge(name, Mutation("drop one, double another", dropped + 1, text), tmp_path)
    assert outcome.verdict in ("CAUGHT", "SAME")
