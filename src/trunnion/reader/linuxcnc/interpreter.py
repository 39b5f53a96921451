"""RS274/NGC programs, line by line: what each one says goes to the virtual control."""

import re
from pathlib import Path
from typing import Final

import numpy as np

from trunnion.errors import Severity
from trunnion.machine import Machine
from trunnion.reader.control import LINEAR, RAPID
from trunnion.reader.drilling import CycleError
from trunnion.reader.handover import ROW
from trunnion.reader.interpreter import STEPS, Activation, End, Interpreter
from trunnion.reader.linuxcnc import words
from trunnion.reader.linuxcnc.blocks import LONGEST, Block, BlockError, Parameters, read_block, split_comments
from trunnion.reader.linuxcnc.control import NONE, LinuxCNCControl
from trunnion.reader.linuxcnc.cycles import steps
from trunnion.reader.run import Written
from trunnion.reader.scan import scan
from trunnion.reader.text import Folder, Text
from trunnion.reader.word import How, Word

#: How names of programs end.
SUFFIXES: Final = (".NGC", ".NC", "")

#: Larger feeds and speeds are slips of the program.
FASTEST: Final = 1e9

#: Whether a line may be plain: a look at its beginning saves starting the kernel in vain.
_PLAIN = re.compile(rb"[ \t]*(?:N[0-9]+[ \t]*)?(?:[;\r\n]|G0?[01](?![0-9.])|[A-FXYZ][ \t]*[-+.0-9])", re.IGNORECASE)
_LOOK: Final = 48

#: Comments that are messages to a person.
_MESSAGE = re.compile(r"[ \t]*(?:MSG|DEBUG|PRINT)[ \t]*,(.*)", re.IGNORECASE | re.DOTALL)

#: Letters that have a meaning only beside some words.
_PARAMETERS: Final = frozenset("IJKRPQLDHE")

#: Which of them beside which G words.
_BESIDE: Final = {words.DWELL: "P", 640: "PQ", 430: "H", 432: "H", 410: "D", 411: "DL", 420: "D", 421: "DL", 960: "D"}


