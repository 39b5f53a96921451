"""Holes as motion: the rows of each hole, against a reference that makes them hole by hole."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from trunnion.arrays import Flags, Floats
from trunnion.model.toolpath import (
    Arcs,
    CycleOff,
    CycleOn,
    Dwell,
    Frame,
    Kind,
    Moves,
    Operation,
    Sense,
    SpindleOff,
    SpindleOn,
    Tool,
)
from trunnion.planning.holes.cycles import HoleCycleError, HoleMethod, SpindleState, cycle_from_event
from trunnion.planning.holes.hole_motion import HoleConditions, convert_holes_to_motion
from trunnion.planning.holes.operations import normalize_cycles
from trunnion.planning.holes.pecks import peck_depths

SPINDLE = SpindleState(1200.0, Sense.CLW)
LENGTH = st.integers(1, 900).map(lambda n: n / 100.0)
MODES = st.sampled_from([("DRILL",), ("DRILL", "DEEP"), ("DRILL", "BRKCHP"), ("REAM",), ("BORE", "DRAG")])

#: Where the tool goes, how, and the events before.
Row = tuple[tuple[float, float, float], Kind, tuple[str, ...]]


def operation(
    tips: list[tuple[float, float, float]], rapid: list[bool], events: tuple[CycleOn | CycleOff, ...]
) -> Operation:
    n = len(tips)
    axis = np.tile([0.0, 0.0, 1.0], (n, 1))
    kind = np.where(rapid, Kind.RAPID, Kind.LINEAR).astype(np.uint8)
    phase, line = np.full(n, 4, np.uint8), np.arange(1, n + 1, dtype=np.int32)
    moves = Moves(np.array(tips, float), axis, kind, phase, np.full(n, 500.0), np.zeros(n, bool), line)
    return Operation("HOLES", Tool(), Frame(), moves, Arcs.empty(), events, 1)


@st.composite
def drilled(draw: st.DrawFn) -> tuple[Operation, CycleOn]:
    """Points, holes of one cycle, and a point after them."""
    above = draw(LENGTH)
    values: dict[str, tuple[float, ...]] = {"RAPTO": (above,), "FEDTO": (-draw(LENGTH),), "MMPM": (90.0,)}
    if draw(st.booleans()):
        values["RTRCTO"] = (above + draw(LENGTH),)
    if draw(st.booleans()):
        values["DWELL"] = (0.5,)
    mode = draw(MODES)
    if mode[-1] in ("DEEP", "BRKCHP"):
        least = draw(LENGTH)
        values["STEP"] = (draw(LENGTH), draw(st.sampled_from([0.0, 0.25])), least)
    place = st.tuples(*[st.sampled_from([0.0, 5.0, -7.5])] * 2, st.sampled_from([0.0, 4.0, -12.0]))
    holes = draw(st.lists(place, min_size=1, max_size=4))
    before = draw(st.sampled_from([[], [(0.0, 0.0, 40.0)], [(5.0, 0.0, 1.0)]]))
    cycle = CycleOn(len(before), 7, mode, tuple(values.items()))
    tips = [*before, *holes, (0.0, 0.0, 50.0)]
    rapid = [True] * len(before) + [False] * len(holes) + [True]
    return operation(tips, rapid, (cycle, CycleOff(len(before) + len(holes), 9))), cycle


def reference(path: Operation, cycle: CycleOn) -> list[Row]:
    """The rows that docs/cl.md defines, under an upright tool, one hole after the other."""
    asked = cycle_from_event(cycle)
    assert asked.retract_height is not None
    holes = path.moves.tip[cycle.row : -1].tolist()
    here = None if cycle.row == 0 else tuple(path.moves.tip[cycle.row - 1].tolist())
    rows: list[Row] = [] if here is None else [(here, Kind.RAPID, ())]
    for x, y, z in holes:
        height = z + (asked.retract_height if here is None else asked.rapid_height)
        if here is not None and here[2] < height - 1e-9:
            rows.append(((here[0], here[1], height), Kind.RAPID, ()))
        elif here is not None:
            height = here[2]
        if here is None or (x, y) != here[:2] or rows[-1][0][2] != height:
            rows.append(((x, y, height), Kind.RAPID, ()))
        if height > z + asked.rapid_height + 1e-9:
            rows.append(((x, y, z + asked.rapid_height), Kind.RAPID, ()))
        done = 0.0
        for depth in depths(asked.method, asked.depth, asked.pecks):
            if done and asked.method is HoleMethod.DEEP_DRILLING:
                rows.append(((x, y, z + asked.rapid_height), Kind.RAPID, ()))
                if z - done + 0.5 < z + asked.rapid_height - 1e-9:
                    rows.append(((x, y, z - done + 0.5), Kind.RAPID, ()))
            elif done:
                rows.append(((x, y, z - done + min(0.5, done / 2.0)), Kind.RAPID, ()))
            rows.append(((x, y, z - depth), Kind.LINEAR, ()))
            done = depth
        happens: tuple[str, ...] = ("Dwell",) if asked.dwell else ()
        if asked.method is HoleMethod.BORE:
            happens = (*happens, "SpindleOff")
        if asked.method is HoleMethod.REAM:
            rows.append(((x, y, z + asked.rapid_height), Kind.LINEAR, happens))
            happens = ()
        if asked.method is not HoleMethod.REAM or asked.retract_height > asked.rapid_height:
            rows.append(((x, y, z + asked.retract_height), Kind.RAPID, happens))
        here = (x, y, z + asked.retract_height)
    return [*rows, ((0.0, 0.0, 50.0), Kind.RAPID, ())]


def depths(method: HoleMethod, depth: float, steps: tuple[float, float, float]) -> list[float]:
    """Depths by adding up pecks, each shorter than the one before; only the last may be below the shortest."""
    if method not in (HoleMethod.DEEP_DRILLING, HoleMethod.CHIP_BREAKING):
        return [depth]
    every, reached, peck = [], 0.0, steps[0]
    while reached < depth - 1e-9:
        reached = min(reached + peck, depth)
        every.append(reached)
        peck = peck if peck <= steps[2] else max(peck - steps[1], steps[2])
    return every


def rows_of(path: Operation) -> list[Row]:
    moves = path.moves
    happens: dict[int, tuple[str, ...]] = {}
    for event in path.events:
        if isinstance(event, Dwell | SpindleOff):
            happens[event.row] = (*happens.get(event.row, ()), type(event).__name__)
    return [
        ((tip[0], tip[1], tip[2]), Kind(int(kind)), happens.get(k, ()))
        for k, (tip, kind) in enumerate(zip(moves.tip.tolist(), moves.kind, strict=True))
    ]


def conditions(home: Flags) -> HoleConditions:
    """Conditions under which every hole becomes motion, if motion can make it."""
    return HoleConditions(SPINDLE, home, None, lambda cycle, spindle: None, prefers_motion=True)


def expanded(path: Operation) -> Operation:
    path = normalize_cycles(path)
    home = np.zeros(len(path.moves), bool)
    return convert_holes_to_motion(path, conditions(home)).operation


@given(drawn=drilled())
def test_holes_become_the_motions_of_the_documentation(drawn: tuple[Operation, CycleOn]) -> None:
    path, cycle = drawn
    made = expanded(path)
    found, wanted = rows_of(made), reference(path, cycle)
    assert [row[1:] for row in found] == [row[1:] for row in wanted]
    assert np.allclose([row[0] for row in found], [row[0] for row in wanted], atol=1e-9)
    assert not any(isinstance(event, CycleOn | CycleOff) for event in made.events)
    assert [event.row for event in made.events] == sorted(event.row for event in made.events)
    lines = made.moves.kind == Kind.LINEAR
    assert (made.moves.feed[lines] == 90.0).all()
    starts = sum(isinstance(event, SpindleOn) for event in made.events)
    assert starts == (len(path.moves) - cycle.row - 1 if cycle.mode == ("BORE", "DRAG") else 0)


@given(drawn=drilled(), axis=st.tuples(*[st.floats(-1.0, 1.0)] * 3))
def test_along_a_tilted_axis_the_motions_are_the_same(
    drawn: tuple[Operation, CycleOn], axis: tuple[float, float, float]
) -> None:
    path, _ = drawn
    matrix = square(np.array(axis))
    moves = path.moves
    leaning = replace(path, moves=replace(moves, tip=moves.tip @ matrix.T, axis=np.tile(matrix[:, 2], (len(moves), 1))))
    upright, tilted = expanded(path).moves, expanded(leaning).moves
    assert np.abs(upright.tip @ matrix.T - tilted.tip).max() < 1e-9
    assert (upright.kind == tilted.kind).all()


def square(axis: Floats) -> Floats:
    """A right-handed frame whose Z is the direction of ``axis``, or Z itself if that is zero."""
    axis = axis if np.linalg.norm(axis) > 0.1 else np.array([0.0, 0.0, 1.0])
    z = axis / np.linalg.norm(axis)
    x = np.cross(np.eye(3)[int(np.argmin(np.abs(z)))], z)
    x /= np.linalg.norm(x)
    return np.column_stack((x, np.cross(z, x), z))


def cycle(*step: float) -> CycleOn:
    values = {"RAPTO": (2.0,), "FEDTO": (-12.0,), "MMPM": (90.0,), "STEP": step}
    return CycleOn(1, 7, ("DRILL", "DEEP"), tuple(values.items()))


@pytest.mark.parametrize(
    ("step", "depths"),
    [
        ((5.0,), [5.0, 10.0, 12.0]),
        ((4.0, 1.0, 2.0), [4.0, 7.0, 9.0, 11.0, 12.0]),
        ((3.0, 0.0, 5.0), [3.0, 6.0, 9.0, 12.0]),
        ((20.0, 1.0, 1.0), [12.0]),
    ],
)
def test_pecks_become_shorter_down_to_the_shortest(step: tuple[float, ...], depths: list[float]) -> None:
    assert peck_depths(cycle_from_event(cycle(*step))) == depths


@pytest.mark.parametrize(
    ("step", "why"), [((4.0, 3.0), "shortest"), ((4.0, -1.0, 1.0), "below 0"), ((1e-5,), "more than 10000 pecks")]
)
def test_pecks_that_never_reach_the_depth_are_refused(step: tuple[float, ...], why: str) -> None:
    path = operation([(0.0, 0.0, 9.0), (0.0, 0.0, 0.0)], [True, False], (cycle(*step),))
    with pytest.raises(HoleCycleError, match=why) as error:
        expanded(path)
    assert error.value.line == 7


def test_threads_stay_cycles() -> None:
    tap = CycleOn(1, 7, ("TAP",), (("RAPTO", (2.0,)), ("FEDTO", (-9.0,)), ("MMPR", (1.0,))))
    path = normalize_cycles(operation([(0.0, 0.0, 9.0), (0.0, 0.0, 0.0)], [True, False], (tap,)))
    home = np.zeros(2, bool)
    assert convert_holes_to_motion(path, conditions(home)).operation is path


def test_each_hole_has_the_spindle_speed_of_its_row() -> None:
    drag = CycleOn(0, 7, ("BORE", "DRAG"), (("RAPTO", (2.0,)), ("FEDTO", (-9.0,)), ("MMPM", (50.0,))))
    tips = [(10.0 * k, 0.0, 0.0) for k in range(3)]
    path = operation(tips, [False] * 3, (drag,))
    path = replace(path, events=(drag, SpindleOn(1, 8, 300.0, Sense.CCLW)))
    said = [(e.rpm, e.sense) for e in expanded(path).events if isinstance(e, SpindleOn)]
    assert said == [(1200.0, Sense.CLW), (300.0, Sense.CCLW), (300.0, Sense.CCLW)]
