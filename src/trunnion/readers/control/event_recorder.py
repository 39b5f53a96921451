"""Events between the rows of a run, the tools, and the modal state."""

import math
from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from typing import Final

from trunnion.errors import Severity
from trunnion.messages import Wording
from trunnion.model.mode_words import ModeWord
from trunnion.model.run import EventValue, RunEvent
from trunnion.readers.control.modal_builder import ModalBuilder
from trunnion.readers.control.row_buffer import RowBuffer
from trunnion.wording import format_duration

#: Dwells that are longer, seconds, are told: most are slips of the unit.
_LONG_DWELL: Final = 60.0

#: Values of the event "spindle", and the sense in which it turns then: 0, it stands. A spindle that is oriented or has
#: become an axis stands until the program starts it again.
SPINDLE_SENSES: Final = {"clockwise": 1, "counter-clockwise": -1, "off": 0, "oriented": 0, "axis": 0}

#: What a control does with a word that stands while radius compensation is on: variants of the message NC343.
_VERDICTS: Final = {
    "refused": Severity.ERROR, "suspends": Severity.ERROR, "unconfirmed": Severity.ERROR, "drills": Severity.WARNING
}  # fmt: skip

#: Reports a diagnostic at the block that is being executed.
Note = Callable[[Wording, Severity], None]


