"""The reader of the toy control, written from its description and not from its writer."""

import re
from typing import Final

from trunnion.arrays import Codes
from trunnion.machines import Axis, Machine
from trunnion.messages import foreign
from trunnion.readers.control.event_recorder import Note
from trunnion.readers.program.family_reader import FamilyReader
from trunnion.readers.program.source_text import SourceText
from trunnion.readers.program.work_offsets import WorkOffsetWords, first_number
from trunnion.readers.rs274.block import Block, block_reader, read_block
from trunnion.readers.rs274.control import Rs274Control
from trunnion.readers.rs274.expressions import Arithmetic, BlockError, Value
from trunnion.readers.rs274.interpreter import ActiveProgram, Rs274Interpreter
from trunnion.readers.scan.letter_blocks import letter_table

#: The word that begins a block; blanks are gone when it is read.
_COMMAND: Final = re.compile(r"RAPID|LINE|CCW|CW|PARK|ORIGIN|LENGTH(?:ON|OFF)|TCP(?:ON|OFF)|TOOL|WAIT|END|(?=M)")

#: G codes of motion, in tenths, as the common interpreter counts them.
_MOTIONS: Final = {"RAPID": 0, "LINE": 10, "CW": 20, "CCW": 30}


class _NoParameters:
    def value(self, key: int | str) -> Value:
        raise BlockError(foreign("the toy has no parameters", code="NC210"))

    def is_set(self, key: int | str) -> bool:
        return False


_ARITHMETIC: Final = Arithmetic(levels=(), operators={}, functions={}, pairs={})


class ToyControl(Rs274Control):
    """The virtual toy control."""

    relative_centres = False
    knows_units = True

    def __init__(self, machine: Machine, note: Note, *, shortest: bool | None = None) -> None:
        super().__init__(machine, note, shortest=shortest)
        self.letter_table = letter_table((self.rotary_names[0], self.rotary_names[1]), gaps=True)

    def takes_shortest_path(self, axis: Axis) -> bool:
        return True


class ToyInterpreter(Rs274Interpreter[ActiveProgram]):
    """Runs a toy program on a machine."""

    semicolon = True

    control: ToyControl

    def _make_control(self) -> ToyControl:
        return ToyControl(self._machine, self._note, shortest=self._options.shortest)

    @property
    def _letter_table(self) -> Codes:
        return self.control.letter_table

    def _main_program(self, source: SourceText) -> ActiveProgram:
        return ActiveProgram(source, 0)

    def _may_scan(self, source: SourceText) -> bool:
        return False

    def _execute_block(self, active: ActiveProgram, line: int, text: str) -> None:
        match = _COMMAND.match(text)
        if match is None:
            raise BlockError(foreign("no command", code="NC210"))
        command, rest = match.group(), text[match.end() :]
        control = self.control
        if command == "TOOL":
            control.select_tool(rest)
            control.change_tool()
        elif command == "ORIGIN":
            control.set_offset(int(rest), f"ORIGIN {rest}")
        elif command.startswith("LENGTH"):
            control.set_length(command.endswith("ON"))
        elif command.startswith("TCP"):
            control.set_tcp(command.endswith("ON"))
        elif command == "WAIT":
            control.add_event("dwell", float(rest))
        elif command == "END":
            self._common_m_code(30)
        else:
            self._execute_words(
                command, read_block(block_reader(rest, _ARITHMETIC, _NoParameters()), self._report_repeated_word)
            )

    def _execute_words(self, command: str, block: Block) -> None:
        for code in block.m:
            if not self._common_m_code(code):
                raise BlockError(foreign(f"unknown M{code}", code="NC210"))
        self._feed_and_speed(block)
        if command == "PARK":
            self.control.motion = 0
            self.control.move(self._axis_words(block), None, machine_frame=True)
        elif command:
            self.motion_code = _MOTIONS[command]
            self._move(block, self._axis_words(block))
        self._report_unused_words(block)


READER: Final = FamilyReader(
    ToyInterpreter,
    frozenset(),
    WorkOffsetWords(
        "1 to 99",
        re.compile(r"([0-9]{1,2})"),
        first_number,
        lambda value: f"ORIGIN {value}",
        lambda n: n if n <= 99 else 0,
        plain=True,
    ),
    is_own_word=lambda word: False,
    comments=rb";[^\n]*",
    uses_length_numbers=False,
)
