"""What the stages of a post hand to each other: read, plan, write, read back, prove, simulate, papers.

``jobs.post.posting`` strings the stages together; each is a function of ``Posting`` and of the records before it.
"""

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

from trunnion.errors import Problem
from trunnion.jobs.observer import Observer
from trunnion.jobs.post.post_job import PostJob
from trunnion.jobs.post.program_places import ProgramPlaces
from trunnion.jobs.result_output import Target
from trunnion.model.motion import Plan
from trunnion.model.operation_start import OperationStart
from trunnion.model.run import Run
from trunnion.model.toolpath import Toolpath
from trunnion.output.program import Program
from trunnion.output.subprograms import SubprogramOutput
from trunnion.records import dataclass
from trunnion.verification import Check, Verification

if TYPE_CHECKING:  # imported where a program is simulated: others start sooner
    from trunnion.jobs.simulate.result import SimulationResult


@dataclass(frozen=True, slots=True, eq=False)
class Posting:
    """One program on its way: what every stage is given.

    toolpaths    that it is made from
    subprograms  how it is divided into files; None: it is a single file
    places       names places in it as its user knows them
    """

    toolpaths: Sequence[Toolpath]
    job: PostJob
    target: Target
    observer: Observer
    subprograms: SubprogramOutput | None
    places: ProgramPlaces


class PlannedProgram(NamedTuple):
    """A program before any text is written.

    program   with a notice in its head for each problem that ``force`` overrules
    plan      its motions and decisions
    problems  warnings about program and plan, and what ``force`` overrules; they have been reported
    """

    program: Program
    plan: Plan
    problems: list[Problem]


@dataclass(frozen=True, slots=True, eq=False)
class WrittenProgram:
    """A program in its files, read back.

    starts  where its operations begin
    run     None: no reader knows the control
    """

    planned: PlannedProgram
    starts: Sequence[OperationStart]
    run: Run | None


@dataclass(frozen=True, slots=True, eq=False)
class Proof:
    """What was found of a program; None: no reader knows its control, or it was not simulated.

    times  seconds of its operations, if it prints them
    """

    verification: Verification | None
    simulation: "SimulationResult | None" = None
    times: Sequence[float] = ()

    @property
    def failed(self) -> list[Check]:
        """The checks that failed."""
        return [] if self.verification is None else [check for check in self.verification.checks if not check.passed]
