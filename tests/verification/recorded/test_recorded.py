"""Recordings against the program: what is on the path is found there, what is off it is named by its block."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.recordings import blade, recorded, with_values
from trunnion.arrays import Floats, Ints
from trunnion.errors import InputError
from trunnion.machines import forward
from trunnion.model.recording import NO_TIME, Mark, Recording, TextColumn
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


@pytest.mark.third
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
    assert not check.passed
    missing = f"N{run.block_number[80]} to N{run.block_number[84]}, 5 motions, were not recorded; ONLY "
    assert check.summary.startswith(missing)


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


@settings(max_examples=examples(25), deadline=None)
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


def rows_of(recording: Recording, rows: Ints) -> Recording:
    """Some rows of a recording, in some order."""
    values = {name: column[rows] for name, column in recording.values.items()}
    texts = {name: TextColumn(column.codes[rows], column.names) for name, column in recording.texts.items()}
    return Recording(recording.file, recording.source[rows], recording.received[rows], {}, values, texts)


def with_times_of(recording: Recording, other: Recording) -> Recording:
    return Recording(other.file, other.source, other.received, {}, recording.values, recording.texts)


@pytest.mark.parametrize("with_lines", [True, False])
def test_a_recording_that_goes_back_fails(with_lines: bool) -> None:
    good = recorded(blade(), np.union1d(times(), blade().ends), with_lines=with_lines)
    assert checked(good).passed
    turned = rows_of(good, np.arange(len(good))[::-1])
    check = checked(turned)
    assert not check.passed
    assert "its time falls" in check.summary
    assert not checked(with_times_of(turned, good)).passed
    parts = np.array_split(np.arange(len(good)), 12)
    again = np.concatenate([*parts[:7], *parts[4:]])  # through a part of the program once more
    assert not checked(rows_of(good, again)).passed


@pytest.mark.parametrize("with_lines", [True, False])
def test_a_machine_may_run_the_program_once_more_while_nobody_sees_it(with_lines: bool) -> None:
    good = recorded(blade(), np.union1d(times(), blade().ends), with_lines=with_lines)
    first, rest = np.arange(2 * len(good) // 3), np.arange(len(good) // 3, len(good))
    gap = len(first)
    cut = rows_of(good, np.concatenate([first, [0, 0], rest]))
    cut.source[gap] = NO_TIME
    cut.source[gap + 2 :] += good.source[-1] - good.source[0]
    cut.received[gap:] = cut.source[gap + 2]  # a value that had not changed since the start was read there as well
    cut.received[gap + 2 :] = cut.source[gap + 2 :]
    for column in cut.values.values():
        column[gap : gap + 2] = np.nan
    marked = replace(cut, marks={gap: (Mark.GAP,)})
    assert checked(marked).passed, checked(marked).summary
    check = checked(cut)
    assert not check.passed
    assert "its time falls" in check.summary
    assert not with_lines or "1 more place" in check.summary


def test_motions_of_a_run_that_nobody_saw_begin_are_in_the_gap() -> None:
    moments = np.union1d(times(), blade().ends)
    good, rows = recorded(blade(), moments), blade().at(moments).row
    before, after = np.flatnonzero((rows >= 70) & (rows < 110)), np.flatnonzero((rows >= 100) | (rows < 40))
    after = np.concatenate([after[rows[after] >= 100], after[rows[after] < 40]])
    cut = rows_of(good, np.concatenate([before, after]))
    rising = good.source[0] + 20_000 * np.arange(len(cut))
    cut = replace(cut, source=rising, received=rising)
    assert any("were not recorded" in place.text for place in checked(cut).places)
    check = checked(replace(cut, marks={len(before): (Mark.GAP,)}))
    assert check.passed, check.summary
    assert "while the connection was broken" in check.summary


def test_lines_that_go_back_are_told_of_their_block() -> None:
    good = recorded(blade(), times())
    line = good.values["line"].copy()
    row = blade().at(times()).row
    line[row == 75] = blade().run.line[60]
    check = checked(with_values(good, line=line))
    assert not check.passed
    assert "the machine went back in the program" in check.summary


def test_a_block_search_leaves_a_hole() -> None:
    good = recorded(blade(), np.union1d(times(), blade().ends))
    rows = blade().at(np.union1d(times(), blade().ends)).row
    skipped = rows_of(good, np.flatnonzero((rows < 70) | (rows > 120)))
    check = checked(with_times_of(skipped, rows_of(good, np.arange(len(skipped)))))
    assert not check.passed
    assert "were not recorded" in check.summary


def test_a_recording_without_any_time_fails() -> None:
    good = recorded(blade(), times())
    none = Recording("x.csv", np.full(len(good), -1), good.received, {}, good.values, good.texts)
    assert "no row of the recording says when it was" in checked(none).summary
    assert not checked(none).passed


@pytest.mark.parametrize(("share", "passes"), [(1.0, True), (1.08, True), (1.2, False), (0.8, False), (0.04, False)])
def test_the_spindle_is_judged_in_cuts(share: float, passes: bool) -> None:
    good = recorded(blade(), times())
    check = checked(with_values(good, spindle=good.values["spindle"] * share))
    assert check.passed is passes
    assert ("the spindle turned at" in check.summary) is not passes


def test_a_part_of_the_program_is_told_to_be_one() -> None:
    good = recorded(blade(), times())
    check = checked(rows_of(good, np.arange(len(good) // 2)))
    assert check.passed
    assert check.summary.startswith("ONLY ")
    assert "all of the path was recorded" in checked(good).summary


@pytest.mark.parametrize("name", ["OTHER.MPF"])
def test_the_name_of_another_program_is_told(name: str) -> None:
    good = recorded(blade(), times())
    other = {"program": TextColumn(np.ones(len(good), np.int64), ("", name))}
    check = checked(Recording("x.csv", good.source, good.received, {}, good.values, other))
    assert check.summary.startswith("the machine calls the program OTHER.MPF")


@pytest.mark.parametrize("line", [9999.0, np.nan, 45.0, 0.0, -1.0])
def test_positions_off_the_path_fail_whatever_line_they_tell(line: float) -> None:
    good = recorded(blade(), times())
    z, lines = good.values["Z"].copy(), good.values["line"].copy()
    z[430:490] -= 60.0
    lines[430:490] = line
    assert not checked(with_values(good, Z=z, line=lines)).passed
    empty = good.values["line"].copy()
    empty[430:490] = np.nan
    assert checked(with_values(good, line=empty)).passed


def test_positions_off_the_path_fail_in_another_program_too() -> None:
    good = recorded(blade(), times())
    z, codes = good.values["Z"].copy(), np.ones(len(good), np.int64)
    z[430:490] -= 60.0
    codes[430:490] = 2
    program = {"program": TextColumn(codes, ("", *good.texts["program"].names[1:], "X.MPF"))}
    assert not checked(Recording("x.csv", good.source, good.received, {}, {**good.values, "Z": z}, program)).passed


@settings(max_examples=examples(8), deadline=None)
@given(
    share=st.floats(0.1, 0.6), off=st.sampled_from([-200.0, -60.0, 10.0, 20.0, 50.0, 100.0, 200.0]),
    axis=st.sampled_from("XYZ"),
)  # fmt: skip
def test_one_position_far_off_fails_without_lines(share: float, off: float, axis: str) -> None:
    good = recorded(blade(), times(), with_lines=False)
    column = good.values[axis].copy()
    column[int(share * 900)] += off
    compared = compare_recording(blade().run, with_values(good, **{axis: column}), 0.05)
    known = compare_recording(blade().run, good, 0.05).row[int(share * 900)] >= 0
    assert not known or compared.tip_off[compared.compared].max() > 0.05


def test_two_columns_for_an_axis_are_refused() -> None:
    good = recorded(blade(), times(20))
    with pytest.raises(InputError, match="has two columns for axis X"):
        checked(with_values(good, x=good.values["X"]))
