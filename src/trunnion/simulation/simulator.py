"""Programs that cut stock one after another, and all that is found.

In:     stock, the design, runs and the bodies of their tools.
Out:    ``Simulation``: what each operation did, what is wrong, and the stock that is left.
Units:  mm, seconds, workpiece frame.
"""

import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import field
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.messages import Wording
from trunnion.model.run import Run
from trunnion.records import dataclass
from trunnion.simulation.cutting.measurements import Chunk, RowsCut, rows_cut
from trunnion.simulation.cutting.removal import CutRows, Cutter, measure
from trunnion.simulation.cutting.shares import JoinedShares, Share, ShareWriter, tiles_of
from trunnion.simulation.finding import Finding
from trunnion.simulation.findings import air_cuts, gouge_findings, idle_rows, row_findings, spindle_turns
from trunnion.simulation.near_stock import near_findings, pieces_with_near
from trunnion.simulation.stock.deviation import Excess, Gouges, lacking_at_start, left_on, missing_from
from trunnion.simulation.stock.material import Stock
from trunnion.simulation.stock.solids import StockShape, make_stock
from trunnion.simulation.stock.spans import Spans
from trunnion.simulation.tools.pieces import RevolvedPieces, revolved_pieces
from trunnion.simulation.tools.profile import ToolShape

#: Gouges that are nearer to each other along the path than so many cells are one.
_APART: Final = 5.0

#: Part of the tolerance that the facets of a tool's round corners take.
_FACETS: Final = 0.25


@dataclass(frozen=True, slots=True)
class CuttingModel:
    """What is simulated: the solids, the cell, how far motions may be off (``tolerance``), mm.

    near  distance from the stock from which on shank and holder are told, mm; 0: only where they meet it or rub on it
    """

    stock: StockShape
    part: StockShape | None
    cell: float
    tolerance: float
    near: float = 0.0

    @property
    def limit(self) -> float:
        """What is no deeper than this is not told, mm: what motions and tools may be off on both sides."""
        return 2.0 * self.tolerance


@dataclass(frozen=True, slots=True, eq=False)
class SimulatedProgram:
    """A program: its run, the body of each tool by its name in the program, the row at which it ends, and why."""

    run: Run
    tools: Mapping[str, ToolShape]
    end: int
    broken_off: Wording | None = None


@dataclass(slots=True, eq=False)
class OperationCut:
    """What consecutive rows with one tool did: rows ``first`` to ``end`` (exclusive) of the run of a program."""

    program: int
    tool: str
    first: int
    end: int
    volumes: list[Floats] = field(default_factory=list)
    gouged: float = 0.0
    air: list[Ints] = field(default_factory=list)
    findings: list[Finding] = field(default_factory=list)
    near: list[Finding] = field(default_factory=list)

    @property
    def removed(self) -> Floats:
        """Volume that each row removed, (end - first,), mm³."""
        return np.concatenate(self.volumes) if self.volumes else np.zeros(0)


@dataclass(frozen=True, slots=True, eq=False)
class Simulation:
    """What came out.

    programs  as far as they were cut
    error    how far the bodies of tools with round corners may be off, mm
    left     what the stock has beyond the design; None without a design
    gouge    what of the design is missing, and was there
    lacking  what of it was missing before anything was cut
    stopped  where it was stopped at the first finding: program and row
    seconds  of computing
    """

    model: CuttingModel
    programs: tuple[SimulatedProgram, ...]
    operations: tuple[OperationCut, ...]
    stock: Stock
    start_volume: float
    error: float
    left: Excess | None
    gouge: Excess | None
    lacking: Excess | None
    leaks: int
    stopped: tuple[int, int] | None
    seconds: float


