"""Volumes and radii of the convex pieces of tools, by formulas of their own."""

import math

import numpy as np

from trunnion.arrays import Floats
from trunnion.simulation.tool_pieces import RevolvedPieces


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
