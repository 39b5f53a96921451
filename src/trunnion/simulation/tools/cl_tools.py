"""Tools of CL files as bodies, as far as a CL file settles their form."""

import math
from typing import Final

from trunnion.errors import InputError, Problem
from trunnion.messages import Wording, phrase
from trunnion.model.apt_cutter import apt_cutter
from trunnion.model.toolpath import Tool
from trunnion.simulation.tools.outlines import rounded_corner
from trunnion.simulation.tools.profile import Point, ProfileArc, ToolShape
from trunnion.simulation.tools.shapes import shape_faults, tool_shape
from trunnion.simulation.tools.sizes import ROUNDING, ToolKind, ToolSizes

#: A corner radius that is so near to half the diameter, as a part of it, makes a ball.
_BALL: Final = 1.0 - ROUNDING

#: How far sizes that say the same may differ, as a part of the diameter.
_SAME: Final = 1e-3


def cl_tool_shape(tool: Tool, number: int | None, *, file: str, line: int, dialect: str = "clsf") -> ToolShape:
    """Return the body of a cutter that a CL file describes.

    number      by which programs call it, if they do
    file, line  where it is described, for messages
    dialect     that of the CL file, ``Toolpath.dialect``

    Raises ``InputError`` if the CL file does not say all of its form, or says it in a way whose meaning is not settled.
    """
    name = tool.name if number is None else number
    called = phrase("tool_called", name=name) if name != "" else phrase("its_tool")
    if unsettled := _unsettled(tool, dialect):
        raise InputError(
            Problem(
                file,
                line,
                Wording("SIM154", "tool", number=number, unsettled=unsettled)
                if number is not None
                else (
                    Wording("SIM154", "unsettled_tool", tool=tool.name, unsettled=unsettled)
                    if tool.name
                    else Wording("SIM154", "unsettled_own_tool", unsettled=unsettled)
                ),
            )
        )
    sizes = _sizes(tool)
    if faults := shape_faults(sizes):
        raise InputError(
            [
                Problem(
                    file,
                    line,
                    Wording("SIM152", "of_cl_file", tool=called, size=size.replace("_", " "), fault=wording),
                )
                for size, wording in faults
            ]
        )
    return tool_shape(sizes, number, tool.name, tool.holder)


def _unsettled(tool: Tool, dialect: str) -> str:
    """Why nothing can be said of the form of a cutter; empty if it can."""
    if tool.kind == "UNKNOWN" or tool.diameter == 0.0:
        return "is known by number or name only: the CL file does not say its form"
    if tool.kind not in ("MILL", "DRILL"):
        return f"is a {tool.kind}, whose numbers in a CL file have a meaning that is not confirmed"
    if tool.upper_radius:
        return "is a mill with an upper corner, whose numbers in a CL file have a meaning that is not confirmed"
    if dialect == "ncl" and not tool.corner_radius and not tool.length:
        return f"has a diameter of {tool.diameter:g} mm, and Creo does not write the form of its end"
    return _unsettled_corner(tool)


def _unsettled_corner(tool: Tool) -> str:
    """Why nothing can be said of the corner of a cutter; empty if it can."""
    diameter, radius, e, f, bottom, side, _ = apt_cutter(tool)
    slack = _SAME * diameter
    where = f"has the centre of its corner {e:g} from the axis and {f:g} above the tip"
    if not radius:
        return ""
    if side and tool.corner_centre is None:
        return "is tapered and has a corner whose centre is not stated: where its diameter counts is not settled"
    if side and not bottom:
        widths = (2.0 * (e + radius), _meeting(e, radius, side))
        if abs(f - radius) > slack or min(abs(width - diameter) for width in widths) > slack or e < -slack:
            return f"{where}, where none can be"
    elif tool.corner_centre is not None and not (bottom and _touches_both(diameter, radius, (e, f), bottom, side)):
        return f"{where}: it is a form of its own"
    return ""


def _touches_both(diameter: float, radius: float, centre: Point, bottom: float, side: float) -> bool:
    """Whether a corner touches a conical bottom and a side that would meet at a diameter."""
    if bottom + side >= 90.0:
        return False
    corner = rounded_corner(0.5 * diameter, radius, bottom, side)[-1]
    return isinstance(corner, ProfileArc) and math.dist(corner.centre, centre) <= _SAME * diameter


def _meeting(e: float, radius: float, side: float) -> float:
    """Return the diameter where bottom and side would meet that touch a corner with a centre ``e`` from the axis."""
    b = math.radians(side)
    return 2.0 * (e + radius * (1.0 - math.sin(b)) / math.cos(b))


def _sizes(tool: Tool) -> ToolSizes:
    """Return the sizes of a cutter whose form is settled."""
    diameter, corner, side_angle, tip_angle = tool.diameter, tool.corner_radius, tool.taper_angle, 0.0
    half = 0.5 * diameter
    kind = ToolKind.FLAT
    if tool.kind == "DRILL" or tool.tip_angle:
        kind = ToolKind.DRILL
        tip_angle = tool.tip_angle if tool.kind == "DRILL" else 180.0 - 2.0 * tool.tip_angle
    elif side_angle and tool.corner_centre is not None:
        e, _ = tool.corner_centre
        kind, diameter = ToolKind.TAPER, _meeting(e, corner, side_angle)
        if e <= _SAME * tool.diameter:
            kind, diameter, corner = ToolKind.TAPER_BALL, 2.0 * corner, 0.0
    elif side_angle:
        kind = ToolKind.TAPER
    elif half * _BALL <= corner <= half * (1.0 + ROUNDING):
        kind, corner = ToolKind.BALL, 0.0
    elif corner:
        kind = ToolKind.BULL
    top = tool.extension or tool.length
    return ToolSizes(
        kind, diameter, corner, side_angle=side_angle, tip_angle=tip_angle,
        flute_length=tool.flute_length, length=top,
        gauge_length=tool.set_length if tool.set_length >= (top or tool.flute_length) else 0.0,
    )  # fmt: skip
