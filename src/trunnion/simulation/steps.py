"""Set-ups that are simulated one after another: the stock that one leaves is that of the next."""

from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager
from dataclasses import replace
from itertools import chain
from typing import Protocol

import numpy as np

from trunnion.errors import Problem, warning
from trunnion.messages import Wording
from trunnion.model.run import ProgrammedWord
from trunnion.records import dataclass
from trunnion.simulation.collisions import Body, check_collisions, fixture_body, machine_bodies, part_body
from trunnion.simulation.cutting.shares import JoinedShares, Share
from trunnion.simulation.finding import Finding
from trunnion.simulation.meshes import TriangleMesh
from trunnion.simulation.prepared_setup import PreparedSetup
from trunnion.simulation.remarks import of_setup, part_remarks, simulation_remarks
from trunnion.simulation.simulator import CuttingModel, SimulatedProgram, Simulation, cut_share, simulate
from trunnion.simulation.stock.solids import StockShape
from trunnion.simulation.stock.turning import turned_stock
from trunnion.simulation.sunk_bodies import jaws_in_stock, sunk_bodies
from trunnion.simulation.turned_parts import as_clamped, places_of_drawing


class Watcher(Protocol):
    """Receives progress and remarks while stock is cut."""

    def problems(self, problems: Sequence[Problem]) -> None:
        """Remarks, as they are found."""

    def progress(self, stage: str, total: int, unit: str) -> AbstractContextManager[Callable[[int], None]]:
        """Accompany a stage: gives a function that is called with how many more units are done."""


@dataclass(frozen=True, slots=True)
class CuttingOptions:
    """How stock is cut.

    cell       width of the cells, mm
    tolerance  how far motions may be off, mm
    near       distance that counts as near, mm; 0: none
    stops_at_first  the simulation ends at the first finding
    threads    None: as many as there are processors
    """

    cell: float
    tolerance: float
    near: float = 0.0
    stops_at_first: bool = False
    threads: int | None = None


@dataclass(frozen=True, slots=True, eq=False)
class CutSetup:
    """What cutting in a set-up came to.

    setup       as it was read
    simulation  of its programs
    programs    the programs as far as they were simulated
    touched     what bodies did in each of them
    remarks     what was not simulated, or was taken for granted
    pairs       of bodies that were checked against each other
    """

    setup: PreparedSetup
    simulation: Simulation
    programs: Sequence[SimulatedProgram]
    touched: Sequence[Sequence[Finding]]
    remarks: tuple[Problem, ...]
    pairs: int


