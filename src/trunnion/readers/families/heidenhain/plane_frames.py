"""Datum shift, mirror, rotation and scale, and the planes of the PLANE function, as affine maps.

All angles are in degrees and right-handed. A plane's matrix takes positions in the tilted plane to the one below it.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.readers.control.affine_map import AffineMap, rotation_matrix
from trunnion.readers.families.heidenhain.parameters import KlartextError

#: Vectors shorter than this, or so nearly parallel, make no plane.
_FLAT: Final = 1e-6


@dataclass(frozen=True, slots=True)
class Datum:
    """What cycles 7, 8, 10, 11 and 26 have set.

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
        """Return the map: scaled first, then turned about the axis ``plane``, mirrored, and shifted.

        Cycles may come in any order; that they always act in this one is unconfirmed.
        """
        scale, centre = np.diag(self.scale), np.array(self.centre)
        mirror = np.diag([-1.0 if mirrored else 1.0 for mirrored in self.mirrored])
        scaled = AffineMap(scale, centre - scale @ centre)
        return AffineMap(mirror @ rotation_matrix(plane, self.angle), np.array(self.shift)).compose(scaled)


def spatial(a: float, b: float, c: float) -> Floats:
    """(3, 3): spatial angles, about the fixed axes X, Y and Z in this order."""
    return rotation_matrix(2, c) @ rotation_matrix(1, b) @ rotation_matrix(0, a)


def euler(precession: float, nutation: float, rotation: float) -> Floats:
    """(3, 3): about Z, the new X, the new Z."""
    return rotation_matrix(2, precession) @ rotation_matrix(0, nutation) @ rotation_matrix(2, rotation)


def from_vectors(base: Floats, normal: Floats) -> Floats:
    """(3, 3): Z along ``normal``, X as near to ``base`` as it goes; vectors of any length."""
    z = _unit(normal)
    along = base / max(float(np.linalg.norm(base)), _FLAT)
    x = _unit(along - (along @ z) * z)
    return np.column_stack((x, np.cross(z, x), z))


def through_points(first: Floats, second: Floats, third: Floats) -> Floats:
    """(3, 3): X from the first point to the second, the third on the side of Y."""
    x = _unit(second - first)
    lateral = third - first
    return from_vectors(x, np.cross(x, lateral / max(float(np.linalg.norm(lateral)), _FLAT)))


def _unit(vector: Floats) -> Floats:
    length = float(np.linalg.norm(vector))
    if not _FLAT < length < np.inf:
        raise KlartextError("the vectors or points make no plane")
    return np.asarray(vector / length)


def plane(kind: str, values: Mapping[str, float]) -> Floats:
    """Return the matrix of a PLANE block, (3, 3), but for RELATIV and AXIAL, which need more than their words.

    Raises
    ------
    KlartextError
        If a word is missing or the plane is none.
    """

    def need(*names: str) -> list[float]:
        missing = [name for name in names if name not in values]
        if missing:
            raise KlartextError(f"PLANE {kind} needs {', '.join(missing)}")
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
            raise KlartextError(f"PLANE {kind} is not simulated")
