"""Where on the table a part may sit: the feasible places of its workpiece zero, and the best of them."""

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from functools import lru_cache
from itertools import product
from pathlib import Path
from typing import Final, Literal

import numpy as np

from trunnion.arrays import Floats
from trunnion.errors import InputError, Problem, Severity, argument_problem
from trunnion.jobs.inputs.arguments import check_choice, check_observer, check_paths
from trunnion.jobs.inputs.reading import FilePath, MachineLike, ToolpathLike, as_machine
from trunnion.jobs.inputs.settings import Settings, as_texts, set_up_machine
from trunnion.jobs.observer import SILENT, Observer
from trunnion.jobs.place.bodies import BodiesInput, read_bodies, stated_lengths
from trunnion.jobs.place.distances import standing_at, touch_warnings, with_bodies, with_distance
from trunnion.jobs.place.inputs import PlacedInput, read_input
from trunnion.jobs.place.orientations import orientations
from trunnion.jobs.place.table import larger_than_table, limit_of_table, standing_on
from trunnion.machines import Machine
from trunnion.machines.machine import Vector
from trunnion.model.clamped_toolpaths import clamped_after
from trunnion.model.rotations import about_x, about_z
from trunnion.placing.best_turn import Grid, TurnResult, best_orientations
from trunnion.placing.between_rows import most_between
from trunnion.placing.collisions.best_clearance import farthest_orientations
from trunnion.placing.collisions.moments import lengths_of
from trunnion.placing.goals import Goal, PlaceCost, rotary_travel
from trunnion.placing.path_rows import PathRows
from trunnion.placing.placement import AxisUse, Limit, Place, Placement, RotaryUse, TurnMargin
from trunnion.placing.planned_time import planned_seconds
from trunnion.placing.region import Region, region_of
from trunnion.placing.rotary_angles import Obstacle
from trunnion.placing.table_limits import EDGES, ClampingArea
from trunnion.placing.travel_limits import TABLE, Cut, CutSet
from trunnion.placing.turns import TurnedPath, choices_of
from trunnion.simulation.meshes import TriangleMesh
from trunnion.simulation.tools.profile import ToolShape

#: From the lowest corner of a cube to each of them.
_CORNERS: Final = np.array(list(product((0.0, 1.0), repeat=3)))

#: The step of turns at which bodies are kept apart, degrees: each of them is a search of its own.
_COLLISION_TURNS: Final = 15.0

#: Limits that are nearer than others by less are both told, mm.
_AS_NEAR: Final = 1e-3

GOALS: Final = tuple(str(goal) for goal in Goal)


