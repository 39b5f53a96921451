"""The words of path blocks, polar coordinates and circles."""

import math
from collections.abc import Collection, Iterable, Sequence
from dataclasses import field
from functools import partial
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.messages import Wording
from trunnion.readers.control import arcs
from trunnion.readers.control.axis_word import AxisWord, PositionMode
from trunnion.readers.control.row_recorder import MAX_POSITION
from trunnion.readers.control.virtual_control import Circle
from trunnion.readers.families.heidenhain.control import HeidenhainControl
from trunnion.readers.families.heidenhain.lexer import Operand, Word
from trunnion.readers.families.heidenhain.parameters import KlartextError, Parameters, canonical
from trunnion.readers.families.heidenhain.words import M_ARGUMENTS
from trunnion.records import dataclass

#: Higher feeds are mistakes of the program.
MAX_FEED: Final = 1e9

#: Helices with more turns are mistakes of the program.
MAX_TURNS: Final = 1000

_AXES: Final = frozenset("XYZABCUVW")
_VECTORS: Final = frozenset({"NX", "NY", "NZ", "TX", "TY", "TZ"})
_FLAGS: Final = frozenset({"FMAX", "R0", "RL", "RR", "R", "DR+", "DR-", "F", "AUTO", "FAUTO", "MAX"})

#: Feeds in two words, of which the first is F.
_FEEDS: Final = ("MAX", "AUTO")

#: Words of which a block takes one.
_ALTERNATIVES: Final = (
    *(frozenset({name}) for name in ("PR", "PA", *sorted(_VECTORS), "R", "LEN", "CCA", "CHF")),
    frozenset({"R0", "RL", "RR"}),
    frozenset({"DR+", "DR-"}),
    frozenset({"F", "FMAX", "FAUTO"}),
)

#: What all path blocks take besides their positions.
_OF_ALL_PATHS: Final = frozenset({*_AXES, "R", "R0", "RL", "RR", "F", "FMAX", "FAUTO", "MAX", "AUTO", "M"})

#: What each takes besides.
_OF_PATHS: Final = {
    "L": _VECTORS,
    "LN": _VECTORS,
    "LP": {"PR", "PA", *_VECTORS},
    "C": {"DR+", "DR-"},
    "CR": {"DR+", "DR-"},
    "CP": {"PA", "DR+", "DR-"},
    "CTP": {"PR", "PA"},
    "CT": set[str](),
}


def value_of(operand: Operand, parameters: Parameters) -> float:
    """Return the value of an operand."""
    if operand.parameter:
        return operand.sign * parameters[canonical(operand.parameter)]
    return operand.sign * operand.number


@dataclass(slots=True)
class Block:
    """The words of a path block with their values.

    axes          axes by letter
    vectors       components of surface normal and tool axis
    polar         PR and PA
    sizes         LEN, CCA and CHF
    direction     1 for DR+, -1 for DR-, 0 without
    side          RL, RR or R0
    feed_of_tool  F AUTO: the feed of the tool call
    m             M functions with their words, whose value is None for flags
    written       the names of all words but those of M functions
    """

    axes: dict[str, AxisWord] = field(default_factory=dict)
    vectors: dict[str, float] = field(default_factory=dict)
    polar: dict[str, AxisWord] = field(default_factory=dict)
    sizes: dict[str, float] = field(default_factory=dict)
    radius: float | None = None
    direction: int = 0
    side: str = ""
    rapid: bool = False
    feed: float | None = None
    feed_of_tool: bool = False
    m: list[tuple[int, dict[str, float | None]]] = field(default_factory=list)
    written: list[str] = field(default_factory=list)

    @property
    def tool_axis(self) -> Floats | None:
        """TX TY TZ, (3,); components that are not written are 0."""
        vector = self._vector("TX", "TY", "TZ")
        if vector is not None and not np.any(vector):
            raise KlartextError(Wording("NC210", "tool_vector_no_length"))
        return vector

    @property
    def normal(self) -> Floats | None:
        """NX NY NZ, (3,); components that are not written are 0."""
        return self._vector("NX", "NY", "NZ")

    def _vector(self, *names: str) -> Floats | None:
        if not self.vectors.keys() & set(names):
            return None
        return np.array([self.vectors.get(name, 0.0) for name in names])


def read_block(words: Sequence[Word], parameters: Parameters, sizes: Collection[str] = ()) -> Block:
    """Return the block of words; ``sizes``: those that it may have besides the words of path blocks.

    Raises ``KlartextError`` for a word that path blocks do not have, and for a parameter without a value.
    """
    block = Block()
    for place, word in enumerate(words):
        arguments = M_ARGUMENTS.get(block.m[-1][0], frozenset()) if block.m else frozenset()
        name = word.name
        if word.text is not None or (name not in arguments and word.operand is None and name not in _FLAGS):
            raise KlartextError(Wording("NC211", "unknown_word", word=name or word.text))
        value = None if word.operand is None else value_of(word.operand, parameters)
        if name == "F" and value is None and (place + 1 == len(words) or words[place + 1].name not in _FEEDS):
            raise KlartextError(Wording("NC210", "word_needs_value", word=name))
        if name in arguments:
            if name in block.m[-1][1]:
                raise KlartextError(Wording("NC212", "written_twice", word=name))
            block.m[-1][1][name] = value
            continue
        if name in _FEEDS and not (place and words[place - 1].name == "F" and words[place - 1].operand is None):
            raise KlartextError(Wording("NC211", "unknown_word", word=name))
        block.written.append("R0" if name == "R" and value == 0.0 else name)
        if value is None:
            _flag(block, name)
        elif name in sizes:
            block.sizes[name] = value
        else:
            _value(block, name, value, PositionMode.INCREMENTAL if word.incremental else PositionMode.ABSOLUTE)
    _check_alternatives(block)
    return block


