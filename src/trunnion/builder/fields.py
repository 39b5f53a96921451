"""The fields of the builder: what a definition can say, on pages in the order in which a shop knows things.

In:     a merged definition, with the file and line of each value.
Out:    pages of fields. What each is called and its help are texts of the catalogue ``builder``; settings and
        templates, which definitions name themselves, bring what their definition says of them.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import field
from typing import Annotated, Any, Final

from trunnion.builder.document import FieldPath
from trunnion.controls.loading import shipped_controls
from trunnion.controls.places import TEMPLATE_ORDER
from trunnion.controls.vocabulary import FEEDS_WITHOUT_TCP, HOLE_APPROACH_HEIGHTS, PROGRAM_CHOICES
from trunnion.definitions import LocatedValue
from trunnion.machines.machine import AngleOutput, AxisKind, Mount, PositiveDirection, PreferredSign
from trunnion.messages import Wording
from trunnion.records import dataclass
from trunnion.results import NOT_DATA, Figure

#: Pages, in their order.
PAGES: Final = (
    "structure", "travels", "rotary", "spindle", "home", "control", "formats", "head", "tool_change", "operation",
    "foot", "codes", "cycles", "smoothing",
)  # fmt: skip

#: Ends of keys, and the unit that stands behind the field; the first that fits counts.
_UNITS: Final = {
    "_mm_min": "mm/min", "_deg_min": "°/min", "_mm_s2": "mm/s²", "_deg_s2": "°/s²", "_mm": "mm", "_deg": "°",
    "_mm_s3": "mm/s³", "_deg_s3": "°/s³", "_rpm": "min⁻¹", "_rpm_s": "min⁻¹/s", "_s": "s", "_kw": "kW",
    "_nm": "N·m", "rotary_tolerance": "°", "tolerance": "mm", "retract_distance": "mm", "delta_length": "mm",
    "delta_radius": "mm", "bore_lift": "mm",
}  # fmt: skip

#: Settings that belong to another page than "control".
_SETTING_PAGES: Final = {
    "retract": "home", "retract_distance": "home", "swivel_retract": "home", "safe_start": "head", "title": "head",
    "program": "head", "part": "head", "date": "head", "method": "head", "series": "head", "blank": "head",
    "tool": "tool_change", "tool_call": "tool_change", "edge": "tool_change", "delta_length": "tool_change",
    "delta_radius": "tool_change", "preselect": "tool_change", "tool_list": "head", "times": "head",
    "work_offset": "operation", "stock": "operation", "plane_move": "operation", "plane_solution": "operation",
    "plane": "operation", "swivel_data": "operation", "swivel_mode": "operation", "swivel_style": "operation",
    "disengage": "operation", "normals": "operation", "orientation": "operation", "rotary_feed": "operation",
    "restart": "operation", "standing_spindle": "operation", "bore_lift": "cycles", "missing_cycles": "cycles",
    "rigid_tap": "cycles", "holes": "cycles", "contour": "smoothing", "smoothing": "smoothing", "cycle832": "smoothing",
    "tolerance": "smoothing", "three_axis_tolerance": "smoothing", "fallback_tolerance": "smoothing",
    "rotary_tolerance": "smoothing", "hsc_mode": "smoothing", "splines": "smoothing",
}  # fmt: skip

#: Beginnings of templates that belong to another page than "operation".
_TEMPLATE_PAGES: Final = {
    "program_start": "head", "subprogram_start": "head", "subprogram_part": "head", "subprogram_call": "head",
    "first_tool": "tool_change", "tool_change": "tool_change", "spindle_on": "tool_change", "program_end": "foot",
    "subprogram_end": "foot",
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class Field:
    """One value of a definition.

    page      of ``PAGES``
    path      from the root of the definition
    kind      text, lines, number, whole, flag, choice, vector or interval
    choices   of a choice
    size      numbers of a vector
    optional  the definition may leave it out
    note      what the definition says of it; may be empty
    allowed   what it may be; may be empty
    stated    its unit by the rule of a setting; empty: its key says the unit, or it has none
    """

    page: Annotated[str, NOT_DATA]
    path: FieldPath
    kind: str
    choices: tuple[str, ...] = ()
    size: int = 0
    optional: bool = True
    note: Annotated[str | Wording, NOT_DATA] = ""
    allowed: Annotated[str | Wording, NOT_DATA] = ""
    stated: Annotated[str, NOT_DATA] = ""

    @property
    @Figure()
    def key(self) -> str:
        """Its path without names, by which texts are found: ``axis.limits_deg``."""
        return ".".join(step for step in self.path if isinstance(step, str))

    @property
    def numbers(self) -> int:
        """How many numbers a list in it has at most; 0: it holds no list."""
        return 2 if self.kind == "interval" else self.size

    @property
    @Figure()
    def unit(self) -> str:
        """Its unit, as it stands behind the field."""
        last = str(self.path[-1])
        return self.stated or next((unit for end, unit in _UNITS.items() if last.endswith(end)), "")


@dataclass(frozen=True, slots=True)
class SettingNotes:
    """What is said of the settings of a control: meanings and allowed values by their names."""

    meanings: Mapping[str, str | Wording] = field(default_factory=dict)
    allowed: Mapping[str, str | Wording] = field(default_factory=dict)


def fields_of(root: LocatedValue, notes: SettingNotes = SettingNotes()) -> list[Field]:
    """Return the fields of a definition, merged with all that it extends, by pages.

    root   the merged definition, its control merged as well
    notes  of the settings of its control
    """
    found = [*_machine_fields(root), *_control_fields(_table(root, "control"), notes)]
    return sorted(found, key=lambda each: PAGES.index(each.page))


def value_at(root: LocatedValue, path: FieldPath) -> LocatedValue | None:
    """Return the value at a path of a merged definition; None if it has none."""
    at: LocatedValue | None = root
    for step in path:
        value = None if at is None else at.value
        if isinstance(step, tuple):
            tables = tables_of(value)
            at = next((item for item in tables if step[0] and _name(item) == step[0]), None)
        else:
            at = value.get(step) if isinstance(value, dict) else None
    return at


def tables_of(value: object) -> list[LocatedValue]:
    """Return the tables of an array of tables; none of any other value."""
    return [item for item in value if isinstance(item, LocatedValue)] if isinstance(value, list) else []


def named_path(root: LocatedValue, key: str) -> FieldPath:
    """Return the path of a key as problems have it, ``axis[1].limits_deg``, with names for indices."""
    path: FieldPath = ()
    for part in key.split(".") if key else ():
        stem, _, index = part.partition("[")
        path = (*path, stem)
        if index:
            items = getattr(value_at(root, path), "value", None)
            number = int(index.rstrip("]")) if index.rstrip("]").isdecimal() else -1
            inside = isinstance(items, list) and 0 <= number < len(items)
            path = (*path, (_name(items[number]) if inside and isinstance(items, list) else "",))
    return path


def _machine_fields(root: LocatedValue) -> Iterator[Field]:
    yield Field("structure", ("name",), "text", optional=False)
    yield Field("structure", ("description",), "text")
    for name, entry in _named_tables(root, "axis"):
        yield from _axis_fields(name, _text(entry, "kind") == AxisKind.ROTARY)
    yield Field("spindle", ("spindle", "direction"), "vector", size=3)
    yield Field("spindle", ("spindle", "gauge_point_mm"), "vector", size=3)
    yield Field("spindle", ("workpiece", "zero_mm"), "vector", size=3)
    for key in ("min_rpm", "max_rpm", "acceleration_rpm_s", "tool_change_s", "power_kw", "torque_nm"):
        yield Field("spindle", ("spindle", key), "number")


def _axis_fields(name: str, is_rotary: bool) -> Iterator[Field]:
    def of(page: str, key: str, kind: str, choices: Sequence[str] = (), size: int = 0, optional: bool = True) -> Field:
        return Field(page, ("axis", (name,), key), kind, tuple(choices), size, optional)

    yield of("structure", "kind", "choice", tuple(AxisKind), optional=False)
    yield of("structure", "carries", "choice", tuple(Mount), optional=False)
    yield of("structure", "direction", "vector", size=3, optional=False)
    yield of("structure", "positive", "choice", tuple(PositiveDirection))
    unit, page = ("deg", "rotary") if is_rotary else ("mm", "travels")
    if is_rotary:
        yield of(page, "point_mm", "vector", size=3, optional=False)
        yield of(page, "endless", "flag")
    yield of(page, f"limits_{unit}", "interval")
    if is_rotary:
        yield of(page, "output", "choice", tuple(AngleOutput))
        yield of(page, "prefer", "choice", tuple(PreferredSign))
    yield of(page, f"rapid_{unit}_min", "number")
    yield of(page, f"acceleration_{unit}_s2", "number")
    yield of(page, f"jerk_{unit}_s3", "number")
    yield of("home", f"home_{unit}", "number")


def _control_fields(control: LocatedValue, notes: SettingNotes) -> Iterator[Field]:
    def of(page: str, kind: str, *path: str | tuple[str], **rest: Any) -> Field:
        return Field(page, ("control", *path), kind, **rest)

    yield of("control", "choice", "extends", choices=tuple(shipped_controls()))
    yield of("control", "text", "extension")
    for key in ("tcp", "plane_from_pose", "shorter_way", "own_blocks", "stops_in_compensation", "threads_stop_spindle",
                "level_approach", "rapid_into_planes"):  # fmt: skip
        yield of("control", "flag", key)
    yield of("control", "choice", "plane_x", choices=("program", "machine"))
    yield of("control", "choice", "feed_without_tcp", choices=tuple(FEEDS_WITHOUT_TCP))
    yield of("control", "whole", "blocks_in_compensation")
    yield of("control", "text", "radius_as_diameter")
    yield of("cycles", "choice", "holes_from", choices=tuple(HOLE_APPROACH_HEIGHTS))
    yield from _format_fields(control, of)
    yield of("smoothing", "number", "between_points", "axis_tolerance_deg")
    yield of("smoothing", "number", "between_points", "finishing_axis_tolerance_deg")
    yield of("smoothing", "number", "arcs", "chord_tolerance")
    yield of("smoothing", "choice", "arcs", "about", choices=("XYZ", "Z"))
    yield of("smoothing", "choice", "arcs", "by", choices=("centre", "radius"))
    yield of("smoothing", "flag", "arcs", "helices")
    yield of("smoothing", "flag", "arcs", "turns")
    for name in _keys(_table(control, "settings")):
        note, allowed = notes.meanings.get(name, ""), notes.allowed.get(name, "")
        choices = PROGRAM_CHOICES.get(name, ())
        kind = "choice" if choices else "text"
        page = _SETTING_PAGES.get(name, "control")
        unit = _text(_table(_table(control, "setting_rules"), name), "unit").replace("degrees", "°")
        yield of(page, kind, "settings", name, choices=choices, note=note, allowed=allowed, stated=unit)
    for name in sorted(_keys(_table(control, "templates")), key=_template_rank):
        start = next((page for begin, page in _TEMPLATE_PAGES.items() if name.startswith(begin)), "operation")
        yield of(start, "lines", "templates", name)
    if isinstance(_table(control, "coolant").value, dict):
        for name in _keys(_table(control, "coolant")):
            yield of("codes", "whole", "coolant", name)
    for name in _keys(_table(control, "codes")):
        yield of("codes", "whole", "codes", name)
    for name in _keys(_table(control, "known")):
        yield of("codes", "text", "known", name)


def _format_fields(control: LocatedValue, of: Any) -> Iterator[Field]:
    yield of("formats", "flag", "block_numbers", "numbered")
    yield of("formats", "text", "block_numbers", "letter")
    for key in ("start", "step", "highest"):
        yield of("formats", "whole", "block_numbers", key)
    for name, _ in _named_tables(control, "format"):
        yield of("formats", "whole", "format", (name,), "decimals", optional=False)
        yield of("formats", "whole", "format", (name,), "decimals_three_axis")
        for key in ("point", "leading_zero", "trailing_zeros", "plus"):
            yield of("formats", "flag", "format", (name,), key)
        yield of("formats", "text", "format", (name,), "zero")


def _template_rank(name: str) -> int:
    return next((rank for rank, start in enumerate(TEMPLATE_ORDER) if name.startswith(start)), len(TEMPLATE_ORDER))


def _table(root: LocatedValue, key: str) -> LocatedValue:
    found = root.value.get(key) if isinstance(root.value, dict) else None
    return found if isinstance(found, LocatedValue) else LocatedValue({}, root.file, root.line)


def _keys(table: LocatedValue) -> list[str]:
    return list(table.value) if isinstance(table.value, dict) else []


def _named_tables(root: LocatedValue, key: str) -> list[tuple[str, LocatedValue]]:
    return [(name, item) for item in tables_of(_table(root, key).value) if (name := _name(item))]


def _name(item: object) -> str:
    return _text(item, "name") if isinstance(item, LocatedValue) else ""


def _text(item: LocatedValue, key: str) -> str:
    found = item.value.get(key) if isinstance(item.value, dict) else None
    return found.value if isinstance(found, LocatedValue) and isinstance(found.value, str) else ""
