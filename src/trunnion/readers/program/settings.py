"""The settings that readers take from a control's definition; the rest of it concerns writing."""

from functools import lru_cache
from importlib.resources import files
from typing import Final

from trunnion.definitions import Table, resolve_extends
from trunnion.encoding import ENCODINGS
from trunnion.families import DEFAULT_FAMILY
from trunnion.machines import Machine
from trunnion.messages import Wording

#: Stands for the file of what is stated for one run, besides the definition.
GIVEN: Final = "(given)"

#: In ``[control.reading.words]``: the control does not have the word, or has it with another meaning.
UNKNOWN: Final = "unknown"


def family_of(machine: Machine) -> str:
    """Return the family of a machine's control."""
    return control_of(machine).text("family", DEFAULT_FAMILY)


def reading_of(machine: Machine) -> Table:
    """Return the table ``reading`` of a machine's control, empty where it has none."""
    return control_of(machine).table("reading")


def encoding_of(machine: Machine) -> str:
    """Return what names and texts of a control's programs are encoded in; empty where its definition does not say."""
    stated = control_of(machine).table("settings").to_dict().get("encoding")
    return stated if isinstance(stated, str) and stated in ENCODINGS else ""


def no_reading(machine: Machine) -> None:
    """Raise ``InputError`` for every key of the table ``reading``, where the family's reader asks for none."""
    table = reading_of(machine)
    for key in list(table.keys()):
        table.add_problem(key, Wording("DEF320", "unknown_key"))
    table.raise_problems()


def unit_of(table: Table) -> str:
    """Return the unit in which a control counts before a program states one: ``mm``, ``inch``, or nothing."""
    return table.text("units", "", one_of=("", "mm", "inch"))


def control_of(machine: Machine) -> Table:
    """Return the definition of a machine's control, with what it extends."""
    return _merged_control(machine).unread_copy()


@lru_cache(maxsize=8)  # a run asks some twenty times
def _merged_control(machine: Machine) -> Table:
    return resolve_extends(machine.control.unread_copy(), files("trunnion").joinpath("controls", "library"))
