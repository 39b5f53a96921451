"""Programs in several files: a main program and the subprograms that it calls."""

import re
from collections.abc import Callable, Sequence
from typing import BinaryIO, Final

from trunnion.controls.definition import SubprogramNaming
from trunnion.errors import InputError, argument_problem
from trunnion.messages import Wording
from trunnion.records import dataclass
from trunnion.transliteration import spelled

#: Bytes of a file that are reserved for the end of an operation.
END_RESERVE_BYTES: Final = 4096

#: The smallest limit for a file: room for the end of an operation, and for some blocks.
MIN_SUBPROGRAM_BYTES: Final = 5 * END_RESERVE_BYTES

#: Characters that some control does not accept in a name.
_OTHER_CHARACTERS: Final = re.compile(r"[^A-Za-z0-9]+")

_BEGINS_WITH_LETTERS: Final = re.compile(r"[A-Za-z]{2}")

#: Names of devices on Windows, which no file can have.
DEVICE_NAME: Final = re.compile(r"CON|PRN|AUX|NUL|COM[0-9]|LPT[0-9]", re.IGNORECASE)

#: Precedes names that are not valid by themselves.
_PREFIX: Final = "OP"

_HIGHEST_NUMBER: Final = 9999


class SubprogramNames:
    """Gives out names that the control accepts, each once; ``taken`` are names in use."""

    def __init__(self, naming: SubprogramNaming, *taken: str) -> None:
        self._naming = naming
        self._taken = {name.upper() for name in taken}

    def unique(self, text: str) -> str:
        """Return a name made of ``text``: letters, digits and single underscores, with two letters first.

        Raises
        ------
        InputError
            If names are numbers, and none is left.

        Examples
        --------
        >>> SubprogramNames(SubprogramNaming(".SPF", True, 24), "PART").unique("Gehäuse-Schlichten (2)")
        'GEHAEUSE_SCHLICHTEN_2'
        """
        naming = self._naming
        if naming.first_number is not None:
            return self._unique_number(naming.first_number)
        plain = _OTHER_CHARACTERS.sub("_", spelled(text, "ascii")).strip("_")
        valid = (
            _BEGINS_WITH_LETTERS.match(plain)
            and not DEVICE_NAME.fullmatch(plain)
            and not plain.upper().startswith(naming.reserved_prefixes)
        )
        if not valid:
            plain = f"{_PREFIX}_{plain}".rstrip("_")
        plain = plain.upper() if naming.capitals else plain.lower()
        name, count = plain[: naming.max_length].rstrip("_"), 1
        while name.upper() in self._taken:
            count += 1
            suffix = f"_{count}"
            name = plain[: naming.max_length - len(suffix)].rstrip("_") + suffix
        self._taken.add(name.upper())
        return name

    def _unique_number(self, first: int) -> str:
        numbers = (f"{n:04d}" for n in range(first, _HIGHEST_NUMBER + 1))
        # The main program's file can have the name that a number would get.
        free = (name for name in numbers if not self._taken & {name, (self._naming.prefix + name).upper()})
        name = next(free, "")
        if not name:
            raise InputError(argument_problem("settings", Wording("ARG240", "no_program_numbers", first=first)))
        self._taken.add(name)
        return name


@dataclass(frozen=True, slots=True, eq=False)
class SubprogramOutput:
    """How to write a main program with one subprogram an operation.

    main_name  name of the main program's file, without its extension
    open_file  opens the file of a subprogram by its name
    max_bytes  size of a subprogram at most; a larger operation continues in further ones. None: no limit
    """

    main_name: str
    open_file: Callable[[str], BinaryIO]
    max_bytes: int | None = None


class SubprogramFiles:
    """The files of a program with subprograms.

    main_sink     of the main program
    current_name  of the subprogram that was opened last
    max_bytes     bytes up to which rows may fill a subprogram; None: no limit
    names         names of the files by their sinks
    """

    def __init__(
        self,
        output: SubprogramOutput,
        naming: SubprogramNaming,
        main_sink: BinaryIO,
        program: str,
        operations: Sequence[str],
    ) -> None:
        self.main_sink = main_sink
        self.current_name = ""
        self.names: dict[BinaryIO, str] = {}
        self.max_bytes = None if output.max_bytes is None else output.max_bytes - END_RESERVE_BYTES
        self._output, self._naming = output, naming
        number = f"{int(program):04d}" if program.isascii() and program.isdecimal() else program
        self._names = SubprogramNames(naming, output.main_name, number)
        # Operations get their names before any part of one does.
        self._operations = iter([self._names.unique(name) for name in operations])
        self._operation = ""

    def next_operation(self) -> BinaryIO:
        """Open the file of the next operation."""
        self._operation = next(self._operations)
        return self._open(self._operation)

    def next_part(self) -> BinaryIO:
        """Open another file for the same operation."""
        return self._open(self._names.unique(self._operation))

    def _open(self, name: str) -> BinaryIO:
        self.current_name = name
        file = self._naming.prefix + name + self._naming.extension
        sink = self._output.open_file(file)
        self.names[sink] = file
        return sink
