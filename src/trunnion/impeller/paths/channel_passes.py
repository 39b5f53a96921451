"""Passes along two blades on one layer of a channel.

In:     a ``Layer``, and how far neighbouring passes may be apart on it.
Out:    passes from the lower to the higher angle, every other one backwards; all begin and end off the stock.
Units:  mm.

A channel is many times as wide at its outlet as at its throat. Passes follow both blades at even distances: at a place
where the way across is n steps wide, pass number k is at the share k / n from the nearer blade. Where n is less than
2 k it would be beyond the middle: there it has not begun yet. Two passes that begin in the middle are one that comes in
from the open end, turns in the middle, and leaves again.
"""

import math
import sys
from collections.abc import Iterator
from itertools import zip_longest
from typing import Final

import numpy as np

from trunnion.arrays import Codes, Floats, Floats2
from trunnion.impeller.paths.channel import turned
from trunnion.impeller.paths.channel_layers import Layer, eased
from trunnion.impeller.paths.passes import Pass, Stepover
from trunnion.jit import inner, kernel
from trunnion.records import dataclass

#: Share of the tolerance within which points are left out, and the longest chord that it may make, mm: tool axes turn
#: with the place.
_SHARE: Final = 0.3
_LONGEST: Final = 2.0


@dataclass(frozen=True, slots=True)
class _Lane:
    """A pass of one side of a layer.

    number   of steps from the blade
    is_high  the blade is that of the higher angle
    front    the node up to which it is there from the first one
    rear     the node from which it is there up to the last one; all along where both are the same
    """

    number: int
    is_high: bool
    front: float
    rear: float

    def shares(self, steps: Floats) -> Floats:
        """Shares (k,) of the way across at places that are so many steps wide."""
        share = np.minimum(self.number / np.maximum(steps, 1e-12), 0.5) if self.number else np.zeros(len(steps))
        return 1.0 - share if self.is_high else share


@dataclass(frozen=True, slots=True, eq=False)
class _Pattern:
    """Lanes of a layer; ``steps`` (n,): how many steps it is wide at its nodes."""

    steps: Floats
    lanes: list[_Lane]

    def stretch(self, lane: _Lane, start: float, end: float) -> Floats:
        """Nodes and shares (k, 2) of a lane from one node to another."""
        low, high = min(start, end), max(start, end)
        nodes = np.r_[low, np.arange(math.floor(low) + 1, math.ceil(high)), high]
        way = np.column_stack(
            (nodes, lane.shares(np.asarray(np.interp(nodes, np.arange(len(self.steps)), self.steps))))
        )
        return way if start <= end else way[::-1]

    def ways(self) -> Iterator[Floats]:
        """All passes (k, 2) as nodes and shares in the order of cutting."""
        last = len(self.steps) - 1.0
        whole = [lane for lane in self.lanes if lane.front >= lane.rear]
        yield from self._turning([lane for lane in self.lanes if 0.0 < lane.front < lane.rear], 0.0)
        low = [lane for lane in whole if not lane.is_high]
        for k, lane in enumerate(low):
            yield self.stretch(lane, 0.0, last)[:: 1 if (len(low) - k) % 2 else -1]
        yield from self._turning([lane for lane in self.lanes if lane.front < lane.rear < last], last)
        for k, lane in enumerate(lane for lane in whole if lane.is_high):
            yield self.stretch(lane, 0.0, last)[:: 1 if k % 2 else -1]

    def _turning(self, lanes: list[_Lane], end: float) -> Iterator[Floats]:
        """Yield passes that come in from an end, along one lane to the middle, and go out along the next one."""

        def tip(lane: _Lane) -> float:
            return lane.rear if end else lane.front

        for one, other in zip_longest(lanes[::2], lanes[1::2]):
            into = self.stretch(one, end, tip(one))
            if other is None:  # out along the middle
                yield np.vstack((into, np.column_stack((into[::-1, 0], np.full(len(into), 0.5)))[1:]))
                continue
            out = self.stretch(other, tip(other), end)
            turn = self.stretch(_MIDDLE, tip(one), tip(other))
            yield np.vstack((into, turn[1:-1], out))


#: The lane that is always in the middle.
_MIDDLE: Final = _Lane(sys.maxsize, is_high=False, front=0.0, rear=0.0)


def passes_on(
    layer: Layer, radius: float, stepover: Stepover, tolerance: float, along: tuple[float, float], below: float
) -> list[Pass]:
    """Return passes from the lower to the higher angle of a layer.

    layer      where the ball's centres are
    radius     of the ball, mm
    stepover   between neighbouring passes, mm
    tolerance  how far chords may be off the path, mm
    along      the values of u that are the places 0 and 1 along
    below      step-overs are those of the surface so many mm below the centres
    """
    pattern = _pattern(_steps(layer, radius, stepover, below))
    found = []
    for way in pattern.ways():
        centre, normal, place = _points(layer, way, along)
        kept = np.empty(len(centre), np.uint8)
        thin(centre, _SHARE * tolerance, _LONGEST, kept)
        rows = np.flatnonzero(kept)
        found.append(Pass(centre[rows], normal[rows], place[rows]))
    return found


