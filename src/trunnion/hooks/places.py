"""The records that functions of a user get at places of output; the values are those of templates.

Lengths and feeds are in mm and mm/min, whatever the program counts in; None is what nobody has stated.
"""

from collections.abc import Mapping, Sequence
from typing import Protocol

from trunnion.controls.words import NumberFormat
from trunnion.model.toolpath import Kind, Phase
from trunnion.records import dataclass


@dataclass(frozen=True, slots=True)
class ToolValues:
    """A tool of the program.

    call              as the program calls it
    number, name      its number; what the CL file calls it
    kind              MILL, TCUTTER, BARREL or DRILL
    diameter, corner_radius, length, flute_length, extension, set_length  mm
    taper_angle, tip_angle  degrees
    holder            what the CL file calls the holder
    operations        how many operations use it
    """

    call: str
    number: int | None
    name: str | None
    kind: str | None
    diameter: float | None
    corner_radius: float | None
    length: float | None
    flute_length: float | None
    taper_angle: float | None
    tip_angle: float | None
    holder: str | None
    extension: float | None
    set_length: float | None
    operations: int


@dataclass(frozen=True, slots=True)
class OperationValues:
    """An operation of the program.

    name, number, tool, points  its name; its number from 1; its tool; how many points it has
    mode           three_axis, tilted, tcp or without_tcp
    method, work_offset, planes  machining method; the setting; how many planes it has
    time           machining time: known when the program is proven, so it can be printed and not be asked
    spindle_speed, spindle_sense, coolant  that it switches first: rev/min; CLW or CCLW; the word of COOLNT
    least_feed, greatest_feed  of its cuts, mm/min
    x_min, x_max, y_min, y_max, z_min, z_max  the box around its cuts, in whole mm outwards
    """

    name: str | None
    number: int
    tool: ToolValues
    mode: str
    method: str | None
    time: str | None
    points: int
    spindle_speed: float | None
    spindle_sense: str | None
    coolant: str | None
    least_feed: float | None
    greatest_feed: float | None
    x_min: float | None
    x_max: float | None
    y_min: float | None
    y_max: float | None
    z_min: float | None
    z_max: float | None
    work_offset: str | None
    planes: int


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Place:
    """A place of a program.

    name        of the place, as tool_change
    template    name of the template that stands here, as first_tool
    lines       what the definition writes here; what is returned takes their place
    machine, control  their names
    settings    of the run, as text
    fields      what templates print as ``{name}``, and settings of the definition
    operation, tool, next_tool  the operation here, its tool, the next other tool
    tools, operations  of the program, in its order
    formats     number formats of the control: ``place.formats["coordinate"].text(12.5)`` is what a program prints
    """

    name: str
    template: str
    lines: tuple[str, ...]
    machine: str
    control: str
    settings: Mapping[str, str]
    fields: Mapping[str, str | float | None]
    operation: OperationValues
    tool: ToolValues
    next_tool: ToolValues | None
    tools: tuple[ToolValues, ...]
    operations: tuple[OperationValues, ...]
    formats: Mapping[str, NumberFormat]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class MotionPlace(Place):
    """A move at ``rapid``, ``linear`` or ``arc``; ``lines`` stand before its block.

    row    of the move in its operation, or the part of it in one plane, from 0
    tip    its end, mm, as the block has it: in a tilted plane the coordinates of the plane
    axis   tool axis there, unit vector from tip to holder
    kind, phase  how the tip moves to it, and its role
    feed   mm/min, or mm/rev where ``per_rev``
    words  of its block: numbers as they are printed, by the names of ``[[control.word]]``. Modal words that are
           unchanged are among them, and left out as ever
    line   of the CL file
    """

    row: int
    tip: tuple[float, float, float]
    axis: tuple[float, float, float]
    kind: Kind
    phase: Phase
    feed: float
    per_rev: bool
    words: Mapping[str, float]
    line: int


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CyclePlace(Place):
    """A cycle that begins.

    kind   the first word of the CYCLE statement, as DRILL
    mode   that word and those behind it
    words  its numbers by the words before them, mm: ``{"RAPTO": 3.0, "STEP": 5.0}``
    line   of the CL file
    """

    kind: str
    mode: tuple[str, ...]
    words: Mapping[str, float]
    line: int


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CoolantPlace(Place):
    """A coolant that is switched.

    kind   its word in COOLNT: ON, FLOOD, MIST, TAP, THRU, AIR or OFF
    words  its M code: ``{"coolant": 8}``
    line   of the CL file
    """

    kind: str
    words: Mapping[str, float]
    line: int


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class StopPlace(Place):
    """A program stop; one of ``lines`` must have its M code.

    number  of that M code
    text    of the STOP or OPSTOP statement
    """

    number: int
    text: str


#: The record of each place that has more than ``Place``.
PLACE_RECORDS = {
    "rapid": MotionPlace,
    "linear": MotionPlace,
    "arc": MotionPlace,
    "cycle": CyclePlace,
    "coolant": CoolantPlace,
    "stop": StopPlace,
}


class AtPlace(Protocol):
    """``at_…``: called at each place of its name, in the order of the program."""

    def __call__(self, place: Place) -> Place | str | Sequence[str] | Mapping[str, float | None] | None:
        """Return lines that take the place of ``place.lines``, words that change, or None for no change.

        Both are ``dataclasses.replace(place, lines=…, words=…)``. A word that is None is left out.
        """
