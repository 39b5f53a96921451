"""Klartext programs, block by block: what each one says goes to the virtual control, and where it goes on."""

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

from trunnion.errors import Severity
from trunnion.machines import Machine
from trunnion.readers.control.axis_word import PositionMode
from trunnion.readers.control.hole_motion import CycleExecutionError
from trunnion.readers.control.virtual_control import INCH, LINEAR, RAPID
from trunnion.readers.families.heidenhain import scan_kernel
from trunnion.readers.families.heidenhain.control import HeidenhainControl
from trunnion.readers.families.heidenhain.cycle_definitions import Definitions
from trunnion.readers.families.heidenhain.fn_functions import ASSIGNED, assign, execute
from trunnion.readers.families.heidenhain.lexer import MAX_LENGTH, Line, split_line, words
from trunnion.readers.families.heidenhain.machine_functions import MFunctions, tool_block
from trunnion.readers.families.heidenhain.parameters import KlartextError, Parameters, canonical
from trunnion.readers.families.heidenhain.path_blocks import Block, circle_of, polar_end, read_block
from trunnion.readers.families.heidenhain.plane_blocks import plane_block, tcpm_block
from trunnion.readers.families.heidenhain.text import SUFFIXES, KlartextText
from trunnion.readers.families.heidenhain.words import BLOCKS_NOT_SIMULATED, M_CALL, M_MACHINE, M_SECOND_MACHINE, PATHS
from trunnion.readers.program import interpreter
from trunnion.readers.program.interpreter import DEFAULT_STEP_LIMIT, Interpreter, ProgramEnd
from trunnion.readers.program.source_text import SourceText, Subprograms

#: Subprograms by label inside each other.
MAX_LABEL_DEPTH: Final = 20

#: Feeds of inch programs count tenths of an inch.
_TENTH: Final = 0.1 * INCH

#: Whether a line may be plain: a look at its beginning saves starting the kernel in vain.
_PLAIN_START = re.compile(rb"[ \t]*(?:[0-9]+[ \t]*)?(?:;|[Ll][Nn]?[ \t])")
_PREFIX_LENGTH: Final = 32

#: Radius compensation: left of the path, right of it, off.
_RADIUS_COMPENSATION: Final = {"R0": 0, "RL": 1, "RR": -1}

_LABEL = re.compile(r"(Q[LR]?[0-9]{1,4})|([0-9]{1,5})")
_CYCLE = re.compile(r"[ \t]*(DEF|CALL)(?![A-Z])")
_CALL = re.compile(r"[ \t]*(LBL|PGM)(?![A-Z])")
_HEAD = re.compile(r"([A-Z]+)")
_PATH = re.compile(rf"({'|'.join(sorted(PATHS, key=len, reverse=True))})(?=[ \t]|$)")


@dataclass(slots=True)
class ActiveProgram(interpreter.ActiveProgram):
    """A program being executed.

    returns   lines after the calls of its labels
    left      repeats that are left, by the line of the call
    """

    source: KlartextText
    parameters: Parameters = field(default_factory=Parameters)
    returns: list[int] = field(default_factory=list)
    left: dict[int, int] = field(default_factory=dict)


