"""What a file of hooks works with: the operations, events and blocks of a CL file, as records.

A hook changes what a CL file asks for, before it is planned; it sees and returns events and operations, and no text of
a program. A function at a place of output writes lines there, or changes words. A file of hooks is a Python file with
functions ``on_operation``, ``on_event`` and ``on_block``, or ``at_…`` for a place. It is run only when its user names
it: ``trunnion post … --hooks FILE.py``, or ``trunnion.post(…, hooks=["FILE.py"])``. docs/hooks.md tells how to write
one.

All records are frozen: ``dataclasses.replace`` makes a changed one. Lengths are in mm, angles in degrees, feeds in
mm/min or mm/rev; coordinates are those of the operation's own coordinate system.
"""

from collections.abc import Mapping, Sequence
from typing import Protocol

from trunnion.hooks.places import (
    AtPlace,
    CoolantPlace,
    CyclePlace,
    MotionPlace,
    OperationValues,
    Place,
    StopPlace,
    ToolValues,
)
from trunnion.model.toolpath import (
    Arcs,
    BlockSkip,
    Coolant,
    CutterComp,
    CycleOff,
    CycleOn,
    Dwell,
    Event,
    From,
    GoHome,
    Insert,
    Kind,
    LoadTool,
    Message,
    Moves,
    Operation,
    Phase,
    SelectTool,
    Sense,
    SetMode,
    SpindleOff,
    SpindleOn,
    Stop,
    Tool,
    UnknownStatement,
)
from trunnion.records import dataclass

__all__ = [
    "Arcs",
    "AtPlace",
    "Block",
    "BlockSkip",
    "Context",
    "Coolant",
    "CoolantPlace",
    "CutterComp",
    "CycleOff",
    "CycleOn",
    "CyclePlace",
    "Dwell",
    "Event",
    "From",
    "GoHome",
    "Insert",
    "Kind",
    "LoadTool",
    "Message",
    "MotionPlace",
    "Moves",
    "OnBlock",
    "OnEvent",
    "OnOperation",
    "Operation",
    "OperationValues",
    "Phase",
    "Place",
    "SelectTool",
    "Sense",
    "SetMode",
    "SpindleOff",
    "SpindleOn",
    "Stop",
    "StopPlace",
    "Tool",
    "ToolValues",
    "UnknownStatement",
]


@dataclass(frozen=True, slots=True, eq=False)
class Context:
    """Where a hook is called.

    file       the CL file
    operation  the operation, as hooks have left it so far
    number     of the operation in its file, from 1
    machine    name of the machine
    control    name of its control
    settings   of the run, as text
    """

    file: str
    operation: Operation
    number: int
    machine: str
    control: str
    settings: Mapping[str, str]


@dataclass(frozen=True, slots=True, eq=False)
class Block:
    """One point of an operation and the move to it; ``Moves`` has all of them as columns.

    row      index of the point in its operation, from 0
    tip      end point of the move, mm
    axis     tool axis there, unit vector from tip to holder
    kind     how the tip moves to it
    phase    the role of the move
    feed     mm/min, or mm/rev where ``per_rev``; NaN before the first FEDRAT
    per_rev  the feed is per spindle revolution
    line     of the CL file
    """

    row: int
    tip: tuple[float, float, float]
    axis: tuple[float, float, float]
    kind: Kind
    phase: Phase
    feed: float
    per_rev: bool
    line: int


class OnOperation(Protocol):
    """``on_operation``: called once for each operation."""

    def __call__(self, operation: Operation, context: Context) -> Operation | Sequence[Operation] | None:
        """Return what takes the operation's place, in order; none of it for an empty list, None for no change."""


class OnEvent(Protocol):
    """``on_event``: called for each event of an operation, also for statements that are not known."""

    def __call__(self, event: Event, context: Context) -> Event | Sequence[Event] | None:
        """Return what takes the event's place, in order; nothing for an empty list, None for no change.

        Rows and lines of what is returned become those of the event.
        """


class OnBlock(Protocol):
    """``on_block``: called for each point of an operation."""

    def __call__(self, block: Block, context: Context) -> Event | Sequence[Event] | None:
        """Return events that are added: before the block with its ``row``, behind it with ``row + 1``."""
