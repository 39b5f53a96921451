"""A set-up that has been read, and what of it is cut."""

from collections.abc import Sequence
from dataclasses import field
from functools import cached_property

import numpy as np

from trunnion.arrays import Floats
from trunnion.compensation.contour_tools import ContourTools
from trunnion.compensation.stretches import RegisterValue
from trunnion.errors import InputError, Problem, argument_problem
from trunnion.machines import Machine
from trunnion.messages import Wording
from trunnion.model.clamping import Clamping
from trunnion.model.run import Run
from trunnion.model.toolpath import Toolpath
from trunnion.records import dataclass
from trunnion.simulation.meshes import TriangleMesh
from trunnion.simulation.simulator import SimulatedProgram
from trunnion.simulation.stock.turning import Pose
from trunnion.simulation.tool_deltas import ToolPath, as_the_tool_goes
from trunnion.simulation.tools.profile import ToolShape
from trunnion.simulation.turned_parts import run_of_drawn_part


@dataclass(frozen=True, eq=False)
class PreparedSetup:
    """A set-up that has been read: its machine, runs, tools by their names in programs, and meshes as they are drawn.

    toolpaths  of the part as it is clamped
    clamping   how the part is clamped
    name       for findings; empty where there is one set-up only
    pose       where the last set-up's workpiece frame lies in this one's
    register_holds  what the registers of the radius hold
    until      N number of the block of the last program before which the simulation ends; None: at its end
    drawn      toolpaths of the part as it is drawn
    strict     what nobody has stated of radius compensation is an error
    until_line  the line of that block instead, which may be skipped; 0: none
    """

    machine: Machine
    runs: tuple[Run, ...]
    tools: dict[str, ToolShape]
    part: TriangleMesh | None
    fixtures: tuple[TriangleMesh, ...]
    toolpaths: list[Toolpath]
    clamping: Clamping = field(default_factory=Clamping)
    name: str = ""
    pose: Pose = field(default_factory=Pose)
    until: str | int | None = None
    register_holds: RegisterValue = RegisterValue.UNKNOWN
    until_line: int = 0
    strict: bool = False
    drawn: Sequence[Toolpath] = ()

    @property
    def turn(self) -> Floats | None:
        """What turns the part as it is drawn to how it is clamped, (3, 3); None: it is clamped as drawn."""
        return self.clamping.rotation if self.clamping.is_turned else None

    def clamped_runs(self) -> list[Run]:
        """Return the runs on the machine, where the part is as it is clamped."""
        return [path.run for path in self.tool_paths]

    def problems(self) -> list[Problem]:
        """Return what of the runs cannot be simulated."""
        return [problem for path in self.tool_paths for problem in path.problems]

    def missing(self) -> tuple[Wording, ...]:
        """Return why what the tools cut is not known."""
        return tuple(dict.fromkeys(wording for path in self.tool_paths for wording in path.missing))

    @cached_property
    def tool_paths(self) -> list[ToolPath]:
        """How the tools of each program go."""
        contours = ContourTools.of(self.toolpaths)
        return [
            as_the_tool_goes(run, self.tools, self.register_holds, contours, strict=self.strict) for run in self.runs
        ]

    def programs(self) -> list[SimulatedProgram]:
        """Return the programs as far as they are simulated, about the part as it is drawn.

        Raises ``InputError`` if the last program has no block ``until``.
        """
        turn, clamped = self.turn, self.clamped_runs()
        runs = clamped if turn is None else [run_of_drawn_part(run, turn) for run in clamped]
        return [_program_of(run, self.tools, self._row_of_end(run) if run is runs[-1] else len(run)) for run in runs]

    def line_of_end(self) -> int:
        """Return the line of the block before which the last program ends; 0: none is stated.

        Raises ``InputError`` if it has no such block.
        """
        return 0 if self.until is None else int(self.runs[-1].line[self._row_of_end(self.runs[-1])])

    def _row_of_end(self, run: Run) -> int:
        """Return the row at which the last program ends.

        Raises ``InputError`` if it has no block ``until``.
        """
        if self.until_line:
            behind = np.flatnonzero((run.file == 0) & (run.line >= self.until_line))
            return int(behind[0]) if len(behind) else len(run)
        return len(run) if self.until is None else _row_of_block(run, self.until)


def _program_of(run: Run, shapes: dict[str, ToolShape], last: int) -> SimulatedProgram:
    end, why = len(run), None
    errors = sorted(run.errors, key=lambda each: each.line)
    if errors:
        first = errors[0]
        number = run.files.index(first.file) if first.file in run.files else 0
        later = np.flatnonzero((run.file == number) & (run.line >= first.line))
        end = int(later[0]) if len(later) else len(run)
        why = Wording("SIM142", "cut_up_to_fault", line=first.line, fault=first.wording)
    if last < end:
        end, why = last, None
    return SimulatedProgram(run, shapes, end, why)


def _row_of_block(run: Run, until: str | int) -> int:
    text = str(until).strip().upper().removeprefix("N")
    number = int(text) if text.isascii() and text.isdecimal() and len(text) < 10 else -1
    own = np.flatnonzero((run.block_number >= number) & (run.file == 0)) if number >= 0 else np.zeros(0, np.int64)
    # A block without motion is followed by the next number, not by what runs next: subprograms may stand behind it.
    rows = own[run.block_number[own] == run.block_number[own].min()] if len(own) else own
    if not len(rows):
        raise InputError(argument_problem("until", Wording("SIM114", "no_block", files=run.files[0], until=until)))
    return int(rows[0])
