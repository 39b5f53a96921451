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
from trunnion.cli.many_files.counting_terminal import CountingTerminal
from trunnion.cli.printing import tell
from trunnion.cli.results import show
from trunnion.cli.wording import in_command_words
from trunnion.errors import InputError, argument_problem
from trunnion.jobs.job import Given
from trunnion.messages import Wording
from trunnion.wording import counted

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
        tell("the batch goes on where it was stopped when it is run again")
        raise
    show(given, lambda: result, result_lines(result))
    return 0 if result.passed else 1


def result_lines(result: BatchResult) -> Iterator[str]:
    """Yield a batch in lines: what failed, what this run has written, and how many became what."""
    width = max((len(unit) for unit in result.jobs), default=0) if len(result.jobs) > 1 else 0
    if result.failed:
        job = f"{'job':<{width}}  " if width else ""
        yield f"{job}{'file':<{_FILE_WIDTH}}  {'code':<{_CODE_WIDTH}}  line  message"
    for record in islice(result.failures(), _MOST):
        yield (f"{record.job:<{width}}  " if width else "") + _row(record)
    if len(result.failed) > _MOST:
        yield f"and {len(result.failed) - _MOST} more; --summary FILE.sqlite has all of them"
    yield from _warnings(result)
    written = list(islice((name for record in result.written() for name in record.outputs), _MOST_WRITTEN + 1))
    if written:
        rest = " and others" if len(written) > _MOST_WRITTEN else ""
        yield f"written now: {', '.join(written[:_MOST_WRITTEN])}{rest}"
    parts = ", ".join(f"{result.counts[status]} {status}" for status in Status if result.counts.get(status))
    before = f"; {result.done} of them done before" if result.done else ""
    judged = "" if result.store.is_exact or not result.done else ", which are judged by their sizes"
    yield f"{counted(len(result.units), 'file')}: {parts}{before}; results in {result.store.label}{judged}"


def _warnings(result: BatchResult) -> Iterator[str]:
    """Yield what is warned of, by codes, each with the first file that has it."""
    if result.warned:
        yield f"{'warning':<{_CODE_WIDTH}}  {'files':>5}  the first"
    for each in result.warned[:_MOST_CODES]:
        problem = each.problem
        at = f"{each.file}:{problem.line}" if problem.line and problem.file == each.file else each.file
        place = "" if problem.file == each.file else f"{problem.file}: "
        message = in_command_words(f"{place}{problem.what}; {problem.cure}".removesuffix("; "))
        yield f"{each.code:<{_CODE_WIDTH}}  {each.files:>5}  {at}: {message}"
    if len(result.warned) > _MOST_CODES:
        yield f"and {counted(len(result.warned) - _MOST_CODES, 'code')} more; --summary FILE.sqlite has all of them"


def _row(record: Record) -> str:
    problem = record.error
    if problem is None:
        return f"{record.file:<{_FILE_WIDTH}}  {'':<{_CODE_WIDTH}}        {record.status}"
    at = f"{problem.file}:{problem.line}" if problem.line else problem.file
    place = "" if problem.file == record.file else f"{at}: "
    message = in_command_words(f"{place}{problem.what}; {problem.cure}".removesuffix("; "))
    line = str(problem.line) if problem.line and not place else ""
    return f"{record.file:<{_FILE_WIDTH}}  {problem.code:<{_CODE_WIDTH}}  {line:>4}  {message}"
