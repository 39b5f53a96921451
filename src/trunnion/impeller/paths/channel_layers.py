"""Layers of ball centres in a channel: how far the ball goes to either blade on each sheet.

In:     a channel, the ball, a step-down.
Out:    a ``Layer`` for each sheet: nodes from the inlet to the outlet, with the angles between which the ball moves.
Units:  mm; angles in radians about Z.
"""

import math
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.errors import InputError, Problem
from trunnion.impeller.impeller import Impeller
from trunnion.impeller.paths.channel import Channel, Extent, turned
from trunnion.impeller.paths.channel_sheets import Ball, Sheet, problem, sheets_of
from trunnion.impeller.progress import Progress, silent
from trunnion.messages import Wording
from trunnion.records import dataclass

#: How often the ball's way in before an edge is laid, and moved off the blade where it is too near.
_SWINGS: Final = 3

#: Share of the tolerance that chords between nodes take, where no path bends more sharply than the ball.
_SHARE: Final = 0.05

#: The ball swings in before an edge by no more than so many mm across on one along: what is left in front of the edge,
#: between there and the ball that touches it, is an eighth of their distance long.
_SLOPE: Final = 2.0

#: Values that would be raised by less stay as they are.
_EASED: Final = 1e-12

_THREADS: Final = 2

#: The largest ball that fits is found by so many trials, at so many places of each sheet.
_TRIALS: Final = 6
_SPARSE: Final = 65


@dataclass(frozen=True, slots=True, eq=False)
class Layer:
    """Nodes (n,) of a layer from inlet to outlet.

    u       of the mean surface
    place   (n, 3) points of a sheet, which are turned
    normal  (n, 3) of the hub there, turned alike
    low, high   angles between which the ball moves
    height  0: the lowest layer, 1: the highest
    """

    u: Floats
    place: Floats
    normal: Floats
    low: Floats
    high: Floats
    height: float

    def across(self, share: float) -> Floats:
        """Centres (n, 3) at a share of the way from the lower to the higher angle."""
        return turned(self.place, self.low + share * (self.high - self.low))


@dataclass(frozen=True, slots=True, eq=False)
class _Throat:
    """The narrowest place: its u, the point between the blades, and the distance of a ball's centre to both, mm."""

    u: float
    point: Floats
    room: float


def layers_of(channel: Channel, ball: Ball, step_down: float | None, progress: Progress = silent) -> list[Layer]:
    """All layers of a channel from the lowest one, or that one alone without a step-down.

    Raises ``InputError`` if the ball is smaller than the fillet, does not get out of the stock, or does not fit between
    the blades; the place is named then, and the largest ball that fits.
    """
    impeller = channel.impeller
    fillet = impeller.definition.fillet
    if ball.radius + min(ball.blade_allowance, ball.hub_allowance) < fillet:
        wording = Wording("IMP320", "ball_smaller_than_fillet", diameter=2.0 * ball.radius, fillet=fillet)
        raise InputError(problem(impeller, wording))
    sheets = sheets_of(impeller, ball, step_down)
    laid = []
    # Kernels run beside each other.
    with ThreadPoolExecutor(_THREADS) as executor, progress("layers", len(sheets), "layers") as advance:
        for one in executor.map(lambda sheet: _laid(channel, ball, sheet), sheets):
            laid.append(one)
            advance(1)
    throat = min((throat for _, throat in laid), key=lambda one: one.room)
    if throat.room < ball.to_blade:
        raise InputError(_too_narrow(channel, ball, step_down, throat))
    return [replace(layer, height=k / max(len(laid) - 1, 1)) for k, (layer, _) in enumerate(laid)]


