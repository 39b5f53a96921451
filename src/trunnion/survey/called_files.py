"""Which files of a folder are subprograms that others beside them call: they are read through these.

In:     the files that were found, and how programs of each language call others.
Out:    the file that calls each of them, by its number. Nothing is run.
"""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Final

from trunnion.readers.program.family_reader import FamilyReader
from trunnion.survey.found_files import FileKind, FoundFile

#: So much of each program is searched for calls, bytes.
_MOST_BYTES: Final = 5_000_000


def callers(files: Sequence[FoundFile], readers: Mapping[str, FamilyReader]) -> dict[int, FoundFile]:
    """Return the file that calls another one of its folder, by the number of that one, which is a subprogram alone.

    readers   by language
    """
    named: dict[tuple[Path, str, str], list[int]] = {}
    for number, file, language, reader in _readings(files, readers):
        if reader.call_words is not None and reader.call_words.mark_of(file.path) is not None:
            named.setdefault((file.path.parent, language, reader.call_name(file.path.name)), []).append(number)
    subprograms = {number for numbers in named.values() for number in numbers}
    calls: dict[int, set[int]] = {}
    for number, file, language, reader in _readings(files, readers) if named else ():
        for called in _called(file.path, reader):
            calls.setdefault(number, set()).update(named.get((file.path.parent, language, called), ()))
    # Subprograms that only call each other are read by nobody.
    found: dict[int, FoundFile] = {}
    reached = [number for number in calls if number not in subprograms]
    while reached:
        number = reached.pop()
        new = sorted(calls.get(number, set()) - found.keys())
        found |= dict.fromkeys(new, files[number])
        reached += new
    return found


def _readings(
    files: Sequence[FoundFile], readers: Mapping[str, FamilyReader]
) -> Iterator[tuple[int, FoundFile, str, FamilyReader]]:
    """Yield each program with the languages that it may have."""
    for number, file in enumerate(files):
        if file.kind is FileKind.PROGRAM:
            for language in readers if file.languages is None else file.languages:
                if language in readers:
                    yield number, file, language, readers[language]


def _called(path: Path, reader: FamilyReader) -> frozenset[str]:
    """Return the names that a program calls."""
    text = b""
    with suppress(OSError), path.open("rb") as stream:
        text = stream.read(_MOST_BYTES)
    return reader.called(text)
