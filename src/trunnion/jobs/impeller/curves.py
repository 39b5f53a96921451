"""Curves through measured points."""

import math
from collections.abc import Iterable, Sequence
from typing import TypeAlias, TypedDict, Unpack

import numpy as np
from numpy.typing import ArrayLike

from trunnion.arrays import Floats
from trunnion.files import atomic_file
from trunnion.geometry.ends import Ends, Natural, Tangent, parse_end
from trunnion.geometry.fitting import CurveFit, Wanted, fit
from trunnion.geometry.parameters import PARAMETERIZATIONS
from trunnion.geometry.point_tables import PointTable, read_point_table, scaled
from trunnion.jobs.arguments import taken
from trunnion.jobs.inputs.arguments import check_choice, check_path, wrong_argument
from trunnion.jobs.inputs.reading import FilePath
from trunnion.jobs.result_output import declared_output
from trunnion.messages import LIBRARY, Words, phrase
from trunnion.reporting.curve_picture import curve_picture
from trunnion.reporting.page_words import in_language

EndLike: TypeAlias = str | Natural | Tangent


def read_points(points: FilePath, *, scale: float = 1.0) -> tuple[PointTable, ...]:
    """Read the curves of a table of measured points.

    Parameters
    ----------
    points
        The table (docs/curves.md says what it may look like).
    scale
        Points are multiplied by it.

    Returns
    -------
    tuple of PointTable
        In the order of their columns, mm.

    Raises
    ------
    InputError
        If the file cannot be read or is no such table; with every mistake and its line.

    Examples
    --------
    >>> import trunnion
    >>> tip, hub = trunnion.read_points("examples/impeller/blade_points.csv", scale=0.75)
    >>> tip.name, tip.points.shape
    ('tip', (20, 3))
    """
    factor = _positive("scale", scale)
    tables = read_point_table(check_path("points", points))
    return tuple(scaled(table, factor) for table in tables)


class CurveArguments(TypedDict, total=False):
    """Arguments of ``trunnion.fit_curve``."""

    start: EndLike
    end: EndLike
    parameterization: str
    tolerance: float | None
    fair: float | None
    weights: Sequence[float] | None


def fit_curve(points: PointTable | ArrayLike, **given: Unpack[CurveArguments]) -> CurveFit:
    """Fit a cubic B-spline curve to points.

    Parameters
    ----------
    points
        A table of ``trunnion.read_points``, or an array (n, 3), mm.
    start, end
        ``natural``: no curvature; ``tangent:X,Y,Z``: a direction; ``derivative:X,Y,Z``: by the parameter, from 0 to 1.
    parameterization
        ``chord-length`` or ``centripetal``.
    tolerance
        mm: the curve passes the points within it, with few control points, and ends in the first and the last. None: it
        goes through them all.
    fair
        mm: points may first be moved by as much, so that the curve bends evenly.
    weights
        One above 0 for each point: the curve is rational (NURBS).

    Returns
    -------
    CurveFit
        The curve, how far it is off at each point and between, and remarks.

    Raises
    ------
    InputError
        If points are the same, too few or not finite, or arguments contradict each other.

    Notes
    -----
    Parameters and ends are those of Piegl and Tiller, The NURBS Book, section 9.2; with few control points, of 9.4.

    Examples
    --------
    >>> import trunnion
    >>> tip, hub = trunnion.read_points("examples/impeller/blade_points.csv")
    >>> fitted = trunnion.fit_curve(tip)
    >>> fitted.curve.control_points.shape, bool(fitted.offsets.max() < 1e-9)
    ((22, 3), True)
    """
    table = points if isinstance(points, PointTable) else _as_table(points)
    found = taken(CurveArguments, "curve", given)
    tolerance, fair, weights = found["tolerance"], found["fair"], found["weights"]
    wanted = Wanted(
        Ends(parse_end("start", found["start"]), parse_end("end", found["end"])),
        check_choice("parameterization", found["parameterization"], PARAMETERIZATIONS),
        None if tolerance is None else _positive("tolerance", tolerance),
        None if fair is None else _positive("fair", fair),
    )
    return fit(table, wanted, None if weights is None else _numbers("weights", weights, 1))


def write_curve_picture(
    fits: Sequence[CurveFit], picture: FilePath, *, inputs: Iterable[FilePath] = (), words: Words = LIBRARY
) -> None:
    """Draw curves with their curvature combs.

    Parameters
    ----------
    fits
        Of ``trunnion.fit_curve``.
    picture
        The file, ``.svg``. An older one is replaced when the new one is complete.
    inputs
        Files that are not written over.
    words
        The language of who reads it.

    Raises
    ------
    InputError
        When the name ends otherwise, the file cannot be written, or it is one of the inputs.
    """
    with atomic_file(declared_output("curve", "picture", picture), inputs=inputs) as sink, in_language(words):
        sink.write(curve_picture(fits).encode())


def _as_table(points: ArrayLike) -> PointTable:
    array = _numbers("points", points, 2)
    if array.shape[1] != 3:
        raise wrong_argument("points", array.shape, phrase("give_points"))
    return PointTable("points", "", array, range(1, len(array) + 1))


def _numbers(name: str, values: ArrayLike, dimensions: int) -> Floats:
    try:
        array = np.array(values, float)
    except (TypeError, ValueError):
        raise wrong_argument(name, values, phrase("give_numbers")) from None
    if array.ndim != dimensions or not np.isfinite(array).all():
        raise wrong_argument(name, values, phrase("give_finite", dimensions=dimensions))
    return array


def _positive(name: str, value: object) -> float:
    if isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value) and value > 0.0:
        return float(value)
    raise wrong_argument(name, value, phrase("give_positive"))
