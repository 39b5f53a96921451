"""The path that is placed: rows of CL files as they are planned, or of NC programs as they run."""

import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import cast

import numpy as np

from trunnion import readers
from trunnion.arrays import Ints, distinct
from trunnion.cl.read import ClReading
from trunnion.errors import InputError, Problem, RefusedError, Severity
from trunnion.jobs.arguments import PlaceArguments
from trunnion.jobs.inputs.arguments import check_paths, is_stream, wrong_argument
from trunnion.jobs.inputs.bodies import known_tools
from trunnion.jobs.inputs.control_settings import register_value
from trunnion.jobs.inputs.driven_paths import centres_of, driven_by_tools
from trunnion.jobs.inputs.hooked import hooked_toolpaths, no_cl_files
from trunnion.jobs.inputs.reading import ToolpathLike, cl_reading, read_toolpaths
from trunnion.jobs.inputs.settings import Settings, as_texts
from trunnion.jobs.observer import SILENT, Observer
from trunnion.jobs.post.planning import plan
from trunnion.machines import Machine
from trunnion.messages import Wording, phrase
from trunnion.model.clamped_toolpaths import stated_clamping, turned_toolpaths
from trunnion.model.clamping import Clamping
from trunnion.model.rotations import about_x
from trunnion.model.run import Run
from trunnion.model.toolpath import Toolpath
from trunnion.placing.path_rows import PathRows, joined_rows
from trunnion.placing.plan_rows import rows_of_plan
from trunnion.placing.program_heads import damaged_notices, stated_place
from trunnion.placing.program_rows import _rows_at_workpiece, rows_of_run
from trunnion.records import dataclass
from trunnion.verification.kinematics.machine_travel import positions_beyond_travel


@dataclass(frozen=True, slots=True, eq=False)
class PlacedInput:
    """What is placed: rows, and the toolpaths that they come from, of CL files; none, of NC programs.

    clamping  how the part is clamped, as the files state; None: they state nothing
    tool   (n,) which of ``tools`` is in the spindle in each row
    tools  numbers and names as the files have them; empty: none was called
    """

    rows: PathRows
    tool: Ints
    tools: tuple[str, ...]
    toolpaths: tuple[Toolpath, ...] = ()
    problems: tuple[Problem, ...] = ()
    clamping: Clamping | None = None

    @property
    def used_tools(self) -> list[int]:
        """The numbers in ``tools`` of those that are in the spindle in some row."""
        return [int(number) for number in distinct(self.tool)]


def read_input(
    files: Iterable[ToolpathLike] | ToolpathLike,
    machine: Machine,
    settings: Settings | None,
    stated: PlaceArguments,
    observer: Observer,
    tilts: Sequence[float] = (0.0,),
) -> PlacedInput:
    """Read CL files or NC programs; which they are is found out.

    CL files are planned as they are; where rotary axes do not reach them so, at the first of the ``tilts``, degrees, at
    which they do. The rows are those of the part as it is drawn.

    Raises ``InputError`` if a file cannot be used as either, or some are CL files and others programs.

    Raises ``RefusedError`` if a program has words that are not understood, or leaves the travel in machine coordinates,
    or no plan of the CL files is possible.
    """
    if isinstance(files, str | os.PathLike | Toolpath) or is_stream(files):
        files = [files]
    if isinstance(files, bytes | Mapping) or not isinstance(files, Iterable):
        raise wrong_argument("files", files, phrase("give_cl_or_nc"))
    given = cast("list[ToolpathLike]", list(files))
    subprograms, hooks = check_paths("subprograms", stated["subprograms"]), check_paths("hooks", stated["hooks"])
    if not given:
        raise InputError(Problem("files", 0, Wording("ARG130", "no_file")))
    texts = as_texts(settings)
    toolpaths: list[Toolpath] = []
    programs: list[Path] = []
    for each in given:
        found = _toolpaths_of(each, cl_reading(texts, stated["strict"]), machine, observer)
        toolpaths += found or ()
        if found is None and isinstance(each, str | os.PathLike):
            programs.append(Path(each))
    if programs and len(programs) < len(given):
        raise InputError(
            Problem(str(programs[0]), 0, Wording("PLC110", "programs_and_others", count=len(given) - len(programs)))
        )
    if programs and hooks:
        raise no_cl_files()
    if programs:
        known = known_tools(stated["tools"], stated["tool_libraries"], stated["unit"], ())
        holds = register_value(stated["radius_register"], settings, machine)
        runs, problems = list[Run](), list[Problem]()
        for program in programs:
            run, notices = driven_by_tools(_run_of(program, machine, subprograms), known, holds)
            runs.append(run)
            problems += [replace(each, severity=Severity.WARNING) for each in notices]
        clamping, damaged = _clamping_of_programs(programs)
        return replace(_of_runs(runs), problems=(*problems, *damaged), clamping=clamping)
    clamping = stated_clamping(toolpaths)
    placed = _planned_tilted(hooked_toolpaths(toolpaths, machine, hooks, texts), machine, texts, observer, tilts)
    return replace(placed, clamping=clamping, toolpaths=tuple(toolpaths))  # a post has hooks change them itself


