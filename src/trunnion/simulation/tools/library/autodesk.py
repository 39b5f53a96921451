"""Tool libraries as Autodesk's CAM exports them: JSON with a list of tools under ``data``, also packed as ``.tools``.

Each tool has its kind (``type``), its unit and its sizes (``geometry``): DC diameter, RE corner radius, TA angle of the
side from the tool axis, SIG whole angle of the tip, LCF flute length, LB length out of the holder, OAL overall length,
SFDM shank diameter.
"""

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import Any, Final, TypeAlias

from trunnion.errors import InputError, Problem
from trunnion.messages import Wording, phrase
from trunnion.simulation.tools.library.json_text import JsonObject, finite, short_text
from trunnion.simulation.tools.library.library import LibraryTool, ToolLibrary, UnusableTool
from trunnion.simulation.tools.shapes import fault_of_size, shape_faults
from trunnion.simulation.tools.sizes import (
    ANGLE_LIMITS,
    MOST_PIECES,
    MOST_TEETH,
    BodyPiece,
    ToolKind,
    ToolSizes,
    ball_height,
    groove_depth,
)

_Form: TypeAlias = Callable[[JsonObject, JsonObject], ToolSizes]

_UNITS: Final[Mapping[str, float]] = {"millimeters": 1.0, "inches": 25.4}

#: Most tools of a library.
_MOST_TOOLS: Final = 20_000

#: How far two sizes that say the same may differ, as a part of the diameter.
_SAME: Final = 1e-3


def read_autodesk(file: str, root: Mapping[str, Any]) -> ToolLibrary:
    """Return the tools of a library; ``root`` is what its JSON holds.

    Raises ``InputError`` if there is no list of tools in it, or an entry of it is none.
    """
    library = JsonObject(root)
    entries = library.children("data", _MOST_TOOLS)
    if library.faults:
        raise InputError([Problem(file, 0, Wording("SIM170", "faulty", fault=fault)) for fault in library.faults])
    tools: list[LibraryTool] = []
    unusable: list[UnusableTool] = []
    for tool in entries:
        if tool.values.get("type") == "holder":
            continue
        # Mistakes of one tool are no mistakes of the others.
        found = _read_tool(file, tool.path, JsonObject(tool.values))
        if isinstance(found, LibraryTool):
            tools.append(found)
        else:
            unusable.append(found)
    return ToolLibrary(file, tuple(tools), tuple(unusable))


def _read_tool(file: str, place: str, tool: JsonObject) -> LibraryTool | UnusableTool:
    number = finite(tool.child("post-process").values.get("number"))
    called = int(number) if number is not None and number >= 0 and number == int(number) else None
    name = short_text(tool.values.get("description")) or short_text(tool.values.get("product-id"))
    found = _sizes(tool)
    if not tool.faults and found:
        tool.faults.extend(map(fault_of_size, shape_faults(found)))
    if tool.faults or not found:
        shown = " ".join(filter(None, ("" if called is None else str(called), name)))
        problems = (
            Problem(file, 0, Wording("SIM152", "of_library", tool=shown, place=place, fault=fault))
            for fault in tool.faults
        )
        return UnusableTool(called, name, tuple(problems))
    kind = short_text(tool.values.get("type"))
    return LibraryTool(found, called, name, kind, tuple(_remarks(kind, tool)))


def _remarks(kind: str, tool: JsonObject) -> Iterator[Wording]:
    """Yield what was taken for granted of a tool."""
    if kind in _AS_CYLINDERS:
        yield Wording("SIM155", "as_cylinder", kind=kind)
    if not tool.child("geometry").length("LB"):
        yield Wording("SIM155", "all_of_it_stands_free")
    if tool.values.get("holder") and not tool.child("holder").children("segments", MOST_PIECES):
        yield Wording("SIM155", "holder_without_form")


