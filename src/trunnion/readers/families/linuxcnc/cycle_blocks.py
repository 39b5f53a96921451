"""Canned cycles and threads of LinuxCNC, as their words come block by block."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from trunnion.errors import Severity
from trunnion.machines import Machine
from trunnion.model.toolpath import Kind
from trunnion.readers.control.axis_word import AxisWord
from trunnion.readers.control.hole_motion import CycleExecutionError, HoleMotion
from trunnion.readers.families.linuxcnc import cycles
from trunnion.readers.families.linuxcnc.offsets_and_frames import OffsetInterpreter
from trunnion.readers.program.interpreter import DEFAULT_STEP_LIMIT
from trunnion.readers.rs274.block import Block
from trunnion.readers.rs274.expressions import BlockError


class CycleInterpreter(OffsetInterpreter):
    """Keeps what cycles keep from block to block: their words, the height before them, the dwell of a cycle before."""

    def __init__(
        self,
        path: Path,
        machine: Machine,
        *,
        subprograms: Sequence[Path] = (),
        step_limit: int = DEFAULT_STEP_LIMIT,
        skip: bool = False,
        shortest: bool | None = None,
    ) -> None:
        super().__init__(path, machine, subprograms=subprograms, step_limit=step_limit, skip=skip, shortest=shortest)
        self._to_initial = False
        self._initial: float | None = None
        self._modal_words: dict[str, float] = {}
        self._waited = 0.0

    def _tap(self, block: Block, axes: dict[str, AxisWord]) -> None:
        """G33.1: in by the pitch K a turn, and back to where it began, I times as fast."""
        control = self._control
        pitch, faster = block.take("K"), block.take("I")
        if pitch is None:
            raise BlockError("G33.1 has no K")
        if "F" in block.words:
            raise BlockError("G33.1 takes no F")
        if not control.spindle.current or not control.rpm.current > 0.0:
            raise BlockError("the spindle does not turn, and G33.1 follows it")
        if set(axes) - set("XYZ"):
            self._note("rotary words in a thread: they are not executed", Severity.ERROR)
        start = control.commanded[:3] / control.length_unit
        end = start.copy()
        for axis, name in enumerate("XYZ"):
            if name in axes:
                end[axis] = axes[name][0] if control.absolute else start[axis] + axes[name][0]
        feed = self._by_pitch(
            abs(pitch) * control.length_unit, float(np.linalg.norm(end - start)) * control.length_unit
        )
        first, second = (control.plane_axis + 1) % 3, (control.plane_axis + 2) % 3
        lateral = float(end[first] - start[first]), float(end[second] - start[second])
        self._count_blocks(2)
        control.drill(
            [
                HoleMotion(False, float(end[control.plane_axis]), feed, lateral=lateral),
                HoleMotion(False, float(start[control.plane_axis]), feed * (faster or 1.0)),
            ]
        )

    def _by_pitch(self, pitch: float, length: float) -> float:
        """F, as it counts now, of a motion of so many mm with so many mm a turn of the spindle."""
        control = self._control
        if control.feed_mode.current == 95:
            return pitch
        rate = pitch * control.rpm.current
        return rate / max(length, 1e-9) if control.feed_mode.current == 93 else rate

    def _cycle(self, code: int, block: Block, axes: dict[str, AxisWord]) -> None:
        """Drill at the positions of a block."""
        control = self._control
        if set(axes) - set("XYZ"):
            self._note("rotary words in a cycle: they are not executed", Severity.ERROR)
        words = {letter: value for letter in cycles.MODAL_WORDS if (value := block.take(letter)) is not None}
        words |= {"Z": axes["XYZ"[control.plane_axis]][0]} if "XYZ"[control.plane_axis] in axes else {}
        fresh = code != self.motion
        self.motion = code
        self._waited = words.get("P", self._waited)
        held = ({"P": self._waited} if code in cycles.KEEP_P else {}) if fresh else self._modal_words
        needed = "ZR" + "Q" * (code in cycles.NEED_Q) + "P" * (code in cycles.NEED_P)
        missing = [letter for letter in needed if letter not in words and letter not in held]
        if missing:
            raise BlockError(f"the cycle has no {missing[0]}")
        self._modal_words = held | words
        repeats = block.take("L")
        d = block.take("D")
        times = 1 if repeats is None else int(repeats)
        if not 1 <= times <= 10_000:
            raise BlockError("L of a cycle is how often it drills")
        self._check_cycle()
        self._drill(code, axes, dict(self._modal_words) | ({"D": d} if d is not None else {}), times)

    def _check_cycle(self) -> None:
        control = self._control
        if control.feed_mode.current == 93:
            raise BlockError("a cycle cannot be in inverse time")
        if not control.commanded[3] > 0.0:
            self._note("a cycle without a feed", Severity.ERROR)

    def _drill(self, code: int, axes: dict[str, AxisWord], words: dict[str, float], times: int) -> None:
        """Drill so many times: at one place, or with G91 at places ever further on."""
        control = self._control
        normal = control.plane_axis
        scale = control.length_unit
        height = float(control.commanded[normal]) / scale
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
            self._count_blocks(1)
            control.drill([HoleMotion(True, retract)])
            old = height = retract
        hole = cycles.Hole(
            retract, bottom, old if self._to_initial else retract, cycles.CLEARANCE * 25.4 / scale, words
        )
        made = self._motions(code, hole)
        place = control.commanded[:3].copy()
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
            self._count_blocks(len(made) + 2)
            place[normal] = first * scale
            if not control.add_row(Kind.RAPID, place, bits, still, 0, None):
                return
            control.drill([HoleMotion(True, retract), *made] if first > retract else made)

    @staticmethod
    def _motions(code: int, hole: cycles.Hole) -> list[HoleMotion]:
        try:
            return cycles.cycle_motions(code, hole)
        except CycleExecutionError as error:
            raise BlockError(f"the cycle {error}") from None
