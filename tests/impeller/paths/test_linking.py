"""Links stay clear: every motion of a linked path is outside of the stock, or was allowed pose by pose."""

import math
from itertools import pairwise

import numpy as np
import pytest

from trunnion import InputError
from trunnion.arrays import Flags, Floats
from trunnion.impeller.definition import StockSize
from trunnion.impeller.paths.linking import FreeSpace, LinkedPath, Links, Surroundings, link_passes
from trunnion.impeller.paths.passes import Pass
from trunnion.model.toolpath import Kind, Phase

STOCK = StockSize(diameter=60.0, height=30.0, bottom=0.0, bore=0.0)
OUTLINE = np.array([[2.0, 0.0], [2.0, 20.0], [15.0, 40.0], [15.0, 80.0]])
LINKS = Links(lead=1.0, clearance=2.0, longest=3.0, tolerance=0.005)


def clear(centre: Floats, _axis: Floats) -> Flags:
    return np.ones(len(centre), np.bool_)


def straight(y: float, z: float = 20.0) -> Pass:
    x = np.linspace(-20.0, 20.0, 41)
    normal = np.tile([0.0, 0.0, 1.0], (41, 1))
    return Pass(np.column_stack((x, np.full(41, y), np.full(41, z))), normal, np.zeros((41, 2)))


def upright(one: Pass, tilt: float = 0.0) -> Floats:
    return np.tile([math.sin(math.radians(tilt)), 0.0, math.cos(math.radians(tilt))], (len(one), 1))


def linked(passes: list[Pass], tilt: float = 0.0, check=clear) -> LinkedPath:  # type: ignore[no-untyped-def]
    axes = [upright(one, tilt) for one in passes]
    space = FreeSpace.around(STOCK, LINKS.clearance, 2.0, OUTLINE, np.concatenate(axes))
    return link_passes(passes, axes, Surroundings(space, check, "TEST"), LINKS, 2.0)


def is_outside(point: Floats) -> bool:
    return bool(math.hypot(point[0], point[1]) >= 34.0 - 1e-9 or point[2] >= 34.0 - 1e-9)


@pytest.mark.parametrize("tilt", [0.0, 30.0, 70.0])
def test_rapids_are_outside_of_the_stock(tilt: float) -> None:
    path = linked([straight(-10.0), straight(0.0), straight(10.0)], tilt)
    rapids = np.flatnonzero(path.kind == Kind.RAPID)
    assert len(rapids) >= 3
    for row in rapids:
        assert is_outside(path.centre[row])
        if row:
            share = np.linspace(0.0, 1.0, 50)[:, None]
            for point in path.centre[row - 1] + share * (path.centre[row] - path.centre[row - 1]):
                assert is_outside(point)


@pytest.mark.parametrize("tilt", [0.0, 30.0, 70.0, 95.0])
def test_across_nothing_of_the_tool_reaches_the_stock(tilt: float) -> None:
    axis = upright(straight(0.0), tilt)
    space = FreeSpace.around(STOCK, 2.0, 2.0, OUTLINE, axis)
    up = np.array([axis[0, 2], math.hypot(axis[0, 0], axis[0, 1])])
    lowest = min(height * up[0] - radius * up[1] for radius, height in OUTLINE)
    assert space.height + min(lowest, -2.0) >= 32.0 - 1e-9


def test_every_point_of_a_pass_is_cut_in_its_order() -> None:
    passes = [straight(-1.0), straight(0.0).backwards(), straight(1.0)]
    path = linked(passes)
    cut = path.centre[path.phase == Phase.CUT]
    ends = [one.centre[k] for one in passes for k in (0, -1)]
    found = [np.flatnonzero(np.linalg.norm(path.centre - end, axis=1) < 1e-9) for end in ends]
    assert all(len(rows) for rows in found)
    assert all(first[0] <= second[-1] for first, second in pairwise(found))
    assert len(cut) >= 3
    # Neighbours that lie near are linked directly, in the feed of the cut.
    assert (path.phase == Phase.STEPOVER).sum() == 2
    assert (path.phase == Phase.TRAVERSE).sum() == 1


def test_leads_are_tangent_arcs_from_the_side_of_the_normal() -> None:
    path = linked([straight(0.0)])
    engage = path.centre[path.phase == Phase.ENGAGE]
    start = np.flatnonzero(path.phase == Phase.APPROACH)[0]
    np.testing.assert_allclose(path.centre[start], [-21.0, 0.0, 21.0], atol=1e-9)
    radii = np.linalg.norm(engage - np.array([-20.0, 0.0, 21.0]), axis=1)
    np.testing.assert_allclose(radii, 1.0, atol=1e-9)
    retract = path.centre[path.phase == Phase.RETRACT]
    np.testing.assert_allclose(retract[-2], [21.0, 0.0, 21.0], atol=1e-9)


def test_a_lead_that_is_not_clear_becomes_smaller() -> None:
    def narrow(centre: Floats, _axis: Floats) -> Flags:
        return np.asarray((centre[:, 0] > -20.6) | (centre[:, 2] > 30.0) | (np.abs(centre[:, 0] + 20.0) < 1e-6))

    path = linked([straight(0.0)], check=narrow)
    assert path.centre[path.phase == Phase.ENGAGE][:, 0].min() >= -20.6


def test_a_way_out_that_is_not_clear_is_refused_with_its_place() -> None:
    def closed(centre: Floats, _axis: Floats) -> Flags:
        return np.asarray(centre[:, 2] < 25.0)

    with pytest.raises(InputError, match=r"cannot come to the pass at \(-2[01]\.00, 0\.00, 2[01]\.00\)"):
        linked([straight(0.0)], check=closed)


def test_a_tool_that_points_down_finds_its_way_out_sideways() -> None:
    path = linked([straight(0.0)], tilt=95.0)
    assert np.isfinite(path.centre).all()
    assert is_outside(path.centre[0])
    assert is_outside(path.centre[-1])


def test_a_turned_path_is_the_same_about_z() -> None:
    path = linked([straight(3.0)], tilt=20.0)
    turned = path.turned(math.pi / 2.0)
    np.testing.assert_allclose(turned.centre[:, 0], -path.centre[:, 1], atol=1e-12)
    np.testing.assert_allclose(turned.centre[:, 1], path.centre[:, 0], atol=1e-12)
    np.testing.assert_allclose(turned.axis[:, 2], path.axis[:, 2], atol=1e-12)
