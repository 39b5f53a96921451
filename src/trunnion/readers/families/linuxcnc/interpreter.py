"""LinuxCNC programs, block by block: what each one says goes to the virtual control, and where it goes on."""

import re
from typing import Final

import numpy as np

from trunnion.arrays import Codes
from trunnion.errors import Severity
from trunnion.readers.control.axis_word import PositionMode
from trunnion.readers.families.linuxcnc import cycles
from trunnion.readers.families.linuxcnc.control import ORDER
from trunnion.readers.families.linuxcnc.cycle_blocks import CycleInterpreter
from trunnion.readers.families.linuxcnc.flow import ActiveProgram
from trunnion.readers.families.linuxcnc.offsets_and_frames import SPECIAL, TAKING_AXIS_WORDS
from trunnion.readers.families.linuxcnc.parameters import ARITHMETIC
from trunnion.readers.families.linuxcnc.text import LinuxcncText
from trunnion.readers.families.linuxcnc.words import (
    LENGTHS,
    NO_MOTION,
    NOT_SIMULATED,
    NOT_SIMULATED_M,
    OFFSETS,
    RIGID_TAP,
    TAKEN_AS_LINES,
    TCP_OFF,
    TCP_ON,
    TCP_USER,
    USERS,
    WITHOUT_PATH_EFFECT,
    WITHOUT_PATH_EFFECT_M,
    WORDS_OF_CODE,
)
from trunnion.readers.program.source_text import SourceText
from trunnion.readers.rs274.block import Block, block_reader, read_block
from trunnion.readers.rs274.expressions import BlockError
from trunnion.readers.rs274.interpreter import CANCEL, MOTIONS

#: Comments that speak to whoever stands at the machine.
_MESSAGE: Final = re.compile(r"[ \t]*(?:MSG|DEBUG|PRINT),(.*)", re.IGNORECASE | re.DOTALL)

#: M codes that act after the motion of their block.
_AFTER_MOTION: Final = frozenset({0, 1, 2, 30, 60})


