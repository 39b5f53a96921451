"""``trunnion place``: where on the table a part may sit."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Final

from trunnion.cli.machine.place_text import placement_lines
from trunnion.cli.printing import print_result, tell
from trunnion.cli.results import show
from trunnion.cli.terminal import Terminal, output_place
from trunnion.cli.wording import line, part, spoken
from trunnion.errors import InputError, Problem, argument_problem
from trunnion.jobs.inputs.reading import ToolpathLike, load_machine
from trunnion.jobs.inputs.settings import as_texts
from trunnion.jobs.job import Given, streams
from trunnion.jobs.place.bodies import BodiesInput
from trunnion.jobs.place.inputs import toolpaths_to_post
from trunnion.jobs.place.placing import place
from trunnion.jobs.place.posting import post_placed
from trunnion.messages import Wording
from trunnion.placing.program_use import ProgramUse, other_positions

if TYPE_CHECKING:  # imported where a project is placed
    from trunnion.jobs.place.project import PlacedSetup

#: The step of the fixture angles of ``--free``, degrees.
_FREE_STEP: Final = 15.0


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

        write_placing_plot(found, given.plot, inputs=given.read, words=spoken())
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
    ends = tuple(part("axis_ends", axis=name, low=low + 0.0, high=high + 0.0) for name, low, high in use.rotary)
    return line("other_positions", ends=ends, margin=use.margin_mm)


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
