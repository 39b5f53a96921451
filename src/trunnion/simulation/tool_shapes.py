"""Tools as bodies: from their sizes to the profile of cutter, shank and holder.

Frame of the tool: origin at the tip, z up the tool axis, from the tip to the holder. Units: mm and degrees.
"""

from itertools import accumulate, pairwise
from typing import Final, TypedDict, Unpack

from trunnion.errors import InputError, argument_problem
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
from trunnion.simulation.tool_sizes import HolderPiece, ToolKind, ToolSizes, size_faults

#: How long a tool is taken to be that states no length, mm, or so many times its diameter if that is more.
UNSTATED_LENGTH: Final = 100.0
_UNSTATED_DIAMETERS: Final = 2.0


class BodySizes(TypedDict, total=False):
    """Sizes of ``ToolSizes`` that every kind has."""

    flute_length: float
    length: float
    shank_diameter: float
    neck_diameter: float
    neck_length: float
    gauge_length: float
    holder: tuple[HolderPiece, ...]


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
    if faults := size_faults(sizes):
        raise InputError([argument_problem(size, what, cure) for size, what, cure in faults])
    outline = cutter_outline(sizes)
    length, flute_length, remarks = _lengths(sizes, outline[-1].end)
    outline += _side(sizes, outline[-1].end, max(flute_length, outline[-1].end[1]))
    cutting, rest = divide(outline, flute_length)
    sections = [Section(Role.CUTTER, cutting, "cutter")]
    if length > flute_length:
        sections.append(Section(Role.SHANK, rest + _shank(sizes, outline[-1].end, length), "shank"))
    sections += _holder(sizes, length)
    gauge_length = sizes.gauge_length or (sections[-1].top if sizes.holder else 0.0)
    return ToolShape(tuple(sections), name, number, gauge_length, flute_length, description, remarks)


def _lengths(sizes: ToolSizes, corner: Point) -> tuple[float, float, tuple[str, ...]]:
    """Length and flute length of a tool, and what was taken for granted."""
    if sizes.flute_length and sizes.length:
        return sizes.length, sizes.flute_length, ()
    if sizes.length:
        remark = f"the flute length is not stated: all {sizes.length:g} mm of the tool below its holder cut"
        return sizes.length, sizes.length, (remark,)
    if sizes.flute_length:
        remark = f"the length is not stated: the tool is {sizes.flute_length:g} mm of flutes without shank and holder"
        return sizes.flute_length, sizes.flute_length, (remark,)
    length = max(UNSTATED_LENGTH, _UNSTATED_DIAMETERS * sizes.diameter, corner[1])
    remark = f"no length is stated: the tool is {length:g} mm of flutes without shank and holder"
    return length, length, (remark,)


def _side(sizes: ToolSizes, corner: Point, top: float) -> tuple[Element, ...]:
    """The side of a cutter from its corner to a height."""
    end = (corner[0] + side_slope(sizes) * (top - corner[1]), top)
    return (ProfileLine(corner, end),) if top > corner[1] else ()


def _shank(sizes: ToolSizes, start: Point, length: float) -> tuple[Element, ...]:
    """Neck and shank, from where the cutter ends up to the holder."""
    shank = 0.5 * sizes.shank_diameter or start[0]
    neck = 0.5 * sizes.neck_diameter or shank
    neck_end = max(sizes.neck_length or (length if sizes.neck_diameter else 0.0), start[1])
    corners = [start, (neck, start[1]), (neck, neck_end), (shank, neck_end), (shank, length)]
    if neck_end >= length:
        corners = corners[:3]
    ends = pairwise(corners)
    return tuple(ProfileLine(below, above) for below, above in ends if below != above)


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


__all__ = [
    "BodySizes",
    "HolderPiece",
    "ProfileArc",
    "ProfileLine",
    "Role",
    "Section",
    "ToolKind",
    "ToolShape",
    "ToolSizes",
    "ball",
    "bull",
    "flat",
    "tool_shape",
]
