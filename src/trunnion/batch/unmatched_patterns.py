"""Why a pattern matches no file although there is one: what a batch leaves out."""

import os
from pathlib import Path, PurePosixPath

from trunnion.batch.patterns import matches
from trunnion.batch.records import FOLDER
from trunnion.definitions.extends import is_within
from trunnion.jobs.project.paths import is_file
from trunnion.messages import Wording, phrase

#: Files that are looked at.
_MOST = 100_000


def unmatched(folder: Path, pattern: str, results: Path | None) -> Wording | None:
    """Which file of a folder a pattern means that is none of the inputs, and why; None: there is none."""
    looked = 0
    for at, folders, names in os.walk(folder):
        here = PurePosixPath(Path(at).relative_to(folder).as_posix())
        for name in sorted([*folders, *names]):
            looked += 1
            if looked > _MOST:
                return None
            file = (here / name).as_posix()
            if matches(file, pattern) and (why := _reason(folder, file, results)):
                return why
        if any((Path(at) / name).is_symlink() and _leads_there(here / name, pattern) for name in folders):
            return phrase("links_folders_not", pattern=pattern[:200])
    return None


def _leads_there(link: PurePosixPath, pattern: str) -> bool:
    """Whether a pattern begins with the name of a link."""
    return pattern.removeprefix("./").startswith(f"{link.as_posix()}/")


def _reason(folder: Path, file: str, results: Path | None) -> Wording | None:
    path, named = folder / file, file[:200]
    if path.is_symlink() and not is_within(path, folder):
        return phrase("link_out_of_folder", file=named)
    if not is_file(path):
        return None if path.is_dir() else phrase("not_read_to_end", file=named)
    if any(part.startswith(".") for part in PurePosixPath(file).parts):
        return phrase("hidden_file", file=named)
    above = [folder / each for each in PurePosixPath(file).parents][:-1]
    if any((each / FOLDER).is_dir() or (results is not None and _is_same(each, results)) for each in above):
        return phrase("among_results", file=named)
    return None


def _is_same(one: Path, other: Path) -> bool:
    return one.resolve() == other.resolve()
