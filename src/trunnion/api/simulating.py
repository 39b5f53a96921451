"""Simulation of NC programs: what they leave of the stock, what they hit, and the part that comes out."""

import math
import os
from collections.abc import Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, Final, Literal

import numpy as np

from trunnion import readers, simulation
from trunnion.api.arguments import check_choice, check_observer, check_path, check_paths, check_whole, wrong_argument
from trunnion.api.observer import SILENT, Observer
from trunnion.api.reading import FilePath, MachineLike, ToolpathLike, as_machine, as_run, as_toolpaths
from trunnion.api.settings import check_tolerance, set_up_machine
from trunnion.api.simulation_remarks import simulation_remarks
from trunnion.api.simulation_result import NO_CALL, SimulationResult, make_result
from trunnion.api.verifying import rapid_feed_of
from trunnion.errors import InputError, Problem, Severity, argument_problem
from trunnion.machines import Machine
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind
from trunnion.simulation.collisions import Collision, check_collisions, fixture_body, machine_bodies, part_body
from trunnion.simulation.meshes import TriangleMesh, load_mesh
from trunnion.simulation.simulator import Job, Setup, Simulation
from trunnion.simulation.stock.solids import StockShape, check_narrow_tools, default_cell, stock_shape
from trunnion.simulation.tools.choice import choose_tools, tools_of_toolpaths
from trunnion.simulation.tools.library import ToolLibrary, read_tools
from trunnion.simulation.tools.profile import Role, ToolShape
from trunnion.simulation.tools.text import parse_tool
from trunnion.verification import restore_rapids
from trunnion.wording import counted

#: Fewer errors do not say that a file is no program of the machine.
_FEW_ERRORS: Final = 5

#: Part of a cell within which motions are simulated by default.
_TOLERANCE: Final = 0.1


