"""How far bodies stay apart at the places that were found."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from trunnion.errors import Problem, warning
from trunnion.messages import Wording
from trunnion.model.clamping import Clamping
from trunnion.placing.best_turn import TurnResult
from trunnion.placing.collisions.best_clearance import Guard, NearestRow, nearest_at
from trunnion.placing.collisions.guarded_pairs import Changes, GuardedPair, standing
from trunnion.placing.path_rows import PathRows
from trunnion.placing.placement import BodyDistance, PartPlace, Placement
from trunnion.placing.rotary_angles import Obstacle
from trunnion.placing.turns import TurnedPath

_CHANGED = (Changes.PLACE, Changes.TURN)


def with_bodies(
    found: Placement, rows: PathRows, guard: Guard, path: TurnedPath | None, drawn: Sequence[TurnedPath]
) -> Placement:
    """Return the placement with the bodies that are nearest to each other at the best and at the present place.

    ``path`` is that of the best place, ``drawn`` are those of the part as it is drawn, for each choice of branches.
    """
    if found.best is None or path is None:
        return found
    best = _with_nearest(found.best, rows, guard, path)
    zero = np.array(best.zero_mm)
    always = nearest_at(path, guard, best.turn_deg, best.tilt_deg, zero, Changes.NOTHING)
    left_out = tuple(dict.fromkeys((*guard.left_out, *(pair.names for pair in _standing(best, guard, path)))))
    present = found.present
    if present is not None:
        own = [each for each in drawn if _reaches(each, present)]
        present = _with_nearest(present, rows, guard, own[0]) if own else present
    return replace(found, best=best, present=present, nearest_anywhere=_told(always, rows), left_out=left_out)


def standing_at(best: TurnResult, guard: Guard) -> list[GuardedPair]:
    """Return the pairs that a simulation does not check at the best place, where the part stands on bodies at home."""
    if best.path is None or best.best is None:
        return []
    return standing(best.path.machine, guard.pairs, Clamping(best.turn, best.tilt).rotation, best.best.zero)


def touch_warnings(found: Placement) -> list[Problem]:
    """Return a warning where bodies touch at the best place of a goal that does not judge them."""
    touching = found.touching
    if touching is None:
        return []
    return [
        warning(
            touching.file,
            touching.line,
            Wording(
                "PLC300",
                "touch_best_place",
                one=touching.between[0],
                other=touching.between[1],
                goal=found.goal,
            ),
        )
    ]


def with_distance(found: Placement, most: float | None) -> Placement:
    """Return the placement with distances as the values of its places; no place has more than ``most`` mm,
    where known.
    """
    best, present = (
        place if place is None or place.nearest is None else replace(place, value=place.nearest.distance_mm)
        for place in (found.best, found.present)
    )
    if best is None or best.nearest is None or most is None:
        return replace(found, best=best, present=present)
    return replace(found, best=best, present=present, most_distance_mm=max(most, best.nearest.distance_mm))


def _with_nearest(place: PartPlace, rows: PathRows, guard: Guard, path: TurnedPath) -> PartPlace:
    judged = guard.without(_standing(place, guard, path))
    nearest = nearest_at(path, judged, place.turn_deg, place.tilt_deg, np.array(place.zero_mm), *_CHANGED)
    return replace(place, nearest=_told(nearest, rows))


def _standing(place: PartPlace, guard: Guard, path: TurnedPath) -> list[GuardedPair]:
    """Return the pairs that a simulation does not check at a place."""
    turn = Clamping(place.turn_deg, place.tilt_deg).rotation
    return standing(path.machine, guard.pairs, turn, np.array(place.zero_mm))


def _reaches(path: TurnedPath, place: PartPlace) -> bool:
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
