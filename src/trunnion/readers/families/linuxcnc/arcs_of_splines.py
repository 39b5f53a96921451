"""The arcs that LinuxCNC runs in place of a spline: how far they are from it.

Its task (``NURBS_FEED`` of ``emccanon.cc``, 2.9) divides a curve evenly into four pieces for each control point, and
runs each as two arcs that touch each other, with the curve's points and directions at both ends of the piece. Both
leave these ends along tangents of one length.
"""

from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.model.splines import Spline
from trunnion.readers.control.splines import at_parameters

#: Pieces for each control point.
PIECES: Final = 4

#: Places within each piece at which curve and arcs are compared.
_LOOKS: Final = 32

#: Points and directions count in X and Y.
_PLANE: Final = slice(0, 2)


def arcs_beside(spline: Spline) -> float:
    """How far the arcs are from a spline in the plane at most, mm."""
    pieces = PIECES * len(spline.poles)
    begin, end = float(spline.knots[spline.degree]), float(spline.knots[len(spline.poles)])
    at = np.linspace(begin, end, pieces * _LOOKS + 1)
    points, directions = (each[:, _PLANE] for each in at_parameters(spline, at))
    ends, along = points[::_LOOKS], directions[::_LOOKS]
    within = np.stack([points[k : k + pieces * _LOOKS : _LOOKS] for k in range(1, _LOOKS)], axis=1)
    joints, turned = _joints(ends[:-1], along[:-1], ends[1:], along[1:])
    first = _beside_arc(within, ends[:-1], along[:-1], joints)
    second = _beside_arc(within, joints, turned, ends[1:])
    in_first = np.einsum("ijk,ik->ij", within - joints[:, None], turned) <= 0.0
    return float(np.where(in_first, first, second).max(initial=0.0))


def _joints(begin: Floats, leaves: Floats, end: Floats, arrives: Floats) -> tuple[Floats, Floats]:
    """Return where the two arcs of each piece touch, and their direction there, (n, 2) each.

    The tangents of length t lead to two points that are 2 t apart: the joint is between them.
    """
    chord = end - begin
    both = leaves + arrives
    square = 2.0 * (1.0 - np.einsum("ij,ij->i", leaves, arrives))
    half = np.einsum("ij,ij->i", chord, both)
    size = np.einsum("ij,ij->i", chord, chord)
    # The positive root of square t² + 2 half t = size, in the form that a straight piece leaves finite.
    root = half + np.sqrt(half**2 + square * size)
    length = np.where(root > 0.0, size / np.where(root > 0.0, root, 1.0), 0.0)[:, None]
    near, far = begin + length * leaves, end - length * arrives
    between = far - near
    norm = np.linalg.norm(between, axis=1)[:, None]
    return 0.5 * (near + far), np.where(norm > 0.0, between / np.where(norm > 0.0, norm, 1.0), leaves)


def _beside_arc(points: Floats, begin: Floats, leaves: Floats, end: Floats) -> Floats:
    """How far points (n, k, 2) are from the circles that leave ``begin`` in a direction and go through ``end``.

    The distance from a circle in the form that a straight line, whose curvature is 0, leaves finite.
    """
    normal = np.stack([-leaves[:, 1], leaves[:, 0]], axis=1)
    chord = end - begin
    bend = 2.0 * np.einsum("ij,ij->i", chord, normal) / np.maximum(np.einsum("ij,ij->i", chord, chord), 1e-300)
    arm = points - begin[:, None]
    across = np.einsum("ijk,ik->ij", arm, normal)
    power = bend[:, None] * np.einsum("ijk,ijk->ij", arm, arm) - 2.0 * across
    return np.asarray(np.abs(power) / (1.0 + np.sqrt(np.maximum(1.0 + bend[:, None] * power, 0.0))))
