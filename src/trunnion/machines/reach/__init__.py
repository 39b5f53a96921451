"""What a machine reaches: which tool axes, and where the tip can be with each.

In:     a ``Machine`` with its limits.
Out:    rotary positions of tool axes; the body of the tips of one rotary position; volumes of many such bodies.
Units:  mm and degrees, workpiece coordinates.

For one rotary position the tip is linear in the slides, so all tips that the slides reach fill a parallelepiped, whose
volume is exact. Volumes of what several of them fill, or share, are bounded from below and above.
"""

from trunnion.machines.reach.bodies import PoseBodies, pose_bodies
from trunnion.machines.reach.points import PointReach, reached_points
from trunnion.machines.reach.poses import AxisPoses, axis_poses
from trunnion.machines.reach.volumes import ReachedVolume, reached_volumes

__all__ = [
    "AxisPoses",
    "PointReach",
    "PoseBodies",
    "ReachedVolume",
    "axis_poses",
    "pose_bodies",
    "reached_points",
    "reached_volumes",
]
