"""What the axes do from row to row: travel, speed, acceleration, time, and how far the tool leaves its path half-way.

In:     a run.
Out:    over all rows the travel of each axis, the shares of its rapid speed and acceleration that the program asks for,
        and the deviation of the tool half-way; for each row its time and the speed of the tip.
Units:  mm and degrees; minutes inside the kernel, seconds outside.

A row at feed covers its length at its feed. With TCP, its length is the distance that the tip travels; without, that
of the slides, or whatever else the control counts (``FeedPath``). Where only rotary axes move, degrees count as
millimetres. ``trunnion.timing`` turns this into time. The acceleration between two rows at
feed is the change of speed over half the time of both: a control that rounds corners needs less, one that stops
exactly needs more.
"""

import math
from dataclasses import replace

import numpy as np

from trunnion.arrays import Codes, Flags, Floats, Ints
from trunnion.machines import Machine, forward
from trunnion.messages import Wording, phrase
from trunnion.model.arc_extremes import run_reach
from trunnion.model.feed_path import NO_ROTATION
from trunnion.model.programmed_words import POSITION_WORDS, ROTARY_WORDS
from trunnion.model.run import Orientation, PositionChunk, Run
from trunnion.model.toolpath import Kind
from trunnion.model.turning_lines import LineSearch, TurningLines
from trunnion.records import dataclass
from trunnion.timing import RowFeeds, RunTimer
from trunnion.verification.kinematics.arc_speeds import ArcSpeeds
from trunnion.verification.kinematics.axis_motion_kernel import AxisLimits, ChunkRows, axis_motion_rows
from trunnion.verification.kinematics.machine_positions import MachinePositions
from trunnion.verification.kinematics.positioning_moves import rotary_positioning_flags
from trunnion.verification.kinematics.seen_rows import SeenRows
from trunnion.verification.kinematics.unknown_approaches import UnknownApproaches, unknown_approaches
from trunnion.verification.kinematics.worst_rows import WorstRows


@dataclass(frozen=True, slots=True, eq=False)
class AxisMotion:
    """What a program makes the axes do.

    seconds         (n,) float64; no rows unless times were asked for
    waiting         (n,) float64, those of them that the axes wait; no rows unless times were asked for
    tip_feed        (n,) float64, mm/min; no rows unless times were asked for
    speed           for each axis, the share of its rapid speed that rows at feed need; 1 is all of it
    acceleration    for each axis, the share of its acceleration
    axis_deviation  degrees between the tool axis half-way and the great circle, in rows at feed
    tip_deviation   mm between the tip half-way and its straight line, in lines without TCP; neither of rows that only
                    position rotary axes
    extremes        (5, 2) lowest and highest values in workpiece motions, mm or deg; of slides also between the ends
                    of arcs and of lines on which rotary axes turn under TCP, but not where they stand at a position
                    of the machine that nobody can compare with those of the workpiece
    extreme_rows    (5, 2) the rows that reach them, -1 for none
    within_lines    (5, 2) bool: between the ends of a line on which rotary axes turn
    unknown         rows that are left out of the extremes, since nobody knows where they begin
    speed_seen      motions whose speeds are known
    change_seen     motions of which it is known how speeds change from the one before
    """

    seconds: Floats
    waiting: Floats
    tip_feed: Floats
    speed: tuple[WorstRows, ...]
    acceleration: tuple[WorstRows, ...]
    axis_deviation: WorstRows
    tip_deviation: WorstRows
    extremes: Floats
    extreme_rows: Ints
    within_lines: Flags
    unknown: UnknownApproaches
    speed_seen: SeenRows
    change_seen: SeenRows


