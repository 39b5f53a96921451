"""Root blend: a ball goes round the root, from a strip of the blade through the fillet to a strip of the hub.

The strips are as wide as balls that went before could not reach. They end at the shroud, and where the fillet of a
blade beside begins.
"""

import math
from dataclasses import replace
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.errors import InputError, Problem
from trunnion.impeller.blade import Blade
from trunnion.impeller.fillet import Fillet, Stations, root_fillet
from trunnion.impeller.impeller import Impeller
from trunnion.impeller.paths.around import dense_stations, lay_passes, row_depths, side_end, stations_at
from trunnion.impeller.paths.ball_clearance import Surroundings, prove_room, surroundings_of
from trunnion.impeller.paths.blade_finish import root_heights, tip_heights
from trunnion.impeller.paths.passes import PassFamily, Stepover, Way
from trunnion.messages import Wording
from trunnion.records import dataclass

#: Strips go on beyond what was not reached, as a part of the ball's radius.
_OVERLAP: Final = 0.25

#: Steps across the strip of the hub at which room is looked for, and halvings of the step in which it ends.
_STEPS: Final = 8
_HALVINGS: Final = 24

#: A step of v that is small against a blade's height.
_LITTLE: Final = 1e-5

#: A ball may be larger than the fillet by rounding, mm.
_SAME: Final = 1e-9


@dataclass(frozen=True, slots=True)
class RootBlend:
    """What is wanted of a root blend, mm.

    radius        of the ball, no larger than the fillet
    stepover      between rows, at the station where they are farthest apart; in the fillet, whose curve holds the ball,
                  as far apart as leaves the ridge that it leaves on a plane
    hub_radius    of the ball that finished the hub, with what it left on the blade
    blade_radius  of the ball that finished the blade, with what it left on the hub
    way           a spiral wants a round trailing edge
    tolerance     of chords of the path of the ball's centre
    """

    radius: float
    stepover: Stepover
    hub_radius: float
    blade_radius: float
    way: Way = Way.ONE_WAY
    tolerance: float = 0.005


@dataclass(frozen=True, slots=True, eq=False)
class _Root:
    """Blade, fillet and hub at stations: depth 0 to 1 down the blade, to 2 through the fillet, to 3 out on the hub.

    radius  of the fillet
    ball    its radius
    top     (k,) v at which the strip of the blade begins
    angle   (k,) of the fillet's arc
    away    (k, 3) unit vectors along the hub, away from the blade
    width   (k,) of the strip of the hub
    """

    impeller: Impeller
    blade: Blade
    stations: Stations
    fillet: Fillet
    radius: float
    ball: float
    top: Floats
    angle: Floats
    away: Floats
    width: Floats

    @property
    def deepest(self) -> float:
        return 3.0

    def balls(self, depth: Floats) -> tuple[Floats, Floats]:
        share = np.clip(depth, 0.0, 1.0)
        centre, normal = self.stations.touching(self.blade, self.top + share * (self.fillet.v - self.top), self.ball)
        rows = np.flatnonzero(depth > 1.0)
        turn = np.minimum(depth[rows] - 1.0, 1.0) * self.angle[rows]
        to_hub = self.fillet.to_hub[rows]
        # ``away``, the normal of the hub and the direction to the blade are in one plane.
        from_blade = self.angle[rows] - turn
        normal[rows] = np.sin(from_blade)[:, None] * self.away[rows] - np.cos(from_blade)[:, None] * to_hub
        centre[rows] = self.fillet.centre[rows] - (self.radius - self.ball) * normal[rows]
        rows = np.flatnonzero(depth > 2.0)
        touch, normal[rows] = self.on_hub(rows, (depth[rows] - 2.0) * self.width[rows])
        centre[rows] = touch + self.ball * normal[rows]
        return centre, normal

    def on_hub(self, rows: Ints, way: Floats) -> tuple[Floats, Floats]:
        """Points of the hub and its normals (k, 3) at stations, so far away from the fillet (k,)."""
        start = self.fillet.centre[rows] + self.radius * self.fillet.to_hub[rows]
        beside = start + way[:, None] * self.away[rows]
        distance, normal, _ = self.impeller.hub.distances(beside)
        return beside - distance[:, None] * normal, normal


