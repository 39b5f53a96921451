"""Programs that are refused: the error, and the report that is written all the same."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace

from trunnion.errors import Problem, TrunnionError
from trunnion.jobs.post.result import PostResult, ProofFailedError
from trunnion.jobs.post.stages import Posting, Proof
from trunnion.jobs.verify.reports import write_refusal


@contextmanager
def reported_refusals(posting: Posting) -> Iterator[None]:
    """Write the report of a program that is refused before its proof."""
    job, target = posting.job, posting.target
    try:
        yield
    except TrunnionError as error:
        if job.papers.report is not None:
            write_refusal(error.problems, job.machine, target.name, job.papers.report)
            target.files.remember_alone(job.papers.report)
        raise


def refused(posting: Posting, proof: Proof, result: PostResult) -> ProofFailedError:
    """Return the error for a program that fails its proof, once its report is written."""
    job, places = posting.job, posting.places
    assert proof.verification is not None
    result = replace(result, verification=places.explained(proof.verification, job.control))
    if job.papers.report is not None:
        result.write_report(job.papers.report)
        posting.target.files.remember_alone(job.papers.report)
    failed = "; ".join(f"{check.summary} ({check.key})" for check in result.checks if not check.passed)
    cause = places.cause(proof.failed, job.control)  # the template that is likely to be why
    what = "; ".join(filter(None, (f"the program fails its proof: {failed}", cause)))
    cure = "; ".join(filter(None, ("no program is written", job.forcing)))
    return ProofFailedError(Problem(result.toolpaths[0].file, 0, what, cure, code="CTL910"), result)
