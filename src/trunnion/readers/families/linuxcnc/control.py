"""The virtual control of LinuxCNC: offsets as it counts them, and positions of the machine under TCP."""

from dataclasses import dataclass, field
from typing import Final

import numpy as np

from trunnion.arrays import Codes, Floats
from trunnion.machines import Axis, Machine, forward
from trunnion.model import axis_positions
from trunnion.readers.control import arcs
from trunnion.readers.control.affine_map import AffineMap, rotation_matrix
from trunnion.readers.control.axis_word import AxisWord, PositionMode
from trunnion.readers.control.row_buffer import StepColumnBuilder
from trunnion.readers.control.row_recorder import Note
from trunnion.readers.rs274.control import Rs274Control
from trunnion.readers.scan.letter_blocks import letter_table

#: Axes in the order of LinuxCNC's own tables.
ORDER: Final = "XYZABC"

#: How much the radius may differ between start and end: always, in part of the radius, and at most, mm.
_FINE: Final = 0.005
_PART: Final = 0.001
_COARSE: Final = 0.5


@dataclass(slots=True)
class Offset:
    """A work offset that the program set.

    values     (6,) X Y Z, mm, A B C, degrees, in positions of the machine
    rotation   about Z, degrees
    """

    values: Floats = field(default_factory=lambda: np.zeros(6))
    rotation: float = 0.0


class LinuxcncControl(Rs274Control):
    """A LinuxCNC at work on a machine. Work offsets that the program does not set are the machine's workpiece zero."""

    def __init__(
        self, machine: Machine, note: Note, file: StepColumnBuilder[int], *, shortest: bool | None = None
    ) -> None:
        super().__init__(machine, note, file, shortest=shortest)
        self.table = letter_table((self.rotary_names[0], self.rotary_names[1]), comment=";", gaps=True)
        #: Number of the work offset in force, 1 for G54.
        self.system = 1
        self._set: dict[int, Offset] = {}
        #: G92 and G52: (6,) mm and degrees, and whether they count.
        self.shift = np.zeros(6)
        self.shifted = False

    def takes_shortest_path(self, axis: Axis) -> bool:
        """Never: rotary axes take the number as it is."""
        return False

    def turn_rule(self, which: int, how: PositionMode) -> int:
        """The number itself, as axes take it that the machine's ini file does not call wrapped."""
        return super().turn_rule(which, how) if self.shortest else axis_positions.PLAIN

    def check_radii(self, start: Floats, end: Floats, centre: Floats) -> None:
        """Refuse circles whose radii differ more than LinuxCNC allows."""
        first, second = ((self.plane_axis + 1) % 3, (self.plane_axis + 2) % 3)
        r1, r2 = (float(np.hypot(p[first] - centre[first], p[second] - centre[second])) for p in (start, end))
        off = abs(r1 - r2)
        if off > _COARSE or (off > _FINE and off > _PART * max(r1, r2)):
            raise arcs.ArcError(f"the radius is {r1:.4f} at the start and {r2:.4f} at the end")

    # Offsets

    @property
    def zero(self) -> Floats:
        """(6,) the workpiece zero in positions of the machine."""
        return np.concatenate((self._origin_slides, np.zeros(3)))

    def offset_of(self, system: int) -> Offset:
        """Return a work offset; one that the program did not set is the workpiece zero."""
        return self._set.get(system) or Offset(self.zero)

    def set_values(self, system: int, offset: Offset) -> None:
        """Set a work offset."""
        self._set[system] = offset
        self.refresh()

    def refresh(self) -> None:
        """Let offsets count as they are now; the axes stand still."""
        offset = self.offset_of(self.system)
        linear = rotation_matrix(2, offset.rotation)
        shift = offset.values[:3] - self.zero[:3]
        if self.shifted:
            shift = shift + linear @ self.shift[:3]
        self.set_program_frame(AffineMap(linear, shift), keep_base=False)

    @property
    def rotary_offsets(self) -> dict[str, float]:
        """What a programmed rotary position has to grow by to be a position of the machine, by letter."""
        offset = self.offset_of(self.system).values
        total = offset + self.shift if self.shifted else offset
        return {name: float(total[ORDER.index(name)]) for name in self.rotary_names if name in ORDER}

    def position(self) -> Floats:
        """(6,) programmed positions of where the axes stand, mm and degrees."""
        self.resolve_rows()
        offsets = self.rotary_offsets
        position = np.zeros(6)
        position[:3] = self.commanded[:3]
        for which, name in enumerate(self.rotary_names):
            if name in ORDER:
                position[ORDER.index(name)] = float(self.current_joints[self.machine.rotary[which]]) - offsets[name]
        return position

    def machine_position(self) -> Floats:
        """(6,) where the axes stand in positions of the machine; with TCP, of the tip in the machine's frame.

        With TCP the length of the tool counts as it does for LinuxCNC's kinematics: over the tip.
        """
        self.resolve_rows()
        position = np.zeros(6)
        if self.tip_programmed:
            position[:3] = forward(self.machine, self.current_joints[None])[0][0] + self.zero[:3] + self._length_offset
        else:
            position[:3] = self.current_joints[self._slides]
        for which, name in enumerate(self.rotary_names):
            if name in ORDER:
                position[ORDER.index(name)] = float(self.current_joints[self.machine.rotary[which]])
        return position

    def without_length(self, position: Floats) -> Floats:
        """Return a position of the machine as work offsets count it, whatever the length of the tool, (6,)."""
        bare = position.copy()
        bare[:3] -= self._length_offset
        return bare

    def machine_move(self, axes: dict[str, AxisWord], *, feed_written: bool) -> None:
        """Go to positions of the machine; with TCP those of the tip in the machine's frame."""
        if not self.tip_programmed:
            self.move(axes, None, machine_frame=True, feed_written=feed_written)
            return
        goal = self.machine_position()[:3]
        for axis, name in enumerate("XYZ"):
            if name in axes:
                goal[axis] = axes[name][0] * self.length_unit
        place = self._to_programmed(goal - self.zero[:3] - self._length_offset) / self.length_unit
        words = {name: word for name, word in axes.items() if name not in "XYZ"}
        words |= {name: (float(place[axis]), PositionMode.ABSOLUTE) for axis, name in enumerate("XYZ")}
        self.move(words, None, feed_written=feed_written)

    @property
    def plain_table(self) -> Codes:
        """What bytes mean to the scan kernel."""
        return self.table
