"""The reader of the toy control, written from its description and not from its writer."""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from trunnion.arrays import Codes
from trunnion.machines import Axis, Machine
from trunnion.readers.control.row_buffer import StepColumnBuilder
from trunnion.readers.control.row_recorder import Note
from trunnion.readers.program.family_reader import FamilyReader
from trunnion.readers.program.interpreter import DEFAULT_STEP_LIMIT
from trunnion.readers.program.source_text import SourceText, Subprograms
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
        raise BlockError("the toy has no parameters")

    def is_set(self, key: int | str) -> bool:
        return False


def _no_operation(name: str, a: float, b: float) -> float:
    raise BlockError("the toy has no expressions")


_ARITHMETIC: Final = Arithmetic(levels=(), operate=_no_operation, functions={}, pairs={})


class ToyControl(Rs274Control):
    """The virtual toy control."""

    relative_centres = False

    def __init__(
        self, machine: Machine, note: Note, file: StepColumnBuilder[int], *, shortest: bool | None = None
    ) -> None:
        super().__init__(machine, note, file, shortest=shortest)
        self.table = letter_table((self.rotary_names[0], self.rotary_names[1]), gaps=True)

    def takes_shortest_path(self, axis: Axis) -> bool:
        return True


class ToyInterpreter(Rs274Interpreter[ActiveProgram]):
    """Runs a toy program on a machine."""

    semicolon = True

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
        self._control = ToyControl(machine, self._note, self._file, shortest=shortest)

    @property
    def control(self) -> ToyControl:
        return self._control

    @property
    def _table(self) -> Codes:
        return self._control.table

    def _main_program(self, text: SourceText) -> ActiveProgram:
        return ActiveProgram(text, 0)

    def _may_scan(self, text: SourceText) -> bool:
        return False

    def _execute_block(self, active: ActiveProgram, line: int, text: str) -> None:
        match = _COMMAND.match(text)
        if match is None:
            raise BlockError("no command")
        command, rest = match.group(), text[match.end() :]
        control = self._control
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
                raise BlockError(f"unknown M{code}")
        self._feed_and_speed(block)
        if command == "PARK":
            self._control.kind = 0
            self._control.move(self._axis_words(block), None, machine_frame=True)
        elif command:
            self.motion = _MOTIONS[command]
            self._move(block, self._axis_words(block))
        self._report_unused_words(block)


READER: Final = FamilyReader(ToyInterpreter, frozenset(), comments=rb";[^\n]*", uses_length_numbers=False)
