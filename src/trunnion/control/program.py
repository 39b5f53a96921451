"""The program from its first line to its last: sequences from templates, dense motion through the block writer.

Every operation goes the same way: operation start, tool, approach with the rotary axes placed first, motion, end.
Events stand between rows; those that are words join the next motion block, the others are blocks of their own.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import BinaryIO

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.control.definition import CALL, SPINDLE_ON, Control
from trunnion.control.family import FIRST_HOLE, WordEvent
from trunnion.control.slides import Slides, inverse_time, slides_of
from trunnion.control.standing import carried_along, on_its_pose
from trunnion.control.template import Value
from trunnion.errors import InputError, Problem
from trunnion.machine import Machine, inverse
from trunnion.machine.pace import clock
from trunnion.nc import ABSENT, CHUNK, ROOM_OF_NUMBER, BlockWriter, counts
from trunnion.plan import Manner, Motion, seconds
from trunnion.plan.holes import Cycle, Turning, cycle_of, feed_of
from trunnion.toolpath import (
    BlockSkip,
    Coolant,
    CutterComp,
    CycleOff,
    CycleOn,
    Dwell,
    Event,
    Insert,
    Kind,
    LoadTool,
    Message,
    Operation,
    Phase,
    Sense,
    SpindleOff,
    SpindleOn,
    Stop,
)

_PHASE_TEXT = {
    Phase.RAPID: "rapid",
    Phase.APPROACH: "approach",
    Phase.ENGAGE: "engage",
    Phase.CUT: "cut",
    Phase.STEPOVER: "stepover",
    Phase.RETRACT: "retract",
    Phase.DEPARTURE: "departure",
    Phase.TRAVERSE: "traverse",
}
_UNKNOWN = (None, None, None)

#: Manners in which X and Y of the program are across the tool.
LEVEL = (Manner.THREE_AXIS, Manner.TILTED)


@dataclass(frozen=True, slots=True)
class Program:
    """All that one program is made from. ``notices`` are printed at its head, as comments."""

    machine: Machine
    control: Control
    motions: Sequence[Motion]
    settings: Mapping[str, str]
    file: str = ""
    notices: Sequence[str] = ()


def kind_of(program: Program, motion: Motion) -> str:
    """What the templates of this kind of operation are called."""
    return program.control.kind(motion.manner, program.settings)


def settings_of(program: Program) -> dict[str, str]:
    """The settings of the run over those of the definition."""
    return {**program.control.settings, **{key: value for key, value in program.settings.items() if value}}


def _on_poses(program: Program) -> Program:
    """The program with the planes that its control takes from the rotary axes, where it does so."""
    if not program.control.plane_from_pose:
        return program
    decimals = program.control.number_formats(three_axis=False)["angle"].decimals
    motions = [m if m.plane is None else on_its_pose(program.machine, m, decimals) for m in program.motions]
    return replace(program, motions=motions)


def setting_of(program: Program, name: str) -> str:
    return program.settings.get(name) or program.control.settings.get(name, "")


def write_program(program: Program, sink: BinaryIO, progress: Callable[[int], None] | None = None) -> None:
    """Write the whole program.

    Parameters
    ----------
    program
        Checked by ``check_program``.
    sink
        Takes UTF-8 bytes in order.
    progress
        Is told how many rows were written since it was last told.

    Raises
    ------
    InputError
        When a value that the program cannot do without is missing.
    """
    _Author(program, sink, progress or (lambda _: None)).write()


class _Author:
    """Writes one program; holds what is in force from one operation to the next."""

    def __init__(self, program: Program, sink: BinaryIO, progress: Callable[[int], None]) -> None:
        self._program = program = _on_poses(program)
        self._control = program.control
        self._family = program.control.family
        self._progress = progress
        axes = program.machine.axes
        self._primary, self._secondary = program.machine.primary, program.machine.secondary
        self._column = {k: c for c, k in enumerate(program.machine.rotary)}
        self._letters = axes[self._primary].name, axes[self._secondary].name
        self._words = self._control.block_words(*self._letters, three_axis=False)
        self._writer = BlockWriter(sink, self._words, self._control.numbers)
        self._tool = self._tool_name = ""
        self._spindle: SpindleOn | None = None
        self._coolant = "OFF"
        self._seconds: list[float] = []
        self._slides: Slides | None = None
        self._feed_mode = ABSENT
        self._speed: Value = None  # of the spindle, as a text said it last
        self._height = 0.0  # of the tool along Z of the frame, at the last row written
        self._before: Motion | None = None
        rapid_feed = setting_of(program, "rapid_feed")
        self._rapid_feed = self._count("feed", float(rapid_feed)) if rapid_feed else ABSENT

    def write(self) -> None:
        """The program, operation by operation."""
        motions = self._program.motions
        self._lines([line for text in self._program.notices for line in self._family.comment(text)])
        self._expand("program_start", self._values(motions[0]), motions[0])
        for k, motion in enumerate(motions):
            self._operation(motion, k + 1 == len(motions) or motions[k + 1].begins)
            off = f"M{self._control.coolant['OFF']}"
            if self._coolant != "OFF" and k + 1 < len(motions) and motions[k + 1].begins:
                end = self._control.templates[f"operation_end_{kind_of(self._program, motion)}"]
                self._writer.lines([] if off in end.lines else [off])
                self._coolant = "OFF"
        self._expand("program_end", self._values(motions[-1]), motions[-1])

    def _expand(self, name: str, values: Mapping[str, Value], motion: Motion) -> None:
        formats = self._control.number_formats(motion.three_axis)
        template = self._control.templates[name]
        speed = values["spindle_speed"]
        self._lines(template.expand({**values, "new_speed": None if speed == self._speed else speed}, formats))
        if any(field in ("spindle_speed", "new_speed") for field, _ in template.fields()):
            self._speed = speed

    def _lines(self, lines: Sequence[str]) -> None:
        """Lines of text, none longer than the control reads; what goes on in the next line is one block with it."""
        room = self._control.longest_line - ROOM_OF_NUMBER
        for line in lines:
            if len(line.encode()) > room:
                what = f"a line has more than the {self._control.longest_line} bytes that {self._control.name} reads"
                raise InputError(Problem(self._program.file, 0, f"{what}: {line[:60]}…", "shorten the text"))
        sign, blocks, goes_on = self._control.continued, list[str](), False
        for line in lines:
            blocks[len(blocks) - goes_on :] = [f"{blocks[-1]}\n{line}" if goes_on else line]
            goes_on = bool(sign) and line.endswith(sign)
        self._writer.lines(blocks)

    def _operation(self, motion: Motion, ends: bool) -> None:
        """An operation, or what there is of it in one plane; ``ends``: there is no more of it."""
        self._slides = None
        if motion.manner is Manner.WITHOUT_TCP:
            angle = self._control.number_formats(motion.three_axis)["angle"]
            self._slides = slides_of(self._program.machine, motion, angle.decimals)
            motion = self._slides.motion
        kind, values = kind_of(self._program, motion), self._values(motion)
        if motion.begins:
            self._expand("operation_start", values, motion)
            tool = str(values["tool"])
            if tool != self._tool:
                self._expand("tool_change" if self._tool else "first_tool", values, motion)
                self._tool = tool
            self._tool_name = motion.operation.tool.name
        self._words = self._control.block_words(*self._letters, motion.three_axis)
        self._writer.use(self._words)
        if not self._goes_on(motion):
            self._writer.forget()
            for word, code in self._control.in_force.items():
                self._writer.remember(word, code)
        else:
            self._writer.forget("X", "Y", "Z", "feed")
        self._feed_mode = ABSENT
        self._expand(f"{'approach' if motion.begins else 'next_plane'}_{kind}", values, motion)
        if motion.plane is not None:
            self._expand(f"plane_on_{kind}", values, motion)
        for word, column in (("primary", self._primary), ("secondary", self._secondary)):
            self._writer.remember(word, int(self._angle_counts(motion.rotary[:1, self._column[column]], word)[0]))
        written = replace(motion, operation=motion.as_written())
        self._motion(written, int(self._stands_there(written)))
        self._before = written
        self._back_in_force()
        if ends:
            self._expand(f"operation_end_{kind}", values, motion)

    def _plane(self, motion: Motion) -> dict[str, Value]:
        """What templates of all families may print of a tilted plane: its origin and the side of the machine.

        The side is -1 or 1: of the two solutions that stand the tool on the plane, the one with the lower or the higher
        value of the rotary axis farther from the workpiece. Where there is only one, either word means it. The sign is
        that of this axis: "+" or "-".
        """
        names = "plane_x", "plane_y", "plane_z"
        if motion.plane is None:
            return dict.fromkeys((*names, "plane_side", "plane_sign"))
        moves, column = motion.operation.moves, self._program.machine.rotary[1]
        both = inverse(self._program.machine, moves.tip[:1], moves.axis[:1]).joints[:, 0, column]
        apart = both - motion.rotary[0, 1]
        apart -= 360.0 * np.rint(apart / 360.0)
        lower = np.argmin(np.abs(apart)) == np.argmin(both)
        side = "-1" if lower else "1"
        sign = "-" if motion.rotary[0, 1] < 0.0 else "+"
        return {**dict(zip(names, motion.plane.origin, strict=True)), "plane_side": side, "plane_sign": sign}

    def _home(self) -> dict[str, Value]:
        """The machine's home, for templates that say it in positions of the machine."""
        axes = self._program.machine.axes
        slides = {axis.name: axis.home for axis in axes if not axis.is_rotary}
        return {
            **{f"home_{name.lower()}": slides.get(name) for name in "XYZ"},
            "primary_home": axes[self._primary].home,
            "secondary_home": axes[self._secondary].home,
        }

    def _values(self, motion: Motion) -> dict[str, Value]:
        """What templates may print in this operation."""
        operation, control = motion.operation, self._control
        tool = operation.tool
        values: dict[str, Value] = {**control.settings, **self._program.settings}
        values |= self._family.values(values, None if motion.plane is None else motion.plane.matrix())
        if not values.get("tolerance"):
            given = operation.intol is not None and operation.outtol is not None
            values["tolerance"] = (
                (operation.intol or 0.0) + (operation.outtol or 0.0) if given else values.get("fallback_tolerance")
            )
        for setting in control.by_method:
            values[setting] = values[setting] or control.usual(setting, str(values.get("method", "")))
        ball = tool.kind == "MILL" and tool.diameter > 0 and abs(2 * tool.corner_radius - tool.diameter) < 1e-6
        known = tool.kind != "UNKNOWN"
        formats = {word.key: word for word in control.block_words(*self._letters, motion.three_axis)}
        angles = {
            f"{word}_word": formats[word].letter
            + formats[word].format.of_count(
                int(self._angle_counts(motion.rotary[:1, self._column[column]], word, motion)[0])
            )
            for word, column in (("primary", self._primary), ("secondary", self._secondary))
        }
        found: dict[str, Value] = {
            **values,
            **angles,
            **self._times(motion),
            **self._plane(motion),
            **self._spindle_values(self._spindle_at_start(operation)),
            "primary": self._letters[0],
            "secondary": self._letters[1],
            "machine": self._program.machine.name,
            **self._home(),
            "operation": operation.name,
            "tool": self._tool_call(motion),
            "tool_name": tool.name or None,
            "tool_type": control.tool_types["BALL" if ball else tool.kind] if known else None,
            "tool_diameter": tool.diameter if known else None,
            "tool_length": tool.length if known else None,
            "tool_corner_radius": tool.corner_radius if known else None,
            "gauge_length": self._program.machine.tool_length,
            **dict(zip(("zero_x", "zero_y", "zero_z"), self._program.machine.workpiece_zero or _UNKNOWN, strict=True)),
            "intol": operation.intol,
            "outtol": operation.outtol,
        }
        return {name: self._family.inside(value) if isinstance(value, str) else value for name, value in found.items()}

    def _times(self, motion: Motion) -> dict[str, Value]:
        """What the operation and all of them take, as people read it; worked out only where a template prints it."""
        if not any(name in ("time", "total_time") for t in self._control.templates.values() for name, _ in t.fields()):
            return {"time": None, "total_time": None}
        if not self._seconds:
            self._seconds = [seconds(self._program.machine, each) for each in self._program.motions]
        own = next(s for each, s in zip(self._program.motions, self._seconds, strict=True) if each is motion)
        return {"time": clock(own), "total_time": clock(sum(self._seconds))}

    def _tool_call(self, motion: Motion) -> str:
        """The tool as ``T=`` takes it: the run's setting, the number of LOAD/TOOL, or else the tool's name."""
        operation = motion.operation
        loads = [event for event in operation.events if isinstance(event, LoadTool)]
        number, name = setting_of(self._program, "tool"), operation.tool.name
        if self._tool and not loads and name == self._tool_name:
            return self._tool
        if name and (setting_of(self._program, "tool_call") == "name" or not (number or loads)):
            return self._family.tool_call(0, name, by_name=True)
        if number:
            return number
        if loads:
            return self._family.tool_call(loads[0].number, "", by_name=False)
        what = f"operation {operation.name} has no LOAD/TOOL, and its tool has no name"
        raise InputError(Problem(self._program.file, operation.line, what, "write --set tool=NUMBER"))

    def _angle_counts(self, angle: Floats, word: str, motion: Motion | None = None) -> Ints:
        """Counts of a rotary word; an axis that displays 0 to 360 degrees prints 360 as 0."""
        column = self._primary if word == "primary" else self._secondary
        axis = self._program.machine.axes[column]
        if motion is None:
            decimals = self._writer.word(word).format.decimals
        else:
            words = self._control.block_words(*self._letters, motion.three_axis)
            decimals = next(w.format.decimals for w in words if w.key == word)
        count = counts(np.ascontiguousarray(angle), decimals)
        if not np.isnan(axis.display_low):
            turn = 360 * 10**decimals
            top = round(axis.display_low * 10**decimals) + turn
            count[count >= top] -= turn
        return count

    def _goes_on(self, motion: Motion) -> bool:
        """Whether the tool comes from another plane of the same operation, and not from home."""
        return not motion.begins and self._control.plane_from_pose

    def _stands_there(self, motion: Motion) -> bool:
        """Whether turning the rotary axes to the next plane has already taken the tool to the first point there."""
        before, operation = self._before, motion.operation
        if before is None or not self._goes_on(motion) or len(operation.moves) < 2:
            return False
        busy = any(event.row == 0 and not isinstance(event, CycleOff) for event in operation.events)
        if busy or operation.moves.kind[0] != Kind.RAPID:
            return False
        last = np.append(before.operation.moves.tip[-1, :2], self._height)
        decimals = self._writer.word("X").format.decimals
        there = counts(carried_along(self._program.machine, last, before, motion), decimals)
        return bool((there == counts(np.ascontiguousarray(operation.moves.tip[0]), decimals)).all())

    def _motion(self, motion: Motion, first: int = 0) -> None:
        """All rows from ``first`` on, broken where an event is a block of its own."""
        rows = len(motion.operation.moves)
        joining = [] if self._goes_on(motion) else self._spindle_again(motion.operation)
        own_spindle = SPINDLE_ON in self._control.templates
        if self._control.own_blocks or own_spindle:
            for again in joining:
                self._own_block(motion, again) if own_spindle else self._event_block(again)
            joining = []
        done, text = first, -1
        cycle: CycleOn | None = None
        for event in motion.operation.events:
            if isinstance(event, CycleOn | CycleOff):
                text = self._stretch(motion, done, event.row, joining, text, cycle)
                done, joining = max(first, event.row), [e for e in joining if e.row >= event.row]
                cycle = event if isinstance(event, CycleOn) else None
                continue
            off = isinstance(event, SpindleOff) or (isinstance(event, Coolant) and event.kind == "OFF")
            alone = self._control.own_blocks and isinstance(event, SpindleOn | Coolant | CutterComp)
            off = off or alone or (own_spindle and isinstance(event, SpindleOn))
            joins = event if isinstance(event, SpindleOn | Coolant | CutterComp) and not off else None
            if joins and not any(type(e) is type(event) and e.row == event.row for e in joining):
                joining.append(joins)
            elif joins or off or isinstance(event, Dwell | Stop | Message | Insert | BlockSkip):
                text = self._stretch(motion, done, event.row, joining, text, cycle)
                for earlier in (e for e in joining if e.row == event.row):
                    self._event_block(earlier)  # what is said twice before one row is said in order
                done, joining = event.row, [e for e in joining if e.row > event.row]
                if joins:
                    joining.append(joins)
                elif isinstance(event, SpindleOn | SpindleOff | Coolant | CutterComp) and not (
                    own_spindle and isinstance(event, SpindleOn)
                ):
                    self._event_block(event)  # with the next motion the control would switch off after it
                else:
                    self._own_block(motion, event)
        self._stretch(motion, done, rows, joining, text, cycle)
        for event in joining:
            if event.row == rows:
                self._event_block(event)

    def _spindle_at_start(self, operation: Operation) -> SpindleOn | None:
        """What the spindle does at the first row; None: nobody said so."""
        said = [event for event in operation.events if isinstance(event, SpindleOn) and event.row == 0]
        return said[-1] if said else self._spindle

    def _spindle_values(self, event: SpindleOn | None) -> dict[str, Value]:
        """Speed, also where it is not the one that was said last, and the M code of the sense."""
        if event is None:
            return dict.fromkeys(("spindle_speed", "new_speed", "spindle_code"))
        code = "spindle_clockwise" if event.sense is Sense.CLW else "spindle_counterclockwise"
        return {
            "spindle_speed": event.rpm,
            "new_speed": event.rpm,
            "spindle_code": str(self._control.codes.get(code, "")),
        }

    def _spindle_again(self, operation: Operation) -> list[WordEvent]:
        """The last operation's end stopped the spindle: what was in force is said again unless something new is."""
        said = any(isinstance(event, SpindleOn) and event.row == 0 for event in operation.events)
        return [] if said or self._spindle is None else [replace(self._spindle, row=0)]

    def _event_block(self, event: WordEvent) -> None:
        """Words of an event in a block of their own."""
        self._writer.table({word: np.array([code], np.int64) for word, code in self._event_words(event).items()})

    def _own_block(self, motion: Motion, event: Event) -> None:
        """Events that are no words of a motion block."""
        if isinstance(event, SpindleOn):
            self._spindle = event
            self._expand(SPINDLE_ON, self._spindle_values(event), motion)
        elif isinstance(event, Dwell):
            rpm = None if self._spindle is None else self._spindle.rpm
            self._lines(self._family.dwell(event, rpm, self._control.number_formats(motion.three_axis)))
        elif isinstance(event, Stop):
            self._lines(self._family.stop(event, self._control.codes))
        elif isinstance(event, Message):
            self._lines(self._family.message(event))
        elif isinstance(event, Insert):
            self._lines([event.text])
            self._writer.forget()  # nobody knows what the text has changed
        elif isinstance(event, BlockSkip):
            self._writer.skip_blocks(event.on)

    def _event_words(self, event: WordEvent) -> dict[str, int]:
        """The words of an event that joins a motion block, as counts."""
        if isinstance(event, SpindleOn):
            self._spindle = event
        elif isinstance(event, Coolant):
            self._coolant = event.kind
        words = self._family.event_words(event, self._control.codes, self._control.coolant)
        return {word: self._count(word, value) for word, value in words.items()}

    def _count(self, word: str, value: float) -> int:
        return int(counts(np.array([value]), self._writer.word(word).format.decimals)[0])

    def _stretch(
        self, motion: Motion, first: int, last: int, joining: Sequence[WordEvent], text: int, cycle: CycleOn | None
    ) -> int:
        """Rows ``first`` to ``last``, holes if there is a cycle; as ``_rows``."""
        if cycle is None or first == last:
            return self._rows(motion, first, last, joining, text)
        said = cycle_of(cycle)
        assert said.retract is not None
        place = self._writer.word("X").format.decimals
        tops = counts(np.ascontiguousarray(motion.operation.moves.tip[first:last, 2]), place)
        begins = {0, *(np.flatnonzero(np.diff(tops)) + 1).tolist(), *(e.row - first for e in joining if e.row >= first)}
        ends = sorted(k for k in begins if k < last - first)
        for k, end in zip(ends, [*ends[1:], last - first], strict=True):
            here = [event for event in joining if event.row == first + k]
            make = self._called_holes if CALL in self._family.WORDS else self._holes
            text = make(motion, first + k, first + end, here, text, said)
        self._progress(last - first)
        return text

    def _holes(
        self, motion: Motion, first: int, last: int, joining: Sequence[WordEvent], text: int, cycle: Cycle
    ) -> int:
        """Holes of one height: position blocks under a modal cycle.

        The tool goes to them at the height to which it was drawn back. It begins at the retract height where nothing
        says how high it is, and is drawn up first where it is lower than the next holes want it.
        """
        moves, control, codes = motion.operation.moves, self._control, self._control.codes
        formats = control.number_formats(motion.three_axis)
        top = float(moves.tip[first, 2])
        assert cycle.retract is not None
        retract = top + cycle.retract
        for event in joining:
            if first > 0:
                self._event_block(event)
        if first == 0:
            block = {"motion": codes["rapid"], "feed": self._rapid_feed, **self._edge()}
            block |= {word: self._count("X", value) for word, value in zip("XY", moves.tip[0], strict=False)}
            if control.level_approach:
                self._block(block)
            block["Z"] = self._count("X", retract)
            for event in joining:
                block |= self._event_words(event)
            self._block(block)
            self._height = retract
        else:
            low = retract if control.holes_from == "retract" else top + cycle.above
            if self._height < low - 1e-9:
                self._block({"motion": codes["rapid"], "feed": self._rapid_feed, "Z": self._count("X", low)})
        turning_now = None if self._spindle is None else Turning(self._spindle.rpm, self._spindle.sense)
        feed, per_rev = feed_of(cycle, turning_now, float(moves.feed[first]), bool(moves.per_rev[first]))
        lines = self._family.hole_call(cycle, top, turning_now, settings_of(self._program), formats)
        decimals = self._writer.word("X").format.decimals
        columns = {
            word: counts(np.ascontiguousarray(moves.tip[first:last, c]), decimals) for c, word in enumerate("XY")
        }
        ids, texts = self._phase_texts()
        wanted = ids[moves.phase[first:last]]
        if any(FIRST_HOLE in line for line in lines):
            self._called_with_hole(lines, columns, self._count("feed", feed))
        else:
            mode = codes["feed_per_revolution" if per_rev else "feed_per_minute"]
            if mode != self._feed_mode:
                self._writer.forget("feed")
            self._feed_mode = mode
            block = {"feed_mode": mode, "plane": codes["plane_xy"], "feed": self._count("feed", feed)}
            self._block(block)
            self._lines(lines)
            columns["motion"] = np.full(last - first, codes["rapid"], np.int64)
            before = np.concatenate(([text], wanted[:-1]))
            self._writer.table(columns, {"X": True, "Y": True}, np.where(wanted != before, wanted, -1), texts)
        self._lines(self._family.hole_end())
        self._height = retract
        self._writer.forget("X", "Y", "Z")  # a point at which the tool already stands gets its block
        return int(wanted[-1])

    def _called_holes(
        self, motion: Motion, first: int, last: int, joining: Sequence[WordEvent], text: int, cycle: Cycle
    ) -> int:
        """Holes of one height where each position block calls the cycle; heights are as in ``_holes``."""
        moves, control = motion.operation.moves, self._control
        assert cycle.retract is not None
        top = float(moves.tip[first, 2])
        retract = top + cycle.retract
        n = last - first
        rapids = self._family.row_words(np.ones(n, np.bool_), np.zeros(n, np.bool_), control.codes)
        decimals = self._writer.word("X").format.decimals
        places = {word: counts(np.ascontiguousarray(moves.tip[first:last, c]), decimals) for c, word in enumerate("XY")}
        block = {word: int(column[0]) for word, column in rapids.items()}
        for event in joining:
            if first > 0:
                self._event_block(event)
            else:
                block |= self._event_words(event)
        if first == 0:
            self._block(
                block | {word: int(column[0]) for word, column in places.items()} | {"Z": self._count("X", retract)}
            )
        elif self._height < top + cycle.above - 1e-9:
            self._block(block | {"Z": self._count("X", top + cycle.above)})
        turning_now = None if self._spindle is None else Turning(self._spindle.rpm, self._spindle.sense)
        feed, per_rev = feed_of(cycle, turning_now, float(moves.feed[first]), bool(moves.per_rev[first]))
        formats = control.number_formats(motion.three_axis)
        said = replace(cycle, feed=feed, per_rev=per_rev)
        self._lines(self._family.hole_call(said, top, turning_now, settings_of(self._program), formats))
        ids, texts = self._phase_texts()
        wanted = ids[moves.phase[first:last]]
        before = np.concatenate(([text], wanted[:-1]))
        columns = {**rapids, **places, CALL: np.full(n, control.codes[CALL], np.int64)}
        self._writer.table(columns, {"X": True, "Y": True}, np.where(wanted != before, wanted, -1), texts)
        self._height = retract
        self._writer.forget("X", "Y", "Z")  # a point at which the tool already stands gets its block
        return int(wanted[-1])

    def _called_with_hole(self, lines: Sequence[str], columns: Mapping[str, Ints], feed: int) -> None:
        """The call of a cycle in the block of its first hole, with F where it is not in force; then the others.

        The blocks of holes say nothing but where they are: any other motion word would end the cycle.
        """
        self._block({"plane": self._control.codes["plane_xy"]})
        place = " ".join(self._writer.said(word, int(columns[word][0])) for word in "XY")
        end = "" if self._writer.printed("feed") == feed else f" {self._writer.said('feed', feed)}"
        self._lines([line.replace(FIRST_HOLE, place) + (end if FIRST_HOLE in line else "") for line in lines])
        if len(columns["X"]) > 1:
            self._writer.table({word: column[1:] for word, column in columns.items()}, {"X": True, "Y": True})

    def _block(self, words: Mapping[str, int]) -> None:
        """One block of these words, as counts; nothing where all of them are in force."""
        self._writer.table({word: np.array([count], np.int64) for word, count in words.items()})

    def _rows(self, motion: Motion, first: int, last: int, joining: Sequence[WordEvent], text: int) -> int:
        """Write rows ``first`` to ``last``; returns the index of the phase text that was printed last."""
        for start in range(first, last, CHUNK):
            stop = min(start + CHUNK, last)
            text = self._chunk(motion, start, stop, [e for e in joining if start <= e.row < stop], text)
            self._progress(stop - start)
        return text

    def _chunk(self, motion: Motion, start: int, stop: int, joining: Sequence[WordEvent], text: int) -> int:
        moves, arcs, control = motion.operation.moves, motion.operation.arcs, self._control
        part = slice(start, stop)
        self._height = float(moves.tip[stop - 1, 2])
        rapid = moves.kind[part] == Kind.RAPID
        decimals = {word: self._writer.word(word).format.decimals for word in ("X", "feed")}
        columns = {
            word: counts(np.ascontiguousarray(moves.tip[part, c]), decimals["X"]) for c, word in enumerate("XYZ")
        }
        if motion.plane is None:  # in a plane the rotary axes stand where they were put
            columns["primary"] = self._angle_counts(motion.rotary[part, self._column[self._primary]], "primary")
            columns["secondary"] = self._angle_counts(motion.rotary[part, self._column[self._secondary]], "secondary")
        columns["feed"] = np.where(
            rapid, self._rapid_feed, counts(np.where(rapid, np.nan, moves.feed[part]), decimals["feed"])
        )
        columns |= self._family.row_words(rapid, moves.per_rev[part], control.codes)
        forced: dict[str, bool | Ints] = {}
        if self._slides is not None:
            forced |= self._words_of_slides(self._slides, moves.feed[part], part, rapid, columns)
        forced["feed"] = self._feed_anew(columns, rapid)
        lines: dict[int, str] = {}
        elsewhere = np.zeros(stop - start, np.bool_)
        inside = np.flatnonzero((arcs.row >= start) & (arcs.row < stop))
        if len(inside):
            formats = {word.key: word.format for word in self._words}
            words = self._family.arc_words(arcs, moves.tip, inside, control.codes, formats)
            at = arcs.row[inside] - start
            for word, column in words.columns.items():
                columns.setdefault(word, np.full(stop - start, ABSENT, np.int64))[at] = column
            for word, flag in words.forced.items():
                every = np.zeros(stop - start, np.int64)
                every[at] = flag
                forced[word] = every | forced.get(word, 0)
            lines = dict(zip(at.tolist(), words.lines or (), strict=False))
            elsewhere = columns["X"] == ABSENT
            for word in "XYZ":  # where an arc's end was said by other words, the next block says its own whole
                forced[word] = np.concatenate(([0], elsewhere[:-1])).astype(np.int64) | forced.get(word, 0)
        if start == 0 and rapid[0] and control.level_approach and motion.begins and motion.manner in LEVEL:
            self._block({word: int(column[0]) for word, column in columns.items() if word != "Z"})
        if start == 0:
            self._join(columns, 0, self._edge())
        for event in joining:
            self._join(columns, event.row - start, self._event_words(event))
        ids, texts = self._phase_texts()
        wanted = ids[moves.phase[part]]
        before = np.concatenate(([text], wanted[:-1]))
        self._writer.table(columns, forced, np.where(wanted != before, wanted, -1), texts, lines)
        if elsewhere[-1]:
            self._writer.forget("X", "Y", "Z")
        return int(wanted[-1])

    def _edge(self) -> dict[str, int]:
        """The cutting edge, on controls that have any."""
        return {"edge": int(setting_of(self._program, "edge"))} if "edge" in self._control.settings else {}

    def _words_of_slides(
        self, slides: Slides, feed: Floats, part: slice, rapid: Flags, columns: dict[str, Ints]
    ) -> dict[str, bool | Ints]:
        """Change the words of rows without TCP: the time of blocks that turn, and the shorter way of endless axes.

        Returns which words are said though they may print as before: X in rapids, which without a slide would only
        place the rotary axes.
        """
        turning = slides.turns[part] & ~rapid
        word = self._writer.word("inverse_feed")
        rate = np.full(len(feed), np.nan)
        rate[turning] = inverse_time(slides.length[part][turning], feed[turning], word.format)[0]
        columns["inverse_feed"] = counts(rate, word.format.decimals)
        columns["feed"][turning] = ABSENT
        columns["feed_mode"][turning] = self._control.codes["feed_inverse_time"]
        for which, key in ((self._primary, "primary"), (self._secondary, "secondary")):
            jumps = slides.shortest[part, self._column[which]]
            if jumps.any():  # which only controls do that have the word
                columns[f"{key}_shortest"] = np.where(jumps, columns[key], ABSENT)
                columns[key][jumps] = ABSENT
        return {"X": rapid.astype(np.int64)}

    def _feed_anew(self, columns: Mapping[str, Ints], rapid: Flags) -> Ints:
        """(n,) 1 in the rows from which F means something else than before; there it is said, whatever its number."""
        changes = np.zeros(len(rapid), np.int64)
        cuts = np.flatnonzero(~rapid)
        if len(cuts) and "feed_mode" in columns:
            modes = columns["feed_mode"][cuts]
            changes[cuts] = modes != np.concatenate(([self._feed_mode], modes[:-1]))
            self._feed_mode = int(modes[-1])
        return changes

    def _join(self, columns: dict[str, Ints], row: int, words: Mapping[str, int]) -> None:
        """Put words onto a row."""
        for word, code in words.items():
            column = columns.setdefault(word, np.full(len(columns["X"]), ABSENT, np.int64))
            column[row] = code

    def _phase_texts(self) -> tuple[Ints, list[str]]:
        """(9,) int64 index of the line for each ``Phase``, -1 for none, and the lines; equal lines share an index."""
        texts = [self._control.phases.get(_PHASE_TEXT.get(phase, ""), "") for phase in Phase]
        lines = list(dict.fromkeys(text for text in texts if text))
        return np.array([lines.index(text) if text else -1 for text in texts], np.int64), lines

    def _back_in_force(self) -> None:
        """Say again what the program start put in force, as far as the operation has changed it."""
        columns = {word: np.array([code], np.int64) for word, code in self._control.in_force.items()}
        if columns:
            self._writer.table(columns)
