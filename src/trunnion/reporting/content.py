"""What a report says in words and tables, as values: the page and the data are made of these.

In:     a ``Verification``.
Out:    ``ReportContent``: checks with their places, tools, times, extents.
Units:  mm, degrees, seconds, rev/min, mm/min.

Text that came from outside is cleaned here of what no file can carry; escaping is the business of each form.
"""

import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.machines import Axis
from trunnion.model.run import ProgrammedWord, Run
from trunnion.model.toolpath import Kind
from trunnion.verification.results import Check, OperationRows, Verification

#: Control characters but tab and line feed; no form can hold all of them.
_CONTROL = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\ufffe\uffff]")


@dataclass(frozen=True, slots=True)
class BlockReference:
    """A block of the program; ``file`` is empty in the program itself and the name of a subprogram elsewhere."""

    nc_line: int
    number: int
    file: str = ""


@dataclass(frozen=True, slots=True)
class Extremes:
    """Lowest and highest value of something, and the blocks that reach them."""

    low: float
    high: float
    low_at: BlockReference
    high_at: BlockReference


@dataclass(frozen=True, slots=True)
class TipExtent:
    """Where the tip goes along one direction of the workpiece frame, mm; ``cutting`` leaves rapids out."""

    name: str
    whole: Extremes | None
    cutting: Extremes | None


@dataclass(frozen=True, slots=True)
class AxisExtent:
    """Where an axis goes, and what it may.

    placed   whether values and limits count from the same zero; not so for slides of a machine without workpiece zero
    margin   the smaller distance to a limit, or what is left of the travel where not placed; negative: too much
    """

    name: str
    unit: str
    extremes: Extremes | None
    low_limit: float | None
    high_limit: float | None
    endless: bool
    has_known_zero: bool
    margin: float | None


@dataclass(frozen=True, slots=True)
class ToolUsage:
    """What one tool does; ``rpm`` and ``feed`` (mm/min) are lowest and highest while cutting, None where not stated."""

    name: str
    motions: int
    seconds: float
    cutting_seconds: float
    rapid_seconds: float
    rpm: tuple[float, float] | None
    feed: tuple[float, float] | None
    first: BlockReference


@dataclass(frozen=True, slots=True)
class OperationUsage:
    """What one operation of a CL file takes, with the way to it; ``first`` is None where no motion belongs to it."""

    name: str
    tool: str
    cl_file: str
    motions: int
    seconds: float
    cutting_seconds: float
    rapid_seconds: float
    first: BlockReference | None


@dataclass(frozen=True, slots=True)
class PlanDecision:
    """Why something was planned as it was: the operation, the place in its CL file, what it is about, and the words."""

    operation: str
    cl_file: str
    cl_line: int
    about: str
    text: str


@dataclass(frozen=True, slots=True)
class ReportContent:
    """All that a report says besides the plots; ``untimed`` counts motions whose time nobody knows."""

    program: str
    machine_key: str
    machine: str
    control: str
    made: str
    passed: bool
    checks: tuple[Check, ...]
    motions: int
    seconds: float
    cutting_seconds: float
    rapid_seconds: float
    untimed: int
    tools: tuple[ToolUsage, ...]
    operations: tuple[OperationUsage, ...]
    decisions: tuple[PlanDecision, ...]
    tip: tuple[TipExtent, ...]
    axes: tuple[AxisExtent, ...]


def collect_content(
    verification: Verification, control: str = "", made: str = "", decisions: Sequence[PlanDecision] = ()
) -> ReportContent:
    """Gather what a report says of a verification."""
    run, machine = verification.run, verification.machine
    seconds, known = durations(verification)
    cutting = run.kind != Kind.RAPID
    return ReportContent(
        program=clean(verification.program),
        machine_key=clean(machine.key),
        machine=clean(machine.name),
        control=clean(control or _control(verification)),
        made=clean(made),
        passed=verification.passed,
        checks=tuple(map(_clean_check, verification.checks)),
        motions=len(run),
        seconds=math.fsum(seconds),
        cutting_seconds=math.fsum(seconds[cutting]),
        rapid_seconds=math.fsum(seconds[~cutting]),
        untimed=int(np.count_nonzero(~known)),
        tools=tuple(_tools(run, seconds, cutting)),
        operations=tuple(_operation(run, operation, seconds, cutting) for operation in verification.operations),
        decisions=tuple(map(_clean_decision, decisions)),
        tip=tuple(_tip(run, k, cutting) for k in range(3)),
        axes=tuple(_axis(run, k, axis) for k, axis in enumerate(machine.axes)),
    )


def durations(verification: Verification) -> tuple[Floats, Flags]:
    """Seconds of each row, (n,) float64, 0 where they are not known; and whether they are, (n,) bool."""
    known = np.isfinite(verification.seconds) & (verification.seconds >= 0.0)
    return np.where(known, verification.seconds, 0.0), known


def clean(text: str) -> str:
    """Return the text without what UTF-8, HTML or JSON cannot carry; each such character becomes U+FFFD.

    >>> clean("hub\\x00 \\udcff 轮毂")
    'hub\ufffd \ufffd 轮毂'
    """
    return _CONTROL.sub("\ufffd", text.encode("utf-16", "surrogatepass").decode("utf-16", "replace"))


