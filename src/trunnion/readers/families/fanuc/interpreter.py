"""Fanuc programs, block by block: what each one says goes to the virtual control, and where it goes on."""

from collections.abc import Sequence
from pathlib import Path
from typing import Final

import numpy as np

from trunnion.arrays import Codes, Floats
from trunnion.errors import Severity
from trunnion.machines import Machine, Mount
from trunnion.model.run import Orientation
from trunnion.readers.control.axis_word import AxisWord, PositionMode
from trunnion.readers.control.hole_motion import CycleExecutionError, HoleMotion
from trunnion.readers.control.row_recorder import MAX_POSITION
from trunnion.readers.control.virtual_control import RAPID
from trunnion.readers.families.fanuc import cycles, words
from trunnion.readers.families.fanuc.control import FanucControl
from trunnion.readers.families.fanuc.flow import ActiveProgram, assign
from trunnion.readers.families.fanuc.offsets_and_frames import OffsetInterpreter
from trunnion.readers.families.fanuc.text import FanucText
from trunnion.readers.families.fanuc.variables import ARITHMETIC
from trunnion.readers.program.interpreter import DEFAULT_STEP_LIMIT, ProgramEnd
from trunnion.readers.program.source_text import SourceText
from trunnion.readers.rs274.block import Block, block_reader, read_block
from trunnion.readers.rs274.expressions import BlockError
from trunnion.readers.rs274.interpreter import CANCEL, MOTIONS

#: More holes at one place than a program means.
_MOST_HOLES: Final = 10_000