def place(
    files: Iterable[ToolpathLike] | ToolpathLike,
    *,
    machine: MachineLike,
    goal: str = "margin",
    turns: float | Sequence[float] | None = None,
    tilts: float | Sequence[float] = (),
    zero: str | Iterable[float] | None = None,
    tool_length: str | float | None = None,
    settings: Settings | None = None,
    subprograms: Sequence[FilePath] = (),
    stock: str | Path | TriangleMesh | None = None,
    part: str | Path | TriangleMesh | None = None,
    fixtures: str | Path | TriangleMesh | Iterable[str | Path | TriangleMesh] = (),
    tools: str | ToolShape | Iterable[str | ToolShape] = (),
    libraries: Sequence[FilePath] = (),
    unit: Literal["mm", "inch"] | None = None,
    observer: Observer = SILENT,
) -> Placement:
    """Find where on the table a part may sit, and where it sits best.

    Parameters
    ----------
    files
        CL files, which ``trunnion.post`` would make one program of, or NC programs: all must fit at one place.
    machine
        A name, a path or a ``Machine``.
    goal
        What the best place is best for: ``"margin"``, the distance of the slides to their limits; or the least
        ``"rotary"`` or ``"slides"`` travel, ``"time"``, or ``"overspeed"``, fewest rows whose feed the
        axes do not reach; or ``"collisions"``, the largest least distance between bodies of the spindle's side and
        those of the table's. Places with these goals keep a margin of 1 mm where they can.
    turns
        The part is tried at every so many degrees about Z, and more finely around the best; or the turns themselves.
        By default each 5 degrees, with several tilts or the goal ``"collisions"`` each 15.
    tilts
        Before it is turned the part is tilted about X of the program's coordinate system, right-handed, as by a fixture
        with that angle: at every so many degrees from -90 to 90, and more finely around the best; or the tilts
        themselves. By default it is not tilted.
    zero : (3,) float, mm
        The present place of the workpiece zero; by default that of the definition.
    tool_length
        Of the tool, gauge point to tip, mm; by default that of the definition, or of each tool its own where the CL
        files state all of them, or 0.
    settings
        Of CL files, as ``trunnion.post`` takes them.
    subprograms
        Files of the subprograms that NC programs call.
    stock, part
        As ``trunnion.simulate`` has them: all of them, seen from above, is to be on the table that the definition
        states. With the goal ``"collisions"`` they are bodies, too.
    fixtures, tools, libraries, unit
        Bodies besides those of the machine, as ``trunnion.simulate`` takes them: as the part is drawn. Fixtures are
        tilted and turned with it. With any of them the least distance at the best place is told with every goal.
    observer
        Receives the progress and warnings.

    Returns
    -------
    Placement
        ``fits``, ``zero_mm``, ``turn_deg``, ``tilt_deg``, ``margin_mm``, ``limits``, the ``region`` of all
        places, and more.

    Raises
    ------
    InputError
        When a file or an argument cannot be used, or no slide has limits.
    RefusedError
        When no plan of the CL files is possible, or a program has words that are not understood.

    Notes
    -----
    docs/placing.md says what is proven, and of which motions.

    Examples
    --------
    >>> import trunnion
    >>> found = trunnion.place("tests/golden/yl569/2_hub_rough.cls", machine="yl569", turns=[0.0])
    >>> found.fits, found.best.axes[1].axis
    (True, 'Y')
    """
    check_observer(observer)
    goal = check_choice("goal", goal, GOALS)
    grid = orientations(_COLLISION_TURNS if turns is None and goal == Goal.COLLISIONS else turns, tilts)
    texts = as_texts(settings)
    zero = texts.pop("zero", None) if zero is None else zero
    tool_length = texts.get("tool_length") if tool_length is None else tool_length
    loaded = set_up_machine(as_machine(machine), zero, tool_length)
    if not np.isfinite(loaded.limits[list(loaded.linear)]).any():
        what = f"no slide of {loaded.key} has limits: the part may sit anywhere"
        raise InputError(argument_problem("machine", what, "state limits_mm of its axes", code="PLC130"))
    tilts_by_size = tuple(sorted(grid.tilts.tolist(), key=abs))
    remarks: list[Problem] = []
    standing = standing_on(loaded, stock, part, remarks)
    given = read_input(files, loaded, texts, check_paths("subprograms", subprograms), observer, tilts_by_size)
    for tilt in tilts_by_size:  # what could not be said in the head of a program is told before it is searched
        clamped_after(given.clamping, (0.0, tilt), given.rows.stretches[0].file)
    bodies = None
    among = BodiesInput(fixtures, part, stock, tools, libraries, unit)
    if goal == Goal.COLLISIONS or among.are_given:
        bodies = read_bodies(among, given, loaded, is_needed=goal == Goal.COLLISIONS)
        loaded, remarks = bodies.machine, [*remarks, *bodies.problems]
        given = replace(given, rows=replace(given.rows, length=lengths_of(bodies.guard.lengths, given.tool)))
    elif loaded.tool_length is None and (own := stated_lengths(given)):
        loaded = replace(loaded, tool_length=max(own.values()))
        given = replace(given, rows=replace(given.rows, length=lengths_of(own, given.tool)))
    problems = [*given.problems, *unknown_length(loaded), *dict.fromkeys(remarks)]
    observer.problems(problems)
    near = _first_guess(loaded)

    @lru_cache(maxsize=1)
    def paths_at(tilt: float) -> list[TurnedPath]:
        tilted = given.rows.turned(about_x(tilt))
        stands = None if standing is None else standing.turned(about_x(tilt))
        return [TurnedPath.of(loaded, choice, rows, near, stands) for choice, rows in choices_of(tilted)]

    with observer.progress("placing", len(grid), "turns") as advance:
        most: float | None = None
        if bodies is not None and goal == Goal.COLLISIONS and bodies.guard.is_changed:
            results, best, most = farthest_orientations(paths_at, grid, bodies.guard, advance)
            stands = standing_at(best, bodies.guard)
            if best.cost is None and stands:  # what touches everywhere may do so since the part stands on it
                judged = bodies.guard.without(stands)
                if judged.is_changed:
                    results, best, most = farthest_orientations(paths_at, grid, judged, lambda _: None)
        else:
            sought = Goal.MARGIN if goal == Goal.COLLISIONS else Goal(goal)
            results, best = best_orientations(paths_at, grid, advance, goal=sought)
    found = _placement(loaded, given, goal, paths_at, results, best, problems, grid)
    if bodies is None:
        return found
    found = with_bodies(found, given.rows, bodies.guard, best.path, paths_at(0.0))
    if goal == Goal.COLLISIONS:
        return with_distance(found, most)
    touching = touch_warnings(found)
    observer.problems(touching)
    return replace(found, problems=(*found.problems, *touching))


