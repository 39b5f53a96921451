"""A blade: all balls whose centres are on its mean surface, each as large as the blade is thick there.

In:     the mean surface, its edges, and the thickness.
Out:    points of its surface and their outward normals; the distance of any point to it.
Units:  mm.

The surface is the envelope of the balls. A point of it is ``P + h m``: P on the mean surface, h half the thickness
there, and m a unit vector with m·Pw = −hw and m·Pv = −hv (the distance to the ball's surface does not change along the
mean surface). So the edges are round by themselves, and the distance of a point q to the blade is the least of
|q − P| − h.

The mean surface is taken over w and v from 0 to 1: w goes from the leading to the trailing edge, v from hub to tip.
Beyond, it goes on straight.
"""

from functools import lru_cache
from typing import Final, NamedTuple

import numpy as np

from trunnion.arrays import Floats, Floats2, Floats3
from trunnion.geometry.surface_kernel import SurfaceData, surface_row
from trunnion.geometry.surfaces import BSplineSurface
from trunnion.jit import inner, kernel
from trunnion.records import dataclass

#: Places along w and v from the nearest of which the search for the closest point begins.
_ALONG: Final = 33
_ACROSS: Final = 13

#: Places are searched in blocks of so many along w and v.
_BLOCK: Final = 4
_BLOCKS_ACROSS: Final = -(-_ACROSS // _BLOCK)

_STEPS: Final = 50
_HALVINGS: Final = 30

#: A step this small is the last one: of parameters from 0 to 1. The distance, least there, is off by its square.
_SMALL: Final = 1e-8


class BladeData(NamedTuple):
    """A blade as kernels take it.

    surface  the mean surface
    edges    (2, 2): u of the leading edge at hub and tip, u of the trailing edge at hub and tip
    half     (2, 2): half the thickness, mm: at the leading edge at hub and tip, at the trailing edge at hub and tip
    low      v from which the blade goes, below the hub
    high     v to which it goes, above the shroud
    """

    surface: SurfaceData
    edges: Floats2
    half: Floats2
    low: float
    high: float


@dataclass(frozen=True, slots=True, eq=False)
class Blade:
    """A blade; ``edges``, ``half``, ``low`` and ``high`` as in ``BladeData``."""

    surface: BSplineSurface
    edges: Floats
    half: Floats
    low: float
    high: float

    @property
    def data(self) -> BladeData:
        """The blade as kernels take it."""
        return BladeData(self.surface.data, self.edges, self.half, self.low, self.high)

    def frames(self, w: Floats, v: Floats) -> Floats:
        """Mean surface at parameters (k,): points, derivatives by w and by v, and h, hw, hv, (4, k, 3)."""
        found = np.empty((4, len(w), 3))
        blade_frames(self.data, np.ascontiguousarray(w, float), np.ascontiguousarray(v, float), found)
        return found

    def sides(self, w: Floats, v: Floats, side: float) -> tuple[Floats, Floats]:
        """Centres of balls (k, 3) and outward normals (k, 3) of one side: +1 is that of the mean surface's normal."""
        centre, along, across, half = self.frames(w, v)
        e = np.einsum("ij,ij->i", along, along)
        f = np.einsum("ij,ij->i", along, across)
        g = np.einsum("ij,ij->i", across, across)
        area = e * g - f * f
        a = (-half[:, 1] * g + half[:, 2] * f) / area
        b = (half[:, 1] * f - half[:, 2] * e) / area
        flat = a[:, None] * along + b[:, None] * across
        normal = np.cross(along, across) / np.sqrt(area)[:, None]
        rest = np.sqrt(np.maximum(1.0 - np.einsum("ij,ij->i", flat, flat), 0.0))
        return centre, flat + side * rest[:, None] * normal

    def edge(self, w: float, turn: Floats, v: Floats) -> tuple[Floats, Floats]:
        """Centres of balls (k, 3) and outward normals (k, 3) of the round edge at w = 0 or 1.

        ``turn`` (k,) goes from 0 to 1 over the edge: from side +1 to side −1 at w = 1, back at w = 0.
        """
        at = np.full(len(v), w)
        first = 1.0 if w > 0.5 else -1.0
        centre, start = self.sides(at, v, first)
        end = self.sides(at, v, -first)[1]
        _, along, across, half = self.frames(at, v)
        size = np.linalg.norm(across, axis=1)
        axis = across / size[:, None]
        lean = (-half[:, 2] / size)[:, None] * axis
        radius = np.linalg.norm(start - lean, axis=1)[:, None]
        x = (start - lean) / radius
        y = np.cross(axis, x)
        outward = along * (1.0 if w > 0.5 else -1.0)
        y *= np.where(np.einsum("ij,ij->i", y, outward) < 0.0, -1.0, 1.0)[:, None]
        other = end - lean
        angle = np.arctan2(np.einsum("ij,ij->i", other, y), np.einsum("ij,ij->i", other, x))
        angle = np.where(angle < 0.0, angle + 2.0 * np.pi, angle) * turn
        return centre, lean + radius * (np.cos(angle)[:, None] * x + np.sin(angle)[:, None] * y)

    def halves(self, w: Floats, v: Floats) -> Floats:
        """Half the thickness (k,), mm."""
        return np.asarray(self.frames(w, v)[3, :, 0])

    def distances(self, points: Floats) -> tuple[Floats, Floats]:
        """Distance of points (k, 3) to the blade, mm, below 0 inside; and w, v of the nearest ball, (k, 2)."""
        return self._distances(points, np.full(len(points), np.inf))

    def nearer(self, points: Floats, known: Floats) -> Floats:
        """Return the distance of points (k, 3) to the blade, mm, or a known one (k,) where that is less.

        It takes little time where the blade is far away.
        """
        return self._distances(points, known.copy())[0]

    def _distances(self, points: Floats, found: Floats) -> tuple[Floats, Floats]:
        at = np.full((len(points), 2), np.nan)
        blade_distances(self.data, _samples(self), np.ascontiguousarray(points, float), found, at)
        return found, at


class Samples(NamedTuple):
    """Balls at places of a blade, from which the search for the nearest one begins.

    grid    (_ALONG · _ACROSS, 4) centres and radii
    bounds  (blocks, 4) a ball for each block of places, which holds all of theirs
    reach   any other ball of the blade is within this distance of one of them, mm
    """

    grid: Floats2
    bounds: Floats2
    reach: float


@lru_cache(maxsize=16)
def _samples(blade: Blade) -> Samples:
    """Return the samples of a blade, kept as it is asked again and again."""
    grid = np.empty((_ALONG * _ACROSS, 4))
    bounds = np.empty((-(-_ALONG // _BLOCK) * _BLOCKS_ACROSS, 4))
    blade_samples(blade.data, grid, bounds)
    cells = grid.reshape(_ALONG, _ACROSS, 4)
    sides = [np.linalg.norm(np.diff(cells, axis=axis), axis=2).max() for axis in (0, 1)]
    return Samples(grid, bounds, float(sum(sides)))


@inner
def _frame(blade: BladeData, w: float, v: float, work: Floats3, row: Floats2, out: Floats2) -> None:
    """Write P, Pw, Pv, Pww, Pwv, Pvv and (h, hw, hv), (hwv, 0, 0) to ``out`` (8, 3)."""
    start = blade.edges[0, 0] + v * (blade.edges[0, 1] - blade.edges[0, 0])
    end = blade.edges[1, 0] + v * (blade.edges[1, 1] - blade.edges[1, 0])
    start_v = blade.edges[0, 1] - blade.edges[0, 0]
    end_v = blade.edges[1, 1] - blade.edges[1, 0]
    u_w = end - start
    u_v = start_v + w * (end_v - start_v)
    u_wv = end_v - start_v
    surface_row(blade.surface, start + w * u_w, v, work, row)
    for axis in range(3):
        out[0, axis] = row[0, axis]
        out[1, axis] = row[1, axis] * u_w
        out[2, axis] = row[1, axis] * u_v + row[2, axis]
        out[3, axis] = row[3, axis] * u_w * u_w
        out[4, axis] = row[3, axis] * u_w * u_v + row[4, axis] * u_w + row[1, axis] * u_wv
        out[5, axis] = row[3, axis] * u_v * u_v + 2.0 * row[4, axis] * u_v + row[5, axis]
    half = blade.half
    leading = half[0, 0] + v * (half[0, 1] - half[0, 0])
    trailing = half[1, 0] + v * (half[1, 1] - half[1, 0])
    leading_v = half[0, 1] - half[0, 0]
    trailing_v = half[1, 1] - half[1, 0]
    out[6, 0] = leading + w * (trailing - leading)
    out[6, 1] = trailing - leading
    out[6, 2] = leading_v + w * (trailing_v - leading_v)
    out[7, 0] = trailing_v - leading_v


@kernel(writes="out")
def blade_frames(blade: BladeData, w: Floats, v: Floats, out: Floats3) -> None:
    """Write P, Pw, Pv and (h, hw, hv) at parameters (k,) to ``out`` (4, k, 3)."""
    work, row, frame = np.empty((3, 4, 4)), np.empty((6, 3)), np.empty((8, 3))
    for k in range(w.shape[0]):
        _frame(blade, w[k], v[k], work, row, frame)
        for axis in range(3):
            out[0, k, axis] = frame[0, axis]
            out[1, k, axis] = frame[1, axis]
            out[2, k, axis] = frame[2, axis]
            out[3, k, axis] = frame[6, axis]


@inner
def _gap(frame: Floats2, x: float, y: float, z: float) -> float:
    """How far a point is from a ball."""
    dx, dy, dz = x - frame[0, 0], y - frame[0, 1], z - frame[0, 2]
    return float((dx * dx + dy * dy + dz * dz) ** 0.5 - frame[6, 0])


@inner
def _slopes(frame: Floats2, x: float, y: float, z: float) -> tuple[float, float, float, float, float]:
    """First and second derivatives of the gap: by w, v, ww, wv, vv; zeros in the ball's centre."""
    dx, dy, dz = x - frame[0, 0], y - frame[0, 1], z - frame[0, 2]
    far = (dx * dx + dy * dy + dz * dz) ** 0.5
    if far < 1e-9:
        return 0.0, 0.0, 0.0, 0.0, 0.0
    m = (dx / far, dy / far, dz / far)
    mw = m[0] * frame[1, 0] + m[1] * frame[1, 1] + m[2] * frame[1, 2]
    mv = m[0] * frame[2, 0] + m[1] * frame[2, 1] + m[2] * frame[2, 2]
    e = f = g = ww = wv = vv = 0.0
    for axis in range(3):
        e += frame[1, axis] * frame[1, axis]
        f += frame[1, axis] * frame[2, axis]
        g += frame[2, axis] * frame[2, axis]
        ww += m[axis] * frame[3, axis]
        wv += m[axis] * frame[4, axis]
        vv += m[axis] * frame[5, axis]
    return (
        -mw - frame[6, 1],
        -mv - frame[6, 2],
        (e - mw * mw) / far - ww,
        (f - mw * mv) / far - wv - frame[7, 0],
        (g - mv * mv) / far - vv,
    )


@inner
def _step(
    slopes: tuple[float, float, float, float, float], w: float, v: float, low: float, high: float
) -> tuple[float, float]:
    """Return the next parameters by Newton's method, or down the slope where the gap does not curve upwards; both in
    range.

    A parameter at an end that the gap falls towards stays there.
    """
    gw, gv, ww, wv, vv = slopes
    hold_w = (w <= 0.0 and gw > 0.0) or (w >= 1.0 and gw < 0.0)
    hold_v = (v <= low and gv > 0.0) or (v >= high and gv < 0.0)
    dw = dv = 0.0
    if not hold_w and not hold_v:
        area = ww * vv - wv * wv
        if area > 0.0 and ww > 0.0:
            dw, dv = -(vv * gw - wv * gv) / area, -(ww * gv - wv * gw) / area
            # Where that leaves the range, the least on its edge is the next: the parameters are skew, so that it would
            # be no step down to cut off one of them alone.
            if w + dw < 0.0 or w + dw > 1.0:
                dw = min(max(dw, -w), 1.0 - w)
                dv = -(gv + wv * dw) / vv
            if v + dv < low or v + dv > high:
                dv = min(max(dv, low - v), high - v)
                dw = -(gw + wv * dv) / ww
        else:
            dw, dv = -gw / (abs(ww) + 1e-12), -gv / (abs(vv) + 1e-12)
    elif not hold_w:
        dw = -gw / (abs(ww) + 1e-12)
    elif not hold_v:
        dv = -gv / (abs(vv) + 1e-12)
    return min(max(w + dw, 0.0), 1.0), min(max(v + dv, low), high)


@kernel(writes="grid bounds")
def blade_samples(blade: BladeData, grid: Floats2, bounds: Floats2) -> None:
    """Write centres and radii of the balls at places of a blade to ``grid``, (_ALONG · _ACROSS, 4).

    Also to ``bounds``, (blocks, 4), a ball for each block of places that holds all of theirs.
    """
    work, row, frame = np.empty((3, 4, 4)), np.empty((6, 3)), np.empty((8, 3))
    for n in range(_ALONG * _ACROSS):
        v = blade.low + (n % _ACROSS) * (blade.high - blade.low) / (_ACROSS - 1)
        _frame(blade, (n // _ACROSS) / (_ALONG - 1), v, work, row, frame)
        for axis in range(3):
            grid[n, axis] = frame[0, axis]
        grid[n, 3] = frame[6, 0]
    for block in range(bounds.shape[0]):
        first, second = (block // _BLOCKS_ACROSS) * _BLOCK, (block % _BLOCKS_ACROSS) * _BLOCK
        last, end = min(first + _BLOCK, _ALONG), min(second + _BLOCK, _ACROSS)
        middle = (first + last - 1) // 2 * _ACROSS + (second + end - 1) // 2
        for axis in range(3):
            bounds[block, axis] = grid[middle, axis]
        bounds[block, 3] = 0.0
        for i in range(first, last):
            for j in range(second, end):
                n = i * _ACROSS + j
                bounds[block, 3] = max(bounds[block, 3], _far(grid, n, grid[middle]) + 2.0 * grid[n, 3])


@inner
def _far(balls: Floats2, n: int, point: Floats) -> float:
    """How far a point is from a ball."""
    dx, dy, dz = point[0] - balls[n, 0], point[1] - balls[n, 1], point[2] - balls[n, 2]
    return float((dx * dx + dy * dy + dz * dz) ** 0.5 - balls[n, 3])


@inner
def _nearest(samples: Samples, point: Floats, place: int) -> int:
    """Return the place whose ball is nearest to a point; one that may be it is given.

    A block whose balls cannot be as near as one that is found already is left out.
    """
    best = _far(samples.grid, place, point)
    for block in range(samples.bounds.shape[0]):
        if _far(samples.bounds, block, point) > best:
            continue
        first, second = (block // _BLOCKS_ACROSS) * _BLOCK, (block % _BLOCKS_ACROSS) * _BLOCK
        for i in range(first, min(first + _BLOCK, _ALONG)):
            for j in range(second, min(second + _BLOCK, _ACROSS)):
                n = i * _ACROSS + j
                gap = _far(samples.grid, n, point)
                if gap < best or (gap == best and n < place):
                    best, place = gap, n
    return place


@inner
def _may_be_nearer(samples: Samples, point: Floats, known: float) -> bool:
    """Whether a ball of the blade may be nearer to a point than so many mm."""
    nearest = np.inf
    for block in range(samples.bounds.shape[0]):
        nearest = min(nearest, _far(samples.bounds, block, point))
    return bool(nearest - samples.reach <= known)


@kernel(writes="found at")
def blade_distances(blade: BladeData, samples: Samples, points: Floats2, found: Floats, at: Floats2) -> None:
    """Write the distance of points (k, 3) to the blade, and w, v of the nearest ball (k, 2).

    Where ``found`` is less than the distance, both stay as they are.
    """
    work, row = np.empty((3, 4, 4)), np.empty((6, 3))
    frame = np.empty((8, 3))
    place = 0
    for k in range(points.shape[0]):
        if not _may_be_nearer(samples, points[k], found[k]):
            continue
        x, y, z = points[k, 0], points[k, 1], points[k, 2]
        place = _nearest(samples, points[k], place)
        w = (place // _ACROSS) / (_ALONG - 1)
        v = blade.low + (place % _ACROSS) * (blade.high - blade.low) / (_ACROSS - 1)
        _frame(blade, w, v, work, row, frame)
        gap = _gap(frame, x, y, z)
        for _ in range(_STEPS):
            next_w, next_v = _step(_slopes(frame, x, y, z), w, v, blade.low, blade.high)
            dw, dv = next_w - w, next_v - v
            for _ in range(_HALVINGS):
                _frame(blade, w + dw, v + dv, work, row, frame)
                tried = _gap(frame, x, y, z)
                if tried <= gap:
                    break
                dw, dv = 0.5 * dw, 0.5 * dv
            if tried > gap:
                break
            w, v, gap = w + dw, v + dv, tried
            if abs(dw) + abs(dv) < _SMALL:
                break
        if gap <= found[k]:
            found[k], at[k, 0], at[k, 1] = gap, w, v