class FanucInterpreter(OffsetInterpreter):
    """Runs one Fanuc program on one machine."""

    source_type = FanucText

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
        super().__init__(path, machine, subprograms=subprograms, step_limit=step_limit, skip=skip)
        self._control = FanucControl(
            machine, self._note, self._file, shortest=shortest, calculator=self._settings.calculator
        )
        self._to_initial = True
        self._initial: float | None = None
        self._modal_words: dict[str, float] = {}
        self._length_number = -1

    @property
    def control(self) -> FanucControl:
        """The virtual control."""
        return self._control

    @property
    def _table(self) -> Codes:
        return self._control.plain_table

    def _main_program(self, text: SourceText) -> ActiveProgram:
        assert isinstance(text, FanucText)
        return ActiveProgram(text, 0)

    def _may_scan(self, text: SourceText) -> bool:
        return self._stack[-1].modal is None and super()._may_scan(text)

    def _system_value(self, key: int) -> float | None:
        control = self._control
        axes = {0: "X", 1: "Y", 2: "Z", **{3 + k: name for k, name in enumerate(control.rotary_names)}}
        if 5001 <= key <= 5005 or 5041 <= key <= 5045:
            axis = (key - 1) % 20
            if axis < 3:
                return float(control.commanded[axis]) / control.length_unit
            control.resolve_rows()
            return float(control.current_joints[control.machine.column(axes[axis])])
        if 5021 <= key <= 5025:
            control.resolve_rows()
            value = float(control.current_joints[control.machine.column(axes[key - 5021])])
            return value / control.length_unit if key <= 5023 else value
        return None

    # Blocks

    def _execute_block(self, active: ActiveProgram, line: int, text: str) -> None:
        if text[0] in "O:":
            self._program_number(active, line, text)
            return
        reader = block_reader(text, ARITHMETIC, self._variables)
        if self._flow.accept(active, line, reader):
            return
        self._execute_words(active, line, read_block(reader, self._report_repeated_word))

    def _program_number(self, active: ActiveProgram, line: int, text: str) -> None:
        """An O number begins a program; where another one runs into it, that one has ended."""
        digits = text[1:]
        if not digits.isdigit() or len(digits) > 8:
            raise BlockError(f"no program number: {text[:40]!r}")
        if active.begun and active.line != line:
            self._note("the program runs into the next one: it ends here", Severity.ERROR)
            self._end_of_file(active)
        active.begun = True

    def _end_of_file(self, active: ActiveProgram) -> None:
        if len(self._stack) < 2:
            raise ProgramEnd
        self._leave_program()

    def _execute_words(self, active: ActiveProgram, line: int, block: Block) -> None:
        control = self._control
        if words.MACRO in block.g or words.MODAL_MACRO in block.g:
            self._macro(active, block)
            assign(self._variables, block)
            return
        for code in block.g:
            if code in (200, 210, 930, 940, 950):
                self._modal_g_code(code)
        tilts = words.TILT in block.g
        if words.DWELL not in block.g:
            self._settings.scale(
                block, control.feed_mode.current, control.length_unit != 1.0, angles="IJKR" if tilts else ""
            )
        self._feed_and_speed(block)
        tool = block.take("T")
        if tool is not None:
            control.select_tool(f"{tool:g}")
        for code in block.m:
            if code not in words.AFTER_MOTION:
                self._m_code(code)
        special, machine_frame = self._codes(block)
        number = block.take("H")
        if number is not None and 0 <= number < 1e6:
            self._length_number = int(number)
        # The control keeps H after G49, but no length is in force.
        control.edge.set(control.row, self._length_number if control.length_active else -1)
        block.take("D")
        if special in words.TAKING_AXIS_WORDS:
            self._special(special, block)
        elif not any(code in words.NO_MOTION for code in block.g):
            self._execute_motion(active, block, machine_frame)
        if words.ALIGN_TOOL in block.g:
            self._align_with_plane(block)
        assign(self._variables, block)
        late = [code for code in block.m if code in words.AFTER_MOTION]
        for code in late:
            self._late(active, line, code, block)
        self._report_unused_words(block)

    def _codes(self, block: Block) -> tuple[int, bool]:
        """Set what G codes set; returns the one that takes the axis words (-1: none), and whether G53 is there."""
        special = -1
        machine_frame = False
        for code in block.g:
            if code in words.TAKING_AXIS_WORDS:
                if special >= 0:
                    raise BlockError("two G words want the words of the block")
                special = code
            elif code == words.MACHINE:
                machine_frame = True
            elif code in MOTIONS or code in cycles.CYCLES or code == CANCEL:
                self._select_motion(code)
            elif code not in (200, 210, 930, 940, 950):
                self._g_code(code, block)
        return special, machine_frame

    def _select_motion(self, code: int) -> None:
        """Take up a motion or a cycle."""
        control = self._control
        if code in cycles.CYCLES:
            if self._initial is None:
                self._initial = float(control.commanded[control.plane_axis])
                self._modal_words = {}
            self.motion = code
            return
        self._initial = None
        self.motion = control.kind * 10 if code == CANCEL else code
        if code in MOTIONS:
            control.kind = MOTIONS[code]

    def _g_code(self, code: int, block: Block) -> None:
        control = self._control
        for letter in words.WORDS_OF_CODE.get(code, ""):
            block.take(letter)
        if code in words.OFFSETS or code == words.MORE_OFFSETS:
            self._offset(code, block)
        elif code in (words.TCP, words.TCP_VECTOR):
            self._tcp(code, block)
        elif code in (words.LENGTH_OFF, 430, 440):
            block.take("H")
            control.vectors = False
            control.set_tcp(False)
            control.set_length(code != words.LENGTH_OFF)
            if code == 440:
                self._note("G44: taken as G43, the length with the other sign is not simulated", Severity.WARNING)
        elif code == words.ROTATION_OFF:
            control.cancel_rotation()
        elif code in (980, 990):
            self._to_initial = code == 980
        elif code == words.MODAL_MACRO_OFF:
            self._stack[-1].modal = None
        elif code in words.TAKEN_AS_LINES:
            self._report_g_code(code, words.NOT_SIMULATED, words.WITHOUT_PATH_EFFECT)
            self._select_motion(10)
        elif code == 960:
            control.feed_mode.set(control.row, 95)
            self._report_g_code(code, words.NOT_SIMULATED, words.WITHOUT_PATH_EFFECT)
        elif code != words.ALIGN_TOOL and not self._modal_g_code(code):
            self._report_g_code(code, words.NOT_SIMULATED, words.WITHOUT_PATH_EFFECT)

    def _tcp(self, code: int, block: Block) -> None:
        """G43.4 and G43.5; P says how the tool axis moves from block to block."""
        control = self._control
        block.take("H")
        posture = block.take("P")
        if posture not in (None, 0.0, 1.0):
            self._note(f"P{posture:g} of G43.4 and G43.5 is not known", Severity.ERROR)
        vectors = code == words.TCP_VECTOR
        if control.tcp and control.vectors != vectors:
            self._note("G43.4 and G43.5 change without G49 between them: taken as if it were there", Severity.WARNING)
        if vectors and any(letter in block.words for letter in "IJK") and not self._in_head:
            self._note("I J K in the block of G43.5: an alarm where a table turns (PS5421)", Severity.ERROR)
        control.set_tcp(True)
        control.set_length(True)
        control.set_orientation(Orientation.GREAT_CIRCLE if posture == 1.0 else Orientation.ANGLES)
        control.vectors = vectors

    @property
    def _in_head(self) -> bool:
        """Whether both rotary axes turn the tool."""
        machine = self._control.machine
        return all(machine.axes[column].mount is Mount.TOOL for column in machine.rotary)

    def _m_code(self, code: int) -> None:
        if not self._common_m_code(code):
            self._control.add_event("m", float(code))

    def _late(self, active: ActiveProgram, line: int, code: int, block: Block) -> None:
        if code == words.CALL:
            self._call(block)
        elif code == words.RETURN:
            self._return(active, line, block)
        elif code == words.CALL_FILE:
            for letter in "PL":
                block.take(letter)
            self._note("M198: programs of other folders are not called", Severity.ERROR)
        else:
            self._m_code(code)

    # Motion

    def _execute_motion(self, active: ActiveProgram, block: Block, machine_frame: bool) -> None:
        """Make the motion that the words of the block ask for."""
        control = self._control
        axes = self._axis_words(block)
        vector = self._vector(block) if control.vectors and self.motion in (0, 10) else None
        if self.motion in cycles.CYCLES:
            self._cycle(block, axes)
            if axes:
                self._call_modal(active)
            return
        circle = self.motion in (20, 30) and any(letter in block.words for letter in "IJKR")
        if not axes and vector is None and not circle:
            return
        if machine_frame:
            if not control.absolute:
                raise BlockError("G53 needs G90")
            control.kind = MOTIONS[self.motion]
            self._check_feed("F" in block.words)
            control.move(
                {name: (word[0], PositionMode.ABSOLUTE) for name, word in axes.items()},
                None,
                machine_frame=True,
                feed_written="F" in block.words,
            )
        elif vector is not None:
            control.kind = MOTIONS[self.motion]
            self._check_feed("F" in block.words)
            control.move(axes, vector, feed_written="F" in block.words)
        else:
            self._move(block, axes)
        self._call_modal(active)

    def _vector(self, block: Block) -> Floats | None:
        """G43.5: I J K are the tool axis; those that are not written are 0 where one is."""
        values = [block.take(letter) for letter in "IJK"]
        incline = block.take("Q")
        if incline:
            self._note("the inclination Q of G43.5 is not simulated", Severity.ERROR)
        if all(value is None for value in values):
            return None
        vector = np.array([value or 0.0 for value in values])
        if not 1e-12 < float(np.linalg.norm(vector)) < MAX_POSITION:
            raise BlockError("the tool axis has no direction")
        return vector

    # Cycles

    def _cycle(self, block: Block, axes: dict[str, AxisWord]) -> None:
        """Drill at the position of a block."""
        control = self._control
        along = "XYZ"[control.plane_axis]
        given = {
            letter: value
            for letter in cycles.MODAL_WORDS
            if letter != "Z" and (value := block.take(letter)) is not None
        }
        if along in axes:
            given["Z"] = axes[along][0]
        self._modal_words |= given
        repeats = block.take("K")
        block.take("L")
        if not axes and not ({"R", "Z"} & given.keys()):
            return
        if set(axes) - set("XYZ"):
            self._note("rotary words in a cycle: they are not executed", Severity.ERROR)
        missing = [letter for letter in "ZR" + "Q" * (self.motion in cycles.NEED_Q) if letter not in self._modal_words]
        if missing:
            raise BlockError(f"the cycle has no {missing[0]}")
        times = 1 if repeats is None else int(repeats)
        if not 0 <= times <= _MOST_HOLES:
            raise BlockError("K of a cycle is how often it drills")
        if not control.commanded[3] > 0.0:
            self._note("a cycle without a feed", Severity.ERROR)
        made = self._motions(self._hole())
        plane = {name: word for name, word in axes.items() if name in "XYZ" and name != along}
        kind = control.kind
        for _ in range(times):
            self._count_blocks(len(made) + 1)
            control.kind = RAPID
            control.move(plane, None)
            control.drill(made)
        control.kind = kind

    def _hole(self) -> cycles.Hole:
        control = self._control
        scale = control.length_unit
        now = self._modal_words
        assert self._initial is not None
        initial = self._initial / scale
        retract, bottom = now["R"], now["Z"]
        if not control.absolute:
            retract += initial
            bottom += retract
        stroke = abs(now.get("Q", 0.0))
        lateral = (now["I"], now.get("J", 0.0)) if "I" in now else (0.0, now["J"]) if "J" in now else (stroke, 0.0)
        return cycles.Hole(
            retract,
            bottom,
            initial,
            self._to_initial,
            stroke,
            lateral,
            max(now.get("P", 0.0), 0.0) / 1000.0,
            1.0 / scale,
        )

    def _motions(self, hole: cycles.Hole) -> list[HoleMotion]:
        try:
            return cycles.cycle_motions(self.motion, hole)
        except CycleExecutionError as error:
            raise BlockError(f"the cycle {error}") from None
