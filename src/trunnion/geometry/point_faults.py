"""What is wrong with measured points."""

from collections.abc import Iterator
from typing import Final

import numpy as np

from trunnion.errors import Problem, warning
from trunnion.geometry.point_tables import MOST_POINTS, PointTable, too_many
from trunnion.messages import Wording

#: Points that are nearer than this are the same, mm.
SAME: Final = 1e-6

#: A path that turns by more than this at a point probably has its points out of order, degrees.
_BACK: Final = 120.0

#: A step that is so many times as long as the middle one leaves points out, or goes to another curve.
_JUMP: Final = 20.0

_LEAST_POINTS: Final = 3


def point_faults(table: PointTable) -> Iterator[Problem]:
    """Errors, and warnings of what is probably wrong, of the points of a curve."""
    file, points, lines = table.file, table.points, table.lines
    if len(points) < _LEAST_POINTS:
        yield Problem(
            file,
            lines[0] if len(lines) else 0,
            Wording("IMP120", "points", table_called=table.called, count=len(points), least_points=_LEAST_POINTS),
        )
        return
    if len(points) > MOST_POINTS:
        yield Problem(file, lines[MOST_POINTS], too_many(len(points)))
        return
    steps = np.diff(points, axis=0)
    lengths = np.linalg.norm(steps, axis=1)
    same = np.flatnonzero(lengths <= SAME)
    for k in same.tolist():
        yield Problem(
            file, lines[k + 1], Wording("IMP121", "same_point_here", table_called=table.called, lines=lines[k])
        )
    if len(same):
        return
    cosine = np.einsum("ij,ij->i", steps[:-1], steps[1:]) / (lengths[:-1] * lengths[1:])
    for k in np.flatnonzero(cosine < np.cos(np.radians(_BACK))).tolist():
        angle = np.degrees(np.arccos(max(cosine[k], -1.0)))
        yield warning(file, lines[k + 1], Wording("IMP122", "turns_back_here", table_called=table.called, angle=angle))
    for k in np.flatnonzero(lengths > _JUMP * np.median(lengths)).tolist():
        yield warning(
            file, lines[k + 1], Wording("IMP122", "gap_mm_before", table_called=table.called, lengths=lengths[k])
        )
