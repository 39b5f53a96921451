"""Interpreter of Fanuc programs."""

from pathlib import Path

import numpy as np

from trunnion.arrays import Codes, Floats
from trunnion.errors import Severity
from trunnion.machines import Machine, Mount
from trunnion.model.run import Orientation
from trunnion.readers.control import iso_m_codes
from trunnion.readers.control.axis_word import PositionMode
from trunnion.readers.control.row_recorder import MAX_POSITION
from trunnion.readers.families.fanuc import cycles, words
from trunnion.readers.families.fanuc.cycle_blocks import CycleInterpreter
from trunnion.readers.families.fanuc.flow import ActiveProgram, assign
from trunnion.readers.families.fanuc.nurbs import NurbsBlocks
from trunnion.readers.families.fanuc.text import FanucText
from trunnion.readers.families.fanuc.variables import ARITHMETIC
from trunnion.readers.program.interpreter import ProgramEnd
from trunnion.readers.program.options import DEFAULT_OPTIONS, RunOptions
from trunnion.readers.program.source_text import SourceText
from trunnion.readers.program.word_values import fault_of_value
from trunnion.readers.rs274.block import Block, block_reader, g_code_text, read_block
from trunnion.readers.rs274.expressions import BlockError
from trunnion.readers.rs274.interpreter import CANCEL, MOTIONS
from trunnion.wording import counted

#: G codes that are executed before the other words of a block: units and feed modes, which scale them.
_SCALING = frozenset({200, 210, 930, 940, 950})


