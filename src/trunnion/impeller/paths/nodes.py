"""Places of a family at which tool axes are chosen, and how far apart they are in mm."""

import math
from typing import Final

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.impeller.paths.passes import PassFamily

#: Places from which the search begins.
_NODES: Final = 240

#: Steps in which the size of cells is found that makes that many.
_HALVINGS: Final = 25


def lengths_of(family: PassFamily) -> Floats:
    """What a parameter from 0 to 1 is in mm: along, the median of the passes; else as centres change on average.

    0 for one that is the same everywhere.
    """
    along = []
    for one in family.passes:
        way = np.linalg.norm(np.diff(one.centre, axis=0), axis=1).sum()
        share = np.abs(np.diff(one.place[:, 0]))
        share = share[share < 0.5].sum()  # a closed one goes from 1 to 0
        if share > 0.0:
            along.append(way / share)
    places, centres = family.places(), family.centres()
    design = np.column_stack((places, np.ones(len(places))))
    slopes = np.linalg.lstsq(design, centres, rcond=None)[0][:-1]
    found = np.r_[np.median(along) if along else 1.0, np.linalg.norm(slopes[1:], axis=1)]
    return np.asarray(np.where(np.ptp(places, axis=0) > 0.0, np.maximum(found, 1.0), 0.0))


def spread_nodes(places: Floats, lengths: Floats) -> Ints:
    """Points, in all cells of about one size the one that is nearest to the middle."""
    inside = np.clip(places, 0.0, 1.0 - 1e-12)

    def cells(size: float) -> tuple[Floats, Ints]:
        """Places in units of cells, and the numbers of their cells."""
        counts = np.maximum(np.round(lengths / size), 1.0)
        number = np.floor(inside * counts) @ np.cumprod(np.r_[1.0, counts[:-1]])
        return inside * counts, np.asarray(number, np.int64)

    low, high = 0.01, float(lengths.max())
    for _ in range(_HALVINGS):
        size = math.sqrt(low * high)
        low, high = (size, high) if len(np.unique(cells(size)[1])) > _NODES else (low, size)
    scaled, number = cells(high)
    order = np.argsort(np.linalg.norm(scaled - np.floor(scaled) - 0.5, axis=1), kind="stable")
    _, first = np.unique(number[order], return_index=True)
    return np.asarray(order[first])
