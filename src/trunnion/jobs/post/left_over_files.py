"""Papers and subprograms of the program before, which stay where a post does not write them again.

In:     a program that is complete, and the papers that are written about it.
Out:    a warning that names what stays.
"""

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Final

from trunnion.errors import Problem, warning
from trunnion.files import OutputPlace
from trunnion.jobs.result_output import Target
from trunnion.messages import Wording

_MOST_NAMED: Final = 5


def left_over(target: Target, papers: Iterable[OutputPlace]) -> list[Problem]:
    """Return the warning; nothing where every file that earlier posts wrote is of this program."""
    files = target.files.left_over(papers)
    if not files:
        return []
    names, more = first_names(files, None if target.path is None else target.path.resolve().parent)
    if more:
        wording = Wording("FIL280", "many_files_left_over", files=names, count=more)
    elif len(names) > 1:
        wording = Wording("FIL280", "files_left_over", files=names)
    else:
        wording = Wording("FIL280", "file_left_over", file=names[0])
    return [warning(target.name, 0, wording)]


def kept_files(target: Target) -> list[Problem]:
    """Return a warning for each file that no job has written as it is, and that is kept under another name."""
    return [warning(place.name, 0, Wording("FIL250", "kept", name=kept.path.name)) for place, kept in target.files.kept]


def first_names(files: Sequence[Path], folder: Path | None) -> tuple[tuple[str, ...], int]:
    """Return the names of the first files, with the paths of those outside a folder, and how many more there are."""
    names = tuple(file.name if file.parent == folder else str(file) for file in files)
    return names[:_MOST_NAMED], max(0, len(names) - _MOST_NAMED)
