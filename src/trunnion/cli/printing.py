"""Lines on stdout and stderr."""

import sys

from trunnion.cli.terminal_text import severity_painted
from trunnion.errors import InputError, Problem
from trunnion.messages import Wording
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
        from trunnion.files.places import of_full_disk  # most that is printed finds its place

        reason = error.strerror or error
        wording = of_full_disk(error) or Wording("FIL230", "stdout_takes_no_more", strerror=reason)
        raise InputError(Problem("stdout", 0, wording)) from None
