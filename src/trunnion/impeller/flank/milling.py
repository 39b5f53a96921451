"""One pass of flank milling over a whole flank: start, fit, and what is left on a denser grid.

In:     a flank as a function of its grid, and a cutter.
Out:    ``FlankCut``.
Units:  mm.

A fit sees the points it is given. So the deviations on a denser grid are computed after it, and where they are worse
than at these points, the worst ones are added and the fit goes on.
"""

from collections.abc import Callable
from dataclasses import replace
from typing import Final

import numpy as np

from trunnion.impeller.flank.cutter import FlankCutter
from trunnion.impeller.flank.deviations import Deviations, deviations_of
from trunnion.impeller.flank.fit import Fit, Floor, Limits, fit_path
from trunnion.impeller.flank.flanks import Flank
from trunnion.impeller.flank.measure import measured_deviations
from trunnion.impeller.flank.path import FlankPath
from trunnion.impeller.flank.start import start_path
from trunnion.impeller.progress import Progress, silent
from trunnion.records import dataclass

#: Points along and across that are fitted, and on which the result is told.
_FITTED: Final = (101, 21)
_DENSE: Final = (401, 61)

#: How often points are added, how many, and rounds of each fit that follows.
_ADDED: Final = 2
_WORST: Final = 500
_ROUNDS: Final = 12

#: Control points of a path, and how far it goes on at either end, as a share of its length.
_CONTROL_POINTS: Final = 14
_LEAD: Final = 0.06

#: A start that cuts so many times deeper than the limit of overcut is fitted without that limit first: kept to it from
#: the beginning, the fit ends at paths that leave far more.
_DEEPER: Final = 4.0


@dataclass(frozen=True, slots=True, eq=False)
class FlankCut:
    """A pass over a flank and what it leaves, over the whole flank.

    path     of the cutter's axis
    left     overcut and undercut by ``measured_deviations``, on a grid of 401 x 61 points
    begun    those of the start
    rounds   linear programs that improved the path
    """

    path: FlankPath
    left: Deviations
    begun: Deviations
    rounds: int


def mill_flank(
    grid: Callable[[int, int], Flank],
    cutter: FlankCutter,
    limits: Limits,
    *,
    below: float,
    floor: Floor | None = None,
    progress: Progress = silent,
) -> FlankCut:
    """Return the pass that leaves least of a flank.

    grid      gives the flank with so many points along and across
    below     how far the axis begins below the flank's lower end, mm; below 0: above it
    progress  accompanies the work
    """
    flank, dense = grid(*_FITTED), grid(*_DENSE).flat()
    points = flank.flat()
    start = start_path(flank, cutter, _CONTROL_POINTS, below, _LEAD)
    with progress("fit of a flank", limits.rounds + _ADDED * _ROUNDS, "rounds") as advance:
        rounds, begun = 0, start
        if limits.overcut is not None and deviations_of(start, points)[0].min() < -_DEEPER * limits.overcut:
            fit = fit_path(start, points, replace(limits, overcut=None), floor, advance)
            rounds, begun = len(fit.history) - 1, fit.path
        fit = fit_path(begun, points, limits, floor, advance)
        rounds += len(fit.history) - 1
        for _ in range(_ADDED):
            left = deviations_of(fit.path, dense)[0][:, 0]
            worse = _worse(left, fit, limits)
            if not len(worse):
                break
            points = np.concatenate((points, dense[worse]))
            fit = fit_path(fit.path, points, replace(limits, rounds=_ROUNDS), floor, advance)
            rounds += len(fit.history) - 1
    left = measured_deviations(fit.path, dense)
    return FlankCut(fit.path, Deviations.of(left), Deviations.of(measured_deviations(start, dense)), rounds)


def _worse(left: np.ndarray, fit: Fit, limits: Limits) -> np.ndarray:
    """Points of a denser grid that are worse than those a path was fitted to, the worst ones."""
    most = fit.deviations.overcut if limits.overcut is None else limits.overcut
    beyond = np.maximum(-left - most, left - fit.deviations.undercut)
    worst = np.argsort(-beyond)[:_WORST]
    return np.asarray(worst[beyond[worst] > 0.0])