class EventRecorder:
    """Records the events of a run; ``line`` is that of the block that is being executed."""

    #: The word that ends radius compensation.
    compensation_off = "G40"

    #: What it does with a drilling cycle while radius compensation is on.
    drills_within_compensation = "drills"

    def __init__(self, note: Note) -> None:
        self.note = note
        self.line = 0
        self.columns = RowBuffer()
        self.modal = ModalBuilder()
        self.events: list[RunEvent] = []
        self.mode_words: list[ModeWord] = []
        self._left_variables: dict[str, RunEvent] = {}
        self._modes_said: dict[str, str] = {}
        self._times_said: Counter[str] = Counter()
        #: The row from which on the program has said a mode.
        self.said_from: dict[str, int] = {}
        #: The row from which on it relies on one that counts only for some blocks, such as those of cycles.
        self.relied_from: dict[str, int] = {}
        self._told_words: set[str] = set()
        self._told_waits: set[tuple[int, int]] = set()
        self.tools: dict[str, int] = {"": 0}
        self._tool_names = [""]
        self._selected_tool = 0
        self._tool_deltas: dict[str, float] = {}
        self._orientation_tolerance = 0.0

    @property
    def row(self) -> int:
        """The row that the next motion becomes."""
        return self.columns.n

    def add_event(self, kind: str, value: EventValue = None) -> None:
        """Record an event before the next row; what happens to the spindle is in the columns too."""
        modal = self.modal
        if kind == "spindle":
            modal.spindle.set(self.row, SPINDLE_SENSES[str(value)])
        if kind == "dwell" and isinstance(value, float):
            self._judge_dwell(value)
        self.events.append(RunEvent(self.line, self.row, kind, value, modal.file.current, bool(modal.tcp.current)))

    def leave_variable(self, name: str, value: float | None) -> None:
        """Record what a variable that outlives the program is set to: the last value is an event at the end."""
        said = f"{name} = {'#0' if value is None else f'{value:.10g}'}"
        file, tcp = self.modal.file.current, bool(self.modal.tcp.current)
        self._left_variables[name] = RunEvent(self.line, self.row, "variable", said, file, tcp)

    @property
    def left_variables(self) -> tuple[RunEvent, ...]:
        """The last value of each variable that outlives the program, behind its last row; at its block."""
        return tuple(replace(event, before_row=self.row) for event in self._left_variables.values())

    def _judge_dwell(self, amount: float) -> None:
        """Note a long dwell: seconds, or turns of the spindle if below zero."""
        rpm = float(self.modal.rpm.current)
        seconds = amount if amount >= 0.0 else -60.0 * amount / rpm if rpm > 0.0 else 0.0
        if seconds > _LONG_DWELL and math.isfinite(seconds):
            self.note_wait(Wording("NC226", "long_dwell", duration=format_duration(seconds)))

    def note_wait(self, wait: Wording, word: str = "") -> None:
        """Note once for each block that the machine waits, or stops, there; ``word``: one that no CL file asks for."""
        if word:
            self.add_event("unasked", word)
        place = self.modal.file.current, self.line
        if place not in self._told_waits:
            self._told_waits.add(place)
            self.note(wait, Severity.WARNING)

    def say_mode(self, mode: str, word: str = "") -> None:
        """Record that the program says a mode, which another may have left otherwise: as in ``ModeWord``."""
        self.said_from.setdefault(mode, self.row)
        if self._modes_said.get(mode) != word:
            self._modes_said[mode] = word
            self.mode_words.append(ModeWord(self.row, mode, word))

    def say_once(self, word: str) -> None:
        """Record a word that acts where it stands, and that no path shows: the mode is how often it has been said."""
        self._times_said[word] += 1
        self.say_mode(word, f"{self._times_said[word]}")

    def add_builders_word(self, letter: str, value: float) -> None:
        """Record an M or H word of the machine's builder, and note the first of each: nobody has said what it does."""
        self.add_event(letter.lower(), value)
        word = f"{letter}{value:g}"
        if word not in self._told_words:
            self._told_words.add(word)
            self.note(Wording("NC225", "word_of_machine", word=word), Severity.WARNING)

    def judge_within_compensation(self, word: str, verdict: str = "refused") -> None:
        """Note a word that stands while radius compensation is on; ``verdict``: what the control does with it."""
        if self.modal.compensation.current:
            self.note(Wording("NC343", verdict, word=word, off=self.compensation_off), _VERDICTS[verdict])

    # Tools

    def select_tool(self, name: str) -> None:
        """Select the tool for the next change."""
        self._selected_tool = self.tools.setdefault(name, len(self.tools))
        if self._selected_tool == len(self._tool_names):
            self._tool_names.append(name)
        self.add_event("tool", name)

    def change_tool(self) -> None:
        """Change to the selected tool."""
        self.modal.tool.set(self.row, self._selected_tool)
        self.add_event("tool_change", self._tool_names[self._selected_tool])

    def add_tolerance(self, tolerance: float) -> None:
        """Record within which tolerance the control may round off the path from now on, mm; 0: none."""
        self.add_event("tolerance", tolerance)

    def add_orientation_tolerance(self, tolerance: float) -> None:
        """Record within which tolerance the control may turn the tool away from now on, degrees; 0: none.

        None in force that stays none is no event: most programs do not speak of it.
        """
        if tolerance or self._orientation_tolerance:
            self._orientation_tolerance = tolerance
            self.add_event("orientation_tolerance", tolerance)

    def add_exact_stop(self, mode: str) -> None:
        """Record how the control goes through the ends of blocks from now on.

        ``on``: it stops at each; ``path``: it never leaves the path, and stops where it must; ``off``: as its settings
        say; ``block``: it stops at the end of this block.
        """
        if mode == "block":
            self.say_once("exact stop in one block")
        self.add_event("exact_stop", mode)

    def add_tool_delta(self, name: str, value: float) -> None:
        """Record that the program adds to the length or the radius of the tool, mm: the path does not show it.

        0 takes back what was added before.
        """
        if not value and not self._tool_deltas.get(name):
            return
        self._tool_deltas[name] = value
        self.add_event("delta", (name, value))
        if not value:
            return
        self.note(Wording("NC360", "tool_delta", word=name, value=value), Severity.WARNING)

    def tool_delta(self, name: str) -> float:
        """Return what a word has added to the tool so far, mm."""
        return self._tool_deltas.get(name, 0.0)

    @property
    def tool_in_spindle(self) -> str:
        """Number or name of the tool in the spindle; empty before the first change."""
        return self._tool_names[self.modal.tool.current]
