"""Flanks of which something is known: analytic blades, a cylinder, a cone, a tangent-developable."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from trunnion.arrays import Floats
from trunnion.impeller.flank.cutter import FlankCutter
from trunnion.impeller.flank.fit import Limits
from trunnion.impeller.flank.flanks import Flank
from trunnion.impeller.flank.milling import FlankCut, mill_flank


@dataclass(frozen=True, slots=True)
class RuledBlade:
    """A ruled blade from formulas, as slavanyx/crossmath has them; lengths in mm, angles in radians.

    radius is that of the cylinder that mills it.
    """

    radius: float
    hub: tuple[float, float]
    shroud: tuple[float, float]
    span: float
    offset: float
    wrap: float
    twist: float
    radial_curve: float = 0.0
    warp: float = 0.0
    backsweep: float = 0.0
    lean: float = 0.0

    def rails(self, u: Floats) -> tuple[Floats, Floats]:
        """Points (n, 3) of the hub's and the shroud's curve."""
        share = u + self.radial_curve * 4.0 * u * (1.0 - u)
        low = self.hub[0] + (self.hub[1] - self.hub[0]) * share
        high = self.shroud[0] + (self.shroud[1] - self.shroud[0]) * share
        angle = self.wrap * u + self.warp * np.sin(2.0 * np.pi * u)
        other = angle + self.twist * u + self.backsweep * u * u
        z = self.span * u
        top = self.offset + z + self.lean * self.span * np.sin(np.pi * u)
        first = np.column_stack((low * np.cos(angle), low * np.sin(angle), z))
        return first, np.column_stack((high * np.cos(other), high * np.sin(other), top))

    def flank(self, along: int, across: int, side: float) -> Flank:
        """A grid of the blade; side +1 or -1."""
        return ruled(self.rails, along, across, side)


def ruled(rails: Callable[[Floats], tuple[Floats, Floats]], along: int, across: int, side: float) -> Flank:
    """A grid of the ruled surface between two curves over parameters from 0 to 1."""
    u, v = np.linspace(0.0, 1.0, along), np.linspace(0.0, 1.0, across)[None, :, None]
    h = 1e-6
    low, high = rails(u)
    after, before = rails(u + h), rails(u - h)
    points = (1.0 - v) * low[:, None] + v * high[:, None]
    slope = ((1.0 - v) * (after[0] - before[0])[:, None] + v * (after[1] - before[1])[:, None]) / (2.0 * h)
    normal = np.cross(slope, np.broadcast_to((high - low)[:, None], slope.shape))
    return Flank(points, side * normal / np.linalg.norm(normal, axis=2)[:, :, None])


#: The published ones and their cutters.
PUBLISHED = {
    "mixed flow": RuledBlade(4.0, (30, 46), (42, 58), 22, 6, 0.55, 0.5, radial_curve=0.5),
    "high twist": RuledBlade(3.5, (34, 48), (46, 60), 20, 6, 0.45, 0.65),
    "S warp": RuledBlade(4.0, (36, 52), (48, 64), 20, 6, 0.55, 0.4, warp=0.45),
    "tall leaned": RuledBlade(3.5, (34, 50), (44, 58), 30, 8, 0.5, 0.45, lean=0.3),
    "default": RuledBlade(6.0, (30, 30), (55, 55), 20, 8, 0.6, 0.7),
}


def mill(blade: RuledBlade, side: float, limits: Limits | None = None) -> FlankCut:
    """One side of a blade, the axis longer than its rulings by 30 % at either end."""
    low, high = blade.rails(np.linspace(0.0, 1.0, 101))
    lengths = np.linalg.norm(high - low, axis=1)
    below = 0.3 * float(lengths.mean())
    cutter = FlankCutter(blade.radius, 0.0, float(lengths.max()) + 2.0 * below)

    def grid(along: int, across: int) -> Flank:
        return blade.flank(along, across, side)

    return mill_flank(grid, cutter, limits or Limits(), below=below)
