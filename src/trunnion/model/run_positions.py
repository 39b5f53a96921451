"""Where axes and tool stand at the ends of rows of a run.

Units:  mm, degrees, unit vectors.
"""

from collections.abc import Sequence

import numpy as np

from trunnion.arrays import Floats, make_read_only
from trunnion.records import dataclass


@dataclass(frozen=True, slots=True, eq=False)
class RowPositions:
    """Axes and tool at the end of k rows: ``joints`` (k, 5), ``tip`` and ``axis`` (k, 3) as in ``Run``, read-only."""

    joints: Floats
    tip: Floats
    axis: Floats

    def __post_init__(self) -> None:
        make_read_only(self.joints, self.tip, self.axis)


@dataclass(frozen=True, slots=True, eq=False)
class PositionChunk(RowPositions):
    """Consecutive rows; ``midpoint_axis`` (k - 1, 3) is the tool axis with every joint half-way from row to row."""

    midpoint_axis: Floats


def joined_chunks(parts: Sequence[PositionChunk]) -> PositionChunk:
    """Return chunks that follow each other as one; each row has the tip that its own chunk gives it."""
    if len(parts) == 1:
        return parts[0]
    joints, tip, axis = (
        np.concatenate([getattr(parts[0], name)[:1], *(getattr(each, name)[1:] for each in parts)])
        for name in ("joints", "tip", "axis")
    )
    return PositionChunk(joints, tip, axis, np.concatenate([each.midpoint_axis for each in parts]))