def simulate(
    model: CuttingModel,
    programs: Sequence[SimulatedProgram],
    *,
    stop_at_first: bool = False,
    threads: int | None = None,
    shares: JoinedShares | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Simulation:
    """Cut stock with programs, one after another.

    model          the solids and the accuracy
    programs       the programs in their order
    stop_at_first  end after the row of the first finding
    threads        as for ``removal.measure``
    shares         what ``cut_share`` has made of each share of the same simulation: nothing is cut but what they cannot
                   know
    progress       is called with rows done and rows in all

    Raises ``DamagedShareError`` if the shares cannot be used.
    """
    found = _simulate(model, programs, threads, progress, shares=shares)
    if stop_at_first:
        first = min(
            ((one.program, finding.rows[0]) for one in found.operations for finding in one.findings), default=None
        )
        if first is not None:
            program, row = first
            kept = [
                *programs[:program],
                SimulatedProgram(programs[program].run, programs[program].tools, row + 1, programs[program].broken_off),
            ]
            return _simulate(model, kept, threads, progress, first)
    return found


def cut_share(
    model: CuttingModel,
    programs: Sequence[SimulatedProgram],
    share: Share,
    *,
    threads: int | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> bytes:
    """Cut some tiles of the stock with all programs; what is needed of it to put the simulation together.

    Parameters are those of ``simulate``.
    """
    stock = make_stock(model.stock, model.cell, lambda lattice: tiles_of(share, lattice))
    tiles = tiles_of(share, stock.lattice)
    design = None if model.part is None else model.part.bundles(stock.lattice, tiles)
    writer = ShareWriter(tiles)
    total, done = sum(program.end for program in programs), 0
    for number, program in enumerate(programs):
        cutter = Cutter(stock, design, model.tolerance)
        for chunk in _measured(model, programs, number, cutter, threads, _shifted(progress, done, total)):
            writer.add(number, chunk)
        done += program.end
    return writer.finish(stock)


def _measured(
    model: CuttingModel,
    programs: Sequence[SimulatedProgram],
    number: int,
    cutter: Cutter,
    threads: int | None,
    progress: Callable[[int, int], None] | None,
) -> Iterator[Chunk]:
    """Cut stock with one of the programs."""
    program = programs[number]
    pieces, _ = tool_pieces(program, model, with_near=True)
    idle = idle_rows(program.run, spindle_turns(program.run))
    rows = CutRows(0, program.end, idle, _offset(programs, number))
    return measure(cutter, program.run, pieces, rows, threads=threads, progress=progress)


def _simulate(
    model: CuttingModel,
    programs: Sequence[SimulatedProgram],
    threads: int | None,
    progress: Callable[[int, int], None] | None,
    stopped: tuple[int, int] | None = None,
    shares: JoinedShares | None = None,
) -> Simulation:
    begin = time.perf_counter()
    stock = make_stock(model.stock, model.cell)
    start = stock.spans(0), stock.spans(1), stock.spans(2)
    design: tuple[Spans, Spans, Spans] | None = None
    lacking, leaks = None, 0
    if model.part is not None:
        design = model.part.bundles(stock.lattice)
        leaks = sum(spans.leaks for spans in design)
        lacking = lacking_at_start(stock, design, model.limit)
    start_volume, operations = stock.volume, list[OperationCut]()
    total, done, error = sum(program.end for program in programs), 0, 0.0
    for number, program in enumerate(programs):
        pieces, off = tool_pieces(program, model, with_near=True)
        error, tell = max(error, off), _shifted(progress, done, total)
        if shares is None:
            chunks = _measured(model, programs, number, Cutter(stock, design, model.tolerance), threads, tell)
        else:
            chunks = shares.chunks(number, program.run, pieces, program.end, stock.lattice, tell)
        operations += _operations(model, program, number, rows_cut(chunks, pieces))
        done += program.end
    if shares is not None:
        shares.finish(stock)
    left = gouge = None
    if design is not None:
        left = left_on(stock, design, model.limit)
        gouge, gouges = missing_from(stock, start, design, model.limit)
        gouges = _with_whole(gouges, model, programs, stock, threads)
        apart = _APART * float(stock.lattice.cell.max())
        for one in operations:
            _add_gouges(one, programs, gouges, apart)
    seconds = time.perf_counter() - begin
    return Simulation(
        model,
        tuple(programs),
        tuple(operations),
        stock,
        start_volume,
        error,
        left,
        gouge,
        lacking,
        leaks,
        stopped,
        seconds,
    )


def _with_whole(
    gouges: Gouges, model: CuttingModel, programs: Sequence[SimulatedProgram], stock: Stock, threads: int | None
) -> Gouges:
    """Gouges, and the rows that took what is missing altogether: it alone is cut again."""
    if gouges.whole is None:
        return gouges
    parts = [gouges]
    took = [
        rows.first + np.flatnonzero(rows.removed > 0.0) + offset
        for offset, rows in _cut_again(gouges.whole, model, programs, stock, threads, None)
    ]
    idle = np.zeros(sum(len(program.run) for program in programs), np.bool_)
    idle[np.concatenate(took)] = True
    for offset, rows in _cut_again(gouges.whole, model, programs, stock, threads, idle):
        deep = np.flatnonzero(rows.idle.depth > model.limit)
        parts.append(Gouges(rows.first + deep + offset, rows.idle.depth[deep], rows.idle.place[deep]))
    row, thickness, place = (
        np.concatenate([getattr(part, name) for part in parts]) for name in ("row", "thickness", "place")
    )
    return Gouges(row, thickness, place)


def _cut_again(
    spans: tuple[Spans, Spans, Spans],
    model: CuttingModel,
    programs: Sequence[SimulatedProgram],
    stock: Stock,
    threads: int | None,
    idle: Flags | None,
) -> Iterator[tuple[int, RowsCut]]:
    """Cut some stretches of material with all programs; what is added to rows of each, and what they did."""
    again = Stock.of_spans(stock.lattice, spans)
    for number, program in enumerate(programs):
        offset, pieces = _offset(programs, number), tool_pieces(program, model)[0]
        own = None if idle is None else idle[offset : offset + len(program.run)]
        cutter, rows_to_cut = Cutter(again, None, model.tolerance), CutRows(0, program.end, own)
        chunks = measure(cutter, program.run, pieces, rows_to_cut, threads=threads)
        for rows in rows_cut(chunks, pieces):
            yield offset, rows


def _add_gouges(one: OperationCut, programs: Sequence[SimulatedProgram], gouges: Gouges, apart: float) -> None:
    """Add what an operation took from the design to its findings."""
    offset, run = _offset(programs, one.program), programs[one.program].run
    own = Gouges(gouges.row - offset, gouges.thickness, gouges.place)
    one.findings += gouge_findings(run, int(run.state.tool[one.first]), one.first, one.end, own, apart)
    one.findings.sort(key=lambda finding: finding.rows)


def _offset(programs: Sequence[SimulatedProgram], program: int) -> int:
    """Return what is added to the rows of a program in the stock: rows of all programs count on."""
    return sum(len(each.run) for each in programs[:program])


def _shifted(progress: Callable[[int, int], None] | None, before: int, total: int) -> Callable[[int, int], None] | None:
    if progress is None:
        return None
    return lambda done, _: progress(before + done, total)


def tool_pieces(
    program: SimulatedProgram, model: CuttingModel, *, with_near: bool = False
) -> tuple[dict[int, RevolvedPieces], float]:
    """Return the pieces of each tool by its index in the run, and how far they are off, mm.

    ``with_near``: and those around shank and holder, which show what they come near to.
    """
    found, error, facets = {}, 0.0, _FACETS * model.tolerance
    for index, name in enumerate(program.run.tools):
        if name in program.tools:
            shape = program.tools[name]
            found[index], off = (
                pieces_with_near(shape, model.near, model.tolerance, facets)
                if with_near
                else revolved_pieces(shape, facets)
            )
            error = max(error, off)
    return found, error


def _operations(
    model: CuttingModel, program: SimulatedProgram, number: int, chunks: Iterable[RowsCut]
) -> Iterator[OperationCut]:
    """Yield the operations of a program when each of them has ended."""
    run, turning, current = program.run, spindle_turns(program.run), None
    for rows in chunks:
        name = run.tools[rows.tool]
        if current is None or current.tool != name or current.end != rows.first:
            if current is not None:
                yield current
            current = OperationCut(number, name, rows.first, rows.first)
        current.end = rows.first + len(rows.removed)
        current.volumes.append(rows.removed)
        current.gouged += float(rows.gouged.sum())
        current.findings += row_findings(run, rows, program.tools[name], model.limit, turning)
        current.near += near_findings(run, rows, program.tools[name], model.near, model.tolerance)
        current.air.append(air_cuts(run, rows))
    if current is not None:
        yield current


def row_runs(rows: Ints) -> Iterator[tuple[int, int]]:
    """Consecutive rows as first and last."""
    if len(rows):
        for part in np.split(rows, np.flatnonzero(np.diff(rows) > 1) + 1):
            yield int(part[0]), int(part[-1])


def tip_lengths(run: Run) -> Floats:
    """Return the straight way of the tip in each row, (n,), mm."""
    steps = np.diff(run.tip, axis=0, prepend=run.tip[:1])
    return np.asarray(np.linalg.norm(steps, axis=1))
