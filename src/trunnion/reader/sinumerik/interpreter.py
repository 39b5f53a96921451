"""Programs, block by block: what each one says goes to the virtual control, and where the program goes on.

A program runs from chunks of its file, plain motion blocks inside the scan kernel. The first jump, loop or subprogram
that needs it makes the whole text be held. Everything that a program could do without end has a limit.
"""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Final

import numpy as np

from trunnion.arrays import Ints
from trunnion.errors import InputError, Problem, Severity
from trunnion.machine import Machine
from trunnion.reader.columns import Changes
from trunnion.reader.run import Comment, Finding, Orientation, Run, State
from trunnion.reader.sinumerik import cycles, scan
from trunnion.reader.sinumerik.block import Block, BlockReader, Call, read_call
from trunnion.reader.sinumerik.control import CLOCKWISE, COUNTER, FARTHEST, LINEAR, RAPID, THROUGH, Control
from trunnion.reader.sinumerik.expressions import ExpressionError, Reader, Value
from trunnion.reader.sinumerik.flow import Activation, End, Flow
from trunnion.reader.sinumerik.frames import Frame, statement, turn
from trunnion.reader.sinumerik.text import Folder, Text, decode
from trunnion.reader.sinumerik.tokens import LONGEST, Sort, Token, split_comment, tokenize
from trunnion.reader.sinumerik.variables import Variables
from trunnion.reader.sinumerik.words import (
    CONSTANTS,
    FRAMES,
    G_FEEDS,
    G_MACHINE,
    G_NAMED,
    G_NO_MOTION,
    G_OFFSETS,
    G_PLANES,
    G_SILENT,
    G_UNITS,
    M_CHANGE,
    M_ENDS,
    M_EVENTS,
    M_LATE,
    M_RETURN,
    M_SPINDLE,
    SILENT,
)

#: Blocks a program may execute besides going once through its files.
STEPS: Final = 2_000_000

#: Findings that are kept one by one; the rest is counted.
MOST_FINDINGS: Final = 10_000

#: So many characters of a block, or of a text that is kept, count as one more: real ones are shorter.
LONG: Final = 128

#: Subprograms that one program may call.
MOST_FILES: Final = 1000

#: Subprograms inside subprograms, as deep as the control itself allows.
DEEPEST_CALL: Final = 16

#: Names with arguments that the interpreter knows; all others are subprograms.
_BUILT_IN: Final = frozenset({*cycles.CYCLES, "CYCLE800", "CYCLE832", "MSG", "SETAL"})

#: Rows there is room for when the kernel starts, and fewer than which are too few.
_ROOM: Final = 65536
_LEAST_ROOM: Final = 4096

#: Whether a line may be plain: a look at its beginning saves starting the kernel in vain.
_PLAIN = re.compile(rb"[ \t]*(?:N[0-9]+[ \t]*)?(?:[;\r\n]|G0?[01](?![0-9])|[A-FXYZ]=?[-+.0-9])", re.IGNORECASE)
_LOOK: Final = 48


