"""Set-ups that are simulated one after another: the stock that one leaves is that of the next."""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Final, TypeAlias

import numpy as np

from trunnion import readers, simulation
from trunnion.errors import InputError, Problem, Severity, argument_problem
from trunnion.jit import compile_ahead
from trunnion.jobs.inputs.arguments import check_choice, check_whole
from trunnion.jobs.inputs.settings import check_tolerance
from trunnion.jobs.observer import Observer
from trunnion.jobs.simulate.remarks import of_setup, part_remarks, simulation_remarks
from trunnion.jobs.simulate.result import SimulationResult, join_results, make_result
from trunnion.jobs.simulate.setups import (
    PreparedSetup,
    SimulationInput,
    cutting_width,
    prepare_setup,
    told_with_places,
)
from trunnion.machines.forward import tool_axis_rows
from trunnion.model.run import Run
from trunnion.simulation.collisions import Body, Collision, check_collisions, fixture_body, machine_bodies, part_body
from trunnion.simulation.cutting.shares import JoinedShares, Share
from trunnion.simulation.meshes import DEVIATION, TriangleMesh
from trunnion.simulation.simulator import Job, Setup, Simulation, cut_share
from trunnion.simulation.stock.solids import StockShape, check_narrow_tools, default_cell, stock_shape
from trunnion.simulation.stock.turning import Pose, turned_stock
from trunnion.simulation.tool_deltas import as_the_tool_goes
from trunnion.simulation.tools.profile import ToolShape
from trunnion.simulation.turned_parts import as_clamped, places_of_drawing, run_of_drawn_part
from trunnion.verification.kinematics.axis_motion_kernel import axis_motion_rows

#: Part of a cell within which motions are simulated by default.
_TOLERANCE: Final = 0.1

#: The greatest part of a cell by which motions may be off.
_COARSEST: Final = 0.5

#: Part of the tolerance of motions within which exact surfaces of CAD files become facets.
_FACETS: Final = 0.25


def simulate_setups(given: SimulationInput, observer: Observer, shares: JoinedShares | None = None) -> SimulationResult:
    """Read everything, then cut the stock in one set-up after another; ``shares`` are those of ``cut_setup_share``.

    Raises
    ------
    InputError
        When a file or an argument cannot be used, or nothing says the form of a tool.
    DamagedShareError
        If the shares cannot be used.
    """
    with told_with_places(given.places):
        if shares is not None:
            _check_sharing(given)
        steps, shape, setups, remarks = _prepared(given, observer, shares)
        results: list[SimulationResult] = []
        for own, told in zip(setups, remarks, strict=True):
            result = steps.follow(own, shape, told)
            results.append(result)
            if given.stop_at == "first" and result.findings:
                break
        return join_results(results)


def cut_setup_share(given: SimulationInput, share: Share, observer: Observer) -> bytes:
    """Read everything, and cut some tiles of the stock: the bytes that ``shares.JoinedShares`` takes.

    Raises
    ------
    InputError
        As ``simulate_setups``; and if there are several set-ups, or it is to end at the first finding.
    """
    with told_with_places(given.places):
        _check_sharing(given)
        steps, shape, (own,), (told,) = _prepared(given, observer)
        return steps.share(own, shape, share, told)


def _check_sharing(given: SimulationInput) -> None:
    """Refuse to divide what is not known from single tiles."""
    if len(given.setups) > 1:
        what = f"divides the stock of one set-up, and here are {len(given.setups)}, each with what the last one leaves"
        raise InputError(argument_problem("tiles", what, "leave it out", code="SIM116"))
    if given.stop_at == "first":
        what = "has no meaning where the simulation ends at the first finding, which no single tile knows"
        raise InputError(argument_problem("tiles", what, "leave out one of them", code="SIM116"))


_Prepared: TypeAlias = tuple["_Steps", StockShape, Sequence[PreparedSetup], Sequence[list[Problem]]]


def _prepared(given: SimulationInput, observer: Observer, shares: JoinedShares | None = None) -> _Prepared:
    """What cuts, the stock, the set-ups as they were read, and what is remarked of each."""
    design = simulation.DESIGN_KERNELS if any(each.part is not None for each in given.setups) else ()
    # The second process begins with the largest, the last one; what is saved at the end is left to it.
    called = (*readers.KERNELS, tool_axis_rows, axis_motion_rows, *design, *simulation.KERNELS)
    compile_ahead((*simulation.SURFACE_KERNELS, *called))
    check_choice("stop_at", given.stop_at or "none", ("none", "first"))
    for name, value in (("cell", given.cell), ("accuracy", given.accuracy), ("near", given.near)):
        check_tolerance(name, value, optional=True)
    threads = None if given.threads is None else check_whole("threads", given.threads, 1)
    remarks: list[list[Problem]] = [[] for _ in given.setups]
    deviation = _deviation(given)
    shape = stock_shape(given.stock, remarks[0].append, deviation)
    setups, problems = [], list[Problem]()
    for each, told in zip(given.setups, remarks, strict=True):
        try:
            with told_with_places(each.places, each.name):
                setups.append(prepare_setup(each, told, observer, deviation))
        except InputError as error:
            problems += error.problems
    if problems:
        raise InputError(dict.fromkeys(problems))
    widths = {name: cutting_width(tool) for each in setups for name, tool in each.tools.items()}
    cell = given.cell or default_cell(shape, min(widths.values(), default=math.inf))
    check_narrow_tools(widths, cell)
    if given.accuracy is not None and given.accuracy > _COARSEST * cell:
        what = f"{given.accuracy:g} mm is more than half of a cell of {cell:g} mm: gouges of a cell would not be told"
        raise InputError(
            argument_problem("accuracy", what, f"give {_COARSEST * cell:g} mm at most, or a wider cell", code="SIM121")
        )
    simulation.check_cell(shape, cell)
    steps = _Steps(cell, given.accuracy or _TOLERANCE * cell, given, threads, observer, shares)
    return steps, shape, setups, remarks


