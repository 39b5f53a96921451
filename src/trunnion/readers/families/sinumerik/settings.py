"""How a Sinumerik is set: the table ``[control.reading]`` of its definition."""

import re
from collections.abc import Mapping
from dataclasses import field
from typing import Final

from trunnion.machines import Machine
from trunnion.readers.control.contour_control import FEED_BEFORE, FEED_BEHIND
from trunnion.readers.control.start_modes import ANGLES, VECTOR_FRAME, VECTORS, check_start_modes
from trunnion.readers.program.declared_variables import read_variables
from trunnion.readers.program.forms import read_form
from trunnion.readers.program.settings import family_of, reading_of, unit_of
from trunnion.records import dataclass

#: Whether the length of the edge in force counts in positions of the machine (G53, G153, SUPA).
WITH_LENGTH: Final = "with_length"
WITHOUT_LENGTH: Final = "without_length"

#: How the reader takes the control to start.
START_MODES: Final = {
    "distances": "G90", "plane": "G17", "compensation": "G40", "feed": "G94", "units": "G71", "TCP": "TRAFOOF",
    "tilted plane": "CYCLE800()", ANGLES: "ORIAXES", VECTORS: "ORIVECT", VECTOR_FRAME: "ORIWKS",
}  # fmt: skip

#: R parameters, variables of the control (GUD) and system variables, in capitals, with their index.
VARIABLE: Final = re.compile(r"R(?:0|[1-9][0-9]{0,4})|\$?[A-Z_][A-Z0-9_]+(?:\[[0-9]{1,5}(?:,[0-9]{1,5})*\])?")


@dataclass(frozen=True, slots=True)
class Settings:
    """The settings of a control.

    cycles_along_tool  cycles turn the frame along the tool while TCP is on
    machine_positions  ``WITH_LENGTH`` or ``WITHOUT_LENGTH``; empty: the definition does not say
    length_along_z     the tool length counts along Z in every working plane (SD42940 = 17), not across the plane
    swivel_axes        names of the rotary axes 1 and 2 of the swivel data; empty: the definition does not say
    corner_feed        of which block corners without a feed of their own have theirs, ``FEED_BEFORE`` or
                       ``FEED_BEHIND`` (MD20201); empty: the definition does not say
    unit               what the control counts in before a program says so, as ``unit_of`` returns it
    variables          values of variables that the control has when a program starts
    """

    cycles_along_tool: bool = False
    machine_positions: str = ""
    length_along_z: bool = False
    swivel_axes: tuple[str, ...] = ()
    corner_feed: str = ""
    unit: str = ""
    variables: Mapping[str, float] = field(default_factory=dict)


def settings_of(machine: Machine) -> Settings:
    """Read the settings of a machine's control; InputError if they are wrong."""
    table = reading_of(machine)
    settings = Settings(
        cycles_along_tool=table.flag("cycles_along_tool", False),
        machine_positions=table.text("machine_positions", "", one_of=("", WITH_LENGTH, WITHOUT_LENGTH)),
        length_along_z=table.flag("length_along_z", False),
        swivel_axes=table.texts("swivel_axes", ()),
        corner_feed=table.text("corner_feed", "", one_of=("", FEED_BEFORE, FEED_BEHIND)),
        unit=unit_of(table),
        variables=read_variables(table, VARIABLE, "R100"),
    )
    read_form(table, family_of(machine))
    check_start_modes(table, START_MODES)
    table.report_unread_keys()
    table.raise_problems()
    return settings