class AxisMotionAnalyzer:
    """Collects the ``AxisMotion`` of a run, chunk by chunk; ``max_rows`` rows are kept of what is beyond a limit.

    ``times``: whether the time of each row is wanted.
    """

    def __init__(self, run: Run, max_rows: int, *, times: bool = True) -> None:
        self._run = run
        self._limits = AxisLimits.of(run.machine)
        self._feeds = RowFeeds(run)
        self._unknown = unknown_approaches(run)
        self._carry = np.zeros(6)
        self._timer = RunTimer(run) if times else None
        axes = run.machine.axes
        self._motion = AxisMotion(
            seconds=np.zeros(0),
            waiting=np.zeros(0),
            tip_feed=np.zeros(0),
            speed=tuple(WorstRows(1.0 + 1e-9, max_rows) for _ in axes),
            acceleration=tuple(WorstRows(1.0 + 1e-9, max_rows) for _ in axes),
            axis_deviation=WorstRows(math.inf, max_rows),
            tip_deviation=WorstRows(math.inf, max_rows),
            extremes=np.column_stack((np.full(5, math.inf), np.full(5, -math.inf))),
            extreme_rows=np.full((5, 2), -1, np.int64),
            within_lines=np.zeros((5, 2), np.bool_),
            unknown=self._unknown,
            speed_seen=SeenRows(),
            change_seen=SeenRows(),
        )
        self._line_searches: dict[int, LineSearch] = {}
        self._is_placed = all(run.machine.is_placed(column) for column in run.machine.linear)
        self._counts_before = self._moved_at_feed = False

    def add(self, first: int, end: int, positions: PositionChunk) -> None:
        """Add rows, in order; ``positions`` is the ``Run.chunk`` of them."""
        run, motion, count = self._run, self._motion, end - first
        state, kind = run.state, run.kind[first:end]
        # With M114 words of rotary axes move the linear ones too, as if these were named.
        programmed = run.programmed[first:end]
        turns = state.at_ends.part(first, end) & ((programmed & int(ROTARY_WORDS)) != 0)
        programmed = np.where(turns, programmed | np.uint8(POSITION_WORDS), programmed)
        tcp, machine_frame = state.tcp.part(first, end), state.machine_frame.part(first, end)
        # On the first leg of an approach the tool is still as high as before it, which may be known to nobody.
        here = self._unknown.rows[(self._unknown.rows >= first) & (self._unknown.rows < end)]
        machine_frame[here - first] = True
        at_machine = MachinePositions.of(run).unplaced(np.arange(first, end))
        feeds = self._feeds.part(first, end, positions)
        arcs = ArcSpeeds.of(run, first, end, positions)
        rows = ChunkRows(
            positions.joints,
            positions.tip,
            positions.axis,
            positions.midpoint_axis,
            kind,
            programmed,
            tcp,
            machine_frame,
            at_machine,
            run.orientation_between(first, end) == Orientation.ANGLES,
            feeds,
            arcs.rows - first,
            arcs.begin,
            arcs.end,
        )
        shares, deviation = np.empty((2, 5, count)), np.empty(count)
        extremes_before = motion.extremes.copy()
        axis_motion_rows(
            first, rows, self._limits, self._carry, motion.extremes, motion.extreme_rows, shares, deviation
        )
        self._count_seen(first, kind, feeds)
        self._add_arc_shares(arcs, first, feeds, shares)
        self._add_arcs(first, positions, machine_frame, at_machine)
        motion.within_lines[motion.extremes != extremes_before] = False
        self._add_lines(first, positions, tcp, machine_frame)
        if self._timer is not None:
            self._timer.add(first, positions, feeds)
        for k, axis in run.machine.own_columns:
            if axis.rapid is not None:
                motion.speed[k].add(first, shares[0, k])
            if axis.acceleration is not None:
                motion.acceleration[k].add(first, shares[1, k])
        positioning = rotary_positioning_flags(run, first, end)
        motion.axis_deviation.add(first, np.where(positioning, 0.0, deviation))
        if not tcp.all():
            free = np.flatnonzero(self._turns(positions) & ~tcp & (kind == Kind.LINEAR) & ~positioning)
            motion.tip_deviation.add(first, _tip_deviations(run.machine_at(first), positions, free, count))

    def _count_seen(self, first: int, kind: Codes, feeds: Floats) -> None:
        """Count the motions whose speeds are known, and those of which it is known how speeds change."""
        count, motion, unknown = len(kind), self._motion, self._unknown
        at_feed = np.isfinite(feeds[1])
        left: list[tuple[Wording, Flags]] = [(phrase("left_rapid"), kind == Kind.RAPID)]
        for row, why in zip(unknown.rows.tolist(), unknown.reasons, strict=True):
            if first <= row < first + count:
                left.append((why, np.arange(count) == row - first))
        left.append((phrase("left_no_feed"), ~at_feed))
        motion.speed_seen.add(first, count, left)
        before = np.append(self._moved_at_feed, (at_feed & (feeds[0] > 0.0))[:-1])
        self._moved_at_feed = bool(at_feed[-1] and feeds[0, -1] > 0.0)
        motion.change_seen.add(first, count, [*left, (phrase("left_begins_at_feed"), ~before)])

    def _add_arc_shares(self, arcs: ArcSpeeds, first: int, feeds: Floats, shares: Floats) -> None:
        """Raise the shares of arcs, (2, 5, k), to the greatest ones on their way."""
        at = arcs.rows - first
        minutes = feeds[0, at] / feeds[1, at]
        known = (minutes > 0.0) & np.isfinite(minutes)
        at, minutes = at[known], minutes[known, None]
        speed = arcs.most[known] / minutes / self._limits.rapid
        acceleration = arcs.acceleration[known] / (60.0 * minutes) ** 2 / self._limits.acceleration
        for share, values in zip(shares, (speed, acceleration), strict=True):
            share[:, at] = np.maximum(share[:, at], values.T)

    def _add_arcs(self, first: int, positions: PositionChunk, machine_frame: Flags, at_machine: Flags) -> None:
        """Widen the extremes of slides by what arcs reach between their ends."""
        rows, reach = run_reach(self._run, first, first + len(machine_frame), positions)
        counts = ~machine_frame[rows - first]
        if not counts.any():
            return
        rows, low, high = rows[counts], reach.low[counts], reach.high[counts]
        out = at_machine[rows - first]
        low, high = np.where(out, math.inf, low), np.where(out, -math.inf, high)
        extremes, extreme_rows = self._motion.extremes, self._motion.extreme_rows
        for column in self._run.machine.linear:
            least, most = int(np.argmin(low[:, column])), int(np.argmax(high[:, column]))
            if low[least, column] < extremes[column, 0]:
                extremes[column, 0], extreme_rows[column, 0] = low[least, column], rows[least]
            if high[most, column] > extremes[column, 1]:
                extremes[column, 1], extreme_rows[column, 1] = high[most, column], rows[most]

    def _add_lines(self, first: int, positions: PositionChunk, tcp: Flags, machine_frame: Flags) -> None:
        """Widen the extremes of slides by what they reach on lines on which rotary axes turn under TCP.

        Where nobody knows where the machine stands, a line that comes from a position of the machine does not count.
        """
        counts = tcp & ~machine_frame
        known = np.append(self._counts_before, ~machine_frame[:-1]) | self._is_placed
        self._counts_before = not machine_frame[-1]
        end = first + len(tcp)
        counts &= known & (self._run.kind[first:end] != Kind.ARC)
        by_vector = self._run.orientation_between(first, end) == Orientation.GREAT_CIRCLE
        search = self._line_search(first)
        at = search.likely(positions.tip, positions.joints, counts, by_vector)
        if not len(at):
            return
        tip, axis, joints = (
            np.stack((each[at], each[at + 1]), axis=1) for each in (positions.tip, positions.axis, positions.joints)
        )
        search.add(TurningLines(first + at, tip, axis, joints, by_vector[at]))

    def _line_search(self, row: int) -> LineSearch:
        """Return the search on the machine as it is set up in a row."""
        machine, motion = self._run.machine_at(row), self._motion
        if id(machine) not in self._line_searches:
            self._line_searches[id(machine)] = LineSearch(
                machine, motion.extremes, motion.extreme_rows, motion.within_lines
            )
        return self._line_searches[id(machine)]

    def _turns(self, positions: PositionChunk) -> Flags:
        """Which rows turn a rotary axis, (k,) bool."""
        steps = np.diff(positions.joints[:, self._limits.rotary], axis=0)
        return np.asarray(np.abs(steps).max(axis=1) > NO_ROTATION)

    def result(self) -> AxisMotion:
        """Everything, once all rows have been added."""
        if self._timer is None:
            return self._motion
        times = self._timer.result()
        seconds = times.moving + times.waiting
        return replace(self._motion, seconds=seconds, waiting=times.waiting, tip_feed=times.tip_feed)


def _tip_deviations(machine: Machine, positions: PositionChunk, rows: Ints, count: int) -> Floats:
    """Mm between the tip half-way through ``rows`` and its straight line; (count,), 0 in the other rows."""
    joints = positions.joints
    middle = forward(machine, 0.5 * (joints[rows] + joints[rows + 1]))[0]
    away = middle - 0.5 * (forward(machine, joints[rows])[0] + positions.tip[rows + 1])
    off = np.zeros(count)
    off[rows] = np.nan_to_num(np.sqrt(np.einsum("ij,ij->i", away, away)))
    return off