def _clamping_of_programs(programs: Sequence[Path]) -> tuple[Clamping | None, tuple[Problem, ...]]:
    """How the part of programs is clamped, as their heads say, and what is damaged there."""
    stated = [stated_place(program) for program in programs]
    problems = [each for program, own in zip(programs, stated, strict=True) for each in damaged_notices(program, own)]
    first = next((own.clamping for own in stated if own.clamping is not None), None)
    for program, own in zip(programs, stated, strict=True):
        if first is not None and not (own.clamping or Clamping()).is_like(first):
            raise InputError(
                Problem(
                    str(program),
                    0,
                    Wording("PLC310", "clamping_not_stated", first=first)
                    if own.clamping is None
                    else Wording("PLC310", "clamped_otherwise", own=own.clamping, first=first),
                )
            )
    return first, tuple(problems)


def toolpaths_to_post(
    files: Iterable[ToolpathLike],
    *,
    machine: Machine,
    settings: Settings | None = None,
    strict: bool = False,
    observer: Observer = SILENT,
) -> list[Toolpath]:
    """Read CL files that are to be posted where they are placed: who places them need not read them again.

    Raises ``InputError`` if a file cannot be used, or one is an NC program: it stays as it is.
    """
    how, found = cl_reading(as_texts(settings), strict), list[Toolpath]()
    for each in files:
        toolpaths = _toolpaths_of(each, how, machine, observer)
        if toolpaths is None:
            raise InputError(nc_program_stays(str(each)))
        found += toolpaths
    return found


def nc_program_stays(file: str) -> Problem:
    """Return the error of an NC program that is to be posted where it was placed."""
    return Problem(file, 0, Wording("PLC140", "program_stays"))


def _toolpaths_of(file: ToolpathLike, how: ClReading, machine: Machine, observer: Observer) -> list[Toolpath] | None:
    """Return the toolpaths of a CL file; None if it is a program that the machine's control understands."""
    try:
        return read_toolpaths(file, observer, how)
    except InputError as error:
        if not isinstance(file, str | os.PathLike) or not readers.can_read(machine):
            raise
        if any(problem.code.startswith("FIL") for problem in error.problems):
            raise
        run = readers.run_program(Path(file), machine)
        if len(run) > len({each.line for each in run.errors}):
            return None
        raise


def _run_of(program: Path, machine: Machine, subprograms: Sequence[Path]) -> Run:
    run = readers.run_program(program, machine, readers.RunOptions(subprograms=subprograms))
    if run.errors:
        found = [Problem(each.file, each.line, each.wording) for each in run.errors]
        raise RefusedError(
            (*found, Problem(str(program), 0, Wording("PLC120", "not_understood", count=len(run.errors))))
        )
    if beyond := tuple(_beyond_travel(run)):
        raise RefusedError(beyond)
    return run


def _planned_tilted(
    toolpaths: Sequence[Toolpath],
    machine: Machine,
    settings: Mapping[str, str],
    observer: Observer,
    tilts: Sequence[float],
) -> PlacedInput:
    """Return the rows of CL files as they are, planned at the first tilt at which that is possible."""
    try:
        return _planned(toolpaths, machine, settings, observer)
    except RefusedError:
        absolute = settings.get("frame") == "absolute"
        for tilt in (tilt for tilt in tilts if tilt):
            with suppress(RefusedError):
                tilted = turned_toolpaths(toolpaths, 0.0, tilt, absolute=absolute)
                found = _planned(tilted, machine, settings, SILENT)
                return replace(found, rows=found.rows.turned(about_x(-tilt)), toolpaths=tuple(toolpaths))
        raise


def _beyond_travel(run: Run) -> Iterator[Problem]:
    """Positions in machine coordinates that no place of the part brings into the travel."""
    for found in positions_beyond_travel(run):
        if run.machine.axes[found.column].is_rotary:  # where it stands follows from the path, which is judged by turn
            continue
        file = run.files[run.state.file[found.row]]
        yield Problem(
            file,
            run.lines[found.row],
            Wording(
                "PLC180",
                "beyond_travel_of_machine",
                axis=run.machine.names[found.column],
                value=found.value,
                limit=found.limit,
            ),
        )


def _planned(
    toolpaths: Sequence[Toolpath], machine: Machine, settings: Mapping[str, str], observer: Observer
) -> PlacedInput:
    """Return the rows of CL files, planned on the machine without limits of its slides."""
    free = replace(
        machine,
        workpiece_zero=(0.0, 0.0, 0.0),
        axes=tuple(axis if axis.is_rotary else replace(axis, low=-np.inf, high=np.inf) for axis in machine.axes),
    )
    centres, notices = centres_of(toolpaths, machine)
    planned = plan(centres, machine=free, settings={**settings, "cycles": "off"}, explain=False, observer=observer)
    warnings = tuple(problem for problem in planned.problems if problem.severity is Severity.WARNING)
    rows = rows_of_plan(free, planned.motions)
    tools = tuple(dict.fromkeys(stretch.tool for stretch in rows.stretches))
    ends = np.diff([*(stretch.first for stretch in rows.stretches), len(rows)])
    tool = np.repeat([tools.index(stretch.tool) for stretch in rows.stretches], ends)
    return PlacedInput(rows, tool, tools, tuple(toolpaths), (*notices, *warnings))


def _of_runs(runs: Sequence[Run]) -> PlacedInput:
    tools = tuple(dict.fromkeys(run.tools[int(k)] for run in runs for k in run.state.tool.distinct()))
    parts = []
    for run in runs:
        own = np.array([tools.index(name) if name in tools else 0 for name in run.tools])
        parts.append(own[run.state.tool.column().astype(np.int64)[_rows_at_workpiece(run)]])
    return PlacedInput(joined_rows([rows_of_run(run) for run in runs]), np.concatenate(parts), tools)
