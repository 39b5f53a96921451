"""Elements of a contour in the working plane, what rounds or chamfers the corner between two, and ways to and from it.

Input and output in programmed coordinates, mm and degrees; a plane is given by the axis normal to it, as in ``arcs``.
"""

import math
from typing import Final, NamedTuple

import numpy as np

from trunnion.arrays import Floats
from trunnion.messages import Wording
from trunnion.readers.control import arcs
from trunnion.readers.control.worded_error import WordedError
from trunnion.records import dataclass

#: Elements that are this far out of the working plane, mm, are in it.
IN_PLANE: Final = 1e-6

#: Directions whose angle is smaller than this, radians, are the same: there is no corner.
SAME_DIRECTION: Final = 1e-5

#: An element may be this much too short for a corner, mm: the last digit of a program.
LENGTH_ERROR: Final = 1e-4


class ContourError(WordedError):
    """The reason why a corner, an approach or a departure cannot be made."""


@dataclass(frozen=True, slots=True, eq=False)
class Element:
    """A line, or with ``arc`` a circle, from ``start`` to ``end``, (3,) programmed positions.

    rapid   it is at rapid
    turns   rotary axes turn in it
    """

    start: Floats
    end: Floats
    arc: arcs.Arc | None = None
    rapid: bool = False
    turns: bool = False

    @property
    def has_length(self) -> bool:
        """Whether it moves: a full circle does."""
        return self.arc is not None or float(np.linalg.norm(self.end - self.start)) > arcs.SAME_POINT

    def lies_in(self, plane: int) -> bool:
        """Whether it stays in the working plane at its height."""
        across = abs(float(self.end[plane] - self.start[plane])) <= IN_PLANE
        return across and (self.arc is None or abs(float(self.arc.normal[plane])) > 1.0 - IN_PLANE)

    def direction(self, at: Floats) -> Floats:
        """Return its direction at one of its points, a unit vector; that of a helix without its rise."""
        way = self.end - self.start if self.arc is None else arcs.cross(self.arc.normal, at - self.arc.centre)
        length = float(np.linalg.norm(way))
        if length < arcs.SAME_POINT:
            raise ContourError(Wording("NC324", "no_direction"))
        return np.asarray(way / length)

    def length_between(self, first: Floats, last: Floats) -> float:
        """Return the signed way along it from one of its points to another, within half a turn of a circle."""
        if self.arc is None:
            return float((last - first) @ self.direction(first))
        a, b, normal = first - self.arc.centre, last - self.arc.centre, self.arc.normal
        return self.arc.radius * math.atan2(float(arcs.cross(a, b) @ normal), float(a @ b))

    @property
    def length(self) -> float:
        """The length of its way in the working plane, of one turn at most."""
        if self.arc is None:
            return float(np.linalg.norm(self.end - self.start))
        angle = self.length_between(self.start, self.end) / self.arc.radius
        full = float(np.linalg.norm(self.end - self.start)) < arcs.SAME_POINT
        return self.arc.radius * (2.0 * math.pi if full else angle % (2.0 * math.pi))


class Corner(NamedTuple):
    """What takes the place of a corner: from ``first`` on the element before to ``last`` on the one behind."""

    first: Floats
    last: Floats
    arc: arcs.Arc | None


def corner_turn(before: Element, behind: Element, plane: int) -> float:
    """Return the angle by which the contour turns at a corner, radians, positive to the left; 0 where it goes on."""
    first, second = before.direction(before.end), behind.direction(behind.start)
    angle = math.atan2(float(arcs.cross(first, second)[plane]), float(first @ second))
    return 0.0 if abs(angle) < SAME_DIRECTION else angle


def check_chamfered(before: Element, behind: Element) -> None:
    """Raise ``ContourError`` if one of the two elements of a chamfer is a circle, tangent or not."""
    if before.arc is not None or behind.arc is not None:
        raise ContourError(Wording("NC324", "chamfer_beside_circle"))


def chamfer(before: Element, behind: Element, side: float) -> Corner:
    """Return the chamfer that cuts ``side`` off both lines."""
    check_chamfered(before, behind)
    for element in (before, behind):
        _check_length(side, element)
    corner = before.end
    first = corner - side * before.direction(corner)
    return Corner(first, corner + side * behind.direction(corner), None)


def rounding(before: Element, behind: Element, radius: float, plane: int) -> Corner:
    """Return the arc of a radius that is tangent to both elements of a corner."""
    angle = corner_turn(before, behind, plane)
    if abs(angle) > math.pi - SAME_DIRECTION:
        raise ContourError(Wording("NC324", "goes_back"))
    left = arcs.normal_of(plane, clockwise=angle < 0.0)
    found: list[tuple[float, Corner]] = []
    for centre in _centres(before, behind, radius, left):
        first, last = _foot(before, centre), _foot(behind, centre)
        cut, used = before.length_between(first, before.end), behind.length_between(behind.start, last)
        if min(cut, used) > 0.0:
            found.append((max(cut, used), Corner(first, last, arcs.Arc(last, centre, left, radius))))
    if not found:
        raise ContourError(Wording("NC324", "no_room", size=radius))
    corner = min(found, key=lambda pair: pair[0])[1]
    _check_length(before.length_between(corner.first, before.end), before)
    _check_length(behind.length_between(behind.start, corner.last), behind)
    return corner


