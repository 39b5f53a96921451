"""How far the tool tip and the axes travel in a program, and the blocks where they turn back.

Units:  mm and degrees.
"""

import math
from operator import attrgetter
from pathlib import Path
from typing import Annotated

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.machines import Axis, Machine, slide_positions
from trunnion.model.arc_extremes import Reach, RunArcs
from trunnion.model.programmed_words import names_no_axis
from trunnion.model.run import ProgrammedWord, Run
from trunnion.records import dataclass
from trunnion.reporting.text import clean
from trunnion.results import NOT_DATA, BlockNumber, Figure
from trunnion.verification.kinematics.unknown_approaches import unknown_approaches


@dataclass(frozen=True, slots=True)
class BlockReference:
    """A block of the program; ``file`` is the name of the subprogram it is in, empty for the program itself."""

    nc_line: int
    number: BlockNumber
    file: Annotated[str, Figure("nc_file", none="")] = ""


@dataclass(frozen=True, slots=True)
class Extremes:
    """Lowest and highest value of a quantity, and the blocks that reach them."""

    low: float
    high: float
    low_at: BlockReference
    high_at: BlockReference


@dataclass(frozen=True, slots=True)
class TipExtent:
    """Extremes of the tip along one direction of the workpiece frame, mm; ``cutting`` is without rapids."""

    name: Annotated[str, Figure(), Figure("unit", take=lambda _: "mm")]
    whole: Extremes | None
    cutting: Extremes | None


@dataclass(frozen=True, slots=True)
class AxisExtent:
    """Extremes of an axis, and its limits.

    zero_known  whether values and limits count from the same zero: not for slides without a workpiece zero, nor for
                those that depend on the tool length without that; their values count from the workpiece zero
    margin      distance to the nearer limit, or the part of the travel that is left where the zero is not known;
                negative if exceeded
    """

    name: str
    unit: Annotated[str, Figure(take=lambda unit: "deg" if unit == "°" else unit)]
    extremes: Annotated[
        Extremes | None,
        Figure("whole"),
        Figure("used", take=attrgetter("low", "high"), is_extra=True),
        Figure("low", take=attrgetter("low"), is_extra=True),
        Figure("high", take=attrgetter("high"), is_extra=True),
    ]
    low_limit: Annotated[float | None, NOT_DATA]
    high_limit: Annotated[float | None, NOT_DATA]
    endless: bool
    zero_known: Annotated[bool, Figure("placed"), Figure("zero_known", is_extra=True)]
    margin: float | None

    @property
    @Figure(after="whole")
    def limits(self) -> tuple[float | None, float | None]:
        """Low and high limit."""
        return self.low_limit, self.high_limit


def block_reference(run: Run, row: int) -> BlockReference:
    """Return the block of a row."""
    file = int(run.file[row])
    return BlockReference(
        int(run.line[row]), int(run.block_number[row]), clean(Path(run.files[file]).name) if file else ""
    )


def tip_extent(run: Run, k: int, cutting: Flags, arcs: RunArcs) -> TipExtent:
    """Return the extent of the tip along direction ``k``; ``cutting`` (n,) is False for rapids."""
    column = run.tip[:, k]
    whole, cut = (
        extremes_of(run, *_with_arcs(column[rows], rows, arcs, arcs.tip, k))
        for rows in (np.arange(len(run)), np.flatnonzero(cutting))
    )
    return TipExtent("XYZ"[k], whole, cut)


def axis_extent(run: Run, k: int, axis: Axis, arcs: RunArcs) -> AxisExtent:
    """Return the extent of an axis, which is column ``k`` of ``run.joints``."""
    rows, zero_known = travel_rows(run, axis), is_zero_known(run, k)
    values, of_rows = _with_arcs(run.joints[rows, k], rows, arcs, arcs.axes, k)
    zero = 0.0 if zero_known else float(at_workpiece_zero(run.machine)[k])
    return extent_of(run, axis, values - zero, of_rows, zero_known=zero_known)


def at_workpiece_zero(machine: Machine) -> Floats:
    """Axis values with the tip at the workpiece zero and the rotary axes at zero, (5,) mm and degrees.

    From there positions count that nobody can place on the machine: a gauge point is not at the zero of its slides.
    """
    return np.asarray(slide_positions(machine, np.zeros((1, 3)), np.zeros((1, 2)))[0])


def _with_arcs(values: Floats, rows: Ints, arcs: RunArcs, reach: Reach, k: int) -> tuple[Floats, Ints]:
    """Values at the ends of rows, and on those that are arcs between them, with their rows."""
    count = np.isin(arcs.rows, rows)
    between = arcs.rows[count]
    return np.concatenate((values, reach.low[count, k], reach.high[count, k])), np.concatenate((rows, between, between))


def extent_of(run: Run, axis: Axis, values: Floats, rows: Ints, *, zero_known: bool) -> AxisExtent:
    """Return the extent of an axis that has taken values (k,) in rows (k,)."""
    extremes = extremes_of(run, values, rows)
    low, high = (value if math.isfinite(value) else None for value in (axis.low, axis.high))
    return AxisExtent(
        name=clean(axis.name),
        unit="°" if axis.is_rotary else "mm",
        extremes=extremes,
        low_limit=low,
        high_limit=high,
        endless=axis.endless,
        zero_known=zero_known,
        margin=None if axis.endless or extremes is None else _margin(extremes, low, high, zero_known),
    )


def is_zero_known(run: Run, k: int) -> bool:
    """Whether the values of axis ``k`` can be compared with its limits: slides take workpiece zero and tool length."""
    return run.machine.is_placed(k)


def travel_rows(run: Run, axis: Axis) -> Ints:
    """Rows that count for the travel of an axis, as for the check: for a slide, not those in machine coordinates.

    On the first leg of an approach the tool is still as high as before it, which may be known to nobody.
    """
    if axis.is_rotary:
        return np.arange(len(run))
    linear = ProgrammedWord.X | ProgrammedWord.Y | ProgrammedWord.Z
    counts = ~run.machine_frame & (
        run.state.follows(0, len(run)) | ((run.programmed & linear) != 0) | names_no_axis(run.programmed)
    )
    counts[unknown_approaches(run).rows] = False
    return np.flatnonzero(counts)


def extremes_of(run: Run, values: Floats, rows: Ints) -> Extremes | None:
    """Extremes of values (k,), and the blocks of their rows (k,); None if no value is finite."""
    known = np.flatnonzero(np.isfinite(values))
    if not len(known):
        return None
    low, high = int(known[np.argmin(values[known])]), int(known[np.argmax(values[known])])
    at = block_reference(run, int(rows[low])), block_reference(run, int(rows[high]))
    return Extremes(float(values[low]), float(values[high]), *at)


def _margin(extremes: Extremes, low: float | None, high: float | None, zero_known: bool) -> float | None:
    """Distance from the extremes to the nearer limit; None if it cannot be told."""
    if not zero_known:
        return None if low is None or high is None else (high - low) - (extremes.high - extremes.low)
    margins = [extremes.low - low] if low is not None else []
    margins += [high - extremes.high] if high is not None else []
    return min(margins, default=None)
