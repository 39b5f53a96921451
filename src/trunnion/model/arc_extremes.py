"""How far arcs reach between their ends: the extreme values that slides, and coordinates of the tip, have on them.

In:     arcs and helices with the positions at their starts and ends.
Out:    for each arc the least and the greatest value of each quantity between its ends, and without them: +inf and -inf
        where it has its extremes at the ends.
Units:  mm and degrees.

While the rotary axes stand, slides are linear in the tip, so a slide's value on a helix is a cosine of the angle, whose
amplitude changes as the radius does, and a slope. Its derivative is zero where another cosine has the value of the
slope. Where rotary axes turn along an arc, their angles move linearly, and the extremes are searched among samples.
"""

from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.machines import KinematicParameters, Machine, kinematic_parameters
from trunnion.model.arcs import CLOSED_ARC
from trunnion.model.axis_positions import joints_from_rows
from trunnion.model.run import CHUNK_ROWS, PositionChunk, Run
from trunnion.model.subdivision import arc_frames, circle_points
from trunnion.model.toolpath import Arcs, From, Operation
from trunnion.records import dataclass

#: Extremes as near to an end are those of the end, radians.
_AT_END: Final = 1e-9

#: Rotary axes that turn by less along an arc stand, degrees.
_STANDS: Final = 1e-9

#: Samples for each turn of an arc or of a rotary axis, and at most of one arc; and how many are made at a time.
_PER_TURN: Final = 48
_MOST_SAMPLES: Final = 100_000
_AT_A_TIME: Final = 65_536

#: Around each sample above its neighbours it is searched again with eight times as narrow ones: four times make the
#: angle exact to 2e-5.
_FINER: Final = np.linspace(-1.0, 1.0, 17)
_NARROWER: Final = (len(_FINER) - 1) // 2
_ROUNDS: Final = 4


@dataclass(frozen=True, slots=True, eq=False)
class ArcPaths:
    """m arcs from ``start`` to ``end``, (m, 3) mm; the other columns as in ``Arcs``."""

    start: Floats
    end: Floats
    centre: Floats
    normal: Floats
    full_turns: Ints

    @staticmethod
    def of(arcs: Arcs, which: slice | Ints, start: Floats, end: Floats) -> "ArcPaths":
        """Return some arcs of ``arcs``, with their starts and ends."""
        return ArcPaths(start, end, arcs.centre[which], arcs.normal[which], arcs.full_turns[which])

    def __len__(self) -> int:
        return len(self.start)

    def select(self, which: slice | Ints) -> "ArcPaths":
        """Return some of them."""
        return ArcPaths(
            self.start[which], self.end[which], self.centre[which], self.normal[which], self.full_turns[which]
        )


@dataclass(frozen=True, slots=True, eq=False)
class Reach:
    """Least and greatest values between the ends of m arcs, (m, k) each."""

    low: Floats
    high: Floats

    @staticmethod
    def nothing(count: int, width: int) -> "Reach":
        """No extremes between the ends."""
        return Reach(np.full((count, width), np.inf), np.full((count, width), -np.inf))


def operation_arcs(operation: Operation) -> ArcPaths:
    """Return the arcs of an operation; those that end over their start but for the last digits are whole turns.

    An arc that is its first row begins at the point of FROM.
    """
    arcs, tip = operation.arcs, operation.moves.tip
    start, end = tip[np.maximum(arcs.row - 1, 0)], tip[arcs.row]
    if len(arcs.row) and arcs.row[0] == 0:
        given = [event.tip for event in operation.events if isinstance(event, From) and event.row == 0]
        start[0] = given[-1] if given else end[0]
    rise = np.einsum("ij,ij->i", end - start, arcs.normal)[:, None] * arcs.normal
    closed = np.linalg.norm(end - start - rise, axis=1) < CLOSED_ARC
    return ArcPaths.of(arcs, slice(None), start, np.where(closed[:, None], start + rise, end))


def tip_reach(paths: ArcPaths) -> Reach:
    """Extremes of X, Y and Z of the tip, (m, 3), mm, in the coordinates of the arcs."""
    reach = Reach.nothing(len(paths), 3)
    for part in _parts(len(paths)):
        found = _tip_reach(paths.select(part))
        reach.low[part], reach.high[part] = found.low, found.high
    return reach


def _tip_reach(paths: ArcPaths) -> Reach:
    frame = arc_frames(paths.start, paths.end, paths.centre, paths.normal, paths.full_turns)
    middle = paths.centre + frame.height[:, None] * paths.normal
    return _extremes(
        middle, frame.across, np.cross(paths.normal, frame.across), frame.rise[:, None] * paths.normal, frame.growth,
        frame.sweep,
    )  # fmt: skip


