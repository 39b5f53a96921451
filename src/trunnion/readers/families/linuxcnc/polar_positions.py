"""Positions by radius and angle: ``@`` and ``^``."""

import math
from typing import Final

from trunnion.messages import Wording
from trunnion.readers.control.axis_word import AxisWord, PositionMode
from trunnion.readers.families.linuxcnc import words
from trunnion.readers.families.linuxcnc.control import LinuxcncControl
from trunnion.readers.rs274.block import Block
from trunnion.readers.rs274.expressions import BlockError

#: The radius about zero, and the angle from X to Y in degrees.
SIGNS: Final = ("@", "^")


def polar_words(block: Block, control: LinuxcncControl, motion_code: int) -> dict[str, AxisWord]:
    """Return X and Y as a block states them by ``@`` and ``^``; nothing without these. What is left out stays.

    With G91 both count from where the tool is.

    motion_code  of the block

    Raises ``BlockError`` for what LinuxCNC refuses, and for an increment
    that repeats itself: each time it leads to another place.
    """
    radius, angle = block.take("@"), block.take("^")
    if radius is None and angle is None:
        return {}
    if beside := next((letter for letter in "XY" if letter in block.words), ""):
        raise BlockError(Wording("NC210", "polar_beside", word=beside))
    if control.plane_axis != 2 or words.MACHINE in block.g or motion_code in words.SPLINES:
        raise BlockError(Wording("NC210", "polar_only_in_plane"))
    x, y = control.position()[:2] / control.length_unit
    repeats = block.words.get("L")
    if not control.absolute:
        if x == y == 0.0:
            raise BlockError(Wording("NC210", "polar_from_zero"))
        if repeats is not None and repeats.value > 1.0:
            raise BlockError(Wording("NC210", "polar_repeats"))
    here = math.hypot(x, y), math.degrees(math.atan2(y, x))
    before = (0.0, 0.0) if control.absolute else here
    length = here[0] if radius is None else radius + before[0]
    turned = math.radians(here[1] if angle is None else angle + before[1])
    return {
        "X": (length * math.cos(turned), PositionMode.ABSOLUTE),
        "Y": (length * math.sin(turned), PositionMode.ABSOLUTE),
    }
