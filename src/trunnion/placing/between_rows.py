"""How far slides may go beyond their samples while rotary axes turn between them.

``model.turning_lines`` has the bound; between two samples angles and tip move evenly.
"""

from dataclasses import replace

import numpy as np

from trunnion.arrays import Floats
from trunnion.machines import Machine, kinematic_parameters
from trunnion.model.turning_lines import chord_excursion, longest_arms
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
    x, y, z = zero.tolist()
    if rows.length is not None and np.isfinite(rows.length).any():
        machine = replace(machine, tool_length=max(machine.tool_length or 0.0, float(np.nanmax(rows.length))))
    kinematics = kinematic_parameters(replace(machine, workpiece_zero=(x, y, z)))
    turn = np.abs(np.diff(positions, axis=0))
    pieces = np.maximum(np.ceil(turn.max(axis=1, initial=0.0) / STEP), 1.0)
    counts = rows.straight[1:] & ~rows.begins[1:] & (turn.max(axis=1, initial=0.0) > 0.0) & (pieces <= 180.0 / STEP)
    if not counts.any():
        return 0.0
    if len(set(kinematics.rotary_below)) > 1:
        return np.nan
    angle = np.radians(turn.sum(axis=1) / pieces)[counts]
    way = (np.linalg.norm(np.diff(rows.tip, axis=0), axis=1) / pieces)[counts]
    arm = longest_arms(kinematics, rows.tip)
    arm = np.maximum(arm[1:], arm[:-1])[counts]
    slides = np.linalg.norm(np.array(kinematics.slides_inverse).reshape(3, 3), axis=1).max()
    return float((slides * chord_excursion(angle, way, arm)).max())
