"""What a report plots: columns over time, and fewer rows that show the same at a distance.

In:     a ``Verification``.
Out:    ``PlotSeries``: one point per motion and one before the first, float32 and int32 columns, and levels of detail.
Units:  seconds, mm, degrees, mm/min, deg/min.

A level cuts the time of the program into equal buckets and keeps, of each, the first row, the last row and the rows
where each column is lowest and highest. They are real rows, so whatever is seen in a level has its own block.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from trunnion.arrays import Floats, Ints, Lines
from trunnion.machines import Axis
from trunnion.reporting.content import clean, durations, has_known_zero, travel_rows
from trunnion.verification.results import Verification

#: Programs with no more points than this are drawn as they are; so are stretches of longer ones.
MAX_DIRECT_POINTS = 40_000

#: Buckets of the coarsest level, and how many times more the next one has.
COARSEST_BUCKETS, BUCKET_FACTOR = 1_000, 3

#: Buckets that a plot should have in view: below, the page takes a finer level.
BUCKETS_IN_VIEW = 600

SingleFloats = NDArray[np.float32]


@dataclass(frozen=True, slots=True)
class Curve:
    """One curve: its column, its name in the legend, the values that it must not pass, and what to call those.

    ``floating``: the distance between the limits is known, but not where they are.
    """

    column: str
    name: str
    limits: tuple[float, ...] = ()
    limit_name: str = "limits"
    floating: bool = False


@dataclass(frozen=True, slots=True)
class Plot:
    """Curves that share a plot; ``step``: a value holds for the whole motion, so it is drawn as steps."""

    title: str
    unit: str
    lines: tuple[Curve, ...]
    step: bool = False
    note: str = ""


@dataclass(frozen=True, slots=True, eq=False)
class DetailLevel:
    """Rows that stand for all, as indices of points; ``buckets`` is how many pieces of equal time they come from."""

    buckets: int
    rows: Ints


@dataclass(frozen=True, slots=True, eq=False)
class PlotSeries:
    """Columns of n + 1 points: the state before the first motion, then one point at the end of each motion.

    seconds   (n+1,) float32   time that the motion takes, 0 for the first point; their running sum is the time axis
    values    name -> (n+1,) float32
    lines     name -> (n+1,) int32: ``block``, ``number``, ``cl``, and ``file`` where there are subprograms
    timed     whether ``seconds`` are seconds; otherwise no time is known at all and each motion counts 1
    changes   tool changes: point after which it happens, and the name of the tool
    """

    seconds: SingleFloats
    values: dict[str, SingleFloats]
    lines: dict[str, Lines]
    plots: tuple[Plot, ...]
    files: tuple[str, ...]
    tool_changes: tuple[tuple[int, str], ...]
    timed: bool

    def __len__(self) -> int:
        return len(self.seconds)

    def time(self) -> Floats:
        """Time at each point, (n+1,) float64, s: exactly what the page adds up."""
        return np.cumsum(self.seconds, dtype=np.float64)


def collect_series(verification: Verification) -> PlotSeries:
    """Gather the columns that a report plots."""
    run, machine = verification.run, verification.machine
    seconds, _ = durations(verification)
    timed = bool(np.any(seconds > 0.0)) or not len(run)
    values = {f"axis{k}": _as_float32(run.joints[:, k], run.start[k]) for k in range(len(machine.axes))}
    plots = [_position_plot(verification, k) for k in (*machine.linear, *machine.rotary)]
    for k in machine.rotary:
        turned = np.abs(np.diff(run.joints[:, k], prepend=run.start[k]))
        with np.errstate(divide="ignore", invalid="ignore"):
            values[f"speed{k}"] = _as_float32(np.where(seconds > 0.0, turned / seconds * 60.0, 0.0))
    values["feed"] = _as_float32(verification.tip_feed)
    values["programmed"] = _as_float32(np.where(run.feed_mode == 94, run.feed, 0.0))
    speeds = tuple(_speed_curve(machine.axes[k], f"speed{k}") for k in machine.rotary)
    # Slides alone cannot move the tip faster than all of them at rapid along the diagonal.
    diagonal = math.hypot(*(machine.axes[k].rapid or np.inf for k in machine.linear))
    feeds = (
        Curve("feed", "tip", _finite_values(round(diagonal) if math.isfinite(diagonal) else None), "slides at rapid"),
        Curve("programmed", "programmed"),
    )
    plots.append(Plot("Rotary speeds", "°/min", speeds, step=True))
    plots.append(Plot("Tip feed", "mm/min", feeds, step=True))
    lines = {
        "block": _as_int32(run.line),
        "number": _as_int32(run.block_number, -1),
        "cl": _as_int32(verification.cl_line),
    }
    if np.any(run.file):
        lines["file"] = _as_int32(run.file)
    tool_changes = tuple(
        (event.before_row, clean(str(event.value or ""))) for event in run.events if event.kind == "tool_change"
    )
    return PlotSeries(
        seconds=_as_float32(seconds if timed else np.ones(len(run)), 0.0),
        values=values,
        lines=lines,
        plots=tuple(plots),
        files=tuple(clean(Path(file).name) for file in run.files),
        tool_changes=tool_changes,
        timed=timed,
    )


def _position_plot(verification: Verification, k: int) -> Plot:
    axis = verification.machine.axes[k]
    limits = () if axis.endless else _finite_values(axis.low, axis.high)
    note = "endless" if axis.endless else "" if limits else "limits not stated"
    floating = bool(limits) and not has_known_zero(verification.run, axis)
    if floating:
        limits = _centred_limits(verification, k)
    name = clean(axis.name)
    return Plot(name, "°" if axis.is_rotary else "mm", (Curve(f"axis{k}", name, limits, floating=floating),), note=note)


def _centred_limits(verification: Verification, k: int) -> tuple[float, ...]:
    """Limits of a slide as far apart as they are, with the motion in the middle."""
    axis = verification.machine.axes[k]
    values = verification.run.joints[travel_rows(verification.run, axis), k]
    if not np.isfinite(axis.high - axis.low) or not len(values) or not np.isfinite(values).all():
        return ()
    middle, half = float(values.min() + values.max()) / 2.0, (axis.high - axis.low) / 2.0
    return (middle - half, middle + half)


def _speed_curve(axis: Axis, column: str) -> Curve:
    name = clean(axis.name)
    return Curve(column, name, _finite_values(axis.rapid), f"{name} rapid")


def _finite_values(*values: float | None) -> tuple[float, ...]:
    return tuple(value for value in values if value is not None and math.isfinite(value))


def _as_float32(column: Floats, before: float | None = None) -> SingleFloats:
    """Return a column as float32 with a point before it, which repeats the first where not given; finite throughout."""
    points = np.empty(len(column) + 1, np.float32)
    with np.errstate(over="ignore"):
        points[1:] = column
    points[0] = before if before is not None else points[min(1, len(column))] if len(column) else 0.0
    points[~np.isfinite(points)] = 0.0
    return points


def _as_int32(column: NDArray[np.integer], before: int = 0) -> Lines:
    """Return a column as int32 with a point before it; numbers that do not fit become -1."""
    points = np.empty(len(column) + 1, np.int32)
    points[0] = before
    points[1:] = np.where(np.abs(column) < 2**31, column, -1)
    return points


# ---------------------------------------------------------------------------------------------------------------------
# Levels of detail


def detail_levels(series: PlotSeries) -> Iterator[DetailLevel]:
    """Yield levels from coarse to fine, none for short programs; the finest reaches as deep as ``MAX_DIRECT_POINTS``
    rows do."""
    if len(series) <= MAX_DIRECT_POINTS:
        return
    time = series.time()
    buckets = COARSEST_BUCKETS
    while True:
        yield DetailLevel(buckets, extreme_rows(tuple(series.values.values()), bucket_of(time, buckets)))
        if len(series) * BUCKETS_IN_VIEW <= MAX_DIRECT_POINTS * buckets:
            return
        buckets *= BUCKET_FACTOR


def bucket_of(time: Floats, buckets: int) -> Ints:
    """Bucket of each point, (n,) int64, growing: pieces of equal time."""
    whole = time[-1] - time[0]
    if whole <= 0.0:
        return np.zeros(len(time), np.int64)
    bucket: Ints = np.minimum((time - time[0]) / whole * buckets, buckets - 1).astype(np.int64)
    return bucket


def extreme_rows(columns: Sequence[SingleFloats], bucket: Ints) -> Ints:
    """Rows to keep, growing: of each bucket the first, the last, and the first row at each column's extremes.

    columns   (n,) float32 each, finite
    bucket    (n,) int64, growing
    """
    starts = np.flatnonzero(np.diff(bucket, prepend=bucket[0] - 1))
    sizes = np.diff(starts, append=len(bucket))
    keep = np.zeros(len(bucket), np.bool_)
    keep[starts] = True
    keep[starts + sizes - 1] = True
    for column in columns:
        for extreme in (np.minimum, np.maximum):
            hits = np.flatnonzero(column == np.repeat(extreme.reduceat(column, starts), sizes))
            keep[hits[np.searchsorted(hits, starts)]] = True
    return np.flatnonzero(keep)


def select_rows(series: PlotSeries, rows: Ints) -> PlotSeries:
    """Return a series of these points only; its times are those of the points, as near as float32 differences say."""
    time = series.time()[rows]
    return PlotSeries(
        seconds=np.diff(time, prepend=0.0).astype(np.float32),
        values={name: column[rows] for name, column in series.values.items()},
        lines={name: column[rows] for name, column in series.lines.items()},
        plots=series.plots,
        files=series.files,
        tool_changes=series.tool_changes,
        timed=series.timed,
    )