def _deviation(given: SimulationInput) -> float:
    """How far facets of exact surfaces may be off them, mm: a part of the accuracy that is asked for."""
    if given.accuracy is not None:
        return _FACETS * given.accuracy
    return DEVIATION if given.cell is None else _FACETS * _TOLERANCE * given.cell


class _Steps:
    """Cuts stock in set-ups, each time what the last one has left."""

    def __init__(
        self,
        cell: float,
        tolerance: float,
        given: SimulationInput,
        threads: int | None,
        observer: Observer,
        shares: JoinedShares | None,
    ) -> None:
        self._cell, self._tolerance, self._given = cell, tolerance, given
        self._threads, self._observer, self._shares = threads, observer, shares
        self._part: TriangleMesh | None = None
        #: How far turns may have moved the surface of the stock, mm.
        self._slack = 0.0
        self._left: Simulation | None = None
        #: What is odd about machines, which is told once, whatever runs on them.
        self._of_machines: list[Problem] = []

    def follow(self, own: PreparedSetup, shape: StockShape, remarks: list[Problem]) -> SimulationResult:
        """Cut the stock in a set-up; ``shape`` is the first one's."""
        pose = own.given.pose or Pose()
        if self._left is not None:
            shape = StockShape.of_kept(*turned_stock(self._left.stock, pose, self._cell))
            self._part = None if self._part is None else self._part.moved(pose.matrix)
            if not pose.keeps_rays:
                self._slack += self._cell
                what = f"is turned through its surface: it may be {0.5 * self._cell:.4g} mm off, and what is thinner"
                what += f" than a cell of {self._cell:g} mm may be lost"
                remarks.append(
                    Problem("stock", 0, what, "turn it by quarters to lose nothing", Severity.WARNING, code="SIM134")
                )
        self._part = own.part or self._part
        result = self._simulated(own, self._setup(shape, self._part), self._part, remarks)
        self._left = result.simulation
        return result

    def share(self, own: PreparedSetup, shape: StockShape, share: Share, remarks: list[Problem]) -> bytes:
        """Cut some tiles of the stock in the only set-up."""
        self._observer.problems(remarks)
        jobs, setup = _jobs(own), self._setup(shape, own.part)
        with self._observer.progress("cutting", sum(job.end for job in jobs), "blocks") as tell:
            return cut_share(setup, jobs, share, threads=self._threads, progress=_told_once(tell))

    def _setup(self, shape: StockShape, part: TriangleMesh | None) -> Setup:
        design = None if part is None else StockShape(part.bounds[0], part.bounds[1], mesh=part)
        return Setup(shape, design, self._cell, self._tolerance, self._given.near or 0.0)

    def _simulated(
        self, own: PreparedSetup, setup: Setup, part: TriangleMesh | None, remarks: list[Problem]
    ) -> SimulationResult:
        given, name, turn = self._given, own.given.name, own.turn
        clamped, jobs = _clamped(own), _jobs(own)
        runs = [job.run for job in jobs]
        remarks += simulation_remarks(setup, runs, own.tools)
        remarks += [problem for run in own.runs for problem in as_the_tool_goes(run)[1]]
        remarks += [Problem(job.run.files[0], 0, job.broken_off, code="SIM142") for job in jobs if job.broken_off]
        self._observer.problems(of_setup(remarks, name))
        told = len(remarks)
        near, solid, around = given.near or 0.0, part, own.fixtures
        if turn is not None:
            solid = None if part is None else as_clamped(part, turn)
            around = tuple(as_clamped(mesh, turn) for mesh in around)
        machines = list[Problem]()
        bodies = [
            _bodies(replace(job, run=run), number, solid, around, remarks, machines)
            for number, (job, run) in enumerate(zip(jobs, clamped, strict=True))
        ]
        machines = [each for each in dict.fromkeys(machines) if each not in self._of_machines]
        self._of_machines += machines
        self._observer.problems(machines)
        pairs: list[int] = []

        def touching(jobs: Sequence[Job], tell: Callable[[int], None] | None = None) -> list[list[Collision]]:
            """What touches on the machine, where the part is as it is clamped; places are those of the drawing."""
            found = [
                _collisions(replace(job, run=run), each, near, tell)
                for job, run, each in zip(jobs, clamped, bodies, strict=False)
            ]
            return found if turn is None else [places_of_drawing(each, turn) for each in found]

        touched = touching(jobs, pairs.append)
        if given.stop_at == "first":
            jobs = _up_to_first_hit(jobs, touched)
        found = _cut(setup, jobs, given.stop_at == "first", self._threads, self._shares, self._observer)
        remarks += part_remarks(setup, found.lacking, self._slack, is_later=self._left is not None)
        if found.leaks:
            what = f"{found.leaks} of {found.stock.lattice.ray_count} rays pass a hole in it, and were left empty"
            remarks.append(Problem("part", 0, what, "close the mesh", Severity.WARNING, code="SIM214"))
        if found.start_volume - found.stock.volume <= 0.0:
            what, cure = "takes nothing from the stock", "check the place of the stock, and the tools"
            remarks.append(Problem(runs[0].files[0], 0, what, cure, Severity.WARNING, code="SIM133"))
        self._observer.problems(of_setup(remarks[told:], name))
        if given.stop_at == "first":
            jobs = _until_stop(jobs, found)
            touched = touching(jobs)
        return make_result(
            own.machine.key, found, jobs, touched, (*of_setup(remarks, name), *machines), own.toolpaths, runs=own.runs,
            setup=name, pairs=sum(pairs), angles=own.angles,
        )  # fmt: skip


