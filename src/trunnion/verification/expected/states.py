"""Modal state that the CL files ask for, as ranges of CL rows: spindle, coolant, radius compensation, tool."""

from collections.abc import Iterator, Sequence
from typing import Generic, TypeVar

from trunnion.model.toolpath import Coolant, CutterComp, LoadTool, SpindleOff, SpindleOn
from trunnion.records import dataclass
from trunnion.verification.expected.path import ExpectedPath, Section
from trunnion.verification.expected.spindle_and_tool import ExpectedSpindle, ExpectedTool, spindle_on

#: Radius compensation to either side of the path.
_SIDES = {"LEFT": 1, "RIGHT": -1}

T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class StateRange(Generic[T]):
    """CL rows ``first`` to ``end`` (exclusive) ask for ``value``."""

    first: int
    end: int
    value: T


def spindle_states(expected: ExpectedPath) -> list[StateRange[ExpectedSpindle | None]]:
    """Spindle states, None before the first SPINDL. An operation starts with the spindle as it was last switched on."""
    last: ExpectedSpindle | None = None
    states: list[StateRange[ExpectedSpindle | None]] = []
    for section in expected.sections:
        changes: list[tuple[int, ExpectedSpindle | None]] = [(0, last)]
        for event in section.operation.events:
            if isinstance(event, SpindleOn):
                last = spindle_on(event)
                changes.append((event.row, last))
            elif isinstance(event, SpindleOff):
                changes.append((event.row, ExpectedSpindle(last.rpm if last else 0.0, 0)))
        states += _ranges(section, changes)
    return states


def coolant_states(expected: ExpectedPath) -> list[StateRange[str]]:
    """Coolant words of the CL file. An operation starts with coolant off."""
    states: list[StateRange[str]] = []
    for section in expected.sections:
        events = [event for event in section.operation.events if isinstance(event, Coolant)]
        states += _ranges(section, [(0, "OFF"), *((event.row, event.kind) for event in events)])
    return states


def all_spindles(expected: ExpectedPath) -> set[ExpectedSpindle]:
    """Every spindle that a CL file starts, also where nothing moves before it is switched again."""
    events = (event for section in expected.sections for event in section.operation.events)
    return {spindle_on(event) for event in events if isinstance(event, SpindleOn)}


def all_coolants(expected: ExpectedPath) -> set[str]:
    """Every coolant word of a CL file, also where nothing moves before it is switched again."""
    events = (event for section in expected.sections for event in section.operation.events)
    return {event.kind for event in events if isinstance(event, Coolant)}


@dataclass(frozen=True, slots=True)
class ExpectedCompensation:
    """Radius compensation: ``side`` 1 left, -1 right, 0 off; ``register`` of the radius, 0 if no number is known.

    ``contour``: the points are those of the contour, and the tool's centre goes the radius beside them.
    """

    side: int = 0
    register: int = 0
    contour: bool = False


def compensation_states(expected: ExpectedPath) -> list[StateRange[ExpectedCompensation]]:
    """Radius compensation, off where an operation starts; ON is the last side, the register CUTCOM's or the tool's."""
    states: list[StateRange[ExpectedCompensation]] = []
    number = 0
    for section in expected.sections:
        changes = [(0, ExpectedCompensation())]
        last = 0
        for event in section.operation.events:
            if isinstance(event, LoadTool):
                number = event.number
            elif isinstance(event, CutterComp):
                last = _SIDES.get(event.side, last)
                called = section.settings.tool
                own = int(called) if called.isdigit() else number
                own += section.settings.radius_offset if own else 0
                side = 0 if event.side == "OFF" else last
                changes.append((event.row, ExpectedCompensation(side, event.register or own, event.contour)))
        states += _ranges(section, changes)
    return states


def tool_states(expected: ExpectedPath) -> list[StateRange[ExpectedTool]]:
    """Tools. An operation starts with the tool of the one before, unless it has another name for its own."""
    tool = ExpectedTool(None)
    states: list[StateRange[ExpectedTool]] = []
    for section in expected.sections:
        tool = tool.of_operation(section.operation.tool.name, section.settings.tool)
        changes = [(0, tool)]
        for event in section.operation.events:
            if isinstance(event, LoadTool):
                tool = ExpectedTool(event.number, event.adjust, tool.name, tool.called)
                changes.append((event.row, tool))
        states += _ranges(section, changes)
    return states


def _ranges(section: Section, changes: Sequence[tuple[int, T]]) -> Iterator[StateRange[T]]:
    """Ranges between changes at rows of an operation, in order; of several changes at one row the last one counts."""
    ends = [row for row, _ in changes[1:]] + [len(section.operation.moves)]
    for (row, value), end in zip(changes, ends, strict=True):
        if end > row:
            yield StateRange(section.first + row, section.first + end, value)
