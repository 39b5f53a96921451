"""The program from its first line to its last: sequences from templates, motion blocks, and events between rows.

Every operation goes the same way: operation start, tool, approach with the rotary axes placed first, motion, end.
Events stand between rows; those that are words join the next motion block, the others are blocks of their own.
"""

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from itertools import takewhile
from typing import BinaryIO, Final

import numpy as np

from trunnion.controls.family_writer import WordEvent
from trunnion.controls.template import Value
from trunnion.controls.vocabulary import SPINDLE_ON
from trunnion.controls.words import round_to_counts
from trunnion.model.motion import Motion
from trunnion.model.toolpath import (
    BlockSkip,
    Coolant,
    CutterComp,
    CycleOff,
    CycleOn,
    Dwell,
    Event,
    Insert,
    Kind,
    Message,
    Operation,
    SpindleOff,
    SpindleOn,
    Stop,
)
from trunnion.output.blocks.motion_blocks import MotionBlockWriter
from trunnion.output.coordinates.plane_from_pose import tip_after_turn, with_plane_inside_limits, with_plane_of_pose
from trunnion.output.holes.hole_blocks import write_holes
from trunnion.output.program import Program, effective_setting, template_suffix
from trunnion.output.subprograms import SubprogramFiles, SubprogramOutput
from trunnion.output.template_values import LoadedTool, TemplateValues, spindle_values

#: A line of a template that switches something, and moves nothing.
_SWITCHING_LINE: Final = re.compile(r"M\d+|\{\w+\}")


def write_program(
    program: Program,
    sink: BinaryIO,
    progress: Callable[[int], None] | None = None,
    subprograms: SubprogramOutput | None = None,
) -> None:
    """Write the whole program.

    Parameters
    ----------
    program
        Checked by ``check_program``.
    sink
        Takes UTF-8 bytes in order.
    progress
        Is told how many rows were written since it was last told.
    subprograms
        The program is a main program, in ``sink``, which calls a subprogram for each operation; None: it is one file.

    Raises
    ------
    InputError
        When a value that the program cannot do without is missing.
    """
    _ProgramWriter(program, sink, progress or (lambda _: None), subprograms).write()


def _with_printed_planes(program: Program) -> Program:
    """The program with its tilted planes as they are for the digits that are printed."""
    if all(motion.plane is None for motion in program.motions):
        return program
    settled, word = (
        (with_plane_of_pose, "angle") if program.control.plane_from_pose else (with_plane_inside_limits, "plane_angle")
    )
    decimals = program.control.number_formats(three_axis=False)[word].decimals
    motions = [m if m.plane is None else settled(program.machine, m, decimals) for m in program.motions]
    return replace(program, motions=motions)


