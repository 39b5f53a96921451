"""Points between CL points, where a control would lead the tool off the CAM's path by more than the tolerances."""

import math
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Floats2, Ints
from trunnion.jit import kernel
from trunnion.machines import KinematicParameters, Machine, kinematic_parameters
from trunnion.machines.forward import kinematic_chain
from trunnion.planning.linearization.leg_division import PathRows, divide_rows
from trunnion.planning.linearization.leg_error import branch_of
from trunnion.records import dataclass

#: Share of a tolerance that is used: the samples within a span miss the worst place by less than the rest.
USABLE_SHARE: Final = 0.96

#: Space for added rows at first.
_FIRST_CAPACITY: Final = 1024


@dataclass(frozen=True, slots=True, eq=False)
class DividedPath:
    """Rows of a path with those that were added.

    source  (m,) int64      the row that each of them leads to, or is
    tip     (m, 3) float64  mm, workpiece frame
    axis    (m, 3) float64  unit vectors, workpiece frame
    rotary  (m, 2) float64  as they wind, degrees
    """

    source: Ints
    tip: Floats
    axis: Floats
    rotary: Floats


def divide_path(
    machine: Machine,
    rows: PathRows,
    divisible: Flags,
    *,
    tcp: bool,
    tip_tolerance: float,
    axis_tolerance: float,
) -> DividedPath:
    """Add the fewest points that keep the tool on its path from CL point to CL point.

    machine                        without ``tcp`` its workpiece zero must be that of the program
    divisible                      (n,) bool: rows before which points may be added. Not the first one, and none in
                                   which the branch changes, as no points help there
    tcp                            the control keeps the tip on its line
    tip_tolerance, axis_tolerance  mm and degrees
    """
    tolerances = math.inf if tcp else USABLE_SHARE * tip_tolerance, USABLE_SHARE * math.radians(axis_tolerance)
    model = kinematic_chain(machine), kinematic_parameters(machine), tolerances
    copies = np.ones(len(rows.tip), np.int64)
    added = PathRows(*(np.empty((_FIRST_CAPACITY, column.shape[1])) for column in rows))
    row, count = divide_rows(*model, rows, divisible, 0, 0, copies, added)
    while row < len(rows.tip):
        added = PathRows(*(np.concatenate((column, np.empty_like(column))) for column in added))
        row, count = divide_rows(*model, rows, divisible, row, count, copies, added)
    if not count:
        return DividedPath(np.arange(len(rows.tip)), *rows)
    is_own = np.zeros(int(copies.sum()), np.bool_)
    is_own[np.cumsum(copies) - 1] = True
    merged = (_merged(is_own, old, new[:count]) for old, new in zip(rows, added, strict=True))
    return DividedPath(np.repeat(np.arange(len(rows.tip)), copies), *merged)


def _merged(is_own: Flags, rows: Floats, added: Floats) -> Floats:
    """``rows`` where ``is_own``, ``added`` ones elsewhere."""
    merged = np.empty((len(is_own), rows.shape[1]))
    merged[is_own], merged[~is_own] = rows, added
    return merged


def branches_of_rows(machine: Machine, rotary: Floats) -> Ints:
    """(n,) int64: the branch of rotary positions (n, 2), degrees; -1 where both branches are one.

    That is so in the pole, and at the edge of reach. The second angle decides: in ``trunnion.machines.inverse`` it is
    phi in one branch and -phi in the other.
    """
    found = np.empty(len(rotary), np.int64)
    _fill_branches(kinematic_parameters(machine), rotary, found)
    return found


@kernel(writes="found")
def _fill_branches(kinematics: KinematicParameters, rotary: Floats2, found: Ints) -> None:
    for row in range(rotary.shape[0]):
        found[row] = branch_of(kinematics, rotary[row, 1])
