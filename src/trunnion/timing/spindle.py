"""The spindle in time: it speeds up and slows down evenly, as fast as the machine's definition states.

``schedule`` says when it is told to. Without a stated acceleration the spindle takes no time.
Units: seconds, rev/min; negative speeds are counter-clockwise (M4).
"""

import math

import numpy as np

from trunnion.arrays import Flags, Floats
from trunnion.records import dataclass


@dataclass(frozen=True, slots=True, eq=False)
class SpindleSpeeds:
    """Changes of the speed in time, ascending.

    seconds   (k,)  when each begins
    before    (k,)  speed there
    target    (k,)  speed that it leads to
    rate      rev/min per second; infinite where none is stated
    """

    seconds: Floats
    before: Floats
    target: Floats
    rate: float

    def at(self, seconds: Floats, after: Flags | None = None) -> tuple[Floats, Floats]:
        """Return the speed and the speed that it leads to at some times, (k,) each.

        ``after`` (k,): where a change begins at that very time, it has begun.
        """
        if not len(self.seconds):
            return np.zeros(len(seconds)), np.zeros(len(seconds))
        k = np.searchsorted(self.seconds, seconds, "left") - 1
        if after is not None:
            k = np.where(after, np.searchsorted(self.seconds, seconds, "right") - 1, k)
        known = np.maximum(k, 0)
        change = self.target[known] - self.before[known]
        done = _moved(change, seconds - self.seconds[known], self.rate)
        return np.where(k < 0, 0.0, self.before[known] + done), np.where(k < 0, 0.0, self.target[known])

    def end(self) -> float:
        """Second at which the last change has come to its end."""
        if not len(self.seconds) or not np.isfinite(self.rate):
            return 0.0
        return float(self.seconds[-1] + abs(self.target[-1] - self.before[-1]) / self.rate)


def _moved(change: Floats, seconds: Floats, rate: float) -> Floats:
    """How far a speed has come towards its target."""
    if not np.isfinite(rate):
        return change
    return np.asarray(np.sign(change) * np.minimum(np.abs(change), rate * np.maximum(seconds, 0.0)))


class SpindleRamps:
    """Collects what the spindle is told, in the order of time."""

    def __init__(self, rate: float) -> None:
        self._rate = rate
        self._seconds: list[float] = []
        self._before: list[float] = []
        self._target: list[float] = []

    def tell(self, seconds: float, target: float) -> None:
        """Have the spindle go to a speed from some time on; nothing changes if it is told what it was told before."""
        if target == self.told:
            return
        before = 0.0
        if self._target:
            gone, change = seconds - self._seconds[-1], self._target[-1] - self._before[-1]
            step = min(self._rate * gone, abs(change)) if math.isfinite(self._rate) else abs(change)
            before = self._before[-1] + math.copysign(step, change)
        self._seconds.append(seconds)
        self._before.append(before)
        self._target.append(target)

    @property
    def told(self) -> float:
        """What it was told last."""
        return self._target[-1] if self._target else 0.0

    def ready(self) -> float:
        """When it has reached what it was told last."""
        if not self._target or not math.isfinite(self._rate):
            return -math.inf
        return self._seconds[-1] + abs(self._target[-1] - self._before[-1]) / self._rate

    def speeds(self) -> SpindleSpeeds:
        """All that it was told."""
        return SpindleSpeeds(np.array(self._seconds), np.array(self._before), np.array(self._target), self._rate)
