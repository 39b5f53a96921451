"""Recordings against the program: what is on the path is found there, what is off it is named by its block."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.recordings import blade, recorded, with_values
from trunnion.arrays import Floats
from trunnion.errors import InputError
from trunnion.machines import forward
from trunnion.model.recording import Mark, Recording
from trunnion.verification.context import Context, ExpectedValues
from trunnion.verification.recorded import check_recorded, compare_recording
from trunnion.verification.recorded.nearest import LEVER, nearest_places
from trunnion.verification.recorded.path import ProgramPath
from trunnion.verification.results import Check


def checked(recording: Recording, tolerance: float = 0.05) -> Check:
    run = blade().run
    return check_recorded(Context(run, ExpectedValues()), compare_recording(run, recording, tolerance))


def times(count: int = 900) -> Floats:
    return np.linspace(0.0, blade().duration, count)


@pytest.mark.parametrize("with_lines", [True, False])
def test_a_machine_that_does_what_it_should_is_on_the_path(with_lines: bool) -> None:
    compared = compare_recording(blade().run, recorded(blade(), times(), with_lines=with_lines), 0.05)
    at = compared.compared
    assert compared.by_line is with_lines
    assert len(at) > 700
    assert compared.tip_off[at].max() < 1e-9
    assert compared.axis_off[at].max() < 1e-9
    state = blade().at(times())
    assert (np.abs(compared.row[at] - state.row[at]) <= 1).all()
    assert (np.diff(compared.row[at]) >= 0).all()


@pytest.mark.parametrize("with_lines", [True, False])
@pytest.mark.parametrize("axis", ["X", "Y", "Z", "B", "C"])
def test_an_axis_that_is_off_in_one_block_fails_that_block(axis: str, with_lines: bool) -> None:
    seconds = times(3000)
    recording, run = recorded(blade(), seconds, with_lines=with_lines), blade().run
    row = 60
    inside = (seconds > blade().begins[row] + 1e-6) & (seconds < blade().ends[row] - 1e-6)
    assert inside.any()
    off = with_values(recording, **{axis: recording.values[axis] + np.where(inside, 0.4, 0.0)})
    check = checked(off)
    assert not check.passed
    # Without lines, nobody can tell a place in one block from the place in the next one that is nearest to it.
    named = {int(run.block_number[k]) for k in ([row] if with_lines else range(row - 3, row + 4))}
    assert {place.number for place in check.places} <= named
    assert "the machine was" in check.summary
    assert checked(off, 2.0).passed


def test_an_axis_that_is_off_throughout_fails() -> None:
    recording = recorded(blade(), times())
    check = checked(with_values(recording, X=recording.values["X"] + 0.3))
    assert not check.passed
    assert check.worst is not None
    assert check.worst == pytest.approx(0.3, abs=0.02)


def test_without_a_line_a_recording_of_something_else_fails() -> None:
    recording = recorded(blade(), times(), with_lines=False)
    check = checked(with_values(recording, X=recording.values["X"] + 500.0))
    assert not check.passed
    assert "no position" in check.summary


def test_blocks_without_a_position_are_told() -> None:
    run = blade().run
    seconds = np.union1d(times(), blade().ends)
    state = blade().at(seconds)
    kept = (state.row < 80) | (state.row > 84)
    check = checked(recorded(blade(), seconds[kept]))
    assert check.passed
    assert f"5 motions have no position, the first is N{run.block_number[80]}" in check.summary


def test_positions_in_other_programs_are_not_compared() -> None:
    recording = recorded(blade(), times())
    texts = recording.texts["program"]
    codes = texts.codes.copy()
    codes[:300] = 2
    others = type(texts)(codes, (*texts.names, "/_N_MPF_DIR/_N_OTHER_MPF"))
    both = Recording("x.csv", recording.source, recording.received, {}, recording.values, {"program": others})
    assert "300 positions in other programs" in checked(both).summary


def test_a_program_that_runs_twice_is_followed_twice() -> None:
    once = recorded(blade(), times(600), with_lines=False)
    values = {name: np.concatenate((column, column)) for name, column in once.values.items()}
    stamps = np.concatenate((once.source, once.source + 10**9))
    twice = Recording("x.csv", stamps, stamps, {}, values, {})
    single, double = (compare_recording(blade().run, each, 0.05) for each in (once, twice))
    assert len(double.compared) >= 2 * len(single.compared) - 40
    assert double.tip_off[double.compared].max() < 1e-9


def test_tips_in_place_of_slides_are_compared_too() -> None:
    recording, run = recorded(blade(), times()), blade().run
    joints = np.column_stack([recording.values[name] for name in run.machine.names])
    tip = forward(run.machine, joints)[0]
    values = {f"tip_{name}": tip[:, k] for k, name in enumerate("xyz")}
    values |= {name: recording.values[name] for name in ("B", "C", "line")}
    only_tip = Recording("x.csv", recording.source, recording.received, {}, values, recording.texts)
    compared = compare_recording(run, only_tip, 0.05)
    assert compared.joints is None
    assert compared.tip_off[compared.compared].max() < 1e-9


def test_a_recording_without_an_axis_is_refused() -> None:
    recording = recorded(blade(), times(20))
    values = {name: column for name, column in recording.values.items() if name != "B"}
    with pytest.raises(InputError, match="has no column B; a recording for yl569 has the axes"):
        checked(Recording("x.csv", recording.source, recording.received, {}, values, {}))


def test_elapsed_time_goes_by_the_machine_and_across_gaps_by_arrival() -> None:
    stamp = np.array([1000, 2000, -1, 9000, 500, 1500], np.int64) * 1000
    stamp[2] = -1
    received = np.array([1001, 2001, 5001, 9001, 9101, 10101], np.int64) * 1000
    recording = Recording("x", stamp, received, {2: (Mark.GAP,), 4: (Mark.BACK,)}, {}, {})
    assert recording.elapsed().tolist() == pytest.approx([0.0, 1.0, 4.0, 8.0, 8.1, 9.1])


@settings(max_examples=25, deadline=None)
@given(
    at=st.floats(0.0, 1.0), off=st.tuples(*[st.floats(-2.0, 2.0)] * 3), turn=st.floats(-1.0, 1.0),
    row=st.integers(10, 140),
)  # fmt: skip
def test_the_nearest_place_is_nearer_than_any_other_of_its_pieces(
    at: float, off: tuple[float, float, float], turn: float, row: int
) -> None:
    path = ProgramPath.of(blade().run)
    low, high = int(path.first[row - 3]), int(path.first[row + 4])
    piece = int(path.first[row])
    joints = path.begin[piece] + at * (path.end[piece] - path.begin[piece])
    joints[3] += turn
    tip, axis = forward(path.machine, joints[None])
    tip = tip + np.array(off)
    found = nearest_places(path, tip, axis, np.array([low]), np.array([high]))
    parts = np.linspace(0.0, 1.0, 41)[:, None]
    many = np.concatenate([path.begin[k] + parts * (path.end[k] - path.begin[k]) for k in range(low, high)])
    tips, axes = forward(path.machine, many)
    away = np.hypot(np.linalg.norm(tips - tip, axis=1), LEVER * np.linalg.norm(axes - axis, axis=1))
    assert found.measure[0] <= away.min() + 1e-3
    assert found.measure[0] >= 0.0
