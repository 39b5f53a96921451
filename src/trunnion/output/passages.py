"""How the tool goes from one operation of a program to the next: home, retracted, or at a height above all.

In:     a program and its tools.
Out:    for each motion that ends an operation, the way to the next one; heights along the tool.
"""

from collections.abc import Iterator, Mapping
from enum import StrEnum
from itertools import accumulate, pairwise
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.controls.template import Value
from trunnion.controls.vocabulary import DRAW_BACK, FOLLOWING, LEAVING
from trunnion.machines import Machine, slide_positions
from trunnion.messages import Wording, phrase
from trunnion.model.motion import Motion
from trunnion.model.toolpath import CutterComp, CycleOff, CycleOn, Kind
from trunnion.output.coordinates.approach_leg import height_at_home
from trunnion.output.coordinates.extents import highest_point
from trunnion.output.coordinates.rotary_angles import rotary_counts
from trunnion.output.program import Program
from trunnion.output.tool_calls import ToolCalls
from trunnion.records import dataclass

#: Planes whose numbers differ by less are one.
_SAME_PLANE: Final = 1e-9

#: A leg along the tool that is shorter is none, mm; what is tried of one that the travel has no room for.
_NO_LEG: Final = 0.01
_SHARES: Final = (2.0, 4.0, 8.0, 16.0)


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
    hindrance     why it is not the way that the settings ask for: a phrase; None: it is
    """

    passage: Passage = Passage.HOME
    keeps_rotary: bool = False
    distance: float = 0.0
    hindrance: Wording | None = None

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

    def __init__(self, program: Program, tools: ToolCalls, *, subprograms: bool = False) -> None:
        """Take a program, with a subprogram for each operation or none."""
        self._program, self._tools, self._subprograms = program, tools, subprograms
        self._operation = list(accumulate(int(motion.starts_operation) for motion in program.motions))
        self._heights: dict[bytes, float] = {}

    def ways(self) -> Iterator[tuple[Motion, Motion, Way]]:
        """Yield the last motion of each operation, the first one of the next, and the way between them."""
        for number, (before, motion) in enumerate(pairwise(self._program.motions)):
            if motion.starts_operation:
                yield before, motion, self.way(number)

    def way(self, number: int) -> Way:
        """Return the way from a motion, by its index, that ends an operation; that of the last one leads home."""
        motions = self._program.motions
        if number + 1 >= len(motions):
            return Way()
        before, motion = motions[number], motions[number + 1]
        setting = self._program.effective_setting("keep_rotary", before.operation)
        same_tool = self._same_tool(number)
        keeps = setting == "on" or (setting == "same_tool" and same_tool)
        passage = Passage(self._program.effective_setting("same_tool", before.operation) or Passage.HOME)
        hindrance = self._enters_from_home(before) if same_tool and passage is not Passage.HOME else None
        if self._subprograms:
            return Way(hindrance=hindrance)
        if not same_tool or hindrance is not None:
            passage = Passage.HOME
        keeps = keeps and self._same_pose(before, motion) and not self._plane_stays_on(before, motion)
        if passage is not Passage.CLEARANCE:
            return Way(passage, keeps, hindrance=hindrance)
        if (hindrance := self._hindrance(before, motion)) is not None:
            return Way(Passage.RETRACT, keeps, hindrance=hindrance)
        axis = before.operation.moves.axis[-1]
        return Way(passage, keeps, self.height(axis) - float(before.operation.moves.tip[-1] @ axis))

    def height(self, axis: Floats) -> float:
        """Return the height above all operations along a tool axis (3,), from the program's zero, mm."""
        return self.highest(axis) + float(self._program.effective_setting("operation_clearance") or 0.0)

    def highest(self, axis: Floats) -> float:
        """Return how high the operations come along a tool axis (3,), from the program's zero, mm."""
        key = axis.tobytes()
        if key not in self._heights:
            self._heights[key] = highest_point(self._program.motions, axis)
        return self._heights[key]

    def first_leg(self, motion: Motion) -> Floats | None:
        """Return where the first leg of an approach under TCP ends, (3,) mm, straight above its first point along the
        tool, where axes move one group after the other: with that along the spindle at home, or above all operations,
        or as high as the travel lets it. None where they need not, or cannot.
        """
        if not motion.mode.holds_tips or not self.in_turn(motion):
            return None
        machine, tip, axis = (
            self._program.machine_of(motion),
            motion.operation.moves.tip[0],
            motion.operation.moves.axis[0],
        )
        home, at = height_at_home(machine, tip, motion.rotary[0]), float(tip @ axis)
        heights = [*(() if home is None else (home,)), self.height(axis), self.highest(axis)]
        heights += [at + (self.height(axis) - at) / share for share in _SHARES]
        raised = (self.above(motion, height) for height in heights if height > at + _NO_LEG)
        return next((place for place in raised if not _beyond_travel(machine, place[None], motion.rotary)), None)

    def in_turn(self, motion: Motion) -> bool:
        """Whether the axes move one group after the other from home to an operation, and behind turns within it."""
        return self._program.effective_setting("first_approach", motion.operation) == "in_turn"

    def above(self, motion: Motion, height: float | None = None) -> Floats:
        """Return the place above the first point of a motion, along the tool, at a height or that above all, (3,)."""
        tip, axis = motion.operation.moves.tip[0], motion.operation.moves.axis[0]
        raised = (self.height(axis) if height is None else height) - float(tip @ axis)
        return np.asarray(tip + max(raised, 0.0) * axis)

    def starts_again(self, number: int) -> bool:
        """Whether an operation has the tool of the one before, which ends where it begins: behind the way home."""
        if number <= 0 or self._subprograms or self._program.effective_setting("restart") == "on":
            return False
        return self._same_tool(number - 1)

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

    def _enters_from_home(self, before: Motion) -> Wording | None:
        """Return why the next operation begins at home, whatever the settings ask for; None: it need not."""
        program, templates = self._program, self._program.control.templates
        if program.effective_setting("restart") == "on":  # every operation can be entered
            return phrase("way_restart")
        if self._subprograms:  # a subprogram depends on nothing before it
            return phrase("way_subprograms")
        needed = (FOLLOWING, f"{LEAVING}_{program.template_suffix(before)}")
        missing = tuple(name for name in needed if name not in templates)
        return phrase("way_templates", names=missing) if missing else None

    def _hindrance(self, before: Motion, motion: Motion) -> Wording | None:
        """Return why the tool cannot go on above all operations; None: it can."""
        program, ends, begins = self._program, before.operation, motion.operation
        if program.effective_setting("stop_between") == "on":
            return phrase("way_stop")
        if before.mode.goes_straight or motion.mode.goes_straight:
            return phrase("way_without_tcp")
        if program.template_suffix(before) != program.template_suffix(motion):
            return phrase("way_other_mode")
        if not self._same_pose(before, motion):
            return phrase("way_turns")
        if not _same_plane(before, motion):
            return phrase("way_other_plane")
        if before.ends_in_hole or any(isinstance(e, CycleOn | CycleOff) for e in (*ends.events, *begins.events)):
            return phrase("way_holes")
        if any(isinstance(event, CutterComp) and event.row == len(ends.moves) for event in ends.events):
            return phrase("way_compensation")
        if begins.moves.kind[0] != Kind.RAPID:
            return phrase("way_cuts")
        if changed := self._changed(before, motion):
            return phrase("way_settings", names=changed)
        axis, tips = ends.moves.axis[-1], (ends.moves.tip[-1], begins.moves.tip[0])
        height = self.height(axis)
        raised = np.array([tip + (height - float(tip @ axis)) * axis for tip in tips])
        beyond = _beyond_travel(program.machine, raised, motion.rotary)
        return phrase("way_travel", axes=beyond) if beyond else None

    def _changed(self, before: Motion, motion: Motion) -> tuple[str, ...]:
        """Return what changes of all that the approach of an operation states: work offset, tolerances, modes."""
        ends, begins = before.operation, motion.operation
        one, other = (self._program.effective_settings(each) for each in (ends, begins))
        found = [name for name in one | other if one.get(name) != other.get(name)]
        found += ["INTOL"] if ends.intol != begins.intol else []
        found += ["OUTTOL"] if ends.outtol != begins.outtol else []
        if "method" not in found and self._program.method_of(ends) != self._program.method_of(begins):
            found.append("method")
        return tuple(found)


def _same_plane(before: Motion, motion: Motion) -> bool:
    if before.plane is None or motion.plane is None:
        return before.plane is motion.plane
    apart = np.abs(before.plane.matrix() - motion.plane.matrix()).max()
    return bool(apart <= _SAME_PLANE) and before.plane.origin == motion.plane.origin


def _beyond_travel(machine: Machine, tips: Floats, rotary: Floats) -> tuple[str, ...]:
    """Return the linear axes that do not reach tips (n, 3), as far as that is known."""
    if machine.workpiece_zero is None or machine.tool_length is None:
        return ()
    joints = slide_positions(machine, tips, np.repeat(rotary[:1], len(tips), axis=0))
    axes = ((machine.axes[k], joints[:, k]) for k in machine.linear)
    return tuple(axis.name for axis, at in axes if not bool(((at >= axis.low) & (at <= axis.high)).all()))
