"""From what a program says to the phases and events of an operation."""

from collections.abc import Collection, Iterator, Mapping, Sequence
from itertools import groupby

import numpy as np

from trunnion.arrays import Codes, Ints
from trunnion.conversion.program_events import ProgramEvent
from trunnion.conversion.unsupported import Warnings
from trunnion.model.run import Run
from trunnion.model.toolpath import (
    BlockSkip,
    Coolant,
    CutterComp,
    Dwell,
    Event,
    Insert,
    Kind,
    LoadTool,
    Message,
    Phase,
    SelectTool,
    Sense,
    SpindleOff,
    SpindleOn,
    Stop,
)

_SENSE_OF_SIGN = {1: Sense.CLW, -1: Sense.CCLW, 0: None}
_COOLANT_CODE = {"mist": 7, "flood": 8, "off": 9}


class EventBuilder:
    """Makes the events of one operation after the other; spindle and tool go on from one to the next.

    phases     comment -> phase
    coolants   M number -> CL word
    known      lines of templates: their comments and messages are said by every program
    marked     the program names phases; without, rapids are one phase and all else is cutting
    unspoken   of the phases that it names rapids are none
    """

    def __init__(
        self,
        phases: Mapping[str, Phase],
        coolants: Mapping[int, str],
        template_lines: Collection[int],
        phases_marked: bool,
        rapids_unmarked: bool,
        warn: Warnings,
    ) -> None:
        self.tool = ""
        self._phases = phases
        self._coolants = coolants
        self._template_lines = template_lines
        self._phases_marked = phases_marked
        self._rapids_unmarked = rapids_unmarked
        self._warn = warn
        self._rpm = 0.0
        self._sense: Sense | None = None
        self._spindle_ran = False

    def build(
        self, program_events: Sequence[ProgramEvent], run: Run, rows: Ints, line: int
    ) -> tuple[Codes, tuple[Event, ...]]:
        """Phase of each row, and the events between the rows.

        Parameters
        ----------
        said
            What is said in the operation.
        run, rows
            Its ``rows`` (n,) of the run.
        line
            Line where the operation begins.
        """
        events: list[Event] = []
        spindle_ran, self._sense = self._spindle_ran, _SENSE_OF_SIGN[int(run.spindle[rows[0] - 1])] if rows[0] else None
        for (row, first, file), block in groupby(
            program_events, key=lambda program_event: (program_event.row, program_event.line, program_event.file)
        ):
            here, spindle_set, before = int(np.searchsorted(rows, row)), False, len(events)
            for program_event in block:
                in_template = program_event.file == 0 and program_event.line in self._template_lines
                if program_event.kind == "tool_change":
                    self._tool_change(program_event, here, len(rows), events)
                elif program_event.kind == "speed":
                    assert isinstance(program_event.value, float)
                    self._rpm, spindle_set = program_event.value, True
                elif program_event.kind == "spindle":
                    spindle_set = self._spindle(program_event, here, events) or spindle_set
                elif program_event.kind == "skip" or not in_template:
                    events += self._simple_events(program_event, here, len(rows))
            if spindle_set and self._sense is not None:
                events.append(SpindleOn(here, first, self._rpm, self._sense))
                self._spindle_ran = True
            if here < len(rows) and (run.line[row], run.file[row]) != (first, file):
                # M5 and M9 act behind the motion of their block. Said twice they get a block of their own again.
                events += [event for event in events[before:] if _switches_off(event)]
        spindle = any(isinstance(event, SpindleOn | SpindleOff) and event.row == 0 for event in events)
        if spindle_ran and not spindle and run.spindle[rows[0]] == 0:
            events.insert(0, SpindleOff(0, line))  # without a word it would turn as in the operation before
        if not any(isinstance(event, LoadTool) for event in events) and self.tool.isdigit():
            events.insert(0, LoadTool(0, line, int(self.tool)))
        return self._phase(program_events, run, rows), tuple(sorted(events, key=lambda event: event.row))

    def _phase(self, program_events: Sequence[ProgramEvent], run: Run, rows: Ints) -> Codes:
        """(n,) uint8: the phase of each row."""
        phase = np.full(len(rows), Phase.INITIAL, np.uint8)
        if not self._phases_marked:
            phase[:] = np.where(run.kind[rows] == Kind.RAPID, Phase.RAPID, Phase.CUT)
        comment_at: dict[int, ProgramEvent] = {}
        unused: list[ProgramEvent] = []
        for program_event in program_events:
            if program_event.text in self._phases and program_event.line not in self._template_lines:
                here = int(np.searchsorted(rows, program_event.row))
                unused += [comment_at[here]] if here in comment_at else []
                comment_at[here] = program_event
                phase[here:] = self._phases[program_event.text]
        if self._rapids_unmarked:
            phase[(phase == Phase.CUT) & (run.kind[rows] == Kind.RAPID)] = Phase.RAPID
        unused += [comment_at[len(rows)]] if len(rows) in comment_at else []
        for program_event in unused:
            self._warn(program_event.line, f"no motion follows {program_event.text!r}, which is not carried over")
        return phase

    def _tool_change(self, program_event: ProgramEvent, here: int, rows: int, events: list[Event]) -> None:
        """M6; of several changes before the first motion the last one counts."""
        before = [event for event in events if isinstance(event, LoadTool) and event.row == here == 0]
        for event in before:
            self._warn(event.line, f"no motion follows the change to tool {event.number}: not carried over")
            events.remove(event)
        if here == rows:
            self._warn(
                program_event.line, f"no motion follows the change to tool {program_event.value}: not carried over"
            )
            return
        self.tool = str(program_event.value or "").strip()
        if self.tool.isdigit():
            events.append(LoadTool(here, program_event.line, int(self.tool)))

    def _spindle(self, program_event: ProgramEvent, here: int, events: list[Event]) -> bool:
        """M3, M4 or M5; returns whether the spindle turns now."""
        if program_event.value == "oriented":
            self._warn(program_event.line, "SPOS is not carried over")
        elif program_event.value == "off":
            if self._sense is not None:
                events.append(SpindleOff(here, program_event.line))
            self._sense = None
        else:
            self._sense = Sense.CLW if program_event.value == "clockwise" else Sense.CCLW
            return True
        return False

    def _simple_events(self, program_event: ProgramEvent, here: int, rows: int) -> Iterator[Event]:
        """Happenings that are events as they stand."""
        line, value = program_event.line, program_event.value
        match program_event.kind:
            case "comment":
                if program_event.text and program_event.text not in self._phases:
                    yield Message(here, line, program_event.text)
            case "tool":
                if str(value).isdigit() and int(str(value)):
                    yield SelectTool(here, line, int(str(value)))
                else:
                    self._warn(line, f"T={value} is not carried over", "preselect tools by their number")
            case "coolant":
                yield Coolant(here, line, self._coolants.get(_COOLANT_CODE[str(value)], str(value).upper()))
            case "dwell":
                assert isinstance(value, float)
                yield Dwell(here, line, abs(value), value < 0)
            case "stop" | "optional_stop":
                yield Stop(here, line, program_event.kind == "optional_stop")
            case "message":
                yield Message(here, line, str(value or ""), display=True)
            case "skip":
                yield BlockSkip(here, line, bool(value))
            case "comp":
                assert isinstance(value, tuple)
                if here < rows or value[0] != "OFF":  # every operation ends without
                    yield CutterComp(here, line, value[0], value[1])
            case "m" | "h":
                assert isinstance(value, float)
                if program_event.kind == "m" and int(value) in self._coolants:
                    yield Coolant(here, line, self._coolants[int(value)])
                else:
                    yield Insert(here, line, f"{program_event.kind.upper()}{value:g}")
            case "cycle832":
                self._warn(line, "CYCLE832 is not carried over", "see --set cycle832=… and tolerance=…")


def _switches_off(event: Event) -> bool:
    """Whether spindle or coolant stops."""
    return isinstance(event, SpindleOff) or (isinstance(event, Coolant) and event.kind == "OFF")
