"""Papers of a case: whether those that are there are still of the program as it is posted now.

In:     papers as they lie in the case, and as they come out in another folder.
Out:    those that are not, and why.
"""

import filecmp
import json
from collections.abc import Iterator
from pathlib import Path

from trunnion.errors import InputError
from trunnion.jobs.post.papers.manifests import verify_manifest
from trunnion.jobs.result_output import PaperFiles
from trunnion.messages import Wording, phrase
from trunnion.records import dataclass


@dataclass(frozen=True, slots=True)
class StalePaper:
    """A paper that is not of the program as it is now, and why."""

    file: Path
    why: Wording


def stale_papers(there: PaperFiles, now: PaperFiles) -> Iterator[StalePaper]:
    """Compare papers with those that come out now.

    Reports name files as they were called, so that two of one post differ: of a report only a manifest beside it can
    tell whether it is the one that was written.
    """
    new = now.by_name()
    for name, file in there.by_name().items():
        if not file.is_file():
            yield StalePaper(file, phrase("paper_missing"))
        elif name == "manifest":
            yield from _of_manifest(file, new[name], there.report)
        elif name != "report" and not filecmp.cmp(file, new[name], shallow=False):
            yield StalePaper(file, phrase("paper_differs"))


def _of_manifest(there: Path, now: Path, report: Path | None) -> Iterator[StalePaper]:
    try:
        checked = verify_manifest(there)
    except InputError as error:
        yield StalePaper(there, error.problems[0].wording)
        return
    if _content(there) != _content(now):
        yield StalePaper(there, phrase("paper_differs"))
    elif report is not None and any(each.fault and each.what == "report" for each in checked.files):
        yield StalePaper(report, phrase("paper_differs"))


def _content(manifest: Path) -> object:
    """Return what a manifest says, but for the report."""
    data = json.loads(manifest.read_bytes())
    return data | {"files": [each for each in data["files"] if each.get("what") != "report"]}