class FanucInterpreter(CycleInterpreter):
    """Runs one Fanuc program on one machine."""

    def __init__(self, path: Path, machine: Machine, options: RunOptions = DEFAULT_OPTIONS) -> None:
        super().__init__(path, machine, options)
        # The last H, -1 before the first.
        self._length_number = -1
        # How many blocks may be read ahead; 0: any number.
        self._blocks_ahead = 0
        # G23: the areas that G22 forbids are not watched.
        self._limits_off = False
        self._needs_number = self.control.settings.needs_program_number
        self._nurbs = NurbsBlocks(self.control)
        self.control.modal.radius.set(0, 0)  # D0, the radius 0, as long as no D is written

    @property
    def _letter_table(self) -> Codes:
        return self.control.letter_table

    def _main_program(self, source: SourceText) -> ActiveProgram:
        assert isinstance(source, FanucText)
        return ActiveProgram(source, 0)

    def _may_scan(self, source: SourceText) -> bool:
        in_doubt = self._spindle_stands or self._not_stated or self._needs_number or self.control.length_ended_at
        return self._stack[-1].modal is None and not in_doubt and super()._may_scan(source)

    def _system_value(self, key: int) -> float | None:
        control = self.control
        axes = {0: "X", 1: "Y", 2: "Z", **{3 + k: name for k, name in enumerate(control.rotary_names)}}
        if 5001 <= key <= 5005 or 5041 <= key <= 5045:
            axis = (key - 1) % 20
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
        if self._needs_number:
            self._needs_number = False
            self._note("the program begins without its number: write O and digits first", Severity.ERROR, "NC160")
        reader = block_reader(text, ARITHMETIC, self._variables)
        if self._flow.accept(active, line, reader):
            self._nurbs.break_off()
            return
        block = read_block(reader, self._report_repeated_word)
        self._translate(block, self.control.settings.words)
        self._report_same_group(block.g, words.GROUPS)
        if words.NURBS in block.g or self._nurbs.is_open:
            self._add_to_nurbs(block)
        else:
            self._execute_words(active, line, block)

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
            raise BlockError(f"no program number: {text[:40]!r}")
        if active.begun and active.line != line:
            self._note("the program runs into the next one: it ends here", Severity.ERROR, "NC160")
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
            self._note("the subprogram ends without M99: the control does not return from it", Severity.ERROR, "NC160")

    def _break_off(self) -> None:
        """End the active program where it stands."""
        self._nurbs.break_off()
        if len(self._stack) < 2:
            raise ProgramEnd
        self._leave_program()

    def _execute_words(self, active: ActiveProgram, line: int, block: Block) -> None:
        control = self.control
        if words.MACRO in block.g or words.MODAL_MACRO in block.g:
            self._macro(active, block)
            assign(self._variables, block)
            return
        self._scale_words(block)
        self._feed_and_speed(block)
        tool = block.take("T")
        if tool is not None:
            control.select_tool(f"{tool:g}")
        last = control.settings.m_codes_last
        if last and len(block.m) > 1:
            self._note("two M words in a block: the control takes one", Severity.ERROR, "NC212")
        for code in block.m:
            if not last and code not in words.AFTER_MOTION:
                self._m_code(code)
        with_axis_words = self._g_codes(block)
        number = block.take("H")
        if number is not None and 0 <= number < 1e6:
            self._length_number = int(number)
        # The control keeps H after G49, but no length is in force.
        control.modal.edge.set(control.row, self._length_number if control.length_active else -1)
        radius = block.take("D")
        if radius is not None and 0 <= radius < 1e6:
            control.modal.radius.set(control.row, int(radius))
        if with_axis_words is not None:
            self._execute_with_axis_words(with_axis_words, block)
        elif not any(code in words.NO_MOTION for code in block.g):
            self._execute_motion(active, block)
        if words.ALIGN_TOOL in block.g:
            self._align_with_plane(block)
        assign(self._variables, block)
        for code in block.m:
            if last or code in words.AFTER_MOTION:
                self._m_code_after_motion(active, line, code, block)
        self._report_unused_words(block)

    def _scale_words(self, block: Block) -> None:
        """Set units and feed mode, and scale the numbers without a point accordingly."""
        control = self.control
        for code in block.g:
            if code in _SCALING:
                self._modal_g_code(code)
        in_cycle = self.motion_code in cycles.CYCLES or not cycles.CYCLES.isdisjoint(block.g)
        if words.DWELL in block.g or (in_cycle and not words.takes_number(block)):
            control.settings.scale_dwell(block)
        if words.DWELL not in block.g:
            angles = "IJKR" if words.TILT in block.g else ""
            mode, inches = control.modal.feed_mode.current, control.length_unit != 1.0
            plain = {letter for code, letter in words.VALUES if code in block.g}
            if in_cycle:
                plain.add(control.settings.repeat_letter)
            if words.JUMP_ON_INPUT in block.m:
                plain.add("Q")
            control.settings.scale(block, mode, inches, angles=angles, plain=plain)

    def _g_codes(self, block: Block) -> int | None:
        """Execute the modal G codes; returns the one that takes the axis words, if any."""
        with_axis_words = None
        self._report_values(block, words.VALUES)
        for code in block.g:
            if code in words.TAKING_AXIS_WORDS:
                if with_axis_words is not None:
                    raise BlockError("two G words want the words of the block")
                with_axis_words = code
            elif code in MOTIONS or code in cycles.CYCLES or code == CANCEL:
                self._select_motion(code)
            elif code != words.MACHINE and code not in _SCALING:
                self._g_code(code, block)
        return with_axis_words

    def _g_code(self, code: int, block: Block) -> None:
        control = self.control
        if code == words.CONTOUR and "Q" not in block.words:
            self._note("G5.1 needs Q1 for on, or Q0 for off", Severity.ERROR, "NC215")
        taken = [letter for letter in words.WORDS_OF_CODE.get(code, "") if block.take(letter) is not None]
        if code in words.STROKE_LIMIT_SWITCHES:
            control.set_mode("limits", g_code_text(code), self._limits_off, code != words.STROKE_LIMITS)
            self._limits_off = code != words.STROKE_LIMITS
        if code == words.STROKE_LIMITS and taken:
            self._note("G22 with positions limits where the axes may go: not simulated", Severity.ERROR, "NC220")
        if code in words.OFFSETS or code == words.MORE_OFFSETS:
            self._work_offset(code, block)
        elif code in (words.TCP, words.TCP_VECTOR):
            self._tcp(code, block)
        elif code == words.PLANE_OF_POSE:
            control.take_plane_of_pose()
            self._not_stated = frozenset("XYZ")
        elif code == words.SMOOTHNESS:
            self._smoothness(block)
        elif code == words.LOOK_AHEAD:
            self._look_ahead(block)
        elif code in words.EXACT_STOPS:
            control.add_exact_stop(words.EXACT_STOPS[code])
        elif code == words.NO_PLANE_OF_POSE:
            control.leave_plane_of_pose()
            self._not_stated = frozenset()
        elif code in (words.LENGTH_OFF, 430, 440):
            block.take("H")
            control.vectors = False
            control.length_ended_at = 0
            control.set_tcp(False)
            on = code != words.LENGTH_OFF and self._numbers_length(block)
            control.set_mode("length", g_code_text(code), control.length_active, on)
            control.set_length(on)
            if code == 440:
                self._note("G44: the tool length with the other sign is not simulated", Severity.ERROR, "NC220")
        elif code == words.ROTATION_OFF:
            control.cancel_rotation()
        elif code in (980, 990):
            self._to_initial = code == 980
        elif code == words.MODAL_MACRO_OFF:
            self._stack[-1].modal = None
        elif code in words.TAKEN_AS_LINES:
            self._report_g_code(code, words.NOT_SIMULATED, words.WITHOUT_PATH_EFFECT)
            self._select_motion(10)
        elif code == 960:
            control.modal.feed_mode.set(control.row, 95)
            self._report_g_code(code, words.NOT_SIMULATED, words.WITHOUT_PATH_EFFECT)
        elif code != words.ALIGN_TOOL and not self._modal_g_code(code):
            self._report_g_code(code, words.NOT_SIMULATED, words.WITHOUT_PATH_EFFECT)
            if code in (410, 420):
                self._check_look_ahead()

    def _numbers_length(self, block: Block) -> bool:
        """Whether the H in force names a tool length: H0 is none."""
        number = block.words["H"].value if "H" in block.words else float(self._length_number)
        return number != 0.0

    def _smoothness(self, block: Block) -> None:
        """Execute the word that chooses a smoothness, P, and how far corners may be rounded, E."""
        control = self.control
        degree, rounding = block.take("P"), block.take("E")
        if degree is not None and (fault := fault_of_value("smoothness", "P", degree, words.SMOOTHNESSES)):
            self._note(fault, Severity.ERROR, "NC215")
        if rounding is not None:
            control.add_tolerance(rounding * control.length_unit)

    def _look_ahead(self, block: Block) -> None:
        """Execute the word that limits how many blocks are read ahead, P; it changes no path but a compensated one."""
        blocks = block.take("P") or 0.0
        if fault := fault_of_value("look-ahead", "P", blocks, words.BLOCKS_AHEAD):
            self._note(fault, Severity.ERROR, "NC215")
        self._blocks_ahead = int(blocks) if abs(blocks) < 1e6 else 0
        self._check_look_ahead()

    def _check_look_ahead(self) -> None:
        """Report radius compensation while the control may not read ahead: it does not see the next corner."""
        if self._blocks_ahead and self.control.modal.compensation.current:
            ahead = counted(self._blocks_ahead, "block")
            what = f"radius compensation while the control reads only {ahead} ahead hides the next corner"
            self._note(f"{what}: end the limit before it", Severity.ERROR, "NC220")

    def _tcp(self, code: int, block: Block) -> None:
        """G43.4 and G43.5; P selects how the tool axis moves within blocks."""
        control = self.control
        block.take("H")
        posture = block.take("P")
        if posture not in (None, 0.0, 1.0):
            self._note(f"P{posture:g} of G43.4 and G43.5 is not known", Severity.ERROR, "NC215")
        control.length_ended_at = 0
        vectors = code == words.TCP_VECTOR
        if control.tcp and control.vectors != vectors:
            self._note(
                "G43.4 and G43.5 change without G49 between them: taken as if it were there", Severity.WARNING, "NC341"
            )
        if vectors and any(letter in block.words for letter in "IJK") and not self._only_head_turns:
            self._note("I J K in the block of G43.5: an alarm where a table turns (PS5421)", Severity.ERROR, "NC340")
        if control.plane_of_pose:
            self._note(
                "TCP in the plane of the rotary position: the control has one or the other", Severity.ERROR, "NC340"
            )
        control.set_tcp(True)
        control.set_length(True)
        control.set_orientation(Orientation.GREAT_CIRCLE if posture == 1.0 else Orientation.ANGLES)
        control.vectors = vectors

    def _may_be_left_on(self) -> list[str]:
        left = [g_code_text(self.motion_code)] if self.motion_code in cycles.CYCLES else []
        left += ["G66"] if self._stack[0].modal is not None or self._stack[-1].modal is not None else []
        return left

    @property
    def _only_head_turns(self) -> bool:
        return all(self._machine.axes[column].mount is Mount.TOOL for column in self._machine.rotary)

    def _m_code(self, code: int) -> None:
        if code in iso_m_codes.SPINDLE:
            self._spindle_stands = ""
        elif code == words.RIGID_TAP and self.motion_code not in cycles.THREADS:
            self._spindle_stands = "M29 has stopped it for a thread"
        if not self._common_m_code(code):
            self.control.add_builders_word("M", float(code))

    def _m_code_after_motion(self, active: ActiveProgram, line: int, code: int, block: Block) -> None:
        if code == words.CALL:
            self._call(block)
        elif code == words.LOCAL_CALL:
            self._local_call(active, line, block)
        elif code == words.JUMP_ON_INPUT:
            self._report_jump_on_input(block)
        elif code == words.RETURN:
            self._return(active, line, block)
        elif code == words.CALL_FILE:
            for letter in "PL":
                block.take(letter)
            self._note("M198: programs of other folders are not called", Severity.ERROR, "NC132")
        else:
            self._m_code(code)

    # Motion

    def _execute_motion(self, active: ActiveProgram, block: Block) -> None:
        """Execute the motion or cycle in force."""
        control = self.control
        axes = self._axis_words(block)
        if axes:
            self._check_cut(axes, of_machine=words.MACHINE in block.g)
        vector = self._vector(block) if control.vectors and self.motion_code in (0, 10) else None
        if control.vectors and axes.keys() & set(control.rotary_names) and words.MACHINE not in block.g:
            self._note("rotary words under G43.5, which takes I J K: an alarm (PS5421)", Severity.ERROR, "NC340")
        if control.plane_of_pose and axes.keys() & set(control.rotary_names):
            self._note("rotary axes turn in the plane of the rotary position: end it first", Severity.ERROR, "NC340")
        if self.motion_code == words.NURBS and words.MACHINE not in block.g and (axes or vector is not None):
            raise BlockError("a position behind the last knot of G6.2, where only G6.2 goes on", code="NC322")
        if self.motion_code in cycles.CYCLES:
            self._cycle(block, axes)
            if axes:
                self._call_modal_macro(active)
            return
        circle = self.motion_code in (20, 30) and any(letter in block.words for letter in "IJKR")
        if not axes and vector is None and not circle:
            return
        if words.MACHINE in block.g:
            if not control.absolute:
                raise BlockError("G53 needs G90")
            control.motion = MOTIONS[self.motion_code]
            absolute = {name: (word[0], PositionMode.ABSOLUTE) for name, word in axes.items()}
            control.move(absolute, None, machine_frame=True, feed_written=self._check_feed(block))
        elif vector is not None:
            control.motion = MOTIONS[self.motion_code]
            control.move(axes, vector, feed_written=self._check_feed(block))
        else:
            self._move(block, axes)
        self._call_modal_macro(active)

    def _vector(self, block: Block) -> Floats | None:
        """G43.5: return the tool axis I J K; components that are not written are 0."""
        values = [block.take(letter) for letter in "IJK"]
        incline = block.take("Q")
        if incline:
            self._note("the inclination Q of G43.5 is not simulated", Severity.ERROR, "NC220")
        if all(value is None for value in values):
            return None
        vector = np.array([value or 0.0 for value in values])
        if not 1e-12 < float(np.linalg.norm(vector)) < MAX_POSITION:
            raise BlockError("the tool axis has no direction")
        return vector
