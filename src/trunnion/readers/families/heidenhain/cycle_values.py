"""Q parameters of cycles that no cycle takes: missing ones, and values of the wrong sign."""

from collections.abc import Mapping
from typing import Final

from trunnion.messages import Wording
from trunnion.readers.control.hole_motion import CycleExecutionError
from trunnion.readers.families.heidenhain.words import CYCLE_PARAMETERS

#: Q parameters that have no sign: the second clearance and dwells.
_UNSIGNED: Final = (204, 210, 211)


def check_given(number: int, values: Mapping[int, float]) -> None:
    """Refuse a definition without one of the Q parameters that its cycle must have."""
    if missing := [parameter for parameter in CYCLE_PARAMETERS[number] if parameter not in values]:
        names = tuple(f"Q{parameter}" for parameter in missing)
        raise CycleExecutionError(Wording("NC380", "has_no_parameter", missing=names))


def check_signs(values: Mapping[int, float], above: tuple[int, ...] = ()) -> None:
    """Refuse values below 0 that have no sign, and values not above 0 of Q parameters that must be."""
    for parameter in above:
        if not values[parameter] > 0.0:
            raise CycleExecutionError(Wording("NC380", "not_above_zero", word=f"Q{parameter}"))
    for parameter in _UNSIGNED:
        if values.get(parameter, 0.0) < 0.0:
            raise CycleExecutionError(Wording("NC380", "below_zero", word=f"Q{parameter}", value=values[parameter]))
