"""Lines on stdout and stderr."""

import sys
from collections.abc import Callable, Iterable

from trunnion.cli.columns import CodeLine, folded, width_of
from trunnion.cli.terminal_text import severity_painted
from trunnion.errors import InputError, Problem
from trunnion.messages import Wording
from trunnion.wording import one_line, printable


def tell(*lines: str) -> None:
    """Print lines to stderr, each as one line: names in them may come from any file."""
    for line in lines:
        print(*folded(one_line(line), width_of(sys.stderr)), sep="\n", file=sys.stderr)


def tell_problem(line: str) -> None:
    """Print the line of a problem to stderr, with its severity in colour where that is a terminal."""
    first, *further = folded(one_line(line), width_of(sys.stderr))
    print(severity_painted(first), *further, sep="\n", file=sys.stderr)


def print_lines(lines: Iterable[str]) -> None:
    """Print lines to stdout, each as one line, and on a terminal broken where it is too narrow.

    Raises what ``print_result`` raises.
    """
    wide = width_of(sys.stdout)
    print_result(*(piece for line in lines for piece in folded(_as_one_line(line), wide)))


def _as_one_line(line: str) -> str:
    """Return a text as one line, which stays code if it is."""
    return line if isinstance(line, CodeLine) and line.isprintable() else one_line(line)


def print_result(*lines: str, end: str = "\n", own: bool = False) -> None:
    """Print lines to stdout, without characters that a terminal obeys; texts that are Trunnion's own may be painted.

    Raises ``InputError`` if stdout takes no more, as on a disk that is full.

    Raises ``BrokenPipeError`` if its reader has gone away.
    """
    try:
        print(*(lines if own else map(printable, lines)), sep="\n", end=end)
        sys.stdout.flush()
    except BrokenPipeError:
        raise
    except OSError as error:
        from trunnion.files.places import of_full_disk  # most that is printed finds its place

        reason = error.strerror or error
        wording = of_full_disk(error) or Wording("FIL230", "stdout_takes_no_more", strerror=reason)
        raise InputError(Problem("stdout", 0, wording)) from None


def announce(ending: str, *, browser: bool) -> Callable[[str], None]:
    """Return what to do when a page can be opened: print its address and, unless told not to, open it.

    ending  a line that says what ends it
    """

    def ready(address: str) -> None:
        print(address, flush=True)
        print(ending, file=sys.stderr)
        if browser:
            import webbrowser  # no other command needs it

            webbrowser.open(address)

    return ready
