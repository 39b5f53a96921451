"""How far bodies stay apart at the places that were found."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from trunnion.placing.collisions.best_clearance import Guard, NearestRow, nearest_at
from trunnion.placing.collisions.guarded_pairs import Changes
from trunnion.placing.path_rows import PathRows
from trunnion.placing.placement import BodyDistance, Place, Placement
from trunnion.placing.rotary_angles import Obstacle
from trunnion.placing.turns import TurnedPath

_CHANGED = (Changes.PLACE, Changes.TURN)


def with_bodies(
    found: Placement, rows: PathRows, guard: Guard, path: TurnedPath | None, drawn: Sequence[TurnedPath]
) -> Placement:
    """The placement with the bodies that are nearest to each other at the best and at the present place.

    ``path`` is that of the best place, ``drawn`` are those of the part as it is drawn, for each choice of branches.
    """
    if found.best is None or path is None:
        return found
    best = _with_nearest(found.best, rows, guard, path)
    zero = np.array(best.zero_mm)
    always = nearest_at(path, guard, best.turn_deg, best.tilt_deg, zero, Changes.NOTHING)
    present = found.present
    if present is not None:
        own = [each for each in drawn if _reaches(each, present)]
        present = _with_nearest(present, rows, guard, own[0]) if own else present
    return replace(found, best=best, present=present, nearest_anywhere=_told(always, rows))


def with_distance(found: Placement, most: float | None) -> Placement:
    """The placement with distances as the values of its places; no place has more than ``most`` mm, where known."""
    best, present = (
        place if place is None or place.nearest is None else replace(place, value=place.nearest.distance_mm)
        for place in (found.best, found.present)
    )
    return replace(found, best=best, present=present, most_distance_mm=most if best and best.nearest else None)


def _with_nearest(place: Place, rows: PathRows, guard: Guard, path: TurnedPath) -> Place:
    nearest = nearest_at(path, guard, place.turn_deg, place.tilt_deg, np.array(place.zero_mm), *_CHANGED)
    return replace(place, nearest=_told(nearest, rows))


def _reaches(path: TurnedPath, place: Place) -> bool:
    """Whether a path is that of a place: the one whose slides go as far."""
    cuts = path.at(place.turn_deg)
    if isinstance(cuts, Obstacle):
        return False
    return abs(cuts.at(np.array(place.zero_mm)).margin - place.margin_mm) < 1e-9


def _told(nearest: NearestRow | None, rows: PathRows) -> BodyDistance | None:
    if nearest is None:
        return None
    stretch = rows.stretch_of(nearest.row)
    line = int(rows.line[nearest.row])
    return BodyDistance(max(nearest.distance, 0.0), nearest.names, stretch.file, line, stretch.operation)
