"""How fast the rotary axes would have to turn at the programmed feed, and the feed at which they can.

The feed is that of the tip, so a row lasts the tip's path over the feed, however far the rotary axes turn meanwhile.
Where the tip rests, the feed counts as degrees per minute of the axis that turns farther. Rapids take the time they
need.
"""

import math
from dataclasses import replace
from typing import Final, NamedTuple

import numpy as np

from trunnion.arrays import Codes, Flags, Floats, Floats2, Ints
from trunnion.jit import kernel
from trunnion.machines import Machine
from trunnion.machines.inverse import Pair
from trunnion.model.toolpath import Kind, Moves, Operation, SpindleOn
from trunnion.planning.rotary_positions import is_endless
from trunnion.records import dataclass

#: Share of an axis' rapid speed that is used: printed numbers are rounded, which counts where steps are small.
USABLE_SHARE: Final = 0.99

#: No feed is lowered below this, mm/min, so that it does not print as 0.
_LEAST_FEED: Final = 0.1

#: A tip that moves by less than this, mm, rests.
REST_LENGTH: Final = 1e-9


@dataclass(frozen=True, slots=True)
class FastestRow:
    """The row that needs the largest share of a rotary axis' rapid speed.

    share  1: all of it
    axis   0 or 1, the first or the second rotary axis
    count  how many rows need more than all of it
    """

    share: float
    row: int
    axis: int
    count: int


class OffPartTurns(NamedTuple):
    """Rows before which the rotary axes turn while the tool is off the part.

    row    (k,) int64      ascending
    after  (k, 2) float64  displayed positions after these turns, degrees
    """

    row: Ints
    after: Floats2


#: No such rows.
NO_TURNS: Final = OffPartTurns(np.zeros(0, np.int64), np.zeros((0, 2)))


def tip_speeds(operation: Operation) -> Floats:
    """(n,) float64: programmed speed of the tip, mm/min, also where the feed is per revolution; NaN if unknown."""
    moves = operation.moves
    if not moves.per_rev.any():
        return moves.feed
    rpm = np.full(len(moves), np.nan)
    for event in operation.events:
        if isinstance(event, SpindleOn):
            rpm[event.row :] = event.rpm
    return np.asarray(np.where(moves.per_rev, moves.feed * rpm, moves.feed))


def find_fastest_row(machine: Machine, operation: Operation, rotary: Floats, off_part: OffPartTurns) -> FastestRow:
    """Find where the rotary axes would have to be fastest.

    operation  in the program's coordinate system
    rotary     (n, 2) float64: displayed positions, degrees
    off_part   turns that take place outside of the rows
    """
    share = np.empty((0, 2))
    return FastestRow(*_speed_shares(*_kernel_arguments(machine, operation, rotary), off_part, share))


def speed_shares(machine: Machine, operation: Operation, rotary: Floats, off_part: OffPartTurns = NO_TURNS) -> Floats:
    """(n, 2) float64: share of each rotary axis' rapid speed that each row needs.

    Parameters as for ``find_fastest_row``.
    """
    share = np.zeros((len(rotary), 2))
    _speed_shares(*_kernel_arguments(machine, operation, rotary), off_part, share)
    return share


def max_rotary_steps(machine: Machine, operation: Operation) -> tuple[Floats, Flags]:
    """How far each rotary axis can turn in each row.

    max_step  (n, 2) float64: Degrees
    unbound   (n,) bool: Rows whose duration no feed fixes: rapids, rows in which the tip rests, and the first one, as
              the axes are brought there beforehand
    """
    moves = operation.moves
    length = np.linalg.norm(np.diff(moves.tip, axis=0, prepend=moves.tip[:1]), axis=1)
    rate = tip_speeds(operation)
    bound = (moves.kind != Kind.RAPID) & (length >= REST_LENGTH) & (rate > 0.0)
    bound[0] = False
    max_step = np.full((len(moves), 2), np.inf)
    for r, column in enumerate(machine.rotary):
        rapid = machine.axes[column].rapid
        max_step[bound, r] = USABLE_SHARE * (math.inf if rapid is None else rapid) * length[bound] / rate[bound]
    return max_step, ~bound


