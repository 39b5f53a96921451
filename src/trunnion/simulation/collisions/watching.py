"""Follows two bodies through a run, and notes where they touch or are near each other."""

import math
from collections.abc import Sequence
from typing import Final

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.machines import Machine, link_transforms
from trunnion.machines.links import WORKPIECE, link_chain
from trunnion.records import dataclass
from trunnion.simulation.collisions.bodies import Body
from trunnion.simulation.collisions.clearance import joint_senses, motion_bounds, relative_pose, turns_about_itself
from trunnion.simulation.collisions.pairs import stands_on_work_offset
from trunnion.simulation.collisions.queries import PairQuery, Solid
from trunnion.simulation.finding import Finding, What
from trunnion.timing import AxisPieces

#: More stretches of one pair are not told one by one: the last one goes on to the end.
MOST_FINDINGS: Final = 200

#: While two bodies touch they are looked at once a piece, or after so many steps if it is longer.
_TOUCHING_STEPS: Final = 8

#: How fast two bodies may get deeper into each other: both what is told of one and of the other grow with their way.
_DEEPENING: Final = 2.0

#: What is deeper by less is as deep, mm: the first of such poses is told.
_SAME_DEPTH: Final = 1e-4

#: Depths that are asked for in short steps in one stretch, the fewest and the most; and tests that they may cost.
_FINE: Final = (16, 256)
_MOST_TESTS: Final = 50_000_000

#: Halvings of the way between two looks in which the deepest pose of it is sought.
_HALVINGS: Final = 10


@dataclass(slots=True)
class _Sample:
    """A pose of a pair: where in the run, the way until then, the axes, and how far apart the surfaces are."""

    row: int
    fraction: float
    way: float
    joints: Floats
    distance: float = 0.0


class _Path:
    """Consecutive pieces, by the way that bodies can have moved against each other at most.

    ``begin`` is that way where they begin, and ``end`` where they end.
    """

    def __init__(self, pieces: AxisPieces, first: int, end: int, bounds: Floats, begin: float) -> None:
        self._pieces, self._first = pieces, first
        self._joints = pieces.joints[first : end + 1]
        self._moved = begin + np.concatenate(([0.0], np.cumsum(bounds)))
        row = pieces.row[first:end]
        self._row_ends = self._moved[1:][np.append(row[1:] != row[:-1], True)]
        self.begin, self.end = begin, float(self._moved[-1])

    def sample(self, way: float) -> tuple[_Sample, float]:
        """Return the pose after a way, and how long the piece is."""
        k = max(int(np.searchsorted(self._moved, way)) - 1, 0)
        span = float(self._moved[k + 1] - self._moved[k])
        share = (way - float(self._moved[k])) / span if span > 0.0 else 0.0
        piece = self._first + k
        done = float(self._pieces.begin[piece])
        done += share * (float(self._pieces.done[piece]) - done)
        axes = self._joints[k] + share * (self._joints[k + 1] - self._joints[k])
        return _Sample(int(self._pieces.row[piece]), done, way, axes), span

    def next_look(self, least: float, most: float) -> float:
        """Return the end of the first row that ends between two ways; ``most`` where none does."""
        k = int(np.searchsorted(self._row_ends, least, side="right"))
        return min(float(self._row_ends[k]), most) if k < len(self._row_ends) else most


