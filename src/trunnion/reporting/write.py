"""Writing a report to a file: its format by the suffix, the file whole or not at all.

In:     a ``Verification`` and a path.
Out:    the file.
"""

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

from trunnion.errors import InputError, Problem
from trunnion.files import atomic_file
from trunnion.machines import Machine
from trunnion.messages import LIBRARY, Wording, Words
from trunnion.model.motion import Decision
from trunnion.reporting.content import ReportContent, collect_content, refused_content
from trunnion.reporting.html_page import render_page
from trunnion.reporting.json_report import render_json
from trunnion.reporting.plot_series import PlotSeries, collect_series, no_series
from trunnion.verification.results import Verification


def write_report(
    verification: Verification, path: Path, *, control: str = "", made: str = "", decisions: Sequence[Decision] = ()
) -> None:
    """Write a report: a page for ``.html``, data for ``.json``. The same input gives the same bytes.

    verification  the result of checking the program, with columns (``trunnion.verification.verify``)
    path          the file to write. An existing one is replaced when the new one is complete
    control       name of the control for the report; by default the key in the machine's definition
    made          when or by whom the report was made, in words. By default the report does not mention it
    decisions     the decisions of the planner, in the order of its operations

    Raises ``InputError`` for any other suffix, and for a file that cannot be written.
    """
    pieces = render_report(path, collect_content(verification, control, made, decisions), collect_series(verification))
    with atomic_file(path) as sink:
        sink.writelines(pieces)


def render_report(path: Path, content: ReportContent, series: PlotSeries, words: Words = LIBRARY) -> Iterator[bytes]:
    """Return the bytes of a report of what was collected, piece by piece, in the words of who asks.

    Raises as ``write_report`` does, but writes nothing.
    """
    return _renderer(path)(content, series, words)


def write_refusal(
    problems: Sequence[Problem], machine: Machine, program: str, path: Path, words: Words = LIBRARY
) -> None:
    """Write the report of a program that was refused before it was run.

    problems          why; warnings too
    machine, program  for which machine, and what the program would have been called
    path              as ``write_report`` has it

    Raises ``InputError`` for any other suffix, and for a file that cannot be written.
    """
    pieces = render_report(path, refused_content(machine, program, problems), no_series(), words)
    with atomic_file(path) as sink:
        sink.writelines(pieces)


def _renderer(path: Path) -> Callable[[ReportContent, PlotSeries, Words], Iterator[bytes]]:
    """Return what makes a report of the form that a name asks for."""
    render = RENDERERS.get(path.suffix.lower())
    if render is None:
        raise InputError(Problem(str(path), 0, Wording("PAG310", "report_html_json")))
    return render


#: Suffix -> the function that yields the bytes, piece by piece.
RENDERERS: dict[str, Callable[[ReportContent, PlotSeries, Words], Iterator[bytes]]] = {
    ".html": render_page,
    ".json": render_json,
}
