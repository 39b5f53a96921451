"""What the axes do between the rows: time, speeds, accelerations, and how the tool bends on the way.

In:     a run.
Out:    per row the time it takes and the speed of the tip; over all rows, how much of each axis' rapid speed and
        acceleration is asked for, how far they go, and how far the tool is off half-way.
Units:  mm and degrees; minutes inside the kernel, seconds outside.

A row at feed takes its length at its feed, or longer if an axis cannot follow. Its length is the tip's way with TCP,
the slides' way without; where nothing but rotary axes move, degrees count as millimetres. A rapid takes as long as its
slowest axis. The acceleration between two rows at feed is the change of speed over half the time of both: a control
that rounds corners needs less, one that stops exactly needs more.
"""

import math
from dataclasses import dataclass, field

import numpy as np
from numba import njit

from trunnion.arrays import Codes, Flags, Floats, Ints
from trunnion.machine import forward
from trunnion.reader import Orientation, Run
from trunnion.toolpath import Kind
from trunnion.verify.align import CHUNK

#: Rotary motion below this, degrees, bends nothing.
_STILL = 1e-9

#: Rows of a chunk that are worked out before the others.
_FIRST = 256


@dataclass(slots=True)
class Worst:
    """The worst of many rows, and those beyond a limit: ``rows`` are the worst of them, worst first."""

    limit: float
    named: int
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
        worst = beyond[np.argsort(-values[beyond], kind="stable")[: self.named]]
        self.rows = sorted(
            [*self.rows, *((first + int(k), float(values[k])) for k in worst)], key=lambda place: -place[1]
        )[: self.named]


@dataclass(frozen=True, slots=True, eq=False)
class Walk:
    """What a program makes the axes do.

    seconds       (n,) float64
    tip_feed      (n,) float64, mm/min
    speed         share of an axis' rapid speed that a row at feed asks for, by axis; 1 is all of it
    acceleration  the same of its acceleration
    bend_axis     degrees between the tool axis half-way and the great circle, rows that cut
    bend_tip      mm between the tip half-way and its straight line, rows that cut without TCP
    extremes      (5, 2) least and greatest values, mm or deg: of slides in workpiece motions, of rotary axes in all
    places        (5, 2) rows where they are
    """

    seconds: Floats
    tip_feed: Floats
    speed: tuple[Worst, ...]
    acceleration: tuple[Worst, ...]
    bend_axis: Worst
    bend_tip: Worst
    extremes: Floats
    places: Ints


def walk(run: Run, named: int, span_limit: float = math.inf) -> Walk:
    """Go through all rows of a run; of what is beyond a limit, ``named`` rows are named."""
    machine = run.machine
    n = len(run)
    rapid = np.array([math.inf if axis.rapid is None else axis.rapid for axis in machine.axes])
    acceleration = np.array([math.inf if axis.acceleration is None else axis.acceleration for axis in machine.axes])
    seconds, tip_feed = np.zeros(n), np.zeros(n)
    speed, more = np.empty((5, min(n, CHUNK))), np.empty((5, min(n, CHUNK)))
    bend = np.empty(min(n, CHUNK))
    angles = run.orientation == Orientation.ANGLES
    state = np.zeros(12)
    state[:5] = run.start
    state[6:9] = forward(machine, run.start[None])[0][0]
    extremes = np.column_stack((np.full(5, math.inf), np.full(5, -math.inf)))
    places = np.full((5, 2), -1, np.int64)
    rotary = np.array([axis.is_rotary for axis in machine.axes])
    arc_length = _arc_lengths(run)
    speeds = tuple(Worst(1.0 + 1e-9, named) for _ in range(5))
    accelerations = tuple(Worst(1.0 + 1e-9, named) for _ in range(5))
    bend_axis, bend_tip = Worst(span_limit, named), Worst(math.inf, named)
    for start in range(0, n, CHUNK):
        end = min(start + CHUNK, n)
        walk_rows(
            start, end, run.joints, run.tip, run.kind, run.programmed, run.tcp, run.machine_frame, run.feed,
            run.feed_mode, run.rpm, run.arcs.row, arc_length, rotary, rapid, acceleration, state, extremes, places,
            seconds, tip_feed, speed, more, angles, bend,
        )  # fmt: skip
        for k, axis in enumerate(machine.axes):
            if axis.rapid is not None:
                speeds[k].take(start, speed[k, : end - start])
            if axis.acceleration is not None:
                accelerations[k].take(start, more[k, : end - start])
        _bend(run, start, bend[: end - start], bend_axis, bend_tip)
    return Walk(seconds, tip_feed, speeds, accelerations, bend_axis, bend_tip, extremes, places)


