"""A program on its machine, as a page for a browser."""

import os
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, Final, Unpack

from trunnion.compensation.contour_tools import ContourTools
from trunnion.compensation.driven_runs import driven_run
from trunnion.compensation.notices import compensation_notices
from trunnion.errors import InputError, Severity, argument_problem
from trunnion.files import atomic_file
from trunnion.jobs.arguments import ViewArguments, reported_by_arguments, taken
from trunnion.jobs.inputs.arguments import check_path, check_paths
from trunnion.jobs.inputs.bodies import KnownTools, fixture_meshes, known_tools
from trunnion.jobs.inputs.control_settings import register_value
from trunnion.jobs.inputs.reading import FilePath, as_machine
from trunnion.jobs.inputs.settings import Settings, as_texts
from trunnion.jobs.inputs.stated_setup import set_up_machine
from trunnion.jobs.inputs.stated_words import with_stated
from trunnion.jobs.observer import SILENT, Observer
from trunnion.jobs.project.file import is_project
from trunnion.jobs.result_output import declared_output
from trunnion.jobs.view.inputs import bodies_not_clamped_so, of_project, view_program
from trunnion.jobs.view.stock import view_simulation, with_stock
from trunnion.machines import Machine
from trunnion.messages import Wording
from trunnion.model.one_frame import WorkpieceFrame, frame_of_offset
from trunnion.model.run import Run
from trunnion.options.words import FRAME_SETTING
from trunnion.simulation.collisions.bodies import fixture_body, part_body
from trunnion.simulation.meshes import load_mesh
from trunnion.simulation.tool_deltas import radius_of
from trunnion.simulation.tools.choice import NO_CALL
from trunnion.simulation.tools.profile import ToolShape
from trunnion.verification.comparison import align
from trunnion.verification.driven_rows import DrivenRows
from trunnion.viewer.content import ViewContent, side_by_side, view_content, with_phases
from trunnion.viewer.page import render_view

#: Arguments that a project does not state: the second program, and what the first is made with.
_OF_VIEW: Final = ("against", "against_machine", "setup", "settings")


def prepare_view(
    nc: FilePath | Sequence[FilePath], *, observer: Observer = SILENT, **given: Unpack[ViewArguments]
) -> ViewContent:
    """Read a program, run and verify it, and put together what a page shows; arguments as ``write_view``.

    Raises ``InputError`` when a file or an argument cannot be used, or no reader knows the control.
    """
    stated: dict[str, Any] = {**taken(ViewArguments, "view", given)}
    against, against_machine, setup, settings = (stated.pop(name) for name in _OF_VIEW)
    files = [check_path("nc", nc)] if isinstance(nc, str | os.PathLike) else check_paths("nc", nc)
    if files and is_project(files[0]):
        stated = of_project(files[0], setup, stated)
        files = check_paths("nc", stated.pop("nc"))
    elif setup is not None:
        raise InputError(argument_problem("setup", Wording("PAG111", "setup_without_project")))
    with reported_by_arguments("view", given):
        content, run = _prepared(files, settings, observer, **stated)
    if against is None:
        if against_machine is not None:
            raise InputError(argument_problem("against_machine", Wording("PAG111", "machine_without_program")))
        return content
    alone = isinstance(against, str | os.PathLike)
    beside = [check_path("against", against)] if alone else check_paths("against", against)
    other = stated | dict.fromkeys(("stock", "near", "cell", "accuracy")) | {"cl": (), "subprograms": (), "hooks": ()}
    if against_machine is not None:  # where the part lies is not the same there
        other |= {"machine": against_machine, "zero": None, "tool_length": None}
    second, other_run = _prepared(beside, settings, observer, **other)
    return side_by_side(content, second, align(run, other_run))


