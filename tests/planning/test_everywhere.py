"""Random paths on every shipped machine, with TCP and without: proven by read-back, within limits, no needless rewind.

The families are those in which posts go wrong: poles, crossed limits, more than two turns, one branch open or both,
smooth and rough. The number of rewinds that a path needs is found by a search through all states of all its rows.
"""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from hypothesis import Phase, event, given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.naive.poses import AllPaths
from tests.support.operations import moves_of, operation_of, rapids_at
from tests.support.path_strategies import directions
from tests.support.without_tcp import NAMES, machine, post, toolpath
from trunnion.arrays import Floats
from trunnion.errors import RefusedError, Severity
from trunnion.machines import AngleOutput, Machine, inverse
from trunnion.model.toolpath import Message, Moves
from trunnion.planning import PlanOptions

#: How far rotary axes may be beyond a limit: half the last printed digit, and what the planner counts as noise.
HALF_DIGIT = 0.5e-5 + 1e-6


def as_it_is(model: Machine) -> Machine:
    return model


def first_limited(model: Machine) -> Machine:
    """The first rotary axis has a travel of 400 degrees."""
    column = model.rotary[0]
    narrow = replace(model.axes[column], low=-200.0, high=200.0, endless=False, output=AngleOutput.NONE)
    return replace(model, axes=tuple(narrow if k == column else axis for k, axis in enumerate(model.axes)))


def one_branch_closed(model: Machine) -> Machine:
    """The second rotary axis has only one degree on one side of zero, so one branch is closed nearly everywhere."""
    column = model.rotary[1]
    axis = model.axes[column]
    low, high = (axis.low, min(axis.high, 1.0)) if -axis.low > axis.high else (max(axis.low, -1.0), axis.high)
    return replace(
        model, axes=tuple(replace(a, low=low, high=high) if k == column else a for k, a in enumerate(model.axes))
    )


def both_branches_open(model: Machine) -> Machine:
    """The second rotary axis has the same travel to either side."""
    column = model.rotary[1]
    most = max(-model.axes[column].low, model.axes[column].high)
    wide = replace(model.axes[column], low=-most, high=most)
    return replace(model, axes=tuple(wide if k == column else axis for k, axis in enumerate(model.axes)))


MACHINES = {
    "as it is": as_it_is,
    "first limited": first_limited,
    "one dead": one_branch_closed,
    "both alive": both_branches_open,
}

FAMILIES = ("by the pole", "through the pole", "over a limit", "round and round", "rough")

azimuths = st.floats(-180.0, 180.0)


@st.composite
def paths(draw: st.DrawFn, name: str) -> Moves:
    """A path of a family of paths."""
    n = draw(st.integers(20, 60))
    at, first = np.linspace(0.0, 1.0, n), draw(azimuths)
    if name == "by the pole":
        off, tilt = draw(st.floats(0.02, 1.0)), draw(st.floats(2.0, 15.0))
        axis = np.column_stack((np.tan(np.radians(tilt * (2.0 * at - 1.0))), np.full(n, np.tan(np.radians(off)))))
        c, s = np.cos(np.radians(first)), np.sin(np.radians(first))
        axis = np.column_stack((axis @ [[c, s], [-s, c]], np.ones(n)))
        axis = axis / np.linalg.norm(axis, axis=1, keepdims=True)
    elif name == "through the pole":
        axis = directions(draw(st.floats(2.0, 25.0)) * (1.0 - at * draw(st.floats(1.1, 2.0))), np.full(n, first))
    elif name == "over a limit":
        axis = directions(np.full(n, draw(st.floats(4.0, 25.0))), first + at * draw(st.floats(-400.0, 400.0)))
    elif name == "round and round":
        n = 120
        at, turns = np.linspace(0.0, 1.0, n), draw(st.floats(2.1, 3.4)) * draw(st.sampled_from([-1.0, 1.0]))
        axis = directions(np.full(n, draw(st.floats(4.0, 25.0))), first + 360.0 * turns * at)
    else:
        n = draw(st.integers(3, 9))
        tilts = draw(st.lists(st.sampled_from([0.0, 0.5, 3.0]) | st.floats(0.0, 25.0), min_size=n, max_size=n))
        axis = directions(np.array(tilts), np.array(draw(st.lists(azimuths, min_size=n, max_size=n))))
    tip: Floats = 25.0 * axis + np.linspace(0.0, 30.0, n)[:, None] * [1.0, 0.4, 0.1]
    moves = moves_of(np.round(tip, 5), axis)
    rapids = draw(st.lists(st.integers(1, n - 1), max_size=2)) if name == "rough" or draw(st.booleans()) else []
    return rapids_at(moves, [0, *rapids])


