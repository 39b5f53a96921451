"""The box of places that all fit, against the inverse map and against other boxes."""

from dataclasses import replace

import numpy as np
from hypothesis import Phase, assume, given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.placed_paths import brute_margin, limited_machines, random_rows
from trunnion.machines import Machine, load_machine
from trunnion.placing.inscribed_box import Box
from trunnion.placing.largest_margin import BestPlace, largest_margin
from trunnion.placing.path_rows import PathRows
from trunnion.placing.region import region_of
from trunnion.placing.rotary_angles import Obstacle
from trunnion.placing.travel_limits import CutSet
from trunnion.placing.turns import Choice, TurnedPath


def fits(cuts: CutSet, box: Box) -> bool:
    return all(cuts.at(corner).margins.min() >= 0.0 for corner in box.corners)


def placed(machine: Machine, seed: int, turn: float) -> tuple[PathRows, CutSet, BestPlace] | None:
    """A random path and its best place; None where rotary axes do not reach it, or barely, or it fits nowhere."""
    rows = random_rows(seed, 12)
    cuts = TurnedPath.of(machine, Choice.AS_PLANNED, rows, np.zeros(3)).at(turn)
    if isinstance(cuts, Obstacle) or any(np.abs(part.forms.normals).max() >= 20.0 for part in cuts.parts):
        return None
    best = largest_margin(cuts, np.zeros(3))
    return (rows, cuts, best) if best.margin > 0.1 else None


@settings(max_examples=examples(4), deadline=None, phases=[Phase.explicit, Phase.generate])
@given(machine=limited_machines(), seed=st.integers(0, 10**6), turn=st.sampled_from([0.0, 37.0]))
def test_every_corner_fits_and_no_other_box_is_larger(machine: Machine, seed: int, turn: float) -> None:
    axes = tuple(
        axis if axis.is_rotary else replace(axis, low=max(axis.low, -900.0), high=min(axis.high, 900.0))
        for axis in machine.axes
    )
    machine = replace(machine, axes=axes)
    found = next((each for k in range(40) if (each := placed(machine, seed + k, turn)) is not None), None)
    assume(found is not None)
    assert found is not None
    rows, cuts, best = found
    region = region_of(cuts, best)
    assert region is not None
    box = region.box
    assert (box.low <= best.zero + 1e-9).all()
    assert (box.high >= best.zero - 1e-9).all()
    assert (box.low >= region.low - 1e-3).all()
    assert (box.high <= region.high + 1e-3).all()
    for corner in box.corners:
        assert brute_margin(machine, rows, turn, corner) >= -1e-6
    volume = np.prod(box.high - box.low)
    random = np.random.default_rng(seed)
    for _ in range(80):
        # Boxes that grow from this one or from a smaller one, until they no longer fit.
        low, high = box.low.copy(), box.high.copy()
        shrink = random.uniform(0.3, 1.0, 6)
        low, high = best.zero - (best.zero - low) * shrink[:3], best.zero + (high - best.zero) * shrink[3:]
        grow = random.uniform(0.0, 0.3, 6) * np.tile(region.high - region.low, 2)
        other = Box(low - grow[:3], high + grow[3:])
        if fits(cuts, other):
            assert np.prod(other.high - other.low) <= 1.02 * volume + 1.0


def test_slides_alone_have_a_box_that_is_the_region() -> None:
    """Three slides and no turning: travel -250 to 250, -150 to 150 and -250 to 250, less the path."""
    machine = replace(load_machine("yl569"), tool_length=0.0)
    rows = random_rows(1, 2)
    tip = np.array([[-10.0, -20.0, 0.0], [30.0, 20.0, 50.0]])
    rows = replace(rows, tip=tip, axis=np.tile([0.0, 0.0, 1.0], (2, 1)), branch=np.zeros(2, np.uint8))
    cuts = TurnedPath.of(machine, Choice.FIRST, rows, np.zeros(3)).at(0.0)
    assert not isinstance(cuts, Obstacle)
    region = region_of(cuts, largest_margin(cuts, np.zeros(3)))
    assert region is not None
    assert np.allclose(region.box.low[:2], [-240.0, -130.0], atol=2e-3)
    assert np.allclose(region.box.high[:2], [220.0, 130.0], atol=2e-3)
    assert np.isclose(region.box.high[2] - region.box.low[2], 450.0, atol=2e-3)
