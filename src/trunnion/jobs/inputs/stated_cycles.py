"""The setting ``open_cycle``: what becomes of cycles of the CL file that nothing ends."""

from collections.abc import Iterable, Mapping
from typing import Final

from trunnion.cl.open_cycles import OpenCycle
from trunnion.jobs.inputs.stated_by_operation import check_operations, stated_by_operation
from trunnion.model.toolpath import Toolpath

_KEY: Final = "open_cycle"

#: The code of what the reader says of such a cycle.
_OF_READER: Final = "CL840"


def stated_cycles(settings: Mapping[str, str]) -> dict[str, OpenCycle]:
    """Return what settings state, by operation; that of all others has no name.

    Raises ``InputError`` if the setting is none, or states two things of one operation.
    """
    return stated_by_operation(_KEY, settings, lambda text: OpenCycle(text) if text in [*OpenCycle] else None)


def check_stated_cycles(toolpaths: Iterable[Toolpath], settings: Mapping[str, str]) -> None:
    """Raise ``InputError`` for operations that are not there. One of which the reader has taken what is stated may
    have been joined to another one since.
    """
    found = list(toolpaths)
    remarks = [each for path in found for each in path.remarks if each.code == _OF_READER]
    taken = {str(each.wording.parameter("operation")) for each in remarks}
    check_operations(_KEY, {*stated_cycles(settings)} - taken, found)
