"""Arcs become lines only where they must, and the lines stay on the arc."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from trunnion.arrays import Floats
from trunnion.errors import InputError
from trunnion.model.toolpath import Arcs, Dwell, Frame, Kind, Moves, Operation, Tool
from trunnion.planning.linearization.arc_chords import arc_sweeps, arcs_a_control_takes, lines_for_arcs


def arc_operation(
    start: Floats, end: Floats, centre: Floats, normal: Floats, turns: int = 0, axes: Floats | None = None
) -> Operation:
    """A line to the start of an arc, a dwell, the arc, and a line away from it."""
    tip = np.array([start, end, end + np.array([0.0, 0.0, 10.0])])
    axis = np.tile([0.0, 0.0, 1.0], (3, 1)) if axes is None else axes
    kind = np.array([Kind.LINEAR, Kind.ARC, Kind.LINEAR], np.uint8)
    moves = Moves(
        tip, axis, kind, np.zeros(3, np.uint8), np.full(3, 100.0), np.zeros(3, bool), np.array([5, 7, 9], np.int32)
    )
    radius = float(np.linalg.norm(start - centre))
    arcs = Arcs(np.array([1]), centre[None], normal[None], np.array([radius]), np.array([turns]))
    return Operation("ARC", Tool(), Frame(), moves, arcs, (Dwell(1, 6, 2.0), Dwell(2, 8, 1.0), Dwell(3, 9, 1.0)), 1)


def vectors(low: float, high: float) -> st.SearchStrategy[Floats]:
    return st.tuples(*[st.floats(low, high)] * 3).map(np.array)


@st.composite
def any_arc(draw: st.DrawFn) -> tuple[Operation, float, float]:
    """A rising arc anywhere in space: its operation, radius and sweep."""
    normal = draw(vectors(-1, 1).filter(lambda v: np.linalg.norm(v) > 0.1))
    normal = normal / np.linalg.norm(normal)
    across = np.cross(normal, [1.0, 0, 0] if abs(normal[0]) < 0.7 else [0, 1.0, 0])
    across /= np.linalg.norm(across)
    radius, sweep = draw(st.floats(0.5, 200.0)), draw(st.floats(0.05, 2 * np.pi - 0.05))
    centre, rise, turns = draw(vectors(-100, 100)), draw(st.floats(-5, 5)), draw(st.integers(0, 3))
    start = centre + radius * across
    end = centre + radius * (np.cos(sweep) * across + np.sin(sweep) * np.cross(normal, across)) + rise * normal
    return arc_operation(start, end, centre, normal, turns), radius, sweep + 2 * np.pi * turns


@settings(deadline=None, max_examples=examples(25))
@given(any_arc(), st.sampled_from([0.001, 0.01, 0.1]))
def test_lines_for_an_arc_keep_the_chord_tolerance(case: tuple[Operation, float, float], tolerance: float) -> None:
    operation, radius, sweep = case
    assert arc_sweeps(operation)[0] == pytest.approx(sweep, abs=1e-9)
    lines = lines_for_arcs(operation, np.array([False]), tolerance)
    centre, normal = operation.arcs.centre[0], operation.arcs.normal[0]
    points = lines.moves.tip[: len(lines.moves) - 1]
    middle = (points[1:] + points[:-1]) / 2
    for these, slack in ((points, 1e-7), (middle, tolerance * 1.0001 + 1e-7)):
        offset = these - centre
        in_plane = offset - (offset @ normal)[:, None] * normal
        assert np.abs(np.linalg.norm(in_plane, axis=1) - radius).max() <= slack
    assert (lines.moves.tip[-2] == operation.moves.tip[1]).all(), "the end of the arc is met exactly"
    assert (lines.moves.kind != Kind.ARC).all()
    assert len(lines.arcs.row) == 0
    fewest = sweep / (2 * np.arccos(max(1 - tolerance / radius, -1)))
    assert len(lines.moves) - 2 <= fewest + 1.5 or len(lines.moves) <= 4 + sweep / (np.pi / 3)


def test_events_stay_at_the_motion_they_belong_to() -> None:
    operation = arc_operation(np.array([10.0, 0, 0]), np.array([-10.0, 0, 0]), np.zeros(3), np.array([0, 0, 1.0]))
    lines = lines_for_arcs(operation, np.array([False]), 0.01)
    before_arc, after_arc, at_end = (event.row for event in lines.events)
    assert before_arc == 1
    assert lines.moves.line[after_arc] == 9
    assert set(lines.moves.line[before_arc:after_arc]) == {7}
    assert at_end == len(lines.moves)


def test_a_full_circle_goes_all_the_way_round() -> None:
    start = np.array([-41.213, 0.0, -0.99])
    operation = arc_operation(start, start, np.array([0, 0, -0.99]), np.array([0, 0, -1.0]))
    assert arc_sweeps(operation)[0] == pytest.approx(2 * np.pi)


@pytest.mark.parametrize(("end", "kept"), [(0.0, True), (1e-6, True), (0.0004, False), (0.01, True)])
def test_a_control_gets_no_arc_that_ends_a_hair_from_its_start_but_full_circles(end: float, kept: bool) -> None:
    start = np.array([10.0, 0, 0])
    hair = np.array([10 * np.cos(end / 10), 10 * np.sin(end / 10), 0])
    operation = arc_operation(start, hair, np.zeros(3), np.array([0, 0, 1.0]))
    assert bool(arcs_a_control_takes(operation)[0]) is kept
    if not kept:
        lines = lines_for_arcs(operation, np.array([False]), 0.001)
        longest = np.linalg.norm(lines.moves.tip - [10.0, 0, 0], axis=1)[:-1].max()
        assert longest < 0.001


def test_an_arc_is_kept_in_the_three_planes_and_with_a_constant_tool_axis_only() -> None:
    start, end = np.array([10.0, 0, 0]), np.array([-10.0, 0, 0])
    upright = arc_operation(start, end, np.zeros(3), np.array([0, 0, 1.0]))
    oblique = arc_operation(start, end, np.zeros(3), np.array([0, 0.6, 0.8]))
    tilting = arc_operation(
        start, end, np.zeros(3), np.array([0, 0, 1.0]), axes=np.array([[0, 0, 1.0], [0, 0.6, 0.8], [0, 0.6, 0.8]])
    )
    assert [bool(arcs_a_control_takes(o)[0]) for o in (upright, oblique, tilting)] == [True, False, False]
    turned = lines_for_arcs(tilting, np.array([False]), 0.01).moves.axis
    tilt = np.degrees(np.arctan2(turned[:-1, 1], turned[:-1, 2]))
    assert np.allclose(np.diff(tilt), np.diff(tilt)[0], atol=1e-9), "the tool axis turns evenly along the arc"
    assert tilt[-1] == pytest.approx(np.degrees(np.arctan2(0.6, 0.8)))


def test_arcs_that_would_become_too_many_lines_are_refused() -> None:
    start, end, up = np.array([1000.0, 0.0, 0.0]), np.array([1000.0, 0.0, 50.0]), np.array([0.0, 0.0, 1.0])
    operation = arc_operation(start, end, np.zeros(3), up, turns=9_999)
    # A chord of a radius of a metre that leaves it by 1e-6 mm spans 2 sqrt(2e-9) rad: 70,248 in a turn.
    with pytest.raises(InputError, match=r"become 70[0-9]{7} lines") as raised:
        lines_for_arcs(operation, np.zeros(1, np.bool_), 1e-6)
    assert raised.value.problems[0].code == "PLN550"
