"""Random machines: any order of slides and rotary axes, any directions, offsets, sides and senses."""

import math

import numpy as np
from hypothesis import assume
from hypothesis import strategies as st

from trunnion.machines import Axis, AxisKind, Machine, Mount, PositiveDirection
from trunnion.machines.machine import Vector

HALF = math.sqrt(0.5)

#: Directions that real machines have, and any other.
USUAL = [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (0.0, -1.0, 0.0), (0.0, -HALF, HALF), (HALF, 0.0, HALF)]
coordinates = st.floats(-1.0, 1.0, allow_subnormal=False)
lengths = st.floats(-1000.0, 1000.0, allow_subnormal=False)
points = st.tuples(lengths, lengths, lengths)


@st.composite
def directions(draw: st.DrawFn) -> Vector:
    """Unit vectors, often along X, Y or Z."""
    if draw(st.booleans()):
        return draw(st.sampled_from(USUAL))
    vector = np.array(draw(st.tuples(coordinates, coordinates, coordinates)))
    length = float(np.linalg.norm(vector))
    assume(length > 0.1)
    x, y, z = (vector / length).tolist()
    return x, y, z


def sine(a: Vector, b: Vector) -> float:
    """Sine of the angle between two unit vectors."""
    return float(np.linalg.norm(np.cross(a, b)))


@st.composite
def machines(draw: st.DrawFn) -> Machine:
    """Any chain of three slides and two rotary axes that can orient a tool."""
    kinds = draw(st.permutations(["linear"] * 3 + ["rotary"] * 2))
    side = draw(st.integers(0, 5))
    ways = [draw(directions()) for _ in kinds]
    spindle = draw(directions())
    slides = [way for way, kind in zip(ways, kinds, strict=True) if kind == "linear"]
    first, second = (way for way, kind in zip(ways, kinds, strict=True) if kind == "rotary")
    assume(abs(np.linalg.det(np.array(slides))) > 0.1)
    assume(sine(first, second) > 0.05)
    assume(sine(second, spindle) > 0.05)
    axes = tuple(
        Axis(
            name=f"J{k}",
            kind=AxisKind(kind),
            mount=Mount.PART if k < side else Mount.TOOL,
            direction=way,
            point=draw(points) if kind == "rotary" else (0.0, 0.0, 0.0),
            positive=draw(st.sampled_from(PositiveDirection)),
        )
        for k, (kind, way) in enumerate(zip(kinds, ways, strict=True))
    )
    return Machine("any", "Any machine", axes, spindle, draw(points), draw(st.none() | points))


#: Five displayed values, for slides and rotary axes alike, with whole and right angles among them.
joints = st.lists(
    st.sampled_from([0.0, 45.0, 90.0, -90.0, 180.0]) | st.floats(-180.0, 180.0, allow_subnormal=False),
    min_size=5,
    max_size=5,
)
