"""The turns and tilts at which a part is tried, as arguments give them."""

from collections.abc import Sequence
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.errors import InputError, argument_problem
from trunnion.jobs.inputs.arguments import wrong_argument
from trunnion.messages import Wording, phrase
from trunnion.placing.best_turn import Grid

#: Orientations are at most as many.
_MOST: Final = 3600

#: Steps between turns, alone and with several tilts, degrees.
_TURN_STEP: Final = 5.0
_TURN_STEP_OF_TILTS: Final = 15.0

#: The least step, so that all turns are no more than can be; the greatest tilt, degrees.
_LEAST_STEP: Final = 360.0 / _MOST
_GREATEST_TILT: Final = 90.0


def orientations(turns: float | Sequence[float] | None, tilts: float | Sequence[float]) -> Grid:
    """Return the orientations that are tried.

    Raises ``InputError`` if a step is out of range, an angle is none, or they are too many.
    """
    tilt_angles, refines_tilts = _tilts(tilts)
    if turns is None:
        turns = _TURN_STEP if len(tilt_angles) == 1 else _TURN_STEP_OF_TILTS
    cure = phrase("give_turns", least=_LEAST_STEP)
    turn_angles, refines_turns = _angles("turns", turns, cure, 0.0, 360.0)
    count = len(turn_angles) * len(tilt_angles)
    if count > _MOST:
        raise InputError(argument_problem("turns", Wording("ARG140", "too_many_orientations", count=count, most=_MOST)))
    return Grid(turn_angles, tilt_angles, refines_turns, refines_tilts)


def _tilts(tilts: float | Sequence[float]) -> tuple[Floats, bool]:
    if isinstance(tilts, Sequence) and not isinstance(tilts, str) and not len(tilts):
        return np.zeros(1), False
    cure = phrase("give_tilts", least=_LEAST_STEP)
    found, refines = _angles("tilts", tilts, cure, 0.0, _GREATEST_TILT)
    if refines:
        found = found[found > 0.0]
        found = np.concatenate((-found[::-1], [0.0], found))
    if np.abs(found).max() > _GREATEST_TILT:
        raise wrong_argument("tilts", tilts, cure)
    return found, refines


def _angles(name: str, given: float | Sequence[float], cure: Wording, first: float, most: float) -> tuple[Floats, bool]:
    """Angles, and whether they are those of a step, which is refined; degrees in whole thousandths."""
    if isinstance(given, bool):
        raise wrong_argument(name, given, cure)
    if isinstance(given, int | float):
        if not _LEAST_STEP <= given <= most:
            raise wrong_argument(name, given, cure)
        end = most if most == 360.0 else most + 1e-9
        return np.arange(first, end, float(given)), True
    try:
        found = np.array(list(given), np.float64)
    except (TypeError, ValueError):
        raise wrong_argument(name, given, cure) from None
    if found.ndim != 1 or not 0 < len(found) <= _MOST or not np.isfinite(found).all():
        raise wrong_argument(name, given, cure)
    return np.round(found, 3), False
