"""Spindle and tool as a CL file asks for them."""

from bisect import bisect_right
from dataclasses import replace

from trunnion.model.toolpath import Operation, Sense, SpindleOff, SpindleOn
from trunnion.records import dataclass


@dataclass(frozen=True, slots=True)
class ExpectedSpindle:
    """Spindle speed, rev/min, and sense: +1 clockwise, -1 counterclockwise, 0 off."""

    rpm: float
    sense: int


@dataclass(frozen=True, slots=True)
class ExpectedTool:
    """The tool that should be in the spindle.

    number  None before the first LOAD/TOOL
    adjust  the length register of LOAD/TOOL, 0 if it names none
    called  what the settings call it instead; empty: nothing
    """

    number: int | None
    adjust: int = 0
    name: str = ""
    called: str = ""

    @property
    def is_known(self) -> bool:
        """Whether a program must call one tool, and no other."""
        return self.number is not None or bool(self.called)

    @property
    def names(self) -> tuple[str, ...]:
        """What a program may call the tool."""
        if self.called:
            return (self.called,)
        return tuple(str(text) for text in (self.number, self.name) if text not in (None, ""))

    def of_operation(self, name: str, called: str) -> "ExpectedTool":
        """Return the tool of an operation that begins with this one, under the name that it has for it itself.

        Under another name it is another tool, of which no number is known before the operation loads one.
        """
        if self.name and name and name != self.name:
            return ExpectedTool(None, 0, name, called)
        return replace(self, name=name, called=called)

    @property
    def lengths(self) -> tuple[int, ...]:
        """The number that its tool length must have: the register of LOAD/TOOL, or the tool's own; empty: any."""
        if self.called.isdigit():
            return (int(self.called),)
        number = self.adjust or self.number
        return (number,) if number else ()


def names_tool(text: str, names: tuple[str, ...]) -> bool:
    """Whether a program's word for a tool is one of its names; numbers may have leading zeros."""
    return text in names or (text.isdigit() and str(int(text)) in names)


def spindle_on(event: SpindleOn) -> ExpectedSpindle:
    """Return the spindle after a SPINDL that starts it."""
    return ExpectedSpindle(event.rpm, 1 if event.sense is Sense.CLW else -1)


class ExpectedSpindles:
    """The spindle along an operation; ``before`` is its state when that begins, None if no SPINDL came yet."""

    def __init__(self, operation: Operation, before: ExpectedSpindle | None) -> None:
        self._rows: list[int] = []
        self._states = [before]
        for event in operation.events:
            last = self._states[-1]
            if isinstance(event, SpindleOn):
                self._rows.append(event.row)
                self._states.append(spindle_on(event))
            elif isinstance(event, SpindleOff):
                self._rows.append(event.row)
                self._states.append(ExpectedSpindle(last.rpm if last else 0.0, 0))

    def at(self, row: int) -> ExpectedSpindle | None:
        """Return the spindle at a row."""
        return self._states[bisect_right(self._rows, row)]
