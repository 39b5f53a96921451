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

from trunnion.controls.definition import SPINDLE_ON
from trunnion.controls.family import WordEvent
from trunnion.controls.template import Value
from trunnion.controls.words import counts
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
from trunnion.output.hole_blocks import write_holes
from trunnion.output.motion_blocks import Blocks
from trunnion.output.plane_from_pose import carried_along, inside_limits, on_its_pose
from trunnion.output.program import Program, kind_of, setting_of
from trunnion.output.subprograms import Division, Files
from trunnion.output.template_values import Held, Printed, spindle_values

#: A line of a template that switches something, and moves nothing.
_SWITCH: Final = re.compile(r"M\d+|\{\w+\}")


def write_program(
    program: Program,
    sink: BinaryIO,
    progress: Callable[[int], None] | None = None,
    division: Division | None = None,
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
    division
        The program is a main program, in ``sink``, which calls a subprogram for each operation; None: it is one file.

    Raises
    ------
    InputError
        When a value that the program cannot do without is missing.
    """
    _Author(program, sink, progress or (lambda _: None), division).write()


def _on_poses(program: Program) -> Program:
    """The program with its tilted planes as they are for the digits that are printed."""
    if all(motion.plane is None for motion in program.motions):
        return program
    settled, word = (on_its_pose, "angle") if program.control.plane_from_pose else (inside_limits, "plane_angle")
    decimals = program.control.number_formats(three_axis=False)[word].decimals
    motions = [m if m.plane is None else settled(program.machine, m, decimals) for m in program.motions]
    return replace(program, motions=motions)


class _Author:
    """Writes one program; holds what is in force from one operation to the next."""

    def __init__(
        self, program: Program, sink: BinaryIO, progress: Callable[[int], None], division: Division | None
    ) -> None:
        self._program = program = _on_poses(program)
        self._control = program.control
        self._family = program.control.family
        self._blocks = Blocks(program, sink, progress)
        self._printed = Printed(program)
        self._notices = [line for text in program.notices for line in self._family.comment(text)]
        self._held = Held()
        self._unskipped: float | None = None  # height before the blocks that may be skipped; None: home
        self._skipped_from: tuple[int, dict[str, int]] = (0, {})  # how long the file was there, and what was in force
        self._said_tool = ""  # that this file has called
        self._speed: Value = None  # of the spindle, as a text said it last
        self._before: Motion | None = None
        self._files: Files | None = None
        if division is not None:
            naming, operations = program.control.subprograms, [m.operation.name for m in program.motions if m.begins]
            assert naming is not None, "a program is divided only where its control can call subprograms"
            self._files = Files(division, naming, sink, setting_of(program, "program"), operations)

    def write(self) -> None:
        """The program, operation by operation."""
        motions = self._program.motions
        self._expand("program_start", self._values(motions[0], 0), motions[0], self._notices)
        for k, motion in enumerate(motions):
            ends = k + 1 == len(motions) or motions[k + 1].begins
            if motion.begins:
                self._enter(motion, k)
            self._operation(motion, k, ends)
            off = f"M{self._control.coolant['OFF']}"
            if self._blocks.coolant != "OFF" and ends and (k + 1 < len(motions) or self._files is not None):
                end = self._control.templates[f"operation_end_{kind_of(self._program, motion)}"]
                self._blocks.writer.lines([] if off in end.lines else [off])
                self._blocks.coolant = "OFF"
            if ends:
                self._leave(motion, k)
        self._expand("program_end", self._values(motions[-1], -1), motions[-1])

    # Subprograms

    def _enter(self, motion: Motion, number: int) -> None:
        """An operation begins: where each has a file of its own, that says all that it needs."""
        if self._files is None:
            return
        values = self._values(motion, number)
        self._call(self._files.next_operation(), "subprogram_start", values, motion)
        self._blocks.full = lambda: self._go_on(values, motion)
        self._speed = None
        self._said_tool = ""

    def _go_on(self, values: Mapping[str, Value], motion: Motion) -> None:
        """The file is full: the operation goes on in another one."""
        assert self._files is not None
        self._end(values, motion)
        self._call(self._files.next_part(), "subprogram_part", values, motion)

    def _leave(self, motion: Motion, number: int) -> None:
        """The operation has ended, and so does its file."""
        if self._files is not None:
            self._end(self._values(motion, number), motion)

    def _call(self, sink: BinaryIO, start: str, values: Mapping[str, Value], motion: Motion) -> None:
        """The main program calls a subprogram, and that begins."""
        assert self._files is not None
        named = {**values, "subprogram": self._files.open}
        self._frame("subprogram_call", named, motion)
        self._blocks.writer.turn_to(sink)
        self._blocks.largest = self._files.largest
        self._frame(start, named, motion, self._notices)

    def _end(self, values: Mapping[str, Value], motion: Motion) -> None:
        """A subprogram ends; what comes next stands in the main program."""
        assert self._files is not None
        self._frame("subprogram_end", {**values, "subprogram": self._files.open}, motion)
        self._blocks.writer.turn_to(self._files.main)

    def _frame(self, name: str, values: Mapping[str, Value], motion: Motion, notices: Sequence[str] = ()) -> None:
        """A template whose blocks must be read whichever blocks are skipped."""
        skips = self._blocks.writer.skips
        self._blocks.writer.skip_blocks(False)
        self._expand(name, values, motion, notices)
        self._blocks.writer.skip_blocks(skips)

    # Operations

    def _expand(self, name: str, values: Mapping[str, Value], motion: Motion, notices: Sequence[str] = ()) -> None:
        formats = self._control.number_formats(motion.three_axis)
        template = self._control.templates[name]
        speed = values["spindle_speed"]
        # Notices stand as near to the first line as the control allows.
        lines = template.expand({**values, "new_speed": None if speed == self._speed else speed}, formats)
        first = self._control.first_lines if notices else 0
        self._blocks.lines([*lines[:first], *notices, *lines[first:]])
        if any(field in ("spindle_speed", "new_speed") for field, _ in template.fields()):
            self._speed = speed

    def _values(self, motion: Motion, number: int) -> dict[str, Value]:
        """What templates may print in this operation."""
        return self._printed.values(motion, number, self._held, self._spindle_at_start(motion.operation))

    def _operation(self, motion: Motion, number: int, ends: bool) -> None:
        """An operation, or what there is of it in one plane; ``ends``: there is no more of it."""
        motion = self._blocks.slid(motion)
        kind, values = kind_of(self._program, motion), self._values(motion, number)
        if motion.begins:
            self._expand("operation_start", values, motion)
            tool = str(values["tool"])
            if tool != self._said_tool:
                self._expand("tool_change" if self._said_tool else "first_tool", values, motion)
            self._said_tool = tool
            self._held = Held(tool, motion.operation.tool.name)
        below = self._goes_on(motion) and not self._drawn_back()
        level = below or not self._goes_on(motion)
        self._blocks.begin(motion, str(values["tool"]), self._goes_on(motion), comes_level=level)
        if below:
            self._expand(f"draw_back_{kind}", values, motion)
        onward = "next_axis" if motion.plane is None else "next_plane"
        self._expand(f"{'approach' if motion.begins else onward}_{kind}", values, motion)
        if motion.plane is not None:
            self._expand(f"plane_on_{kind}", values, motion)
        self._blocks.rotary_stand(motion)
        written = replace(motion, operation=motion.as_written())
        end = self._control.templates[f"operation_end_{kind}"].lines if ends else ()
        self._motion(written, int(not below and self._stands_there(written)), end)
        self._before = written
        if ends:
            self._skip(False)  # the way home, and the next operation, are for every run of the program
        self._blocks.back_in_force()
        if ends:
            self._expand(f"operation_end_{kind}", values, motion)

    def _goes_on(self, motion: Motion) -> bool:
        """Whether the tool comes from another plane of the same operation, and not from home."""
        return not motion.begins and motion.plane is not None and self._control.plane_from_pose

    def _drawn_back(self) -> bool:
        """Whether the CL file itself has drawn the tool back, at rapid, at the end of the motion before this one."""
        assert self._before is not None
        operation = self._before.operation
        cycles = [event for event in operation.events if isinstance(event, CycleOn | CycleOff)]
        in_hole = self._before.in_hole or (bool(cycles) and isinstance(cycles[-1], CycleOn))
        return not in_hole and bool(operation.moves.kind[-1] == Kind.RAPID)

    def _stands_there(self, motion: Motion) -> bool:
        """Whether turning the rotary axes to the next plane has already taken the tool to the first point there."""
        before, operation = self._before, motion.operation
        if before is None or not self._goes_on(motion) or len(operation.moves) < 2:
            return False
        busy = any(event.row == 0 and not isinstance(event, CycleOff) for event in operation.events)
        if busy or operation.moves.kind[0] != Kind.RAPID:
            return False
        last = np.append(before.operation.moves.tip[-1, :2], self._blocks.height)
        decimals = self._blocks.writer.word("X").format.decimals
        there = counts(carried_along(self._program.machine, last, before, motion), decimals)
        return bool((there == counts(np.ascontiguousarray(operation.moves.tip[0]), decimals)).all())

    def _motion(self, motion: Motion, first: int, end: Sequence[str]) -> None:
        """All rows from ``first`` on, broken where an event is a block of its own.

        ``end``: the lines that come next; what they begin with is not said right before them as well.
        """
        rows = len(motion.operation.moves)
        joining = [] if self._goes_on(motion) else self._spindle_again(motion.operation)
        own_spindle = SPINDLE_ON in self._control.templates
        if self._control.own_blocks or own_spindle:
            for again in joining:
                self._own_block(motion, again) if own_spindle else self._blocks.event_block(again)
            joining = []
        done, text = first, -1
        cycle: CycleOn | None = None
        for event in motion.operation.events:
            if isinstance(event, CycleOn | CycleOff):
                text = self._stretch(motion, done, event.row, joining, text, cycle)
                done, joining = max(first, event.row), [e for e in joining if e.row >= event.row]
                cycle = event if isinstance(event, CycleOn) else None
                continue
            off = isinstance(event, SpindleOff) or (isinstance(event, Coolant) and event.kind == "OFF")
            alone = self._control.own_blocks and isinstance(event, SpindleOn | Coolant | CutterComp)
            off = off or alone or (own_spindle and isinstance(event, SpindleOn))
            joins = event if isinstance(event, SpindleOn | Coolant | CutterComp) and not off else None
            if joins and not any(type(e) is type(event) and e.row == event.row for e in joining):
                joining.append(joins)
            elif joins or off or isinstance(event, Dwell | Stop | Message | Insert | BlockSkip):
                text = self._stretch(motion, done, event.row, joining, text, cycle)
                for earlier in (e for e in joining if e.row == event.row):
                    self._blocks.event_block(earlier)  # what is said twice before one row is said in order
                done, joining = event.row, [e for e in joining if e.row > event.row]
                if joins:
                    joining.append(joins)
                elif isinstance(event, SpindleOn | SpindleOff | Coolant | CutterComp) and not (
                    own_spindle and isinstance(event, SpindleOn)
                ):
                    if event.row == rows and self._said_in(end, event):
                        continue
                    self._blocks.event_block(event)  # with the next motion the control would switch off after it
                else:
                    self._own_block(motion, event)
        self._stretch(motion, done, rows, joining, text, cycle)
        for event in joining:
            if event.row == rows:
                self._blocks.event_block(event)

    def _stretch(
        self, motion: Motion, first: int, last: int, joining: Sequence[WordEvent], text: int, cycle: CycleOn | None
    ) -> int:
        """Rows ``first`` to ``last``, holes if there is a cycle; as ``Blocks.rows``."""
        if cycle is None or first == last:
            return self._blocks.rows(motion, first, last, joining, text)
        return write_holes(self._blocks, motion, first, last, joining, text, cycle)

    def _said_in(self, lines: Sequence[str], event: WordEvent) -> bool:
        """Whether lines begin with what an event says, among other M words and names of settings."""
        words = self._blocks.event_words(event)
        head = list(takewhile(_SWITCH.fullmatch, lines))
        return bool(words) and all(f"M{code}" in head for code in words.values())

    def _spindle_at_start(self, operation: Operation) -> SpindleOn | None:
        """What the spindle does at the first row; None: nobody said so."""
        said = [event for event in operation.events if isinstance(event, SpindleOn) and event.row == 0]
        return said[-1] if said else self._blocks.spindle

    def _spindle_again(self, operation: Operation) -> list[WordEvent]:
        """The last operation's end stopped the spindle: what was in force is said again unless something new is."""
        said = any(isinstance(event, SpindleOn) and event.row == 0 for event in operation.events)
        return [] if said or self._blocks.spindle is None else [replace(self._blocks.spindle, row=0)]

    def _skip(self, on: bool, row: int = 0) -> None:
        """Blocks from a row on have the block-skip sign, or no longer: what those with it said may not be in force."""
        blocks, writer = self._blocks, self._blocks.writer
        written = writer.size, writer.in_force()
        if on and not writer.skips:
            self._unskipped, self._skipped_from = blocks.height if row else None, written
        elif writer.skips and not on and written != self._skipped_from:
            writer.forget()
            blocks.highest = None if self._unskipped is None else max(self._unskipped, blocks.height)
        writer.skip_blocks(on)

    def _own_block(self, motion: Motion, event: Event) -> None:
        """Events that are no words of a motion block."""
        if isinstance(event, SpindleOn):
            self._blocks.spindle = event
            self._expand(SPINDLE_ON, spindle_values(self._program, event), motion)
        elif isinstance(event, Dwell):
            rpm = None if self._blocks.spindle is None else self._blocks.spindle.rpm
            self._blocks.lines(self._family.dwell(event, rpm, self._control.number_formats(motion.three_axis)))
        elif isinstance(event, Stop):
            self._blocks.lines(self._family.stop(event, self._control.codes))
        elif isinstance(event, Message):
            self._blocks.lines(self._family.message(event))
        elif isinstance(event, Insert):
            self._blocks.lines([event.text])
            self._blocks.writer.forget()  # nobody knows what the text has changed
        elif isinstance(event, BlockSkip):
            self._skip(event.on, event.row)
