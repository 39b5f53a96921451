"""A cutter by the seven parameters of APT: what all dialects of CL files can say of its form.

Frame of the tool: origin at the tip, height up the tool axis. Units: mm and degrees.
"""

import math
from typing import Final, NamedTuple

from trunnion.model.toolpath import Tool

#: How far a corner's centre may be off that of a plain corner, mm or as a part of the diameter: numbers are rounded.
_SAME_CENTRE: Final = 1e-3

_NO_CONE: Final = 180.0


class AptCutter(NamedTuple):
    """CUTTER/d,r,e,f,a,b,h.

    d     diameter where the lines of bottom and side meet
    r     radius of the corner
    e, f  centre of the corner: distance from the axis, negative beyond it, and height above the tip
    a     angle of the bottom from the horizontal
    b     angle of the side from the axis; negative: it grows narrower upwards
    h     height of the cutter
    """

    d: float
    r: float
    e: float
    f: float
    a: float
    b: float
    h: float


def apt_cutter(tool: Tool) -> AptCutter:
    """Return the seven parameters of a tool; what nothing states is 0.

    A corner without a centre touches a level bottom and an upright side. Of a TCUTTER and a BARREL this is the lower
    corner; ``upper_radius`` and ``upper_centre`` have the other one.
    """
    d, r = tool.diameter, tool.corner_radius
    bottom = 0.5 * (_NO_CONE - tool.tip_angle) if tool.kind == "DRILL" and tool.tip_angle else tool.tip_angle
    side = 0.0 if tool.kind == "DRILL" else tool.taper_angle
    if tool.corner_centre is not None:
        e, f = tool.corner_centre
    elif r == 0.0:
        e, f = 0.5 * d, 0.5 * d * math.tan(math.radians(bottom)) if bottom < 0.5 * _NO_CONE else 0.0
    else:
        e, f = 0.5 * d - r, r
    return AptCutter(d, r, e, f, bottom, side, tool.flute_length if tool.kind == "TCUTTER" else tool.length)


def stated_centre(diameter: float, radius: float, e: float, f: float) -> tuple[float, float] | None:
    """Return the centre of a corner as a file gives it; None if that is not one, or that of a plain corner.

    A plain corner touches a level bottom and an upright side; files write its centre, or 0 and 0, or nothing.
    """
    if not radius or (e == 0.0 and f == 0.0):
        return None
    plain = max(abs(e - (0.5 * diameter - radius)), abs(f - radius)) <= _SAME_CENTRE * max(diameter, 1.0)
    return None if plain else (e, f)
