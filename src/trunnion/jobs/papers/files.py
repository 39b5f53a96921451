"""Where the papers of a post go: report, setup sheet, listing and manifest."""

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from trunnion.errors import InputError, Problem
from trunnion.jobs.inputs.reading import FilePath
from trunnion.jobs.papers.reports import check_report_name
from trunnion.jobs.targets import declared_output


@dataclass(frozen=True, slots=True)
class PaperFiles:
    """Where the papers of a post go; None: there is no such paper.

    report    ``.html`` or ``.json``
    sheet     the setup sheet, ``.html`` or ``.json``
    listing   of the motions, of any name
    manifest  ``.json``, beside the program
    """

    report: Path | None = None
    sheet: Path | None = None
    listing: Path | None = None
    manifest: Path | None = None

    def by_name(self) -> dict[str, Path]:
        """The papers that there are."""
        return {name: getattr(self, name) for name in PAPERS if getattr(self, name) is not None}

    @property
    def need_columns(self) -> bool:
        """Whether one of them takes the columns of the verification."""
        return any(each is not None for each in (self.report, self.sheet, self.manifest))


#: No papers at all.
NO_PAPERS: Final = PaperFiles()

#: The papers by their names, and what each is called in a sentence.
PAPERS: Final = {"report": "report", "sheet": "setup sheet", "listing": "listing", "manifest": "manifest"}


def paper_files(
    report: FilePath | None, sheet: FilePath | None, listing: FilePath | None, manifest: FilePath | None, output: object
) -> PaperFiles:
    """The papers of a post, whose places are found out before any work.

    Raises
    ------
    InputError
        If one is of an unknown form or cannot be written, or a manifest is not beside its program.
    """
    if report is not None:
        check_report_name(report)
    if sheet is not None:
        declared_output("post", "sheet", sheet)
    if manifest is not None:
        place = declared_output("post", "manifest", manifest)
        program = Path(output) if isinstance(output, str | os.PathLike) else None
        if program is None or program.parent.resolve() != Path(manifest).parent.resolve():
            cure = "name a file in the folder of the program, and write the program to a file"
            raise InputError(Problem(place.name, 0, "a manifest tells of the files beside it", cure, code="FIL320"))
    places = (None if each is None else Path(each) for each in (report, sheet, listing, manifest))
    return PaperFiles(*places)
