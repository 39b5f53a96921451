"""How a TNC is set: the table ``[control.reading]`` of its definition."""

import re
from typing import Final

from trunnion.machines import Machine
from trunnion.readers.control.start_modes import check_start_modes
from trunnion.readers.program.declared_variables import read_variables
from trunnion.readers.program.forms import read_form
from trunnion.readers.program.settings import control_of, family_of, reading_of

#: How the reader takes the control to start.
START_MODES: Final = {"feed": "M137", "tilted plane": "PLANE RESET", "TCP": "M129"}

#: Parameters that all programs share.
VARIABLE: Final = re.compile(r"QR?(?:0|[1-9][0-9]{0,3})")


def variables_of(machine: Machine) -> dict[str, float]:
    """Return the values of parameters that a machine's control has when a program starts; InputError if wrong."""
    table = reading_of(machine)
    variables = read_variables(table, VARIABLE, "Q1600")
    read_form(table, family_of(machine))
    check_start_modes(table, START_MODES)
    table.flag("approach_without_side", False)  # asked for by approaches
    table.flag("m114", False)  # asked for by the control
    table.report_unread_keys()
    table.raise_problems()
    return variables


def has_m114(machine: Machine) -> bool:
    """Whether the control has M114, which places the tip at the ends of blocks."""
    return reading_of(machine).flag("m114", False)


def approaches_without_side(machine: Machine) -> bool:
    """Whether APPR with R0 approaches as RR does, for a tool without radius; other controls stop there."""
    return reading_of(machine).flag("approach_without_side", False)


def projected_angles(machine: Machine) -> str:
    """Return what the angles of PLANE PROJECTED mean on a control: ``turning``, ``rising``, or ``unknown``."""
    return control_of(machine).text("projected_angles", "unknown")
