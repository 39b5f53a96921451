"""What the machine shows at some times of a program: axes, tool tip, spindle, and the block that runs.

In:     a run in time with the texts of its program; times, and rows of which they are the ends.
Out:    ``Snapshots``.
Units:  mm and degrees, mm/min, rev/min, seconds of the program.
"""

import math
from collections.abc import Mapping, Sequence
from functools import cached_property
from pathlib import PurePath
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.machines import Machine, forward
from trunnion.machines.unmeasured import POSITIONS, ValueKind, unmeasured_values
from trunnion.model.run import Run
from trunnion.model.run_samples import joint_samples
from trunnion.records import dataclass
from trunnion.timing import TimedEvent, TimedRun
from trunnion.twin.modal import Blocks, BlockState
from trunnion.verification.grounds import Grounds, grounds_of

#: How far beyond its travel an axis may stand before it is an alarm, mm or degrees.
_TRAVEL_TOLERANCE = 1e-6

#: Further than any axis goes, mm or degrees.
_FAR = 1e5


@dataclass(frozen=True, slots=True, eq=False)
class Snapshots:
    """A machine at k times, ascending.

    seconds    (k,)    of the program
    row        (k,)    that runs, or that has just ended; -1 before the first
    is_end     (k,)    the row ends here, and ``joints`` are exactly those of the run
    joints     (k, 5)  axis values as displayed, machine order
    remaining  (k, 5)  from there to the end of the row
    moving     (k, 5)  the axis moves
    rates      (k, 3, 5)  velocity, acceleration and jerk of the axes, mm or degrees and seconds
    tip        (k, 3)  tool tip in the workpiece frame
    to_go      (k, 3)  from there to the tip at the end of the row
    feed       (k,)    speed along the path as F counts it
    rpm        (k,)    speed of the spindle, negative for M4
    told_rpm   (k,)    speed that it has been told
    blocks             what is in force at each time
    """

    seconds: Floats
    row: Ints
    is_end: Flags
    joints: Floats
    remaining: Floats
    moving: Flags
    rates: Floats
    tip: Floats
    to_go: Floats
    feed: Floats
    rpm: Floats
    told_rpm: Floats
    blocks: tuple[BlockState, ...]

    def __len__(self) -> int:
        return len(self.seconds)


#: What positions, times and alarms of limits stand on.
_STANDS_ON: Final = (*POSITIONS, ValueKind.TRAVEL, ValueKind.RAPID, ValueKind.ACCELERATION, ValueKind.WAITS)


