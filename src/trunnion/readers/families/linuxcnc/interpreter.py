"""Interpreter of LinuxCNC programs."""

import re
from typing import Final

import numpy as np

from trunnion.arrays import Codes
from trunnion.errors import Severity
from trunnion.readers.control.axis_word import PositionMode
from trunnion.readers.families.linuxcnc import cycles, words
from trunnion.readers.families.linuxcnc.control import ORDER
from trunnion.readers.families.linuxcnc.cycle_blocks import CycleInterpreter
from trunnion.readers.families.linuxcnc.flow import ActiveProgram
from trunnion.readers.families.linuxcnc.parameters import ARITHMETIC
from trunnion.readers.families.linuxcnc.text import LinuxcncText
from trunnion.readers.program.source_text import SourceText
from trunnion.readers.program.word_values import fault_of_value
from trunnion.readers.rs274.block import Block, block_reader, g_code_text, read_block
from trunnion.readers.rs274.expressions import BlockError
from trunnion.readers.rs274.interpreter import CANCEL, MOTIONS
from trunnion.wording import format_duration

#: Comments that are messages to the operator.
_MESSAGE: Final = re.compile(r"[ \t]*(?:MSG|DEBUG|PRINT),[ \t]*(.*)", re.IGNORECASE | re.DOTALL)

#: Comments that run Python, or end the program.
_PROGRAM: Final = re.compile(r"\s*(PY|PYRUN|ABORT)\s*,", re.IGNORECASE)

#: M codes that act after the motion of their block.
_AFTER_MOTION: Final = frozenset({0, 1, 2, 30, 60})

_FEED_MODES: Final = frozenset({930, 940, 950})


