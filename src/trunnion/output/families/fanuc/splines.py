"""Splines of a Fanuc: G06.2 with the knots and weights of its control points."""

from dataclasses import replace
from typing import Final

import numpy as np

from trunnion.arrays import distinct
from trunnion.controls.family_writer import Formats
from trunnion.controls.words import NumberFormat
from trunnion.model.splines import Spline
from trunnion.output.shared.splines import printed

#: Orders that P names: one more than the degree.
_ORDERS: Final = range(2, 5)

#: The control counts knots and weights in its least increment. Knots go from 0 to this: seven decimals of 1.
_DECIMALS: Final = 3
_LAST_KNOT: Final = 10000.0
_GREATEST_WEIGHT: Final = 999999.0
_EXACT: Final = 1e-9


def takes_spline(spline: Spline) -> bool:
    """Return whether its order, knots and weights can be said: all that is printed of the weights is exact."""
    if spline.degree + 1 not in _ORDERS:
        return False
    counts = np.rint(_scaled_knots(spline) * 10**_DECIMALS)
    first, last = counts[: spline.degree + 1], counts[-spline.degree - 1 :]
    inner = counts[spline.degree + 1 : -spline.degree - 1]
    _, repeats = np.unique(inner, return_counts=True)
    clamped = bool((first == first[0]).all() and (last == last[0]).all())
    apart = bool(((inner > first[0]) & (inner < last[0])).all()) and repeats.max(initial=0) <= spline.degree
    as_many = len(distinct(counts)) == len(distinct(spline.knots))
    weights = spline.weights * 10**_DECIMALS
    exact = bool((np.abs(weights - np.rint(weights)) < _EXACT).all() and (weights >= 1.0).all())
    return clamped and apart and as_many and exact and float(spline.weights.max()) <= _GREATEST_WEIGHT


def spline_lines(spline: Spline, formats: Formats) -> list[str]:
    """Return a block for each control point, the first of which is the start, and one for each knot behind them.

    The start must be where the tool stands, so control points are printed as coordinates are. G1 ends the mode, in
    which no other command may stand.
    """
    number = formats["coordinate"]
    plain = replace(number, decimals=_DECIMALS, unit=1.0, zero="")
    knots = [f"K{plain.text(value)}" for value in _scaled_knots(spline).tolist()]
    lines = []
    for knot, pole, weight in zip(knots, spline.poles.tolist(), spline.weights.tolist(), strict=False):
        words = [knot, *(f"{axis}{printed(number, value, axis)}" for axis, value in zip("XYZ", pole, strict=True))]
        lines.append(" ".join([*words, *_weight(plain, weight, spline)]))
    return [f"G06.2 P{spline.degree + 1} {lines[0]}", *lines[1:], *knots[len(lines) :], "G1"]


def _weight(number: NumberFormat, weight: float, spline: Spline) -> list[str]:
    return [f"R{number.text(weight)}"] if spline.is_rational else []


def _scaled_knots(spline: Spline) -> np.ndarray:
    """Return the knots from 0 to ``_LAST_KNOT``: the curve does not depend on where they begin and how far apart they
    are.
    """
    first, last = spline.knots[0], spline.knots[-1]
    return np.asarray((spline.knots - first) / (last - first) * _LAST_KNOT)
