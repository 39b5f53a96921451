"""What a report shows of a recording: curves of axes and spindle over time, what of their travel was used, and how far
off each motion was.

In:     a ``Verification`` with a recording.
Out:    ``RecordedContent``.
Units:  seconds, mm, degrees, rev/min.
"""

from collections.abc import Iterator
from operator import itemgetter
from pathlib import Path
from typing import Annotated, Final

import numpy as np

from trunnion.arrays import Floats, Ints, Lines
from trunnion.machines import Axis
from trunnion.messages import Wording
from trunnion.model.recording import SPINDLE, TIP, Mark
from trunnion.records import dataclass
from trunnion.reporting.extents import AxisExtent, extent_of, extremes_of, is_zero_known
from trunnion.reporting.plot_series import Curve, Plot, PlotSeries, finite_values
from trunnion.reporting.text import clean
from trunnion.results import NOT_DATA, Figure
from trunnion.verification.recorded import RecordedComparison
from trunnion.verification.results import Verification

#: What is marked where the connection was broken, and where it was there again.
_GAP: Final = Wording("report", "recorded_gap")
_AFTER_GAP: Final = Wording("report", "recorded_again")

#: Recorded columns beside those of the axes, NAME_velocity, and their units of time.
RATES: Final = {"velocity": "s", "acceleration": "s²"}


@dataclass(frozen=True, slots=True, eq=False)
class RecordedContent:
    """A recording in a report; n motions.

    file       its name
    compared   positions that were compared
    other      positions in other programs, before the program, after it, and where nobody knows the tool
    incomplete rows without all axes
    gaps       breaks of the connection
    seconds    how long it is
    positions  (n,)    positions of each motion
    worst      (n, 2)  how far off tip and tool axis were at worst; NaN where there is no position
    extents    of axes and spindle, in the order of their curves; none where the recording has the tip in their place
    series     curves over time
    """

    file: str
    compared: Annotated[int, Figure("positions", after="seconds")]
    other: Annotated[int, Figure("positions_elsewhere", after="positions")]
    incomplete: Annotated[int, Figure("incomplete_rows", after="positions_elsewhere")]
    gaps: Annotated[int, Figure(after="incomplete_rows")]
    seconds: float
    positions: Annotated[Ints, NOT_DATA]
    worst: Annotated[Floats, NOT_DATA]
    extents: tuple[AxisExtent, ...]
    series: Annotated[PlotSeries, NOT_DATA]


def recorded_content(verification: Verification) -> RecordedContent | None:
    """Return the content of the recording; None if there is none."""
    found = verification.recorded
    if found is None:
        return None
    elapsed = found.recording.elapsed()
    return RecordedContent(
        file=clean(found.recording.name),
        compared=len(found.compared),
        other=found.foreign + found.outside,
        incomplete=found.incomplete,
        gaps=int(found.recording.marked(Mark.GAP).sum()),
        seconds=float(elapsed[-1]) if len(elapsed) else 0.0,
        positions=found.positions,
        worst=found.worst,
        extents=tuple(_extents(verification, found)),
        series=_series(verification, found, elapsed),
    )


def _series(verification: Verification, found: RecordedComparison, elapsed: Floats) -> PlotSeries:
    """Rows that show all axes, as points over time."""
    recording, run = found.recording, verification.run
    curves = dict(_curves(verification, found))
    rates = dict(_rates(verification, found))
    needed = [*(column for _, column in curves.values()), *(column for _, column in rates.values())]
    shown = np.flatnonzero(np.isfinite(np.column_stack(needed)).all(axis=1))
    marks = list[tuple[int, str | Wording]]()
    for gap in np.flatnonzero(recording.marked(Mark.GAP)).tolist():
        after = int(np.searchsorted(shown, gap))
        marks += [(max(after - 1, 0), _GAP), *([(after, _AFTER_GAP)] if after < len(shown) else [])]
    rows = found.row[shown]
    marks = sorted([*marks, *_operations(verification, rows)], key=itemgetter(0))
    # Row -1, of positions that were not compared, takes what is appended.
    block, number = np.append(run.line, 0)[rows], np.append(run.block_number, -1)[rows]
    has_cl = len(verification.cl_line) == len(run)
    cl = np.append(verification.cl_line, 0)[rows] if has_cl else np.zeros(len(rows), np.int64)
    lines = {"block": _as_int32(block), "number": _as_int32(number), "cl": _as_int32(cl)}
    if np.any(run.file):
        lines["file"] = _as_int32(np.append(run.file, 0)[rows])
    values = {f"axis{k}": column[shown].astype(np.float32) for k, (_, column) in enumerate(curves.values())}
    values |= {name: column[shown].astype(np.float32) for name, (_, column) in rates.items()}
    if SPINDLE in recording.values:
        values[SPINDLE] = np.nan_to_num(recording.values[SPINDLE][shown]).astype(np.float32)
    return PlotSeries(
        seconds=np.diff(elapsed[shown], prepend=elapsed[shown][:1]).astype(np.float32),
        values=values,
        lines=lines,
        plots=tuple(_plots(verification, curves, rates, SPINDLE in recording.values)),
        files=tuple(clean(Path(file).name) for file in run.files),
        tool_changes=tuple(marks),
        timed=True,
        name="recorded",
        title=Wording("report", "as_recorded", file=clean(recording.name)),
        note=Wording("report", "recorded_note"),
    )


