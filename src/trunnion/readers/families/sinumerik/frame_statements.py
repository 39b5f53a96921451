"""Frame statements TRANS, ROT, SCALE and MIRROR as affine maps."""

from collections.abc import Mapping
from typing import Final

import numpy as np

from trunnion.readers.control.affine_map import AffineMap, rotation_matrix

#: Frames are the same within this, mm and parts of one.
_SAME: Final = 1e-9


def frame_of_statement(word: str, values: Mapping[str, float], plane: int) -> AffineMap:
    """Return the frame of a statement; ``word`` without the A of additive statements.

    values  words of the block: X, Y, Z (mm, degrees or factors) and RPL (degrees)
    plane   axis normal to the working plane: 2 for G17
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


def state_of_frame(word: str, frame: AffineMap) -> str:
    """Return what is on behind a statement: "" if its frame changes nothing, TRANS if it only shifts, else the word.

    ``TRANS X0 Y0 Z0`` and statements that undo each other switch a frame off as TRANS alone does.
    """
    if not np.allclose(frame.linear, np.eye(3), rtol=0.0, atol=_SAME):
        return word
    return "TRANS" if np.abs(frame.shift).max() > _SAME else ""
