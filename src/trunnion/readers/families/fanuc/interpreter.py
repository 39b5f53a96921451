"""Interpreter of Fanuc programs."""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Final

import numpy as np

from trunnion.arrays import Codes, Floats
from trunnion.errors import Severity
from trunnion.machines import Machine, Mount
from trunnion.messages import Wording
from trunnion.model.mode_words import TOOL_AXIS
from trunnion.model.run import Orientation
from trunnion.readers.control.axis_word import PositionMode
from trunnion.readers.control.row_recorder import MAX_POSITION
from trunnion.readers.control.virtual_control import LINEAR
from trunnion.readers.families.fanuc import words
from trunnion.readers.families.fanuc.contour_modes import ContourModes
from trunnion.readers.families.fanuc.corners import cut_corner
from trunnion.readers.families.fanuc.cycle_blocks import CycleInterpreter
from trunnion.readers.families.fanuc.flow import ActiveProgram, assign
from trunnion.readers.families.fanuc.nurbs import NurbsBlocks
from trunnion.readers.families.fanuc.polar_positions import PolarPositions
from trunnion.readers.families.fanuc.variables import ARITHMETIC
from trunnion.readers.program.interpreter import ProgramEnd
from trunnion.readers.program.options import DEFAULT_OPTIONS, RunOptions
from trunnion.readers.program.source_text import SourceText
from trunnion.readers.rs274.block import Block, block_reader
from trunnion.readers.rs274.expressions import BlockError
from trunnion.readers.rs274.interpreter import MOTIONS
from trunnion.readers.rs274.word_table import Word

#: A program's name in place of its number, as controls from 30i on have it.
_PROGRAM_NAME: Final = re.compile(r"<[A-Z0-9+_.-]{1,32}>")


