"""A part that is clamped turned, simulated in the coordinates in which it is drawn: the machine is turned about it.

In:     a run in the coordinates of its program, and the matrix that turns the part as it is drawn to how it is clamped.
Out:    the run as the part has it; meshes as they are clamped; places of the program as those of the drawing.
Units:  mm, unit vectors; both workpiece frames have one origin, the workpiece zero.

The slides of the turned machine go along its own directions, so all that a run says of axes and their positions stays.
"""

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from trunnion.arrays import Floats
from trunnion.machines import Machine
from trunnion.machines.machine import Vector
from trunnion.model.run import Run
from trunnion.simulation.finding import Finding
from trunnion.simulation.meshes import TriangleMesh


def run_of_drawn_part(run: Run, turn: Floats) -> Run:
    """Return the run past the part as it is drawn; ``turn`` (3, 3) takes directions of the drawing to the program's.

    Words of the program are in its own coordinates, which are those of a rotated frame then (``Run.planes``).
    """
    is_tip = run.state.xyz_is_tip.column().astype(np.bool_)
    xyz = run.xyz.copy()
    xyz[is_tip] = xyz[is_tip] @ turn
    own_frame = np.concatenate((turn.T, np.zeros((3, 1))), axis=1)
    planes = np.concatenate((turn.T @ run.planes, own_frame[None]))
    plane = run.state.plane
    in_frames = replace(plane, values=np.where(plane.values < 0, len(run.planes), plane.values).astype(np.int64))
    return replace(
        run,
        machine=_about_the_part(run.machine, turn),
        xyz=xyz,
        state=replace(run.state, plane=in_frames),
        arcs=replace(run.arcs, centre=run.arcs.centre @ turn, normal=run.arcs.normal @ turn),
        normals=replace(run.normals, vector=run.normals.vector @ turn),
        splines=run.splines.with_poles(run.splines.poles @ turn),
        compensation_planes=run.compensation_planes @ turn,
        planes=planes,
    )


def _about_the_part(machine: Machine, turn: Floats) -> Machine:
    """Return the machine turned about its workpiece zero as the part is turned back; its bodies stay away."""
    zero = np.array(machine.workpiece_zero or (0.0, 0.0, 0.0), np.float64)

    def direction(vector: Vector) -> Vector:
        x, y, z = (np.array(vector) @ turn).tolist()
        return x, y, z

    def point(place: Vector) -> Vector:
        x, y, z = (zero + (np.array(place) - zero) @ turn).tolist()
        return x, y, z

    axes = tuple(replace(axis, direction=direction(axis.direction), point=point(axis.point)) for axis in machine.axes)
    return replace(
        machine,
        axes=axes,
        spindle_direction=direction(machine.spindle_direction),
        spindle_point=point(machine.spindle_point),
        bodies=(),
    )


def as_clamped(mesh: TriangleMesh, turn: Floats) -> TriangleMesh:
    """Return a mesh that is given as it is drawn, as it stands on the machine, in workpiece coordinates."""
    pose = np.eye(4)
    pose[:3, :3] = turn
    return mesh.moved(pose)


def places_of_drawing(collisions: Iterable[Finding], turn: Floats) -> list[Finding]:
    """Return what touches, with its places in the coordinates of the drawing."""
    found = []
    for each in collisions:
        x, y, z = (np.array(each.place) @ turn).tolist()
        found.append(replace(each, place=(x, y, z)))
    return found
