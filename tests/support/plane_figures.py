"""Paths of lines and circles in words: points as complex numbers, and circles as (end, centre, sense)."""

import math
from typing import TypeAlias

import numpy as np
from hypothesis import strategies as st

from trunnion.compensation.plane_path import PlanePath

Piece: TypeAlias = complex | tuple[complex, complex, int]


def figure(first: complex, *pieces: Piece) -> PlanePath:
    """A path from its first point on."""
    ends, centres, senses = zip(*(each if isinstance(each, tuple) else (each, 0j, 0) for each in pieces), strict=True)
    return PlanePath(
        np.array([first, *ends[:-1]], complex), np.array(ends, complex), np.array(centres, complex), np.array(senses)
    )


def pieces(path: PlanePath) -> list[tuple[complex, complex, int]]:
    """The elements of a path, each with its end, its centre and its sense, rounded."""
    rounded = zip(np.round(path.end, 6) + 0, np.round(path.centre, 6) + 0, path.sense.tolist(), strict=True)
    return [(complex(end), complex(centre) if sense else 0j, sense) for end, centre, sense in rounded]


def spaced(path: PlanePath, count: int = 40) -> np.ndarray:
    """Points along each element, (m, count)."""
    part = np.linspace(0.0, 1.0, count)[None]
    lines = path.start[:, None] + (path.end - path.start)[:, None] * part
    angle = (path.sense * path.swept())[:, None] * part
    turned = path.centre[:, None] + (path.start - path.centre)[:, None] * np.exp(1j * angle)
    return np.asarray(np.where(path.sense[:, None] == 0, lines, turned))


def line(end: complex) -> tuple[complex, complex, int]:
    """A line to a point, as ``pieces`` has it."""
    return end, 0j, 0


@st.composite
def turning_paths(draw: st.DrawFn) -> list[tuple[complex, complex, int]]:
    """Lines and circles that turn by 150 degrees at most, each long enough for the tool beside it."""
    place, heading = 0j, 0.0
    found = [line(0j)]
    for _ in range(draw(st.integers(2, 5))):
        heading += draw(st.floats(-2.6, 2.6))
        way = complex(math.cos(heading), math.sin(heading))
        if sense := draw(st.sampled_from((0, 0, 1, -1))):
            radius, angle = draw(st.floats(5.0, 30.0)), draw(st.floats(1.0, 2.5))
            centre = place + 1j * sense * way * radius
            place = centre + (place - centre) * complex(math.cos(angle), math.sin(sense * angle))
            heading += sense * angle
            found.append((place, centre, sense))
        else:
            place += way * draw(st.floats(10.0, 40.0))
            found.append(line(place))
    return found
