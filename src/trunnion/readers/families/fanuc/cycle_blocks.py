"""Canned cycles of a Fanuc, block by block."""

import math
from collections.abc import Collection, Sequence
from pathlib import Path
from typing import Final

from trunnion.errors import Severity
from trunnion.machines import Machine
from trunnion.messages import Wording
from trunnion.model.run import Diagnostic
from trunnion.readers.control.axis_word import AxisWord, PositionMode
from trunnion.readers.control.virtual_control import RAPID
from trunnion.readers.families.fanuc import cycles, words
from trunnion.readers.families.fanuc.offsets_and_frames import OffsetInterpreter
from trunnion.readers.program.options import DEFAULT_OPTIONS, RunOptions
from trunnion.readers.rs274.block import Block, g_code_text
from trunnion.readers.rs274.expressions import BlockError
from trunnion.readers.rs274.word_table import Word

#: More holes of one block are mistakes of the program.
_MAX_HOLES: Final = 10_000


#: J of a thread on the controls that have it there.
_TIMES_AS_FAST: Final = range(1, 10)


class CycleInterpreter(OffsetInterpreter):
    """Keeps what holds from block to block: the words of the cycles, and the height before them."""

    def __init__(self, path: Path, machine: Machine, options: RunOptions = DEFAULT_OPTIONS) -> None:
        super().__init__(path, machine, options)
        self._initial: float | None = None
        # What was reported of the cycle in force, which has no words yet.
        self._waiting: Diagnostic | None = None
        # What has stopped the spindle besides M5, if the program has not started it since; else empty.
        self._spindle_stands: Wording | None = None
        # The control turns the spindle in threads, whatever turned it before.
        self._thread_turns = False
        # Axes whose positions must be stated in a new plane before the tool cuts there.
        self._not_stated: frozenset[str] = frozenset()

    def _select_motion(self, code: int) -> None:
        control = self.control
        if code in words.THREADS:
            self._spindle_stands = None  # the cycle turns it
        elif self.motion_code in words.THREADS:
            self._thread_turns = False
            stands = Wording("NC370", "thread_stopped_spindle")
            self._spindle_stands = stands if control.settings.threads_stop_spindle else None
        super()._select_motion(code)
        if code not in self.table.cycles:
            self._initial = None
            self._waiting = None
        elif self._initial is None:
            self._initial = float(control.programmed_position[control.plane_axis])

    def _stop_for_thread(self, word: Word, block: Block) -> None:
        if self.motion_code not in words.THREADS:
            self._spindle_stands = Wording("NC370", "word_stopped_spindle", word=word.text)
        self._thread_turns = True
        self._execute_unknown(word)

    def _drill_block(self, block: Block, axes: dict[str, AxisWord]) -> None:
        """Drill at the position of a block; those without one and without R and Z drill nothing, and no word stays."""
        control = self.control
        along = "XYZ"[control.plane_axis]
        self._check_words(block)
        letter = control.settings.repeat_letter
        if not axes and "R" not in block.words:
            if self.motion_code in block.g:
                self._select_without_words(block.take(letter))
            return
        self._take_cycle_words(block, axes)
        repeats = block.take(letter)
        if "L" in block.words and block.words["L"].value == 1.0:
            block.take("L")
        self._report_rotary_words(axes)
        self._require_words(self._modal_words)
        holes = 1 if repeats is None else int(repeats)
        if not 0 <= holes <= _MAX_HOLES or repeats not in (None, holes):
            raise BlockError(Wording("NC210", "repeats_of_cycle", letter=letter))
        if letter == "L" and holes > 1 and control.absolute:
            raise BlockError(Wording("NC210", "l_repeats_cycle_g91_only"))
        self._withdraw_waiting()
        in_plane = {name: word for name, word in axes.items() if name in "XYZ" and name != along}
        self._drill_at([in_plane] * holes)

    def _take_cycle_words(self, block: Block, axes: dict[str, AxisWord]) -> None:
        """Take the words of a cycle, which hold until it ends."""
        without = "ZP" if words.takes_number(block) else "Z"
        given = {
            letter: value
            for letter in cycles.MODAL_WORDS
            if letter not in without and (value := block.take(letter)) is not None
        }
        if (along := "XYZ"[self.control.plane_axis]) in axes:
            given["Z"] = axes[along][0]
        if self.motion_code in cycles.PECKS and self.motion_code in block.g:
            self._modal_words.pop("P", None)  # the dwell of another cycle
        self._modal_words |= given
        self._warn_of_shift(given)

    def _drill_at(self, places: Sequence[dict[str, AxisWord]]) -> None:
        """Execute the cycle in force at places, by the words that lead there."""
        control = self.control
        if self._inverse_time:
            raise BlockError(Wording("NC210", "cycle_cannot_inverse_time"))
        self._check_cycle_feed()
        hole = self._hole()
        if hole.bottom > hole.retract and control.plane_axis == 2 and self.motion_code != cycles.BACK_BORE:
            raise BlockError(Wording("NC210", "r_cycle_lies_below_depth"))
        motions = self._cycle_motions(lambda: cycles.cycle_motions(self.motion_code, hole))
        work = cycles.spindle_work(self.motion_code, hole.peck * control.length_unit)
        turned = self._thread_turns or control.settings.threads_stop_spindle
        if work is not None and work.hand and not turned and control.modal.spindle.current == -work.hand:
            self._note(Wording("NC370", "thread_of_other_hand", word=g_code_text(self.motion_code)), Severity.ERROR)
        motion = control.motion
        for place in places:
            self._counter.count_motions(len(motions) + 1)
            control.motion = RAPID
            control.move(place, None)
            control.drill(motions, work)
        control.motion = motion

    def _bolt_holes(self, word: Word, block: Block) -> None:
        """Execute the cycle in force, or that of the block, at holes of a circle or an arc.

        Their centre is where the block positions the tool, or where the tool is.

        Facts: G71 of a Haas at helmancnc.com/g71-bolt-hole-arc-cnc-mill-programming, which describes G70 with it.
        """
        name = self.control.settings.words.own_text(word.code)
        if self.motion_code not in self.table.cycles:
            raise BlockError(Wording("NC210", "holes_without_cycle", word=name))
        values = {letter: block.take(letter) for letter in word.letters}
        axes = self._axis_words(block)
        self._check_dwell(block)
        self._take_cycle_words(block, axes)
        self._report_rotary_words(axes)
        self._require_words(self._modal_words)
        if missing := tuple(letter for letter, value in values.items() if value is None):
            raise BlockError(Wording("NC210", "holes_without_words", word=name, missing=missing))
        radius, begin, count = (values[letter] or 0.0 for letter in "IJL")
        if not 1.0 <= count <= _MAX_HOLES or count != int(count):
            raise BlockError(Wording("NC210", "repeats_of_cycle", letter="L"))
        if radius <= 0.0:
            raise BlockError(Wording("NC210", "radius_of_holes", word=name, value=radius))
        step = values.get("K") or 0.0 if "K" in values else 360.0 / count
        if not step:
            raise BlockError(Wording("NC210", "holes_in_one_place", word=name))
        control = self.control
        along = "XYZ"[control.plane_axis]
        if in_plane := {name: word for name, word in axes.items() if name in "XYZ" and name != along}:
            motion, control.motion = control.motion, RAPID
            control.move(in_plane, None)
            control.motion = motion
        u, v = (control.plane_axis + 1) % 3, (control.plane_axis + 2) % 3
        centre = control.programmed_position / control.length_unit
        places: list[dict[str, AxisWord]] = []
        for k in range(int(count)):
            angle = math.radians(begin + k * step)
            offsets = ((u, radius * math.cos(angle)), (v, radius * math.sin(angle)))
            places.append({"XYZ"[a]: (float(centre[a]) + d, PositionMode.ABSOLUTE) for a, d in offsets})
        self._withdraw_waiting()
        self._drill_at(places)

    def _select_without_words(self, repeats: float | None) -> None:
        """Report a cycle that has no words yet, until a block brings them.

        Where L repeats, the block that selects a cycle drills at once, where the tool is, except with L0.
        """
        if self._modal_words or self._waiting is not None:
            return
        noted = len(self._diagnostics)
        self._note(Wording("NC218", "cycle_without_position_and_depth"), Severity.ERROR)
        at_once = self.control.settings.repeat_letter == "L" and repeats != 0.0
        if not at_once and len(self._diagnostics) > noted:
            self._waiting = self._diagnostics[-1]

    def _withdraw_waiting(self) -> None:
        """Withdraw what was reported of a cycle without words: they have come before it drilled."""
        if self._waiting is not None:
            self._diagnostics.remove(self._waiting)
            self._waiting = None

    def _check_cut(self, axes: Collection[str], *, of_machine: bool) -> None:
        """Report a cut that a thread has left without a spindle, or that a new plane has left without a position."""
        if self.control.length_ended_at and "Z" in axes and not of_machine:
            word, line = self.control.length_ended_by, self.control.length_ended_at
            self._note(Wording("NC361", "length_taken_off", word=word, line=line), Severity.ERROR)
            self.control.length_ended_at = 0
        if self._not_stated and not of_machine:
            if self.motion_code != 0:
                missing = ", ".join(sorted(self._not_stated))
                self._note(Wording("NC351", "cuts_new_plane_before_stated", missing=missing), Severity.ERROR)
                self._not_stated = frozenset()
            self._not_stated -= set(axes)
        if self._spindle_stands and self.motion_code not in (0, *words.THREADS):
            self._note(self._spindle_stands, Severity.ERROR)
            self._spindle_stands = None

    def _check_words(self, block: Block) -> None:
        """Refuse words that describe pecks and retracts on some controls, and dwells whose unit is in doubt."""
        self._check_pecks(block)
        self._check_dwell(block)

    def _check_pecks(self, block: Block) -> None:
        settings = self.control.settings
        others = "" if self.motion_code in cycles.SHIFTED else "IJ"
        if settings.repeat_letter == "L":
            others = "K" if self.motion_code == cycles.FINE_BORE else "IJK"
            others = "IK" if self._leaves_thread_faster(block) else others
        if found := [letter for letter in others if letter in block.words]:
            raise BlockError(Wording("NC220", "peck_word_not_simulated", word=found[0]))

    def _leaves_thread_faster(self, block: Block) -> bool:
        """Whether J of a thread says how many times as fast as it was cut it is left, spindle and feed alike."""
        times = block.words.get("J")
        return self.motion_code in words.THREADS and times is not None and times.value in _TIMES_AS_FAST

    def _check_dwell(self, block: Block) -> None:
        settings = self.control.settings
        if words.MACHINE in block.g:
            raise BlockError(Wording("NC210", "block_takes_no", block=g_code_text(self.motion_code), word="G53"))
        dwell = block.words.get("P")
        with_p = (*cycles.WITH_P, *(cycles.PECKS if settings.repeat_letter == "L" else ()))
        for letter, codes in (("P", with_p), ("Q", cycles.WITH_Q)):
            written = block.words.get(letter)
            of_offset = letter == "P" and words.takes_number(block)
            if written is not None and written.value and self.motion_code not in codes and not of_offset:
                self._note(Wording("NC213", "unused_word", word=letter), Severity.ERROR)
        if dwell is not None and dwell.value < 0.0 and not words.takes_number(block):
            raise BlockError(Wording("NC215", "negative_dwell"))
        in_doubt = settings.point_is_seconds and dwell is not None and dwell.whole and dwell.value
        if in_doubt and not words.takes_number(block):
            raise BlockError(Wording("NC217", "p_cycle_without_point_no"))
        if not words.takes_number(block):
            settings.check_dwell(block)

    def _warn_of_shift(self, given: dict[str, float]) -> None:
        """Warn of a Q whose sign does not count, and of fine boring that no block gives a shift."""
        if given.get("Q", 0.0) < 0.0:
            self._note(Wording("NC221", "q_without_sign", value=given["Q"]), Severity.WARNING)
        if self.motion_code == cycles.FINE_BORE and not any(self._modal_words.get(letter) for letter in "QIJ"):
            self._note(Wording("NC221", "bore_without_shift"), Severity.WARNING)

    def _hole(self) -> cycles.Hole:
        control, given = self.control, self._modal_words
        assert self._initial is not None
        self._rely_on_end_of_cycles()
        initial = self._initial / control.length_unit
        retract, bottom = given["R"], given["Z"]
        if not control.absolute:
            retract += initial
            bottom += retract
        peck = abs(given.get("Q", 0.0))
        lateral = (peck, 0.0)
        if "I" in given:
            lateral = given["I"], given.get("J", 0.0)
        elif "J" in given:
            lateral = 0.0, given["J"]
        return cycles.Hole(
            retract=retract,
            bottom=bottom,
            initial=initial,
            to_initial=self._to_initial,
            peck=peck,
            lateral=lateral,
            dwell=given.get("P", 0.0) / 1000.0,
            units=1.0 / control.length_unit,
        )