class LinuxcncInterpreter(CycleInterpreter):
    """Runs one LinuxCNC program on one machine."""

    semicolon = True
    motion_code = CANCEL

    @property
    def _letter_table(self) -> Codes:
        return self.control.letter_table

    def _main_program(self, source: SourceText) -> ActiveProgram:
        assert isinstance(source, LinuxcncText)
        return ActiveProgram(source, 0)

    def _may_scan(self, source: SourceText) -> bool:
        return super()._may_scan(source) and not any(self.control.rotary_offsets.values())

    # Parameters

    def _system_value(self, key: int | str) -> float | None:
        control = self.control
        if isinstance(key, int):
            if 5420 <= key < 5426:
                return self._position(key - 5420)
            if 5210 < key <= 5216:
                value = float(control.axis_offset[key - 5211])
                return value / control.length_unit if key <= 5213 else value
            return {5210: float(control.axis_offset_active), 5220: float(control.system)}.get(key)
        if len(key) == 2 and key[0] == "_" and key[1] in ORDER:
            return self._position(ORDER.index(key[1]))
        feed = control.programmed_feed
        values: dict[str, float | None] = {
            "_VALUE": self._returned or 0.0,
            "_VALUE_RETURNED": float(self._returned is not None),
            "_LINE": float(control.line),
            "_FEED": 0.0 if np.isnan(feed) else feed / control.feed_unit,
            "_RPM": float(control.modal.rpm.current),
            "_METRIC": float(control.length_unit == 1.0),
            "_IMPERIAL": float(control.length_unit != 1.0),
            "_ABSOLUTE": float(control.absolute),
            "_INCREMENTAL": float(not control.absolute),
            "_MOTION_MODE": float(self.motion_code),
            "_PLANE": {2: 170.0, 1: 180.0, 0: 190.0}[control.plane_axis],
            "_COORD_SYSTEM": float(words.OFFSETS[control.system - 1]),
        }
        return values.get(key)

    def _position(self, axis: int) -> float:
        value = float(self.control.position()[axis])
        return value / self.control.length_unit if axis < 3 else value

    # Blocks

    def _report_repeated_word(self, letter: str) -> None:
        raise BlockError(f"{letter} is written twice", code="NC212")

    def _handle_comment(self, comment: str) -> None:
        if (program := _PROGRAM.match(comment)) is not None:
            what = f"the comment {program.group(1).lower()}, is executed, and what it does is not simulated"
            self._note(what, Severity.ERROR, "NC220")
        match = _MESSAGE.match(comment)
        if match is not None:
            self.control.add_event("message", match.group(1))

    def _execute_block(self, active: ActiveProgram, line: int, text: str) -> None:
        reader = block_reader(text, ARITHMETIC, self._parameters)
        if reader.accept("O"):
            self._o_word(active, line, reader)
            return
        block = read_block(reader, self._report_repeated_word)
        self._translate(block, self.control.own_words)
        self._refuse_same_group(block)
        self._execute_words(block)
        for key, value in block.assignments:
            self._parameters.set(key, value or 0.0)

    @staticmethod
    def _refuse_same_group(block: Block) -> None:
        """Refuse two G codes or two M codes of one group, also twice the same, as LinuxCNC does."""
        for letter, codes, groups in (("G", block.g, words.GROUPS), ("M", block.m, words.GROUPS_M)):
            for group in groups:
                found = [code for code in codes if code in group]
                if len(found) > 1:
                    names = [g_code_text(code) if letter == "G" else f"M{code}" for code in found]
                    what = f"{' and '.join(names[:2])} are of one group, of which a block has one"
                    raise BlockError(what, code="NC212")

    def _execute_words(self, block: Block) -> None:
        control = self.control
        for code in block.g:
            if code in _FEED_MODES:
                self._modal_g_code(code)
                if code != 930:
                    # LinuxCNC forgets the feed, even if the mode does not change.
                    control.programmed_feed = np.nan
        self._feed_and_speed(block)
        tool = block.take("T")
        if tool is not None:
            control.select_tool(f"{tool:g}")
        for code in block.m:
            if code not in _AFTER_MOTION:
                self._m_code(code, block)
        special = self._g_codes(block)
        selected = [code for code in block.g if code in cycles.CYCLES]
        if CANCEL in block.g and not self._has_motion_code(block):
            selected = [CANCEL]
        if special in words.TAKING_AXIS_WORDS or any(code in words.NO_MOTION for code in block.g):
            self.motion_code = CANCEL if CANCEL in selected else self.motion_code
        else:
            self._execute_motion(block, selected[-1] if selected else None)
        self._report_unused_words(block)
        for code in block.m:
            if code in _AFTER_MOTION:
                self._m_code(code, block)

    def _g_codes(self, block: Block) -> int | None:
        """Execute the G codes of a block other than motions; returns that of ``words.SPECIAL``, if any."""
        special = None
        self._report_values(block, words.VALUES)
        for code in block.g:
            if code in words.SPECIAL:
                special = code
            elif code not in cycles.CYCLES and code not in _FEED_MODES and code not in (CANCEL, words.MACHINE):
                self._g_code(code, block)
        if special in words.TAKING_AXIS_WORDS and self._has_motion_code(block):
            raise BlockError("two G words want the axis words")
        if special is not None:
            self._execute_special(special, block)
        return special

    @staticmethod
    def _has_motion_code(block: Block) -> bool:
        """Whether a block has a G code for motions and cycles besides G80, which counts then."""
        return any(
            code in MOTIONS or code in words.TAKEN_AS_LINES or code == words.RIGID_TAP or code in cycles.CYCLES
            for code in block.g
        )

    def _g_code(self, code: int, block: Block) -> None:
        control = self.control
        if code in words.ADDED_LENGTHS:
            self._added_length(code, block)
        self._take_radius(code, block)
        for letter in words.WORDS_OF_CODE.get(code, ""):
            block.take(letter)
        if code in words.OFFSETS:
            control.system = words.OFFSETS.index(code) + 1
            control.set_offset(_offset_code(control.system), f"G{code / 10:g}")
            control.update_frame()
        elif code == words.CONTINUOUS:
            tolerance, naive = block.take("P"), block.take("Q")
            if (tolerance or 0.0) < 0.0 or (naive or 0.0) < 0.0:
                self._note("G64 with a tolerance below zero", Severity.ERROR, "NC215")
            # P0 is no tolerance: the control keeps its speed, as without P.
            control.add_tolerance(tolerance * control.length_unit if tolerance else np.inf)
            control.add_exact_stop("off")
        elif code in (610, 611):
            control.add_tolerance(0.0)
            control.add_exact_stop("path" if code == 610 else "on")
        elif code in (980, 990):
            self._to_initial = code == 980
        elif code in words.LENGTHS:
            number = self._length_number(block) if words.LENGTHS[code] else -1
            if number != control.modal.edge.current:
                control.judge_new_length(g_code_text(code))
            control.set_mode("length", g_code_text(code), control.length_active, words.LENGTHS[code])
            control.set_length(words.LENGTHS[code])
            control.modal.edge.set(control.row, number)
        elif code in (901, 911):
            control.set_mode("centres", g_code_text(code), control.relative_centres, code == 911)
            control.relative_centres = code == 911
        elif code in words.TAKEN_AS_LINES:
            self._report_g_code(code, words.NOT_SIMULATED, words.WITHOUT_PATH_EFFECT)
            self.motion_code = code
        elif code == words.RIGID_TAP:
            self.motion_code = code
        elif code == 960:
            control.modal.feed_mode.set(control.row, 95)
            self._report_g_code(code, words.NOT_SIMULATED, words.WITHOUT_PATH_EFFECT)
        elif not self._modal_g_code(code):
            self._report_g_code(code, words.NOT_SIMULATED, words.WITHOUT_PATH_EFFECT)

    def _added_length(self, code: int, block: Block) -> None:
        """G43.1 and G43.2: what they add to the length of the tool, which the path does not show."""
        name = g_code_text(code)
        for letter in "XYZ":
            if value := block.take(letter):
                self.control.add_tool_delta(f"{name} {letter}", value * self.control.length_unit)
        if block.take("H"):
            self._note(f"{name} H: the length of another tool is not simulated", Severity.ERROR, "NC220")

    def _length_number(self, block: Block) -> int:
        """Return which length G43 takes: that of H; with H0 or none of the tool in the spindle, 0 if it is unknown."""
        if "H" in block.words and block.words["H"].value:
            return int(block.words["H"].value)
        name = self.control.tool_in_spindle
        return int(name) if name.isdigit() else 0

    def _m_code(self, code: int, block: Block) -> None:
        control = self.control
        if code == words.WAIT_FOR_INPUT and block.words.get("L") is not None and block.words["L"].value:
            seconds = block.words["Q"].value if "Q" in block.words else 0.0
            control.note_wait(f"M66 waits for an input, up to {format_duration(max(seconds, 0.0))}")
        if code in words.INPUTS_AND_OUTPUTS and (fault := words.fault_of_signal(code, block)):
            self._note(f"{fault}: LinuxCNC refuses it", Severity.ERROR, "NC218")
        for letter in words.WITHOUT_PATH_EFFECT_M.get(code, "") or words.WORDS_OF_M_CODE.get(code, ""):
            value, known = block.take(letter), words.VALUES_M.get((code, letter))
            fault = "" if value is None or known is None else fault_of_value(f"M{code}", letter, value, known)
            kind = "NC215"
            if code in words.ANALOG_OUTPUTS and letter == "E" and value == words.KINEMATICS_OUTPUT:
                fault, kind = f"M{code} E{value:g} switches the kinematics: not simulated; M428 and M429 are", "NC220"
            if code == words.ADAPTIVE_FEED and value != 0.0:
                fault, kind = "M52 lets a signal scale the feed: not simulated; M52 P0 does not", "NC220"
            if fault:
                self._note(fault, Severity.ERROR, kind)
        if code in (words.TCP_ON, words.TCP_OFF):
            control.set_tcp(code == words.TCP_ON)
        elif code == 61:
            tool = block.take("Q")
            control.select_tool(f"{tool or 0:g}")
            control.change_tool()
        elif code == 60:
            control.add_event("stop", "pallet")
        elif code in words.USERS:
            for letter in "PQ":
                block.take(letter)
            control.add_builders_word("M", float(code))
            if code in words.USERS_TCP:
                text = f"M{code} switches TCP in some configurations: M428 and M429 do, or declare what it does"
                self._note(text, Severity.ERROR, "NC224")
        elif code in words.NOT_SIMULATED_M:
            self._note(f"M{code}: {words.NOT_SIMULATED_M[code]}", Severity.ERROR, "NC220")
        elif code == words.TCP_USER:
            self._note("M430: kinematics of the user are not known", Severity.ERROR, "NC224")
        elif code not in words.WITHOUT_PATH_EFFECT_M and not self._common_m_code(code):
            self._note(f"unknown word M{code}", Severity.ERROR, "NC211")

    # Motion

    def _execute_motion(self, block: Block, selected: int | None) -> None:
        """Execute the motion or cycle in force; ``selected`` is the cycle, or G80, of the block."""
        explicit = self._has_motion_code(block)
        if selected == CANCEL:
            self.motion_code, self._initial = CANCEL, None
        code = selected if selected is not None else self.motion_code
        if code != CANCEL and code not in cycles.CYCLES:
            self._initial = None
        axes = self._axis_words(block)
        circle = code in (20, 30) and (explicit or any(letter in block.words for letter in "IJKR"))
        if not axes and not circle:
            if explicit and code in cycles.CYCLES:
                self._note("a cycle without a position", Severity.ERROR, "NC218")
                self.motion_code = code
        elif code == CANCEL:
            self._initial = None
            self._note(
                "a position without a G word that goes there: the block is not executed", Severity.ERROR, "NC218"
            )
        elif code in cycles.CYCLES:
            self._cycle(code, block, axes)
        elif code == words.RIGID_TAP:
            self._rigid_tap(block, axes)
        elif words.MACHINE in block.g:
            self._check_machine_move(block, code)
            absolute = {name: (word[0], PositionMode.ABSOLUTE) for name, word in axes.items()}
            self.control.machine_move(absolute, feed_written=self._check_feed(block))
        else:
            turns = block.take("P") if code in (20, 30) else None
            if turns is not None and not 1 <= turns == int(turns):
                raise BlockError("P of a circle is the number of its turns")
            here, self.motion_code = self.motion_code, 10 if code in words.TAKEN_AS_LINES else self.motion_code
            self._move(block, self._with_rotary_offsets(axes), turns=int(turns) - 1 if turns else 0)
            self.motion_code = here

    def _check_machine_move(self, block: Block, code: int) -> None:
        if code in (20, 30):
            block.take("P")
        if code not in (0, 10) or not self.control.absolute:
            raise BlockError("G53 needs G0 or G1, and G90")
        self.control.motion = MOTIONS[code]


def _offset_code(system: int) -> int:
    """Return the value of column ``work_offset``: 54 to 59, and 591 to 593 for G59.1 to G59.3."""
    return 53 + system if system <= 6 else 584 + system
