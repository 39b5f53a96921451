"""A machine tool as data: its axes in the order in which they carry each other, and a spindle.

Everything is given in ONE machine frame, with all axes at zero. Order: from the workpiece to the tool.
Units: mm and degrees; rapids in mm/min and deg/min, accelerations in mm/s^2 and deg/s^2, jerks in mm/s^3 and deg/s^3,
as the definition keys say.
Limits, home and all axis values are those that the control displays and the program contains.
"""

from collections.abc import Mapping
from dataclasses import field, replace
from enum import StrEnum
from typing import Annotated, Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.definitions import LocatedValue, Table
from trunnion.definitions.marked_values import MarkedValue
from trunnion.machines.bodies import MachineBody
from trunnion.machines.bodies import Vector as Vector
from trunnion.records import dataclass
from trunnion.results import NOT_DATA, Figure, to_data

#: Greatest component along the tool of a slide that is across it.
_ACROSS = 1e-9


class AxisKind(StrEnum):
    """How a joint moves."""

    LINEAR = "linear"
    ROTARY = "rotary"


class Mount(StrEnum):
    """What an axis carries: the part (a table) or the tool (a head, a ram)."""

    PART = "part"
    TOOL = "tool"


class PositiveDirection(StrEnum):
    """The direction in which a displayed value grows.

    STANDARD is ISO 841: growing values move the TOOL, as seen from the workpiece, along or right-handed about
    ``direction``, no matter which of the two really moves. REVERSED is the other way.
    """

    STANDARD = "standard"
    REVERSED = "reversed"


class PreferredSign(StrEnum):
    """The sign of a rotary axis in the pose that a machine usually works in."""

    POSITIVE = "positive"
    NEGATIVE = "negative"
    EITHER = "either"


class AngleOutput(StrEnum):
    """The range in which the values of an endless axis are written: one turn, or none (NONE), so that turns add up."""

    POSITIVE = "0..360"
    SYMMETRIC = "-180..180"
    NONE = "none"


@dataclass(frozen=True, slots=True)
class Axis:
    """One joint of the chain.

    mount           whether it carries the part or the tool
    direction       unit vector, machine frame, all axes at zero
    point           a point on the axis of a rotary joint, mm, machine frame, all axes at zero; unused for linear axes
    low, high       travel in displayed values, mm or deg; -inf and inf where endless or not stated
    rapid           mm/min or deg/min; None where not stated
    acceleration    mm/s^2 or deg/s^2; None where not stated
    jerk            mm/s^3 or deg/s^3; None where not stated
    home            displayed value, mm or deg
    home_is_stated  the definition states it; else it is assumed to be 0
    is_missing      the machine has no such axis: it turns the tool about itself, by nothing but 0, and nobody sees it
    """

    name: str
    kind: AxisKind
    mount: Annotated[Mount, Figure(), Figure("carries", is_extra=True)]
    direction: Vector
    point: Vector = (0.0, 0.0, 0.0)
    low: float = -np.inf
    high: float = np.inf
    endless: bool = False
    output: AngleOutput = AngleOutput.NONE
    rapid: float | None = None
    acceleration: float | None = None
    jerk: float | None = None
    home: float = 0.0
    positive: PositiveDirection = PositiveDirection.STANDARD
    prefer: PreferredSign = PreferredSign.EITHER
    home_is_stated: bool = True
    is_missing: Annotated[bool, NOT_DATA] = False

    @property
    @Figure(is_extra=True)
    def limits(self) -> tuple[float, float]:
        """Low and high end of its travel."""
        return self.low, self.high

    @property
    @Figure(is_extra=True)
    def is_rotary(self) -> bool:
        """Whether the joint turns."""
        return self.kind is AxisKind.ROTARY

    @property
    def has_limits(self) -> bool:
        """Whether an end of its travel is stated."""
        return not self.endless and bool(np.isfinite(self.low) or np.isfinite(self.high))

    @property
    def sense(self) -> float:
        """1.0 if growing values move the tool along or about ``direction``, -1.0 if they move it the other way."""
        return 1.0 if self.positive is PositiveDirection.STANDARD else -1.0

    @property
    def preferred_sign(self) -> float:
        """1.0 or -1.0: the sign of the axis in the preferred pose; 0.0 for either."""
        return {PreferredSign.POSITIVE: 1.0, PreferredSign.NEGATIVE: -1.0, PreferredSign.EITHER: 0.0}[self.prefer]

    @property
    def display_low(self) -> float:
        """Lower end of the turn in which the axis is displayed, deg; NaN if its turns add up."""
        return {AngleOutput.POSITIVE: 0.0, AngleOutput.SYMMETRIC: -180.0, AngleOutput.NONE: np.nan}[self.output]

    def displayed(self, values: Floats, decimals: int) -> Floats:
        """Return values, rounded, as the machine displays them: within one turn where it has only that."""
        rounded = np.round(values, decimals)
        if not self.endless or self.output is AngleOutput.NONE:
            return rounded
        return np.round(self.display_low + np.mod(rounded - self.display_low, 360.0), decimals) + 0.0

    def displayed_range(self, low: float, high: float, decimals: int) -> tuple[float, float]:
        """Return what the machine displays at both ends of the way from ``low`` to ``high``.

        The first is the greater one where the way passes the end of the turn; a turn or more is all of it.
        """
        if self.endless and self.output is not AngleOutput.NONE and high - low >= 360.0 - 10.0**-decimals:
            return self.display_low, self.display_low + 360.0
        first, last = self.displayed(np.array([low, high]), decimals).tolist()
        return first, last


