"""Programs that are refused: the error, and the report that is written all the same."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace

from trunnion.errors import Problem, TrunnionError
from trunnion.jobs.post.result import PostResult, ProofFailedError
from trunnion.jobs.post.stages import Posting, Proof
from trunnion.jobs.verify.reports import OfPost, write_post_report, write_refusal
from trunnion.messages import Wording


@contextmanager
def reported_refusals(posting: Posting) -> Iterator[None]:
    """Write the report of a program that is refused before its proof."""
    job, target = posting.job, posting.target
    try:
        yield
    except TrunnionError as error:
        if job.papers.report is not None:
            write_refusal(error.problems, job.machine, target.name, job.papers.report, posting.observer.words)
            target.files.remember_alone(job.papers.report)
        raise


def refused(posting: Posting, proof: Proof, result: PostResult) -> ProofFailedError:
    """Return the error for a program that fails its proof, once its report is written."""
    job, places = posting.job, posting.places
    assert proof.verification is not None
    result = replace(result, verification=places.explained(proof.verification))
    if job.papers.report is not None:
        assert result.proof is not None
        words = posting.observer.words
        write_post_report(result.proof, job.papers.report, OfPost(result.decisions, result.simulation), words)
        posting.target.files.remember_alone(job.papers.report)
    failed = tuple(f"{check.summary} ({check.key})" for check in result.checks if not check.passed)
    wording = Wording("CTL910", "can_be_forced" if job.can_force else "nothing_written", failed=failed)
    cause = places.cause(proof.failed)  # the template that is likely to be why
    if cause is not None:
        wording = wording.within("because", cause=cause)
    return ProofFailedError(Problem(result.toolpaths[0].file, 0, wording), result)