def unknown_length(machine: Machine) -> list[Problem]:
    """A warning where places depend on a tool length that nobody has stated."""
    if machine.tool_length is not None or not any(machine.depends_on_length(k) for k in machine.linear):
        return []
    names = ", ".join(machine.axes[k].name for k in machine.linear if machine.depends_on_length(k))
    what, cure = (
        f"the tool counts as 0 mm long, and places depend on its length ({names})",
        "give the length of the tool",
    )
    return [argument_problem("tool_length", what, cure, Severity.WARNING, code="PLC210")]


def _first_guess(machine: Machine) -> Floats:
    """A place near which the search begins: the present one, or where the part sits on the first rotary axis."""
    if machine.workpiece_zero is not None:
        return np.array(machine.workpiece_zero)
    return np.array(machine.axes[machine.rotary[0]].point)


def _placement(
    machine: Machine,
    given: PlacedInput,
    goal: str,
    paths_at: Callable[[float], list[TurnedPath]],
    results: Sequence[TurnResult],
    best: TurnResult,
    problems: Sequence[Problem],
    grid: Grid,
) -> Placement:
    rows = given.rows
    found = None
    if best.best is not None and best.cuts is not None:
        found = place_at(machine, rows, best.cuts, _rounded(best.cuts, best.best.zero), best.turn)
        found = _with_value(replace(found, tilt_deg=best.tilt), best.path, Goal(goal))
    held = () if best.best is None else tuple(limit_of_cut(machine, rows, cut) for cut in best.best.holds)
    if found is not None and found.fits and Goal(goal) is not Goal.MARGIN and best.cuts is not None:
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
        goal,
        found,
        held,
        _present(machine, rows, paths_at(0.0), Goal(goal)),
        tuple(
            replace(_turn_margin(machine, rows, result), is_asked=grid.has(result.turn, result.tilt))
            for result in results
        ),
        between_mm=0.0 if found is None or best.path is None else _between(best.path, found),
        problems=tuple(problems),
        toolpaths=given.toolpaths,
        clamping=given.clamping,
        tool_length_mm=machine.tool_length,
        table=ClampingArea.of(machine),
        _find_region=region,
        _margin_at=margin_at,
    )


def _between(path: TurnedPath, found: Place) -> float:
    """How far slides may go beyond their samples at a place, mm."""
    angles = path.angles_at(found.turn_deg)
    assert not isinstance(angles, Obstacle)
    rows = path.rows.turned(about_z(found.turn_deg))
    return most_between(path.machine, rows, angles.positions, np.array(found.zero_mm))


def _with_value(place: Place, path: TurnedPath | None, goal: Goal) -> Place:
    """A place with the value of the goal."""
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


def _present(machine: Machine, rows: PathRows, paths: Sequence[TurnedPath], goal: Goal) -> Place | None:
    """The place that the machine has been given; None if it has none, or rotary axes do not reach the path there."""
    if machine.workpiece_zero is None:
        return None
    zero = np.array(machine.workpiece_zero)
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


