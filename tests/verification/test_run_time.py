"""Times of runs and of planned motions: never less than the machine needs, never more than with a stop at every row."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.support.locations import YL569
from tests.support.operations import moves_of, operation_of, rapids_at
from tests.support.pole_paths import around_pole
from trunnion.cl import read_cl
from trunnion.machines import Machine, load_machine, slide_positions
from trunnion.model.motion import MachiningMode, Motion
from trunnion.model.toolpath import Dwell, Operation, Toolpath
from trunnion.planning import PlanOptions, operation_seconds, plan
from trunnion.planning.rotary_positions import continuous_positions
from trunnion.planning.speed.operation_time import row_durations
from trunnion.readers import run_program
from trunnion.verification import Verification, time_lines, verify

BC = load_machine("generic_head_table_bc")

#: Ten times what six thousand random operations take longer with a higher feed, and more than any three rows do.
HARDLY_LONGER = 1.05


def ramped(machine: Machine) -> Machine:
    """The machine with an acceleration for each axis."""
    return replace(machine, axes=tuple(replace(axis, acceleration=axis.acceleration or 800.0) for axis in machine.axes))


@st.composite
def operations(draw: st.DrawFn) -> Operation:
    """Cuts and rapids, smooth or rough, away from the pole and near it."""
    n = draw(st.integers(2, 60))
    seed = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    tip = np.cumsum(seed.normal(size=(n, 3)) * draw(st.sampled_from([0.02, 1.0, 20.0])), axis=0)
    x, y = np.cumsum(seed.normal(size=(2, n)) * draw(st.sampled_from([0.0, 0.05, 1.0])), axis=1)
    moves = moves_of(tip, around_pole(BC, np.clip(x + 10.0, -30.0, 80.0), np.clip(y, -60.0, 60.0)))
    moves = replace(moves, feed=np.full(n, draw(st.floats(10.0, 20000.0))))
    return operation_of(rapids_at(moves, [row for row in range(n) if seed.random() < 0.1]))


def motion_of(operation: Operation, feed: float = 1.0) -> Motion:
    """The planned motion, with the feed times a factor."""
    moves = operation.moves
    operation = replace(operation, moves=replace(moves, feed=feed * moves.feed))
    return plan([Toolpath("part.cls", (operation,))], BC, 0.001, PlanOptions()).motions[0]


def rest_to_rest(way: float, top: float, ramp: float) -> float:
    """Least time from rest to rest."""
    return 2.0 * float(np.sqrt(way / ramp)) if way < top**2 / ramp else way / top + top / ramp


@given(operations())
def test_no_axis_is_faster_than_it_can_be_and_no_row_than_its_feed(operation: Operation) -> None:
    motion = motion_of(operation)
    times, moves = row_durations(BC, motion), motion.operation.moves
    assert np.isfinite(times).all()
    way = np.linalg.norm(np.diff(moves.tip, axis=0), axis=1)
    fed = (moves.kind[1:] != 0) & (way > 1e-9)
    assert (times[1:][fed] >= 60.0 * way[fed] / moves.feed[1:][fed] * (1.0 - 1e-9)).all()
    steps = np.abs(np.diff(slide_positions(BC, moves.tip, continuous_positions(BC, motion.rotary)), axis=0))
    for k, axis in enumerate(BC.axes):
        assert axis.rapid is not None
        assert (steps[:, k] <= axis.rapid / 60.0 * times[1:] * (1.0 + 1e-9) + 1e-9).all()


@given(operations())
def test_a_stop_at_every_row_is_no_faster(operation: Operation) -> None:
    motion = motion_of(operation)
    stops = tuple(Dwell(row, 1, 0.0) for row in range(1, len(motion.operation.moves)))
    stopping = replace(motion, operation=replace(motion.operation, events=stops))
    assert row_durations(BC, motion).sum() <= row_durations(BC, stopping).sum() * (1.0 + 1e-9)


@given(operations(), st.floats(1.0, 20.0))
def test_a_higher_feed_is_hardly_slower(operation: Operation, factor: float) -> None:
    """Corners are as long as the feed needs that each bears by itself; a longer one leaves less room for ramps."""
    slow, fast = (row_durations(BC, motion_of(operation, each)).sum() for each in (1.0, factor))
    assert fast <= slow * HARDLY_LONGER


def test_a_dwell_takes_its_time() -> None:
    tip = np.column_stack((np.linspace(0.0, 100.0, 11), np.zeros(11), np.zeros(11)))
    operation = operation_of(replace(moves_of(tip, np.tile([0.0, 0.0, 1.0], (11, 1))), feed=np.full(11, 6000.0)))
    motion = Motion(operation, np.zeros((11, 2)), MachiningMode.THREE_AXIS)
    top, ramp = 100.0, 4000.0
    assert operation_seconds(BC, motion) == pytest.approx(rest_to_rest(100.0, top, ramp))
    dwelling = replace(motion, operation=replace(operation, events=(Dwell(5, 1, 2.5),)))
    assert operation_seconds(BC, dwelling) == pytest.approx(
        2.5 + rest_to_rest(40.0, top, ramp) + rest_to_rest(60.0, top, ramp)
    )


@pytest.fixture(scope="module")
def proven() -> Verification:
    machine = ramped(load_machine("yl569"))
    paths = [read_cl(YL569 / "3_blade_finish.cls")]
    return verify(run_program(YL569 / "3_blade_finish.expected.mpf", machine), paths)


def test_a_run_takes_what_its_axes_need(proven: Verification) -> None:
    run, machine = proven.run, proven.machine
    steps = np.abs(np.diff(run.joints, axis=0))
    for k, axis in enumerate(machine.axes):
        assert axis.rapid is not None
        assert (steps[:, k] <= axis.rapid / 60.0 * proven.seconds[1:] * (1.0 + 1e-9) + 1e-9).all()
    lazy = verify(run_program(YL569 / "3_blade_finish.expected.mpf", load_machine("yl569")))
    assert lazy.seconds.sum() < proven.seconds.sum()


@pytest.mark.parametrize(("dwell", "wait"), [("G4 F2.5", 2.5), ("G4 S100", 100 * 60.0 / 2500.0)])
def test_a_run_waits_where_its_program_does(tmp_path: Path, dwell: str, wait: float) -> None:
    machine, path = load_machine("yl569"), YL569 / "3_blade_finish.expected.mpf"
    lines = path.read_text(encoding="utf-8").splitlines(keepends=True)
    place = next(k for k, line in enumerate(lines) if " G1 " in line) + 20
    waiting, passing = tmp_path / "waiting.mpf", tmp_path / "passing.mpf"
    waiting.write_text("".join([*lines[:place], f"{dwell}\n", *lines[place:]]), encoding="utf-8")
    passing.write_text("".join([*lines[:place], "G4 F0\n", *lines[place:]]), encoding="utf-8")
    waits, passes = (verify(run_program(each, machine), columns=True) for each in (waiting, passing))
    assert waits.seconds.sum() - passes.seconds.sum() == pytest.approx(wait)
    assert np.array_equal(waits.tip_feed, passes.tip_feed)
    # The tool waits at the end of the row before: a dwell at the end of an operation belongs to it.
    (event,) = (each for each in waits.run.events if each.kind == "dwell")
    assert np.flatnonzero(waits.seconds - passes.seconds > 0.1).tolist() == [event.before_row - 1]


def test_operations_divide_all_rows_among_them(proven: Verification) -> None:
    assert [share.name for share in proven.operations] == [
        operation.name for operation in read_cl(YL569 / "3_blade_finish.cls").operations if len(operation.moves)
    ]
    assert proven.operations[0].first == 0
    assert proven.operations[-1].end == len(proven.run)
    for before, after in zip(proven.operations, proven.operations[1:], strict=False):
        assert before.end == after.first
    lines = list(time_lines(proven))
    assert len(lines) == 1 + len(proven.operations)
    assert lines[0].startswith("time: ")


def test_a_template_prints_times_and_others_cost_nothing(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    from trunnion.cli import main

    machine = tmp_path / "timed.toml"
    machine.write_text(
        'schema = 1\nextends = "yl569"\n[control.templates]\nfirst_tool = ";{operation} {time} of {total_time}"\n',
        encoding="utf-8",
    )
    source, target = YL569 / "3_blade_finish.cls", tmp_path / "timed.mpf"
    assert main(["post", str(source), "--machine", str(machine), "--output", str(target), "--force"]) == 1
    text = target.read_text(encoding="utf-8")
    assert " s of " in text or " min of " in text
    capfd.readouterr()


def test_a_rapid_of_an_axis_without_a_stated_speed_has_no_feed(tmp_path: Path) -> None:
    """It took what another axis needed for a rounding of 1e-12 mm, and had 1e20 mm/min."""
    yl569 = load_machine("yl569")
    machine = replace(yl569, axes=tuple(replace(axis, rapid=None) if axis.name == "X" else axis for axis in yl569.axes))
    program = tmp_path / "part.mpf"
    program.write_text("G54 G90 G17 G710 G94\nG0 X0 Y0 Z50 B0 C0\nG0 X300 Z50.0000000001\nG0 Y20\nG1 X0 F500\nM30\n")
    found = verify(run_program(program, machine), columns=True)
    assert np.isnan(found.tip_feed).tolist()[1:] == [True, False, False]
    assert found.tip_feed[2] > 0.0
    assert found.tip_feed[3] == pytest.approx(500.0)
    every = verify(run_program(program, yl569), columns=True)
    assert np.isfinite(every.tip_feed).all()
