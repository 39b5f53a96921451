"""A sensitivity as a page and as data.

In:     ``Sensitivity``.
Out:    ``SensitivityContent`` with its curves, or plain data.
"""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trunnion.arrays import Floats, Ints, Lines
from trunnion.capability.sensitivity import ErrorExtent, NumberSensitivity, Sensitivity, errors_over
from trunnion.files import atomic_file
from trunnion.jobs.inputs.reading import FilePath
from trunnion.jobs.result_output import declared_output
from trunnion.messages import LIBRARY, Wording, Words, foreign, phrase
from trunnion.model.run import Run
from trunnion.reporting.page_words import in_language, label, told
from trunnion.reporting.plot_series import Curve, Plot, PlotSeries, SingleFloats
from trunnion.reporting.sensitivity_page import ErrorCells, NumberRow, SensitivityContent, render_sensitivity_page
from trunnion.reporting.text import clean

#: Numbers whose errors are drawn: further ones matter less than all of these.
_DRAWN: Final = 12

_DECIMALS: Final = 9

#: What is printed as zero, mm.
_NONE: Final = 5e-6


def write_sensitivity_report(
    found: Sensitivity, file: FilePath, inputs: Iterable[FilePath] = (), words: Words = LIBRARY
) -> None:
    """Write a sensitivity as a page that works offline, with the errors of the worst numbers over the program.

    ``words`` are those of who reads it: the library, or the command line.

    Raises ``InputError`` when the name does not end in ``.html``, the file cannot be written, or it is one of
    ``inputs``.
    """
    with atomic_file(declared_output("sensitivity", "report", file), inputs=inputs) as sink:
        with in_language(words):
            content, series = _content(found), _series(found)
        sink.writelines(render_sensitivity_page(content, series, words))


def amount_text(each: NumberSensitivity) -> str:
    """How far a number is off, in words."""
    return f"{each.amount:g}″" if each.number.is_angle else f"{each.amount:g} mm"


def place_said(extent: ErrorExtent, run: Run) -> Wording:
    """Return the block of the largest error as programmers call it; empty where there is none."""
    place = extent.place
    if extent.largest < _NONE:
        return foreign("")
    block = (
        phrase("block_in_line", block=place.block, line=place.line)
        if place.block >= 0
        else phrase("line_number", line=place.line)
    )
    return block if place.file == run.files[0] else phrase("block_of_file", file=Path(place.file).name, block=block)


def pose_text(pose: Mapping[str, float]) -> str:
    """Return the values of axes."""
    return " ".join(f"{name}{value:g}" for name, value in pose.items())


def _content(found: Sensitivity) -> SensitivityContent:
    run, machine = found.run, found.run.machine
    zero = machine.workpiece_zero
    length = machine.tool_length
    facts = [
        (label("machine"), clean(machine.name)),
        (label("feed_motions"), str(found.motions)),
        (
            label("zero_set_with"),
            label("not_set") if found.zero_at is None else clean(label("set_at", pose=pose_text(found.zero_at))),
        ),
        (label("fact_zero"), label("not_known") if zero is None else " ".join(f"{part:g}" for part in zero) + " mm"),
        (label("fact_length"), label("not_known") if length is None else f"{length:g} mm"),
    ]
    rows = [
        NumberRow(
            clean(told(each.number.said)),
            amount_text(each),
            _cells(each.tip, run),
            None if each.zeroed is None else _cells(each.zeroed, run),
            each.axis_deg,
        )
        for each in found.numbers
    ]
    idle = tuple(number.said for number in found.idle)
    notes = [clean(told(remark.wording.with_cure())) for remark in found.remarks]
    notes += [clean(label("without_effect", names=idle))] if idle else []
    notes += [clean(told(each)) for each in found.grounds.wordings(named=True)]
    return SensitivityContent(clean(Path(run.files[0]).name), facts, rows, notes)


def _cells(extent: ErrorExtent, run: Run) -> ErrorCells:
    return ErrorCells(extent.largest, extent.rms, clean(told(place_said(extent, run))))


def _series(found: Sensitivity) -> PlotSeries:
    """Return the errors of the worst numbers, one point a motion at feed and one before the first."""
    drawn = found.numbers[:_DRAWN]
    rows, errors = errors_over(found, [each.number for each in drawn])
    run = found.run
    lines = {
        "block": _whole(run.line, rows, 0),
        "number": _whole(run.block_number, rows, -1),
        "cl": np.zeros(len(rows) + 1, np.int32),
    }
    if np.any(run.file):
        lines["file"] = _whole(run.file, rows, 0)
    plots = [
        Plot(clean(told(each.number.said)), "µm", (Curve(f"error{k}", amount_text(each)),))
        for k, each in enumerate(drawn)
    ]
    title = "tip_error_over" if found.zero_at is None else "tip_error_with_zero"
    return PlotSeries(
        seconds=np.concatenate(([0.0], np.ones(len(rows)))).astype(np.float32),
        values={f"error{k}": _micrometres(errors[:, k]) for k in range(len(drawn))},
        lines=lines,
        plots=tuple(plots),
        files=tuple(clean(Path(file).name) for file in run.files),
        tool_changes=tuple(
            (int(np.searchsorted(rows, event.before_row)), clean(str(event.value or "")))
            for event in run.events
            if event.kind == "tool_change"
        ),
        timed=False,
        title=label(title, count=len(drawn)),
    )


def _micrometres(errors: Floats) -> SingleFloats:
    """Return a column in micrometres with a point before it, finite throughout."""
    column = np.concatenate((errors[:1], errors)) * 1e3
    column[~np.isfinite(column)] = 0.0
    return column.astype(np.float32)


def _whole(column: NDArray[np.integer], rows: Ints, before: int) -> Lines:
    """Return a column of rows as int32 with a point before it; numbers that do not fit become -1."""
    chosen = np.asarray(column)[rows].astype(np.int64)
    return np.concatenate(([before], np.where(np.abs(chosen) < 2**31, chosen, -1))).astype(np.int32)
