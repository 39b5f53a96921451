"""A report into a file: the form by its suffix, written whole or not at all.

In:     a ``Verification`` and a path.
Out:    the file.
"""

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

from trunnion.errors import InputError, Problem
from trunnion.files import atomic_file
from trunnion.reporting.content import PlanDecision, ReportContent, collect_content
from trunnion.reporting.html_page import render_page
from trunnion.reporting.json_report import render_json
from trunnion.reporting.plot_series import PlotSeries, collect_series
from trunnion.verification.results import Verification


def write_report(
    verification: Verification, path: Path, *, control: str = "", made: str = "", decisions: Sequence[PlanDecision] = ()
) -> None:
    """Write a report: a page for ``.html``, data for ``.json``. The same input makes the same bytes.

    Parameters
    ----------
    verification
        What was found out about the program.
    path
        The file to write; one that exists is replaced when the new one is complete.
    control
        Name of the control as the report shows it; by default the key that the machine's definition names.
    made
        Text that says when, or by whom, the report was made. Nothing is said by default.
    decisions
        Why the program was planned as it is, in the order of its operations.

    Raises
    ------
    InputError
        When the suffix is another, or the file cannot be written.
    """
    render = RENDERERS.get(path.suffix.lower())
    if render is None:
        raise InputError(Problem(str(path), 0, "a report is HTML or JSON", "let the name end in .html or .json"))
    with atomic_file(str(path)) as sink:
        for piece in render(collect_content(verification, control, made, decisions), collect_series(verification)):
            sink.write(piece)


#: Suffix -> what makes the bytes, piece by piece.
RENDERERS: dict[str, Callable[[ReportContent, PlotSeries], Iterator[bytes]]] = {
    ".html": render_page,
    ".json": render_json,
}
