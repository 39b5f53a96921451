"""How a part is clamped against its drawing.

First the part is tilted about X of the program's coordinate system, then turned about Z of the machine frame, both
right-handed and about the workpiece zero.

Units: degrees, mm.
"""

from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.messages import Wording, phrase
from trunnion.model.rotations import about_x, about_z
from trunnion.records import dataclass

#: Angles and lengths that differ by less are the same: they are printed in thousandths.
SAME: Final = 2e-3


@dataclass(frozen=True, slots=True)
class Clamping:
    """How a part is clamped: turn and tilt, degrees in thousandths."""

    turn: float = 0.0
    tilt: float = 0.0

    @property
    def is_as_drawn(self) -> bool:
        """Whether the part is neither turned nor tilted."""
        return self.is_like(Clamping())

    @property
    def is_turned(self) -> bool:
        """Whether turn or tilt is more or less than whole turns, however little."""
        return self.turn % 360.0 != 0.0 or self.tilt % 360.0 != 0.0

    @property
    def rotation(self) -> Floats:
        """(3, 3): turns directions of the part as it is drawn into those of the part as it is clamped."""
        return np.asarray(about_z(self.turn) @ about_x(self.tilt))

    def is_like(self, other: "Clamping") -> bool:
        """Whether both are the same but for what is printed of an angle; whole turns count as none."""
        return are_one_angle(self.turn, other.turn) and are_one_angle(self.tilt, other.tilt)

    def then(self, turn: float, tilt: float) -> "Clamping | None":
        """How the part is clamped after it has been tilted and turned once more.

        None: that is no tilt with a turn behind it.
        """
        if tilt % 360.0 == 0.0:
            return Clamping(round(self.turn + turn, 3), self.tilt)
        if self.turn % 360.0 == 0.0:
            return Clamping(turn, round(self.tilt + tilt, 3))
        return None

    @property
    def said(self) -> Wording:
        """What is said behind *the part is*."""
        if self.is_as_drawn:
            return phrase("clamped_as_drawn")
        turn = number(self.turn % 360.0)
        if are_one_angle(self.tilt, 0.0):
            return phrase("turned_by", turn=turn)
        return phrase("tilted_and_turned_by", tilt=number(self.tilt), turn=turn)

    def __str__(self) -> str:
        """Return it in words, behind *the part is*."""
        return str(self.said)


def are_one_angle(one: float, other: float) -> bool:
    """Whether two angles, degrees, are the same but for whole turns and what is printed of them."""
    return abs((one - other + 180.0) % 360.0 - 180.0) < SAME


def number(value: float) -> str:
    """Degrees or mm in thousandths, as short as they can be written."""
    return f"{round(value, 3) + 0.0:.3f}".rstrip("0").removesuffix(".")


def clamping_data(clamping: Clamping | None) -> dict[str, float | None]:
    """Return the keys of a clamping in data, degrees; null: nobody said it."""
    if clamping is None:
        return {"turn_deg": None, "tilt_deg": None}
    return {"turn_deg": clamping.turn, "tilt_deg": clamping.tilt}
