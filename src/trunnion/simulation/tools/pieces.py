"""The convex pieces of a tool, as arrays for kernels.

In:     a ``ToolShape``.
Out:    ``RevolvedPieces``: each is the body of revolution of a radius that is a concave function of the height, so that
        a straight line meets it in one interval.
"""

import math
from collections.abc import Iterator
from itertools import accumulate, pairwise
from typing import Final, NamedTuple, TypeAlias

import numpy as np

from trunnion.arrays import Flags, Floats2, Ints, make_read_only
from trunnion.simulation.tools.profile import Point, ProfileArc, ProfileLine, Role, Section, ToolShape

#: The centre of an arc nearer to the tool axis than this, mm, is on it.
_ON_AXIS: Final = 1e-9

#: How much steeper an element may be than the one below it without a reflex corner: outlines are computed.
_TANGENT: Final = 1e-7

#: No arc is held closer than this, mm: nobody measures it, and the number of elements grows as 1 / √tolerance.
_CLOSEST: Final = 1e-6

#: Elements lower than this, mm, are none: rounding leaves them where an outline is divided at an end.
_NO_HEIGHT: Final = 1e-9

#: z0, z1, r0, r1, NaN of a frustum, or z0, z1, centre z, radius, 0 of a sphere.
_Row: TypeAlias = tuple[float, float, float, float, float]

#: The first and the last chord of an arc as a part of the others, with the same deviation: one of their ends is on it.
_END_CHORD: Final = (2.0 + math.sqrt(2.0)) / 4.0


class RevolvedPieces(NamedTuple):
    """Convex bodies of revolution about the tool axis; all arrays are read-only. mm, frame of the tool.

    first     (p + 1,)  int64    elements of piece k are ``first[k]:first[k + 1]``, from below to above
    cuts      (p,)      bool     it belongs to a section that cuts
    section   (p,)      int64    index into ``ToolShape.sections``
    bounds    (p, 3)    float64  lowest z, highest z, greatest r
    elements  (e, 5)    float64  a frustum: z0, z1, r0, r1, NaN; a sphere on the tool axis: z0, z1, centre z, radius, 0
                                 z0 < z1 always: every piece is closed by the planes of its lowest and its highest z
    """

    first: Ints
    cuts: Flags
    section: Ints
    bounds: Floats2
    elements: Floats2


def revolved_pieces(shape: ToolShape, tolerance: float) -> tuple[RevolvedPieces, float]:
    """Return the convex pieces of a tool, and how far they are from it at most, mm.

    An arc that is not about the tool axis becomes frusta, half within it and half outside, no farther off than
    ``tolerance`` (mm). Everything else is exact. A section is divided at each reflex corner of its outline.

    Raises ``ValueError`` if ``tolerance`` is not above 0.
    """
    if not tolerance > 0.0:
        raise ValueError("the tolerance of a tool's pieces is not above 0")
    pieces: list[list[_Row]] = []
    owners: list[int] = []
    error = 0.0
    for number, section in enumerate(shape.sections):
        rows, off = _elements(section, max(tolerance, _CLOSEST))
        error = max(error, off)
        found = list(_convex_runs(rows))
        pieces += found
        owners += [number] * len(found)
    return _as_arrays(shape, pieces, owners), error


def _as_arrays(shape: ToolShape, pieces: list[list[_Row]], owners: list[int]) -> RevolvedPieces:
    arrays = RevolvedPieces(
        first=np.array([0, *accumulate(map(len, pieces))], np.int64),
        cuts=np.array([shape.sections[owner].role is Role.CUTTER for owner in owners], np.bool_),
        section=np.array(owners, np.int64),
        bounds=np.array([(rows[0][0], rows[-1][1], max(map(_widest, rows))) for rows in pieces], np.float64),
        elements=np.array([row for rows in pieces for row in rows], np.float64),
    )
    make_read_only(*arrays)
    return arrays


