"""From what a program says to the phases and events of an operation."""

from collections.abc import Collection, Iterator, Mapping, Sequence

import numpy as np

from trunnion.arrays import Codes
from trunnion.convert.points import Points
from trunnion.convert.timeline import Item, Remark, blocks
from trunnion.toolpath import (
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

_COOLANT_CODE = {"mist": 7, "flood": 8, "off": 9}


class Events:
    """Makes the events of one operation after the other; spindle and tool go on from one to the next.

    phases     comment -> phase
    coolants   M number -> CL word
    by_colour  the program names phases; without, rapids are one phase and all else is cutting
    """

    def __init__(
        self, phases: Mapping[str, Phase], coolants: Mapping[int, str], by_colour: bool, remark: Remark
    ) -> None:
        self.tool = ""
        self._phases = phases
        self._coolants = coolants
        self._by_colour = by_colour
        self._remark = remark
        self._rpm = 0.0
        self._sense: Sense | None = None

    def of(
        self, said: Sequence[Item], points: Points, known: Collection[int], in_order: bool, line: int
    ) -> tuple[Codes, list[Event]]:
        """Phase of each point, and the events between the points.

        Parameters
        ----------
        said
            What is said in the operation.
        points
            Its points.
        known
            Lines of templates: their comments and messages are said by every program.
        in_order
            Whether lines say when they are executed.
        line
            Line where the operation begins.
        """
        phase = np.full(len(points.row), Phase.INITIAL, np.uint8)
        if not self._by_colour:
            phase[:] = np.where(points.kind == Kind.RAPID, Phase.RAPID, Phase.CUT)
        events: list[Event] = []
        loaded = False
        changes = {item.row for item in said if item.kind == "tool_change"}
        for block in blocks(said):
            here = points.at(block[0].row, block[0].line if in_order else 0)
            spun = False
            for item in block:
                templated = item.file == 0 and item.line in known
                text = str(item.value or "").strip()
                if item.kind == "comment":
                    if not templated and text in self._phases:
                        phase[here:] = self._phases[text]
                    elif not templated and text:
                        events.append(Message(here, item.line, text))
                elif item.kind == "tool":
                    if item.row not in changes and text.isdigit() and int(text):
                        events.append(SelectTool(here, item.line, int(text)))
                elif item.kind == "tool_change":
                    self.tool, loaded = text, True
                    events += self._load(here, item.line)
                elif item.kind == "speed":
                    assert isinstance(item.value, float)
                    self._rpm, spun = item.value, True
                elif item.kind == "spindle":
                    spun = self._turn(item, here, events) or spun
                elif item.kind == "skip" or not templated:
                    events += self._plain(item, here)
            if spun and self._sense is not None:
                events.append(SpindleOn(here, block[0].line, self._rpm, self._sense))
            if block[0].line in points.twice:
                events.append(events[-1])
        if not loaded:
            events = [*self._load(0, line), *events]
        events.sort(key=lambda event: event.row)
        return phase, events

    def _load(self, here: int, line: int) -> list[Event]:
        return [LoadTool(here, line, int(self.tool))] if self.tool.isdigit() else []

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

    def _plain(self, item: Item, here: int) -> Iterator[Event]:
        """Happenings that are events as they stand."""
        line, value = item.line, item.value
        match item.kind:
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
                yield CutterComp(here, line, value[0], value[1])
            case "m" | "h":
                assert isinstance(value, float)
                if item.kind == "m" and int(value) in self._coolants:
                    yield Coolant(here, line, self._coolants[int(value)])
                else:
                    yield Insert(here, line, f"{item.kind.upper()}{value:g}")
            case "cycle832":
                self._remark(line, "CYCLE832 within an operation is not carried over")
