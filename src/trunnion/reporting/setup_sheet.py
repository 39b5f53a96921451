"""What a setup sheet says, as values from which its page and its data are made.

In:     a proven program: its verification, and what the post knows of tools, operations and files.
Out:    ``SetupSheet``.
Units:  mm, degrees, seconds, rev/min; feeds mm/min and mm/rev.

Text from outside is cleaned here of characters that no file can hold.
"""

from bisect import bisect_left
from collections.abc import Sequence
from dataclasses import replace
from operator import attrgetter
from typing import Annotated, ClassVar, Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.machines import Axis
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind
from trunnion.records import dataclass
from trunnion.reporting.content import ReportContent
from trunnion.reporting.extents import AxisExtent, BlockReference, block_reference
from trunnion.reporting.text import clean
from trunnion.results import FIRST, NOT_DATA, Figure, to_data
from trunnion.verification.results import OperationRows

#: Decimals of angles.
_DECIMALS: Final = 3

#: An axis that moves by less stands still, deg; so many positions at which it stands are named.
_STILL: Final = 1e-6
_MOST_POSITIONS: Final = 6

#: A lowest and a highest value.
Range = tuple[float, float]


@dataclass(frozen=True, slots=True)
class SheetTool:
    """A tool: ``call`` is what the program calls it by; lengths are 0 where they are not known.

    length      from the shoulder of its holder, as the CAM system states it
    stick_out   out of the holder
    set_length  in the spindle, from the gauge point to the tip
    register    number of its length, 0 for that of the tool
    operations  numbers of the operations that use it, from 1
    seconds     in cuts
    """

    call: str
    name: str
    kind: str
    diameter: float
    corner_radius: float
    length: float
    flute_length: float
    stick_out: float
    set_length: float
    holder: str
    register: int
    operations: tuple[int, ...]
    seconds: float


@dataclass(frozen=True, slots=True)
class CutRanges:
    """What a run does in the cuts of one operation, and where that begins.

    rotary  range of the primary and of the secondary rotary axis along its way; where that passes the end of
            the turn, the first is the greater one
    stands  where these stand in the cuts, in their order; empty for one that turns, or has many positions
    start   its first block
    """

    rotary: tuple[Range | None, ...]
    rpm: Range | None
    sense: str
    feed: Range | None
    feed_per_rev: Range | None
    coolant: str
    start: BlockReference | None
    stands: Annotated[tuple[tuple[float, ...], ...], NOT_DATA] = ()


@dataclass(frozen=True, slots=True)
class SheetOperation:
    """An operation: ``box`` has the lower and the upper corner of what the tip cuts, None if nothing.

    mode     such as ``three-axis``; several where it has several
    notes    radius compensation, pitches of taps, programmed stops, in words
    seconds  with what leads to it; ``cutting_seconds`` in cuts
    """

    number: int
    name: str
    method: str
    mode: str
    tool: str
    cl_file: str
    seconds: float
    cutting_seconds: float
    box: tuple[tuple[float, float, float], tuple[float, float, float]] | None
    cuts: Annotated[CutRanges, Figure(is_flat=True, after=FIRST)]
    notes: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class SheetFile:
    """A file of the program as it was written."""

    name: str
    size: int
    sha256: str


#: What the data of a sheet says of axes and checks.
_OF_AXIS: Final = ("name", "unit", "used", "limits", "endless", "placed", "margin")
_OF_CHECK: Final = ("key", "title", "state", "missing", "summary", "worst", "limit", "unit")


@dataclass(frozen=True, slots=True)
class SetupSheet:
    """Everything on the sheet.

    content     what the report says of checks, axes and times
    title       of the program, as it was set or as the CL file has it
    may_run     proven, and nothing was overruled
    simulated   whether its simulation found nothing; None: it was not simulated
    offsets     the work offsets that the program takes
    zero        where the workpiece zero is on the machine; None: it was not said
    system      which coordinate system the program counts in, in words
    start       what stands at its beginning, in sentences
    to_check    what the proof cannot see, in sentences
    rotary      names of the primary and of the secondary rotary axis
    picture     SVG of the set-up; empty: there is none
    untimed     what the times leave out, in words; empty: nothing
    """

    SCHEMA: ClassVar[int] = 3

    content: Annotated[
        ReportContent,
        Figure("program", take=attrgetter("program")),
        Figure("key", take=attrgetter("machine_key"), within="machine", after="simulation_passed"),
        Figure("name", take=attrgetter("machine"), within="machine"),
        Figure("control", take=lambda content: content.control or None),
        Figure("program_units", take=attrgetter("units"), after="made_by"),
        Figure("turn_deg", take=lambda content: content.clamping and content.clamping.turn, after="zero"),
        Figure("tilt_deg", take=lambda content: content.clamping and content.clamping.tilt),
        Figure("zeros", take=attrgetter("zeros"), after="work_offsets"),
        Figure("tool_lengths", take=attrgetter("lengths"), after="tool_length"),
        Figure("seconds", take=attrgetter("seconds"), after="coordinates"),
        Figure("cutting_seconds", take=attrgetter("cutting_seconds")),
        Figure("axes", take=lambda content: to_data(content.axes, only=_OF_AXIS), after="operations"),
        Figure("standing", take=attrgetter("standing"), after="to_check"),
        Figure("checks", take=lambda content: to_data(content.checks, only=_OF_CHECK)),
    ]
    version: Annotated[str, Figure("made_by", after="control")]
    title: Annotated[str, Figure(none="", after="program")]
    part: Annotated[str, Figure(none="", after="title")]
    may_run: bool
    simulated: Annotated[bool | None, Figure("simulation_passed")]
    offsets: Annotated[tuple[str, ...], Figure("work_offsets")]
    zero: tuple[float, float, float] | None
    tool_length: float | None
    system: Annotated[str, Figure("coordinates")]
    rotary: Annotated[tuple[str, ...], NOT_DATA]
    tools: tuple[SheetTool, ...]
    operations: Annotated[tuple[SheetOperation, ...], NOT_DATA]
    start: tuple[str, ...]
    to_check: tuple[str, ...]
    files: tuple[SheetFile, ...]
    picture: Annotated[str, NOT_DATA]
    untimed: Annotated[str, Figure("not_in_times", none="", after="cutting_seconds")] = ""

    @property
    @Figure("operations", after="tools")
    def operations_data(self) -> list[dict[str, object]]:
        """The operations as data, with the names of the rotary axes."""
        rotary = [dict(zip(self.rotary, each.cuts.rotary, strict=True)) for each in self.operations]
        return [{**to_data(each), "rotary": own} for each, own in zip(self.operations, rotary, strict=True)]


