"""The planner: how the machine makes the motion that a toolpath asks for.

In:     operations in the CAM's coordinate systems, and a machine.
Out:    ``Motion``: the same operations in the program's coordinate system, with five axis positions a row, and what
        was found wrong on the way.
Knows nothing of text, neither of CL files nor of NC programs.
"""

from trunnion.plan.clearance import Clearance, Surface
from trunnion.plan.duration import seconds
from trunnion.plan.motion import Decision, Departures, Manner, Motion, Plan, Pole, Why
from trunnion.plan.placing import lean, straight_on
from trunnion.plan.planner import plan
from trunnion.plan.wishes import Wishes

#: Kernels that most programs need.
KERNELS = (lean, straight_on)

__all__ = [
    "KERNELS",
    "Clearance",
    "Decision",
    "Departures",
    "Manner",
    "Motion",
    "Plan",
    "Pole",
    "Surface",
    "Why",
    "Wishes",
    "plan",
    "seconds",
]