class SetupSteps:
    """Cuts stock in set-ups, each time what the last one has left."""

    def __init__(self, options: CuttingOptions, watcher: Watcher, shares: JoinedShares | None) -> None:
        self._options, self._watcher, self._shares = options, watcher, shares
        self._part: TriangleMesh | None = None
        #: How far turns may have moved the surface of the stock, mm.
        self._slack = 0.0
        self._left: Simulation | None = None
        #: What is odd about machines, which is told once, whatever runs on them.
        self._of_machines: list[Problem] = []

    def again(self, watcher: Watcher) -> "SetupSteps":
        """Return what cuts the stock once more from the beginning, whole."""
        return SetupSteps(self._options, watcher, None)

    def follow(self, own: PreparedSetup, shape: StockShape, remarks: list[Problem]) -> CutSetup:
        """Cut the stock in a set-up; ``shape`` is the first one's."""
        pose, cell = own.pose, self._options.cell
        if self._left is not None:
            shape = StockShape.of_kept(*turned_stock(self._left.stock, pose, cell))
            self._part = None if self._part is None else self._part.moved(pose.matrix)
            if not pose.keeps_rays:
                self._slack += cell
                remarks.append(
                    warning("stock", 0, Wording("SIM134", "turned_through_surface", off=0.5 * cell, cell=cell))
                )
        self._part = own.part or self._part
        result = self._simulated(own, self._model(shape, self._part), self._part, remarks)
        self._left = result.simulation
        return result

    def share(self, own: PreparedSetup, shape: StockShape, share: Share, remarks: list[Problem]) -> bytes:
        """Cut some tiles of the stock in the only set-up."""
        self._watcher.problems(remarks)
        programs, model = own.programs(), self._model(shape, own.part)
        with self._watcher.progress("cutting", sum(program.end for program in programs), "blocks") as tell:
            return cut_share(model, programs, share, threads=self._options.threads, progress=_told_once(tell))

    def _model(self, shape: StockShape, part: TriangleMesh | None) -> CuttingModel:
        design = None if part is None else StockShape(part.bounds[0], part.bounds[1], mesh=part)
        return CuttingModel(shape, design, self._options.cell, self._options.tolerance, self._options.near)

    def _simulated(
        self, own: PreparedSetup, model: CuttingModel, part: TriangleMesh | None, remarks: list[Problem]
    ) -> CutSetup:
        options, name, turn = self._options, own.name, own.turn
        clamped, programs = own.clamped_runs(), own.programs()
        runs = [program.run for program in programs]
        remarks += simulation_remarks(model, runs, own.tools)
        remarks += own.problems()
        remarks += [
            Problem(program.run.files[0], 0, program.broken_off)
            for program in programs
            if program.broken_off is not None
        ]
        self._watcher.problems(of_setup(remarks, name))
        told = len(remarks)
        solid, around = part, own.fixtures
        if turn is not None:
            solid = None if part is None else as_clamped(part, turn)
            around = tuple(as_clamped(mesh, turn) for mesh in around)
        machines = list[Problem]()
        bodies = [
            _bodies(replace(program, run=run), number, solid, around, remarks, machines)
            for number, (program, run) in enumerate(zip(programs, clamped, strict=True))
        ]
        if around or _lengths_known(programs[0]):
            # What an earlier set-up has left has no surface of its own yet.
            blank: tuple[TriangleMesh, ...] = (
                () if model.stock.kept is not None else (model.stock.as_mesh().named("stock"),)
            )
            if turn is not None:
                blank = tuple(as_clamped(mesh, turn) for mesh in blank)
            remarks += sunk_bodies(clamped[0].machine, (*blank, *around))
            remarks += chain.from_iterable(jaws_in_stock(stock, around) for stock in blank)
        machines = [each for each in dict.fromkeys(machines) if each not in self._of_machines]
        self._of_machines += machines
        self._watcher.problems(machines)
        pairs: list[int] = []

        def touching(
            programs: Sequence[SimulatedProgram], tell: Callable[[int], None] | None = None
        ) -> list[list[Finding]]:
            """Return what touches on the machine, where the part is as it is clamped; places are those of the
            drawing.
            """
            found = [
                _collisions(replace(program, run=run), each, options.near, tell)
                for program, run, each in zip(programs, clamped, bodies, strict=False)
            ]
            return found if turn is None else [places_of_drawing(each, turn) for each in found]

        touched = touching(programs, pairs.append)
        if options.stops_at_first:
            programs = _up_to_first_hit(programs, touched)
        found = self._cut(model, programs)
        remarks += part_remarks(model, found.lacking, self._slack, is_later=self._left is not None)
        if found.leaks:
            remarks.append(
                warning(
                    "part",
                    0,
                    Wording("SIM214", "rays_pass_hole", leaks=found.leaks, ray_count=found.stock.lattice.ray_count),
                )
            )
        if found.start_volume - found.stock.volume <= 0.0:
            remarks.append(warning(runs[0].files[0], 0, Wording("SIM133", "takes_nothing_from")))
        self._watcher.problems(of_setup(remarks[told:], name))
        if options.stops_at_first:
            programs = _until_stop(programs, found)
            touched = touching(programs)
        return CutSetup(own, found, programs, touched, (*of_setup(remarks, name), *machines), sum(pairs))

    def _cut(self, model: CuttingModel, programs: Sequence[SimulatedProgram]) -> Simulation:
        """Cut the stock, with progress."""
        with self._watcher.progress("cutting", sum(program.end for program in programs), "blocks") as tell:
            return simulate(
                model, programs, stop_at_first=self._options.stops_at_first, threads=self._options.threads,
                shares=self._shares, progress=_told_once(tell),
            )  # fmt: skip


