"""Whether the points of several CL files are in one coordinate system."""

from collections.abc import Sequence
from typing import Final

from trunnion.errors import Problem
from trunnion.messages import Wording
from trunnion.model.toolpath import Frame, Toolpath

#: Numbers of a coordinate system are printed with five decimals or more.
_SAME: Final = 2e-5

_IDENTITY: Final = (1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0)


def other_system(toolpaths: Sequence[Toolpath]) -> Problem | None:
    """Return the first toolpath whose coordinate system differs from that of the first one, as a problem.

    Files of different systems may be different setups, and of most dialects it is not settled whether rows or columns
    are the axes: points are not turned into the system of another file. Beside an MSYS off the absolute system a file
    that states none would be moved by it.
    """
    if problem := _unstated_system(toolpaths):
        return problem
    for toolpath in toolpaths[1:]:
        pair = zip(toolpath.system or _IDENTITY, toolpaths[0].system or _IDENTITY, strict=True)
        if any(abs(a - b) > _SAME for a, b in pair):
            return Problem(
                toolpath.file, 0, Wording("CL430", "points_another_coordinate", toolpaths_file=toolpaths[0].file)
            )
    return None


def _unstated_system(toolpaths: Sequence[Toolpath]) -> Problem | None:
    """Return the first toolpath that does not state where its points are, beside one that is off the absolute
    system.
    """
    stating = [toolpath for toolpath in toolpaths if toolpath.states_system]
    off = next((each for each in stating if any(operation.frame != Frame() for operation in each.operations)), None)
    if off is None or len(stating) == len(toolpaths):
        return None
    other = next(toolpath for toolpath in toolpaths if not toolpath.states_system)
    return Problem(other.file, 0, Wording("CL430", "does_not_state", off_file=off.file))
