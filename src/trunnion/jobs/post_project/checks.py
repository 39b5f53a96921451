"""What a project asks for once its programs are proven: the simulation of all set-ups, released programs, times.

In:     a project with the programs that were posted for it; none of them has its place yet.
Out:    what was found, as errors or warnings as the project judges it.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from trunnion.errors import Problem, Severity
from trunnion.jobs.inputs.simulation_input import SetupInput
from trunnion.jobs.observer import Observer, Untold
from trunnion.jobs.post.result import PostResult
from trunnion.jobs.post.writing import named_run
from trunnion.jobs.project.project import Division, Judgement, PostedSetup, Project
from trunnion.jobs.verify.comparing import diff
from trunnion.messages import Wording, foreign, phrase
from trunnion.model.run import Run
from trunnion.records import dataclass
from trunnion.verification import durations
from trunnion.wording import format_duration

if TYPE_CHECKING:  # imported where a project is simulated
    from trunnion.jobs.simulate.result import SimulationResult

#: Findings of a set-up that are told one by one.
_MOST_TOLD = 10

#: The severity of what a check finds.
_SEVERITIES = {Judgement.WARN: Severity.WARNING, Judgement.REFUSE: Severity.ERROR}


@dataclass(frozen=True, slots=True, eq=False)
class SetupFindings:
    """What was found of a set-up, as the project judges it, and its simulation; None: it was not simulated."""

    problems: tuple[Problem, ...]
    simulation: "SimulationResult | None"


class _Warned(Untold):
    """Passes on progress and warnings: errors are told as the project judges them, once."""

    def problems(self, problems: Sequence[Problem]) -> None:
        """As ``Observer`` has it."""
        self._observer.problems([each for each in problems if each.severity is Severity.WARNING])


def check_project(
    project: Project, posted: Sequence[tuple[PostedSetup, Sequence[PostResult]]], observer: Observer
) -> tuple["SimulationResult | None", list[SetupFindings]]:
    """Carry out the checks of a project.

    simulation  none: it is not asked for
    found       of every set-up of the project, in their order

    Raises ``InputError`` when a file of the simulation or a released program cannot be used.
    """
    checks = project.checks
    found = [list[Problem]() for _ in project.posted]
    own = [problems for problems, each in zip(found, project.posted, strict=True) if each is not None]
    for (setup, results), problems in zip(posted, own, strict=True):
        if checks.longest_s is not None:
            problems += _too_long(project, results)
        if checks.released is not Judgement.OFF and setup.released:
            severity = _SEVERITIES[checks.released]
            problems += [replace(each, severity=severity) for each in _compare_released(project, setup, results)]
    simulation = None if checks.simulate is Judgement.OFF else _simulate(project, posted, _Warned(observer))
    # A simulation that stops at the first finding has no results of the set-ups behind it.
    simulated = [] if simulation is None else list(simulation.setups or (simulation,))
    for one, problems in zip(simulated, found, strict=False):
        severity = _SEVERITIES[checks.simulate]
        problems += [replace(each, severity=severity) for each in _found(one, _shows(project))]
    lacking = [None] * (len(found) - len(simulated))
    return simulation, [
        SetupFindings(tuple(problems), one) for problems, one in zip(found, [*simulated, *lacking], strict=True)
    ]


def _shows(project: Project) -> Wording:
    """How to see all that the simulation of a project finds, which takes programs that are written: a phrase."""
    name = project.path.name
    if project.checks.simulate is Judgement.REFUSE:
        return phrase("simulate_after_mending", project=name)
    return phrase("simulate_once_written", project=name)


def _name(project: Project, result: PostResult) -> str:
    assert result.output is not None, "every program of a project has a file"
    return str(project.place_of(result.output))


def _run(project: Project, result: PostResult) -> Run:
    """Return the run of a program under the name that it will have."""
    assert result.run is not None, "nothing is posted here that nobody reads"
    return named_run(result.run, _name(project, result))


def _too_long(project: Project, results: Sequence[PostResult]) -> Iterator[Problem]:
    """Programs that take longer than they may."""
    longest = project.checks.longest_s
    assert longest is not None
    for result in results:
        assert result.verification is not None
        seconds, known = durations(result.verification)
        if seconds.sum() > longest:
            yield Problem(
                _name(project, result),
                0,
                Wording(
                    "PRJ230",
                    "takes_too_long" if known.all() else "takes_at_least_too_long",
                    time=format_duration(float(seconds.sum())),
                    longest=format_duration(longest),
                ),
            )


def _compare_released(
    project: Project, setup: PostedSetup, results: Sequence[PostResult]
) -> Iterator[Problem]:  # fmt: skip
    """Programs that move otherwise than the released ones."""
    if setup.division is not Division.OPERATIONS:
        pairs = [(results[0], setup.released[0], setup.released[1:])]
    else:
        pairs = [(result, released, ()) for result, released in zip(results, setup.released, strict=False)]
        if len(results) != len(setup.released):
            yield Problem(
                str(project.place_of(setup.output)),
                0,
                Wording("PRJ220", "other_number_of_programs", count=len(results), released=len(setup.released)),
            )
    for result, released, beside in pairs:
        run = _run(project, result)
        compared = diff(
            released, run, machine=run.machine, subprograms=[*beside, *setup.subprograms],
        )  # fmt: skip
        if not compared.same:
            yield Problem(
                _name(project, result),
                0,
                Wording("PRJ220", "moves_otherwise", released=Path(released).name, differences=tuple(compared.lines())),
            )


def _simulate(
    project: Project, posted: Sequence[tuple[PostedSetup, Sequence[PostResult]]], observer: Observer
) -> "SimulationResult":
    """Cut the stock in all set-ups one after another."""
    from trunnion.jobs.simulate.steps import simulate_setups

    waiting = iter(posted)
    setups = [
        each if setup is None else _with_runs(project, each, next(waiting)[1])
        for each, setup in zip(project.simulation.setups, project.posted, strict=True)
    ]
    return simulate_setups(replace(project.simulation, setups=setups), observer)


def _found(simulated: "SimulationResult", remedy: Wording) -> Iterator[Problem]:
    """Yield what a set-up must not do, each at its program and line; the ``remedy`` says how to see more of it."""
    # Each finding is a text of its own: papers that join what says the same must not hide a collision behind a gouge.
    for finding in simulated.findings[:_MOST_TOLD]:
        yield Problem(finding.file, finding.line, Wording("PRJ210", "simulation_finds", finding=foreign(str(finding))))
    if len(simulated.findings) > _MOST_TOLD:
        yield Problem(
            simulated.programs[0],
            0,
            Wording("PRJ210", "more_findings", count=len(simulated.findings), most=_MOST_TOLD, remedy=remedy),
        )
    yield from (remark for remark in simulated.remarks if remark.severity is Severity.ERROR)
    gouge = simulated.gouge
    if gouge is not None and gouge.largest > simulated.limit and not simulated.findings:
        yield Problem(
            simulated.programs[0], 0, Wording("PRJ210", "missing_from_part", largest=gouge.largest, remedy=remedy)
        )


def _with_runs(project: Project, setup: SetupInput, results: Sequence[PostResult]) -> SetupInput:
    """Return a set-up with the programs that have been posted for it, on their machine as it was set up."""
    toolpaths = [toolpath for result in results for toolpath in result.toolpaths]
    runs = [_run(project, result) for result in results]
    return replace(
        setup, programs=runs, machine=runs[0].machine, cl=toolpaths, cl_is_turned=True, subprograms=(), zero=None,
        tool_length=None,
    )  # fmt: skip
