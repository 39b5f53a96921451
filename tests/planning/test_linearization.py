"""Points between CL points: enough by a look at every hundredth of the path, and no more than needed."""

import math
from dataclasses import replace
from typing import TypeAlias

import numpy as np
import pytest
from hypothesis import Phase, assume, event, given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.machines import five_axis_machines
from trunnion.arrays import Floats
from trunnion.machines import Machine, forward, inverse, load_machine, slide_positions
from trunnion.planning.linearization.intermediate_points import DividedPath, divide_path
from trunnion.planning.linearization.leg_division import PathRows

NAMES = sorted(five_axis_machines())
ZERO = (37.0, -21.0, 110.0)


def machine(name: str) -> Machine:
    """A machine with a part that is clamped off its rotary axes."""
    return replace(load_machine(name), workpiece_zero=ZERO)


def great_circle(begin: Floats, end: Floats, part: Floats) -> Floats:
    """(k, 3) unit vectors."""
    angle = math.atan2(float(np.linalg.norm(np.cross(begin, end))), float(begin @ end))
    if angle < 1e-9:
        return np.repeat(begin[None], len(part), axis=0)
    vectors = np.sin((1.0 - part) * angle)[:, None] * begin + np.sin(part * angle)[:, None] * end
    return np.asarray(vectors / np.linalg.norm(vectors, axis=1)[:, None])


def followed(model: Machine, tip: Floats, axis: Floats) -> Floats:
    """Rotary positions of dense rows, as they wind, in the branch that is nearer to home at the first row."""
    found = inverse(model, tip, axis)
    options = found.joints[..., list(model.rotary)]
    last = np.array([model.axes[c].home for c in model.rotary])
    side = int(np.abs((options[:, 0] - last + 180.0) % 360.0 - 180.0).sum(axis=1).argmin())
    rotary = np.empty((len(tip), 2))
    for row in range(len(tip)):
        wound = options[side, row] + 360.0 * np.round((last - options[side, row]) / 360.0)
        if found.pole[row]:
            wound[0] = last[0]
        rotary[row] = last = wound
    return rotary


def axes_of(model: Machine, tip: Floats, axis: Floats) -> Floats:
    """Rotary positions of a path, followed in small steps from point to point."""
    part = np.linspace(0.0, 1.0, 101)
    looks = [axis[:1], *(great_circle(axis[row - 1], axis[row], part) for row in range(1, len(axis)))]
    dense = np.concatenate(looks)
    return followed(model, np.zeros_like(dense), dense)[:: len(part)]


def off(model: Machine, tip: Floats, axis: Floats, spans: DividedPath, tcp: bool) -> tuple[float, float]:
    """How far the tip is off the CAM's line, mm, and the tool axis off its great circle, degrees, at most."""
    joints = np.empty((len(spans.tip), 5))
    joints[:] = slide_positions(model, spans.tip, spans.rotary)
    worst_tip = worst_axis = 0.0
    share = np.linspace(0.0, 1.0, 101)[:, None]
    for k in range(1, len(spans.tip)):
        row = int(spans.source[k])
        if row == 0:
            continue
        p, q = tip[row - 1], tip[row]
        way = joints[k - 1] + share * (joints[k] - joints[k - 1])
        now, look = forward(model, way)
        if tcp:
            now = spans.tip[k - 1] + share * (spans.tip[k] - spans.tip[k - 1])
        first, last = ((spans.tip[k - 1 : k + 1] - p) @ (q - p) / ((q - p) @ (q - p))).tolist()
        part = np.clip((now - p) @ (q - p) / ((q - p) @ (q - p)), max(first, 0.0), last)
        worst_tip = max(worst_tip, float(np.linalg.norm(now - p - part[:, None] * (q - p), axis=1).max()))
        wanted = great_circle(axis[row - 1], axis[row], first + share[:, 0] * (last - first))
        worst_axis = max(worst_axis, float(np.degrees(2 * np.arcsin(np.linalg.norm(look - wanted, axis=1) / 2)).max()))
    return worst_tip, worst_axis


steps = st.tuples(st.floats(-30.0, 30.0), st.floats(-30.0, 30.0), st.floats(-20.0, 20.0))
leans = st.tuples(st.floats(-0.6, 0.6), st.floats(-0.6, 0.6))

#: Steps of the tip, each with the lean of the tool axis in X and Y.
Path: TypeAlias = list[tuple[tuple[float, float, float], tuple[float, float]]]


