"""The time of the rows of a path at a place, as the planner of speeds has it: with accelerations, jerks and corners.

Rows are straight motions of all axes together; approaches, tool changes and dwells are not among them.
"""

import numpy as np

from trunnion.arrays import Floats
from trunnion.machines import Machine
from trunnion.placing.axis_equations import axis_equations
from trunnion.placing.path_rows import PathRows
from trunnion.timing import CORNER_TOLERANCE, AxisDynamics, Path, piece_seconds


def planned_seconds(machine: Machine, rows: PathRows, positions: Floats, zero: Floats) -> float:
    """Seconds with the workpiece zero at a place (3,), of rows as the part is turned.

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
