"""What a report plots: columns over time, and how they are drawn.

In:     a ``Verification``.
Out:    ``PlotSeries``: one point for each motion and one before the first, in float32 and int32 columns.
Units:  seconds, mm, degrees, mm/min, deg/min.
"""

import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from trunnion.arrays import Floats, Lines
from trunnion.machines import Axis
from trunnion.messages import Wording, phrase
from trunnion.records import dataclass
from trunnion.reporting.extents import is_zero_known, travel_rows
from trunnion.reporting.text import clean
from trunnion.verification.results import Verification, durations

SingleFloats = NDArray[np.float32]


@dataclass(frozen=True, slots=True)
class Curve:
    """One curve: its column, its name in the legend, its limits, and the name of these.

    ``floating``: the distance between the limits is known, but not where they are.
    """

    column: str
    name: str | Wording
    limits: tuple[float, ...] = ()
    limit_name: str | Wording = "limits"
    floating: bool = False


@dataclass(frozen=True, slots=True)
class Plot:
    """Curves in one plot; with ``step`` a value holds for the whole motion and is drawn as a step."""

    title: str | Wording
    unit: str
    curves: tuple[Curve, ...]
    step: bool = False
    note: str = ""


@dataclass(frozen=True, slots=True, eq=False)
class PlotSeries:
    """Columns of n + 1 points: the state before the first motion, then one point at the end of each motion.

    seconds       (n+1,) float32   duration of the motion, 0 for the first point; the running sum is the time axis
    values        name -> (n+1,) float32; NaN in speeds whose time is not known
    lines         name -> (n+1,) int32: ``block``, ``number``, ``cl``, and ``file`` if there are subprograms
    timed         whether ``seconds`` are seconds; otherwise no time is known and each motion counts 1
    tool_changes  the point after which each one happens, and the name of the tool; of a recording, what is marked
    name          of the section; empty: the program itself
    title, note   of the section; empty: those of the program
    """

    seconds: SingleFloats
    values: dict[str, SingleFloats]
    lines: dict[str, Lines]
    plots: tuple[Plot, ...]
    files: tuple[str, ...]
    tool_changes: tuple[tuple[int, str | Wording], ...]
    timed: bool
    name: str = ""
    title: str | Wording = ""
    note: str | Wording = ""

    def __len__(self) -> int:
        return len(self.seconds)

    def time(self) -> Floats:
        """Time at each point, (n+1,) float64, s: the same sum as in the page."""
        return np.cumsum(self.seconds, dtype=np.float64)


def no_series() -> PlotSeries:
    """Columns of a program without motion: the one point before it, and nothing to plot."""
    none, at = np.zeros(1, np.float32), np.zeros(1, np.int32)
    return PlotSeries(none, {"feed": none}, {"block": at, "number": at, "cl": at}, (), (), (), timed=False)


def collect_series(verification: Verification) -> PlotSeries:
    """Collect the columns that a report plots."""
    run = verification.run
    seconds, _ = durations(verification)
    timed = bool(np.any(seconds > 0.0)) or not len(run)
    return PlotSeries(
        seconds=_as_float32(seconds if timed else np.ones(len(run)), 0.0),
        values=_values(verification, seconds),
        lines=_lines(verification),
        plots=tuple(_plots(verification)),
        files=tuple(clean(Path(file).name) for file in run.files),
        tool_changes=tuple(
            (event.before_row, clean(str(event.value or ""))) for event in run.events if event.kind == "tool_change"
        ),
        timed=timed,
    )


def _values(verification: Verification, seconds: Floats) -> dict[str, SingleFloats]:
    """Return the columns of axis positions, rotary speeds and feeds; ``seconds`` (n,), 0 where not known."""
    run, machine = verification.run, verification.machine
    values = {f"axis{k}": _as_float32(run.joints[:, k], run.start[k]) for k in range(len(machine.axes))}
    for k in machine.own_rotary:
        turned = np.abs(np.diff(run.joints[:, k], prepend=run.start[k]))
        with np.errstate(divide="ignore", invalid="ignore"):
            speed = np.where(seconds > 0.0, turned / seconds * 60.0, 0.0)
        values[f"speed{k}"] = _with_gaps(speed, verification.tip_feed)
    values["feed"] = _with_gaps(verification.tip_feed, verification.tip_feed)
    values["programmed"] = _as_float32(np.where(run.feed_mode == 94, run.feed, 0.0))
    return values