def points(path: Path) -> tuple[Floats, Floats]:
    """Tips and tool axes (n, 3)."""
    tip = np.cumsum([step for step, _ in path], axis=0)
    assume(np.linalg.norm(np.diff(tip, axis=0), axis=1).min() > 0.1)
    axis = np.array([[i, j, 1.0] for _, (i, j) in path])
    return tip, axis / np.linalg.norm(axis, axis=1)[:, None]


def divided(
    model: Machine, tip: Floats, axis: Floats, tcp: bool, tip_tolerance: float, axis_tolerance: float
) -> tuple[Floats, DividedPath]:
    """Rotary positions (n, 2), and the path with its points."""
    rotary = axes_of(model, tip, axis)
    assume(np.isfinite(rotary).all())
    divisible = np.ones(len(tip), bool)
    return rotary, divide_path(
        model,
        PathRows(tip, axis, rotary),
        divisible,
        tcp=tcp,
        tip_tolerance=tip_tolerance,
        axis_tolerance=axis_tolerance,
    )


@settings(deadline=None, max_examples=examples(25), phases=[Phase.generate])
@given(
    st.sampled_from(NAMES),
    st.lists(st.tuples(steps, leans), min_size=2, max_size=5),
    st.booleans(),
    st.sampled_from([0.001, 0.01, 0.1]),
    st.sampled_from([0.01, 0.05, 0.5]),
)
def test_the_tool_stays_within_its_tolerances(
    name: str, path: Path, tcp: bool, tip_tolerance: float, axis_tolerance: float
) -> None:
    model = machine(name)
    tip, axis = points(path)
    rotary, spans = divided(model, tip, axis, tcp, tip_tolerance, axis_tolerance)
    last = np.flatnonzero(np.diff(np.append(spans.source, len(tip))))
    np.testing.assert_array_equal(spans.tip[last], tip)
    np.testing.assert_array_equal(spans.rotary[last], rotary)
    worst_tip, worst_axis = off(model, tip, axis, spans, tcp)
    assert worst_tip <= tip_tolerance * (1.0 + 1e-6) + 1e-9
    assert worst_axis <= axis_tolerance * (1.0 + 1e-6) + 1e-7


def fewest(
    model: Machine, tip: Floats, axis: Floats, rotary: Floats, tolerance: tuple[float, float], tcp: bool, nodes: int
) -> int:
    """The fewest spans between ``nodes`` evenly spaced points, by trying all of them."""
    grid = np.linspace(0.0, 1.0, nodes + 1)
    tips = tip[0] + grid[:, None] * (tip[1] - tip[0])
    axes = great_circle(axis[0], axis[1], grid)
    winding = followed(model, tips, axes)
    winding += np.round((rotary[0] - winding[0]) / 360.0) * 360.0
    joints = slide_positions(model, tips, winding)
    first, last = np.triu_indices(nodes + 1, 1)
    share = np.linspace(0.0, 1.0, 31)[1:-1]
    part = grid[first, None] + share * (grid[last] - grid[first])[:, None]
    between = joints[first, None] + share[:, None] * (joints[last] - joints[first])[:, None]
    now, look = (found.reshape(len(first), len(share), 3) for found in forward(model, between.reshape(-1, 5)))
    wanted = great_circle(axis[0], axis[1], part.ravel()).reshape(look.shape)
    holds = np.degrees(np.linalg.norm(look - wanted, axis=2).max(axis=1)) <= tolerance[1]
    if not tcp:
        way = tip[1] - tip[0]
        along = np.clip((now - tip[0]) @ way / (way @ way), grid[first, None], grid[last, None])
        off = np.linalg.norm(now - tip[0] - along[..., None] * way, axis=2)
        holds &= off.max(axis=1) <= tolerance[0]
    count = np.full(nodes + 1, np.inf)
    count[0] = 0.0
    for node in range(1, nodes + 1):
        reached = first[(last == node) & holds]
        count[node] = 1.0 + count[reached].min(initial=np.inf)
    return int(count[-1]) if np.isfinite(count[-1]) else nodes


