"""Interpreter of LinuxCNC programs."""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Final

import numpy as np

from trunnion.arrays import Codes
from trunnion.errors import Severity
from trunnion.machines import Machine
from trunnion.messages import Wording
from trunnion.readers.control.axis_word import AxisWord, PositionMode
from trunnion.readers.control.iso_m_codes import PROGRAM_ENDS
from trunnion.readers.families.linuxcnc import words
from trunnion.readers.families.linuxcnc.control import ORDER
from trunnion.readers.families.linuxcnc.cycle_blocks import CycleInterpreter
from trunnion.readers.families.linuxcnc.flow import ActiveProgram
from trunnion.readers.families.linuxcnc.parameters import ARITHMETIC
from trunnion.readers.families.linuxcnc.polar_positions import SIGNS, polar_words
from trunnion.readers.families.linuxcnc.spline_blocks import SplineBlocks
from trunnion.readers.families.linuxcnc.text import LinuxcncText
from trunnion.readers.program.options import DEFAULT_OPTIONS, RunOptions
from trunnion.readers.program.source_text import SourceText
from trunnion.readers.rs274.block import Block, block_reader
from trunnion.readers.rs274.expressions import BlockError
from trunnion.readers.rs274.interpreter import CANCEL, MOTIONS
from trunnion.readers.rs274.word_table import Word
from trunnion.wording import format_duration

#: Comments that are messages to the operator.
_MESSAGE: Final = re.compile(r"[ \t]*(?:MSG|DEBUG|PRINT),[ \t]*(.*)", re.IGNORECASE | re.DOTALL)

#: Comments that run Python, or end the program.
_PROGRAM: Final = re.compile(r"\s*(PY|PYRUN|ABORT)\s*,", re.IGNORECASE)

#: The mode that says within what the path is rounded (P), and lines are joined (Q).
_WITHIN: Final = "tolerances of G64"


