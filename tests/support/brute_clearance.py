"""The least distance of bodies over a path, as python-fcl tells it at many poses.

Shares nothing with placing by collisions: slides come from the inverse map, and the links of the machine move bodies.
"""

from collections.abc import Sequence
from dataclasses import replace

import fcl  # type: ignore[import-untyped]
import numpy as np

from tests.support.placed_paths import turned_by
from trunnion.arrays import Floats
from trunnion.machines import BodyBox, Machine, MachineBody, inverse, link_transforms
from trunnion.placing.path_rows import PathRows
from trunnion.simulation.meshes import TriangleMesh


def box_body(name: str, link: str, low: Sequence[float], high: Sequence[float]) -> MachineBody:
    """A box between two corners, in the machine frame, or of the spindle nose's for a body of the spindle."""
    a, b = np.array(low, np.float64), np.array(high, np.float64)
    x, y, z = ((a + b) / 2.0).tolist()
    u, v, w = (b - a).tolist()
    return MachineBody(name, link, BodyBox((u, v, w), (x, y, z)))


def model_of(mesh: TriangleMesh) -> fcl.BVHModel:
    """A mesh for fcl."""
    model = fcl.BVHModel()
    model.beginModel(len(mesh.faces), len(mesh.vertices))
    model.addSubModel(mesh.vertices, mesh.faces)
    model.endModel()
    return model


def brute_joints(machine: Machine, rows: PathRows, turn: float, zero: Floats, steps: int = 1) -> Floats:
    """Axis values of rows, and evenly between them, (k, 5); the path must stay within half a turn of each axis."""
    x, y, z = zero.tolist()
    there = replace(machine, workpiece_zero=(x, y, z))
    found = inverse(there, turned_by(turn, rows.tip), turned_by(turn, rows.axis))
    joints = found.joints[rows.branch, np.arange(len(rows))]
    for column in machine.rotary:
        last = 0.0
        for row in range(len(joints)):
            joints[row, column] += 360.0 * np.round((last - joints[row, column]) / 360.0)
            last = joints[row, column]
    shares = np.arange(steps) / steps
    between = joints[:-1, None] + shares[:, None] * np.diff(joints, axis=0)[:, None]
    return np.concatenate((between.reshape(-1, 5), joints[-1:]))


class BruteBodies:
    """Bodies on links, and bodies that are clamped with the part, in workpiece coordinates."""

    def __init__(
        self, machine: Machine, on_links: Sequence[tuple[str, TriangleMesh]], on_part: Sequence[TriangleMesh]
    ) -> None:
        self.machine = machine
        self.on_links = [(link, model_of(mesh)) for link, mesh in on_links]
        self.on_part = [model_of(mesh) for mesh in on_part]

    def least(self, pairs: Sequence[tuple[int, int]], joints: Floats, turn: float, zero: Floats) -> float:
        """The least distance of pairs; the second number of a pair counts bodies on links, then those on the part."""
        links = link_transforms(self.machine, joints)
        angle = np.radians(turn)
        clamped = np.eye(4)
        clamped[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
        clamped[:3, 3] = zero
        best = np.inf
        for one, other in pairs:
            link, model = self.on_links[one]
            if other < len(self.on_links):
                base, target = self.on_links[other]
                poses, still = links[base], target
            else:
                poses, still = links["workpiece"] @ clamped, self.on_part[other - len(self.on_links)]
            a, b = fcl.CollisionObject(model), fcl.CollisionObject(still)
            for k in range(len(joints)):
                a.setTransform(fcl.Transform(links[link][k][:3, :3], links[link][k][:3, 3]))
                b.setTransform(fcl.Transform(poses[k][:3, :3], poses[k][:3, 3]))
                best = min(best, max(fcl.distance(a, b, fcl.DistanceRequest()), 0.0))
        return float(best)