def obstacle_text(machine: Machine, rows: PathRows, obstacle: Obstacle) -> str:
    """Why a turn is impossible, with the line."""
    if obstacle.outline is not None:
        return larger_than_table(machine, obstacle.outline)
    stretch = rows.stretch_of(obstacle.row)
    what = "no rotary positions give its tool axis"
    if obstacle.axis >= 0:
        axis = machine.axes[obstacle.axis]
        what = f"{axis.name} would have to leave its travel, {axis.low:g} to {axis.high:g} degrees"
    return f"{stretch.file}:{rows.line[obstacle.row]}: {what}"


def place_at(machine: Machine, rows: PathRows, cuts: CutSet, zero: Floats, turn: float) -> Place:
    """A place with what it leaves each slide."""
    reached = cuts.at(zero)
    axes = []
    for slide, column in enumerate(machine.linear):
        low, high = (limit_at(machine, rows, cuts.row(reached, slide, side), slide, side) for side in (0, 1))
        least, greatest = reached.extremes[slide].tolist()
        axes.append(AxisUse(machine.axes[column].name, least, greatest, float(reached.margins[slide].min()), low, high))
    table = None if cuts.edges is None else reached.table
    return Place(vector(zero), turn, reached.margin, tuple(axes), table_mm=table)


def _rounded(cuts: CutSet, zero: Floats) -> Floats:
    """A place in whole thousandths of a millimetre, as controls have it, unless the part fits at the exact one only.

    Of the eight around it the nearest at which slides and stock keep their limits, else that which is nearest of all.
    """
    down = np.floor(zero * 1000.0)
    around = sorted(
        ((down + corner) / 1000.0 for corner in _CORNERS), key=lambda each: float(np.linalg.norm(each - zero))
    )
    inside = next((each for each in around if cuts.at(each).least >= 0.0), None)
    if inside is not None:
        return np.asarray(inside)
    rounded = np.round(zero, 3)
    exact, near = (cuts.at(each).margin for each in (zero, rounded))
    return rounded if near >= 0.0 or exact < 0.0 else zero


def rotary_uses(machine: Machine, positions: Floats) -> tuple[RotaryUse, ...]:
    """How the rotary axes use their travel in positions (n, 2), degrees."""
    uses = []
    for k, column in enumerate(machine.rotary):
        axis, least, greatest = machine.axes[column], float(positions[:, k].min()), float(positions[:, k].max())
        margin = min(least - axis.low, axis.high - greatest)
        uses.append(RotaryUse(axis.name, least, greatest, margin, axis.low, axis.high))
    return tuple(uses)


def limit_of_cut(machine: Machine, rows: PathRows, cut: Cut) -> Limit:
    """The limit that a half-space is."""
    if cut.slide == TABLE:
        return limit_of_table(machine, EDGES[cut.side])
    return limit_at(machine, rows, cut.row, cut.slide, cut.side)


def nearest_limits(machine: Machine, cuts: CutSet, place: Place) -> tuple[Limit, ...]:
    """The limits to which slides have the least left at a place, like ones all; before them edges that are as near."""
    left = [(axis.least_mm - axis.low.limit_mm, axis.low) for axis in place.axes]
    left += [(axis.high.limit_mm - axis.greatest_mm, axis.high) for axis in place.axes]
    least = min(one for one, _ in left)
    slides = tuple(limit for one, limit in left if one <= least + _AS_NEAR)
    if cuts.edges is None or place.table_mm is None or place.table_mm > least + _AS_NEAR:
        return slides
    edges = cuts.edges.nearest_edges(np.array(place.zero_mm))
    return (*(limit_of_table(machine, edge) for edge in edges), *slides)


def limit_at(machine: Machine, rows: PathRows, row: int, slide: int, side: int) -> Limit:
    """The limit of a slide with the row that comes nearest to it."""
    axis, stretch = machine.axes[machine.linear[slide]], rows.stretch_of(row)
    limit = axis.high if side else axis.low
    return Limit(axis.name, ("low", "high")[side], limit, stretch.file, int(rows.line[row]), stretch.operation)


def vector(values: Floats) -> Vector:
    """Three numbers, without -0."""
    x, y, z = (value + 0.0 for value in values.tolist())
    assert math.isfinite(x + y + z)
    return x, y, z
