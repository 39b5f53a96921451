"""Rapids that are lines: shops that allow no rapid motion write a high feed in its place.

What such a program does is judged as what it stands for. A cut that the CL file wants at this very feed stays a cut.
"""

from dataclasses import replace

import numpy as np

from trunnion.arrays import Ints
from trunnion.model.run import ProgrammedWord, Run
from trunnion.model.toolpath import Kind

#: Rows looked at at a time.
_CHUNK = 8192

#: Words that say where the tip or the tool axis is to be.
POSITION_WORDS = ProgrammedWord.X | ProgrammedWord.Y | ProgrammedWord.Z | ProgrammedWord.VECTOR


#: So far off its axis may the tool be that leaves along it, mm, and so much may the axis change.
_STRAIGHT = 1e-6
_STEADY = 1e-9


def restore_rapids(run: Run, feed: float | None) -> Run:
    """The run with every line at the feed, mm/min, that stands for rapid motion as a rapid; itself without one."""
    if feed is None:
        return run
    kind = run.kind.copy()
    for start in range(0, len(run), _CHUNK):
        end = min(start + _CHUNK, len(run))
        fast = (run.state.feed.part(start, end) == feed) & (run.state.feed_mode.part(start, end) == 94)
        kind[start:end][fast & (kind[start:end] == Kind.LINEAR)] = Kind.RAPID
    return replace(run, kind=kind)


def tool_axis_exit_rows(run: Run) -> Ints:
    """Rows in which the tool leaves the part along its own axis by a distance, growing; no CL point asks for them.

    They go straight out at rapid, and what comes next are positions of the machine.
    """
    said = [event.before_row for event in run.events if event.kind == "leave"]
    if not said:
        return np.zeros(0, np.int64)
    rows = np.unique(np.array(said, np.int64))
    rows = rows[(rows > 0) & (rows + 1 < len(run))]
    rows = rows[run.state.machine_frame.at(rows + 1) & (run.kind[rows] == Kind.RAPID)]
    before, after = run.positions(rows - 1), run.positions(rows)
    way = after.tip - before.tip
    out = np.einsum("ij,ij->i", way, after.axis)
    aside = np.abs(way - out[:, None] * after.axis).max(axis=1, initial=0.0)
    still = np.abs(after.axis - before.axis).max(axis=1, initial=0.0) < _STEADY
    return np.asarray(rows[(out > 0.0) & (aside < _STRAIGHT) & still])


def approach_rows(run: Run) -> Ints:
    """Rows that are the first leg of an approach, growing; no CL point asks for them.

    The tool has been drawn back (``retract``), or comes from a position of the machine, and goes to its X and Y at
    rapid; the block after it says Z alone. Where the machine's travel is not known, nobody knows from how high it
    comes.
    """
    found = []
    starts = {event.before_row for event in run.events if event.kind == "retract"}
    starts.update(row for row in run.state.machine_frame.rows_changing_to(False) if row > 0)
    for start in sorted(starts):
        row = start
        while row + 1 < len(run) and (
            run.state.machine_frame[row] or not int(run.programmed[row]) & int(POSITION_WORDS)
        ):
            row += 1
        if row + 1 >= len(run) or (run.kind[row : row + 2] != Kind.RAPID).any() or run.state.tcp[row]:
            continue
        across, along = (int(bits) & int(POSITION_WORDS) for bits in run.programmed[row : row + 2])
        if not across & ~int(ProgrammedWord.X | ProgrammedWord.Y) and along == int(ProgrammedWord.Z):
            found.append(row)
    return np.unique(np.array(found, np.int64))