def _prepared(
    files: Sequence[Path], settings: Settings | None, observer: Observer, **given: Any
) -> tuple[ViewContent, Run]:
    """Put together what a page shows of one program, when no project states arguments any more; and its run."""
    if not files:
        raise InputError(argument_problem("nc", Wording("PAG110", "nothing_to_view")))
    if given["machine"] is None:
        raise InputError(argument_problem("machine", Wording("PAG110", "missing_machine")))
    stated, settings = with_stated(as_machine(given["machine"]), settings, given["assume"])
    placed = set_up_machine(stated, given["zero"], given["tool_length"])
    of_stock = ("stock", "part", "fixtures", "tools", "tool_libraries", "unit", "near", "cell", "accuracy")
    holds = register_value(given["radius_register"], settings, placed)
    frame = as_texts(settings).get(FRAME_SETTING)
    simulated = view_simulation(placed, holds, frame, **{name: given[name] for name in of_stock})
    viewed = view_program(files, placed, given=given, settings=settings, observer=observer)
    if any(given[name] for name in ("stock", "part", "fixtures")):
        observer.problems(bodies_not_clamped_so(files[0], viewed.toolpaths))
    fixtures = fixture_meshes(given["fixtures"], [])
    run = viewed.verification.run
    machine = _with_zero_of(frame_of_offset([run], None), viewed.verification.machine)
    around = [fixture_body(mesh, machine) for mesh in fixtures]
    part = None if given["part"] is None else load_mesh(check_path("part", given["part"]), name="part")
    clamped = around if part is None else [part_body(part, machine), *around]
    bodies = _shown_tools(run, known_tools(given["tools"], given["tool_libraries"], given["unit"], viewed.toolpaths))
    driven = driven_run(run, holds, lambda row: radius_of(run, bodies, row), ContourTools.of(viewed.toolpaths))
    content = view_content(
        replace(viewed.verification, machine=machine), viewed.texts, viewed.cl_texts, bodies, clamped,
        DrivenRows(driven.centre.run, driven.centre.row_of),
    )  # fmt: skip
    content = with_phases(content, viewed.verification, viewed.toolpaths)
    if notices := [replace(each, severity=Severity.WARNING) for each in compensation_notices(run, driven)]:
        observer.problems(notices)
        content = replace(content, scene={**content.scene, "remarks": notices})
    if simulated is not None:
        content = with_stock(content, simulated, viewed.verification, viewed.toolpaths, observer)
    return content, run


def _with_zero_of(frame: WorkpieceFrame, machine: Machine) -> Machine:
    """Return the machine with the zero about which stock and part are shown."""
    return machine if frame.zero is None else replace(machine, workpiece_zero=frame.zero)


def write_view(
    nc: FilePath | Sequence[FilePath],
    *,
    output: FilePath,
    observer: Observer = SILENT,
    **given: Unpack[ViewArguments],
) -> str:
    """Show an NC program on its machine, block by block, on a page that works offline.

    Parameters
    ----------
    nc
        The program, also with the files of its subprograms behind it; or CL files, which are posted as one program,
        also where it must not run; or a project (.toml), which states the arguments that are not given here.
    output
        The page, ``.html``. An older file is replaced when the new one is complete.
    machine
        The machine that runs it: a name, a path or a ``Machine``. Only a project may state it instead.
    against, against_machine
        A second program, or CL files, which go along the same tool path beside the first, and the machine that runs
        it if it is another. What differs is marked, as ``trunnion.diff`` compares programs.
    setup
        Name or number of a project's set-up, if it has several.
    settings, units, dialect, strict
        For CL files, as for ``post``. ``settings`` may have values of variables, too, as for ``verify``.
    assume
        What words do that the reader does not know, as for ``verify``.
    cl
        Its CL files: the page then names the CL line of each block, and what the proof finds.
    hooks
        Python files that change the CL files, as for ``post``. They are run; those of a project are not.
    subprograms
        Files of the subprograms that it calls. No others are opened.
    stock, near, cell, accuracy
        As for ``simulate``: the page then shows the stock as it is cut, how far it is from ``part`` in the end, and
        what the simulation finds. Without ``stock`` nothing is simulated; ``"cl"`` is that of the CL files.
    part, fixtures
        Meshes in the workpiece frame.
    radius_register
        As for ``verify``: the tool's centre goes beside the path under radius compensation. Where nobody has stated it,
        or the tool's radius is not known, the page shows the programmed path, and says so.
    tools, tool_libraries, unit
        Tools as ``simulate`` has them. Without ``stock``, one whose form nothing states is drawn as a needle.
    zero, tool_length
        As for ``verify``. Without a zero, the part is drawn at the machine's zero.
    observer
        Receives progress and warnings.

    Returns
    -------
    str
        What the proof says of the program, as the page has it.

    Raises
    ------
    InputError
        When a file or an argument cannot be used, or no reader knows the control.

    Examples
    --------
    >>> import trunnion
    >>> _ = trunnion.write_view("tests/golden/yl569/2_hub_rough.expected.mpf", machine="yl569", output="view.html")
    """
    place = declared_output("view", "output", output)
    content = prepare_view(nc, observer=observer, **given)
    if content.stock is not None:
        with observer.progress("states of the stock", len(content.stock.page_states), "states") as tell:
            content.stock.packed(tell)
    with atomic_file(place, inputs=_shown_files(content)) as sink:
        sink.writelines(render_view(content, observer.words, embedded=True))
    return str(content.said(observer.words)["standing"])


def _shown_files(content: ViewContent) -> list[Path]:
    scenes = (content.scene, content.scene.get("against", {}))
    return [Path(file) for scene in scenes for file in scene.get("files", ())]


def _shown_tools(run: Run, known: KnownTools) -> dict[str, ToolShape]:
    """Return the bodies of the tools whose form something states."""
    found: dict[str, ToolShape] = {}
    for name in run.tools:
        try:
            found[name] = known.choose([name or NO_CALL])[name or NO_CALL]
        except InputError:
            continue  # drawn as a needle, which the page says
    return found
