"""The sizes of a tool as people state them, and what is impossible about them.

In:     a ``ToolSizes`` from a library, a command line or a CL file.
Out:    ``size_faults``: everything that is wrong with it. Sizes without a fault make a tool (``tool_shapes``).
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass, fields
from enum import StrEnum
from typing import Final, NamedTuple

#: Greatest size of a tool, mm: a larger one is in another unit, or a slip.
GREATEST: Final = 10_000.0

#: How far a corner radius may exceed half the diameter, as a part of the diameter: sizes are rounded, also in inches.
ROUNDING: Final = 1e-4


class ToolKind(StrEnum):
    """The form of a cutter."""

    FLAT = "flat"
    BALL = "ball"
    BULL = "bull"


@dataclass(frozen=True, slots=True)
class HolderPiece:
    """A piece of a holder: a cylinder, or a cone where the diameters differ, mm."""

    lower_diameter: float
    upper_diameter: float
    height: float


@dataclass(frozen=True, slots=True)
class ToolSizes:
    """A tool as its sizes, mm and degrees; 0 is a size that nothing states.

    corner_radius   of a bull nose mill
    flute_length    from the tip to where it stops cutting; not stated: all of the tool below its holder cuts
    length          from the tip to the lower end of the holder; not stated: ``flute_length``
    shank_diameter  above cutter and neck; not stated: that of the cutter where it ends
    neck_diameter   between cutter and shank; not stated: that of the shank
    neck_length     from the tip to where the shank begins; not stated: the neck goes up to the holder
    gauge_length    from the tip to the gauge point; not stated: where the holder ends
    holder          its pieces from below to above
    """

    kind: ToolKind
    diameter: float
    corner_radius: float = 0.0
    flute_length: float = 0.0
    length: float = 0.0
    shank_diameter: float = 0.0
    neck_diameter: float = 0.0
    neck_length: float = 0.0
    gauge_length: float = 0.0
    holder: tuple[HolderPiece, ...] = ()


class SizeFault(NamedTuple):
    """What is impossible about a size: the field of ``ToolSizes`` that has it, the fault and its cure."""

    size: str
    what: str
    cure: str


#: The sizes that a kind must state, and those that it may state besides; all may state those of ``_OF_BODY``.
_OF_KIND: Final[dict[ToolKind, tuple[tuple[str, ...], tuple[str, ...]]]] = {
    ToolKind.FLAT: (("diameter",), ()),
    ToolKind.BALL: (("diameter",), ()),
    ToolKind.BULL: (("diameter", "corner_radius"), ()),
}

_OF_BODY: Final = ("flute_length", "length", "shank_diameter", "neck_diameter", "neck_length", "gauge_length")


def size_faults(sizes: ToolSizes) -> tuple[SizeFault, ...]:
    """Return everything that is impossible about the sizes of a tool."""
    faults = tuple(_out_of_range(sizes))
    return faults or tuple(_contradictions(sizes))


def _out_of_range(sizes: ToolSizes) -> Iterator[SizeFault]:
    """Sizes that are missing, not those of the kind, or no sizes at all."""
    needed, others = _OF_KIND[sizes.kind]
    for field in fields(sizes):
        value = getattr(sizes, field.name)
        if not isinstance(value, float | int):
            continue
        if field.name in needed and value == 0.0:
            yield SizeFault(field.name, "is not stated", f"a tool of the kind {sizes.kind} needs it")
        elif value != 0.0 and field.name not in (*needed, *others, *_OF_BODY):
            yield SizeFault(field.name, f"is no size of a tool of the kind {sizes.kind}", "leave it out")
        elif not 0.0 <= value <= GREATEST:
            yield SizeFault(field.name, f"is {value:g}", f"write a number above 0, at most {GREATEST:g}")
    for number, piece in enumerate(sizes.holder, 1):
        for value in (piece.lower_diameter, piece.upper_diameter, piece.height):
            if not 0.0 < value <= GREATEST:
                what = f"has {value:g} in piece {number}"
                yield SizeFault("holder", what, f"write diameters and heights above 0, at most {GREATEST:g}")


def _contradictions(sizes: ToolSizes) -> Iterator[SizeFault]:
    """Sizes that cannot be together."""
    if sizes.corner_radius > 0.5 * sizes.diameter + ROUNDING * sizes.diameter:
        what = f"is {sizes.corner_radius:g}, more than half the diameter"
        yield SizeFault("corner_radius", what, f"write at most {0.5 * sizes.diameter:g}")
    yield from _body_contradictions(sizes)


def _body_contradictions(sizes: ToolSizes) -> Iterator[SizeFault]:
    below_holder = sizes.length or sizes.flute_length
    if sizes.length and sizes.flute_length > sizes.length:
        what = f"is {sizes.flute_length:g}, more than the length {sizes.length:g}"
        yield SizeFault("flute_length", what, "the length counts from the tip to the holder")
    above = [name for name in ("shank_diameter", "neck_diameter", "holder") if getattr(sizes, name)]
    if above and not sizes.length:
        yield SizeFault("length", "is not stated", f"write it: {above[0].replace('_', ' ')} has no place without it")
    if sizes.neck_length and not sizes.neck_diameter:
        yield SizeFault("neck_diameter", "is not stated, but the neck's length is", "write both or none")
    if sizes.neck_length and not sizes.flute_length <= sizes.neck_length <= (sizes.length or math.inf):
        what = f"is {sizes.neck_length:g}, not between flute length and length"
        yield SizeFault("neck_length", what, "it counts from the tip to where the shank begins")
    top = below_holder + sum(piece.height for piece in sizes.holder)
    if sizes.gauge_length and sizes.gauge_length < top:
        what = f"is {sizes.gauge_length:g}, but the tool with its holder is {top:g} long"
        yield SizeFault("gauge_length", what, "it counts from the tip to the gauge point, above the holder")
