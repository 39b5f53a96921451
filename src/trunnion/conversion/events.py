"""From what a program says to the phases and events of an operation."""

from collections.abc import Collection, Iterator, Mapping, Sequence
from itertools import groupby

import numpy as np

from trunnion.arrays import Codes, Ints
from trunnion.conversion.program_events import Item
from trunnion.conversion.unsupported import Remarks
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

_SENSES = {1: Sense.CLW, -1: Sense.CCLW, 0: None}
_COOLANT_CODE = {"mist": 7, "flood": 8, "off": 9}


class Events:
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
        known: Collection[int],
        marked: bool,
        unspoken: bool,
        remark: Remarks,
    ) -> None:
        self.tool = ""
        self._phases = phases
        self._coolants = coolants
        self._known = known
        self._marked = marked
        self._unspoken = unspoken
        self._remark = remark
        self._rpm = 0.0
        self._sense: Sense | None = None
        self._turned = False

    def of(self, said: Sequence[Item], run: Run, rows: Ints, line: int) -> tuple[Codes, tuple[Event, ...]]:
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
        turned, self._sense = self._turned, _SENSES[int(run.spindle[rows[0] - 1])] if rows[0] else None
        for (row, first, file), block in groupby(said, key=lambda item: (item.row, item.line, item.file)):
            here, spun, before = int(np.searchsorted(rows, row)), False, len(events)
            for item in block:
                templated = item.file == 0 and item.line in self._known
                if item.kind == "tool_change":
                    self._change(item, here, len(rows), events)
                elif item.kind == "speed":
                    assert isinstance(item.value, float)
                    self._rpm, spun = item.value, True
                elif item.kind == "spindle":
                    spun = self._turn(item, here, events) or spun
                elif item.kind == "skip" or not templated:
                    events += self._plain(item, here, len(rows))
            if spun and self._sense is not None:
                events.append(SpindleOn(here, first, self._rpm, self._sense))
                self._turned = True
            if here < len(rows) and (run.block[row], run.file[row]) != (first, file):
                # M5 and M9 act behind the motion of their block. Said twice they get a block of their own again.
                events += [event for event in events[before:] if _ends(event)]
        spindle = any(isinstance(event, SpindleOn | SpindleOff) and event.row == 0 for event in events)
        if turned and not spindle and run.spindle[rows[0]] == 0:
            events.insert(0, SpindleOff(0, line))  # without a word it would turn as in the operation before
        if not any(isinstance(event, LoadTool) for event in events) and self.tool.isdigit():
            events.insert(0, LoadTool(0, line, int(self.tool)))
        return self._phase(said, run, rows), tuple(sorted(events, key=lambda event: event.row))

    def _phase(self, said: Sequence[Item], run: Run, rows: Ints) -> Codes:
        """(n,) uint8: the phase of each row."""
        phase = np.full(len(rows), Phase.INITIAL, np.uint8)
        if not self._marked:
            phase[:] = np.where(run.kind[rows] == Kind.RAPID, Phase.RAPID, Phase.CUT)
        spoken: dict[int, Item] = {}
        unheard: list[Item] = []
        for item in said:
            if item.text in self._phases and item.line not in self._known:
                here = int(np.searchsorted(rows, item.row))
                unheard += [spoken[here]] if here in spoken else []
                spoken[here] = item
                phase[here:] = self._phases[item.text]
        if self._unspoken:
            phase[(phase == Phase.CUT) & (run.kind[rows] == Kind.RAPID)] = Phase.RAPID
        unheard += [spoken[len(rows)]] if len(rows) in spoken else []
        for item in unheard:
            self._remark(item.line, f"no motion follows {item.text!r}, which is not carried over")
        return phase

    def _change(self, item: Item, here: int, rows: int, events: list[Event]) -> None:
        """M6; of several changes before the first motion the last one counts."""
        before = [event for event in events if isinstance(event, LoadTool) and event.row == here == 0]
        for event in before:
            self._remark(event.line, f"no motion follows the change to tool {event.number}: not carried over")
            events.remove(event)
        if here == rows:
            self._remark(item.line, f"no motion follows the change to tool {item.value}: not carried over")
            return
        self.tool = str(item.value or "").strip()
        if self.tool.isdigit():
            events.append(LoadTool(here, item.line, int(self.tool)))

    def _turn(self, item: Item, here: int, events: list[Event]) -> bool:
        """M3, M4 or M5; returns whether the spindle turns now."""
        if item.value == "oriented":
            self._remark(item.line, "SPOS is not carried over")
        elif item.value == "off":
            if self._sense is not None:
                events.append(SpindleOff(here, item.line))
            self._sense = None
        else:
            self._sense = Sense.CLW if item.value == "clockwise" else Sense.CCLW
            return True
        return False

    def _plain(self, item: Item, here: int, rows: int) -> Iterator[Event]:
        """Happenings that are events as they stand."""
        line, value = item.line, item.value
        match item.kind:
            case "comment":
                if item.text and item.text not in self._phases:
                    yield Message(here, line, item.text)
            case "tool":
                if str(value).isdigit() and int(str(value)):
                    yield SelectTool(here, line, int(str(value)))
                else:
                    self._remark(line, f"T={value} is not carried over", "preselect tools by their number")
            case "coolant":
                yield Coolant(here, line, self._coolants.get(_COOLANT_CODE[str(value)], str(value).upper()))
            case "dwell":
                assert isinstance(value, float)
                yield Dwell(here, line, abs(value), value < 0)
            case "stop" | "optional_stop":
                yield Stop(here, line, item.kind == "optional_stop")
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
                if item.kind == "m" and int(value) in self._coolants:
                    yield Coolant(here, line, self._coolants[int(value)])
                else:
                    yield Insert(here, line, f"{item.kind.upper()}{value:g}")
            case "cycle832":
                self._remark(line, "CYCLE832 is not carried over", "see --set cycle832=… and tolerance=…")


def _ends(event: Event) -> bool:
    """Whether spindle or coolant stops."""
    return isinstance(event, SpindleOff) or (isinstance(event, Coolant) and event.kind == "OFF")
