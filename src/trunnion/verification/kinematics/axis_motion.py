"""What the axes do between the rows: time, speeds, accelerations, and how the tool bends on the way.

In:     a run.
Out:    per row the time it takes and the speed of the tip; over all rows, how much of each axis' rapid speed and
        acceleration is asked for, how far they go, and how far the tool is off half-way.
Units:  mm and degrees; minutes inside the kernel, seconds outside.

A row at feed asks for its length at its feed. Its length is the tip's way with TCP; without, it is the slides' way, or
what the control counts besides (``FeedPath``). Where nothing but rotary axes move, degrees count as millimetres. How
long it takes is in ``trunnion.verification.kinematics.run_time``. The acceleration between two rows at feed is the
change of speed over half the time of both: a control that rounds corners needs less, one that stops exactly needs more.
"""

import math
from dataclasses import dataclass, field, replace

import numpy as np

from trunnion.arrays import Codes, Flags, Floats, Ints
from trunnion.jit import njit
from trunnion.machines import Machine, forward
from trunnion.model.feed_path import NO_ROTATION, FeedPath, feed_path_lengths
from trunnion.model.run import Orientation, PositionChunk, Run
from trunnion.model.toolpath import Kind
from trunnion.verification.kinematics.rapid_feeds import approach_rows
from trunnion.verification.kinematics.run_time import RunTimer


@dataclass(slots=True)
class WorstRows:
    """The worst of many rows, and those beyond a limit: ``rows`` are the worst of them, worst first."""

    limit: float
    max_rows: int
    value: float = 0.0
    row: int = -1
    count: int = 0
    rows: list[tuple[int, float]] = field(default_factory=list)

    def take(self, first: int, values: Floats) -> None:
        """Add the values of consecutive rows from ``first`` on."""
        if not len(values):
            return
        k = int(np.argmax(values))
        if values[k] > self.value:
            self.value, self.row = float(values[k]), first + k
        if values[k] <= self.limit:
            return
        beyond = np.flatnonzero(values > self.limit)
        self.count += len(beyond)
        worst = beyond[np.argsort(-values[beyond], kind="stable")[: self.max_rows]]
        self.rows = sorted(
            [*self.rows, *((first + int(k), float(values[k])) for k in worst)], key=lambda place: -place[1]
        )[: self.max_rows]


@dataclass(frozen=True, slots=True, eq=False)
class AxisMotion:
    """What a program makes the axes do.

    seconds       (n,) float64; no rows where times were not asked for
    tip_feed      (n,) float64, mm/min; the same
    speed         share of an axis' rapid speed that a row at feed asks for, by axis; 1 is all of it
    acceleration  the same of its acceleration
    bend_axis     degrees between the tool axis half-way and the great circle, rows that cut
    bend_tip      mm between the tip half-way and its straight line, rows that cut without TCP
    extremes      (5, 2) least and greatest values, mm or deg: of slides in workpiece motions, of rotary axes in all
    places        (5, 2) rows where they are
    """

    seconds: Floats
    tip_feed: Floats
    speed: tuple[WorstRows, ...]
    acceleration: tuple[WorstRows, ...]
    axis_deviation: WorstRows
    tip_deviation: WorstRows
    extremes: Floats
    places: Ints


