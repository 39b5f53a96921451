"""The values that templates may print: settings, tool, spindle, plane, home position, machining times.

A value is None where there is none: a template leaves out the line that names it.
"""

import math
import secrets
from collections.abc import Mapping
from itertools import accumulate
from string import ascii_uppercase
from typing import Final

import numpy as np

from trunnion.controls.family_writer import FamilyWriter
from trunnion.controls.template import PrintedText, Value
from trunnion.controls.vocabulary import OFFSETS_DIFFER, PLANES_USED, PROJECTED_ANGLES, TCP_USED
from trunnion.machines import Axis, inverse
from trunnion.model.apt_cutter import apt_cutter
from trunnion.model.motion import MachiningMode, Motion
from trunnion.model.toolpath import Operation, Sense, SpindleOn
from trunnion.output.coordinates.extents import cut_extents
from trunnion.output.coordinates.rotary_angles import rotary_counts
from trunnion.output.program import Program
from trunnion.output.tool_calls import LoadedTool, ToolCalls, edge_setting
from trunnion.planning import operation_seconds
from trunnion.wording import format_duration

#: The value of the setting ``blank`` for a block form around all cuts.
EXTENTS: Final = "extents"
STOCK: Final = "stock"
NO_BLANK: Final = "off"

#: Letters that begin the text that stands for a machining time while it is not known, and digits behind them: the
#: number of the operation, from 1, or 0 for the whole program. The times are those of the proof; none is longer.
TIME_TOKEN_LETTERS: Final = 7
TIME_TOKEN_DIGITS: Final = 7

#: What follows a time on a machine whose definition does not state how fast all its axes go at rapid.
_RAPIDS_LEFT_OUT: Final = " + rapids"

#: Times of an operation; where a template prints that of the program too, that one says what both leave out.
_OWN_TIMES: Final = frozenset({"time", "time_shown"})

_NO_POSITION: Final = (None, None, None)


