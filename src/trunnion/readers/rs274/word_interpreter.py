"""The part of interpreters that executes blocks by the table of a control's words."""

import math
from collections.abc import Callable, Collection, Sequence
from pathlib import Path
from typing import Final, TypeVar

from trunnion.errors import Severity
from trunnion.machines import Machine
from trunnion.messages import Wording
from trunnion.model.mode_words import END_OF_CYCLES
from trunnion.readers.control.hole_motion import CycleExecutionError, HoleMotion
from trunnion.readers.control.start_modes import MOTION
from trunnion.readers.program.modal_groups import same_group
from trunnion.readers.program.options import DEFAULT_OPTIONS, RunOptions
from trunnion.readers.program.word_values import fault_of_value
from trunnion.readers.rs274.block import Block, read_block
from trunnion.readers.rs274.expressions import BlockError, ExpressionReader
from trunnion.readers.rs274.interpreter import MOTIONS, ActiveProgram, Rs274Interpreter
from trunnion.readers.rs274.word_table import Effect, When, Word, WordTable

#: How a word that is not simulated is reported.
_NOT_SIMULATED: Final = {Effect.WARNING: (Severity.WARNING, "NC221"), Effect.ERROR: (Severity.ERROR, "NC220")}

A = TypeVar("A", bound=ActiveProgram)


