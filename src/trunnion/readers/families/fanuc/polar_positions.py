"""Positions by radius and angle: G16."""

import math

from trunnion.messages import Wording
from trunnion.readers.control.axis_word import AxisWord, PositionMode
from trunnion.readers.control.row_recorder import MAX_POSITION
from trunnion.readers.families.fanuc.control import FanucControl
from trunnion.readers.rs274.block import Number
from trunnion.readers.rs274.expressions import BlockError


class PolarPositions:
    """Positions of the working plane whose words are a radius about its zero and an angle, each of which stays.

    on   G16 is in force
    """

    def __init__(self, control: FanucControl) -> None:
        self._control = control
        self.on = False
        self._radius = self._angle = math.nan

    def switch(self, on: bool) -> None:
        """Begin or end such positions."""
        self.on = on
        self._radius = self._angle = math.nan

    @property
    def letters(self) -> tuple[str, str]:
        """The axes of the working plane, whose words are radius and angle."""
        plane = self._control.plane_axis
        return "XYZ"[(plane + 1) % 3], "XYZ"[(plane + 2) % 3]

    def position(self, axes: dict[str, AxisWord], repeats: Number | None) -> dict[str, AxisWord]:
        """Return the axes of a block with the position that its radius and angle make; ``repeats``: of a cycle.

        With G91 an angle counts from the last one; a radius would count from where the tool is.
        """
        (first, second), absolute = self.letters, self._control.absolute
        if not axes.keys() & {first, second}:
            return axes
        if not absolute and (first in axes or (repeats is not None and repeats.value > 1.0)):
            raise BlockError(Wording("NC220", "polar_increments"))
        if first in axes:
            self._radius = axes[first][0]
        if second in axes:
            self._angle = axes[second][0] + (0.0 if absolute else self._angle)
        if math.isnan(self._radius) or not abs(self._angle) < MAX_POSITION:
            raise BlockError(Wording("NC210", "polar_needs_both", first=first, second=second))
        angle = math.radians(self._angle)
        ends = self._radius * math.cos(angle), self._radius * math.sin(angle)
        position = {name: (end, PositionMode.ABSOLUTE) for name, end in zip((first, second), ends, strict=True)}
        return {**axes, **position}