class AxisMotionAnalyzer:
    """Goes through the rows of a run, stretch by stretch; of what is beyond a limit, ``max_rows`` rows are named.

    ``times``: whether the time of each row is wanted.
    """

    def __init__(self, run: Run, max_rows: int, span_limit: float = math.inf, *, times: bool = True) -> None:
        self._run = run
        axes = run.machine.axes
        self._rotary = np.array([axis.is_rotary for axis in axes])
        self._rapid = np.array([math.inf if axis.rapid is None else axis.rapid for axis in axes])
        self._acceleration = np.array([math.inf if axis.acceleration is None else axis.acceleration for axis in axes])
        self._arc_length = _arc_lengths(run)
        self._levels = approach_rows(run)
        self._state = np.zeros(7)
        self._pace = RunTimer(run) if times else None
        self._walk = AxisMotion(
            np.zeros(0),
            np.zeros(0),
            tuple(WorstRows(1.0 + 1e-9, max_rows) for _ in axes),
            tuple(WorstRows(1.0 + 1e-9, max_rows) for _ in axes),
            WorstRows(span_limit, max_rows),
            WorstRows(math.inf, max_rows),
            np.column_stack((np.full(5, math.inf), np.full(5, -math.inf))),
            np.full((5, 2), -1, np.int64),
        )

    def take(self, first: int, end: int, poses: PositionChunk) -> None:
        """Add rows, in order; ``poses`` is the ``Run.chunk`` of them."""
        run, walk, count = self._run, self._walk, end - first
        state, kind, programmed = run.state, run.kind[first:end], run.programmed[first:end]
        tcp, machine_frame = state.tcp.part(first, end), state.machine_frame.part(first, end)
        # On the first leg of an approach the tool is still as high as the machine's position before it.
        here = self._levels[(self._levels >= first) & (self._levels < end)]
        machine_frame[here - first] = True
        angles = run.orientation_between(first, end) == Orientation.ANGLES
        times, shares, bend = np.empty((4, count)), np.empty((2, 5, count)), np.empty(count)
        ways = self._ways(first, end, poses, tcp)
        axis_motion_rows(
            first, poses.joints, poses.tip, poses.axis, poses.midpoint_axis, kind, programmed, tcp, machine_frame,
            state.feed.part(first, end), state.feed_mode.part(first, end), state.rpm.part(first, end), run.arcs.row,
            self._arc_length, self._rotary,
            self._rapid, self._acceleration, ways, self._state, walk.extremes, walk.places, times, shares, angles, bend,
        )  # fmt: skip
        if self._pace is not None:
            self._pace.take(first, end, poses, times)
        for k, axis in enumerate(run.machine.axes):
            if axis.rapid is not None:
                walk.speed[k].take(first, shares[0, k])
            if axis.acceleration is not None:
                walk.acceleration[k].take(first, shares[1, k])
        walk.axis_deviation.take(first, bend)
        if not tcp.all():
            turned = np.abs(np.diff(poses.joints[:, self._rotary], axis=0)).max(axis=1) > NO_ROTATION
            free = np.flatnonzero(turned & ~tcp & (kind == Kind.LINEAR))
            walk.tip_deviation.take(first, _off_tip(run.machine, poses, free, count))

    def _ways(self, first: int, end: int, poses: PositionChunk, tcp: Flags) -> Floats:
        """What F counts in rows in which rotary axes turn without TCP, NaN in the others; empty where there are none.

        A rule that counts the slides alone is left to the kernel.
        """
        path = self._run.state.feed_path.part(first, end)
        led = ~tcp & (path != FeedPath.SLIDES)
        if not led.any():
            return np.zeros(0)
        led &= np.abs(np.diff(poses.joints[:, self._rotary], axis=0)).max(axis=1) > NO_ROTATION
        found, rows = np.full(end - first, np.nan), np.flatnonzero(led)
        found[rows] = feed_path_lengths(self._run.machine, poses.joints[rows], poses.joints[rows + 1], path[rows])
        return found

    def result(self) -> AxisMotion:
        """Everything, when all rows have gone by."""
        if self._pace is None:
            return self._walk
        seconds, tip_feed = self._pace.result()
        return replace(self._walk, seconds=seconds, tip_feed=tip_feed)


def _arc_lengths(run: Run) -> Floats:
    """Length of each circle of the run, mm."""
    rows = run.arcs.row
    if not len(rows):
        return np.zeros(0)
    start, end = run.positions(rows - 1).tip, run.positions(rows).tip
    centre, normal = run.arcs.centre, run.arcs.normal
    rise = np.einsum("ij,ij->i", end - start, normal)
    a, b = start - centre, end - centre
    across = np.einsum("ij,ij->i", np.cross(a, b), normal)
    along = np.einsum("ij,ij->i", a, b) - np.einsum("ij,ij->i", a, normal) * np.einsum("ij,ij->i", b, normal)
    angle = np.mod(np.arctan2(across, along), 2.0 * np.pi)
    angle = np.where(np.minimum(angle, 2.0 * np.pi - angle) * run.arcs.radius < 1e-6, 2.0 * np.pi, angle)
    return np.asarray(np.hypot((angle + 2.0 * np.pi * run.arcs.full_turns) * run.arcs.radius, rise))


def _off_tip(machine: Machine, poses: PositionChunk, rows: Ints, count: int) -> Floats:
    """Mm between the tip half-way through ``rows`` and its straight line; of all ``count`` rows, 0 in the others."""
    middle = forward(machine, 0.5 * (poses.joints[rows] + poses.joints[rows + 1]))[0]
    away = middle - 0.5 * (forward(machine, poses.joints[rows])[0] + poses.tip[rows + 1])
    off = np.zeros(count)
    off[rows] = np.nan_to_num(np.sqrt(np.einsum("ij,ij->i", away, away)))
    return off


@njit(cache=True)
def half_way_deviation(axis: Floats, half_way: Floats, row: int) -> float:
    """Degrees from ``half_way`` (k, 3) at a row to the middle of the great circle from ``axis`` there to the next one.

    Opposite tool axes have no middle: 0.
    """
    x, y, z = axis[row, 0] + axis[row + 1, 0], axis[row, 1] + axis[row + 1, 1], axis[row, 2] + axis[row + 1, 2]
    length = math.sqrt(x * x + y * y + z * z)
    if not length > 0.0:
        return 0.0
    x, y, z = half_way[row, 0] - x / length, half_way[row, 1] - y / length, half_way[row, 2] - z / length
    chord = math.sqrt(x * x + y * y + z * z)
    # The angle of a small chord is the chord itself, to its last digit.
    return math.degrees(chord if chord < 1e-8 else 2.0 * math.asin(min(1.0, 0.5 * chord)))


