"""Rewinds without TCP: the slides follow the turn at the clearance, and the proof checks them."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import Phase, event, given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.operations import operation_of
from tests.support.path_strategies import winding
from tests.support.rewind_paths import round_part
from tests.support.without_tcp import NAMES, Posted, machine, post, toolpath, worst_off
from trunnion.arrays import Floats
from trunnion.errors import Severity
from trunnion.machines import Machine
from trunnion.model.subdivision import subdivide
from trunnion.model.toolpath import Kind, Message, Moves
from trunnion.planning import Clearance, PlanOptions
from trunnion.readers import run_program
from trunnion.verification import verify

CA = machine("generic_head_head_ca")


def posted(moves: Moves, model: Machine = CA, tolerance: float = 0.01, clearance: float = 40.0) -> Posted:
    options = PlanOptions(tcp=False, tip_tolerance=tolerance, clearance=Clearance(clearance))
    return post(model, toolpath(operation_of(moves)), options)


def turning_rows(done: Posted) -> slice:
    """Rows of the run in which the tool turns at the clearance."""
    rapids = np.flatnonzero((done.run.kind == Kind.RAPID) & ~done.run.machine_frame & ((done.run.programmed & 7) != 0))
    rapids = rapids[rapids > 10]
    assert (np.diff(rapids) == 1).all(), "one rewind"
    return slice(int(rapids[0]), int(rapids[-1]) + 1)


def test_the_slides_keep_the_tip_at_the_clearance_while_the_axes_turn() -> None:
    moves = round_part()
    done = posted(moves)
    assert [str(check) for check in done.found.checks if not check.passed] == []
    assert "1 retract along the tool axis to turn" in next(c.summary for c in done.found.checks if c.key == "order")
    rows = turning_rows(done)
    left = done.run.tip[rows.start - 2]
    (point,) = np.flatnonzero(np.abs(moves.tip - left).max(axis=1) < 3e-5)
    away = moves.tip[point] + 40.0 * moves.axis[point]
    on_the_way = subdivide(done.run, 20, rows).tip
    assert np.linalg.norm(on_the_way - away, axis=1).max() <= 0.01 + 3e-5
    c = done.run.rotary[:, 0]
    assert abs(c[rows.stop - 1] - c[rows.start - 1]) == pytest.approx(360.0, abs=1e-4)
    assert np.abs(done.run.tip[rows.stop] - left).max() < 3e-5
    assert (done.run.feed[rows.start - 1], done.run.feed[rows.stop]) == (100.0, 50.0)
    notes = [e for e in done.plan.motions[0].operation.events if isinstance(e, Message)]
    assert len(notes) == 1
    assert done.text.count(";Rewind: C ") == 1


def test_rewinds_can_be_forbidden_without_tcp_too() -> None:
    done = post(CA, toolpath(operation_of(round_part())), PlanOptions(tcp=False, allow_rewinds=False))
    (problem,) = done.plan.problems
    assert problem.severity is Severity.ERROR
    assert "axis C would go to 36" in problem.what
    assert "setting rewind=insert" in problem.cure
    assert not any(isinstance(e, Message) for e in done.plan.motions[0].operation.events)


def test_a_retract_beyond_the_limits_of_slides_is_refused_once_with_its_remedy() -> None:
    near = replace(CA, axes=tuple(replace(a, low=-280.0, high=280.0) if a.name == "Y" else a for a in CA.axes))
    errors = [p for p in posted(round_part(), near).plan.problems if p.severity is Severity.ERROR]
    assert len(errors) == 1
    assert "on the retract for a rewind axis Y would go to" in errors[0].what
    assert "setting clearance=MM" in errors[0].cure


def straight_turn(lines: list[str], first: int, last: int) -> list[str]:
    return [*lines[:first], lines[last], *lines[last + 1 :]]


def nudged(lines: list[str], first: int, last: int) -> list[str]:
    middle = (first + last) // 2
    words = [f"X{float(w[1:]) + 2.0:.5f}" if w[0] == "X" else w for w in lines[middle].split(" ")]
    return [*lines[:middle], " ".join(words), *lines[middle + 1 :]]


def left_out(number: int) -> Callable[[list[str], int, int], list[str]]:
    return lambda lines, first, last: [*lines[: first + number], *lines[first + number + 1 :]]


def half_of_it(lines: list[str], first: int, last: int) -> list[str]:
    return [*lines[: (first + last) // 2], *lines[last + 1 :]]


def every_eighth(lines: list[str], first: int, last: int) -> list[str]:
    return [*lines[:first], *lines[first:last:64], *lines[last:]]


FAULTS: dict[str, Callable[[list[str], int, int], list[str]]] = {
    "the axes turn in one go": straight_turn,
    "the slides follow too coarsely": every_eighth,
    "a point beside the tip": nudged,
    "no way out": left_out(-2),
    "half the turn": half_of_it,
}


@pytest.mark.third
@pytest.mark.parametrize("fault", sorted(FAULTS))
@pytest.mark.parametrize("asked", [True, False], ids=["with a tolerance of the tip", "without"])
def test_the_proof_checks_the_tip_during_a_turn(fault: str, asked: bool, tmp_path: Path) -> None:
    path = toolpath(operation_of(round_part()))
    done = post(CA, path, PlanOptions(tcp=False))
    lines = done.text.splitlines()
    rows = turning_rows(done)
    first, last = (int(done.run.lines[row]) - 1 for row in (rows.start, rows.stop - 1))
    file = tmp_path / "part.mpf"
    for text, passes in ((lines, True), (FAULTS[fault](lines, first, last), False)):
        file.write_text("\n".join(text) + "\n", encoding="utf-8")
        said = done.settings if asked else replace(done.settings, span=1.0, span_tip=None)
        found = verify(run_program(file, CA), [path], tolerances=done.allowed, settings=said)
        assert found.passed is passes, [str(c) for c in found.checks if not c.passed]


@settings(deadline=None, max_examples=examples(10), phases=[Phase.generate])
@given(
    st.sampled_from(NAMES),
    st.floats(3.0, 29.0),
    st.floats(-180.0, 180.0),
    st.floats(1.2, 3.6),
    st.sampled_from([-1.0, 1.0]),
    st.sampled_from([0.01, 0.1]),
)
def test_winding_beyond_the_limits_is_proven_everywhere(
    name: str, tilt: float, start: float, turns: float, sense: float, tolerance: float
) -> None:
    n = 120
    moves = winding(tilt, start, start + sense * 360.0 * turns, n)
    tip: Floats = np.round(30.0 * moves.axis + np.linspace(0.0, 6.0, n)[:, None] * [0.0, 0.0, 1.0], 5)
    model = machine(name)
    done = posted(replace(moves, tip=tip), model, tolerance)
    rewinds = [p for p in done.plan.problems if "to rewind" in p.what]
    event(f"rewinds: {len(rewinds)}")
    assert [p for p in done.plan.problems if p.severity is Severity.ERROR] == []
    assert [str(check) for check in done.found.checks if not check.passed] == []
    if model.axes[model.rotary[0]].endless:
        assert not rewinds
    else:
        low, high = model.axes[model.rotary[0]].low, model.axes[model.rotary[0]].high
        assert done.run.rotary[:, 0].min() >= low - 1e-5
        assert done.run.rotary[:, 0].max() <= high + 1e-5
    if not rewinds:
        assert worst_off(done.run, tip, moves.axis, [Kind.LINEAR] * n)[0] <= tolerance + 3e-5
