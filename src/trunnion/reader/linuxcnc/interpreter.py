"""LinuxCNC programs, block by block: what each one says goes to the virtual control, and where it goes on."""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Final

import numpy as np

from trunnion.arrays import Codes
from trunnion.errors import Severity
from trunnion.machine import Machine
from trunnion.reader.control import RAPID
from trunnion.reader.drilling import CycleError, Step
from trunnion.reader.frames import turn
from trunnion.reader.interpreter import STEPS
from trunnion.reader.linuxcnc import cycles
from trunnion.reader.linuxcnc.control import ORDER, LinuxcncControl, Offset
from trunnion.reader.linuxcnc.flow import Activation, OWordInterpreter
from trunnion.reader.linuxcnc.parameters import ARITHMETIC
from trunnion.reader.linuxcnc.text import LinuxcncText
from trunnion.reader.linuxcnc.words import (
    LENGTHS,
    LINES,
    NAMED,
    NAMED_M,
    NO_MOTION,
    OFFSETS,
    RIGID_TAP,
    SILENT,
    SILENT_M,
    TCP_OFF,
    TCP_ON,
    TCP_USER,
    USERS,
    WORDS,
)
from trunnion.reader.rows import FARTHEST
from trunnion.reader.rs274.block import Block, block_reader, read_block
from trunnion.reader.rs274.expressions import BlockError
from trunnion.reader.rs274.interpreter import CANCEL, MOTIONS
from trunnion.reader.text import Text
from trunnion.reader.word import How, Word
from trunnion.toolpath import Kind

#: Comments that speak to whoever stands at the machine.
_MESSAGE: Final = re.compile(r"[ \t]*(?:MSG|DEBUG|PRINT),(.*)", re.IGNORECASE | re.DOTALL)

#: M codes that act after the motion of their block.
_LATE: Final = frozenset({0, 1, 2, 30, 60})

#: G codes, in tenths, whose axis words are no goal of the motion in force.
_DWELL: Final = 40
_SETUP: Final = 100
_HOMES: Final = {280: 281, 300: 301}
_AXIS_OFFSETS: Final = frozenset({520, 920})


