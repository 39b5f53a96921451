"""The subprograms that a program may call."""

import re
from collections.abc import Iterable, Sequence
from pathlib import Path

from trunnion.errors import InputError, Problem, unusable_file
from trunnion.messages import Wording, phrase


class Subprograms:
    """The files that a program may call, by name: those given by the user, and no others.

    suffixes   endings of program names on this control, in order of precedence; "" for none
    prefix     what the control may put before a name
    """

    def __init__(self, files: Sequence[Path], suffixes: Sequence[str], prefix: str = "") -> None:
        self._suffixes = tuple(suffixes)
        self._prefix = prefix
        self._files: dict[str, Path] = {}
        problems = []
        found: dict[tuple[str, int], Path] = {}
        for path in files:
            key = self.key(path.name)
            if unusable := unusable_file(path, phrase("file_of_program")):
                problems.append(unusable)
            elif key is None:
                endings = ", ".join(suffix for suffix in self._suffixes if suffix)
                problems.append(Problem(str(path), 0, Wording("NC130", "not_a_subprogram_name", endings=endings)))
            elif (first := found.setdefault(key, path)) is not path:
                problems.append(Problem(str(path), 0, Wording("NC130", "same_name", first=first)))
        if problems:
            raise InputError(problems)
        for (stem, _), path in sorted(found.items(), key=lambda each: each[0][1]):
            self._files.setdefault(stem, path)

    def find(self, name: str) -> Path | None:
        """Return the file of a subprogram, or None; case, ending and prefix of the name do not matter.

        Folders of the control are not those of this computer: only the last part of a path counts.
        """
        parts = [part for part in re.split(r"[/\\:]", name.strip()) if part]
        if not parts or ".." in parts or len(name) > 200:
            return None
        return self._files.get(self._stem(parts[-1]))

    def key(self, name: str) -> tuple[str, int] | None:
        """Return the name of a file as it is called, and the index of its suffix; None if no program calls it so."""
        upper = name.upper()
        for k, suffix in enumerate(self._suffixes):
            if upper.endswith(suffix) if suffix else "." not in upper:
                return self._stem(name), k
        return None

    def _stem(self, name: str) -> str:
        stem = name.upper()
        for suffix in self._suffixes:
            stem = stem.removesuffix(suffix)
        return stem.removeprefix(self._prefix)


def callable_files(files: Iterable[Path], suffixes: Sequence[str], prefix: str = "") -> tuple[Path, ...]:
    """Return the files whose names the control can call, the first of each name; arguments as in ``Subprograms``."""
    named = Subprograms((), suffixes, prefix)
    found: dict[tuple[str, int], Path] = {}
    for path in files:
        if (key := named.key(path.name)) is not None:
            found.setdefault(key, path)
    return tuple(found.values())
