"""What a report plots: columns over time, and fewer rows that show the same at a distance.

In:     a ``Verification``.
Out:    ``Series``: one point per motion and one before the first, float32 and int32 columns, and levels of detail.
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
from trunnion.reporting.facts import clean, durations, placed, travelled
from trunnion.verification.results import Verification

#: Programs with no more points than this are drawn as they are; so are stretches of longer ones.
DIRECT = 40_000

#: Buckets of the coarsest level, and how many times more the next one has.
COARSEST, STEP = 1_000, 3

#: Buckets that a plot should have in view: below, the page takes a finer level.
IN_VIEW = 600

Single = NDArray[np.float32]


@dataclass(frozen=True, slots=True)
class Line:
    """One curve: its column, its name in the legend, the values that it must not pass, and what to call those.

    ``loose``: the distance between the limits is known, but not where they are.
    """

    column: str
    name: str
    limits: tuple[float, ...] = ()
    limit_name: str = "limits"
    loose: bool = False


@dataclass(frozen=True, slots=True)
class Plot:
    """Curves that share a plot; ``step``: a value holds for the whole motion, so it is drawn as steps."""

    title: str
    unit: str
    lines: tuple[Line, ...]
    step: bool = False
    note: str = ""


@dataclass(frozen=True, slots=True, eq=False)
class Level:
    """Rows that stand for all, as indices of points; ``buckets`` is how many pieces of equal time they come from."""

    buckets: int
    rows: Ints


@dataclass(frozen=True, slots=True, eq=False)
class Series:
    """Columns of n + 1 points: the state before the first motion, then one point at the end of each motion.

    seconds   (n+1,) float32   time that the motion takes, 0 for the first point; their running sum is the time axis
    values    name -> (n+1,) float32
    lines     name -> (n+1,) int32: ``block``, ``number``, ``cl``, and ``file`` where there are subprograms
    timed     whether ``seconds`` are seconds; otherwise no time is known at all and each motion counts 1
    changes   tool changes: point after which it happens, and the name of the tool
    """

    seconds: Single
    values: dict[str, Single]
    lines: dict[str, Lines]
    plots: tuple[Plot, ...]
    files: tuple[str, ...]
    changes: tuple[tuple[int, str], ...]
    timed: bool

    def __len__(self) -> int:
        return len(self.seconds)

    def time(self) -> Floats:
        """Time at each point, (n+1,) float64, s: exactly what the page adds up."""
        return np.cumsum(self.seconds, dtype=np.float64)


def series(verification: Verification) -> Series:
    """Gather the columns that a report plots."""
    run, machine = verification.run, verification.machine
    seconds, _ = durations(verification)
    timed = bool(np.any(seconds > 0.0)) or not len(run)
    values = {f"axis{k}": _single(run.joints[:, k], run.start[k]) for k in range(len(machine.axes))}
    plots = [_positions(verification, k) for k in (*machine.linear, *machine.rotary)]
    for k in machine.rotary:
        turned = np.abs(np.diff(run.joints[:, k], prepend=run.start[k]))
        with np.errstate(divide="ignore", invalid="ignore"):
            values[f"speed{k}"] = _single(np.where(seconds > 0.0, turned / seconds * 60.0, 0.0))
    values["feed"] = _single(verification.tip_feed)
    values["programmed"] = _single(np.where(run.feed_mode == 94, run.feed, 0.0))
    speeds = tuple(_speed(machine.axes[k], f"speed{k}") for k in machine.rotary)
    # Slides alone cannot move the tip faster than all of them at rapid along the diagonal.
    diagonal = math.hypot(*(machine.axes[k].rapid or np.inf for k in machine.linear))
    feeds = (
        Line("feed", "tip", _stated(round(diagonal) if math.isfinite(diagonal) else None), "slides at rapid"),
        Line("programmed", "programmed"),
    )
    plots.append(Plot("Rotary speeds", "°/min", speeds, step=True))
    plots.append(Plot("Tip feed", "mm/min", feeds, step=True))
    lines = {"block": _whole(run.block), "number": _whole(run.number, -1), "cl": _whole(verification.cl_line)}
    if np.any(run.file):
        lines["file"] = _whole(run.file)
    changes = tuple(
        (event.before_row, clean(str(event.value or ""))) for event in run.events if event.kind == "tool_change"
    )
    return Series(
        seconds=_single(seconds if timed else np.ones(len(run)), 0.0),
        values=values,
        lines=lines,
        plots=tuple(plots),
        files=tuple(clean(Path(file).name) for file in run.files),
        changes=changes,
        timed=timed,
    )


def _positions(verification: Verification, k: int) -> Plot:
    axis = verification.machine.axes[k]
    limits = () if axis.endless else _stated(axis.low, axis.high)
    note = "endless" if axis.endless else "" if limits else "limits not stated"
    loose = bool(limits) and not placed(verification.run, axis)
    if loose:
        limits = _around(verification, k)
    name = clean(axis.name)
    return Plot(name, "°" if axis.is_rotary else "mm", (Line(f"axis{k}", name, limits, loose=loose),), note=note)


def _around(verification: Verification, k: int) -> tuple[float, ...]:
    """Limits of a slide as far apart as they are, with the motion in the middle."""
    axis = verification.machine.axes[k]
    values = verification.run.joints[travelled(verification.run, axis), k]
    if not np.isfinite(axis.high - axis.low) or not len(values) or not np.isfinite(values).all():
        return ()
    middle, half = float(values.min() + values.max()) / 2.0, (axis.high - axis.low) / 2.0
    return (middle - half, middle + half)


def _speed(axis: Axis, column: str) -> Line:
    name = clean(axis.name)
    return Line(column, name, _stated(axis.rapid), f"{name} rapid")


def _stated(*values: float | None) -> tuple[float, ...]:
    return tuple(value for value in values if value is not None and math.isfinite(value))


def _single(column: Floats, before: float | None = None) -> Single:
    """Return a column as float32 with a point before it, which repeats the first where not given; finite throughout."""
    points = np.empty(len(column) + 1, np.float32)
    with np.errstate(over="ignore"):
        points[1:] = column
    points[0] = before if before is not None else points[min(1, len(column))] if len(column) else 0.0
    points[~np.isfinite(points)] = 0.0
    return points


def _whole(column: NDArray[np.integer], before: int = 0) -> Lines:
    """Return a column as int32 with a point before it; numbers that do not fit become -1."""
    points = np.empty(len(column) + 1, np.int32)
    points[0] = before
    points[1:] = np.where(np.abs(column) < 2**31, column, -1)
    return points


# ---------------------------------------------------------------------------------------------------------------------
# Levels of detail


def levels(shown: Series) -> Iterator[Level]:
    """Yield levels from coarse to fine, none for short programs; the finest reaches as deep as ``DIRECT`` rows do."""
    if len(shown) <= DIRECT:
        return
    time = shown.time()
    buckets = COARSEST
    while True:
        yield Level(buckets, kept(tuple(shown.values.values()), bucket_of(time, buckets)))
        if len(shown) * IN_VIEW <= DIRECT * buckets:
            return
        buckets *= STEP


def bucket_of(time: Floats, buckets: int) -> Ints:
    """Bucket of each point, (n,) int64, growing: pieces of equal time."""
    whole = time[-1] - time[0]
    if whole <= 0.0:
        return np.zeros(len(time), np.int64)
    bucket: Ints = np.minimum((time - time[0]) / whole * buckets, buckets - 1).astype(np.int64)
    return bucket


def kept(columns: Sequence[Single], bucket: Ints) -> Ints:
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


def rows_of(shown: Series, rows: Ints) -> Series:
    """Return a series of these points only; its times are those of the points, as near as float32 differences say."""
    time = shown.time()[rows]
    return Series(
        seconds=np.diff(time, prepend=0.0).astype(np.float32),
        values={name: column[rows] for name, column in shown.values.items()},
        lines={name: column[rows] for name, column in shown.lines.items()},
        plots=shown.plots,
        files=shown.files,
        changes=shown.changes,
        timed=shown.timed,
    )
