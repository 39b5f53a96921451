"""Blade finish: a ball goes round the blade, row by row from the shroud down to the hub or the fillet."""

import numpy as np

from trunnion.arrays import Floats
from trunnion.impeller.blade import Blade
from trunnion.impeller.fillet import Stations, crossings
from trunnion.impeller.impeller import Impeller
from trunnion.impeller.paths.around import dense_stations, lay_passes, row_depths, side_end, stations_at
from trunnion.impeller.paths.ball_clearance import prove_room, surroundings_of
from trunnion.impeller.paths.passes import PassFamily, Stepover, Way
from trunnion.records import dataclass


@dataclass(frozen=True, slots=True)
class BladeFinish:
    """What is wanted of a blade finish, mm.

    radius     of the ball
    stepover   between rows, at the station where they are farthest apart
    way        a spiral wants a round trailing edge
    allowance  that stays on the blade
    tolerance  of chords of the path of the ball's centre
    """

    radius: float
    stepover: Stepover
    way: Way = Way.ONE_WAY
    allowance: float = 0.0
    tolerance: float = 0.005


@dataclass(frozen=True, slots=True, eq=False)
class _Flank:
    """The flanks and edges of a blade at stations, from the shroud at depth 0 to the root at depth 1.

    top, root  (k,) v at which the ball touches the blade in the first and the last row
    reach      from the blade to the ball's centre
    """

    blade: Blade
    stations: Stations
    top: Floats
    root: Floats
    reach: float

    @property
    def deepest(self) -> float:
        return 1.0

    def balls(self, depth: Floats) -> tuple[Floats, Floats]:
        return self.stations.touching(self.blade, self.top + depth * (self.root - self.top), self.reach)


def blade_finish(impeller: Impeller, blade: Blade, step: BladeFinish) -> PassFamily:
    """Return passes of a ball round a blade or splitter.

    The last row is where the ball touches the hub too; a ball smaller than the fillet ends at the fillet's upper edge.
    Passes at a cut trailing edge go on until the ball is out of the stock.

    Raises ``InputError`` if the ball has no room beside the blade, or a spiral is wanted round a cut trailing edge.
    """
    reach = step.radius + step.allowance
    end = side_end(impeller, blade, reach)

    def build(s: Floats) -> _Flank:
        stations = stations_at(s, end)
        root = root_heights(impeller, blade, stations, max(reach, impeller.definition.fillet))
        return _Flank(blade, stations, np.maximum(tip_heights(impeller, blade, stations), root), root, reach)

    round_trailing = impeller.definition.trailing_edge == "round"
    s = dense_stations(build, 4.0 if round_trailing else 3.0, step.tolerance)
    flank = build(s)
    rows = row_depths(flank, len(s), 0.0, 1.0, step.radius, step.stepover)
    family = lay_passes(flank, s, rows, step.radius, step.way)
    prove_room(surroundings_of(impeller, blade), family, step.allowance, step.tolerance)
    return family


def root_heights(impeller: Impeller, blade: Blade, stations: Stations, radius: float) -> Floats:
    """v (k,) at which a ball of a radius touches blade and hub; the blade's own end where it touches both nowhere."""

    def gap(v: Floats) -> Floats:
        return impeller.hub.distances(stations.touching(blade, v, radius)[0])[0] - radius

    return crossings(gap, np.full(len(stations.part), blade.low), np.full(len(stations.part), blade.high))


def tip_heights(impeller: Impeller, blade: Blade, stations: Stations) -> Floats:
    """v (k,) at which the surface of the blade meets the shroud."""

    def gap(v: Floats) -> Floats:
        return impeller.shroud.distances(stations.touching(blade, v, 0.0)[0])[0]

    return crossings(gap, np.full(len(stations.part), blade.low), np.full(len(stations.part), blade.high))
