"""The sizes of a tool as people state them, and what is impossible about them.

In:     a ``ToolSizes`` from a library, a command line or a CL file.
Out:    ``size_faults``: everything that is wrong with it. Sizes without a fault make a tool (``tool_shapes``).
"""

import math
from collections.abc import Iterator, Mapping
from dataclasses import fields
from enum import StrEnum
from typing import Final, NamedTuple

from trunnion.messages import Wording
from trunnion.records import dataclass

#: Greatest size of a tool, mm: a larger one is in another unit, or a slip.
GREATEST: Final = 10_000.0

#: How far a corner radius may exceed what fits, as a part of it: sizes are rounded, also in inches.
ROUNDING: Final = 2e-4

#: Most teeth of a thread mill, one above the other.
MOST_TEETH: Final = 100

#: Most pieces of a shank or a holder.
MOST_PIECES: Final = 100

#: Included angle of metric and unified threads, degrees.
THREAD_ANGLE: Final = 60.0


class ToolKind(StrEnum):
    """The form of a cutter."""

    FLAT = "flat"
    BALL = "ball"
    BULL = "bull"
    TAPER = "taper"
    TAPER_BALL = "taper_ball"
    DRILL = "drill"
    CHAMFER = "chamfer"
    LOLLIPOP = "lollipop"
    T_SLOT = "t_slot"
    THREAD_MILL = "thread_mill"
    BARREL = "barrel"


