"""Impellers of a published family of analytic ruled blades, as definitions.

With u from 0 to 1: radius of hub and shroud r = r0 + (r1 - r0) u, angle of the hub wrap u, of the shroud
(wrap + twist) u, heights from the top down. Formulas: slavanyx/crossmath, "BladeCAM".
"""

import numpy as np
import pytest
from hypothesis import strategies as st

from trunnion.arrays import Floats
from trunnion.geometry.point_tables import PointTable
from trunnion.impeller.definition import ImpellerDefinition, StockSize
from trunnion.impeller.paths.passes import PassFamily


def mixed_flow_sections(wrap: float, twist: float, points: int = 15, sections: int = 2) -> list[Floats]:
    """Curves of a blade from hub to shroud: radius 30 to 46 and 42 to 58 mm, height from 34 down to 12 and 28 to 6."""
    u = np.linspace(0.0, 1.0, points)
    angle = -wrap * u
    hub = np.column_stack(((30 + 16 * u) * np.cos(angle), (30 + 16 * u) * np.sin(angle), 34 - 22 * u))
    angle = -(wrap + twist) * u
    tip = np.column_stack(((42 + 16 * u) * np.cos(angle), (42 + 16 * u) * np.sin(angle), 28 - 22 * u))
    return [(1.0 - share) * hub + share * tip for share in np.linspace(0.0, 1.0, sections)]


def mixed_flow(
    wrap: float = 0.55,
    twist: float = 0.2,
    number: int = 6,
    splitter: float | None = 0.35,
    fillet: float = 2.0,
    trailing_edge: str = "round",
    sections: int = 2,
) -> ImpellerDefinition:
    """A definition of such an impeller."""
    curves = mixed_flow_sections(wrap, twist, sections=sections)
    tables = [PointTable("mixed_flow", f"c{k}", points, range(1, len(points) + 1)) for k, points in enumerate(curves)]
    return ImpellerDefinition(
        file="mixed_flow",
        name="MIXED",
        sections=tuple(tables),
        parameterization="chord-length",
        number=number,
        hub_thickness=2.4,
        tip_thickness=1.4,
        trailing_edge=trailing_edge,
        splitter=splitter,
        fillet=fillet,
        stock=StockSize(diameter=120.0, height=36.0, bottom=0.0, bore=20.0),
    )


def dense_path(family: PassFamily, step: float) -> Floats:
    """Points (k, 3) on the path of a ball's centre, straight between the points of its passes."""
    found = []
    for one in family.passes:
        pieces = np.maximum(np.ceil(np.linalg.norm(np.diff(one.centre, axis=0), axis=1) / step), 1).astype(int)
        at = np.concatenate([k + np.arange(n) / n for k, n in enumerate(pieces)] + [[float(len(pieces))]])
        rows = np.arange(len(one.centre))
        found.append(np.column_stack([np.interp(at, rows, one.centre[:, axis]) for axis in range(3)]))
    return np.concatenate(found)


def nearest_on_path(family: PassFamily, points: Floats, step: float = 0.05) -> Floats:
    """Distance (k,) of points (k, 3) to the path of a ball's centre; too large by less than step²/8 of the distance."""
    tree = pytest.importorskip("scipy.spatial").cKDTree(dense_path(family, step))
    return np.asarray(tree.query(points)[0])


@st.composite
def mixed_flow_cases(draw: st.DrawFn) -> tuple[ImpellerDefinition, float]:
    """An impeller of the family, with or without splitters, and the radius of a ball for its fillet."""
    fillet = draw(st.floats(1.0, 2.5))
    definition = mixed_flow(
        wrap=draw(st.floats(0.1, 0.7)),
        twist=draw(st.floats(0.0, 0.2)),
        number=draw(st.integers(3, 6)),
        splitter=draw(st.sampled_from([None, 0.35, 0.5])),
        fillet=fillet,
        sections=draw(st.integers(2, 3)),
    )
    return definition, fillet * draw(st.floats(0.5, 1.0))
