"""Canned cycles and rigid tapping of LinuxCNC, block by block."""

from pathlib import Path

import numpy as np

from trunnion.errors import Severity
from trunnion.machines import Machine
from trunnion.messages import Wording
from trunnion.model.spindle_work import SpindleTask, SpindleWork
from trunnion.model.toolpath import Kind
from trunnion.readers.control.axis_word import AxisWord
from trunnion.readers.control.coordinates import INCH
from trunnion.readers.control.hole_motion import HoleMotion
from trunnion.readers.families.linuxcnc import cycles, words
from trunnion.readers.families.linuxcnc.offsets_and_frames import OffsetInterpreter
from trunnion.readers.program.options import DEFAULT_OPTIONS, RunOptions
from trunnion.readers.rs274.block import Block, g_code_text
from trunnion.readers.rs274.expressions import BlockError

#: More holes of one block are mistakes of the program.
_MAX_HOLES = 10_000


class CycleInterpreter(OffsetInterpreter):
    """Keeps what holds from block to block: words of the cycles, the height before them, and the last dwell."""

    def __init__(self, path: Path, machine: Machine, options: RunOptions = DEFAULT_OPTIONS) -> None:
        super().__init__(path, machine, options)
        self._to_initial = False
        self._initial: float | None = None
        self._last_dwell = 0.0

    # Rigid tapping

    def _rigid_tap(self, block: Block, axes: dict[str, AxisWord]) -> None:
        """G33.1: in by the pitch K per revolution, and back to the start, I times as fast."""
        control = self.control
        pitch, factor = block.take("K"), block.take("I")
        if pitch is None:
            raise BlockError(Wording("NC210", "g33_1_no_k"))
        if not pitch > 0.0:
            raise BlockError(Wording("NC210", "g33_1_k_not_positive"))
        if "F" in block.words:
            raise BlockError(Wording("NC210", "g33_1_takes_no_f"))
        if not control.modal.spindle.current or not control.modal.rpm.current > 0.0:
            raise BlockError(Wording("NC210", "spindle_does_not_turn_g33"))
        self._report_rotary_words(axes, of_thread=True)
        start = control.programmed_position / control.length_unit
        end = start.copy()
        for axis, name in enumerate("XYZ"):
            if name in axes:
                end[axis] = axes[name][0] if control.absolute else start[axis] + axes[name][0]
        length = float(np.linalg.norm(end - start)) * control.length_unit
        feed = self._feed_of_pitch(pitch * control.length_unit, length)
        u, v = (control.plane_axis + 1) % 3, (control.plane_axis + 2) % 3
        lateral = float(end[u] - start[u]), float(end[v] - start[v])
        self._counter.count_motions(2)
        control.drill(
            [
                HoleMotion(False, float(end[control.plane_axis]), feed, lateral=lateral),
                HoleMotion(False, float(start[control.plane_axis]), feed * (factor or 1.0)),
            ],
            SpindleWork(SpindleTask.TAP, pitch * control.length_unit),
        )

    def _feed_of_pitch(self, pitch: float, length: float) -> float:
        """Return F in the present feed mode for a motion of a length with a pitch, both mm."""
        modal = self.control.modal
        if modal.feed_mode.current == 95:
            return pitch
        rate = pitch * modal.rpm.current
        return rate / max(length, 1e-9) if self._inverse_time else rate

    # Cycles

    def _drill_block(self, code: int, block: Block, axes: dict[str, AxisWord]) -> None:
        """Drill at the positions of a block."""
        along = "XYZ"[self.control.plane_axis]
        self._report_rotary_words(axes)
        for letter in block.unused():
            if code not in cycles.OWN_WORDS.get(letter, (code,)):
                raise BlockError(Wording("NC213", "unused_word", word=letter))
        given = {letter: value for letter in cycles.MODAL_WORDS if (value := block.take(letter)) is not None}
        given |= {"Z": axes[along][0]} if along in axes else {}
        begins = code != self.motion_code
        self.motion_code = code
        if given.get("P", 0.0) < 0.0:
            raise BlockError(Wording("NC215", "negative_dwell"))
        self._last_dwell = given.get("P", self._last_dwell)
        kept = ({"P": self._last_dwell} if code in words.TAPS else {}) if begins else self._modal_words
        self._require_words(kept | given)
        self._modal_words = kept | given
        repeats = block.take("L")
        clearance = block.take("D")
        holes = 1 if repeats is None else int(repeats)
        if not 1 <= holes <= _MAX_HOLES or repeats not in (None, holes):
            raise BlockError(Wording("NC210", "repeats_l"))
        if self._inverse_time:
            raise BlockError(Wording("NC210", "cycle_cannot_inverse_time"))
        self._check_cycle_feed()
        work = cycles.spindle_work(code)
        if work is not None and work.hand and self.control.modal.spindle.current == -work.hand:
            self._note(Wording("NC370", "thread_of_other_hand", word=g_code_text(code)), Severity.ERROR)
        own = {} if clearance is None else {"D": clearance}
        if own:
            self.control.add_event("cycle_value", f"D {clearance:g}")
        hole, height = self._hole(dict(self._modal_words) | own)
        self._drill(axes, hole, height, holes)

    def _hole(self, words: dict[str, float]) -> tuple[cycles.Hole, float]:
        """Return the values of the cycle and the present height; moves up to the retract plane from below it."""
        control, unit = self.control, self.control.length_unit
        height = float(control.programmed_position[control.plane_axis]) / unit
        if self._initial is None:
            self._initial = height * unit
        initial = self._initial / unit
        self._rely_on_end_of_cycles()
        retract, bottom = words["R"], words["Z"]
        if not control.absolute:
            retract += initial
            bottom += retract
            if "K" in words:
                words["K"] += bottom
        if retract < bottom:
            raise BlockError(Wording("NC210", "r_cycle_lies_below_depth"))
        if initial < retract:
            self._counter.count_motions(1)
            control.drill([HoleMotion(True, retract)])
            initial = height = retract
        clear = initial if self._to_initial else retract
        return cycles.Hole(retract, bottom, clear, cycles.CLEARANCE * INCH / unit, words), height

    def _drill(self, axes: dict[str, AxisWord], hole: cycles.Hole, height: float, holes: int) -> None:
        """Drill several times from a height, at one place, or with G91 at places that are ever further on."""
        control, unit = self.control, self.control.length_unit
        along = control.plane_axis
        motions = self._cycle_motions(lambda: cycles.cycle_motions(self.motion_code, hole))
        place = control.programmed_position.copy()
        bits = 0
        for count in range(holes):
            for axis, name in enumerate("XYZ"):
                if axis != along and name in axes:
                    value = axes[name][0] * unit
                    place[axis] = value if control.absolute else place[axis] + value
                    bits |= 1 << axis
            above = height if count == 0 and height > hole.retract else hole.clear
            self._counter.count_motions(len(motions) + 2)
            place[along] = above * unit
            if not control.add_row(Kind.RAPID, place, bits=bits):
                return
            work = cycles.spindle_work(self.motion_code)
            control.drill([HoleMotion(True, hole.retract), *motions] if above > hole.retract else motions, work)
