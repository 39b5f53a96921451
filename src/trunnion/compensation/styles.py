"""How controls round outer corners under radius compensation, and how they come to the contour and leave it."""

import math
from enum import StrEnum
from typing import Final

from trunnion.records import dataclass


class Corner(StrEnum):
    """What is inserted at an outer corner.

    ARC      a circle about the corner
    MEET     both equidistants go on to where they meet, up to ``sharpest``; sharper corners get a circle
    CHAMFER  the same along the tangents; sharper corners are cut off square, a radius behind the corner
    """

    ARC = "arc"
    MEET = "meet"
    CHAMFER = "chamfer"


class Entry(StrEnum):
    """Where the first line under compensation ends.

    SQUARE  square to the start of the contour, beside its first point; the last line begins square to its end
    OWN     where a contour line in its place would end, with the corner behind it; the last line begins as with SQUARE
    """

    SQUARE = "square"
    OWN = "own"


@dataclass(frozen=True, slots=True)
class CompensationStyle:
    """How a control compensates.

    sharpest  greatest change of direction at which equidistants go on to where they meet, radians
    smooth    a change of direction that is no corner: the next element begins where the one before it ends, radians
    """

    corner: Corner = Corner.ARC
    entry: Entry = Entry.SQUARE
    sharpest: float = 0.5 * math.pi
    smooth: float = 1e-6


#: ``ModalState.compensation_style`` of a control of which no manual says it, or of modes that are not simulated.
UNKNOWN_STYLE: Final = 0

#: Heidenhain, and Sinumerik with G450; Sinumerik with G451, up to the angle of its machine data MD20210 as it is
#: shipped; Fanuc and Haas, type A; LinuxCNC.
CIRCLES: Final = 1
MEETINGS: Final = 2
TYPE_A: Final = 3
OWN_ENTRY: Final = 4

#: As far from corners as any known control goes.
WIDEST: Final = CompensationStyle(Corner.CHAMFER, sharpest=math.radians(100.0))

#: Styles by ``ModalState.compensation_style``.
STYLES: Final = {
    CIRCLES: CompensationStyle(),
    MEETINGS: CompensationStyle(Corner.MEET, sharpest=math.radians(100.0)),
    TYPE_A: CompensationStyle(Corner.CHAMFER),
    OWN_ENTRY: CompensationStyle(Corner.ARC, Entry.OWN, smooth=0.05),
}
