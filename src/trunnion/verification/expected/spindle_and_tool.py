"""Spindle and tool as a CL file asks for them."""

from dataclasses import dataclass

from trunnion.model.toolpath import Operation, Sense, SpindleOff, SpindleOn


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
    """The spindle after a SPINDL that starts it."""
    return ExpectedSpindle(event.rpm, 1 if event.sense is Sense.CLW else -1)


def spindle_at(operation: Operation, row: int, before: ExpectedSpindle | None) -> ExpectedSpindle | None:
    """The spindle at a row; ``before`` is its state when the operation begins, None if no SPINDL came yet."""
    for event in operation.events:
        if event.row > row:
            break
        if isinstance(event, SpindleOn):
            before = spindle_on(event)
        elif isinstance(event, SpindleOff):
            before = ExpectedSpindle(before.rpm if before else 0.0, 0)
    return before
