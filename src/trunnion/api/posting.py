"""Posting: toolpaths to one proven NC program.

In:     toolpaths, a machine, settings.
Out:    the program: planned, written, read back, run and compared with its toolpaths. A program that fails is not
        written unless it is forced.
"""

import io
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from trunnion.api.job import PostJob, prepare
from trunnion.api.observer import SILENT, Observer
from trunnion.api.planning import load_toolpaths, plan_program
from trunnion.api.proving import expectation, failure_notices, prove, refusal
from trunnion.api.reading import FilePath, MachineLike, ToolpathLike, as_machine
from trunnion.api.reports import check_report_name, write_report
from trunnion.api.settings import Settings
from trunnion.api.targets import OutputLike, Target, open_target, written_text
from trunnion.api.writing import read_back_while_writing, write
from trunnion.errors import InputError, Problem, Severity
from trunnion.model.motion import Decision, Motion, Plan
from trunnion.model.run import Run
from trunnion.model.toolpath import Toolpath
from trunnion.verification import Check, Verification, failures


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class PostResult:
    """A program that was posted.

    toolpaths     what it was made from
    plan          motions on the machine, decisions, problems
    verification  what the proof found; None: no reader knows the control, and nothing is proven (only with ``force``)
    problems      warnings about CL files, plan and program, and what ``force`` overruled
    output        file of the program; None: it was not written to a file
    subprograms   files of its subprograms
    """

    toolpaths: tuple[Toolpath, ...]
    plan: Plan
    verification: Verification | None
    problems: tuple[Problem, ...]
    output: Path | None
    subprograms: tuple[Path, ...]
    _memory: io.BytesIO | None

    def __repr__(self) -> str:
        """Return what matters in a notebook: the columns would fill pages."""
        rows = "not run" if self.run is None else f"{len(self.run)} motions"
        place = "" if self.output is None else f", output={str(self.output)!r}"
        return f"PostResult(passed={self.passed}, {rows}{place})"

    @property
    def passed(self) -> bool:
        """Whether the program is proven and may run."""
        overruled = any(problem.severity is Severity.ERROR for problem in self.problems)
        return self.verification is not None and self.verification.passed and not overruled

    @property
    def checks(self) -> tuple[Check, ...]:
        """The questions that were put to the program, and their answers; none where nothing is proven."""
        return () if self.verification is None else self.verification.checks

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
        return written_text(self.output, self._memory)

    def write_report(self, file: FilePath) -> None:
        """Write a report of the proof: a page that works offline (``.html``), or data (``.json``).

        Raises
        ------
        InputError
            When the name ends otherwise, the file cannot be written, or nothing was proven.
        """
        if self.verification is None:
            raise InputError(Problem(str(file), 0, "nothing was proven", "post for a control that has a reader"))
        write_report(self.verification, file, decisions=self.decisions)


def post(
    cl: ToolpathLike | Iterable[ToolpathLike],
    *,
    machine: MachineLike,
    output: OutputLike = None,
    settings: Settings | None = None,
    strict: bool = False,
    force: bool = False,
    explain: bool = False,
    report: FilePath | None = None,
    columns: bool = True,
    observer: Observer = SILENT,
) -> PostResult:
    """Post CL files as one NC program, and prove it.

    The program is planned and written, read back by an independent reader, run on the machine and compared with its CL
    files. It appears at ``output`` only when every check has passed.

    Parameters
    ----------
    cl
        CL files in the order in which they are cut: paths, or toolpaths that are already read.
    machine
        The name of a shipped machine, the path of a definition, or a ``Machine``.
    output
        File of the program, or a binary stream; None: the result has the text. A file appears whole or not at all,
        with the files of its subprograms.
    settings
        As ``--set`` takes them, by the same keys: ``{"title": "BLADE", "zero": (0, 0, 80), "tcp": "off"}``; see
        docs/commands.md.
    strict
        Raise an error for unknown CL statements instead of keeping them with a warning.
    force
        Write a program that must not run; its head says why. ``passed`` is then False.
    explain
        Record why the axes were planned as they are (``decisions``).
    report
        File of a report, ``.html`` or ``.json``, which is written even if the program is refused.
    columns
        Work out the columns of the verification: ``seconds`` (n,), ``tip_feed`` (n,) in mm/min and ``cl_line`` (n,). A
        report needs them; without them a program of any length takes little memory.
    observer
        Hears of the progress, of warnings, of the plan and of the proof.

    Returns
    -------
    PostResult
        ``passed``, ``checks``, ``run``, ``motions``, ``problems`` and the files.

    Raises
    ------
    InputError
        When a file, the machine or a setting cannot be used.
    RefusedError
        When the program must not run, as when an axis leaves its travel; nothing is written.
    ProofFailedError
        A ``RefusedError``: when a check fails. Its ``verification`` has the checks.

    Notes
    -----
    docs/checks.md has the derivation of each check and of its tolerance.

    Examples
    --------
    >>> import trunnion
    >>> result = trunnion.post("tests/golden/yl569/2_hub_rough.cls", machine="yl569", settings={"title": "HUB"})
    >>> result.passed, len(result.run)
    (True, 119)
    """
    if report is not None:
        check_report_name(report)
    place = None if report is None else Path(report)
    job = prepare(as_machine(machine), settings, force=force, explain=explain, report=place, columns=columns)
    with open_target(output) as target:
        job.subprograms(target.files, target.path)  # settings that contradict each other are found before any reading
        toolpaths = load_toolpaths(cl, job, strict, observer)
        return post_toolpaths(toolpaths, job, target, observer)


def post_toolpaths(toolpaths: Sequence[Toolpath], job: PostJob, target: Target, observer: Observer) -> PostResult:
    """Plan, write and prove a program; errors as ``post`` raises them."""
    subprograms = job.subprograms(target.files, target.path)
    with read_back_while_writing(target.files, job.machine, divided=subprograms is not None) as (progress, run):
        program, planned, problems = plan_program(toolpaths, job, observer)
        write(program, target.files.main, progress, subprograms, observer)
        expected = expectation(program, job.options)
    verification = None
    if (complete := run.result()) is None:
        problems.append(_nothing_checked(job, target))
        observer.problems(problems[-1:])
    else:
        verification = prove(complete, toolpaths, expected, columns=job.columns)
        verification = replace(verification, program=target.name)
        observer.verified(verification)
        if job.report is not None:
            write_report(verification, job.report, decisions=planned.decisions)
        failed = failures(verification)
        if failed and not job.force:
            raise refusal(verification, toolpaths[0].file)
        if failed:
            target.files.restart()
            notices = [*program.notices, *failure_notices(failed)]
            write(replace(program, notices=notices), target.files.main, subprograms=subprograms)
    remarks = [remark for toolpath in toolpaths for remark in toolpath.remarks]
    return PostResult(
        tuple(toolpaths), planned, verification, (*remarks, *problems), target.path, target.subprograms, target.memory
    )


def _nothing_checked(job: PostJob, target: Target) -> Problem:
    """The warning of a forced program that no reader can read."""
    lost = "" if job.report is None else ": there is no report"
    return Problem(
        target.name, 0, f"it is written by --force, and nothing has been checked{lost}", severity=Severity.WARNING
    )
