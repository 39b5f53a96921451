"""``trunnion batch``: many files posted, converted, verified or simulated."""

from collections.abc import Iterator
from itertools import islice
from pathlib import Path
from typing import Final

from trunnion.batch.batch_run import run_batch
from trunnion.batch.cluster import Tls
from trunnion.batch.records import Record
from trunnion.batch.running import BatchResult
from trunnion.batch.worker_task import Status
from trunnion.cli.columns import padded
from trunnion.cli.many_files.counting_terminal import CountingTerminal
from trunnion.cli.printing import tell
from trunnion.cli.results import show
from trunnion.cli.wording import in_command_words, in_words
from trunnion.errors import InputError, Problem, argument_problem
from trunnion.jobs.job import Given
from trunnion.messages import Wording, word_said

#: Files that failed which are printed; the summary has all of them.
_MOST: Final = 200

#: Results that are printed as written by this run.
_MOST_WRITTEN: Final = 20

#: Codes of warnings that are printed, those of the most files.
_MOST_CODES: Final = 20

#: Columns of the widest file and code in a table.
_FILE_WIDTH: Final = 60
_CODE_WIDTH: Final = 12


def run(given: Given) -> int:
    """Run a batch; 0 if every file passed, else 1."""
    tls = [given.tls_ca, given.tls_cert, given.tls_key]
    if given.scheduler is None and any(tls):
        name = next(name for name in ("tls_ca", "tls_cert", "tls_key") if given.values[name])
        raise InputError(argument_problem(name, Wording("ARG130", "tls_without_scheduler")))
    files = (None if value is None else Path(value) for value in tls)
    try:
        result = run_batch(
            **given.arguments(),
            tls=Tls(*files) if any(tls) else None,
            written=[] if given.json in (None, "-") else [given.json],
            observer=CountingTerminal(),
        )
    except KeyboardInterrupt:
        tell(_said("batch_goes_on"))
        raise
    show(given, lambda: result, result_lines(result))
    return 0 if result.passed else 1


def result_lines(result: BatchResult) -> Iterator[str]:
    """Yield a batch in lines: what failed, what this run has written, and how many became what."""
    width = max((len(unit) for unit in result.jobs), default=0) if len(result.jobs) > 1 else 0
    if result.failed:
        job = f"{padded(_said('batch_job'), width)}  " if width else ""
        file, code = padded(_said("batch_file"), _FILE_WIDTH), padded(_said("batch_code"), _CODE_WIDTH)
        yield f"{job}{file}  {code}  {padded(_said('batch_line'), 4)}  {_said('batch_message')}"
    for record in islice(result.failures(), _MOST):
        yield (f"{record.job:<{width}}  " if width else "") + _row(record)
    if len(result.failed) > _MOST:
        yield _said("batch_more_files", count=len(result.failed) - _MOST)
    yield from _warnings(result)
    written = list(islice((name for record in result.written() for name in record.outputs), _MOST_WRITTEN + 1))
    if written:
        variant = "batch_written_with_others" if len(written) > _MOST_WRITTEN else "batch_written"
        yield _said(variant, names=tuple(written[:_MOST_WRITTEN]))
    parts = tuple(
        f"{result.counts[status]} {in_words(word_said(status))}" for status in Status if result.counts.get(status)
    )
    variant = "batch_end" if not result.done else "batch_end_judged" if result.store.is_exact else "batch_end_by_sizes"
    before = {"done": result.done} if result.done else {}
    yield _said(variant, count=len(result.units), parts=parts, place=result.store.label, **before)


def _said(variant: str, /, **parameters: object) -> str:
    """Return a line of the catalogue ``terminal``."""
    return in_words(Wording("terminal", variant, **parameters))


def _warnings(result: BatchResult) -> Iterator[str]:
    """Yield what is warned of, by codes, each with the first file that has it."""
    if result.warned:
        code, files = padded(_said("warning"), _CODE_WIDTH), padded(_said("batch_files"), 5, right=True)
        yield f"{code}  {files}  {_said('batch_first')}"
    for each in result.warned[:_MOST_CODES]:
        problem = each.problem
        at = f"{each.file}:{problem.line}" if problem.line and problem.file == each.file else each.file
        place = "" if problem.file == each.file else f"{problem.file}: "
        message = place + _message(problem)
        yield f"{each.code:<{_CODE_WIDTH}}  {each.files:>5}  {at}: {message}"
    if len(result.warned) > _MOST_CODES:
        yield _said("batch_more_codes", count=len(result.warned) - _MOST_CODES)


def _message(problem: Problem) -> str:
    """Return a message with its cure, as the results keep it: in English, for they are the same for everybody."""
    return in_command_words(f"{problem.what}; {problem.cure}".removesuffix("; "))


def _row(record: Record) -> str:
    problem = record.error
    if problem is None:
        return f"{record.file:<{_FILE_WIDTH}}  {'':<{_CODE_WIDTH}}        {in_words(word_said(record.status))}"
    at = f"{problem.file}:{problem.line}" if problem.line else problem.file
    place = "" if problem.file == record.file else f"{at}: "
    message = place + _message(problem)
    line = str(problem.line) if problem.line and not place else ""
    return f"{record.file:<{_FILE_WIDTH}}  {problem.code:<{_CODE_WIDTH}}  {line:>4}  {message}"