class HeidenhainInterpreter(Interpreter[ActiveProgram]):
    """Runs one Klartext program on one machine."""

    source_type = KlartextText

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
        super().__init__(path, machine, Subprograms(subprograms, SUFFIXES), step_limit=step_limit, skip=skip)
        self._control = HeidenhainControl(machine, self._note, self._file, shortest=shortest)
        self._definitions = Definitions(self._control, self._note)
        #: Parts of a block that goes on over several lines.
        self._block_parts: list[str] = []
        self._block_start = 0, -1
        self._functions = MFunctions(self._control, self._note)
        self._tool_feed: float | None = None
        self._handlers: dict[str, Callable[[ActiveProgram, str], None]] = {
            "BEGIN": self._begin_program,
            "END": self._end_program,
            "BLK": self._nothing,
            "TOOL": self._tool,
            "CYCL": self._cycle,
            "CYCLE": self._cycle,
            "CALL": self._call,
            "LBL": self._label,
            "FN": self._function,
            "PLANE": self._plane,
            "FUNCTION": self._special,
            "CC": self._pole,
            "STOP": self._stop,
        }

    @property
    def control(self) -> HeidenhainControl:
        """The virtual control."""
        return self._control

    def _main_program(self, text: SourceText) -> ActiveProgram:
        assert isinstance(text, KlartextText)
        return ActiveProgram(text, 0)

    def _may_scan(self, text: SourceText) -> bool:
        if self._block_parts or self._functions.modal_call or self._control.compensation.current:
            return False
        return _PLAIN_START.match(text.buffer[text.position : text.position + _PREFIX_LENGTH].tobytes()) is not None

    def _scan_blocks(self, text: SourceText) -> None:
        control = self._control
        scan_kernel.scan_blocks(
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

    # Lines and blocks

    def _execute_line(self, active: ActiveProgram, line: int, raw: str) -> None:
        if len(raw) > MAX_LENGTH:
            self._block_parts.clear()
            self._note(f"the line is longer than {MAX_LENGTH} characters: it is not executed", Severity.ERROR)
            return
        parts = split_line(raw)
        if self._block_parts and parts.number >= 0 and not ASSIGNED.match(parts.statement):
            self._note("the block before it goes on (~), and a new one begins", Severity.ERROR)
            self._finish(active)
            self._control.line = line
        if parts.block_skip and self._skip:
            parts = Line(parts.number, True, "", parts.comment, False)
        if not self._block_parts:
            self._block_start = line, parts.number
        if parts.statement:
            self._block_parts.append(parts.statement)
        try:
            if not (parts.continues and self._block_parts):
                self._finish(active)
            elif sum(map(len, self._block_parts)) > MAX_LENGTH:
                self._block_parts.clear()
                self._note(f"the block is longer than {MAX_LENGTH} characters: it is not executed", Severity.ERROR)
        finally:
            self._record_comment(line, parts.comment)

    def _finish(self, active: ActiveProgram) -> None:
        """Execute the block whose parts have come together."""
        statement = " ".join(self._block_parts)
        self._block_parts.clear()
        if not statement:
            return
        self._control.line, self._control.block_number = self._block_start
        try:
            self._statement(active, statement)
        except KlartextError as error:
            self._note(f"not understood: {statement[:80]}: {error}: the block is not executed", Severity.ERROR)

    def _leave_program(self) -> None:
        if self._block_parts:
            # The last block said that it goes on, and nothing came.
            self._finish(self._stack[-1])
            return
        super()._leave_program()

    def _statement(self, active: ActiveProgram, statement: str) -> None:
        path, assigned = _PATH.match(statement), ASSIGNED.match(statement)
        if path is not None:
            self._motion(active, path[0], statement[path.end() :])
            return
        if assigned is not None:
            assign(assigned[1], statement[assigned.end() :], active.parameters)
            return
        head = _HEAD.match(statement)
        word = "" if head is None else head[0]
        if word in self._handlers:
            self._handlers[word](active, statement[len(word) :])
        elif word in BLOCKS_NOT_SIMULATED:
            self._note(f"{word} {BLOCKS_NOT_SIMULATED[word]}", Severity.ERROR)
        else:
            # A block of M words, or one axis on its own, needs no head.
            self._motion(active, "L", statement)

    def _nothing(self, active: ActiveProgram, rest: str) -> None:
        pass

    def _begin_program(self, active: ActiveProgram, rest: str) -> None:
        if not rest.split()[:1] == ["PGM"]:
            raise KlartextError("BEGIN needs PGM")
        unit = rest.split()[-1]
        if unit not in ("MM", "INCH"):
            self._note("BEGIN PGM without MM or INCH: taken as millimetres", Severity.WARNING)
        self._control.set_units(unit == "INCH", False)
        self._control.feed_unit = _TENTH if unit == "INCH" else 1.0

    def _end_program(self, active: ActiveProgram, rest: str) -> None:
        self._block_parts.clear()
        self._leave_program()

    def _stop(self, active: ActiveProgram, rest: str) -> None:
        block = read_block(words(rest), active.parameters)
        self._functions.execute_before_motion(block)
        self._control.add_event("stop")
        self._functions.execute_after_motion(block)

    # Motion

    def _motion(self, active: ActiveProgram, head: str, rest: str) -> None:
        control = self._control
        block = read_block(words(rest), active.parameters)
        machine = {M_MACHINE, M_SECOND_MACHINE} & {code for code, _ in block.m}
        self._check_axes(block)
        axes = block.axes
        if head in ("LP", "CP", "CTP"):
            axes = polar_end(control, block, circle=head == "CP")
        elif block.polar:
            raise KlartextError(f"{head} has no polar coordinates")
        if block.radius is not None and head != "CR":
            raise KlartextError(f"{head} has no radius")
        circle = circle_of(control, head, block) if head[0] == "C" else None
        vector = block.tool_axis
        feed = self._feed(block)
        self._functions.execute_before_motion(block)
        if feed is not None:
            control.commanded[3] = feed
        control.kind = RAPID if block.rapid else LINEAR
        if block.side:
            control.compensation.set(control.row, _RADIUS_COMPENSATION[block.side])
        if block.side in ("RL", "RR"):
            text = "radius compensation is not simulated: the path is that of the tool centre as programmed"
            self._note(f"{block.side}: {text}", Severity.WARNING)
        if M_SECOND_MACHINE in machine:
            self._note("M92: where it counts from is set in the machine, taken as M91", Severity.WARNING)
        if vector is not None and not control.tip_programmed:
            self._note("TX TY TZ need M128: the vector is taken as the tool axis", Severity.WARNING)
        moves, row = bool(axes) or vector is not None or circle is not None, control.row
        if moves:
            control.move(
                axes,
                vector,
                circle=circle,
                machine_frame=bool(machine),
                feed_written=block.feed is not None and not block.rapid,
            )
            if block.normal is not None and control.row > row:
                control.add_normal(block.normal)
        calls = any(code == M_CALL for code, _ in block.m)
        if calls or (self._functions.modal_call and moves and not machine):
            self._drill(active)
        if calls:
            self._functions.modal_call = False
        self._functions.execute_after_motion(block)

    def _check_axes(self, block: Block) -> None:
        """Say which axes the machine does not have, and take them out."""
        known = {"X", "Y", "Z", *self._control.rotary_names} | (
            {"A", "B", "C"} if self._control.spatial_angles_active else set()
        )
        for name in sorted(block.axes.keys() - known):
            self._note(f"the machine has no axis {name}: its word is not executed", Severity.ERROR)
            del block.axes[name]

    def _feed(self, block: Block) -> float | None:
        """Feed of a block in mm/min, None if it has none."""
        if block.feed is not None:
            return block.feed * self._control.feed_unit
        if block.feed_of_tool and self._tool_feed is None:
            raise KlartextError("F AUTO, and TOOL CALL has no F")
        return self._tool_feed if block.feed_of_tool else None

    def _pole(self, active: ActiveProgram, rest: str) -> None:
        control = self._control
        # A pole that is not understood leaves none.
        control.pole = None
        block = read_block(words(rest), active.parameters)
        pole = control.commanded[:3].copy()
        for name, (value, how) in block.axes.items():
            if name not in ("X", "Y", "Z"):
                raise KlartextError(f"CC takes no {name}")
            axis = "XYZ".index(name)
            pole[axis] = value * control.length_unit + (pole[axis] if how is PositionMode.INCREMENTAL else 0.0)
        control.pole = pole

    def _drill(self, active: ActiveProgram) -> None:
        try:
            made = self._definitions.motions_of_call(active.parameters)
        except CycleExecutionError as error:
            self._note(f"the cycle {error}: it is not executed", Severity.ERROR)
            return
        self._count_blocks(len(made))
        self._control.drill(made)

    # Tools and cycles

    def _tool(self, active: ActiveProgram, rest: str) -> None:
        feed = tool_block(self._control, rest, active.parameters)
        if feed is not None:
            self._tool_feed = feed

    def _cycle(self, active: ActiveProgram, rest: str) -> None:
        match = _CYCLE.match(rest)
        if match is None:
            raise KlartextError("CYCL needs DEF or CALL")
        rest = rest[match.end() :]
        if match[1] == "DEF":
            self._definitions.define(rest, active.parameters)
            return
        said = words(rest)
        first = said[0].name if said else ""
        if first == "PAT":
            self._note("CYCL CALL PAT: point patterns are not simulated", Severity.ERROR)
            return
        position = first == "POS"
        block = read_block(said[1:] if position else said, active.parameters)
        if block.axes and not position:
            raise KlartextError("CYCL CALL takes no positions")
        self._functions.execute_before_motion(block)
        if block.feed is not None:
            self._control.commanded[3] = block.feed * self._control.feed_unit
        if position:
            self._control.kind = LINEAR if block.feed is not None and not block.rapid else RAPID
            self._control.move(block.axes, None, feed_written=block.feed is not None)
        self._drill(active)
        self._functions.execute_after_motion(block)

    # Planes

    def _plane(self, active: ActiveProgram, rest: str) -> None:
        self._control.add_event("plane", rest.strip())
        plane_block(self._control, words(rest), active.parameters, self._note)

    def _special(self, active: ActiveProgram, rest: str) -> None:
        match rest.split():
            case ["TCPM", *_]:
                tcpm_block(self._control, words(rest.replace("TCPM", "", 1)), self._note)
            case ["RESET", "TCPM"]:
                self._control.spatial_angles_active = False
                self._control.set_tcp(False)
            case ["MODE", "MILL"]:
                pass
            case _:
                self._note(f"FUNCTION{rest[:60]} is not simulated", Severity.ERROR)

    # Flow

    def _label(self, active: ActiveProgram, rest: str) -> None:
        if _target(rest, active.parameters) == "0" and active.returns:
            active.source.jump(active.returns.pop())

    def _call(self, active: ActiveProgram, rest: str) -> None:
        match = _CALL.match(rest)
        if match is None:
            raise KlartextError("CALL needs LBL or PGM")
        rest = rest[match.end() :].strip()
        if match[1] == "PGM":
            self._enter_subprogram(rest.strip('"'))
            return
        where, _, again = rest.partition("REP")
        active.source.load()
        here = active.source.line
        target = self._line_of(active, where)
        if again:
            self._repeat(active, here, target, int(_target(again.split("/")[0], active.parameters)))
            return
        if len(active.returns) >= MAX_LABEL_DEPTH:
            line = self._control.line
            what = f"calls labels deeper than {MAX_LABEL_DEPTH} levels"
            raise active.source.problem(line, what, "does one call itself?")
        active.returns.append(here)
        active.source.jump(target)

    def _repeat(self, active: ActiveProgram, here: int, target: int, times: int) -> None:
        left = active.left.setdefault(here, times)
        if left > 0:
            active.left[here] = left - 1
            active.source.jump(target)
        else:
            del active.left[here]

    def _line_of(self, active: ActiveProgram, where: str) -> int:
        name = _target(where, active.parameters)
        found = active.source.label(name)
        if found is None:
            self._note(f"the label {name[:60]} is missing: the program ends here", Severity.ERROR)
            raise ProgramEnd
        return found

    def _enter_subprogram(self, name: str) -> None:
        """Call a program, one of the files that were named."""
        path = self._subprograms.find(name)
        if path is None:
            self._note(f"missing program {name[:80]}: it is not executed; name its file", Severity.ERROR)
            return
        self._check_depth()
        parameters = Parameters(self._stack[-1].parameters)
        text, file = self._open_subprogram(path)
        assert isinstance(text, KlartextText)
        self._stack.append(ActiveProgram(text, file, parameters=parameters))

    # Parameters

    def _function(self, active: ActiveProgram, rest: str) -> None:
        where = execute(rest, active.parameters, self._note)
        if where is not None:
            active.source.load()
            active.source.jump(self._line_of(active, where))


def _target(text: str, parameters: Parameters) -> str:
    """Name of a label: its number, or its name in capitals."""
    text = text.strip()
    if text[:1] == '"':
        return text.strip('"').upper()
    match = _LABEL.fullmatch(text)
    if match is None:
        raise KlartextError("a label has a number or a name in quotes")
    number = parameters[canonical(match[1])] if match[1] else float(match[2])
    if number != int(number) or number < 0.0:
        raise KlartextError(f"{number:g} is no label")
    return str(int(number))