class _ProgramWriter:
    """Writes one program; holds what is in force from one operation to the next."""

    def __init__(
        self, program: Program, sink: BinaryIO, progress: Callable[[int], None], subprograms: SubprogramOutput | None
    ) -> None:
        self._program = program = _with_printed_planes(program)
        self._control = program.control
        self._family = program.control.family
        self._blocks = MotionBlockWriter(program, sink, progress)
        self._template_values = TemplateValues(program)
        self._notices = [line for text in program.notices for line in self._family.comment(text)]
        self._loaded_tool = LoadedTool()
        self._height_before_skip: float | None = None  # height before the blocks that may be skipped; None: home
        self._state_before_skip: tuple[int, dict[str, int]] = (
            0,
            {},
        )  # how long the file was there, and what was in force
        self._called_tool = ""  # that this file has called
        self._printed_speed: Value = None  # of the spindle, as a text said it last
        self._previous_motion: Motion | None = None
        self._files: SubprogramFiles | None = None
        if subprograms is not None:
            naming, operations = (
                program.control.subprograms,
                [m.operation.name for m in program.motions if m.starts_operation],
            )
            assert naming is not None, "a program is divided only where its control can call subprograms"
            self._files = SubprogramFiles(subprograms, naming, sink, effective_setting(program, "program"), operations)

    def write(self) -> None:
        """The program, operation by operation."""
        motions = self._program.motions
        self._expand("program_start", self._values(motions[0], 0), motions[0], self._notices)
        for k, motion in enumerate(motions):
            ends = k + 1 == len(motions) or motions[k + 1].starts_operation
            if motion.starts_operation:
                self._begin_operation_file(motion, k)
            self._write_motion(motion, k, ends)
            off = f"M{self._control.coolant['OFF']}"
            if self._blocks.coolant != "OFF" and ends and (k + 1 < len(motions) or self._files is not None):
                end = self._control.templates[f"operation_end_{template_suffix(self._program, motion)}"]
                self._blocks.writer.write_lines([] if off in end.lines else [off])
                self._blocks.coolant = "OFF"
            if ends:
                self._end_operation_file(motion, k)
        self._expand("program_end", self._values(motions[-1], -1), motions[-1])

    # Subprograms

    def _begin_operation_file(self, motion: Motion, number: int) -> None:
        """An operation begins: where each has a file of its own, that says all that it needs."""
        if self._files is None:
            return
        values = self._values(motion, number)
        self._call_subprogram(self._files.next_operation(), "subprogram_start", values, motion)
        self._blocks.on_file_full = lambda: self._continue_in_next_file(values, motion)
        self._printed_speed = None
        self._called_tool = ""

    def _continue_in_next_file(self, values: Mapping[str, Value], motion: Motion) -> None:
        """The file is full: the operation goes on in another one."""
        assert self._files is not None
        self._end_subprogram(values, motion)
        self._call_subprogram(self._files.next_part(), "subprogram_part", values, motion)

    def _end_operation_file(self, motion: Motion, number: int) -> None:
        """The operation has ended, and so does its file."""
        if self._files is not None:
            self._end_subprogram(self._values(motion, number), motion)

    def _call_subprogram(self, sink: BinaryIO, start: str, values: Mapping[str, Value], motion: Motion) -> None:
        """The main program calls a subprogram, and that begins."""
        assert self._files is not None
        named = {**values, "subprogram": self._files.current_name}
        self._expand_unskipped("subprogram_call", named, motion)
        self._blocks.writer.switch_file(sink)
        self._blocks.max_file_bytes = self._files.max_bytes
        self._expand_unskipped(start, named, motion, self._notices)

    def _end_subprogram(self, values: Mapping[str, Value], motion: Motion) -> None:
        """A subprogram ends; what comes next stands in the main program."""
        assert self._files is not None
        self._expand_unskipped("subprogram_end", {**values, "subprogram": self._files.current_name}, motion)
        self._blocks.writer.switch_file(self._files.main_sink)

    def _expand_unskipped(
        self, name: str, values: Mapping[str, Value], motion: Motion, notices: Sequence[str] = ()
    ) -> None:
        """A template whose blocks must be read whichever blocks are skipped."""
        skips = self._blocks.writer.skips_blocks
        self._blocks.writer.set_block_skip(False)
        self._expand(name, values, motion, notices)
        self._blocks.writer.set_block_skip(skips)

    # Operations

    def _expand(self, name: str, values: Mapping[str, Value], motion: Motion, notices: Sequence[str] = ()) -> None:
        formats = self._control.number_formats(motion.three_axis)
        template = self._control.templates[name]
        speed = values["spindle_speed"]
        # Notices stand as near to the first line as the control allows.
        lines = template.expand({**values, "new_speed": None if speed == self._printed_speed else speed}, formats)
        first = self._control.first_lines if notices else 0
        self._blocks.write_lines([*lines[:first], *notices, *lines[first:]])
        if any(field in ("spindle_speed", "new_speed") for field, _ in template.fields()):
            self._printed_speed = speed

    def _values(self, motion: Motion, number: int) -> dict[str, Value]:
        """What templates may print in this operation."""
        return self._template_values.values(motion, number, self._loaded_tool, self._spindle_at_start(motion.operation))

    def _write_motion(self, motion: Motion, number: int, ends: bool) -> None:
        """An operation, or what there is of it in one plane; ``ends``: there is no more of it."""
        motion = self._blocks.use_axis_coordinates(motion)
        kind, values = template_suffix(self._program, motion), self._values(motion, number)
        if motion.starts_operation:
            self._expand("operation_start", values, motion)
            tool = str(values["tool"])
            if tool != self._called_tool:
                self._expand("tool_change" if self._called_tool else "first_tool", values, motion)
            self._called_tool = tool
            self._loaded_tool = LoadedTool(tool, motion.operation.tool.name)
        below = self._continues_from_plane(motion) and not self._is_retracted()
        level = below or not self._continues_from_plane(motion)
        self._blocks.begin_motion(motion, str(values["tool"]), self._continues_from_plane(motion), xy_before_z=level)
        if below:
            self._expand(f"draw_back_{kind}", values, motion)
        onward = "next_axis" if motion.plane is None else "next_plane"
        self._expand(f"{'approach' if motion.starts_operation else onward}_{kind}", values, motion)
        if motion.plane is not None:
            self._expand(f"plane_on_{kind}", values, motion)
        self._blocks.assume_rotary_position(motion)
        written = replace(motion, operation=motion.as_written())
        end = self._control.templates[f"operation_end_{kind}"].lines if ends else ()
        self._write_rows_and_events(written, int(not below and self._is_at_first_point(written)), end)
        self._previous_motion = written
        if ends:
            self._set_block_skip(False)  # the way home, and the next operation, are for every run of the program
        self._blocks.restore_modal_state()
        if ends:
            self._expand(f"operation_end_{kind}", values, motion)

    def _continues_from_plane(self, motion: Motion) -> bool:
        """Whether the tool comes from another plane of the same operation, and not from home."""
        return not motion.starts_operation and motion.plane is not None and self._control.plane_from_pose

    def _is_retracted(self) -> bool:
        """Whether the CL file itself has drawn the tool back, at rapid, at the end of the motion before this one."""
        assert self._previous_motion is not None
        operation = self._previous_motion.operation
        cycles = [event for event in operation.events if isinstance(event, CycleOn | CycleOff)]
        in_hole = self._previous_motion.ends_in_hole or (bool(cycles) and isinstance(cycles[-1], CycleOn))
        return not in_hole and bool(operation.moves.kind[-1] == Kind.RAPID)

    def _is_at_first_point(self, motion: Motion) -> bool:
        """Whether turning the rotary axes to the next plane has already taken the tool to the first point there."""
        before, operation = self._previous_motion, motion.operation
        if before is None or not self._continues_from_plane(motion) or len(operation.moves) < 2:
            return False
        busy = any(event.row == 0 and not isinstance(event, CycleOff) for event in operation.events)
        if busy or operation.moves.kind[0] != Kind.RAPID:
            return False
        last = np.append(before.operation.moves.tip[-1, :2], self._blocks.tool_height)
        decimals = self._blocks.writer.word("X").format.decimals
        there = round_to_counts(tip_after_turn(self._program.machine, last, before, motion), decimals)
        return bool((there == round_to_counts(np.ascontiguousarray(operation.moves.tip[0]), decimals)).all())

    def _write_rows_and_events(self, motion: Motion, first: int, end: Sequence[str]) -> None:
        """All rows from ``first`` on, broken where an event is a block of its own.

        ``end``: the lines that come next; what they begin with is not said right before them as well.
        """
        rows = len(motion.operation.moves)
        joining_events = [] if self._continues_from_plane(motion) else self._spindle_restart(motion.operation)
        own_spindle = SPINDLE_ON in self._control.templates
        if self._control.own_blocks or own_spindle:
            for again in joining_events:
                self._write_event(motion, again) if own_spindle else self._blocks.event_block(again)
            joining_events = []
        done, text = first, -1
        cycle: CycleOn | None = None
        for event in motion.operation.events:
            if isinstance(event, CycleOn | CycleOff):
                text = self._write_rows(motion, done, event.row, joining_events, text, cycle)
                done, joining_events = max(first, event.row), [e for e in joining_events if e.row >= event.row]
                cycle = event if isinstance(event, CycleOn) else None
                continue
            off = isinstance(event, SpindleOff) or (isinstance(event, Coolant) and event.kind == "OFF")
            alone = self._control.own_blocks and isinstance(event, SpindleOn | Coolant | CutterComp)
            off = off or alone or (own_spindle and isinstance(event, SpindleOn))
            joins = event if isinstance(event, SpindleOn | Coolant | CutterComp) and not off else None
            if joins and not any(type(e) is type(event) and e.row == event.row for e in joining_events):
                joining_events.append(joins)
            elif joins or off or isinstance(event, Dwell | Stop | Message | Insert | BlockSkip):
                text = self._write_rows(motion, done, event.row, joining_events, text, cycle)
                for earlier in (e for e in joining_events if e.row == event.row):
                    self._blocks.event_block(earlier)  # what is said twice before one row is said in order
                done, joining_events = event.row, [e for e in joining_events if e.row > event.row]
                if joins:
                    joining_events.append(joins)
                elif isinstance(event, SpindleOn | SpindleOff | Coolant | CutterComp) and not (
                    own_spindle and isinstance(event, SpindleOn)
                ):
                    if event.row == rows and self._already_said(end, event):
                        continue
                    self._blocks.event_block(event)  # with the next motion the control would switch off after it
                else:
                    self._write_event(motion, event)
        self._write_rows(motion, done, rows, joining_events, text, cycle)
        for event in joining_events:
            if event.row == rows:
                self._blocks.event_block(event)

    def _write_rows(
        self,
        motion: Motion,
        first: int,
        last: int,
        joining_events: Sequence[WordEvent],
        text: int,
        cycle: CycleOn | None,
    ) -> int:
        """Rows ``first`` to ``last``, holes if there is a cycle; as ``MotionBlockWriter.write_rows``."""
        if cycle is None or first == last:
            return self._blocks.write_rows(motion, first, last, joining_events, text)
        return write_holes(self._blocks, motion, first, last, joining_events, text, cycle)

    def _already_said(self, lines: Sequence[str], event: WordEvent) -> bool:
        """Whether lines begin with what an event says, among other M words and names of settings."""
        words = self._blocks.event_words(event)
        head = list(takewhile(_SWITCHING_LINE.fullmatch, lines))
        return bool(words) and all(f"M{code}" in head for code in words.values())

    def _spindle_at_start(self, operation: Operation) -> SpindleOn | None:
        """What the spindle does at the first row; None: nobody said so."""
        said = [event for event in operation.events if isinstance(event, SpindleOn) and event.row == 0]
        return said[-1] if said else self._blocks.spindle

    def _spindle_restart(self, operation: Operation) -> list[WordEvent]:
        """The last operation's end stopped the spindle: what was in force is said again unless something new is."""
        said = any(isinstance(event, SpindleOn) and event.row == 0 for event in operation.events)
        return [] if said or self._blocks.spindle is None else [replace(self._blocks.spindle, row=0)]

    def _set_block_skip(self, on: bool, row: int = 0) -> None:
        """Blocks from a row on have the block-skip sign, or no longer: what those with it said may not be in force."""
        blocks, writer = self._blocks, self._blocks.writer
        written = writer.size, writer.modal_state()
        if on and not writer.skips_blocks:
            self._height_before_skip, self._state_before_skip = blocks.tool_height if row else None, written
        elif writer.skips_blocks and not on and written != self._state_before_skip:
            writer.forget()
            blocks.height_bound = (
                None if self._height_before_skip is None else max(self._height_before_skip, blocks.tool_height)
            )
        writer.set_block_skip(on)

    def _write_event(self, motion: Motion, event: Event) -> None:
        """Events that are no words of a motion block."""
        if isinstance(event, SpindleOn):
            self._blocks.spindle = event
            self._expand(SPINDLE_ON, spindle_values(self._program, event), motion)
        elif isinstance(event, Dwell):
            rpm = None if self._blocks.spindle is None else self._blocks.spindle.rpm
            self._blocks.write_lines(self._family.dwell(event, rpm, self._control.number_formats(motion.three_axis)))
        elif isinstance(event, Stop):
            self._blocks.write_lines(self._family.stop(event, self._control.codes))
        elif isinstance(event, Message):
            self._blocks.write_lines(self._family.message(event))
        elif isinstance(event, Insert):
            self._blocks.write_lines([event.text])
            self._blocks.writer.forget()  # nobody knows what the text has changed
        elif isinstance(event, BlockSkip):
            self._set_block_skip(event.on, event.row)
