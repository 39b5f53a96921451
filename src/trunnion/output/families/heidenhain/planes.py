"""The values of PLANE blocks: one plane as angles, vectors, points and turns."""

import math
from collections.abc import Mapping
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.controls.template import Value
from trunnion.controls.vocabulary import PROJECTED_ANGLES
from trunnion.messages import Wording
from trunnion.output.coordinates.euler_angles import euler_zxz_angles, tait_bryan_angles

_SPATIAL: Final = ("spatial_c", "spatial_b", "spatial_a")
_VECTORS: Final = ("base_x", "base_y", "base_z", "normal_x", "normal_y", "normal_z")
_EULER: Final = ("euler_precession", "euler_nutation", "euler_rotation")
_RELATIVE: Final = ("relative_first", "relative_tilt", "relative_last")
_POINTS: Final = ("second_x", "second_y", "second_z", "third_x", "third_y", "third_z")
_PROJECTED: Final = ("projected_main", "projected_minor", "projected_turn")

#: The values of all forms, which templates may print.
PLANE_FIELDS: Final = (*_SPATIAL, *_VECTORS, *_EULER, *_RELATIVE, *_POINTS, *_PROJECTED)

#: How far the second and the third point are from the first: four decimals are then as exact as the seven of a vector.
_POINT_DISTANCE: Final = 1000.0

#: Angles within this of zero are noise, degrees.
_NOISE: Final = 1e-9

#: The most that a plane of projected angles may be tilted, degrees: half a digit of both turns a plane of tilt t by
#: (1 + cos² t) / (2 cos t) digits, and beyond this by more than the three angles of another form do.
_MOST_TILT: Final = 67.0

#: AXIAL has the machine's X, within this, degrees.
_SAME_X: Final = 1e-4


def plane_values(plane: Floats | None, projected_angles: str) -> dict[str, Value]:
    """Return the values of all forms for a plane, (3, 3) with its axes as columns; None for each without a plane.

    SPA, SPB and SPC turn about the fixed axes X, then Y, then Z: as about Z, the new Y and the newest X. EULPR is from
    -180 to 180, EULNU from 0 to 180, EULROT from 0 to 360 degrees, as the manual has them. RELATIV turns by the same
    three angles one after the other, so that no plane on the way needs another tool axis than the last one.
    """
    if plane is None:
        return dict.fromkeys(PLANE_FIELDS)
    spatial = [180.0 if angle < -179.99999999 else angle for angle in tait_bryan_angles(plane, (2, 1, 0))]
    vectors = [*plane[:, 0].tolist(), *plane[:, 2].tolist()]
    precession, nutation, rotation = (_quiet(angle) for angle in euler_zxz_angles(plane))
    euler = (precession, nutation, rotation + 360.0 if rotation < 0.0 else rotation)
    relative = (precession or None, nutation or None, rotation)
    points = (_POINT_DISTANCE * plane[:, :2]).T.ravel().tolist()
    projected = _projected(plane, projected_angles) if _has_projection(plane) else (None, None, None)
    values = (*spatial, *vectors, *euler, *relative, *points, *projected)
    return dict(zip(PLANE_FIELDS, values, strict=True))


def validate_plane(settings: Mapping[str, str], plane: Floats, of_pose: Floats) -> Wording | None:
    """Return why the form of the settings cannot say a plane: AXIAL with an X of its own, PROJECTED too steep or
    with angles of unknown meaning.
    """
    form = settings.get("plane")
    if form == "axial":
        off = math.degrees(math.acos(min(1.0, float(plane[:, 0] @ of_pose[:, 0]))))
        return Wording("CTL640", "axial_other_x", angle=off) if off > _SAME_X else None
    if form == "projected":
        if settings.get(PROJECTED_ANGLES) not in ("turning", "rising"):
            return Wording("CTL640", "projected_unknown")
        if not _has_projection(plane):
            tilt = math.degrees(math.acos(max(-1.0, min(1.0, float(plane[2, 2])))))
            return Wording("CTL640", "projected_too_steep", tilt=tilt, most=_MOST_TILT)
    return None


def _has_projection(plane: Floats) -> bool:
    return bool(plane[2, 2] >= math.cos(math.radians(_MOST_TILT)))


def _projected(plane: Floats, meaning: str) -> tuple[float, float, float]:
    """Return PROPR, PROMIN and ROT of a plane whose Z points up: the slopes of its lines in Z/X and in Y/Z, and the
    turn from the line in Z/X to its X.
    """
    x, y, z = plane[:, 2]
    main, minor = math.degrees(math.atan2(x, z)), math.degrees(math.atan2(-y, z))
    line = np.array([z, 0.0, -x]) / math.hypot(x, z)
    turn = math.degrees(math.atan2(float(line @ -plane[:, 1]), float(line @ plane[:, 0])))
    return _quiet(-main if meaning == "rising" else main), _quiet(minor), _quiet(turn)


def _quiet(angle: float) -> float:
    return 0.0 if abs(angle) < _NOISE else angle
