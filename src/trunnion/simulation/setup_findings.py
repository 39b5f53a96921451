"""What a simulation found, as records for scripts and data."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import field, replace
from typing import Annotated, Any, Final, TypeVar

import numpy as np

from trunnion.arrays import Floats, Lines
from trunnion.messages import Wording, phrase, word_said
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind, Toolpath
from trunnion.records import dataclass
from trunnion.results import NOT_DATA, BlockNumber, CubicMillimetres, Figure, Millimetres, OptionalLine, OptionalText
from trunnion.simulation.body_names import body_said
from trunnion.simulation.contact_times import reached
from trunnion.simulation.finding import Finding, What
from trunnion.simulation.findings import file_of_row
from trunnion.simulation.simulator import OperationCut, SimulatedProgram, row_runs, tip_lengths
from trunnion.simulation.steps import CutSetup
from trunnion.simulation.tool_deltas import ToolPath
from trunnion.simulation.tools.choice import NO_CALL
from trunnion.simulation.tools.profile import Role
from trunnion.verification import Verification
from trunnion.verification import verify as verify_run
from trunnion.verification.driven_rows import DrivenRows
from trunnion.wording import position


@dataclass(frozen=True, slots=True)
class SimulationFinding:
    """One thing that is wrong.

    kind      ``rapid through stock``, ``gouge``, ``cuts with the spindle off``, ``shank into stock``,
              ``holder into stock`` or ``collision``
    between   names of two bodies
    file      program
    line      of its worst block in it, from 1
    block     N number of that block, -1 where it has none
    first_line, first_block  of the first block of the run of blocks that do it: where the machine would stop
    last_line, last_block  of the last one
    cl_line   line of the CL file that the block comes from; 0 where it is not known
    cl_file   that file
    seconds   when, from the beginning of the program
    depth     how deep, mm
    place     where, workpiece frame, mm
    setup     name of the set-up; empty where there is only one
    when      which blocks must be skipped (``/``) for it; None: none. ``skipped`` is that in English
    row       of the worst block in the run of its program
    """

    kind: str
    between: tuple[str, str]
    file: str
    line: int
    block: BlockNumber
    last_line: int
    last_block: BlockNumber
    cl_line: OptionalLine
    seconds: float
    depth: Millimetres
    place: tuple[float, float, float]
    cl_file: Annotated[str, Figure(none="", after="cl_line")] = ""
    setup: OptionalText = ""
    when: Annotated[Wording | None, Figure("skipped", take=str)] = None
    row: Annotated[int, NOT_DATA] = -1
    first_line: Annotated[int, Figure(after="block")] = 0
    first_block: Annotated[int, Figure(none=-1, after="first_line")] = -1

    @property
    def stretch(self) -> str:
        """Which blocks do it besides the worst one; empty where there are none."""
        return str(self.among or "")

    @property
    def among(self) -> Wording | None:
        """Which blocks do it besides the worst one; None where there are none."""
        return _stretch(self)

    @property
    def skipped(self) -> str:
        """Which blocks must be skipped for it; empty: none."""
        return str(self.when or "")

    @property
    def said(self) -> Wording:
        """What does what, how deep and where."""
        one, other = map(body_said, self.between)
        where = {"kind": word_said(self.kind), "one": one, "other": other, "place": position(self.place)}
        return _when_skipped(self, phrase("finding_deep", **where, depth=self.depth))

    def __str__(self) -> str:
        """Return what does what, how deep and where."""
        return str(self.said)


@dataclass(frozen=True, slots=True)
class NearMiss:
    """Two bodies that come near each other: where nearest, and how near, mm; the rest as in ``SimulationFinding``.

    The distance is 0 where a shank rubs along the stock.
    """

    between: tuple[str, str]
    file: str
    line: int
    block: BlockNumber
    last_line: int
    last_block: BlockNumber
    seconds: float
    distance: Millimetres
    place: tuple[float, float, float]
    setup: OptionalText = ""
    when: Annotated[Wording | None, Figure("skipped", take=str)] = None
    row: Annotated[int, NOT_DATA] = -1
    first_line: Annotated[int, Figure(after="block")] = 0
    first_block: Annotated[int, Figure(none=-1, after="first_line")] = -1

    @property
    def rubs(self) -> bool:
        """Whether a shank rubs along a wall that stands higher than the flutes."""
        return self.distance == 0.0

    @property
    def stretch(self) -> str:
        """Which blocks do it besides the nearest one; empty where there are none."""
        return str(self.among or "")

    @property
    def among(self) -> Wording | None:
        """Which blocks do it besides the nearest one; None where there are none."""
        return _stretch(self)

    @property
    def skipped(self) -> str:
        """Which blocks must be skipped for it; empty: none."""
        return str(self.when or "")

    @property
    def said(self) -> Wording:
        """What comes near what, how near and where."""
        one, other = map(body_said, self.between)
        where = {"one": one, "other": other, "place": position(self.place)}
        found = phrase("finding_rubs", **where)
        return _when_skipped(self, found if self.rubs else phrase("finding_near", **where, distance=self.distance))

    def __str__(self) -> str:
        """Return what comes near what, how near and where."""
        return str(self.said)


@dataclass(frozen=True, slots=True)
class AirCut:
    """Blocks at feed that take nothing away: file, first and last line and N number, and the way of the tip in mm."""

    file: str
    line: int
    block: BlockNumber
    last_line: int
    last_block: BlockNumber
    length: Millimetres
    setup: OptionalText = ""


@dataclass(frozen=True, slots=True, eq=False)
class BlockRemoval:
    """What each block removed that removed anything.

    line     (n,) of each block in its own file
    removed  (n,) mm³ of the stock
    rate     (n,) mm³/min, at the programmed feeds; NaN where the block takes no time
    """

    line: Lines
    removed: Annotated[Floats, Figure(unit="mm3")]
    rate: Annotated[Floats, Figure("mm3_per_min")]


@dataclass(frozen=True, slots=True)
class SimulatedOperation:
    """Consecutive blocks with one tool.

    file      of the first block: the program, or a subprogram
    tool      as the program calls it
    line      of the first block
    last_line of the last block, in its own file
    removed   mm³ of the stock
    gouged    mm³ of the design
    seconds   at the programmed feeds
    air       mm at feed in which nothing was removed
    findings  their number
    blocks    volume removed by block and minute
    """

    file: str
    tool: str
    line: int
    last_line: int
    removed: CubicMillimetres
    gouged: CubicMillimetres
    seconds: float
    air: Millimetres
    findings: int
    blocks: BlockRemoval = field(compare=False, repr=False)
    setup: OptionalText = ""


@dataclass(frozen=True, slots=True, eq=False)
class CutFindings:
    """What was found in a set-up: what must not be, what comes near, operations with one tool, and all air cuts."""

    findings: tuple[SimulationFinding, ...]
    near: tuple[NearMiss, ...]
    operations: tuple[SimulatedOperation, ...]
    air: tuple[AirCut, ...]


_Named = TypeVar("_Named", SimulationFinding, NearMiss, AirCut, SimulatedOperation)

#: The part of the tool that does what is wrong; all others are the cutter's.
_ROLES: Final = {What.SHANK: (Role.SHANK,), What.HOLDER: (Role.HOLDER,), What.NEAR: (Role.SHANK, Role.HOLDER)}


def setup_findings(cut: CutSetup) -> CutFindings:
    """Return records of what programs have cut, hit and come near to in a set-up, with their blocks and times."""
    found, programs, touched, setup = cut.simulation, cut.programs, cut.touched, cut.setup.name
    toolpaths = cut.setup.toolpaths if len(programs) == 1 else ()
    verified = [
        _verified(run, path, toolpaths)
        for run, path, _ in zip(cut.setup.runs, cut.setup.tool_paths, programs, strict=False)
    ]
    slack = 0.5 * float(found.stock.lattice.cell.max())
    seconds = [np.cumsum(each.seconds) for each in verified]
    lengths = [tip_lengths(program.run) for program in programs]
    findings, operations, air = list[SimulationFinding](), list[SimulatedOperation](), list[AirCut]()
    misses = list[NearMiss]()
    for one in found.operations:
        run, at = programs[one.program].run, seconds[one.program]
        for finding in one.findings:
            findings.append(
                _finding(verified[one.program], finding, _moment(programs[one.program], finding, at, slack))
            )
        for finding in one.near:
            misses.append(_near(run, finding, _moment(programs[one.program], finding, at, slack + finding.depth)))
        idle = list(_air(run, one, lengths[one.program]))
        air += idle
        seconds_taken = float(at[one.end - 1]) - (float(at[one.first - 1]) if one.first else 0.0)
        air_length = sum(each.length for each in idle)
        own = [each for each in touched[one.program] if not each.is_near and one.first <= each.worst < one.end]
        count, blocks = len(one.findings) + len(own), _blocks(run, one, at)
        operations.append(_operation(run, one, seconds_taken, air_length, count, blocks))
    for number, collisions in enumerate(touched):
        run, at = programs[number].run, seconds[number]
        for finding in collisions:
            moment = _moment(programs[number], finding, at, slack)
            if finding.is_near:
                misses.append(_near(run, finding, moment))
            else:
                findings.append(_finding(verified[number], finding, moment))
    return CutFindings(_named(findings, setup), _named(misses, setup), _named(operations, setup), _named(air, setup))


def _verified(run: Run, path: ToolPath, toolpaths: Sequence[Toolpath]) -> Verification:
    """Return what is known of a run as it was read; where radius compensation inserts rows, by the rows with these."""
    own = verify_run(run, toolpaths)
    if len(run) == len(path.run):
        return own
    rows, real = DrivenRows(path.run, path.row_of), verify_run(path.run)
    return replace(real, cl_line=rows.column(own.cl_line), operations=tuple(rows.operations(own.operations)))


def _named(found: Iterable[_Named], setup: str) -> tuple[_Named, ...]:
    """Return records with the name of their set-up."""
    return tuple(replace(each, setup=setup) for each in found) if setup else tuple(found)


def _operation(
    run: Run, one: OperationCut, seconds: float, air: float, count: int, blocks: BlockRemoval
) -> SimulatedOperation:
    lines = int(run.line[one.first]), int(run.line[one.end - 1])
    tool, removed = one.tool or NO_CALL, float(one.removed.sum())
    file = run.files[int(run.file[one.first])]  # line 21 may be that of a subprogram
    return SimulatedOperation(file, tool, *lines, removed, one.gouged, seconds, air, count, blocks)


def _blocks(run: Run, one: OperationCut, at: Floats) -> BlockRemoval:
    """Return what each block of an operation removed; ``at`` are seconds at the ends of the run's rows.

    Rows that follow each other in one line are a block: a cycle, or an arc in pieces.
    """
    lines = run.line[one.first : one.end]
    starts = np.flatnonzero(np.diff(lines, prepend=lines[:1] - 1))
    removed = np.add.reduceat(one.removed, starts)
    ends = one.first + np.append(starts[1:], len(lines)) - 1
    before = one.first + starts - 1
    minutes = (at[ends] - np.where(before >= 0, at[np.maximum(before, 0)], 0.0)) / 60.0
    rate = np.divide(removed, minutes, out=np.full(len(removed), np.nan), where=minutes > 0.0)
    kept = removed > 0.0
    return BlockRemoval(lines[starts][kept], removed[kept], rate[kept])


def _moment(program: SimulatedProgram, finding: Finding, seconds: Floats, slack: float) -> float:
    """When something is found, seconds from the start of the program; ``seconds`` are those at the ends of rows."""
    row, fraction = finding.worst, finding.fraction
    if math.isnan(fraction):
        shape = program.tools.get(program.run.tools[int(program.run.state.tool[row])])
        roles = _ROLES.get(finding.what, (Role.CUTTER,))
        fraction = 1.0 if shape is None else reached(program.run, row, shape, roles, finding.place, slack)
    return _at_fraction(seconds, row, fraction)


def _at_fraction(seconds: Floats, row: int, fraction: float) -> float:
    begin = float(seconds[row - 1]) if row else 0.0
    return begin + fraction * (float(seconds[row]) - begin)


def _finding(verified: Verification, finding: Finding, seconds: float) -> SimulationFinding:
    run, row, (first, last) = verified.run, finding.worst, finding.rows
    x, y, z = finding.place
    cl_line = int(verified.cl_line[row]) if len(verified.cl_line) else 0
    cl_file = next((each.cl_file for each in verified.operations if each.first <= row < each.end), "")
    return SimulationFinding(
        str(finding.what), finding.between, file_of_row(run, row), int(run.line[row]), int(run.block_number[row]),
        int(run.line[last]), int(run.block_number[last]), cl_line, seconds, finding.depth, (x, y, z),
        cl_file if cl_line else "", row=row, first_line=int(run.line[first]), first_block=int(run.block_number[first]),
    )  # fmt: skip


def _near(run: Run, each: Finding, seconds: float) -> NearMiss:
    row, (first, last) = each.worst, each.rows
    return NearMiss(
        each.between, file_of_row(run, row), int(run.line[row]), int(run.block_number[row]), int(run.line[last]),
        int(run.block_number[last]), seconds, each.depth, each.place, row=row, first_line=int(run.line[first]),
        first_block=int(run.block_number[first]),
    )  # fmt: skip


def _when_skipped(each: SimulationFinding | NearMiss, what: Wording) -> Wording:
    return what if each.when is None else phrase("with_skipped", skipped=each.when, what=what)


def _stretch(each: SimulationFinding | NearMiss) -> Wording | None:
    if each.first_line == each.line == each.last_line:
        return None
    first = (
        phrase("block_in_line", block=each.first_block, line=each.first_line)
        if each.first_block >= 0
        else phrase("line_number", line=each.first_line)
    )
    return phrase("from_to_line", first=first, last=each.last_line)


def _air(run: Run, one: OperationCut, lengths: Any) -> Iterable[AirCut]:
    rows = np.concatenate(one.air) if one.air else np.zeros(0, np.int64)
    rows = rows[run.kind[rows] != Kind.RAPID]
    for first, last in row_runs(rows):
        length = float(lengths[first : last + 1].sum())
        if length > 0.0:
            numbers = int(run.block_number[first]), int(run.block_number[last])
            yield AirCut(
                file_of_row(run, first), int(run.line[first]), numbers[0], int(run.line[last]), numbers[1], length
            )