@dataclass(frozen=True, slots=True)
class MachineFacts:
    """What a definition states about a machine besides its motion; None where it does not.

    spindle_gears_rpm  the least and the greatest speed of each gear
    table_centre_mm    machine frame, all axes at zero
    """

    spindle_min_rpm: float | None = None
    spindle_gears_rpm: tuple[tuple[float, float], ...] = ()
    spindle_power_kw: float | None = None
    spindle_torque_nm: float | None = None
    spindle_acceleration_rpm_s: float | None = None
    tool_change_s: float | None = None
    tool_holder: str | None = None
    tool_pockets: int | None = None
    table_size_mm: tuple[float, float] | None = None
    table_diameter_mm: float | None = None
    table_centre_mm: tuple[float, float] | None = None
    table_load_kg: float | None = None


def tool_key(tool: str) -> str:
    """Return the number or name of a tool as it is looked up: ``01`` is 1, and quotes do not count."""
    name = tool.strip().strip('"')
    return str(int(name)) if name.isascii() and name.isdecimal() else name


def _no_control() -> Table:
    return Table(LocatedValue({}, "", 0), "control")


#: What the data of a list of machines says of an axis.
_OF_AXIS: Final = ("name", "is_rotary", "carries", "endless", "limits")


def _data_of_axes(axes: tuple[Axis, ...]) -> object:
    return to_data([axis for axis in axes if not axis.is_missing], only=_OF_AXIS)


