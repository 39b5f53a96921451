"""Interpreter of Sinumerik programs."""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from trunnion.errors import Severity
from trunnion.machines import Machine
from trunnion.messages import Wording
from trunnion.readers.control.arcs import ArcError
from trunnion.readers.control.hole_motion import CycleExecutionError, finite
from trunnion.readers.control.virtual_control import LINEAR, RAPID
from trunnion.readers.families.sinumerik import cycles, unseen_modes
from trunnion.readers.families.sinumerik.block import Block, Call
from trunnion.readers.families.sinumerik.block_reader import BlockReader
from trunnion.readers.families.sinumerik.control import (
    POLYNOMIAL,
    THROUGH,
    SinumerikControl,
)
from trunnion.readers.families.sinumerik.corner_words import CornerWords
from trunnion.readers.families.sinumerik.cycle800 import swivel
from trunnion.readers.families.sinumerik.cycle832 import smooth
from trunnion.readers.families.sinumerik.cycle_modes import classic_form, without_texts
from trunnion.readers.families.sinumerik.expressions import ExpressionError, ExpressionReader, Value
from trunnion.readers.families.sinumerik.flow import ActiveProgram
from trunnion.readers.families.sinumerik.polynomials import move_along_polynomials
from trunnion.readers.families.sinumerik.settings import settings_of
from trunnion.readers.families.sinumerik.text import SinumerikText
from trunnion.readers.families.sinumerik.tokens import MAX_LENGTH, Token, TokenKind, split_comment, tokenize
from trunnion.readers.families.sinumerik.variables import Variables
from trunnion.readers.families.sinumerik.word_interpreter import DWELL, WordInterpreter
from trunnion.readers.families.sinumerik.words import (
    DEGREE_AS_MILLIMETRE,
    FRAMES,
    G_GROUPS,
    G_LIMITS,
    G_MACHINE,
    G_NO_MOTION,
    G_PLANES,
    M_AFTER_MOTION,
)
from trunnion.readers.program.declared_variables import DeclaredVariables
from trunnion.readers.program.interpreter import ProgramEnd
from trunnion.readers.program.modal_groups import same_group
from trunnion.readers.program.options import DEFAULT_OPTIONS, RunOptions
from trunnion.readers.program.source_text import SourceText
from trunnion.readers.scan.buffers import BlockModes
from trunnion.readers.scan.letter_blocks import read_blocks

#: Names with arguments that are no subprograms.
_BUILT_IN: Final = frozenset({*cycles.CYCLES, "CYCLE800", "CYCLE832", "MSG", "SETAL"})


#: Radii that differ by less are the same, mm.
_SAME_RADIUS: Final = 0.001

#: What stands before the number of a block, and of a main block.
_BLOCK_NUMBERS: Final = frozenset({"N", ":"})

#: Words that lines take, circles through a point, and other circles.
_OF_LINES: Final = frozenset({"ANG"})
_OF_THROUGH: Final = frozenset({"I1", "J1", "K1", "TURN"})
_OF_CIRCLES: Final = frozenset({"I", "J", "K", "CR", "AR", "TURN", "ANG"})

#: Beginnings of lines that may be plain blocks, so that a scan is worth starting.
_PLAIN_START = re.compile(rb"[ \t]*(?:N[0-9]+[ \t]*)?(?:[;\r\n]|G0?[0-3](?![0-9])|[A-FXYZ]=?[-+.0-9])", re.IGNORECASE)
_PREFIX_LENGTH: Final = 48


#: G codes that take positions; names take their own.
_TAKES_POSITIONS: Final = re.compile(
    r"G(?:[0-3]|5|7|2[56]|3[345]|58|59|63|7[45]|11[0-2]|14[78]|[23]4[78]|33[12])|[A-Z_]{2}.*"
)


