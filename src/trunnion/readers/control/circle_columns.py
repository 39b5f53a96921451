"""Circles of a run as columns, as they come: one by one, or those of a scan."""

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.model.toolpath import Arcs


class CircleColumns:
    """The circles so far, in the order of their rows, in the workpiece frame, mm."""

    def __init__(self) -> None:
        self._parts: list[Arcs] = [Arcs.empty()]
        self._single: list[tuple[int, Floats, Floats, float, int]] = []

    def add(self, row: int, centre: Floats, normal: Floats, radius: float, turns: int) -> None:
        """Add the circle of a row, with whole turns besides."""
        self._single.append((row, centre, normal, radius, turns))

    def add_scanned(self, rows: Ints, centres: Floats, normals: Floats, radii: Floats) -> None:
        """Add circles (k,) without whole turns besides."""
        self._collect()
        self._parts.append(Arcs(rows, centres, normals, radii, np.zeros(len(rows), np.int64)))

    def _collect(self) -> None:
        """Put the single ones into columns."""
        if self._single:
            rows, centres, normals, radii, turns = map(np.array, zip(*self._single, strict=True))
            self._parts.append(Arcs(rows.astype(np.int64), centres, normals, radii, turns.astype(np.int64)))
            self._single.clear()

    def joined(self) -> Arcs:
        """Return all of them."""
        self._collect()
        columns = zip(*((a.row, a.centre, a.normal, a.radius, a.full_turns) for a in self._parts), strict=True)
        return Arcs(*map(np.concatenate, columns))
