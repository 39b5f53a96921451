"""Tools as bodies: from their sizes to the profile of cutter, shank and holder.

Frame of the tool: origin at the tip, z up the tool axis, from the tip to the holder. Units: mm and degrees.
"""

from itertools import accumulate, pairwise
from typing import Final, TypedDict, Unpack

from trunnion.errors import InputError, Problem, argument_problem
from trunnion.model.toolpath import Tool
from trunnion.simulation.tool_outlines import cutter_outline, side_slope
from trunnion.simulation.tool_profile import (
    Element,
    Point,
    ProfileArc,
    ProfileLine,
    Role,
    Section,
    ToolShape,
    divide,
)
from trunnion.simulation.tool_sizes import ROUNDING, BodyPiece, SizeFault, ToolKind, ToolSizes, size_faults

#: A part of a tool lower than this, mm, is none: sizes are computed.
_NO_HEIGHT: Final = 1e-8

#: How long a tool is taken to be that states no length, mm, or so many times its diameter if that is more.
UNSTATED_LENGTH: Final = 100.0
_UNSTATED_DIAMETERS: Final = 2.0


class BodySizes(TypedDict, total=False):
    """Sizes of ``ToolSizes`` that every kind may state."""

    flute_length: float
    length: float
    shank_diameter: float
    neck_diameter: float
    neck_length: float
    gauge_length: float
    shank: tuple[BodyPiece, ...]
    holder: tuple[BodyPiece, ...]


def flat(diameter: float, **body: Unpack[BodySizes]) -> ToolShape:
    """Return an end mill with sharp corners."""
    return tool_shape(ToolSizes(ToolKind.FLAT, diameter, **body))


def ball(diameter: float, **body: Unpack[BodySizes]) -> ToolShape:
    """Return a ball mill."""
    return tool_shape(ToolSizes(ToolKind.BALL, diameter, **body))


def bull(diameter: float, corner_radius: float, **body: Unpack[BodySizes]) -> ToolShape:
    """Return a bull nose mill: an end mill with round corners."""
    return tool_shape(ToolSizes(ToolKind.BULL, diameter, corner_radius, **body))


def tool_shape(sizes: ToolSizes, number: int | None = None, name: str = "", description: str = "") -> ToolShape:
    """Return the body of a tool.

    Raises
    ------
    InputError
        If sizes are impossible, with all of them.
    """
    if faults := tool_faults(sizes):
        raise InputError([argument_problem(size, what, cure) for size, what, cure in faults])
    outline = cutter_outline(sizes)
    length, flute_length, remarks = _lengths(sizes, outline[-1].end[1])
    outline += _side(sizes, outline[-1].end, flute_length)
    cutting, rest = divide(outline, flute_length)
    sections = [Section(Role.CUTTER, cutting, "cutter")]
    shank = rest + _shank(sizes, outline[-1].end, length)
    if shank and shank[-1].end[1] - shank[0].start[1] > _NO_HEIGHT:
        sections.append(Section(Role.SHANK, shank, "shank"))
    sections += _holder(sizes, length)
    gauge_length = sizes.gauge_length or (sections[-1].top if sizes.holder else 0.0)
    return ToolShape(tuple(sections), name, number, gauge_length, flute_length, description, remarks)


def tool_faults(sizes: ToolSizes) -> tuple[SizeFault, ...]:
    """Return everything that is impossible about the sizes of a tool; ``tool_shape`` takes those without a fault."""
    if faults := size_faults(sizes):
        return faults
    tip = cutter_outline(sizes)[-1].end[1]
    if sizes.length and sizes.length < tip * (1.0 - ROUNDING):
        return (SizeFault("length", f"is {sizes.length:g}, but its tip alone is {tip:.6g} high", "write all of it"),)
    return ()


def _lengths(sizes: ToolSizes, top: float) -> tuple[float, float, tuple[str, ...]]:
    """Length and flute length of a tool whose outline ends at ``top``, and what was taken for granted."""
    flute_length = sizes.flute_length
    if side_slope(sizes) is None and (flute_length == 0.0 or flute_length > top - _NO_HEIGHT):
        flute_length = top
    if flute_length and sizes.length:
        return sizes.length, flute_length, ()
    if sizes.length:
        remark = f"the flute length is not stated: all {sizes.length:g} mm of the tool below its holder cut"
        return sizes.length, sizes.length, (remark,)
    length = flute_length or max(UNSTATED_LENGTH, _UNSTATED_DIAMETERS * sizes.diameter, top)
    remark = f"the length is not stated: the tool is {length:g} mm of flutes without shank and holder"
    return length, length, (remark,)


def _side(sizes: ToolSizes, corner: Point, top: float) -> tuple[Element, ...]:
    """The side of a cutter from its corner to a height."""
    slope = side_slope(sizes)
    if slope is None or top <= corner[1]:
        return ()
    return (ProfileLine(corner, (corner[0] + slope * (top - corner[1]), top)),)


