"""Tool bits of FreeCAD: JSON with the name of a shape and its parameters, which are texts with their unit."""

import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Final

from trunnion.errors import Problem
from trunnion.simulation.tool_library.json_text import finite, short_text
from trunnion.simulation.tool_library.library import ToolLibrary, UnusableTool
from trunnion.simulation.tool_shapes import tool_faults, tool_shape
from trunnion.simulation.tool_sizes import ToolKind, ToolSizes

#: mm to a unit of length, degrees to a unit of angle; a parameter without a unit is in mm or degrees.
_LENGTHS: Final[Mapping[str, float]] = {"": 1.0, "mm": 1.0, "cm": 10.0, "m": 1000.0, "in": 25.4, '"': 25.4}
_ANGLES: Final = frozenset({"", "°", "deg"})

_VALUE: Final = re.compile(r"(\d{1,12}(?:\.\d{0,20})?)\s*([^\d.,\s]{0,5})", re.ASCII)

#: Names of shapes, in small letters without hyphens -> kind.
_KINDS: Final[Mapping[str, ToolKind]] = {
    "endmill": ToolKind.FLAT,
    "reamer": ToolKind.FLAT,
    "tap": ToolKind.FLAT,
    "ballend": ToolKind.BALL,
    "bullnose": ToolKind.BULL,
    "torus": ToolKind.BULL,
    "drill": ToolKind.DRILL,
    "chamfer": ToolKind.CHAMFER,
    "vbit": ToolKind.CHAMFER,
    "taperedballnose": ToolKind.TAPER_BALL,
    "threadmill": ToolKind.THREAD_MILL,
}

#: How far two sizes that say the same may differ, as a part of the larger one.
_SAME: Final = 0.01


@dataclass(frozen=True, slots=True)
class _Parameters:
    """The parameters of a tool bit, with what is wrong in them."""

    values: Mapping[str, Any]
    faults: list[str] = field(default_factory=list)

    def length(self, key: str) -> float:
        """A length in mm; 0 if there is none."""
        number, unit = self._value(key)
        if unit not in _LENGTHS:
            self.faults.append(f"{key} has the unit {unit}, which is none of length")
            return 0.0
        return number * _LENGTHS[unit]

    def angle(self, key: str) -> float:
        """An angle in degrees; 0 if there is none."""
        number, unit = self._value(key)
        if unit not in _ANGLES:
            self.faults.append(f"{key} has the unit {unit}, which is none of angles")
            return 0.0
        return number

    def _value(self, key: str) -> tuple[float, str]:
        value = self.values.get(key)
        if value is None:
            return 0.0, ""
        if isinstance(value, str) and (match := _VALUE.fullmatch(value.strip())):
            return float(match[1]), match[2].strip()
        number = finite(value)
        if number is None or number < 0.0:
            self.faults.append(f"{key} is {str(value)[:40]}, not a number with its unit")
            return 0.0, ""
        return number, ""


def read_freecad(file: str, root: Mapping[str, Any]) -> ToolLibrary:
    """Return the one tool of a tool bit; ``root`` is what its JSON holds. It has a name, and no number."""
    name = short_text(root.get("name")) or short_text(root.get("label"))
    shape = short_text(root.get("shape-type")) or short_text(root.get("shape")).removesuffix(".fcstd")
    given = root.get("parameter")
    parameters = _Parameters(given if isinstance(given, dict) else {})
    kind = _KINDS.get(re.split(r"[/\\]", shape)[-1].casefold().replace("-", "").replace("_", ""))
    whats = []
    sizes = None
    if kind is None:
        whats = [f"{shape or 'none'} is a shape that is not read"]
    else:
        sizes = _sizes(kind, parameters)
        whats = parameters.faults or [
            f"its {size.replace('_', ' ')} {what}; {cure}" for size, what, cure in tool_faults(sizes)
        ]
    if whats or sizes is None:
        cure = "state the tool itself: its kind and its sizes"
        problems = tuple(Problem(file, 0, f"tool bit {name}: {what}", cure) for what in whats)
        return ToolLibrary(file, (), (UnusableTool(None, name, problems),))
    return ToolLibrary(file, (tool_shape(sizes, None, name, shape),))


def _sizes(kind: ToolKind, bit: _Parameters) -> ToolSizes:
    """The sizes of a tool bit. Its holder is not in it: all of its length stands free."""
    form = ToolSizes(
        kind,
        bit.length("Diameter"),
        flute_length=min(bit.length("CuttingEdgeHeight"), bit.length("Length")),
        length=bit.length("Length"),
        shank_diameter=bit.length("ShankDiameter"),
    )
    return _FORMS[kind](form, bit) if kind in _FORMS else form


def _bull(form: ToolSizes, bit: _Parameters) -> ToolSizes:
    flat = bit.length("FlatRadius")
    corner = 0.5 * form.diameter - flat if flat else bit.length("CornerRadius") or bit.length("TorusRadius")
    return replace(form, corner_radius=corner)


def _drill(form: ToolSizes, bit: _Parameters) -> ToolSizes:
    return replace(form, tip_angle=bit.angle("TipAngle"))


def _chamfer(form: ToolSizes, bit: _Parameters) -> ToolSizes:
    """It cuts along its cone; CuttingEdgeAngle is the whole angle."""
    tip, side_angle = bit.length("TipDiameter"), 0.5 * bit.angle("CuttingEdgeAngle")
    slope = math.tan(math.radians(side_angle))
    cone = 0.5 * (form.diameter - tip) / slope if slope else 0.0
    return replace(form, tip_diameter=tip, side_angle=side_angle, flute_length=max(min(cone, form.length), 0.0))


def _taper_ball(form: ToolSizes, bit: _Parameters) -> ToolSizes:
    """TaperAngle is the whole angle; TaperDiameter, where the cutting edge ends, has to agree."""
    b, radius = math.radians(0.5 * bit.angle("TaperAngle")), 0.5 * form.diameter
    top = 2.0 * (radius / math.cos(b) + (form.flute_length - radius) * math.tan(b)) if b < 1.5 else 0.0
    stated = bit.length("TaperDiameter")
    if stated and abs(stated - top) > _SAME * stated:
        bit.faults.append(f"TaperDiameter is {stated:g} mm, but a ball with this angle has {top:.4g} mm there")
    return replace(form, side_angle=math.degrees(b))


def _thread_mill(form: ToolSizes, bit: _Parameters) -> ToolSizes:
    """One tooth at the tip, on a neck."""
    crest, neck, angle = bit.length("Crest"), bit.length("NeckDiameter"), bit.angle("cuttingAngle")
    if not (neck and 0.0 < angle < 180.0):
        bit.faults.append("a tooth needs NeckDiameter and cuttingAngle")
        return form
    height = crest + max(form.diameter - neck, 0.0) * math.tan(math.radians(0.5 * angle))
    return replace(
        form, crest=crest, thread_angle=angle, pitch=height, flute_length=height,
        neck_diameter=neck, neck_length=max(bit.length("NeckLength"), height),
    )  # fmt: skip


_FORMS: Final[Mapping[ToolKind, Callable[[ToolSizes, _Parameters], ToolSizes]]] = {
    ToolKind.BULL: _bull,
    ToolKind.DRILL: _drill,
    ToolKind.CHAMFER: _chamfer,
    ToolKind.TAPER_BALL: _taper_ball,
    ToolKind.THREAD_MILL: _thread_mill,
}