def simulate(
    nc: FilePath | Run | Iterable[FilePath | Run],
    *,
    machine: MachineLike,
    stock: str | Path | TriangleMesh,
    part: str | Path | TriangleMesh | None = None,
    fixtures: Iterable[str | Path | TriangleMesh] = (),
    near: float | None = None,
    tools: Iterable[str | ToolShape] = (),
    libraries: Sequence[FilePath] = (),
    unit: Literal["mm", "inch"] | None = None,
    cl: ToolpathLike | Iterable[ToolpathLike] = (),
    subprograms: Sequence[FilePath] = (),
    cell: float | None = None,
    accuracy: float | None = None,
    stop_at: Literal["none", "first"] = "none",
    until: str | int | None = None,
    zero: str | Iterable[float] | None = None,
    tool_length: str | float | None = None,
    threads: int | None = None,
    observer: Observer = SILENT,
) -> SimulationResult:
    """Cut stock with NC programs as the control runs them, and find what they must not do.

    Parameters
    ----------
    nc
        A program or several, in the order in which they cut the same stock: paths, or their runs.
    machine
        The machine that runs them: a name, a path or a ``Machine``.
    stock
        ``"box:X,Y,Z[,x0,y0,z0]"`` with its sizes and its lowest corner (0,0,0 by default), ``"cylinder:D,H[,z0]"``
        standing on Z = z0 (0 by default) about X0 Y0, mm in the workpiece frame, or a closed mesh.
    part
        The design, a closed mesh in the workpiece frame.
    fixtures
        Meshes in the workpiece frame, which nothing may touch. They, the part and the bodies of the machine are checked
        against each other and against the tool; the machine's only where ``zero`` and the tools' lengths are known.
    near
        Distance in mm from which on bodies are told that do not touch; by default only those that do.
    tools
        Tools as text, such as ``"3=ball:10,length=60,flutes=20"``, or as bodies; they come first.
    libraries
        Tool libraries, for tools that ``tools`` does not have.
    unit
        Length unit of LinuxCNC's tool tables, which state none.
    cl
        CL files, for tools that neither has.
    subprograms
        Files of the subprograms that the programs call. No others are opened.
    cell
        Width of the cells, mm; by default the 200th part of the stock's longest side, and at most half of the narrowest
        tool.
    accuracy
        How far motions may be off, mm; by default a tenth of a cell.
    stop_at
        ``"first"``: end after the block of the first finding.
    until
        N number of the block before which the last program ends.
    zero, tool_length
        As for ``verify``: without both, machine positions (G53, M91) are taken as retracts along the tool axis.
    threads
        How many; by default as many as there are processors. The result is the same.
    observer
        Receives progress and warnings.

    Returns
    -------
    SimulationResult
        ``passed``; ``findings``, ``left`` and ``gouge``, ``operations``, and the stock in ``simulation``.

    Raises
    ------
    InputError
        When a file or an argument cannot be used, or nothing says the form of a tool.

    Examples
    --------
    >>> import trunnion
    >>> found = trunnion.simulate(
    ...     "tests/golden/yl569/2_hub_rough.expected.mpf", machine="yl569",
    ...     stock="box:80,40,40,-10,-20,-40", tools=["2=ball:8,length=80,flutes=40"], cell=1.0,
    ... )
    >>> [(operation.tool, round(operation.removed / 1000.0)) for operation in found.operations]
    [('2', 2)]
    """
    check_observer(observer)
    check_choice("stop_at", stop_at, ("none", "first"))
    check_tolerance("cell", cell, optional=True)
    check_tolerance("accuracy", accuracy, optional=True)
    threads = None if threads is None else check_whole("threads", threads, 1)
    loaded = as_machine(machine)
    readers.reader_of(loaded)
    loaded = set_up_machine(loaded, zero, tool_length)
    remarks: list[Problem] = []
    shape = stock_shape(stock, remarks.append)
    check_tolerance("near", near, optional=True)
    mesh = None if part is None else _mesh(part, "part", remarks)
    design = None if mesh is None else StockShape(mesh.bounds[0], mesh.bounds[1], mesh=mesh)
    given = _listed("fixtures", fixtures, TriangleMesh)
    around = [_mesh(fixture, f"fixture {k}", remarks) for k, fixture in enumerate(given, 1)]
    programs: list[FilePath | Run] = _listed("nc", nc, Run)
    if not programs:
        raise wrong_argument("nc", nc, "give an NC program")
    others, rapid_feed = check_paths("subprograms", subprograms), rapid_feed_of(loaded)
    runs = [restore_rapids(as_run(program, loaded, others), rapid_feed) for program in programs]
    _check_programs(runs, loaded)
    toolpaths = as_toolpaths(cl, None, False, observer)
    shapes = _tools(runs, tools, _libraries(libraries, unit), toolpaths)
    widths = {name: _cutting_width(tool) for name, tool in shapes.items()}
    wide = cell or default_cell(shape, min(widths.values(), default=math.inf))
    check_narrow_tools(widths, wide)
    setup = Setup(shape, design, wide, accuracy or _TOLERANCE * wide)
    simulation.check_cell(shape, wide)
    remarks += simulation_remarks(setup, runs, shapes)
    jobs = [_job(run, shapes, until if run is runs[-1] else None) for run in runs]
    remarks += [Problem(job.run.files[0], 0, job.broken_off) for job in jobs if job.broken_off]
    observer.problems(remarks)
    told = len(remarks)
    touched = [_collisions(job, number, mesh, around, near or 0.0, remarks) for number, job in enumerate(jobs)]
    if stop_at == "first":
        jobs = _up_to_first_hit(jobs, touched)
    found = _cut(setup, jobs, stop_at == "first", threads, observer)
    if found.leaks:
        what = f"{found.leaks} of {found.stock.lattice.ray_count} rays pass a hole in it, and were left empty"
        remarks.append(Problem("part", 0, what, "close the mesh", Severity.WARNING))
    if found.start_volume - found.stock.volume <= 0.0:
        what, cure = "takes nothing from the stock", "check the place of the stock, and the tools"
        remarks.append(Problem(runs[0].files[0], 0, what, cure, Severity.WARNING))
    observer.problems(remarks[told:])
    return make_result(loaded.key, found, jobs, _until_stop(jobs, touched, found), tuple(remarks), toolpaths)