def _cut(
    setup: Setup,
    jobs: Sequence[Job],
    to_first: bool,
    threads: int | None,
    shares: JoinedShares | None,
    observer: Observer,
) -> Simulation:
    """Cut the stock, with progress."""
    with observer.progress("cutting", sum(job.end for job in jobs), "blocks") as tell:
        return simulation.simulate(
            setup, jobs, stop_at_first=to_first, threads=threads, shares=shares, progress=_told_once(tell)
        )


def _told_once(tell: Callable[[int], None]) -> Callable[[int, int], None]:
    """What tells of rows that are done, each of them once."""
    done = 0

    def progress(rows: int, _: int) -> None:
        nonlocal done
        if rows > done:
            tell(rows - done)
            done = rows

    return progress


def _up_to_first_hit(jobs: Sequence[Job], touched: Sequence[Sequence[Collision]]) -> list[Job]:
    """The jobs as far as the row in which bodies first touch."""
    kept = []
    for job, collisions in zip(jobs, touched, strict=True):
        first = min((each.row for each in collisions if not each.is_near), default=None)
        kept.append(job if first is None else replace(job, end=first + 1))
        if first is not None:
            break
    return kept


def _until_stop(jobs: Sequence[Job], found: Simulation) -> list[Job]:
    """The jobs as far as they were simulated."""
    if found.stopped is None:
        return list(jobs)
    last, row = found.stopped
    return [*jobs[:last], replace(jobs[last], end=row + 1)]


def _bodies(
    job: Job,
    number: int,
    part: TriangleMesh | None,
    fixtures: Sequence[TriangleMesh],
    remarks: list[Problem],
    of_machine: list[Problem],
) -> list[Body]:
    """What a tool can hit while a program runs, and what the machine may hit with it."""
    machine = job.run.machine
    bodies = [fixture_body(mesh, machine) for mesh in fixtures]
    if fixtures and part is not None:
        bodies.append(part_body(part, machine))
    if machine.workpiece_zero is not None and _lengths_known(job):
        bodies += machine_bodies(machine, of_machine.append)
    elif number == 0 and machine.bodies:
        what = "the bodies of the machine are not checked: workpiece zero and tool lengths are not known"
        cure = "give the workpiece zero, and the tool length or a tool with its holder"
        remarks.append(Problem(job.run.files[0], 0, what, cure, Severity.WARNING, code="SIM310"))
    return bodies


def _collisions(
    job: Job, bodies: Sequence[Body], near: float, pairs_told: Callable[[int], None] | None = None
) -> list[Collision]:
    """What touches, or comes near, while a program runs as far as it is simulated."""
    if not bodies:
        return []
    return check_collisions(job.run, bodies, job.tools, near=near, end=job.end, pairs_told=pairs_told)


def _lengths_known(job: Job) -> bool:
    """Whether the length of every tool that the program calls is known, from its tip to the gauge point."""
    used = [job.run.tools[int(index)] for index in job.run.state.tool.distinct()]
    known = job.run.machine.tool_length is not None
    return all(known or job.tools[name].length for name in used if name in job.tools)


def _clamped(own: PreparedSetup) -> list[Run]:
    """The runs of a set-up on its machine, where the part is as it is clamped."""
    return [as_the_tool_goes(run)[0] for run in own.runs]


def _jobs(own: PreparedSetup) -> list[Job]:
    """The programs of a set-up as far as they are simulated, about the part as it is drawn."""
    turn, clamped = own.turn, _clamped(own)
    runs = clamped if turn is None else [run_of_drawn_part(run, turn) for run in clamped]
    return [_job(run, own.tools, own.given.until if run is runs[-1] else None) for run in runs]


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
        raise InputError(argument_problem("until", f"{run.files[0]} has no block {until}", cure, code="SIM114"))
    return int(rows[0])
