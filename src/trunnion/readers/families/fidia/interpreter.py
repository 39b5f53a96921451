"""Fidia programs, block by block: what each one says goes to the virtual control. They have no jumps and no loops."""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from trunnion.arrays import Codes
from trunnion.errors import Severity
from trunnion.machines import Machine
from trunnion.readers.control.axis_word import AxisWord
from trunnion.readers.control.hole_motion import CycleExecutionError, HoleMotion
from trunnion.readers.control.virtual_control import RAPID
from trunnion.readers.families.fidia import cycles, words
from trunnion.readers.families.fidia.control import FidiaControl
from trunnion.readers.program.interpreter import DEFAULT_STEP_LIMIT
from trunnion.readers.program.source_text import SourceText, Subprograms
from trunnion.readers.rs274.block import Block, block_reader, read_block
from trunnion.readers.rs274.expressions import Arithmetic, BlockError, Value
from trunnion.readers.rs274.interpreter import CANCEL, MOTIONS, ActiveProgram, Rs274Interpreter

#: A tool's number may stand behind a point: T.1.
_TOOL = re.compile(r"T\.?([0-9]{1,9})")


class _NoParameters:
    """This language has no parameters."""

    def value(self, key: int | str) -> Value:
        raise BlockError("parameters are not simulated")

    def is_set(self, key: int | str) -> bool:
        return False


_NO_PARAMETERS: Final = _NoParameters()


def _no_operation(name: str, a: float, b: float) -> float:
    raise BlockError("expressions are not simulated")


_ARITHMETIC: Final = Arithmetic(levels=(), operate=_no_operation, functions={}, pairs={})