class LinuxCNCInterpreter(Interpreter[Activation]):
    """Runs one RS274/NGC program on one machine."""

    def __init__(
        self, path: Path, machine: Machine, *, step_limit: int = STEPS, skip: bool = False, shortest: bool | None = None
    ) -> None:
        super().__init__(path, machine, Folder(path, SUFFIXES), step_limit=step_limit, skip=skip)
        self._control = LinuxCNCControl(machine, self._note, self._file, shortest=shortest)
        self._parameters = Parameters()
        self._percents = 0
        self._cycle = 0
        self._sticky: dict[str, float] = {}
        self._to_old_height = True
        self._height = 0.0

    @property
    def control(self) -> LinuxCNCControl:
        """The virtual control."""
        return self._control

    def _first(self, text: Text) -> Activation:
        return Activation(text, 0)

    def _may_be_plain(self, text: Text) -> bool:
        if not self._control.absolute or self._cycle:
            return False
        return _PLAIN.match(text.buffer[text.position : text.position + _LOOK].tobytes()) is not None

    def _kernel(self, text: Text) -> None:
        control = self._control
        before = control.columns.n
        scan(
            text.buffer,
            len(text.buffer),
            control.table,
            False,
            False,
            control.lengths,
            self._per_feed,
            control.default_way,
            control.map,
            control.turn,
            control.counts,
            control.place,
            control.target(),
            control.notes,
        )
        if control.feed_mode.now == 93:
            self._check_inverse_time(before, int(control.counts[ROW]))

    @property
    def _per_feed(self) -> float:
        """Millimetres of the length in a feed; inverse time has none."""
        return 1.0 if self._control.feed_mode.now == 93 else self._control.feeds

    def _check_inverse_time(self, first: int, end: int) -> None:
        """Under G93 every line and circle has its own F."""
        columns = self._control.columns
        bare = (columns.kind[first:end] != RAPID) & ((columns.programmed[first:end] & int(Written.FEED)) == 0)
        here = self._control.line
        for row in np.flatnonzero(bare):
            self._control.line = int(columns.block[first - columns.base + row])
            self._note("G93 needs F in every block", Severity.ERROR)
        self._control.line = here

    # Lines

    def _line(self, call: Activation, line: int, raw: str) -> None:
        raw = raw.strip()
        if raw == "%":
            self._percents += 1
            if self._percents == 2:
                raise End
            return
        if len(raw) > LONGEST:
            self._note(f"the line is longer than {LONGEST} characters: it is not executed", Severity.ERROR)
            return
        comments: list[str] = []
        try:
            code, comments = split_comments(raw)
            for message in map(_MESSAGE.match, comments):
                if message:
                    self._control.event("message", message[1])
            if code.startswith("/"):
                code = "" if self._skip else code[1:]
            if re.match(r"(?:N[0-9.]+)?O", code):
                self._note("O words are not simulated: the program ends here", Severity.ERROR)
                raise End
            if code:
                self._block(read_block(code, self._parameters))
        except BlockError as error:
            self._note(f"not understood: {raw[:80]}: {error}: the block is not executed", Severity.ERROR)
        except CycleError as error:
            self._note(f"the cycle {error}: it is not executed", Severity.ERROR)
        finally:
            for text in comments:
                self._comment(line, text)

    def _block(self, block: Block) -> None:
        """Carry out the words of a block, in the order in which the control does."""
        control = self._control
        control.block_number = block.number
        said = block.words
        self._check_words(said)
        for code in block.g:
            self._g(code)
        self._check_parameters(block)
        self._feed_speed_tool(said)
        for code in block.m:
            if code not in words.M_LATE:
                self._m(code)
        axes: dict[str, Word] = {
            name: (said[name], How.AS_SET) for name in ("X", "Y", "Z", *control.names) if name in said
        }
        if words.DWELL in block.g:
            self._dwell(said)
        elif not words.NO_MOTION & set(block.g):
            self._motion(block, axes)
        for name, value in block.sets:
            self._parameters[name] = value
        for code in block.m:
            if code in words.M_LATE:
                self._m(code)

    def _check_words(self, said: dict[str, float]) -> None:
        known = {"X", "Y", "Z", "F", "S", "T", "N", *self._control.names} | _PARAMETERS
        for name in sorted(said.keys() - known):
            if name in "ABCUVW":
                self._note(f"the machine has no axis {name}: its word is not executed", Severity.ERROR)
            else:
                raise BlockError(f"unknown word {name}{said[name]:g}")

    def _check_parameters(self, block: Block) -> None:
        """Refuse letters that mean nothing beside the other words; after the G words, which say how it moves."""
        if words.NAMED.keys() & set(block.g) or any(code in words.M_NAMED or code >= 19 for code in block.m):
            return
        meant = set("".join(_BESIDE.get(code, "") for code in block.g))
        if self._cycle:
            meant |= set("RPQL")
        elif self._control.kind not in (RAPID, LINEAR):
            meant |= set("IJKRP")
        odd = sorted(_PARAMETERS & block.words.keys() - meant)
        if odd:
            raise BlockError(f"{' and '.join(odd)} mean nothing here")

    def _feed_speed_tool(self, said: dict[str, float]) -> None:
        control = self._control
        if "F" in said:
            if not 0.0 <= said["F"] <= FASTEST:
                raise BlockError(f"a feed is not from 0 to {FASTEST:g}")
            control.place[3] = said["F"] * self._per_feed
        if "S" in said:
            if not abs(said["S"]) <= FASTEST:
                raise BlockError("a speed that no spindle has")
            control.rpm.set(control.row, abs(said["S"]))
            control.event("speed", abs(said["S"]))
        if "T" in said:
            control.choose(f"{said['T']:.10g}")

    def _dwell(self, said: dict[str, float]) -> None:
        if "P" not in said:
            raise BlockError("G4 needs P")
        self._control.event("dwell", said["P"])

    # G and M words

    def _g(self, code: int) -> None:
        control = self._control
        if code in words.MOTIONS:
            control.kind, self._cycle = words.MOTIONS[code], 0
        elif code in words.CYCLES:
            if not self._cycle:
                self._sticky.clear()
                self._height = float(control.place[control.plane])
            self._cycle = code
        elif code == words.CANCEL:
            self._cycle, control.kind = 0, NONE
        elif code in words.PLANES:
            control.plane = words.PLANES[code]
        elif code in words.UNITS:
            control.set_units(words.UNITS[code], True)
        elif code in words.DISTANCES:
            control.absolute = words.DISTANCES[code]
        elif code in words.ARC_DISTANCES:
            control.relative_centres = not words.ARC_DISTANCES[code]
        elif code in words.FEED_MODES:
            control.feed_mode.set(control.row, words.FEED_MODES[code])
        elif code in words.OFFSETS:
            control.set_offset(53 + words.OFFSETS[code], f"G{code / 10:g}")
        elif code in words.LENGTHS:
            control.set_length(words.LENGTHS[code])
        elif code in words.RETURNS:
            self._to_old_height = words.RETURNS[code]
        elif code in words.NAMED:
            text, grave = words.NAMED[code]
            self._note(f"G{code / 10:g}: {text}", Severity.ERROR if grave else Severity.WARNING)
            if code in (330, 331):
                control.kind = LINEAR
        elif code not in words.SILENT and code not in (words.DWELL, words.MACHINE):
            raise BlockError(f"unknown word G{code / 10:g}")

    def _m(self, code: int) -> None:
        control = self._control
        if code in words.M_SPINDLE:
            control.spindle.set(control.row, words.M_SPINDLE[code])
        if code in words.M_EVENTS:
            control.event(*words.M_EVENTS[code])
        elif code == words.M_CHANGE:
            control.change_tool()
        elif code in (words.M_TCP, words.M_IDENTITY):
            control.set_tcp(code == words.M_TCP)
        elif code in words.M_ENDS:
            control.event("end", f"M{code}")
            raise End
        elif code in words.M_CALLS:
            self._note(f"M{code}: calls are not simulated: the program ends here", Severity.ERROR)
            raise End
        elif code in words.M_NAMED:
            self._note(f"M{code} {words.M_NAMED[code]}", Severity.ERROR)
        elif code not in words.M_SILENT:
            control.event("m", float(code))

    # Motion

    def _motion(self, block: Block, axes: dict[str, Word]) -> None:
        control = self._control
        machine = words.MACHINE in block.g
        if self._cycle:
            if axes or self._cycle in block.g:
                self._drill(block, axes)
            return
        circle = control.circle(block.words) if axes or block.words.keys() & set("IJKR") else None
        if not axes and circle is None:
            return
        if control.kind == NONE:
            raise BlockError("positions, and no motion word is in force")
        if machine and circle is not None:
            raise BlockError("G53 is for lines")
        if control.feed_mode.now == 93 and control.kind != RAPID and "F" not in block.words:
            self._note("G93 needs F in every block", Severity.ERROR)
        feed_written = "F" in block.words
        if machine:
            axes = {name: (value, How.ABSOLUTE) for name, (value, _) in axes.items()}
        control.move(axes, None, circle=circle, machine_frame=machine, feed_written=feed_written)

    def _drill(self, block: Block, axes: dict[str, Word]) -> None:
        """A canned cycle at the position of a block, or at several."""
        control = self._control
        said, up = block.words, "XYZ"[control.plane]
        if axes.keys() & set(control.names):
            raise BlockError("rotary words have no place in a cycle")
        if control.feed_mode.now == 93:
            raise BlockError("a cycle has no place under G93")
        for name in (up, "R", "P", "Q"):
            if name in said:
                self._sticky["Z" if name == up else name] = said[name]
        if not {"Z", "R"} <= self._sticky.keys():
            raise CycleError(f"needs {up} and R")
        times = said.get("L", 1.0)
        if times != int(times) or not 1 <= times <= 10_000:
            raise BlockError(f"L{times:g} is no number of holes")
        flat = {name: word for name, word in axes.items() if name != up}
        for _ in range(int(times)):
            self._count(1)
            self._hole(flat)

    def _hole(self, flat: dict[str, Word]) -> None:
        control = self._control
        unit = control.lengths
        here = float(control.place[control.plane]) / unit
        heights = dict(self._sticky)
        if not control.absolute:
            # R counts from where the tool is, and the bottom from R.
            heights["R"] += here
            heights["Z"] += heights["R"]
        top = heights["R"]
        back = max(self._height / unit, top) if self._to_old_height else top
        made = steps(self._cycle, heights, max(here, top), back, unit, float(control.rpm.now))
        kind, control.kind = control.kind, RAPID
        if here < top:
            up = "XYZ"[control.plane]
            control.move({up: (top, How.ABSOLUTE)}, None)
        if flat:
            control.move(flat, None)
        control.kind = kind
        self._count(len(made))
        control.drill(made)
