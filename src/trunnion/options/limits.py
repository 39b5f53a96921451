"""Bounds of what a user asks of a twin."""

from typing import Final

#: Times real time.
SLOWEST: Final = 0.1
FASTEST: Final = 1000.0

#: Milliseconds between two samples.
SHORTEST_RATE: Final = 5.0
LONGEST_RATE: Final = 60_000.0
