"""Results on stdout."""

import sys

from trunnion.errors import InputError, Problem
from trunnion.wording import one_line, printable


def tell(*lines: str) -> None:
    """Print lines to stderr, each as one line: names in them may come from any file."""
    for line in lines:
        print(one_line(line), file=sys.stderr)


def print_result(*lines: str, end: str = "\n") -> None:
    """Print lines to stdout, without characters that a terminal obeys.

    Raises
    ------
    InputError
        If stdout takes no more, as on a disk that is full.
    BrokenPipeError
        If its reader has gone away.
    """
    try:
        print(*map(printable, lines), sep="\n", end=end)
        sys.stdout.flush()
    except BrokenPipeError:
        raise
    except OSError as error:
        what = f"cannot be written: {error.strerror or error}"
        raise InputError(Problem("stdout", 0, what, "let it go elsewhere", code="FIL230")) from None
