"""Splines for writers: the polynomial of each span by its Bezier points."""

import numpy as np

from trunnion.arrays import Floats
from trunnion.controls.family_writer import Formats
from trunnion.controls.words import NumberFormat, WordRangeError
from trunnion.messages import Wording
from trunnion.model.splines import Spline


def bezier_points(spline: Spline) -> Floats:
    """(s, degree + 1, 4): the Bezier points of each span, x w, y w, z w in mm, and the weight w.

    Point j of a span from knot a to knot b is the blossom of its polynomial at degree - j times a and j times b.
    """
    degree, knots, spans = spline.degree, spline.knots, spline.spans
    raised = np.column_stack((spline.poles * spline.weights[:, None], spline.weights))
    points = np.empty((len(spans), degree + 1, 4))
    for j in range(degree + 1):
        row = [raised[spans - degree + i] for i in range(degree + 1)]
        for level in range(1, degree + 1):
            at = knots[spans] if level <= degree - j else knots[spans + 1]
            for i in range(degree, level - 1, -1):
                low, high = knots[spans - degree + i], knots[spans + 1 + i - level]
                share = ((at - low) / (high - low))[:, None]
                row[i] = (1.0 - share) * row[i - 1] + share * row[i]
        points[:, j] = row[degree]
    return points


def takes_spline(spline: Spline) -> bool:
    """Return that a control has no words for splines."""
    return False


def spline_lines(spline: Spline, formats: Formats) -> list[str]:
    """Return nothing: such a control gets no splines."""
    raise AssertionError("the planner has made lines of all splines")


def finer_format(number: NumberFormat, digits: int) -> NumberFormat:
    """Return a number format with more decimals."""
    return NumberFormat(
        number.decimals + digits, number.point, number.leading_zero, number.trailing_zeros, number.plus, number.zero,
        number.least, number.greatest, number.unit,
    )  # fmt: skip


def printed(number: NumberFormat, value: float, name: str) -> str:
    """Return a number of a line; ``name`` is what it is. Raises ``WordRangeError`` beyond the limits of its format."""
    shown = number.rounded(value) / number.unit
    if not number.least / number.unit <= shown <= number.greatest / number.unit:
        limit = number.greatest if shown > 0.0 else number.least
        wording = Wording("CTL110", "number_beyond_format", name=name, value=shown, limit=limit / number.unit)
        raise WordRangeError(wording)
    return number.text(value)