def _cut(setup: Setup, jobs: Sequence[Job], to_first: bool, threads: int | None, observer: Observer) -> Simulation:
    """Cut the stock, with progress."""
    done = 0
    with observer.progress("cutting", sum(job.end for job in jobs), "blocks") as tell:

        def progress(rows: int, _: int) -> None:
            nonlocal done
            if rows > done:
                tell(rows - done)
                done = rows

        return simulation.simulate(setup, jobs, stop_at_first=to_first, threads=threads, progress=progress)


def _up_to_first_hit(jobs: Sequence[Job], touched: Sequence[Sequence[Collision]]) -> list[Job]:
    """The jobs as far as the row in which bodies first touch."""
    kept = []
    for job, collisions in zip(jobs, touched, strict=True):
        first = min((each.row for each in collisions if not each.is_near), default=None)
        kept.append(job if first is None else replace(job, end=first + 1))
        if first is not None:
            break
    return kept


def _until_stop(
    jobs: Sequence[Job], touched: Sequence[Sequence[Collision]], found: Simulation
) -> list[list[Collision]]:
    """The collisions of jobs in the rows that were simulated."""
    last, row = found.stopped or (len(jobs), -1)
    ends = [job.end if number < last else (row + 1 if number == last else 0) for number, job in enumerate(jobs)]
    return [[each for each in own if each.row < end] for own, end in zip(touched, ends, strict=False)]


def _mesh(mesh: str | Path | TriangleMesh, name: str, remarks: list[Problem]) -> TriangleMesh:
    if isinstance(mesh, TriangleMesh):
        return mesh.named(name)
    check_path(name, mesh)
    return load_mesh(mesh, name=name, closed=True, warn=remarks.append)


def _listed(name: str, values: Any, record: type) -> list[Any]:
    """One or several texts, paths or records; errors name the argument."""
    single = (str, os.PathLike, record)
    if isinstance(values, single):
        return [values]
    listed = list(values) if isinstance(values, Iterable) else [None]
    if not all(isinstance(value, single) for value in listed):
        raise wrong_argument(name, values, f"give a text, a path, a {record.__name__}, or a list of them")
    return listed


def _collisions(
    job: Job,
    number: int,
    part: TriangleMesh | None,
    fixtures: Sequence[TriangleMesh],
    near: float,
    remarks: list[Problem],
) -> list[Collision]:
    """What touches, or comes near, while a program runs as far as it is simulated."""
    machine = job.run.machine
    bodies = [fixture_body(mesh, machine) for mesh in fixtures]
    if fixtures and part is not None:
        bodies.append(part_body(part, machine))
    if machine.workpiece_zero is not None and _lengths_known(job):
        bodies += machine_bodies(machine, remarks.append)
    elif number == 0 and machine.bodies:
        what = "the bodies of the machine are not checked: workpiece zero and tool lengths are not known"
        cure = "give zero, and tool_length or a tool with its holder"
        remarks.append(Problem(job.run.files[0], 0, what, cure, Severity.WARNING))
    if not bodies:
        return []
    found = check_collisions(job.run, bodies, job.tools, near=near)
    return [each for each in found if each.row < job.end]


def _lengths_known(job: Job) -> bool:
    """Whether the length of every tool that the program calls is known, from its tip to the gauge point."""
    used = [job.run.tools[int(index)] for index in job.run.state.tool.distinct()]
    known = job.run.machine.tool_length is not None
    return all(known or job.tools[name].length for name in used if name in job.tools)


