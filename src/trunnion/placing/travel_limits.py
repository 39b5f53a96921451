"""Limits of slides as half-spaces of the workpiece zero, found when they are violated.

A cut is one of them: ``normal . z <= bound`` says that a slide stays on this side of a limit in one sample, or what
stands on the table inside of its edge.
"""

from dataclasses import field
from typing import Final

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.machines import Machine
from trunnion.placing.extremes import Extremes
from trunnion.placing.table_limits import EDGES, KEPT, EdgeLimit, TableLimits
from trunnion.records import dataclass

#: How far a workpiece zero may be from the machine's, mm.
FARTHEST: Final = 1e5

#: A half-space with so much more left than the margin, mm, may be the next to hold it.
_NEARLY: Final = 1.0

#: The number of the table behind those of the slides.
TABLE: Final = 3

#: So much farther are the edges of a table than they are, mm: an outline as wide as the table must have a place.
_LOOSE: Final = 1e-8


@dataclass(frozen=True, slots=True)
class Cut:
    """A half-space of the workpiece zero.

    slide  0 to 2, in the order of ``Machine.linear``; ``TABLE``
    side   0: its low limit, 1: the high one; of the table a number of ``EDGES``
    row    of the path; -1: the table's
    part, sample  of the ``CutSet``; -1: the table's
    """

    normal: tuple[float, float, float]
    bound: float
    slide: int
    side: int
    row: int
    part: int
    sample: int


@dataclass(slots=True)
class CutSet:
    """The half-spaces of one path on one machine that have been met so far.

    parts   the extremes of its rows; each row is in one of them
    limits  (3, 2) low and high limits of the slides, mm; infinite where there is none
    edges   of the table, which hold as well; None: nothing is known to stand on it
    """

    parts: tuple[Extremes, ...]
    limits: Floats
    edges: TableLimits | None = None
    cuts: list[Cut] = field(default_factory=list)
    _known: set[tuple[int, int, int, int]] = field(default_factory=set)

    def __post_init__(self) -> None:
        if self.edges is not None:
            self.cuts += [_edge_cut(limit) for limit in (*self.edges.straight_edges(), *self.edges.rim_around())]

    @property
    def knows_slides(self) -> bool:
        """Whether half-spaces of slides are among those so far."""
        return any(cut.slide != TABLE for cut in self.cuts)

    def at(self, zero: Floats) -> "Reached":
        """Where the slides go with the workpiece zero there."""
        found = [part.at(zero) for part in self.parts]
        values = np.array([one for one, _ in found])
        sign = np.array([-1.0, 1.0])
        which = np.argmax(values * sign, axis=0)
        samples = np.array([one for _, one in found])[which, np.arange(3)[:, None], np.arange(2)]
        extremes = np.take_along_axis(values, which[None], axis=0)[0]
        left = np.inf if self.edges is None else self.edges.left(zero)
        return Reached(extremes, (self.limits - extremes) * sign, which, samples, zero, left)

    def add(self, reached: "Reached", wanted: Floats, of_table: float = -KEPT) -> int:
        """Add the half-spaces whose margin is below what is wanted, (3, 2) mm; how many of them are new.

        ``of_table`` is what is wanted of the table, mm.
        """
        count = len(self.cuts)
        if self.edges is not None and reached.table < of_table:
            rim = self.edges.rim_at(reached.zero)
            self.cuts += [] if rim is None else [_edge_cut(rim)]
        for slide, side in np.argwhere(reached.margins < wanted).tolist():
            self._meet(slide, side, int(reached.part[slide, side]), int(reached.sample[slide, side]))
        return len(self.cuts) - count

    def begin_with(self, other: "CutSet", zero: Floats, margin: float) -> None:
        """Take over what nearly held the margin of another turn, mm, with the zero (3,) there: it may do so here."""
        for cut in other.cuts:
            left = cut.bound - float(np.dot(cut.normal, zero))
            if cut.slide == TABLE or left >= margin + _NEARLY:
                continue
            if cut.part < len(self.parts) and cut.sample < len(self.parts[cut.part].forms):
                self._meet(cut.slide, cut.side, cut.part, cut.sample)

    def _meet(self, slide: int, side: int, part: int, sample: int) -> None:
        if (slide, side, part, sample) not in self._known:
            self._known.add((slide, side, part, sample))
            self.cuts.append(self._cut(slide, side, part, sample))

    def _cut(self, slide: int, side: int, part: int, sample: int) -> Cut:
        extremes, sign = self.parts[part], 2.0 * side - 1.0
        normal, offset = extremes.form(sample, slide)
        x, y, z = (sign * normal).tolist()
        bound = sign * (float(self.limits[slide, side]) - offset)
        return Cut((x, y, z), bound, slide, side, int(extremes.forms.row[sample]), part, sample)

    def row(self, reached: "Reached", slide: int, side: int) -> int:
        """Return the row in which a slide goes farthest."""
        part = self.parts[int(reached.part[slide, side])]
        return int(part.forms.row[int(reached.sample[slide, side])])

    def table(self) -> tuple[Floats, Floats, Ints]:
        """Return normals (c, 3), bounds (c,), and slides (c,) or ``TABLE`` of the cuts so far."""
        normals = np.array([cut.normal for cut in self.cuts]).reshape(-1, 3)
        return normals, np.array([cut.bound for cut in self.cuts]), np.array([c.slide for c in self.cuts], np.int64)


def _edge_cut(limit: EdgeLimit) -> Cut:
    return Cut((*limit.normal, 0.0), limit.bound + _LOOSE, TABLE, EDGES.index(limit.edge), -1, -1, -1)


@dataclass(frozen=True, slots=True, eq=False)
class Reached:
    """Where slides go at one place of the zero; arrays (3, 2) are for the low and the high end of each slide.

    extremes      least and greatest value, mm
    margins       what is left to the limits, mm; negative beyond them, infinite without
    part, sample  of the ``CutSet``: where it happens
    zero          (3,) the place, mm
    table         what is left to the edges of the table, mm; negative beyond them, infinite without
    """

    extremes: Floats
    margins: Floats
    part: Ints
    sample: Ints
    zero: Floats
    table: float

    @property
    def least(self) -> float:
        """The least of what is left, to limits and edges, mm."""
        return min(float(self.margins.min()), self.table)

    @property
    def margin(self) -> float:
        """What the slide nearest to a limit has left, mm; where something is beyond the table that counts as well."""
        return float(self.margins.min()) if self.table >= -KEPT else self.least


def slide_limits(machine: Machine) -> Floats:
    """(3, 2): low and high limits of the slides, mm."""
    return machine.limits[list(machine.linear)]
