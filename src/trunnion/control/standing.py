"""Planes that a control takes from where the rotary axes stand: no words say their angles.

The plane's zero is the work offset's, its axes are those of the machine turned with the tool. It is worked out for the
rotary position as it is printed, so that rounding an angle costs nothing at the tip.
"""

from dataclasses import replace

import numpy as np

from trunnion.arrays import Floats
from trunnion.machine import Machine, forward, slide_positions
from trunnion.nc import counts
from trunnion.plan import Motion
from trunnion.plan.frames import frame_of
from trunnion.toolpath import Frame


def on_its_pose(machine: Machine, motion: Motion, decimals: int) -> Motion:
    """A motion in a tilted plane, in the plane of its rotary position printed with so many decimals."""
    rotary = counts(np.ascontiguousarray(motion.rotary[0]), decimals) / 10.0**decimals
    return replace(motion, plane=plane_of_pose(machine, rotary), rotary=np.tile(rotary, (len(motion.rotary), 1)))


def plane_of_pose(machine: Machine, rotary: Floats) -> Frame:
    """The plane on which the tool stands at a rotary position (2,), degrees, as seen from the workpiece."""
    joints = np.zeros((1, 5))
    joints[0, list(machine.rotary)] = rotary
    x, y = (
        forward(replace(machine, spindle_direction=direction), joints)[1][0]
        for direction in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0))
    )
    return frame_of(np.zeros(3), x, y)


def carried_along(machine: Machine, place: Floats, before: Motion, after: Motion) -> Floats:
    """Where a tool at ``place`` (3,) of one motion's plane is in that of the next, once the rotary axes have turned.

    The slides stand still meanwhile, mm.
    """
    assert before.plane is not None
    assert after.plane is not None
    tip = before.plane.matrix() @ place + np.array(before.plane.origin)
    joints = slide_positions(machine, tip[None], before.rotary[:1])
    joints[:, list(machine.rotary)] = after.rotary[:1]
    there = forward(machine, joints)[0][0]
    return np.asarray(after.plane.matrix().T @ (there - np.array(after.plane.origin)))
