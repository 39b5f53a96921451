"""Words that say a position: a value, and how it is meant."""

from enum import StrEnum


class How(StrEnum):
    """How a position is said: as the control is set, or in a way that the word itself names.

    The last three are for endless rotary axes: the shorter way, with growing, with falling values.
    """

    AS_SET = ""
    ABSOLUTE = "AC"
    INCREMENTAL = "IC"
    SHORTEST = "DC"
    GROWING = "ACP"
    FALLING = "ACN"


#: A word's value and how it was said.
Word = tuple[float, How]
