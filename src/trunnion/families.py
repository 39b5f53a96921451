"""The families of controls: where the writer and the reader of each stand. A new family is one entry here."""

from importlib import import_module
from typing import Any, Final, NamedTuple


class FamilyEntry(NamedTuple):
    """A family of controls.

    writer  module that writes its programs (``trunnion.controls.family_writer.FamilyWriter``)
    reader  module whose ``READER`` reads them (``trunnion.readers.program.family_reader.FamilyReader``), or None
    """

    writer: str
    reader: str | None


def _family(folder: str) -> FamilyEntry:
    return FamilyEntry(f"trunnion.output.families.{folder}.writer", f"trunnion.readers.families.{folder}.reader")


#: By the name that definitions give: ``family`` under ``[control]``.
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
    """The writer of a family; its module is imported when it is asked for, and no other."""
    return import_module(FAMILIES[family].writer)


def load_reader(family: str) -> Any:
    """Return the ``FamilyReader`` of a family that has one; importing its module loads no other family."""
    module = FAMILIES[family].reader
    assert module is not None, f"no reader of {family}"
    return import_module(module).READER
