"""Recordings made of a program in time, as a machine would show it; and the rows of their files."""

from collections.abc import Mapping
from functools import cache
from pathlib import Path

import numpy as np

from tests.support.locations import YL569
from trunnion import load_machine, read_program
from trunnion.arrays import Floats
from trunnion.model.recording import Recording, TextColumn
from trunnion.model.run import Run
from trunnion.timing import TimedRun, time_run

BLADE_FINISH = YL569 / "3_blade_finish.expected.mpf"

#: Microseconds since 1970 at which recordings begin.
BEGIN = 1_780_000_000_000_000


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
    name = Path(run.files[0]).name
    program = {"program": TextColumn(np.ones(len(seconds), np.int64), ("", name))}
    return Recording("made.csv", stamps, stamps + 1000, {}, values, program)


def with_values(recording: Recording, **values: Floats) -> Recording:
    """A recording with other columns."""
    changed: Mapping[str, Floats] = {**recording.values, **values}
    return Recording(recording.file, recording.source, recording.received, recording.marks, changed, recording.texts)


def known_rows(run: Run) -> slice:
    """Rows of the blade's program of which it is known where the tool is, without those beside others."""
    return slice(10, len(run) - 4)
