"""The families of controls: where the writer and the reader of each stand. A new family is one entry here."""

from collections.abc import Callable
from importlib import import_module
from typing import Any, Final, NamedTuple


class FamilyEntry(NamedTuple):
    """A family of controls.

    writer       module that writes its programs (``trunnion.controls.family_writer.FamilyWriter``)
    reader       module that reads them; None: nobody does
    interpreter  its class that runs a program
    """

    writer: str
    reader: str | None
    interpreter: str


def _family(folder: str, interpreter: str) -> FamilyEntry:
    return FamilyEntry(
        f"trunnion.output.families.{folder}.writer", f"trunnion.readers.families.{folder}.interpreter", interpreter
    )


#: By the name that definitions give: ``family`` under ``[control]``.
FAMILIES: Final[dict[str, FamilyEntry]] = {
    "sinumerik_840d": _family("sinumerik", "SinumerikInterpreter"),
    "linuxcnc": _family("linuxcnc", "LinuxcncInterpreter"),
    "heidenhain_itnc530": _family("heidenhain", "HeidenhainInterpreter"),
    "heidenhain_tnc640": _family("heidenhain", "HeidenhainInterpreter"),
    "fidia_nc15": _family("fidia", "FidiaInterpreter"),
    "fanuc_30i": _family("fanuc", "FanucInterpreter"),
}


def load_writer(family: str) -> Any:
    """The writer of a family; its module is imported when it is asked for, and no other."""
    return import_module(FAMILIES[family].writer)


def load_interpreter(family: str) -> Callable[..., Any]:
    """The interpreter of a family's programs, imported when it is asked for."""
    entry = FAMILIES[family]
    assert entry.reader is not None, f"no reader of {family}"
    interpreter: Callable[..., Any] = getattr(import_module(entry.reader), entry.interpreter)
    return interpreter