def root_blend(impeller: Impeller, blade: Blade, step: RootBlend) -> PassFamily:
    """Return passes of a ball round the root of a blade or splitter, from the blade out to the hub.

    Raises ``InputError`` if the ball is larger than the fillet, the fillet has no room beside the next blade, or a
    spiral is wanted round a cut trailing edge.
    """
    fillet = impeller.definition.fillet
    if step.radius > fillet + _SAME:
        raise InputError(
            Problem(impeller.definition.file, 0, Wording("IMP320", "ball_radius_mm", radius=step.radius, fillet=fillet))
        )
    around = surroundings_of(impeller, blade)
    end = side_end(impeller, blade, fillet)

    def build(s: Floats) -> _Root:
        return _root(around, stations_at(s, end), step)

    s = dense_stations(build, 4.0 if impeller.definition.trailing_edge == "round" else 3.0, step.tolerance)
    root = build(s)
    family = lay_passes(root, s, _rows(root, step), step.radius, step.way)
    prove_room(around, family, 0.0, step.tolerance)
    return family


def _root(around: Surroundings, stations: Stations, step: RootBlend) -> _Root:
    """Return the root at stations, with its strips."""
    impeller, blade, radius = around.impeller, around.blade, around.impeller.definition.fillet
    fillet = root_fillet(blade, impeller.hub, radius, stations)
    cosine = np.einsum("ij,ij->i", fillet.to_blade, fillet.to_hub)
    away = cosine[:, None] * fillet.to_hub - fillet.to_blade
    away /= np.linalg.norm(away, axis=1)[:, None]
    angle = np.arccos(np.clip(cosine, -1.0, 1.0))
    top = _top(around, stations, fillet, step)
    root = _Root(impeller, blade, stations, fillet, radius, step.radius, top, angle, away, np.zeros(len(top)))
    return replace(root, width=_width(around, root, step))


def _top(around: Surroundings, stations: Stations, fillet: Fillet, step: RootBlend) -> Floats:
    """v (k,) at which the strip of the blade begins."""
    blade, v = around.blade, fillet.v
    if step.blade_radius > around.impeller.definition.fillet:
        v = root_heights(around.impeller, blade, stations, step.blade_radius)
    one, other = (stations.touching(blade, at, 0.0)[0] for at in (v, v + _LITTLE))
    per_v = np.linalg.norm(other - one, axis=1) / _LITTLE
    top = np.minimum(v + _OVERLAP * step.radius / per_v, tip_heights(around.impeller, blade, stations))
    return np.asarray(np.maximum(top, fillet.v))


def _width(around: Surroundings, root: _Root, step: RootBlend) -> Floats:
    """Width (k,) of the strip of the hub: as far as is wanted, and as the fillets of the blades beside let it."""
    every = np.arange(len(root.top))
    wanted = np.full(len(every), _OVERLAP * step.radius)
    if step.hub_radius > root.radius:
        v = root_heights(around.impeller, around.blade, root.stations, step.hub_radius)
        ball = root.stations.touching(around.blade, v, step.hub_radius)[0]
        distance, normal, _ = around.impeller.hub.distances(ball)
        wanted += np.linalg.norm(
            ball - distance[:, None] * normal - root.on_hub(every, np.zeros(len(every)))[0], axis=1
        )

    def fits(rows: Ints, way: Floats) -> Flags:
        touch, normal = root.on_hub(rows, way)
        return np.asarray(around.neighbour_gaps(touch + root.radius * normal) >= root.radius)

    low, rows = np.zeros(len(every)), every
    for k in range(1, _STEPS + 1):  # as far as one step after another fits
        rows = rows[fits(rows, wanted[rows] * k / _STEPS)]
        low[rows] = k / _STEPS
    rows = np.flatnonzero(low < 1.0)
    low, high = low[rows], low[rows] + 1.0 / _STEPS
    for _ in range(_HALVINGS):
        middle = (low + high) / 2.0
        inside = fits(rows, wanted[rows] * middle)
        low, high = np.where(inside, middle, low), np.where(inside, high, middle)
    wanted[rows] *= low
    return wanted


def _rows(root: _Root, step: RootBlend) -> Floats:
    """Depths of the rows."""
    count = len(root.top)
    blade, hub = (row_depths(root, count, at, at + 1.0, step.radius, step.stepover) for at in (0.0, 2.0))
    return np.concatenate((blade[:-1], _arc_rows(root, step), hub[1:]))


def _arc_rows(root: _Root, step: RootBlend) -> Floats:
    """Depths of the rows in the fillet: one in its middle if the ball hardly moves from the first to the last."""
    ball, fillet, widest = step.radius, root.radius, float(root.angle.max())
    rest = fillet - ball
    if rest * widest < step.tolerance:
        return np.array([1.5])
    ridge = ball - math.sqrt(max(ball**2 - step.stepover.on(ball) ** 2 / 4.0, 0.0))
    # Two balls of the fillet that are 2x apart about its centre leave a ridge at this distance from it:
    top = fillet - ridge
    x = math.acos(min(max((top**2 + rest**2 - ball**2) / (2.0 * top * rest), -1.0), 1.0))
    return np.linspace(1.0, 2.0, math.ceil(widest / (2.0 * x) - 1e-9) + 1)
