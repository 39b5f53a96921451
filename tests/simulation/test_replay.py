"""Stock that is cut again from states that are kept is that of a simulation that ends there."""

import numpy as np
import pytest

import trunnion
from tests.support.stepped_slot import write_slot
from trunnion.simulation.replay import Replay, changed_box
from trunnion.simulation.simulator import SimulatedProgram, Simulation
from trunnion.simulation.stock.material import Stock


@pytest.fixture(scope="module")
def found(tmp_path_factory: pytest.TempPathFactory) -> Simulation:
    """A simulation of many short rows, so that states are kept on the way."""
    folder = tmp_path_factory.mktemp("replay")
    program, given = write_slot(folder)
    steps = "".join(f"G1 X{25 + 0.2 * k:.2f} Y{0.1 * (k % 7):.2f}\n" for k in range(150))
    program.write_text(program.read_text().replace("N80 G1 X70\n", steps), encoding="utf-8")
    given = {**given, "cell": 1.0, "part": None}
    return trunnion.simulate(program, **given).simulation


def ends(stock: Stock) -> list[np.ndarray]:
    return [column for bundle in range(3) for column in (stock.spans(bundle).first, stock.spans(bundle).ends)]


def cut_at_once(found: Simulation, rows: int) -> Stock:
    job = found.programs[0]
    return trunnion.simulation.simulate(found.model, [SimulatedProgram(job.run, job.tools, rows)]).stock


def test_any_row_in_any_order_is_that_of_a_simulation(found: Simulation) -> None:
    replay = Replay(found.model, found.programs[0])
    for rows in (120, 7, 120, 75, 0, 151, 149, found.programs[0].end):
        assert replay.go_to(rows)
        assert replay.done == rows
        for ours, theirs in zip(ends(replay.stock), ends(cut_at_once(found, rows)), strict=True):
            np.testing.assert_array_equal(ours, theirs)
    assert replay.kept == (0, 50, 100, 150)
    assert replay.go_to(10**9)
    assert replay.done == found.programs[0].end


def test_the_box_of_what_changes_has_all_of_it_and_little_else(found: Simulation) -> None:
    replay = Replay(found.model, found.programs[0])
    replay.go_to(60)
    before = replay.state()
    assert changed_box(before, replay.state()) is None
    replay.go_to(70)
    box = changed_box(before, replay.state())
    assert box is not None
    tips = found.programs[0].run.tip[59:70]
    # A mill of 10 mm, 5 mm deep in stock that is 0 high; rays are half a cell from what they stand for.
    np.testing.assert_array_less(tips.min(axis=0) - np.array([5.0, 5.0, 1e-6]), box[0])
    np.testing.assert_array_less(box[1], tips.max(axis=0) + np.array([5.0, 5.0, 5.0]))
    assert box[1, 0] == pytest.approx(tips[:, 0].max() + 5.0, abs=0.6)
    assert box[1, 2] == pytest.approx(0.0, abs=1e-9)
    back = changed_box(replay.state(), before)
    np.testing.assert_array_equal(box, back)


def test_states_stay_within_their_bound(found: Simulation) -> None:
    replay = Replay(found.model, found.programs[0], bound=1)
    replay.go_to(160)
    assert len(replay.kept) <= 2
    replay.go_to(140)
    for ours, theirs in zip(ends(replay.stock), ends(cut_at_once(found, 140)), strict=True):
        np.testing.assert_array_equal(ours, theirs)


def test_what_nobody_wants_any_more_is_left(found: Simulation) -> None:
    asked: list[int] = []
    replay = Replay(found.model, found.programs[0])

    def go_on() -> bool:
        asked.append(replay.done)
        return len(asked) < 3

    assert not replay.go_to(160, go_on)
    assert replay.done == 100
    assert replay.go_to(160)


def test_the_finished_stock_needs_no_cutting(found: Simulation) -> None:
    replay = Replay(found.model, found.programs[0], found.stock)
    assert replay.go_to(found.programs[0].end, lambda: False)
    for ours, theirs in zip(ends(replay.stock), ends(found.stock), strict=True):
        np.testing.assert_array_equal(ours, theirs)
