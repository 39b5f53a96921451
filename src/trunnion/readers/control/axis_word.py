"""Words that say a position: a value, and how it is meant."""

from enum import StrEnum


class PositionMode(StrEnum):
    """How a position is said: as the control is set, or in a way that the word itself names.

    The last three are for endless rotary axes: the shorter way, with growing, with falling values.
    """

    MODAL = ""
    ABSOLUTE = "AC"
    INCREMENTAL = "IC"
    SHORTEST = "DC"
    POSITIVE = "ACP"
    NEGATIVE = "ACN"


#: A word's value and how it was said.
AxisWord = tuple[float, PositionMode]
