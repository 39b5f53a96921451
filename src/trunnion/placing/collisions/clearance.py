"""The least distance of pairs of bodies over a path, at one place of the zero."""

from collections.abc import Iterator, Sequence
from functools import cached_property
from typing import Final

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.machines import Machine
from trunnion.machines.links import link_chain
from trunnion.placing.collisions.guarded_pairs import Guarded, GuardedPair, piece_pairs
from trunnion.placing.collisions.nearest_moment import Course, course_pose, nearest_moment
from trunnion.placing.collisions.path_samples import PathSamples
from trunnion.placing.collisions.surfaces import SurfaceGap, SurfacePair
from trunnion.records import dataclass
from trunnion.simulation.collisions.clearance import joint_senses, motion_bounds
from trunnion.simulation.collisions.hull_pieces import HullPiece
from trunnion.simulation.collisions.hull_points import HullPoints, hull_points

#: Bodies with pieces that are not exact are followed in steps of as much, mm.
_STEP: Final = 0.05

#: No bodies are as far apart, mm.
ENOUGH: Final = 1e5

_UP: Final = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True, slots=True, eq=False)
class Nearest:
    """Where two bodies are nearest to each other.

    distance       mm, times the weight of the pair; 0: they touch
    moment, share  of ``PathSamples``: on the way to it
    one, other     points whose hulls are as far apart there, and no nearer to each other than the bodies at any
                   other zero, in the frames of the bodies
    inside         how deep a point of one body is in the other there, mm, where hulls do not show that they touch
    """

    pair: GuardedPair
    distance: float
    moment: int
    share: float
    one: HullPoints
    other: HullPoints
    inside: float = 0.0


@dataclass(slots=True, eq=False)
class _Pieces:
    """Two pieces that are followed, with the last direction between them and what asks their surfaces."""

    pair: GuardedPair
    one: HullPiece
    other: HullPiece
    direction: Floats
    surfaces: SurfacePair | None


