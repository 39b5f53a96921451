"""Lines that stand for an arc: none leaves it by more than the chord tolerance, and none goes back along it."""

import math
from collections.abc import Iterator
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.verification.context import ComparedContext
from trunnion.verification.matching.pairs import ArcSegments
from trunnion.verification.results import Place

#: A point whose three coordinates are off by one each is off by this much.
_DIAGONAL: Final = math.sqrt(3.0) + 1e-6

#: Share by which a chord may be higher than its tolerance: arithmetic, and ends of arcs that the CL file rounds.
_SHARE: Final = 1.01


def arc_chord_faults(context: ComparedContext) -> Iterator[Place]:
    """Chords that are too high for their arc, and those that go back along it, in the order of the program."""
    for segments in context.matching.arc_segments:
        if segments.pieces is None:
            yield from _faults(context, segments)


def chord_heights(context: ComparedContext, segments: ArcSegments) -> Floats:
    """How far each line that stands for an arc is off it, (k + 1,) mm; the last one goes to its end."""
    return _heights(segments.arc.radius, _turns(context, segments))


def _turns(context: ComparedContext, segments: ArcSegments) -> Floats:
    """How far each line goes round, (k + 1,) radians; less than 0 where it goes back."""
    arc = segments.arc
    fractions = np.concatenate(([0.0], arc.fractions(context.run.positions(segments.nc).tip), [1.0]))
    return np.asarray(np.diff(fractions) * arc.sweep)


def _heights(radius: float, turns: Floats) -> Floats:
    # A line in place of a whole turn, or of several, is off by the diameter.
    return np.asarray(radius * (1.0 - np.cos(np.minimum(0.5 * np.abs(turns), np.pi))))


def _faults(context: ComparedContext, segments: ArcSegments) -> Iterator[Place]:
    arc, tolerances = segments.arc, context.expected.section_at(segments.cl).tolerances
    turns = _turns(context, segments)
    heights = _heights(arc.radius, turns)
    # Both ends of a chord are rounded, and seen from the axis each is off by this angle at most.
    rounding = math.asin(min(1.0, _DIAGONAL * tolerances.tip / max(arc.radius, 1e-9)))
    half = 2.0 * math.asin(math.sqrt(min(1.0, 0.5 * _SHARE * tolerances.chord / max(arc.radius, 1e-9))))
    back = turns < -2.0 * rounding - 1e-9
    bad = (0.5 * np.abs(turns) > half + rounding + 1e-9) | back
    for k in np.flatnonzero(bad).tolist():
        if back[k]:
            value = 2.0 * arc.radius * math.sin(min(-0.5 * float(turns[k]), 0.5 * math.pi))
            text = f"goes back along the arc that it stands for, by {value:.5f} mm"
        else:
            value = float(heights[k])
            text = f"is {value:.5f} mm off the arc that it stands for, {tolerances.chord:g} mm is allowed"
        yield context.place_with_cl(_row(context, segments, k), value, text, segments.cl)


def _row(context: ComparedContext, segments: ArcSegments, k: int) -> int:
    """Return the row of the k-th line; the last one is paired with the end of the arc."""
    matching = context.matching
    if k < len(segments.nc):
        return int(segments.nc[k])
    if segments.cl in matching.cl:
        return matching.nc[matching.cl.count_before(segments.cl)]
    return int(segments.nc[-1])
