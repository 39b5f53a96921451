"""Splines of a Sinumerik: POLY, a block for each polynomial.

BSPLINE is not written: its manuals do not say to which control point an interval of PL belongs, and two systems that
write it differ.
"""

from typing import Final

import numpy as np

from trunnion.controls.family_writer import Formats
from trunnion.model.splines import Spline
from trunnion.output.shared.splines import bezier_points, finer_format, printed

#: The highest degree that every Sinumerik with POLY has.
_MOST: Final = 3

#: Decimals of an end more than coordinates have, so that rounded ends do not bend the path; and of coefficients.
_FINER: Final = 2


def takes_spline(spline: Spline) -> bool:
    """Return whether its spans are polynomials: the manual contradicts itself about those of a denominator."""
    return spline.degree in (2, _MOST) and not spline.is_rational


def spline_lines(spline: Spline, formats: Formats) -> list[str]:
    """Return a block for each span: the end of each axis, and its coefficients of the parameter's square and cube.

    The parameter goes from 0 to 1, as it does without PL. Its coefficient itself follows from start and end.
    """
    number = finer_format(formats["coordinate"], _FINER)
    points = bezier_points(spline)[:, :, :3] / spline.weights[0]
    if spline.degree == 2:
        square = points[:, 0] - 2.0 * points[:, 1] + points[:, 2]
        columns = [points[:, 2], square]
    else:
        square = 3.0 * (points[:, 0] - 2.0 * points[:, 1] + points[:, 2])
        cube = points[:, 3] - points[:, 0] + 3.0 * (points[:, 1] - points[:, 2])
        columns = [points[:, 3], square, cube]
    lines = []
    for span in np.stack(columns, axis=2).tolist():
        axes = zip("XYZ", span, strict=True)
        words = [f"PO[{axis}]=({','.join(printed(number, v, f'PO[{axis}]') for v in row)})" for axis, row in axes]
        lines.append(" ".join(words))
    return [f"POLY {lines[0]}", *lines[1:]]
