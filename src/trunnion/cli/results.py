"""Results on stdout."""

import sys
from collections.abc import Callable, Iterable

from trunnion.cli.terminal_text import severity_painted
from trunnion.errors import InputError, Problem
from trunnion.files import atomic_file
from trunnion.files.places import of_full_disk
from trunnion.jobs.job import Given
from trunnion.messages import Wording
from trunnion.results import as_json, to_data
from trunnion.wording import one_line, printable


def tell(*lines: str) -> None:
    """Print lines to stderr, each as one line: names in them may come from any file."""
    for line in lines:
        print(one_line(line), file=sys.stderr)


def tell_problem(line: str) -> None:
    """Print the line of a problem to stderr, with its severity in colour where that is a terminal."""
    print(severity_painted(one_line(line)), file=sys.stderr)


def print_result(*lines: str, end: str = "\n") -> None:
    """Print lines to stdout, without characters that a terminal obeys.

    Raises ``InputError`` if stdout takes no more, as on a disk that is full.

    Raises ``BrokenPipeError`` if its reader has gone away.
    """
    try:
        print(*map(printable, lines), sep="\n", end=end)
        sys.stdout.flush()
    except BrokenPipeError:
        raise
    except OSError as error:
        reason = error.strerror or error
        wording = of_full_disk(error) or Wording("FIL230", "stdout_takes_no_more", strerror=reason)
        raise InputError(Problem("stdout", 0, wording)) from None


def show(given: Given, result: Callable[[], object], lines: Iterable[str], *, aside: bool = False) -> None:
    """Print a result, as ``--json`` says: in lines, as data, or both where the data goes to a file.

    given   what the command was given
    result  makes the result, a record or plain data, if it is asked for as data
    lines   of text; beside data on stdout they are not printed
    aside   lines go to stderr: stdout has something else
    """
    if given.json == "-":
        print_result(as_json(to_data(result())))
        return
    (tell if aside else print_result)(*map(one_line, lines))
    if given.json is not None:
        with atomic_file(given.json, inputs=given.read) as sink:
            sink.write((as_json(to_data(result())) + "\n").encode())
