"""Interpreter of Fidia programs, which have no jumps and no loops."""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from trunnion.arrays import Codes
from trunnion.errors import Severity
from trunnion.machines import Machine
from trunnion.messages import Wording
from trunnion.readers.control.axis_word import AxisWord
from trunnion.readers.control.hole_motion import HoleMotion
from trunnion.readers.control.virtual_control import RAPID
from trunnion.readers.families.fidia import cycles, words
from trunnion.readers.families.fidia.control import FidiaControl
from trunnion.readers.program.options import DEFAULT_OPTIONS, RunOptions
from trunnion.readers.program.source_text import SourceText
from trunnion.readers.rs274.block import Block, block_reader
from trunnion.readers.rs274.expressions import NO_ARITHMETIC, BlockError, Value
from trunnion.readers.rs274.interpreter import CANCEL, MOTIONS, ActiveProgram
from trunnion.readers.rs274.word_interpreter import WordInterpreter
from trunnion.readers.rs274.word_table import Word

#: A tool's number follows a point: T.1. Without it, it is a tool of M6 alone: of M306 no source has that.
_TOOL = re.compile(r"T(\.?)([0-9]{1,9})(?![0-9.])")
_BY_POINT: Final = 306
_TOOL_CHANGES: Final = frozenset({6, _BY_POINT})


class _NoParameters:
    """This language has no parameters."""

    def value(self, key: int | str) -> Value:
        raise BlockError(Wording("NC220", "parameters_not_simulated"))

    def is_set(self, key: int | str) -> bool:
        return False


_NO_PARAMETERS: Final = _NoParameters()


