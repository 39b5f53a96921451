"""The virtual control of languages of the RS274 kind: their circles."""

from collections.abc import Mapping
from functools import partial
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.errors import Severity
from trunnion.readers.control import arcs
from trunnion.readers.control.row_recorder import MAX_POSITION
from trunnion.readers.control.virtual_control import LINEAR, Circle, VirtualControl

#: Kinds of motion besides rapid and lines: G2 and G3.
CLOCKWISE: Final = 2
COUNTER: Final = 3

#: More turns than this are none that a program means.
MAX_TURNS: Final = 1000


class Rs274Control(VirtualControl):
    """A control whose circles have centres I J K or a radius R."""

    #: I J K count from the start of the circle.
    relative_centres = True

    #: The length of the tool counts along Z.
    _length_active = False

    @property
    def _length_offset(self) -> Floats:
        return np.array([0.0, 0.0, self.machine.tool_length or 0.0]) if self._length_active else np.zeros(3)

    @property
    def length_active(self) -> bool:
        """Whether the length of the tool counts."""
        return self._length_active

    def set_length(self, on: bool) -> None:
        """The length of the tool, if it is known, counts along Z, or no longer."""
        if on == self._length_active:
            return
        if not self.machine.tool_length:
            self._length_active = on
            return
        with self.frame_change():
            self._length_active = on

    def circle(self, params: Mapping[str, float], turns: int = 0) -> Circle | None:
        """The circle that the motion in force makes of a block; None if it makes lines.

        params   I, J, K and R, in the units of the program
        turns    whole turns besides
        """
        if self.kind <= LINEAR:
            return None
        return partial(self._arc, params, turns)

    def _arc(self, params: Mapping[str, float], turns: int, start: Floats, end: Floats) -> arcs.Arc:
        if not 0 <= turns < MAX_TURNS:
            raise arcs.ArcError(f"a circle with {turns} turns")
        if any(abs(value) * self.length_unit > MAX_POSITION for value in params.values()):
            raise arcs.ArcError("a circle with numbers that no machine has")
        clockwise = self.kind == CLOCKWISE
        given = {axis: params[name] * self.length_unit for axis, name in enumerate("IJK") if name in params}
        if self.plane_axis in given:
            self.note(f"{'IJK'[self.plane_axis]} has no meaning for a circle in this plane", Severity.WARNING)
            del given[self.plane_axis]
        if "R" in params:
            if given:
                self.note("R and a centre in one block: R counts", Severity.ERROR)
            return arcs.by_radius(start, end, params["R"] * self.length_unit, self.plane_axis, clockwise, turns)
        if not given:
            raise arcs.ArcError("the circle has no centre")
        if not self.relative_centres and len(given) < 2:
            raise arcs.ArcError("the circle needs both words of its centre")
        centre = start.copy()
        for axis, value in given.items():
            centre[axis] = start[axis] + value if self.relative_centres else value
        self.check_radii(start, end, centre)
        return arcs.by_centre(start, end, centre, self.plane_axis, clockwise, turns)

    def check_radii(self, start: Floats, end: Floats, centre: Floats) -> None:
        """Raise ``arcs.ArcError`` where this control minds how far the radii at start and end differ."""
