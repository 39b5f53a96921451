"""Datum shift, mirror, rotation and scale, and the planes of the PLANE function, as affine maps.

All angles are in degrees and right-handed. The matrix of a plane maps positions in it to those outside of it.
"""

import math
from collections.abc import Mapping
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.messages import Wording
from trunnion.readers.control.affine_map import AffineMap, rotation_matrix
from trunnion.readers.families.heidenhain.parameters import KlartextError
from trunnion.records import dataclass

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


def projected(main: float, minor: float, turn: float, *, rising: bool) -> Floats:
    """Return the plane of projection angles, degrees: (3, 3), its axes as columns.

    main    under which the plane is seen in Z/X: as a turn about Y, or ``rising`` with X
    minor   under which it is seen in Y/Z: as a turn about X, so that it rises with Y
    turn    of the plane about its Z, from its line in Z/X
    """
    seen, side = math.radians(-main if rising else main), math.radians(minor)
    in_zx = np.array([math.cos(seen), 0.0, -math.sin(seen)])
    in_yz = np.array([0.0, math.cos(side), math.sin(side)])
    return from_vectors(in_zx, np.cross(in_zx, in_yz)) @ rotation_matrix(2, turn)


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
    "PROJECTED": ("PROPR", "PROMIN", "ROT"),
}


#: PROPR and PROMIN are less than this, degrees.
_MOST_PROJECTED: Final = 89.9999


def plane(kind: str, values: Mapping[str, float], projected_angles: str) -> Floats:
    """Return the matrix of a PLANE block, (3, 3); not of RELATIV and AXIAL, which depend on the axes.

    projected_angles  what the angles of PROJECTED mean on the control, as its definition says

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
        case "PROJECTED":
            main, minor, turn = need("PROPR", "PROMIN", "ROT")
            if projected_angles not in ("turning", "rising"):
                raise KlartextError(Wording("NC220", "projected_angles_unknown"))
            if max(abs(main), abs(minor)) > _MOST_PROJECTED:
                raise KlartextError(Wording("NC210", "projected_angle_beyond", most=_MOST_PROJECTED))
            return projected(main, minor, turn, rising=projected_angles == "rising")
        case _:
            raise KlartextError(Wording("NC211", "unknown_word", word=kind))