class WordInterpreter(Rs274Interpreter[A]):
    """Executes the words of a block in the order of ``_execute_words``, each as the table has it.

    A control is a table, and methods for what only it does: those that its table names, and those for the places in
    that order at which it does more.
    """

    #: The words of the control.
    table: WordTable

    #: Whether M codes that the table does not have are words of the machine builder; else they are unknown.
    has_builders_words = True

    #: Letters that make words of corners behind a comma.
    corner_letters: tuple[str, ...] = ()

    #: Signs that are letters of words.
    signs: tuple[str, ...] = ()

    def __init__(self, path: Path, machine: Machine, options: RunOptions = DEFAULT_OPTIONS) -> None:
        super().__init__(path, machine, options)
        self._acts: dict[str, Callable[[Word, Block], None]] = {
            act: getattr(self, f"_{act}") for act in self.table.acts
        }
        # Whether cycles end at the height where the first one began; words of cycles that hold until they end.
        self._to_initial, self._end_is_said = True, False
        self._modal_words: dict[str, float] = {}

    # Blocks

    def _takes_positions(self, codes: Sequence[str]) -> bool:
        meanings = self.control.own_words.g
        numbers = [self.table.code(code) for code in codes if code[0] == "G" and code[1:2].isdigit()]
        own = [meaning for code in numbers if (meaning := meanings.get(code, code)) is not None]
        words = self.table.words("G", own)
        return any(word.is_motion or not word.moves or word.when is When.BEHIND_MODES for word in words)

    def _read_block(self, reader: ExpressionReader) -> Block:
        """Read the words of a block as those of the family."""
        block = read_block(reader, self._report_repeated_word, self.corner_letters, self.signs)
        for word in self.control.own_words.translate(block):
            self._note(Wording("NC211", "unknown_own_word", word=word), Severity.ERROR)
        self._check_groups(block)
        return block

    def _check_groups(self, block: Block) -> None:
        """Report two G codes of a block that set one mode."""
        if len(block.g) < 2:
            return
        for fault in same_group(block.g, self.table.groups["G"], lambda code: self.table.words("G", [code])[0].text):
            self._note(fault, Severity.ERROR)

    def _execute_words(self, block: Block) -> None:
        """Execute a block: units and feed modes, F and S, T, M codes, G codes, the motion, and M codes behind it."""
        g, m = self.table.words("G", block.g), self.table.words("M", block.m)
        self._judge_within_compensation((*g, *m), block)
        self._scale_words(block)
        self._feed_and_speed(block)
        self._call_tool(block)
        late = self._late_words(m)
        for word in m:
            if word not in late:
                self._report_values((word,), block)
                self._execute_word(word, block)
        self._execute_g_words(g, block)
        for word in g:
            if word.when is When.AFTER_MOTION:
                self._execute_word(word, block)
        self._close_block(block)
        for word in late:
            self._execute_word(word, block)

    def _judge_within_compensation(self, codes: Sequence[Word], block: Block) -> None:
        """Report words that the control does not take while radius compensation is on, unless their block ends it."""
        if not self.control.modal.compensation.current or any(word.text == "G40" for word in codes):
            return
        for word in codes:
            verdict = self.table.within_compensation(word)
            if verdict and self._changes_something(word, block):
                self.control.judge_within_compensation(word.text, verdict)

    def _changes_something(self, word: Word, block: Block) -> bool:
        """Whether a word sets another plane or mode than the one in force."""
        control = self.control
        match word.act:
            case "plane":
                return bool(control.plane_axis != word.sets)
            case "cancel_rotation" | "end_plane":
                return control.tilted
            case "compensation" | "compensation_in_space":
                return bool(word.sets)
            case "tcp":
                return bool(word.sets) or control.tcp
            case _:
                return True

    def _scale_words(self, block: Block) -> None:
        """Execute the G codes before F and S, which they may scale."""
        words = [word for word in self.table.words("G", block.g) if word.when is When.BEFORE_FEED]
        self._report_values(words, block)
        for word in words:
            self._execute_word(word, block)

    def _call_tool(self, block: Block) -> None:
        tool = block.take("T")
        if tool is not None:
            if tool < 0.0 or tool != int(tool):
                raise BlockError(Wording("NC215", "no_number_of_tool", tool=tool))
            self.control.select_tool(f"{tool:.15g}")

    def _late_words(self, codes: Sequence[Word]) -> Sequence[Word]:
        """Return the M codes that act after the motion of their block."""
        return [word for word in codes if word.when is When.AFTER_MOTION]

    def _execute_g_words(self, codes: Sequence[Word], block: Block) -> None:
        """Execute modes, the word that may take the axis words in place of the motion, and the motion."""
        self._report_values([word for word in codes if word.when is not When.BEFORE_FEED], block)
        behind: Word | None = None
        for word in codes:
            if word.when is When.BEFORE_MOTION:
                self._execute_word(word, block)
            elif word.when is When.BEHIND_MODES:
                if behind is not None and not behind.moves and not word.moves:
                    raise BlockError(Wording("NC210", "two_g_words_want_words"))
                behind = word
        self._before_motion(codes, block)
        if behind is not None:
            self._execute_behind_modes(behind, codes, block)
        if all(word.moves or word.when is When.BEHIND_MODES for word in codes) and (behind is None or behind.moves):
            self._execute_motion(codes, block)
        else:
            self._pass_motion(codes)

    def _before_motion(self, codes: Sequence[Word], block: Block) -> None:
        """Act between the modes of a block and its motion."""

    def _execute_behind_modes(self, word: Word, codes: Sequence[Word], block: Block) -> None:
        """Execute the word of a block that acts behind its modes."""
        self._execute_word(word, block)

    def _execute_motion(self, codes: Sequence[Word], block: Block) -> None:
        """Execute the motion or the cycle in force; ``codes`` are the G codes of the block."""

    def _pass_motion(self, codes: Sequence[Word]) -> None:
        """Pass over the motion of a block whose axis words are none."""

    def _close_block(self, block: Block) -> None:
        """Act behind the motion of a block."""
        self._report_unused_words(block)

    # Words

    def _execute_word(self, word: Word, block: Block) -> None:
        for letter in word.letters:
            block.take(letter)
        text = word.text if word.code >= 0 else self.control.own_words.own_text(word.code)
        if word.effect in _NOT_SIMULATED:
            severity, code = _NOT_SIMULATED[word.effect]
            self._note(Wording(word.problem or code, "not_simulated", word=text, does=word.does), severity)
        elif word.effect is Effect.UNKNOWN:
            self._execute_unknown(word)
        if word.mode:
            said = text if word.group else " ".join((text, *_letters(word, block)))
            self.control.say_mode(word.mode, "" if word.shows else said)
        if word.is_motion or word.act == "cancel":
            self.control.said_from.setdefault(MOTION, self.control.row)
        if word.act:
            self._acts[word.act](word, block)

    def _execute_unknown(self, word: Word) -> None:
        if word.text[0] == "M" and self.has_builders_words:
            self.control.add_builders_word("M", float(word.code))
        else:
            self._note(Wording("NC211", "unknown_own_word", word=word.text), Severity.ERROR)

    def _report_values(self, words: Sequence[Word], block: Block) -> None:
        """Report letters with values that a word cannot have."""
        for word in dict.fromkeys(words):
            for letter, known in word.values.items():
                if letter in block.words and (
                    fault := fault_of_value(word.text, letter, block.words[letter].value, known)
                ):
                    self._note(fault, Severity.ERROR)

    def _motion(self, word: Word, block: Block) -> None:
        self._select_motion(word.code)

    _cycle = _motion
    _cancel = _motion

    def _line(self, word: Word, block: Block) -> None:
        """Take a motion as straight lines."""
        self._select_motion(10)

    def _select_motion(self, code: int) -> None:
        """Select a motion or a cycle by its G code, or end the cycle: the motion before it is in force again."""
        cycles = self.table.cycles
        if code in cycles:
            if self.motion_code not in cycles:
                self._modal_words = {}
            self.motion_code = code
        else:
            self.motion_code = code if code in MOTIONS else 10 * self.control.motion
            self.control.motion = MOTIONS[self.motion_code]

    def _plane(self, word: Word, block: Block) -> None:
        control = self.control
        control.set_mode("plane", word.text, control.plane_axis, word.sets)
        control.plane_axis = word.sets

    def _units(self, word: Word, block: Block) -> None:
        control = self.control
        control.set_mode("units", word.text, bool(control.modal.inches.current), word.sets)
        control.set_units(word.sets, True)

    def _distances(self, word: Word, block: Block) -> None:
        self.control.set_mode("distances", word.text, self.control.absolute, word.sets)
        self.control.absolute = word.sets

    def _feed_mode(self, word: Word, block: Block) -> None:
        control = self.control
        control.set_mode("feed", word.text, control.modal.feed_mode.current, word.sets)
        control.modal.feed_mode.set(control.row, word.sets)

    def _surface_speed(self, word: Word, block: Block) -> None:
        self.control.modal.feed_mode.set(self.control.row, 95)

    def _compensation(self, word: Word, block: Block) -> None:
        control = self.control
        side = control.modal.compensation
        control.set_mode("compensation", word.text, side.current, word.sets)
        side.set(control.row, word.sets)
        control.compensates_in_space = False
        stated = block.words["D"].value if word.text in ("G41.1", "G42.1") and "D" in block.words else math.nan
        control.modal.stated_radius.set(control.row, 0.5 * stated * control.length_unit)
        if word.text in ("G41", "G42"):
            self._begin_compensation(block)

    def _compensation_in_space(self, word: Word, block: Block) -> None:
        self._compensation(word, block)
        self.control.compensates_in_space = True

    def _begin_compensation(self, block: Block) -> None:
        """Note the register D of G41 and G42; without one, the radius is that of the tool."""
        number = block.words["D"].value if "D" in block.words else -1.0
        self.control.modal.radius.set(self.control.row, int(number) if abs(number) < 1e6 else 0)

    def _dwell(self, word: Word, block: Block) -> None:
        """Wait for the seconds of a letter; ``word.sets`` is how it is written."""
        seconds = block.take(word.letters)
        if seconds is None:
            self._note(Wording("NC218", "no_time", word=word.text, written=word.sets), Severity.ERROR)
        elif seconds < 0.0:
            raise BlockError(Wording("NC215", "negative_dwell"))
        else:
            self.control.add_event("dwell", seconds)

    def _unasked(self, word: Word, block: Block) -> None:
        self.control.add_event("unasked", word.text)

    def _tcp(self, word: Word, block: Block) -> None:
        self.control.set_tcp(word.sets)

    def _end_of_cycles(self, word: Word, block: Block) -> None:
        self._to_initial, self._end_is_said = word.sets, True

    def _rely_on_end_of_cycles(self) -> None:
        """Note that a cycle ends as it was said, or as the control starts: it counts from the first cycle on."""
        if self._end_is_said:
            self.control.say_mode(END_OF_CYCLES)
        else:
            self.control.relied_from.setdefault(END_OF_CYCLES, self.control.row)

    def _iso(self, word: Word, block: Block) -> None:
        self._say_letters(word, block)
        self._common_m_code(word.code)

    def _say_letters(self, word: Word, block: Block) -> None:
        """Record the letters of a word whose event does not show them."""
        if word.letters:
            self.control.say_mode(word.text, " ".join(_letters(word, block)))

    # Cycles

    def _report_rotary_words(self, axes: Collection[str], *, of_thread: bool = False) -> None:
        if set(axes) - set("XYZ"):
            variant = "rotary_words_of_thread" if of_thread else "rotary_words_of_cycle"
            self._note(Wording("NC213", variant), Severity.ERROR)

    def _require_words(self, words: Collection[str]) -> None:
        """Refuse the cycle in force if it lacks one of the words that it needs."""
        for letter in self.table.cycles[self.motion_code].needs:
            if letter not in words:
                raise BlockError(Wording("NC210", "cycle_no", letter=letter))

    def _may_be_left_on(self) -> list[str]:
        return [self.table.cycles[self.motion_code].text] if self.motion_code in self.table.cycles else []

    def _check_cycle_feed(self) -> None:
        if not self.control.programmed_feed > 0.0:
            self._note(Wording("NC240", "cycle_without_feed"), Severity.ERROR)

    @staticmethod
    def _cycle_motions(motions: Callable[[], list[HoleMotion]]) -> list[HoleMotion]:
        """Return the motions of a cycle at a hole; BlockError if it cannot be executed."""
        try:
            return motions()
        except CycleExecutionError as error:
            raise BlockError(error.wording.within("of_cycle")) from None


def _letters(word: Word, block: Block) -> list[str]:
    """Return the letters of a word in a block, with their values."""
    return [f"{letter}{block.words[letter].value:g}" for letter in word.letters if letter in block.words]