class LinuxcncInterpreter(CycleInterpreter):
    """Runs one LinuxCNC program on one machine."""

    table = words.TABLE
    semicolon = True
    motion_code = CANCEL
    signs = SIGNS
    has_builders_words = False

    def __init__(self, path: Path, machine: Machine, options: RunOptions = DEFAULT_OPTIONS) -> None:
        super().__init__(path, machine, options)
        self._splines = SplineBlocks(self.control, self._counter.count_motions)

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
            "_COORD_SYSTEM": float(_parameter_of_offset(control.system)),
        }
        return values.get(key)

    def _position(self, axis: int) -> float:
        value = float(self.control.position()[axis])
        return value / self.control.length_unit if axis < 3 else value

    # Blocks

    def _report_repeated_word(self, letter: str) -> None:
        raise BlockError(Wording("NC212", "written_twice", word=letter))

    def _handle_comment(self, comment: str) -> None:
        if (program := _PROGRAM.match(comment)) is not None:
            self._note(Wording("NC220", "active_comment", program=program.group(1).lower()), Severity.ERROR)
        match = _MESSAGE.match(comment)
        if match is not None:
            self.control.add_event("message", match.group(1))

    def _execute_block(self, active: ActiveProgram, line: int, text: str) -> None:
        reader = block_reader(text, ARITHMETIC, self._parameters)
        if reader.accept("O"):
            self._o_word(active, line, reader)
            return
        block = self._read_block(reader)
        self._execute_words(block)
        for key, value in block.assignments:
            self._parameters.set(key, value or 0.0)

    def _iso(self, word: Word, block: Block) -> None:
        if word.code in PROGRAM_ENDS:
            self._splines.break_off()
        super()._iso(word, block)

    def _check_groups(self, block: Block) -> None:
        """Refuse two G codes or two M codes of one group, also twice the same, as LinuxCNC does."""
        for letter, codes in (("G", block.g), ("M", block.m)):
            if len(codes) < 2:
                continue
            for group in self.table.groups[letter]:
                found = [word.text for word in self.table.words(letter, codes) if word.code in group]
                if len(found) > 1:
                    raise BlockError(Wording("NC212", "same_group", words=tuple(found[:2])))

    def _execute_behind_modes(self, word: Word, codes: Sequence[Word], block: Block) -> None:
        if not word.moves and any(code.is_motion for code in codes):
            raise BlockError(Wording("NC210", "two_g_words_want_axis"))
        super()._execute_behind_modes(word, codes, block)

    def _pass_motion(self, codes: Sequence[Word]) -> None:
        if self._selected(codes) == CANCEL:
            self.motion_code = CANCEL

    @staticmethod
    def _selected(codes: Sequence[Word]) -> int | None:
        """Return the cycle or spline that a block selects, or G80, which counts beside no motion; None for neither."""
        cycles = [word.code for word in codes if word.act == "cycle" or word.code in words.SPLINES]
        if any(word.code == CANCEL for word in codes) and not any(word.is_motion for word in codes):
            return CANCEL
        return cycles[-1] if cycles else None

    # Words

    def _changes_something(self, word: Word, block: Block) -> bool:
        """Whether a word changes what is in force: G10 may write data of tools and of other work offsets."""
        if word.act != "set_data":
            return super()._changes_something(word, block)
        kind, number = (block.words[letter].value if letter in block.words else -1.0 for letter in "LP")
        return kind not in words.TOOL_DATA and number in (0.0, float(self.control.system))

    def _may_be_left_on(self) -> list[str]:
        control = self.control  # M2 and M30 end cycles, but no tool length
        has_length = control.length_active and control.cuts_behind(0)
        left = ["G43"] if has_length and not control.sets_behind_use("length") else []
        shifted = control.axis_offset_active and control.axis_offset.any() and not control.unused_shift
        return [*left, "G92"] if shifted else left

    def _select_motion(self, code: int) -> None:
        """Select a motion; cycles, splines, and G80, which may stand beside one, are selected when the block moves."""
        if code not in self.table.cycles and code not in words.SPLINES and code != CANCEL:
            self.motion_code = code

    def _line(self, word: Word, block: Block) -> None:
        self._select_motion(word.code)

    def _feed_mode(self, word: Word, block: Block) -> None:
        super()._feed_mode(word, block)
        if word.sets != 93:
            # LinuxCNC forgets the feed, even if the mode does not change.
            self.control.programmed_feed = np.nan

    def _work_offset(self, word: Word, block: Block) -> None:
        control = self.control
        control.system = word.sets
        control.set_offset(_offset_code(control.system), word.text)
        control.update_frame()

    def _blending(self, word: Word, block: Block) -> None:
        """G64: continuous path, within the tolerance P, and with points left out within Q; the wider one is judged."""
        control = self.control
        tolerance, naive = block.take("P"), block.take("Q")
        if (tolerance or 0.0) < 0.0 or (naive or 0.0) < 0.0:
            self._note(Wording("NC215", "g64_tolerance_below_zero"), Severity.ERROR)
        # P0 is no tolerance: the control keeps its speed, as without P.
        control.add_tolerance(max(tolerance, naive or 0.0) * control.length_unit if tolerance else np.inf)
        within = (tolerance or 0.0, (tolerance or 0.0) if naive is None else naive)
        # In two digits: 0.0004 inch stands for 0.01 mm. The wider one is compared by its value besides.
        rounding, joining = (f"{each * control.length_unit:.2g}" for each in within)
        control.say_mode(_WITHIN, f"P{rounding} Q{joining}")
        control.add_exact_stop("off")

    def _exact_path(self, word: Word, block: Block) -> None:
        self.control.add_tolerance(0.0)
        self.control.say_mode(_WITHIN, "none")
        self.control.add_exact_stop(word.sets)

    def _length(self, word: Word, block: Block) -> None:
        control = self.control
        number = self._length_number(block) if word.sets else -1
        if number != control.modal.edge.current:
            control.judge_new_length(word.text)
        control.set_mode("length", word.text, control.length_active, word.sets)
        control.take_back_lengths()
        control.set_length(word.sets)
        control.modal.edge.set(control.row, number)

    def _centres(self, word: Word, block: Block) -> None:
        self.control.set_mode("centres", word.text, self.control.relative_centres, word.sets)
        self.control.relative_centres = word.sets

    def _added_length(self, word: Word, block: Block) -> None:
        """G43.1 puts its Z in the place of the tool's length; G43.2, and X and Y of both, are beside the path."""
        control = self.control
        if word.text == "G43.1" and (length := block.take("Z")) is not None:
            control.judge_new_length(word.text)
            control.replace_length(word.text, length * control.length_unit)
        for letter in "XYZ":
            if value := block.take(letter):
                name = f"{word.text} {letter}"
                before = control.tool_delta(name) if word.text == "G43.2" else 0.0
                control.add_tool_delta(name, before + value * control.length_unit)
        for letter in "ABCUVW":
            if block.take(letter):
                does = f"an offset of the axis {letter} is not simulated"
                self._note(Wording("NC220", "not_simulated", word=f"{word.text} {letter}", does=does), Severity.ERROR)
        if block.take("H"):
            self._note(Wording("NC220", "length_of_other_tool", word=word.text), Severity.ERROR)

    def _length_number(self, block: Block) -> int:
        """Return which length G43 takes: that of H; with H0 or none of the tool in the spindle, 0 if it is unknown."""
        if "H" in block.words and block.words["H"].value:
            return int(block.words["H"].value)
        name = self.control.tool_in_spindle
        return int(name) if name.isdigit() else 0

    def _wait_for_input(self, word: Word, block: Block) -> None:
        """M66: read an input; with L other than 0 wait for it, up to Q seconds."""
        if block.words.get("L") is not None and block.words["L"].value:
            seconds = block.words["Q"].value if "Q" in block.words else 0.0
            waits = Wording("NC226", "waits_for_input", duration=format_duration(max(seconds, 0.0)))
            self.control.note_wait(waits, word.text)
        self._report_signal(word, block)
        self.control.say_once(" ".join((word.text, *(f"{name}{each.value:g}" for name, each in block.words.items()))))

    def _report_signal(self, word: Word, block: Block) -> None:
        if fault := words.fault_of_signal(word, block):
            self._note(fault, Severity.ERROR)

    def _signal(self, word: Word, block: Block) -> None:
        self._report_signal(word, block)
        if "P" in block.words:
            output = block.words["P"].value
            self.control.say_mode(f"digital output {output:g}", word.text)
            self.control.add_event("unasked", f"{word.text} P{output:g}")

    def _analog_output(self, word: Word, block: Block) -> None:
        self._report_signal(word, block)
        if "E" in block.words:
            value = block.words["Q"].value if "Q" in block.words else 0.0
            output = block.words["E"].value
            self.control.say_mode(f"analog output {output:g}", f"{word.text} {value:g}")
            self.control.add_event("unasked", f"{word.text} E{output:g} Q{value:g}")
        if block.take("E") == words.KINEMATICS_OUTPUT:
            self._note(
                Wording("NC220", "output_switches_kinematics", word=word.text, output=words.KINEMATICS_OUTPUT),
                Severity.ERROR,
            )

    def _overrides(self, word: Word, block: Block) -> None:
        for code in ("M50", "M51"):
            self.control.say_mode(words.OVERRIDES[code], f"P{word.sets:g}")
        if not word.sets:
            self.control.add_event("unasked", word.text)

    def _override(self, word: Word, block: Block) -> None:
        value = block.words["P"].value if "P" in block.words else 1.0
        self.control.say_mode(words.OVERRIDES[word.text], f"P{value:g}")
        if not value:
            self.control.add_event("unasked", f"{word.text} P0")

    def _adaptive_feed(self, word: Word, block: Block) -> None:
        self.control.say_mode("adaptive feed", f"P{block.words['P'].value:g}" if "P" in block.words else "on")
        if block.take("P") != 0.0:
            self.control.add_event("unasked", word.text)
            self._note(Wording("NC221", "m52_lets_signal_scale_feed"), Severity.WARNING)

    def _rename_tool(self, word: Word, block: Block) -> None:
        """M61: take the tool in the spindle for Q, whatever it is: no tool is changed."""
        number = block.take("Q")
        name = f"{number or 0:g}"
        if number is None or name != self.control.tool_in_spindle:
            self._note(Wording("NC220", "renames_tool", word=word.text, tool=name), Severity.ERROR)

    def _change_pallet(self, word: Word, block: Block) -> None:
        self.control.add_event("stop", "pallet")
        self.control.add_event("unasked", word.text)

    def _builders_program(self, word: Word, block: Block) -> None:
        self.control.add_builders_word("M", float(word.code))
        self._say_letters(word, block)
        if word.text in words.USERS_TCP:
            self._note(Wording("NC224", "switches_tcp_some_configurations_m428", word=word.text), Severity.ERROR)

    # Motion

    def _execute_motion(self, codes: Sequence[Word], block: Block) -> None:
        selected, explicit = self._selected(codes), any(word.is_motion for word in codes)
        if selected == CANCEL:
            self.motion_code, self._initial = CANCEL, None
        code = selected if selected is not None else self.motion_code
        if code != CANCEL and code not in self.table.cycles:
            self._initial = None
        axes = {**self._axis_words(block), **polar_words(block, self.control, code)}
        if code in words.SPLINES:
            self._spline(code, block, axes)
            return
        self._splines.break_off()
        circle = code in (20, 30) and (explicit or any(letter in block.words for letter in "IJKR"))
        if not axes and not circle:
            if explicit and code in self.table.cycles:
                self._note(Wording("NC218", "cycle_without_position"), Severity.ERROR)
                self.motion_code = code
        elif code == CANCEL:
            self._initial = None
            self._note(Wording("NC218", "position_without_g_word_goes"), Severity.ERROR)
        elif code in self.table.cycles:
            self._drill_block(code, block, axes)
        elif code == words.RIGID_TAP:
            self._rigid_tap(block, axes)
        elif words.MACHINE in block.g:
            self._check_machine_move(block, code)
            absolute = {name: (word[0], PositionMode.ABSOLUTE) for name, word in axes.items()}
            self.control.machine_move(absolute, feed_written=self._check_feed(block))
        else:
            turns = block.take("P") if code in (20, 30) else None
            if turns is not None and not 1 <= turns == int(turns):
                raise BlockError(Wording("NC210", "p_circle_number_turns"))
            moved = code if code in MOTIONS else 10
            here, self.motion_code = self.motion_code, moved
            self._move(block, self._with_rotary_offsets(axes), turns=int(turns) - 1 if turns else 0)
            if self.motion_code == moved:  # no other one holds behind it
                self.motion_code = here

    def _spline(self, code: int, block: Block, axes: dict[str, AxisWord]) -> None:
        """Execute a block of a spline: G5.2 stays in force, G5.3 leaves none, and the others the motion before."""
        if code == words.NURBS and self.motion_code == code and not axes and code not in block.g:
            return
        if code in (words.NURBS, words.END_NURBS):
            self.motion_code = words.NURBS if code == words.NURBS else CANCEL
        else:
            self._splines.break_off()
        self._splines.execute(code, block, axes)

    def _check_machine_move(self, block: Block, code: int) -> None:
        if code in (20, 30):
            block.take("P")
        if code not in (0, 10) or not self.control.absolute:
            raise BlockError(Wording("NC210", "g53_needs_g0_g1_g90"))
        self.control.motion = MOTIONS[code]


def _offset_code(system: int) -> int:
    """Return the value of column ``work_offset``: 54 to 59, and 591 to 593 for G59.1 to G59.3."""
    return 53 + system if system <= 6 else 584 + system


def _parameter_of_offset(system: int) -> int:
    """Return the value of ``#<_coord_system>``: 540 to 590, and 591 to 593 for G59.1 to G59.3."""
    return 530 + 10 * system if system <= 6 else _offset_code(system)
