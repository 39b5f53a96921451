"""Axis words: values, how they are meant, and what those of the rotary axes amount to."""

import math
from enum import StrEnum
from typing import Final

from trunnion.records import dataclass


class PositionMode(StrEnum):
    """How a position is meant: as the control is set (G90, G91), or as the word itself states.

    The last three are for endless rotary axes: the shorter way, in positive and in negative direction.
    """

    MODAL = ""
    ABSOLUTE = "AC"
    INCREMENTAL = "IC"
    SHORTEST = "DC"
    POSITIVE = "ACP"
    NEGATIVE = "ACN"


#: The value of a word and its mode.
AxisWord = tuple[float, PositionMode]


@dataclass(frozen=True, slots=True, eq=False)
class RotaryTarget:
    """What a block programs for the rotary axes.

    values     of the first and the second axis, degrees, NaN without a word
    turn_rule  see ``trunnion.model.axis_positions``
    bits       the words that are written, as bits of a ``ProgrammedWord``
    """

    values: tuple[float, float] = (math.nan, math.nan)
    turn_rule: int = 0
    bits: int = 0


#: No rotary words: the axes stay.
NO_ROTARY: Final = RotaryTarget()
