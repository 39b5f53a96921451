"""The profile of a tool: what its revolving body is, as lines and arcs in the plane of radius and height.

Frame of the tool: origin at the tip, z up the tool axis, from the tip to the holder. Units: mm.
"""

import math
from enum import StrEnum
from typing import Final, TypeAlias

from trunnion.messages import Wording
from trunnion.records import dataclass

#: Two points nearer to each other than this, as a part of their size, are the same: outlines are computed.
_SAME: Final = 1e-9

#: Radius and height of a point.
Point: TypeAlias = tuple[float, float]


class Role(StrEnum):
    """What a section of a tool is there for. SHANK is everything of the tool itself that does not cut."""

    CUTTER = "cutter"
    SHANK = "shank"
    HOLDER = "holder"


@dataclass(frozen=True, slots=True)
class ProfileLine:
    """A straight element of an outline, from below to above, or level."""

    start: Point
    end: Point

    def __post_init__(self) -> None:
        _check_points(self.start, self.end)
        if self.end[1] < self.start[1]:
            raise ValueError("a line of an outline goes down")

    def radius_at(self, z: float) -> float:
        """Return the radius at a height between start and end."""
        share = (z - self.start[1]) / (self.end[1] - self.start[1])
        return self.start[0] + share * (self.end[0] - self.start[0])


@dataclass(frozen=True, slots=True)
class ProfileArc:
    """A round element of an outline, from below to above: the short arc about ``centre``, bulging outward."""

    start: Point
    end: Point
    centre: Point

    def __post_init__(self) -> None:
        _check_points(self.start, self.end)
        slack = _SAME * (self.radius + math.hypot(*self.centre))
        apart = math.dist(self.start, self.centre) - math.dist(self.end, self.centre)
        if abs(apart) > slack or self.end[1] <= self.start[1]:
            raise ValueError("the ends of an arc are not at one distance from its centre, or the second is not higher")
        if min(self.start[0], self.end[0]) < self.centre[0] - slack:
            raise ValueError("an arc of an outline does not bulge outward all along")

    @property
    def radius(self) -> float:
        """The radius of the arc itself, mm."""
        return math.dist(self.start, self.centre)

    def radius_at(self, z: float) -> float:
        """Return the distance from the tool axis at a height between start and end."""
        return self.centre[0] + math.sqrt(max(self.radius**2 - (z - self.centre[1]) ** 2, 0.0))


Element: TypeAlias = ProfileLine | ProfileArc


@dataclass(frozen=True, slots=True)
class Section:
    """A part of a tool that one role fits: its outline revolved, closed by discs at its lowest and highest z.

    outline  from the tool axis or from the section below, going up; each element begins where the last one ends
    name     for messages, such as "holder piece 2"
    """

    role: Role
    outline: tuple[Element, ...]
    name: str = ""

    def __post_init__(self) -> None:
        if not self.outline or self.top <= self.bottom:
            raise ValueError("a section has no height")
        for below, above in zip(self.outline, self.outline[1:], strict=False):
            if math.dist(below.end, above.start) > _SAME * (1.0 + math.hypot(*below.end)):
                raise ValueError("an outline has a gap")

    @property
    def bottom(self) -> float:
        """Its lowest z, mm."""
        return self.outline[0].start[1]

    @property
    def top(self) -> float:
        """Its highest z, mm."""
        return self.outline[-1].end[1]


@dataclass(frozen=True, slots=True)
class ToolShape:
    """A tool as a body: its cutter, its shank and the pieces of its holder, from below to above.

    number        by which programs call it; None if it has none
    length        from the tip to the gauge point, mm; 0 if it is not known
    flute_length  from the tip to where it stops cutting, mm
    remarks       what had to be taken for granted
    is_drawn_only nothing states how long it is: its size can be drawn, and counts for nothing
    """

    sections: tuple[Section, ...]
    name: str = ""
    number: int | None = None
    length: float = 0.0
    flute_length: float = 0.0
    description: str = ""
    remarks: tuple[Wording, ...] = ()
    is_drawn_only: bool = False

    @property
    def top(self) -> float:
        """The highest z of its body, mm."""
        return max(section.top for section in self.sections)


def divide(outline: tuple[Element, ...], z: float) -> tuple[tuple[Element, ...], tuple[Element, ...]]:
    """Return the parts of an outline below and above a height; ends that are nearly there are."""
    below: list[Element] = []
    above: list[Element] = []
    slack = _SAME * (1.0 + abs(z))
    for element in outline:
        if element.end[1] <= z + slack:
            below.append(element)
        elif element.start[1] >= z - slack:
            above.append(element)
        else:
            at = (element.radius_at(z), z)
            below.append(_between(element, element.start, at))
            above.append(_between(element, at, element.end))
    return tuple(below), tuple(above)


def _between(element: Element, start: Point, end: Point) -> Element:
    return ProfileArc(start, end, element.centre) if isinstance(element, ProfileArc) else ProfileLine(start, end)


def _check_points(*points: Point) -> None:
    if not all(math.isfinite(value) for point in points for value in point) or min(point[0] for point in points) < 0.0:
        raise ValueError("a point of an outline is not finite, or beyond the tool axis")


def cutting_width(tool: ToolShape) -> float:
    """Return the greatest diameter of what cuts of a tool, mm; infinite where nothing does."""
    points = [
        point for section in tool.sections if section.role is Role.CUTTER
        for element in section.outline for point in (element.start, element.end)
    ]  # fmt: skip
    return 2.0 * max((radius for radius, _ in points), default=float("inf"))