@dataclass(frozen=True)
class Fewest:
    """What a search through all states finds: the fewest rewinds, and whether every row has a state within limits."""

    rewinds: int
    keeps_limits: bool


def fewest(model: Machine, moves: Moves) -> Fewest:
    """Dynamic programming over the states of ``AllPaths``: rewinds depend on single steps only."""
    every = AllPaths(model, moves)
    low, high = every.limits.T
    inside = [
        any(((every.value(row, s) >= low - 1e-5) & (every.value(row, s) <= high + 1e-5)).all() for s in every.states)
        for row in range(len(moves))
    ]
    count = np.where(every.open[0], 0, 1 << 40)
    for row in range(1, len(moves)):
        before = [k for k, is_open in enumerate(every.open[row - 1]) if is_open]
        count = np.array([
            min(int(count[k]) + every.step(row, every.states[k], state)[0] for k in before) if is_open else 1 << 40
            for state, is_open in zip(every.states, every.open[row], strict=True)
        ])  # fmt: skip
    return Fewest(int(count.min()), all(inside))


def check_plan(name: str, variant: str, path: Moves, options: PlanOptions) -> None:
    model = MACHINES[variant](machine(name))
    needed = fewest(model, path)
    try:
        done = post(model, toolpath(operation_of(path)), options)
    except RefusedError:
        assert not np.isfinite(inverse(model, path.tip, path.axis).joints).all()
        event("out of reach")
        return
    errors = [problem.what for problem in done.plan.problems if problem.severity is Severity.ERROR]
    between = ("in this step of the cut the tool axis leaves its path", "on the way to this point")
    if errors:
        possible = needed.keeps_limits and needed.rewinds < 1 << 20
        event("refused")
        assert not possible or all(what.startswith(between) for what in errors), errors
        return
    assert [str(check) for check in done.found.checks if not check.passed] == []
    notes = [each for motion in done.plan.motions for each in motion.operation.events if isinstance(each, Message)]
    rewinds = sum(each.text.startswith("Rewind: ") for each in notes)
    event(f"rewinds: {rewinds}")
    assert rewinds == needed.rewinds
    low, high = model.limits[list(model.rotary)].T
    assert (done.run.rotary >= low - HALF_DIGIT).all()
    assert (done.run.rotary <= high + HALF_DIGIT).all()


@pytest.mark.parametrize("family", FAMILIES)
@settings(deadline=None, max_examples=examples(6), phases=[Phase.generate])
@given(st.sampled_from(NAMES), st.sampled_from(sorted(MACHINES)), st.data())
def test_with_tcp(family: str, name: str, variant: str, data: st.DataObject) -> None:
    check_plan(name, variant, data.draw(paths(family)), PlanOptions())


@pytest.mark.parametrize("family", FAMILIES)
@settings(deadline=None, max_examples=examples(4), phases=[Phase.generate])
@given(st.sampled_from(NAMES), st.sampled_from(sorted(MACHINES)), st.sampled_from([0.001, 0.01, 0.1]), st.data())
def test_without_tcp(family: str, name: str, variant: str, tolerance: float, data: st.DataObject) -> None:
    check_plan(name, variant, data.draw(paths(family)), PlanOptions(tcp=False, tip_tolerance=tolerance))