@settings(deadline=None, max_examples=examples(15), phases=[Phase.generate])
@given(
    st.sampled_from(NAMES),
    st.lists(st.tuples(steps, leans), min_size=2, max_size=3),
    st.booleans(),
    st.sampled_from([0.002, 0.01, 0.05]),
    st.sampled_from([0.01, 0.05, 0.5]),
)
def test_points_are_at_most_a_tenth_more_than_the_fewest(
    name: str, path: Path, tcp: bool, tip_tolerance: float, axis_tolerance: float
) -> None:
    model = machine(name)
    tip, axis = points(path)
    assume(np.abs(axis[:, :2]).max(axis=1).min() > 1e-3)  # turns at rest in the pole are no spans
    rotary, spans = divided(model, tip, axis, tcp, tip_tolerance, axis_tolerance)
    made = np.bincount(spans.source)
    for row in range(1, len(tip)):
        way = slice(row - 1, row + 1)
        needed = fewest(model, tip[way], axis[way], rotary[way], (tip_tolerance, axis_tolerance), tcp, 150)
        if needed > 15:  # the nodes are too far apart to say
            event("many spans")
            continue
        event(f"spans: {needed // 5 * 5} and more")
        assert made[row] <= math.ceil(1.1 * needed)


def test_with_tcp_a_short_turn_needs_no_points_and_without_it_does() -> None:
    model = machine("generic_head_table_bc")
    tip = np.array([[0.0, 0.0, 0.0], [5.0, 0.0, 0.0]])
    axis = np.array([[0.3, 0.0, 1.0], [0.3, 0.01, 1.0]])
    axis /= np.linalg.norm(axis, axis=1)[:, None]
    rotary = axes_of(model, tip, axis)
    counts = [
        len(
            divide_path(
                model, PathRows(tip, axis, rotary), np.ones(2, bool), tcp=tcp, tip_tolerance=0.001, axis_tolerance=0.1
            ).tip
        )
        for tcp in (True, False)
    ]
    assert counts[0] == 2
    assert counts[1] > 2


def test_a_turn_in_the_pole_is_cut_into_pieces_at_rest() -> None:
    """The CAM passes through the pole and the machine keeps its branch: C turns half a turn under an upright tool."""
    model = machine("generic_head_table_bc")
    tip = np.array([[-10.0, 0.0, 0.0], [10.0, 0.0, 0.0]])
    axis = np.array([[-0.2, 0.0, 1.0], [0.2, 0.0, 1.0]])
    axis /= np.linalg.norm(axis, axis=1)[:, None]
    first = axes_of(model, tip, axis)[0]
    options = inverse(model, tip, axis).joints[..., list(model.rotary)].reshape(-1, 2, 2)
    candidates = options.reshape(-1, 2)
    same_side = [c for c in candidates if abs(c[1] - first[1]) < 1e-6 and abs(c[0] - first[0]) > 90.0]
    rotary = np.array([first, same_side[0]])
    spans = divide_path(
        model, PathRows(tip, axis, rotary), np.ones(2, bool), tcp=False, tip_tolerance=0.01, axis_tolerance=0.1
    )
    assert off(model, tip, axis, spans, tcp=False)[0] <= 0.01
    upright = np.abs(spans.axis[:, 2] - 1.0) < 1e-9
    assert upright.sum() > 50
    assert np.linalg.norm(spans.tip[upright], axis=1).max() < 1e-3


@pytest.mark.parametrize("name", NAMES)
def test_the_tip_stays_on_a_short_line_along_which_it_goes_back_while_the_tool_turns(name: str) -> None:
    model = machine(name)
    tip = np.array([[10.15, 20.395, 0.354], [10.15, 20.395, 1.314]])
    axis = np.array([[0.0, -0.347, 1.0], [0.0, 0.597, 1.0]])
    axis /= np.linalg.norm(axis, axis=1)[:, None]
    rotary = axes_of(model, tip, axis)
    spans = divide_path(
        model, PathRows(tip, axis, rotary), np.ones(2, bool), tcp=False, tip_tolerance=0.001, axis_tolerance=0.5
    )
    assert off(model, tip, axis, spans, tcp=False)[0] <= 0.001


def test_rows_that_are_not_divisible_stay_as_they_are() -> None:
    model = machine("generic_head_head_ca")
    tip = np.array([[0.0, 0.0, 0.0], [50.0, 0.0, 0.0], [0.0, 0.0, 0.0]])
    axis = np.array([[0.0, 0.2, 1.0], [0.4, 0.2, 1.0], [0.0, 0.2, 1.0]])
    axis /= np.linalg.norm(axis, axis=1)[:, None]
    rotary = axes_of(model, tip, axis)
    spans = divide_path(
        model,
        PathRows(tip, axis, rotary),
        np.array([True, False, True]),
        tcp=False,
        tip_tolerance=0.01,
        axis_tolerance=1.0,
    )
    assert (spans.source == 1).sum() == 1
    assert (spans.source == 2).sum() > 1