def _sizes(tool: JsonObject) -> ToolSizes | None:
    """Return the sizes of a tool; None if its kind or its unit is not known, which is a fault of it."""
    kind, unit = short_text(tool.values.get("type")), short_text(tool.values.get("unit"))
    if kind not in _FORMS:
        tool.faults.append(phrase("type_not_read", type=kind) if kind else phrase("no_type"))
        return None
    if unit not in _UNITS:
        tool.faults.append(phrase("unit_not_read", unit=unit) if unit else phrase("no_unit"))
        return None
    geometry = tool.child("geometry", _UNITS[unit])
    found = _with_body(_FORMS[kind](tool, geometry), tool, geometry)
    if found.kind is ToolKind.LOLLIPOP and 0.0 < found.neck_diameter < found.diameter:
        found = replace(found, flute_length=min(found.flute_length, ball_height(found)))
    return found


def _with_body(form: ToolSizes, tool: JsonObject, geometry: JsonObject) -> ToolSizes:
    """Return a cutter with what stands above it."""
    length = geometry.length("LB")
    pieces, gauge = _holder(tool, geometry)
    if not length:
        length = geometry.length("OAL")
        if pieces:
            geometry.faults.append(phrase("holder_begins_nowhere"))
    flute_length = form.flute_length or min(geometry.length("LCF"), length or math.inf)
    shank = _pieces(tool.child("shaft", geometry.scale))
    found = replace(
        form, flute_length=flute_length, length=length, shank=shank, holder=pieces,
        shank_diameter=0.0 if shank else geometry.length("SFDM"),
        gauge_length=length + gauge if pieces and gauge else 0.0,
    )  # fmt: skip
    return _with_shoulder(found, geometry)


def _with_shoulder(found: ToolSizes, geometry: JsonObject) -> ToolSizes:
    """Return a tool with its shoulder, which goes from the cutter to the shank."""
    diameter = geometry.length("shoulder-diameter") or _usual_shoulder(found)
    top = min(geometry.length("shoulder-length"), found.length)
    if found.kind is ToolKind.THREAD_MILL:
        # Below LCF it is as thick as the grooves.
        root, flutes = found.diameter - 2.0 * groove_depth(found) if found.pitch else 0.0, geometry.length("LCF")
        return _with_pieces(found, [(root, flutes - found.flute_length), (diameter, top - flutes)])
    if found.kind is ToolKind.CHAMFER and 0.0 < diameter < found.diameter and found.side_angle:
        return _with_return_flank(found, diameter, top)
    if found.kind in (ToolKind.LOLLIPOP, ToolKind.T_SLOT):
        return replace(found, neck_diameter=diameter, neck_length=max(top, found.flute_length))
    if top < found.flute_length or not diameter:
        return found
    return replace(found, neck_diameter=diameter, neck_length=top)


def _usual_shoulder(found: ToolSizes) -> float:
    """Return the shoulder of a tool that states none: as thick as the cutter, or as the shank behind a head."""
    if found.kind is ToolKind.TAPER:
        return 0.0
    if found.kind in (ToolKind.LOLLIPOP, ToolKind.T_SLOT):
        return found.shank_diameter if found.shank_diameter < found.diameter else 0.0
    return found.diameter


def _with_return_flank(found: ToolSizes, neck: float, top: float) -> ToolSizes:
    """Return a chamfer mill on a neck: above its cone it narrows as it widened, whatever LCF says."""
    slope = math.tan(math.radians(found.side_angle))
    peak = 0.5 * max(found.diameter - found.tip_diameter, 0.0) / slope
    back = 0.5 * (found.diameter - neck) / slope
    flank = BodyPiece(found.diameter, neck, back)
    pieces = (flank, BodyPiece(neck, neck, top - peak - back)) if top > peak + back else (flank,)
    return replace(found, flute_length=peak, shank=pieces + found.shank)


def _with_pieces(found: ToolSizes, cylinders: list[tuple[float, float]]) -> ToolSizes:
    """Return a tool with cylinders below its shank: diameters and heights; those of no height are none."""
    pieces = tuple(BodyPiece(diameter, diameter, height) for diameter, height in cylinders if height > 0.0)
    return replace(found, shank=pieces + found.shank)