def _laid(channel: Channel, ball: Ball, sheet: Sheet) -> tuple[Layer, _Throat]:
    """Return the layer of a sheet, and where it is narrowest."""
    u = np.linspace(sheet.first, sheet.last, _count(sheet, ball))
    place = sheet.points(u)
    extent = channel.extent(place, ball.to_blade)
    throat = _throat(u, place, extent)
    for _ in range(_SWINGS):
        swung = _swung(place, extent)
        rows = np.flatnonzero((swung.low > extent.low) | (swung.high < extent.high))
        if not len(rows):
            break
        extent = channel.narrowed(place, ball.to_blade, swung, rows)
    normal = channel.impeller.hub.distances(place)[1]
    return Layer(u, place, normal, extent.low, extent.high, 0.0), throat


def _count(sheet: Sheet, ball: Ball) -> int:
    """So many nodes that chords of a path that bends like the ball are within a share of the tolerance."""
    u = np.linspace(sheet.first, sheet.last, 65)
    longest = 64.0 * float(np.linalg.norm(np.diff(sheet.points(u), axis=0), axis=1).max())
    return max(9, math.ceil(longest / math.sqrt(8.0 * _SHARE * ball.tolerance * ball.radius)))


def _swung(place: Floats, extent: Extent) -> Extent:
    """Angles that change by no more than a slope to the path: so the ball swings in before an edge.

    Where a blade begins, the place of contact would turn off at a right angle to the line in front of it.
    """
    step = np.gradient(place, axis=0)
    radius = np.maximum(np.hypot(place[:, 0], place[:, 1]), 1e-9)
    around = (place[:, 0] * step[:, 1] - place[:, 1] * step[:, 0]) / radius
    square = np.einsum("ij,ij->i", step, step)
    most = _SLOPE * square / np.maximum(radius * np.sqrt(np.maximum(square - around**2, 0.0)), 1e-9)
    low = np.minimum(eased(extent.low, most), extent.middle)
    high = np.maximum(-eased(-extent.high, most), extent.middle)
    return replace(extent, low=low, high=high)


def eased(values: Floats, most: Floats) -> Floats:
    """Return the least values (n,) that are nowhere below others, and change by no more than ``most`` (n,) at
    a node.
    """
    way = np.r_[0.0, np.cumsum((most[1:] + most[:-1]) / 2.0)]
    behind = np.maximum.accumulate(values + way) - way
    before = np.maximum.accumulate((values - way)[::-1])[::-1] + way
    found = np.maximum(behind, before)
    return np.asarray(np.where(found > values + _EASED, found, values))


def _throat(u: Floats, place: Floats, extent: Extent) -> _Throat:
    k = int(extent.room.argmin())
    return _Throat(float(u[k]), turned(place[k : k + 1], extent.middle[k : k + 1])[0], float(extent.room[k]))


def _too_narrow(channel: Channel, ball: Ball, step_down: float | None, throat: _Throat) -> Problem:
    """Return a channel that is too narrow for a ball."""
    w, z, r = _named(channel.impeller, throat)
    where: dict[str, object] = {"diameter": 2.0 * ball.radius, "w": w, "z": z, "r": r}
    allowance = ball.blade_allowance
    radius = throat.room - allowance
    for _ in range(_TRIALS):  # a smaller ball goes deeper, where there is less room or more
        if radius <= 0.0:
            break
        sheets = sheets_of(channel.impeller, replace(ball, radius=radius), step_down)
        u = [np.linspace(sheet.first, sheet.last, _SPARSE) for sheet in sheets]
        places = np.concatenate([sheet.points(at) for sheet, at in zip(sheets, u, strict=True)])
        radius = min(radius, float(channel.extent(places, radius + allowance).room.min()) - allowance)
    largest = math.floor(200.0 * radius) / 100.0
    if largest <= 0.0:
        return problem(channel.impeller, Wording("IMP320", "no_ball_fits", **where))
    return problem(channel.impeller, Wording("IMP320", "ball_does_not_fit", largest=largest, **where))


def _named(impeller: Impeller, throat: _Throat) -> tuple[float, float, float]:
    """Return a place by w, height and radius."""
    x, y, z = throat.point
    middle = float(impeller.blade.edges[0].mean()), float(impeller.blade.edges[1].mean())
    w = (throat.u - middle[0]) / (middle[1] - middle[0])
    return w, z, math.hypot(x, y)