def _lines(verification: Verification) -> dict[str, Lines]:
    """Return the columns of line and block numbers."""
    run = verification.run
    lines = {
        "block": _as_int32(run.line),
        "number": _as_int32(run.block_number, -1),
        "cl": _as_int32(verification.cl_line),
    }
    return lines | ({"file": _as_int32(run.file)} if np.any(run.file) else {})


# ---------------------------------------------------------------------------------------------------------------------
# Plots


def _plots(verification: Verification) -> Iterator[Plot]:
    """Yield the plots: positions of the axes, rotary speeds, tip feed."""
    machine = verification.machine
    for k in (*machine.linear, *machine.own_rotary):
        yield _position_plot(verification, k)
    yield Plot("Rotary speeds", "°/min", tuple(_speed_curve(machine.axes[k], k) for k in machine.own_rotary), step=True)
    # The slides alone cannot move the tip faster than all of them together at rapid, along the diagonal.
    diagonal = math.hypot(*(machine.axes[k].rapid or np.inf for k in machine.linear))
    limits = (round(diagonal),) if math.isfinite(diagonal) else ()
    curves = Curve("feed", "tip", limits, "linear axes at rapid"), Curve("programmed", "programmed")
    yield Plot("Tip feed", "mm/min", curves, step=True)


def _position_plot(verification: Verification, k: int) -> Plot:
    axis = verification.machine.axes[k]
    limits = () if axis.endless else finite_values(axis.low, axis.high)
    note = "endless" if axis.endless else "" if limits else "limits not stated"
    floating = bool(limits) and not is_zero_known(verification.run, k)
    if floating:
        limits = _centred_limits(verification, k)
    name = clean(axis.name)
    return Plot(name, "°" if axis.is_rotary else "mm", (Curve(f"axis{k}", name, limits, floating=floating),), note=note)


def _centred_limits(verification: Verification, k: int) -> tuple[float, ...]:
    """Limits of a linear axis at their true distance, with the motion in the middle."""
    axis = verification.machine.axes[k]
    values = verification.run.joints[travel_rows(verification.run, axis), k]
    if not np.isfinite(axis.high - axis.low) or not len(values) or not np.isfinite(values).all():
        return ()
    middle, half = float(values.min() + values.max()) / 2.0, (axis.high - axis.low) / 2.0
    return (middle - half, middle + half)


def _speed_curve(axis: Axis, k: int) -> Curve:
    name = clean(axis.name)
    return Curve(f"speed{k}", name, finite_values(axis.rapid), phrase("axis_rapid", axis=name))


def finite_values(*values: float | None) -> tuple[float, ...]:
    """Those that are known and finite."""
    return tuple(value for value in values if value is not None and math.isfinite(value))


# ---------------------------------------------------------------------------------------------------------------------
# Columns


def _as_float32(column: Floats, before: float | None = None) -> SingleFloats:
    """Return a column as float32 with a point ``before`` it, by default its first value; finite throughout."""
    points = np.empty(len(column) + 1, np.float32)
    with np.errstate(over="ignore"):
        points[1:] = column
    points[0] = before if before is not None else points[min(1, len(column))] if len(column) else 0.0
    points[~np.isfinite(points)] = 0.0
    return points


def _with_gaps(column: Floats, tip_feed: Floats) -> SingleFloats:
    """Return a column of speeds as ``_as_float32`` does, with NaN where the time of a motion is not known."""
    points = _as_float32(column)
    if len(tip_feed) == len(column):
        points[1:][np.isnan(tip_feed)] = np.nan
    return points


def _as_int32(column: NDArray[np.integer], before: int = 0) -> Lines:
    """Return a column as int32 with a point ``before`` it; numbers that do not fit become -1."""
    points = np.empty(len(column) + 1, np.int32)
    points[0] = before
    points[1:] = np.where(np.abs(column) < 2**31, column, -1)
    return points
