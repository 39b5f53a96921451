"""Proving a program: its run is compared with its toolpaths, and simulated if that is asked for.

In:     a program that was written and read back.
Out:    its proof, and the result of the post, whose warnings have been reported.
"""

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from trunnion.errors import Problem, Severity, warning
from trunnion.jobs.observer import Untold
from trunnion.jobs.post.expected_values import Expectation
from trunnion.jobs.post.forced_program import write_forced
from trunnion.jobs.post.machining_times import operation_times
from trunnion.jobs.post.post_job import PostJob
from trunnion.jobs.post.result import PostResult
from trunnion.jobs.post.stages import PlannedProgram, Posting, Proof, WrittenProgram
from trunnion.jobs.post.writing import named_run, named_verification
from trunnion.jobs.verify.program_warnings import program_warnings, speed_warnings, stated_words
from trunnion.messages import Wording
from trunnion.model.operation_start import OperationStart
from trunnion.model.run import Run
from trunnion.output.compensation_entries import entries_at_control
from trunnion.verification import Verification, rows_from_starts, verify, without_columns
from trunnion.verification.skip_meanings import with_other_meanings

if TYPE_CHECKING:  # imported where a CL file states its stock
    from trunnion.simulation.stock.stated_stock import StatedStock


def prove(posting: Posting, written: WrittenProgram, expected: Expectation) -> Proof:
    """Return the proof of a program; one that fails and is forced is written again, with what failed in its head."""
    job, program = posting.job, written.planned.program
    prove_run = partial(_prove_run, posting, expected, job.columns or bool(program.time_token))
    proof = prove_run(written.run, written.starts)
    if job.force and proof.failed:
        proof = write_forced(posting, program, proof, prove_run)
    found = proof.verification
    times = operation_times(program, found) if program.time_token else []
    if found is not None and not job.columns:
        found = without_columns(found)
    return replace(proof, verification=found, times=times)


def _prove_run(
    posting: Posting, expected: Expectation, columns: bool, run: Run | None, starts: Sequence[OperationStart]
) -> Proof:
    """Return what verification and simulation find of a run."""
    found = None
    if run is not None:
        job, tolerances = posting.job, expected.tolerances
        found = verify(run, posting.toolpaths, tolerances=tolerances, settings=expected.settings, columns=columns)
        found = with_other_meanings(found, partial(_skipping, posting, expected), has_toolpaths=True)
        found = named_verification(found, posting.target.name, job.beside)
        found = replace(found, operations=rows_from_starts(run, found.operations, starts), clamping=job.clamping)
    return _simulate(posting, run, found)


def _skipping(posting: Posting, expected: Expectation, run: Run, left_out: frozenset[int] | None) -> Verification:
    """Return the proof of the program with blocks skipped, and the OPSKIP with these numbers; None: by itself."""
    settings = replace(expected.settings, left_out=left_out or frozenset())
    toolpaths, limits = ((), None) if left_out is None else (posting.toolpaths, expected.tolerances)
    return verify(run, toolpaths, tolerances=limits, settings=settings, columns=False)


def _simulate(posting: Posting, run: Run | None, found: Verification | None) -> Proof:
    """Return a proof with what the program cuts and hits, if that is asked for."""
    job = posting.job
    if job.simulation is None:
        return Proof(found)
    from trunnion.jobs.simulate.posted import simulate_posted, simulation_checks

    # What may get notices in its head is told when lines are those of the file that stays.
    observer = Untold(posting.observer) if job.force else posting.observer
    named = None if run is None else named_run(run, posting.target.name)
    simulated = simulate_posted(job.simulation, named, posting.toolpaths, observer)
    if found is not None:
        found = replace(found, checks=(*found.checks, *simulation_checks(simulated)))
    return Proof(found, simulated)


def report_proof(posting: Posting, planned: PlannedProgram, proof: Proof) -> PostResult:
    """Report what was found, and return the result of the post."""
    job, observer, found = posting.job, posting.observer, proof.verification
    problems = list(planned.problems)
    if found is None:
        problems.append(_nothing_checked(posting))
        observer.problems(problems[-1:])
    if proof.simulation is not None:
        if job.force:
            observer.problems(proof.simulation.remarks)
        problems += [remark for remark in proof.simulation.remarks if remark.severity is Severity.WARNING]
    if found is not None:
        words = program_warnings(found.run, stated_words(job.control, {**job.control.settings, **job.settings}))
        words += speed_warnings(found)
        problems += words
        observer.problems(words)
    remarks = [remark for toolpath in posting.toolpaths for remark in toolpath.remarks]
    if found is not None:
        observer.verified(replace(found, remarks=(*remarks, *problems)))
    toolpaths = tuple(posting.toolpaths)
    entered = tuple(entries_at_control(planned.program))
    return PostResult(
        toolpaths, planned.plan, found, (*remarks, *problems), simulation=proof.simulation, entered=entered,
        stated_stock=_stated_stock(job),
    )  # fmt: skip


def _stated_stock(job: PostJob) -> "StatedStock | None":
    """Return the stock that a CL file states; None where another one counts, or none does."""
    if not job.stock_from or job.stock is None or isinstance(job.stock, Path):
        return None
    from trunnion.simulation.stock.stated_stock import StatedStock  # few CL files state their stock

    return StatedStock(job.stock, job.stock_from)


def _nothing_checked(posting: Posting) -> Problem:
    """Return the warning of a forced program that no reader can read."""
    papers = posting.job.papers.by_name()
    without = tuple("setup sheet" if name == "sheet" else name for name in papers if name != "manifest")
    wording = (
        Wording("CTL930", "nothing_checked_no_papers", papers=without)
        if without
        else Wording("CTL930", "nothing_checked")
    )
    return warning(posting.target.name, 0, wording)
