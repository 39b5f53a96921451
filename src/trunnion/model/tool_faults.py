"""What is wrong with a tool, by the sizes that a CL file or a program states, and what tells two tools apart.

In:     a ``Tool`` in mm and degrees; 0 is a size that nothing states.
Out:    its faults: with an error there is no such tool; a warning says that two lengths contradict each other.
"""

import math
from collections.abc import Iterator, Mapping
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


#: Sizes of a tool that are compared, mm and degrees, with what two files may differ by when they write the same size:
#: one in inches rounds to the fourth decimal.
_COMPARED: Final[Mapping[str, float]] = {
    "diameter": 0.002,
    "corner_radius": 0.002,
    "length": 0.002,
    "taper_angle": 0.01,
    "tip_angle": 0.01,
}

#: Sizes of which 0 says that the file does not know them.
_UNKNOWN_AT_ZERO: Final = frozenset({"diameter", "length"})


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


def told_apart(one: Tool, two: Tool) -> Iterator[str]:
    """Yield how a CL file tells two tools apart, by their names and forms, in words."""
    if one.name and two.name and one.name != two.name:
        yield f"name {one.name} and {two.name}"
    yield from tool_differences(one, two)


def tool_differences(one: Tool, two: Tool) -> Iterator[str]:
    """Yield what both tools state of their form and where they differ, in words."""
    if "UNKNOWN" in (one.kind, two.kind):
        return
    if one.kind != two.kind:
        yield f"form {one.kind} and {two.kind}"
    for size, tolerance in _COMPARED.items():
        a, b = float(getattr(one, size)), float(getattr(two, size))
        is_stated = size not in _UNKNOWN_AT_ZERO or (a != 0.0 and b != 0.0)
        # Angles of different forms are different angles.
        if is_stated and abs(a - b) > tolerance and (one.kind == two.kind or not size.endswith("angle")):
            yield f"{size.replace('_', ' ')} {a:g} and {b:g}"
    here, there = one.corner_centre, two.corner_centre
    if here and there and math.dist(here, there) > _COMPARED["corner_radius"]:
        yield f"corner centre {here[0]:g},{here[1]:g} and {there[0]:g},{there[1]:g}"
