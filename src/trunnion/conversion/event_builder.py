"""The events of an operation, from what its section of the program contains besides motion."""

from collections.abc import Collection, Iterator, Mapping, Sequence
from itertools import groupby
from typing import Final

import numpy as np

from trunnion.arrays import Ints
from trunnion.conversion.program_events import ProgramEvent
from trunnion.conversion.states import Fate, loss_of
from trunnion.conversion.unsupported import Warnings
from trunnion.messages import Wording
from trunnion.model.run import Run
from trunnion.model.toolpath import (
    BlockSkip,
    Coolant,
    CutterComp,
    Dwell,
    Event,
    Insert,
    LoadTool,
    Message,
    SelectTool,
    Sense,
    SpindleOff,
    SpindleOn,
    Stop,
)

_SENSE_OF_SIGN = {1: Sense.CLW, -1: Sense.CCLW, 0: None}

#: CL words of coolants, the preferred first.
_COOLANT_WORDS: Final = {"mist": ("MIST",), "flood": ("ON", "FLOOD"), "off": ("OFF",)}


class EventBuilder:
    """Builds the events of one operation after another; spindle and tool carry over from one to the next.

    phase_comments   comments that name phases, in capitals, and are no messages
    coolants         M number -> CL word
    template_lines   lines written from templates: every program of the control has their comments and messages
    smoothing        as ``FamilyReader.lost_smoothing``
    """

    def __init__(
        self,
        run: Run,
        phase_comments: Collection[str],
        coolants: Mapping[int, str],
        template_lines: Collection[int],
        smoothing: Mapping[str, tuple[str, str]],
        warn: Warnings,
    ) -> None:
        self.tool = ""
        self._run = run
        self._phase_comments = phase_comments
        self._coolants = coolants
        self._template_lines = template_lines
        self._smoothing = smoothing
        self._warn = warn
        self._rpm = 0.0
        self._sense: Sense | None = None
        self._spindle_ran = False

    def build(self, events: Sequence[ProgramEvent], rows: Ints, line: int) -> tuple[Event, ...]:
        """Return the events of an operation.

        events  the program events of its section, in order
        rows    its (n,) rows of the run
        line    the line where it begins
        """
        run, found = self._run, list[Event]()
        spindle_ran, self._sense = self._spindle_ran, _SENSE_OF_SIGN[int(run.spindle[rows[0] - 1])] if rows[0] else None
        for _, block in groupby(events, key=lambda event: (event.row, event.line, event.file)):
            self._add_block(list(block), rows, found)
        spindle_given = any(isinstance(event, SpindleOn | SpindleOff) and event.row == 0 for event in found)
        if spindle_ran and not spindle_given and run.spindle[rows[0]] == 0:
            found.insert(0, SpindleOff(0, line))  # otherwise it would turn as in the operation before
        if not any(isinstance(event, LoadTool) for event in found) and self.tool.isdigit():
            found.insert(0, LoadTool(0, line, int(self.tool)))
        return tuple(sorted(found, key=lambda event: event.row))

    def _add_block(self, block: Sequence[ProgramEvent], rows: Ints, found: list[Event]) -> None:
        """Add the events of one block to those ``found`` before."""
        run_row, line, file = block[0].row, block[0].line, block[0].file
        row, begin, spindle_set = int(np.searchsorted(rows, run_row)), len(found), False
        for event in block:
            if event.kind == "tool_change":
                self._add_tool_change(event, row, len(rows), found)
            elif event.kind == "speed":
                assert isinstance(event.value, float)
                self._rpm, spindle_set = event.value, True
            elif event.kind == "spindle":
                spindle_set = self._set_spindle(event, row, found) or spindle_set
            elif event.kind in ("skip", "delta") or event.file != 0 or event.line not in self._template_lines:
                found += self._simple_events(event, row, len(rows))
        if spindle_set and self._sense is not None:
            found.append(SpindleOn(row, line, self._rpm, self._sense))
            self._spindle_ran = True
        if row < len(rows) and (self._run.line[run_row], self._run.file[run_row]) != (line, file):
            # M5 and M9 act after the motion of their block. Given twice, they get a block of their own again.
            found += [event for event in found[begin:] if _switches_off(event)]

    def _add_tool_change(self, event: ProgramEvent, row: int, row_count: int, found: list[Event]) -> None:
        """M6. Of several changes before the first motion, the last one counts."""
        earlier = [other for other in found if isinstance(other, LoadTool) and other.row == row == 0]
        for other in earlier:
            self._warn(other.line, Wording("CNV174", "no_motion_follows", number=other.number))
            found.remove(other)
        if row == row_count:
            self._warn(event.line, Wording("CNV174", "no_motion_follows_change", event=event.value))
            return
        self.tool = str(event.value or "").strip()
        if self.tool.isdigit():
            found.append(LoadTool(row, event.line, int(self.tool)))

    def _set_spindle(self, event: ProgramEvent, row: int, found: list[Event]) -> bool:
        """M3, M4 or M5; returns whether the event starts the spindle."""
        if event.value in ("oriented", "axis"):
            self._warn.refuse(event.line, Wording("CNV170", "spindle_stops_angle"), event.file)
        elif event.value == "off":
            if self._sense is not None:
                found.append(SpindleOff(row, event.line))
            self._sense = None
        else:
            self._sense = Sense.CLW if event.value == "clockwise" else Sense.CCLW
            return True
        return False

    def _simple_events(self, event: ProgramEvent, row: int, row_count: int) -> Iterator[Event]:
        """Program events that are events of an operation as they are."""
        line, value = event.line, event.value
        match event.kind:
            case "comment":
                text = event.text.upper()
                if text and text not in self._phase_comments:
                    yield Message(row, line, _one_line(event.text))
            case "tool":
                if str(value).isdigit() and int(str(value)):
                    yield SelectTool(row, line, int(str(value)))
                else:
                    self._warn(line, Wording("CNV150", "t_not_carried", value=value))
            case "coolant":
                yield Coolant(row, line, self._coolant_word(str(value)))
            case "dwell":
                assert isinstance(value, float)
                yield Dwell(row, line, abs(value), value < 0)
            case "stop" if value == "pallet":
                self._warn.refuse(line, Wording("CNV170", "m60_changes_pallet"), event.file)
            case "stop" | "optional_stop":
                yield Stop(row, line, event.kind == "optional_stop")
            case "message":
                yield Message(row, line, _one_line(str(value or "")), display=True)
            case "skip":
                yield BlockSkip(row, line, bool(value))
            case "comp":
                assert isinstance(value, tuple)
                if row < row_count or value[0] != "OFF":  # every operation ends without compensation
                    register = int(value[2])
                    yield CutterComp(row, line, value[0], value[1], 0 if str(register) == self.tool else register)
            case "m" | "h":
                assert isinstance(value, float)
                if event.kind == "m" and int(value) in self._coolants:
                    yield Coolant(row, line, self._coolants[int(value)])
                else:
                    yield Insert(row, line, f"{event.kind.upper()}{value:g}")
            case "known":
                yield Insert(row, line, str(value))
            case "delta" if isinstance(value, tuple) and str(value[0]).startswith("TOOL DEF"):
                self._warn(line, Wording("CNV173", "length_radius_tool"), event.file)
            case kind if kind in self._smoothing:
                name, cure = self._smoothing[kind]
                self._warn(line, Wording("CNV140", "not_carried_over", name=name, cure=cure), event.file)
            case kind:
                self._lose(kind, event)

    def _coolant_word(self, value: str) -> str:
        """Return the CL word of coolant that the reader knows."""
        if value == "through":
            return "THRU"
        known = self._coolants.values()
        return next((word for word in _COOLANT_WORDS[value] if word in known), value.upper())

    def _lose(self, kind: str, event: ProgramEvent) -> None:
        """Say of an event that no operation holds what the table of states has."""
        fate, loss = loss_of(kind, event.value)
        if loss is not None:
            (self._warn.refuse if fate is Fate.REFUSED else self._warn)(event.line, loss, event.file)


def _one_line(text: str) -> str:
    """Return a text with blanks in the place of control characters, as a stray carriage return in a comment."""
    return "".join(character if character.isprintable() else " " for character in text)


def _switches_off(event: Event) -> bool:
    """Whether the spindle or the coolant stops."""
    return isinstance(event, SpindleOff) or (isinstance(event, Coolant) and event.kind == "OFF")