def _arc_lengths(run: Run) -> Floats:
    """Length of each circle of the run, mm."""
    rows = run.arcs.row
    if not len(rows):
        return np.zeros(0)
    first = forward(run.machine, run.start[None])[0]
    start = np.where((rows > 0)[:, None], run.tip[rows - 1], first)
    end, centre, normal = run.tip[rows], run.arcs.centre, run.arcs.normal
    rise = np.einsum("ij,ij->i", end - start, normal)
    a, b = start - centre, end - centre
    across = np.einsum("ij,ij->i", np.cross(a, b), normal)
    along = np.einsum("ij,ij->i", a, b) - np.einsum("ij,ij->i", a, normal) * np.einsum("ij,ij->i", b, normal)
    angle = np.mod(np.arctan2(across, along), 2.0 * np.pi)
    angle = np.where(np.minimum(angle, 2.0 * np.pi - angle) * run.arcs.radius < 1e-6, 2.0 * np.pi, angle)
    return np.asarray(np.hypot((angle + 2.0 * np.pi * run.arcs.turns) * run.arcs.radius, rise))


def _bend(run: Run, start: int, most: Floats, bend_axis: Worst, bend_tip: Worst) -> None:
    """How far the tool is off half-way through rows that cut and turn a rotary axis.

    ``most`` (k,) is more than the tool axis can be off, degrees: rows that cannot be the worst are not worked out.
    """
    needed = min(bend_axis.limit, bend_axis.value)
    if len(most) > _FIRST:
        # The likeliest ones first: they raise what is needed.
        likely = np.argpartition(most, -_FIRST)[-_FIRST:]
        off = _off_axis(run, start + likely)
        needed = min(bend_axis.limit, max(bend_axis.value, float(off.max())))
    rows = np.flatnonzero(most >= max(needed, _STILL))
    off = np.zeros(len(most))
    off[rows] = _off_axis(run, start + rows)
    bend_axis.take(start, off)
    part = slice(start, start + len(most))
    free = np.flatnonzero((most > _STILL) & ~run.tcp[part] & (run.kind[part] == Kind.LINEAR))
    if len(free):
        before = _before(run, start + free)
        middle = forward(run.machine, 0.5 * (before + run.joints[start + free]))[0]
        away = middle - 0.5 * (forward(run.machine, before)[0] + run.tip[start + free])
        off[:] = 0.0
        off[free] = np.nan_to_num(np.sqrt(np.einsum("ij,ij->i", away, away)))
        bend_tip.take(start, off)


def _before(run: Run, rows: Ints) -> Floats:
    """Joints before rows, (k, 5)."""
    before = run.joints[np.maximum(rows - 1, 0)]
    before[rows == 0] = run.start
    return before


def _off_axis(run: Run, rows: Ints) -> Floats:
    """Degrees between the tool axis half-way through rows and the great circle from end to end, (k,)."""
    if not len(rows):
        return np.zeros(0)
    begin = _before(run, rows)
    axis = forward(run.machine, 0.5 * (begin + run.joints[rows]))[1]
    middle = run.axis[np.maximum(rows - 1, 0)] + run.axis[rows]
    first = np.flatnonzero(rows == 0)
    if len(first):
        middle[first] = forward(run.machine, begin[first])[1] + run.axis[0]
    middle /= np.sqrt(np.einsum("ij,ij->i", middle, middle))[:, None]
    axis -= middle
    chord = np.sqrt(np.einsum("ij,ij->i", axis, axis))
    return np.asarray(np.nan_to_num(np.degrees(2.0 * np.arcsin(np.minimum(0.5 * chord, 1.0)))))