def _operations(verification: Verification, rows: Ints) -> Iterator[tuple[int, str]]:
    """Where operations begin, and their names, by the rows of positions; without CL files the subprograms."""
    run = verification.run
    operation = run.file.astype(np.int64) - 1
    names = [clean(Path(file).name) for file in run.files[1:]]
    if verification.operations:
        operation[:], names = -1, [clean(each.name) for each in verification.operations]
        for k, each in enumerate(verification.operations):
            operation[each.first : each.end] = k
    compared = np.flatnonzero(rows >= 0)
    found = operation[rows[compared]]
    for k in np.flatnonzero(np.diff(found, prepend=-1)).tolist():
        if found[k] >= 0:
            yield int(compared[k]), names[int(found[k])]


def _extents(verification: Verification, found: RecordedComparison) -> Iterator[AxisExtent]:
    """How far axes and spindle went in the recording, and at which blocks."""
    run, machine = verification.run, verification.machine
    # The block of a position that was not compared is the one before it.
    last = np.maximum.accumulate(np.where(found.row >= 0, np.arange(len(found.row)), -1))
    rows = np.where(last >= 0, found.row[last], 0)
    for k in () if found.joints is None else (*machine.linear, *machine.own_rotary):
        assert found.joints is not None
        yield extent_of(run, machine.axes[k], found.joints[:, k], rows, zero_known=is_zero_known(run, k))
    if (speeds := found.recording.values.get(SPINDLE)) is not None:
        extremes = extremes_of(run, speeds, rows)
        fastest = next(iter(finite_values(machine.spindle_max_rpm)), None)
        margin = None if fastest is None or extremes is None else fastest - extremes.high
        yield AxisExtent("Spindle", "rev/min", extremes, None, fastest, False, True, margin)


def _curves(verification: Verification, found: RecordedComparison) -> Iterator[tuple[str, tuple[int | None, Floats]]]:
    """Yield recorded columns by their names, with the column of the machine's axis: slides first, or the tip."""
    machine, joints = verification.machine, found.joints
    if joints is not None:
        for k in (*machine.linear, *machine.own_rotary):
            yield machine.names[k], (k, joints[:, k])
        return
    for name, column in zip(TIP, found.tips.T, strict=True):
        yield name, (None, column)
    columns = {name.casefold(): column for name, column in found.recording.values.items()}
    for k in machine.own_rotary:
        yield machine.names[k], (k, columns[machine.names[k].casefold()])


def _rates(verification: Verification, found: RecordedComparison) -> Iterator[tuple[str, tuple[Plot, Floats]]]:
    """Yield recorded velocities and accelerations of the axes by their columns, each with its plot."""
    columns = {name.casefold(): column for name, column in found.recording.values.items()}
    machine = verification.machine
    for k in (*machine.linear, *machine.own_rotary):
        name, unit = clean(machine.names[k]), "°" if machine.axes[k].is_rotary else "mm"
        for what, per in RATES.items():
            column = columns.get(f"{machine.names[k]}_{what}".casefold())
            if column is not None and np.isfinite(column).any():
                key = f"{what}{k}"
                said = Wording("report", f"rate_{what}", axis=name)
                yield key, (Plot(said, f"{unit}/{per}", (Curve(key, said),)), column)


def _plots(
    verification: Verification,
    curves: dict[str, tuple[int | None, Floats]],
    rates: dict[str, tuple[Plot, Floats]],
    has_spindle: bool,
) -> Iterator[Plot]:
    """Yield the plots: below each axis its velocity and its acceleration, if they were recorded."""
    machine = verification.machine
    for k, (name, (axis, values)) in enumerate(curves.items()):
        if axis is None:
            yield Plot(name, "mm", (Curve(f"axis{k}", name),))
        else:
            yield _axis_plot(f"axis{k}", machine.axes[axis], values, machine.is_placed(axis))
            yield from (rates[f"{what}{axis}"][0] for what in RATES if f"{what}{axis}" in rates)
    if has_spindle:
        limits = finite_values(machine.spindle_max_rpm)
        yield Plot("Spindle", "rev/min", (Curve(SPINDLE, "spindle", limits, "fastest"),))


def _axis_plot(column: str, axis: Axis, values: Floats, is_placed: bool) -> Plot:
    """Return an axis with its travel, which stands around the motion where nobody knows its place."""
    limits = () if axis.endless else finite_values(axis.low, axis.high)
    note = "endless" if axis.endless else "" if limits else "limits not stated"
    known = values[np.isfinite(values)]
    if limits and not is_placed:
        middle, half = float(known.min() + known.max()) / 2.0 if len(known) else 0.0, (axis.high - axis.low) / 2.0
        limits = (middle - half, middle + half) if np.isfinite(half) else ()
    name = clean(axis.name)
    curve = Curve(column, name, limits, floating=bool(limits) and not is_placed)
    return Plot(name, "°" if axis.is_rotary else "mm", (curve,), note=note)


def _as_int32(column: Ints | Lines) -> Lines:
    return np.where(np.abs(column) < 2**31, column, -1).astype(np.int32)
