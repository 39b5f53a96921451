"""The observations of an agent that are kept: the last ones by their sequence numbers, and what held before them."""

from collections.abc import Container
from datetime import datetime
from typing import Final, NamedTuple

from trunnion.twin.mtconnect.observations import Condition

#: Observations that are kept.
KEPT: Final = 131_072


class Observation(NamedTuple):
    """A value or a condition of a data item, by its key, from a time on."""

    sequence: int
    time: datetime
    key: str
    value: str | Condition


class ObservationBuffer:
    """The last observations; each has the number after that of the one before, from 1 on."""

    def __init__(self, size: int = KEPT) -> None:
        self.size, self.next = size, 1
        self._ring: list[Observation] = []
        self._before: dict[str, Observation] = {}
        self._latest: dict[str, Observation] = {}

    @property
    def first(self) -> int:
        """Number of the oldest observation that is kept."""
        return self.next - len(self._ring)

    @property
    def last(self) -> int:
        """Number of the newest one."""
        return self.next - 1

    def add(self, time: datetime, key: str, value: str | Condition) -> None:
        """Keep an observation; the oldest makes room for it."""
        new = Observation(self.next, time, key, value)
        if len(self._ring) < self.size:
            self._ring.append(new)
        else:
            place = self.last % self.size
            old = self._ring[place]
            self._before[old.key], self._ring[place] = old, new
        self._latest[key] = new
        self.next += 1

    def at(self, sequence: int) -> Observation:
        """Return the observation of a number that is kept."""
        return self._ring[(sequence - 1) % self.size]

    def latest(self, at: int | None = None) -> list[Observation]:
        """Return the newest observation of each item; ``at``: when this number was that of the last one."""
        if at is None:
            return list(self._latest.values())
        found = dict(self._before)
        for sequence in range(self.first, at + 1):
            observation = self.at(sequence)
            found[observation.key] = observation
        return list(found.values())

    def forward(self, start: int, end: int, most: int, keys: Container[str]) -> tuple[list[Observation], int]:
        """Return at most some observations of items from one number to another, and the number after the last seen."""
        found = []
        for sequence in range(start, end + 1):
            observation = self.at(sequence)
            if observation.key in keys:
                found.append(observation)
                if len(found) == most:
                    return found, sequence + 1
        return found, end + 1

    def backward(self, start: int, most: int, keys: Container[str]) -> tuple[list[Observation], int]:
        """Return at most some observations from a number back, in the order of their numbers, and the number before.

        Where there is none before, the number is the next one that there will be.
        """
        found = []
        for sequence in range(start, self.first - 1, -1):
            observation = self.at(sequence)
            if observation.key in keys:
                found.append(observation)
                if len(found) == most and sequence > self.first:
                    return found[::-1], sequence - 1
        return found[::-1], self.next
