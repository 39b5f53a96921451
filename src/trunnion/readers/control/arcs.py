"""Circles as blocks program them: by centre, radius, opening angle or an intermediate point; and their maps.

Input and output in programmed coordinates, mm and degrees. A plane is given by the axis normal to it: 2 for G17 (X, Y),
1 for G18 (Z, X), 0 for G19 (Y, Z). Seen from the positive end of this axis, G3 turns counter-clockwise.
"""

import math
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.messages import Wording
from trunnion.readers.control.worded_error import WordedError
from trunnion.records import dataclass

#: How much the radii at start and end may differ: an amount, mm, or a ratio of the radius, whichever is more. These are
#: the default settings of a Sinumerik.
RADIUS_ERROR: Final = 0.01
RADIUS_RATIO: Final = 0.001

#: Points nearer than this coincide, mm.
SAME_POINT: Final = 1e-9

#: Larger radii, mm, are mistakes of the program.
MAX_RADIUS: Final = 1e7


#: The end of a circle that is nearer to its start than this, mm, and not there, was mostly meant to be there.
_GAP: Final = 0.002

#: A circle is wider than so many gaps, and a helix rises more than so many.
_GAPS: Final = 10.0


class ArcError(WordedError):
    """The reason why a block programs no circle."""


#: Scales are equal, and directions at right angles, within this.
SAME_SCALE: Final = 1e-9


@dataclass(frozen=True, slots=True, eq=False)
class Arc:
    """A circle or helix to ``end`` about a centre; it turns about ``normal`` by the right-hand rule.

    turns   whole turns besides
    """

    end: Floats
    centre: Floats
    normal: Floats
    radius: float
    turns: int = 0


@dataclass(frozen=True, slots=True, eq=False)
class ArcMap:
    """The map of circles under an affine map that keeps them: linear (3, 3), shift (3,), normals (3, 3) and scale."""

    linear: Floats
    shift: Floats
    normals: Floats
    scale: float

    @staticmethod
    def of(linear: Floats, shift: Floats) -> "ArcMap":
        """Return the map of circles; normals map with the cofactors, which takes mirroring into account."""
        volume = float(np.linalg.det(linear))
        scale = abs(volume) ** (1.0 / 3.0)
        return ArcMap(linear, shift, np.linalg.inv(linear).T * (scale * math.copysign(1.0, volume)), scale)

    def map_arc(self, arc: Arc) -> tuple[Floats, Floats, float]:
        """Return centre, normal and radius of the mapped arc."""
        return self.linear @ arc.centre + self.shift, self.normals @ arc.normal, arc.radius * self.scale

    def map_in_plane(self, arc: Arc) -> tuple[Floats, Floats, float] | None:
        """Return the same under unequal scales, which keep the circles of a plane whose two are equal; else None."""
        ways = self.linear @ np.roll(np.eye(3), -1 - int(np.argmax(np.abs(arc.normal))), axis=1)
        lengths = np.linalg.norm(ways, axis=0)
        cosines = np.abs(ways.T @ ways - np.diag(lengths**2))
        if abs(lengths[0] - lengths[1]) > SAME_SCALE * lengths[0] or cosines.max() > SAME_SCALE * lengths.max() ** 2:
            return None
        normal = cross(ways[:, 0], ways[:, 1]) * (float(arc.normal.sum()) / lengths[0] ** 2)
        return self.linear @ arc.centre + self.shift, normal, arc.radius * float(lengths[0])


def gap_of_turn(start: Floats, arc: Arc) -> float:
    """Return how far off a full turn a circle or helix ends, mm; 0 if it does not end right beside its start.

    A last digit decides there between a whole turn and nearly none, or between so many turns and one more. A short arc
    that neither rises nor turns is one.
    """
    chord = arc.end - start
    a, b, c = chord.tolist()
    x, y, z = arc.normal.tolist()
    rise = a * x + b * y + c * z
    gap = math.hypot(a - rise * x, b - rise * y, c - rise * z)
    if not SAME_POINT < gap < _GAP or arc.radius < _GAPS * gap:
        return 0.0
    goes_on = not arc.turns and float(cross(start - arc.centre, chord) @ arc.normal) > 0.0
    return 0.0 if goes_on and abs(rise) < _GAPS * gap else gap


def normal_of(plane: int, clockwise: bool) -> Floats:
    """Return the unit vector about which an arc turns by the right-hand rule."""
    normal = np.zeros(3)
    normal[plane] = -1.0 if clockwise else 1.0
    return normal


def by_centre(start: Floats, end: Floats, centre: Floats, plane: int, clockwise: bool, turns: int) -> Arc:
    """Return the arc about a centre, whose coordinate along the normal is ignored; a full circle if start is end."""
    middle = centre.copy()
    middle[plane] = start[plane]
    u, v = (plane + 1) % 3, (plane + 2) % 3
    about, first, last = centre.tolist(), start.tolist(), end.tolist()
    radius = math.hypot(first[u] - about[u], first[v] - about[v])
    radius_at_end = math.hypot(last[u] - about[u], last[v] - about[v])
    if radius < SAME_POINT:
        raise ArcError(Wording("NC320", "circle_no_radius"))
    if abs(radius_at_end - radius) > max(RADIUS_ERROR, RADIUS_RATIO * radius):
        raise ArcError(Wording("NC320", "radii_differ", start=radius, end=radius_at_end))
    return Arc(end, middle, normal_of(plane, clockwise), radius, turns)


