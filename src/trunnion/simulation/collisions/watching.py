"""Follows two bodies through a run, and notes where they touch or are near each other."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.machines import Machine, link_transforms
from trunnion.machines.links import WORKPIECE, link_chain
from trunnion.simulation.collisions.bodies import Body
from trunnion.simulation.collisions.clearance import joint_senses, motion_bounds, relative_pose, turns_about_itself
from trunnion.simulation.collisions.findings import Collision
from trunnion.simulation.collisions.motion import AxisPieces
from trunnion.simulation.collisions.queries import PairQuery, Solid

#: More stretches of one pair are not told one by one: the last one goes on to the end.
MOST_FINDINGS: Final = 200

#: Poses of a stretch that are kept, to find the worst among them.
_KEPT: Final = 16

#: While two bodies touch they are looked at once a piece, or after so many steps if it is longer.
_TOUCHING_STEPS: Final = 8


@dataclass(slots=True)
class _Sample:
    """A pose of a pair: where in the run, the axes, and how far apart the surfaces are."""

    row: int
    fraction: float
    joints: Floats
    distance: float


class _Stretch:
    """Rows in which two bodies touch or are near each other, while it lasts."""

    def __init__(self, first: _Sample) -> None:
        self.first = self.last = self.nearest = first
        self.touching: list[_Sample] = []
        self._stride, self._skipped = 1, 0

    def add(self, sample: _Sample, *, touches: bool) -> None:
        """Take in a pose."""
        self.last = sample
        if sample.distance < self.nearest.distance:
            self.nearest = sample
        if not touches:
            return
        if not self.touching:
            self.first = sample
        self._skipped += 1
        if self._skipped >= self._stride:
            self._skipped = 0
            self.touching.append(sample)
            if len(self.touching) > _KEPT:
                del self.touching[1::2]
                self._stride *= 2


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
        self._chain = link_chain(machine)
        self._query = PairQuery(*solids)
        self._there = joint_senses(machine, self.one.link, self.other.link)
        self._bounding = [
            (*_moving_joints(machine, body, other), solid.centre, solid.radius)
            for body, other, solid in zip(bodies, bodies[::-1], solids, strict=True)
        ]
        self._pose = np.eye(4)
        #: How far the bodies may still move until they are looked at again; None: their pose is new.
        self._allowance: float | None = None
        self._was_touching = False
        self._inside = False
        self._stretch: _Stretch | None = None
        self._closed: list[_Stretch] = []

    def follow(self, pieces: AxisPieces) -> None:
        """Look at the bodies wherever they may touch in the pieces that follow the last ones."""
        name = self.one.tool or self.other.tool
        if not name:
            self._follow(pieces, 0, len(pieces.row))
            return
        present = pieces.known & np.array([tool == name for tool in self._tools])[pieces.tool]
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
        """The tool of the pair is taken out."""
        self._close()
        self._allowance, self._was_touching, self._inside = None, False, False

    def _follow(self, pieces: AxisPieces, begin: int, end: int) -> None:
        joints = pieces.joints[begin : end + 1]
        bounds = np.zeros((2, end - begin))
        for k, (columns, senses, centre, radius) in enumerate(self._bounding):
            motion_bounds(self._chain, columns, senses, centre, radius, joints, bounds[k])
        moved = np.concatenate(([0.0], np.cumsum(bounds.min(axis=0))))
        at = 0.0 if self._allowance is None else self._allowance
        while at <= moved[-1]:
            k = max(int(np.searchsorted(moved, at)) - 1, 0)
            span = float(moved[k + 1] - moved[k])
            share = (at - float(moved[k])) / span if span > 0.0 else 0.0
            row, done = int(pieces.row[begin + k]), float(pieces.begin[begin + k])
            done += share * (float(pieces.done[begin + k]) - done)
            axes = joints[k] + share * (joints[k + 1] - joints[k])
            at += self._look(_Sample(row, done, axes, 0.0), span)
        self._allowance = at - float(moved[-1])

    def _look(self, sample: _Sample, span: float) -> float:
        """Look at one pose, and return how far the bodies may move until the next look."""
        relative_pose(self._chain, *self._there, sample.joints, self._pose)
        if self._was_touching:
            touches = self._query.touches(self._pose)
        else:
            sample.distance = self._query.distance(self._pose)
            touches = sample.distance <= 0.0
        if not touches and (self._allowance is None or self._was_touching):
            # Only here can one body have got into the other as a whole: later their surfaces would meet first.
            touches = self._query.contains(self._pose)
            sample.distance = 0.0 if touches else sample.distance or self._query.distance(self._pose)
        self._allowance = 0.0
        self._was_touching = touches
        inside = touches or sample.distance < self.near
        last = None if self._stretch is None else self._stretch.last.row
        if last is not None and sample.row > last + 1 and not (inside and self._inside):
            self._close()
        if inside:
            self._stretch = self._stretch or _Stretch(sample)
            self._stretch.add(sample, touches=touches)
        self._inside = inside
        if touches:
            return max(self.step, min(span, _TOUCHING_STEPS * self.step))
        if sample.distance < self.near:
            return max(self.step, sample.distance / 2.0)
        return max(self.step, sample.distance - self.near)

    def _close(self) -> None:
        if self._stretch is not None and len(self._closed) < MOST_FINDINGS:
            self._closed.append(self._stretch)
            self._stretch = None

    def findings(self) -> list[Collision]:
        """Return what was found, once all pieces have been followed."""
        stretches = self._closed + ([] if self._stretch is None else [self._stretch])
        return [self._finding(stretch) for stretch in stretches]

    def _finding(self, stretch: _Stretch) -> Collision:
        depth, worst, place = 0.0, stretch.nearest, None
        for sample in stretch.touching:
            relative_pose(self._chain, *self._there, sample.joints, self._pose)
            deep, at = self._query.depth(self._pose)
            if place is None or deep > depth:
                depth, worst, place = deep, sample, at
        if place is None:
            relative_pose(self._chain, *self._there, worst.joints, self._pose)
            place = self._query.nearest(self._pose)
        return Collision(
            between=(self.one.name, self.other.name),
            row=stretch.first.row,
            fraction=stretch.first.fraction,
            last_row=stretch.last.row,
            worst_row=worst.row,
            worst_fraction=worst.fraction,
            depth_mm=depth,
            distance_mm=0.0 if stretch.touching else worst.distance,
            place=_in_workpiece(self.machine, self.other.link, worst.joints, place),
        )


def _moving_joints(machine: Machine, body: Body, other: Body) -> tuple[Ints, Floats]:
    """The joints that move a body against another, and their senses; without one that turns it about its own axis."""
    columns, senses = joint_senses(machine, body.link, other.link)
    first = 1 if turns_about_itself(machine, int(columns[0]), body.line) else 0
    return columns[first:], senses[first:]


def _in_workpiece(machine: Machine, link: str, joints: Floats, point: Floats) -> tuple[float, float, float]:
    """A point in the frame of a link, in workpiece coordinates."""
    links = link_transforms(machine, joints[None])
    seen = np.linalg.inv(links[WORKPIECE][0]) @ links[link][0] @ np.append(point, 1.0)
    x, y, z = (seen[:3] - np.array(machine.workpiece_zero or (0.0, 0.0, 0.0))).tolist()
    return x, y, z
