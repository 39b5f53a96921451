"""Reports of a verification: a page or data."""

from collections.abc import Sequence
from pathlib import Path
from typing import Final

from trunnion import reporting
from trunnion.api.arguments import check_path, wrong_argument
from trunnion.api.reading import FilePath
from trunnion.errors import InputError, Problem
from trunnion.model.motion import Decision
from trunnion.verification import Verification

_SUFFIXES: Final = (".html", ".json")


def check_report_name(file: FilePath) -> None:
    """Raise ``InputError`` for a report of an unknown form, before any work."""
    if check_path("report", file).suffix.lower() not in _SUFFIXES:
        cure = f"let its name end in {' or '.join(_SUFFIXES)}"
        raise InputError(Problem(str(file), 0, "a report is a page or data", cure))


def write_report(verification: Verification, file: FilePath, *, decisions: Sequence[Decision] = ()) -> None:
    """Write a report of a verification: a page that works offline (``.html``), or data (``.json``).

    Parameters
    ----------
    verification
        Of ``trunnion.verify`` or ``trunnion.post``, with its columns.
    file
        An older file is replaced when the new one is complete.
    decisions
        Of the planner.

    Raises
    ------
    InputError
        When the name ends otherwise, the verification has no columns, or the file cannot be written.
    """
    if not isinstance(verification, Verification):
        raise wrong_argument("verification", verification, "give the result of trunnion.verify or trunnion.post")
    check_report_name(file)
    if len(verification.seconds) != len(verification.run):
        raise InputError(Problem(str(file), 0, "the verification has no columns", "ask for it with columns=True"))
    reporting.write_report(verification, Path(file), decisions=decisions)