class SinumerikInterpreter(WordInterpreter):
    """Runs one Sinumerik program on one machine."""

    comment_signs = (";", "")
    text_sign = '"'

    def __init__(self, path: Path, machine: Machine, options: RunOptions = DEFAULT_OPTIONS) -> None:
        super().__init__(path, machine, options)
        # Whether F counts for rotary axes at another radius than that of a degree as a millimetre.
        self._other_feed_radius = False
        self._corners = CornerWords(self.control, self._note)
        self._block_reader = BlockReader(self.control.rotary_names, self._note)
        self._flow = self._flow_handlers()

    def _make_control(self) -> SinumerikControl:
        return SinumerikControl(self._machine, self._note, shortest=self._options.shortest)

    def _main_program(self, source: SourceText) -> ActiveProgram:
        assert isinstance(source, SinumerikText)
        declared = DeclaredVariables(settings_of(self._machine).variables, self._note, self.control.leave_variable)
        return ActiveProgram(source, 0, variables=Variables(declared))

    def _takes_positions(self, codes: Sequence[str]) -> bool:
        return any(_TAKES_POSITIONS.fullmatch(code) is not None for code in codes)

    def _may_scan(self, source: SourceText) -> bool:
        control = self.control
        if not control.absolute or self._stack[-1].modal is not None or control.tool_frame:
            return False
        if self._corners.rounds or self._stack[-1].sections:
            return False
        if control.motion == POLYNOMIAL or (self._other_feed_radius and not control.tcp):
            return False
        beginning = source.buffer[source.position : source.position + _PREFIX_LENGTH]
        return _PLAIN_START.match(beginning.tobytes()) is not None

    def _read_blocks(self, source: SourceText, limit: int) -> tuple[int, int]:
        control = self.control
        return read_blocks(
            source.buffer,
            source.position,
            limit,
            control.letter_table,
            BlockModes(control.motion, control.tip_programmed, control.plane_axis),
            control.words,
        )

    # Lines

    def _execute_line(self, active: ActiveProgram, line: int, raw: str) -> None:
        try:
            self._read_line(active, line, raw)
        finally:
            active.end_section(line)

    def _read_line(self, active: ActiveProgram, line: int, raw: str) -> None:
        words, comment = split_comment(raw.rstrip("\r"))
        stripped = words.strip()
        level, skipped = 0, stripped.startswith("/")
        if skipped:
            level = int(stripped[1]) if re.match(r"/\d(?!\d)", stripped) else 0
            skipped = self._options.skips(level)
        if not stripped or stripped.startswith("%") or (skipped and len(words) <= MAX_LENGTH):
            self._read_header(active, line, stripped)
            self._record_comment(line, comment)
            return
        if len(words) > MAX_LENGTH:
            self._note(Wording("NC214", "long_block_not_executed", most=MAX_LENGTH), Severity.ERROR)
            return
        if stripped.startswith("/"):
            self.control.add_event("block_skip", float(level))
        tokens = tokenize(words)
        at = self._read_line_start(tokens)
        try:
            if at < len(tokens):
                self._execute_statement(active, line, tokens, at)
        finally:
            self._record_comment(line, comment)

    def _read_header(self, active: ActiveProgram, line: int, words: str) -> None:
        """Read a line without a block; the transfer header of another program ends this one."""
        if line == active.header_end + 1:
            active.header_end = line
        elif words.startswith("%") and active.source.rest().strip():
            self._note(Wording("NC160", "second_program_begins_needs_file"), Severity.ERROR)
            raise ProgramEnd

    def _has_words(self, raw: str) -> bool:
        words = split_comment(raw.rstrip("\r"))[0].strip()
        if not words or words.startswith("%") or len(words) > MAX_LENGTH:
            return bool(words) and not words.startswith("%")
        tokens = tokenize(words)
        return self._read_line_start(tokens) < len(tokens)

    def _read_line_start(self, tokens: tuple[Token, ...]) -> int:
        """Read block skip, block number and labels; returns the index of the token after them."""
        at = 0
        if tokens[0].kind is TokenKind.SIGN and tokens[0].text == "/":
            level = tokens[1] if len(tokens) > 1 else None
            has_level = (
                level is not None
                and level.kind is TokenKind.NUMBER
                and len(level.text) == 1
                and level.start == tokens[0].end
            )
            at = 2 if has_level else 1
        if len(tokens) > at + 1 and tokens[at].text in _BLOCK_NUMBERS and tokens[at + 1].text.isdigit():
            number = tokens[at + 1].value
            self.control.block_number = int(number) if number < 1e15 else -1
            at += 2
        while len(tokens) > at + 1 and tokens[at].kind is TokenKind.NAME and tokens[at + 1].text == ":":
            at += 2
        return at

    def _execute_statement(self, active: ActiveProgram, line: int, tokens: tuple[Token, ...], at: int) -> None:
        first = tokens[at]
        flow = self._flow.get(first.text) if first.kind is TokenKind.NAME else None
        if flow is None:
            self._execute_block(active, self._block_reader.read(tokens, at, active.variables))
            return
        reader = ExpressionReader(tokens, active.variables, at + 1)
        try:
            flow(reader, active, line)
        except ExpressionError as error:
            self._note(error.wording.within("not_understood", text=first.text), Severity.ERROR)

    # Blocks

    def _execute_block(self, active: ActiveProgram, block: Block) -> None:
        """Execute the words of a block in the order of the control."""
        for fault in same_group(block.g, G_GROUPS, "G{}".format):
            self._note(fault, Severity.ERROR)
        for code in block.g:  # before the words, one of which may begin compensation in the new plane
            if code in G_PLANES and "XYZ".index(G_PLANES[code]) != self.control.plane_axis:
                self.control.judge_within_compensation(f"G{code}")
        for code in block.g:
            self._g_code(code)
        for word in block.words:
            self._word(word, block)
        for name, written in block.said:
            unseen_modes.say(self.control, name, written)
        for word in block.waits:
            self.control.note_wait(Wording("NC226", "waits_for_channel", word=word), word)
        self._corners.begin_block(block.corner)
        if DWELL in block.g:
            self._dwell(block)
            self._corners.end_block(block.corner, moved=False)
            return
        self._feed_speed_and_tool(block)
        for code in block.m:
            if code not in M_AFTER_MOTION:
                self._m_code(code)
        for value in block.h:
            self.control.add_builders_word("H", value)
        calls = block.calls
        moved = self._execute_motion(block)
        self._corners.end_block(block.corner, moved=moved)
        if moved and active.modal is not None:
            calls = [active.modal, *calls]
        for call in calls:
            if call.name in _BUILT_IN:
                self._call_built_in(call)
        for code in block.m:
            if code in M_AFTER_MOTION:
                self._m_code(code)
        self._call_one([call for call in calls if call.name not in _BUILT_IN])

    def _feed_speed_and_tool(self, block: Block) -> None:
        control = self.control
        if block.feed is not None:
            control.programmed_feed = block.feed * control.unit_of_feed
        if block.speed is not None and not G_LIMITS.intersection(block.g):
            control.modal.rpm.set(control.row, block.speed)
            control.add_event("speed", block.speed)
        if block.tool is not None:
            control.select_tool(block.tool)
        if block.edge is not None:
            control.set_edge(block.edge)
        if block.feed_radius is not None:
            radius = block.feed_radius * control.length_unit
            self._other_feed_radius = abs(radius - DEGREE_AS_MILLIMETRE) > _SAME_RADIUS
        for tolerance in block.tolerances:
            control.add_tolerance(tolerance * control.length_unit)
        if block.orientation_tolerance is not None:
            control.add_orientation_tolerance(block.orientation_tolerance)
        for name, delta in block.deltas.items():
            control.add_tool_delta(name, delta * control.length_unit)

    def _execute_motion(self, block: Block) -> bool:
        """Execute the frame statement or the motion of a block; returns whether it was a motion."""
        control = self.control
        frame_words = [word for word in block.words if word in FRAMES]
        if frame_words and block.calls:
            names = [call.name for call in block.calls]
            self._note(Wording("NC212", "alone_in_block", word=frame_words[0], words=tuple(names)), Severity.ERROR)
        if frame_words:
            self._frame(frame_words, block)
            return False
        if block.polynomials or block.interval is not None or (control.motion == POLYNOMIAL and block.params):
            move_along_polynomials(control, block, self._counter.count_motions)
            return True
        has_motion = block.axes or block.vector or (block.params and control.motion > LINEAR) or "ANG" in block.params
        if not has_motion or G_NO_MOTION.intersection(block.g):
            for word in sorted(block.params):
                self._note(Wording("NC213", "unused_word", word=word), Severity.ERROR)
            return False
        self._refuse_unused(block)
        if block.vector and not control.tip_programmed:
            self._note(Wording("NC340", "a3_b3_c3_need_traori"), Severity.ERROR)
        if control.tool_frame and {"X", "Y"} & block.axes.keys():
            self._note(Wording("NC224", "x_y_before_torotof_point"), Severity.ERROR)
        if self._other_feed_radius and control.motion != RAPID and self._only_turns(block):
            self._note(Wording("NC220", "fgref_changes_feed_rotary_axes"), Severity.ERROR)
        self._corners.begin_motion()
        axes = block.axes
        if "ANG" in block.params:
            try:
                axes = control.end_at_angle(axes, block.params["ANG"][0])
            except ArcError as error:
                self._note(error.wording, Severity.ERROR)
        control.move(
            axes,
            block.tool_axis,
            circle=control.circle(block.params, axes),
            machine_frame="SUPA" in block.words or bool(G_MACHINE.intersection(block.g)),
            feed_written=block.feed is not None,
        )
        return True

    def _refuse_unused(self, block: Block) -> None:
        """Report words of circles that the motion in force does not take."""
        motion, given = self.control.motion, block.params.keys()
        takes = _OF_LINES if motion <= LINEAR else _OF_THROUGH if motion == THROUGH else _OF_CIRCLES
        for word in sorted(given - takes):
            self._note(Wording("NC213", "unused_word", word=word), Severity.ERROR)

    def _only_turns(self, block: Block) -> bool:
        """Whether rotary axes alone move in a block, without TCP and at a feed that counts for them."""
        control = self.control
        inverse_time = control.modal.feed_mode.current == 93
        return not (control.tcp or inverse_time or {"X", "Y", "Z"} & block.axes.keys()) and bool(block.axes)

    # Cycles and messages

    def _call_built_in(self, call: Call) -> None:
        """Execute a cycle or a message."""
        control = self.control
        name = call.name
        if name in cycles.CYCLES:
            self._drill(call)
        elif name == "CYCLE832":
            smooth(control, call)
        elif name == "CYCLE800":
            swivel(control, call)
        elif name == "MSG":
            first = call.arguments[0] if call.arguments else ""
            control.add_event("message", first if isinstance(first, str) else f"{first or 0:g}")
        else:
            assert name == "SETAL"
            alarm = f"SETAL({', '.join(call.argument_texts)})"
            control.add_event("message", alarm)
            control.note_wait(Wording("NC226", "alarm", word=alarm), alarm)
            control.say_once(alarm)

    def _drill(self, call: Call) -> None:
        try:
            numbers = [finite(_number(value)) for value in without_texts(call.name, call.arguments)]
            control, rpm = self.control, float(self.control.modal.rpm.current)
            cycles.check_unread(call.name, numbers, control.plane_axis)
            numbers = classic_form(call.name, numbers, control.plane_axis)
            numbers = cycles.in_millimetres(call.name, numbers, control.length_unit, control.feed_unit)
            motions, work = cycles.cycle_motions(call.name, numbers, rpm), cycles.spindle_work(call.name, numbers)
        except CycleExecutionError as error:
            self._note(error.wording.within("call_not_executed", name=call.name), Severity.ERROR)
            return
        self._counter.count_motions(len(motions))
        for value in cycles.unusual_values(call.name, numbers):
            control.add_event("cycle_value", value)
        control.drill([motion.with_lengths_in(control.length_unit) for motion in motions], work)
        if work is not None and work.after is not None:
            control.leave_spindle(work.after)


def _number(value: Value | None) -> float | None:
    if isinstance(value, str):
        raise CycleExecutionError(Wording("NC380", "text_number_must_stand"))
    return value
