"""``trunnion place``: where on the table a part may sit."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Final

from trunnion.arrays import Floats
from trunnion.cli.printing import print_result, tell
from trunnion.cli.results import show
from trunnion.cli.terminal import Terminal, output_place
from trunnion.errors import InputError, Problem, argument_problem
from trunnion.jobs.inputs.reading import ToolpathLike, load_machine
from trunnion.jobs.inputs.settings import as_texts
from trunnion.jobs.job import Given, streams
from trunnion.jobs.place.bodies import BodiesInput
from trunnion.jobs.place.inputs import toolpaths_to_post
from trunnion.jobs.place.placing import place
from trunnion.jobs.place.posting import post_placed
from trunnion.messages import Wording, phrase
from trunnion.model.clamping import are_one_angle, number
from trunnion.placing.placement import AxisUse, BodyDistance, Limit, PartPlace, Placement, RotaryUse, TurnMargin
from trunnion.placing.program_use import ProgramUse, other_positions
from trunnion.placing.table_limits import KEPT
from trunnion.wording import counted, format_duration

if TYPE_CHECKING:  # imported where a project is placed
    from trunnion.jobs.place.project import PlacedSetup

#: The step of the fixture angles of ``--free``, degrees.
_FREE_STEP: Final = 15.0

#: Turns out of reach that are told one by one.
_MOST: Final = 3

#: What differs by less is printed as the same, mm.
_SAME: Final = 0.0005


def run(given: Given) -> int:
    """Place a part; 0 if it fits somewhere, else 1."""
    project = _project(given)
    if project is not None:
        Terminal().problems(project.problems)
    files, machine_name = (
        (given.files, given.machine) if project is None else (project.files, given.machine or project.machine)
    )
    if machine_name is None:
        raise InputError(argument_problem("machine", Wording("ARG130", "missing_machine")))
    machine = load_machine(machine_name)
    if given.sheet is not None and given.apply is None:
        raise InputError(argument_problem("sheet", Wording("ARG130", "sheet_without_apply")))
    settings = {**({} if project is None else as_texts(project.settings)), **dict(given.settings)}
    length = given.tool_length or settings.get("tool_length")
    stated = BodiesInput() if project is None else project.bodies
    placed: Sequence[ToolpathLike] = streams(files)
    if given.apply is not None:
        placed = toolpaths_to_post(placed, machine=machine, settings=settings, strict=given.strict, observer=Terminal())
    found = place(
        placed,
        machine=machine,
        goal=given.goal,
        turns=given.only_turns or given.turns,
        tilts=(_FREE_STEP if given.free else given.tilts) or (),
        zero=given.zero,
        tool_length=given.tool_length,
        radius_register=given.radius_register,
        settings=settings,
        strict=given.strict,
        subprograms=given.subprograms,
        hooks=given.hooks,
        fixtures=given.fixtures or stated.fixtures,
        part=given.part or stated.part,
        stock=given.stock or stated.stock,
        tools=given.tools or stated.tools,
        tool_libraries=given.tool_libraries or stated.tool_libraries,
        unit=given.unit or stated.unit,
        observer=Terminal(),
    )
    to_stdout = given.apply == "-"
    show(given, lambda: found, placement_lines(found), aside=to_stdout)
    if given.plot is not None:
        from trunnion.jobs.place.plot import write_placing_plot

        write_placing_plot(found, given.plot, inputs=given.read)
    if given.apply is not None and found.fits:
        settings = settings if length is None else {**settings, "tool_length": length}
        output = output_place(given.apply)
        posted = post_placed(
            found,
            machine=machine,
            output=output,
            settings=settings,
            sheet=given.sheet,
            hooks=given.hooks,
            observer=Terminal(),
        )
        use = None if posted.run is None else other_positions(found, posted.run)
        if use is not None:
            (tell if to_stdout or given.json == "-" else print_result)(f"  {_other_positions(use)}")
    return 0 if found.fits else 1


def _other_positions(use: ProgramUse) -> str:
    """Where the program has other rotary positions than the place."""
    ends = ", ".join(f"{name} {low + 0.0:.3f} to {high + 0.0:.3f}" for name, low, high in use.rotary)
    return f"the program takes other rotary positions, at feed {ends} degrees: {use.margin_mm:.3f} mm to the limits"


def _project(given: Given) -> "PlacedSetup | None":
    """Return the set-up of the project that is placed; None: files are."""
    projects = [file for file in given.files if file.endswith(".toml")]
    if not projects:
        if given.setup is not None:
            raise InputError(argument_problem("setup", Wording("ARG130", "setup_without_project")))
        return None
    if len(given.files) > 1:
        raise InputError(Problem(projects[0], 0, Wording("ARG130", "project_among_files")))
    from trunnion.jobs.place.project import placed_setup

    return placed_setup(Path(projects[0]), given.setup, has_zero=given.zero is not None)


def placement_lines(found: Placement) -> Iterator[str]:
    """Yield a placement in lines."""
    best, present = found.best, found.present
    if best is None:
        off_table = any(turn.table_is_too_small for turn in found.turns)
        what = "the part finds a place at" if off_table else "the rotary axes reach the path at"
        yield f"{found.machine}: {what} no {_tried(found)}"
        for turn in sorted(found.turns, key=lambda each: abs(each.tilt_deg))[:_MOST]:
            yield f"  {_clamped(turn)}: {turn.obstacle}"
        return
    if (touching := _touch_line(found)) is not None:
        yield touching
        yield f"  the place with the largest margin is {_point(best)}, {_clamped(best)}"
    elif not best.fits:
        off = f"{-best.margin_mm:.3f} mm too far at the least"
        yield f"{found.machine}: the part fits nowhere: {off}, at {_point(best)}, {_clamped(best)}"
    else:
        left = f"{best.margin_mm:.3f} mm to the limits"
        yield f"{found.machine}: best zero {_point(best)}, {_clamped(best)}: {left}"
    if best.fits:
        yield from (f"  {line}" for line in _sense(found))
    for axis in best.axes:
        yield f"  {_use(axis)}"
    for rotary in best.rotary:
        yield f"  {_rotary_use(rotary)}"
    yield from (f"  {line}" for line in _table(found, best))
    yield from (f"  {line}" for line in _body_lines(found))
    if found.limits:
        what = _held(found, best)
        yield f"  {what} {'; '.join(dict.fromkeys(map(_limit, found.limits)))}{_overlap(found)}"
    if present is not None:
        gain = best.margin_mm - present.margin_mm
        state = f"{present.margin_mm:.3f} mm to the limits" if present.fits else f"{-present.margin_mm:.3f} mm too far"
        state += _beyond_table(present)
        gained = "" if found.goal != "margin" else f"; the best place{_where(best)} has {_gain_text(gain)}"
        yield f"  present zero {_point(present)}{_where(best, present)}: {state}{gained}"
    if found.goal not in ("margin", "collisions") and best.value is not None:
        now = "" if present is None else f"; at the present zero {_goal_number(found.goal, present)}"
        yield f"  {_value(found.goal, best)}{now}"
    yield f"  {_share(found)}"
    if best.tilt_deg and (plain := _without_tilt(found)) is not None:
        yield f"  without a fixture angle: {plain}"
    if found.region is not None:
        box = found.region.box
        yield f"  clamped so, the zero may be anywhere within {_ends(box.low, box.high)}"
        if not found.region.is_box:
            yield f"  and not beyond {_ends(found.region.low, found.region.high)}, where not every place fits"
    if found.not_measured:
        yield f"  {phrase('stands_on', values=found.not_measured)}"


def _table(found: Placement, best: PartPlace) -> Iterator[str]:
    """Which table the part stands on, and how far from its edge; or that nothing keeps it there."""
    table = found.table
    if table is None:
        return
    x, y = table.centre
    where = f" on the {table.axis} axis" if table.axis else ""
    named = f"the definition's, {table}, its middle{where} at X{x:.3f} Y{y:.3f}"
    if best.table_mm is not None:
        yield f"table: {max(best.table_mm, 0.0):.3f} left to its edge; it is {named}"
    elif best.fits and not table.has(best.zero_mm):
        yield f"the zero is beyond the table, {named}: give stock or part to keep them on it"


def _held(found: Placement, best: PartPlace) -> str:
    """Return what the limits that are told do."""
    if not best.fits:
        return "these conflict:"
    return "it is held by" if found.goal == "margin" else f"nearest limit{'s' if len(found.limits) > 1 else ''}:"


def _beyond_table(place: PartPlace) -> str:
    beyond = 0.0 if place.table_mm is None else -place.table_mm
    return f" ({beyond:.3f} mm beyond the table)" if beyond > KEPT else ""


def _where(best: PartPlace, place: PartPlace | None = None) -> str:
    """How the part is clamped at a place, by default the best: where that is not how it is now."""
    is_turned = not (are_one_angle(best.turn_deg, 0.0) and are_one_angle(best.tilt_deg, 0.0))
    return f", {_clamped(place or best)}{'' if place else ','}" if is_turned else ""


def _clamped(place: PartPlace | TurnMargin) -> str:
    tilted = f"tilted {number(place.tilt_deg)} degrees about X, then " if place.tilt_deg else ""
    return f"{tilted}turned {number(_once(place.turn_deg))} degrees"


def _once(turn: float) -> float:
    """Return a turn as it is told, from 0 up to 360 degrees."""
    return 0.0 if are_one_angle(turn, 0.0) else turn % 360.0


def _sense(found: Placement) -> Iterator[str]:
    """How the part is clamped: in words that do not ask for a rule of hands."""
    best, stated, whole = found.best, found.clamping, found.clamped
    assert best is not None
    if whole is None:
        return
    if stated is not None and not stated.is_as_drawn:
        yield f"the part is {stated} already, as its file states; with that, against the drawing:"
    if not are_one_angle(whole.tilt, 0.0):
        side = "up" if whole.tilt > 0.0 else "down"
        angle = number(whole.tilt)
        yield f"first a fixture angle of {angle} degrees about X of the part, right-handed: its +Y side goes {side}"
    if not are_one_angle(whole.turn, 0.0):
        then = "" if are_one_angle(whole.tilt, 0.0) else "then "
        turn = number(_once(whole.turn))
        yield f"{then}turn the part by {turn} degrees about Z, counter-clockwise seen from above (from +Z)"
    if whole.is_as_drawn:
        yield "the part is clamped as it is drawn"


def _share(found: Placement) -> str:
    """At how many of the turns that were asked for the part fits, and at how many more around the best."""
    asked = [turn for turn in found.turns if turn.is_asked]
    more = [turn for turn in found.turns if not turn.is_asked]
    fits = sum(turn.fits for turn in asked)
    if not more:
        return f"it fits at {fits} of {counted(len(asked), _tried(found))}"
    text = f"it fits at {fits} of the {counted(len(asked), _tried(found))} asked for"
    return f"{text}; around the best, {len(more)} more were tried, {sum(turn.fits for turn in more)} fit"


def _tried(found: Placement) -> str:
    """Return what was tried, in a word."""
    return "tilted turn" if len({turn.tilt_deg for turn in found.turns}) > 1 else "turn"


def _without_tilt(found: Placement) -> str | None:
    """Return the best place of those that need no fixture angle, in words; None if none was tried."""
    flat = [turn for turn in found.turns if turn.tilt_deg == 0.0]
    if not flat:
        return None
    best = max(flat, key=lambda turn: -float("inf") if turn.margin_mm is None else turn.margin_mm)
    if best.margin_mm is None:
        small = all(turn.table_is_too_small for turn in flat)
        return "the table is too small" if small else "the rotary axes do not reach the path"
    margin = best.margin_mm
    left = f"{margin:.3f} mm to the limits" if margin >= 0.0 else f"it fits nowhere, {-margin:.3f} mm too far"
    return f"{left}, {_clamped(best)}"


def _ends(low: Floats, high: Floats) -> str:
    ends = zip("XYZ", low.tolist(), high.tolist(), strict=True)
    return ", ".join(f"{name} {least:.3f} to {most:.3f}" for name, least, most in ends)


def _rotary_use(axis: RotaryUse) -> str:
    text = f"{axis.axis} {axis.least_deg + 0.0:.3f} to {axis.greatest_deg + 0.0:.3f} degrees"
    if axis.margin_deg == float("inf"):
        return f"{text}, no limits"
    return f"{text} of {axis.low_deg:g} to {axis.high_deg:g}: {max(axis.margin_deg, 0.0):.3f} left"


def _point(place: PartPlace) -> str:
    return ",".join(f"{value:.3f}" for value in place.zero_mm)


def _overlap(found: Placement) -> str:
    """How much travel is missing, where both limits of one linear axis conflict and nothing else does."""
    ends = {(limit.axis, limit.end) for limit in found.limits}
    if found.fits or found.best is None or len(ends) != 2 or len({axis for axis, _ in ends}) > 1:
        return ""
    return f"; {found.limits[0].axis} needs {-2.0 * found.best.margin_mm:.3f} mm more travel"


def _value(goal: str, place: PartPlace) -> str:
    """Return the value of a goal in words."""
    what = {
        "rotary": "the rotary axes turn",
        "slides": "the linear axes travel",
        "time": "as the planner of speeds has it, it takes",
        "overspeed": "the axes do not reach the feed in",
    }
    return f"{what[goal]} {_goal_number(goal, place)}"


def _goal_number(goal: str, place: PartPlace) -> str:
    value = place.value or 0.0
    if goal == "time":
        planned = value if place.planned_s is None else place.planned_s
        return f"{format_duration(planned)} ({format_duration(value)} by speeds alone)"
    return (
        counted(round(value), "row")
        if goal == "overspeed"
        else f"{value:.1f} {'degrees' if goal == 'rotary' else 'mm'}"
    )


def _use(axis: AxisUse) -> str:
    text = f"{axis.axis} {axis.least_mm:.3f} to {axis.greatest_mm:.3f}"
    if axis.low.limit_mm == -float("inf") and axis.high.limit_mm == float("inf"):
        return f"{text}, no limits stated"
    left = f"{axis.margin_mm:.3f} left" if axis.margin_mm >= 0.0 else f"{-axis.margin_mm:.3f} too far"
    return f"{text} of {axis.low.limit_mm:g} to {axis.high.limit_mm:g}: {left}"


def _limit(limit: Limit) -> str:
    if not limit.file:  # that of a table
        edge = limit.end.split()[-1]
        return (
            f"the table's rim, Ø{limit.limit_mm:g}"
            if edge == "rim"
            else f"the table's edge at {edge} {limit.limit_mm:g}"
        )
    return f"{limit.axis} at {limit.limit_mm:g} ({limit.file}:{limit.line})"


def _body_lines(found: Placement) -> Iterator[str]:
    """How far bodies are apart at the best place, at the present one, and wherever the part sits."""
    best, present = found.best, found.present
    if best is not None and best.nearest is not None:
        now = "" if present is None or present.nearest is None else f"; at the present zero {_apart(present.nearest)}"
        yield f"nearest to each other: {_apart(best.nearest)}{now}{_gain(found)}"
    if found.most_distance_mm is not None and not found.touching:
        yield f"no place at the turns that were tried keeps bodies farther apart than {found.most_distance_mm:.3f} mm"
    if found.nearest_anywhere is not None:
        yield f"wherever the part sits: {_apart(found.nearest_anywhere)}"


def _touch_line(found: Placement) -> str | None:
    """Return what is said first where bodies touch everywhere; None where they do not."""
    if found.goal != "collisions" or found.touching is None:
        return None
    return f"{found.machine}: bodies touch wherever the part sits: {_apart(found.touching)}"


def _apart(nearest: BodyDistance) -> str:
    """Two bodies in words."""
    one, other = nearest.between
    apart = "touch" if nearest.touches else f"are {nearest.distance_mm:.3f} mm apart"
    return f"{one} and {other} {apart} ({nearest.file}:{nearest.line})"


def _gain(found: Placement) -> str:
    """How much farther apart bodies are at the best place than at the present one."""
    best, present = found.best, found.present
    if best is None or present is None or best.nearest is None or present.nearest is None:
        return ""
    return f"; the best place has {_gain_text(best.nearest.distance_mm - present.nearest.distance_mm)}"


def _gain_text(gain: float) -> str:
    """How much more the best place has than the present one, mm."""
    if abs(gain) < _SAME:
        return "the same"
    return f"{abs(gain):.3f} mm {'more' if gain > 0.0 else 'less'}"
