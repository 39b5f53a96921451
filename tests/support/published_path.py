"""The five-axis path of Ma, Yuan, Shen, Gao (JCDE 9, 2022, 2355-2374) and its limits, with exact derivatives.

Derivatives come from truncated power series, through the inverse kinematics of a table-table machine, A under C.
"""

import numpy as np

from trunnion.arrays import Flags, Floats
from trunnion.extras import import_extra
from trunnion.timing import AxisDynamics, SmoothPath

_BREAKS = np.array([0.0, 0.2, 0.4, 0.6, 0.8, 1.0])
_TIP = [(5, 0, 0), (-10, 20, 0), (10, 20, 0), (20, 30, 0), (30, 30, 0), (40, 30, 0), (50, 20, 0), (55, 0, 0)]
_AXIS_POINT = [
    (0, 0, 15), (-15, 20, 15), (5, 25, 15), (15, 35, 15), (30, 35, 15), (45, 35, 15), (55, 25, 15), (60, 0, 15),
]  # fmt: skip

#: X Y Z in mm, A C in radians.
LIMITS = AxisDynamics(
    np.array([100.0, 100.0, 100.0, 0.4, 0.8]),
    np.array([500.0, 500.0, 500.0, 0.5, 0.5]),
    np.array([3000.0, 3000.0, 3000.0, 1.5, 1.5]),
)

#: A power series: (4, n), coefficients of the powers 0 to 3.
Series = Floats


def _product(a: Series, b: Series) -> Series:
    return np.stack([sum(a[i] * b[k - i] for i in range(k + 1)) for k in range(len(a))])


def _quotient(a: Series, b: Series) -> Series:
    found: list[Floats] = []
    for k in range(len(a)):
        found.append((a[k] - sum((b[i] * found[k - i] for i in range(1, k + 1)), start=0.0)) / b[0])
    return np.stack(found)


def _root(a: Series) -> Series:
    found = [np.sqrt(a[0])]
    for k in range(1, len(a)):
        found.append((a[k] - sum((found[i] * found[k - i] for i in range(1, k)), start=0.0)) / (2.0 * found[0]))
    return np.stack(found)


def _angle(y: Series, x: Series) -> Series:
    powers = np.arange(1.0, len(x))[:, None]
    rate = _quotient(
        _product(x[:-1], powers * y[1:]) - _product(y[:-1], powers * x[1:]),
        _product(x[:-1], x[:-1]) + _product(y[:-1], y[:-1]),
    )
    return np.concatenate((np.arctan2(y[:1], x[:1]), rate / powers))


def _sine_cosine(a: Series) -> tuple[Series, Series]:
    sine, cosine = [np.sin(a[0])], [np.cos(a[0])]
    for k in range(1, len(a)):
        terms = range(1, k + 1)
        up, down = (sum((i * a[i] * of[k - i] for i in terms), start=0.0) / k for of in (cosine, sine))
        sine.append(up)
        cosine.append(-down)
    return np.stack(sine), np.stack(cosine)


def _derivatives(parameter: Floats, before: Flags) -> Floats:
    knots, points = np.repeat(_BREAKS, (4, 1, 1, 1, 1, 4)), np.hstack((_TIP, _AXIS_POINT)).astype(float)
    spline = import_extra("scipy.interpolate", "geometry").BSpline(knots, points, 3)
    inner = _BREAKS[1:-1]
    span = np.where(before, np.searchsorted(inner, parameter), np.searchsorted(inner, parameter, side="right"))
    # Each span is one cubic: its Taylor series from the middle of the span.
    middle = 0.5 * (_BREAKS[span] + _BREAKS[span + 1])
    h = (parameter - middle)[:, None]
    d0, d1, d2, d3 = (spline(middle, order) for order in range(4))
    series = np.stack((
        d0 + h * (d1 + h / 2 * (d2 + h / 3 * d3)), d1 + h * (d2 + h / 2 * d3), (d2 + h * d3) / 2, d3 / 6,
    ))  # fmt: skip
    x, y, z = (series[:, :, k] for k in range(3))
    i, j, k = (series[:, :, n + 3] - series[:, :, n] for n in range(3))
    a, c = _angle(_root(_product(i, i) + _product(j, j)), k), _angle(i, j)
    sine_a, cosine_a = _sine_cosine(a)
    sine_c, cosine_c = _sine_cosine(c)
    x, y = _product(cosine_c, x) - _product(sine_c, y), _product(sine_c, x) + _product(cosine_c, y)
    y, z = _product(cosine_a, y) - _product(sine_a, z), _product(sine_a, y) + _product(cosine_a, z)
    return np.asarray(np.stack((x, y, z, a, c), axis=2) * np.array([1.0, 1.0, 2.0, 6.0])[:, None, None])


PATH = SmoothPath(_derivatives, _BREAKS)
