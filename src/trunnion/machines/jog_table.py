"""What a machine's definition means at the machine: where tool and table go when an axis is jogged.

In:     a ``Machine``.
Out:    records of numbers and words that a person beside the machine compares with the iron.
Units:  mm and degrees.

The iron is moved here, part and tool each by the axes that carry it, with quaternions. ``trunnion.machines.forward``
and ``trunnion.machines.inverse`` are derived in other ways, and nothing is shared with them, so that a wrong sense or
order anywhere shows as a difference: from the machine, or from what programs are written by.
"""

import math
from collections.abc import Iterable, Iterator, Mapping
from itertools import product
from typing import Annotated, Final

from trunnion.machines.machine import Axis, Machine, Mount, PositiveDirection, PreferredSign, Vector
from trunnion.messages import Wording, phrase
from trunnion.records import dataclass
from trunnion.results import Figure

#: How far slides and rotary axes are jogged, mm and degrees.
STEP: Final = 10.0

#: Rotary values of the poses, as far as they are inside the limits.
_VALUES: Final = (-90.0, -30.0, 30.0, 90.0)

_X: Final[Vector] = (1.0, 0.0, 0.0)
_Y: Final[Vector] = (0.0, 1.0, 0.0)
_Z: Final[Vector] = (0.0, 0.0, 1.0)


@dataclass(frozen=True, slots=True)
class AxisJog:
    """An axis, and what happens when it is jogged in its positive direction, all others at zero.

    axis       as the definition has it
    step       how far it is jogged, mm or degrees
    tool_said  where the tool goes as seen from the workpiece; ``tool`` in English
    iron_said  what the table or the head does, in directions of the machine; ``iron`` in English
    tool_step  of a slide: where the tip goes in workpiece coordinates, mm; of a rotary axis: the tool axis after it
    iron_turn  of a rotary axis: the direction about which the iron turns right-handed; of a slide: where it goes
    """

    axis: Axis
    step: float
    tool_said: Annotated[Wording, Figure("tool", take=str)]
    iron_said: Annotated[Wording, Figure("iron", take=str)]
    tool_step: Vector
    iron_turn: Vector

    @property
    def tool(self) -> str:
        """Where the tool goes as seen from the workpiece, in words."""
        return str(self.tool_said)

    @property
    def iron(self) -> str:
        """What the table or the head does, in words."""
        return str(self.iron_said)


@dataclass(frozen=True, slots=True)
class RotaryPose:
    """The tool at values of the rotary axes, slides at zero.

    values       axis -> degrees, in the order in which programs write them
    tool_axis    from tip to holder, unit vector in workpiece coordinates
    gauge_point  of the spindle, mm in workpiece coordinates
    in_travel    the values are inside the limits
    """

    values: Mapping[str, float]
    tool_axis: Vector
    gauge_point: Vector
    in_travel: bool


@dataclass(frozen=True, slots=True)
class JogTable:
    """What the definition of a machine means.

    order         names of the axes from the workpiece to the tool, with ``bed`` between those of both sides
    axes          in that order
    poses         single rotary axes first, then both
    same_axis     two poses with the same tool axis; none where there are fewer than two rotary axes
    prefers       which of two such poses cuts begin in; ``preferred`` in English
    """

    order: tuple[str, ...]
    axes: tuple[AxisJog, ...]
    poses: tuple[RotaryPose, ...]
    same_axis: tuple[RotaryPose, ...]
    prefers: Annotated[Wording, Figure("preferred", take=str)]

    @property
    def preferred(self) -> str:
        """Which of two poses with one tool axis cuts begin in, in words."""
        return str(self.prefers)


def order_of_axes(machine: Machine) -> tuple[str, ...]:
    """Return the names of the axes from the workpiece to the tool, with ``bed`` between those of both sides."""
    order = [axis.name for axis in machine.own_axes]
    bed = next((k for k, axis in enumerate(machine.own_axes) if axis.mount is Mount.TOOL), len(order))
    return (*order[:bed], "bed", *order[bed:])


def jog_table(machine: Machine) -> JogTable:
    """Return what the definition of a machine means."""
    poses = tuple(rotary_pose(machine, values) for values in _pose_values(machine))
    same_axis: tuple[RotaryPose, ...] = ()
    if len(machine.own_rotary) == 2:
        tilted = next((pose for pose in reversed(poses) if pose.in_travel), poses[-1])
        same_axis = tilted, rotary_pose(machine, _other_values(machine, tilted.values))
    return JogTable(
        order=order_of_axes(machine),
        axes=tuple(_jog(machine, axis) for axis in machine.own_axes),
        poses=poses,
        same_axis=same_axis,
        prefers=_preferred(machine),
    )