def _holder(tool: JsonObject, geometry: JsonObject) -> tuple[tuple[BodyPiece, ...], float]:
    """Return the pieces of a holder up to the gauge point, and how far that is above its lower end; 0 if nothing says
    it.
    """
    unit = short_text(tool.child("holder").values.get("unit"))
    if unit and unit not in _UNITS:
        tool.faults.append(phrase("unit_of_holder_not_read", unit=unit))
    holder = tool.child("holder", _UNITS.get(unit, geometry.scale))
    pieces, gauge = _pieces(holder), holder.length("gaugeLength")
    return (_below(pieces, gauge) if gauge else pieces), gauge


def _pieces(owner: JsonObject) -> tuple[BodyPiece, ...]:
    """Return the pieces of a shaft or a holder from below to above; steps have no height."""
    found = (
        BodyPiece(piece.length("lower-diameter"), piece.length("upper-diameter"), piece.length("height"))
        for piece in owner.children("segments", MOST_PIECES)
    )
    return tuple(piece for piece in found if piece.height)


def _below(pieces: tuple[BodyPiece, ...], height: float) -> tuple[BodyPiece, ...]:
    """Return the pieces of a holder up to the gauge point: above it they are in the spindle."""
    found: list[BodyPiece] = []
    for piece in pieces:
        share = min(height / piece.height, 1.0)
        if share <= 0.0:
            break
        upper = piece.lower_diameter + share * (piece.upper_diameter - piece.lower_diameter)
        found.append(BodyPiece(piece.lower_diameter, upper, share * piece.height))
        height -= piece.height
    return tuple(found)


def _refuse(geometry: JsonObject, key: str, why: str, **parameters: object) -> None:
    """Note a size whose meaning is not settled, unless it is absent; ``why`` is the phrase of the reason."""
    if geometry.values.get(key):
        shown = str(geometry.values[key])[:40]
        geometry.faults.append(phrase(why, size=f"{geometry.path}.{key}", value=shown, **parameters))


def _flat(tool: JsonObject, geometry: JsonObject) -> ToolSizes:
    _refuse(geometry, "RE", "flat_with_corner")
    return ToolSizes(ToolKind.FLAT, geometry.length("DC"))


def _ball(tool: JsonObject, geometry: JsonObject) -> ToolSizes:
    diameter, radius = geometry.length("DC"), geometry.length("RE")
    if radius and abs(radius - 0.5 * diameter) > _SAME * diameter:
        _refuse(geometry, "RE", "ball_of_other_radius", half=0.5 * diameter / geometry.scale)
    return ToolSizes(ToolKind.BALL, diameter)


def _bull(tool: JsonObject, geometry: JsonObject) -> ToolSizes:
    radius = geometry.length("RE")
    return ToolSizes(ToolKind.BULL if radius else ToolKind.FLAT, geometry.length("DC"), radius)


def _face(tool: JsonObject, geometry: JsonObject) -> ToolSizes:
    """Return a straight one is a bull nose; an upper radius means nothing without an angle."""
    _refuse(geometry, "TA", "face_mill_with_angle")
    return _bull(tool, geometry)


def _taper(tool: JsonObject, geometry: JsonObject) -> ToolSizes:
    """DC is where side and bottom would meet, also where a ball stands there."""
    diameter, radius, angle = geometry.length("DC"), geometry.length("RE"), geometry.angle("TA")
    form = short_text(tool.values.get("tapered-type"))
    if form not in ("tapered_bull_nose", "tapered_ball") and radius:
        geometry.faults.append(phrase("tapered_type_not_read", type=form) if form else phrase("tapered_type_missing"))
    if not angle:
        return _bull(tool, geometry)
    if form != "tapered_ball" or angle >= ANGLE_LIMITS["side_angle"]:
        return ToolSizes(ToolKind.TAPER, diameter, radius, side_angle=angle)
    b = math.radians(angle)
    meeting = 2.0 * radius * (1.0 - math.sin(b)) / math.cos(b)
    if abs(meeting - diameter) > _SAME * diameter:
        _refuse(geometry, "DC", "ball_of_other_meeting", meeting=meeting / geometry.scale)
    return ToolSizes(ToolKind.TAPER_BALL, 2.0 * radius, side_angle=angle)


