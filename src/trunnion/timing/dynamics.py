"""What the axes of a machine can do: speeds, accelerations and jerks, one of each for every axis.

Units: mm and degrees, seconds. What a definition does not state sets no limit: it is infinite.
"""

import math
from dataclasses import dataclass

import numpy as np

from trunnion.arrays import Floats
from trunnion.machines import Machine


@dataclass(frozen=True, slots=True, eq=False)
class AxisDynamics:
    """Limits of the five axes, in the order of ``Machine.axes``.

    speed         (5,) float64  mm/s or deg/s
    acceleration  (5,) float64  mm/s^2 or deg/s^2
    jerk          (5,) float64  mm/s^3 or deg/s^3
    """

    speed: Floats
    acceleration: Floats
    jerk: Floats

    @staticmethod
    def of(machine: Machine) -> "AxisDynamics":
        """What the definition of a machine states."""
        axes = machine.axes
        return AxisDynamics(
            np.array([math.inf if axis.rapid is None else axis.rapid / 60.0 for axis in axes]),
            np.array([math.inf if axis.acceleration is None else axis.acceleration for axis in axes]),
            np.full(len(axes), math.inf),
        )