class TwinProgram:
    """A program in time, with its texts, as a twin runs it; ``lengths`` are those of its tools by their index."""

    def __init__(self, timed: TimedRun, texts: Sequence[str], lengths: Mapping[int, float] | None = None) -> None:
        self.timed = timed
        self._blocks = Blocks(timed, texts)
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
    def files(self) -> tuple[str, ...]:
        """Names of the main program and of its subprograms, without their folders."""
        return tuple(PurePath(name).name for name in self.run.files) or (self.name,)

    @property
    def grounds(self) -> Grounds:
        """What positions and times stand on besides the program."""
        return grounds_of(
            (self.run,),
            (value.said for value in unmeasured_values(self.machine, _STANDS_ON, joint_samples(self.run))),
        )

    @cached_property
    def tools(self) -> tuple[str, ...]:
        """Tools that the program calls, in the order of the first calls."""
        return tuple(name for name in self.run.tools if name)

    def events_within(self, begin: float, end: float) -> list[TimedEvent]:
        """Events after ``begin`` (from it on, at the start of the program) up to ``end``."""
        return [e for e in self.timed.events if (begin < e.seconds <= end) or (e.seconds == begin == 0.0)]

    def at(self, seconds: Floats, ended: Ints, share: float = 1.0) -> Snapshots:
        """Return the machine at times (k,), ascending; ``ended`` (k,) are the rows that end at them, -1 where none
        does.

        ``share``: of the speed, as the feed override has it; 0: the axes stand.
        """
        run, is_end = self.run, ended >= 0
        state = self.timed.at(seconds, ~is_end)
        row = np.where(is_end, ended, state.row)
        moving = state.velocity != 0.0
        if is_end.any():  # an axis that goes on moves, one that has arrived does not
            moving[is_end] &= self.timed.at(seconds[is_end], np.ones(int(is_end.sum()), np.bool_)).velocity != 0.0
        rates = np.stack((state.velocity, state.acceleration, state.jerk), axis=1) * share ** np.arange(1, 4)[:, None]
        blocks = self._blocks.at(seconds, row, is_end, state.told_rpm)
        joints = state.joints.copy()
        joints[is_end] = run.positions(ended[is_end]).joints
        of_row = run.positions(row)
        tip, _ = run.forward_at(row, joints)
        tip[is_end] = of_row.tip[is_end]
        remaining, to_go = of_row.joints - joints, of_row.tip - tip
        before = row < 0
        remaining[before], to_go[before] = 0.0, 0.0
        return Snapshots(
            seconds, row, is_end, joints, remaining, moving & (share > 0.0), rates, tip, to_go, state.feed * share,
            state.rpm, state.told_rpm, blocks,
        )  # fmt: skip

    def before_start(self) -> Snapshots:
        """Return the machine before the program has been started."""
        joints = np.asarray(self.run.start)[None]
        none, still = np.zeros((1, 5)), np.zeros(1)
        return Snapshots(
            still, np.full(1, -1), np.zeros(1, np.bool_), joints, none, np.zeros((1, 5), np.bool_),
            np.zeros((1, 3, 5)), forward(self.machine, joints)[0], np.zeros((1, 3)), still, still, still,
            (self._blocks.before_start(),),
        )  # fmt: skip

    def tool_number(self, name: str) -> int:
        """Return the number by which a tool is called; of a name, its place among the tools; 0 for none."""
        if name.isascii() and name.isdigit() and int(name) < 2**31:
            return int(name)
        return self.tools.index(name) + 1 if name in self.tools else 0

    def beyond_travel(self, snapshots: Snapshots, since: float) -> Flags:
        """Which axes are beyond their travel, (k, 5), where it is known where they stand.

        There, or on the way since the time before; ``since`` is that of the first. An arc may go beyond a limit and be
        back at its end.
        """
        low, high = self.machine.limits.T
        placed = np.array([self.machine.is_placed(column) for column in range(5)])
        least, most = self.timed.passed(np.append(since, snapshots.seconds[:-1]), snapshots.seconds)
        with np.errstate(invalid="ignore"):
            beyond = np.minimum(least, snapshots.joints) < low - _TRAVEL_TOLERANCE
            beyond |= np.maximum(most, snapshots.joints) > high + _TRAVEL_TOLERANCE
        return np.asarray(beyond & placed)


def displayed(machine: Machine, column: int, values: Floats) -> Floats:
    """Return what a control shows of an axis: of one that turns without end, the turn in which the machine shows it."""
    axis = machine.axes[column]
    if not axis.endless or math.isnan(axis.display_low):
        return values
    shown = np.mod(values - axis.display_low, 360.0)
    return np.where(shown >= 360.0, 0.0, shown) + axis.display_low


def display_range(machine: Machine, column: int) -> tuple[float, float]:
    """Return the range of what a control shows of an axis, finite.

    It is that of the travel where it is known where slides stand; without a workpiece zero nobody knows what of it
    their values use.
    """
    axis = machine.axes[column]
    if axis.endless and not math.isnan(axis.display_low):
        return axis.display_low, axis.display_low + 360.0
    if axis.endless or not machine.is_placed(column):
        return -_FAR, _FAR
    return max(axis.low, -_FAR), min(axis.high, _FAR)