@njit(cache=True)
def walk_rows(
    start: int,
    end: int,
    joints: Floats,
    tip: Floats,
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
    state: Floats,
    extremes: Floats,
    places: Ints,
    seconds: Floats,
    tip_feed: Floats,
    speed: Floats,
    acceleration: Floats,
    angles: Flags,
    bend: Floats,
) -> None:
    """Go through rows ``start`` to ``end``.

    rapid, most   (5,) float64   mm/min or deg/min, mm/s^2 or deg/s^2; infinite where not stated
    state         (12,) float64  joints (5), minutes of the row before if it was at feed (else 0), tip (3), next arc
    speed, acceleration  (5, k) float64  written: shares of ``rapid`` and ``most``, 0 for rapids
    angles        (n,) bool      rotary axes go linearly, not the tool axis on a great circle
    bend          (k,) float64   written: more than the tool axis can be off half-way, degrees

    A curve whose second derivative is at most s is off its chord by at most s/8 half-way; here s is the square of the
    angles turned together, in radians. A little more allows for the chord's middle being nearer than the circle's.
    """
    velocity = np.zeros(5)
    minutes_before = state[5]
    arc = int(state[9])
    for k in range(5):
        velocity[k] = 0.0
    if minutes_before > 0.0 and start > 1:
        for k in range(5):
            velocity[k] = (joints[start - 1, k] - joints[start - 2, k]) / minutes_before
    x, y, z = state[6], state[7], state[8]
    for row in range(start, end):
        slowest = 0.0
        slides = 0.0
        turned = 0.0
        both = 0.0
        for k in range(5):
            before = joints[row - 1, k] if row > 0 else state[k]
            moved = abs(joints[row, k] - before)
            slowest = max(slowest, moved / rapid[k])
            if rotary[k]:
                turned = max(turned, moved)
                both += moved
            else:
                slides += moved * moved
            if rotary[k] or (not machine_frame[row] and (tcp[row] or programmed[row] & 7)):
                value = joints[row, k]
                if value < extremes[k, 0]:
                    extremes[k, 0] = value
                    places[k, 0] = row
                if value > extremes[k, 1]:
                    extremes[k, 1] = value
                    places[k, 1] = row
        dx, dy, dz = tip[row, 0] - x, tip[row, 1] - y, tip[row, 2] - z
        x, y, z = tip[row, 0], tip[row, 1], tip[row, 2]
        way = math.sqrt(dx * dx + dy * dy + dz * dz)
        while arc < arc_row.shape[0] and arc_row[arc] < row:
            arc += 1
        on_arc = arc < arc_row.shape[0] and arc_row[arc] == row
        if on_arc:
            way = arc_length[arc]
        minutes = 0.0
        if kind[row] != 0:
            length = way if tcp[row] or on_arc else math.sqrt(slides)
            if length < 1e-9:
                length = turned
            rate = feed[row]
            if feed_mode[row] == 95:
                rate *= rpm[row]
            elif feed_mode[row] == 93:
                rate *= length
            if rate > 0.0:
                minutes = length / rate
        took = max(minutes, slowest)
        seconds[row] = 60.0 * took
        tip_feed[row] = way / took if took > 0.0 else 0.0
        at = row - start
        bend[at] = 0.0
        if kind[row] != 0 and not machine_frame[row] and (angles[row] or not tcp[row]):
            bend[at] = both * both * (math.pi / 180.0) / 6.0 if both < 60.0 else 180.0
        for k in range(5):
            speed[k, at] = 0.0
            acceleration[k, at] = 0.0
            if minutes <= 0.0:
                continue
            before = joints[row - 1, k] if row > 0 else state[k]
            now = (joints[row, k] - before) / minutes
            speed[k, at] = abs(now) / rapid[k]
            if minutes_before > 0.0:
                change = 2.0 * abs(now - velocity[k]) / (minutes + minutes_before)
                acceleration[k, at] = change / 3600.0 / most[k]
            velocity[k] = now
        minutes_before = minutes
    state[5] = minutes_before
    state[6], state[7], state[8] = x, y, z
    state[9] = arc
