"""What posting gives back."""

import io
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from trunnion.errors import InputError, Problem, RefusedError, Severity
from trunnion.jobs.inputs.reading import FilePath
from trunnion.jobs.result_output import written_text
from trunnion.jobs.verify.reports import OfPost, write_post_report
from trunnion.messages import LIBRARY, Wording
from trunnion.model.motion import Decision, Motion, Plan
from trunnion.model.run import Run
from trunnion.model.toolpath import Toolpath
from trunnion.records import dataclass
from trunnion.results import NOT_DATA, Figure
from trunnion.verification import Check, Standing, Verification
from trunnion.wording import counted

if TYPE_CHECKING:  # imported where a program is simulated
    from trunnion.jobs.simulate.result import SimulationResult
    from trunnion.simulation.stock.stated_stock import StatedStock


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class PostResult:
    """A program that was posted.

    toolpaths     what it was made from
    plan          motions on the machine, decisions, problems
    verification  what the proof found; None: no reader knows the control, and nothing is proven (only with ``force``)
    problems      warnings about CL files, plan and program, and what ``force`` overruled
    output        file of the program; None: it was not written to a file
    subprograms   files of its subprograms
    simulation    what it cuts and hits; None: it was not simulated
    encoding      of its files
    entered       what the operator enters for radius compensation, and where
    stated_stock  of the part as it is drawn, in the coordinates of the program; None: no CL file states it
    """

    toolpaths: Annotated[tuple[Toolpath, ...], NOT_DATA]
    plan: Annotated[
        Plan,
        Figure("operations", take=lambda plan: sum(one.starts_operation for one in plan.motions), after="passed"),
        Figure("points", take=lambda plan: sum(len(one.operation.moves) for one in plan.motions)),
    ]
    verification: Annotated[Verification | None, NOT_DATA]
    problems: Annotated[tuple[Problem, ...], Figure("remarks", after="checks")]
    output: Path | None = None
    subprograms: tuple[Path, ...] = ()
    simulation: Annotated["SimulationResult | None", NOT_DATA] = None
    encoding: Annotated[str, NOT_DATA] = "utf-8"
    entered: tuple[str, ...] = ()
    stated_stock: Annotated["StatedStock | None", NOT_DATA] = None
    _memory: io.BytesIO | None = None

    def __repr__(self) -> str:
        """Return what matters in a notebook: the columns would fill pages."""
        rows = "not run" if self.run is None else counted(len(self.run), "motion")
        place = "" if self.output is None else f", output={str(self.output)!r}"
        return f"PostResult(passed={self.passed}, {rows}{place})"

    @property
    @Figure(after="subprograms")
    def passed(self) -> bool:
        """Whether the program is proven and may run."""
        overruled = any(problem.severity is Severity.ERROR for problem in self.problems)
        return self.verification is not None and self.verification.passed and not overruled

    @property
    @Figure(after="points", take=lambda checks: {check.key: check.state for check in checks})
    def checks(self) -> tuple[Check, ...]:
        """The questions that were put to the program, and their answers; none where nothing is proven."""
        return () if self.verification is None else self.verification.checks

    @property
    def proof(self) -> Verification | None:
        """``verification`` with all the warnings of the post: what papers tell."""
        return None if self.verification is None else replace(self.verification, remarks=self.problems)

    @property
    @Figure(after="checks")
    def standing(self) -> Standing | None:
        """What the word that is said of the program stands on; None where nothing is proven."""
        return None if self.proof is None else self.proof.standing

    @property
    def run(self) -> Run | None:
        """The program as it was read back and run: one row a motion, in columns."""
        return None if self.verification is None else self.verification.run

    @property
    def motions(self) -> tuple[Motion, ...]:
        """The operations on the machine, as they were planned."""
        return self.plan.motions

    @property
    def decisions(self) -> tuple[Decision, ...]:
        """Why the axes were planned as they are."""
        return self.plan.decisions

    @property
    def text(self) -> str | None:
        """The program, from its file where it has one; None where it went to a stream."""
        return written_text(self.output, self._memory, self.encoding)

    def write_report(self, file: FilePath) -> None:
        """Write a report of the proof: a page that works offline (``.html``), or data (``.json``).

        Raises
        ------
        InputError
            When the name ends otherwise, nothing was proven, the program was posted without columns, or the file cannot
            be written.
        """
        if self.verification is None:
            raise InputError(Problem(str(file), 0, Wording("CTL920", "nothing_proven")))
        assert self.proof is not None
        write_post_report(self.proof, file, OfPost(self.decisions, self.simulation), LIBRARY)


class ProofFailedError(RefusedError):
    """The program was written and read back, and does not do what its CL files ask for.

    ``result`` has the verification with its checks, and writes its report; ``passed`` is False, and there is no file.
    """

    def __init__(self, problem: Problem, result: PostResult) -> None:
        super().__init__(problem)
        self.result = result