def _clean_check(check: Check) -> Check:
    places = tuple(replace(place, text=clean(place.text), cl_file=clean(place.cl_file)) for place in check.places)
    return replace(
        check,
        key=clean(check.key),
        title=clean(check.title),
        summary=clean(check.summary),
        unit=clean(check.unit),
        places=places,
    )


def _control(verification: Verification) -> str:
    """Name of the control as far as the machine's definition says it without the definition of the control."""
    table = verification.machine.control.to_dict()
    return next((str(table[key]) for key in ("name", "extends", "family") if table.get(key)), "")


def _block_reference(run: Run, row: int) -> BlockReference:
    file = int(run.file[row])
    return BlockReference(
        int(run.line[row]), int(run.block_number[row]), clean(Path(run.files[file]).name) if file else ""
    )


def _extremes(run: Run, values: Floats, rows: Ints | None = None) -> Extremes | None:
    """Extremes of a column, over some rows or all; None where there is no finite value."""
    chosen = np.flatnonzero(np.isfinite(values)) if rows is None else rows[np.isfinite(values[rows])]
    if not len(chosen):
        return None
    low, high = (int(chosen[np.argmin(values[chosen])]), int(chosen[np.argmax(values[chosen])]))
    return Extremes(float(values[low]), float(values[high]), _block_reference(run, low), _block_reference(run, high))


def _tip(run: Run, k: int, cutting: Flags) -> TipExtent:
    return TipExtent("XYZ"[k], _extremes(run, run.tip[:, k]), _extremes(run, run.tip[:, k], np.flatnonzero(cutting)))


def has_known_zero(run: Run, axis: Axis) -> bool:
    """Whether the values of an axis can be held against its limits: slides need a known workpiece zero for that."""
    return axis.is_rotary or run.machine.workpiece_zero is not None


def travel_rows(run: Run, axis: Axis) -> Ints:
    """Rows whose values count for the travel of an axis: a slide's not where they are from the machine's zero."""
    slide = ~run.machine_frame & (
        run.tcp | ((run.programmed & (ProgrammedWord.X | ProgrammedWord.Y | ProgrammedWord.Z)) != 0)
    )
    return np.flatnonzero(np.ones(len(run), np.bool_) if axis.is_rotary else slide)


def _axis(run: Run, k: int, axis: Axis) -> AxisExtent:
    extremes = _extremes(run, run.joints[:, k], travel_rows(run, axis))
    low, high = (value if math.isfinite(value) else None for value in (axis.low, axis.high))
    margins: list[float] = []
    if extremes and not axis.endless and has_known_zero(run, axis):
        margins += [extremes.low - low] if low is not None else []
        margins += [high - extremes.high] if high is not None else []
    elif extremes and not axis.endless and low is not None and high is not None:
        margins = [(high - low) - (extremes.high - extremes.low)]
    return AxisExtent(
        name=clean(axis.name),
        unit="°" if axis.is_rotary else "mm",
        extremes=extremes,
        low_limit=low,
        high_limit=high,
        endless=axis.endless,
        has_known_zero=has_known_zero(run, axis),
        margin=min(margins, default=None),
    )


def _tools(run: Run, seconds: Floats, cutting: Flags) -> Iterator[ToolUsage]:
    """Yield the tools in the order of their first motion."""
    indices, first = np.unique(run.tool, return_index=True)
    for k in np.argsort(first):
        used = run.tool == indices[k]
        cuts = used & cutting
        per_minute = cuts & (run.feed_mode == 94)
        yield ToolUsage(
            name=clean(run.tools[indices[k]]),
            motions=int(np.count_nonzero(used)),
            seconds=math.fsum(seconds[used]),
            cutting_seconds=math.fsum(seconds[cuts]),
            rapid_seconds=math.fsum(seconds[used & ~cutting]),
            rpm=_range(run.rpm[cuts & (run.spindle != 0)]),
            feed=_range(run.feed[per_minute]),
            first=_block_reference(run, int(first[k])),
        )


def _operation(run: Run, operation: OperationRows, seconds: Floats, cutting: Flags) -> OperationUsage:
    rows = slice(operation.first, operation.end)
    return OperationUsage(
        name=clean(operation.name),
        tool=clean(operation.tool),
        cl_file=clean(operation.cl_file),
        motions=operation.end - operation.first,
        seconds=math.fsum(seconds[rows]),
        cutting_seconds=math.fsum(seconds[rows][cutting[rows]]),
        rapid_seconds=math.fsum(seconds[rows][~cutting[rows]]),
        first=_block_reference(run, operation.first) if operation.end > operation.first else None,
    )


def _clean_decision(decision: PlanDecision) -> PlanDecision:
    return replace(
        decision,
        operation=clean(decision.operation),
        cl_file=clean(decision.cl_file),
        about=clean(decision.about),
        text=clean(decision.text),
    )


def _range(values: Floats) -> tuple[float, float] | None:
    finite = values[np.isfinite(values)]
    return (float(finite.min()), float(finite.max())) if len(finite) else None


def finite_or_none(value: float | None) -> float | None:
    """Return the value, or None for what JSON has no word for."""
    return value if value is not None and math.isfinite(value) else None
