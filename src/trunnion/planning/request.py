"""What the stages of planning hand to each other: the request, and operations prepared for it."""

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property

from trunnion.arrays import Floats, Ints
from trunnion.errors import Problem
from trunnion.machines import Machine
from trunnion.messages import Wording
from trunnion.model.motion import Decision, DecisionTopic, MachiningMode
from trunnion.model.toolpath import Frame, Operation
from trunnion.planning.linearization.arc_chords import source_rows
from trunnion.planning.machining_mode import machine_x_direction, tilted_plane
from trunnion.planning.options import ControlCapabilities, PlanOptions
from trunnion.records import dataclass


@dataclass(frozen=True, slots=True, eq=False)
class PlanRequest:
    """Everything but the toolpaths.

    chord_tolerance  for arcs that become lines, mm
    frame_remedy     what the cure of a tool axis out of reach says of the program's coordinate system; may be empty
    """

    machine: Machine
    chord_tolerance: float
    options: PlanOptions
    capabilities: ControlCapabilities
    frame_remedy: Wording | str = ""

    @property
    def keeps_slide_limits(self) -> bool:
        """Whether the slides' limits hold: only a known workpiece zero says where the slides are."""
        return self.machine.workpiece_zero is not None


@dataclass(frozen=True, slots=True)
class OperationPart:
    """Rows ``first`` to ``end`` (exclusive) of an operation that are made by themselves.

    ends_in_hole  the last row is that of a hole that is made as motion
    """

    first: int
    end: int
    ends_in_hole: bool = False


@dataclass(frozen=True, eq=False)
class PreparedOperation:
    """An operation in the form in which the machine makes it, before axis positions are chosen.

    file       its CL file
    original   as the CL file has it, arcs and cycles included
    operation  in the program's coordinate system, with the arcs and cycles that the control takes; the rest is rows
    own_frame  its own coordinate system, seen from the program's
    parts      parts in planes of their own, or between which the tool goes home; empty: it is made in one
    warnings   about its mode and its holes
    log        holes that became motion
    """

    request: PlanRequest
    file: str
    original: Operation
    operation: Operation
    own_frame: Frame
    mode: MachiningMode
    parts: Sequence[OperationPart] = ()
    warnings: Sequence[Problem] = ()
    log: Sequence[Decision] = ()

    @cached_property
    def source_rows(self) -> Ints:
        """(n,) int64: the CL row that each row belongs to; rows that share one are lines for its arc."""
        return source_rows(self.original, self.operation)

    def with_operation(self, operation: Operation) -> "PreparedOperation":
        """Return the same with other tool axes or feeds; rows stay."""
        return replace(self, operation=operation)

    def plane(self, axis: Floats, rotary: Floats) -> Frame | None:
        """Return the tilted plane under a tool axis (3,) at rotary positions (2,), degrees; None in other modes."""
        if self.mode is not MachiningMode.TILTED:
            return None
        machine, capabilities = self.request.machine, self.request.capabilities
        x_direction = machine_x_direction(machine, rotary) if capabilities.plane_x_from_machine else None
        return tilted_plane(axis, self.own_frame, x_direction)

    def decision(self, row: int, topic: DecisionTopic, said: Wording) -> Decision:
        """Return a decision about a row; -1: about the whole operation."""
        line = int(self.operation.moves.line[max(row, 0)])
        return Decision(self.file, self.operation.name, line, row, topic, said)
