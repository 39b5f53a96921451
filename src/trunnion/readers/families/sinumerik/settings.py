"""How a Sinumerik is set: the table ``[control.reading]`` of its definition."""

from trunnion.machines import Machine
from trunnion.readers.program.settings import reading_of


def cycles_along_tool(machine: Machine) -> bool:
    """Read whether cycles turn the frame along the tool while TCP is on; InputError if the table is wrong."""
    table = reading_of(machine)
    along = table.flag("cycles_along_tool", False)
    table.report_unread_keys()
    table.raise_problems()
    return along
