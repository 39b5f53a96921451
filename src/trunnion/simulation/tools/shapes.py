"""Tools as bodies: from their sizes to the profile of cutter, shank and holder.

Frame of the tool: origin at the tip, z up the tool axis, from the tip to the holder. Units: mm and degrees.
"""

from itertools import accumulate, pairwise
from typing import Final, TypedDict, Unpack

from trunnion.errors import InputError, argument_problem
from trunnion.messages import Wording, phrase
from trunnion.simulation.tools.outlines import cutter_outline, side_slope, tip_height
from trunnion.simulation.tools.profile import (
    Element,
    Point,
    ProfileArc,
    ProfileLine,
    Role,
    Section,
    ToolShape,
    divide,
)
from trunnion.simulation.tools.sizes import ROUNDING, BodyPiece, SizeFault, ToolKind, ToolSizes, size_faults

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

    Raises ``InputError`` if sizes are impossible, with all of them.
    """
    if faults := shape_faults(sizes):
        raise InputError([argument_problem(size, wording) for size, wording in faults])
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
    is_drawn_only = not (sizes.length or sizes.gauge_length)
    return ToolShape(tuple(sections), name, number, gauge_length, flute_length, description, remarks, is_drawn_only)


def shape_faults(sizes: ToolSizes) -> tuple[SizeFault, ...]:
    """Return everything that is impossible about the sizes of a tool; ``tool_shape`` takes those without a fault."""
    if faults := size_faults(sizes):
        return faults
    tip = tip_height(sizes)
    if sizes.length and sizes.length < tip * (1.0 - ROUNDING):
        return (SizeFault("length", Wording("SIM152", "less_than_tip", value=sizes.length, tip=tip)),)
    return ()


def fault_of_size(fault: SizeFault) -> Wording:
    """Return the phrase of a fault, with its cure, as one of several of a tool."""
    return phrase("fault_of_size", size=fault.size.replace("_", " "), fault=fault.wording)


def _lengths(sizes: ToolSizes, top: float) -> tuple[float, float, tuple[Wording, ...]]:
    """Length and flute length of a tool whose outline ends at ``top``, and what was taken for granted."""
    flute_length = sizes.flute_length
    if side_slope(sizes) is None and (flute_length == 0.0 or flute_length > top - _NO_HEIGHT):
        flute_length = top
    if flute_length and sizes.length:
        return sizes.length, flute_length, ()
    if sizes.length:
        remark = Wording("SIM155", "all_of_it_cuts", length=sizes.length)
        return sizes.length, sizes.length, (remark,)
    length = flute_length or max(UNSTATED_LENGTH, _UNSTATED_DIAMETERS * sizes.diameter, top)
    remark = Wording("SIM155", "flutes_alone", length=length)
    return length, length, (remark,)


def _side(sizes: ToolSizes, corner: Point, top: float) -> tuple[Element, ...]:
    """Return the side of a cutter from its corner to a height."""
    slope = side_slope(sizes)
    if slope is None or top <= corner[1]:
        return ()
    return (ProfileLine(corner, (corner[0] + slope * (top - corner[1]), top)),)


def _shank(sizes: ToolSizes, start: Point, length: float) -> tuple[Element, ...]:
    """Neck and shank, from where the cutter ends up to the holder."""
    shank = 0.5 * sizes.shank_diameter or (0.5 * sizes.shank[-1].upper_diameter if sizes.shank else start[0])
    neck = 0.5 * sizes.neck_diameter or shank
    neck_end = max(sizes.neck_length or (length if sizes.neck_diameter and not sizes.shank else 0.0), start[1])
    corners = [start, (neck, start[1]), (neck, neck_end)] if neck_end > start[1] else [start]
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
    "flat",
    "shape_faults",
    "tool_shape",
]