def rotary_pose(machine: Machine, values: Mapping[str, float]) -> RotaryPose:
    """Return the tool at values of the rotary axes, degrees, by their names, and of slides, mm, if they are named.

    Axes that are not named are at zero.
    """
    by_name = {axis.name: axis for axis in machine.own_axes}
    inside = all(by_name[name].low <= value <= by_name[name].high for name, value in values.items())
    zero = machine.workpiece_zero or (0.0, 0.0, 0.0)
    return RotaryPose(
        values=dict(values),
        tool_axis=_in_workpiece(machine, machine.spindle_direction, values, turn_only=True),
        gauge_point=_minus(_in_workpiece(machine, machine.spindle_point, values), zero),
        in_travel=inside,
    )


def named_direction(vector: Vector) -> str:
    """Return a direction as ``+X``, or as numbers where it is along none of the axes."""
    length = math.hypot(*vector)
    unit = tuple(part / length for part in vector)
    for name, part in zip("XYZ", unit, strict=True):
        if abs(abs(part) - 1.0) < 1e-6:
            return f"{'+' if part > 0 else '-'}{name}"
    return f"({', '.join(number_text(part, 3) for part in unit)})"


def number_text(value: float, decimals: int) -> str:
    """Return a number without zeros at its end, and without a sign at zero."""
    return f"{round(value, decimals) + 0.0:.{decimals}f}".rstrip("0").rstrip(".") if decimals else f"{value:.0f}"


def _jog(machine: Machine, axis: Axis) -> AxisJog:
    carried = phrase("the_table" if axis.mount is Mount.PART else "the_head")
    if not axis.is_rotary:
        at_zero = _in_workpiece(machine, machine.spindle_point, {})
        step = _minus(_in_workpiece(machine, machine.spindle_point, {axis.name: STEP}), at_zero)
        iron = _iron_step(axis)
        return AxisJog(
            axis,
            STEP,
            phrase("tool_goes", step=STEP, direction=named_direction(step)),
            phrase("iron_goes", carried=carried, step=STEP, direction=named_direction(iron)),
            step,
            iron,
        )
    tool_axis = _in_workpiece(machine, machine.spindle_direction, {axis.name: STEP}, turn_only=True)
    turn = _iron_step(axis)
    return AxisJog(
        axis,
        STEP,
        _tool_words(machine, tool_axis),
        phrase("iron_turns", carried=carried, turn=_turn_words(machine, axis, turn)),
        tool_axis,
        turn,
    )


def _iron_step(axis: Axis) -> Vector:
    """Where the iron goes as the displayed value grows, or about what it turns right-handed.

    Growing values move the tool as seen from the workpiece (ISO 841): a head that way, a table the other way.
    """
    along = axis.direction if axis.positive is PositiveDirection.STANDARD else _negative(axis.direction)
    return along if axis.mount is Mount.TOOL else _negative(along)


def _tool_words(machine: Machine, tool_axis: Vector) -> Wording:
    if _length(_minus(tool_axis, machine.spindle_direction)) < 1e-6:
        return phrase("tool_axis_stays", direction=_vector_text(tool_axis))
    leans = _minus(tool_axis, _times(machine.spindle_direction, _dot(tool_axis, machine.spindle_direction)))
    return phrase("tool_axis_leans", direction=_vector_text(tool_axis), to=named_direction(leans))


def _turn_words(machine: Machine, axis: Axis, turn: Vector) -> Wording:
    """How a table or a head turns: seen from outside, and where what can be seen goes."""
    largest = max(range(3), key=lambda k: (round(abs(axis.direction[k]), 6), k))
    seen_from = axis.direction if axis.direction[largest] > 0 else _negative(axis.direction)
    sense = "turn_counter_clockwise" if _dot(turn, seen_from) > 0 else "turn_clockwise"
    return phrase(sense, step=STEP, side=named_direction(seen_from), then=_seen_motion(machine, axis, turn))


def _seen_motion(machine: Machine, axis: Axis, turn: Vector) -> Wording:
    """Where what can be seen of a turning table or head goes."""
    if axis.mount is Mount.TOOL:
        swing = _cross(turn, _negative(machine.spindle_direction))
        if _length(swing) > 0.1:
            return phrase("tip_swings", direction=named_direction(swing))
        return phrase("tip_stays", mark=_swing_of_mark(turn, phrase("at_head")))
    rising = _cross(_Z, turn)
    if _length(rising) < 0.1:
        return _swing_of_mark(turn, phrase("at_table"))
    return phrase("edges_go", rises=named_direction(rising), falls=named_direction(_negative(rising)))


def _swing_of_mark(turn: Vector, what: Wording) -> Wording:
    """Where a mark goes that is not on the axis: at +X, or at +Y of what turns about X."""
    mark = _X if _length(_cross(turn, _X)) > 0.1 else _Y
    return phrase("mark_goes", side=named_direction(mark), what=what, direction=named_direction(_cross(turn, mark)))


