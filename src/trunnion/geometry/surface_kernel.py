"""Points and derivatives of tensor-product B-spline surfaces.

Basis functions follow Cox and de Boor's recursion, their derivatives that of the next lower degree (Piegl and Tiller,
The NURBS Book, equations 2.5 and 2.9). Beyond the parameters 0 to 1 the surface goes on straight.
"""

from typing import Final, NamedTuple

import numpy as np

from trunnion.arrays import Floats, Floats2, Floats3
from trunnion.jit import inner, kernel

_HIGHEST: Final = 3


class SurfaceData(NamedTuple):
    """A surface: knots, degree along v, and control points (n, m, 3)."""

    u_knots: Floats
    v_knots: Floats
    degree: int
    control: Floats3


@inner
def _basis(knots: Floats, degree: int, count: int, at: float, table: Floats2, out: Floats2) -> int:
    """Write the basis functions that are not 0 at a parameter, and their first two derivatives, to ``out`` (3, 4).

    ``table`` (4, 4) is scratch. Returns the first of them.
    """
    low, high = degree, count
    while high - low > 1:
        middle = (low + high) // 2
        if at < knots[middle]:
            high = middle
        else:
            low = middle
    span = low
    table[0, 0] = 1.0
    for d in range(1, degree + 1):
        for j in range(d + 1):
            i = span - d + j
            value = 0.0
            if j > 0:
                width = knots[i + d] - knots[i]
                value += (at - knots[i]) / width * table[d - 1, j - 1]
            if j < d:
                width = knots[i + d + 1] - knots[i + 1]
                value += (knots[i + d + 1] - at) / width * table[d - 1, j]
            table[d, j] = value
    for j in range(degree + 1):
        out[0, j] = table[degree, j]
        out[1, j] = _slope(knots, degree, span, j, table)
        out[2, j] = 0.0
        if degree >= 2:
            i = span - degree + j
            if j > 0:
                out[2, j] += degree * _slope(knots, degree - 1, span, j - 1, table) / (knots[i + degree] - knots[i])
            if j < degree:
                out[2, j] -= degree * _slope(knots, degree - 1, span, j, table) / (knots[i + degree + 1] - knots[i + 1])
    return span - degree


@inner
def _slope(knots: Floats, degree: int, span: int, j: int, table: Floats2) -> float:
    """Return the derivative of the basis function ``j`` of a degree."""
    i = span - degree + j
    value = 0.0
    if j > 0:
        value += table[degree - 1, j - 1] / (knots[i + degree] - knots[i])
    if j < degree:
        value -= table[degree - 1, j] / (knots[i + degree + 1] - knots[i + 1])
    return degree * value


@inner
def surface_row(surface: SurfaceData, u: float, v: float, work: Floats3, out: Floats2) -> None:
    """Write S, Su, Sv, Suu, Suv and Svv at a parameter to ``out`` (6, 3); ``work`` (4, 4, 4) is scratch."""
    u_inside = min(max(u, 0.0), 1.0)
    v_inside = min(max(v, 0.0), 1.0)
    u_basis, v_basis = work[1], work[2]
    first = _basis(surface.u_knots, _HIGHEST, surface.control.shape[0], u_inside, work[0], u_basis)
    second = _basis(surface.v_knots, surface.degree, surface.control.shape[1], v_inside, work[0], v_basis)
    for axis in range(3):
        for k in range(6):
            out[k, axis] = 0.0
        for i in range(_HIGHEST + 1):
            value = slope = bend = 0.0
            for j in range(surface.degree + 1):
                point = surface.control[first + i, second + j, axis]
                value += v_basis[0, j] * point
                slope += v_basis[1, j] * point
                bend += v_basis[2, j] * point
            out[0, axis] += u_basis[0, i] * value
            out[1, axis] += u_basis[1, i] * value
            out[2, axis] += u_basis[0, i] * slope
            out[3, axis] += u_basis[2, i] * value
            out[4, axis] += u_basis[1, i] * slope
            out[5, axis] += u_basis[0, i] * bend
            out[3, axis] += (v - v_inside) * u_basis[2, i] * slope
            out[5, axis] += (u - u_inside) * u_basis[1, i] * bend
        _go_on(out, axis, u - u_inside, v - v_inside)


@inner
def _go_on(out: Floats2, axis: int, du: float, dv: float) -> None:
    """Continue a surface beyond its edges, linear in u and in v there; the second derivatives along them are."""
    out[0, axis] += du * out[1, axis] + dv * out[2, axis] + du * dv * out[4, axis]
    out[1, axis] += dv * out[4, axis]
    out[2, axis] += du * out[4, axis]
    if du != 0.0:
        out[3, axis] = 0.0
    if dv != 0.0:
        out[5, axis] = 0.0


@kernel(writes="out")
def surface_points(surface: SurfaceData, u: Floats, v: Floats, out: Floats3) -> None:
    """Write S, Su, Sv, Suu, Suv and Svv at parameters (k,) to ``out`` (6, k, 3)."""
    work = np.empty((3, 4, 4))
    row = np.empty((6, 3))
    for k in range(u.shape[0]):
        surface_row(surface, u[k], v[k], work, row)
        for d in range(6):
            for axis in range(3):
                out[d, k, axis] = row[d, axis]
