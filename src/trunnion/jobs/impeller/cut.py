"""An impeller as it is machined: the steps with their times and clearances, the proof, the files."""

from collections.abc import Sequence
from operator import attrgetter
from pathlib import Path
from typing import Annotated, ClassVar

from trunnion.errors import Problem
from trunnion.impeller.impeller import Impeller
from trunnion.impeller.material import Material
from trunnion.impeller.paths.least_clearances import PartClearance
from trunnion.impeller.steps import MachiningStep
from trunnion.jobs.impeller.step_times import StepTimes
from trunnion.jobs.post.result import PostResult
from trunnion.jobs.simulate.result import SimulationResult
from trunnion.model.toolpath import Toolpath
from trunnion.records import dataclass
from trunnion.results import NOT_DATA, Figure


def _flanks(flanks: Sequence[tuple[float, float]]) -> list[dict[str, float]]:
    return [{"overcut_mm": over, "undercut_mm": under} for over, under in flanks]


@dataclass(frozen=True, slots=True, eq=False)
class CutStep:
    """A machining step as it is cut.

    toolpath   its operations, one for each blade or channel, as the CL file says them
    points     of all of them
    seconds    of each operation on the machine, with what leads to it
    times      where they go
    clearance  of each part of the tool, the least that it has to a blade or the hub, or to the stock where the step
               goes round the part. In flank milling the cutter's is that to the hub and to other blades
    flanks     of flank milling: overcut and undercut of each side, mm
    before     what metal stands before it, an estimate
    cl_file    its CL file
    programs   the subprogram of each operation; none if they are in one program, or divided further
    """

    step: Annotated[
        MachiningStep,
        Figure("name", take=attrgetter("name")),
        Figure("kind", take=attrgetter("kind")),
        Figure("published_minutes", take=lambda step: step.published_minutes or None, after="minutes"),
    ]
    toolpath: Annotated[Toolpath, NOT_DATA]
    points: Annotated[int, Figure(after="programs")]
    seconds: Annotated[tuple[float, ...], Figure("operations", take=len)]
    times: Annotated[StepTimes, Figure(after="published_minutes")]
    clearance: Annotated[tuple[PartClearance, ...], Figure("clearances", after="times")]
    before: Annotated[Material, Figure(after="clearances")]
    flanks: Annotated[tuple[tuple[float, float], ...], Figure(decimals=6, take=_flanks, after="before")] = ()
    cl_file: Path | None = None
    programs: tuple[Path, ...] = ()

    @property
    @Figure(decimals=6, after="points")
    def minutes(self) -> float:
        """Of one operation, in the mean."""
        return sum(self.seconds) / len(self.seconds) / 60.0


@dataclass(frozen=True, slots=True, eq=False)
class ImpellerCut:
    """An impeller as it is machined.

    steps       in their order
    remarks     warnings: steps that find more metal than they can take, by an estimate
    result      of the post: the program, its proof and its files
    cl_files    one for each step
    simulation  what the program leaves of the stock, against the model; None: it was not simulated
    """

    SCHEMA: ClassVar[int] = 3

    impeller: Annotated[Impeller, Figure("name", take=attrgetter("definition.name"))]
    steps: Annotated[tuple[CutStep, ...], Figure(after="cl_files")]
    result: Annotated[
        PostResult,
        Figure("program", take=lambda result: str(result.output)),
        Figure("subprograms", take=attrgetter("subprograms")),
        Figure("checks", take=lambda result: {check.key: check.state for check in result.checks}, after="remarks"),
    ]
    cl_files: tuple[Path, ...]
    simulation: Annotated[SimulationResult | None, Figure(after="checks")]
    remarks: Annotated[tuple[Problem, ...], Figure(after="steps")] = ()

    def __repr__(self) -> str:
        """Return what matters in a notebook."""
        return f"ImpellerCut(passed={self.passed}, {len(self.steps)} steps)"

    @property
    @Figure(after="name")
    def passed(self) -> bool:
        """Whether the program is proven, and what was simulated has no finding."""
        return self.result.passed and (self.simulation is None or self.simulation.passed)