def cut_ranges(run: Run, operation: OperationRows) -> CutRanges:
    """Return what a run does in the cuts of an operation."""
    rows = slice(operation.first, operation.end)
    cuts = run.kind[rows] != Kind.RAPID
    feed, mode = run.feed[rows], run.feed_mode[rows]
    spindle = run.spindle[rows][cuts]
    senses = [word for sign, word in ((1, "clockwise"), (-1, "counterclockwise"), (0, "standing")) if sign in spindle]
    joints = run.joints[rows]
    first = bisect_left(run.events, operation.first, key=lambda event: event.before_row)
    end = bisect_left(run.events, operation.end, key=lambda event: event.before_row)
    # Coolant that the operation before has left on is on in this one.
    before = [event for event in run.events[:first] if event.kind == "coolant"][-1:]
    coolants = [str(event.value) for event in (*before, *run.events[first:end]) if event.kind == "coolant"]
    axes = run.machine.rotary_words
    stands = [_stands(run, operation.first + np.flatnonzero(cuts), k) for k in axes]
    return CutRanges(
        rotary=tuple(_turns(run, joints, k, cuts, each) for k, each in zip(axes, stands, strict=True)),
        rpm=_range(run.rpm[rows], cuts & (run.spindle[rows] != 0)),
        sense=", ".join(senses),
        feed=_range(feed, cuts & (mode == 94)),
        feed_per_rev=_range(feed, cuts & (mode == 95)),
        coolant=clean(", ".join(dict.fromkeys(each for each in coolants if each != "off"))),
        start=_start(run, operation),
        stands=tuple(stands),
    )


def _stands(run: Run, rows: Ints, k: int) -> tuple[float, ...]:
    """Return the displayed positions at which a rotary axis stands in the cuts of some rows; empty if it turns."""
    here, before = run.joints[rows, k], run.joints[np.maximum(rows - 1, 0), k]
    if not len(rows) or not np.isfinite(here).all() or np.abs(here - before).max() > _STILL:
        return ()
    positions = tuple(dict.fromkeys(run.machine.axes[k].displayed(here, _DECIMALS).tolist()))
    return positions if len(positions) <= _MOST_POSITIONS else ()


def displayed_extent(axis: Axis, extent: AxisExtent) -> AxisExtent:
    """Return the extent of an axis as the machine displays it; turns add up nowhere on an endless axis that
    shows one.
    """
    if extent.extremes is None or not axis.endless:
        return extent
    low, high = axis.displayed_range(extent.extremes.low, extent.extremes.high, _DECIMALS)
    return replace(extent, extremes=replace(extent.extremes, low=low, high=high))


def _turns(run: Run, joints: Floats, k: int, chosen: Flags, stands: Sequence[float]) -> Range | None:
    """Return the range of a rotary axis as the machine displays it; where it only stands, that of its positions."""
    if stands:
        return min(stands), max(stands)
    found = _range(joints[:, k], chosen)
    return None if found is None else run.machine.axes[k].displayed_range(*found, _DECIMALS)


def _start(run: Run, operation: OperationRows) -> BlockReference | None:
    """Where an operation begins: its first block, or its first motion where that is not known."""
    if operation.start is not None:
        return BlockReference(operation.start.line, operation.start.number, clean(operation.start.file))
    return block_reference(run, operation.first) if operation.end > operation.first else None


def _range(values: Floats, chosen: Flags) -> Range | None:
    found = values[chosen & np.isfinite(values)]
    return (float(found.min()), float(found.max())) if len(found) else None