def _points(layer: Layer, way: Floats, along: tuple[float, float]) -> tuple[Floats, Floats, Floats]:
    """Centres, normals and places (k, 3) at nodes and shares (k, 2), without doubles: between nodes, the radius, the
    height and the angle change evenly."""
    way = way[np.r_[True, (np.abs(np.diff(way, axis=0)) > 1e-9).any(axis=1)]]
    at, share = way.T
    nodes = np.arange(len(layer.u))
    angle = np.unwrap(np.arctan2(layer.place[:, 1], layer.place[:, 0]))
    columns = (
        np.hypot(layer.place[:, 0], layer.place[:, 1]),
        layer.place[:, 2],
        angle + layer.low,
        layer.high - layer.low,
        np.hypot(layer.normal[:, 0], layer.normal[:, 1]) * _sign_outward(layer),
        layer.normal[:, 2],
        layer.u,
    )
    r, z, low, wide, outward, up, u = (np.interp(at, nodes, column) for column in columns)
    turn = low + share * wide
    cosine, sine = np.cos(turn), np.sin(turn)
    size = np.hypot(outward, up)
    centre = np.column_stack((r * cosine, r * sine, z))
    normal = np.column_stack((outward * cosine, outward * sine, up)) / size[:, None]
    place = np.column_stack(((u - along[0]) / (along[1] - along[0]), share, np.full(len(u), layer.height)))
    return centre, normal, place


def _sign_outward(layer: Layer) -> Floats:
    """+1 where the normal points away from the axis (k,), −1 towards it."""
    return np.where(np.einsum("ij,ij->i", layer.normal[:, :2], layer.place[:, :2]) < 0.0, -1.0, 1.0)


def _steps(layer: Layer, radius: float, stepover: Stepover, below: float) -> Floats:
    """How many step-overs (n,) wide a layer is at its nodes, at right angles to the passes."""
    found = []
    for share in (0.0, 0.5, 1.0):
        centre = layer.across(share)
        normal = turned(layer.normal, layer.low + share * (layer.high - layer.low))
        point = centre - below * normal
        size = np.maximum(np.hypot(point[:, 0], point[:, 1]), 1e-9)
        outward = np.column_stack((point[:, :2] / size[:, None], np.zeros(len(size))))
        step = np.gradient(point, axis=0)
        around = (point[:, 0] * step[:, 1] - point[:, 1] * step[:, 0]) / size
        square = np.maximum(np.einsum("ij,ij->i", step, step), 1e-24)
        sine = np.clip(around**2 / square, 0.0, 1.0)
        # Curvatures of the surface round the axis and along its profile, above 0 where it is convex.
        flat = np.column_stack((np.einsum("ij,ij->i", normal, outward), normal[:, 2]))
        profile = np.column_stack((np.gradient(size), step[:, 2]))
        length = np.maximum(np.einsum("ij,ij->i", profile, profile), 1e-24)
        bend_along = np.einsum("ij,ij->i", np.gradient(flat, axis=0), profile) / length
        bend = sine * bend_along + (1.0 - sine) * flat[:, 0] / size
        most = np.array([stepover.on(radius, float(one)) for one in bend])
        wide = np.maximum((layer.high - layer.low) * size * np.sqrt(1.0 - sine), 1e-9)
        # A pass in the middle moves across by half of what the width changes: by no more than it goes along.
        found.append(np.exp(eased(np.log(wide / most), 2.0 * np.sqrt(square) / wide)))
    return np.asarray(np.maximum.reduce(found))


def _pattern(steps: Floats) -> _Pattern:
    """Return the lanes of a layer in their order from the lower to the higher angle.

    From its throat the layer counts as nowhere narrower towards either end, so that every lane goes out of an end.
    """
    throat = int(steps.argmin())
    front = np.maximum.accumulate(steps[throat::-1])
    rear = np.maximum.accumulate(steps[throat:])
    wide = np.r_[front[::-1], rear[1:]]
    most = float(wide.max())
    lanes: list[_Lane] = []
    for is_high in (False, True):
        numbers = range(int((most + is_high) / 2.0) + 1)
        for number in reversed(numbers) if is_high else numbers:
            least = 2.0 * number - is_high if number else 0.0
            nodes = np.arange(len(wide), dtype=float)
            before = throat - np.interp(least, front, nodes[: len(front)]) if front[-1] >= least else 0.0
            behind = throat + np.interp(least, rear, nodes[: len(rear)]) if rear[-1] >= least else nodes[-1]
            lanes.append(_Lane(number, is_high, float(before), float(behind)))
    return _Pattern(wide, lanes)


@kernel(writes="kept")
def thin(points: Floats2, tolerance: float, longest: float, kept: Codes) -> None:
    """Write 1 to ``kept`` (n,) for points (n, 3) whose chords are within a tolerance of all others, 0 for the others.

    Chords are no longer than ``longest``, mm, where points are not farther apart.
    """
    count = points.shape[0]
    for k in range(count):
        kept[k] = 0
    kept[0] = kept[count - 1] = 1
    start = 0
    for end in range(2, count):
        if not _is_chord(points, start, end, tolerance, longest):
            start = end - 1
            kept[start] = 1


@inner
def _is_chord(points: Floats2, start: int, end: int, tolerance: float, longest: float) -> bool:
    """Whether all points between two are within a tolerance of the chord."""
    x, y, z = points[start, 0], points[start, 1], points[start, 2]
    dx, dy, dz = points[end, 0] - x, points[end, 1] - y, points[end, 2] - z
    square = dx * dx + dy * dy + dz * dz
    if square > longest * longest:
        return False
    for k in range(start + 1, end):
        px, py, pz = points[k, 0] - x, points[k, 1] - y, points[k, 2] - z
        share = 0.0
        if square > 0.0:
            share = min(max((px * dx + py * dy + pz * dz) / square, 0.0), 1.0)
        px, py, pz = px - share * dx, py - share * dy, pz - share * dz
        if px * px + py * py + pz * pz > tolerance * tolerance:
            return False
    return True
