"""The states between which the machine can choose at every row, and what a change from one to another costs.

A state is a branch of the inverse calculation and, for each rotary axis with limits, the whole turns that it is wound
up by: its value is the angle of the branch in (-180, 180] plus 360 degrees times its turn. An endless axis has one turn
state only, and goes the shorter way.
"""

import math
from dataclasses import dataclass
from typing import Annotated, Final, NamedTuple

import numpy as np

from trunnion.arrays import Ints
from trunnion.machines import Axis, Machine
from trunnion.machines.inverse import FlatArray

#: Bits of a backpointer: the state before; whether the step from there is a rewind; and one that is blocked.
STATE_BITS: Final = 0x3F
REWIND_STEP: Final = 0x80
BLOCKED_STEP: Final = 0x40

#: A value beyond a limit by less than this, mm or degrees, prints as the limit and is put onto it.
LIMIT_TOLERANCE: Final = 1e-5

#: Most combinations of turns of the two rotary axes. An axis with more is planned for those around its home only.
MOST_TURNS: Final = 32

#: Degrees by which a step in the cut may bend the tool axis half-way off its great circle before it is a rewind.
MAX_BEND: Final = 1.0

#: A change of branch in which the joints move by less than this, degrees, and the tool axis does not bend, goes through
#: the pole.
POLE_JUMP: Final = 90.0

# Costs, in degrees of rotary travel. A rewind costs more than any of them, whatever they add up to.

#: Change to the other branch, unless it goes through the pole. More than the 180 degrees that a change can save: the
#: side is changed where the path forces it, never to save travel, so that equal tool axes have the same pose in every
#: pass.
BRANCH_CHANGE_COST: Final = 200.0

#: The same through the pole; more than two reversals, so that these alone are no reason for it.
POLE_PASSAGE_COST: Final = 0.5

#: A cutting stretch begun on the side that is not preferred.
NON_PREFERRED_COST: Final = 400.0

#: An axis turns back.
REVERSAL_COST: Final = 0.1

#: A rewind between cutting rows, over one between rows that engage or step over.
REWIND_IN_CUT_COST: Final = 1.0

#: All rows of an operation right at a limit, over all in the middle between both: this decides between equals only.
NEAR_LIMITS_COST: Final = 1e-6


@dataclass(frozen=True, slots=True, eq=False)
class States:
    """The states of one machine.

    table  (s, 3) int64   branch, whole turns of the first and of the second rotary axis; in this order of growing
    span   (4,)           of each rotary axis the least turn and how many there are; 0 of them: endless, one state
    """

    table: Ints
    turn_ranges: tuple[int, int, int, int]

    def __len__(self) -> int:
        return len(self.table)


class SearchSpace(NamedTuple):
    """What there is to choose from, in numbers that a kernel keeps in registers.

    low, high  (5,) float  limits by column, infinite where none is to be kept
    slides     bool        a slide has a limit to be kept
    span       (4,) int    ``States.turn_ranges``
    start      (2,) float  rotary positions before the first row, degrees
    side       (2,) float  the sign that each rotary axis is to have, 0: either
    both       float       sum of the second angles of both branches, degrees, whole turns left out
    """

    low: Annotated[FlatArray, 5]
    high: Annotated[FlatArray, 5]
    slides: bool
    turn_ranges: Annotated[tuple[int, ...], 4]
    start: Annotated[FlatArray, 2]
    preferred_sign: Annotated[FlatArray, 2]
    second_angle_sum: float


def states_of(machine: Machine) -> States:
    """All states in which both rotary axes can keep their limits."""
    spans = [_turn_range(machine.axes[column]) for column in machine.rotary]
    while _count(spans) > MOST_TURNS:
        most = 0 if spans[0][1] >= spans[1][1] else 1
        spans[most] = _narrower(*spans[most], machine.axes[machine.rotary[most]].home)
    (low_1, count_1), (low_2, count_2) = spans
    turns = np.arange(low_1, low_1 + max(count_1, 1)), np.arange(low_2, low_2 + max(count_2, 1))
    grid = np.meshgrid([0, 1], *turns, indexing="ij")
    table = np.column_stack([column.ravel() for column in grid]).astype(np.int64)
    return States(table, (low_1, count_1, low_2, count_2))


def _turn_range(axis: Axis) -> tuple[int, int]:
    """Least turn and number of turns with which an angle in (-180, 180] can lie within the limits."""
    if not math.isfinite(axis.low) and not math.isfinite(axis.high):
        return 0, 0
    around = round(axis.home / 360.0)
    low = around - MOST_TURNS
    high = around + MOST_TURNS
    if math.isfinite(axis.low):
        low = max(low, math.ceil((axis.low - LIMIT_TOLERANCE - 180.0) / 360.0))
    if math.isfinite(axis.high):
        high = min(high, math.floor((axis.high + LIMIT_TOLERANCE + 180.0) / 360.0))
    return low, high - low + 1


def _count(spans: list[tuple[int, int]]) -> int:
    return max(spans[0][1], 1) * max(spans[1][1], 1)


def _narrower(low: int, count: int, home: float) -> tuple[int, int]:
    """One turn less, at the end farther from home."""
    above = low + count - 1 - home / 360.0
    return (low, count - 1) if above >= home / 360.0 - low else (low + 1, count - 1)