@njit(cache=True, nogil=True)
def axis_motion_rows(
    first: int,
    joints: Floats,
    tip: Floats,
    axis: Floats,
    half_way: Floats,
    kind: Codes,
    programmed: Codes,
    tcp: Flags,
    machine_frame: Flags,
    feed: Floats,
    feed_mode: Codes,
    rpm: Floats,
    arc_row: Ints,
    arc_length: Floats,
    rotary: Flags,
    rapid: Floats,
    most: Floats,
    ways: Floats,
    state: Floats,
    extremes: Floats,
    places: Ints,
    times: Floats,
    shares: Floats,
    angles: Flags,
    bend: Floats,
) -> None:
    """Go through k rows from row ``first`` on.

    joints, tip, axis (k + 1, …) with the place before the rows in front; all other columns have k rows
    rapid, most   (5,) float64   mm/min or deg/min, mm/s^2 or deg/s^2; infinite where not stated
    ways          (k,) float64   what the feed counts where that is neither the tip's way nor the slides', else NaN;
                                 or empty
    state         (7,) float64   minutes of the row before if it was at feed (else 0), next arc, speeds of that row (5)
    times         (4, k) float64 written: length that the feed means, mm or degrees, the feed along it, infinite for
                                 rapids, the tip's way, mm, and 0, 1 or 2 where the tip, the slides or degrees are meant
    shares        (2, 5, k) float64  written: shares of ``rapid`` and, where it is stated, of ``most``; 0 for rapids
    angles        (k,) bool      rotary axes go linearly, not the tool axis on a great circle
    bend          (k,) float64   written: how far the tool axis is off half-way in rows that cut, degrees
    """
    velocity = state[2:]
    minutes_before = state[0]
    arc = int(state[1])
    for at in range(kind.shape[0]):
        row = first + at
        slides = 0.0
        turned = 0.0
        placed = not machine_frame[at] and (tcp[at] or programmed[at] & 7)
        for k in range(5):
            value = joints[at + 1, k]
            moved = abs(value - joints[at, k])
            if rotary[k]:
                turned = max(turned, moved)
            else:
                slides += moved * moved
            if rotary[k] or placed:
                if value < extremes[k, 0]:
                    extremes[k, 0] = value
                    places[k, 0] = row
                if value > extremes[k, 1]:
                    extremes[k, 1] = value
                    places[k, 1] = row
        dx, dy, dz = tip[at + 1, 0] - tip[at, 0], tip[at + 1, 1] - tip[at, 1], tip[at + 1, 2] - tip[at, 2]
        way = math.sqrt(dx * dx + dy * dy + dz * dz)
        while arc < arc_row.shape[0] and arc_row[arc] < row:
            arc += 1
        on_arc = arc < arc_row.shape[0] and arc_row[arc] == row
        if on_arc:
            way = arc_length[arc]
        minutes = 0.0
        meant = 0.0 if tcp[at] or on_arc else 1.0
        length = way if tcp[at] or on_arc else math.sqrt(slides)
        if ways.shape[0] and not on_arc and ways[at] == ways[at]:
            length = ways[at]
        if length < 1e-9:
            length = turned
            meant = 2.0
        speed = math.inf
        if kind[at] != 0:
            rate = feed[at]
            if feed_mode[at] == 95:
                rate *= rpm[at]
            elif feed_mode[at] == 93:
                rate *= length
            if rate > 0.0:
                minutes = length / rate
                speed = rate
        times[0, at] = length
        times[1, at] = speed
        times[2, at] = way
        times[3, at] = meant
        bend[at] = 0.0
        if turned > NO_ROTATION and kind[at] != 0 and not machine_frame[at] and (angles[at] or not tcp[at]):
            bend[at] = half_way_deviation(axis, half_way, at)
        for k in range(5):
            stated = most[k] < math.inf
            shares[0, k, at] = 0.0
            if stated:
                shares[1, k, at] = 0.0
            if minutes <= 0.0:
                continue
            now = (joints[at + 1, k] - joints[at, k]) / minutes
            shares[0, k, at] = abs(now) / rapid[k]
            if stated and minutes_before > 0.0:
                change = 2.0 * abs(now - velocity[k]) / (minutes + minutes_before)
                shares[1, k, at] = change / 3600.0 / most[k]
            velocity[k] = now
        minutes_before = minutes
    state[0] = minutes_before
    state[1] = arc