def _check_length(cut: float, element: Element) -> None:
    if cut > element.length + LENGTH_ERROR:
        raise ContourError(Wording("NC324", "too_short", length=element.length, cut=cut))


def _foot(element: Element, centre: Floats) -> Floats:
    """Return the point of the line or circle of an element that is nearest to a point of the plane."""
    if element.arc is None:
        way = element.direction(element.start)
        return np.asarray(element.start + way * float((centre - element.start) @ way))
    out = centre - element.arc.centre
    return np.asarray(element.arc.centre + out * (element.arc.radius / float(np.linalg.norm(out))))


def _centres(before: Element, behind: Element, radius: float, left: Floats) -> list[Floats]:
    """Return the points at a distance from both elements, on the side to which ``left`` turns their directions."""
    moved = [_offset(element, radius, left) for element in (before, behind)]
    lines = [element for element in moved if element.arc is None]
    circles = [element.arc for element in moved if element.arc is not None]
    if not circles:
        first, second = (element.direction(element.start) for element in lines)
        across = arcs.cross(left, second)
        along = float((lines[1].start - lines[0].start) @ across) / float(first @ across)
        return [lines[0].start + first * along]
    if lines:
        foot, way = _foot(lines[0], circles[0].centre), lines[0].direction(lines[0].start)
        middle, out = foot, way
    else:
        between = circles[1].centre - circles[0].centre
        distance = float(np.linalg.norm(between))
        if distance < arcs.SAME_POINT:
            return []
        square = distance**2 + circles[0].radius ** 2 - circles[1].radius ** 2
        middle = circles[0].centre + between * (square / (2.0 * distance**2))
        out = arcs.cross(left, between / distance)
    rest = circles[0].radius ** 2 - float(np.sum((middle - circles[0].centre) ** 2))
    if rest < 0.0:
        return []
    return [middle + sign * math.sqrt(rest) * out for sign in (1.0, -1.0)]


def _offset(element: Element, distance: float, left: Floats) -> Element:
    """Return the element moved to the side to which ``left`` turns its direction."""
    if element.arc is None:
        shift = distance * arcs.cross(left, element.direction(element.start))
        return Element(element.start + shift, element.end + shift)
    arc = element.arc
    radius = arc.radius - distance * math.copysign(1.0, float(arc.normal @ left))
    if radius < arcs.SAME_POINT:
        raise ContourError(Wording("NC324", "no_room", size=distance))
    return Element(element.start, element.end, arcs.Arc(element.end, arc.centre, arc.normal, radius))


# Approach and departure


class Lead(NamedTuple):
    """A way from a contour point: to ``point`` off the contour, on ``arc`` or straight; both as the tool leaves."""

    point: Floats
    arc: arcs.Arc | None = None


def lead_line(contour_point: Floats, direction: Floats, length: float) -> Lead:
    """Return the straight way off a contour point."""
    return Lead(contour_point + length * direction)


def lead_arc(contour_point: Floats, direction: Floats, radius: float, angle: float, normal: Floats) -> Lead:
    """Return the way off a contour point on an arc of an angle, degrees, that turns about ``normal``."""
    centre = contour_point + radius * arcs.cross(normal, direction)
    point = centre + _turned(contour_point - centre, normal, math.radians(angle))
    return Lead(point, arcs.Arc(point, centre, normal, radius))


def lead_to(contour_point: Floats, direction: Floats, radius: float, target: Floats, plane: int) -> Lead:
    """Return the way off a contour point on an arc from which a line goes on tangentially to a target.

    It turns to the side of the target, the shorter way.
    """
    way = target - contour_point
    way[plane] = 0.0
    across = float(arcs.cross(direction, way)[plane])
    if abs(across) < arcs.SAME_POINT:
        raise ContourError(Wording("NC324", "straight_ahead"))
    normal = arcs.normal_of(plane, clockwise=across < 0.0)
    centre = contour_point + radius * arcs.cross(normal, direction)
    out = target - centre
    out[plane] = 0.0
    distance = float(np.linalg.norm(out))
    if distance < radius:
        raise ContourError(Wording("NC324", "inside_arc", radius=radius))
    # Seen from the centre the tangent point is before the target by the angle whose cosine is radius / distance.
    point = centre + _turned(out * (radius / distance), normal, -math.acos(min(radius / distance, 1.0)))
    point[plane] = contour_point[plane]
    return Lead(point, arcs.Arc(point, centre, normal, radius))


def _turned(vector: Floats, normal: Floats, angle: float) -> Floats:
    """Return a vector of a plane turned about its normal, radians."""
    return np.asarray(vector * math.cos(angle) + arcs.cross(normal, vector) * math.sin(angle))
