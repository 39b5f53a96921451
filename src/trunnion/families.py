"""The registry of control families: the modules that write and read the programs of each.

A new family is one entry here, besides a folder for its writer, one for its reader, and a definition.
"""

from importlib import import_module
from typing import Any, Final, NamedTuple


class FamilyEntry(NamedTuple):
    """The modules of a control family, by their dotted names.

    writer  has all of ``trunnion.controls.family_writer.FamilyWriter``
    reader  has ``READER``, a ``trunnion.readers.program.family_reader.FamilyReader``; None: no reader yet
    """

    writer: str
    reader: str | None


def _family(folder: str) -> FamilyEntry:
    return FamilyEntry(f"trunnion.output.families.{folder}.writer", f"trunnion.readers.families.{folder}.reader")


#: By the key ``family`` of control definitions.
FAMILIES: Final[dict[str, FamilyEntry]] = {
    "sinumerik_840d": _family("sinumerik"),
    "linuxcnc": _family("linuxcnc"),
    "heidenhain_itnc530": _family("heidenhain"),
    "heidenhain_tnc640": _family("heidenhain"),
    "fidia_nc15": _family("fidia"),
    "fanuc_30i": _family("fanuc"),
}

#: The family of machines whose definition names no control.
DEFAULT_FAMILY: Final = "sinumerik_840d"


def load_writer(family: str) -> Any:
    """Return the writer of a family, a ``FamilyWriter``; importing its module loads no other family."""
    return import_module(FAMILIES[family].writer)


def load_reader(family: str) -> Any:
    """Return the ``FamilyReader`` of a family that has one; importing its module loads no other family."""
    module = FAMILIES[family].reader
    assert module is not None, f"no reader of {family}"
    return import_module(module).READER