class _Stretch:
    """Rows in which two bodies touch or are near each other, while it lasts.

    fine     looks at depths or distances before their steps become twice as long
    worst    where it is deepest, so far; None until they touch
    before   the way at a pose before the worst that is not as deep
    measured where the depth was asked for last, and ``depth`` was found
    """

    def __init__(self, first: _Sample, before: float, fine: int) -> None:
        self.first = self.last = self.nearest = first
        self.worst: _Sample | None = None
        self.deepest, self.place = 0.0, np.zeros(3)
        self.measured, self.depth = first, 0.0
        self.before = before
        self._fine, self._count = fine, 0

    @property
    def scale(self) -> float:
        """How much longer the steps have become."""
        return float(2 ** min(self._count // self._fine, 60))

    def add(self, sample: _Sample, before: float, *, touches: bool) -> None:
        """Take in a pose; ``before`` is the way at the one before it."""
        self.last = sample
        if touches and self.worst is None:
            self.first, self.before = sample, before
        if not touches:
            self._count += 1
            if sample.distance < self.nearest.distance:
                self.nearest = sample

    def cannot_deepen(self, way: float) -> float:
        """How far the bodies move from ``way`` before they can be deeper in each other than they were."""
        return (self.deepest - self.depth) / _DEEPENING - (way - self.measured.way)

    def measure(self, sample: _Sample, depth: float, place: Floats) -> None:
        """Take in how deep the bodies are in each other."""
        self._count += 1
        if self.worst is None or depth > self.deepest + _SAME_DEPTH:
            self.before = self.before if self.worst is None else self.measured.way
            self.worst, self.deepest, self.place = sample, depth, place
        self.measured, self.depth = sample, depth

    @property
    def may_peak(self) -> bool:
        """Whether the depth was asked for last where it is deepest, within a row: around it may be a deeper pose."""
        return self.measured is self.worst and 0.0 < self.measured.fraction < 1.0


class PairWatch:
    """Follows two bodies through a run.

    machine       whose links they are on
    tools         names of the tools, by their index in ``AxisPieces.tool``
    solids        those of the two bodies
    near, step    as in ``check_collisions``
    """

    def __init__(
        self,
        machine: Machine,
        tools: Sequence[str],
        bodies: tuple[Body, Body],
        solids: tuple[Solid, Solid],
        near: float,
        step: float,
    ) -> None:
        self.one, self.other = bodies
        self.machine, self.near, self.step = machine, near, step
        self._tools = tools
        self._needs_offset = stands_on_work_offset(machine, *bodies)
        self._chain = link_chain(machine)
        self._query = PairQuery(*solids)
        self._there = joint_senses(machine, self.one.link, self.other.link)
        self._bounding = [
            (*_moving_joints(machine, body, other), solid.centre, solid.radius)
            for body, other, solid in zip(bodies, bodies[::-1], solids, strict=True)
        ]
        self._pose = np.eye(4)
        corners, faces = zip(*((len(solid.mesh.vertices), len(solid.mesh.faces)) for solid in solids), strict=True)
        self._fine = int(np.clip(_MOST_TESTS // (corners[0] * faces[1] + corners[1] * faces[0]), *_FINE))
        #: The way of the bodies until now, and those between which they are looked at again.
        self._way, self._last_look, self._wanted = 0.0, 0.0, (0.0, 0.0)
        #: Nothing is known of where the bodies were before.
        self._is_new = True
        self._was_touching = False
        self._inside = False
        self._stretch: _Stretch | None = None
        self._closed: list[_Stretch] = []

    def follow(self, pieces: AxisPieces) -> None:
        """Look at the bodies wherever they may touch in the pieces that follow the last ones."""
        name = self.one.tool or self.other.tool
        if not name and not self._needs_offset:
            self._follow(pieces, 0, len(pieces.row))
            return
        present = pieces.known.copy()
        if name:
            present &= np.array([tool == name for tool in self._tools])[pieces.tool]
        if self._needs_offset:
            present &= ~pieces.at_machine
        edges = np.flatnonzero(np.diff(present.astype(np.int8), prepend=0, append=0))
        if not len(present) or not present[0]:
            self._leave()
        for begin, end in zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True):
            if begin:
                self._leave()
            self._follow(pieces, begin, end)
        if len(present) and not present[-1]:
            self._leave()

    def _leave(self) -> None:
        """Take out the tool of the pair."""
        self._close()
        self._is_new, self._was_touching, self._inside = True, False, False

    def _follow(self, pieces: AxisPieces, begin: int, end: int) -> None:
        joints = pieces.joints[begin : end + 1]
        bounds = np.zeros((2, end - begin))
        for k, (columns, senses, centre, radius) in enumerate(self._bounding):
            motion_bounds(self._chain, columns, senses, centre, radius, joints, bounds[k])
        path = _Path(pieces, begin, end, bounds.min(axis=0), self._way)
        at = self._way if self._is_new else path.next_look(*self._wanted)
        while at <= path.end:
            self._wanted = self._look(path, at)
            at = path.next_look(*self._wanted)
        self._way = path.end

    def _look(self, path: _Path, way: float) -> tuple[float, float]:
        """Look at one pose, and return the ways before which nothing can happen, and at which to look again.

        Rows that end between them want a look at their ends: where the motion turns bodies are often the deepest.
        """
        sample, span = path.sample(way)
        relative_pose(self._chain, *self._there, sample.joints, self._pose)
        if self._was_touching:
            touches = self._query.touches(self._pose)
        else:
            sample.distance = self._query.distance(self._pose)
            touches = sample.distance <= 0.0
        if not touches and (self._is_new or self._was_touching):
            # Only here can one body have got into the other as a whole: later their surfaces would meet first.
            touches = self._query.contains(self._pose)
            sample.distance = 0.0 if touches else sample.distance or self._query.distance(self._pose)
        before = -math.inf if self._is_new else self._last_look
        if self._was_touching and not touches and self._stretch is not None and self._stretch.may_peak:
            self._refine(self._stretch, path, way)
        self._is_new, self._was_touching, self._last_look = False, touches, way
        inside = touches or sample.distance < self.near
        last = None if self._stretch is None else self._stretch.last.row
        if last is not None and sample.row > last + 1 and not (inside and self._inside):
            self._close()
        if inside:
            self._stretch = self._stretch or _Stretch(sample, before, self._fine)
            self._stretch.add(sample, before, touches=touches)
        self._inside = inside
        if touches:
            assert self._stretch is not None
            least, most = self._deepen(self._stretch, path, sample, span)
        else:
            least, most = self._approach(sample.distance)
        return way + least, way + most

    def _deepen(self, stretch: _Stretch, path: _Path, sample: _Sample, span: float) -> tuple[float, float]:
        """Ask how deep touching bodies are in each other if they can be deeper than before; and how far to go on."""
        if stretch.worst is None or stretch.cannot_deepen(sample.way) <= 0.0:
            may_peak = stretch.may_peak
            stretch.measure(sample, *self._query.depth(self._pose))
            if may_peak and stretch.worst is not sample:
                self._refine(stretch, path, sample.way)
        step = self.step / 2.0
        gap = max(stretch.cannot_deepen(sample.way), 0.0)
        most = min(gap + step * stretch.scale, max(self.step, min(span, _TOUCHING_STEPS * self.step)))
        return min(gap + step * (stretch.scale - 1.0), most), most

    def _refine(self, stretch: _Stretch, path: _Path, high: float) -> None:
        """Find the deepest pose around the deepest known, until a way where they are not as deep."""
        low = stretch.before
        for _ in range(_HALVINGS if low >= path.begin and stretch.scale == 1.0 else 0):
            assert stretch.worst is not None
            middle = stretch.worst.way
            way = (low + middle) / 2.0 if middle - low > high - middle else (middle + high) / 2.0
            sample = path.sample(way)[0]
            relative_pose(self._chain, *self._there, sample.joints, self._pose)
            depth, place = self._query.depth(self._pose)
            if depth > stretch.deepest + _SAME_DEPTH:
                low, high = (middle, high) if way > middle else (low, middle)
                stretch.worst, stretch.deepest, stretch.place = sample, depth, place
            else:
                low, high = (low, way) if way > middle else (way, high)

    def _approach(self, distance: float) -> tuple[float, float]:
        """How far bodies that do not touch may go on."""
        if distance >= self.near:
            return distance - self.near, max(self.step, distance - self.near)
        assert self._stretch is not None
        most = max(self.step, distance / 2.0)
        least = self.step / 2.0 * (self._stretch.scale - 1.0)
        if self._stretch.worst is None:
            least += distance - self._stretch.nearest.distance
        return min(least, distance, most), most

    def _close(self) -> None:
        if self._stretch is not None and len(self._closed) < MOST_FINDINGS:
            self._closed.append(self._stretch)
            self._stretch = None

    def findings(self) -> list[Finding]:
        """Return what was found, once all pieces have been followed."""
        stretches = self._closed + ([] if self._stretch is None else [self._stretch])
        return [self._finding(stretch) for stretch in stretches]

    def _finding(self, stretch: _Stretch) -> Finding:
        depth, worst, place = stretch.deepest, stretch.worst, stretch.place
        if worst is None:
            worst = stretch.nearest
            relative_pose(self._chain, *self._there, worst.joints, self._pose)
            place = self._query.nearest(self._pose)
        is_near = stretch.worst is None and worst.distance > 0.0
        return Finding(
            What.NEAR if is_near else What.BODY,
            between=(self.one.name, self.other.name),
            rows=(stretch.first.row, stretch.last.row),
            worst=worst.row,
            depth=worst.distance if is_near else depth,
            place=_in_workpiece(self.machine, self.other.link, worst.joints, place),
            fraction=worst.fraction,
            begin=stretch.first.fraction,
        )


def _moving_joints(machine: Machine, body: Body, other: Body) -> tuple[Ints, Floats]:
    """Return the joints that move a body against another, and their senses; without one that turns it about its own
    axis.
    """
    columns, senses = joint_senses(machine, body.link, other.link)
    first = 1 if turns_about_itself(machine, int(columns[0]), body.line) else 0
    return columns[first:], senses[first:]


def _in_workpiece(machine: Machine, link: str, joints: Floats, point: Floats) -> tuple[float, float, float]:
    """Return a point in the frame of a link, in workpiece coordinates."""
    links = link_transforms(machine, joints[None])
    seen = np.linalg.inv(links[WORKPIECE][0]) @ links[link][0] @ np.append(point, 1.0)
    x, y, z = (seen[:3] - np.array(machine.workpiece_zero or (0.0, 0.0, 0.0), np.float64)).tolist()
    return x, y, z