def _elements(section: Section, tolerance: float) -> tuple[list[_Row | None], float]:
    """Return the elements of a section, None for a step, and how far they are off its outline."""
    rows: list[_Row | None] = []
    error = 0.0
    for element in section.outline:
        if element.end[1] - element.start[1] <= _NO_HEIGHT:
            rows.append(None)
        elif isinstance(element, ProfileArc) and abs(element.centre[0]) <= _ON_AXIS:
            rows.append((element.start[1], element.end[1], element.centre[1], element.radius, 0.0))
        else:
            points, off = _chords(element, tolerance)
            error = max(error, off)
            rows += [_frustum(start, end) for start, end in pairwise(points)]
    return rows, error


def _frustum(start: Point, end: Point) -> _Row:
    return start[1], end[1], start[0], end[0], math.nan


def _convex_runs(rows: list[_Row | None]) -> Iterator[list[_Row]]:
    """Divide elements at steps and reflex corners."""
    run: list[_Row] = []
    for row in rows:
        if run and (row is None or _is_reflex(run[-1], row)):
            yield run
            run = []
        if row is not None:
            run.append(row)
    if run:
        yield run


def _is_reflex(below: _Row, above: _Row) -> bool:
    """Whether the outline turns outward where one element ends and the next one begins."""
    (dr, dz), (next_dr, next_dz) = _direction(below, below[1]), _direction(above, above[0])
    return next_dr * dz - dr * next_dz > _TANGENT


def _direction(row: _Row, z: float) -> tuple[float, float]:
    """Return the unit vector along an element at a height, upward."""
    z0, z1, third, fourth, is_sphere = row
    if is_sphere == 0.0:
        along = (third - z) / fourth
        return along, math.sqrt(max(1.0 - along * along, 0.0))
    length = math.hypot(fourth - third, z1 - z0)
    return (fourth - third) / length, (z1 - z0) / length


def _widest(row: _Row) -> float:
    z0, z1, third, fourth, is_sphere = row
    if is_sphere != 0.0:
        return max(third, fourth)
    return math.sqrt(max(fourth**2 - (min(max(third, z0), z1) - third) ** 2, 0.0))


def _chords(element: ProfileLine | ProfileArc, tolerance: float) -> tuple[list[Point], float]:
    """Return the corners of the lines that replace an element, and how far those are off it at most.

    The ends stay where they are, so that no plane moves. The corners between lie outside the arc as far as the chords
    between them lie within.
    """
    if isinstance(element, ProfileLine):
        return [element.start, element.end], 0.0
    radius, (r, z) = element.radius, element.centre
    begin, end = (math.atan2(point[1] - z, point[0] - r) for point in (element.start, element.end))
    count = 1
    while (deviation := max(_deviations(radius, end - begin, count))) > tolerance:
        count += 1
    step = _step(end - begin, count)
    outer = radius + _deviations(radius, end - begin, count)[0]
    inner = [begin + (k + _END_CHORD) * step for k in range(count - 1)]
    corners = [(r + outer * math.cos(angle), z + outer * math.sin(angle)) for angle in inner]
    return [element.start, *corners, element.end], deviation


def _step(angle: float, count: int) -> float:
    """Return the angle between two corners outside an arc that a number of chords replaces."""
    return angle / (count - 2.0 + 2.0 * _END_CHORD)


def _deviations(radius: float, angle: float, count: int) -> tuple[float, float]:
    """How far the corners of a number of chords are outside an arc, and how far its end chords are within."""
    if count == 1:
        return 0.0, radius * (1.0 - math.cos(0.5 * angle))
    step = _step(angle, count)
    outside = radius * math.tan(0.25 * step) ** 2
    # The end chord goes from the arc to a corner outside it; its line is so far from the centre.
    edge, outer = _END_CHORD * step, radius + outside
    across = math.sqrt(radius**2 + outer**2 - 2.0 * radius * outer * math.cos(edge))
    return outside, radius - radius * outer * math.sin(edge) / across
