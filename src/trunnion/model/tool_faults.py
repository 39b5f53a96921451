"""What is impossible about a tool, by the sizes that a CL file or a program states.

In:     a ``Tool`` in mm and degrees; 0 is a size that nothing states.
Out:    its faults: with an error there is no such tool; a warning says that two lengths contradict each other.
"""

from collections.abc import Iterator
from typing import Final, NamedTuple

from trunnion.errors import Severity
from trunnion.model.toolpath import Tool

#: The greatest length of a tool or a part of it, mm: a larger one is in another unit, or a slip.
GREATEST: Final = 10_000.0

#: How far a corner may be off what its tool has room for, as a part of the diameter: sizes are rounded, also in inches.
_ROUNDING: Final = 1e-3

_SIZES: Final = (
    "diameter",
    "corner_radius",
    "length",
    "flute_length",
    "upper_radius",
    "extension",
    "set_length",
)

#: Radii of barrels are larger than the tool.
_RADII: Final = frozenset({"corner_radius", "upper_radius"})

_RIGHT_ANGLE: Final = 90.0
_ANGLE_ROUNDING: Final = 0.01


class ToolFault(NamedTuple):
    """What is wrong with a tool, its cure, and whether it can be lived with."""

    what: str
    cure: str
    severity: Severity = Severity.ERROR


def tool_faults(tool: Tool) -> tuple[ToolFault, ...]:
    """Return everything that is impossible about a tool."""
    return tuple(_sizes(tool)) or (*_corners(tool), *_angles(tool), *_lengths(tool))


def _sizes(tool: Tool) -> Iterator[ToolFault]:
    """Sizes that nothing has."""
    for size in _SIZES:
        value, name = float(getattr(tool, size)), size.replace("_", " ")
        if value < 0.0:
            yield ToolFault(f"the tool has a negative {name}: {value:g}", f"write the {name} of the tool, 0 or more")
        elif value > GREATEST and size not in _RADII:
            cure = f"write one up to {GREATEST:g} mm, or check the unit of the file"
            yield ToolFault(f"the tool has a {name} of {value:.10g} mm", cure)


def _corners(tool: Tool) -> Iterator[ToolFault]:
    """A corner that its tool has no room for; one whose centre the file says may be that of a barrel."""
    d, r = tool.diameter, tool.corner_radius
    e, f = tool.corner_centre or (-1.0, r)
    if d and e >= 0.0 and r - f > _ROUNDING * d:
        what = (
            f"the corner of the tool would reach below its tip: its radius is {r:g}, and its centre {f:g} above the tip"
        )
        yield ToolFault(what, "write the seven numbers of CUTTER in their order")
    if d and tool.kind != "BARREL" and tool.corner_centre is None and r > 0.5 * d + _ROUNDING * d:
        what = f"the tool has a corner radius of {r:g}, more than half its diameter {d:g}"
        yield ToolFault(what, "write the radius of the corner, and half the diameter for a ball")


def _angles(tool: Tool) -> Iterator[ToolFault]:
    """Angles between which there is no cutter."""
    taper, tip = tool.taper_angle, tool.tip_angle
    if abs(taper) >= _RIGHT_ANGLE:
        yield ToolFault(f"the side of the tool is {taper:g} degrees off its axis", "write an angle below 90")
    if tool.kind == "DRILL":
        if not 0.0 <= tip <= 2.0 * _RIGHT_ANGLE:
            yield ToolFault(f"the point of the drill has {tip:g} degrees", "write the whole angle, from 0 to 180")
    elif not 0.0 <= tip < _RIGHT_ANGLE:
        yield ToolFault(f"the bottom of the tool is {tip:g} degrees off the horizontal", "write an angle from 0 to 90")
    elif abs(taper) < _RIGHT_ANGLE < taper + tip - _ANGLE_ROUNDING:
        what = f"bottom and side of the tool never meet: {tip:g} degrees from the horizontal, {taper:g} from the axis"
        yield ToolFault(what, "write angles that are 90 together at most")


def _lengths(tool: Tool) -> Iterator[ToolFault]:
    """Lengths that contradict each other."""
    if tool.length and tool.flute_length > tool.length:
        what = f"the tool has flutes of {tool.flute_length:g} mm, more than its length {tool.length:g}"
        yield ToolFault(what, "check both in the CAM system", Severity.WARNING)
