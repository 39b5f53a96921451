"""Papers and subprograms of the program before, which stay where a post does not write them again.

In:     a program that is complete, and the papers that are written about it.
Out:    a warning that names what stays.
"""

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Final

from trunnion.errors import Problem, Severity
from trunnion.files import OutputPlace
from trunnion.jobs.result_output import Target
from trunnion.messages import Wording
from trunnion.wording import counted

_MOST_NAMED: Final = 5


def left_over(target: Target, papers: Iterable[OutputPlace]) -> list[Problem]:
    """Return the warning; nothing where every file that earlier posts wrote is of this program."""
    files = target.files.left_over(papers)
    if not files:
        return []
    named = named_files(files, None if target.path is None else target.path.resolve().parent)
    one = len(files) == 1
    what = f"{named} {'is' if one else 'are'} of the program before"
    cure = f"write {'it' if one else 'them'} with this one, or delete {'it' if one else 'them'}"
    return [Problem(target.name, 0, what, cure, Severity.WARNING, code="FIL280")]


def kept_files(target: Target) -> list[Problem]:
    """Return a warning for each program that was edited since it was written, and that is kept under another name."""
    return [
        Problem(place.name, 0, Wording("FIL250", "kept", name=kept.path.name), severity=Severity.WARNING)
        for place, kept in target.files.kept
    ]


def named_files(files: Sequence[Path], folder: Path | None) -> str:
    """Return the names of the first files, with the paths of those outside a folder, and how many more there are."""
    names = [file.name if file.parent == folder else str(file) for file in files]
    more = f" and {counted(len(names) - _MOST_NAMED, 'more file')}" if len(names) > _MOST_NAMED else ""
    return f"{', '.join(names[:_MOST_NAMED])}{more}"
