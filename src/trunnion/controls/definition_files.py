"""Definitions of controls as files of their own, beside those of machines, which hold a control in ``[control]``."""

from pathlib import Path
from typing import Final

from trunnion.controls.loading import control_library
from trunnion.definitions import Table, load_table, own_keys
from trunnion.errors import InputError

#: Keys that only the definition of a machine has.
_MACHINE_KEYS: Final = frozenset({"schema", "axis", "spindle", "workpiece", "facts", "control"})

#: Keys that only the definition of a control has.
_CONTROL_KEYS: Final = frozenset(
    {
        "family", "extension", "format", "word", "codes", "coolant", "in_force", "statements", "settings",
        "setting_rules", "setting_meanings", "by_method", "tool_types", "phases", "arcs", "templates", "subprograms",
        "block_numbers", "reading", "known",
    }
)  # fmt: skip


def is_control_file(path: Path) -> bool:
    """Whether a definition file defines a control, and not a machine; a file that cannot be read is taken for neither.

    Its own keys tell, or else what it extends.
    """
    try:
        keys = own_keys(path)
        if keys & _MACHINE_KEYS or keys & _CONTROL_KEYS:
            return not keys & _MACHINE_KEYS
        return "family" in load_control_table(str(path))
    except InputError:
        return False


def load_control_table(name_or_path: str) -> Table:
    """Return the table of a shipped control, or of a file that defines one, with all that it extends.

    Raises ``InputError`` if there is no such definition, or it cannot be read.
    """
    return load_table(name_or_path, control_library(), kind="control")
