"""What a place costs: travel of the slides, time, feeds that the axes cannot reach; as convex functions of the zero.

Slides are linear in the workpiece zero, so their steps from row to row are, and

    slides     the sum of |steps| of all slides, mm
    time       the sum of the longest of the time at the programmed feed and that of each axis at its rapid speed, s
    overspeed  what the second is longer than the first in rows at feed, summed, s; and the number of such rows

are convex. Accelerations are not in them, but in ``planned_seconds``.
"""

from enum import StrEnum
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Floats2, Floats3
from trunnion.jit import kernel
from trunnion.machines import Machine
from trunnion.placing.axis_equations import axis_equations
from trunnion.placing.path_rows import PathRows
from trunnion.records import dataclass
from trunnion.timing import CORNER_TOLERANCE, AxisDynamics, Path, piece_seconds


class Goal(StrEnum):
    """What the best place is best for."""

    MARGIN = "margin"
    ROTARY = "rotary"
    SLIDES = "slides"
    TIME = "time"
    OVERSPEED = "overspeed"
    COLLISIONS = "collisions"


#: Goals whose cost depends on the place at one turn.
OF_PLACE: Final = (Goal.SLIDES, Goal.TIME, Goal.OVERSPEED)

#: Number of each for the kernel.
_CODES: Final = {Goal.SLIDES: 0, Goal.TIME: 1, Goal.OVERSPEED: 2}


def rotary_travel(rows: PathRows, positions: Floats) -> float:
    """How far both rotary axes turn together, degrees, from the start of each stretch on; ``positions`` (n, 2)."""
    steps = np.diff(positions, axis=0, prepend=positions[:1])
    firsts = [stretch.first for stretch in rows.stretches]
    steps[firsts] = positions[firsts] - rows.start
    return float(np.abs(steps).sum())


@dataclass(frozen=True, slots=True, eq=False)
class PlaceCost:
    """The cost of places for a path at one turn.

    normals  (n, 3, 3) and offsets (n, 3): slides of the rows
    begins   (n,) rows that no way leads to
    seconds  (n,) at the programmed feed; 0 at rapid
    turning  (n,) seconds that the rotary axes take at their rapid speed
    speeds   (3,) rapid speeds of the slides, mm/s; infinite where not stated
    """

    goal: Goal
    normals: Floats
    offsets: Floats
    begins: Flags
    seconds: Floats
    turning: Floats
    speeds: Floats

    @staticmethod
    def of(goal: Goal, machine: Machine, rows: PathRows, positions: Floats) -> "PlaceCost":
        """Of rows as the part is turned; ``machine`` without a workpiece zero, ``positions`` (n, 2) degrees."""
        normals, offsets, _ = axis_equations(machine, rows.tip, positions, rows.length)
        steps = np.abs(np.diff(positions, axis=0, prepend=positions[:1]))
        turning = np.zeros(len(rows))
        for k, column in enumerate(machine.rotary):
            if rapid := machine.axes[column].rapid:
                turning = np.maximum(turning, 60.0 * steps[:, k] / rapid)
        speeds = np.array([(machine.axes[column].rapid or np.inf) / 60.0 for column in machine.linear])
        return PlaceCost(goal, normals, offsets, rows.begins, rows.seconds, turning, speeds)

    def at(self, zero: Floats) -> tuple[float, Floats, int]:
        """Return the cost at a place (3,), a subgradient (3,), and the number of rows whose feed is not reached."""
        gradient = np.zeros(3)
        cost, count = _cost(
            _CODES[self.goal], self.normals, self.offsets, self.begins, self.seconds, self.turning, self.speeds, zero,
            gradient,
        )  # fmt: skip
        return cost, gradient, count

    def value(self, zero: Floats) -> float:
        """Return what is told of a place: the cost, or the number of rows."""
        cost, _, count = self.at(zero)
        return float(count) if self.goal is Goal.OVERSPEED else cost


@kernel(writes="gradient")
def _cost(
    goal: int,
    normals: Floats3,
    offsets: Floats2,
    begins: Flags,
    seconds: Floats,
    turning: Floats,
    speeds: Floats,
    zero: Floats,
    gradient: Floats,
) -> tuple[float, int]:
    """Return the cost and the number of rows whose feed is not reached; adds a subgradient of the cost."""
    cost, count = 0.0, 0
    for row in range(1, len(offsets)):
        if begins[row]:
            continue
        longest, slowest, direction = turning[row], -1, 0.0
        for k in range(3):
            a, b = normals[row, k], normals[row - 1, k]
            step = offsets[row, k] - offsets[row - 1, k]
            for j in range(3):
                step += (a[j] - b[j]) * zero[j]
            sign = 1.0 if step >= 0.0 else -1.0
            if goal == 0:
                cost += abs(step)
                for j in range(3):
                    gradient[j] += sign * (a[j] - b[j])
                continue
            needed = abs(step) / speeds[k]
            if needed > longest:
                longest, slowest, direction = needed, k, sign / speeds[k]
        if goal == 0:
            continue
        late = longest > seconds[row]
        if late and seconds[row] > 0.0 and longest > seconds[row] * (1.0 + 1e-9):
            count += 1
        if goal == 1:
            cost += max(longest, seconds[row])
        elif seconds[row] > 0.0 and late:
            cost += longest - seconds[row]
        if late and slowest >= 0 and (goal == 1 or seconds[row] > 0.0):
            for j in range(3):
                gradient[j] += direction * (normals[row, slowest, j] - normals[row - 1, slowest, j])
    return cost, count


def planned_seconds(machine: Machine, rows: PathRows, positions: Floats, zero: Floats) -> float:
    """Seconds with the workpiece zero at a place (3,), of rows as the part is turned, by the planner of speeds.

    It counts accelerations, jerks and corners; approaches, tool changes and dwells are not among the rows.

    ``machine`` is without a workpiece zero; ``positions`` (n, 2) are those of the rotary axes, degrees.
    """
    normals, offsets, _ = axis_equations(machine, rows.tip, positions, rows.length)
    joints = np.empty((len(rows), 5))
    joints[:, list(machine.linear)] = normals @ zero + offsets
    joints[:, list(machine.rotary)] = positions
    steps = np.diff(joints, axis=0, prepend=joints[:1])
    begins = rows.begins
    steps[begins] = 0.0
    length = np.linalg.norm(np.diff(rows.tip, axis=0, prepend=rows.tip[:1]), axis=1)
    length = np.where(length > 0.0, length, np.abs(steps).max(axis=1))
    length[begins] = 0.0
    is_timed = rows.seconds > 0.0
    rate = np.where(is_timed, 60.0 * length / np.where(is_timed, rows.seconds, 1.0), np.inf)
    path = Path(
        steps,
        length,
        rate,
        np.full(len(rows), CORNER_TOLERANCE),
        np.append(begins[1:], True),
        np.zeros(len(rows), np.bool_),
        np.zeros(0, np.int64),
    )
    return float(piece_seconds(path, AxisDynamics.of(machine)).sum())
