"""Whether a motion of one program ends on the path of a motion of the other."""

import math
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.model.run import Orientation, Run
from trunnion.records import dataclass
from trunnion.verification.comparison.moving_rows import MovingRows

#: At how many fractions of a turn the nearest is searched, and how often around it: to a millionth of the turn.
_SAMPLES: Final = 65
_REFINEMENTS: Final = 4

#: The share of a turn that it may go back: as exactly as the nearest is found.
_TURN_SLACK: Final = 1e-6


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
    turn = _Turn.of(less, j, start_axis, end_axis)
    if length < tolerances.tip**2:  # only the tool axis moves: it must be on its way
        part, before, slack = turn.nearest(axis), turn.nearest(begin_axis), _TURN_SLACK
    else:
        part, before = float((tip - start) @ line) / length, float((begin - start) @ line) / length
        slack = tolerances.tip / math.sqrt(length)
    if not (before - slack <= part <= 1.0 + 1e-9):
        return False
    if (np.abs(tip - (start + part * line)) > tolerances.tip).any():
        return False
    return bool(np.linalg.norm(axis - turn.at(np.array([part]))[0]) <= tolerances.axis)


@dataclass(frozen=True, slots=True, eq=False)
class _Turn:
    """How the tool axis goes from one vector to another within a motion.

    joints  (2, 5) axis values at both ends, which move in proportion; None: the vector goes on a great circle
    """

    program: Run
    row: int
    ends: Floats
    joints: Floats | None

    @staticmethod
    def of(program: MovingRows, motion: int, start: Floats, end: Floats) -> "_Turn":
        """Return how the tool axis goes within a motion."""
        row, run = int(program.rows[motion]), program.run
        ends = np.stack([start, end])
        if run.orientation_between(row, row + 1)[0] == Orientation.GREAT_CIRCLE:
            return _Turn(run, row, ends, None)
        return _Turn(run, row, ends, run.positions(np.array([row - 1, row])).joints)

    def at(self, parts: Floats) -> Floats:
        """Return the tool axis (k, 3) at fractions (k,) of the motion."""
        weights = np.stack([1.0 - parts, parts], axis=1)
        if self.joints is not None:
            return self.program.forward_at(np.full(len(parts), self.row), weights @ self.joints)[1]
        angle = math.acos(max(-1.0, min(1.0, float(self.ends[0] @ self.ends[1]))))
        if math.sin(angle) > 1e-9:
            weights = np.sin(weights * angle)
        vectors = weights @ self.ends
        return np.asarray(vectors / np.linalg.norm(vectors, axis=1)[:, None])

    def nearest(self, axis: Floats) -> float:
        """Return the fraction at which the tool axis is nearest to a vector."""
        low, high = 0.0, 1.0
        for _ in range(_REFINEMENTS):
            parts = np.linspace(low, high, _SAMPLES)
            near = float(parts[np.argmin(np.linalg.norm(self.at(parts) - axis, axis=1))])
            step = (high - low) / (_SAMPLES - 1)
            low, high = max(near - step, 0.0), min(near + step, 1.0)
        return near


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