class TemplateValues:
    """Computes the values of templates with the ``tools`` of the program; keeps machining times, which take long."""

    def __init__(self, program: Program) -> None:
        self._program = program
        self._family: FamilyWriter = program.control.family
        self._seconds: list[float] = []
        self.tools = ToolCalls(program)
        modes = {motion.mode for motion in program.motions}
        offsets = {program.effective_setting("work_offset", motion.operation) for motion in program.motions}
        self._prints_times = prints_times(program)
        printed = [{name for name, _ in template.fields()} for template in program.control.templates.values()]
        self._total_follows = all({f"total_{name}" for name in names & _OWN_TIMES} <= names for names in printed)
        self._operation_numbers = list(accumulate(int(motion.starts_operation) for motion in program.motions))
        self._used = {
            PLANES_USED: "on" if MachiningMode.TILTED in modes else None,
            TCP_USED: "on" if MachiningMode.TCP in modes else None,
            OFFSETS_DIFFER: "on" if len(offsets) > 1 else None,
            PROJECTED_ANGLES: program.control.projected_angles,
        }

    def values(self, motion: Motion, number: int, loaded: LoadedTool, spindle: SpindleOn | None) -> dict[str, Value]:
        """Return the values for an operation, or for the part of it that is one motion.

        motion   in coordinates of the workpiece
        number   index of the motion in the program; -1 for the last
        loaded   the tool before the operation
        spindle  at the first row; None if it has not been started

        Raises ``InputError`` if there is nothing to call the tool by.
        """
        operation, machine = motion.operation, self._program.machine_of(motion)
        position = self._operation_numbers[number]
        following = self.tools.next_call(position)
        found: dict[str, Value] = {
            **self._setting_values(motion),
            **self._rotary_values(motion),
            **self._time_values(position),
            **self._plane_values(motion),
            **spindle_values(self._program, spindle),
            **self._home_values(),
            **self._tool_values(operation),
            **dict(zip(("zero_x", "zero_y", "zero_z"), machine.workpiece_zero or _NO_POSITION, strict=True)),
            "subprogram": None,
            "machine": machine.name,
            "unit_word": (unit_word := self._program.control.unit_words.get(self._program.control.units)),
            "entry_unit": unit_word if self._program.effective_setting("restart") == "on" else None,
            "gauge_length": machine.tool_length,
            "operation": operation.name,
            "operation_number": position,
            "next_tool": following,
            "intol": operation.intol,
            "outtol": operation.outtol,
            "tool": (tool := self.tools.call(operation, loaded)),
            "length_number": str((register := self.tools.length_register(operation, loaded)) or tool),
        }
        if "edge" in found:
            found["edge"] = edge_setting(self._program, operation, register)
        return {name: self._escaped(value) for name, value in found.items()}

    def _escaped(self, value: Value) -> Value:
        if not isinstance(value, str):
            return value
        text = self._family.escape_comment(self._program.spelled(value))
        return PrintedText(text) if isinstance(value, PrintedText) else text

    def _setting_values(self, motion: Motion) -> dict[str, Value]:
        """Return settings, with the values that the family makes of them and the defaults that depend on the
        operation.
        """
        control, operation = self._program.control, motion.operation
        values: dict[str, Value] = {**control.settings, **self._program.settings_of(operation)}
        if values.get("blank") == EXTENTS:
            values["blank"] = self._extents()
        elif values.get("blank") in (STOCK, NO_BLANK):  # stock that is known has come as its corners
            values["blank"] = ""
        plane = None if motion.plane is None else motion.plane.matrix()
        values |= self._used
        values |= self._family.template_values(self._in_program_unit(values), plane)
        if not control.tcp:  # a machine without TCP has no words that switch it
            values |= dict.fromkeys(("tcp_on", "tcp_off"))
        if not values.get("tolerance"):
            given = operation.intol is not None and operation.outtol is not None
            values["tolerance"] = (
                (operation.intol or 0.0) + (operation.outtol or 0.0) if given else values.get("fallback_tolerance")
            )
        if not values.get("three_axis_tolerance"):
            values["three_axis_tolerance"] = values["tolerance"]
        method = self._program.method_of(operation)
        for setting in control.method_defaults:
            values[setting] = values[setting] or control.default_for_method(setting, method)
        return values

    def _in_program_unit(self, values: Mapping[str, Value]) -> dict[str, Value]:
        """Return settings for the family, of which those that are texts of lengths are in the unit of the program."""
        control, found = self._program.control, dict(values)
        for name in control.length_settings if control.unit != 1.0 else ():
            numbers = [float(part) / control.unit for part in str(values.get(name) or "").split(",") if part]
            found[name] = ",".join(f"{number:.5f}".rstrip("0").rstrip(".") for number in numbers)
        return found

    def _extents(self) -> str:
        """Return the corners of the block form around all cuts; empty if nothing is cut."""
        box = cut_extents(self._program.motions)
        return "" if box is None else ",".join(f"{value:g}" for value in np.concatenate(box).tolist())

    def _rotary_values(self, motion: Motion) -> dict[str, Value]:
        """Name and word of both rotary axes at the first row."""
        machine, words = self._program.machine, {word.key: word for word in self._program.block_words(motion)}
        values: dict[str, Value] = dict.fromkeys(("primary", "primary_word", "secondary", "secondary_word"))
        for key, axis, column in self._program.rotary_words():
            word = words[key]
            count = int(rotary_counts(machine, axis, motion.rotary[:1, column], word.format.decimals)[0])
            values[key] = machine.axes[axis].name
            values[f"{key}_word"] = word.letter + word.format.text_of_count(count)
        return values

    def time_of(self, operation: int) -> Value:
        """Return the machining time of an operation, by its number, with what it leaves out; None where no template
        prints any.
        """
        return self._time_text(operation) if self._prints_times else None

    def _time_values(self, operation: int) -> dict[str, Value]:
        """Machining times of the operation and of the program; computed only if a template prints them."""
        names = "time", "total_time", "time_shown", "total_time_shown"
        if not self._prints_times:
            return dict.fromkeys(names)
        own, total = self._time_text(operation, noted=not self._total_follows), self._time_text(0)
        shown = (own, total) if self._program.effective_setting("times") == "on" else (None, None)
        return dict(zip(names, (own, total, *shown), strict=True))

    def operation_times(self) -> list[str | None]:
        """Return the machining time of each operation, or what stands for it; None where the program has no times."""
        count = sum(motion.starts_operation for motion in self._program.motions)
        shown = prints_times(self._program)
        return [self._time_text(number) if shown else None for number in range(1, count + 1)]

    def _time_text(self, number: int, *, noted: bool = True) -> PrintedText:
        """Return the machining time of an operation, counted from 1, or of the program (0); or what stands for it.

        ``noted``: it says where it counts no rapids.
        """
        is_left_out = noted and any(axis.rapid is None for axis in self._program.machine.own_axes)
        left_out = self._family.escape_comment(_RAPIDS_LEFT_OUT) if is_left_out else ""
        if self._program.time_token:
            return PrintedText(self._program.time_token + str(number).zfill(TIME_TOKEN_DIGITS) + left_out)
        self._seconds = self._seconds or estimated_seconds(self._program)
        seconds = self._seconds[number - 1] if number else sum(self._seconds)
        return PrintedText(format_duration(seconds, colons=self._family.escape_comment(":") == ":") + left_out)

    def _plane_values(self, motion: Motion) -> dict[str, Value]:
        """Return the origin of a tilted plane, and which of the two rotary positions the machine takes there.

        ``plane_side`` is -1 for the position with the lower value of the rotary axis farther from the workpiece, and 1
        for the other; ``plane_sign`` is the sign of that axis. At zero it is the one for which the axis has travel.
        """
        names = "plane_x", "plane_y", "plane_z"
        if motion.plane is None:
            return dict.fromkeys((*names, "plane_side", "plane_sign"))
        last = self._program.machine.last_rotary
        moves, column = motion.operation.moves, self._program.machine.rotary[last]
        solutions = inverse(self._program.machine, moves.tip[:1], moves.axis[:1]).joints[:, 0, column]
        distance = solutions - motion.rotary[0, last]
        distance -= 360.0 * np.rint(distance / 360.0)
        lower = np.argmin(np.abs(distance)) == np.argmin(solutions)
        sign = self._solution_sign(motion)
        origin = dict(zip(names, motion.plane.origin, strict=True))
        return {**origin, "plane_side": "-1" if lower else "1", "plane_sign": sign}

    def _solution_sign(self, motion: Motion) -> str:
        """Return the sign of the rotary axis farther from the workpiece, as its position is printed."""
        number_format = self._program.control.number_formats(motion.three_axis)["angle"]
        last = self._program.machine.last_rotary
        angle, axis = number_format.rounded(float(motion.rotary[0, last])), self._program.machine.rotary[last]
        angle -= 360.0 * math.ceil((angle - 180.0) / 360.0)  # as controls find it: within a turn
        has_travel_above = self._program.machine.axes[axis].high >= 10.0**-number_format.decimals
        return "+" if angle > 0.0 or (angle == 0.0 and has_travel_above) else "-"

    def _home_values(self) -> dict[str, Value]:
        """Return the home position, for templates that move in machine coordinates."""
        machine = self._program.machine
        linear = {axis.name: self._printed_home(axis) for axis in machine.axes if not axis.is_rotary}
        rotary: dict[str, Value] = {}
        for key, column in (("primary", machine.primary), ("secondary", machine.secondary)):
            axis = machine.axes[column]
            rotary[f"{key}_returns"] = None if axis.is_missing else axis.name
            rotary[f"{key}_home"] = None if axis.is_missing else axis.home
        return {**{f"home_{name.lower()}": linear.get(name) for name in "XYZ"}, **rotary}

    def _printed_home(self, axis: Axis) -> float:
        """Return the home of a slide as a program can say it: in inches a last digit off it, but never beyond
        a limit.
        """
        if self._program.control.unit == 1.0:
            return axis.home
        number_format = self._program.control.number_formats(three_axis=True)["coordinate"]
        home = number_format.rounded(axis.home)
        if home > axis.high:
            return home - number_format.digit
        return home + number_format.digit if home < axis.low else home

    def _tool_values(self, operation: Operation) -> dict[str, Value]:
        tool = operation.tool
        ball = tool.kind == "MILL" and tool.diameter > 0 and abs(2 * tool.corner_radius - tool.diameter) < 1e-6
        known = tool.kind != "UNKNOWN"
        return {
            "tool_name": tool.name or None,
            "tool_type": self._program.control.tool_types["BALL" if ball else tool.kind] if known else None,
            "tool_diameter": tool.diameter if known else None,
            "tool_length": tool.length if known else None,
            "tool_corner_radius": tool.corner_radius if known else None,
            "tool_corner_e": apt_cutter(tool).e if known else None,
            "tool_corner_f": apt_cutter(tool).f if known else None,
            "tool_flute_length": tool.flute_length or None,
            "tool_taper_angle": tool.taper_angle or None,
            "tool_tip_angle": tool.tip_angle or None,
            "tool_upper_radius": tool.upper_radius or None,
            "tool_extension": tool.extension or None,
            "tool_set_length": tool.set_length or None,
            "tool_holder": tool.holder or None,
        }


