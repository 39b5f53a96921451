"""Tool bits of FreeCAD: JSON with the name of a shape and its parameters, which are texts with their unit."""

import math
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import field, replace
from typing import Any, Final

from trunnion.errors import Problem
from trunnion.messages import Wording, phrase
from trunnion.records import dataclass
from trunnion.simulation.tools.library.json_text import finite, short_text
from trunnion.simulation.tools.library.library import LibraryTool, ToolLibrary, UnusableTool
from trunnion.simulation.tools.shapes import fault_of_size, shape_faults
from trunnion.simulation.tools.sizes import ANGLE_LIMITS, BodyPiece, ToolKind, ToolSizes

#: mm to a unit of length, degrees to a unit of angle; a parameter without a unit is in mm or degrees.
_LENGTHS: Final[Mapping[str, float]] = {
    "": 1.0, "µm": 1e-3, "μm": 1e-3, "um": 1e-3, "mm": 1.0, "cm": 10.0, "m": 1000.0,
    "thou": 0.0254, "mil": 0.0254, "in": 25.4, "inch": 25.4, '"': 25.4, "ft": 304.8, "'": 304.8,
}  # fmt: skip
#: Sizes that say the same differ by no more than this, mm.
_SAME: Final = 1e-3

_ANGLES: Final = frozenset({"", "°", "deg"})

#: A number with its unit: with a point or a comma, as the language of the system has it, or a fraction of an inch.
_VALUE: Final = re.compile(
    r"(?P<number>\+?(?:\d{1,12}(?:[.,]\d{0,20})?|[.,]\d{1,20})(?:e[+-]?\d{1,2}(?!\d))?)\s*(?P<unit>[^\d.,\s]{0,5})",
    re.ASCII,
)
_FRACTION: Final = re.compile(
    r"(?:(?P<whole>\d{1,6})(?:\s*[+-]\s*|\s+))?(?P<part>\d{1,6})/(?P<of>[1-9]\d{0,5})\s*(?P<unit>in|inch|\")", re.ASCII
)

#: Names of shapes, in small letters without hyphens -> kind.
_KINDS: Final[Mapping[str, ToolKind]] = {
    "endmill": ToolKind.FLAT,
    "reamer": ToolKind.FLAT,
    "tap": ToolKind.DRILL,
    "ballend": ToolKind.BALL,
    "bullnose": ToolKind.BULL,
    "torus": ToolKind.BULL,
    "drill": ToolKind.DRILL,
    "chamfer": ToolKind.CHAMFER,
    "vbit": ToolKind.CHAMFER,
    "taperedballnose": ToolKind.TAPER_BALL,
    "threadmill": ToolKind.THREAD_MILL,
}


@dataclass(frozen=True, slots=True)
class _Parameters:
    """The parameters of a tool bit, with what is wrong in them."""

    values: Mapping[str, Any]
    faults: list[Wording] = field(default_factory=list)

    def length(self, key: str) -> float:
        """Return a length in mm; 0 if there is none."""
        number, unit = self._value(key)
        if unit not in _LENGTHS:
            self.faults.append(phrase("no_unit_of_length", size=key, unit=unit))
            return 0.0
        return number * _LENGTHS[unit]

    def angle(self, key: str) -> float:
        """Return an angle in degrees; 0 if there is none."""
        number, unit = self._value(key)
        if unit not in _ANGLES:
            self.faults.append(phrase("no_unit_of_angles", size=key, unit=unit))
            return 0.0
        return number

    def _value(self, key: str) -> tuple[float, str]:
        value = self.values.get(key)
        if value is None:
            return 0.0, ""
        text = _written_plainly(value) if isinstance(value, str) else ""
        if match := _VALUE.fullmatch(text):
            return float(match["number"].replace(",", ".")), match["unit"]
        if match := _FRACTION.fullmatch(text):
            return int(match["whole"] or 0) + int(match["part"]) / int(match["of"]), match["unit"]
        number = finite(value)
        if number is None or number < 0.0:
            self.faults.append(phrase("no_number_with_unit", size=key, value=str(value)[:40]))
            return 0.0, ""
        return number, ""


