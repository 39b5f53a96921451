"""The files that a project names, to read and to write: they lie beside the project or below, wherever links go."""

import re
from collections.abc import Callable
from pathlib import Path, PurePosixPath
from typing import Final

from trunnion.definitions import Table
from trunnion.definitions.extends import is_within
from trunnion.errors import InputError, Problem
from trunnion.files import name_fault
from trunnion.messages import Wording

#: Files that one key may name, and a project.
_MOST_FILES: Final = 1000
_MOST_NAMES: Final = 10_000

#: Characters of a name.
_LONGEST_NAME: Final = 1000


class ProjectPaths:
    """Turns names in a project into paths; mistakes become problems of the tables."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._count = 0

    def has_beside(self, name: str) -> bool:
        """Whether a file lies in the folder of the project; never asked of another folder."""
        return PurePosixPath(name).name == name and "\\" not in name and _answer(Path.is_file, self._folder / name)

    def files(
        self, table: Table, key: str, *, required: bool = False, is_text: Callable[[str], bool] | None = None
    ) -> tuple[str, ...]:
        """Return the paths of files that are read; what ``is_text`` says to be no name of a file, as it stands."""
        names = table.texts(key) if required else table.texts(key, ())
        if required and key in table and not names:
            table.add_problem(key, Wording("DEF330", "no_programs"))
        if len(names) > _MOST_FILES:
            table.add_problem(key, Wording("DEF330", "too_many_files", count=len(names), most=_MOST_FILES))
            return ()
        return tuple(name if is_text and is_text(name) else self.file(table, key, name) for name in names)

    def output(self, table: Table, key: str) -> Path | None:
        """Return the path of a file that a project writes; it lies beside the project or below.

        None: it is not stated.
        """
        name = table.text(key, "")
        if not name:
            if key in table and table.text(key, None) is not None:
                table.add_problem(key, Wording("DEF330", "no_output"))
            return None
        told = len(table.problems)
        location = self._located(table, key, name)
        if len(table.problems) > told:
            return location
        if name.endswith("/") or _answer(Path.is_dir, location):
            table.add_problem(key, Wording("DEF330", "output_is_folder", name=name[:100]))
        elif not _answer(Path.is_dir, location.parent):
            table.add_problem(key, Wording("FIL220", "no_such_folder_for", name=name[:100]))
        elif fault := name_fault(PurePosixPath(name)) or name_fault(self._behind_links(location)):
            table.add_problem(key, Wording("FIL340", "name_impossible", fault=fault))
        return location

    def _behind_links(self, location: Path) -> PurePosixPath:
        """Where a file of the folder is in it, behind all links."""
        return PurePosixPath(location.resolve().relative_to(self._folder.resolve()).as_posix())

    def file(self, table: Table, key: str, name: str) -> str:
        """Return the path of a file that is read; it lies beside the project or below."""
        if not name:
            if key in table:
                table.add_problem(key, Wording("DEF330", "names_nothing"))
            return ""
        told = len(table.problems)
        location = self._located(table, key, name)
        if len(table.problems) == told and not is_file(location):
            table.add_problem(key, Wording("DEF330", "names_no_file", name=name))
        return str(location)

    def _located(self, table: Table, key: str, name: str) -> Path:
        """Return the path that a name in a project leads to; one that leads out of its folder is a mistake."""
        self._count += 1
        if self._count > _MOST_NAMES:  # asking the system about each takes a while
            raise InputError(
                Problem(
                    *table.location(key),
                    Wording("PRJ110", "too_many_files", most=_MOST_NAMES).of_key(table.key_path(key)),
                )
            )
        pure = PurePosixPath(name)
        location = self._folder / pure
        if leads_out(name) or not is_within(location, self._folder):
            table.add_problem(key, Wording("DEF330", "leads_out_of_project", name=name[:100]))
            return self._folder / "outside"
        return location


def leads_out(name: str) -> bool:
    """Whether no project names a file so, wherever the file lies: it leads out of the folder, on one system or all."""
    pure = PurePosixPath(name)
    outside = pure.is_absolute() or ".." in pure.parts or len(name) > _LONGEST_NAME
    return outside or re.search(r"[\\:\x00-\x1f]", name) is not None


def is_file(location: Path) -> bool:
    """Whether a path is that of a file; one that is too long for the system, or a link that goes round, is not."""
    return _answer(Path.is_file, location)


def _answer(question: Callable[[Path], bool], location: Path) -> bool:
    try:
        return question(location)
    except (OSError, RuntimeError, ValueError):
        return False
