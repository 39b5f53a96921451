"""Frame statements TRANS, ROT, SCALE and MIRROR as affine maps."""

from collections.abc import Mapping

import numpy as np

from trunnion.readers.control.affine_map import AffineMap, rotation_matrix


def frame_of_statement(word: str, values: Mapping[str, float], plane: int) -> AffineMap:
    """Return the frame of a statement; ``word`` without the A of additive statements.

    Parameters
    ----------
    values
        Words of the block: X, Y, Z (mm, degrees or factors) and RPL (degrees).
    plane
        Axis normal to the working plane: 2 for G17.
    """
    x, y, z = (values.get(letter) for letter in "XYZ")
    match word:
        case "TRANS":
            return AffineMap(np.eye(3), np.array([x or 0.0, y or 0.0, z or 0.0]))
        case "ROT":
            linear = np.eye(3)
            # Several angles in one block rotate first about Z, then about the new Y, then about the new X.
            for axis, angle in ((2, z), (1, y), (0, x)):
                if angle is not None:
                    linear = linear @ rotation_matrix(axis, angle)
            if "RPL" in values:
                linear = linear @ rotation_matrix(plane, values["RPL"])
            return AffineMap(linear)
        case "SCALE":
            return AffineMap(np.diag([1.0 if factor is None else factor for factor in (x, y, z)]))
        case _:
            return AffineMap(np.diag([1.0 if value is None else -1.0 for value in (x, y, z)]))
