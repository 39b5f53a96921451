"""What the feed of each row counts: a length, and the speed along it.

In:     a run and the positions of some of its rows.
Out:    for each row the length that F refers to, the speed along it and the distance that the tip travels.
Units:  mm and degrees; mm/min and deg/min.

With TCP, and on circles, F counts the path of the tip. Without, it counts that of the slides, or whatever else the
control counts (``FeedPath``). Where nothing of that moves, the degrees of the rotary axis that turns farthest count.
"""

import math
from enum import IntEnum

import numpy as np

from trunnion.arrays import Codes, Flags, Floats, Floats2, Ints
from trunnion.jit import inlined, kernel
from trunnion.model.feed_path import NO_ROTATION, FeedPath, feed_path_lengths
from trunnion.model.run import PositionChunk, Run


class FeedRow(IntEnum):
    """What the rows of ``RowFeeds.part`` are.

    LENGTH  that the feed counts, mm or degrees
    RATE    speed along it, mm/min or deg/min; infinite for rapids and where no feed is known
    TRAVEL  distance that the tip covers, mm
    COUNTS  whether the length is that of the tip (0), of the slides (1) or in degrees (2)
    """

    LENGTH = 0
    RATE = 1
    TRAVEL = 2
    COUNTS = 3


class RowFeeds:
    """The feeds of a run, some rows at a time and in any order."""

    def __init__(self, run: Run) -> None:
        self._run = run
        self._arc_length = arc_lengths(run)
        self._rotary = np.array([axis.is_rotary for axis in run.machine.axes])

    def part(self, first: int, end: int, positions: PositionChunk) -> Floats:
        """Return the feeds of consecutive rows, (4, k): what ``FeedRow`` says; ``positions`` is their ``Run.chunk``."""
        run, state = self._run, self._run.state
        tcp = state.tcp.part(first, end)
        feeds = np.empty((4, end - first))
        fill_feeds(
            first, positions.joints, positions.tip, run.kind[first:end], tcp, state.feed.part(first, end),
            state.feed_mode.part(first, end), state.rpm.part(first, end), self._lengths(first, end, positions, tcp),
            self._rotary, run.arcs.row, self._arc_length, feeds,
        )  # fmt: skip
        return feeds

    def _lengths(self, first: int, end: int, positions: PositionChunk, tcp: Flags) -> Floats:
        """Return what F counts in rows that turn rotary axes without TCP, NaN in the others; empty where there are
        none.

        A control that counts the slides alone is left to the kernel.
        """
        path = self._run.state.feed_path.part(first, end)
        counted = ~tcp & (path != FeedPath.SLIDES)
        if not counted.any():
            return np.zeros(0)
        steps = np.diff(positions.joints[:, self._rotary], axis=0)
        rows = np.flatnonzero(counted & (np.abs(steps).max(axis=1) > NO_ROTATION))
        lengths, joints = np.full(end - first, np.nan), positions.joints
        lengths[rows] = feed_path_lengths(self._run.machine, joints[rows], joints[rows + 1], path[rows])
        return lengths


def arc_lengths(run: Run) -> Floats:
    """Length of each circle of a run, mm."""
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


@kernel(writes="feeds")
def fill_feeds(
    first: int,
    joints: Floats2,
    tip: Floats2,
    kind: Codes,
    tcp: Flags,
    feed: Floats,
    feed_mode: Codes,
    rpm: Floats,
    feed_lengths: Floats,
    rotary: Flags,
    arc_row: Ints,
    arc_length: Floats,
    feeds: Floats2,
) -> None:
    """Fill ``feeds`` (4, k) for k rows from row ``first`` on; ``joints`` and ``tip`` have the row before them too."""
    arc = 0
    while arc < arc_row.shape[0] and arc_row[arc] < first:
        arc += 1
    for at in range(kind.shape[0]):
        row = first + at
        while arc < arc_row.shape[0] and arc_row[arc] < row:
            arc += 1
        on_arc = arc < arc_row.shape[0] and arc_row[arc] == row
        slides, turned = _ways(joints, at, rotary)
        travel = arc_length[arc] if on_arc else _tip_travel(tip, at)
        length, counts = (travel, 0.0) if tcp[at] or on_arc else (slides, 1.0)
        if feed_lengths.shape[0] and not on_arc and feed_lengths[at] == feed_lengths[at]:
            length = feed_lengths[at]
        if length < 1e-9:
            length, counts = turned, 2.0
        rate = math.inf
        if kind[at] != 0:
            rate = _rate(feed[at], feed_mode[at], rpm[at], length)
        feeds[0, at], feeds[1, at], feeds[2, at], feeds[3, at] = length, rate, travel, counts


@inlined
def _ways(joints: Floats, at: int, rotary: Flags) -> tuple[float, float]:
    """How far the slides go, mm, and the rotary axis that turns farthest, degrees."""
    squares, turned = 0.0, 0.0
    for k in range(5):
        moved = abs(joints[at + 1, k] - joints[at, k])
        if rotary[k]:
            turned = max(turned, moved)
        else:
            squares += moved * moved
    return math.sqrt(squares), turned


@inlined
def _tip_travel(tip: Floats, at: int) -> float:
    """Straight distance of the tip in a row, mm."""
    dx, dy, dz = tip[at + 1, 0] - tip[at, 0], tip[at + 1, 1] - tip[at, 1], tip[at + 1, 2] - tip[at, 2]
    return math.sqrt(dx * dx + dy * dy + dz * dz)


@inlined
def _rate(feed: float, mode: int, rpm: float, length: float) -> float:
    """Speed along a length, per minute; infinite without a feed."""
    rate = feed
    if mode == 95:
        rate = feed * rpm
    elif mode == 93:
        rate = feed * length
    return rate if rate > 0.0 else math.inf
