"""How the tool goes from one operation of a program to the next: home, retracted, or at a height above all.

In:     a program and its tools.
Out:    for each motion that ends an operation, the way to the next one; heights along the tool.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from itertools import accumulate
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.controls.template import Value
from trunnion.controls.vocabulary import DRAW_BACK, FOLLOWING, LEAVING
from trunnion.machines import Machine, slide_positions
from trunnion.model.motion import MachiningMode, Motion
from trunnion.model.toolpath import CutterComp, CycleOff, CycleOn, Kind
from trunnion.output.coordinates.approach_leg import height_at_home
from trunnion.output.coordinates.extents import highest_point
from trunnion.output.coordinates.rotary_angles import rotary_counts
from trunnion.output.program import Program
from trunnion.output.tool_calls import ToolCalls

#: Planes whose numbers differ by less are one.
_SAME_PLANE: Final = 1e-9


class Passage(StrEnum):
    """The way to the next operation.

    HOME       all axes go home
    RETRACT    the axis along the spindle goes home, where the rotary axes turn
    CLEARANCE  the tool leaves along its axis to a height above all operations; everything else stays as it is
    """

    HOME = "home"
    RETRACT = "retract"
    CLEARANCE = "clearance"


@dataclass(frozen=True, slots=True)
class Way:
    """The way from one operation to the next.

    keeps_rotary  the rotary axes do not return
    distance      how far the tool leaves along its axis, mm, with CLEARANCE
    """

    passage: Passage = Passage.HOME
    keeps_rotary: bool = False
    distance: float = 0.0

    def end_template(self, suffix: str) -> str:
        """Return the template that begins the way from an operation; empty for none."""
        beginnings = {Passage.HOME: "operation_end", Passage.RETRACT: LEAVING, Passage.CLEARANCE: ""}
        beginning = beginnings[self.passage]
        return f"{beginning}_{suffix}" if beginning else ""

    def values(self, values: Mapping[str, Value]) -> dict[str, Value]:
        """Return the values of templates, without the rotary axes that do not return home."""
        stay: dict[str, Value] = {"primary_returns": None, "secondary_returns": None} if self.keeps_rotary else {}
        return {**values, **stay}


class Passages:
    """Knows the ways between the operations of a program."""

    def __init__(self, program: Program, tools: ToolCalls) -> None:
        self._program, self._tools = program, tools
        self._operation = list(accumulate(int(motion.starts_operation) for motion in program.motions))
        self._heights: dict[bytes, float] = {}

    def way(self, number: int) -> Way:
        """Return the way from a motion, by its index, that ends an operation; that of the last one leads home."""
        motions = self._program.motions
        if number + 1 >= len(motions):
            return Way()
        before, motion = motions[number], motions[number + 1]
        setting = self._program.effective_setting("keep_rotary", before.operation)
        same_tool = self._same_tool(number)
        keeps = setting == "on" or (setting == "same_tool" and same_tool)
        passage = self._passage(before, motion) if same_tool else Passage.HOME
        same_pose = (keeps or passage is Passage.CLEARANCE) and self._same_pose(before, motion)
        keeps = keeps and same_pose and not self._plane_stays_on(before, motion)
        distance = self._distance(before, motion) if passage is Passage.CLEARANCE and same_pose else None
        if passage is Passage.CLEARANCE and distance is None:
            passage = Passage.RETRACT
        return Way(passage, keeps, distance or 0.0)

    def height(self, axis: Floats) -> float:
        """Return the height above all operations along a tool axis (3,), from the program's zero, mm."""
        clearance = float(self._program.effective_setting("operation_clearance") or 0.0)
        key = axis.tobytes()
        if key not in self._heights:
            self._heights[key] = highest_point(self._program.motions, axis)
        return self._heights[key] + clearance

    def first_leg(self, motion: Motion) -> Floats | None:
        """Return where the first leg of an approach under TCP ends, (3,) mm, straight above its first point along the
        tool, where axes move one group after the other: with that along the spindle at home, or above all operations.
        """
        if motion.mode is not MachiningMode.TCP or not self.in_turn(motion):
            return None
        tip, axis = motion.operation.moves.tip[0], motion.operation.moves.axis[0]
        home = height_at_home(self._program.machine, tip, motion.rotary[0])
        return self.above(motion, self.height(axis) if home is None else home)

    def in_turn(self, motion: Motion) -> bool:
        """Whether the axes move one group after the other in the first approach of an operation."""
        return self._program.effective_setting("first_approach", motion.operation) == "in_turn"

    def above(self, motion: Motion, height: float | None = None) -> Floats:
        """Return the place above the first point of a motion, along the tool, at a height or that above all, (3,)."""
        tip, axis = motion.operation.moves.tip[0], motion.operation.moves.axis[0]
        raised = (self.height(axis) if height is None else height) - float(tip @ axis)
        return np.asarray(tip + max(raised, 0.0) * axis)

    def _same_tool(self, number: int) -> bool:
        """Whether the next operation has the tool and the length of a motion's."""
        operation = self._operation[number]
        return self._tools.calls[operation - 1][:2] == self._tools.calls[operation][:2]

    def _same_pose(self, before: Motion, motion: Motion) -> bool:
        """Whether the rotary axes end one motion as they begin the other, as they are printed."""
        counts = []
        for each, row in ((before, -1), (motion, 0)):
            rounding = self._program.control.number_formats(each.three_axis)["angle"].decimals
            angles = ((axis, each.rotary[[row], column]) for _, axis, column in self._program.rotary_words())
            counts.append([int(rotary_counts(self._program.machine, k, angle, rounding)[0]) for k, angle in angles])
        return counts[0] == counts[1]

    def _plane_stays_on(self, *motions: Motion) -> bool:
        """Whether a plane of the rotary position is only left by the rotary axes at home."""
        suffixes = (self._program.template_suffix(motion) for motion in motions)
        return any(f"{DRAW_BACK}_{suffix}" in self._program.control.templates for suffix in suffixes)

    def _passage(self, before: Motion, motion: Motion) -> Passage:
        """Return the way that the settings ask for, where the control has it."""
        program, templates = self._program, self._program.control.templates
        asked = Passage(program.effective_setting("same_tool", before.operation) or Passage.HOME)
        if {FOLLOWING, f"{LEAVING}_{program.template_suffix(before)}"} - templates.keys():
            return Passage.HOME
        if program.effective_setting("restart") == "on":  # every operation can be entered
            return Passage.HOME
        stops = program.effective_setting("stop_between") == "on"
        differs = program.template_suffix(before) != program.template_suffix(motion)
        return Passage.RETRACT if asked is Passage.CLEARANCE and (stops or differs) else asked

    def _distance(self, before: Motion, motion: Motion) -> float | None:
        """Return how far the tool leaves along its axis to the height above all; None if it must retract instead."""
        ends, begins = before.operation, motion.operation
        if before.mode is MachiningMode.WITHOUT_TCP or not _same_plane(before, motion) or before.ends_in_hole:
            return None
        if any(isinstance(event, CycleOn | CycleOff) for each in (ends, begins) for event in each.events):
            return None
        if any(isinstance(event, CutterComp) and event.row == len(ends.moves) for event in ends.events):
            return None
        if begins.moves.kind[0] != Kind.RAPID or not self._same_settings(before, motion):
            return None
        axis, tips = ends.moves.axis[-1], (ends.moves.tip[-1], begins.moves.tip[0])
        height = self.height(axis)
        raised = np.array([tip + (height - float(tip @ axis)) * axis for tip in tips])
        return height - float(tips[0] @ axis) if _within_travel(self._program.machine, raised, motion.rotary) else None

    def _same_settings(self, before: Motion, motion: Motion) -> bool:
        """Whether nothing changes that the approach of an operation states: work offset, tolerances, modes."""
        given = [self._program.effective_settings(each.operation) for each in (before, motion)]
        stated = [
            (each.operation.intol, each.operation.outtol, self._program.method_of(each.operation))
            for each in (before, motion)
        ]
        return given[0] == given[1] and stated[0] == stated[1]


def _same_plane(before: Motion, motion: Motion) -> bool:
    if before.plane is None or motion.plane is None:
        return before.plane is motion.plane
    apart = np.abs(before.plane.matrix() - motion.plane.matrix()).max()
    return bool(apart <= _SAME_PLANE) and before.plane.origin == motion.plane.origin


def _within_travel(machine: Machine, tips: Floats, rotary: Floats) -> bool:
    """Whether the linear axes reach tips (n, 3), as far as that is known."""
    if machine.workpiece_zero is None or machine.tool_length is None:
        return True
    joints = slide_positions(machine, tips, np.repeat(rotary[:1], len(tips), axis=0))
    return all(
        bool(((joints[:, k] >= machine.axes[k].low) & (joints[:, k] <= machine.axes[k].high)).all())
        for k in machine.linear
    )
