"""Rotations about the axes of a frame, as matrices (3, 3); right-handed, degrees."""

import numpy as np

from trunnion.arrays import Floats


def about_z(degrees: float) -> Floats:
    """(3, 3): turns vectors about Z, right-handed; exact for quarters of a turn."""
    cos, sin = _cos_sin(degrees)
    return np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]])


def about_x(degrees: float) -> Floats:
    """(3, 3): turns vectors about X, right-handed; exact for quarters of a turn."""
    cos, sin = _cos_sin(degrees)
    return np.array([[1.0, 0.0, 0.0], [0.0, cos, -sin], [0.0, sin, cos]])


def _cos_sin(degrees: float) -> tuple[float, float]:
    """Cosine and sine; exact for quarters of a turn."""
    quarter = round(degrees / 90.0)
    angle = np.radians(degrees - 90.0 * quarter)
    cos, sin = float(np.cos(angle)), float(np.sin(angle))
    for _ in range(quarter % 4):
        cos, sin = -sin, cos
    return cos, sin