class FidiaInterpreter(WordInterpreter[ActiveProgram]):
    """Runs one Fidia program on one machine."""

    control: FidiaControl

    table = words.TABLE

    def __init__(self, path: Path, machine: Machine, options: RunOptions = DEFAULT_OPTIONS) -> None:
        super().__init__(path, machine, options)
        # The tool that the present block calls.
        self._tool: str | None = None
        # The present block has the two letters of a time.
        self._has_time = self._without_point = False

    def _make_control(self) -> FidiaControl:
        return FidiaControl(self._machine, self._note, shortest=self._options.shortest)

    @property
    def _letter_table(self) -> Codes:
        return self.control.letter_table

    def _main_program(self, source: SourceText) -> ActiveProgram:
        return ActiveProgram(source, 0)

    def _may_scan(self, source: SourceText) -> bool:
        # In a plane without TCP, rotary words leave the slides where they are.
        control = self.control
        return (control.tcp or not control.tilted) and super()._may_scan(source)

    def _execute_block(self, active: ActiveProgram, line: int, text: str) -> None:
        tool = _TOOL.search(text)
        if tool is not None:
            text = text[: tool.start()] + text[tool.end() :]
        # The time of a dwell has two letters.
        reader = block_reader(text.replace("HD", "H"), NO_ARITHMETIC, _NO_PARAMETERS)
        self._has_time = "HD" in text
        self._without_point = tool is not None and not tool[1]
        block = self._read_block(reader)
        if block.assignments:
            raise BlockError(Wording("NC220", "parameters_not_simulated"))
        self._tool = None if tool is None else tool[2]
        self._execute_words(block)

    def _scale_words(self, block: Block) -> None:
        super()._scale_words(block)
        if (words.DWELL in block.g) != self._has_time and "H" in block.words:
            block.take("H")
            self._note(Wording("NC213", "unused_word", word="HD" if self._has_time else "H"), Severity.ERROR)
        if words.DWELL in block.g:  # behind all other G words
            self._dwell(self.table.words("G", [words.DWELL])[0], block)
            if self._axis_words(block):
                raise BlockError(Wording("NC210", "axis_words_beside_g4"))

    def _call_tool(self, block: Block) -> None:
        if self._tool is not None:
            self.control.select_tool(self._tool)

    def _before_motion(self, codes: Sequence[Word], block: Block) -> None:
        if self._tool is not None and _TOOL_CHANGES.isdisjoint(block.m):
            self._note(Wording("NC362", "tool_only_chosen", tool=self._tool), Severity.WARNING)
        if self._without_point and _BY_POINT in block.m:
            self._note(Wording("NC210", "tool_without_point", tool=self._tool), Severity.ERROR)

    # Words

    def _changes_something(self, word: Word, block: Block) -> bool:
        if word.act == "work_offset" and "O" in block.words:
            return bool(self.control.modal.work_offset.current != words.OFFSET_BASE + block.words["O"].value)
        return super()._changes_something(word, block)

    def _units(self, word: Word, block: Block) -> None:
        super()._units(word, block)
        if word.sets:
            self._note(Wording("NC241", "g70_what_f_counts_inches"), Severity.ERROR)

    def _work_offset(self, word: Word, block: Block) -> None:
        control, number = self.control, block.take("O")
        if number is None or number != int(number) or not 1 <= number <= 99:
            raise BlockError(Wording("NC210", "g55_needs_o_1_99"))
        offset, name = words.OFFSET_BASE + int(number), f"G55 O{number:g}"
        control.set_mode("offset", name, control.modal.work_offset.current, offset)
        control.set_offset(offset, name)
        control.set_length(True)
        control.preconditions.meet("G55")

    def _take_plane(self, word: Word, block: Block) -> None:
        self.control.take_plane()

    def _tcp(self, word: Word, block: Block) -> None:
        super()._tcp(word, block)
        if word.text not in self.control.tcp_words:
            where = "tcp_of_heads" if word.text in words.TCP_OF_HEADS else "tcp_of_tables"
            self._note(Wording("NC341", where, word=word.text), Severity.ERROR)

    def _end_plane(self, word: Word, block: Block) -> None:
        self.control.set_plane(None)

    def _change_tool(self, word: Word, block: Block) -> None:
        self.control.change_tool()

    def _retract(self, word: Word, block: Block) -> None:
        self._counter.count_motions(1)
        self.control.retract()

    # Motion

    def _execute_motion(self, codes: Sequence[Word], block: Block) -> None:
        control = self.control
        if self.motion_code in self.table.cycles:
            self._drill_block(block, selected=any(word.is_motion or word.code == CANCEL for word in codes))
            return
        axes = self._axis_words(block)
        circle = self.motion_code in (20, 30) and any(letter in block.words for letter in "IJKR")
        if not axes and not circle:
            return
        rotary = set(axes) & set(control.rotary_names)
        if words.MACHINE in block.g:
            control.motion = MOTIONS[self.motion_code]
            control.go_to_machine(axes, feed_written=self._check_feed(block))
        elif rotary and control.tilted and not control.tcp:
            if set(axes) != rotary:
                self._note(Wording("NC216", "positions_rotary_words_block_plane"), Severity.ERROR)
            control.motion = MOTIONS[self.motion_code]
            control.turn_axes({name: axes[name] for name in rotary}, feed_written=self._check_feed(block))
        else:
            self._move(block, axes)

    def _drill_block(self, block: Block, *, selected: bool) -> None:
        """Drill at the position of a block; ``selected`` if the block itself selects the cycle."""
        control = self.control
        if "D" in block.words and self.motion_code != cycles.PECKS:
            self._note(Wording("NC213", "unused_word", word="D"), Severity.ERROR)
        self._modal_words |= {
            letter: value for letter in cycles.MODAL_WORDS if (value := block.take(letter)) is not None
        }
        axes = self._axis_words(block)
        axes.pop("Z", None)
        if not axes and not selected:
            return
        self._report_rotary_words(axes)
        if control.plane_axis != 2 or not control.absolute:
            raise BlockError(Wording("NC220", "cycles_simulated_g17_g90_only"))
        self._require_words(self._modal_words)
        self._check_cycle_feed()
        above = control.settings.peck_clearance / control.length_unit
        motions = self._cycle_motions(lambda: cycles.cycle_motions(self.motion_code, self._modal_words, above))
        self._counter.count_motions(len(motions) + 2)
        self._drill({name: word for name, word in axes.items() if name in "XY"}, motions)

    def _drill(self, place: dict[str, AxisWord], motions: list[HoleMotion]) -> None:
        """Drill at a place: up to the height of positioning before the rapid motion, or down to it afterwards."""
        control = self.control
        to_height = HoleMotion(True, self._modal_words["Z"])
        height = self._modal_words["Z"] * control.length_unit
        motion, control.motion = control.motion, RAPID
        up = float(control.programmed_position[2]) < height
        if up:
            control.drill([to_height])
        control.move(place, None)
        level = up or float(control.programmed_position[2]) == height
        control.drill(motions if level else [to_height, *motions], cycles.spindle_work(self.motion_code))
        control.motion = motion
