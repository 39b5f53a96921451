"""Sinumerik programs, block by block: what each one says goes to the virtual control, and where it goes on."""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from trunnion.errors import Severity
from trunnion.machines import Machine
from trunnion.model.run import Orientation
from trunnion.readers.control.hole_motion import CycleExecutionError, finite
from trunnion.readers.control.row_recorder import MAX_POSITION
from trunnion.readers.control.virtual_control import LINEAR, RAPID
from trunnion.readers.families.sinumerik import cycles
from trunnion.readers.families.sinumerik.block import Block, BlockReader, Call, read_call
from trunnion.readers.families.sinumerik.control import CLOCKWISE, COUNTER, THROUGH, SinumerikControl
from trunnion.readers.families.sinumerik.cycle800 import swivel
from trunnion.readers.families.sinumerik.expressions import ExpressionError, ExpressionReader, Value
from trunnion.readers.families.sinumerik.flow import ActiveProgram, Flow
from trunnion.readers.families.sinumerik.frame_statements import frame_of_statement
from trunnion.readers.families.sinumerik.text import SUFFIXES, SinumerikText
from trunnion.readers.families.sinumerik.tokens import MAX_LENGTH, Token, TokenKind, split_comment, tokenize
from trunnion.readers.families.sinumerik.variables import Variables
from trunnion.readers.families.sinumerik.words import (
    CONSTANTS,
    FRAMES,
    G_FEEDS,
    G_LIMITS,
    G_MACHINE,
    G_NO_MOTION,
    G_NOT_SIMULATED,
    G_OFFSETS,
    G_PLANES,
    G_RADIUS_COMPENSATION,
    G_SURFACE,
    G_UNITS,
    G_WITHOUT_PATH_EFFECT,
    M_AFTER_MOTION,
    M_CHANGE,
    M_EVENTS,
    M_PROGRAM_ENDS,
    M_RETURN,
    M_SPINDLE,
    TOOL_FRAMES,
    WITHOUT_PATH_EFFECT,
)
from trunnion.readers.program.interpreter import DEFAULT_STEP_LIMIT, Interpreter, ProgramEnd
from trunnion.readers.program.source_text import SourceText, Subprograms
from trunnion.readers.scan.letter_blocks import scan_blocks

#: Names with arguments that the interpreter knows; all others are subprograms.
_BUILT_IN: Final = frozenset({*cycles.CYCLES, "CYCLE800", "CYCLE832", "MSG", "SETAL"})

#: Whether a line may be plain: a look at its beginning saves starting the kernel in vain.
_PLAIN_START = re.compile(rb"[ \t]*(?:N[0-9]+[ \t]*)?(?:[;\r\n]|G0?[01](?![0-9])|[A-FXYZ]=?[-+.0-9])", re.IGNORECASE)
_PREFIX_LENGTH: Final = 48