def lower_feeds(
    machine: Machine, operation: Operation, rotary: Floats, off_part: OffPartTurns, together: Ints
) -> tuple[Moves, Ints]:
    """Lower feeds so that no rotary axis exceeds its rapid speed.

    together  (n,) int64: ascending; rows with the same number are pieces of one arc and get one feed

    moves, rows  the moves, and the rows (k,) whose feed is lower now
    """
    moves = operation.moves
    share = speed_shares(machine, operation, rotary, off_part).max(axis=1)
    rate = tip_speeds(operation)
    factor = np.where(share > 1.0, USABLE_SHARE / np.maximum(share, 1.0), 1.0)
    with np.errstate(invalid="ignore"):
        factor = np.where(factor < 1.0, np.minimum(np.maximum(factor, _LEAST_FEED / rate), 1.0), 1.0)
    first = np.flatnonzero(np.diff(together, prepend=together[:1] - 1))
    factor = np.repeat(np.minimum.reduceat(factor, first), np.diff(first, append=len(factor)))
    factor[(moves.kind == Kind.RAPID) | np.isnan(factor)] = 1.0
    return replace(moves, feed=np.where(factor < 1.0, moves.feed * factor, moves.feed)), np.flatnonzero(factor < 1.0)


class _Rows(NamedTuple):
    """Columns of an operation; ``rate`` is the speed of the tip, ``rotary`` the displayed positions."""

    tip: Floats2
    kind: Codes
    rate: Floats
    rotary: Floats2


class _RotaryAxes(NamedTuple):
    """Of both rotary axes, whether they are endless, and their rapid speeds, degrees/min."""

    endless: tuple[bool, bool]
    rapid: Pair


def _kernel_arguments(machine: Machine, operation: Operation, rotary: Floats) -> tuple[_Rows, _RotaryAxes]:
    first, second = (machine.axes[column].rapid for column in machine.rotary)
    rapid = (math.inf if first is None else first, math.inf if second is None else second)
    rows = _Rows(operation.moves.tip, operation.moves.kind, tip_speeds(operation), rotary)
    return rows, _RotaryAxes(is_endless(machine), rapid)


@kernel(writes="share")
def _speed_shares(
    rows: _Rows, axes: _RotaryAxes, off_part: OffPartTurns, share: Floats2
) -> tuple[float, int, int, int]:
    """Fill the shares (n, 2), if there is space; return the fields of ``FastestRow``."""
    tip, kind, rate, rotary = rows
    off_part_row, after = off_part
    largest, fastest_row, fastest_axis, count = 0.0, -1, 0, 0
    turn = 0
    for row in range(1, tip.shape[0]):
        while turn < len(off_part_row) and off_part_row[turn] < row:
            turn += 1
        if kind[row] == 0 or not rate[row] > 0.0:
            continue
        one, two = rotary[row, 0] - rotary[row - 1, 0], rotary[row, 1] - rotary[row - 1, 1]
        if turn < len(off_part_row) and off_part_row[turn] == row:
            one, two = rotary[row, 0] - after[turn, 0], rotary[row, 1] - after[turn, 1]
        if one == 0.0 and two == 0.0:
            continue
        if axes.endless[0]:
            one -= 360.0 * math.floor(one / 360.0 + 0.5)
        if axes.endless[1]:
            two -= 360.0 * math.floor(two / 360.0 + 0.5)
        one, two = abs(one), abs(two)
        x, y, z = tip[row, 0] - tip[row - 1, 0], tip[row, 1] - tip[row - 1, 1], tip[row, 2] - tip[row - 1, 2]
        length = math.sqrt(x * x + y * y + z * z)
        if length < REST_LENGTH:
            length = max(one, two)
            if length < REST_LENGTH:
                continue
        minutes = length / rate[row]
        one, two = one / minutes / axes.rapid[0], two / minutes / axes.rapid[1]
        if len(share):
            share[row, 0], share[row, 1] = one, two
        if one > 1.0 or two > 1.0:
            count += 1
        if max(one, two) > largest:
            largest, fastest_row, fastest_axis = max(one, two), row, 0 if one >= two else 1
    return largest, fastest_row, fastest_axis, count
