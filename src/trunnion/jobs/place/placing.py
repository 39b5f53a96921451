"""Where on the table a part may sit: the feasible places of its workpiece zero, and the best of them."""

from collections.abc import Iterable
from dataclasses import replace
from typing import Final, Unpack

import numpy as np

from trunnion.errors import InputError, Problem, Severity, argument_problem
from trunnion.jobs.arguments import PlaceArguments, reported_by_arguments, taken
from trunnion.jobs.inputs.arguments import check_choice, check_observer
from trunnion.jobs.inputs.reading import MachineLike, ToolpathLike, as_machine
from trunnion.jobs.inputs.settings import as_texts
from trunnion.jobs.inputs.simulation_input import SimulationInput, leaves_stock_to_cl, with_decided_stock
from trunnion.jobs.inputs.stated_setup import apply_setup, check_one_zero, set_up_machine
from trunnion.jobs.observer import SILENT, Observer
from trunnion.jobs.place.bodies import BodiesInput, read_bodies, stated_lengths
from trunnion.jobs.place.inputs import read_input
from trunnion.jobs.place.orientations import orientations
from trunnion.jobs.place.table import standing_on
from trunnion.machines import Machine
from trunnion.machines.unmeasured import POSITIONS, ValueKind, corners, unmeasured_values
from trunnion.messages import Wording
from trunnion.model.clamped_toolpaths import clamped_after
from trunnion.options.words import FRAME_SETTING
from trunnion.placing.body_distances import touch_warnings
from trunnion.placing.collisions.path_samples import lengths_of
from trunnion.placing.goals import Goal
from trunnion.placing.place_search import PlaceSearch
from trunnion.placing.placement import Placement
from trunnion.simulation.stock.solids import CL_STOCK

#: The step of turns at which bodies are kept apart, degrees: each of them is a search of its own.
_COLLISION_TURNS: Final = 15.0

#: What the place stands on besides, by its goal.
_OF_GOALS: Final = {
    Goal.TIME: (ValueKind.RAPID, ValueKind.ACCELERATION),
    Goal.OVERSPEED: (ValueKind.RAPID,),
    Goal.COLLISIONS: (ValueKind.BODIES,),
}

GOALS: Final = tuple(str(goal) for goal in Goal)