class SinumerikInterpreter(Interpreter[ActiveProgram]):
    """Runs one Sinumerik program on one machine."""

    source_type = SinumerikText

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
        super().__init__(path, machine, Subprograms(subprograms, SUFFIXES, "_N_"), step_limit=step_limit, skip=skip)
        self._control = SinumerikControl(machine, self._note, self._file, shortest=shortest)
        self._reader = BlockReader(self._control.rotary_names, self._note)
        self._flow = {
            **Flow(self._note).handlers,
            "RET": self._return,
            "MCALL": self._mcall,
            "EXTCALL": self._extcall,
            "CALL": self._extcall,
        }

    @property
    def control(self) -> SinumerikControl:
        """The virtual control."""
        return self._control

    def _main_program(self, text: SourceText) -> ActiveProgram:
        assert isinstance(text, SinumerikText)
        return ActiveProgram(text, 0, variables=Variables())

    def _may_scan(self, text: SourceText) -> bool:
        active = self._stack[-1]
        if not self._control.absolute or active.modal is not None or self._control.tool_frame:
            return False
        begin = text.buffer[text.position : text.position + _PREFIX_LENGTH].tobytes()
        return _PLAIN_START.match(begin) is not None

    def _scan_blocks(self, text: SourceText) -> None:
        control = self._control
        scan_blocks(
            text.buffer,
            len(text.buffer),
            control.table,
            control.tip_programmed,
            control.length_unit,
            control.feed_unit,
            control.default_turn_rules,
            control.position_map,
            control.vector_map,
            control.counters,
            control.commanded,
            control.scan_target(),
            control.scan_records,
        )

    def _execute_line(self, active: ActiveProgram, line: int, raw: str) -> None:
        """Execute a line that is not plain."""
        control = self._control
        raw = raw.rstrip("\r")
        words, comment = split_comment(raw)
        stripped = words.strip()
        if not stripped or stripped.startswith("%"):
            self._record_comment(line, comment)
            return
        if len(words) > MAX_LENGTH:
            self._note(f"the block is longer than {MAX_LENGTH} characters: it is not executed", Severity.ERROR)
            return
        tokens = tokenize(words)
        at = 0
        if stripped.startswith("/"):
            if self._skip:
                self._record_comment(line, comment)
                return
            at = 1
            level = tokens[1] if len(tokens) > 1 else None
            if (
                level is not None
                and level.kind is TokenKind.NUMBER
                and len(level.text) == 1
                and level.start == tokens[0].end
            ):
                at = 2
        if len(tokens) > at + 1 and tokens[at].text == "N" and tokens[at + 1].text.isdigit():
            number = tokens[at + 1].value
            control.block_number = int(number) if number < 1e15 else -1
            at += 2
        while len(tokens) > at + 1 and tokens[at].kind is TokenKind.NAME and tokens[at + 1].text == ":":
            at += 2
        try:
            if at < len(tokens):
                self._statement(active, line, tokens, at)
        finally:
            self._record_comment(line, comment)

    def _statement(self, active: ActiveProgram, line: int, tokens: tuple[Token, ...], at: int) -> None:
        first = tokens[at]
        flow = self._flow.get(first.text) if first.kind is TokenKind.NAME else None
        if flow is None:
            self._block(active, self._reader.read(tokens, at, active.variables))
            return
        reader = ExpressionReader(tokens, active.variables, at + 1)
        try:
            flow(reader, active, line)
        except ExpressionError as error:
            self._note(f"not understood: {first.text}: {error}", Severity.ERROR)

    # Words

    def _block(self, active: ActiveProgram, block: Block) -> None:
        """Carry out the words of a block, in the order in which the control does."""
        control = self._control
        machine_frame = "SUPA" in block.words
        silent = False
        dwell = False
        for code in block.g:
            machine_frame |= code in G_MACHINE
            silent |= code in G_NO_MOTION
            dwell |= code == 4
            self._g_code(code)
        frame = [word for word in block.words if word in FRAMES]
        for word in block.words:
            self._word(word, block)
        if dwell:
            self._dwell(block)
            return
        if block.feed is not None:
            control.commanded[3] = block.feed * control.feed_unit
        if block.speed is not None and not G_LIMITS.intersection(block.g):
            control.rpm.set(control.row, abs(block.speed))
            control.add_event("speed", abs(block.speed))
        if block.tool is not None:
            control.select_tool(block.tool)
        if block.edge is not None:
            control.set_edge(block.edge)
        late = [code for code in block.m if code in M_AFTER_MOTION]
        for code in block.m:
            if code not in late:
                self._m_code(code)
        for value in block.h:
            control.add_event("h", value)
        calls = block.calls
        if frame:
            self._frame(frame, block)
        elif silent:
            pass
        elif block.axes or block.vector or (block.params and control.kind > LINEAR):
            if {"I", "J", "K"} & block.params.keys() and control.kind <= LINEAR:
                self._note("I, J and K have no meaning for a straight line", Severity.WARNING)
            if block.vector and not control.tip_programmed:
                self._note("A3= B3= C3= need TRAORI: the vector is taken as the tool axis", Severity.WARNING)
            if control.tool_frame and {"X", "Y"} & block.axes.keys():
                self._note(
                    "X and Y before TOROTOF point where the control's settings have them: not known", Severity.ERROR
                )
            control.move(
                block.axes,
                block.tool_axis,
                circle=control.circle(block.params, block.axes),
                machine_frame=machine_frame,
                feed_written=block.feed is not None,
            )
            calls = [*([active.modal] if active.modal else []), *calls]
        for call in calls:
            if call.name in _BUILT_IN:
                self._call(call)
        for code in late:
            self._m_code(code)
        self._enter_one([call for call in calls if call.name not in _BUILT_IN])

    def _g_code(self, code: int) -> None:
        control = self._control
        if code in G_RADIUS_COMPENSATION:
            control.compensation.set(control.row, G_RADIUS_COMPENSATION[code])
        if code in (RAPID, LINEAR, CLOCKWISE, COUNTER):
            control.kind = code
        elif code in G_PLANES:
            control.set_working_plane("XYZ".index(G_PLANES[code]))
        elif code in G_UNITS:
            control.set_units(*G_UNITS[code])
        elif code in (90, 91):
            control.absolute = code == 90
        elif code in G_FEEDS:
            control.feed_mode.set(control.row, G_FEEDS[code])
            if code in G_SURFACE:
                self._note(f"G{code}: constant surface speed: only the kind of feed is followed", Severity.WARNING)
        elif code in G_OFFSETS:
            control.set_offset(code, f"G{code}")
        elif code in G_NOT_SIMULATED:
            text, grave = G_NOT_SIMULATED[code]
            self._note(f"G{code}: {text}", Severity.ERROR if grave else Severity.WARNING)
            if code in (33, 63, 331, 332):
                control.kind = LINEAR
        elif (
            code not in G_WITHOUT_PATH_EFFECT
            and code not in G_RADIUS_COMPENSATION
            and code not in G_MACHINE
            and code != 4
        ):
            self._note(f"unknown word G{code}", Severity.ERROR)

    def _word(self, word: str, block: Block) -> None:
        control = self._control
        match word:
            case "TRAORI":
                if block.traori not in (1.0, 2.0):
                    self._note(f"TRAORI({block.traori:g}): taken as TRAORI", Severity.WARNING)
                control.set_tcp(True)
            case "TRAFOOF":
                control.set_tcp(False)
            case "CIP":
                control.kind = THROUGH
            case "ORIAXES":
                control.set_orientation(Orientation.ANGLES)
            case "ORIVECT" | "ORIPLANE":
                control.set_orientation(Orientation.GREAT_CIRCLE)
            case "ORIMKS" | "ORIWKS":
                control.set_machine_vectors(word == "ORIMKS")
            case _ if word in TOOL_FRAMES:
                control.turn_frame(word)
            case "SPOS":
                control.add_event("spindle", "oriented")
            case _:
                # Frames come after this, SUPA before; the rest drives, and leaves the path alone.
                assert word in FRAMES or word in WITHOUT_PATH_EFFECT or word == "SUPA" or word.startswith("ORI")

    def _dwell(self, block: Block) -> None:
        if block.feed is not None:
            self._control.add_event("dwell", block.feed)
        elif block.speed is not None:
            self._control.add_event("dwell", -block.speed)
        else:
            self._note("G4 without a time", Severity.WARNING)
        if block.axes:
            self._note("axis words beside G4 are not executed", Severity.ERROR)

    def _m_code(self, code: int) -> None:
        control = self._control
        if code in M_SPINDLE:
            control.spindle.set(control.row, M_SPINDLE[code])
        if code in M_EVENTS:
            control.add_event(*M_EVENTS[code])
        elif code == M_CHANGE:
            control.change_tool()
        elif code in M_PROGRAM_ENDS:
            control.add_event("end", f"M{code}")
            raise ProgramEnd
        elif code == M_RETURN:
            self._leave_program()
        else:
            control.add_event("m", float(code))

    def _frame(self, words: list[str], block: Block) -> None:
        control = self._control
        if len(words) > 1:
            self._note("several frame words in one block: the last one counts", Severity.ERROR)
        word = words[-1]
        adds = word.startswith("A")
        base = word.removeprefix("A")
        values: dict[str, float] = {}
        for name, (value, _) in {**block.axes, **block.params}.items():
            if abs(value) * control.length_unit > MAX_POSITION:
                self._note(f"{word}: {name} is larger than any machine: the frame is not used", Severity.ERROR)
                return
            if name in ("X", "Y", "Z"):
                values[name] = value * control.length_unit if base == "TRANS" else value
            elif name == "RPL":
                values[name] = value
            else:
                self._note(f"{word}: {name} is not simulated", Severity.ERROR)
        frame = frame_of_statement(base, values, control.plane_axis)
        control.set_program_frame(control.program_frame.compose(frame) if adds else frame)
        control.add_event("frame", "" if not adds and not values else word)

    # Cycles and calls

    def _call(self, call: Call) -> None:
        """Carry out a cycle or a message."""
        control = self._control
        name = call.name
        if name in cycles.CYCLES:
            self._drill(call)
        elif name == "CYCLE832":
            values = tuple(
                text if text in CONSTANTS else value
                for text, value in zip(call.argument_texts, call.arguments, strict=True)
            )
            control.add_event("cycle832", values)
        elif name == "CYCLE800":
            swivel(control, call)
        elif name == "MSG":
            first = call.arguments[0] if call.arguments else ""
            control.add_event("message", first if isinstance(first, str) else f"{first or 0:g}")
        else:
            assert name == "SETAL"
            control.add_event("message", f"SETAL({', '.join(call.argument_texts)})")

    def _enter_one(self, calls: Sequence[Call]) -> None:
        """Call the subprogram of a block, which goes on only after all that the block says."""
        if len(calls) > 1:
            self._note("several subprograms in one block: only the first is executed", Severity.ERROR)
        for call in calls[:1]:
            self._enter_subprogram(call.name, call)

    def _drill(self, call: Call) -> None:
        control = self._control
        try:
            numbers = [finite(self._plain_number(value)) for value in call.arguments]
            steps = cycles.cycle_motions(call.name, numbers, float(control.rpm.current))
        except CycleExecutionError as error:
            self._note(f"{call.name} {error}: it is not executed", Severity.ERROR)
            return
        self._count_blocks(len(steps))
        control.drill(steps)

    @staticmethod
    def _plain_number(value: Value | None) -> float | None:
        if isinstance(value, str):
            raise CycleExecutionError("has a text where a number must stand")
        return value

    def _enter_subprogram(self, name: str, call: Call) -> None:
        """Call a subprogram, one of the files that were named."""
        path = self._subprograms.find(name)
        if path is None:
            self._note(
                f"unknown word or missing subprogram {name[:80]}: it is not executed; name its file, if it is one",
                Severity.ERROR,
            )
            return
        if call.repeats < 1:
            return
        self._check_depth()
        variables = Variables(self._stack[-1].variables)
        text, file = self._open_subprogram(path)
        assert isinstance(text, SinumerikText)
        self._stack.append(ActiveProgram(text, file, call.repeats, variables=variables))
        self._bind(call)

    def _bind(self, call: Call) -> None:
        """Hand arguments to the PROC line, which reads them when it is executed."""
        self._stack[-1].variables.pass_arguments(call.arguments)

    def _return(self, reader: ExpressionReader, active: ActiveProgram, line: int) -> None:
        self._leave_program()

    def _mcall(self, reader: ExpressionReader, active: ActiveProgram, line: int) -> None:
        token = reader.token
        if token is None:
            active.modal = None
            return
        if token.kind is TokenKind.LETTER and token.text == "L":
            reader.at += 1
            number = reader.token
            if number is None or not number.text.isdigit():
                raise ExpressionError("a subprogram has a number")
            active.modal = Call(f"L{number.text}")
            return
        if token.kind is not TokenKind.NAME:
            raise ExpressionError("a name must follow")
        reader.at += 1
        active.modal = read_call(reader, token.text)

    def _extcall(self, reader: ExpressionReader, active: ActiveProgram, line: int) -> None:
        inside = reader.accept("(")
        value = reader.value()
        if inside:
            reader.expect(")")
        if not isinstance(value, str):
            raise ExpressionError("takes the name of a program")
        self._enter_subprogram(value, Call(value))