class FanucInterpreter(CycleInterpreter):
    """Runs one Fanuc program on one machine."""

    table = words.TABLE
    corner_letters, program_letter = ("R", "C"), "O"

    def __init__(self, path: Path, machine: Machine, options: RunOptions = DEFAULT_OPTIONS) -> None:
        super().__init__(path, machine, options)
        # The last H, -1 before the first.
        self._length_number = -1
        # The word that has put the tool length on, with TCP or without.
        self._length_word = "G43"
        # How many blocks may be read ahead; 0: any number.
        self._blocks_ahead = 0
        # G23: the areas that G22 forbids are not watched.
        self._limits_off = False
        # The row from which radius compensation begins or ends; -1: no motion waits for that.
        self._compensates_from = -1
        self._limits_set_at = 0
        self._polar = PolarPositions(self.control)
        self._contour_modes = ContourModes(self._note)
        self._needs_number = self.control.settings.needs_program_number
        self._nurbs = NurbsBlocks(self.control)
        self.control.modal.radius.set(0, 0)  # D0, the radius 0, as long as no D is written

    @property
    def _letter_table(self) -> Codes:
        return self.control.letter_table

    def _may_scan(self, source: SourceText) -> bool:
        in_doubt = (
            self._polar.on
            or self._spindle_stands
            or self._not_stated
            or self._needs_number
            or self.control.length_ended_at
        )
        return self._stack[-1].modal is None and not in_doubt and super()._may_scan(source)

    def _system_value(self, key: int) -> float | None:
        control = self.control
        axes = {0: "X", 1: "Y", 2: "Z", **{3 + k: name for k, name in enumerate(control.rotary_names)}}
        if 5001 <= key <= 5005 or 5041 <= key <= 5045:
            axis = (key - 1) % 20
            with_length = control.tcp or (axis == 2 and control.length_active)
            if key > 5040 and axis < 3 and with_length and not control.machine.tool_length:
                return None  # the present position counts the tool length, which nothing states
            if axis < 3:
                return float(control.programmed_position[axis]) / control.length_unit
            control.resolve_rows()
            return float(control.current_joints[control.machine.column(axes[axis])])
        if 5021 <= key <= 5025:
            control.resolve_rows()
            value = float(control.current_joints[control.machine.column(axes[key - 5021])])
            return value / control.length_unit if key <= 5023 else value
        return None

    # Blocks

    def _execute_block(self, active: ActiveProgram, line: int, text: str) -> None:
        if text[0] in "O:":
            self._needs_number = False
            self._program_number(active, line, text)
            return
        active.has_blocks = True
        if self._needs_number:
            self._needs_number = False
            if _PROGRAM_NAME.fullmatch(text):
                active.begun = True
                return
            self._note(Wording("NC168", "program_begins_without_number"), Severity.WARNING)
        reader = block_reader(text, ARITHMETIC, self._variables)
        if self._flow.accept(active, line, reader):
            self._nurbs.break_off()
            return
        block = self._read_block(reader)
        self._here = active, line
        if words.NURBS in block.g or self._nurbs.is_open:
            self._add_to_nurbs(block)
        elif words.MACROS.isdisjoint(block.g):
            self._execute_words(block)
        else:
            self._macro(active, block)
            assign(self._variables, block)

    def _add_to_nurbs(self, block: Block) -> None:
        """Execute a block of a NURBS, the first of which has G6.2; no other motion may follow without G0 to G3."""
        self.motion_code = words.NURBS
        self._scale_words(block)
        self._feed_and_speed(block)
        self._counter.count_motions(self._nurbs.add(block))
        self._report_unused_words(block)

    def _program_number(self, active: ActiveProgram, line: int, text: str) -> None:
        """Start a program at its O number; if another program runs into it, that one ends."""
        digits = text[1:]
        if not digits.isdigit() or len(digits) > 8:
            raise BlockError(Wording("NC210", "no_program_number", text=repr(text[:40])))
        has_begun = active.begun or active.has_blocks or self.control.row > active.row
        if has_begun and active.line != line:
            self._note(Wording("NC160", "program_runs_next_ends_here"), Severity.ERROR)
            self._break_off()
        active.begun = True

    def _leave_program(self) -> None:
        self._nurbs.break_off()
        super()._leave_program()

    def _end_of_file(self, active: ActiveProgram) -> None:
        self._check_return()
        self._break_off()

    def _end_of_source(self) -> None:
        self._check_return()
        super()._end_of_source()

    def _check_return(self) -> None:
        if len(self._stack) > 1:
            self._note(Wording("NC160", "subprogram_ends_without_m99_control"), Severity.ERROR)

    def _break_off(self) -> None:
        """End the active program where it stands."""
        self._nurbs.break_off()
        if len(self._stack) < 2:
            raise ProgramEnd
        self._leave_program()

    def _execute_words(self, block: Block) -> None:
        waits, row = self.control.awaits_element, self.control.row
        super()._execute_words(block)
        if waits and row == self.control.row:
            self.control.end_contour()  # the motion that makes a corner must be in the next block (PS0051)
        self._report_unused_words(block)  # behind the M codes after the motion, which take some

    def _scale_words(self, block: Block) -> None:
        """Set units and feed mode, and scale the numbers without a point accordingly."""
        super()._scale_words(block)
        control = self.control
        cycles = self.table.cycles
        in_cycle = self.motion_code in cycles or any(code in cycles for code in block.g)
        if words.DWELL in block.g or (in_cycle and not words.takes_number(block)):
            control.settings.scale_dwell(block)
        if words.DWELL not in block.g:
            angles = "IJKR" if words.TILT in block.g else ""
            angles += self._polar.letters[1] if self._is_polar(block) else ""
            plain = {letter for word in self.table.words("G", block.g) for letter in word.values}
            if in_cycle:
                plain.update(control.settings.counts_in_cycles({self.motion_code, *block.g}))
            if words.JUMP_ON_INPUT in block.m:
                plain.add("Q")
            control.scale(block, angles=angles, plain=plain)

    def _late_words(self, codes: Sequence[Word]) -> Sequence[Word]:
        if not self.control.settings.m_codes_last:
            return super()._late_words(codes)
        if len(codes) > 1:
            self._note(Wording("NC212", "two_m_words_block_control"), Severity.ERROR)
        return codes

    def _before_motion(self, codes: Sequence[Word], block: Block) -> None:
        """Take the numbers of the tool's length and of its radius."""
        modal, row = self.control.modal, self.control.row
        if (number := block.take("H")) is not None and 0 <= number < 1e6:
            self._length_number = int(number)
            if number == 0.0 and self.control.length_active:
                self.control.end_length("H0")
        # The control keeps H after G49, but no length is in force.
        modal.edge.set(row, self._length_number if self.control.length_active else -1)
        radius = block.take("D")
        if radius is not None and 0 <= radius < 1e6:
            modal.radius.set(row, int(radius))
        if self._compensates_from == row and MOTIONS.get(self.motion_code, 0) > LINEAR:
            self._compensates_from = -1
            self._note(Wording("NC210", "compensation_switched_on_arc"), Severity.ERROR)

    def _close_block(self, block: Block) -> None:
        assign(self._variables, block)

    # Words

    def _changes_something(self, word: Word, block: Block) -> bool:
        if word.act == "leave_plane_of_pose":
            return self.control.plane_of_pose
        return word.act == "tcp" or super()._changes_something(word, block)

    def _contour_control(self, word: Word, block: Block) -> None:
        self._contour_modes.switch(word, block)

    def _exact_stop(self, word: Word, block: Block) -> None:
        self.control.add_exact_stop(word.sets)

    def _stroke_limits(self, word: Word, block: Block) -> None:
        self.control.set_mode("limits", word.text, self._limits_off, word.sets)
        self._limits_off, self._limits_set_at = word.sets, self.control.row
        if any(letter in block.words for letter in word.letters):
            self._note(Wording("NC220", "g22_positions_limits_axes_may"), Severity.ERROR)

    def _take_plane_of_pose(self, word: Word, block: Block) -> None:
        self.control.take_plane_of_pose()
        self._not_stated = frozenset("XYZ")

    def _leave_plane_of_pose(self, word: Word, block: Block) -> None:
        self.control.leave_plane_of_pose()
        self._not_stated = frozenset()

    def _length(self, word: Word, block: Block) -> None:
        control = self.control
        control.vectors = False
        control.length_ended_at = 0
        control.set_tcp(False)
        on = word.sets and self._numbers_length(block)
        self._length_word = word.text
        control.set_mode("length", word.text, control.length_active, on)
        control.set_length(on)
        # Parameter 5001 says whether G43 counts across the plane or along Z.
        if on and control.plane_axis != 2 and not control.settings.length_along_z:
            control.record_length(control.plane_axis)
        if word.text == "G44":
            self._note(Wording("NC220", "g44_tool_length_other_sign"), Severity.ERROR)

    def _cancel_rotation(self, word: Word, block: Block) -> None:
        self.control.cancel_rotation()

    def _end_modal_macro(self, word: Word, block: Block) -> None:
        self._stack[-1].modal = None

    def _compensation(self, word: Word, block: Block) -> None:
        before = self.control.modal.compensation.current
        super()._compensation(word, block)
        if bool(before) != bool(word.sets):
            self._compensates_from = self.control.row

    def _begin_compensation(self, block: Block) -> None:
        self._check_look_ahead()
        self.control.judge_mirror()

    def _numbers_length(self, block: Block) -> bool:
        """Whether the H in force names a tool length: H0 is none."""
        number = block.words["H"].value if "H" in block.words else float(self._length_number)
        return number != 0.0

    def _smoothness(self, word: Word, block: Block) -> None:
        rounding = block.take("E")
        if rounding is not None:
            self.control.add_tolerance(rounding * self.control.length_unit)

    def _look_ahead(self, word: Word, block: Block) -> None:
        """Limit how many blocks are read ahead, which changes no path but a compensated one."""
        blocks = block.take("P") or 0.0
        self._blocks_ahead = int(blocks) if abs(blocks) < 1e6 else 0
        self._check_look_ahead()

    def _check_look_ahead(self) -> None:
        """Report radius compensation while the control may not read ahead: it does not see the next corner."""
        if self._blocks_ahead and self.control.modal.compensation.current:
            self._note(Wording("NC220", "look_ahead_under_compensation", count=self._blocks_ahead), Severity.ERROR)

    def _tcp(self, word: Word, block: Block) -> None:
        """G43.4 and G43.5; P selects how the tool axis moves within blocks."""
        control = self.control
        posture = block.take("P")
        if posture not in (None, 0.0, 1.0):
            self._note(Wording("NC215", "unknown_posture", posture=posture), Severity.ERROR)
        control.length_ended_at = 0
        vectors = word.sets
        if control.tcp and control.vectors != vectors:
            self._note(Wording("NC341", "g43_4_g43_5_change"), Severity.WARNING)
        if vectors and any(letter in block.words for letter in "IJK") and not self._only_head_turns:
            self._note(Wording("NC340", "vector_in_block_of_g43_5"), Severity.ERROR)
        if control.plane_of_pose:
            self._note(Wording("NC340", "tcp_plane_rotary_position_control"), Severity.ERROR)
        self._length_word = control.settings.words.own_text(word.code)
        control.set_tcp(True)
        control.set_length(True)
        control.set_orientation(Orientation.GREAT_CIRCLE if posture == 1.0 else Orientation.ANGLES)
        control.say_mode(TOOL_AXIS, self._length_word)
        control.vectors = vectors
        control.judge_mirror()

    def _may_be_left_on(self) -> list[str]:
        left = super()._may_be_left_on()
        left += ["G23"] if self._limits_off and self.control.cuts_behind(self._limits_set_at) else []
        control = self.control
        has_length = control.length_active and control.cuts_behind(0)
        left += [self._length_word] if has_length and not control.sets_behind_use("length") else []
        left += ["G68.2"] if control.tilted and not control.plane_of_pose else []
        left += ["G16"] if self._polar.on else []
        left += [] if control.unused_shift else control.shifts_on
        left += self._contour_modes.on
        left += ["G66"] if self._stack[0].modal is not None or self._stack[-1].modal is not None else []
        return left

    @property
    def _only_head_turns(self) -> bool:
        return all(self._machine.axes[column].mount is Mount.TOOL for column in self._machine.rotary)

    def _iso(self, word: Word, block: Block) -> None:
        if word.group == "spindle":
            self._spindle_stands = None
        super()._iso(word, block)

    # Motion

    def _execute_motion(self, codes: Sequence[Word], block: Block) -> None:
        control = self.control
        axes = self._axis_words(block)
        if axes:
            self._check_cut(axes, of_machine=words.MACHINE in block.g)
        if self._is_polar(block):
            axes = self._polar.position(axes, block.words.get(control.settings.repeat_letter))
        vector = self._vector(block) if control.vectors and self.motion_code in (0, 10) else None
        if control.vectors and axes.keys() & set(control.rotary_names) and words.MACHINE not in block.g:
            self._note(Wording("NC340", "rotary_words_with_vector"), Severity.ERROR)
        if control.plane_of_pose and axes.keys() & set(control.rotary_names):
            self._note(Wording("NC340", "rotary_axes_turn_plane_rotary"), Severity.ERROR)
        if self.motion_code == words.NURBS and words.MACHINE not in block.g and (axes or vector is not None):
            raise BlockError(Wording("NC322", "position_behind_last_knot_g6"))
        if self.motion_code in self.table.cycles:
            self._drill_block(block, axes)
            if axes:
                self._call_modal_macro()
            return
        circle = self.motion_code in (20, 30) and any(letter in block.words for letter in "IJKR")
        if not axes and vector is None and not circle:
            return
        if words.MACHINE in block.g:
            if not control.absolute:
                raise BlockError(Wording("NC210", "g53_needs_g90"))
            control.motion = MOTIONS[self.motion_code]
            absolute = {name: (word[0], PositionMode.ABSOLUTE) for name, word in axes.items()}
            control.move(absolute, None, machine_frame=True, feed_written=self._check_feed(block))
        elif vector is not None:
            control.motion = MOTIONS[self.motion_code]
            control.move(axes, vector, feed_written=self._check_feed(block))
        else:
            self._move(block, axes)
            cut_corner(control, block)
        self._call_modal_macro()

    def _is_polar(self, block: Block) -> bool:
        """Whether the axis words of a block, if they are a position, are radius and angle."""
        return self._polar.on and words.MACHINE not in block.g

    def _polar_positions(self, word: Word, block: Block) -> None:
        self._polar.switch(word.sets)

    def _vector(self, block: Block) -> Floats | None:
        """G43.5: return the tool axis I J K; components that are not written are 0."""
        values = [block.take(letter) for letter in "IJK"]
        incline = block.take("Q")
        if incline:
            self._note(Wording("NC220", "inclination_q_g43_5_not"), Severity.ERROR)
        if all(value is None for value in values):
            return None
        vector = np.array([value or 0.0 for value in values])
        if not 1e-12 < float(np.linalg.norm(vector)) < MAX_POSITION:
            raise BlockError(Wording("NC210", "tool_axis_no_direction"))
        return vector
