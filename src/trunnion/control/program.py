"""The program from its first line to its last: sequences from templates, dense motion through the block writer.

Every operation goes the same way: operation start, tool, approach with the rotary axes placed first, motion, end.
Events stand between rows; those that are words join the next motion block, the others are blocks of their own.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import BinaryIO

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.control import sinumerik
from trunnion.control.definition import Control
from trunnion.control.holes import Heights, cycle_call, feed_of
from trunnion.control.template import Value
from trunnion.errors import InputError, Problem, Severity
from trunnion.machine import Machine, inverse
from trunnion.nc import ABSENT, CHUNK, BlockWriter, counts
from trunnion.plan import Manner, Motion
from trunnion.plan.holes import Cycle, CycleError, Turning, cycle_of, turning
from trunnion.toolpath import (
    BlockSkip,
    Coolant,
    CutterComp,
    CycleOff,
    CycleOn,
    Dwell,
    Event,
    GoHome,
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
_COMP = {"LEFT": "comp_left", "RIGHT": "comp_right", "OFF": "comp_off"}
_COMP_PLANE = {"XYPLAN": "plane_xy", "ZXPLAN": "plane_zx", "YZPLAN": "plane_yz"}


@dataclass(frozen=True, slots=True)
class Program:
    """All that one program is made from. ``notices`` are printed at its head, as comments."""

    machine: Machine
    control: Control
    motions: Sequence[Motion]
    settings: Mapping[str, str]
    file: str = ""
    notices: Sequence[str] = ()


def check_program(program: Program) -> list[Problem]:
    """What the program would lack, or what this control cannot yet be told; errors mean that it must not be written."""
    problems = []
    spindle, in_spindle = False, ""
    for motion in program.motions:
        operation = motion.operation
        moves = operation.moves
        problems += _hole_problems(program, motion)
        if not motion.begins:
            continue
        unfed = np.flatnonzero((moves.kind != Kind.RAPID) & ~(moves.feed > 0))
        if len(unfed):
            problems.append(
                Problem(
                    program.file, int(moves.line[unfed[0]]), "cutting motion without a feed", "put FEDRAT before it"
                )
            )
        spindle = spindle or any(isinstance(e, SpindleOn) for e in operation.events)
        if not spindle:
            what = f"operation {operation.name} has no spindle speed"
            problems.append(Problem(program.file, operation.line, what, "put SPINDL before it", Severity.WARNING))
        loaded = any(isinstance(e, LoadTool) for e in operation.events) or _setting(program, "tool")
        if not loaded and operation.tool.name and operation.tool.name != in_spindle:
            what = f"operation {operation.name} has no LOAD/TOOL; its tool is called by its name"
            problems.append(
                Problem(program.file, operation.line, what, "--set tool=NUMBER calls it by number", Severity.WARNING)
            )
        if '"' in operation.tool.name and (not loaded or _setting(program, "tool_call") == "name"):
            what = f"the tool name {operation.tool.name} has a quotation mark in it"
            problems.append(Problem(program.file, operation.line, what, "write --set tool=NUMBER"))
        in_spindle = operation.tool.name
        for event in operation.events:
            problems += _event_problems(program, operation, event)
        tolerance = operation.intol is not None and operation.outtol is not None
        fine = not motion.three_axis and not (motion.plane and _setting(program, "plane") == "cycle800")
        if fine and not tolerance and not _setting(program, "tolerance"):
            fallback = _setting(program, "fallback_tolerance")
            what = f"operation {operation.name} has no INTOL and OUTTOL; the tolerance becomes {fallback}"
            problems.append(Problem(program.file, operation.line, what, "--set tolerance=…", Severity.WARNING))
    return problems


def _event_problems(program: Program, operation: Operation, event: Event) -> list[Problem]:
    place = program.file, event.line
    rows = len(operation.moves)
    if isinstance(event, LoadTool) and event.row > 0:
        return [Problem(*place, "tool change within an operation", "begin a new operation with the new tool")]
    if isinstance(event, CutterComp) and event.side == "ON":
        return [Problem(*place, "CUTCOM/ON does not say on which side", "write CUTCOM/LEFT or CUTCOM/RIGHT")]
    if isinstance(event, GoHome) and event.row < rows:
        return [Problem(*place, "GOHOME before the operation's end", "begin a new operation after it")]
    if isinstance(event, Coolant) and event.kind not in program.control.coolant:
        known = ", ".join(program.control.coolant)
        return [Problem(*place, f"{program.control.name} has no coolant {event.kind}", f"use one of {known}")]
    return []


def _hole_problems(program: Program, motion: Motion) -> list[Problem]:
    """What the cycles of a motion ask for and this control cannot be told."""
    operation, problems = motion.as_written(), []
    moves = operation.moves
    for event in operation.events:
        if not isinstance(event, CycleOn):
            continue
        try:
            cycle = cycle_of(event)
            if motion.manner is Manner.TCP:
                cure = "leave the setting manner out, or end the cut before the tool axis changes"
                raise CycleError("hole-making cycles while the tool axis changes, or with TCP", cure)
            spindle = turning(operation.events, event.row, Turning(1.0, Sense.CLW))
            cycle_call(cycle, 0.0, spindle, _lift(program), program.control.number_formats(motion.three_axis))
            feed, _ = feed_of(cycle, spindle, float(moves.feed[event.row]), False)
            if not feed > 0.0:
                raise CycleError("CYCLE without a feed", "write MMPM,feed, or FEDRAT before it")
            low = event.row > 0 and moves.tip[event.row - 1, 2] < moves.tip[event.row, 2] + cycle.above - 1e-6
            if low and moves.kind[event.row - 1] != Kind.RAPID:
                cure = "draw the tool back before the cycle"
                raise CycleError("CYCLE while the tool is below the height of RAPTO", cure)
        except CycleError as error:
            problems.append(Problem(program.file, event.line, error.what, error.cure))
    return problems


def _lift(program: Program) -> float | None:
    """The setting ``bore_lift``, mm; None where it is not given."""
    text = _setting(program, "bore_lift")
    return float(text) if text else None


def _setting(program: Program, name: str) -> str:
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
        self._program = program
        self._control = program.control
        self._progress = progress
        axes = program.machine.axes
        self._primary, self._secondary = program.machine.primary, program.machine.secondary
        self._column = {k: c for c, k in enumerate(program.machine.rotary)}
        self._letters = axes[self._primary].name, axes[self._secondary].name
        words = self._control.block_words(*self._letters, three_axis=False)
        self._writer = BlockWriter(sink, words, self._control.numbers)
        self._tool = self._tool_name = ""
        self._spindle: SpindleOn | None = None
        self._coolant = "OFF"
        self._height = 0.0  # of the tool along Z of the frame, at the last row written

    def write(self) -> None:
        """The program, operation by operation."""
        motions = self._program.motions
        self._writer.lines(sinumerik.comment(text) for text in self._program.notices)
        self._expand("program_start", self._values(motions[0]), motions[0])
        for k, motion in enumerate(motions):
            self._operation(motion, k + 1 == len(motions) or motions[k + 1].begins)
            if self._coolant != "OFF" and k + 1 < len(motions) and motions[k + 1].begins:
                self._writer.lines([f"M{self._control.coolant['OFF']}"])
                self._coolant = "OFF"
        self._expand("program_end", self._values(motions[-1]), motions[-1])

    def _expand(self, name: str, values: Mapping[str, Value], motion: Motion) -> None:
        formats = self._control.number_formats(motion.three_axis)
        self._writer.lines(self._control.templates[name].expand(values, formats))

    def _operation(self, motion: Motion, ends: bool) -> None:
        """An operation, or what there is of it in one plane; ``ends``: there is no more of it."""
        kind, values = self._kind(motion), self._values(motion)
        if motion.begins:
            self._expand("operation_start", values, motion)
            tool = str(values["tool"])
            if tool != self._tool:
                self._expand("tool_change" if self._tool else "first_tool", values, motion)
                self._tool = tool
            self._tool_name = motion.operation.tool.name
        self._writer.use(self._control.block_words(*self._letters, motion.three_axis))
        self._writer.forget()
        for word, code in self._control.in_force.items():
            self._writer.remember(word, code)
        self._expand(f"{'approach' if motion.begins else 'next_plane'}_{kind}", values, motion)
        if motion.plane is not None:
            self._expand(f"plane_on_{kind}", values, motion)
        for word, column in (("primary", self._primary), ("secondary", self._secondary)):
            self._writer.remember(word, int(self._angle_counts(motion.rotary[:1, self._column[column]], word)[0]))
        self._motion(replace(motion, operation=motion.as_written()))
        self._back_in_force()
        if ends:
            self._expand(f"operation_end_{kind}", values, motion)

    def _kind(self, motion: Motion) -> str:
        """What the templates of this kind of operation are called."""
        if motion.manner is Manner.TILTED:
            return _setting(self._program, "plane")
        return "three_axis" if motion.three_axis else "five_axis"

    def _plane(self, motion: Motion) -> dict[str, Value]:
        """What templates may print of a tilted plane: its origin, its turning angles and the side of the machine.

        The side is -1 or 1: of the two solutions that stand the tool on the plane, the one with the lower or the higher
        value of the rotary axis farther from the workpiece. Where there is only one, either word means it.
        """
        names = "plane_x", "plane_y", "plane_z", "plane_first", "plane_second", "plane_third"
        if motion.plane is None:
            return dict.fromkeys((*names, "plane_mode", "plane_side"))
        mode = _setting(self._program, "swivel_mode") if _setting(self._program, "plane") == "cycle800" else "57"
        angles = sinumerik.turns(motion.plane.matrix(), sinumerik.sequence(int(mode)))
        moves, column = motion.operation.moves, self._program.machine.rotary[1]
        both = inverse(self._program.machine, moves.tip[:1], moves.axis[:1]).joints[:, 0, column]
        apart = both - motion.rotary[0, 1]
        apart -= 360.0 * np.rint(apart / 360.0)
        lower = np.argmin(np.abs(apart)) == np.argmin(both)
        side = "-1" if lower else "1"
        return {
            **dict(zip(names, (*motion.plane.origin, *angles), strict=True)),
            "plane_mode": mode,
            "plane_side": side,
        }

    def _values(self, motion: Motion) -> dict[str, Value]:
        """What templates may print in this operation."""
        operation, control = motion.operation, self._control
        tool = operation.tool
        values: dict[str, Value] = {**control.settings, **self._program.settings}
        if not values["tolerance"]:
            given = operation.intol is not None and operation.outtol is not None
            values["tolerance"] = (
                (operation.intol or 0.0) + (operation.outtol or 0.0) if given else values["fallback_tolerance"]
            )
        if not values["cycle832"]:
            method = str(values["method"]).upper()
            values["cycle832"] = next((mode for part, mode in control.kinds if part.upper() in method), None)
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
        return {
            **values,
            **angles,
            **self._plane(motion),
            "primary": self._letters[0],
            "secondary": self._letters[1],
            "machine": self._program.machine.name,
            "operation": operation.name,
            "tool": self._tool_call(motion),
            "tool_name": tool.name or None,
            "tool_type": control.tool_types["BALL" if ball else tool.kind] if known else None,
            "tool_diameter": tool.diameter if known else None,
            "tool_length": tool.length if known else None,
            "tool_corner_radius": tool.corner_radius if known else None,
            "intol": operation.intol,
            "outtol": operation.outtol,
        }

    def _tool_call(self, motion: Motion) -> str:
        """The tool as ``T=`` takes it: the run's setting, the number of LOAD/TOOL, or else the tool's name."""
        operation = motion.operation
        loads = [event for event in operation.events if isinstance(event, LoadTool)]
        number, name = _setting(self._program, "tool"), operation.tool.name
        if self._tool and not loads and name == self._tool_name:
            return self._tool
        if name and (_setting(self._program, "tool_call") == "name" or not (number or loads)):
            return sinumerik.tool_call(0, name, by_name=True)
        if number:
            return number
        if loads:
            return sinumerik.tool_call(loads[0].number, "", by_name=False)
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

    def _motion(self, motion: Motion) -> None:
        """All rows, broken where an event is a block of its own."""
        rows = len(motion.operation.moves)
        joining = self._spindle_again(motion.operation)
        done, text = 0, -1
        cycle: CycleOn | None = None
        for event in motion.operation.events:
            if isinstance(event, CycleOn | CycleOff):
                text = self._stretch(motion, done, event.row, joining, text, cycle)
                done, joining = event.row, [e for e in joining if e.row >= event.row]
                cycle = event if isinstance(event, CycleOn) else None
                continue
            off = isinstance(event, SpindleOff) or (isinstance(event, Coolant) and event.kind == "OFF")
            joins = isinstance(event, SpindleOn | Coolant | CutterComp) and not off
            if joins and not any(type(e) is type(event) and e.row == event.row for e in joining):
                joining.append(event)
            elif joins or off or isinstance(event, Dwell | Stop | Message | Insert | BlockSkip):
                text = self._stretch(motion, done, event.row, joining, text, cycle)
                for earlier in (e for e in joining if e.row == event.row):
                    self._event_block(earlier)  # what is said twice before one row is said in order
                done, joining = event.row, [e for e in joining if e.row > event.row]
                if joins:
                    joining.append(event)
                elif off:
                    self._event_block(event)  # with the next motion the control would switch off after it
                else:
                    self._own_block(motion, event)
        self._stretch(motion, done, rows, joining, text, cycle)
        for event in joining:
            if event.row == rows:
                self._event_block(event)

    def _spindle_again(self, operation: Operation) -> list[Event]:
        """The last operation's end stopped the spindle: what was in force is said again unless something new is."""
        said = any(isinstance(event, SpindleOn) and event.row == 0 for event in operation.events)
        return [] if said or self._spindle is None else [replace(self._spindle, row=0)]

    def _event_block(self, event: Event) -> None:
        """Words of an event in a block of their own."""
        self._writer.table({word: np.array([code], np.int64) for word, code in self._event_words(event).items()})

    def _own_block(self, motion: Motion, event: Event) -> None:
        """Events that are no words of a motion block."""
        if isinstance(event, Dwell):
            self._writer.lines([sinumerik.dwell(event, self._control.number_formats(motion.three_axis))])
        elif isinstance(event, Stop):
            self._writer.lines(sinumerik.stop(event, self._control))
        elif isinstance(event, Message):
            self._writer.lines([sinumerik.message(event)])
        elif isinstance(event, Insert):
            self._writer.lines([event.text])
            self._writer.forget()  # nobody knows what the text has changed
        elif isinstance(event, BlockSkip):
            self._writer.skip_blocks(event.on)

    def _event_words(self, event: Event) -> dict[str, int]:
        """The words of an event that joins a motion block, as counts."""
        codes = self._control.codes
        if isinstance(event, SpindleOn):
            self._spindle = event
            turn = "spindle_clockwise" if event.sense is Sense.CLW else "spindle_counterclockwise"
            return {"speed": self._count("speed", event.rpm), "spindle": codes[turn]}
        if isinstance(event, SpindleOff):
            return {"spindle": codes["spindle_off"]}
        if isinstance(event, Coolant):
            self._coolant = event.kind
            return {"coolant": self._control.coolant[event.kind]}
        assert isinstance(event, CutterComp)
        words = {"cutter_comp": codes[_COMP[event.side]]} if event.side in _COMP else {}
        if event.plane in _COMP_PLANE:
            words["plane"] = codes[_COMP_PLANE[event.plane]]
        return words

    def _count(self, word: str, value: float) -> int:
        return int(counts(np.array([value]), self._writer.word(word).format.decimals)[0])

    def _stretch(
        self, motion: Motion, first: int, last: int, joining: Sequence[Event], text: int, cycle: CycleOn | None
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
            text = self._holes(motion, first + k, first + end, here, text, said)
        self._progress(last - first)
        return text

    def _holes(self, motion: Motion, first: int, last: int, joining: Sequence[Event], text: int, cycle: Cycle) -> int:
        """Holes of one height: position blocks between MCALL with a cycle and MCALL without.

        The tool goes to them at the height to which it was drawn back. It begins at the retract height where nothing
        says how high it is, and is drawn up first where it is lower than the next holes want it.
        """
        moves, control, codes = motion.operation.moves, self._control, self._control.codes
        formats = control.number_formats(motion.three_axis)
        top = float(moves.tip[first, 2])
        heights = Heights.of(cycle, top)
        for event in joining:
            if first > 0:
                self._event_block(event)
        if first == 0:
            block = {"motion": codes["rapid"], "edge": int(_setting(self._program, "edge"))}
            block |= {word: self._count("X", value) for word, value in zip("XY", moves.tip[0], strict=False)}
            block["Z"] = self._count("X", heights.retract)
            for event in joining:
                block |= self._event_words(event)
            self._block(block)
            self._height = heights.retract
        elif self._height < top + cycle.above - 1e-9:
            self._block({"motion": codes["rapid"], "Z": self._count("X", top + cycle.above)})
        turning_now = None if self._spindle is None else Turning(self._spindle.rpm, self._spindle.sense)
        feed, per_rev = feed_of(cycle, turning_now, float(moves.feed[first]), bool(moves.per_rev[first]))
        mode = codes["feed_per_revolution" if per_rev else "feed_per_minute"]
        self._block({"feed_mode": mode, "plane": codes["plane_xy"], "feed": self._count("feed", feed)})
        self._writer.lines([f"MCALL {cycle_call(cycle, top, turning_now, _lift(self._program), formats)}"])
        decimals = self._writer.word("X").format.decimals
        columns = {
            word: counts(np.ascontiguousarray(moves.tip[first:last, c]), decimals) for c, word in enumerate("XY")
        }
        columns["motion"] = np.full(last - first, codes["rapid"], np.int64)
        ids, texts = self._phase_texts()
        wanted = ids[moves.phase[first:last]]
        before = np.concatenate(([text], wanted[:-1]))
        self._writer.table(columns, {"X": True, "Y": True}, np.where(wanted != before, wanted, -1), texts)
        self._writer.lines(["MCALL"])
        self._height = heights.retract
        self._writer.forget("X", "Y", "Z")  # a point at which the tool already stands gets its block
        return int(wanted[-1])

    def _block(self, words: Mapping[str, int]) -> None:
        """One block of these words, as counts; nothing where all of them are in force."""
        self._writer.table({word: np.array([count], np.int64) for word, count in words.items()})

    def _rows(self, motion: Motion, first: int, last: int, joining: Sequence[Event], text: int) -> int:
        """Write rows ``first`` to ``last``; returns the index of the phase text that was printed last."""
        for start in range(first, last, CHUNK):
            stop = min(start + CHUNK, last)
            text = self._chunk(motion, start, stop, [e for e in joining if start <= e.row < stop], text)
            self._progress(stop - start)
        return text

    def _chunk(self, motion: Motion, start: int, stop: int, joining: Sequence[Event], text: int) -> int:
        moves, arcs, control = motion.operation.moves, motion.operation.arcs, self._control
        part = slice(start, stop)
        self._height = float(moves.tip[stop - 1, 2])
        rapid = moves.kind[part] == Kind.RAPID
        decimals = {word: self._writer.word(word).format.decimals for word in ("X", "feed", "I")}
        columns = {
            word: counts(np.ascontiguousarray(moves.tip[part, c]), decimals["X"]) for c, word in enumerate("XYZ")
        }
        if motion.plane is None:  # in a plane the rotary axes stand where they were put
            columns["primary"] = self._angle_counts(motion.rotary[part, self._column[self._primary]], "primary")
            columns["secondary"] = self._angle_counts(motion.rotary[part, self._column[self._secondary]], "secondary")
        columns["motion"] = np.where(rapid, control.codes["rapid"], control.codes["linear"]).astype(np.int64)
        columns["feed"] = np.where(rapid, ABSENT, counts(np.where(rapid, np.nan, moves.feed[part]), decimals["feed"]))
        mode = np.where(moves.per_rev[part], control.codes["feed_per_revolution"], control.codes["feed_per_minute"])
        columns["feed_mode"] = np.where(rapid, ABSENT, mode).astype(np.int64)
        forced: dict[str, bool | Ints] = {}
        inside = np.flatnonzero((arcs.row >= start) & (arcs.row < stop))
        if len(inside):
            words, ends = sinumerik.arc_words(arcs, moves.tip, inside, start, decimals["I"], control)
            at = arcs.row[inside] - start
            for word, column in words.items():
                columns.setdefault(word, np.full(stop - start, ABSENT, np.int64))[at] = column
            for word, flag in ends.items():
                every = np.zeros(stop - start, np.int64)
                every[at] = flag
                forced[word] = every
        if start == 0:
            self._join(columns, 0, {"edge": int(_setting(self._program, "edge"))})
        for event in joining:
            self._join(columns, event.row - start, self._event_words(event))
        ids, texts = self._phase_texts()
        wanted = ids[moves.phase[part]]
        before = np.concatenate(([text], wanted[:-1]))
        self._writer.table(columns, forced, np.where(wanted != before, wanted, -1), texts)
        return int(wanted[-1])

    def _join(self, columns: dict[str, Ints], row: int, words: Mapping[str, int]) -> None:
        """Put words onto a row."""
        for word, code in words.items():
            column = columns.setdefault(word, np.full(len(columns["motion"]), ABSENT, np.int64))
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
