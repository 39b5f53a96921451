"""Where the time of a machining step goes, and the setting that would give the published time."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from trunnion.impeller.paths.passes import Stepover
from trunnion.impeller.steps import MachiningStep, StepKind
from trunnion.jobs.impeller.step_times import StepTimes, setting_for_published, step_times
from trunnion.model.toolpath import Arcs, Frame, Moves, Operation, Phase, Tool
from trunnion.verification.results import OperationRows

STEP = cast(
    MachiningStep,
    SimpleNamespace(kind=StepKind.BLADE_FINISH, stepover=Stepover(distance=0.2), published_minutes=8.95, feed=200.0),
)
TIMES = StepTimes(45.55, 5.05, 2.02, 9110.0, 0.0, 92)


def changed(**values: object) -> MachiningStep:
    return cast(MachiningStep, SimpleNamespace(**{**vars(STEP), **values}))


def test_the_step_over_that_gives_the_published_time() -> None:
    found = setting_for_published(STEP, TIMES)
    assert found is not None
    assert (found.passes, found.key, found.value) == (16, "stepover_mm", 1.214)
    assert found.minutes == pytest.approx(TIMES.minutes * 16 / 92)


@pytest.mark.parametrize(
    "step",
    [
        changed(published_minutes=0.0),
        changed(published_minutes=45.0),
        changed(kind=StepKind.STOCK_FINISHING),
        changed(stepover=Stepover(scallop=0.01)),
    ],
)
def test_nothing_is_proposed_where_it_says_nothing(step: MachiningStep) -> None:
    assert setting_for_published(step, TIMES) is None
    assert setting_for_published(STEP, replace(TIMES, passes=1)) is None


def test_the_step_down_that_gives_the_published_time_of_a_helix() -> None:
    """As measured: 4806 mm at 1.5 mm down are 9.65 min, and 345.5 mm of them the turn at the bottom."""
    helix = changed(kind=StepKind.STOCK_ROUGHING, step_down=1.5, published_minutes=5.23)
    times = StepTimes(9.52, 0.095, 0.03, 4806.3, 345.5, 1)
    found = setting_for_published(helix, times)
    assert found is not None
    assert (found.key, found.passes) == ("step_down_mm", 0)
    assert found.value == pytest.approx(3.0, abs=0.02)  # posted with 3 mm it takes 5:14 min
    assert setting_for_published(changed(**{**vars(helix), "published_minutes": 0.7}), times) is None


def test_seconds_are_divided_by_what_the_cl_file_does_in_them() -> None:
    n = 7
    tip = np.zeros((n, 3))
    tip[:, 0] = [0, 10, 20, 30, 30, 40, 50]
    phase = np.array([1, Phase.ENGAGE, Phase.CUT, Phase.CUT, Phase.RETRACT, Phase.CUT, 1], np.uint8)
    kind = np.array([0, 1, 1, 1, 1, 1, 0], np.uint8)
    feed = np.array([200.0, 1000.0, 200.0, 200.0, 1000.0, 200.0, 200.0])
    moves = Moves(
        tip,
        np.tile([0.0, 0.0, 1.0], (n, 1)),
        kind,
        phase,
        feed,
        np.zeros(n, np.bool_),
        np.arange(10, 10 + n, dtype=np.int32),
    )
    operation = Operation("A", Tool(), Frame(), moves, Arcs.empty(), (), 1)
    seconds = np.array([60.0, 1.0, 2.0, 3.0, 3.0, 4.0, 3.0, 5.0])
    line = np.array([0, 10, 11, 12, 13, 14, 15, 16], np.int32)
    proof = cast(Any, SimpleNamespace(seconds=seconds, tip_feed=np.ones(8), cl_line=line))
    rows = OperationRows("A", "1", "a.cls", 0, 8)
    found = step_times(200.0, [operation], [rows], proof)
    assert (found.cuts * 60, found.leads * 60, found.rest * 60) == pytest.approx((9.0, 6.0, 66.0))
    assert (found.cut, found.level, found.passes) == (30.0, 30.0, 2)
    assert found.minutes * 60 == pytest.approx(seconds.sum())
