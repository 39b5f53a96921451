"""The virtual control of a Fanuc: its frames, its tilted planes and where G53.1 turns the rotary axes."""

import numpy as np

from trunnion.arrays import Codes, Floats
from trunnion.errors import Severity
from trunnion.machines import AngleOutput, Axis, Machine, Mount
from trunnion.model.axis_positions import PLAIN
from trunnion.model.run import ProgrammedWord
from trunnion.model.toolpath import Kind
from trunnion.readers.control import tool_orientation
from trunnion.readers.control.affine_map import AffineMap, rotation_about, rotation_matrix
from trunnion.readers.control.axis_word import AxisWord, PositionMode
from trunnion.readers.control.row_buffer import StepColumnBuilder
from trunnion.readers.control.row_recorder import Note
from trunnion.readers.rs274.control import Rs274Control
from trunnion.readers.scan.letter_blocks import letter_table


class FanucControl(Rs274Control):
    """A Fanuc at work on a machine. Work offsets that the program does not set are the machine's workpiece zero."""

    def __init__(
        self,
        machine: Machine,
        note: Note,
        file: StepColumnBuilder[int],
        *,
        shortest: bool | None = None,
        calculator: bool,
    ) -> None:
        super().__init__(machine, note, file, shortest=shortest)
        names = self.rotary_names[0], self.rotary_names[1]
        pointed = "" if calculator else "XYZ" + "".join(names)
        # Whole numbers behind F are what they look like only in mm/min; with G43.5 I J K are the tool axis.
        self._tables = {
            (plain, vectors): letter_table(
                names,
                gaps=True,
                pointed="" if calculator else pointed + "IJK" + ("" if plain else "F"),
                vector="IJK" if vectors else "",
            )
            for plain in (True, False)
            for vectors in (True, False)
        }
        #: Number of the work offset in force: 1 to 6 for G54 to G59, more for G54.1.
        self.system = 1
        self._set: dict[int, Floats] = {}
        #: G92 and G52, mm.
        self.preset = np.zeros(3)
        self.local = np.zeros(3)
        #: G68 as one frame.
        self.rotation = AffineMap()
        #: G43.5: words I J K of lines are vectors.
        self.vectors = False
        #: In one table or in one head the axis that carries the other; on mixed machines that of the table.
        self.deciding_axis = 1 if all(machine.axes[k].mount is Mount.PART for k in machine.rotary) else 0

    def takes_shortest_path(self, axis: Axis) -> bool:
        """Always, as axes roll over that are set to; but for axes whose values are written as they wind."""
        return axis.output is not AngleOutput.NONE

    @property
    def plain_table(self) -> Codes:
        """What bytes mean to the scan kernel now."""
        plain = self.feed_mode.current in (93, 94) and self.length_unit == 1.0
        return self._tables[plain, self.vectors]

    # Frames

    @property
    def zero(self) -> Floats:
        """(3,) the workpiece zero in positions of the slides."""
        return self._origin_slides

    def offset_of(self, system: int) -> Floats:
        """Return a work offset in positions of the slides, (3,) mm."""
        return self._set.get(system, self.zero)

    def set_values(self, system: int, values: Floats) -> None:
        """Set a work offset."""
        self._set[system] = values
        self.refresh()

    def refresh(self) -> None:
        """Let offsets and rotations count as they are now; the axes stand still."""
        shift = self.offset_of(self.system) - self.zero + self.preset + self.local
        base = AffineMap(np.eye(3), shift)
        if self.tilted:
            # The plane stands in the work offset that held when it was taken.
            self.set_program_frame(self.rotation, keep_base=False)
        else:
            self.set_program_frame(base.compose(self.rotation), keep_base=False)

    def rotate(self, centre: Floats, direction: Floats, angle: float) -> None:
        """G68: turn about an axis through a point (both (3,), programmed), on top of a G68 in force."""
        linear = _about(direction, angle)
        self.rotation = self.rotation.compose(AffineMap(linear, centre - linear @ centre))
        self.refresh()

    def tilt(self, origin: Floats, euler: tuple[float, float, float]) -> None:
        """G68.2: a plane by its origin and Euler angles Z, X, Z, in the work offset; the axes stay."""
        if self.tilted:
            self.note("G68.2 while a plane is tilted: the old one is given up", Severity.WARNING)
        first, second, third = euler
        linear = rotation_matrix(2, first) @ rotation_matrix(0, second) @ rotation_matrix(2, third)
        shift = self.offset_of(self.system) - self.zero + self.preset + self.local
        self.rotation = AffineMap()
        self.set_plane(AffineMap(linear, shift + origin))
        self.add_event("tilt", "G68.2")

    def cancel_rotation(self) -> None:
        """G69: no rotation and no plane."""
        self.rotation = AffineMap()
        if self.tilted:
            self.set_plane(None)
            self.add_event("tilt", "")
        self.refresh()

    def align_with_plane(self) -> None:
        """G53.1: turn the rotary axes so that the tool stands on the plane, by the way on which they turn least."""
        if not self.tilted:
            self.note("G53.1 without a plane of G68.2: it is not executed", Severity.ERROR)
            return
        self.resolve_rows()
        pairs = tool_orientation.solutions(self.machine, self.frame.linear[:, 2], self.current_joints)
        inside = [
            tool_orientation.nearest_in_travel(self.machine, pair, self.current_joints)
            for pair in pairs
            if tool_orientation.is_in_travel(self.machine, pair)
        ]
        if not inside:
            self.note("G53.1: no rotary position inside the travel stands the tool on this plane", Severity.ERROR)
            return
        held, first = self.current_joints[list(self.machine.rotary)], self.deciding_axis
        ways = [np.round(np.abs(np.array(pair) - held), 6).tolist() for pair in inside]
        _, best = min(zip(ways, inside, strict=True), key=lambda item: (item[0][first], item[0][1 - first]))
        bits = int(ProgrammedWord.FIRST | ProgrammedWord.SECOND)
        self.add_event("tilt", "G53.1")
        self.move_axes(Kind.RAPID, self.current_joints[self._slides].copy(), list(best), PLAIN, bits)

    # Positions of the machine

    def slides_now(self) -> Floats:
        """(3,) where the slides X, Y and Z stand."""
        self.resolve_rows()
        return np.asarray(self.current_joints[self._slides])

    def go_to_machine(self, goal: dict[str, float]) -> None:
        """Go to positions of axes, mm and degrees, at rapid."""
        axes: dict[str, AxisWord] = {
            name: (value / self.length_unit if name in "XYZ" else value, PositionMode.ABSOLUTE)
            for name, value in goal.items()
        }
        self.move(axes, None, machine_frame=True)


def _about(direction: Floats, angle: float) -> Floats:
    """(3, 3): exact about X, Y and Z."""
    axis = int(np.argmax(np.abs(direction)))
    if abs(abs(direction[axis]) - 1.0) < 1e-12:
        return rotation_matrix(axis, float(np.sign(direction[axis])) * angle)
    return rotation_about(direction, angle)
