"""Tools as simple formulas: volumes and radii of their convex pieces, and the radius of a cutter at a height."""

import math
from typing import Any

import numpy as np
from hypothesis import assume
from hypothesis import strategies as st

from trunnion.arrays import Floats
from trunnion.simulation.tools.pieces import RevolvedPieces
from trunnion.simulation.tools.shapes import ToolKind, ToolSizes, shape_faults


def pieces_volume(pieces: RevolvedPieces) -> float:
    """The volumes of all pieces together, mm³."""
    volume = 0.0
    for z0, z1, third, fourth, is_sphere in pieces.elements.tolist():
        if is_sphere == 0.0:
            volume += math.pi * (fourth**2 * (z1 - z0) - ((z1 - third) ** 3 - (z0 - third) ** 3) / 3.0)
        else:
            volume += math.pi * (z1 - z0) * (third**2 + third * fourth + fourth**2) / 3.0
    return volume


def piece_radius(pieces: RevolvedPieces, piece: int, z: Floats) -> Floats:
    """The radius of a piece at heights between its lowest and its highest z, (n,)."""
    radius = np.zeros(len(z))
    for z0, z1, third, fourth, is_sphere in pieces.elements[pieces.first[piece] : pieces.first[piece + 1]].tolist():
        inside = (z >= z0) & (z <= z1)
        along = z[inside]
        if is_sphere == 0.0:
            radius[inside] = np.sqrt(np.maximum(fourth**2 - (along - third) ** 2, 0.0))
        else:
            radius[inside] = third + (fourth - third) * (along - z0) / (z1 - z0)
    return radius


def cutter_radius(sizes: ToolSizes, z: Floats) -> Floats:
    """The radius of a cutter at heights, (n,), from what its sizes mean."""
    half = 0.5 * sizes.diameter
    if sizes.kind in (ToolKind.FLAT, ToolKind.BALL, ToolKind.BULL, ToolKind.TAPER, ToolKind.DRILL):
        radius = half if sizes.kind is ToolKind.BALL else sizes.corner_radius
        bottom = 90.0 - 0.5 * sizes.tip_angle if sizes.tip_angle else 0.0
        return _rounded(half, radius, math.radians(bottom), math.radians(sizes.side_angle), z)
    if sizes.kind is ToolKind.TAPER_BALL:
        slope = math.tan(math.radians(sizes.side_angle))
        # A cone that touches the ball.
        cone = half * math.hypot(1.0, slope) + (z - half) * slope
        contact = half - half * math.sin(math.radians(sizes.side_angle))
        return np.where(z < contact, _circle(half, half, z), cone)
    if sizes.kind is ToolKind.CHAMFER:
        return np.minimum(0.5 * sizes.tip_diameter + z * math.tan(math.radians(sizes.side_angle)), half)
    if sizes.kind is ToolKind.LOLLIPOP:
        return _circle(half, half, z)
    if sizes.kind is ToolKind.T_SLOT:
        lower = _rounded(half, sizes.corner_radius, 0.0, 0.0, z)
        return np.minimum(lower, _rounded(half, sizes.upper_radius, 0.0, 0.0, sizes.flute_length - z))
    if sizes.kind is ToolKind.THREAD_MILL:
        off_middle = np.abs(z % sizes.pitch - 0.5 * sizes.pitch)
        slope = 1.0 / math.tan(math.radians(0.5 * (sizes.thread_angle or 60.0)))
        tooth = half - np.maximum(off_middle - 0.5 * sizes.crest, 0.0) * slope
        return np.maximum(tooth, 0.5 * sizes.neck_diameter)
    side = half - sizes.profile_radius + _circle(sizes.profile_radius, sizes.widest_height, z)
    corner = sizes.corner_radius
    if not corner:
        return side
    reach = math.sqrt((sizes.profile_radius - corner) ** 2 - (sizes.widest_height - corner) ** 2)
    return np.where(
        z < corner * (sizes.profile_radius - sizes.widest_height) / (sizes.profile_radius - corner),
        half - sizes.profile_radius + reach + _circle(corner, corner, z),
        side,
    )


def _circle(radius: float, middle: float, z: Floats) -> Floats:
    return np.asarray(np.sqrt(np.maximum(radius**2 - (z - middle) ** 2, 0.0)))


def _rounded(half: float, radius: float, a: float, b: float, z: Floats) -> Floats:
    """The radius of a bottom and a side with a corner, whose centre is as far from both lines as it is round."""
    sharp = half + (z - half * math.tan(a)) * math.tan(b)
    if a > 0.0:
        sharp = np.minimum(sharp, z / math.tan(a))
    if radius == 0.0:
        return np.asarray(sharp)
    lines = [[-math.sin(a), math.cos(a)], [math.cos(b), -math.sin(b)]]
    r, middle = np.linalg.solve(lines, [radius, half * math.cos(b) - half * math.tan(a) * math.sin(b) - radius])
    low, high = middle - radius * math.cos(a), middle - radius * math.sin(b)
    return np.where((z >= low) & (z <= high), np.maximum(r, 0.0) + _circle(radius, middle, z), sharp)


@st.composite
def cutter_sizes(draw: st.DrawFn, kind: ToolKind) -> ToolSizes:
    """Sizes of a cutter of a kind, without shank and holder."""
    share = st.floats(0.05, 0.95)
    diameter = draw(st.floats(0.5, 60.0))
    sizes: dict[str, Any] = {"flute_length": diameter * draw(st.floats(1.1, 6.0))}
    if kind in (ToolKind.BULL, ToolKind.TAPER, ToolKind.T_SLOT, ToolKind.DRILL):
        sizes["corner_radius"] = 0.25 * diameter * draw(share)
    if kind in (ToolKind.TAPER, ToolKind.TAPER_BALL):
        sizes["side_angle"] = draw(st.floats(0.5, 60.0))
    if kind is ToolKind.CHAMFER:
        sizes["side_angle"] = draw(st.floats(30.0, 75.0))
        sizes["tip_diameter"] = diameter * draw(st.floats(0.0, 0.9))
    if kind is ToolKind.DRILL:
        sizes["tip_angle"] = draw(st.floats(60.0, 179.0))
        sizes["side_angle"] = draw(st.sampled_from([0.0, 1.0, 25.0]))
    if kind in (ToolKind.LOLLIPOP, ToolKind.T_SLOT):
        sizes["neck_diameter"] = diameter * draw(share)
    if kind is ToolKind.LOLLIPOP:
        sizes["flute_length"] = 0.0
    if kind is ToolKind.T_SLOT:
        sizes["upper_radius"] = 0.25 * diameter * draw(share)
    if kind is ToolKind.THREAD_MILL:
        sizes["pitch"] = diameter * draw(st.floats(0.05, 0.5))
        sizes["flute_length"] = sizes["pitch"] * draw(st.integers(1, 8))
        sizes["crest"] = sizes["pitch"] * draw(st.floats(0.0, 0.4))
        sizes["neck_diameter"] = diameter * draw(st.floats(0.0, 0.95))
    if kind is ToolKind.BARREL:
        sizes["profile_radius"] = diameter * draw(st.floats(3.0, 20.0))
        sizes["widest_height"] = sizes["flute_length"] * draw(st.floats(0.1, 1.2))
        sizes["corner_radius"] = 0.25 * diameter * draw(st.sampled_from([0.0, 0.2, 0.9]))
    found = ToolSizes(kind, diameter, **sizes)
    assume(not shape_faults(found))
    return found
