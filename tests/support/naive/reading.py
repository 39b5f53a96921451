"""Reference implementations of the readers' kernels."""

import numpy as np

from trunnion.arrays import Floats


def angle_reached(held: float, value: float | None, turn_rule: str, lowest: float = 0.0) -> float:
    """Where a rotary axis stands after a word, found among all turns."""
    if value is None:
        return held
    if turn_rule == "plain":
        return value
    turns = [value + 360.0 * k for k in range(-200, 201)]
    if turn_rule == "shortest":
        return min(turns, key=lambda angle: (abs(angle - held), -angle))
    if turn_rule == "positive":
        return min(angle for angle in turns if angle >= held - 1e-9)
    if turn_rule == "negative":
        return max(angle for angle in turns if angle <= held + 1e-9)
    first = lowest + 360.0 * np.floor((held - lowest) / 360.0)
    return next(angle for angle in turns if first - 1e-9 <= angle < first + 360.0 - 1e-9)


def point_on_circle(start: Floats, end: Floats, centre: Floats, normal: Floats, turns: int, fraction: float) -> Floats:
    """A point of a circle or helix, in a frame at its centre."""
    x = start - centre - np.dot(start - centre, normal) * normal
    first = np.linalg.norm(x)
    x = x / first
    y = np.cross(normal, x)
    last = end - centre
    angle = np.arctan2(np.dot(last, y), np.dot(last, x)) % (2.0 * np.pi)
    if angle < 1e-9 or 2.0 * np.pi - angle < 1e-9:
        angle = 2.0 * np.pi
    angle = (angle + 2.0 * np.pi * turns) * fraction
    height = np.dot(start - centre, normal) + fraction * np.dot(end - start, normal)
    size = first + fraction * (np.linalg.norm(last - np.dot(last, normal) * normal) - first)
    return np.asarray(centre + size * (np.cos(angle) * x + np.sin(angle) * y) + height * normal)
