"""Paths that wind up a rotary axis."""

from dataclasses import replace

import numpy as np

from tests.support.path_strategies import winding
from trunnion.model.toolpath import Moves


def round_part(n: int = 400) -> Moves:
    """Almost three times around a part with the tool tilted outwards: 1000 degrees, where C has a travel of 720."""
    moves = winding(40.0, 100.0, 1100.0, n)
    return replace(moves, tip=40.0 * moves.axis + np.linspace(0.0, 4.0, n)[:, None] * [0.0, 0.0, 1.0])
