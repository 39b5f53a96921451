"""The planner: how the machine makes the motion that a toolpath asks for.

In:     operations in the CAM's coordinate systems, and a machine.
Out:    ``Motion``: the same operations in the program's coordinate system, with five axis positions a row, and what
        was found wrong on the way.
Knows nothing of text, neither of CL files nor of NC programs.
"""

from trunnion.planning.options import ControlCapabilities, PlanOptions
from trunnion.planning.planner import plan
from trunnion.planning.poses.placement import follow_nearest, solve_rotary
from trunnion.planning.retracts.clearance import Clearance, ClearanceSurface
from trunnion.planning.speed.operation_time import operation_seconds

#: Kernels that most programs need.
KERNELS = (solve_rotary, follow_nearest)

__all__ = [
    "KERNELS",
    "Clearance",
    "ClearanceSurface",
    "ControlCapabilities",
    "PlanOptions",
    "operation_seconds",
    "plan",
]
