"""What a report shows in words and tables, as values from which the HTML page and the JSON file are made.

In:     a ``Verification`` and the decisions of the planner.
Out:    ``ReportContent``: checks with their places, tools, operations, times, decisions, extents.
Units:  mm, degrees, seconds, rev/min, mm/min.

Text from outside is cleaned here of characters that no file can hold.
"""

import math
from collections.abc import Sequence
from dataclasses import replace
from operator import attrgetter
from pathlib import Path
from typing import Annotated, ClassVar, Final, Literal

import numpy as np

from trunnion.errors import Problem, Severity
from trunnion.machines import Machine
from trunnion.messages import Wording
from trunnion.model.arc_extremes import RunArcs
from trunnion.model.clamping import Clamping
from trunnion.model.motion import Decision
from trunnion.model.toolpath import Kind
from trunnion.records import dataclass
from trunnion.reporting.extents import AxisExtent, TipExtent, axis_extent, tip_extent
from trunnion.reporting.recorded_content import RecordedContent, recorded_content
from trunnion.reporting.remarks import RemarkGroup, remark_groups
from trunnion.reporting.set_up_values import OffsetZero, ToolLength, lengths_of, zeros_of
from trunnion.reporting.simulation_content import SimulationContent
from trunnion.reporting.text import clean
from trunnion.reporting.usage import OperationUsage, ToolUsage, operation_usage, tool_usages
from trunnion.results import NOT_DATA, Figure, OptionalText
from trunnion.verification import Standing, Verdict
from trunnion.verification.results import Check, Place, Verification, durations, moving_seconds

#: Units of a program by whether they are inches.
_UNITS: Final = {False: "mm", True: "inch"}


@dataclass(frozen=True, slots=True)
class ReportContent:
    """Everything in a report except its plots.

    ``command`` has made it. ``rapids`` counts rapid motions, ``untimed`` motions whose time is not known; ``units`` are
    those that the program counts in, which the report does not: its lengths are mm.
    """

    SCHEMA: ClassVar[int] = 2

    program: str
    machine_key: Annotated[str, Figure("key", within="machine")]
    machine: Annotated[str, Figure("name", within="machine")]
    control: OptionalText
    made: OptionalText
    standing: Annotated[Standing, Figure("passed", take=attrgetter("passed")), Figure(after="passed")]
    checks: tuple[Check, ...]
    motions: int
    seconds: Annotated[float, Figure(within="time")] = 0.0
    cutting_seconds: Annotated[float, Figure(within="time")] = 0.0
    rapid_seconds: Annotated[float, Figure(within="time")] = 0.0
    waiting_seconds: Annotated[float, Figure(within="time")] = 0.0
    rapids: Annotated[int, NOT_DATA] = 0
    untimed: Annotated[int, Figure("motions_without_time", within="time")] = 0
    tools: tuple[ToolUsage, ...] = ()
    operations: tuple[OperationUsage, ...] = ()
    decisions: tuple[Decision, ...] = ()
    tip: Annotated[tuple[TipExtent, ...], Figure(within="extents")] = ()
    axes: Annotated[tuple[AxisExtent, ...], Figure(within="extents")] = ()
    units: Annotated[tuple[str, ...], Figure("program_units", after="made")] = ()
    remarks: Annotated[tuple[RemarkGroup, ...], Figure(after="checks")] = ()
    simulation: Annotated[
        SimulationContent | None, Figure(take=attrgetter("data"), is_optional=True, after="operations")
    ] = None
    recorded: Annotated[RecordedContent | None, Figure(is_optional=True, after="simulation")] = None
    command: Annotated[Literal["post", "verify"], Figure(after="program")] = "verify"
    clamping: Annotated[
        Clamping | None,
        Figure("turn_deg", take=attrgetter("turn"), after="program_units"),
        Figure("tilt_deg", take=attrgetter("tilt")),
    ] = None
    zeros: Annotated[tuple[OffsetZero, ...], Figure("work_offsets", after="tilt_deg")] = ()
    lengths: Annotated[tuple[ToolLength, ...], Figure("tool_lengths", after="work_offsets")] = ()

    @property
    def verdict(self) -> Verdict:
        """What the page says at its head: that of the proof, in part where a simulation only warns of what it found."""
        own = self.standing.verdict
        warned = self.simulation is not None and not self.simulation.passed
        return Verdict.IN_PART if warned and own is Verdict.PASSED else own


