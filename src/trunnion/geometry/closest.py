"""The point of a curve that is nearest to a given one."""

import math
from functools import lru_cache
from typing import Any, Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints, distinct
from trunnion.extras import import_extra
from trunnion.geometry.curves import BSplineCurve

#: Samples in a knot interval at least, and on the whole curve if that leaves more to each: the nearest of them begins
#: the search.
_SAMPLES: Final = 4
_ALL_SAMPLES: Final = 1200

#: Newton's method doubles the digits in a step; where it does not help, halving ends as near.
_STEPS: Final = 60

_CLOSE: Final = 1e-12

#: So many of the nearest samples tell whether another stretch of the curve is as near.
_NEIGHBOURS: Final = 8


def closest_parameters(curve: BSplineCurve, points: Floats) -> Floats:
    """Parameters (m,) of the points of a curve that are nearest to points (m, 3).

    The nearest of dense samples begins the search. Where another stretch of the curve has a sample that is nearly as
    near, that one is searched too: the point of the curve that is nearest may be there.
    """
    at, reach, tree = _samples(curve)
    apart, nearest = tree.query(points, min(_NEIGHBOURS, len(at)))
    found = _nearest_about(curve, points, at, nearest[:, 0])
    off = np.linalg.norm(curve.points(found) - points, axis=1)
    rows, other = _other_stretches(nearest, apart - reach < off[:, None])
    if len(rows):
        tried = _nearest_about(curve, points[rows], at, other)
        nearer = np.linalg.norm(curve.points(tried) - points[rows], axis=1) < off[rows]
        found[rows[nearer]] = tried[nearer]
    return found


def _other_stretches(nearest: Ints, near: Flags) -> tuple[Ints, Ints]:
    """Points, and for each the nearest of its samples that is no neighbour of a nearer one; points that have one."""
    alone = near.copy()
    alone[:, 0] = False
    for k in range(1, nearest.shape[1]):
        alone[:, k] &= (np.abs(nearest[:, :k] - nearest[:, k : k + 1]) > 1).all(axis=1)
    rows = np.flatnonzero(alone.any(axis=1))
    return rows, nearest[rows, alone[rows].argmax(axis=1)]


def _nearest_about(curve: BSplineCurve, points: Floats, at: Floats, nearest: Ints) -> Floats:
    """Parameters (m,) of the nearest points between the neighbours of samples (m,).

    Newton's method on the derivative of the squared distance, and halving of the interval where a step would leave it.
    """
    low, high = at[np.maximum(nearest - 1, 0)], at[np.minimum(nearest + 1, len(at) - 1)]
    found = at[nearest]
    open_ = np.arange(len(points))
    for _ in range(_STEPS):
        before = found[open_]
        position, first, second = curve.derivatives(before, 2)
        away = position - points[open_]
        slope = np.einsum("ij,ij->i", away, first)
        bend = np.einsum("ij,ij->i", first, first) + np.einsum("ij,ij->i", away, second)
        low[open_] = np.where(slope < 0.0, before, low[open_])
        high[open_] = np.where(slope > 0.0, before, high[open_])
        with np.errstate(divide="ignore", invalid="ignore"):
            step = before - slope / bend
        inside = (bend > 0.0) & (step >= low[open_]) & (step <= high[open_])
        following = np.where(inside, step, (low[open_] + high[open_]) / 2.0)
        found[open_] = np.where(slope == 0.0, before, following)
        open_ = open_[np.abs(found[open_] - before) >= _CLOSE]
        if not len(open_):
            break
    return np.asarray(found)


@lru_cache(maxsize=8)
def _samples(curve: BSplineCurve) -> tuple[Floats, float, Any]:
    """Parameters of dense samples of a curve, how far it goes between two of them, and a tree of the samples.

    Hub and shroud are asked again and again.
    """
    knots = distinct(curve.knots)
    spans = curve.lengths(knots)
    # In long spans there are more of them, so that none are much farther apart than others.
    each = max(_SAMPLES, math.ceil(_ALL_SAMPLES / len(spans)))
    counts = np.maximum(each, np.ceil(each * spans / max(float(spans.mean()), 1e-300))).astype(int)
    parts = [
        np.linspace(low, high, count, endpoint=False)
        for low, high, count in zip(knots[:-1].tolist(), knots[1:].tolist(), counts.tolist(), strict=True)
    ]
    at = np.append(np.concatenate(parts), 1.0)
    reach = float(curve.lengths(at).max()) / 2.0
    return at, reach, import_extra("scipy.spatial", "geometry").cKDTree(curve.points(at))
