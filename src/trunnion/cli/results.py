"""Results on stdout, in lines or as data."""

from collections.abc import Callable, Iterable

from trunnion.cli.printing import print_lines, print_result, tell
from trunnion.files import atomic_file
from trunnion.jobs.job import Given
from trunnion.results import as_json, to_data


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
    if aside:
        tell(*lines)
    else:
        print_lines(lines)
    if given.json is not None:
        with atomic_file(given.json, inputs=given.read) as sink:
            sink.write((as_json(to_data(result())) + "\n").encode())