def by_radius(start: Floats, end: Floats, radius: float, plane: int, clockwise: bool, turns: int) -> Arc:
    """Return the arc of a radius; a negative radius means the longer arc."""
    chord = _chord(start, end, plane)
    length = float(np.linalg.norm(chord))
    if length < SAME_POINT:
        raise ArcError(Wording("NC320", "full_circle_by_radius"))
    short = 0.5 * length - abs(radius)
    if short > max(RADIUS_ERROR, RADIUS_RATIO * abs(radius)):
        raise ArcError(Wording("NC320", "radius_too_small", radius=radius, length=length))
    height = math.sqrt(max(radius * radius - 0.25 * length * length, 0.0)) * math.copysign(1.0, radius)
    return _from_chord(start, end, chord, height, normal_of(plane, clockwise), turns)


def by_angle(start: Floats, end: Floats, angle: float, plane: int, clockwise: bool, turns: int) -> Arc:
    """Return the arc of an opening angle to an end point."""
    chord = _chord(start, end, plane)
    length = float(np.linalg.norm(chord))
    if length < SAME_POINT or not 0.0 < angle < 360.0:
        raise ArcError(Wording("NC320", "opening_angle_makes_no_circle", angle=angle))
    half = math.radians(0.5 * angle)
    if length > 2.0 * MAX_RADIUS * math.sin(half):
        raise ArcError(Wording("NC320", "opening_angle_needs_radius_no", angle=angle))
    height = 0.5 * length * math.cos(half) / math.sin(half)
    return _from_chord(start, end, chord, height, normal_of(plane, clockwise), turns)


def by_angle_and_centre(start: Floats, centre: Floats, angle: float, plane: int, clockwise: bool, turns: int) -> Arc:
    """Return the arc of an opening angle about a centre, which determine its end."""
    if not 0.0 < angle < 360.0:
        raise ArcError(Wording("NC320", "opening_angle_makes_no_circle", angle=angle))
    u, v = (plane + 1) % 3, (plane + 2) % 3
    radians = math.radians(-angle if clockwise else angle)
    a, b = start[u] - centre[u], start[v] - centre[v]
    end = start.copy()
    end[u] = centre[u] + a * math.cos(radians) - b * math.sin(radians)
    end[v] = centre[v] + a * math.sin(radians) + b * math.cos(radians)
    return by_centre(start, end, centre, plane, clockwise, turns)


def by_points(start: Floats, through: Floats, end: Floats, turns: int) -> Arc:
    """Return the arc through an intermediate point, in any plane."""
    a, b = through - start, end - start
    normal = cross(a, b)
    size = float(normal @ normal)
    if size < SAME_POINT * max(float(a @ a), float(b @ b), SAME_POINT):
        raise ArcError(Wording("NC320", "three_points_circle_lie_line"))
    centre = start + (cross(normal, a) * float(b @ b) + cross(b, normal) * float(a @ a)) / (2.0 * size)
    radius = float(np.linalg.norm(start - centre))
    if not SAME_POINT < radius < MAX_RADIUS:
        raise ArcError(Wording("NC320", "three_points_circle_make_no"))
    return Arc(end, centre, normal / math.sqrt(size), radius, turns)


def tangential(start: Floats, end: Floats, heading: Floats | None, plane: int, turns: int) -> Arc | None:
    """Return the arc that goes on in a direction, (3,) of any length or None; None if the end lies straight ahead."""
    chord = _chord(start, end, plane)
    way = np.zeros(3) if heading is None else heading.copy()
    way[plane] = 0.0
    length = float(np.linalg.norm(way))
    if length < SAME_POINT or float(np.linalg.norm(chord)) < SAME_POINT:
        raise ArcError(Wording("NC320", "no_direction_circle_could_go"))
    left = cross(normal_of(plane, False), way / length)
    across = float(left @ chord)
    if abs(across) < SAME_POINT * float(chord @ chord):
        return None
    centre = start + left * (float(chord @ chord) / (2.0 * across))
    if float(np.abs(centre).max()) > MAX_RADIUS:
        return None
    return by_centre(start, end, centre, plane, across < 0.0, turns)


def cross(a: Floats, b: Floats) -> Floats:
    """Return the vector product of two vectors (3,), bit for bit as ``np.cross``, which is slow for a single pair."""
    (a0, a1, a2), (b0, b1, b2) = a.tolist(), b.tolist()
    return np.array([a1 * b2 - a2 * b1, a2 * b0 - a0 * b2, a0 * b1 - a1 * b0])


def _chord(start: Floats, end: Floats, plane: int) -> Floats:
    chord = end - start
    chord[plane] = 0.0
    return np.asarray(chord)


def _from_chord(start: Floats, end: Floats, chord: Floats, height: float, normal: Floats, turns: int) -> Arc:
    """Return the arc whose centre is at a height over the middle of the chord, to its left about the normal."""
    left = cross(normal, chord)
    centre = start + 0.5 * chord + height * left / np.linalg.norm(left)
    middle = np.asarray(centre)
    radius = float(np.linalg.norm(start - middle))
    return Arc(end, middle, normal, radius, turns)
