"""Sheets of ball centres in a channel, parallel to the hub.

In:     the impeller, the ball and its allowances, a step-down.
Out:    a ``Sheet`` for each layer: points at the parameter u of the mean surface, which are turned about Z.
Units:  mm.

The lowest sheet is at the radius and an allowance from the hub. From there sheets follow each other along the lines
u = constant of the mean surface, a step-down apart in the plane of radius and height: neighbours are nowhere farther
apart. Beyond the ends of the blade's curves a sheet goes on straight in that plane, and keeps its angle to it.
"""

from typing import Any, Final

import numpy as np

from trunnion.arrays import Flags, Floats
from trunnion.errors import InputError, Problem
from trunnion.extras import import_extra
from trunnion.impeller.impeller import Impeller
from trunnion.messages import Wording
from trunnion.records import dataclass

#: How far a ball is off shroud and stock where its passes begin and end, mm.
CLEAR: Final = 0.5

#: A sheet goes on so far beyond its ends, in parts of itself.
_BEYOND: Final = 2.0

#: Places at which it is looked whether the ball is clear, and those of them on the mean surface.
_PLACES: Final = 1001
_INSIDE: Final = 201

_STEPS: Final = 30

#: The ball touches the hub this nearly, mm.
_TOUCH: Final = 1e-9


@dataclass(frozen=True, slots=True, eq=False)
class Ball:
    """The tool's ball in a channel: its radius, the tolerance of its path, and what it leaves on blades and hub, mm."""

    radius: float
    tolerance: float
    blade_allowance: float = 0.0
    hub_allowance: float = 0.0

    @property
    def to_blade(self) -> float:
        """Distance of its centre to a blade that it touches but for the allowance."""
        return self.radius + self.blade_allowance

    @property
    def to_hub(self) -> float:
        """Distance of its centre to the hub that it touches but for the allowance."""
        return self.radius + self.hub_allowance


@dataclass(frozen=True, slots=True, eq=False)
class Sheet:
    """A sheet; ``first`` and ``last`` are the values of u between which the ball is not clear of the stock.

    to_hub  distance of the lowest sheet to the hub, mm; None: it is another one
    """

    impeller: Impeller
    height: Any
    to_hub: float | None
    first: float = 0.0
    last: float = 1.0

    def points(self, u: Floats) -> Floats:
        """Points (k, 3) at u (k,), which may be beyond 0 and 1."""
        inside = np.clip(u, 0.0, 1.0)
        height = self.height(inside)
        if self.to_hub is not None:
            height = _floor(self.impeller, inside, height, self.to_hub)
        found = self.impeller.blade.surface.points(inside, height)
        for end, rows in ((0.0, np.flatnonzero(u < 0.0)), (1.0, np.flatnonzero(u > 1.0))):
            found[rows] = self._beyond(end, u[rows] - end)
        return found

    def _beyond(self, end: float, more: Floats) -> Floats:
        """Points (k, 3) beyond an end."""
        at = np.array([end])
        (place,), (along,), (across,), *_ = self.impeller.blade.surface.derivatives(at, self.height(at))
        slope = along + float(self.height(at, 1)[0]) * across
        radius = float(np.hypot(*place[:2]))
        x, y = place[:2] / radius
        outward, around = x * slope[0] + y * slope[1], x * slope[1] - y * slope[0]
        # The angle is the integral of around / radius.
        share = np.maximum(more * outward / radius, -0.95)
        even = np.abs(share) < 1e-9
        angle = around / radius * more * np.where(even, 1.0, np.log1p(share) / np.where(even, 1.0, share))
        angle += np.arctan2(place[1], place[0])
        size = radius * (1.0 + share)
        found = np.column_stack((size * np.cos(angle), size * np.sin(angle), place[2] + more * slope[2]))
        for _ in range(0 if self.to_hub is None else _STEPS):
            distance, normal, _ = self.impeller.hub.distances(found)
            missing = (self.to_hub or 0.0) - distance
            if np.abs(missing).max(initial=0.0) < _TOUCH:
                break
            found += missing[:, None] * normal
        return found