#: What others call them, as ``meant_word`` takes it.
OTHER_KINDS: Final = {
    "mill": ToolKind.FLAT, "endmill": ToolKind.FLAT, "flatmill": ToolKind.FLAT, "flatendmill": ToolKind.FLAT,
    "squareendmill": ToolKind.FLAT, "cylinder": ToolKind.FLAT, "cylindrical": ToolKind.FLAT, "facemill": ToolKind.FLAT,
    "ballmill": ToolKind.BALL, "ballnose": ToolKind.BALL, "ballnosemill": ToolKind.BALL, "ballend": ToolKind.BALL,
    "ballendmill": ToolKind.BALL, "ballnoseendmill": ToolKind.BALL, "spherical": ToolKind.BALL,
    "bullmill": ToolKind.BULL, "bullnose": ToolKind.BULL, "bullnosemill": ToolKind.BULL, "bullendmill": ToolKind.BULL,
    "bullnoseendmill": ToolKind.BULL, "torus": ToolKind.BULL, "toroid": ToolKind.BULL, "toroidal": ToolKind.BULL,
    "cone": ToolKind.TAPER, "conical": ToolKind.TAPER, "tapered": ToolKind.TAPER, "tapermill": ToolKind.TAPER,
    "taperedball": ToolKind.TAPER_BALL, "conicalball": ToolKind.TAPER_BALL, "taperballmill": ToolKind.TAPER_BALL,
    "twistdrill": ToolKind.DRILL, "spotdrill": ToolKind.DRILL, "centerdrill": ToolKind.DRILL,
    "chamfermill": ToolKind.CHAMFER, "countersink": ToolKind.CHAMFER, "engraver": ToolKind.CHAMFER,
    "undercut": ToolKind.LOLLIPOP, "undercutmill": ToolKind.LOLLIPOP, "slotmill": ToolKind.T_SLOT,
    "woodruff": ToolKind.T_SLOT, "keyseat": ToolKind.T_SLOT, "threadcutter": ToolKind.THREAD_MILL,
    "circlesegment": ToolKind.BARREL, "oval": ToolKind.BARREL,
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class BodyPiece:
    """A piece of a shank or a holder: a cylinder, or a cone where the diameters differ, mm."""

    lower_diameter: float
    upper_diameter: float
    height: float


@dataclass(frozen=True, slots=True)
class ToolSizes:
    """A tool as its sizes, mm and degrees; 0 is a size that nothing states.

    diameter        of a taper where its side and its bottom would meet, of a taper ball that of the ball, of a barrel
                    the greatest, of a thread mill at the crests of its teeth
    corner_radius   between bottom and side
    upper_radius    between side and top of a T-slot cutter
    side_angle      of the side from the tool axis
    tip_angle       whole angle of a drill's tip
    tip_diameter    where a chamfer mill ends flat; not stated: it ends in a point
    profile_radius  of the side of a barrel
    widest_height   from the tip to where a barrel is or would be widest
    pitch           from tooth to tooth of a thread mill
    crest           height of the flat on a tooth of a thread mill; not stated: the tooth is sharp
    thread_angle    whole angle of a tooth of a thread mill; not stated: 60
    flute_length    from the tip to where it stops cutting; not stated: all of the tool below its holder cuts
    length          from the tip to the lower end of the holder; not stated: ``flute_length``
    shank_diameter  above cutter and neck; not stated: that of the cutter where it ends
    neck_diameter   between cutter and shank; not stated: that of the shank
    neck_length     from the tip to where the shank begins; not stated: the neck goes up to the holder
    gauge_length    from the tip to the gauge point; not stated: where the holder ends
    shank           pieces of the shank from below to above, before the rest of it, which is as ``shank_diameter`` says
    holder          its pieces from below to above; the last one ends at the gauge point
    """

    kind: ToolKind
    diameter: float
    corner_radius: float = 0.0
    upper_radius: float = 0.0
    side_angle: float = 0.0
    tip_angle: float = 0.0
    tip_diameter: float = 0.0
    profile_radius: float = 0.0
    widest_height: float = 0.0
    pitch: float = 0.0
    crest: float = 0.0
    thread_angle: float = 0.0
    flute_length: float = 0.0
    length: float = 0.0
    shank_diameter: float = 0.0
    neck_diameter: float = 0.0
    neck_length: float = 0.0
    gauge_length: float = 0.0
    shank: tuple[BodyPiece, ...] = ()
    holder: tuple[BodyPiece, ...] = ()


class SizeFault(NamedTuple):
    """What is impossible about a size: the field of ``ToolSizes`` that has it, and the fault."""

    size: str
    wording: Wording


def _fault(size: str, variant: str, **parameters: object) -> SizeFault:
    return SizeFault(size, Wording("SIM152", variant, **parameters))


class SizesOfKind(NamedTuple):
    """The sizes that a kind of tool must state, and those that it may state besides."""

    needed: tuple[str, ...]
    others: tuple[str, ...] = ()


#: Sizes of the body above the cutter, which every kind may state.
OF_BODY: Final = ("flute_length", "length", "shank_diameter", "neck_diameter", "neck_length", "gauge_length")

OF_KIND: Final[Mapping[ToolKind, SizesOfKind]] = {
    ToolKind.FLAT: SizesOfKind(("diameter",)),
    ToolKind.BALL: SizesOfKind(("diameter",)),
    ToolKind.BULL: SizesOfKind(("diameter", "corner_radius")),
    ToolKind.TAPER: SizesOfKind(("diameter", "side_angle"), ("corner_radius",)),
    ToolKind.TAPER_BALL: SizesOfKind(("diameter", "side_angle")),
    ToolKind.DRILL: SizesOfKind(("diameter", "tip_angle"), ("corner_radius", "side_angle")),
    ToolKind.CHAMFER: SizesOfKind(("diameter", "side_angle"), ("tip_diameter",)),
    ToolKind.LOLLIPOP: SizesOfKind(("diameter", "neck_diameter")),
    ToolKind.T_SLOT: SizesOfKind(("diameter", "flute_length", "neck_diameter"), ("corner_radius", "upper_radius")),
    ToolKind.THREAD_MILL: SizesOfKind(("diameter", "pitch", "flute_length"), ("crest", "thread_angle")),
    ToolKind.BARREL: SizesOfKind(("diameter", "profile_radius", "widest_height", "flute_length"), ("corner_radius",)),
}

#: Angles, and what they must stay below, degrees.
ANGLE_LIMITS: Final = {"side_angle": 90.0, "tip_angle": 180.0, "thread_angle": 180.0}


def corner_room(half: float, bottom: float, side: float) -> float:
    """Return the greatest radius of a corner between a bottom from the tool axis and a side, mm.

    half    radius where bottom and side would meet, mm
    bottom  angle of the bottom from the horizontal, radians
    side    angle of the side from the tool axis, radians
    """
    return half * (1.0 + math.sin(bottom + side)) / (math.cos(bottom + side) * math.cos(bottom))


def ball_height(sizes: ToolSizes) -> float:
    """Return the height of the ball of a lollipop up to its neck, mm."""
    radius, neck = 0.5 * sizes.diameter, 0.5 * sizes.neck_diameter
    return radius + math.sqrt(radius**2 - neck**2)


def groove_depth(sizes: ToolSizes) -> float:
    """How deep the grooves between the teeth of a thread mill are where the flanks meet, mm."""
    return 0.5 * (sizes.pitch - sizes.crest) / math.tan(math.radians(0.5 * (sizes.thread_angle or THREAD_ANGLE)))


def tooth_count(sizes: ToolSizes) -> int:
    """Return the whole teeth of a thread mill, one above the other."""
    return math.floor(sizes.flute_length / sizes.pitch + 1e-6)


def size_faults(sizes: ToolSizes) -> tuple[SizeFault, ...]:
    """Return everything that is impossible about the sizes of a tool."""
    faults = tuple(_out_of_range(sizes))
    return faults or (*_cutter_contradictions(sizes), *_body_contradictions(sizes))


def _out_of_range(sizes: ToolSizes) -> Iterator[SizeFault]:
    """Sizes that are missing, not those of the kind, or no sizes at all."""
    needed, others = OF_KIND[sizes.kind]
    for field in fields(sizes):
        value = getattr(sizes, field.name)
        if not isinstance(value, float | int):
            continue
        below = ANGLE_LIMITS.get(field.name)
        if field.name in needed and value == 0.0:
            yield _fault(field.name, "size_needed", kind=sizes.kind)
        elif value != 0.0 and field.name not in (*needed, *others, *OF_BODY):
            yield _fault(field.name, "size_of_other_kind", kind=sizes.kind)
        elif below and not 0.0 <= value < below:
            yield _fault(field.name, "angle_out_of_range", value=value, below=below)
        elif not 0.0 <= value <= GREATEST:
            yield _fault(field.name, "size_out_of_range", value=value, most=GREATEST)
    for name, pieces in (("shank", sizes.shank), ("holder", sizes.holder)):
        if len(pieces) > MOST_PIECES:
            yield _fault(name, "too_many_pieces", count=len(pieces), most=MOST_PIECES)
            return
        for number, piece in enumerate(pieces, 1):
            for value in (piece.lower_diameter, piece.upper_diameter, piece.height):
                if not 0.0 < value <= GREATEST:
                    yield _fault(name, "piece_out_of_range", value=value, piece=number, most=GREATEST)


def _cutter_contradictions(sizes: ToolSizes) -> Iterator[SizeFault]:
    """Sizes of a cutter that cannot be together."""
    half = 0.5 * sizes.diameter
    if sizes.kind is ToolKind.DRILL and sizes.side_angle >= 0.5 * sizes.tip_angle:
        yield _fault("side_angle", "side_never_meets_tip", value=sizes.side_angle, half=0.5 * sizes.tip_angle)
    elif sizes.kind in (ToolKind.BULL, ToolKind.TAPER, ToolKind.DRILL):
        bottom = 90.0 - 0.5 * sizes.tip_angle if sizes.tip_angle else 0.0
        room = corner_room(half, math.radians(bottom), math.radians(sizes.side_angle))
        yield from _at_most(sizes, "corner_radius", room, "does_not_fit_between_bottom_and_side")
    elif sizes.kind is ToolKind.CHAMFER and sizes.tip_diameter >= sizes.diameter:
        yield _fault("tip_diameter", "not_less", value=sizes.tip_diameter, limit=sizes.diameter)
    elif sizes.kind is ToolKind.LOLLIPOP:
        yield from _lollipop_contradictions(sizes)
    elif sizes.kind is ToolKind.T_SLOT:
        yield from _t_slot_contradictions(sizes)
    elif sizes.kind is ToolKind.THREAD_MILL:
        yield from _thread_contradictions(sizes)
    elif sizes.kind is ToolKind.BARREL:
        yield from _barrel_contradictions(sizes)


def _at_most(sizes: ToolSizes, name: str, most: float, variant: str) -> Iterator[SizeFault]:
    value = getattr(sizes, name)
    if value > most * (1.0 + ROUNDING):
        yield _fault(name, variant, value=value, most=most)


def _lollipop_contradictions(sizes: ToolSizes) -> Iterator[SizeFault]:
    if sizes.neck_diameter >= sizes.diameter:
        yield _fault("neck_diameter", "not_less", value=sizes.neck_diameter, limit=sizes.diameter)
    else:
        yield from _at_most(sizes, "flute_length", ball_height(sizes), "more_than_ball_up_to_neck")


def _t_slot_contradictions(sizes: ToolSizes) -> Iterator[SizeFault]:
    half = 0.5 * sizes.diameter
    if sizes.neck_diameter >= sizes.diameter:
        yield _fault("neck_diameter", "not_less", value=sizes.neck_diameter, limit=sizes.diameter)
    yield from _at_most(sizes, "corner_radius", half, "more_than_half_the_diameter")
    yield from _at_most(sizes, "upper_radius", half, "more_than_half_the_diameter")
    if sizes.corner_radius + sizes.upper_radius > sizes.flute_length * (1.0 + ROUNDING):
        yield _fault("flute_length", "less_than_both_corners", value=sizes.flute_length)


def _thread_contradictions(sizes: ToolSizes) -> Iterator[SizeFault]:
    if sizes.crest >= sizes.pitch:
        yield _fault("crest", "not_less_than_pitch", value=sizes.crest, pitch=sizes.pitch)
    elif groove_depth(sizes) >= 0.5 * sizes.diameter:
        yield _fault("pitch", "grooves_too_deep", value=sizes.pitch, depth=groove_depth(sizes))
    if sizes.neck_diameter >= sizes.diameter:
        yield _fault("neck_diameter", "not_less", value=sizes.neck_diameter, limit=sizes.diameter)
    if not 1 <= tooth_count(sizes) <= MOST_TEETH:
        yield _fault(
            "flute_length", "number_of_teeth", value=sizes.flute_length, count=tooth_count(sizes), most=MOST_TEETH
        )


def _barrel_contradictions(sizes: ToolSizes) -> Iterator[SizeFault]:
    profile, widest, corner = sizes.profile_radius, sizes.widest_height, sizes.corner_radius
    off_axis = 0.5 * sizes.diameter - profile
    farthest = max(0.0 if corner else widest, abs(sizes.flute_length - widest))
    if farthest >= profile or off_axis + math.sqrt(profile**2 - farthest**2) <= 0.0:
        yield _fault("profile_radius", "side_reaches_tool_axis", value=profile)
    elif corner and not _corner_fits(sizes, off_axis):
        yield _fault("corner_radius", "does_not_fit_below_side", value=corner)


def _corner_fits(sizes: ToolSizes, off_axis: float) -> bool:
    """Whether a corner of a barrel touches its side below the end of the flutes, and its bottom off the tool axis."""
    profile, widest, corner = sizes.profile_radius, sizes.widest_height, sizes.corner_radius
    if corner > widest or widest >= profile:
        return False
    reach = off_axis + math.sqrt((profile - corner) ** 2 - (widest - corner) ** 2)
    return reach >= 0.0 and corner * (profile - widest) / (profile - corner) < sizes.flute_length


def _body_contradictions(sizes: ToolSizes) -> Iterator[SizeFault]:
    below_holder = sizes.length or sizes.flute_length
    if sizes.length and sizes.flute_length > sizes.length:
        yield _fault("flute_length", "more_than_length", value=sizes.flute_length, length=sizes.length)
    above = [name for name in ("shank_diameter", "neck_length", "shank", "holder") if getattr(sizes, name)]
    if above and not sizes.length:
        yield _fault("length", "no_place_without_length", above=above[0].replace("_", " "))
    elif above and above != ["holder"] and not sizes.flute_length and sizes.kind is not ToolKind.LOLLIPOP:
        yield _fault("flute_length", "flutes_end_nowhere", above=above[0].replace("_", " "))
    if sizes.neck_length and not sizes.neck_diameter:
        yield _fault("neck_diameter", "neck_without_diameter")
    if sizes.neck_diameter and (sizes.shank_diameter or sizes.shank) and not sizes.neck_length:
        yield _fault("neck_length", "neck_without_length")
    if sizes.neck_length and not sizes.flute_length <= sizes.neck_length <= (sizes.length or math.inf):
        yield _fault("neck_length", "neck_not_between", value=sizes.neck_length)
    top = below_holder + sum(piece.height for piece in sizes.holder)
    if sizes.gauge_length and sizes.gauge_length < top * (1.0 - ROUNDING):
        yield _fault("gauge_length", "less_than_tool_with_holder", value=sizes.gauge_length, top=top)