def plain_text(program: Program, text: str) -> str:
    """Return a text of a CL file in letters of the program.

    It ends neither a line, nor a comment of a template, nor a text in quotation marks.
    """
    return program.control.family.escape_comment(program.spelled(text)).replace('"', "'")


def prints_times(program: Program) -> bool:
    """Return whether a template of the control, or the list of operations, has machining times."""
    setting = program.effective_setting("times")
    templates = program.control.templates.values()
    fields = {name for template in templates for name, _ in template.fields()}
    fields |= {name for template in templates for name in template.record_values}
    wanted = {"time", "total_time"} | ({"time_shown", "total_time_shown"} if setting == "on" else set())
    listed = program.effective_setting("operation_list") == "on"
    return setting != "off" and (listed or bool(fields & wanted))


def new_time_token() -> str:
    """Return letters for the tokens of one program, which no text of a CL file or definition can foresee."""
    return "".join(secrets.choice(ascii_uppercase) for _ in range(TIME_TOKEN_LETTERS))


def estimated_seconds(program: Program) -> list[float]:
    """Return the seconds of each operation as planned, from its first point to its last; cycles take no time."""
    seconds: list[float] = []
    for motion in program.motions:
        own = operation_seconds(program.machine, motion)
        if motion.starts_operation:
            seconds.append(own)
        else:
            seconds[-1] += own
    return seconds


def spindle_values(program: Program, event: SpindleOn | None) -> dict[str, Value]:
    """Return speed and M code of a spindle start; None without one.

    ``new_speed`` is for lines that are written only where the speed changes.
    """
    if event is None:
        return dict.fromkeys(("spindle_speed", "new_speed", "spindle_code"))
    code = "spindle_clockwise" if event.sense is Sense.CLW else "spindle_counterclockwise"
    return {
        "spindle_speed": event.rpm,
        "new_speed": event.rpm,
        "spindle_code": str(program.control.codes.get(code, "")),
    }
