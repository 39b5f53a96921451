"""What templates may print in an operation: settings, tool, spindle, plane, home, times.

In:     the program, the motion, and what the spindle holds and does.
Out:    a name and a value each; None where there is none, and the line that names it is left out.
"""

from dataclasses import dataclass

import numpy as np

from trunnion.controls.family_writer import FamilyWriter
from trunnion.controls.template import Value
from trunnion.errors import InputError, Problem
from trunnion.machines import inverse
from trunnion.machines.motion_time import format_duration
from trunnion.model.motion import Motion
from trunnion.model.toolpath import LoadTool, Sense, SpindleOn
from trunnion.output.coordinates.extents import extents
from trunnion.output.program import Program, effective_setting, motion_block_words, rotary_counts
from trunnion.planning import operation_seconds

_NO_POSITION = (None, None, None)

#: The setting ``blank`` of controls with a block form: the box round all that is cut.
EXTENTS = "extents"


@dataclass(frozen=True, slots=True)
class LoadedTool:
    """The tool in the spindle: how the program calls it, and its name; both empty before the first."""

    call: str = ""
    name: str = ""


class TemplateValues:
    """Works the values out; keeps the times of operations, which take long."""

    def __init__(self, program: Program) -> None:
        self._program = program
        self._family: FamilyWriter = program.control.family
        self._second_angle_ranges: list[float] = []

    def values(self, motion: Motion, number: int, loaded: LoadedTool, spindle: SpindleOn | None) -> dict[str, Value]:
        """What templates may print in this operation.

        Parameters
        ----------
        motion
            Of the operation, in coordinates of the workpiece.
        number
            Of the motion among those of the program.
        held
            The tool before the operation.
        spindle
            What it does at the first row; None: nobody said so.

        Raises
        ------
        InputError
            When nothing says which tool it is.
        """
        program, operation = self._program, motion.operation
        machine, control, tool = program.machine, program.control, operation.tool
        values: dict[str, Value] = {**control.settings, **program.settings}
        if values.get("blank") == EXTENTS:
            values["blank"] = self._cut_extents()
        values |= self._family.template_values(values, None if motion.plane is None else motion.plane.matrix())
        if not values.get("tolerance"):
            given = operation.intol is not None and operation.outtol is not None
            values["tolerance"] = (
                (operation.intol or 0.0) + (operation.outtol or 0.0) if given else values.get("fallback_tolerance")
            )
        for setting in control.method_defaults:
            values[setting] = values[setting] or control.default_for_method(setting, str(values.get("method", "")))
        ball = tool.kind == "MILL" and tool.diameter > 0 and abs(2 * tool.corner_radius - tool.diameter) < 1e-6
        known = tool.kind != "UNKNOWN"
        formats = {word.key: word for word in motion_block_words(program, motion)}
        rotary = {}
        for word, column in (("primary", machine.primary), ("secondary", machine.secondary)):
            angle = motion.rotary[:1, machine.rotary.index(column)]
            count = int(rotary_counts(machine, column, angle, formats[word].format.decimals)[0])
            rotary[word] = machine.axes[column].name
            rotary[f"{word}_word"] = formats[word].letter + formats[word].format.text_of_count(count)
        found: dict[str, Value] = {
            **values,
            **rotary,
            **self._machining_times(number),
            **self._plane_values(motion),
            **spindle_values(program, spindle),
            "subprogram": None,
            "machine": machine.name,
            **self._home_values(),
            "operation": operation.name,
            "tool": self._tool_call(motion, loaded),
            "tool_name": tool.name or None,
            "tool_type": control.tool_types["BALL" if ball else tool.kind] if known else None,
            "tool_diameter": tool.diameter if known else None,
            "tool_length": tool.length if known else None,
            "tool_corner_radius": tool.corner_radius if known else None,
            "gauge_length": machine.tool_length,
            **dict(zip(("zero_x", "zero_y", "zero_z"), machine.workpiece_zero or _NO_POSITION, strict=True)),
            "intol": operation.intol,
            "outtol": operation.outtol,
        }
        return {
            name: self._family.escape_comment(value) if isinstance(value, str) else value
            for name, value in found.items()
        }

    def _cut_extents(self) -> str:
        """The corners of the block form round all that is cut; empty where nothing is."""
        found = extents(self._program.motions)
        return "" if found is None else ",".join(f"{value:g}" for value in np.concatenate(found).tolist())

    def _machining_times(self, number: int) -> dict[str, Value]:
        """What the operation and all of them take, as people read it; worked out only where a template prints it."""
        fields = {name for template in self._program.control.templates.values() for name, _ in template.fields()}
        if not fields & {"time", "total_time"}:
            return {"time": None, "total_time": None}
        if not self._second_angle_ranges:
            self._second_angle_ranges = [
                operation_seconds(self._program.machine, each) for each in self._program.motions
            ]
        return {
            "time": format_duration(self._second_angle_ranges[number]),
            "total_time": format_duration(sum(self._second_angle_ranges)),
        }

    def _tool_call(self, motion: Motion, loaded: LoadedTool) -> str:
        """The tool as ``T=`` takes it: the run's setting, the number of LOAD/TOOL, or else the tool's name."""
        operation = motion.operation
        loads = [event for event in operation.events if isinstance(event, LoadTool)]
        number, name = effective_setting(self._program, "tool"), operation.tool.name
        if loaded.call and not loads and name == loaded.name:
            return loaded.call
        if name and (effective_setting(self._program, "tool_call") == "name" or not (number or loads)):
            return self._family.tool_call(0, name, by_name=True)
        if number:
            return number
        if loads:
            return self._family.tool_call(loads[0].number, "", by_name=False)
        what = f"operation {operation.name} has no LOAD/TOOL, and its tool has no name"
        raise InputError(Problem(self._program.file, operation.line, what, "write --set tool=NUMBER"))

    def _plane_values(self, motion: Motion) -> dict[str, Value]:
        """What templates of all families may print of a tilted plane: its origin and the side of the machine.

        The side is -1 or 1: of the two solutions that stand the tool on the plane, the one with the lower or the higher
        value of the rotary axis farther from the workpiece. Where there is only one, either word means it. The sign is
        that of this axis: "+" or "-".
        """
        names = "plane_x", "plane_y", "plane_z"
        if motion.plane is None:
            return dict.fromkeys((*names, "plane_side", "plane_sign"))
        moves, column = motion.operation.moves, self._program.machine.rotary[1]
        both = inverse(self._program.machine, moves.tip[:1], moves.axis[:1]).joints[:, 0, column]
        apart = both - motion.rotary[0, 1]
        apart -= 360.0 * np.rint(apart / 360.0)
        lower = np.argmin(np.abs(apart)) == np.argmin(both)
        side = "-1" if lower else "1"
        sign = "-" if motion.rotary[0, 1] < 0.0 else "+"
        return {**dict(zip(names, motion.plane.origin, strict=True)), "plane_side": side, "plane_sign": sign}

    def _home_values(self) -> dict[str, Value]:
        """The machine's home, for templates that say it in positions of the machine."""
        machine = self._program.machine
        axes = machine.axes
        slides = {axis.name: axis.home for axis in axes if not axis.is_rotary}
        return {
            **{f"home_{name.lower()}": slides.get(name) for name in "XYZ"},
            "primary_home": axes[machine.primary].home,
            "secondary_home": axes[machine.secondary].home,
        }


def spindle_values(program: Program, event: SpindleOn | None) -> dict[str, Value]:
    """Speed, also where it is not the one that was said last, and the M code of the sense; None without an event."""
    if event is None:
        return dict.fromkeys(("spindle_speed", "new_speed", "spindle_code"))
    code = "spindle_clockwise" if event.sense is Sense.CLW else "spindle_counterclockwise"
    return {
        "spindle_speed": event.rpm,
        "new_speed": event.rpm,
        "spindle_code": str(program.control.codes.get(code, "")),
    }