class Clearance:
    """Asks how far pairs of bodies are apart over a path.

    machine  without a workpiece zero
    turn     (3, 3): the part is turned by it
    near     (3,) a place of the zero near which most questions are asked
    """

    def __init__(
        self, machine: Machine, moments: PathSamples, pairs: Sequence[GuardedPair], turn: Floats, near: Floats
    ) -> None:
        self.machine, self.moments, self.turn, self.near = machine, moments, turn, near
        self._chain = link_chain(machine)
        self._courses: dict[tuple[int, str, bool], Course] = {}
        self._ranges: dict[int, Ints] = {}
        self._pieces = [
            _Pieces(pair, one, other, _UP.copy(), None if one.exact and other.exact else SurfacePair(one, other))
            for pair in pairs
            for one, other in piece_pairs(pair)
        ]

    def nearest(self, zero: Floats, limit: float = ENOUGH) -> Nearest | None:
        """Which bodies are nearest to each other with the zero (3,) there, and where; None: no nearer than a limit, mm.

        The distance is the least but for ``CLOSE``, and ``_STEP`` where pieces are not exact.
        """
        found: Nearest | None = None
        # What was nearest last time comes first: then most others need no look.
        for k, pieces in enumerate(self._pieces):
            own = self._follow(pieces, zero, limit if found is None else found.distance)
            if own is not None:
                found = own
                if k:
                    self._pieces.insert(0, self._pieces.pop(k))
            if found is not None and found.distance <= 0.0:
                break
        return found

    def pose(self, pair: GuardedPair, zero: Floats, moment: int, share: float) -> Floats:
        """Return the map (4, 4) from the frame of the first body of a pair to that of the second."""
        pose = np.eye(4)
        course_pose(self._chain, self._course(pair), zero, moment, share, pose)
        return pose

    def _follow(self, pieces: _Pieces, zero: Floats, limit: float) -> Nearest | None:
        course, pair, found = self._course(pieces.pair), pieces.pair, None
        limit /= pair.weight
        away = float(np.linalg.norm(zero - self.near))
        for ranges in self._of_tool(pair.tool):
            if pieces.surfaces is None:
                low, moment, share = nearest_moment(
                    self._chain, course, pieces.one.hull, pieces.other.hull, zero, away, ranges, limit, True,
                    pieces.direction,
                )  # fmt: skip
                if moment >= 0:
                    limit = low
                    found = Nearest(pair, low * pair.weight, moment, share, pieces.one.hull, pieces.other.hull)
            else:
                found = self._follow_surfaces(pieces, course, zero, away, ranges, limit) or found
                limit = limit if found is None else found.distance / pair.weight
        return found

    def _follow_surfaces(
        self, pieces: _Pieces, course: Course, zero: Floats, away: float, ranges: Ints, limit: float
    ) -> Nearest | None:
        """Follow pieces that are not exact: hulls say where a look at their surfaces is needed."""
        assert pieces.surfaces is not None
        found: Nearest | None = None
        moment, end = ranges.tolist()
        way = course.way + away * course.drift
        while moment < end:
            _, at, share = nearest_moment(
                self._chain, course, pieces.one.hull, pieces.other.hull, zero, away, np.array([moment, end]),
                limit, False, pieces.direction,
            )  # fmt: skip
            if at < 0:
                break
            moment = at if share >= 1.0 else at - 1
            gap = self._surface_gap(pieces, zero, moment, 1.0)
            if gap.distance < limit:
                limit, found = gap.distance, self._nearest(pieces, gap, moment, 1.0)
            room = gap.distance - limit + _STEP
            after = int(np.searchsorted(way, way[moment] + room))
            if after - 1 > moment:
                moment = after - 1
                continue
            moment += 1
            if moment < end and not course.begins[moment]:
                for own in self._halve(pieces, zero, moment, float(way[moment] - way[moment - 1]), limit):
                    limit, found = own.distance / own.pair.weight, own
            if limit <= 0.0:
                break
        return found

    def _halve(self, pieces: _Pieces, zero: Floats, moment: int, size: float, limit: float) -> Iterator[Nearest]:
        """Look at parts of the way to a moment, halved where they are not settled; yields what is ever nearer."""
        parts = [(0.0, 1.0)]
        while parts and limit > 0.0:
            begin, end = parts.pop()
            middle, half = (begin + end) / 2.0, 0.5 * size * (end - begin)
            gap = self._surface_gap(pieces, zero, moment, middle)
            if gap.distance < limit:
                limit = gap.distance
                yield self._nearest(pieces, gap, moment, middle)
            if gap.distance - half < limit - _STEP and half > 0.5 * _STEP:
                parts += [(middle, end), (begin, middle)]

    def _surface_gap(self, pieces: _Pieces, zero: Floats, moment: int, share: float) -> SurfaceGap:
        assert pieces.surfaces is not None
        return pieces.surfaces.gap(self.pose(pieces.pair, zero, moment, share))

    def _nearest(self, pieces: _Pieces, gap: SurfaceGap, moment: int, share: float) -> Nearest:
        return Nearest(
            pieces.pair, gap.distance * pieces.pair.weight, moment, share, hull_points(gap.one), hull_points(gap.other)
        )

    def inside(self, zero: Floats) -> Nearest | None:
        """Return a body that is inside of another one, whose surfaces never meet, at the zero (3,); None: there is
        none.

        Since bodies move without jumps, the first moment of each stretch shows it.
        """
        for pair in self._hollow:
            for first, end in self._of_tool(pair.tool).tolist():
                begins = first + np.flatnonzero(self.moments.begins[first:end])
                for moment in {first, *begins.tolist()}:
                    pose = self.pose(pair, zero, moment, 1.0)
                    deep = SurfacePair.depth_inside(pair.one.body.mesh, pair.other.body.mesh, pose)
                    if deep is not None:
                        one, other, depth = deep
                        return Nearest(pair, 0.0, moment, 1.0, hull_points(one), hull_points(other), depth)
        return None

    @cached_property
    def _hollow(self) -> list[GuardedPair]:
        """Pairs of which one has pieces that are not all there is of it."""
        return list(
            dict.fromkeys(
                each.pair for each in self._pieces if _is_hollow(each.pair.one) or _is_hollow(each.pair.other)
            )
        )

    def _of_tool(self, tool: int) -> Ints:
        if tool not in self._ranges:
            every = np.array([[0, len(self.moments)]])
            self._ranges[tool] = every if tool < 0 else self.moments.ranges(tool)
        return self._ranges[tool]

    def _course(self, pair: GuardedPair) -> Course:
        key = (id(pair.one), pair.other.body.link if not pair.other.carried else "", pair.other.carried)
        if key not in self._courses:
            self._courses[key] = _course(self.machine, self.moments, pair, self.turn, self.near)
        return self._courses[key]


def _is_hollow(guarded: Guarded) -> bool:
    """Whether pieces are only the surface of a body."""
    return any(piece.hollow for piece in guarded.pieces)


def _course(machine: Machine, moments: PathSamples, pair: GuardedPair, turn: Floats, near: Floats) -> Course:
    """How the first body of a pair moves in the frame of the second, with bounds for zeros around ``near``."""
    chain, body, other = link_chain(machine), pair.one.body, pair.other.body
    columns, senses = joint_senses(machine, body.link, other.link)
    joints = np.empty((len(moments), 5))
    joints[:, list(machine.rotary)] = moments.angles
    joints[:, list(machine.linear)] = moments.normals @ near + moments.offsets
    bounds = np.zeros(max(len(moments) - 1, 0))
    centre = body.mesh.bounds.mean(axis=0)
    radius = float(np.linalg.norm(body.mesh.vertices - centre, axis=1).max())
    motion_bounds(chain, columns, senses, centre, radius, joints, bounds)
    return Course(
        moments.angles, moments.normals, moments.offsets, moments.begins,
        moments.turn, np.concatenate(([0.0], np.cumsum(bounds))), moments.drift, columns, senses,
        np.array([*machine.rotary, *machine.linear], np.int64), np.ascontiguousarray(turn.T), pair.other.carried,
    )  # fmt: skip