class LinuxcncInterpreter(OWordInterpreter):
    """Runs one LinuxCNC program on one machine."""

    text_type = LinuxcncText
    semicolon = True
    motion = CANCEL

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
        self._control = LinuxcncControl(machine, self._note, self._file, shortest=shortest)
        self._to_initial = False
        self._initial: float | None = None
        self._sticky: dict[str, float] = {}
        self._waited = 0.0
        self._homes = {code: self._home_of(machine) for code in _HOMES}

    @staticmethod
    def _home_of(machine: Machine) -> dict[str, float]:
        return {axis.name: float(axis.home) for axis in machine.axes}

    @property
    def control(self) -> LinuxcncControl:
        """The virtual control."""
        return self._control

    @property
    def _table(self) -> Codes:
        return self._control.plain_table

    def _first(self, text: Text) -> Activation:
        assert isinstance(text, LinuxcncText)
        return Activation(text, 0)

    def _may_be_plain(self, text: Text) -> bool:
        return super()._may_be_plain(text) and not any(self._control.turned.values())

    # Parameters

    def _system(self, key: int | str) -> float | None:
        """Return what the control itself puts behind a number or name; None if it is none of its own."""
        control = self._control
        if isinstance(key, int):
            if 5420 <= key < 5426:
                return self._position(key - 5420)
            if 5210 < key <= 5216:
                value = float(control.shift[key - 5211])
                return value / control.lengths if key <= 5213 else value
            return {5210: float(control.shifted), 5220: float(control.system)}.get(key)
        if len(key) == 2 and key[0] == "_" and key[1] in ORDER:
            return self._position(ORDER.index(key[1]))
        feed = float(control.place[3])
        found: dict[str, float | None] = {
            "_VALUE": self._returned or 0.0,
            "_VALUE_RETURNED": float(self._returned is not None),
            "_LINE": float(control.line),
            "_FEED": 0.0 if np.isnan(feed) else feed / control.feeds,
            "_RPM": float(control.rpm.now),
            "_METRIC": float(control.lengths == 1.0),
            "_IMPERIAL": float(control.lengths != 1.0),
            "_ABSOLUTE": float(control.absolute),
            "_INCREMENTAL": float(not control.absolute),
            "_MOTION_MODE": float(self.motion),
            "_PLANE": {2: 170.0, 1: 180.0, 0: 190.0}[control.plane],
            "_COORD_SYSTEM": float(OFFSETS[control.system - 1]),
        }
        return found.get(key)

    def _position(self, axis: int) -> float:
        value = float(self._control.position()[axis])
        return value / self._control.lengths if axis < 3 else value

    # Blocks

    def _twice(self, letter: str) -> None:
        raise BlockError(f"{letter} is written twice")

    def _said(self, comment: str) -> None:
        match = _MESSAGE.match(comment)
        if match is not None:
            self._control.event("message", match.group(1))

    def _text(self, call: Activation, line: int, text: str) -> None:
        reader = block_reader(text, ARITHMETIC, self._parameters)
        if reader.takes("O"):
            self._o_word(call, line, reader)
            return
        block = read_block(reader, self._twice)
        self._carry_out(block)
        for key, value in block.settings:
            self._parameters.set(key, value or 0.0)

    def _carry_out(self, block: Block) -> None:
        control = self._control
        for code in block.g:
            if code in (930, 940, 950):
                self._modal(code)
                if code != 930:
                    # LinuxCNC forgets the feed, even where the mode stays what it was.
                    control.place[3] = np.nan
        self._feed_and_speed(block)
        tool = block.take("T")
        if tool is not None:
            control.choose(f"{tool:g}")
        for code in block.m:
            if code not in _LATE:
                self._m_word(code, block)
        special = -1
        machine_frame = False
        explicit = False
        for code in block.g:
            if code in MOTIONS or code in cycles.CYCLES or code in LINES or code in (CANCEL, RIGID_TAP):
                explicit = code != CANCEL
            if code in (_DWELL, _SETUP, *_HOMES, *_HOMES.values(), *_AXIS_OFFSETS, 921, 922, 923):
                special = code
            elif code == 530:
                machine_frame = True
            elif code in cycles.CYCLES or code in (CANCEL, 930, 940, 950):
                continue
            else:
                self._g(code, block)
        takes_axes = special in (_SETUP, *_HOMES, *_AXIS_OFFSETS)
        if takes_axes and explicit:
            raise BlockError("two G words want the axis words")
        self._special(special, block)
        begun = [code for code in block.g if code in cycles.CYCLES or code == CANCEL]
        if takes_axes or any(code in NO_MOTION for code in block.g):
            self.motion = CANCEL if CANCEL in begun else self.motion
        else:
            self._drive(block, begun[-1] if begun else None, machine_frame, explicit)
        late = [code for code in block.m if code in _LATE]
        self._name_unused(block)
        for code in late:
            self._m_word(code, block)

    def _g(self, code: int, block: Block) -> None:
        control = self._control
        for letter in WORDS.get(code, ""):
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
        elif code in LINES:
            self._name_code(code, NAMED, SILENT)
            self.motion = code
        elif code == RIGID_TAP:
            self.motion = code
        elif code == 960:
            control.feed_mode.set(control.row, 95)
            self._name_code(code, NAMED, SILENT)
        elif not self._modal(code):
            self._name_code(code, NAMED, SILENT)

    def _length_number(self, block: Block) -> int:
        """Which length G43 takes: that of H, or of the tool in the spindle; 0 where nobody knows its number."""
        if "H" in block.words:
            return int(block.words["H"].value)
        name = self._control.tool_in_spindle
        return int(name) if name.isdigit() else 0

    def _m_word(self, code: int, block: Block) -> None:
        control = self._control
        if code in (TCP_ON, TCP_OFF):
            control.set_tcp(code == TCP_ON)
        elif code in SILENT_M:
            for letter in SILENT_M[code]:
                block.take(letter)
        elif code == 61:
            tool = block.take("Q")
            control.choose(f"{tool or 0:g}")
            control.change_tool()
        elif code == 60:
            control.event("stop", "pallet")
        elif code == 19:
            for letter in "RQP":
                block.take(letter)
            self._m(code)
        elif code in USERS:
            for letter in "PQ":
                block.take(letter)
            control.event("m", float(code))
            self._note(f"M{code} belongs to the machine: what it does is not known", Severity.WARNING)
        elif code in NAMED_M:
            self._note(f"M{code}: {NAMED_M[code]}", Severity.ERROR)
        elif code == TCP_USER:
            self._note("M430: kinematics of the user are not known", Severity.ERROR)
        elif not self._m(code):
            self._note(f"unknown word M{code}", Severity.ERROR)

    # What takes the axis words of its block

    def _special(self, code: int, block: Block) -> None:
        control = self._control
        if code == _DWELL:
            seconds = block.take("P")
            if seconds is None:
                self._note("G4 without a time P", Severity.ERROR)
            else:
                control.event("dwell", seconds)
        elif code == _SETUP:
            self._set_up(block)
        elif code in _AXIS_OFFSETS:
            self._axis_offset(code, block)
        elif code in (921, 922, 923):
            if code == 921:
                control.shift = np.zeros(6)
            control.shifted = code == 923
            control.refresh()
        elif code in _HOMES:
            self._go_home(code, block)
        elif code in _HOMES.values():
            stored = control.machine_position()
            kept = next(go for go, keep in _HOMES.items() if keep == code)
            self._homes[kept] = {name: float(stored[axis]) for axis, name in enumerate(ORDER)}

    def _axis_offset(self, code: int, block: Block) -> None:
        """G92: the present position gets new numbers; G52: the offset itself is said."""
        control = self._control
        position = control.position()
        shift = control.shift.copy()
        for axis, name in enumerate(ORDER):
            value = self._scaled(block, name, axis)
            if value is not None:
                shift[axis] = value if code == 520 else shift[axis] * control.shifted + position[axis] - value
            elif not control.shifted:
                shift[axis] = 0.0
        if float(np.abs(shift).max()) > FARTHEST:
            raise BlockError("an offset is larger than any machine")
        control.shift, control.shifted = shift, True
        control.refresh()

    def _set_up(self, block: Block) -> None:
        """G10: a work offset, or a tool's data."""
        control = self._control
        kind = block.take("L")
        system = block.take("P")
        if kind in (0.0, 1.0, 10.0, 11.0):
            for letter in "XYZABCUVWRIJQ":
                block.take(letter)
            return
        if kind not in (2.0, 20.0) or system is None or system != int(system) or not 0 <= system <= 9:
            raise BlockError("G10 needs L2 or L20, and P from 0 to 9")
        number = int(system) or control.system
        old = control.offset_of(number)
        values, rotation = old.values.copy(), old.rotation
        turned = block.take("R")
        if turned is not None and kind == 2.0:
            rotation = turned
        elif turned is not None:
            raise BlockError("G10 L20 takes no R")
        point = control.without_length(control.machine_position())
        shift = control.shift if control.shifted else np.zeros(6)
        unturned = turn(2, -rotation)
        inside = point - values
        inside[:3] = unturned @ inside[:3]
        inside -= shift
        change = np.zeros(6)
        for axis, name in enumerate(ORDER):
            value = self._scaled(block, name, axis)
            if value is None:
                continue
            if kind == 2.0:
                values[axis] = value
            else:
                change[axis] = inside[axis] - value
        change[:3] = turn(2, rotation) @ change[:3]
        values = values + change
        if float(np.abs(values).max()) > FARTHEST or abs(rotation) > FARTHEST:
            raise BlockError("an offset is larger than any machine")
        control.set_values(number, Offset(values, rotation))

    def _scaled(self, block: Block, name: str, axis: int) -> float | None:
        """Return the value of an axis word in mm or degrees."""
        value = block.take(name)
        if value is None:
            return None
        if axis > 2 and name not in self._control.names:
            if value:
                self._note(f"{name}: the machine has no such axis", Severity.ERROR)
            return None
        return value * self._control.lengths if axis < 3 else value

    def _go_home(self, code: int, block: Block) -> None:
        """G28 and G30: over the point that the block says to the stored one, all axes or those of the block."""
        control = self._control
        axes = self._programmed(self._axis_words(block))
        kind, control.kind = control.kind, RAPID
        self._count(1)
        control.move(axes, None)
        names = axes or dict.fromkeys((*"XYZ", *control.names))
        stored = self._homes[code]
        scale = control.lengths
        goal: dict[str, Word] = {
            name: (stored.get(name, 0.0) / (scale if name in "XYZ" else 1.0), How.ABSOLUTE) for name in names
        }
        control.machine_move(goal, feed_written=False)
        control.kind = kind

    # Motion

    def _programmed(self, axes: dict[str, Word]) -> dict[str, Word]:
        """Axis words with the offsets of rotary axes in them."""
        if not self._control.absolute:
            return axes
        turned = self._control.turned
        return {name: (word[0] + turned.get(name, 0.0), word[1]) for name, word in axes.items()}

    def _drive(self, block: Block, begun: int | None, machine_frame: bool, explicit: bool) -> None:
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
            control.machine_move({name: (word[0], How.ABSOLUTE) for name, word in axes.items()}, feed_written=written)
            return
        here = self.motion
        if code in LINES:
            self.motion = 10
        if turns is not None and not 1 <= turns == int(turns):
            raise BlockError("P of a circle is the number of its turns")
        self._move(block, self._programmed(axes), turns=int(turns) - 1 if turns else 0)
        self.motion = here

    def _tap(self, block: Block, axes: dict[str, Word]) -> None:
        """G33.1: in by the pitch K a turn, and back to where it began, I times as fast."""
        control = self._control
        pitch, faster = block.take("K"), block.take("I")
        if pitch is None:
            raise BlockError("G33.1 has no K")
        if "F" in block.words:
            raise BlockError("G33.1 takes no F")
        if not control.spindle.now or not control.rpm.now > 0.0:
            raise BlockError("the spindle does not turn, and G33.1 follows it")
        if set(axes) - set("XYZ"):
            self._note("rotary words in a thread: they are not executed", Severity.ERROR)
        start = control.place[:3] / control.lengths
        end = start.copy()
        for axis, name in enumerate("XYZ"):
            if name in axes:
                end[axis] = axes[name][0] if control.absolute else start[axis] + axes[name][0]
        feed = self._by_pitch(abs(pitch) * control.lengths, float(np.linalg.norm(end - start)) * control.lengths)
        first, second = (control.plane + 1) % 3, (control.plane + 2) % 3
        aside = float(end[first] - start[first]), float(end[second] - start[second])
        self._count(2)
        control.drill(
            [
                Step(False, float(end[control.plane]), feed, aside=aside),
                Step(False, float(start[control.plane]), feed * (faster or 1.0)),
            ]
        )

    def _by_pitch(self, pitch: float, length: float) -> float:
        """F, as it counts now, of a motion of so many mm with so many mm a turn of the spindle."""
        control = self._control
        if control.feed_mode.now == 95:
            return pitch
        rate = pitch * control.rpm.now
        return rate / max(length, 1e-9) if control.feed_mode.now == 93 else rate

    def _cycle(self, code: int, block: Block, axes: dict[str, Word]) -> None:
        """Drill at the positions of a block."""
        control = self._control
        if set(axes) - set("XYZ"):
            self._note("rotary words in a cycle: they are not executed", Severity.ERROR)
        words = {letter: value for letter in cycles.STICKY if (value := block.take(letter)) is not None}
        words |= {"Z": axes["XYZ"[control.plane]][0]} if "XYZ"[control.plane] in axes else {}
        fresh = code != self.motion
        self.motion = code
        self._waited = words.get("P", self._waited)
        held = ({"P": self._waited} if code in cycles.KEEP_P else {}) if fresh else self._sticky
        needed = "ZR" + "Q" * (code in cycles.NEED_Q) + "P" * (code in cycles.NEED_P)
        missing = [letter for letter in needed if letter not in words and letter not in held]
        if missing:
            raise BlockError(f"the cycle has no {missing[0]}")
        self._sticky = held | words
        repeats = block.take("L")
        d = block.take("D")
        times = 1 if repeats is None else int(repeats)
        if not 1 <= times <= 10_000:
            raise BlockError("L of a cycle is how often it drills")
        self._check_cycle()
        self._drill(code, axes, dict(self._sticky) | ({"D": d} if d is not None else {}), times)

    def _check_cycle(self) -> None:
        control = self._control
        if control.feed_mode.now == 93:
            raise BlockError("a cycle cannot be in inverse time")
        if not control.place[3] > 0.0:
            self._note("a cycle without a feed", Severity.ERROR)

    def _drill(self, code: int, axes: dict[str, Word], words: dict[str, float], times: int) -> None:
        """Drill so many times: at one place, or with G91 at places ever further on."""
        control = self._control
        normal = control.plane
        scale = control.lengths
        height = float(control.place[normal]) / scale
        if self._initial is None:
            self._initial = height * scale
        old = self._initial / scale
        retract, bottom = words["R"], words["Z"]
        if not control.absolute:
            retract += old
            bottom += retract
            if "K" in words:
                words["K"] += bottom
        if retract < bottom:
            raise BlockError("R of the cycle lies below its depth")
        still = [np.nan, np.nan]
        if old < retract:
            self._count(1)
            control.drill([Step(True, retract)])
            old = height = retract
        hole = cycles.Hole(
            retract, bottom, old if self._to_initial else retract, cycles.CLEARANCE * 25.4 / scale, words
        )
        made = self._motions(code, hole)
        place = control.place[:3].copy()
        bits = 0
        for count in range(times):
            for axis in range(3):
                name = "XYZ"[axis]
                if axis == normal or name not in axes:
                    continue
                value = axes[name][0] * scale
                place[axis] = value if control.absolute else place[axis] + value
                bits |= 1 << axis
            first = height if count == 0 and height > retract else hole.clear
            self._count(len(made) + 2)
            place[normal] = first * scale
            if not control.emit(Kind.RAPID, place, bits, still, 0, None):
                return
            control.drill([Step(True, retract), *made] if first > retract else made)

    @staticmethod
    def _motions(code: int, hole: cycles.Hole) -> list[Step]:
        try:
            return cycles.steps(code, hole)
        except CycleError as error:
            raise BlockError(f"the cycle {error}") from None


def _offset_code(system: int) -> int:
    """Column ``offset`` of the work offsets: 54 to 59, and 591 to 593 for G59.1 to G59.3."""
    return 53 + system if system <= 6 else 584 + system
