"""What the machine shows at some times of a program: axes, tool tip, spindle, and the block that runs.

In:     a run in time with the texts of its program; times, and rows of which they are the ends.
Out:    ``Snapshots``.
Units:  mm and degrees, mm/min, rev/min, seconds of the program.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import PurePath

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.machines import Machine, forward
from trunnion.model.run import Run
from trunnion.timing import TimedEvent, TimedRun
from trunnion.twin.modal import Blocks, BlockState

#: How far beyond its travel an axis may stand before it is an alarm, mm or degrees.
_TRAVEL_TOLERANCE = 1e-6


@dataclass(frozen=True, slots=True, eq=False)
class Snapshots:
    """A machine at k times, ascending.

    seconds    (k,)    of the program
    row        (k,)    that runs, or that has just ended; -1 before the first
    is_end     (k,)    the row ends here, and ``joints`` are exactly those of the run
    joints     (k, 5)  axis values as displayed, machine order
    remaining  (k, 5)  from there to the end of the row
    moving     (k, 5)  the axis moves
    tip        (k, 3)  tool tip in the workpiece frame
    to_go      (k, 3)  from there to the tip at the end of the row
    tip_feed   (k,)    speed of the tip
    rpm        (k,)    speed of the spindle, negative for M4
    blocks             what is in force at each time
    """

    seconds: Floats
    row: Ints
    is_end: Flags
    joints: Floats
    remaining: Floats
    moving: Flags
    tip: Floats
    to_go: Floats
    tip_feed: Floats
    rpm: Floats
    blocks: tuple[BlockState, ...]

    def __len__(self) -> int:
        return len(self.seconds)


class TwinProgram:
    """A program in time, with its texts, as a twin runs it; ``lengths`` are those of its tools by their index."""

    def __init__(self, timed: TimedRun, texts: Sequence[str], lengths: Mapping[int, float] | None = None) -> None:
        self.timed = timed
        self._blocks = Blocks(timed.run, texts)
        self.lengths = dict(lengths or {})

    @property
    def run(self) -> Run:
        """The program as the control runs it."""
        return self.timed.run

    @property
    def machine(self) -> Machine:
        """The machine that it runs on."""
        return self.timed.run.machine

    @property
    def name(self) -> str:
        """Name of the main program, without its folder."""
        return PurePath(self.run.files[0]).name if self.run.files else "program"

    @property
    def tools(self) -> tuple[str, ...]:
        """Tools that the program calls, in the order of the first calls."""
        return tuple(name for name in self.run.tools if name)

    def events_within(self, begin: float, end: float) -> list[TimedEvent]:
        """Events after ``begin`` (from it on, at the start of the program) up to ``end``."""
        return [e for e in self.timed.events if (begin < e.seconds <= end) or (e.seconds == begin == 0.0)]

    def at(self, seconds: Floats, ended: Ints, *, standing: bool = False) -> Snapshots:
        """The machine at times (k,), ascending; ``ended`` (k,) are the rows that end at them, -1 where none does.

        ``standing``: the program does not go on there, and no axis moves.
        """
        run, state = self.run, self.timed.at(seconds)
        is_end = ended >= 0
        row = np.where(is_end, ended, state.row)
        joints = state.joints.copy()
        joints[is_end] = run.positions(ended[is_end]).joints
        of_row = run.positions(row)
        tip = forward(self.machine, joints)[0]
        tip[is_end] = of_row.tip[is_end]
        remaining, to_go = of_row.joints - joints, of_row.tip - tip
        before = row < 0
        remaining[before], to_go[before] = 0.0, 0.0
        moving = (state.velocity != 0.0) & ~is_end[:, None] & (not standing)
        tip_feed = np.zeros(len(seconds)) if standing else state.tip_feed
        blocks = tuple(self._blocks.at(k) for k in row.tolist())
        return Snapshots(seconds, row, is_end, joints, remaining, moving, tip, to_go, tip_feed, state.rpm, blocks)

    def beyond_travel(self, snapshots: Snapshots) -> Flags:
        """Which axes are beyond their travel, (k, 5), where it is known where they stand."""
        low, high = self.machine.limits.T
        placed = np.array([self.machine.is_placed(column) for column in range(5)])
        joints = snapshots.joints
        with np.errstate(invalid="ignore"):
            beyond = (joints < low - _TRAVEL_TOLERANCE) | (joints > high + _TRAVEL_TOLERANCE)
        return np.asarray(beyond & placed)