def _libraries(libraries: Sequence[FilePath], unit: str | None) -> list[ToolLibrary]:
    if unit is not None:
        check_choice("unit", unit, ("mm", "inch"))
    return [read_tools(path, unit or "") for path in check_paths("libraries", libraries)]


def _tools(
    runs: Sequence[Run], tools: Iterable[str | ToolShape], read: Sequence[ToolLibrary], toolpaths: Any
) -> dict[str, ToolShape]:
    """The bodies of the tools with which the programs move at feed or at rapid."""
    diameters = {number: wide for library in reversed(read) for number, wide in library.diameters.items()}
    given = _listed("tools", tools, ToolShape)
    stated = [tool if isinstance(tool, ToolShape) else parse_tool(tool, diameters) for tool in given]
    called = [run.tools[int(index)] for run in runs for index in run.state.tool.distinct()]
    in_spindle = any(tool.number == int(NO_CALL) for tool in stated)
    if in_spindle or any(_cuts_without_call(run) for run in runs):
        called.append(NO_CALL)
        if not in_spindle:
            what, cure = "the program cuts before it calls a tool", "state the one that is in the spindle: 0=ball:10"
            raise InputError(argument_problem("tools", what, cure))
    found = choose_tools(called, stated, read, tools_of_toolpaths(toolpaths))
    return found | ({"": found[NO_CALL]} if NO_CALL in found else {})


def _cuts_without_call(run: Run) -> bool:
    """Whether a program moves at feed before it calls a tool: the operator has put one in."""
    rows = np.concatenate([run.state.tool.rows_with(index) for index, name in enumerate(run.tools) if not name])
    return bool((run.kind[rows] != Kind.RAPID).any())


def _cutting_width(tool: ToolShape) -> float:
    """The greatest diameter of what cuts of a tool, mm."""
    points = [
        point for section in tool.sections if section.role is Role.CUTTER
        for element in section.outline for point in (element.start, element.end)
    ]  # fmt: skip
    return 2.0 * max((radius for radius, _ in points), default=math.inf)


def _check_programs(runs: Sequence[Run], machine: Machine) -> None:
    """Refuse what is no program of the machine: more lines of it are not understood than it has motions."""
    for run in runs:
        wrong = sorted({(each.file, each.line): each for each in run.errors}.items())
        if len(wrong) > max(_FEW_ERRORS, len(run)):
            (file, line), first = wrong[0]
            what = f"{first.text}; {counted(len(wrong), 'line')} of it not understood"
            raise InputError(Problem(file, line, what, f"is this a program of {machine.key}?"))


def _job(run: Run, shapes: dict[str, ToolShape], until: str | int | None) -> Job:
    end, why = len(run), ""
    errors = sorted(run.errors, key=lambda each: each.line)
    if errors:
        first = errors[0]
        number = run.files.index(first.file) if first.file in run.files else 0
        later = np.flatnonzero((run.file == number) & (run.line >= first.line))
        end = int(later[0]) if len(later) else len(run)
        why = f"line {first.line}: {first.text}; it is cut up to there"
    if until is not None:
        row = _row_of_block(run, until)
        if row < end:
            end, why = row, ""
    return Job(run, shapes, end, why)


def _row_of_block(run: Run, until: str | int) -> int:
    text = str(until).strip().upper().removeprefix("N")
    number = int(text) if text.isascii() and text.isdecimal() and len(text) < 10 else -1
    own = np.flatnonzero((run.block_number >= number) & (run.file == 0)) if number >= 0 else np.zeros(0, np.int64)
    # A block without motion is followed by the next number, not by what runs next: subprograms may stand behind it.
    rows = own[run.block_number[own] == run.block_number[own].min()] if len(own) else own
    if not len(rows):
        cure = "give the N number of a block of the last program"
        raise InputError(argument_problem("until", f"{run.files[0]} has no block {until}", cure))
    return int(rows[0])
