"""Writes the rows of a motion and the events between them.

Events that are words join the next motion block; others are blocks of their own, between which the rows are divided.
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import takewhile
from typing import Final

from trunnion.controls.family_writer import FamilyWriter, WordEvent
from trunnion.controls.inches import without_comments
from trunnion.controls.places import STOP_PLACE
from trunnion.controls.template import Value
from trunnion.controls.vocabulary import SPINDLE_ON
from trunnion.errors import InputError, Problem
from trunnion.messages import Wording
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
    SelectTool,
    SpindleOff,
    SpindleOn,
    Stop,
)
from trunnion.output.blocks.motion_blocks import MotionBlockWriter
from trunnion.output.blocks.spline_blocks import write_rows_and_splines
from trunnion.output.changed_words import ChangedWords
from trunnion.output.holes.hole_blocks import write_holes
from trunnion.output.holes.hole_groups import HoleRows
from trunnion.output.program import Program
from trunnion.output.template_values import plain_text, spindle_values
from trunnion.output.template_writer import TemplateWriter
from trunnion.transliteration import spelled

#: A line of a template that switches something and moves nothing.
_SWITCHING_LINE: Final = re.compile(r"M\d+|\{\w+\}")


class EventWriter:
    """Writes motions with their events, one after the other."""

    def __init__(self, program: Program, blocks: MotionBlockWriter, templates: TemplateWriter) -> None:
        self._program, self._control = program, program.control
        self._family: FamilyWriter = program.control.family
        self._encoding = program.text_form.encoding
        self._blocks, self._templates = blocks, templates
        self._starts_spindle_by_template = SPINDLE_ON in program.control.templates
        # Before the blocks that may be skipped: the tool height, None for home; the file's size, and the modal state.
        self._height_before_skip: float | None = None
        self._state_before_skip: tuple[int, dict[str, int]] = 0, {}
        self._coolant_before_skip = "OFF"
        # In the present motion:
        self._motion = program.motions[0]
        self._values: Mapping[str, Value] = {}
        self._next_row = 0
        self._phase = -1
        self._cycle: CycleOn | None = None
        self._joining_events: list[WordEvent | ChangedWords] = []
        self._last_in_rows = _LastInRows(())
        self._spindle_turns = False
        self._resumes = False  # the spindle stands at a stop, and turns again before the row

    def write(
        self,
        motion: Motion,
        first: int,
        end_lines: Sequence[str],
        values: Mapping[str, Value],
        *,
        restart_spindle: bool,
    ) -> None:
        """Write the rows of a motion from ``first`` on, with its events.

        motion           in the coordinates of its blocks
        end_lines        lines of the template that comes next. What they switch at their beginning is not switched
                         right before
        values           of templates, for those of stops
        restart_spindle  the end of the last operation has stopped the spindle
        """
        rows = len(motion.operation.moves)
        self._motion, self._next_row, self._phase, self._cycle = motion, first, -1, None
        self._values = values
        self._joining_events = []
        if restart_spindle:
            self._spindle_turns = False
            if not any(isinstance(event, SpindleOn) and event.row == 0 for event in motion.operation.events):
                self._restart_spindle(0)
        events = motion.operation.events
        self._last_in_rows = _LastInRows(events)
        for k, event in enumerate(events):
            if not _is_said_again(events, k):
                # What is switched off before a stop is off while the machine stands.
                at_end = event.row == rows and not self._last_in_rows.comes_after(k, event, Stop)
                self._write_event(k, event, end_lines if at_end else ())
        self._write_rows(rows)
        for event in self._joining_events:
            if event.row == rows and not isinstance(event, ChangedWords):
                self._blocks.write_event(event)

    def set_block_skip(self, on: bool, row: int = 0) -> None:
        """Start the blocks from a row on with the block-skip sign, or no longer.

        After them nothing is known of what they have changed: the control may have skipped them.
        """
        blocks, writer = self._blocks, self._blocks.writer
        state = writer.size, writer.modal_state()
        if on and not writer.skips_blocks:
            highest = max(blocks.tool_height, blocks.height_bound or blocks.tool_height)
            self._height_before_skip, self._state_before_skip = highest if row else None, state
            self._coolant_before_skip = blocks.coolant
        elif writer.skips_blocks and not on and state != self._state_before_skip:
            writer.forget()
            before = self._height_before_skip
            blocks.height_bound = None if before is None else max(before, blocks.tool_height)
            blocks.coolant_may_run |= self._coolant_before_skip != "OFF"
        writer.set_block_skip(on)

    def _restart_spindle(self, row: int) -> None:
        """Start the spindle before a row as it was started last."""
        spindle = self._blocks.spindle
        if spindle is None:
            return
        self._spindle_turns = True
        again = replace(spindle, row=row)
        if self._joins_motion(again):
            self._joining_events.append(again)
        elif self._starts_spindle_by_template:
            self._start_spindle(again)
        else:
            self._blocks.write_event(again)

    # Events

    def _joins_motion(self, event: Event) -> bool:
        """Whether the words of an event join a motion block.

        The words that switch something off do not: some controls would switch it off after the motion.
        """
        if not isinstance(event, SpindleOn | Coolant | CutterComp) or self._control.own_blocks:
            return False
        if isinstance(event, SpindleOn):
            return not self._starts_spindle_by_template
        return not (isinstance(event, Coolant) and event.kind == "OFF")

    def _write_event(self, index: int, event: Event, end_lines: Sequence[str]) -> None:
        if isinstance(event, CycleOn | CycleOff):
            self._write_rows(event.row)
            self._joining_events = [joining for joining in self._joining_events if joining.row >= event.row]
            was, self._cycle = self._cycle, event if isinstance(event, CycleOn) else None
            if was is not None:
                self._turn_again_after_thread(was, event)
        elif isinstance(event, ChangedWords):
            self._joining_events.append(event)
        elif isinstance(event, SpindleOn | SpindleOff | Coolant | CutterComp):
            self._write_word_event(event, end_lines)
            if isinstance(event, SpindleOn | SpindleOff):
                self._spindle_turns = isinstance(event, SpindleOn)
        elif isinstance(event, Dwell | Stop | Message | Insert | BlockSkip | SelectTool):
            self._finish_rows(event.row)
            if isinstance(event, Stop):
                self._write_stop(index, event)
            else:
                self._write_line_event(event)

    def _write_word_event(self, event: WordEvent, end_lines: Sequence[str]) -> None:
        if self._joins_motion(event):
            if any(type(joining) is type(event) for joining in self._joining_at(event.row)):
                self._finish_rows(event.row)  # what is switched twice before a row is switched in order
            here = self._joining_at(event.row)
            del self._joining_events[len(self._joining_events) - len(here) :]
            self._joining_events += [
                joining for joining in here if type(joining) is not type(event)
            ]  # or the last time
            self._joining_events.append(event)
            return
        self._finish_rows(event.row)
        if isinstance(event, SpindleOn) and self._starts_spindle_by_template:
            self._start_spindle(event)
        elif not self._is_switched_in(end_lines, event):
            self._blocks.write_event(event)

    def _joining_at(self, row: int) -> list[WordEvent | ChangedWords]:
        """Return the events that are to join a row, the last one that any joins so far, in their order."""
        here = list(takewhile(lambda joining: joining.row == row, reversed(self._joining_events)))
        return here[::-1]

    def _write_line_event(self, event: Dwell | Message | Insert | BlockSkip | SelectTool) -> None:
        blocks = self._blocks
        if isinstance(event, Dwell):
            rpm = None if blocks.spindle is None else blocks.spindle.rpm
            formats = self._control.number_formats(self._motion.three_axis)
            blocks.write_lines(self._family.dwell(event, rpm, formats))
        elif isinstance(event, Message):
            lines = self._family.message(replace(event, text=spelled(event.text, self._encoding)))
            # One without a text ends that before it, where the control displays any.
            blocks.write_lines([line for line in lines if event.text or line not in self._family.comment("")])
        elif isinstance(event, Insert):
            lines = event.text.split("\n")
            source = self._control.templates[event.template] if event.template else None
            blocks.write_lines(lines, as_they_are=True, source=source)
            if event.template:
                self._templates.forget_words(lines)
            else:
                blocks.writer.forget()  # the text may have changed anything
        elif isinstance(event, SelectTool):
            if self._program.effective_setting("preselect") != "on":  # else the next tool is selected after a change
                call = self._family.tool_call(event.number, "", by_name=False)
                blocks.write_lines(self._family.tool_preselection(call))
        else:
            self.set_block_skip(event.on, event.row)

    def _write_stop(self, index: int, event: Stop) -> None:
        """Write a stop, at which the spindle stands; what ran before it is said again before the next row.

        Machines switch coolant off at a stop, and with it the spindle at an optional one, as their builder has decided:
        they stay off until the program says otherwise.
        """
        resumes = self._spindle_turns or self._resumes
        if self._spindle_turns and not event.optional:
            self._blocks.write_event(SpindleOff(event.row, event.line))
            self._spindle_turns = False
        self._write_stop_lines(event)
        self._blocks.writer.forget("coolant", *(("spindle",) if event.optional else ()))
        if event.row == len(self._motion.operation.moves):
            return
        comes_after = self._last_in_rows.comes_after
        is_last = not comes_after(index, event, Stop)
        self._resumes = resumes and not comes_after(index, event, SpindleOn, SpindleOff)
        if self._resumes and is_last:
            self._resumes = False
            self._restart_spindle(event.row)
        if is_last and self._blocks.coolant != "OFF" and not comes_after(index, event, Coolant):
            self._write_word_event(Coolant(event.row, event.line, self._blocks.coolant), ())

    def stop_between(self, motion: Motion, values: Mapping[str, Value]) -> None:
        """Write an optional stop between operations, with the ``values`` of the template of stops."""
        self._motion, self._values = motion, values
        rows = len(motion.operation.moves)
        self._write_stop_lines(Stop(rows, motion.operation.line, optional=True))

    def _write_stop_lines(self, event: Stop) -> None:
        """Write the lines of a stop: the family's, or those of the shop's template, which must stop as well."""
        usual = self._family.stop(replace(event, text=spelled(event.text, self._encoding)), self._control.codes)
        if STOP_PLACE not in self._control.templates:
            self._blocks.write_lines(usual)
            return
        code = self._control.codes["optional_stop" if event.optional else "stop"]
        own: dict[str, Value] = {"text": plain_text(self._program, event.text), "number": code}
        given = {**own, "lines": tuple(usual)}
        answer = self._templates.answer(STOP_PLACE, {**self._values, **own}, self._motion, given)
        word = re.compile(rf"(?<![A-Za-z0-9.])M0*{code}(?![0-9.])")
        stops = any(word.search(without_comments(self._control, line)) for line in answer.lines)
        if answer.source is not None and not stops:
            file, at = answer.source.place_of(0)
            raise InputError(
                Problem(
                    file,
                    at,
                    Wording(
                        "DEF560", "template_does_not", source=answer.source.title, code=code, event_line=event.line
                    ),
                )
            )
        self._templates.write_answer(answer)

    def _turn_again_after_thread(self, cycle: CycleOn, event: CycleOn | CycleOff) -> None:
        """Start the spindle after a thread at which the control stops it, unless no cut follows, or it is switched."""
        if not self._control.threads_stop_spindle or cycle.mode[:1] != ("TAP",) or not self._spindle_turns:
            return
        if isinstance(event, CycleOn) and event.mode[:1] == ("TAP",):
            return
        operation = self._motion.operation
        cuts = bool((operation.moves.kind[event.row :] != Kind.RAPID).any()) or isinstance(event, CycleOn)
        cuts |= any(isinstance(each, CycleOn) and each.row >= event.row for each in operation.events)
        switched = any(isinstance(each, SpindleOn | SpindleOff) and each.row == event.row for each in operation.events)
        if cuts and not switched and self._blocks.spindle is not None:
            self._blocks.writer.forget(*self._blocks.event_words(self._blocks.spindle))
            self._restart_spindle(event.row)

    def _start_spindle(self, event: SpindleOn) -> None:
        self._blocks.spindle = event
        program, values = self._program, spindle_values(self._program, event)
        with_tcp = self._control.new_speed_template(self._motion.mode)
        if not (with_tcp and self._templates.speed_changes(event.rpm)):
            self._templates.write(SPINDLE_ON, values, self._motion)
            return
        settings = {**self._control.settings, **program.settings_of(self._motion.operation)}
        words = {**self._family.template_values(settings, None), **values}
        self._templates.write(with_tcp, words, self._motion)
        writer = self._blocks.writer
        active = writer.modal_state()
        writer.forget()  # what X, Y and Z mean has changed between, and not how feeds count
        if "feed_mode" in active:
            writer.remember("feed_mode", active["feed_mode"])

    def _is_switched_in(self, lines: Sequence[str], event: WordEvent) -> bool:
        """Whether lines begin with the words of an event, among other M words and settings."""
        if not lines:
            return False
        words = self._blocks.event_words(event)
        switches = list(takewhile(_SWITCHING_LINE.fullmatch, lines))
        return bool(words) and all(f"M{code}" in switches for code in words.values())

    # Rows

    def _finish_rows(self, row: int) -> None:
        """Write all rows before ``row``, and the events that were to join it, as far as they make a block alone."""
        self._write_rows(row)
        waiting = []
        for event in self._joining_events:
            if event.row > row or (event.row == row and self._blocks.needs_motion(event)):
                waiting.append(event)
            elif event.row == row and not isinstance(event, ChangedWords):
                self._blocks.write_event(event)
        self._joining_events = waiting

    def _write_rows(self, last: int) -> None:
        """Write the rows up to ``last`` (excluded): motion, or the holes of the present cycle."""
        first = self._next_row
        if self._cycle is None or first >= last:
            joining = self._joining_events
            self._phase = write_rows_and_splines(self._blocks, self._motion, first, last, joining, self._phase)
        else:
            joined = [event for event in self._joining_events if not isinstance(event, ChangedWords)]
            rows = HoleRows(self._motion, first, last, joined)
            self._phase = write_holes(self._blocks, rows, self._phase, self._cycle)
        self._next_row = max(first, last)


class _LastInRows:
    """Which events come last before their row, by type."""

    def __init__(self, events: Sequence[Event]) -> None:
        self._last = {(event.row, type(event)): k for k, event in enumerate(events)}

    def comes_after(self, index: int, event: Event, *types: type[Event]) -> bool:
        """Whether an event of one of the types comes after the event with this index, before the same row."""
        return any(self._last.get((event.row, each), -1) > index for each in types)


def _is_said_again(events: Sequence[Event], index: int) -> bool:
    """Whether an event says what one before it in the same row does, with nothing but switching in between.

    Off is no such event: conversions of M5 and M9 in a block of their own say it twice.
    """
    event = events[index]
    if not isinstance(event, SpindleOn | Coolant | CutterComp) or (isinstance(event, Coolant) and event.kind == "OFF"):
        return False
    for k in range(index - 1, -1, -1):
        earlier = events[k]
        if earlier.row != event.row or not isinstance(earlier, SpindleOn | Coolant | CutterComp):
            return False
        if type(earlier) is type(event):
            return replace(earlier, line=event.line) == event
    return False
