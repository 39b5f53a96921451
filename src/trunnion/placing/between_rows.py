"""How far slides may go beyond their samples while rotary axes turn between them.

Between two samples a slide is s(u) = a(u) . p(u) with the angles and the tip even in u, from 0 to 1. With the angle w
that both rotary axes turn together, the tip's way d, and the longest arm L from a rotary axis to the tip,

    |s''| <= k (w^2 L + 2 w d)

where k is the largest norm of a slide's normal. A curve leaves its chord by at most an eighth of that.
"""

import numpy as np

from trunnion.arrays import Floats
from trunnion.machines import Machine, kinematic_parameters
from trunnion.placing.moving_samples import STEP
from trunnion.placing.path_rows import PathRows


def most_between(machine: Machine, rows: PathRows, positions: Floats, zero: Floats) -> float:
    """The bound over the ways to all rows, mm, with the zero (3,) there; NaN if rotary axes stand between slides.

    Parameters
    ----------
    rows
        As the part is turned.
    positions : (n, 2) float64
        Of the rotary axes, degrees.
    """
    kinematics = kinematic_parameters(machine)
    turn = np.abs(np.diff(positions, axis=0))
    pieces = np.maximum(np.ceil(turn.max(axis=1, initial=0.0) / STEP), 1.0)
    counts = rows.straight[1:] & ~rows.begins[1:] & (turn.max(axis=1, initial=0.0) > 0.0) & (pieces <= 180.0 / STEP)
    if not counts.any():
        return 0.0
    if len(set(kinematics.rotary_below)) > 1:
        return np.nan
    angle = np.radians(turn.sum(axis=1) / pieces)[counts]
    way = (np.linalg.norm(np.diff(rows.tip, axis=0), axis=1) / pieces)[counts]
    arm = np.linalg.norm(rows.tip + zero - np.array(machine.axes[machine.rotary[0]].point), axis=1)
    arm = np.maximum(arm[1:], arm[:-1])[counts]
    arm += np.linalg.norm(kinematics.second_offset) + np.linalg.norm(kinematics.tool_offset)
    slides = np.linalg.norm(np.array(kinematics.slides_inverse).reshape(3, 3), axis=1).max()
    return float((slides * (angle**2 * arm + 2.0 * angle * way)).max() / 8.0)
