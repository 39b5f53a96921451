"""A body that is not convex."""

import numpy as np

from trunnion.simulation.meshes import TriangleMesh


def vice() -> TriangleMesh:
    """A U of one surface: 100 wide, 40 high, a slot of 60 wide from height 10 on; along Y -20 to 20."""
    outline = np.array([[-50, 0], [50, 0], [50, 40], [30, 40], [30, 10], [-30, 10], [-30, 40], [-50, 40]], np.float64)
    front = np.column_stack((outline[:, 0], np.full(8, -20.0), outline[:, 1]))
    back = front + np.array([0.0, 40.0, 0.0])
    cap = [(0, 1, 4), (0, 4, 5), (1, 2, 3), (1, 3, 4), (0, 5, 7), (5, 6, 7)]
    faces = [*cap, *((8 + c, 8 + b, 8 + a) for a, b, c in cap)]
    for k in range(8):
        after = (k + 1) % 8
        faces += [(k, 8 + k, 8 + after), (k, 8 + after, after)]
    return TriangleMesh(np.concatenate((front, back)), np.array(faces))
