"""_GMODE, _DMODE and _AMODE, which drilling cycles of an 840D sl have behind the classic parameters.

The digits of _AMODE say how classic parameters count. What a digit says is made of the classic parameters here, so that
the motions of a cycle are those of its classic form. A digit whose meaning no source settles is refused.
"""

from collections.abc import Callable, Sequence
from typing import Final

from trunnion.messages import Wording
from trunnion.readers.control.hole_motion import CycleExecutionError

Values = list[float | None]

#: The first of the three places of _GMODE, _DMODE and _AMODE, from 1.
MODE_PLACES: Final = {
    "CYCLE81": 7, "CYCLE82": 7, "CYCLE83": 18, "CYCLE84": 22, "CYCLE840": 18,
    "CYCLE85": 9, "CYCLE86": 12, "CYCLE87": 7, "CYCLE88": 8, "CYCLE89": 7,
}  # fmt: skip

#: Places of texts, which masks show and cycles do not read: pitch and thread as they were chosen.
_TEXT_PLACES: Final = {"CYCLE84": (19, 20, 21), "CYCLE840": (15, 16, 17)}

#: Depths that differ by less are the same, in units of the program.
_SAME: Final = 1e-6

_AMODE: Final = 2
_MOST_DIGITS: Final = 9


class _MisfitError(Exception):
    """A digit contradicts the parameter of which it speaks."""

    def __init__(self, variant: str) -> None:
        super().__init__(variant)
        self.variant = variant


def classic_form(name: str, arguments: Sequence[float | None], plane_axis: int) -> Values:
    """Return the arguments of a cycle without what its three modes say, in the classic form.

    name        a key of ``MODE_PLACES``
    arguments   as written; None for omitted ones
    plane_axis  the axis along which it drills: that perpendicular to the working plane

    Raises ``CycleExecutionError`` for a mode that is not known, or that contradicts a parameter.
    """
    first = MODE_PLACES[name]
    geometry, plane, alternatives = (_at(arguments, first + k) or 0.0 for k in range(_AMODE + 1))
    if geometry:
        raise CycleExecutionError(Wording("NC220", "gmode_not_simulated", geometry=geometry))
    if plane and plane != 3 - plane_axis:
        raise CycleExecutionError(Wording("NC380", "dmode_not_working_plane", plane=plane))
    found: Values = [*arguments[: first - 1], *[None] * (first - 1 - len(arguments))]
    if not 0.0 <= alternatives < 10.0**_MOST_DIGITS or alternatives % 1.0:
        raise CycleExecutionError(Wording("NC220", "amode_not_simulated", alternatives=alternatives))
    meanings = _DIGITS[name]
    for power in range(_MOST_DIGITS):
        digit = int(alternatives) // 10**power % 10
        if not digit:
            continue
        meaning = meanings.get(power)
        try:
            if meaning is None or not meaning(found, digit):
                raise CycleExecutionError(
                    Wording("NC220", "amode_digit_unknown", alternatives=alternatives, digit=digit, place=10**power)
                )
        except _MisfitError as misfit:
            raise CycleExecutionError(Wording("NC380", misfit.variant, alternatives=alternatives)) from None
    return found


def without_texts(name: str, arguments: Sequence[float | str | None]) -> Sequence[float | str | None]:
    """Return the arguments of a cycle without the texts that only its mask shows.

    Raises ``CycleExecutionError`` for a number in their place.
    """
    shown = _TEXT_PLACES.get(name, ())
    if any(isinstance(value, float) for value in arguments[slice(shown[0] - 1, shown[-1]) if shown else slice(0)]):
        raise CycleExecutionError(Wording("NC380", "number_text_must_stand"))
    return [
        None if place in shown and isinstance(value, str) else value for place, value in enumerate(arguments, start=1)
    ]


def _at(arguments: Sequence[float | None], place: int) -> float | None:
    return arguments[place - 1] if place <= len(arguments) else None


def _depth(absolute: int, relative: int, reference: int = 2) -> Callable[[Values, int], bool]:
    """1: the relative depth counts, 2: the absolute one; where the call has both, they must agree."""

    def said(values: Values, digit: int) -> bool:
        if digit not in (1, 2):
            return False
        deep, to, zero = values[relative - 1], values[absolute - 1], values[reference - 1] or 0.0
        wanted, other = (deep, to) if digit == 1 else (to, deep)
        if (digit == 1 and not wanted) or wanted is None:
            raise _MisfitError("amode_does_not_fit_dp")
        if other and abs(abs((to or 0.0) - zero) - abs(deep or 0.0)) > _SAME:
            raise _MisfitError("amode_does_not_fit_dp")
        values[(absolute if digit == 1 else relative) - 1] = None
        return True

    return said


def _dwell(place: int) -> Callable[[Values, int], bool]:
    """1: seconds, 2: turns of the spindle, which the classic form has below zero."""

    def said(values: Values, digit: int) -> bool:
        value = values[place - 1]
        if digit == 1 and value is not None and value < 0.0:
            raise _MisfitError("amode_does_not_fit_dwell")
        if digit == 2 and value:
            values[place - 1] = -abs(value)
        return digit in (1, 2)

    return said


def _degression(values: Values, digit: int) -> bool:
    """1: a length; 2, a percentage, is not known in its scale."""
    if digit == 1 and (values[7] or 0.0) < 0.0:
        raise _MisfitError("amode_does_not_fit_degression")
    return digit == 1


def _hand(values: Values, digit: int) -> bool:
    """1: right, 2: left, as the sign of the pitch says in the classic form; whether it may differ is not known."""
    pitch = values[8] or values[7] or 0.0
    if digit in (1, 2) and (digit == 1) is not (pitch > 0.0):
        raise _MisfitError("amode_does_not_fit_hand")
    return digit in (1, 2)


def _stated_retract(values: Values, digit: int) -> bool:
    """1 of CYCLE83: a distance as stated. Which one, VRT or DIS1, is not known: what the hole uses must be stated."""
    return digit == 1 and bool(values[16] if values[11] == 1.0 else values[14])


def _stated_chip_break(values: Values, digit: int) -> bool:
    """1 of CYCLE84: a distance as stated, which counts only where chips are broken."""
    return digit == 1 and (values[15] != 1.0 or bool(values[17]))


_DEPTH: Final = _depth(4, 5)
_PLAIN: Final = {0: _DEPTH, 1: _dwell(6)}
_DIGITS: Final[dict[str, dict[int, Callable[[Values, int], bool]]]] = {
    "CYCLE81": _PLAIN,
    "CYCLE82": _PLAIN,
    "CYCLE83": {
        0: _DEPTH, 1: _dwell(9), 2: _dwell(10), 3: _dwell(16), 4: _depth(6, 7), 5: _degression, 6: _stated_retract,
    },
    "CYCLE84": {0: _DEPTH, 3: _hand, 6: _stated_chip_break},
    "CYCLE840": {0: _DEPTH},
    "CYCLE85": _PLAIN,
    "CYCLE86": _PLAIN,
    "CYCLE87": {},
    "CYCLE88": {},
    "CYCLE89": _PLAIN,
}  # fmt: skip
