"""Words of LinuxCNC whose axis words are no goal of a motion: dwells, offsets, and the ways home."""

from collections.abc import Sequence
from pathlib import Path
from typing import Final

import numpy as np

from trunnion.errors import Severity
from trunnion.machines import Machine
from trunnion.readers.control.affine_map import rotation_matrix
from trunnion.readers.control.axis_word import AxisWord, PositionMode
from trunnion.readers.control.row_recorder import MAX_POSITION
from trunnion.readers.control.virtual_control import RAPID
from trunnion.readers.families.linuxcnc.control import ORDER, LinuxcncControl, Offset
from trunnion.readers.families.linuxcnc.flow import OWordInterpreter
from trunnion.readers.program.interpreter import DEFAULT_STEP_LIMIT
from trunnion.readers.rs274.block import Block
from trunnion.readers.rs274.expressions import BlockError

#: G codes, in tenths: a dwell, what sets offsets and tools, the ways home with what stores their ends, and offsets
#: that a block says in its axis words, takes off or puts on again.
DWELL: Final = 40
SETUP: Final = 100
HOMES: Final = {280: 281, 300: 301}
AXIS_OFFSETS: Final = frozenset({520, 920})
SHIFTS: Final = frozenset({921, 922, 923})

#: All of them, and those that take the axis words of their block.
SPECIAL: Final = frozenset({DWELL, SETUP, *HOMES, *HOMES.values(), *AXIS_OFFSETS, *SHIFTS})
TAKING_AXIS_WORDS: Final = frozenset({SETUP, *HOMES, *AXIS_OFFSETS})


class OffsetInterpreter(OWordInterpreter):
    """Has the virtual control, its offsets and the places that G28 and G30 go to."""

    def __init__(
        self,
        path: Path,
        machine: Machine,
        *,
        subprograms: Sequence[Path] = (),
        step_limit: int = DEFAULT_STEP_LIMIT,
        skip: bool = False,
        shortest: bool | None = None,
    ) -> None:
        super().__init__(path, machine, subprograms=subprograms, step_limit=step_limit, skip=skip)
        self._control = LinuxcncControl(machine, self._note, self._file, shortest=shortest)
        self._stored_positions = {code: {axis.name: float(axis.home) for axis in machine.axes} for code in HOMES}

    @property
    def control(self) -> LinuxcncControl:
        """The virtual control."""
        return self._control

    def _special(self, code: int, block: Block) -> None:
        control = self._control
        if code == DWELL:
            seconds = block.take("P")
            if seconds is None:
                self._note("G4 without a time P", Severity.ERROR)
            else:
                control.add_event("dwell", seconds)
        elif code == SETUP:
            self._set_up(block)
        elif code in AXIS_OFFSETS:
            self._axis_offset(code, block)
        elif code in SHIFTS:
            if code == 921:
                control.shift = np.zeros(6)
            control.shifted = code == 923
            control.refresh()
        elif code in HOMES:
            self._go_home(code, block)
        elif code in HOMES.values():
            stored = control.machine_position()
            kept = next(go for go, keep in HOMES.items() if keep == code)
            self._stored_positions[kept] = {name: float(stored[axis]) for axis, name in enumerate(ORDER)}

    def _axis_offset(self, code: int, block: Block) -> None:
        """G92: the present position gets new numbers; G52: the offset itself is said."""
        control = self._control
        position = control.position()
        shift = control.shift.copy()
        for axis, name in enumerate(ORDER):
            value = self._scaled(block, name, axis)
            if value is not None:
                shift[axis] = value if code == 520 else shift[axis] * control.shifted + position[axis] - value
            elif not control.shifted:
                shift[axis] = 0.0
        if float(np.abs(shift).max()) > MAX_POSITION:
            raise BlockError("an offset is larger than any machine")
        control.shift, control.shifted = shift, True
        control.refresh()

    def _set_up(self, block: Block) -> None:
        """G10: a work offset, or a tool's data."""
        control = self._control
        kind = block.take("L")
        system = block.take("P")
        if kind in (0.0, 1.0, 10.0, 11.0):
            for letter in "XYZABCUVWRIJQ":
                block.take(letter)
            return
        if kind not in (2.0, 20.0) or system is None or system != int(system) or not 0 <= system <= 9:
            raise BlockError("G10 needs L2 or L20, and P from 0 to 9")
        number = int(system) or control.system
        old = control.offset_of(number)
        values, rotation = old.values.copy(), old.rotation
        turned = block.take("R")
        if turned is not None and kind == 2.0:
            rotation = turned
        elif turned is not None:
            raise BlockError("G10 L20 takes no R")
        point = control.without_length(control.machine_position())
        shift = control.shift if control.shifted else np.zeros(6)
        unturned = rotation_matrix(2, -rotation)
        inside = point - values
        inside[:3] = unturned @ inside[:3]
        inside -= shift
        change = np.zeros(6)
        for axis, name in enumerate(ORDER):
            value = self._scaled(block, name, axis)
            if value is None:
                continue
            if kind == 2.0:
                values[axis] = value
            else:
                change[axis] = inside[axis] - value
        change[:3] = rotation_matrix(2, rotation) @ change[:3]
        values = values + change
        if float(np.abs(values).max()) > MAX_POSITION or abs(rotation) > MAX_POSITION:
            raise BlockError("an offset is larger than any machine")
        control.set_values(number, Offset(values, rotation))

    def _scaled(self, block: Block, name: str, axis: int) -> float | None:
        """Return the value of an axis word in mm or degrees."""
        value = block.take(name)
        if value is None:
            return None
        if axis > 2 and name not in self._control.rotary_names:
            if value:
                self._note(f"{name}: the machine has no such axis", Severity.ERROR)
            return None
        return value * self._control.length_unit if axis < 3 else value

    def _go_home(self, code: int, block: Block) -> None:
        """G28 and G30: over the point that the block says to the stored one, all axes or those of the block."""
        control = self._control
        axes = self._with_rotary_offsets(self._axis_words(block))
        kind, control.kind = control.kind, RAPID
        self._count_blocks(1)
        control.move(axes, None)
        names = axes or dict.fromkeys((*"XYZ", *control.rotary_names))
        stored = self._stored_positions[code]
        scale = control.length_unit
        goal: dict[str, AxisWord] = {
            name: (stored.get(name, 0.0) / (scale if name in "XYZ" else 1.0), PositionMode.ABSOLUTE) for name in names
        }
        control.machine_move(goal, feed_written=False)
        control.kind = kind

    def _with_rotary_offsets(self, axes: dict[str, AxisWord]) -> dict[str, AxisWord]:
        """Axis words with the offsets of rotary axes in them."""
        if not self._control.absolute:
            return axes
        turned = self._control.rotary_offsets
        return {name: (word[0] + turned.get(name, 0.0), word[1]) for name, word in axes.items()}
