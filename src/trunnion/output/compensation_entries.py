"""What the operator enters for radius compensation: said in the head of the program, on the setup sheet and in the log.

Where the points of a CL file are those of the tool's centre that is a difference; where they are those of the contour,
the radius.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise

from trunnion.controls.definition import MM_PER_INCH
from trunnion.controls.vocabulary import ENTRY_NOTICE, INCH, MM, RADIUS_NUMBER_WORD, RADIUS_REGISTER_SETTING
from trunnion.errors import Problem, warning
from trunnion.messages import Wording
from trunnion.model.motion import Motion
from trunnion.model.toolpath import CutterComp
from trunnion.output.program import Program
from trunnion.output.tool_calls import ToolCalls
from trunnion.records import dataclass

#: The setting for what a tool call adds to the radius, on controls that have a word for it.
_ADDED: str = "delta_radius"

#: Of ``Control.radius_as_diameter``: the control knows diameters only.
_ALWAYS: str = "always"


@dataclass(frozen=True, slots=True)
class CompensationEntry:
    """What an operation compensates by.

    call      the tool as the program calls it
    register  D; 0: the radius in the tool table
    radius    of the tool in the CL file, mm; 0: not known
    holds     what the register holds: ``difference``, ``radius`` or ``unknown``
    contour   the path is that of the contour, and not that of the tool's centre
    doubled   when the control takes the diameter instead: ``always``, a condition, or never (empty)
    units     in which the program counts, and what is entered: ``mm`` or ``inch``
    """

    call: str
    register: int
    radius: float
    holds: str
    contour: bool
    doubled: str
    units: str

    @property
    def where(self) -> str:
        """Where it is entered, and when twice that is."""
        place = f"in D{self.register}" if self.register else "in the tool table"
        return f"{place}, twice that if {self.doubled_if}" if self.doubled_if else place

    @property
    def doubled_if(self) -> str:
        """On what condition the control takes the diameter instead; empty: on none."""
        return "" if self.doubled == _ALWAYS else self.doubled

    @property
    def size_name(self) -> str:
        """What of the tool is entered."""
        return "diameter" if self.doubled == _ALWAYS else "radius"

    @property
    def size(self) -> str:
        """Its size in the CL file, with its unit; empty: not known."""
        size = 2.0 * self.radius if self.doubled == _ALWAYS else self.radius
        if not size:
            return ""
        return f"{size:.10g} {MM}" if self.units == MM else f"{size / MM_PER_INCH:.5g} {INCH}"

    @property
    def value(self) -> str:
        """What is entered."""
        what, size = self.size_name, self.size
        if self.contour or self.holds == "radius":
            return f"the {what}"
        return f"the {what} minus {size}" if size else f"the {what} minus that of CAM"


def entries_at_control(program: Program) -> list[str]:
    """Return what the operator enters at the control, as head and log say it, each text once."""
    calls = [call for call, *_ in ToolCalls(program).calls]
    found = _entries(program, calls)
    return list(dict.fromkeys(f"{ENTRY_NOTICE} {each.call}: enter {each.value} {each.where}" for each in found))


def _entries(program: Program, calls: Sequence[str]) -> Iterator[CompensationEntry]:
    """Yield what each operation with CUTCOM compensates by; ``calls`` are the tools of all operations."""
    for motions, call in zip(motions_by_operation(program), calls, strict=True):
        yield from entries_of(program, motions, call)


def motions_by_operation(program: Program) -> list[Sequence[Motion]]:
    """Return the motions of each operation."""
    starts = [k for k, motion in enumerate(program.motions) if motion.starts_operation]
    return [program.motions[first:end] for first, end in pairwise([*starts, len(program.motions)])]


def unknown_radii(program: Program) -> Iterator[Problem]:
    """Yield a warning for each operation with CUTCOM along the tool's centre whose CL file states no radius."""
    for motion in program.motions:
        operation = motion.operation
        events = (event for event in operation.events if isinstance(event, CutterComp))
        on = next((event for event in events if event.side != "OFF" and not event.contour), None)
        if motion.starts_operation and on is not None and not operation.tool.diameter:
            yield warning(operation.file or program.file, on.line, Wording("SIM147", "difference_not_known"))


def entries_of(program: Program, motions: Sequence[Motion], call: str) -> Iterator[CompensationEntry]:
    """Yield what an operation compensates by, each entry once."""
    operation = motions[0].operation
    names_register = RADIUS_NUMBER_WORD in program.control.family.WORDS
    more = int(program.effective_setting("radius_offset", operation) or 0)
    own = int(call) + more if call.isdigit() else 0
    holds = program.effective_setting(RADIUS_REGISTER_SETTING, operation) or "unknown"
    registers = dict.fromkeys(
        ((event.register or own) if names_register else 0, event.contour)
        for motion in motions
        for event in motion.operation.events
        if isinstance(event, CutterComp) and event.side != "OFF"
    )
    for register, contour in registers:
        doubled = program.control.radius_as_diameter
        yield CompensationEntry(
            call, register, 0.5 * operation.tool.diameter, holds, contour, doubled, program.control.units
        )


def with_radius_taken_off(program: Program) -> Program:
    """Return a program whose tool calls take the radius off the one in the tool table, where that is what it holds.

    That is so on controls with a word for it (DR), for the tools of operations with CUTCOM along the tool's centre.
    """
    if _ADDED not in program.control.settings:
        return program
    operations = [motion.operation for motion in program.motions]
    compensated = {
        each.tool.name
        for each in operations
        if any(isinstance(event, CutterComp) and event.side != "OFF" and not event.contour for event in each.events)
    }
    own: dict[str, Mapping[str, str]] = {**program.own_settings}
    for each in operations:
        holds = program.effective_setting(RADIUS_REGISTER_SETTING, each)
        if each.tool.name in compensated and each.tool.diameter and holds == "radius":
            given = program.effective_setting(_ADDED, each)
            own[each.name] = {_ADDED: given or f"{-0.5 * each.tool.diameter:.4f}", **own.get(each.name, {})}
    return replace(program, own_settings=own)
