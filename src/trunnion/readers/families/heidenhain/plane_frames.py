"""Datum shift, mirror, rotation and scale, and the planes of the PLANE function, as affine maps.

All angles are in degrees and right-handed. The matrix of a plane maps positions in it to those outside of it.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.messages import Wording
from trunnion.readers.control.affine_map import AffineMap, rotation_matrix
from trunnion.readers.families.heidenhain.parameters import KlartextError

#: Vectors that are shorter, or parallel within this, make no plane.
_FLAT: Final = 1e-6


@dataclass(frozen=True, slots=True)
class Datum:
    """The values of cycles 7, 8, 10, 11 and 26.

    shift      mm
    mirrored   of X, Y and Z
    angle      about the tool axis
    scale      of X, Y and Z, about ``centre`` (mm)
    """

    shift: tuple[float, float, float] = (0.0, 0.0, 0.0)
    mirrored: tuple[bool, bool, bool] = (False, False, False)
    angle: float = 0.0
    scale: tuple[float, float, float] = (1.0, 1.0, 1.0)
    centre: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def frame(self, plane: int) -> AffineMap:
        """Return the map: first scaled, then rotated about the axis ``plane``, mirrored, and shifted.

        That this order holds whatever the order of the cycles is unconfirmed.
        """
        scale, centre = np.diag(self.scale), np.array(self.centre)
        mirror = np.diag([-1.0 if mirrored else 1.0 for mirrored in self.mirrored])
        scaled = AffineMap(scale, centre - scale @ centre)
        return AffineMap(mirror @ rotation_matrix(plane, self.angle), np.array(self.shift)).compose(scaled)


def spatial(a: float, b: float, c: float) -> Floats:
    """Return the plane of spatial angles, degrees, about the fixed X, Y, Z in this order: (3, 3), axes as columns."""
    return rotation_matrix(2, c) @ rotation_matrix(1, b) @ rotation_matrix(0, a)


def euler(precession: float, nutation: float, rotation: float) -> Floats:
    """Return the plane of Euler angles, about Z, the new X and the new Z, degrees: (3, 3), its axes as columns."""
    return rotation_matrix(2, precession) @ rotation_matrix(0, nutation) @ rotation_matrix(2, rotation)


def from_vectors(base: Floats, normal: Floats) -> Floats:
    """Return the plane with Z along ``normal`` and X along the part of ``base`` in the plane, (3, 3)."""
    z = _unit(normal)
    along = base / max(float(np.linalg.norm(base)), _FLAT)
    x = _unit(along - (along @ z) * z)
    return np.column_stack((x, np.cross(z, x), z))


def through_points(first: Floats, second: Floats, third: Floats) -> Floats:
    """Return the plane with X from the first point to the second, and the third point on the side of +Y, (3, 3)."""
    x = _unit(second - first)
    lateral = third - first
    return from_vectors(x, np.cross(x, lateral / max(float(np.linalg.norm(lateral)), _FLAT)))


def _unit(vector: Floats) -> Floats:
    length = float(np.linalg.norm(vector))
    if not _FLAT < length < np.inf:
        raise KlartextError(Wording("NC210", "vectors_points_make_no_plane"))
    return np.asarray(vector / length)


#: The words that define a plane, by its kind; those of RELATIV and AXIAL depend on more.
PLANE_WORDS: Final = {
    "RESET": (),
    "SPATIAL": ("SPA", "SPB", "SPC"),
    "EULER": ("EULPR", "EULNU", "EULROT"),
    "VECTOR": ("BX", "BY", "BZ", "NX", "NY", "NZ"),
    "POINTS": tuple(f"P{k}{axis}" for k in (1, 2, 3) for axis in "XYZ"),
}


def plane(kind: str, values: Mapping[str, float]) -> Floats:
    """Return the matrix of a PLANE block, (3, 3); not of RELATIV and AXIAL, which depend on the axes.

    Raises ``KlartextError`` if a word is missing, or if the values define no plane.
    """

    def need(*names: str) -> list[float]:
        missing = [name for name in names if name not in values]
        if missing:
            raise KlartextError(Wording("NC210", "plane_needs", kind=kind, missing=tuple(missing)))
        return [values[name] for name in names]

    match kind:
        case "SPATIAL":
            return spatial(*need("SPA", "SPB", "SPC"))
        case "EULER":
            return euler(*need("EULPR", "EULNU", "EULROT"))
        case "VECTOR":
            return from_vectors(np.array(need("BX", "BY", "BZ")), np.array(need("NX", "NY", "NZ")))
        case "POINTS":
            points = [np.array(need(f"P{k}X", f"P{k}Y", f"P{k}Z")) for k in (1, 2, 3)]
            return through_points(*points)
        case _:
            raise KlartextError(Wording("NC220", "plane_not_simulated", kind=kind))
