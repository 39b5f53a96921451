"""Points of B-splines by the recursion of Cox and de Boor as books print it."""

from collections.abc import Iterable, Sequence

import numpy as np
from hypothesis import strategies as st

from trunnion.arrays import Floats
from trunnion.model.splines import Spline


def share(full: Sequence[float], i: int, degree: int, at: float) -> float:
    """The part of a control point at a place of the curve."""
    if degree == 0:
        return float(full[i] <= at < full[i + 1] or (at == full[-1] and full[i] < at == full[i + 1]))
    first = second = 0.0
    if full[i + degree] > full[i]:
        first = (at - full[i]) / (full[i + degree] - full[i]) * share(full, i, degree - 1, at)
    if full[i + degree + 1] > full[i + 1]:
        rest = (full[i + degree + 1] - at) / (full[i + degree + 1] - full[i + 1])
        second = rest * share(full, i + 1, degree - 1, at)
    return first + second


def points_of(spline: Spline, places: Iterable[float]) -> Floats:
    """Points (k, 3) of a spline at parameters."""
    full, n = spline.knots.tolist(), len(spline.poles)
    shares = np.array([[share(full, i, spline.degree, at) for i in range(n)] for at in places]) * spline.weights
    return np.asarray(shares @ spline.poles / shares.sum(axis=1, keepdims=True))


@st.composite
def splines(
    draw: st.DrawFn, degrees: Sequence[int] = (2, 3, 4, 5), weights: Sequence[float] = (1.0,), repeats: int = 2
) -> Spline:
    """Splines that begin and end in their first and last control points, with inner knots up to ``repeats`` times."""
    degree = draw(st.sampled_from(degrees))
    inner = draw(st.lists(st.integers(1, 999), max_size=4, unique=True))
    counts = draw(st.lists(st.integers(1, repeats), min_size=4, max_size=4))
    inside = [knot / 1000 for knot, count in zip(sorted(inner), counts, strict=False) for _ in range(count)]
    knots = np.array([*[0.0] * (degree + 1), *inside, *[1.0] * (degree + 1)])
    n = len(knots) - degree - 1
    numbers = st.integers(-400_000, 400_000).map(lambda number: number / 1e4)
    poles = draw(st.lists(st.tuples(numbers, numbers, numbers), min_size=n, max_size=n))
    chosen = draw(st.lists(st.sampled_from(weights), min_size=n, max_size=n))
    return Spline(degree, knots, np.array(poles), np.array(chosen))
