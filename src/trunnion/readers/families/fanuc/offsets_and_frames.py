"""Blocks of a Fanuc whose axis words are no target: work offsets, shifts, rotations, planes, home and dwells."""

from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.errors import Severity
from trunnion.messages import Wording
from trunnion.readers.control.axis_word import AxisWord
from trunnion.readers.control.row_recorder import MAX_POSITION
from trunnion.readers.control.virtual_control import RAPID
from trunnion.readers.families.fanuc import words
from trunnion.readers.families.fanuc.calls import CallInterpreter
from trunnion.readers.families.fanuc.work_offsets import extended_offset, offset_name
from trunnion.readers.program.word_values import fault_of_value
from trunnion.readers.rs274.block import Block
from trunnion.readers.rs274.expressions import BlockError
from trunnion.readers.rs274.word_table import Word

#: The word of extended work offsets of the family, where G54 P means the same.
_FAMILY_WORD: Final = "G54.1"


class OffsetInterpreter(CallInterpreter):
    """Executes G codes that take the axis words of their block."""

    def _work_offset(self, word: Word, block: Block) -> None:
        control, system = self.control, word.sets
        extended, highest = control.settings.extended_word, control.settings.extended_offsets
        takes_number = word.numbered or (word.text == "G54" and extended == _FAMILY_WORD)
        more = block.take("P") if takes_number else None
        if word.numbered and more is None:
            raise BlockError(Wording("NC210", "extended_offset_needs_p", word=extended))
        if more is not None:
            if more != int(more) or not extended_offset(int(more), highest):
                raise BlockError(Wording("NC215", "extended_offset_out_of_range", word=extended, most=highest))
            system = 6 + int(more)
        control.system = system
        offset = 53 + system if system <= 6 else extended_offset(system - 6)
        name = offset_name(offset, extended)
        control.set_mode("offset", name, control.modal.work_offset.current, offset)
        control.set_offset(offset, name)
        control.update_frame()

    def _dwell(self, word: Word, block: Block) -> None:
        number = block.words.get("X") or block.words.get("U")
        if number is not None and self.control.settings.point_is_seconds:
            raise BlockError(Wording("NC210", "time_dwell_p_control"))
        for letter in "XU":
            block.take(letter)
        self.control.settings.check_dwell(block)
        milliseconds = block.take("P")
        if (milliseconds or 0.0) < 0.0 or (number is not None and number.value < 0.0):
            raise BlockError(Wording("NC215", "negative_dwell"))
        if number is not None:
            unit = self.control.settings.seconds if number.whole else 1.0
            self.control.add_event("dwell", number.value * unit)
        elif milliseconds is not None:
            self.control.add_event("dwell", milliseconds / 1000.0)
        else:
            self._note(Wording("NC218", "g4_without_time"), Severity.WARNING)

    # Offsets and shifts

    def _point(self, block: Block) -> list[float | None]:
        """Return X, Y and Z of a block in mm; shifts of rotary axes are reported unless they are 0."""
        for name in self.control.rotary_names:
            if block.take(name):
                self._note(Wording("NC220", "shift_not_simulated", name=name), Severity.ERROR)
        values = [block.take(name) for name in "XYZ"]
        scaled = [None if value is None else value * self.control.length_unit for value in values]
        if any(value is not None and abs(value) > MAX_POSITION for value in scaled):
            raise BlockError(Wording("NC215", "shift_larger_than_any_machine"))
        return scaled

    def _refuse_tilted(self) -> None:
        if self.control.tilted:
            self._note(Wording("NC220", "shifts_tilted_plane_not_simulated"), Severity.ERROR)

    def _shifted(self, block: Block) -> list[float | None]:
        """Return X, Y and Z of a shift in mm; one of the axes must be there."""
        rotary = any(name in block.words for name in self.control.rotary_names)
        values = self._point(block)
        if not rotary and all(value is None for value in values):
            raise BlockError(Wording("NC210", "shift_needs_axes"))
        return values

    def _local_shift(self, word: Word, block: Block) -> None:
        control = self.control
        self._refuse_tilted()
        control.local = _changed(control.local, self._shifted(block))
        control.note_shift()
        control.update_frame()

    def _preset(self, word: Word, block: Block) -> None:
        """G92: give the present position new coordinates."""
        control = self.control
        self._refuse_tilted()
        for axis, value in enumerate(self._shifted(block)):
            if value is not None:
                if control.is_at_unknown_place(axis):
                    control.require_known_zero(word.text, word.text)
                control.preset[axis] += float(control.programmed_position[axis]) - value
        control.note_shift()
        rotation = control.rotation
        if control.tilted or not rotation.keeps_lengths or not np.allclose(rotation.linear, np.eye(3)):
            self._note(Wording("NC220", "g92_turned_frame_not_simulated"), Severity.ERROR)
        control.update_frame()

    def _set_data(self, word: Word, block: Block) -> None:
        """G10: set a work offset; what writes data of tools is an error, as the path does not show it."""
        control = self.control
        kind, number = block.take("L"), block.take("P")
        known = words.DATA_NUMBERS.get(int(kind)) if kind is not None and kind == int(kind) else None
        fault = None if known is None or number is None else fault_of_value(f"G10 L{kind:g}", "P", number, known)
        if fault:
            for letter in "RXYZQDH":
                block.take(letter)
            raise BlockError(fault)
        if kind is not None and kind in words.TOOL_DATA:
            for letter in "RXYZQDH":
                block.take(letter)
            self._note(
                Wording("NC220", "tool_data_not_simulated", kind=kind, does=words.TOOL_DATA[int(kind)]), Severity.ERROR
            )
            return
        if (
            kind not in (2.0, 20.0)
            or number is None
            or number != int(number)
            or not 0 <= number <= control.settings.extended_offsets
        ):
            for letter in "RXYZ":
                block.take(letter)
            raise BlockError(Wording("NC220", "g10_l_p_not_simulated"))
        values = self._point(block)
        system = int(number) if kind == 2.0 else 6 + int(number)
        old = control.offset_of(system)
        added = [
            value if control.absolute or value is None else value + float(was)
            for value, was in zip(values, old, strict=True)
        ]
        new = _changed(old, added)
        control.require_known_zero(f"G10 L{kind:g} P{number:g}", f"offset {system}")
        control.note_stored_offset(f"G10 L{kind:g} P{number:g}", system, clears=not new.any())
        control.set_values(system, new)

    # Home

    def _go_home(self, word: Word, block: Block) -> None:
        """G28 and G30: through the programmed point to the reference position."""
        control = self.control
        axes, settings = self._axis_words(block), control.settings
        if not axes and not settings.home_takes_all:
            raise BlockError(Wording("NC210", "home_needs_axes"))
        which = int(block.take("P") or 2) if word.numbered else 1
        self._counter.count_motions(1)
        motion, control.motion = control.motion, RAPID
        before = control.programmed_position.copy()
        moving = {name: word for name, word in axes.items() if control.absolute or word[0] != 0.0}
        if moving and (set(moving) - set("XYZ") or not np.array_equal(before, self._target(moving))):
            control.move(moving, None)
        names = axes or dict.fromkeys((*"XYZ", *control.rotary_names))
        stated = settings.reference_positions.get(which, {})
        if which > 1 and not stated.keys() >= names.keys():
            self._note(Wording("NC224", "second_reference", which=which), Severity.WARNING)
        goal = {name: float(control.machine.axis(name).home) for name in names}
        control.go_to_machine({name: stated.get(name, home) for name, home in goal.items()})
        control.motion = motion
        if settings.home_ends_length:
            self._end_length_at_home()

    def _end_length_at_home(self) -> None:
        """Take the tool length off behind G28, where the control does."""
        control = self.control
        if control.tcp:
            self._note(Wording("NC341", "g28_tcp_whether_ends_tcp"), Severity.ERROR)
            return
        control.end_length("G28")
        control.modal.edge.set(control.row, -1)

    def _target(self, axes: dict[str, AxisWord]) -> Floats:
        control = self.control
        target = control.programmed_position.copy()
        for axis, name in enumerate("XYZ"):
            if name in axes:
                value = axes[name][0] * control.length_unit
                target[axis] = value if control.absolute else target[axis] + value
        return np.asarray(target)

    # Rotations and planes

    def _rotate(self, word: Word, block: Block) -> None:
        """G68: rotate in the working plane, or with I J K about any axis."""
        control = self.control
        angle = block.take("R")
        across = "XYZ"[control.plane_axis]
        if across in block.words and not {"I", "J", "K"} & block.words.keys():
            self._note(Wording("NC213", "unused_word", word=across), Severity.ERROR)
        centre = _changed(control.programmed_position, self._point(block))
        direction = [block.take(letter) for letter in "IJK"]
        axis = np.zeros(3)
        if any(value is not None for value in direction):
            axis[:] = [value or 0.0 for value in direction]
        else:
            axis[control.plane_axis] = 1.0
        length = float(np.linalg.norm(axis))
        if angle is None or not 1e-12 < length < MAX_POSITION or not abs(angle) < MAX_POSITION:
            raise BlockError(Wording("NC210", "g68_needs_angle_r_axis"))
        control.rotate(centre, axis / length, angle)

    def _mirror(self, word: Word, block: Block) -> None:
        """G51.1: mirror each axis of the block about its value."""
        values = [block.take(letter) for letter in "XYZ"]
        if all(value is None for value in values) or any(abs(value or 0.0) > MAX_POSITION for value in values):
            raise BlockError(Wording("NC210", "mirror_needs_axes", word=word.text))
        unit = self.control.length_unit
        self.control.mirror({axis: value * unit for axis, value in enumerate(values) if value is not None})

    def _end_mirror(self, word: Word, block: Block) -> None:
        """G50.1: end the mirror image of the axes of the block."""
        axes = [axis for axis, letter in enumerate("XYZ") if block.take(letter) is not None]
        if not axes and self.control.mirrored:
            raise BlockError(Wording("NC210", "mirror_needs_axes", word=word.text))
        self.control.mirror(dict.fromkeys(axes))

    def _tilt(self, word: Word, block: Block) -> None:
        """G68.2: tilt the plane by its origin and Euler angles."""
        kind = block.take("P")
        turn = block.take("R")
        origin = np.array([value or 0.0 for value in self._point(block)])
        angles = [block.take(letter) or 0.0 for letter in "IJK"]
        order = block.take("Q")
        if kind or turn or (order is not None and order != 313):
            raise BlockError(Wording("NC220", "g68_2_p_q_not"))
        if any(not abs(angle) < MAX_POSITION for angle in angles):
            raise BlockError(Wording("NC215", "angle_not_plane"))
        self.control.tilt(origin, (angles[0], angles[1], angles[2]))

    def _align_with_plane(self, word: Word, block: Block) -> None:
        self._counter.count_motions(1)
        self.control.align_with_plane()


def _changed(old: Floats, values: list[float | None]) -> Floats:
    """Return a point with the values that are not None in place of the old ones, (3,) mm."""
    return np.array([was if value is None else value for was, value in zip(old, values, strict=True)])
