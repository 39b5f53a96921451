"""Writes a program from its first line to its last.

Every operation has the same sequence: operation start, tool change, approach with the rotary axes placed first, motion
with its events, operation end. An operation with several tool axes is several motions, each in a plane of its own.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import BinaryIO

import numpy as np

from trunnion.arrays import Floats
from trunnion.controls.template import Value
from trunnion.controls.vocabulary import AGAIN, DRAW_BACK, FOLLOWING
from trunnion.controls.words import WordRangeError
from trunnion.machines import SweptPart
from trunnion.model.motion import Motion
from trunnion.model.operation_start import OperationStart
from trunnion.model.template_passage import TemplatePassage
from trunnion.model.toolpath import CycleOff, CycleOn, Kind, Operation, SpindleOn, Stop
from trunnion.output.blocks.motion_blocks import MotionBlockWriter
from trunnion.output.compensation_entries import entries_at_control
from trunnion.output.coordinates.plane_from_pose import tip_after_turn
from trunnion.output.coordinates.turn_distance import is_clear_of_turn, part_of
from trunnion.output.event_writer import EventWriter
from trunnion.output.operation_list import operation_texts
from trunnion.output.passages import Passage, Passages, Way
from trunnion.output.printed_planes import needs_plane, with_printed_planes
from trunnion.output.program import Program
from trunnion.output.subprograms import SubprogramFiles, SubprogramOutput
from trunnion.output.template_printing import TemplatePrinting
from trunnion.output.template_values import TemplateValues
from trunnion.output.template_writer import TemplateWriter
from trunnion.output.tool_calls import LoadedTool, tool_text
from trunnion.planning.retracts.tool_retract import with_row_along_tool


def write_program(
    program: Program,
    sink: BinaryIO,
    progress: Callable[[int], None] | None = None,
    subprograms: SubprogramOutput | None = None,
    passages: list[TemplatePassage] | None = None,
) -> tuple[OperationStart, ...]:
    """Write a whole program, and return where its operations begin.

    program      checked by ``check_program``
    sink         takes bytes in order
    progress     called with the number of rows written since the last call
    subprograms  write a main program to ``sink`` that calls a subprogram for each operation. None: everything is in one
                 file
    passages     takes where texts of the user's templates stand

    Raises ``InputError`` if a value that the program needs is missing.

    Raises ``WordRangeError`` if a number is beyond the limits of its word's format; an ``InputError`` with the line of
    the CL file.
    """
    writer = _ProgramWriter(program, sink, progress or (lambda _: None), subprograms)
    starts = writer.write()
    if passages is not None:
        passages[:] = writer.passages()
    return starts


class _ProgramWriter:
    """Writes one program, operation by operation."""

    def __init__(
        self, program: Program, sink: BinaryIO, progress: Callable[[int], None], subprograms: SubprogramOutput | None
    ) -> None:
        self._program = program = with_printed_planes(program)
        self._control = program.control
        self._blocks = MotionBlockWriter(program, sink, progress)
        self._template_values = TemplateValues(program)
        self._templates = TemplateWriter(self._blocks, TemplatePrinting(program, self._template_values))
        self._events = EventWriter(program, self._blocks, self._templates)
        self._notices = self._comments(program.notices)
        self._loaded_tool = LoadedTool()
        self._called_tool = ""  # in the present file
        self._tool_calls = self._template_values.tools.calls
        self._operation = 0
        self._edge = ""
        self._calls_each = program.effective_setting("restart") == "on"
        self._passages = Passages(program, self._template_values.tools, subprograms=subprograms is not None)
        self._way = Way()  # to the present operation
        self._previous_motion: Motion | None = None
        self._part: SweptPart | None = None
        self._files: SubprogramFiles | None = None
        if subprograms is not None:
            naming = program.control.subprograms
            assert naming is not None, "the control can call no subprograms"
            operations = [motion.operation.name for motion in program.motions if motion.starts_operation]
            number = program.effective_setting("program")
            self._files = SubprogramFiles(subprograms, naming, sink, number, operations)

    def write(self) -> tuple[OperationStart, ...]:
        """Write the program, and return where its operations begin."""
        motions = self._program.motions
        values = self._values(motions[0], 0)
        entered = self._comments(entries_at_control(self._program))
        head = [*self._notices, *entered, *self._tool_list(values), *self._operation_list()]
        self._templates.write("program_start", values, motions[0], head)
        for k, motion in enumerate(motions):
            ends_program = k + 1 == len(motions)
            ends_operation = ends_program or motions[k + 1].starts_operation
            if motion.starts_operation:
                self._begin_operation_file(motion, k)
            try:
                self._write_motion(motion, k, ends_operation)
            except WordRangeError as error:
                raise error.at(self._program.file_of(motion.operation), motion.operation.line) from None
            if ends_operation:
                self._switch_coolant_off(motion, k, ends_program)
                self._way = self._passages.way(k)
                if "after_operation" in self._control.templates:
                    self._templates.write_place("after_operation", self._values(motion, k), motion)
                self._end_operation_file(motion, k)
                if not ends_program:
                    self._stop_between(motion, k)
        self._templates.write("program_end", self._values(motions[-1], -1), motions[-1])
        names = {} if self._files is None else self._files.names
        starts = self._blocks.writer.operation_starts
        return tuple(OperationStart(names.get(sink, ""), line, number) for sink, line, number in starts)

    def passages(self) -> list[TemplatePassage]:
        """Where texts of the user's templates stand, once all is written."""
        names = {} if self._files is None else self._files.names
        return [
            TemplatePassage(names.get(sink, ""), line, texts, each.name, each.title, each.place_of(0))
            for sink, line, texts, each in self._blocks.passages
        ]

    def _values(self, motion: Motion, number: int) -> dict[str, Value]:
        """Return the values that templates may print for a motion."""
        return self._template_values.values(motion, number, self._loaded_tool, self._spindle_at_start(motion.operation))

    def _spindle_at_start(self, operation: Operation) -> SpindleOn | None:
        """Return the spindle at the first row; None if it has not been started."""
        starts = [event for event in operation.events if isinstance(event, SpindleOn) and event.row == 0]
        return starts[-1] if starts else self._blocks.spindle

    # Subprograms

    def _begin_operation_file(self, motion: Motion, number: int) -> None:
        """Begin the subprogram of an operation, if each has one; it depends on nothing that came before."""
        if self._files is None:
            return
        values = self._values(motion, number)
        self._call_subprogram(self._files.next_operation(), "subprogram_start", values, motion)
        self._blocks.on_file_full = lambda: self._continue_in_next_file(values, motion)
        self._templates.forget_speed()
        self._called_tool = ""

    def _continue_in_next_file(self, values: Mapping[str, Value], motion: Motion) -> None:
        """Continue a subprogram that is full in another one."""
        assert self._files is not None
        self._end_subprogram(values, motion)
        self._call_subprogram(self._files.next_part(), "subprogram_part", values, motion)

    def _end_operation_file(self, motion: Motion, number: int) -> None:
        if self._files is not None:
            self._end_subprogram(self._values(motion, number), motion)

    def _call_subprogram(self, sink: BinaryIO, start: str, values: Mapping[str, Value], motion: Motion) -> None:
        """Call a subprogram from the main program, and begin it with the template ``start``."""
        assert self._files is not None
        named = {**values, "subprogram": self._files.current_name}
        self._templates.write_unskipped("subprogram_call", named, motion)
        self._blocks.writer.switch_file(sink)
        self._blocks.max_file_bytes = self._files.max_bytes
        self._templates.write_unskipped(start, named, motion, self._notices)

    def _end_subprogram(self, values: Mapping[str, Value], motion: Motion) -> None:
        """End the present subprogram; the next lines are in the main program."""
        assert self._files is not None
        named = {**values, "subprogram": self._files.current_name}
        self._templates.write_unskipped("subprogram_end", named, motion)
        self._blocks.writer.switch_file(self._files.main_sink)

    # Tools

    def _tool_list(self, values: Mapping[str, Value]) -> list[str]:
        """Comment lines with the tools in the order of their calls, if they are asked for."""
        if self._program.effective_setting("tool_list") != "on":
            return []
        if "tool_list" in self._control.templates:
            return self._templates.lines("tool_list", values, self._program.motions[0], {"lines": self._tools()})
        return self._tools()

    def _tools(self) -> list[str]:
        """Comment lines with the tools."""
        texts = dict.fromkeys(
            tool_text(call, operation.tool, self._control.unit) for call, _, operation in self._tool_calls
        )
        return self._comments(["TOOL LIST", *texts])

    def _operation_list(self) -> list[str]:
        """Comment lines with the operations in their order, if they are asked for."""
        if self._program.effective_setting("operation_list") != "on":
            return []
        times = self._template_values.operation_times()
        texts = operation_texts(self._program, [call for call, *_ in self._tool_calls], times)
        return self._comments(["OPERATION LIST", *texts])

    def _comments(self, texts: Sequence[str]) -> list[str]:
        return [line for text in texts for line in self._control.family.comment(self._program.spelled(text))]

    def _preselect_next(self, motion: Motion, values: Mapping[str, Value]) -> None:
        """Select the next other tool, if that is asked for, as soon as that of an operation is in the spindle."""
        following = self._template_values.tools.next_call(self._operation + 1)
        if self._program.effective_setting("preselect") != "on" or following is None:
            return
        usual = self._control.family.tool_preselection(following)
        if not self._templates.write_place("preselect", values, motion, {"lines": usual}):
            self._blocks.write_lines(usual)

    # Operations

    def _write_motion(self, motion: Motion, number: int, ends_operation: bool) -> None:
        """Write an operation, or the part of it in one plane."""
        planned = motion
        motion = self._blocks.use_axis_coordinates(motion)
        suffix, values = self._program.template_suffix(motion), self._values(motion, number)
        if motion.starts_operation:
            self._blocks.writer.begin_operation()
            self._templates.write_place("before_operation", values, motion)
            if self._way.passage is Passage.HOME:
                start = self._way.values(values) | {"edge": self._edge_of_spindle(motion)}
                again = AGAIN in self._control.templates and self._passages.starts_again(number)
                self._templates.write(AGAIN if again else "operation_start", start, motion)
            else:
                self._templates.write(FOLLOWING, values, motion)
            self._change_tool(motion, self._way.values(values))
            self._edge = str(values.get("edge") or "")
        else:
            self._templates.write_place("between_planes", values, motion)
        from_plane = self._continues_from_plane(motion)
        must_retract = from_plane and (self._passages.in_turn(motion) or not self._may_turn_here(motion))
        retracted = must_retract or not from_plane
        continues = motion.starts_operation and self._way.passage is Passage.CLEARANCE
        in_force = self._blocks.writer.modal_state() if continues else {}
        self._blocks.begin_motion(motion, str(values["tool"]), from_plane=from_plane, retracted=retracted)
        self._blocks.first_leg = self._first_leg(motion, planned, continues=continues)
        if must_retract:
            self._templates.write(f"{DRAW_BACK}_{suffix}", values, motion)
        if continues:
            for word, count in in_force.items():
                if word != "coolant":  # off between operations
                    self._blocks.writer.remember(word, count)
        else:
            self._approach(motion, suffix, values)
        self._templates.write_place("after_approach", values, motion)
        way = self._passages.way(number) if ends_operation else Way()
        if way.passage is Passage.CLEARANCE and way.distance > 0.0:
            motion = with_row_along_tool(motion, way.distance)
        written = replace(motion, operation=motion.as_written())
        first = 1 if not must_retract and self._is_at_first_point(written) else 0
        end, end_values = way.end_template(suffix), way.values(values)
        end_lines = self._templates.switching_lines(end, end_values, motion) if ends_operation and end else ()
        self._events.write(written, first, end_lines, values, restart_spindle=not from_plane)
        self._previous_motion = written
        if ends_operation:
            self._events.set_block_skip(False)  # the way home is for every run of the program
        self._blocks.restore_modal_state()
        if ends_operation and end:
            self._templates.write(end, end_values, motion)

    def _first_leg(self, motion: Motion, planned: Motion, *, continues: bool) -> Floats | None:
        """Return where the first leg from home ends, (3,) mm in coordinates of the blocks; None: the control's.

        planned  the motion in coordinates of the workpiece: an operation, or what follows behind a turn within one
        """
        if self._passages.in_turn(motion) and not motion.mode.holds_tips:
            self._blocks.xy_before_z = True
        leg = self._passages.above(planned) if continues else self._passages.first_leg(planned)
        if leg is None or motion.plane is None:
            return leg
        return np.asarray(motion.plane.matrix().T @ (leg - np.array(motion.plane.origin)))

    def _change_tool(self, motion: Motion, values: Mapping[str, Value]) -> None:
        tool = str(values["tool"])
        if self._calls_each:
            self._templates.forget_speed()
        if tool != self._called_tool or self._calls_each:
            self._templates.write("tool_change" if self._called_tool else "first_tool", values, motion)
            self._preselect_next(motion, values)
        else:
            self._templates.write_place("same_tool", values, motion)
        self._called_tool = tool
        self._operation += 1
        register = self._template_values.tools.length_register(motion.operation, self._loaded_tool)
        self._loaded_tool = LoadedTool(tool, motion.operation.tool.name, register)

    def _edge_of_spindle(self, motion: Motion) -> str:
        """Return the cutting edge of the tool before an operation: ADJUST names one of the operation's own tool."""
        return self._edge or self._program.effective_setting("edge", motion.operation)

    def _approach(self, motion: Motion, suffix: str, values: Mapping[str, Value]) -> None:
        """Place the rotary axes for the first row, and activate TCP or the tilted plane."""
        onward = "next_axis" if motion.plane is None else "next_plane"
        self._templates.write(f"{'approach' if motion.starts_operation else onward}_{suffix}", values, motion)
        if needs_plane(self._program, motion):
            self._templates.write(f"plane_on_{suffix}", values, motion)
        self._blocks.assume_rotary_position(motion)

    def _switch_coolant_off(self, motion: Motion, number: int, ends_program: bool) -> None:
        """Switch the coolant off after an operation, unless the end of the operation or of the program says so."""
        if self._blocks.coolant == "OFF" and not self._blocks.coolant_may_run:
            return
        ends_program = ends_program and self._files is None
        off, end = (
            f"M{self._control.coolant['OFF']}",
            self._passages.way(number).end_template(self._program.template_suffix(motion)),
        )
        ends = [end] if end else []
        ends += ["program_end"] if ends_program else []
        depends = any(self._control.templates[end].is_text for end in ends)
        values = self._values(motion, number) if depends else {}
        said = any(off in self._templates.switching_lines(end, values, motion) for end in ends)
        if not said:
            self._blocks.writer.write_lines([off])
        self._blocks.coolant, self._blocks.coolant_may_run = "OFF", False

    def _stop_between(self, motion: Motion, number: int) -> None:
        """Write an optional stop behind an operation, if that is asked for and the CL file has no stop there."""
        rows, following = len(motion.operation.moves), self._program.motions[number + 1].operation.events
        here = [event for event in motion.operation.events if event.row == rows]
        here += [event for event in following if event.row == 0]
        if self._program.effective_setting("stop_between") == "on" and not any(isinstance(e, Stop) for e in here):
            self._events.stop_between(motion, self._values(motion, number))

    # From plane to plane

    def _continues_from_plane(self, motion: Motion) -> bool:
        """Whether the tool comes from another plane of the same operation, and not from home."""
        if motion.starts_operation or motion.plane is None or not self._control.plane_from_pose:
            return False
        return f"{DRAW_BACK}_{self._program.template_suffix(motion)}" in self._control.templates

    def _may_turn_here(self, motion: Motion) -> bool:
        """Whether the rotary axes may turn to a plane where the CL file has left the tool."""
        if not self._is_retracted():
            return False
        before, machine = self._previous_motion, self._program.machine_of(motion)
        assert before is not None
        if self._part is None:
            self._part = part_of(self._program)
        return is_clear_of_turn(machine, self._part, self._last_tip(before), before, motion)

    def _is_retracted(self) -> bool:
        """Whether the CL file has retracted the tool, at rapid, at the end of the motion before."""
        assert self._previous_motion is not None
        operation = self._previous_motion.operation
        cycles = [event for event in operation.events if isinstance(event, CycleOn | CycleOff)]
        in_hole = self._previous_motion.ends_in_hole or (bool(cycles) and isinstance(cycles[-1], CycleOn))
        return not in_hole and bool(operation.moves.kind[-1] == Kind.RAPID)

    def _last_tip(self, before: Motion) -> Floats:
        """Where the motion before has left the tool, in its plane, (3,) mm."""
        return np.append(before.operation.moves.tip[-1, :2], self._blocks.tool_height)

    def _is_at_first_point(self, motion: Motion) -> bool:
        """Whether turning the rotary axes to the next plane has brought the tool to the first point there."""
        before, operation = self._previous_motion, motion.operation
        if before is None or not self._continues_from_plane(motion) or len(operation.moves) < 2:
            return False
        has_events = any(event.row == 0 and not isinstance(event, CycleOff) for event in operation.events)
        if has_events or operation.moves.kind[0] != Kind.RAPID:
            return False
        last = self._last_tip(before)
        counts = self._blocks.writer.word("X").format.counts
        reached = counts(tip_after_turn(self._program.machine_of(motion), last, before, motion))
        return bool((reached == counts(operation.moves.tip[0])).all())