def _preferred(machine: Machine) -> Wording:
    told = tuple(
        phrase("sign_positive" if axis.prefer is PreferredSign.POSITIVE else "sign_negative", axis=axis.name)
        for axis in machine.own_axes
        if axis.is_rotary and axis.prefer is not PreferredSign.EITHER
    )
    return phrase("prefers_signs", signs=told) if told else phrase("prefers_neither")


def _pose_values(machine: Machine) -> Iterator[dict[str, float]]:
    """Values of the rotary axes that can be seen at the machine: one axis turned, then both."""
    axes = [machine.axes[k] for k in machine.rotary_words]
    rest = {axis.name: 0.0 if axis.low <= 0.0 <= axis.high else axis.home for axis in axes}
    inside = [[value for value in _VALUES if axis.low <= value <= axis.high] or [axis.low, axis.high] for axis in axes]
    for axis, values in zip(axes, inside, strict=True):
        yield from ({**rest, axis.name: value} for value in values)
    if len(axes) < 2:
        return
    small, large = [value for value in inside[0] if abs(value) < 60.0] or inside[0], inside[1][::2]
    yield from ({axes[0].name: one, axes[1].name: other} for one, other in product(small, large))


def _other_values(machine: Machine, values: Mapping[str, float]) -> dict[str, float]:
    """Return the other rotary position with the same tool axis.

    The second axis reaches the same height over the first one's direction at two angles, mirrored about the angle of
    the highest; the first axis turns the rest of the way.
    """
    first, second = (axis for axis in machine.axes if axis.is_rotary)
    one, two, spindle = _tool_step(first), _tool_step(second), machine.spindle_direction
    across = _minus(spindle, _times(two, _dot(two, spindle)))
    highest = math.degrees(math.atan2(_dot(one, _cross(two, spindle)), _dot(one, across)))
    other = 2.0 * highest - values[second.name]
    there, here = _turned(spindle, two, other), _turned(spindle, two, values[second.name])
    turn = math.atan2(_dot(one, _cross(there, here)), _dot(there, here) - _dot(one, there) * _dot(one, here))
    found = {first.name: values[first.name] + math.degrees(turn), second.name: other}
    return {name: _within_a_turn(found[name]) for name in values}


def _within_a_turn(degrees: float) -> float:
    value = round(degrees - 360.0 * math.ceil((degrees - 180.0) / 360.0), 9)
    return 180.0 if value == -180.0 else value + 0.0


def _in_workpiece(machine: Machine, vector: Vector, values: Mapping[str, float], *, turn_only: bool = False) -> Vector:
    """Return a point of the spindle, or with ``turn_only`` a direction, as seen from the workpiece, in machine
    directions.

    The head goes first, from the tool to the bed; then everything turns with the table back to where the part was.
    """
    head: Iterable[Axis] = [axis for axis in reversed(machine.own_axes) if axis.mount is Mount.TOOL]
    table: Iterable[Axis] = [axis for axis in reversed(machine.own_axes) if axis.mount is Mount.PART]
    for axis in (*head, *table):
        value = values.get(axis.name, 0.0)
        if axis.is_rotary:
            point = (0.0, 0.0, 0.0) if turn_only else axis.point
            vector = _plus(_turned(_minus(vector, point), _tool_step(axis), value), point)
        elif not turn_only:
            vector = _plus(vector, _times(_tool_step(axis), value))
    return vector


def _tool_step(axis: Axis) -> Vector:
    """Where the tool goes as seen from the workpiece, or about what it turns right-handed, as the value grows."""
    iron = _iron_step(axis)
    return iron if axis.mount is Mount.TOOL else _negative(iron)


def _turned(vector: Vector, about: Vector, degrees: float) -> Vector:
    """Return a vector turned right-handed by a quaternion: q v q*."""
    half = math.radians(degrees) / 2.0
    w, axis = math.cos(half), _times(about, math.sin(half))
    twice = _times(_cross(axis, vector), 2.0)
    return _plus(_plus(vector, _times(twice, w)), _cross(axis, twice))


def _vector_text(vector: Vector) -> str:
    return f"({', '.join(number_text(part, 3) for part in vector)})"


def _plus(a: Vector, b: Vector) -> Vector:
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def _minus(a: Vector, b: Vector) -> Vector:
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def _times(a: Vector, factor: float) -> Vector:
    return a[0] * factor, a[1] * factor, a[2] * factor


def _negative(a: Vector) -> Vector:
    return _times(a, -1.0)


def _dot(a: Vector, b: Vector) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _cross(a: Vector, b: Vector) -> Vector:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def _length(a: Vector) -> float:
    return math.sqrt(_dot(a, a))
