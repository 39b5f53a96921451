"""What the value of a word may be on a control; another one has no meaning, or one that the reader does not know."""

import math
from typing import Final

from trunnion.messages import Wording
from trunnion.records import dataclass


@dataclass(frozen=True, slots=True)
class Values:
    """Values that a word may have: those of ``single``, and all from ``least`` to ``greatest``.

    of_whole  only the whole ones of them
    """

    single: tuple[float, ...] = ()
    least: float = 0.0
    greatest: float = -1.0
    of_whole: bool = True

    def __contains__(self, value: float) -> bool:
        within = self.least <= value <= self.greatest
        return value in self.single or (within and (value == int(value) or not self.of_whole))

    def __str__(self) -> str:
        parts = [f"{value:g}" for value in self.single]
        if self.least <= self.greatest:
            kind = "whole numbers" if self.of_whole else "numbers"
            bounds = f"from {self.least:g} to {self.greatest:g}" if math.isfinite(self.greatest) else "above 0"
            parts.append(f"{kind} {bounds}")
        return " or ".join(parts)


def one_of(*values: float) -> Values:
    """Return single values."""
    return Values(values)


def whole(least: float, greatest: float) -> Values:
    """Return the whole numbers between two, both included."""
    return Values((), least, greatest)


def between(least: float, greatest: float) -> Values:
    """Return all numbers between two, both included."""
    return Values((), least, greatest, of_whole=False)


#: All numbers above 0.
ABOVE_ZERO: Final = between(math.nextafter(0.0, 1.0), math.inf)


def fault_of_value(word: str, letter: str, value: float, known: Values) -> Wording | None:
    """Return what is wrong with the value of a word; None if it is known."""
    if value in known:
        return None
    return Wording("NC215", "unknown_value", word=word, letter=letter, value=value, known=known)


#: How far the control may turn the tool away at most, degrees: the checks allow for no more.
GREATEST_TURN: Final = 1.0


def orientation_fault(word: str, value: float) -> Wording:
    """Return what is wrong with a tolerance of the orientation above the greatest."""
    return Wording("NC215", "orientation_tolerance_too_great", word=word, value=value, most=GREATEST_TURN)
