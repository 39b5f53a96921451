"""The virtual control of LinuxCNC: what only it does with circles and rotary words."""

from collections.abc import Mapping
from functools import partial
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.errors import Severity
from trunnion.machine import Axis, Machine
from trunnion.reader import arcs
from trunnion.reader.columns import Changes
from trunnion.reader.control import LINEAR, Circle, Control
from trunnion.reader.rows import FARTHEST, Note
from trunnion.reader.scan import letters

#: Kinds of motion besides rapid and lines: G2, G3, and none before the first motion word and after G80.
CLOCKWISE: Final = 2
NONE: Final = 4

#: More turns of a circle are none that a program means.
MOST_TURNS: Final = 1000


class LinuxCNCControl(Control):
    """LinuxCNC at work on a machine. TCP is its switchable kinematics."""

    winds = True

    def __init__(self, machine: Machine, note: Note, file: Changes[int], *, shortest: bool | None = None) -> None:
        self._lengthened = False
        super().__init__(machine, note, file, shortest=shortest)
        self.kind = NONE
        self.table = letters((self.names[0], self.names[1]))
        #: Whether I J K count from the start of a circle.
        self.relative_centres = True

    def shorter(self, axis: Axis) -> bool:
        """Never: rotary words are positions."""
        return False

    @property
    def _length(self) -> Floats:
        return np.array([0.0, 0.0, self.machine.tool_length or 0.0]) if self._lengthened else np.zeros(3)

    def set_length(self, on: bool) -> None:
        """G43 or G49: the length of the tool in the spindle, if it is known, counts along Z."""
        if not self.machine.tool_length or on == self._lengthened:
            return
        with self.change():
            self._lengthened = on

    def circle(self, words: Mapping[str, float]) -> Circle | None:
        """The circle that the motion in force makes of the words of a block; None if it makes lines."""
        return partial(self._arc, words) if LINEAR < self.kind < NONE else None

    def _arc(self, words: Mapping[str, float], start: Floats, end: Floats) -> arcs.Arc:
        turns = words.get("P", 1.0)
        if turns != int(turns) or not 1 <= turns <= MOST_TURNS:
            raise arcs.ArcError(f"P{turns:g} is no number of turns")
        said = {name: words[name] * self.lengths for name in "IJKR" if name in words}
        if any(abs(value) > FARTHEST for value in said.values()):
            raise arcs.ArcError("a circle with numbers that no machine has")
        clockwise = self.kind == CLOCKWISE
        more = int(turns) - 1
        if "R" in said:
            if said.keys() != {"R"}:
                self.note("R and a centre in one block: R counts", Severity.ERROR)
            return arcs.by_radius(start, end, said["R"], self.plane, clockwise, more)
        centre = start.copy()
        for axis, name in enumerate("IJK"):
            if axis == self.plane and name in said:
                raise arcs.ArcError(f"{name} has no meaning for a circle in this plane")
            if name in said:
                centre[axis] = said[name] + (start[axis] if self.relative_centres else 0.0)
        if not said:
            raise arcs.ArcError("the circle has no centre")
        return arcs.by_centre(start, end, centre, self.plane, clockwise, more)