def axis_reach(machine: Machine, paths: ArcPaths, rotary_start: Floats, rotary_end: Floats) -> Reach:
    """Extremes of the slides, (m, 5), in the order of ``machine.axes``; rotary axes have theirs at the ends.

    paths                     in the workpiece frame
    rotary_start, rotary_end  (m, 2) float64: positions at the ends of each arc, degrees, between which they move
                              linearly, in the order of ``machine.rotary``
    """
    reach = Reach.nothing(len(paths), 5)
    for part in _parts(len(paths)):
        found = _axis_reach(machine, paths.select(part), rotary_start[part], rotary_end[part])
        reach.low[part], reach.high[part] = found.low, found.high
    return reach


def _parts(count: int) -> list[slice]:
    """So many arcs at a time that what is computed of them takes little memory."""
    return [slice(first, first + CHUNK_ROWS) for first in range(0, count, CHUNK_ROWS)]


def _axis_reach(machine: Machine, paths: ArcPaths, rotary_start: Floats, rotary_end: Floats) -> Reach:
    reach = Reach.nothing(len(paths), 5)
    kinematics, columns = kinematic_parameters(machine), np.array(machine.linear)
    with np.errstate(invalid="ignore"):
        turns = np.abs(rotary_end - rotary_start).max(axis=1) > _STANDS
        standing = np.flatnonzero(~turns)
        if len(standing):
            found = _at_standing_axes(machine, kinematics, paths.select(standing), rotary_end[standing])
            rows = np.ix_(standing, columns)
            reach.low[rows], reach.high[rows] = found.low[:, columns], found.high[:, columns]
        for some in _batches(paths, turns, rotary_end - rotary_start):
            search = _Search(machine, kinematics, paths.select(some), rotary_start[some], rotary_end[some])
            for column in columns.tolist():
                reach.low[some, column] = -search.greatest(column, -1.0)
                reach.high[some, column] = search.greatest(column, 1.0)
    return reach


def run_reach(run: Run, first: int, end: int, positions: PositionChunk) -> tuple[Ints, Reach]:
    """Rows from ``first`` to the one before ``end`` that are arcs, and the reach of their slides; see ``axis_reach``.

    ``positions`` is the ``Run.chunk`` of the rows.
    """
    part = slice(*np.searchsorted(run.arcs.row, [first, end]).tolist())
    rows = run.arcs.row[part]
    at = rows - first  # the chunk begins with the row before
    paths = ArcPaths.of(run.arcs, part, positions.tip[at], positions.tip[at + 1])
    rotary = positions.joints[:, list(run.machine.rotary)]
    return rows, axis_reach(run.machine_at(first), paths, rotary[at], rotary[at + 1])


@dataclass(frozen=True, slots=True, eq=False)
class RunArcs:
    """The arcs of a run: their rows, (m,), and the reach of tip, workpiece frame, and axes between their ends."""

    rows: Ints
    tip: Reach
    axes: Reach

    @staticmethod
    def of(run: Run) -> "RunArcs":
        """All arcs of a run."""
        rows = run.arcs.row
        start, end = run.positions(rows - 1), run.positions(rows)
        paths, columns = ArcPaths.of(run.arcs, slice(None), start.tip, end.tip), list(run.machine.rotary)
        axes = axis_reach(run.machine, paths, start.joints[:, columns], end.joints[:, columns])
        return RunArcs(rows, tip_reach(paths), axes)


def _at_standing_axes(machine: Machine, kinematics: KinematicParameters, paths: ArcPaths, rotary: Floats) -> Reach:
    """Return the reach of all axes while the rotary axes stand at ``rotary`` (m, 2)."""
    frame = arc_frames(paths.start, paths.end, paths.centre, paths.normal, paths.full_turns)
    middle = paths.centre + frame.height[:, None] * paths.normal
    ahead = np.cross(paths.normal, frame.across)
    tips = np.concatenate(
        (middle, middle + frame.across, middle + ahead, middle + frame.rise[:, None] * paths.normal)
    )  # fmt: skip
    every = np.ones(len(tips), np.bool_)
    joints = joints_from_rows(machine, kinematics, every, tips, np.tile(rotary, (4, 1))).reshape(4, -1, 5)
    cosine, sine, slope = joints[1:] - joints[0]
    return _extremes(joints[0], cosine, sine, slope, frame.growth, frame.sweep)


def _extremes(middle: Floats, cosine: Floats, sine: Floats, slope: Floats, growth: Floats, sweep: Floats) -> Reach:
    """Extremes of ``middle + size (cosine cos a + sine sin a) + slope a / sweep`` for angles a within the sweep.

    The size goes from 1 at the start to ``growth`` (m,) at the end; the other columns are (m, k).
    """
    sweep = np.maximum(sweep, _AT_END)[:, None]
    change, drift = (growth[:, None] - 1.0) / sweep, slope / sweep
    # The derivative with the size at the start: level (cos (a - phase)) + drift, on its way down at maxima.
    along, across = sine + change * cosine, change * sine - cosine
    level, phase = np.hypot(along, across), np.arctan2(across, along)
    has_any = level > np.abs(drift)
    away = np.arccos(np.where(has_any, -drift / np.where(has_any, level, 1.0), 0.0))
    reach = Reach.nothing(*middle.shape)
    for begin, values, keep in ((phase + away, reach.high, np.maximum), (phase - away, reach.low, np.minimum)):
        earliest = np.mod(begin, 2.0 * np.pi)
        # Of several turns the outermost extremes are in the first or in the last.
        for angle in (earliest, earliest + 2.0 * np.pi * np.floor((sweep - earliest) / (2.0 * np.pi))):
            inside = has_any & (angle > _AT_END) & (angle < sweep - _AT_END)
            size = 1.0 + change * angle
            there = middle + size * (cosine * np.cos(angle) + sine * np.sin(angle)) + drift * angle
            keep(values, there, out=values, where=inside)
    return reach