def _told_once(tell: Callable[[int], None]) -> Callable[[int, int], None]:
    """Return what tells of rows that are done, each of them once."""
    done = 0

    def progress(rows: int, _: int) -> None:
        nonlocal done
        if rows > done:
            tell(rows - done)
            done = rows

    return progress


def _up_to_first_hit(
    programs: Sequence[SimulatedProgram], touched: Sequence[Sequence[Finding]]
) -> list[SimulatedProgram]:
    """Return the programs as far as the row in which bodies first touch."""
    kept = []
    for program, collisions in zip(programs, touched, strict=True):
        first = min((each.rows[0] for each in collisions if not each.is_near), default=None)
        kept.append(program if first is None else replace(program, end=first + 1))
        if first is not None:
            break
    return kept


def _until_stop(programs: Sequence[SimulatedProgram], found: Simulation) -> list[SimulatedProgram]:
    """Return the programs as far as they were simulated."""
    if found.stopped is None:
        return list(programs)
    last, row = found.stopped
    return [*programs[:last], replace(programs[last], end=row + 1)]


def _bodies(
    program: SimulatedProgram,
    number: int,
    part: TriangleMesh | None,
    fixtures: Sequence[TriangleMesh],
    remarks: list[Problem],
    of_machine: list[Problem],
) -> list[Body]:
    """Return what a tool can hit while a program runs, and what the machine may hit with it."""
    machine = program.run.machine
    bodies = [fixture_body(mesh, machine) for mesh in fixtures]
    if fixtures and part is not None:
        bodies.append(part_body(part, machine))
    if machine.workpiece_zero is not None and _lengths_known(program):
        bodies += machine_bodies(machine, of_machine.append)
        remarks += _not_where_machine_positions_stand(program)
    elif number == 0 and machine.bodies:
        remarks.append(warning(program.run.files[0], 0, Wording("SIM310", "bodies_machine_not")))
    return bodies


def _not_where_machine_positions_stand(program: SimulatedProgram) -> list[Problem]:
    """Return the warning that the spindle nose stands nowhere known behind blocks that name positions of the machine.

    Elsewhere work offset and tool length say how far it is from the table.
    """
    run = program.run
    if run.machine.spindle_point_is_stated or run.machine.has_rotary_head:
        return []
    words = ProgrammedWord.X | ProgrammedWord.Y | ProgrammedWord.Z
    rows = np.flatnonzero(run.machine_frame[: program.end] & ((run.programmed[: program.end] & words) != 0))
    if not len(rows):
        return []
    file, line = run.files[int(run.state.file[rows[0]])], int(run.lines[int(rows[0])])
    return [warning(file, line, Wording("SIM310", "gauge_at_machine", count=len(rows)))]


def _collisions(
    program: SimulatedProgram, bodies: Sequence[Body], near: float, pairs_told: Callable[[int], None] | None = None
) -> list[Finding]:
    """Return what touches, or comes near, while a program runs as far as it is simulated."""
    if not bodies:
        return []
    return check_collisions(program.run, bodies, program.tools, near=near, end=program.end, pairs_told=pairs_told)


def _lengths_known(program: SimulatedProgram) -> bool:
    """Whether the length of every tool that the program calls is known, from its tip to the gauge point."""
    run = program.run
    used = [run.tools[int(index)] for index in run.state.tool.distinct()]
    known = [run.length_of(name) is not None or program.tools[name].length for name in used if name in program.tools]
    return all(known)
