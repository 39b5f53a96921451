"""The planner: how a machine makes a toolpath.

In:     operations in the CAM's coordinate systems, a machine, options of the user and capabilities of the control.
Out:    ``Plan``: motions in the program's coordinate system with rotary positions for every row, problems, and
        decisions.
It knows nothing of text, neither of CL files nor of NC programs.
"""

from trunnion.planning.options import ControlCapabilities, PlanOptions
from trunnion.planning.planner import plan
from trunnion.planning.poses.nearest_path import follow_nearest, solve_rotary
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