def collect_content(
    verification: Verification,
    control: str = "",
    made: str = "",
    decisions: Sequence[Decision] = (),
    simulation: SimulationContent | None = None,
) -> ReportContent:
    """Collect the content of a report; the arguments are those of ``trunnion.reporting.write_report``."""
    run, machine = verification.run, verification.machine
    seconds, known = durations(verification)
    arcs, moving = RunArcs.of(run), moving_seconds(verification)
    cutting = run.kind != Kind.RAPID
    return ReportContent(
        program=clean(verification.program),
        machine_key=clean(machine.key),
        machine=clean(machine.name),
        control=clean(control or _control_name(machine)),
        made=clean(made),
        standing=verification.standing,
        checks=tuple(map(_clean_check, verification.checks)),
        motions=len(run),
        seconds=math.fsum(seconds),
        cutting_seconds=math.fsum(moving[cutting]),
        rapid_seconds=math.fsum(moving[~cutting]),
        waiting_seconds=math.fsum(seconds - moving),
        rapids=int(np.count_nonzero(~cutting)),
        untimed=int(np.count_nonzero(~known)),
        tools=tuple(tool_usages(run, seconds, moving, cutting)),
        operations=tuple(operation_usage(run, each, seconds, moving, cutting) for each in verification.operations),
        decisions=tuple(map(_clean_decision, decisions)),
        tip=tuple(tip_extent(run, k, cutting, arcs) for k in range(3)),
        axes=tuple(axis_extent(run, k, axis, arcs) for k, axis in machine.own_columns),
        units=tuple(_UNITS[inches] for inches in dict.fromkeys(run.state.inches.values.tolist())),
        simulation=simulation,
        recorded=recorded_content(verification),
        clamping=verification.clamping,
        remarks=remark_groups(verification.remarks),
        zeros=zeros_of(run),
        lengths=lengths_of(run),
    )


def refused_content(machine: Machine, program: str, problems: Sequence[Problem]) -> ReportContent:
    """Return the content for a program that ``post`` refused before it was run: one check, with problems as places."""
    errors = [problem for problem in problems if problem.severity is Severity.ERROR]
    places = tuple(
        Place(0, -1, math.nan, problem.wording.with_cure(), problem.file, problem.line, code=problem.code)
        for problem in sorted(problems, key=lambda problem: problem.severity is not Severity.ERROR)
    )
    refused = Wording("program", "refused_for", fault=errors[0].wording) if errors else Wording("program", "refused")
    check = Check("program", False, refused, places=places)
    return ReportContent(
        program=clean(program),
        machine_key=clean(machine.key),
        machine=clean(machine.name),
        control=clean(_control_name(machine)),
        made="",
        command="post",
        standing=Standing(passed=False, ok=0, failed=1, not_checked=0, warnings=len(problems) - len(errors)),
        checks=(_clean_check(check),),
        motions=0,
    )


def _control_name(machine: Machine) -> str:
    """Name of the control, as far as the machine's definition gives it without that of the control."""
    table = machine.control.to_dict()
    return next((str(table[key]) for key in ("name", "extends", "family") if table.get(key)), "")


def _clean_check(check: Check) -> Check:
    places = tuple(
        replace(
            place,
            wording=place.wording.changed(clean),
            cl_file=clean(place.cl_file),
            nc_file=clean(Path(place.nc_file).name),
        )
        for place in check.places
    )
    return replace(
        check,
        key=clean(check.key),
        answer=check.answer and check.answer.changed(clean),
        unit=clean(check.unit),
        missing=tuple(wording.changed(clean) for wording in check.missing),
        places=places,
    )


def _clean_decision(decision: Decision) -> Decision:
    return replace(
        decision, operation=clean(decision.operation), file=clean(decision.file), said=decision.said.changed(clean)
    )
