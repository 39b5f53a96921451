"""Programs in several files: a main program, and what the subprograms that it calls are named.

In:     the definition's ``[subprograms]``, and the operations that become subprograms.
Out:    names that the control takes, each once, and the files as they are begun.
"""

import re
import unicodedata
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import BinaryIO

from trunnion.controls.definition import Naming
from trunnion.errors import InputError, Problem

#: What no control minds in a name is all but these.
_STRANGE = re.compile(r"[^A-Za-z0-9]+")
_TWO_LETTERS = re.compile(r"[A-Za-z]{2}")

#: Names that Windows gives to devices: no file can have one.
_DEVICE = re.compile(r"CON|PRN|AUX|NUL|COM[0-9]|LPT[0-9]", re.IGNORECASE)

#: Stands before names that cannot stand alone.
_BEFORE = "OP"

#: Bytes of a file that are kept for what ends an operation.
ROOM_FOR_THE_END = 4096

#: The least that a file may hold at most: beside the room for the end, some blocks.
LEAST_SIZE = 5 * ROOM_FOR_THE_END


#: The highest number of a program with four digits.
_HIGHEST = 9999


class Names:
    """Gives names that the control takes, each once; ``taken`` are those that nobody may have."""

    def __init__(self, naming: Naming, *taken: str) -> None:
        self._naming = naming
        self._taken = {name.upper() for name in taken}

    def of(self, text: str) -> str:
        """A name for what people call ``text``: letters, digits and single low lines, and two letters first.

        >>> Names(Naming(".SPF", True, 24), "PART").of("Gehäuse-Schlichten (2)")
        'GEHAUSE_SCHLICHTEN_2'
        """
        naming = self._naming
        if naming.first is not None:
            return self._number(naming.first)
        letters = unicodedata.normalize("NFKD", text)
        plain = _STRANGE.sub("_", "".join(one for one in letters if not unicodedata.combining(one))).strip("_")
        alone = (
            _TWO_LETTERS.match(plain) and not _DEVICE.fullmatch(plain) and not plain.upper().startswith(naming.reserved)
        )
        if not alone:
            plain = f"{_BEFORE}_{plain}".rstrip("_")
        plain = plain.upper() if naming.capitals else plain.lower()
        name, count = plain[: naming.longest].rstrip("_"), 1
        while name.upper() in self._taken:
            count += 1
            end = f"_{count}"
            name = plain[: naming.longest - len(end)].rstrip("_") + end
        self._taken.add(name.upper())
        return name

    def _number(self, first: int) -> str:
        names = (f"{n:04d}" for n in range(first, _HIGHEST + 1))
        # The main program's file may be called as that of a number would be.
        free = (name for name in names if not self._taken & {name, (self._naming.before + name).upper()})
        name = next(free, "")
        if not name:
            raise InputError(
                Problem("--set", 0, f"no program numbers are left from {first:04d} on", "write programs=one")
            )
        self._taken.add(name)
        return name


@dataclass(frozen=True, slots=True)
class Division:
    """That a program is a main program with a subprogram for each operation.

    main     name of the main program's file, without its extension
    begin    begins the file of a subprogram, by its name
    largest  bytes of a subprogram at most, as far as rows can divide it; None: no matter how many
    """

    main: str
    begin: Callable[[str], BinaryIO]
    largest: int | None = None


class Files:
    """The files of a program that has several.

    main     sink of the main program
    open     name of the subprogram that was begun last
    largest  bytes that the rows of a subprogram may come to; None: no matter how many
    """

    def __init__(
        self, division: Division, naming: Naming, main: BinaryIO, program: str, operations: Sequence[str]
    ) -> None:
        self.main = main
        self.open = ""
        self.largest = None if division.largest is None else division.largest - ROOM_FOR_THE_END
        self._division, self._naming = division, naming
        number = f"{int(program):04d}" if program.isascii() and program.isdecimal() else program
        self._names = Names(naming, division.main, number)
        # All operations have their names before a part of one can take a name.
        self._operations = iter([self._names.of(name) for name in operations])
        self._operation = ""

    def next_operation(self) -> BinaryIO:
        """Begin the file of the next operation."""
        self._operation = next(self._operations)
        return self._begin(self._operation)

    def next_part(self) -> BinaryIO:
        """Begin another file for the same operation."""
        return self._begin(self._names.of(self._operation))

    def _begin(self, name: str) -> BinaryIO:
        self.open = name
        return self._division.begin(self._naming.before + name + self._naming.extension)
