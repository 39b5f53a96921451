"""The virtual control of LinuxCNC: its offsets, and machine positions under TCP."""

import math
import re
from collections.abc import Mapping
from dataclasses import field
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.compensation.styles import OWN_ENTRY
from trunnion.errors import Severity
from trunnion.machines import Axis, Machine, forward
from trunnion.messages import Wording, phrase
from trunnion.model import axis_positions
from trunnion.model.mode_words import END_OF_CYCLES
from trunnion.readers.control import arcs
from trunnion.readers.control.affine_map import AffineMap, rotation_matrix
from trunnion.readers.control.axis_word import AxisWord, PositionMode
from trunnion.readers.control.event_recorder import Note
from trunnion.readers.control.start_modes import CENTRES, KINEMATICS, check_start_modes, with_tcp_off
from trunnion.readers.families.linuxcnc.words import is_own_word
from trunnion.readers.program.declared_variables import read_variables
from trunnion.readers.program.forms import read_form
from trunnion.readers.program.settings import family_of, reading_of, unit_of
from trunnion.readers.rs274.control import Rs274Control
from trunnion.readers.rs274.word_meanings import WordMeanings, read_word_meanings
from trunnion.readers.scan.letter_blocks import letter_table
from trunnion.records import dataclass

#: Axes in the order of LinuxCNC's tables.
ORDER: Final = "XYZABC"

#: How much the radii at start and end may differ: in any case, mm; as a ratio of the radius; and at most, mm.
_FINE: Final = 0.005
_RATIO: Final = 0.001
_COARSE: Final = 0.5

#: Lengths that differ by no more than this are the same, mm.
_SAME_LENGTH: Final = 1e-6

#: Axes within this of zero, degrees, carry no length sideways; directions within this are parallel.
_STILL: Final = 1e-9

#: How the reader takes the control to start.
_START_MODES: Final = {
    "distances": "G90", "plane": "G17", "compensation": "G40", "feed": "G94", "length": "G49", CENTRES: "G91.1",
    END_OF_CYCLES: "G99",
}  # fmt: skip

#: Parameters that keep their values from one program to the next; names in small letters.
PARAMETER: Final = re.compile(r"#([1-9][0-9]{0,2}|[1-4][0-9]{3}|5000|<_[a-z0-9_]+>)")


def _start_modes_of(machine: Machine) -> Mapping[str, str]:
    return with_tcp_off(machine, KINEMATICS, _START_MODES)


def settings_of(machine: Machine) -> tuple[str, WordMeanings, dict[str, float]]:
    """Read the unit, own words and declared parameters of a machine's control; InputError if they are wrong."""
    table = reading_of(machine)
    unit, words = unit_of(table), read_word_meanings(table, is_own_word)
    variables = read_variables(table, PARAMETER, "#100")
    read_form(table, family_of(machine))
    check_start_modes(table, _start_modes_of(machine))
    table.report_unread_keys()
    table.raise_problems()
    return unit, words, variables


@dataclass(slots=True)
class Offset:
    """A work offset that the program set.

    values     (6,) X Y Z, mm, A B C, degrees, in machine positions
    rotation   about Z, degrees
    """

    values: Floats = field(default_factory=lambda: np.zeros(6))
    rotation: float = 0.0