class Interpreter:
    """Runs one program on one machine; ``run`` may be called once."""

    def __init__(self, path: Path, machine: Machine, *, step_limit: int, skip: bool, shortest: bool | None) -> None:
        rotary = tuple(machine.axes[column].name.upper() for column in machine.rotary)
        slides = {machine.axes[column].name for column in machine.linear}
        if slides != {"X", "Y", "Z"}:
            what = f"has slides {', '.join(sorted(slides))}"
            raise InputError(Problem(machine.key, 0, what, "this reader needs X, Y and Z"))
        self._machine = machine
        self._path = path
        self._skip = skip
        self._limit = step_limit
        self._steps = 0
        self._kept = 0
        self._events = 0
        self._findings: list[Finding] = []
        self._more = 0
        self._comments: list[Comment] = []
        self._texts: dict[Path, tuple[Text, int]] = {}
        self._folder = Folder(path)
        self._file = Changes(0)
        self._files = [str(path)]
        self._control = Control(machine, self._note, self._file, shortest=shortest)
        self._reader = BlockReader(rotary, self._note)
        self._stack: list[Activation] = []
        self._flow = {
            **Flow(self._note).handlers,
            "RET": self._return,
            "MCALL": self._mcall,
            "EXTCALL": self._extcall,
            "CALL": self._extcall,
        }

    def run(self) -> Run:
        """Execute the program."""
        main = Text(self._path)
        try:
            self._stack.append(Activation(main, 0, Variables()))
            self._execute()
        except End:
            pass
        finally:
            main.close()
            for text, _ in self._texts.values():
                text.close()
        self._control.settle()
        return self._result()

    def _note(self, text: str, severity: Severity) -> None:
        if len(self._findings) >= MOST_FINDINGS:
            self._more += 1
            return
        file = self._files[self._file.now]
        self._findings.append(Finding(self._control.line, text, severity, file))

    # The loop

    def _execute(self) -> None:
        control = self._control
        while self._stack:
            call = self._stack[-1]
            text = call.text
            if not text.fill():
                self._leave()
                continue
            if self._may_be_plain(text):
                self._scan(call)
                if not text.fill():
                    continue
            line = text.line
            control.line, control.block_number = line, -1
            raw = text.next_line()
            self._count(1 + len(raw) // LONG)
            self._line(call, line, raw)
            self._keep_events()

    def _count(self, blocks: int) -> None:
        """Count executed blocks. Going once through each file is free."""
        self._steps += blocks
        if self._steps <= self._limit:
            return
        main = self._stack[0].text
        texts = [text for text, _ in self._texts.values()]
        allowed = self._limit + (main.lines if main.whole else main.line) + sum(text.lines for text in texts)
        allowed += sum(text.size // LONG for text in (main, *texts))
        if self._steps > allowed:
            raise self._endless(f"executes more than {self._limit} blocks")

    def _keep(self, texts: int, characters: int) -> None:
        """Count comments and events, which are kept. What each file says once is free."""
        self._kept += texts + characters // LONG
        if self._kept <= self._limit:
            return
        files = (self._stack[0].text, *(text for text, _ in self._texts.values()))
        if self._kept > self._limit + sum(text.size for text in files):
            raise self._endless(f"makes more than {self._limit} comments and events")

    def _keep_events(self) -> None:
        new = self._control.events[self._events :]
        if new:
            self._events += len(new)
            self._keep(len(new), sum(len(event.value) for event in new if isinstance(event.value, str | tuple)))

    def _endless(self, what: str) -> InputError:
        return self._stack[-1].text.problem(self._control.line, f"the program {what}", "does it end?")

    def _may_be_plain(self, text: Text) -> bool:
        call = self._stack[-1]
        if not self._control.absolute or call.modal is not None:
            return False
        begin = text.buffer[text.position : text.position + _LOOK].tobytes()
        return _PLAIN.match(begin) is not None

    def _scan(self, call: Activation) -> None:
        """Let the kernel take plain blocks."""
        control, text = self._control, call.text
        columns = control.columns
        while text.fill():
            if columns.capacity - columns.n < _LEAST_ROOM:
                # A little more than there will be if the program goes on as it began, once it is known how it does.
                begun = columns.n > _ROOM // 2
                columns.reserve(_ROOM, int(1.02 * text.expected(columns.n)) if begun else 0)
            control.before_scan(text.position, text.line)
            scan.scan(
                text.buffer,
                len(text.buffer),
                control.table,
                control.tips,
                control.lengths,
                control.feeds,
                control.default_way,
                control.map,
                control.turn,
                control.counts,
                control.place,
                control.target(),
                control.notes,
            )
            control.after_scan()
            self._take_comments(text, control.notes.comments[: control.counts[scan.COMMENTS]])
            line = int(control.counts[scan.LINE])
            taken = line - text.line
            size = int(control.counts[scan.POSITION]) - text.position
            text.position, text.line = int(control.counts[scan.POSITION]), line
            control.line = line
            self._count(taken + max(size - LONG * taken, 0) // LONG)
            if text.position < len(text.buffer) and not control.full:
                return

    def _take_comments(self, text: Text, table: Ints) -> None:
        file = self._file.now
        self._keep(len(table), int((table[:, 3] - table[:, 2]).sum()))
        for line, row, start, end in table.tolist():
            words = decode(text.buffer[start:end].tobytes()).strip("\r")
            self._comments.append(Comment(line, row, words, file))

    def _line(self, call: Activation, line: int, raw: str) -> None:
        """Execute a line that is not plain."""
        control = self._control
        raw = raw.rstrip("\r")
        words, comment = split_comment(raw)
        stripped = words.strip()
        if not stripped or stripped.startswith("%"):
            self._comment(line, comment)
            return
        if len(words) > LONGEST:
            self._note(f"the block is longer than {LONGEST} characters: it is not executed", Severity.ERROR)
            return
        tokens = tokenize(words)
        at = 0
        if stripped.startswith("/"):
            if self._skip:
                self._comment(line, comment)
                return
            at = 1
            level = tokens[1] if len(tokens) > 1 else None
            if (
                level is not None
                and level.sort is Sort.NUMBER
                and len(level.text) == 1
                and level.start == tokens[0].end
            ):
                at = 2
        if len(tokens) > at + 1 and tokens[at].text == "N" and tokens[at + 1].text.isdigit():
            number = tokens[at + 1].value
            control.block_number = int(number) if number < 1e15 else -1
            at += 2
        while len(tokens) > at + 1 and tokens[at].sort is Sort.NAME and tokens[at + 1].text == ":":
            at += 2
        try:
            if at < len(tokens):
                self._statement(call, line, tokens, at)
        finally:
            self._comment(line, comment)

    def _comment(self, line: int, comment: str | None) -> None:
        if comment is not None:
            self._keep(1, len(comment))
            self._comments.append(Comment(line, self._control.row, comment, self._file.now))

    def _statement(self, call: Activation, line: int, tokens: tuple[Token, ...], at: int) -> None:
        first = tokens[at]
        flow = self._flow.get(first.text) if first.sort is Sort.NAME else None
        if flow is None:
            self._block(call, self._reader.read(tokens, at, call.variables))
            return
        reader = Reader(tokens, call.variables, at + 1)
        try:
            flow(reader, call, line)
        except ExpressionError as error:
            self._note(f"not understood: {first.text}: {error}", Severity.ERROR)

    # Words

    def _block(self, call: Activation, block: Block) -> None:
        """Carry out the words of a block, in the order in which the control does."""
        control = self._control
        machine_frame = "SUPA" in block.words
        silent = False
        dwell = False
        for code in block.g:
            machine_frame |= code in G_MACHINE
            silent |= code in G_NO_MOTION
            dwell |= code == 4
            self._g(code)
        frame = [word for word in block.words if word in FRAMES]
        for word in block.words:
            self._word(word, block)
        if dwell:
            self._dwell(block)
            return
        if block.feed is not None:
            control.place[3] = block.feed * control.feeds
        if block.speed is not None:
            control.rpm.set(control.row, abs(block.speed))
            control.event("speed", abs(block.speed))
        if block.tool is not None:
            control.choose(block.tool)
        if block.edge is not None:
            control.set_edge(block.edge)
        late = [code for code in block.m if code in M_LATE]
        for code in block.m:
            if code not in late:
                self._m(code)
        for value in block.h:
            control.event("h", value)
        calls = block.calls
        if frame:
            self._frame(frame, block)
        elif silent:
            pass
        elif block.axes or block.vector or (block.params and control.kind > LINEAR):
            if {"I", "J", "K"} & block.params.keys() and control.kind <= LINEAR:
                self._note("I, J and K have no meaning for a straight line", Severity.WARNING)
            if block.vector and not control.tips:
                self._note("A3= B3= C3= need TRAORI: the vector is taken as the tool axis", Severity.WARNING)
            control.move(
                block.axes,
                block.vector,
                block.params,
                machine_frame=machine_frame,
                feed_written=block.feed is not None,
            )
            calls = [*([call.modal] if call.modal else []), *calls]
        for made in calls:
            if made.name in _BUILT_IN:
                self._call(made)
        for code in late:
            self._m(code)
        self._enter_one([made for made in calls if made.name not in _BUILT_IN])

    def _g(self, code: int) -> None:
        control = self._control
        if code in (RAPID, LINEAR, CLOCKWISE, COUNTER):
            control.kind = code
        elif code in G_PLANES:
            control.plane = "XYZ".index(G_PLANES[code])
        elif code in G_UNITS:
            control.set_units(*G_UNITS[code])
        elif code in (90, 91):
            control.absolute = code == 90
        elif code in G_FEEDS:
            control.feed_mode.set(control.row, G_FEEDS[code])
        elif code in G_OFFSETS:
            control.set_offset(code)
        elif code in G_NAMED:
            text, grave = G_NAMED[code]
            self._note(f"G{code}: {text}", Severity.ERROR if grave else Severity.WARNING)
            if code in (33, 63, 331, 332):
                control.kind = LINEAR
        elif code not in G_SILENT and code not in G_MACHINE and code != 4:
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
                control.settle()
                control.set_machine_vectors(word == "ORIMKS")
            case "SPOS":
                control.event("spindle", "oriented")
            case _:
                # Frames come after this, SUPA before; the rest drives, and leaves the path alone.
                assert word in FRAMES or word in SILENT or word == "SUPA" or word.startswith("ORI")

    def _dwell(self, block: Block) -> None:
        if block.feed is not None:
            self._control.event("dwell", block.feed)
        elif block.speed is not None:
            self._control.event("dwell", -block.speed)
        else:
            self._note("G4 without a time", Severity.WARNING)
        if block.axes:
            self._note("axis words beside G4 are not executed", Severity.ERROR)

    def _m(self, code: int) -> None:
        control = self._control
        if code in M_SPINDLE:
            control.spindle.set(control.row, M_SPINDLE[code])
        if code in M_EVENTS:
            control.event(*M_EVENTS[code])
        elif code == M_CHANGE:
            control.change_tool()
        elif code in M_ENDS:
            control.event("end", f"M{code}")
            raise End
        elif code == M_RETURN:
            self._leave()
        else:
            control.event("m", float(code))

    def _frame(self, words: list[str], block: Block) -> None:
        control = self._control
        if len(words) > 1:
            self._note("several frame words in one block: the last one counts", Severity.ERROR)
        word = words[-1]
        adds = word.startswith("A")
        base = word.removeprefix("A")
        values: dict[str, float] = {}
        for name, (value, _) in {**block.axes, **block.params}.items():
            if abs(value) * control.lengths > FARTHEST:
                self._note(f"{word}: {name} is larger than any machine: the frame is not used", Severity.ERROR)
                return
            if name in ("X", "Y", "Z"):
                values[name] = value * control.lengths if base == "TRANS" else value
            elif name == "RPL":
                values[name] = value
            else:
                self._note(f"{word}: {name} is not simulated", Severity.ERROR)
        frame = statement(base, values, control.plane)
        control.set_program_frame(control.program_frame.then(frame) if adds else frame)

    # Cycles and calls

    def _call(self, made: Call) -> None:
        """Carry out a cycle or a message."""
        control = self._control
        name = made.name
        if name in cycles.CYCLES:
            self._drill(made)
        elif name == "CYCLE832":
            values = tuple(
                text if text in CONSTANTS else value for text, value in zip(made.written, made.arguments, strict=True)
            )
            control.event("cycle832", values)
        elif name == "CYCLE800":
            self._swivel(made)
        elif name == "MSG":
            first = made.arguments[0] if made.arguments else ""
            control.event("message", first if isinstance(first, str) else f"{first or 0:g}")
        else:
            assert name == "SETAL"
            control.event("message", f"SETAL({', '.join(made.written)})")

    def _enter_one(self, calls: Sequence[Call]) -> None:
        """Call the subprogram of a block, which goes on only after all that the block says."""
        if len(calls) > 1:
            self._note("several subprograms in one block: only the first is executed", Severity.ERROR)
        for made in calls[:1]:
            self._enter(made.name, made)

    def _drill(self, made: Call) -> None:
        control = self._control
        try:
            numbers = [cycles.sane(self._plain_number(value)) for value in made.arguments]
            steps = cycles.steps(made.name, numbers, float(control.rpm.now))
        except cycles.CycleError as error:
            self._note(f"{made.name} {error}: it is not executed", Severity.ERROR)
            return
        self._count(len(steps))
        control.drill(steps)

    @staticmethod
    def _plain_number(value: Value | None) -> float | None:
        if isinstance(value, str):
            raise cycles.CycleError("has a text where a number must stand")
        return value

    def _swivel(self, made: Call) -> None:
        control = self._control
        control.event("cycle800", ",".join(made.written))
        texts = [value if isinstance(value, str) else None for value in made.arguments]
        if not made.arguments or (len(texts) > 1 and texts[1] == "0"):
            control.unswivel()
            return
        if len(made.arguments) > 16:
            self._note(f"CYCLE800 takes 16 values, not {len(made.arguments)}", Severity.ERROR)
            return
        numbers = [value if isinstance(value, float) else 0.0 for value in made.arguments]
        numbers += [0.0] * (16 - len(numbers))
        retract, _, style, mode = numbers[:4]
        before, angles, after, direction = numbers[4:7], numbers[7:10], numbers[10:13], numbers[13]
        if any(abs(value) > 1e7 for value in numbers):
            self._note("CYCLE800 with numbers that no machine has: it is not executed", Severity.ERROR)
            return
        if retract:
            self._note(f"CYCLE800 retracts first (_FR {retract:g}): where to is not simulated", Severity.WARNING)
        origin = control.lengths * np.array(before)
        offset = control.lengths * np.array(after)
        linear = np.eye(3)
        direct = None
        axes = cycles.rotations(int(mode))
        if int(mode) >> 6 == 3:
            direct = angles[0], angles[1]
            # Values come in the order of the machine's axes as written in the swivel data: first, second.
        elif axes is None:
            self._note(f"CYCLE800 with _MODE {mode:g} is not simulated", Severity.ERROR)
            return
        else:
            for axis, angle in zip(axes, angles, strict=True):
                linear = linear @ turn(axis, angle)
        frame = Frame(linear, origin)
        if direct is None:
            frame = frame.then(Frame(np.eye(3), offset))
        control.swivel(frame, add=int(style) % 10 == 1, direction=direction, direct=direct)
        if direct is not None and offset.any():
            self._note("CYCLE800 with direct angles: the offset after turning is not simulated", Severity.ERROR)

    def _enter(self, name: str, made: Call) -> None:
        """Call a subprogram that lies beside the program."""
        path = self._folder.find(name)
        if path is None:
            self._note(f"unknown word or missing subprogram {name[:80]}: it is not executed", Severity.ERROR)
            return
        if made.repeats < 1:
            return
        if len(self._stack) >= DEEPEST_CALL:
            raise self._stack[-1].text.problem(
                self._control.line, f"calls subprograms deeper than {DEEPEST_CALL} levels", "does one call itself?"
            )
        variables = Variables(self._stack[-1].variables)
        self._stack.append(self._activation(path, variables, made.repeats))
        self._bind(made)

    def _activation(self, path: Path, variables: Variables, repeats: int) -> Activation:
        if path not in self._texts:
            if len(self._texts) >= MOST_FILES:
                raise self._endless(f"calls more than {MOST_FILES} subprograms")
            self._files.append(str(path))
            self._texts[path] = Text(path, whole=True), len(self._files) - 1
        text, file = self._texts[path]
        # The same file may be active more than once: each activation has its own place in it.
        self._file.set(self._control.row, file)
        return Activation(text.again(), file, variables, repeats)

    def _bind(self, made: Call) -> None:
        """Hand arguments to the PROC line, which reads them when it is executed."""
        self._stack[-1].variables.hand(made.arguments)

    def _leave(self) -> None:
        """End of a subprogram, or of the program."""
        call = self._stack[-1]
        call.repeats -= 1
        if call.repeats > 0:
            call.text.jump(1)
            self._count(1)
            return
        self._stack.pop()
        if not self._stack:
            raise End
        self._file.set(self._control.row, self._stack[-1].file)
        self._control.line = self._stack[-1].text.line - 1

    def _return(self, reader: Reader, call: Activation, line: int) -> None:
        self._leave()

    def _mcall(self, reader: Reader, call: Activation, line: int) -> None:
        token = reader.token
        if token is None:
            call.modal = None
            return
        if token.sort is Sort.LETTER and token.text == "L":
            reader.at += 1
            number = reader.token
            if number is None or not number.text.isdigit():
                raise ExpressionError("a subprogram has a number")
            call.modal = Call(f"L{number.text}")
            return
        if token.sort is not Sort.NAME:
            raise ExpressionError("a name must follow")
        reader.at += 1
        call.modal = read_call(reader, token.text)

    def _extcall(self, reader: Reader, call: Activation, line: int) -> None:
        inside = reader.takes("(")
        value = reader.value()
        if inside:
            reader.expect(")")
        if not isinstance(value, str):
            raise ExpressionError("takes the name of a program")
        self._enter(value, Call(value))

    # The end

    def _result(self) -> Run:
        control = self._control
        c = control.columns
        c.clear()
        n = c.n
        findings = list(self._findings)
        if self._more:
            findings.append(Finding(0, f"and {self._more} findings more", Severity.ERROR, self._files[0]))
        return Run(
            machine=self._machine,
            files=tuple(self._files),
            blocks=c.blocks.ramps(),
            numbers=c.numbers.ramps(),
            kind=c.kind[:n],
            programmed=c.programmed[:n],
            place=c.place[:n],
            rotary=c.rotary[:n],
            state=State(
                file=self._file.steps(n, np.uint16),
                feed=control.feed.steps(n, np.float64),
                feed_mode=control.feed_mode.steps(n, np.uint8),
                rpm=control.rpm.steps(n, np.float64),
                spindle=control.spindle.steps(n, np.int8),
                tool=control.tool.steps(n, np.int32),
                edge=control.edge.steps(n, np.int32),
                offset=control.offset.steps(n, np.uint16),
                tcp=control.tcp_rows.steps(n, np.bool_),
                machine_frame=control.machine_rows.steps(n, np.bool_),
                inches=control.inch_rows.steps(n, np.bool_),
                orientation=control.orientation.steps(n, np.uint8),
                by_tip=control.by_tip.steps(n, np.bool_),
            ),
            start=control.start,
            arcs=control.finish_arcs(),
            tools=tuple(control.tools),
            comments=self._comments,
            events=control.events,
            findings=tuple(findings),
        )
