"""Simulation of NC programs: what they leave of the stock, what they hit, and the part that comes out."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, Literal

import numpy as np

from trunnion import readers, simulation
from trunnion.api.arguments import check_choice, check_observer, check_paths, check_whole, wrong_argument
from trunnion.api.observer import SILENT, Observer
from trunnion.api.reading import FilePath, MachineLike, ToolpathLike, as_machine, as_run, as_toolpaths
from trunnion.api.settings import check_tolerance, set_up_machine
from trunnion.api.verifying import rapid_feed_of
from trunnion.errors import InputError, Problem, Severity, argument_problem
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind
from trunnion.simulation.deviation import Excess
from trunnion.simulation.findings import Finding
from trunnion.simulation.meshes import TriangleMesh, load_mesh
from trunnion.simulation.simulator import Job, OperationCut, Setup, Simulation, row_runs, tip_lengths
from trunnion.simulation.stock_shapes import StockShape, default_cell, stock_shape
from trunnion.simulation.tool_choice import choose_tools, tools_of_toolpaths
from trunnion.simulation.tool_library import read_tools
from trunnion.simulation.tool_profile import ToolShape
from trunnion.simulation.tool_text import parse_tool
from trunnion.verification import restore_rapids
from trunnion.verification import verify as verify_run

#: Part of a cell within which motions are simulated by default.
_TOLERANCE: Final = 0.1

#: The number of the tool with which a program cuts that calls none.
_NO_CALL: Final = "0"

#: Air cuts that are told, the longest ones.
_MOST_AIR: Final = 20


@dataclass(frozen=True, slots=True)
class SimulationFinding:
    """One thing that is wrong.

    kind      ``rapid through stock``, ``gouge``, ``cuts with the spindle off``, ``shank into stock``,
              ``holder into stock`` or ``collision``
    between   names of two bodies
    file      program
    line      of its worst block in it, from 1
    block     N number of that block, -1 where it has none
    last_line, last_block  of the last block of the run of blocks that do it
    cl_line   line of the CL file that the block comes from; 0 where it is not known
    seconds   when, from the beginning of the program
    depth     how deep, mm
    place     where, workpiece frame, mm
    """

    kind: str
    between: tuple[str, str]
    file: str
    line: int
    block: int
    last_line: int
    last_block: int
    cl_line: int
    seconds: float
    depth: float
    place: tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class AirCut:
    """Blocks at feed that take nothing away: file, first and last line and N number, and the way of the tip in mm."""

    file: str
    line: int
    block: int
    last_line: int
    last_block: int
    length: float


@dataclass(frozen=True, slots=True)
class SimulatedOperation:
    """Consecutive blocks with one tool.

    removed   mm³ of the stock
    gouged    mm³ of the design
    seconds   at the programmed feeds
    air       mm at feed in which nothing was removed
    findings  their number
    """

    file: str
    tool: str
    line: int
    last_line: int
    removed: float
    gouged: float
    seconds: float
    air: float
    findings: int


@dataclass(frozen=True, slots=True, eq=False)
class SimulationResult:
    """What a simulation found.

    cell       width of the cells along X, Y and Z, mm
    accuracy   how far motions and tools are off at most, mm; across a ray another 0.41 cells
    limit      what is no deeper than this is not told, mm
    removed    mm³ of the stock
    left       what the stock has beyond the part; None without a part
    gouge      what of the part is missing; None without a part
    remarks    what was not simulated, or was taken for granted
    seconds    of computing
    """

    programs: tuple[str, ...]
    machine: str
    cell: tuple[float, float, float]
    accuracy: float
    limit: float
    removed: float
    operations: tuple[SimulatedOperation, ...]
    findings: tuple[SimulationFinding, ...]
    air: tuple[AirCut, ...]
    left: Excess | None
    gouge: Excess | None
    remarks: tuple[Problem, ...]
    seconds: float
    simulation: Simulation

    @property
    def passed(self) -> bool:
        """Whether nothing was found that must not be: no finding, no gouge, no program that breaks off."""
        broken = any(remark.severity is Severity.ERROR for remark in self.remarks)
        gouged = self.gouge is not None and self.gouge.largest > self.limit
        return not self.findings and not gouged and not broken


def simulate(
    nc: FilePath | Run | Iterable[FilePath | Run],
    *,
    machine: MachineLike,
    stock: str | Path | TriangleMesh,
    part: str | Path | TriangleMesh | None = None,
    tools: Iterable[str | ToolShape] = (),
    libraries: Sequence[FilePath] = (),
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
    tools
        Tools as text, such as ``"3=ball:10,length=60,flutes=20"``, or as bodies; they come first.
    libraries
        Tool libraries, for tools that ``tools`` does not have.
    cl
        CL files, for tools that neither has.
    subprograms
        Files of the subprograms that the programs call. No others are opened.
    cell
        Width of the cells, mm; by default the 200th part of the stock's longest side.
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
    shape = stock_shape(stock)
    design = None if part is None else _design(part)
    wide = cell or default_cell(shape)
    setup = Setup(shape, design, wide, accuracy or _TOLERANCE * wide)
    simulation.check_cell(shape, wide)
    programs = [nc] if isinstance(nc, Run | str) or hasattr(nc, "__fspath__") else list(nc)
    if not programs:
        raise wrong_argument("nc", nc, "give an NC program")
    others, rapid_feed = check_paths("subprograms", subprograms), rapid_feed_of(loaded)
    runs = [restore_rapids(as_run(program, loaded, others), rapid_feed) for program in programs]  # type: ignore[arg-type]
    toolpaths = as_toolpaths(cl, None, False, observer)
    shapes = _tools(runs, tools, libraries, toolpaths)
    remarks = [*_remarks(runs, shapes), *_outside(setup)]
    jobs = [_job(run, shapes, until if run is runs[-1] else None) for run in runs]
    remarks += [Problem(job.run.files[0], 0, job.broken_off) for job in jobs if job.broken_off]
    observer.problems(remarks)
    total = sum(job.end for job in jobs)
    done = 0
    with observer.progress("cutting", total, "blocks") as tell:

        def progress(rows: int, _: int) -> None:
            nonlocal done
            if rows > done:
                tell(rows - done)
                done = rows

        found = simulation.simulate(setup, jobs, stop_at_first=stop_at == "first", threads=threads, progress=progress)
    if found.leaks:
        what = f"{found.leaks} of {found.stock.lattice.ray_count} rays pass a hole in it, and were left empty"
        remarks.append(Problem("part", 0, what, "close the mesh", Severity.WARNING))
        observer.problems(remarks[-1:])
    return _result(loaded.key, found, jobs, tuple(remarks), toolpaths)


def _design(part: str | Path | TriangleMesh) -> StockShape:
    mesh = part if isinstance(part, TriangleMesh) else load_mesh(part, name="part", closed=True)
    return StockShape(mesh.bounds[0], mesh.bounds[1], mesh=mesh)


def _tools(
    runs: Sequence[Run], tools: Iterable[str | ToolShape], libraries: Sequence[FilePath], toolpaths: Any
) -> dict[str, ToolShape]:
    """The bodies of the tools with which the programs move at feed or at rapid."""
    read = [read_tools(path) for path in check_paths("libraries", libraries)]
    diameters = {number: wide for library in reversed(read) for number, wide in library.diameters.items()}
    stated = [tool if isinstance(tool, ToolShape) else parse_tool(tool, diameters) for tool in tools]
    called = [run.tools[int(index)] for run in runs for index in run.state.tool.distinct()]
    if any(_cuts_without_call(run) for run in runs):
        called.append(_NO_CALL)
        if not any(tool.number == int(_NO_CALL) for tool in stated):
            what, cure = "the program cuts before it calls a tool", "state the one that is in the spindle: 0=ball:10"
            raise InputError(argument_problem("tools", what, cure))
    found = choose_tools(called, stated, read, tools_of_toolpaths(toolpaths))
    return found | ({"": found[_NO_CALL]} if _NO_CALL in found else {})


def _cuts_without_call(run: Run) -> bool:
    """Whether a program moves at feed before it calls a tool: the operator has put one in."""
    rows = np.concatenate([run.state.tool.rows_with(index) for index, name in enumerate(run.tools) if not name])
    return bool((run.kind[rows] != Kind.RAPID).any())


def _remarks(runs: Sequence[Run], shapes: dict[str, ToolShape]) -> list[Problem]:
    """What was taken for granted, and what is not simulated."""
    found = [
        Problem(f"tool {name}", 0, remark, severity=Severity.WARNING)
        for name, shape in shapes.items()
        for remark in shape.remarks
    ]
    for run in runs:
        compensated = run.state.compensation.rows_with(1), run.state.compensation.rows_with(-1)
        rows = np.concatenate(compensated)
        if len(rows):
            row = int(rows.min())
            what = "radius compensation is on: the programmed path is taken for that of the tool's centre"
            cure = "compensation for wear is simulated as it should be; a programmed contour is not"
            found.append(Problem(_file(run, row), int(run.line[row]), what, cure, Severity.WARNING))
        if run.machine.workpiece_zero is None and bool(run.state.machine_frame.values.any()):
            what = "machine positions are taken as retracts along the tool axis: the workpiece zero is not known"
            cure = "give zero and tool_length"
            found.append(Problem(run.files[0], 0, what, cure, Severity.WARNING))
    return found


def _outside(setup: Setup) -> list[Problem]:
    if setup.part is None:
        return []
    beyond = max(float((setup.stock.low - setup.part.low).max()), float((setup.part.high - setup.stock.high).max()))
    if beyond <= setup.tolerance:
        return []
    what = f"reaches {beyond:.3f} mm beyond the stock: what is outside is not compared"
    cure = "check the zero of part and stock"
    return [Problem("part", 0, what, cure, Severity.WARNING)]


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
    rows = np.flatnonzero((run.block_number >= number) & (run.file == 0)) if number >= 0 else np.zeros(0, np.int64)
    if not len(rows):
        cure = "give the N number of a block of the last program"
        raise InputError(argument_problem("until", f"{run.files[0]} has no block {until}", cure))
    return int(rows[0])


def _file(run: Run, row: int) -> str:
    return run.files[int(run.state.file[row])]


def _result(
    machine: str, found: Simulation, jobs: Sequence[Job], remarks: tuple[Problem, ...], toolpaths: Any
) -> SimulationResult:
    verified = [verify_run(job.run, toolpaths if len(jobs) == 1 else ()) for job in jobs]
    seconds = [np.cumsum(each.seconds) for each in verified]
    lengths = [tip_lengths(job.run) for job in jobs]
    findings, operations, air = list[SimulationFinding](), list[SimulatedOperation](), list[AirCut]()
    for one in found.operations:
        run, at = jobs[one.job].run, seconds[one.job]
        cl_line = verified[one.job].cl_line
        findings += (_finding(run, finding, at, cl_line) for finding in one.findings)
        idle = list(_air(run, one, lengths[one.job]))
        air += idle
        seconds_taken = float(at[one.end - 1]) - (float(at[one.first - 1]) if one.first else 0.0)
        lines = int(run.line[one.first]), int(run.line[one.end - 1])
        air_length = sum(each.length for each in idle)
        operations.append(_operation(run, one, seconds_taken, lines, air_length))
    x, y, z = found.stock.lattice.cell.tolist()
    setup = found.setup
    return SimulationResult(
        tuple(job.run.files[0] for job in jobs), machine, (x, y, z), setup.tolerance + found.error, setup.limit,
        found.start_volume - found.stock.volume, tuple(operations), tuple(findings),
        tuple(sorted(air, key=lambda each: -each.length)[:_MOST_AIR]), found.left, found.gouge, remarks,
        found.seconds, found,
    )  # fmt: skip


def _operation(run: Run, one: OperationCut, seconds: float, lines: tuple[int, int], air: float) -> SimulatedOperation:
    tool = one.tool or _NO_CALL
    count = len(one.findings)
    return SimulatedOperation(run.files[0], tool, *lines, one.removed, one.gouged, seconds, air, count)


def _finding(run: Run, finding: Finding, seconds: Any, cl_line: Any) -> SimulationFinding:
    row, last = finding.worst, finding.rows[1]
    x, y, z = finding.place
    return SimulationFinding(
        str(finding.what), finding.between, _file(run, row), int(run.line[row]), int(run.block_number[row]),
        int(run.line[last]), int(run.block_number[last]), int(cl_line[row]) if len(cl_line) else 0,
        float(seconds[row]), finding.depth, (x, y, z),
    )  # fmt: skip


def _air(run: Run, one: OperationCut, lengths: Any) -> Iterable[AirCut]:
    rows = np.concatenate(one.air) if one.air else np.zeros(0, np.int64)
    rows = rows[run.kind[rows] != Kind.RAPID]
    for first, last in row_runs(rows):
        length = float(lengths[first : last + 1].sum())
        if length > 0.0:
            numbers = int(run.block_number[first]), int(run.block_number[last])
            yield AirCut(_file(run, first), int(run.line[first]), numbers[0], int(run.line[last]), numbers[1], length)