def _batches(paths: ArcPaths, turns: Flags, ways: Floats) -> list[Ints]:
    """Return the arcs along which rotary axes turn, so many at a time that their samples are few."""
    which = np.flatnonzero(turns)
    if not len(which):
        return []
    counts = np.cumsum(_sample_counts(paths.select(which), ways[which]))
    return np.split(which, np.flatnonzero(np.diff(counts // _AT_A_TIME)) + 1)


def _sample_counts(paths: ArcPaths, ways: Floats) -> Ints:
    """Pieces between samples of each arc, (m,); ``ways`` (m, 2) degrees."""
    turns = paths.full_turns + 1.0 + np.ceil(np.nan_to_num(np.abs(ways)).max(axis=1) / 360.0)
    return np.asarray(np.minimum(_PER_TURN * turns, _MOST_SAMPLES), np.int64)


class _Search:
    """Searches the extremes of slides on arcs along which rotary axes turn."""

    def __init__(
        self, machine: Machine, kinematics: KinematicParameters, paths: ArcPaths, begin: Floats, end: Floats
    ) -> None:
        self._machine, self._kinematics, self._paths = machine, kinematics, paths
        self._begin, self._way = begin, end - begin
        counts = _sample_counts(paths, self._way)
        self._firsts = np.cumsum(counts + 1) - counts - 1
        self._step = 1.0 / counts
        arc = np.repeat(np.arange(len(counts)), counts + 1)
        self._shares = (np.arange(len(arc)) - self._firsts[arc]) * self._step[arc]
        self._joints, self._arc = self._joints_at(arc, self._shares), arc

    def _joints_at(self, arc: Ints, share: Floats) -> Floats:
        """(k, 5): axis values at shares of arcs; NaN where there are none."""
        paths = self._paths
        tips = circle_points(
            paths.start[arc], paths.end[arc], paths.centre[arc], paths.normal[arc], paths.full_turns[arc], share
        )
        rotary = self._begin[arc] + share[:, None] * self._way[arc]
        return joints_from_rows(self._machine, self._kinematics, np.ones(len(arc), np.bool_), tips, rotary)

    def greatest(self, column: int, sign: float) -> Floats:
        """(m,): the greatest value of an axis times ``sign``; -inf if it has none."""
        values = _numbers(sign * self._joints[:, column])
        # Two samples of a turn may be higher than those beside them, and the lower one belong to the higher peak.
        before, after = np.append(-np.inf, values[:-1]), np.append(values[1:], -np.inf)
        before[self._firsts], after[self._firsts[1:] - 1] = -np.inf, -np.inf
        peaks = np.flatnonzero((values >= before) & (values >= after))
        arc, at, best = self._arc[peaks], self._shares[peaks], values[peaks]
        margin = self._margins(values, before, after)
        for k in range(_ROUNDS):
            # Helices have a peak each turn: only those that may still be the highest are searched.
            highest = np.full(len(self._firsts), -np.inf)
            np.maximum.at(highest, arc, best)
            high = best >= (highest - margin / _NARROWER ** (2 * k))[arc]
            arc, at = arc[high], at[high]
            width, every = self._step[arc] / _NARROWER**k, np.repeat(arc, len(_FINER))
            shares = np.clip(at[:, None] + width[:, None] * _FINER, 0.0, 1.0)
            found = _numbers(sign * self._joints_at(every, shares.ravel())[:, column]).reshape(shares.shape)
            which = np.argmax(found, axis=1)[:, None]
            at, best = (np.take_along_axis(each, which, axis=1)[:, 0] for each in (shares, found))
        greatest = np.full(len(self._firsts), -np.inf)
        np.maximum.at(greatest, arc, best)
        return greatest

    def _margins(self, values: Floats, before: Floats, after: Floats) -> Floats:
        """(m,): how far the highest sample beside a peak may be below it, inf if samples are missing.

        A parabola rises above its samples by an eighth of their second difference at most; this is eight times that.
        """
        with np.errstate(invalid="ignore"):
            bend = np.abs(before - 2.0 * values + after)
        ends = np.append(self._firsts[1:], len(values)) - 1
        bend[self._firsts] = bend[ends] = 0.0
        return np.maximum.reduceat(np.where(np.isfinite(bend), bend, np.inf), self._firsts)


def _numbers(values: Floats) -> Floats:
    return np.where(np.isnan(values), -np.inf, values)
