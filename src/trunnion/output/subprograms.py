"""Programs in several files: a main program, and what the subprograms that it calls are named.

In:     the definition's ``[subprograms]``, and the operations that become subprograms.
Out:    names that the control takes, each once, and the files as they are begun.
"""

import re
import unicodedata
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import BinaryIO

from trunnion.controls.definition import SubprogramNaming
from trunnion.errors import InputError, Problem

#: What no control minds in a name is all but these.
_OTHER_CHARACTERS = re.compile(r"[^A-Za-z0-9]+")
_BEGINS_WITH_LETTERS = re.compile(r"[A-Za-z]{2}")

#: Names that Windows gives to devices: no file can have one.
_DEVICE_NAME = re.compile(r"CON|PRN|AUX|NUL|COM[0-9]|LPT[0-9]", re.IGNORECASE)

#: Stands before names that cannot stand alone.
_PREFIX = "OP"

#: Bytes of a file that are kept for what ends an operation.
END_RESERVE_BYTES = 4096

#: The least that a file may hold at most: beside the room for the end, some blocks.
MIN_SUBPROGRAM_BYTES = 5 * END_RESERVE_BYTES


#: The highest number of a program with four digits.
_HIGHEST_NUMBER = 9999


class SubprogramNames:
    """Gives names that the control takes, each once; ``taken`` are those that nobody may have."""

    def __init__(self, naming: SubprogramNaming, *taken: str) -> None:
        self._naming = naming
        self._taken = {name.upper() for name in taken}

    def unique(self, text: str) -> str:
        """A name for what people call ``text``: letters, digits and single low lines, and two letters first.

        >>> SubprogramNames(SubprogramNaming(".SPF", True, 24), "PART").unique("Gehäuse-Schlichten (2)")
        'GEHAUSE_SCHLICHTEN_2'
        """
        naming = self._naming
        if naming.first_number is not None:
            return self._number(naming.first_number)
        letters = unicodedata.normalize("NFKD", text)
        plain = _OTHER_CHARACTERS.sub("_", "".join(one for one in letters if not unicodedata.combining(one))).strip("_")
        alone = (
            _BEGINS_WITH_LETTERS.match(plain)
            and not _DEVICE_NAME.fullmatch(plain)
            and not plain.upper().startswith(naming.reserved_prefixes)
        )
        if not alone:
            plain = f"{_PREFIX}_{plain}".rstrip("_")
        plain = plain.upper() if naming.capitals else plain.lower()
        name, count = plain[: naming.max_length].rstrip("_"), 1
        while name.upper() in self._taken:
            count += 1
            end = f"_{count}"
            name = plain[: naming.max_length - len(end)].rstrip("_") + end
        self._taken.add(name.upper())
        return name

    def _number(self, first: int) -> str:
        names = (f"{n:04d}" for n in range(first, _HIGHEST_NUMBER + 1))
        # The main program's file may be called as that of a number would be.
        free = (name for name in names if not self._taken & {name, (self._naming.prefix + name).upper()})
        name = next(free, "")
        if not name:
            raise InputError(
                Problem("--set", 0, f"no program numbers are left from {first:04d} on", "write programs=one")
            )
        self._taken.add(name)
        return name


@dataclass(frozen=True, slots=True)
class SubprogramOutput:
    """That a program is a main program with a subprogram for each operation.

    main_name  name of the main program's file, without its extension
    open_file  begins the file of a subprogram, by its name
    max_bytes  bytes of a subprogram at most, as far as rows can divide it; None: no matter how many
    """

    main_name: str
    open_file: Callable[[str], BinaryIO]
    max_bytes: int | None = None


class SubprogramFiles:
    """The files of a program that has several.

    main_sink  sink of the main program
    current_name  name of the subprogram that was begun last
    max_bytes  bytes that the rows of a subprogram may come to; None: no matter how many
    """

    def __init__(
        self,
        output: SubprogramOutput,
        naming: SubprogramNaming,
        main: BinaryIO,
        program: str,
        operations: Sequence[str],
    ) -> None:
        self.main_sink = main
        self.current_name = ""
        self.max_bytes = None if output.max_bytes is None else output.max_bytes - END_RESERVE_BYTES
        self._output, self._naming = output, naming
        number = f"{int(program):04d}" if program.isascii() and program.isdecimal() else program
        self._names = SubprogramNames(naming, output.main_name, number)
        # All operations have their names before a part of one can take a name.
        self._operations = iter([self._names.unique(name) for name in operations])
        self._operation = ""

    def next_operation(self) -> BinaryIO:
        """Begin the file of the next operation."""
        self._operation = next(self._operations)
        return self._begin(self._operation)

    def next_part(self) -> BinaryIO:
        """Begin another file for the same operation."""
        return self._begin(self._names.unique(self._operation))

    def _begin(self, name: str) -> BinaryIO:
        self.current_name = name
        return self._output.open_file(self._naming.prefix + name + self._naming.extension)