def only(written: Iterable[str], takes: Collection[str], block: str) -> None:
    """Refuse a word that its block has no use for; ``takes``: those that it has one for."""
    for name in written:
        if name not in takes:
            raise KlartextError(Wording("NC210", "block_takes_no", block=block, word=name))


def _check_alternatives(block: Block) -> None:
    """Refuse two words of a block of which it takes one, or one word twice."""
    for group in _ALTERNATIVES:
        if len(found := [name for name in block.written if name in group]) > 1:
            raise KlartextError(Wording("NC212", "written_twice", word=" ".join(dict.fromkeys(found))))


def _flag(block: Block, name: str) -> None:
    match name:
        case "FMAX":
            block.rapid = True
        case "DR+" | "DR-":
            block.direction = 1 if name == "DR+" else -1
        case "RL" | "RR":
            block.side = name
        case "FAUTO" | "AUTO":
            block.feed_of_tool = True
        case "MAX":
            block.rapid = True
        case _:
            if name != "F":
                raise KlartextError(Wording("NC210", "word_needs_value", word=name))


def _value(block: Block, name: str, value: float, how: PositionMode) -> None:
    if name in _AXES:
        if name in block.axes:
            raise KlartextError(Wording("NC212", "written_twice", word=name))
        block.axes[name] = value, how
    elif name in ("PR", "PA"):
        block.polar[name] = value, how
    elif name in _VECTORS:
        block.vectors[name] = value
    elif name == "F":
        if not 0.0 <= value <= MAX_FEED:
            raise KlartextError(Wording("NC215", "feed_out_of_range", most=MAX_FEED))
        block.feed = value
    elif name == "R":
        # R0 switches cutter compensation off; other values are the radius of a circle.
        if value == 0.0:
            block.side = "R0"
        else:
            block.radius = value
    elif name == "M":
        if value != int(value) or not 0 <= value < 10000:
            raise KlartextError(Wording("NC210", "m_not_function", value=value))
        block.m.append((int(value), {}))
    else:
        raise KlartextError(Wording("NC211", "unknown_word_with_value", word=name, value=value))


def check_path_words(function: str, block: Block) -> None:
    """Refuse words that a path function has no use for."""
    only(block.written, _OF_ALL_PATHS | _OF_PATHS[function], function)
    if block.rapid and function[0] == "C":
        raise KlartextError(Wording("NC220", "arc_at_rapid", function=function))


# Polar coordinates


def polar_end(control: HeidenhainControl, block: Block, *, circle: bool) -> dict[str, AxisWord]:
    """Return the axes of LP, CP or CTP including those of the plane, in the units of the program."""
    pole = _pole(control)
    first, second = (control.plane_axis + 1) % 3, (control.plane_axis + 2) % 3
    here = control.programmed_position - pole
    radius = math.hypot(here[first], here[second])
    angle = math.degrees(math.atan2(here[second], here[first]))
    if "PR" in block.polar and not circle:
        value, how = block.polar["PR"]
        value *= control.length_unit
        radius = radius + value if how is PositionMode.INCREMENTAL else value
    if "PA" in block.polar:
        value, how = block.polar["PA"]
        angle = angle + value if how is PositionMode.INCREMENTAL else value
    if abs(angle) > 360.0 * MAX_TURNS or not abs(radius) < MAX_POSITION:
        raise KlartextError(Wording("NC215", "polar_coordinates_no_machine"))
    end = {
        "XYZ"[first]: (pole[first] + radius * math.cos(math.radians(angle))) / control.length_unit,
        "XYZ"[second]: (pole[second] + radius * math.sin(math.radians(angle))) / control.length_unit,
    }
    if end.keys() & block.axes.keys():
        raise KlartextError(Wording("NC210", "polar_coordinates_axes_plane_block"))
    return {**block.axes, **{name: (value, PositionMode.ABSOLUTE) for name, value in end.items()}}


def _pole(control: HeidenhainControl) -> Floats:
    if control.pole is None:
        raise KlartextError(Wording("NC210", "no_cc_before"))
    return control.pole


# Circles


def circle_of(control: HeidenhainControl, head: str, block: Block) -> Circle:
    """Return the circle of a C, CP, CR, CT or CTP block."""
    if head in ("CT", "CTP"):
        return partial(_tangential, control)
    if not block.direction:
        raise KlartextError(Wording("NC210", "needs_dr_dr", head=head))
    clockwise = block.direction < 0
    if head == "CR":
        if block.radius is None:
            raise KlartextError(Wording("NC210", "cr_needs_radius"))
        radius = block.radius * control.length_unit
        if abs(radius) > MAX_POSITION:
            raise KlartextError(Wording("NC215", "radius_no_machine"))
        return lambda start, end: arcs.by_radius(start, end, radius, control.plane_axis, clockwise, 0)
    pole = _pole(control).copy()
    turns = 0
    angle, how = block.polar.get("PA", (0.0, PositionMode.ABSOLUTE))
    if head == "CP" and how is PositionMode.INCREMENTAL:
        if angle and (angle > 0.0) != (block.direction > 0):
            raise KlartextError(Wording("NC210", "ipa_dr_different_signs"))
        turns = max(math.ceil(round(abs(angle) / 360.0, 9)) - 1, 0)
    return lambda start, end: arcs.by_centre(start, end, pole, control.plane_axis, clockwise, turns)


def _tangential(control: HeidenhainControl, start: Floats, end: Floats) -> arcs.Arc:
    """Return the circle that continues in the direction of the last motion."""
    arc = arcs.tangential(start, end, control.end_direction(), control.plane_axis, 0)
    if arc is None:
        raise arcs.ArcError(Wording("NC320", "end_lies_straight_ahead"))
    return arc