def _written_plainly(value: str) -> str:
    """Return a value with plain blanks, and with the sign of inches that is one character of ASCII."""
    return " ".join(value.split()).replace("″", '"').replace("”", '"').replace("''", '"').replace("′", "'")


def read_freecad(file: str, root: Mapping[str, Any]) -> ToolLibrary:
    """Return the one tool of a tool bit; ``root`` is what its JSON holds. It has a name, and no number."""
    name = short_text(root.get("name")) or short_text(root.get("label"))
    shape = short_text(root.get("shape-type")) or short_text(root.get("shape")).removesuffix(".fcstd")
    given = root.get("parameter")
    parameters = _Parameters(given if isinstance(given, dict) else {})
    known = _known(shape)
    faults = []
    sizes = None
    if known not in _KINDS:
        faults = [phrase("shape_not_read", shape=shape) if shape else phrase("no_shape")]
    else:
        sizes = _sizes(known, parameters)
        _note_contradictions(root, known, parameters)
        faults = parameters.faults or [fault_of_size(each) for each in shape_faults(sizes)]
    if faults or sizes is None:
        problems = tuple(
            Problem(file, 0, Wording("SIM152", "tool_bit", name=name, fault=each)) for each in dict.fromkeys(faults)
        )
        return ToolLibrary(file, (), (UnusableTool(None, name, problems),))
    remarks = [Wording("SIM155", "tool_bit_without_holder", length=sizes.length)] if sizes.length else []
    remarks += [Wording("SIM155", "tap_without_thread")] if known == "tap" else []
    return ToolLibrary(file, (LibraryTool(sizes, None, name, shape, tuple(remarks)),))


def _known(shape: str) -> str:
    """Return the name of a shape as ``_KINDS`` has it."""
    return re.split(r"[/\\]", shape)[-1].removesuffix(".fcstd").casefold().replace("-", "").replace("_", "")


def _note_contradictions(root: Mapping[str, Any], known: str, bit: _Parameters) -> None:
    """Note what a tool bit says twice, and not the same."""
    file = short_text(root.get("shape"))
    if known != _known(file) and _KINDS.get(_known(file), _KINDS[known]) is not _KINDS[known]:
        bit.faults.append(phrase("shapes_contradict", first=known, second=file))
    for size, value, usual in _sizes_of_other_shapes(known, bit):
        if value and abs(value - usual) > _SAME:
            bit.faults.append(phrase("size_of_another_shape", size=size, value=value, shape=known, usual=usual))
    edge, length = bit.length("CuttingEdgeHeight"), bit.length("Length")
    if 0.0 < length < edge:
        bit.faults.append(phrase("edge_longer_than_tool", edge=edge, length=length))


def _sizes_of_other_shapes(known: str, bit: _Parameters) -> Iterator[tuple[str, float, float]]:
    """Yield sizes that a shape has by itself: their keys, what the bit states (0: nothing), and what the shape has."""
    if known in ("endmill", "reamer", "ballend"):
        radius = 0.5 * bit.length("Diameter")
        corner = radius if known == "ballend" else 0.0
        yield from ((key, bit.length(key), corner) for key in ("CornerRadius", "TorusRadius"))
        yield "FlatRadius", bit.length("FlatRadius"), radius - corner
    if known in ("endmill", "ballend", "bullnose", "torus"):
        yield "TipAngle", bit.angle("TipAngle"), 180.0


def _sizes(shape: str, bit: _Parameters) -> ToolSizes:
    """Return the sizes of a tool bit. Its holder is not in it: all of its length stands free."""
    form = ToolSizes(
        _KINDS[shape],
        bit.length("Diameter"),
        flute_length=min(bit.length("CuttingEdgeHeight"), bit.length("Length")),
        length=bit.length("Length"),
        shank_diameter=bit.length("ShankDiameter"),
    )
    return _FORMS[shape](form, bit) if shape in _FORMS else form