class FidiaInterpreter(Rs274Interpreter[ActiveProgram]):
    """Runs one Fidia program on one machine."""

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
        super().__init__(path, machine, Subprograms(subprograms, ()), step_limit=step_limit, skip=skip)
        self._control = FidiaControl(machine, self._note, self._file, shortest=shortest)
        self._modal_words: dict[str, float] = {}

    @property
    def control(self) -> FidiaControl:
        """The virtual control."""
        return self._control

    @property
    def _table(self) -> Codes:
        return self._control.plain_table

    def _main_program(self, text: SourceText) -> ActiveProgram:
        return ActiveProgram(text, 0)

    def _may_scan(self, text: SourceText) -> bool:
        # In a plane without TCP, rotary words leave the slides where they are.
        control = self._control
        return (control.tcp or not control.tilted) and super()._may_scan(text)

    def _execute_block(self, active: ActiveProgram, line: int, text: str) -> None:
        tool = _TOOL.search(text)
        if tool is not None:
            text = text[: tool.start()] + text[tool.end() :]
        # The time of a dwell has two letters.
        block = read_block(
            block_reader(text.replace("HD", "H"), _ARITHMETIC, _NO_PARAMETERS), self._report_repeated_word
        )
        if block.assignments:
            raise BlockError("parameters are not simulated")
        self._execute_words(block, None if tool is None else tool.group(1))

    def _execute_words(self, block: Block, tool: str | None) -> None:
        control = self._control
        machine_frame = words.MACHINE in block.g
        begun = False
        for code in block.g:
            if code in MOTIONS or code in cycles.CYCLES or code == CANCEL:
                begun = True
                self._select_motion(code)
            elif code != words.MACHINE:
                self._g_code(code, block)
        if words.DWELL in block.g:
            self._dwell(block)
        self._feed_and_speed(block)
        if tool is not None:
            control.select_tool(tool)
        for code in block.m:
            if code not in words.AFTER_MOTION:
                self._m_code(code)
        if tool is not None and words.TOOL not in block.m and 6 not in block.m:
            self._note(f"T{tool} without M306 or M6: the tool is only chosen", Severity.WARNING)
        if not any(code in words.NO_MOTION for code in block.g):
            self._execute_motion(block, machine_frame, begun)
        self._report_unused_words(block)
        for code in block.m:
            if code in words.AFTER_MOTION:
                self._m_code(code)

    def _select_motion(self, code: int) -> None:
        """Take up a motion or a cycle, or end a cycle."""
        control = self._control
        if code in cycles.CYCLES:
            if self.motion not in cycles.CYCLES:
                self._modal_words = {}
            self.motion = code
            return
        self.motion = control.kind * 10 if code == CANCEL else code
        control.kind = MOTIONS[self.motion]

    def _g_code(self, code: int, block: Block) -> None:
        control = self._control
        for letter in words.WORDS_OF_CODE.get(code, ""):
            block.take(letter)
        if code in words.UNITS:
            control.set_units(words.UNITS[code], True)
        elif code == words.OFFSET:
            number = block.take("O")
            if number is None or number != int(number) or not 1 <= number <= 99:
                raise BlockError("G55 needs O from 1 to 99")
            control.set_offset(500 + int(number), f"G55 O{number:g}")
            control.set_length(True)
        elif code == words.TAKE_PLANE:
            control.take_plane()
        elif code == words.NO_PLANE:
            control.set_plane(None)
        elif code in words.TCP_ON or code in words.TCP_OFF:
            control.set_tcp(code in words.TCP_ON)
        elif code in (930, 950, 200, 210) or (code != words.DWELL and not self._modal_g_code(code)):
            self._report_g_code(code, words.NOT_SIMULATED, words.WITHOUT_PATH_EFFECT)

    def _dwell(self, block: Block) -> None:
        seconds = block.take("H")
        if seconds is None:
            self._note("G4 without a time HD", Severity.WARNING)
        else:
            self._control.add_event("dwell", seconds)

    def _m_code(self, code: int) -> None:
        control = self._control
        if code == words.TOOL:
            control.change_tool()
        elif code == words.RETRACT:
            self._count_blocks(1)
            control.retract()
        elif not self._common_m_code(code):
            control.add_event("m", float(code))

    # Motion

    def _execute_motion(self, block: Block, machine_frame: bool, begun: bool) -> None:
        """Make the motion that the words of the block ask for."""
        control = self._control
        if self.motion in cycles.CYCLES:
            self._cycle(block, begun)
            return
        axes = self._axis_words(block)
        circle = self.motion in (20, 30) and any(letter in block.words for letter in "IJKR")
        if not axes and not circle:
            return
        written = "F" in block.words
        turns = set(axes) & set(control.rotary_names)
        if machine_frame:
            control.kind = MOTIONS[self.motion]
            self._check_feed(written)
            control.go_to_machine(axes, feed_written=written)
        elif turns and control.tilted and not control.tcp:
            if set(axes) != turns:
                self._note("positions and rotary words in one block of a plane: only the axes turn", Severity.ERROR)
            control.kind = MOTIONS[self.motion]
            self._check_feed(written)
            control.turn_axes({name: axes[name] for name in turns}, feed_written=written)
        else:
            self._move(block, axes)

    def _cycle(self, block: Block, begun: bool) -> None:
        """Drill at the position of a block."""
        control = self._control
        given = {letter: value for letter in cycles.MODAL_WORDS if (value := block.take(letter)) is not None}
        self._modal_words |= given
        axes = self._axis_words(block)
        axes.pop("Z", None)
        if not axes and not begun:
            return
        if set(axes) - set("XY"):
            self._note("rotary words in a cycle: they are not executed", Severity.ERROR)
        if control.plane_axis != 2 or not control.absolute:
            raise BlockError("cycles are simulated in G17 and G90 only")
        missing = [letter for letter in "ZER" if letter not in self._modal_words]
        if missing:
            raise BlockError(f"the cycle has no {missing[0]}")
        if not control.commanded[3] > 0.0:
            self._note("a cycle without a feed", Severity.ERROR)
        made = self._motions()
        self._count_blocks(len(made) + 2)
        place: dict[str, AxisWord] = {name: word for name, word in axes.items() if name in "XY"}
        height = self._modal_words["Z"]
        up = float(control.commanded[2]) < height * control.length_unit
        kind, control.kind = control.kind, RAPID
        if up:
            control.drill([HoleMotion(True, height)])
        control.move(place, None)
        control.drill(
            made
            if up or float(control.commanded[2]) == height * control.length_unit
            else [HoleMotion(True, height), *made]
        )
        control.kind = kind

    def _motions(self) -> list[HoleMotion]:
        try:
            return cycles.cycle_motions(self.motion, self._modal_words, 1.0 / self._control.length_unit)
        except CycleExecutionError as error:
            raise BlockError(f"the cycle {error}") from None
