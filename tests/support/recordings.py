"""Recordings made of a program in time, as a machine would show it; and the rows of their files."""

from collections.abc import Mapping
from functools import cache
from pathlib import Path

import numpy as np

from tests.support.locations import YL569
from trunnion import load_machine, read_program
from trunnion.arrays import Floats
from trunnion.files import resolve_output
from trunnion.model.recording import NO_TIME, Mark, Recording, TextColumn
from trunnion.timing import TimedRun, time_run
from trunnion.twin.recording.files import RecordingWriter
from trunnion.twin.recording.rows import Row

BLADE_FINISH = YL569 / "3_blade_finish.expected.mpf"

#: Microseconds since 1970 at which recordings begin.
BEGIN = 1_780_000_000_000_000


#: The three operations of the impeller, each a program and the CL file that it was made from.
IMPELLER = {
    part: (YL569 / f"{part}.expected.mpf", YL569 / f"{part}.cls")
    for part in ("1_contour_rough", "2_hub_rough", "3_blade_finish")
}


def impeller(folder: Path) -> Path:
    """A main program that calls the programs of the impeller in turn; coolant goes on until somebody turns it off."""
    main = folder / "impeller.mpf"
    calls = [f'EXTCALL("{program.name}")\nM9\n' for program, _ in IMPELLER.values()]
    main.write_text("".join(calls) + "M30\n", encoding="utf-8")
    return main


@cache
def blade() -> TimedRun:
    """The program of the blade in time."""
    return time_run(read_program(BLADE_FINISH, machine=load_machine("yl569")))


def recorded(timed: TimedRun, seconds: Floats, *, with_lines: bool = True) -> Recording:
    """What a machine that runs a program shows at some times."""
    run, state = timed.run, timed.at(seconds)
    values = {name: state.joints[:, k].copy() for k, name in enumerate(run.machine.names)}
    values["spindle"] = np.abs(state.rpm)
    if with_lines:
        values["line"] = np.where(state.row < 0, 0, run.line[np.maximum(state.row, 0)]).astype(np.float64)
    stamps = (BEGIN + np.rint(seconds * 1e6)).astype(np.int64)
    names = ("", *(Path(file).name for file in run.files))
    program = {"program": TextColumn(run.file[np.maximum(state.row, 0)].astype(np.int64) + 1, names)}
    return Recording("made.csv", stamps, stamps + 1000, {}, values, program)


def with_values(recording: Recording, **values: Floats) -> Recording:
    """A recording with other columns."""
    changed: Mapping[str, Floats] = {**recording.values, **values}
    return Recording(recording.file, recording.source, recording.received, recording.marks, changed, recording.texts)


def written(recording: Recording, file: Path) -> Path:
    """A recording as a file."""
    names = [*recording.values, *recording.texts]
    writer = RecordingWriter(resolve_output(file), names, frozenset(recording.texts))
    columns = [column.tolist() for column in recording.values.values()]
    for row in range(len(recording)):
        values = [None if np.isnan(column[row]) else column[row] for column in columns]
        values += [column[row] or None for column in recording.texts.values()]
        source = int(recording.source[row])
        stamp = None if source == NO_TIME else source
        writer.add([Row(values, stamp, stamp, int(recording.received[row]), list(recording.marks.get(row, ())))])
    writer.close()
    return file


def with_gap(recording: Recording, first: int, end: int) -> Recording:
    """A recording that was not connected from row ``first`` to row ``end``."""
    keep = np.r_[0:first, first, end : len(recording)]
    gap = np.arange(len(keep)) == first
    values = {name: np.where(gap, np.nan, column[keep]) for name, column in recording.values.items()}
    texts = {
        name: TextColumn(np.where(gap, 0, column.codes[keep]), column.names) for name, column in recording.texts.items()
    }
    source = np.where(gap, NO_TIME, recording.source[keep])
    return Recording(recording.file, source, recording.received[keep], {first: (Mark.GAP,)}, values, texts)
