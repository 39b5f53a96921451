"""Cycles 220 and 221: the positions of a circle and of lines, at which the cycle that was defined before is executed.

Facts: the parameters of both in the cycle manuals of the TNC 320 (9/2016, page 178), TNC 640 (34059x-01, page 162) and
TNC 128 (77184x-01, page 380), and their course of motions in the same chapters.
"""

import math
from collections.abc import Mapping
from typing import Final

from trunnion.messages import Wording
from trunnion.readers.control.hole_motion import CycleExecutionError, finite
from trunnion.readers.families.heidenhain.cycle_values import check_given, check_signs
from trunnion.readers.program.word_values import one_of
from trunnion.records import dataclass

#: The cycles of patterns.
CIRCLE: Final = 220
LINES: Final = 221

#: What patterns put in the place of the values of the cycle: clearance, surface, second clearance.
_OVERRIDES: Final = (200, 203, 204)

#: Cycles with which the manuals combine patterns, of those that are simulated.
WITH_PATTERNS: Final = frozenset({*range(200, 210), 240})

#: How the tool goes from one position to the next: Q301 at the first or the second clearance, Q365 straight on.
_ON_THE_WAY: Final = {301: one_of(0, 1), 365: one_of(0)}

#: More positions are mistakes of the program.
_MOST: Final = 10_000

_FULL_TURN: Final = 360.0


@dataclass(frozen=True, slots=True)
class Pattern:
    """A pattern: its positions in the working plane, in units of the program, and what holds at all of them.

    at_second   the tool goes from one to the next at the second clearance
    values      Q parameters in the place of those of the cycle
    """

    positions: tuple[tuple[float, float], ...]
    at_second: bool
    values: Mapping[int, float]

    @property
    def clearance(self) -> float:
        """The height of the set-up clearance."""
        return self.values[203] + self.values[200]

    @property
    def second_clearance(self) -> float:
        """The height of the second set-up clearance if it is higher, else of the first."""
        return self.values[203] + max(self.values[200], self.values[204])


def pattern_of(number: int, values: Mapping[int, float]) -> Pattern:
    """Return the pattern of a definition; CycleExecutionError if it is none, or not simulated."""
    check_given(number, values)
    for parameter in values:
        finite(values[parameter])
    for parameter, known in _ON_THE_WAY.items():
        if parameter in values and values[parameter] not in known:
            raise CycleExecutionError(
                Wording("NC215", "parameter_out_of_range", parameter=parameter, value=values[parameter], known=known)
            )
    if values[200] < 0.0:
        raise CycleExecutionError(Wording("NC380", "clearance_below_zero", value=values[200]))
    check_signs(values, (244,) if number == CIRCLE else ())
    positions = _on_circle(values) if number == CIRCLE else _on_lines(values)
    own = {parameter: values[parameter] for parameter in _OVERRIDES}
    return Pattern(tuple(positions), values[301] == 1.0, own)


def _count(values: Mapping[int, float], parameter: int) -> int:
    value = values[parameter]
    if not 1.0 <= value <= _MOST or value != int(value):
        raise CycleExecutionError(Wording("NC380", "bad_count", parameter=f"Q{parameter}", value=value, most=_MOST))
    return int(value)


def _on_circle(values: Mapping[int, float]) -> list[tuple[float, float]]:
    """Return the positions of cycle 220: by the angle between two of them, or else by the first and the last angle."""
    count, begin, step = _count(values, 241), values[245], values[247]
    if not step and count > 1:
        turn = values[246] - begin
        if turn == 0.0 or abs(turn) > _FULL_TURN:
            raise CycleExecutionError(Wording("NC380", "bad_angles_of_pattern", turn=turn))
        step = turn / (count if abs(turn) == _FULL_TURN else count - 1)
    radius = 0.5 * values[244]
    angles = [math.radians(begin + k * step) for k in range(count)]
    return [(values[216] + radius * math.cos(angle), values[217] + radius * math.sin(angle)) for angle in angles]


def _on_lines(values: Mapping[int, float]) -> list[tuple[float, float]]:
    """Return the positions of cycle 221: there on the first line, back on the second, turned about the first one."""
    columns, lines = _count(values, 242), _count(values, 243)
    if columns * lines > _MOST:
        raise CycleExecutionError(
            Wording("NC380", "bad_count", parameter="Q242", value=float(columns * lines), most=_MOST)
        )
    for parameter, count in ((237, columns), (238, lines)):
        if count > 1 and not values[parameter]:
            raise CycleExecutionError(Wording("NC380", "positions_in_one_place", parameter=f"Q{parameter}"))
    cos, sin = math.cos(math.radians(values[224])), math.sin(math.radians(values[224]))
    positions = []
    for line in range(lines):
        across = line * values[238]
        for k in range(columns) if line % 2 == 0 else reversed(range(columns)):
            along = k * values[237]
            positions.append((values[225] + along * cos - across * sin, values[226] + along * sin + across * cos))
    return positions
