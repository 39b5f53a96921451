"""The search for the places of a part on a machine, and the placement that it finds."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import lru_cache
from typing import TypeAlias

import numpy as np

from trunnion.arrays import Floats
from trunnion.machines import Machine
from trunnion.model.rotations import about_x, about_z
from trunnion.placing.best_turn import Grid, TurnResult, best_orientations
from trunnion.placing.body_distances import standing_at, with_bodies, with_distance
from trunnion.placing.collisions.best_clearance import Guard, farthest_orientations
from trunnion.placing.goals import Goal, PlaceCost, planned_seconds, rotary_travel
from trunnion.placing.moving_samples import most_between
from trunnion.placing.path_rows import PathRows
from trunnion.placing.placement import PartPlace, Placement, TurnMargin
from trunnion.placing.region import Region, region_of
from trunnion.placing.rotary_angles import Obstacle
from trunnion.placing.table_limits import ClampingArea, Standing
from trunnion.placing.travel_limits import CutSet
from trunnion.placing.travel_use import (
    limit_of_cut,
    nearest_limits,
    obstacle_text,
    place_at,
    rotary_uses,
    rounded_zero,
    vector,
)
from trunnion.placing.turns import TurnedPath, choices_of
from trunnion.records import dataclass

PathsAt: TypeAlias = Callable[[float], list[TurnedPath]]


@dataclass(frozen=True, slots=True, eq=False)
class PlaceSearch:
    """The search for the best place of a part.

    machine   with the tool length that counts where rows have none of their own
    rows      of the part as it is drawn
    goal      what the best place is best for
    grid      the turns and tilts that are tried
    standing  what stands on the table; None: it is not judged
    guard     the bodies that are kept apart; None: there are none
    """

    machine: Machine
    rows: PathRows
    goal: Goal
    grid: Grid
    standing: Standing | None = None
    guard: Guard | None = None

    def find(self, advance: Callable[[int], None]) -> Placement:
        """Try all orientations, and return the best place with what it leaves; ``advance`` counts turns."""
        paths_at = lru_cache(maxsize=1)(self._paths_at)
        results, best, most = self._searched(paths_at, advance)
        found = self._placement(paths_at, results, best)
        if self.guard is None:
            return found
        found = with_bodies(found, self.rows, self.guard, best.path, paths_at(0.0))
        return with_distance(found, most) if self.goal is Goal.COLLISIONS else found

    def _paths_at(self, tilt: float) -> list[TurnedPath]:
        tilted = self.rows.turned(about_x(tilt))
        stands = None if self.standing is None else self.standing.turned(about_x(tilt))
        near = _first_guess(self.machine)
        return [TurnedPath.of(self.machine, choice, rows, near, stands) for choice, rows in choices_of(tilted)]

    def _searched(
        self, paths_at: PathsAt, advance: Callable[[int], None]
    ) -> tuple[Sequence[TurnResult], TurnResult, float | None]:
        """Return what each orientation allows, the best of them, and the most distance of bodies anywhere,
        where known.
        """
        if self.guard is None or self.goal is not Goal.COLLISIONS or not self.guard.is_changed:
            sought = Goal.MARGIN if self.goal is Goal.COLLISIONS else self.goal
            return *best_orientations(paths_at, self.grid, advance, goal=sought), None
        results, best, most = farthest_orientations(paths_at, self.grid, self.guard, advance)
        stands = standing_at(best, self.guard)
        if best.cost is None and stands:  # what touches everywhere may do so since the part stands on it
            judged = self.guard.without(stands)
            if judged.is_changed:
                return farthest_orientations(paths_at, self.grid, judged, lambda _: None)
        return results, best, most

    def _placement(self, paths_at: PathsAt, results: Sequence[TurnResult], best: TurnResult) -> Placement:
        machine, rows, found = self.machine, self.rows, None
        if best.best is not None and best.cuts is not None:
            found = place_at(machine, rows, best.cuts, rounded_zero(best.cuts, best.best.zero), best.turn)
            found = _with_value(replace(found, tilt_deg=best.tilt), best.path, self.goal)
        held = () if best.best is None else tuple(limit_of_cut(machine, rows, cut) for cut in best.best.holds)
        if found is not None and found.fits and self.goal is not Goal.MARGIN and best.cuts is not None:
            held = nearest_limits(machine, best.cuts, found)

        @lru_cache(maxsize=1)
        def region() -> Region | None:
            if best.best is None or best.cuts is None or found is None:
                return None
            return region_of(best.cuts, best.best, np.array(found.zero_mm))

        @lru_cache(maxsize=2)
        def turned(turn: float, tilt: float) -> list[CutSet]:
            return [cuts for cuts in (path.at(turn) for path in paths_at(tilt)) if isinstance(cuts, CutSet)]

        def margin_at(zero: Floats, turn: float, tilt: float) -> float:
            return max((cuts.at(zero).margin for cuts in turned(turn, tilt)), default=-np.inf)

        return Placement(
            machine.key,
            tuple(dict.fromkeys(stretch.file for stretch in rows.stretches)),
            str(self.goal),
            found,
            held,
            _present(machine, rows, paths_at(0.0), self.goal),
            tuple(
                replace(_turn_margin(machine, rows, result), is_asked=self.grid.has(result.turn, result.tilt))
                for result in results
            ),
            between_mm=0.0 if found is None or best.path is None else _between(best.path, found),
            tool_length_mm=machine.tool_length,
            table=ClampingArea.of(machine),
            _find_region=region,
            _margin_at=margin_at,
        )


def _first_guess(machine: Machine) -> Floats:
    """Return a place near which the search begins: the present one, or where the part sits on the first rotary axis."""
    if machine.workpiece_zero is not None:
        return np.array(machine.workpiece_zero, np.float64)
    return np.array(machine.axes[machine.rotary[0]].point)


def _between(path: TurnedPath, found: PartPlace) -> float:
    """How far slides may go beyond their samples at a place, mm."""
    angles = path.angles_at(found.turn_deg)
    assert not isinstance(angles, Obstacle)
    rows = path.rows.turned(about_z(found.turn_deg))
    return most_between(path.machine, rows, angles.positions, np.array(found.zero_mm))


def _with_value(place: PartPlace, path: TurnedPath | None, goal: Goal) -> PartPlace:
    """Return a place with the value of the goal."""
    angles = None if path is None else path.angles_at(place.turn_deg)
    if path is None or isinstance(angles, Obstacle) or angles is None:
        return place
    rows, positions = path.rows.turned(about_z(place.turn_deg)), angles.positions
    place = replace(place, rotary=rotary_uses(path.machine, positions))
    if goal is Goal.COLLISIONS:
        return place
    if goal is Goal.MARGIN:
        return replace(place, value=place.margin_mm)
    if goal is Goal.ROTARY:
        return replace(place, value=rotary_travel(rows, positions))
    if goal is Goal.TIME:
        place = replace(place, planned_s=planned_seconds(path.machine, rows, positions, np.array(place.zero_mm)))
    return replace(place, value=PlaceCost.of(goal, path.machine, rows, positions).value(np.array(place.zero_mm)))


def _present(machine: Machine, rows: PathRows, paths: Sequence[TurnedPath], goal: Goal) -> PartPlace | None:
    """Return the place that the machine has been given; None if it has none, or rotary axes do not reach the path
    there.
    """
    if machine.workpiece_zero is None:
        return None
    zero = np.array(machine.workpiece_zero, np.float64)
    places = [
        _with_value(place_at(machine, rows, cuts, zero, 0.0), path, goal)
        for path, cuts in ((path, path.at(0.0)) for path in paths)
        if isinstance(cuts, CutSet)
    ]
    return max(places, key=lambda place: place.margin_mm, default=None)


def _turn_margin(machine: Machine, rows: PathRows, result: TurnResult) -> TurnMargin:
    if result.best is None:
        assert result.obstacle is not None
        obstacle, is_table = obstacle_text(machine, rows, result.obstacle), result.obstacle.outline is not None
        return TurnMargin(result.turn, None, None, obstacle, tilt_deg=result.tilt, table_is_too_small=is_table)
    return TurnMargin(result.turn, result.margin, vector(result.best.zero), value=result.cost, tilt_deg=result.tilt)
