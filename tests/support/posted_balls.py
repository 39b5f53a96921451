"""Balls of a posted program, as it was read back and run, against the exact surfaces of an impeller.

Nothing here comes from the making of paths or from the simulation: tips and tool axes are those of the run.
"""

from typing import TypeAlias

import numpy as np
import pytest

from trunnion import ImpellerCut
from trunnion.arrays import Floats
from trunnion.impeller.blade import Blade
from trunnion.impeller.fillet import root_fillet
from trunnion.impeller.impeller import Impeller, rotated
from trunnion.impeller.paths.around import stations_at
from trunnion.impeller.profiles import Profile
from trunnion.model.toolpath import Kind

#: Points of the fillet of each blade, in its own frame, and the angle of the blade.
Fillets: TypeAlias = tuple[tuple[Floats, float], ...]

#: Of a root, points along a fillet and across it; they are some 0.1 mm apart.
_ALONG, _ACROSS = 1500, 33


def ball_centres(found: ImpellerCut, name: str, radius: float, step: float) -> Floats:
    """Ball centres (n, 3) of all motions at feed of an operation, no more than ``step`` mm apart along each motion.

    Between two points the tip goes straight and the tool axis turns evenly, as a control with TCP moves them.
    """
    run, verification = found.result.run, found.result.verification
    assert run is not None
    assert verification is not None
    (rows,) = (each for each in verification.operations if each.name == name)
    at = np.arange(rows.first + 1, rows.end)
    at = at[run.kind[at] == Kind.LINEAR]
    tips, axes = run.tip, run.axis
    pieces = np.maximum(np.ceil(np.linalg.norm(tips[at] - tips[at - 1], axis=1) / step), 1).astype(int)
    row = np.repeat(at, pieces)
    first = np.repeat(np.cumsum(pieces) - pieces, pieces)
    share = ((np.arange(len(row)) - first + 1) / np.repeat(pieces, pieces))[:, None]
    axis = axes[row - 1] + share * (axes[row] - axes[row - 1])
    axis /= np.linalg.norm(axis, axis=1)[:, None]
    return np.asarray(tips[row - 1] + share * (tips[row] - tips[row - 1]) + radius * axis)


def reaching(impeller: Impeller, centres: Floats, radius: float) -> Floats:
    """Those of ball centres whose balls reach into the stock's cylinder: beyond it the surfaces go on, the part not."""
    stock = impeller.definition.stock
    inside = (np.hypot(centres[:, 0], centres[:, 1]) < stock.diameter / 2.0 + radius) & (
        centres[:, 2] < stock.top + radius
    )
    return np.asarray(centres[inside])


def gaps(impeller: Impeller, points: Floats) -> tuple[Floats, Floats]:
    """Distances of points to the nearest of all blades, and to the hub."""
    blades = [blade.distances(rotated(points, -angle))[0] for blade, angle in impeller.blades()]
    return np.min(blades, axis=0), profile_gaps(impeller, impeller.hub, points)


def profile_gaps(impeller: Impeller, profile: Profile, points: Floats) -> Floats:
    """Distances (n,) of points to hub or shroud: the surface goes on straight, what counts ends at the stock.

    For points outside of the stock's cylinder the distance is that to points of the outline, which are 1 µm apart.
    """
    stock = impeller.definition.stock
    rim, across = stock.diameter / 2.0, np.hypot(points[:, 0], points[:, 1])
    found = profile.distances(points)[0]
    beyond = np.flatnonzero((across > rim) | (points[:, 2] > stock.top))
    outline = profile.outline(1e-5, 2.0 * rim)
    way = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(outline, axis=0), axis=1))]
    at = np.arange(0.0, way[-1], 0.001)
    dense = np.column_stack([np.interp(at, way, outline[:, k]) for k in (0, 1)])
    within = (dense[:, 0] <= rim) & (dense[:, 1] <= stock.top)
    found[beyond] = nearest(np.column_stack((across, points[:, 2]))[beyond], dense[within])
    return found


def fillet_points(impeller: Impeller, blade: Blade) -> Floats:
    """Points (n, 3) on the fillet of a blade, in its own frame, within the stock's cylinder."""
    radius = impeller.definition.fillet
    last = 4.0 if impeller.definition.trailing_edge == "round" else 3.0
    fillet = root_fillet(blade, impeller.hub, radius, stations_at(np.linspace(0.0, last, _ALONG), 1.0))
    angle = np.arccos(np.clip(np.einsum("ij,ij->i", fillet.to_blade, fillet.to_hub), -1.0, 1.0))
    # On a great circle from where the ball touches the blade to where it touches the hub.
    share = np.linspace(0.0, 1.0, _ACROSS)[:, None]
    weights = np.sin((1.0 - share) * angle) / np.sin(angle), np.sin(share * angle) / np.sin(angle)
    outward = weights[0][:, :, None] * fillet.to_blade + weights[1][:, :, None] * fillet.to_hub
    points = (fillet.centre + radius * outward).reshape(-1, 3)
    return np.asarray(points[np.hypot(points[:, 0], points[:, 1]) < impeller.definition.stock.diameter / 2.0])


def fillets(impeller: Impeller) -> Fillets:
    """The points of the fillets of all blades, each in its own frame with the angle of the blade."""
    points = {id(blade): fillet_points(impeller, blade) for blade, _ in impeller.blades()}
    return tuple((points[id(blade)], angle) for blade, angle in impeller.blades())


def nearest(points: Floats, others: Floats) -> Floats:
    """Distance (n,) of points (n, k) to the nearest of others (m, k)."""
    return np.asarray(pytest.importorskip("scipy.spatial").cKDTree(others).query(points)[0])


def fillet_gaps(roots: Fillets, centres: Floats) -> Floats:
    """Distances (n,) of ball centres to the fillets: too great by (0.1 mm)² / 8 r at most."""
    return np.asarray(np.min([nearest(rotated(centres, -angle), points) for points, angle in roots], axis=0))
