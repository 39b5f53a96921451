"""Tool libraries as Autodesk's CAM exports them: JSON with a list of tools under ``data``, also packed as ``.tools``.

Each tool has its kind (``type``), its unit and its sizes (``geometry``): DC diameter, RE corner radius, TA angle of the
side from the tool axis, SIG whole angle of the tip, LCF flute length, LB length out of the holder, OAL overall length,
SFDM shank diameter.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any, Final, TypeAlias

from trunnion.errors import InputError, Problem
from trunnion.simulation.tool_library.json_text import JsonObject, finite, short_text
from trunnion.simulation.tool_library.library import ToolLibrary, UnusableTool
from trunnion.simulation.tool_profile import ToolShape
from trunnion.simulation.tool_shapes import tool_faults, tool_shape
from trunnion.simulation.tool_sizes import MOST_PIECES, BodyPiece, ToolKind, ToolSizes, ball_height

_Form: TypeAlias = Callable[[JsonObject], ToolSizes]

_UNITS: Final[Mapping[str, float]] = {"millimeters": 1.0, "inches": 25.4}

_SAY_IT: Final = "state the tool itself: its kind and its sizes"

#: Most tools of a library.
_MOST_TOOLS: Final = 20_000

#: How far two sizes that say the same may differ, as a part of the diameter.
_SAME: Final = 1e-3


def read_autodesk(file: str, root: Mapping[str, Any]) -> ToolLibrary:
    """Return the tools of a library; ``root`` is what its JSON holds.

    Raises
    ------
    InputError
        If there is no list of tools in it, or an entry of it is none.
    """
    library = JsonObject(root)
    entries = library.children("data", _MOST_TOOLS)
    if library.faults:
        raise InputError(
            [Problem(file, 0, what, "export the library again, or fewer tools") for what in library.faults]
        )
    tools: list[ToolShape] = []
    unusable: list[UnusableTool] = []
    for tool in entries:
        if tool.values.get("type") == "holder":
            continue
        # Mistakes of one tool are no mistakes of the others.
        found = _read_tool(file, tool.path, JsonObject(tool.values))
        if isinstance(found, ToolShape):
            tools.append(found)
        else:
            unusable.append(found)
    return ToolLibrary(file, tuple(tools), tuple(unusable))


def _read_tool(file: str, place: str, tool: JsonObject) -> ToolShape | UnusableTool:
    number = finite(tool.child("post-process").values.get("number"))
    called = int(number) if number is not None and number >= 0 and number == int(number) else None
    name = short_text(tool.values.get("description")) or short_text(tool.values.get("product-id"))
    found = _sizes(tool)
    if not tool.faults and found:
        faults = tool_faults(found)
        tool.faults.extend(f"its {size.replace('_', ' ')} {what}; {cure}" for size, what, cure in faults)
    if tool.faults or not found:
        shown = " ".join(filter(None, ("tool", "" if called is None else str(called), name)))
        problems = (Problem(file, 0, f"{shown} ({place}): {what}", _SAY_IT) for what in tool.faults)
        return UnusableTool(called, name, tuple(problems))
    kind = short_text(tool.values.get("type"))
    shape = tool_shape(found, called, name, kind)
    remarks = (f"is a {kind}: simulated as a cylinder",) if kind in _AS_CYLINDERS else ()
    return replace(shape, remarks=(*shape.remarks, *remarks)) if remarks else shape


def _sizes(tool: JsonObject) -> ToolSizes | None:
    """The sizes of a tool; None if its kind or its unit is not known, which is a fault of it."""
    kind, unit = short_text(tool.values.get("type")), short_text(tool.values.get("unit"))
    if kind not in _FORMS:
        tool.faults.append(f"{kind} is a type that is not read" if kind else "it has no type")
        return None
    if unit not in _UNITS:
        tool.faults.append(f'its unit is {unit}, not "millimeters" or "inches"' if unit else "it has no unit")
        return None
    geometry = tool.child("geometry", _UNITS[unit])
    found = _with_body(_FORMS[kind](geometry), tool, geometry)
    if found.kind is ToolKind.LOLLIPOP and 0.0 < found.neck_diameter < found.diameter:
        found = replace(found, flute_length=min(found.flute_length, ball_height(found)))
    return found


def _with_body(form: ToolSizes, tool: JsonObject, geometry: JsonObject) -> ToolSizes:
    """A cutter with what stands above it."""
    length = geometry.length("LB")
    holder_unit = short_text(tool.child("holder").values.get("unit"))
    if holder_unit and holder_unit not in _UNITS:
        tool.faults.append(f'its holder has the unit {holder_unit}, not "millimeters" or "inches"')
    holder = tool.child("holder", _UNITS.get(holder_unit, geometry.scale))
    pieces = _pieces(holder)
    if not length:
        length = geometry.length("OAL")
        if pieces:
            geometry.faults.append("geometry.LB is missing: nothing says where its holder begins")
    flute_length = min(geometry.length("LCF"), length or math.inf)
    shank = _pieces(tool.child("shaft", geometry.scale))
    neck_length = min(geometry.length("shoulder-length"), length)
    neck_diameter = geometry.length("shoulder-diameter") or (0.0 if form.kind is ToolKind.TAPER else form.diameter)
    if form.kind in (ToolKind.LOLLIPOP, ToolKind.T_SLOT):
        neck_length = max(neck_length, flute_length)
    elif neck_length < flute_length or not neck_diameter:
        neck_length = neck_diameter = 0.0
    gauge = holder.length("gaugeLength")
    if pieces and gauge:
        pieces = _below(pieces, gauge)
    return replace(
        form, flute_length=flute_length, length=length, shank=shank, holder=pieces,
        shank_diameter=0.0 if shank else geometry.length("SFDM"),
        neck_length=neck_length, neck_diameter=neck_diameter,
        gauge_length=length + gauge if pieces and gauge else 0.0,
    )  # fmt: skip


def _pieces(owner: JsonObject) -> tuple[BodyPiece, ...]:
    """The pieces of a shaft or a holder from below to above; steps have no height."""
    found = (
        BodyPiece(piece.length("lower-diameter"), piece.length("upper-diameter"), piece.length("height"))
        for piece in owner.children("segments", MOST_PIECES)
    )
    return tuple(piece for piece in found if piece.height)


def _below(pieces: tuple[BodyPiece, ...], height: float) -> tuple[BodyPiece, ...]:
    """The pieces of a holder up to the gauge point: above it they are in the spindle."""
    found: list[BodyPiece] = []
    for piece in pieces:
        share = min(height / piece.height, 1.0)
        if share <= 0.0:
            break
        upper = piece.lower_diameter + share * (piece.upper_diameter - piece.lower_diameter)
        found.append(BodyPiece(piece.lower_diameter, upper, share * piece.height))
        height -= piece.height
    return tuple(found)


def _refuse(geometry: JsonObject, key: str, why: str) -> None:
    """Note a size whose meaning is not settled, unless it is absent."""
    if geometry.values.get(key):
        geometry.faults.append(f"{geometry.path}.{key} is {str(geometry.values[key])[:40]}: {why}")


def _flat(geometry: JsonObject) -> ToolSizes:
    _refuse(geometry, "RE", "a flat end mill has no corner radius")
    return ToolSizes(ToolKind.FLAT, geometry.length("DC"))


def _ball(geometry: JsonObject) -> ToolSizes:
    diameter, radius = geometry.length("DC"), geometry.length("RE")
    if radius and abs(radius - 0.5 * diameter) > _SAME * diameter:
        _refuse(geometry, "RE", f"half the diameter is {0.5 * diameter / geometry.scale:g}")
    return ToolSizes(ToolKind.BALL, diameter)


def _bull(geometry: JsonObject) -> ToolSizes:
    return ToolSizes(ToolKind.BULL, geometry.length("DC"), geometry.length("RE"))


def _face(geometry: JsonObject) -> ToolSizes:
    _refuse(geometry, "TA", "where the diameter of a tapered face mill counts is not confirmed")
    radius = geometry.length("RE")
    return ToolSizes(ToolKind.BULL if radius else ToolKind.FLAT, geometry.length("DC"), radius)


def _taper(geometry: JsonObject) -> ToolSizes:
    diameter, radius = geometry.length("DC"), geometry.length("RE")
    if diameter and radius >= 0.5 * diameter * (1.0 - _SAME):
        geometry.faults.append("it is a tapered ball mill, of which it is not confirmed where its diameter counts")
    return ToolSizes(ToolKind.TAPER, diameter, radius, side_angle=geometry.angle("TA"))


def _chamfer(geometry: JsonObject) -> ToolSizes:
    _refuse(geometry, "RE", "a rounded tip of a chamfer mill is not read")
    tip = geometry.length("tip-diameter")
    return ToolSizes(ToolKind.CHAMFER, geometry.length("DC"), tip_diameter=tip, side_angle=geometry.angle("TA"))


def _countersink(geometry: JsonObject) -> ToolSizes:
    tip, angle = geometry.length("tip-diameter"), 0.5 * geometry.angle("SIG")
    return ToolSizes(ToolKind.CHAMFER, geometry.length("DC"), tip_diameter=tip, side_angle=angle)


def _drill(geometry: JsonObject) -> ToolSizes:
    _refuse(geometry, "tip-diameter", "a drill ends in a point")
    angle = geometry.angle("SIG")
    if angle == 180.0:
        return ToolSizes(ToolKind.FLAT, geometry.length("DC"))
    return ToolSizes(ToolKind.DRILL, geometry.length("DC"), tip_angle=angle)


def _cylinder(geometry: JsonObject) -> ToolSizes:
    return _drill(geometry) if geometry.angle("SIG") else ToolSizes(ToolKind.FLAT, geometry.length("DC"))


def _lollipop(geometry: JsonObject) -> ToolSizes:
    return ToolSizes(ToolKind.LOLLIPOP, geometry.length("DC"))


def _slot(geometry: JsonObject) -> ToolSizes:
    _refuse(geometry, "RE", "which corners of a slot mill are round is not confirmed")
    return ToolSizes(ToolKind.T_SLOT, geometry.length("DC"))


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
}

#: Types that are no cylinders, but cut one nearly.
_AS_CYLINDERS: Final = frozenset({"boring bar", "tap right hand", "tap left hand"})
