"""The outline of the cutter of each kind, from its sizes."""

import math

from trunnion.simulation.tool_profile import Element, Point, ProfileArc, ProfileLine
from trunnion.simulation.tool_sizes import ToolKind, ToolSizes


def cutter_outline(sizes: ToolSizes) -> tuple[Element, ...]:
    """The outline of a cutter from its tip to where its side begins, which goes on as ``side_slope`` says.

    ``sizes`` have no faults.
    """
    half = 0.5 * sizes.diameter
    radius = half if sizes.kind is ToolKind.BALL else min(sizes.corner_radius, half)
    return rounded_corner(half, radius, 0.0, 0.0)


def side_slope(sizes: ToolSizes) -> float:
    """How much the radius grows by mm of height above the outline of a cutter."""
    return 0.0


def rounded_corner(half: float, radius: float, bottom: float, side: float) -> tuple[Element, ...]:
    """The outline of a mill of straight bottom and side with a round corner between them.

    half    radius where bottom and side would meet, mm
    radius  of the corner, mm
    bottom  angle of the bottom from the horizontal, degrees
    side    angle of the side from the tool axis, degrees
    """
    a, b = math.radians(bottom), math.radians(side)
    meet = (half, half * math.tan(a))
    if radius == 0.0:
        return _line((0.0, 0.0), meet)
    # The centre is as far from the line of the bottom as from that of the side.
    back = radius * math.cos(a + b) / (1.0 + math.sin(a + b))
    low = (max(meet[0] - back * math.cos(a), 0.0), max(meet[1] - back * math.sin(a), 0.0))
    high = (meet[0] + back * math.sin(b), meet[1] + back * math.cos(b))
    centre = (low[0] - radius * math.sin(a), low[1] + radius * math.cos(a))
    return (*_line((0.0, 0.0), low), ProfileArc(low, high, centre))


def _line(start: Point, end: Point) -> tuple[Element, ...]:
    return (ProfileLine(start, end),) if start != end else ()
