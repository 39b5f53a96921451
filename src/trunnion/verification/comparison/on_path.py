"""Whether a motion of one program ends on the path of a motion of the other."""

from dataclasses import dataclass

import numpy as np

from trunnion.arrays import Floats
from trunnion.verification.comparison.moving_rows import MovingRows


@dataclass(frozen=True, slots=True)
class PointTolerances:
    """How far tips may be apart, mm, and tool axes as the length of a vector."""

    tip: float
    axis: float

    @staticmethod
    def of(tip: float, degrees: float) -> "PointTolerances":
        """Return tolerances of which that of tool axes is stated in degrees."""
        return PointTolerances(tip, float(np.radians(degrees)))


def ends_on_path(more: MovingRows, i: int, less: MovingRows, j: int, tolerances: PointTolerances) -> bool:
    """Whether motion ``i`` ends on the path of the other program's motion ``j``, after its own start."""
    a, b = more.rows[i], less.rows[j]
    start, start_axis = less.start(j)
    begin, begin_axis = more.start(i)
    end, end_axis = less.run.tip[b], less.run.axis[b]
    tip, axis = more.run.tip[a], more.run.axis[a]
    circle = more.circle(i)
    if circle is not None:
        on_arc = _ends_on_circle(circle, less.circle(j), (begin, tip), (start, end), tolerances.tip)
        return on_arc and bool((np.abs(axis - start_axis) <= tolerances.axis).all())
    line = end - start
    length = float(line @ line)
    if length < tolerances.tip**2:  # only the tool axis moves: it must be on its way
        turn = end_axis - start_axis
        total = float(turn @ turn)
        part = float((axis - start_axis) @ turn) / total if total > 0.0 else 0.0
        before = float((begin_axis - start_axis) @ turn) / total if total > 0.0 else 0.0
    else:
        part, before = float((tip - start) @ line) / length, float((begin - start) @ line) / length
    if not (before - 1e-9 <= part <= 1.0 + 1e-9):
        return False
    if (np.abs(tip - (start + part * line)) > tolerances.tip).any():
        return False
    axis_there = start_axis + part * (end_axis - start_axis)
    axis_there = axis_there / np.linalg.norm(axis_there)
    return bool(np.linalg.norm(axis - axis_there) <= tolerances.axis)


def _ends_on_circle(
    circle: tuple[Floats, Floats],
    other: tuple[Floats, Floats] | None,
    motion: tuple[Floats, Floats],
    path: tuple[Floats, Floats],
    tolerance: float,
) -> bool:
    """Whether a circular motion ends on another circle; ``motion`` and ``path`` are start and end of both."""
    if other is None or circle[1] @ other[1] < 0.999:
        return False
    (begin, tip), (start, end), (centre, normal) = motion, path, other
    if (np.abs(_in_plane(circle[0] - centre, normal)) > 2.0 * tolerance).any():
        return False
    part, before = (_fraction_of_circle(other, start, point, end) for point in (tip, begin))
    if np.abs(begin - start).max() <= tolerance:
        before = 0.0
    rise = float((tip - start - part * (end - start)) @ normal)
    return 1e-9 < part < 1.0 and before < part and abs(rise) <= 2.0 * tolerance


def _fraction_of_circle(circle: tuple[Floats, Floats], start: Floats, point: Floats, end: Floats) -> float:
    """At which fraction of a circle from ``start`` to ``end`` a point lies; -1 if it is not on it."""
    centre, normal = circle
    a, p, b = (_in_plane(each - centre, normal) for each in (start, point, end))
    if abs(float(np.linalg.norm(p) - np.linalg.norm(a))) > 0.01:
        return -1.0

    def angle(arm: Floats) -> float:
        return float(np.arctan2(np.cross(a, arm) @ normal, a @ arm) % (2.0 * np.pi))

    whole = angle(b)
    return angle(p) / (whole if whole > 1e-9 else 2.0 * np.pi)


def _in_plane(arm: Floats, normal: Floats) -> Floats:
    """Return a vector without its share along the normal, (3,)."""
    return np.asarray(arm - (arm @ normal) * normal)
