"""The described body of an impeller: closed, and each edge the same curve on both of its faces."""

import tempfile
from collections import defaultdict
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.example_impellers import changed
from tests.support.examples import examples
from trunnion.arrays import Floats
from trunnion.errors import InputError
from trunnion.extras import import_extra
from trunnion.impeller.impeller import rotated
from trunnion.impeller.solid.impeller_body import impeller_body
from trunnion.impeller.solid.root_loop import Density
from trunnion.impeller.solid.shapes import (
    Body,
    Circle,
    Curve,
    Cylinder,
    EdgeUse,
    Line,
    Plane,
    Spline,
    SplineSurface,
    Surface,
)
from trunnion.jobs.impeller.models import load_impeller

BSpline = import_extra("scipy.interpolate", "impeller").BSpline

COARSE = Density(65, 9, 7, 5)


def curve_points(curve: Curve, at: Floats) -> Floats:
    """Points of a curve in space, or of a circle or line on a surface."""
    if isinstance(curve, Spline):
        return np.asarray(BSpline(curve.knots, curve.points, 3)(at))
    if isinstance(curve, Line):
        return np.asarray(np.array(curve.origin) + at[:, None] * np.array(curve.direction))
    assert isinstance(curve, Circle)
    return np.column_stack((curve.radius * np.cos(at), curve.radius * np.sin(at), np.full(len(at), curve.height)))


def surface_points(surface: Surface, places: Floats) -> Floats:
    u, v = places[:, :2].T
    if isinstance(surface, Plane):
        return np.column_stack((u, v, np.full(len(u), surface.height)))
    if isinstance(surface, Cylinder):
        angle = u + surface.start
        return np.column_stack((surface.radius * np.cos(angle), surface.radius * np.sin(angle), v))
    if isinstance(surface, SplineSurface):
        rows = [BSpline(surface.u_knots, surface.points, 3)(one) for one in u]
        return np.array([BSpline(surface.v_knots, row, 3)(one) for row, one in zip(rows, v, strict=True)])
    points = BSpline(surface.curve.knots, surface.curve.points, 3)(v)
    return np.vstack([rotated(one[None], angle) for one, angle in zip(points, u, strict=True)])


def gap(body: Body, use: EdgeUse, surface: Surface) -> float:
    """How far an edge's curve on a surface is from its curve in space, mm."""
    edge = body.edges[use.edge]
    at = np.linspace(*edge.span, 5)
    on_face = surface_points(surface, curve_points(use.flat, at))
    if edge.curve is None:
        return float(np.abs(on_face - body.vertices[edge.ends[0]]).max())
    in_space = curve_points(edge.curve, at)
    ends = np.array([body.vertices[k] for k in edge.ends])
    return float(max(np.abs(in_space - on_face).max(), np.abs(in_space[[0, -1]] - ends).max()))


def check(body: Body) -> None:
    """Each edge is passed once each way, loops are joined, and curves agree."""
    ways = defaultdict(list)
    for face in body.faces:
        for loop in face.loops:
            ends = [body.edges[use.edge].ends[:: -1 if use.backwards else 1] for use in loop]
            assert all(one[1] == other[0] for one, other in zip(ends, ends[1:] + ends[:1], strict=True))
            for use in loop:
                assert gap(body, use, face.surface) < 2e-3
                ways[use.edge].append(use.backwards == face.outward)
    assert len(ways) == len(body.edges)
    # An edge that is a point, on the axis, has one face only.
    assert all(sorted(ways[k]) == [False, True] or edge.curve is None for k, edge in enumerate(body.edges))


@settings(max_examples=examples(5), deadline=None)
@given(
    number=st.integers(2, 6),
    fillet=st.floats(0.5, 2.0),
    trailing=st.sampled_from(["round", "cut"]),
    splitter=st.one_of(st.none(), st.floats(0.3, 0.7)),
    bore=st.sampled_from([0.0, 12.0]),
    height=st.sampled_from([42.0, 60.0]),
)
def test_a_body_is_closed(
    number: int, fillet: float, trailing: str, splitter: float | None, bore: float, height: float
) -> None:
    changes = (
        ("number = 5", f"number = {number}"),
        ("fillet_mm = 2.5", f"fillet_mm = {fillet}"),
        ('trailing_edge = "round"', f'trailing_edge = "{trailing}"'),
        ("splitter_start = 0.4", "" if splitter is None else f"splitter_start = {splitter}"),
        ("bore_mm = 12.0", f"bore_mm = {bore}"),
        ("height_mm = 42.0", f"height_mm = {height}"),
        ("diameter_mm = 108.0", f"diameter_mm = {108.0 if trailing == 'round' else 101.0}"),
    )
    with tempfile.TemporaryDirectory() as folder:
        impeller = load_impeller(changed(Path(folder), "mixed_flow", *changes))
        body, _ = impeller_body(impeller, COARSE)
    check(body)
    blades = len(list(impeller.blades()))
    on_axis = sum(edge.curve is None for edge in body.edges)
    # Twelve patches and a tip for each blade; hub and wall for each channel; bottom, and the top where there is one.
    assert len(body.faces) == 13 * blades + 2 * number + (1 if on_axis else 2)
    assert on_axis == (number if height == 60.0 and not bore else 0)


@pytest.mark.parametrize(
    ("example", "changes", "what"),
    [
        ("impeller", (("fillet_mm = 2.0", "fillet_mm = 2.6"),), "the fillet reaches the shroud near X"),
        ("mixed_flow", (("bottom_mm = -4.0", "bottom_mm = -400.0"), ("height_mm = 42.0", "height_mm = 480.0"),
                        ("diameter_mm = 108.0", "diameter_mm = 500.0")),
         "hub and shroud cross inside of the stock"),
    ],
)  # fmt: skip
def test_what_makes_no_body_is_refused(
    tmp_path: Path, example: str, changes: tuple[tuple[str, str], ...], what: str
) -> None:
    impeller = load_impeller(changed(tmp_path, example, *changes))
    with pytest.raises(InputError, match=what):
        impeller_body(impeller, COARSE)
