"""Stock and meshes in the workpiece frame of the next set-up.

In:     what one set-up has left, and its pose in the next one.
Out:    the same solid there.
Units:  mm, degrees.

Quarter turns about the axes turn the rays themselves: nothing is lost. For any other turn the surface of the stock
becomes a mesh, and its inside is stretches along new rays.
"""

import math
from typing import Final

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.errors import InputError, Problem
from trunnion.messages import Wording
from trunnion.records import dataclass
from trunnion.simulation.stock.lattice import BUNDLE_AXES, Lattice
from trunnion.simulation.stock.material import Stock
from trunnion.simulation.stock.spans import Spans, mesh_spans
from trunnion.simulation.stock.surface import stock_surface

#: A rotation whose numbers are so near to 0 and 1 turns by quarters.
_QUARTER: Final = 1e-12


@dataclass(frozen=True, slots=True)
class Pose:
    """Where the last set-up's workpiece frame lies in the next one's.

    origin  where its zero lies, mm
    turn    how it is turned about its zero first: about X, then Y, then Z of the new frame, right-handed, degrees
    """

    origin: tuple[float, float, float] = (0.0, 0.0, 0.0)
    turn: tuple[float, float, float] = (0.0, 0.0, 0.0)

    @property
    def rotation(self) -> Floats:
        """The turn as a matrix, (3, 3); multiples of 90 degrees without rounding."""
        (ca, sa), (cb, sb), (cc, sc) = map(_cosine_and_sine, self.turn)
        x = np.array([[1.0, 0.0, 0.0], [0.0, ca, -sa], [0.0, sa, ca]])
        y = np.array([[cb, 0.0, sb], [0.0, 1.0, 0.0], [-sb, 0.0, cb]])
        z = np.array([[cc, -sc, 0.0], [sc, cc, 0.0], [0.0, 0.0, 1.0]])
        return np.asarray(z @ y @ x)

    @property
    def matrix(self) -> Floats:
        """The map from the last workpiece frame to the new one, (4, 4)."""
        found = np.eye(4)
        found[:3, :3], found[:3, 3] = self.rotation, self.origin
        return found

    @property
    def keeps_rays(self) -> bool:
        """Whether it turns by quarters only, so that nothing is lost."""
        size = np.abs(self.rotation)
        return bool((np.minimum(size, np.abs(size - 1.0)) < _QUARTER).all())


def _cosine_and_sine(angle: float) -> tuple[float, float]:
    quarter, rest = divmod(angle, 90.0)
    if rest == 0.0:
        return ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))[int(quarter) % 4]
    return math.cos(math.radians(angle)), math.sin(math.radians(angle))


def turned_stock(stock: Stock, pose: Pose, cell: float) -> tuple[Lattice, tuple[Spans, Spans, Spans]]:
    """Return stock in the next workpiece frame: its lattice and the spans of the three bundles.

    stock  what the last set-up has left
    pose   where it lies now
    cell   width of the cells where the rays cannot be turned, mm

    Raises ``InputError`` if nothing is left of the stock.
    """
    if stock.volume <= 0.0:
        raise InputError(Problem("stock", 0, Wording("SIM135", "nothing_left_next")))
    if pose.keeps_rays:
        return _turned_rays(stock, pose)
    mesh = stock_surface(stock).moved(pose.matrix)
    lattice = Lattice.of_box(mesh.bounds[0], mesh.bounds[1], cell)
    first, second, third = (mesh_spans(mesh.vertices, mesh.faces, lattice, bundle) for bundle in range(3))
    return lattice, (first, second, third)


def _turned_rays(stock: Stock, pose: Pose) -> tuple[Lattice, tuple[Spans, Spans, Spans]]:
    """Return the rays themselves, turned by quarters."""
    old, rotation = stock.lattice, np.round(pose.rotation)
    source = np.abs(rotation).argmax(axis=1)
    sign = rotation[np.arange(3), source]
    corners = np.stack((sign * old.low[source], sign * old.high[source])) + np.array(pose.origin)
    x, y, z = (old.counts[axis] for axis in source.tolist())
    lattice = Lattice(corners.min(axis=0), corners.max(axis=0), (x, y, z))
    first, second, third = (_turned_bundle(stock, bundle, source, sign, pose) for bundle in range(3))
    return lattice, (first, second, third)


def _turned_bundle(stock: Stock, bundle: int, source: Ints, sign: Floats, pose: Pose) -> Spans:
    """One bundle of the new frame, made of that of the old frame whose rays lie along it."""
    axes = BUNDLE_AXES[bundle]
    from_axes = BUNDLE_AXES[int(source[bundle])]
    own = stock.spans(int(source[bundle]))
    numbers = np.arange(len(own.first) - 1).reshape(stock.lattice.rays(int(source[bundle])))
    if source[axes[0]] != from_axes[0]:
        numbers = numbers.T
    for place, axis in enumerate(axes[:2]):
        if sign[axis] < 0.0:
            numbers = np.flip(numbers, axis=place)
    turned = own.at(numbers.ravel())
    ends, normals = turned.ends, turned.normals
    if sign[bundle] < 0.0:
        ray = np.repeat(np.arange(len(turned.first) - 1), 2 * np.diff(turned.first))
        backwards = 2 * (turned.first[ray] + turned.first[ray + 1]) - 1 - np.arange(len(ends))
        ends, normals = ends[backwards], normals[backwards]
    components = [from_axes.index(int(source[axis])) for axis in axes]
    signs = np.array([sign[axis] for axis in axes], np.int8)
    return Spans(turned.first, sign[bundle] * ends + pose.origin[bundle], normals[:, components] * signs)
