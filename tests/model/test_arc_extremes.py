"""What arcs reach between their ends, against dense samples."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from trunnion.arrays import Floats
from trunnion.machines import kinematic_parameters, load_machine
from trunnion.model.arc_extremes import ArcPaths, Reach, axis_reach, tip_reach
from trunnion.model.axis_positions import joints_from_rows
from trunnion.model.subdivision import circle_points

#: Table and table, head and head, head and table, and an axis that is not at right angles.
MACHINES = {
    key: load_machine(key)
    for key in ("yl569", "generic_head_head_ca", "generic_head_table_bc", "generic_nutated_b45_c")
}
SAMPLES = 2001


def vectors(low: float, high: float) -> st.SearchStrategy[Floats]:
    return st.tuples(*[st.floats(low, high)] * 3).map(np.array)


@st.composite
def any_path(draw: st.DrawFn) -> ArcPaths:
    """An arc, helix or whole circle anywhere in space, whose radius may change a little."""
    normal = draw(st.sampled_from(np.eye(3).tolist()).map(np.array) | vectors(-1, 1))
    normal = normal / np.linalg.norm(normal) if np.linalg.norm(normal) > 0.1 else np.array([0.0, 0.0, -1.0])
    across = np.cross(normal, [1.0, 0, 0] if abs(normal[0]) < 0.7 else [0, 1.0, 0])
    across /= np.linalg.norm(across)
    radius, sweep = draw(st.floats(0.5, 200.0)), draw(st.just(2 * np.pi) | st.floats(0.05, 2 * np.pi - 0.05))
    centre, rise, turns = draw(vectors(-100, 100)), draw(st.just(0.0) | st.floats(-50, 50)), draw(st.integers(0, 3))
    grown = radius + (0.0 if sweep == 2 * np.pi else draw(st.sampled_from([0.0, 0.005, -0.01])))
    start = centre + radius * across + draw(st.floats(-5, 5)) * normal
    height = float((start - centre) @ normal) + rise
    end = centre + grown * (np.cos(sweep) * across + np.sin(sweep) * np.cross(normal, across)) + height * normal
    return ArcPaths(start[None], end[None], centre[None], normal[None], np.array([turns]))


def sampled(path: ArcPaths) -> tuple[Floats, Floats]:
    """Shares of the arc, and the points there."""
    share = np.linspace(0.0, 1.0, SAMPLES)
    start, end, centre, normal = (
        np.repeat(each, SAMPLES, axis=0) for each in (path.start, path.end, path.centre, path.normal)
    )
    return share, circle_points(start, end, centre, normal, np.repeat(path.full_turns, SAMPLES), share)


def agrees(reach: Reach, values: Floats, columns: list[int]) -> None:
    """The reach with the ends is that of the samples, and beyond it by no more than lies between two of them."""
    ends = values[[0, -1]]
    low = np.minimum(reach.low[0], ends.min(axis=0))[columns]
    high = np.maximum(reach.high[0], ends.max(axis=0))[columns]
    least, most = values.min(axis=0)[columns], values.max(axis=0)[columns]
    between = np.abs(np.diff(values, n=2, axis=0)).max(axis=0)[columns] + 1e-7
    assert (low <= least + 1e-7).all()
    assert (low >= least - between).all()
    assert (high >= most - 1e-7).all()
    assert (high <= most + between).all()


@settings(deadline=None, max_examples=examples(80))
@given(any_path())
def test_the_tip(path: ArcPaths) -> None:
    agrees(tip_reach(path), sampled(path)[1], [0, 1, 2])


@settings(deadline=None, max_examples=examples(80))
@given(
    any_path(),
    st.sampled_from(sorted(MACHINES)),
    st.tuples(*[st.floats(-100, 100)] * 2),
    st.booleans(),
    st.floats(-90, 400),
)
def test_the_slides(path: ArcPaths, key: str, rotary: tuple[float, float], turns: bool, way: float) -> None:
    machine = MACHINES[key]
    begin = np.array([rotary])
    end = begin + np.array([[0.3 * way, way]]) if turns else begin
    share, tips = sampled(path)
    joints = joints_from_rows(
        machine, kinematic_parameters(machine), np.ones(SAMPLES, np.bool_), tips, begin + share[:, None] * (end - begin)
    )
    agrees(axis_reach(machine, path, begin, end), joints, list(machine.linear))


def test_many_arcs_are_those_of_one() -> None:
    """Standing and turning axes among each other, more of them than are taken at a time."""
    machine, n = load_machine("yl569"), 1500
    rng = np.random.default_rng(5)
    angle, sweep = rng.uniform(0, 6, n), rng.uniform(0.1, 6.2, n)
    start = np.column_stack((20 * np.cos(angle), 20 * np.sin(angle), np.zeros(n)))
    end = np.column_stack((20 * np.cos(angle + sweep), 20 * np.sin(angle + sweep), np.ones(n)))
    paths = ArcPaths(start, end, np.zeros((n, 3)), np.tile([0.0, 0.0, 1.0], (n, 1)), rng.integers(0, 3, n))
    begin = rng.uniform(-10, 90, (n, 2))
    finish = begin + np.where(rng.random((n, 1)) < 0.5, 0.0, rng.uniform(-40, 40, (n, 2)))
    whole = axis_reach(machine, paths, begin, finish)
    for k in range(0, n, 250):
        single = axis_reach(machine, paths.select(slice(k, k + 1)), begin[k : k + 1], finish[k : k + 1])
        np.testing.assert_allclose(whole.low[k], single.low[0], atol=1e-12)
        np.testing.assert_allclose(whole.high[k], single.high[0], atol=1e-12)


def test_an_arc_that_turns_at_no_extreme_has_none() -> None:
    half = np.sqrt(0.5)
    path = ArcPaths(
        np.array([[10 * half, 10 * half, 0.0]]), np.array([[0.1, np.sqrt(100 - 0.01), 0.0]]), np.zeros((1, 3)),
        np.array([[0.0, 0.0, 1.0]]), np.array([0]),
    )  # fmt: skip
    reach = tip_reach(path)
    assert np.isinf(reach.low).all()
    assert np.isinf(reach.high).all()


def test_a_whole_circle_reaches_the_other_side() -> None:
    point = np.array([[20.0, 0.0, 5.0]])
    reach = tip_reach(ArcPaths(point, point, np.zeros((1, 3)), np.array([[0.0, 0.0, 1.0]]), np.array([0])))
    np.testing.assert_allclose(reach.low[0, :2], [-20.0, -20.0], atol=1e-12)
    assert reach.high[0, 1] == 20.0
    assert np.isinf(reach.high[0, 0])
