"""A report into a file: the form by its suffix, written whole or not at all.

In:     a ``Verification`` and a path.
Out:    the file.
"""

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

from trunnion.errors import InputError, Problem
from trunnion.files import whole
from trunnion.reporting.data import data
from trunnion.reporting.facts import Decided, Facts, facts
from trunnion.reporting.page import page
from trunnion.reporting.series import Series, series
from trunnion.verification.results import Verification


def write_report(
    verification: Verification, path: Path, *, control: str = "", made: str = "", decisions: Sequence[Decided] = ()
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
    form = FORMS.get(path.suffix.lower())
    if form is None:
        raise InputError(Problem(str(path), 0, "a report is HTML or JSON", "let the name end in .html or .json"))
    with whole(str(path)) as sink:
        for piece in form(facts(verification, control, made, decisions), series(verification)):
            sink.write(piece)


#: Suffix -> what makes the bytes, piece by piece.
FORMS: dict[str, Callable[[Facts, Series], Iterator[bytes]]] = {".html": page, ".json": data}
