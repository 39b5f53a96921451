"""What is impossible about a tool, by the sizes that a CL file or a program states.

In:     a ``Tool`` in mm and degrees; 0 is a size that nothing states.
Out:    its faults: with an error there is no such tool; a warning says that two lengths contradict each other.
"""

from collections.abc import Iterator
from typing import Final, NamedTuple

from trunnion.errors import Severity
from trunnion.messages import Wording
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
    """What is wrong with a tool, and whether it can be lived with."""

    wording: Wording
    severity: Severity = Severity.ERROR


def tool_faults(tool: Tool) -> tuple[ToolFault, ...]:
    """Return everything that is impossible about a tool."""
    return tuple(_sizes(tool)) or (*_corners(tool), *_angles(tool), *_lengths(tool))


def _sizes(tool: Tool) -> Iterator[ToolFault]:
    """Sizes that nothing has."""
    for size in _SIZES:
        value, name = float(getattr(tool, size)), size.replace("_", " ")
        if value < 0.0:
            yield ToolFault(Wording("CL770", "tool_negative", name=name, value=value))
        elif value > GREATEST and size not in _RADII:
            yield ToolFault(Wording("CL770", "tool_mm", name=name, value=value, greatest=GREATEST))


def _corners(tool: Tool) -> Iterator[ToolFault]:
    """Yield a corner that its tool has no room for; one whose centre the file says may be that of a barrel."""
    d, r = tool.diameter, tool.corner_radius
    e, f = tool.corner_centre or (-1.0, r)
    if d and e >= 0.0 and r - f > _ROUNDING * d:
        yield ToolFault(Wording("CL770", "corner_tool_would", r=r, f=f))
    if d and tool.kind != "BARREL" and tool.corner_centre is None and r > 0.5 * d + _ROUNDING * d:
        yield ToolFault(Wording("CL770", "tool_corner_radius", r=r, d=d))


def _angles(tool: Tool) -> Iterator[ToolFault]:
    """Angles between which there is no cutter."""
    taper, tip = tool.taper_angle, tool.tip_angle
    if abs(taper) >= _RIGHT_ANGLE:
        yield ToolFault(Wording("CL770", "side_tool_degrees", taper=taper))
    if tool.kind == "DRILL":
        if not 0.0 <= tip <= 2.0 * _RIGHT_ANGLE:
            yield ToolFault(Wording("CL770", "point_drill_degrees", tip=tip))
    elif not 0.0 <= tip < _RIGHT_ANGLE:
        yield ToolFault(Wording("CL770", "bottom_tool_degrees", tip=tip))
    elif abs(taper) < _RIGHT_ANGLE < taper + tip - _ANGLE_ROUNDING:
        yield ToolFault(Wording("CL770", "bottom_side_tool", tip=tip, taper=taper))


def _lengths(tool: Tool) -> Iterator[ToolFault]:
    """Lengths that contradict each other."""
    if tool.length and tool.flute_length > tool.length:
        yield ToolFault(
            Wording("CL770", "tool_flutes_mm", flute_length=tool.flute_length, length=tool.length),
            severity=Severity.WARNING,
        )
