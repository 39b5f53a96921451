"""The states between which the planner chooses in every row, and what states and steps cost.

A state is a branch of the inverse kinematics and, for each rotary axis with limits, the whole turns by which the axis
is wound up: its value is the angle of the branch in (-180, 180] plus 360 degrees for each turn. An endless axis has no
turns in its states, as it takes the shorter way.
"""

import math
from typing import Final

import numpy as np

from trunnion.arrays import Ints
from trunnion.machines import Axis, Machine
from trunnion.records import dataclass

#: Bits of a backpointer: the state before; the step from there is a rewind; the rewind is blocked.
STATE_BITS: Final = 0x3F
REWIND_STEP: Final = 0x80
BLOCKED_STEP: Final = 0x40

#: A value beyond a limit by less than this, mm or degrees, prints as the limit and becomes it.
LIMIT_TOLERANCE: Final = 1e-5

#: The most combinations of turns of both rotary axes. An axis with more is planned around its home only.
MOST_TURNS: Final = 32

#: A step in the cut that bends the tool axis half-way off its great circle by more than this, degrees, is a rewind.
MAX_BEND: Final = 1.0

#: A change of branch goes through the pole if the rotary axes turn by less than this, degrees, and the tool axis does
#: not bend.
POLE_JUMP: Final = 90.0

# Costs, in degrees of rotary travel. A rewind costs more than any sum of them.

#: A change of branch, unless it goes through the pole. It is more than the 180 degrees that a change can save, so the
#: branch changes where the path forces it and never to save travel. Equal tool axes then have equal poses in every
#: pass.
BRANCH_CHANGE_COST: Final = 200.0

#: A change of branch through the pole: more than two reversals, so that saving these is no reason for it.
POLE_PASSAGE_COST: Final = 0.5

#: A cut that begins in a branch that is not preferred.
NON_PREFERRED_COST: Final = 400.0

#: An axis reverses.
REVERSAL_COST: Final = 0.1

#: A rewind between cutting rows, above one between rows that engage or step over.
REWIND_IN_CUT_COST: Final = 1.0

#: All rows of an operation at a limit, above all in the middle of the travel: this decides between equals only.
NEAR_LIMITS_COST: Final = 1e-6


@dataclass(frozen=True, slots=True, eq=False)
class States:
    """The states of one machine.

    table        (s, 3) int64  branch, whole turns of the first and of the second rotary axis; ascending
    turn_ranges  (4,)          of each rotary axis the least turn and the number of turns; 0 of them: it is endless
    """

    table: Ints
    turn_ranges: tuple[int, int, int, int]

    def __len__(self) -> int:
        return len(self.table)


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
    """Least turn and number of turns with which an angle in (-180, 180] can be within the limits."""
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
    """Return the same range without the turn at the end farther from home."""
    above = low + count - 1 - home / 360.0
    return (low, count - 1) if above >= home / 360.0 - low else (low + 1, count - 1)
