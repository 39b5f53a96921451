"""What a machine can do: speeds, accelerations and jerks of its axes, and what tool changes and its spindle take.

Units: mm and degrees, seconds. What a definition does not state sets no limit and takes no time.
"""

import math

import numpy as np

from trunnion.arrays import Floats
from trunnion.machines import Machine
from trunnion.records import dataclass


@dataclass(frozen=True, slots=True, eq=False)
class AxisDynamics:
    """Limits of the five axes, in the order of ``Machine.axes``, and the times of what is no motion.

    speed         (5,) float64  mm/s or deg/s
    acceleration  (5,) float64  mm/s^2 or deg/s^2
    jerk          (5,) float64  mm/s^3 or deg/s^3
    spindle       how fast the speed of the spindle changes, rev/min per second
    tool_change   seconds from the end of one row to the begin of the next
    """

    speed: Floats
    acceleration: Floats
    jerk: Floats
    spindle: float = math.inf
    tool_change: float = 0.0

    @property
    def has_jerk(self) -> bool:
        """Whether the jerk of an axis is limited."""
        return bool(np.isfinite(self.jerk).any())

    @staticmethod
    def of(machine: Machine) -> "AxisDynamics":
        """Return what the definition of a machine states."""
        axes, facts = machine.axes, machine.facts
        return AxisDynamics(
            np.array([math.inf if axis.rapid is None else axis.rapid / 60.0 for axis in axes]),
            np.array([math.inf if axis.acceleration is None else axis.acceleration for axis in axes]),
            np.array([math.inf if axis.jerk is None else axis.jerk for axis in axes]),
            math.inf if facts.spindle_acceleration_rpm_s is None else facts.spindle_acceleration_rpm_s,
            facts.tool_change_s or 0.0,
        )
