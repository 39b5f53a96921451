"""How near the parts of a tool come to an impeller over all poses of a path.

In:     the bodies of an impeller, a tool, ball centres and tool axes.
Out:    ``PartClearance`` for each part of the tool.
Units:  mm.
"""

from collections.abc import Collection
from typing import Annotated, Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.impeller.paths.clearance import Obstacles, ToolBody, distances_of
from trunnion.messages import Wording, phrase, word_said
from trunnion.records import dataclass
from trunnion.results import NOT_DATA, Figure
from trunnion.simulation.tools.profile import Role

#: Clearances are told up to this, mm.
FAR: Final = 10.0

#: One of so many poses is looked at before all of them are.
_SOME: Final = 16

#: What tells a least distance from those that are only known to be no less, mm.
_MORE: Final = 1e-6


@dataclass(frozen=True, slots=True)
class PartClearance:
    """The least distance of a part of the tool to a body, mm, and where: the ball's centre, and the tool axis there.

    The cutter counts from one radius above its ball's centre on. Distances are measured up to 10 mm.
    """

    part: Role
    body: str
    distance: Annotated[float, Figure("mm", decimals=6)]
    centre: Annotated[tuple[float, float, float], Figure("at")]
    axis: Annotated[tuple[float, float, float], NOT_DATA]

    @property
    def said(self) -> Wording:
        """The distance, such as ``shank 2.500 mm from blade 1``."""
        part = word_said(self.part)
        if self.distance >= FAR:
            return phrase("part_far", part=part, far=FAR)
        return phrase("part_from_body", part=part, distance=self.distance, body=word_said(self.body))

    def __str__(self) -> str:
        """Return the distance in words."""
        return str(self.said)


def least_clearances(
    obstacles: Obstacles, body: ToolBody, centres: Floats, axes: Floats, touched: Collection[str] = ()
) -> tuple[PartClearance, ...]:
    """For each part of a tool, the least of its distances, the nearest part first.

    centres, axes  (n, 3): of the ball, and of the tool towards the holder
    touched        names of bodies that the cutter is meant to touch: for it they do not count
    """
    found = []
    for role in dict.fromkeys(body.roles):
        pieces = body.part(role)
        counts = [k for k, name in enumerate(obstacles.names) if role is not Role.CUTTER or name not in touched]
        # What some poses have is no less than the least: what is farther away than that need not be known.
        some = distances_of(obstacles, pieces, centres[::_SOME], axes[::_SOME], FAR)[:, :, counts]
        enough = min(float(some.min()) + _MORE, FAR)
        own = distances_of(obstacles, pieces, centres, axes, enough)[:, :, counts].min(axis=1)
        row, number = np.unravel_index(int(own.argmin()), own.shape)
        centre, axis = ((float(x), float(y), float(z)) for x, y, z in (centres[row], axes[row]))
        found.append(PartClearance(role, obstacles.names[counts[number]], float(own[row, number]), centre, axis))
    return tuple(sorted(found, key=lambda one: one.distance))