def place(
    files: Iterable[ToolpathLike] | ToolpathLike,
    *,
    machine: MachineLike,
    observer: Observer = SILENT,
    **given: Unpack[PlaceArguments],
) -> Placement:
    """Find where on the table a part may sit, and where it sits best.

    Parameters
    ----------
    files
        CL files, which ``trunnion.post`` would make one program of, or NC programs: all must fit at one place.
    machine
        A name, a path or a ``Machine``.
    goal
        What the best place is best for: ``"margin"``, the distance of the linear axes to their limits; or the least
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
        Of the tool, gauge point to tip, mm, or ``{"1": 110.0, "2": 85.0}`` of each tool; by default that of the
        definition, or of each tool its own where the CL files state all of them, or 0.
    radius_register
        As for ``verify``, of NC programs: the tool's centre goes beside the path under radius compensation.
    settings, units, dialect, strict
        Of CL files, as ``trunnion.post`` takes them.
    subprograms
        Files of the subprograms that NC programs call.
    hooks
        Python files that change the CL files, as for ``trunnion.post``, which then takes them too. They are run.
    stock, part
        As ``trunnion.simulate`` has them: all of them, seen from above, is to be on the table that the definition
        states. With the goal ``"collisions"`` they are bodies, too.
    fixtures, tools, tool_libraries, unit
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
        When a file or an argument cannot be used, or no linear axis has limits.
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
    stated = taken(PlaceArguments, "place", given)
    goal, turns = check_choice("goal", stated["goal"], GOALS), stated["turns"]
    grid = orientations(_COLLISION_TURNS if turns is None and goal == Goal.COLLISIONS else turns, stated["tilts"])
    texts = as_texts(stated["settings"])
    given_too = {name for name in ("zero", "tool_length") if given.get(name) is not None}
    of_setup = {str(name): texts[name] for name in ("zero", "tool_length") if name in texts and name not in given_too}
    texts.pop("zero", None)
    loaded = set_up_machine(apply_setup(as_machine(machine), of_setup), stated["zero"], stated["tool_length"])
    if not np.isfinite(loaded.limits[list(loaded.linear)]).any():
        raise InputError(argument_problem("machine", Wording("PLC130", "no_limits", machine=loaded.key)))
    check_one_zero(loaded, Wording("ARG220", "one_place"))
    asked = loaded
    tilts_by_size = tuple(sorted(grid.tilts.tolist(), key=abs))
    remarks: list[Problem] = []
    among = BodiesInput(
        stated["fixtures"], stated["part"], stated["stock"], stated["tools"], stated["tool_libraries"], stated["unit"]
    )
    leaves_to_cl = among.stock is not None and leaves_stock_to_cl(among.stock)
    standing = None if leaves_to_cl else standing_on(loaded, among.stock, among.part, remarks)
    with reported_by_arguments("place", given):
        read = read_input(files, loaded, texts, stated, observer, tilts_by_size)
    if leaves_to_cl:
        is_absolute = texts.get(FRAME_SETTING) == "absolute"
        decided = with_decided_stock(SimulationInput(CL_STOCK, ()), read.toolpaths, is_absolute=is_absolute)
        among = replace(among, stock=decided.stock)
        standing = standing_on(loaded, among.stock, among.part, remarks)
    for tilt in tilts_by_size:  # what could not be said in the head of a program is told before it is searched
        clamped_after(read.clamping, (0.0, tilt), read.rows.stretches[0].file)
    bodies = None
    if goal == Goal.COLLISIONS or among.are_given:
        bodies = read_bodies(among, read, loaded, is_needed=goal == Goal.COLLISIONS)
        loaded, remarks = bodies.machine, [*remarks, *bodies.problems]
        read = replace(read, rows=replace(read.rows, length=lengths_of(bodies.guard.lengths, read.tool)))
    elif (loaded.tool_length is None or loaded.tool_lengths) and (own := stated_lengths(read, loaded)):
        loaded = replace(loaded, tool_length=max(own.values()), tool_lengths={})
        read = replace(read, rows=replace(read.rows, length=lengths_of(own, read.tool)))
    problems = [*read.problems, *unknown_length(loaded), *dict.fromkeys(remarks)]
    observer.problems(problems)
    search = PlaceSearch(loaded, read.rows, Goal(goal), grid, standing, None if bodies is None else bodies.guard)
    with observer.progress("placing", len(grid), "turns") as advance:
        found = search.find(advance)
    found = replace(
        found, remarks=tuple(problems), toolpaths=read.toolpaths, clamping=read.clamping,
        unmeasured=_unmeasured(loaded, found),
    )  # fmt: skip
    if asked.tool_lengths:
        found = replace(found, tool_length_mm=asked.tool_length, tool_lengths_mm=asked.tool_lengths)
    if bodies is None or goal == Goal.COLLISIONS:
        return found
    touching = touch_warnings(found)
    observer.problems(touching)
    return replace(found, remarks=(*found.remarks, *touching))


def _unmeasured(machine: Machine, found: Placement) -> tuple[Wording, ...]:
    """Return the values that nobody has measured, and that the place stands on."""
    kinds = {*POSITIONS, ValueKind.TRAVEL, *_OF_GOALS.get(Goal(found.goal), ())}
    if found.table is not None:
        kinds.add(ValueKind.TABLE)
    joints = None
    if found.best is not None:
        ranges = {each.axis: (each.least_mm, each.greatest_mm) for each in found.best.axes}
        ranges |= {each.axis: (each.least_deg, each.greatest_deg) for each in found.best.rotary}
        joints = corners(machine, ranges)
    # The zero is what is looked for: it is the place that stands on the geometry, not the position of a tip.
    placed = replace(machine, workpiece_zero=machine.workpiece_zero or (0.0, 0.0, 0.0))
    return tuple(value.said for value in unmeasured_values(placed, kinds, joints))


def unknown_length(machine: Machine) -> list[Problem]:
    """Return a warning where places depend on a tool length that nobody has stated."""
    axes = tuple(machine.axes[k].name for k in machine.linear if machine.depends_on_length(k))
    if machine.tool_length is not None or machine.tool_lengths or not axes:
        return []
    return [
        argument_problem(
            "tool_length", Wording("PLC210", "places_depend_on_length", axes=axes), severity=Severity.WARNING
        )
    ]
