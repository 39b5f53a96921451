"""Blocks of LinuxCNC whose axis words are no target: dwells, offsets and home."""

from pathlib import Path

import numpy as np

from trunnion.arrays import Floats
from trunnion.errors import Severity
from trunnion.machines import Machine
from trunnion.messages import Wording
from trunnion.readers.control.affine_map import rotation_matrix
from trunnion.readers.control.axis_word import AxisWord, PositionMode
from trunnion.readers.control.row_recorder import MAX_POSITION
from trunnion.readers.control.virtual_control import RAPID
from trunnion.readers.families.linuxcnc import words
from trunnion.readers.families.linuxcnc.control import ORDER, LinuxcncControl, Offset
from trunnion.readers.families.linuxcnc.flow import OWordInterpreter
from trunnion.readers.program.options import DEFAULT_OPTIONS, RunOptions
from trunnion.readers.rs274.block import Block
from trunnion.readers.rs274.expressions import BlockError
from trunnion.readers.rs274.word_table import Word


class OffsetInterpreter(OWordInterpreter):
    """Executes offsets, and keeps the positions that G28 and G30 go to."""

    control: LinuxcncControl

    def __init__(self, path: Path, machine: Machine, options: RunOptions = DEFAULT_OPTIONS) -> None:
        super().__init__(path, machine, options)
        home = {axis.name: float(axis.home) for axis in machine.own_axes}
        self._stored_positions = {"G28": home, "G30": home}

    def _make_control(self) -> LinuxcncControl:
        return LinuxcncControl(self._machine, self._note, shortest=self._options.shortest)

    # Offsets

    def _switch_axis_offset(self, word: Word, block: Block) -> None:
        """G92.1 clears the offset, G92.2 switches it off, G92.3 on again."""
        control = self.control
        if word.text == "G92.1":
            control.axis_offset = np.zeros(6)
            control.axis_offset_known = True
        if word.text == "G92.3" and not control.axis_offset_known:
            self._note(Wording("NC222", "g92_3_brings_back_offset"), Severity.ERROR)
        control.axis_offset_active = word.text == "G92.3"
        control.update_frame()

    def _axis_offset(self, word: Word, block: Block) -> None:
        """G92: give the present position new coordinates; G52: set the offset itself."""
        control = self.control
        position = control.position()
        active = control.axis_offset_active
        offset = control.axis_offset.copy()
        values = self._axis_values(block)
        if all(value is None for value in values):
            raise BlockError(Wording("NC210", "shift_needs_axes"))
        for axis, value in enumerate(values):
            if value is not None:
                if word.text == "G92" and axis < 3 and control.is_at_unknown_place(axis):
                    control.require_known_zero("G92", "G92")
                offset[axis] = value if word.text == "G52" else offset[axis] * active + position[axis] - value
            elif not active:
                offset[axis] = 0.0
        if float(np.abs(offset).max()) > MAX_POSITION:
            raise BlockError(Wording("NC215", "offset_larger_than_any_machine"))
        control.axis_offset, control.axis_offset_active = offset, True
        control.axis_offset_known = True
        control.note_shift()
        control.update_frame()

    def _set_data(self, word: Word, block: Block) -> None:
        """G10: set a work offset; what writes data of a tool is an error, as the path does not show it."""
        control = self.control
        kind = block.take("L")
        system = block.take("P")
        if kind in words.TOOL_DATA or kind == words.RELOAD_TOOLS:
            for letter in "XYZABCUVWRIJQ":
                block.take(letter)
            if kind in words.TOOL_DATA:
                self._note(Wording("NC220", "g10_l_writes_length_radius", kind=kind), Severity.ERROR)
            return
        if kind not in (2.0, 20.0) or system is None or system != int(system) or not 0 <= system <= 9:
            raise BlockError(Wording("NC210", "g10_needs_l2_l20_p"))
        number = int(system) or control.system
        rotation = block.take("R")
        if rotation is not None and kind == 20.0:
            raise BlockError(Wording("NC210", "g10_l20_takes_no_r"))
        old = control.offset_of(number)
        offset = Offset(old.values.copy(), old.rotation if rotation is None else rotation)
        if kind == 2.0:
            for axis, value in enumerate(self._axis_values(block)):
                if value is not None:
                    offset.values[axis] = value
        else:
            offset.values += self._offset_change(offset, block)
        if float(np.abs(offset.values).max()) > MAX_POSITION or abs(offset.rotation) > MAX_POSITION:
            raise BlockError(Wording("NC215", "offset_larger_than_any_machine"))
        control.note_shift()
        clears = not offset.values.any() and not offset.rotation
        control.require_known_zero(f"G10 L{kind:g} P{system:g}", f"offset {number}")
        control.note_stored_offset(f"G10 L{kind:g} P{system:g}", number, clears=clears)
        control.set_values(number, offset)

    def _offset_change(self, offset: Offset, block: Block) -> Floats:
        """Return by how much an offset must change to give the present position the coordinates of a block, (6,)."""
        control = self.control
        position = control.without_length(control.machine_position()) - offset.values
        position[:3] = rotation_matrix(2, -offset.rotation) @ position[:3]
        if control.axis_offset_active:
            position -= control.axis_offset
        change = np.zeros(6)
        for axis, value in enumerate(self._axis_values(block)):
            if value is not None:
                change[axis] = position[axis] - value
        change[:3] = rotation_matrix(2, offset.rotation) @ change[:3]
        return change

    def _axis_values(self, block: Block) -> list[float | None]:
        """Return the axis words of a block in mm and degrees, in the order X Y Z A B C."""
        values: list[float | None] = []
        for axis, name in enumerate(ORDER):
            value = block.take(name)
            if value is not None and axis < 3:
                value *= self.control.length_unit
            elif value is not None and name not in self.control.rotary_names:
                if value:
                    self._note(Wording("NC230", "no_such_axis", axis=name), Severity.ERROR)
                value = None
            values.append(value)
        return values

    # Home

    def _go_home(self, word: Word, block: Block) -> None:
        """G28 and G30: through the programmed point to the stored one, with all axes or those of the block."""
        control = self.control
        axes = self._with_rotary_offsets(self._axis_words(block))
        motion, control.motion = control.motion, RAPID
        self._counter.count_motions(1)
        control.move(axes, None)
        names = axes or dict.fromkeys((*"XYZ", *control.rotary_names))
        stored = self._stored_positions[word.text]
        unit = control.length_unit
        goal: dict[str, AxisWord] = {
            name: (stored.get(name, 0.0) / (unit if name in "XYZ" else 1.0), PositionMode.ABSOLUTE) for name in names
        }
        control.machine_move(goal, feed_written=False)
        control.motion = motion

    def _store_home(self, word: Word, block: Block) -> None:
        """G28.1 and G30.1: store the present position for G28 and G30."""
        stored = self.control.machine_position()
        self._stored_positions[word.sets] = {name: float(stored[axis]) for axis, name in enumerate(ORDER)}
        what = f"the position that {word.sets} goes to in"
        self.control.note_stored_offset(word.text, word.code, clears=False, what=what)

    def _with_rotary_offsets(self, axes: dict[str, AxisWord]) -> dict[str, AxisWord]:
        """Return axis words with the offsets of rotary axes added."""
        if not self.control.absolute:
            return axes
        offsets = self.control.rotary_offsets
        return {name: (word[0] + offsets.get(name, 0.0), word[1]) for name, word in axes.items()}
