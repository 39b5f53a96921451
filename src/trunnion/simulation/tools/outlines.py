"""The outline of the cutter of each kind, from its sizes, which have no faults."""

import math
from collections.abc import Callable, Mapping
from itertools import pairwise
from typing import Final

from trunnion.simulation.tools.profile import Element, Point, ProfileArc, ProfileLine
from trunnion.simulation.tools.sizes import ToolKind, ToolSizes, ball_height, corner_room, groove_depth, tooth_count


def cutter_outline(sizes: ToolSizes) -> tuple[Element, ...]:
    """Return the outline of a cutter from its tip to where its straight side begins, or to its end."""
    return _OUTLINES[sizes.kind](sizes)


def tip_height(sizes: ToolSizes) -> float:
    """Return the height of the outline of a cutter, without making many teeth for it."""
    if sizes.kind is ToolKind.THREAD_MILL:
        return tooth_count(sizes) * sizes.pitch
    return cutter_outline(sizes)[-1].end[1]


def side_slope(sizes: ToolSizes) -> float | None:
    """Return how much the radius grows by mm of height above the outline of a cutter; None if the cutter ends there."""
    if sizes.kind in (ToolKind.LOLLIPOP, ToolKind.T_SLOT, ToolKind.THREAD_MILL, ToolKind.BARREL):
        return None
    return 0.0 if sizes.kind is ToolKind.CHAMFER else math.tan(math.radians(sizes.side_angle))


def rounded_corner(half: float, radius: float, bottom: float, side: float) -> tuple[Element, ...]:
    """Return the outline of a mill of straight bottom and side with a round corner between them.

    half    radius where bottom and side would meet, mm
    radius  of the corner, mm; one that hardly fits is made to fit
    bottom  angle of the bottom from the horizontal, degrees
    side    angle of the side from the tool axis, degrees
    """
    a, b = math.radians(bottom), math.radians(side)
    meet = (half, half * math.tan(a))
    if radius == 0.0:
        return _lines((0.0, 0.0), meet)
    room = corner_room(half, a, b)
    touches_axis = radius >= room * (1.0 - 1e-9)
    radius = min(radius, room)
    back = radius * math.cos(a + b) / (1.0 + math.sin(a + b))
    low = (0.0, 0.0) if touches_axis else (meet[0] - back * math.cos(a), meet[1] - back * math.sin(a))
    high = (meet[0] + back * math.sin(b), meet[1] + back * math.cos(b))
    centre = (low[0] - radius * math.sin(a), low[1] + radius * math.cos(a))
    return (*_lines((0.0, 0.0), low), ProfileArc(low, high, centre))


def _lines(*corners: Point) -> tuple[Element, ...]:
    """Return the lines from corner to corner."""
    return tuple(ProfileLine(start, end) for start, end in pairwise(corners) if start != end)


def _ball(radius: float, top: Point) -> tuple[Element, ...]:
    """Return the outline of a ball that stands on its tip, up to a point on it."""
    return (ProfileArc((0.0, 0.0), top, (0.0, radius)),)


def _mill(sizes: ToolSizes) -> tuple[Element, ...]:
    half = 0.5 * sizes.diameter
    radius = half if sizes.kind is ToolKind.BALL else sizes.corner_radius
    return rounded_corner(half, radius, 0.0, sizes.side_angle)


def _taper_ball(sizes: ToolSizes) -> tuple[Element, ...]:
    radius, b = 0.5 * sizes.diameter, math.radians(sizes.side_angle)
    return _ball(radius, (radius * math.cos(b), radius - radius * math.sin(b)))


def _drill(sizes: ToolSizes) -> tuple[Element, ...]:
    return rounded_corner(0.5 * sizes.diameter, sizes.corner_radius, 90.0 - 0.5 * sizes.tip_angle, sizes.side_angle)


def _chamfer(sizes: ToolSizes) -> tuple[Element, ...]:
    half, tip = 0.5 * sizes.diameter, 0.5 * sizes.tip_diameter
    return _lines((0.0, 0.0), (tip, 0.0), (half, (half - tip) / math.tan(math.radians(sizes.side_angle))))


def _lollipop(sizes: ToolSizes) -> tuple[Element, ...]:
    return _ball(0.5 * sizes.diameter, (0.5 * sizes.neck_diameter, ball_height(sizes)))


def _t_slot(sizes: ToolSizes) -> tuple[Element, ...]:
    half, height = 0.5 * sizes.diameter, sizes.flute_length
    lower = min(sizes.corner_radius, half, height)
    upper = min(sizes.upper_radius, half, height - lower)
    outline = rounded_corner(half, lower, 0.0, 0.0)
    outline += _lines(outline[-1].end, (half, height - upper))
    if upper:
        centre = (half - upper, height - upper)
        outline += (ProfileArc((half, height - upper), (half - upper, height), centre),)
    return outline


def _thread_mill(sizes: ToolSizes) -> tuple[Element, ...]:
    half, pitch = 0.5 * sizes.diameter, sizes.pitch
    depth = groove_depth(sizes)
    root = max(half - depth, 0.5 * sizes.neck_diameter)
    # Half the height of a tooth at its crest and at the core.
    crest = 0.5 * sizes.crest
    base = min(crest + (0.5 * pitch - crest) * (half - root) / depth, 0.5 * pitch)
    corners: list[Point] = [(0.0, 0.0)]
    for tooth in range(tooth_count(sizes)):
        middle = (tooth + 0.5) * pitch
        low = max(middle - base, corners[-1][1])  # two teeth that meet do so at one height
        corners += [(root, corners[-1][1]), (root, low)]
        corners += [(half, middle - crest), (half, middle + crest), (root, middle + base)]
    corners.append((root, max(tooth_count(sizes) * pitch, corners[-1][1])))
    return _lines(*corners)


def _barrel(sizes: ToolSizes) -> tuple[Element, ...]:
    profile, widest, corner = sizes.profile_radius, sizes.widest_height, sizes.corner_radius
    centre = (0.5 * sizes.diameter - profile, widest)
    top = (centre[0] + math.sqrt(profile**2 - (sizes.flute_length - widest) ** 2), sizes.flute_length)
    if corner == 0.0:
        foot = (centre[0] + math.sqrt(profile**2 - widest**2), 0.0)
        return (*_lines((0.0, 0.0), foot), ProfileArc(foot, top, centre))
    # The corner touches the side from within: both centres and the point of contact are on one line.
    between = profile - corner
    inner = (centre[0] + math.sqrt(between**2 - (widest - corner) ** 2), corner)
    contact = tuple(c + profile / between * (i - c) for c, i in zip(centre, inner, strict=True))
    touch = (contact[0], contact[1])
    return (
        *_lines((0.0, 0.0), (inner[0], 0.0)),
        ProfileArc((inner[0], 0.0), touch, inner),
        ProfileArc(touch, top, centre),
    )


_OUTLINES: Final[Mapping[ToolKind, Callable[[ToolSizes], tuple[Element, ...]]]] = {
    ToolKind.FLAT: _mill,
    ToolKind.BALL: _mill,
    ToolKind.BULL: _mill,
    ToolKind.TAPER: _mill,
    ToolKind.TAPER_BALL: _taper_ball,
    ToolKind.DRILL: _drill,
    ToolKind.CHAMFER: _chamfer,
    ToolKind.LOLLIPOP: _lollipop,
    ToolKind.T_SLOT: _t_slot,
    ToolKind.THREAD_MILL: _thread_mill,
    ToolKind.BARREL: _barrel,
}