def _bull(form: ToolSizes, bit: _Parameters) -> ToolSizes:
    flat = bit.length("FlatRadius")
    stated = [0.5 * form.diameter - flat] if flat else []
    stated += [radius for key in ("CornerRadius", "TorusRadius") if (radius := bit.length(key))]
    if stated and max(stated) - min(stated) > _SAME:
        bit.faults.append(phrase("corner_radii_contradict", first=stated[0], second=stated[1]))
    return replace(form, corner_radius=stated[0] if stated else 0.0)


def _drill(form: ToolSizes, bit: _Parameters) -> ToolSizes:
    return replace(form, tip_angle=bit.angle("TipAngle"))


def _tap(form: ToolSizes, bit: _Parameters) -> ToolSizes:
    """CuttingEdgeLength counts from where the tip ends."""
    angle = bit.angle("TipAngle")
    tip = _cone(0.5 * form.diameter, 0.5 * angle)
    return replace(form, tip_angle=angle, flute_length=tip + bit.length("CuttingEdgeLength"))


def _cone(radius: float, angle: float) -> float:
    """Return the height of a cone of a radius with an angle from its axis; 0 if it has none."""
    return radius / math.tan(math.radians(angle)) if angle else 0.0


def _chamfer(form: ToolSizes, bit: _Parameters) -> ToolSizes:
    """Return a chamfer mill: as wide as its cone, which is as high as the cutting edge; Diameter is that of no part."""
    tip, side_angle = bit.length("TipDiameter"), 0.5 * bit.angle("CuttingEdgeAngle")
    diameter = tip + 2.0 * form.flute_length * math.tan(math.radians(side_angle))
    return replace(form, diameter=diameter, tip_diameter=tip, side_angle=side_angle)


def _v_bit(form: ToolSizes, bit: _Parameters) -> ToolSizes:
    """Its cone is as wide as Diameter; CuttingEdgeHeight is that of the cylinder above."""
    tip, side_angle = bit.length("TipDiameter"), 0.5 * bit.angle("CuttingEdgeAngle")
    cone = _cone(0.5 * (form.diameter - tip), side_angle)
    return replace(form, tip_diameter=tip, side_angle=side_angle, flute_length=cone + bit.length("CuttingEdgeHeight"))


def _taper_ball(form: ToolSizes, bit: _Parameters) -> ToolSizes:
    """TaperAngle is the whole angle. The cone goes on above the cutting edge up to TaperDiameter."""
    side_angle, radius = 0.5 * bit.angle("TaperAngle"), 0.5 * form.diameter
    b = math.radians(side_angle)
    edge = radius / math.cos(b) + (form.flute_length - radius) * math.tan(b)
    rest = 0.5 * bit.length("TaperDiameter") - edge
    pieces = (BodyPiece(2.0 * edge, 2.0 * (edge + rest), _cone(rest, side_angle)),) if rest > 0.0 and b else ()
    return replace(form, side_angle=side_angle, shank=pieces)


def _thread_mill(form: ToolSizes, bit: _Parameters) -> ToolSizes:
    """One tooth at the tip, on a neck."""
    crest, neck, angle = bit.length("Crest"), bit.length("NeckDiameter"), bit.angle("cuttingAngle")
    if not (neck and 0.0 < angle < ANGLE_LIMITS["thread_angle"]):
        bit.faults.append(phrase("tooth_needs_sizes"))
        return form
    height = crest + max(form.diameter - neck, 0.0) * math.tan(math.radians(0.5 * angle))
    return replace(
        form, crest=crest, thread_angle=angle, pitch=height, flute_length=height,
        neck_diameter=neck, neck_length=max(bit.length("NeckLength"), height),
    )  # fmt: skip


_FORMS: Final[Mapping[str, Callable[[ToolSizes, _Parameters], ToolSizes]]] = {
    "bullnose": _bull,
    "torus": _bull,
    "drill": _drill,
    "tap": _tap,
    "chamfer": _chamfer,
    "vbit": _v_bit,
    "taperedballnose": _taper_ball,
    "threadmill": _thread_mill,
}
