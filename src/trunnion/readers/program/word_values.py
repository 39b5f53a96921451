"""What the value of a word may be on a control; another one has no meaning, or one that the reader does not know."""

from dataclasses import dataclass

from trunnion.messages import Wording


@dataclass(frozen=True, slots=True)
class Values:
    """Values that a word may have: those of ``single``, and all from ``least`` to ``greatest``, whole ones only."""

    single: tuple[float, ...] = ()
    least: float = 0.0
    greatest: float = -1.0

    def __contains__(self, value: float) -> bool:
        return value in self.single or (self.least <= value <= self.greatest and value == int(value))

    def __str__(self) -> str:
        parts = [f"{value:g}" for value in self.single]
        if self.least <= self.greatest:
            parts.append(f"whole numbers from {self.least:g} to {self.greatest:g}")
        return " or ".join(parts)


def one_of(*values: float) -> Values:
    """Return single values."""
    return Values(values)


def whole(least: float, greatest: float) -> Values:
    """Return the whole numbers between two, both included."""
    return Values((), least, greatest)


def fault_of_value(word: str, letter: str, value: float, known: Values) -> Wording | None:
    """Return what is wrong with the value of a word; None if it is known."""
    if value in known:
        return None
    return Wording("NC215", "unknown_value", word=word, letter=letter, value=value, known=known)