class LinuxcncControl(Rs274Control):
    """A LinuxCNC on a machine. Work offsets that the program does not set are the machine's workpiece zero.

    system             number of the work offset in force, 1 for G54
    axis_offset        offset of G92 or G52, (6,) mm and degrees
    axis_offset_active whether it counts
    axis_offset_known  whether this program has set or cleared it
    own_words          words that the control has in place of the family's
    declared           values of parameters that the control has when a program starts
    """

    # M2 and M30 set all others back: G54, G17, G90, G94, G40, G80 (docs/reader-linuxcnc.md).
    compensation_style = OWN_ENTRY
    kept_modes = frozenset({"units", "centres", "length"})
    reset_by = "M2 and M30 do not end it"

    def __init__(self, machine: Machine, note: Note, *, shortest: bool | None = None) -> None:
        super().__init__(machine, note, shortest=shortest)
        self.start_modes = _start_modes_of(machine)
        self.letter_table = letter_table(self.rotary_names, comment=";", gaps=True)
        self.system = 1
        self._offset_values: dict[int, Offset] = {}
        self.axis_offset = np.zeros(6)
        self.axis_offset_active = False
        self.axis_offset_known = False
        self._replaced = ""
        unit, self.own_words, self.declared = settings_of(machine)
        self.count_in(unit)

    def set_tcp(self, on: bool) -> None:
        """M428 and M429, which switch the kinematics, and so the positions of the machine as well."""
        self.said_from.setdefault(KINEMATICS, self.row)
        super().set_tcp(on)

    def left_on(self) -> Wording | None:
        """Return an offset or a rotation without use that the end of the program leaves on; None if nothing."""
        if not self.unused_shift:
            return None
        if self.axis_offset_active and self.axis_offset.any():
            return phrase("left_offset")
        return phrase("left_rotation") if self.offset_of(self.system).rotation else None

    def takes_shortest_path(self, axis: Axis) -> bool:
        """Never: rotary axes take the number as it is."""
        return False

    def turn_rule(self, which: int, mode: PositionMode) -> int:
        """Return the turn rule of axes that the machine's ini file does not call wrapped: the number itself."""
        return super().turn_rule(which, mode) if self.shortest else axis_positions.PLAIN

    def check_radii(self, start: Floats, end: Floats, centre: Floats) -> None:
        """Refuse circles whose radii differ more than LinuxCNC allows."""
        first, second = ((self.plane_axis + 1) % 3, (self.plane_axis + 2) % 3)
        r1, r2 = (math.hypot(p[first] - centre[first], p[second] - centre[second]) for p in (start, end))
        difference = abs(r1 - r2)
        if difference > _COARSE or (difference > _FINE and difference > _RATIO * max(r1, r2)):
            raise arcs.ArcError(Wording("NC320", "radii_differ", start=r1, end=r2))

    # Offsets

    @property
    def zero(self) -> Floats:
        """The workpiece zero in machine positions, (6,) mm and degrees."""
        return np.concatenate((self._zero_slides, np.zeros(3)))

    def offset_of(self, system: int) -> Offset:
        """Return a work offset; one that the program did not set is the workpiece zero."""
        return self._offset_values.get(system) or Offset(self.zero)

    def set_values(self, system: int, offset: Offset) -> None:
        """Set a work offset."""
        self._offset_values[system] = offset
        self.update_frame()

    def update_frame(self) -> None:
        """Put the offsets into effect; the axes stay."""
        offset = self.offset_of(self.system)
        linear = rotation_matrix(2, offset.rotation)
        shift = offset.values[:3] - self.zero[:3]
        if self.axis_offset_active:
            shift = shift + linear @ self.axis_offset[:3]
        self.set_program_frame(AffineMap(linear, shift), keep_base=False)

    @property
    def rotary_offsets(self) -> dict[str, float]:
        """What must be added to programmed rotary positions to give machine positions, by letter."""
        offset = self.offset_of(self.system).values
        total = offset + self.axis_offset if self.axis_offset_active else offset
        return {name: float(total[ORDER.index(name)]) for name in self.rotary_names if name in ORDER}

    def replace_length(self, word: str, length: float) -> None:
        """Take a length of the program in place of that of the tool, mm."""
        stated, tool = self.stated_length(), self.tool_in_spindle
        if stated is not None and abs(stated - length) > _SAME_LENGTH:
            wording = Wording(
                "NC361", "length_of_other_tool", word=word, counted=length, tool=tool or "0", length=stated
            )
            self.note(wording, Severity.ERROR)
        else:
            self.note(Wording("NC360", "length_replaced", word=word, value=length), Severity.WARNING)
        self.set_length(True)
        self.take_length(length, word)
        self.modal.edge.set(self.row, 0)
        self._replaced = word
        self.add_event("delta", (f"{word} Z", length))

    def take_back_lengths(self) -> None:
        """Take back what G43.1 and G43.2 say of the length: G43 and G49 replace it."""
        self.take_length(None)
        if self._replaced:
            self.add_event("delta", (f"{self._replaced} Z", 0.0))
            self._replaced = ""
        for letter in "XYZ":
            self.add_tool_delta(f"G43.2 {letter}", 0.0)

    def judge_new_length(self, word: str) -> None:
        """Note another tool length where the kinematics turn it: LinuxCNC moves the slides there at once, unplanned."""
        if not self.tcp:
            return
        turned = self._turned_off_spindle()
        if turned:
            variant = "length_ends_under_tcp" if word == "G49" else "length_changes_under_tcp"
            self.note(Wording("NC364", variant, word=word, axes=tuple(turned)), Severity.ERROR)

    def _turned_off_spindle(self) -> list[str]:
        """Names of the rotary axes that stand turned, except those about the tool at zero, which carry no length."""
        self.resolve_rows()
        turned = []
        for which, name in enumerate(self.rotary_names):
            column = self.machine.rotary[which]
            angle = float(self.current_joints[column])
            off = abs(angle - 360.0 * round(angle / 360.0)) > _STILL
            along = abs(float(np.dot(self.machine.axes[column].direction, self.machine.spindle_direction)))
            if off and along < 1.0 - _STILL:
                turned.append(name)
        return turned

    # Positions

    def position(self) -> Floats:
        """Return the programmed position at which the axes stand, (6,) mm and degrees."""
        self.resolve_rows()
        position = np.zeros(6)
        position[:3] = self.programmed_position
        self._write_rotary(position)
        for name, offset in self.rotary_offsets.items():
            position[ORDER.index(name)] -= offset
        return position

    def machine_position(self) -> Floats:
        """Return the machine position of the axes, (6,) mm and degrees; with TCP, of the tip in the machine frame.

        With TCP the tool length counts as in LinuxCNC's kinematics: above the tip.
        """
        self.resolve_rows()
        position = np.zeros(6)
        if self.tip_programmed:
            tip = forward(self.machine, self.current_joints[None])[0][0]
            position[:3] = tip + self.zero[:3] + self._length_offset
        else:
            position[:3] = self.current_joints[self._slides]
        self._write_rotary(position)
        return position

    def _write_rotary(self, position: Floats) -> None:
        for which, name in enumerate(self.rotary_names):
            if name in ORDER:
                position[ORDER.index(name)] = float(self.current_joints[self.machine.rotary[which]])

    def without_length(self, position: Floats) -> Floats:
        """Return a machine position without the tool length, as work offsets count it, (6,)."""
        bare = position.copy()
        bare[:3] -= self._length_offset
        return bare

    def machine_move(self, axes: dict[str, AxisWord], *, feed_written: bool) -> None:
        """Move to machine positions; with TCP to positions of the tip in the machine frame."""
        if not self.tip_programmed:
            self.move(axes, None, machine_frame=True, feed_written=feed_written)
            return
        if axes.keys() & {"X", "Y", "Z"}:
            self.note(Wording("NC341", "g53_tcp_goes_position_tip"), Severity.WARNING)
        goal = self.machine_position()[:3]
        for axis, name in enumerate("XYZ"):
            if name in axes:
                goal[axis] = axes[name][0] * self.length_unit
        programmed = self._to_programmed(goal - self.zero[:3] - self._length_offset) / self.length_unit
        words = {name: word for name, word in axes.items() if name not in "XYZ"}
        words |= {name: (float(programmed[axis]), PositionMode.ABSOLUTE) for axis, name in enumerate("XYZ")}
        self.move(words, None, feed_written=feed_written)
