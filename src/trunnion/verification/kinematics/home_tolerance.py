"""How near to home an axis is at home, and which one leads the tool away from the part."""

from typing import Final

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.machines import Machine
from trunnion.model.run import Run

#: An axis is at home within this, mm or degrees; a slide whose position is programmed in inches within the second, a
#: ten-thousandth of an inch: few homes are whole numbers of the last digit of inches.
HOME_TOLERANCE: Final = 1e-6
INCH_HOME_TOLERANCE: Final = 2.6e-3


def home_tolerance(run: Run, rows: Ints) -> Floats:
    """Within what axes are at home at rows, (k, 5) mm or degrees."""
    tolerance = np.full((len(rows), len(run.machine.axes)), HOME_TOLERANCE)
    for slide in run.machine.linear:
        tolerance[run.state.inches.at(rows), slide] = INCH_HOME_TOLERANCE
    return tolerance


def spindle_slide(machine: Machine) -> tuple[int, float]:
    """Column of the slide along the spindle, and whether its growing values lead away from the part (1.0 or -1.0)."""
    along = {k: float(np.dot(machine.axes[k].direction, machine.spindle_direction)) for k in machine.linear}
    column = max(along, key=lambda k: abs(along[k]))
    return column, float(np.copysign(1.0, along[column] * machine.axes[column].sense))