def _shank(sizes: ToolSizes, start: Point, length: float) -> tuple[Element, ...]:
    """Neck and shank, from where the cutter ends up to the holder."""
    shank = 0.5 * sizes.shank_diameter or (0.5 * sizes.shank[-1].upper_diameter if sizes.shank else start[0])
    neck = 0.5 * sizes.neck_diameter or shank
    neck_end = max(sizes.neck_length or (length if sizes.neck_diameter and not sizes.shank else 0.0), start[1])
    corners = [start, (neck, start[1]), (neck, neck_end)]
    for piece in sizes.shank:
        low, high = 0.5 * piece.lower_diameter, 0.5 * piece.upper_diameter
        corners += [(low, corners[-1][1]), (high, corners[-1][1] + piece.height)]
    corners += [(shank, corners[-1][1]), (shank, max(length, corners[-1][1]))]
    lines = tuple(ProfileLine(below, above) for below, above in pairwise(corners) if below != above)
    within, _ = divide(lines, length)
    return within


def _holder(sizes: ToolSizes, length: float) -> list[Section]:
    """One section for each piece of the holder."""
    bottoms = accumulate((piece.height for piece in sizes.holder), initial=length)
    return [
        Section(
            Role.HOLDER,
            (ProfileLine((0.5 * piece.lower_diameter, z), (0.5 * piece.upper_diameter, z + piece.height)),),
            f"holder piece {number}",
        )
        for number, (piece, z) in enumerate(zip(sizes.holder, bottoms, strict=False), 1)
    ]


#: A corner radius that is so near to half the diameter, as a part of it, makes a ball.
_BALL: Final = 1.0 - ROUNDING

_SAY_IT: Final = "state the tool itself: its kind and its sizes"


def cl_tool_shape(tool: Tool, number: int | None, *, file: str, line: int, dialect: str = "clsf") -> ToolShape:
    """Return the body of a cutter that a CL file describes.

    number      by which programs call it, if they do
    file, line  where it is described, for messages
    dialect     that of the CL file, ``Toolpath.dialect``

    Raises
    ------
    InputError
        If the CL file does not say all of its form, or says it in a way whose meaning is not settled.
    """
    called = f"tool {number}" if number is not None else f"tool {tool.name}" if tool.name else "its tool"
    if unsettled := _unsettled(tool, dialect):
        raise InputError(Problem(file, line, f"{called} {unsettled}", _SAY_IT))
    sizes = _cl_sizes(tool)
    if faults := tool_faults(sizes):
        whats = ((f"{called}: its {size.replace('_', ' ')} {what}", cure) for size, what, cure in faults)
        raise InputError([Problem(file, line, what, f"{cure}, or {_SAY_IT}") for what, cure in whats])
    return tool_shape(sizes, number, tool.name, tool.holder)


def _unsettled(tool: Tool, dialect: str) -> str:
    """Why nothing can be said of the form of a cutter; empty if it can."""
    if tool.kind == "UNKNOWN" or tool.diameter == 0.0:
        return "is known by number or name only: the CL file does not say its form"
    if tool.kind not in ("MILL", "DRILL"):
        return f"is a {tool.kind}, whose numbers in a CL file have a meaning that is not confirmed"
    if tool.upper_radius:
        return "is a mill with an upper corner, whose numbers in a CL file have a meaning that is not confirmed"
    if tool.taper_angle and tool.tip_angle:
        return "is tapered and has a conical bottom, which is no kind that is known here"
    if tool.taper_angle and tool.corner_radius >= 0.5 * tool.diameter * _BALL:
        return "is a tapered ball mill, of which it is not settled where its diameter counts"
    if dialect == "ncl" and not tool.corner_radius and not tool.length:
        return f"has a diameter of {tool.diameter:g} mm, and Creo does not write the form of its end"
    return ""


def _cl_sizes(tool: Tool) -> ToolSizes:
    """The sizes of a cutter whose form is settled."""
    half, corner = 0.5 * tool.diameter, tool.corner_radius
    kind, side_angle, tip_angle = ToolKind.FLAT, tool.taper_angle, 0.0
    if tool.kind == "DRILL" or tool.tip_angle:
        kind = ToolKind.DRILL
        tip_angle = tool.tip_angle if tool.kind == "DRILL" else 180.0 - 2.0 * tool.tip_angle
    elif side_angle:
        kind = ToolKind.TAPER
    elif half * _BALL <= corner <= half * (1.0 + ROUNDING):
        kind, corner = ToolKind.BALL, 0.0
    elif corner:
        kind = ToolKind.BULL
    top = tool.extension or tool.length
    return ToolSizes(
        kind, tool.diameter, corner, side_angle=side_angle, tip_angle=tip_angle,
        flute_length=tool.flute_length, length=top,
        gauge_length=tool.set_length if tool.set_length >= (top or tool.flute_length) else 0.0,
    )  # fmt: skip


__all__ = [
    "BodyPiece",
    "BodySizes",
    "ProfileArc",
    "ProfileLine",
    "Role",
    "Section",
    "ToolKind",
    "ToolShape",
    "ToolSizes",
    "ball",
    "bull",
    "cl_tool_shape",
    "flat",
    "tool_faults",
    "tool_shape",
]
