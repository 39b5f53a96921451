"""Room for a ball that touches a surface: what else it would touch.

A ball that is no smaller than the fillet and clear of blades and hub is clear of the fillets. A smaller one is inside
of a ball as large as the fillet that touches the surface at the same point: if that one is clear, so is it.
"""

from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.errors import InputError, Problem
from trunnion.impeller.blade import Blade
from trunnion.impeller.impeller import Impeller, rotated
from trunnion.impeller.paths.passes import PassFamily
from trunnion.messages import Wording
from trunnion.records import dataclass

#: Halvings of the interval in which the largest ball is.
_HALVINGS: Final = 40

#: So many of the worst places are asked for the largest ball that fits.
_WORST: Final = 64


@dataclass(frozen=True, slots=True, eq=False)
class Surroundings:
    """What is around a blade: itself, the hub, and the blades beside it.

    beside  blades and the angles by which they are turned about Z, seen from this blade
    """

    impeller: Impeller
    blade: Blade
    beside: tuple[tuple[Blade, float], ...]

    def neighbour_gaps(self, points: Floats) -> Floats:
        """Distance (k,) of points (k, 3) to the nearest of the blades beside."""
        gap = np.full(len(points), np.inf)
        for other, angle in self.beside:
            gap = np.minimum(gap, other.distances(rotated(points, -angle))[0])
        return gap

    def gaps(self, points: Floats) -> Floats:
        """Distance (k,) of points (k, 3) to the nearest of all."""
        own = np.minimum(self.blade.distances(points)[0], self.impeller.hub.distances(points)[0])
        return np.asarray(np.minimum(own, self.neighbour_gaps(points)))


def surroundings_of(impeller: Impeller, blade: Blade) -> Surroundings:
    """Return what is around a blade or splitter, seen from it."""
    pitch = 2.0 * np.pi / impeller.definition.number
    around = [(other, angle) for other, angle in impeller.blades()]
    own = next(angle for other, angle in around if other is blade)
    beside = []
    for other, angle in around:
        turn = (angle - own + np.pi) % (2.0 * np.pi) - np.pi
        if 1e-9 < abs(turn) <= pitch * (1.0 + 1e-9):
            beside.append((other, turn))
    return Surroundings(impeller, blade, tuple(beside))


def prove_room(around: Surroundings, family: PassFamily, allowance: float, tolerance: float) -> None:
    """Refuse passes whose ball would cut into blades, hub or fillets; balls outside of the stock cut nothing.

    Raises ``InputError`` with the place, by how much, and the largest ball that fits.
    """
    definition = around.impeller.definition
    reach = family.radius + allowance
    centre = family.centres()
    normal = np.concatenate([one.normal for one in family.passes])
    inside = np.hypot(centre[:, 0], centre[:, 1]) < definition.stock.diameter / 2.0 + reach
    touch, normal = centre[inside] - reach * normal[inside], normal[inside]
    wanted = max(reach, definition.fillet)
    missing = wanted - around.gaps(touch + wanted * normal)
    worst = np.argsort(-missing)[:_WORST]
    if not len(worst) or missing[worst[0]] <= tolerance:
        return
    touch, normal = touch[worst], normal[worst]
    low, high = np.zeros(len(worst)), np.full(len(worst), wanted)
    for _ in range(_HALVINGS):
        middle = (low + high) / 2.0
        fits = around.gaps(touch + middle[:, None] * normal) >= middle - 1e-9
        low, high = np.where(fits, middle, low), np.where(fits, high, middle)
    largest = float(low.min()) - allowance
    x, y, z = touch[0]
    raise InputError(
        Problem(
            definition.file,
            0,
            Wording(
                "IMP320",
                "ball_radius_mm_cuts" if reach < wanted else "ball_radius_mm_cuts_mm",
                wanted=wanted,
                missing=missing[worst[0]],
                x=x,
                y=y,
                z=z,
                largest=largest,
            ),
        )
    )
