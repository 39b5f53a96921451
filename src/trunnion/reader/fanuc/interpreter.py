"""Fanuc programs, block by block: what each one says goes to the virtual control, and where it goes on."""

from collections.abc import Sequence
from pathlib import Path
from typing import Final

import numpy as np

from trunnion.arrays import Codes, Floats
from trunnion.errors import Severity
from trunnion.machine import Machine
from trunnion.reader.control import RAPID
from trunnion.reader.drilling import CycleError, Step
from trunnion.reader.fanuc import cycles, words
from trunnion.reader.fanuc.calls import CallInterpreter
from trunnion.reader.fanuc.control import FanucControl
from trunnion.reader.fanuc.flow import Activation, assign
from trunnion.reader.fanuc.text import FanucText
from trunnion.reader.fanuc.variables import ARITHMETIC
from trunnion.reader.interpreter import STEPS, End
from trunnion.reader.rows import FARTHEST
from trunnion.reader.rs274.block import Block, block_reader, read_block
from trunnion.reader.rs274.expressions import BlockError
from trunnion.reader.rs274.interpreter import CANCEL, MOTIONS
from trunnion.reader.text import Text
from trunnion.reader.word import How, Word

#: More holes at one place than a program means.
_MOST_HOLES: Final = 10_000


class FanucInterpreter(CallInterpreter):
    """Runs one Fanuc program on one machine."""

    text_type = FanucText

    def __init__(
        self,
        path: Path,
        machine: Machine,
        *,
        subprograms: Sequence[Path] = (),
        step_limit: int = STEPS,
        skip: bool = False,
        shortest: bool | None = None,
    ) -> None:
        super().__init__(path, machine, subprograms=subprograms, step_limit=step_limit, skip=skip)
        self._control = FanucControl(
            machine, self._note, self._file, shortest=shortest, calculator=self._settings.calculator
        )
        self._to_initial = True
        self._initial: float | None = None
        self._sticky: dict[str, float] = {}
        self._length_number = -1

    @property
    def control(self) -> FanucControl:
        """The virtual control."""
        return self._control

    @property
    def _table(self) -> Codes:
        return self._control.plain_table

    def _first(self, text: Text) -> Activation:
        assert isinstance(text, FanucText)
        return Activation(text, 0)

    def _may_be_plain(self, text: Text) -> bool:
        return self._stack[-1].modal is None and super()._may_be_plain(text)

    def _system(self, key: int) -> float | None:
        control = self._control
        axes = {0: "X", 1: "Y", 2: "Z", **{3 + k: name for k, name in enumerate(control.names)}}
        if 5001 <= key <= 5005 or 5041 <= key <= 5045:
            axis = (key - 1) % 20
            if axis < 3:
                return float(control.place[axis]) / control.lengths
            control.settle()
            return float(control.held[control.machine.column(axes[axis])])
        if 5021 <= key <= 5025:
            control.settle()
            value = float(control.held[control.machine.column(axes[key - 5021])])
            return value / control.lengths if key <= 5023 else value
        return None

    # Blocks

    def _text(self, call: Activation, line: int, text: str) -> None:
        if text[0] in "O:":
            self._program_number(call, line, text)
            return
        reader = block_reader(text, ARITHMETIC, self._variables)
        if self._flow.takes(call, line, reader):
            return
        self._carry_out(call, line, read_block(reader, self._twice))

    def _program_number(self, call: Activation, line: int, text: str) -> None:
        """An O number begins a program; where another one runs into it, that one has ended."""
        digits = text[1:]
        if not digits.isdigit() or len(digits) > 8:
            raise BlockError(f"no program number: {text[:40]!r}")
        if call.begun and call.line != line:
            self._note("the program runs into the next one: it ends here", Severity.ERROR)
            self._end_of_file(call)
        call.begun = True

    def _end_of_file(self, call: Activation) -> None:
        if len(self._stack) < 2:
            raise End
        self._leave()

    def _carry_out(self, call: Activation, line: int, block: Block) -> None:
        control = self._control
        if words.MACRO in block.g or words.MODAL_MACRO in block.g:
            self._macro(call, block)
            assign(self._variables, block)
            return
        for code in block.g:
            if code in (200, 210, 930, 940, 950):
                self._modal(code)
        tilts = words.TILT in block.g
        if words.DWELL not in block.g:
            self._settings.scale(block, control.feed_mode.now, control.lengths != 1.0, angles="IJKR" if tilts else "")
        self._feed_and_speed(block)
        tool = block.take("T")
        if tool is not None:
            control.choose(f"{tool:g}")
        for code in block.m:
            if code not in words.LATE:
                self._m_word(code)
        special, machine_frame = self._codes(block)
        number = block.take("H")
        if number is not None and 0 <= number < 1e6:
            self._length_number = int(number)
        # The control keeps H after G49, but no length is in force.
        control.edge.set(control.row, self._length_number if control.lengthened else -1)
        block.take("D")
        if special in words.TAKES_AXES:
            self._special(special, block)
        elif not any(code in words.NO_MOTION for code in block.g):
            self._drive(call, block, machine_frame)
        if words.TOOL_UPRIGHT in block.g:
            self._stand(block)
        assign(self._variables, block)
        late = [code for code in block.m if code in words.LATE]
        for code in late:
            self._late(call, line, code, block)
        self._name_unused(block)

    def _codes(self, block: Block) -> tuple[int, bool]:
        """Set what G codes set; returns the one that takes the axis words (-1: none), and whether G53 is there."""
        special = -1
        machine_frame = False
        for code in block.g:
            if code in words.TAKES_AXES:
                if special >= 0:
                    raise BlockError("two G words want the words of the block")
                special = code
            elif code == words.MACHINE:
                machine_frame = True
            elif code in MOTIONS or code in cycles.CYCLES or code == CANCEL:
                self._begin(code)
            elif code not in (200, 210, 930, 940, 950):
                self._g(code, block)
        return special, machine_frame

    def _begin(self, code: int) -> None:
        """Take up a motion or a cycle."""
        control = self._control
        if code in cycles.CYCLES:
            if self._initial is None:
                self._initial = float(control.place[control.plane])
                self._sticky = {}
            self.motion = code
            return
        self._initial = None
        self.motion = control.kind * 10 if code == CANCEL else code
        if code in MOTIONS:
            control.kind = MOTIONS[code]

    def _g(self, code: int, block: Block) -> None:
        control = self._control
        for letter in words.WORDS.get(code, ""):
            block.take(letter)
        if code in words.OFFSETS or code == words.MORE_OFFSETS:
            self._offset(code, block)
        elif code in (words.TCP, words.TCP_VECTOR):
            block.take("H")
            control.set_tcp(True)
            control.set_length(True)
            control.vectors = code == words.TCP_VECTOR
        elif code in (words.LENGTH_OFF, 430, 440):
            block.take("H")
            control.vectors = False
            control.set_tcp(False)
            control.set_length(code != words.LENGTH_OFF)
            if code == 440:
                self._note("G44: taken as G43, the length with the other sign is not simulated", Severity.WARNING)
        elif code == words.UPRIGHT_OFF:
            control.upright()
        elif code in (980, 990):
            self._to_initial = code == 980
        elif code == words.MODAL_MACRO_OFF:
            self._stack[-1].modal = None
        elif code in words.LINES:
            self._name_code(code, words.NAMED, words.SILENT)
            self._begin(10)
        elif code == 960:
            control.feed_mode.set(control.row, 95)
            self._name_code(code, words.NAMED, words.SILENT)
        elif code != words.TOOL_UPRIGHT and not self._modal(code):
            self._name_code(code, words.NAMED, words.SILENT)

    def _offset(self, code: int, block: Block) -> None:
        control = self._control
        system = words.OFFSETS.index(code) + 1 if code in words.OFFSETS else 1
        more = block.take("P") if code in (540, words.MORE_OFFSETS) else None
        if code == words.MORE_OFFSETS and more is None:
            raise BlockError("G54.1 needs P")
        if more is not None:
            if more != int(more) or not 1 <= more <= 300:
                raise BlockError("P of G54.1 is not from 1 to 300")
            system = 6 + int(more)
        control.system = system
        name = f"G{53 + system}" if system <= 6 else f"G54.1 P{system - 6}"
        control.set_offset(53 + system if system <= 6 else 594 + system, name)
        control.refresh()

    def _m_word(self, code: int) -> None:
        if not self._m(code):
            self._control.event("m", float(code))

    def _late(self, call: Activation, line: int, code: int, block: Block) -> None:
        if code == words.CALL:
            self._call(block)
        elif code == words.RETURN:
            self._return(call, line, block)
        elif code == words.CALL_FILE:
            for letter in "PL":
                block.take(letter)
            self._note("M198: programs of other folders are not called", Severity.ERROR)
        else:
            self._m_word(code)

    # What takes the words of its block

    def _special(self, code: int, block: Block) -> None:
        control = self._control
        if control.tilted and code in (words.LOCAL, words.PRESET):
            self._note("shifts in a tilted plane are not simulated", Severity.ERROR)
        match code:
            case words.DWELL:
                self._dwell(block)
            case words.SET_DATA:
                self._set_data(block)
            case words.HOME | words.OTHER_HOME:
                self._go_home(code, block)
            case words.LOCAL:
                values = self._point(block)
                control.local = np.array(
                    [old if new is None else new for old, new in zip(control.local, values, strict=True)]
                )
                control.refresh()
            case words.PRESET:
                for axis, value in enumerate(self._point(block)):
                    if value is not None:
                        control.preset[axis] += float(control.place[axis]) - value
                if control.tilted or not control.rotation.rigid or self._turned():
                    self._note("G92 in a turned frame is not simulated", Severity.ERROR)
                control.refresh()
            case words.ROTATE:
                self._rotate(block)
            case _:
                assert code == words.TILT
                self._tilt(block)

    def _turned(self) -> bool:
        return not np.allclose(self._control.rotation.linear, np.eye(3))

    def _dwell(self, block: Block) -> None:
        number = block.words.get("X") or block.words.get("U")
        for letter in "XU":
            block.take(letter)
        milliseconds = block.take("P")
        if number is not None:
            self._control.event("dwell", number.value * (self._settings.seconds if number.whole else 1.0))
        elif milliseconds is not None:
            self._control.event("dwell", milliseconds / 1000.0)
        else:
            self._note("G4 without a time", Severity.WARNING)

    def _point(self, block: Block) -> list[float | None]:
        """X, Y and Z of a block in mm; words of rotary axes must be 0 where they would shift."""
        for name in self._control.names:
            if block.take(name):
                self._note(f"a shift of {name} is not simulated", Severity.ERROR)
        values = [block.take(name) for name in "XYZ"]
        scaled = [None if value is None else value * self._control.lengths for value in values]
        if any(value is not None and abs(value) > FARTHEST for value in scaled):
            raise BlockError("a shift is larger than any machine")
        return scaled

    def _set_data(self, block: Block) -> None:
        """G10: a work offset, or data of tools."""
        control = self._control
        kind, number = block.take("L"), block.take("P")
        if kind in (10.0, 11.0, 12.0, 13.0, 1.0, 3.0):
            for letter in "RXYZQDH":
                block.take(letter)
            return
        if kind not in (2.0, 20.0) or number is None or number != int(number) or not 0 <= number <= 300:
            for letter in "RXYZ":
                block.take(letter)
            raise BlockError("G10 with this L and P is not simulated")
        values = self._point(block)
        if kind == 2.0 and not 1 <= number <= 6:
            raise BlockError("G10 L2 with this P is not simulated")
        system = int(number) if kind == 2.0 else 6 + int(number)
        old = control.offset_of(system)
        base = np.zeros(3) if control.absolute else old
        control.set_values(
            system, np.array([o if v is None else b + v for o, b, v in zip(old, base, values, strict=True)])
        )

    def _go_home(self, code: int, block: Block) -> None:
        """G28 and G30: over the point that the block says to the reference position."""
        control = self._control
        axes = self._axis_words(block)
        if not axes:
            raise BlockError("G28 and G30 need the axes that go home")
        if code == words.OTHER_HOME:
            which = block.take("P")
            self._note(f"G30 P{which or 2:g}: taken as the reference position of G28", Severity.WARNING)
        self._count(1)
        kind, control.kind = control.kind, RAPID
        before = control.place[:3].copy()
        moving = {name: word for name, word in axes.items() if not (not control.absolute and word[0] == 0.0)}
        if moving and (set(moving) - set("XYZ") or not np.array_equal(before, self._goal(moving))):
            control.move(moving, None)
        control.go_to_machine({name: float(control.machine.axis(name).home) for name in axes})
        control.kind = kind

    def _goal(self, axes: dict[str, Word]) -> Floats:
        control = self._control
        goal = control.place[:3].copy()
        for axis, name in enumerate("XYZ"):
            if name in axes:
                value = axes[name][0] * control.lengths
                goal[axis] = value if control.absolute else goal[axis] + value
        return np.asarray(goal)

    def _rotate(self, block: Block) -> None:
        """G68: in the working plane, or with I J K in space."""
        control = self._control
        angle = block.take("R")
        point = self._point(block)
        centre = np.array(
            [now if value is None else value for now, value in zip(control.place[:3], point, strict=True)]
        )
        direction = [block.take(letter) for letter in "IJK"]
        axis = np.zeros(3)
        if any(value is not None for value in direction):
            axis[:] = [value or 0.0 for value in direction]
        else:
            axis[control.plane] = 1.0
        length = float(np.linalg.norm(axis))
        if angle is None or not 1e-12 < length < FARTHEST or not abs(angle) < FARTHEST:
            raise BlockError("G68 needs an angle R, and an axis that has a direction")
        control.rotate(centre, axis / length, angle)

    def _tilt(self, block: Block) -> None:
        """G68.2: the plane by its origin and Euler angles."""
        control = self._control
        way = block.take("P")
        block.take("R")
        origin = np.array([value or 0.0 for value in self._point(block)])
        angles = [block.take(letter) or 0.0 for letter in "IJK"]
        order = block.take("Q")
        if way or (order is not None and order != 313):
            raise BlockError("G68.2 with P or Q is not simulated: only Euler angles are")
        if any(not abs(angle) < FARTHEST for angle in angles):
            raise BlockError("an angle is none that a plane has")
        control.tilt(origin, (angles[0], angles[1], angles[2]))

    def _stand(self, block: Block) -> None:
        way = block.take("P")
        if way:
            self._note(f"G53.1 P{way:g}: taken as G53.1, the way on which the axes turn least", Severity.WARNING)
        self._count(1)
        self._control.stand_on_plane()

    # Motion

    def _drive(self, call: Activation, block: Block, machine_frame: bool) -> None:
        """Make the motion that the words of the block ask for."""
        control = self._control
        axes = self._axis_words(block)
        vector = self._vector(block) if control.vectors and self.motion in (0, 10) else None
        if self.motion in cycles.CYCLES:
            self._cycle(block, axes)
            if axes:
                self._call_modal(call)
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
                {name: (word[0], How.ABSOLUTE) for name, word in axes.items()},
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
        self._call_modal(call)

    def _vector(self, block: Block) -> Floats | None:
        """G43.5: I J K are the tool axis; those that are not written are 0 where one is."""
        values = [block.take(letter) for letter in "IJK"]
        incline = block.take("Q")
        if incline:
            self._note("the inclination Q of G43.5 is not simulated", Severity.ERROR)
        if all(value is None for value in values):
            return None
        vector = np.array([value or 0.0 for value in values])
        if not 1e-12 < float(np.linalg.norm(vector)) < FARTHEST:
            raise BlockError("the tool axis has no direction")
        return vector

    # Cycles

    def _cycle(self, block: Block, axes: dict[str, Word]) -> None:
        """Drill at the position of a block."""
        control = self._control
        along = "XYZ"[control.plane]
        given = {
            letter: value for letter in cycles.STICKY if letter != "Z" and (value := block.take(letter)) is not None
        }
        if along in axes:
            given["Z"] = axes[along][0]
        self._sticky |= given
        repeats = block.take("K")
        block.take("L")
        if not axes and not ({"R", "Z"} & given.keys()):
            return
        if set(axes) - set("XYZ"):
            self._note("rotary words in a cycle: they are not executed", Severity.ERROR)
        missing = [letter for letter in "ZR" + "Q" * (self.motion in cycles.NEED_Q) if letter not in self._sticky]
        if missing:
            raise BlockError(f"the cycle has no {missing[0]}")
        times = 1 if repeats is None else int(repeats)
        if not 0 <= times <= _MOST_HOLES:
            raise BlockError("K of a cycle is how often it drills")
        if not control.place[3] > 0.0:
            self._note("a cycle without a feed", Severity.ERROR)
        made = self._motions(self._hole())
        plane = {name: word for name, word in axes.items() if name in "XYZ" and name != along}
        kind = control.kind
        for _ in range(times):
            self._count(len(made) + 1)
            control.kind = RAPID
            control.move(plane, None)
            control.drill(made)
        control.kind = kind

    def _hole(self) -> cycles.Hole:
        control = self._control
        scale = control.lengths
        now = self._sticky
        assert self._initial is not None
        initial = self._initial / scale
        retract, bottom = now["R"], now["Z"]
        if not control.absolute:
            retract += initial
            bottom += retract
        stroke = abs(now.get("Q", 0.0))
        aside = (now["I"], now.get("J", 0.0)) if "I" in now else (0.0, now["J"]) if "J" in now else (stroke, 0.0)
        return cycles.Hole(
            retract, bottom, initial, self._to_initial, stroke, aside, max(now.get("P", 0.0), 0.0) / 1000.0, 1.0 / scale
        )

    def _motions(self, hole: cycles.Hole) -> list[Step]:
        try:
            return cycles.steps(self.motion, hole)
        except CycleError as error:
            raise BlockError(f"the cycle {error}") from None