def _chamfer(tool: JsonObject, geometry: JsonObject) -> ToolSizes:
    _refuse(geometry, "RE", "chamfer_with_rounded_tip")
    tip = geometry.length("tip-diameter")
    return ToolSizes(ToolKind.CHAMFER, geometry.length("DC"), tip_diameter=tip, side_angle=geometry.angle("TA"))


def _countersink(tool: JsonObject, geometry: JsonObject) -> ToolSizes:
    tip, angle = geometry.length("tip-diameter"), 0.5 * geometry.angle("SIG")
    return ToolSizes(ToolKind.CHAMFER, geometry.length("DC"), tip_diameter=tip, side_angle=angle)


def _drill(tool: JsonObject, geometry: JsonObject) -> ToolSizes:
    _refuse(geometry, "tip-diameter", "drill_with_flat_tip")
    angle = geometry.angle("SIG")
    if angle == ANGLE_LIMITS["tip_angle"]:
        return ToolSizes(ToolKind.FLAT, geometry.length("DC"))
    return ToolSizes(ToolKind.DRILL, geometry.length("DC"), tip_angle=angle)


def _cylinder(tool: JsonObject, geometry: JsonObject) -> ToolSizes:
    return _drill(tool, geometry) if geometry.angle("SIG") else ToolSizes(ToolKind.FLAT, geometry.length("DC"))


def _lollipop(tool: JsonObject, geometry: JsonObject) -> ToolSizes:
    return ToolSizes(ToolKind.LOLLIPOP, geometry.length("DC"))


def _slot(tool: JsonObject, geometry: JsonObject) -> ToolSizes:
    """Both corners are round; a head lower than they are is as high."""
    radius = geometry.length("RE")
    height = max(geometry.length("LCF"), 2.0 * radius)
    return ToolSizes(ToolKind.T_SLOT, geometry.length("DC"), radius, radius, flute_length=height)


def _thread_mill(tool: JsonObject, geometry: JsonObject) -> ToolSizes:
    """Teeth begin at the tip, as many as NT says and LCF holds."""
    if geometry.values.get("thread-tip-type") != "point":
        geometry.faults.append(phrase("crest_no_point"))
    pitch, angle = geometry.length("TP"), geometry.angle("thread-profile-angle")
    teeth = geometry.number("NT", MOST_TEETH)
    if pitch:
        teeth = min(teeth, geometry.length("LCF") / pitch + _SAME)
    return ToolSizes(
        ToolKind.THREAD_MILL, geometry.length("DC"), pitch=pitch, thread_angle=angle,
        flute_length=math.floor(teeth) * pitch,
    )  # fmt: skip


_FORMS: Final[Mapping[str, _Form]] = {
    "flat end mill": _flat,
    "ball end mill": _ball,
    "bull nose end mill": _bull,
    "face mill": _face,
    "tapered mill": _taper,
    "chamfer mill": _chamfer,
    "counter sink": _countersink,
    "drill": _drill,
    "spot drill": _drill,
    "reamer": _cylinder,
    "counter bore": _cylinder,
    "boring bar": _cylinder,
    "tap right hand": _cylinder,
    "tap left hand": _cylinder,
    "lollipop mill": _lollipop,
    "slot mill": _slot,
    "thread mill": _thread_mill,
}

#: Types that are no cylinders, but cut one nearly.
_AS_CYLINDERS: Final = frozenset({"boring bar", "tap right hand", "tap left hand"})