@dataclass(frozen=True, slots=True, eq=False)
class Machine:
    """A machine: three linear axes and two rotary axes, FROM THE WORKPIECE TO THE TOOL.

    A rotary axis that it has not is there as well, as a missing one (``machines.missing_axes``), so that all machines
    have five columns. What people and programs see goes by ``own_axes`` and ``own_rotary``.

    spindle_direction   unit vector from tool tip to holder, all axes at zero
    spindle_point       gauge point (where tool lengths begin), mm, all axes at zero
    workpiece_zero      workpiece zero in the machine frame, all axes at zero, mm; None if it is not known
    tool_length         of the tool in the spindle, gauge point to tip, mm; None if it is not known, and counts as 0
    tool_lengths        those of single tools by number or name; all others have ``tool_length``
    length_sources      what has told a length that nobody stated, by tools
    in_force            the tool and the work offset that it is set up for, in words; empty: no other differs
    zeros               the workpiece zeros of single work offsets by their ``Run.work_offset``; all others have
                        ``workpiece_zero``
    control             the ``[control]`` table of the definition, unread
    files               definition files that the machine comes from
    cl_words            words of the shop's own in its CL files, and the statements of CL files that they are
    cl_word_places      file and line of each in the definition
    bodies              the iron on its links, as the simulation sees it; nothing else looks at it
    spindle_point_is_stated  the definition states the gauge point; else it is assumed to be in the machine's zero
    unmeasured          values that the definition marks as still to be measured or entered, with their places
    assumed             values that it marks as assumptions, with their places
    inherited           measured values that it has from another machine, which it extends, with their places
    demands             what a proof must stand on: names of ``loading.DEMANDS``
    home_at             axes that must be at home before a ``tool_change`` and the ``end``; silent: all linear ones
    """

    key: str
    name: str
    axes: Annotated[tuple[Axis, ...], Figure(take=_data_of_axes)]
    spindle_direction: Vector = (0.0, 0.0, 1.0)
    spindle_point: Vector = (0.0, 0.0, 0.0)
    workpiece_zero: Vector | None = None
    tool_length: float | None = None
    tool_lengths: Annotated[Mapping[str, float], NOT_DATA] = field(default_factory=dict)
    length_sources: Annotated[Mapping[str, str], NOT_DATA] = field(default_factory=dict)
    in_force: Annotated[str, NOT_DATA] = ""
    zeros: Annotated[Mapping[int, Vector], NOT_DATA] = field(default_factory=dict)
    spindle_max_rpm: float | None = None
    description: str = ""
    facts: MachineFacts = MachineFacts()
    control: Table = field(default_factory=_no_control)
    files: tuple[str, ...] = ()
    cl_words: Mapping[str, str] = field(default_factory=dict)
    cl_word_places: Annotated[Mapping[str, tuple[str, int]], NOT_DATA] = field(default_factory=dict)
    bodies: tuple[MachineBody, ...] = ()
    spindle_point_is_stated: bool = True
    unmeasured: tuple[MarkedValue, ...] = ()
    assumed: tuple[MarkedValue, ...] = ()
    inherited: tuple[MarkedValue, ...] = ()
    demands: tuple[str, ...] = ()
    home_at: Mapping[str, tuple[str, ...]] = field(default_factory=dict)

    @property
    def nobody_measured(self) -> tuple[MarkedValue, ...]:
        """What counts although nobody has measured it: marked values, those of another machine, and what is assumed if
        unstated.
        """
        homes = (
            MarkedValue(f"{axis.name} home_{'deg' if axis.is_rotary else 'mm'}", "", 0, "", "axis")
            for axis in self.own_axes
            if not axis.home_is_stated
        )
        gauge = MarkedValue("spindle gauge_point_mm", "", 0, "", "spindle")
        marked = (*self.unmeasured, *self.assumed)
        told = {value.name for value in marked} | {f"{value.of} shape" for value in marked if value.table == "body"}
        others = (value for value in self.inherited if value.name not in told)
        return (*marked, *others, *homes, *(() if self.spindle_point_is_stated else (gauge,)))

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the axes, in chain order: the columns of every joint array."""
        return tuple(axis.name for axis in self.axes)

    @property
    def own_axes(self) -> tuple[Axis, ...]:
        """The axes that the machine has, in chain order."""
        return tuple(axis for axis in self.axes if not axis.is_missing)

    @property
    def own_columns(self) -> tuple[tuple[int, Axis], ...]:
        """The axes that the machine has, each with its column."""
        return tuple((k, axis) for k, axis in enumerate(self.axes) if not axis.is_missing)

    @property
    def own_rotary(self) -> tuple[int, ...]:
        """Columns of the rotary axes that the machine has, in chain order: none, one or two."""
        return tuple(k for k in self.rotary if not self.axes[k].is_missing)

    @property
    def rotary(self) -> tuple[int, int]:
        """Columns of the two rotary axes; the first is the one next to the workpiece."""
        first, second = (k for k, axis in enumerate(self.axes) if axis.is_rotary)
        return first, second

    @property
    def linear(self) -> tuple[int, int, int]:
        """Columns of the three linear axes, in chain order."""
        first, second, third = (k for k, axis in enumerate(self.axes) if not axis.is_rotary)
        return first, second, third

    @property
    def primary(self) -> int:
        """Column of the primary rotary axis (the fourth): the one on the base, or of the head on mixed machines."""
        first, second = self.rotary
        if self.axes[second].is_missing:
            return first
        both_in_table = self.axes[second].mount is Mount.PART
        mixed = self.axes[first].mount is Mount.PART and self.axes[second].mount is Mount.TOOL
        return second if both_in_table or mixed else first

    @property
    def secondary(self) -> int:
        """Column of the secondary rotary axis (the fifth): the one that the primary carries."""
        first, second = self.rotary
        return first if self.primary == second else second

    @property
    def last_rotary(self) -> int:
        """Which of ``rotary`` (0 or 1) is the one farther from the workpiece, of those that the machine has."""
        return max(len(self.own_rotary) - 1, 0)

    @property
    def rotary_words(self) -> tuple[int, ...]:
        """Columns of the rotary axes that it has, in the order of their words: the primary one first."""
        return tuple(k for k in (self.primary, self.secondary) if not self.axes[k].is_missing)

    @property
    def has_rotary_head(self) -> bool:
        """Whether a rotary axis carries the tool, so that the direction of the tool length changes with it."""
        return any(axis.is_rotary and axis.mount is Mount.TOOL for axis in self.own_axes)

    @property
    def has_single_values(self) -> bool:
        """Whether a tool has a length, or a work offset a zero, of its own."""
        return bool(self.tool_lengths or self.zeros)

    def set_up_for(self, tool: str, work_offset: int) -> "Machine":
        """Return the machine with a tool in the spindle and a work offset in force, as programs call them."""
        if not self.has_single_values:
            return self
        length = self.tool_lengths.get(tool_key(tool), self.tool_length)
        zero = self.zeros.get(work_offset, self.workpiece_zero)
        return replace(self, tool_length=length, workpiece_zero=zero, tool_lengths={}, zeros={}, length_sources={})

    def is_placed(self, column: int) -> bool:
        """Whether it is known where an axis stands when the tip is at a point of the workpiece.

        Linear axes need the workpiece zero for that, and those along the tool its length; all of them where a head
        turns it.
        """
        if self.axes[column].is_rotary:
            return True
        return self.workpiece_zero is not None and (self.tool_length is not None or not self.depends_on_length(column))

    def depends_on_length(self, column: int) -> bool:
        """Whether an axis stands elsewhere with a longer tool, the tip at the same point of the workpiece."""
        axis = self.axes[column]
        along = float(np.dot(axis.direction, self.spindle_direction))
        return not axis.is_rotary and (self.has_rotary_head or abs(along) > _ACROSS)

    @property
    def limits(self) -> Floats:
        """Lowest and highest displayed values, (5, 2) float64, mm or deg, infinite where endless or not stated."""
        return np.array([(axis.low, axis.high) for axis in self.axes])

    @property
    def home(self) -> Floats:
        """Home position, (5,) float64, mm or deg."""
        return np.array([axis.home for axis in self.axes])

    def column(self, name: str) -> int:
        """Column of the axis of this name; KeyError if there is none."""
        try:
            return self.names.index(name)
        except ValueError:
            raise KeyError(name) from None

    def axis(self, name: str) -> Axis:
        """Return the axis of this name; KeyError if there is none."""
        return self.axes[self.column(name)]
