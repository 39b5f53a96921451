"""What a control's definition says to readers; all else in it is for whoever writes programs."""

from functools import lru_cache
from importlib.resources import files

from trunnion.definitions import Table, resolve_extends
from trunnion.machines import Machine

#: The family of machines whose definition names no control.
USUAL = "sinumerik_840d"


@lru_cache(maxsize=8)
def family_of(machine: Machine) -> str:
    """Return the family of a machine's control."""
    return _control(machine).text("family", USUAL)


def reading_of(machine: Machine) -> Table:
    """Return the table ``reading`` of a machine's control, empty where it has none."""
    return _control(machine).table("reading")


def _control(machine: Machine) -> Table:
    return resolve_extends(machine.control.unread_copy(), files("trunnion").joinpath("controls", "library"))
