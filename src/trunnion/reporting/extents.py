"""How far the tool tip and the axes travel in a program, and the blocks where they turn back.

Units:  mm and degrees.
"""

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.machines import Axis
from trunnion.model.arc_extremes import Reach, RunArcs
from trunnion.model.run import ProgrammedWord, Run
from trunnion.reporting.text import clean
from trunnion.verification.kinematics.positioning_moves import approach_rows, names_no_axis


@dataclass(frozen=True, slots=True)
class BlockReference:
    """A block of the program; ``file`` is the name of the subprogram it is in, empty for the program itself."""

    nc_line: int
    number: int
    file: str = ""


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

    name: str
    whole: Extremes | None
    cutting: Extremes | None


@dataclass(frozen=True, slots=True)
class AxisExtent:
    """Extremes of an axis, and its limits.

    zero_known  whether values and limits count from the same zero: not for slides without a workpiece zero, nor for
                those that depend on the tool length without that
    margin      distance to the nearer limit, or the part of the travel that is left where the zero is not known;
                negative if exceeded
    """

    name: str
    unit: str
    extremes: Extremes | None
    low_limit: float | None
    high_limit: float | None
    endless: bool
    zero_known: bool
    margin: float | None


def block_reference(run: Run, row: int) -> BlockReference:
    """The block of a row."""
    file = int(run.file[row])
    return BlockReference(
        int(run.line[row]), int(run.block_number[row]), clean(Path(run.files[file]).name) if file else ""
    )


def tip_extent(run: Run, k: int, cutting: Flags, arcs: RunArcs) -> TipExtent:
    """The extent of the tip along direction ``k``; ``cutting`` (n,) is False for rapids."""
    column = run.tip[:, k]
    whole, cut = (
        extremes_of(run, *_with_arcs(column[rows], rows, arcs, arcs.tip, k))
        for rows in (np.arange(len(run)), np.flatnonzero(cutting))
    )
    return TipExtent("XYZ"[k], whole, cut)


def axis_extent(run: Run, k: int, axis: Axis, arcs: RunArcs) -> AxisExtent:
    """The extent of an axis, which is column ``k`` of ``run.joints``."""
    rows = travel_rows(run, axis)
    values, of_rows = _with_arcs(run.joints[rows, k], rows, arcs, arcs.axes, k)
    return extent_of(run, axis, values, of_rows, zero_known=is_zero_known(run, k))


def _with_arcs(values: Floats, rows: Ints, arcs: RunArcs, reach: Reach, k: int) -> tuple[Floats, Ints]:
    """Values at the ends of rows, and on those that are arcs between them, with their rows."""
    count = np.isin(arcs.rows, rows)
    between = arcs.rows[count]
    return np.concatenate((values, reach.low[count, k], reach.high[count, k])), np.concatenate((rows, between, between))


def extent_of(run: Run, axis: Axis, values: Floats, rows: Ints, *, zero_known: bool) -> AxisExtent:
    """The extent of an axis that has taken values (k,) in rows (k,)."""
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

    On the first leg of an approach the tool is still as high as the machine position before it.
    """
    if axis.is_rotary:
        return np.arange(len(run))
    linear = ProgrammedWord.X | ProgrammedWord.Y | ProgrammedWord.Z
    counts = ~run.machine_frame & (run.tcp | ((run.programmed & linear) != 0) | names_no_axis(run.programmed))
    counts[approach_rows(run)] = False
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