def sheets_of(impeller: Impeller, ball: Ball, step_down: float | None) -> list[Sheet]:
    """All sheets on which the ball meets stock, from the lowest one, or that one alone without a step-down.

    Raises ``InputError`` if it does not get out of the stock, or there is none.
    """
    inside = np.linspace(0.0, 1.0, _INSIDE)
    every = np.linspace(-_BEYOND, 1.0 + _BEYOND, _PLACES)
    middle = (every >= 0.0) & (every <= 1.0)
    v = _floor(impeller, inside, np.zeros(_INSIDE), ball.to_hub)
    found: list[Sheet] = []
    while step_down is not None or not found:
        sheet = Sheet(impeller, _spline(inside, v), None if found else ball.to_hub)
        clear = _is_clear(impeller, ball, sheet.points(every))
        cut = np.flatnonzero(~clear & middle)
        if not len(cut):
            break
        before, behind = np.flatnonzero(clear[: cut[0]]), np.flatnonzero(clear[cut[-1] :])
        if not len(before) or not len(behind):
            variant = "no_way_out_at_inlet" if not len(before) else "no_way_out_at_outlet"
            raise InputError(problem(impeller, Wording("IMP327", variant, diameter=2.0 * ball.radius)))
        first, last = float(every[before[-1]]), float(every[cut[-1] + behind[0]])
        found.append(Sheet(impeller, sheet.height, sheet.to_hub, first, last))
        v = _raised(impeller, inside, v, step_down or 0.0)
    if not found:
        raise InputError(problem(impeller, Wording("IMP327", "no_stock_between_blades")))
    return found


def _spline(u: Floats, v: Floats) -> Any:
    return import_extra("scipy.interpolate", "impeller").make_interp_spline(u, v)


def _is_clear(impeller: Impeller, ball: Ball, centres: Floats) -> Flags:
    """Whether a ball is off the stock, or beyond the shroud."""
    stock, off = impeller.definition.stock, ball.radius + CLEAR
    radius, height = np.hypot(centres[:, 0], centres[:, 1]), centres[:, 2]
    outside = (radius >= stock.diameter / 2.0 + off) | (height >= stock.top + off) | (height <= stock.bottom - off)
    rows = np.flatnonzero(~outside)
    outside[rows] = impeller.shroud.distances(centres[rows])[0] >= off
    return np.asarray(outside)


def _floor(impeller: Impeller, u: Floats, v: Floats, to_hub: float) -> Floats:
    """Return the v (k,) at which the mean surface is so far from the hub, near given ones: Newton's method."""
    v = v.copy()
    for _ in range(_STEPS):
        place, _, slope, *_ = impeller.blade.surface.derivatives(u, v)
        distance, normal, _ = impeller.hub.distances(place)
        missing = to_hub - distance
        if np.abs(missing).max() < _TOUCH:
            break
        v += missing / np.maximum(np.einsum("ij,ij->i", slope, normal), 0.1 * np.linalg.norm(slope, axis=1))
    return v


def _raised(impeller: Impeller, u: Floats, v: Floats, step_down: float) -> Floats:
    """Return the v (k,) that is a step farther from the hub in the plane of radius and height, by the midpoint rule."""
    half = v + 0.5 * step_down / _speed(impeller, u, v)
    return np.asarray(v + step_down / _speed(impeller, u, half))


def _speed(impeller: Impeller, u: Floats, v: Floats) -> Floats:
    """How fast radius and height change with v, mm."""
    place, _, slope, *_ = impeller.blade.surface.derivatives(u, v)
    radius = np.maximum(np.hypot(place[:, 0], place[:, 1]), 1e-9)
    outward = np.einsum("ij,ij->i", place[:, :2], slope[:, :2]) / radius
    return np.asarray(np.maximum(np.hypot(outward, slope[:, 2]), 0.1 * np.linalg.norm(slope, axis=1)))


def problem(impeller: Impeller, wording: Wording) -> Problem:
    """Something wrong with an impeller."""
    return Problem(impeller.definition.file, 0, wording)
