"""How a Sinumerik is set: the table ``[control.reading]`` of its definition."""

from dataclasses import dataclass
from typing import Final

from trunnion.machines import Machine
from trunnion.readers.program.settings import reading_of

#: Whether the length of the edge in force counts in positions of the machine (G53, G153, SUPA).
WITH_LENGTH: Final = "with_length"
WITHOUT_LENGTH: Final = "without_length"


@dataclass(frozen=True, slots=True)
class Settings:
    """The settings of a control.

    cycles_along_tool  cycles turn the frame along the tool while TCP is on
    machine_positions  ``WITH_LENGTH`` or ``WITHOUT_LENGTH``; empty: the definition does not say
    """

    cycles_along_tool: bool = False
    machine_positions: str = ""


def settings_of(machine: Machine) -> Settings:
    """Read the settings of a machine's control; InputError if they are wrong."""
    table = reading_of(machine)
    settings = Settings(
        cycles_along_tool=table.flag("cycles_along_tool", False),
        machine_positions=table.text("machine_positions", "", one_of=("", WITH_LENGTH, WITHOUT_LENGTH)),
    )
    table.report_unread_keys()
    table.raise_problems()
    return settings