class LinuxcncInterpreter(CycleInterpreter):
    """Runs one LinuxCNC program on one machine."""

    source_type = LinuxcncText
    semicolon = True
    motion = CANCEL

    @property
    def _table(self) -> Codes:
        return self._control.plain_table

    def _main_program(self, text: SourceText) -> ActiveProgram:
        assert isinstance(text, LinuxcncText)
        return ActiveProgram(text, 0)

    def _may_scan(self, text: SourceText) -> bool:
        return super()._may_scan(text) and not any(self._control.rotary_offsets.values())

    # Parameters

    def _system_value(self, key: int | str) -> float | None:
        """Return what the control itself puts behind a number or name; None if it is none of its own."""
        control = self._control
        if isinstance(key, int):
            if 5420 <= key < 5426:
                return self._position(key - 5420)
            if 5210 < key <= 5216:
                value = float(control.shift[key - 5211])
                return value / control.length_unit if key <= 5213 else value
            return {5210: float(control.shifted), 5220: float(control.system)}.get(key)
        if len(key) == 2 and key[0] == "_" and key[1] in ORDER:
            return self._position(ORDER.index(key[1]))
        feed = float(control.commanded[3])
        found: dict[str, float | None] = {
            "_VALUE": self._returned or 0.0,
            "_VALUE_RETURNED": float(self._returned is not None),
            "_LINE": float(control.line),
            "_FEED": 0.0 if np.isnan(feed) else feed / control.feed_unit,
            "_RPM": float(control.rpm.current),
            "_METRIC": float(control.length_unit == 1.0),
            "_IMPERIAL": float(control.length_unit != 1.0),
            "_ABSOLUTE": float(control.absolute),
            "_INCREMENTAL": float(not control.absolute),
            "_MOTION_MODE": float(self.motion),
            "_PLANE": {2: 170.0, 1: 180.0, 0: 190.0}[control.plane_axis],
            "_COORD_SYSTEM": float(OFFSETS[control.system - 1]),
        }
        return found.get(key)

    def _position(self, axis: int) -> float:
        value = float(self._control.position()[axis])
        return value / self._control.length_unit if axis < 3 else value

    # Blocks

    def _report_repeated_word(self, letter: str) -> None:
        raise BlockError(f"{letter} is written twice")

    def _handle_comment(self, comment: str) -> None:
        match = _MESSAGE.match(comment)
        if match is not None:
            self._control.add_event("message", match.group(1))

    def _execute_block(self, active: ActiveProgram, line: int, text: str) -> None:
        reader = block_reader(text, ARITHMETIC, self._parameters)
        if reader.accept("O"):
            self._o_word(active, line, reader)
            return
        block = read_block(reader, self._report_repeated_word)
        self._execute_words(block)
        for key, value in block.assignments:
            self._parameters.set(key, value or 0.0)

    def _execute_words(self, block: Block) -> None:
        control = self._control
        for code in block.g:
            if code in (930, 940, 950):
                self._modal_g_code(code)
                if code != 930:
                    # LinuxCNC forgets the feed, even where the mode stays what it was.
                    control.commanded[3] = np.nan
        self._feed_and_speed(block)
        tool = block.take("T")
        if tool is not None:
            control.select_tool(f"{tool:g}")
        for code in block.m:
            if code not in _AFTER_MOTION:
                self._m_code(code, block)
        special = -1
        machine_frame = False
        explicit = False
        for code in block.g:
            if code in MOTIONS or code in cycles.CYCLES or code in TAKEN_AS_LINES or code in (CANCEL, RIGID_TAP):
                explicit = code != CANCEL
            if code in SPECIAL:
                special = code
            elif code == 530:
                machine_frame = True
            elif code in cycles.CYCLES or code in (CANCEL, 930, 940, 950):
                continue
            else:
                self._g_code(code, block)
        takes_axes = special in TAKING_AXIS_WORDS
        if takes_axes and explicit:
            raise BlockError("two G words want the axis words")
        self._special(special, block)
        begun = [code for code in block.g if code in cycles.CYCLES or code == CANCEL]
        if takes_axes or any(code in NO_MOTION for code in block.g):
            self.motion = CANCEL if CANCEL in begun else self.motion
        else:
            self._execute_motion(block, begun[-1] if begun else None, machine_frame, explicit)
        late = [code for code in block.m if code in _AFTER_MOTION]
        self._report_unused_words(block)
        for code in late:
            self._m_code(code, block)

    def _g_code(self, code: int, block: Block) -> None:
        control = self._control
        for letter in WORDS_OF_CODE.get(code, ""):
            block.take(letter)
        if code in OFFSETS:
            control.system = OFFSETS.index(code) + 1
            control.set_offset(_offset_code(control.system), f"G{code / 10:g}")
            control.refresh()
        elif code in (980, 990):
            self._to_initial = code == 980
        elif code in LENGTHS:
            control.set_length(LENGTHS[code])
            control.edge.set(control.row, self._length_number(block) if LENGTHS[code] else -1)
        elif code in (901, 911):
            control.relative_centres = code == 911
        elif code in TAKEN_AS_LINES:
            self._report_g_code(code, NOT_SIMULATED, WITHOUT_PATH_EFFECT)
            self.motion = code
        elif code == RIGID_TAP:
            self.motion = code
        elif code == 960:
            control.feed_mode.set(control.row, 95)
            self._report_g_code(code, NOT_SIMULATED, WITHOUT_PATH_EFFECT)
        elif not self._modal_g_code(code):
            self._report_g_code(code, NOT_SIMULATED, WITHOUT_PATH_EFFECT)

    def _length_number(self, block: Block) -> int:
        """Which length G43 takes: that of H, or of the tool in the spindle; 0 where nobody knows its number."""
        if "H" in block.words:
            return int(block.words["H"].value)
        name = self._control.tool_in_spindle
        return int(name) if name.isdigit() else 0

    def _m_code(self, code: int, block: Block) -> None:
        control = self._control
        if code in (TCP_ON, TCP_OFF):
            control.set_tcp(code == TCP_ON)
        elif code in WITHOUT_PATH_EFFECT_M:
            for letter in WITHOUT_PATH_EFFECT_M[code]:
                block.take(letter)
        elif code == 61:
            tool = block.take("Q")
            control.select_tool(f"{tool or 0:g}")
            control.change_tool()
        elif code == 60:
            control.add_event("stop", "pallet")
        elif code == 19:
            for letter in "RQP":
                block.take(letter)
            self._common_m_code(code)
        elif code in USERS:
            for letter in "PQ":
                block.take(letter)
            control.add_event("m", float(code))
            self._note(f"M{code} belongs to the machine: what it does is not known", Severity.WARNING)
        elif code in NOT_SIMULATED_M:
            self._note(f"M{code}: {NOT_SIMULATED_M[code]}", Severity.ERROR)
        elif code == TCP_USER:
            self._note("M430: kinematics of the user are not known", Severity.ERROR)
        elif not self._common_m_code(code):
            self._note(f"unknown word M{code}", Severity.ERROR)

    # Motion

    def _execute_motion(self, block: Block, begun: int | None, machine_frame: bool, explicit: bool) -> None:
        """Make the motion that the words of the block ask for."""
        control = self._control
        if begun == CANCEL:
            self.motion, self._initial = CANCEL, None
        code = begun if begun is not None else self.motion
        if code != CANCEL and code not in cycles.CYCLES:
            self._initial = None
        axes = self._axis_words(block)
        centre = "I" in block.words or "J" in block.words or "K" in block.words or "R" in block.words
        if not axes and not (code in (20, 30) and (centre or explicit)):
            if explicit and code in cycles.CYCLES:
                self._note("a cycle without a position", Severity.ERROR)
                self.motion = code
            return
        if code == CANCEL:
            self._initial = None
            self._note("a position without a G word that goes there: the block is not executed", Severity.ERROR)
            return
        if code in cycles.CYCLES:
            self._cycle(code, block, axes)
            return
        if code == RIGID_TAP:
            self._tap(block, axes)
            return
        turns = block.take("P") if code in (20, 30) else None
        if machine_frame:
            if code not in (0, 10) or not control.absolute:
                raise BlockError("G53 needs G0 or G1, and G90")
            control.kind = MOTIONS[code]
            written = "F" in block.words
            self._check_feed(written)
            control.machine_move(
                {name: (word[0], PositionMode.ABSOLUTE) for name, word in axes.items()}, feed_written=written
            )
            return
        here = self.motion
        if code in TAKEN_AS_LINES:
            self.motion = 10
        if turns is not None and not 1 <= turns == int(turns):
            raise BlockError("P of a circle is the number of its turns")
        self._move(block, self._with_rotary_offsets(axes), turns=int(turns) - 1 if turns else 0)
        self.motion = here


def _offset_code(system: int) -> int:
    """Column ``offset`` of the work offsets: 54 to 59, and 591 to 593 for G59.1 to G59.3."""
    return 53 + system if system <= 6 else 584 + system
