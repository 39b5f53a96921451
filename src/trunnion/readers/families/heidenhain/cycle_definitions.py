"""CYCL DEF blocks: cycles that act at once, and cycles that a later block calls."""

import math
import re
from dataclasses import replace
from typing import Final

from trunnion.errors import Severity
from trunnion.messages import Wording
from trunnion.model.spindle_work import SpindleWork
from trunnion.readers.control.event_recorder import Note
from trunnion.readers.control.hole_motion import CycleExecutionError, HoleMotion
from trunnion.readers.control.row_recorder import MAX_POSITION
from trunnion.readers.families.heidenhain import plane_datums
from trunnion.readers.families.heidenhain.control import HeidenhainControl
from trunnion.readers.families.heidenhain.cycle_values import Cycle, check_given, check_title, last_value
from trunnion.readers.families.heidenhain.cycles import (
    CYCLES,
    LEGACY_CYCLES,
    MAY_BE_RAPID,
    cycle_motions,
    legacy_cycle_motions,
    legacy_spindle_work,
    spindle_work,
)
from trunnion.readers.families.heidenhain.cylinder_contours import labels_of
from trunnion.readers.families.heidenhain.lexer import Word, words
from trunnion.readers.families.heidenhain.parameters import KlartextError, Parameters, canonical
from trunnion.readers.families.heidenhain.path_blocks import value_of
from trunnion.readers.families.heidenhain.patterns import WITH_PATTERNS, Pattern, pattern_of
from trunnion.readers.families.heidenhain.plane_blocks import store_rotary_angles
from trunnion.readers.families.heidenhain.plane_control import Positioning
from trunnion.readers.families.heidenhain.plane_frames import spatial
from trunnion.readers.families.heidenhain.unusual_pecks import unusual_values
from trunnion.readers.families.heidenhain.words import (
    ACT_WHEN_DEFINED,
    AXIS_SCALING,
    BORE_MILLING,
    CONTOUR,
    CYCLE_LINES,
    CYCLE_OPTIONS,
    CYCLE_PARAMETERS,
    CYCLES_NOT_SIMULATED,
    DATUM,
    DWELL,
    MIRROR,
    ON_CYLINDER,
    ORIENTATION,
    PATTERNS,
    PRESET,
    ROTATION,
    SCALING,
    TILT,
    TOLERANCE,
    TOLERANCE_WORDS,
)
from trunnion.readers.program.word_values import GREATEST_TURN, Values, orientation_fault

_NUMBER = re.compile(r"[ \t]*([0-9]{1,4})(?:\.([0-9]{1,2}))?(?![0-9.])")
_ASSIGNED = re.compile(
    r"[ \t]*(Q[0-9]{1,4})[ \t]*=[ \t]*(?:([+-]?)[ \t]*(?:(Q[LR]?[0-9]{1,4})|([0-9]+[.,]?[0-9]*|[.,][0-9]+))|([A-Z]+))"
)

#: Words of cycle 19 by which some machines turn the axes.
_TURNS: Final = ("F", "ABST", "DIST")

#: Rapid as a feed of a cycle.
_RAPID: Final = ("MAX", "FMAX")

#: Other scales are mistakes of the program.
_MIN_SCALE: Final = 1e-6
_MAX_SCALE: Final = 1e6


class Definitions:
    """Executes CYCL DEF blocks.

    defined_cycle   the cycle that CYCL CALL executes
    pattern         what the last block has defined to be executed at once
    contour_labels  the labels of the last contour (cycle 14)
    """

    def __init__(self, control: HeidenhainControl, note: Note) -> None:
        self._control = control
        self._note = note
        self.defined_cycle: Cycle | None = None
        self.pattern: Pattern | None = None
        self.contour_labels: tuple[str, ...] = ()
        # Number of the older cycle whose lines are being read, and the last of them.
        self._open: tuple[int, int] | None = None

    @property
    def is_open(self) -> bool:
        """Whether the last block was a line of an older cycle, on which another may follow."""
        return self._open is not None

    def end_lines(self) -> None:
        """Another block follows: no line can follow on those of an older cycle; its title alone defines nothing."""
        if self._open is not None and self._open[1] == 0:
            number = self._open[0]
            self._note(Wording("NC210", "title_without_line", number=number), Severity.ERROR)
        self._open = None

    def define(self, text: str, parameters: Parameters) -> None:
        """Execute a block; ``text`` is what follows CYCL DEF."""
        self.pattern = None
        match = _NUMBER.match(text)
        if match is None:
            raise KlartextError(Wording("NC210", "cycle_number"))
        number, rest = int(match[1]), text[match.end() :].strip()
        if match[2] is None:
            self.end_lines()
            self._define_with_parameters(number, rest, parameters)
            return
        line = int(match[2])
        if line == 0:
            self.end_lines()
            self._open = number, 0
            self._begin_definition(number, rest)
            return
        before, self._open = self._open, (number, line)
        if before != (number, line - 1):
            raise KlartextError(Wording("NC210", "line_out_of_order", line=line, number=number, before=line - 1))
        self._continue_definition(number, line, rest, parameters)

    def _begin_definition(self, number: int, title: str) -> None:
        """Execute the first line of an older cycle: its title."""
        check_title(number, title)
        if number in LEGACY_CYCLES or number in CYCLES_NOT_SIMULATED:
            self.defined_cycle = Cycle(number)
        elif number not in _IMMEDIATE:
            self._note(Wording("NC211", "cycle_unknown", number=number, title=title[:40]), Severity.ERROR)

    def _continue_definition(self, number: int, line: int, rest: str, parameters: Parameters) -> None:
        if number in CYCLES_NOT_SIMULATED:
            return
        if number in LEGACY_CYCLES:
            name = CYCLE_LINES[number].get(line)
            if self.defined_cycle is None or self.defined_cycle.number != number or name is None:
                raise KlartextError(Wording("NC210", "stray_line", number=number))
            self.defined_cycle.values[name] = last_value(rest, parameters)
            return
        control = self._control
        match number:
            case 7:
                self._shift(rest, parameters)
            case 8:
                self._mirror(words(rest))
            case 9:
                control.add_event("dwell", last_value(rest, parameters))
            case 10:
                self._rotate(words(rest), parameters)
            case 11 | 26:
                self._scale(words(rest), parameters)
            case 14:
                self.contour_labels = labels_of(rest)
            case 13:
                last_value(rest, parameters)
                control.add_event("spindle", "oriented")
            case 19:
                control.judge_within_compensation("cycle 19")
                self._tilt(words(rest), parameters)
            case 32:
                if line == 1:
                    control.judge_within_compensation("cycle 32")
                self._tolerance(line, words(rest), parameters)
                control.add_event("cycle32", rest)
            case _:
                self._note(Wording("NC211", "line_cycle_unknown", number=number), Severity.ERROR)

    # Cycles that act at once

    def _shift(self, rest: str, parameters: Parameters) -> None:
        if rest.startswith("#"):
            self._note(Wording("NC222", "cycle_7_takes_datum_table"), Severity.ERROR)
            return
        shift = list(self._control.datum.shift)
        values = _axis_values(words(rest), parameters, "XYZ")
        for word, value in values:
            axis = "XYZ".index(word.name)
            value *= self._control.length_unit
            shift[axis] = shift[axis] + value if word.incremental else value
        if any(abs(value) > MAX_POSITION for value in shift):
            raise KlartextError(Wording("NC215", "shift_no_machine"))
        datum = replace(self._control.datum, shift=(shift[0], shift[1], shift[2]))
        parts = {plane_datums.SHIFTS["XYZ".index(word.name)] for word, _ in values}
        self._control.set_datum(datum, parts, incremental=any(word.incremental for word, _ in values))

    def _mirror(self, block_words: list[Word]) -> None:
        names = [word.name for word in block_words]
        if any(word.name not in ("X", "Y", "Z") or word.operand is not None for word in block_words):
            raise KlartextError(Wording("NC210", "only_x_y_z_mirrored"))
        mirrored = ("X" in names, "Y" in names, "Z" in names)
        self._control.set_datum(replace(self._control.datum, mirrored=mirrored), {plane_datums.MIRROR})

    def _rotate(self, block_words: list[Word], parameters: Parameters) -> None:
        angle = self._control.datum.angle
        incremental = any(word.incremental for word in block_words)
        for word in block_words:
            if word.name != "ROT" or word.operand is None:
                raise KlartextError(Wording("NC211", "unknown_word", word=word.name))
            value = value_of(word.operand, parameters)
            angle = angle + value if word.incremental else value
        self._control.set_datum(
            replace(self._control.datum, angle=angle), {plane_datums.ROTATION}, incremental=incremental
        )

    def _scale(self, block_words: list[Word], parameters: Parameters) -> None:
        scale, centre = [1.0, 1.0, 1.0], [0.0, 0.0, 0.0]
        for word in block_words:
            if word.operand is None:
                raise KlartextError(Wording("NC210", "word_needs_value", word=word.name))
            value = value_of(word.operand, parameters)
            if word.name in ("CCX", "CCY", "CCZ"):
                centre["XYZ".index(word.name[2])] = value * self._control.length_unit
                continue
            if not _MIN_SCALE < value < _MAX_SCALE:
                raise KlartextError(Wording("NC215", "bad_scale", value=value))
            if word.name == "SCL":
                scale = [value, value, value]
            elif word.name in ("X", "Y", "Z"):
                scale["XYZ".index(word.name)] = value
            else:
                raise KlartextError(Wording("NC211", "unknown_word", word=word.name))
        datum = replace(
            self._control.datum, scale=(scale[0], scale[1], scale[2]), centre=(centre[0], centre[1], centre[2])
        )
        self._control.set_datum(datum, {plane_datums.SCALE})

    def _tolerance(self, line: int, block_words: list[Word], parameters: Parameters) -> None:
        """Cycle 32: the tolerance T of its first line; without one the machine's own holds again."""
        values: dict[str, float] = {}
        for word in block_words:
            known = TOLERANCE_WORDS.get((line, word.name))
            value = None if word.operand is None else value_of(word.operand, parameters)
            if known is None or value is None:
                raise KlartextError(Wording("NC211", "unknown_word_line_cycle_32", word=word.name, line=line))
            if value < 0.0 or (isinstance(known, Values) and value not in known):
                raise KlartextError(
                    Wording("NC215", "line_cycle_32_control_does", word=word.name, value=value, line=line)
                )
            if word.name == "TA" and value > GREATEST_TURN:
                raise KlartextError(orientation_fault(f"CYCL DEF 32.{line} TA", value))
            values[word.name] = value
        if line == 1 or "HSC-MODE" in values:
            self._control.say_mode("HSC-MODE", f"{values['HSC-MODE']:g}" if "HSC-MODE" in values else "not given")
        if line == 1:
            self._control.add_tolerance(values.get("T", 0.0) * self._control.length_unit)
        self._control.add_orientation_tolerance(values.get("TA", 0.0))

    def _tilt(self, block_words: list[Word], parameters: Parameters) -> None:
        """Cycle 19: tilt by spatial angles, without a motion; that the angles are spatial ones is unconfirmed."""
        if turns := tuple(word.name for word in block_words if word.name in _TURNS):
            self._note(Wording("NC221", "cycle_19_turns", words=turns), Severity.WARNING)
        block_words = [word for word in block_words if word.name not in _TURNS]
        if not block_words:
            self._control.untilt(Positioning())
            return
        angles = {word.name: value for word, value in _axis_values(block_words, parameters, "ABC")}
        linear = spatial(*(angles.get(name, 0.0) for name in "ABC"))
        store_rotary_angles(parameters, self._control, self._control.tilt(linear, Positioning()))

    # Cycles with Q parameters

    def _define_with_parameters(self, number: int, rest: str, parameters: Parameters) -> None:
        """Define a cycle of the 200 series; its values become those of the Q parameters."""
        begin = re.search(r"(?:^|[ \t])Q[0-9]{1,4}[ \t]*=", rest)
        title, rest = (rest, "") if begin is None else (rest[: begin.start()], rest[begin.start() :])
        check_title(number, title)
        q_values = self._read_parameters(number, rest, parameters)
        own = (*CYCLE_PARAMETERS.get(number, q_values), *CYCLE_OPTIONS.get(number, ()))
        if foreign := tuple(f"Q{each}" for each in q_values if each not in own):
            self._note(Wording("NC221", "foreign_parameters", names=foreign, number=number), Severity.WARNING)
        if number in CYCLES or number in ON_CYLINDER or number in CYCLES_NOT_SIMULATED:
            if number in ACT_WHEN_DEFINED:
                self._note(
                    Wording("NC220", "cycle_not_simulated", number=number, cycle=CYCLES_NOT_SIMULATED[number]),
                    Severity.ERROR,
                )
                return
            self.defined_cycle = Cycle(number, q_values=q_values)
            if number == BORE_MILLING:
                self._note(Wording("NC221", "cycle_208_tool_radius_control"), Severity.WARNING)
        elif number in PATTERNS:
            self._pattern(number, q_values)
        elif number == PRESET:
            self._preset(q_values)
        else:
            self._note(Wording("NC211", "cycle_unknown", number=number, title=title[:40].strip()), Severity.ERROR)

    def _read_parameters(self, number: int, rest: str, parameters: Parameters) -> dict[int, float]:
        """Assign the Q parameters of a definition; returns them by number."""
        q_values: dict[int, float] = {}
        at = 0
        while at < len(rest.rstrip()):
            match = _ASSIGNED.match(rest, at)
            if match is None:
                raise KlartextError(Wording("NC210", "not_parameter_cycle", rest=rest[at : at + 20].strip()))
            at = match.end()
            target, sign, parameter, figures, word = match.groups()
            if int(target[1:]) in q_values:
                raise KlartextError(Wording("NC210", "parameter_of_cycle_twice", parameter=target, number=number))
            if word in _RAPID and int(target[1:]) in MAY_BE_RAPID:
                q_values[int(target[1:])] = math.inf
                parameters.forget(canonical(target))
                continue
            if word is not None:
                self._note(
                    Wording("NC220", "cycle_word_not_simulated", number=number, target=target, word=word),
                    Severity.ERROR,
                )
                continue
            value = parameters[canonical(parameter)] if parameter else float(figures.replace(",", "."))
            value = -value if sign == "-" else value
            parameters[canonical(target)] = value
            q_values[int(target[1:])] = value
        return q_values

    def _preset(self, q_values: dict[int, float]) -> None:
        try:
            check_given(PRESET, q_values)
        except CycleExecutionError as error:
            raise KlartextError(error.wording.within("of_cycle")) from None
        preset = q_values[339]
        if preset != int(preset) or not 0 <= preset < 65535:
            raise KlartextError(Wording("NC215", "preset_does_not_exist", preset=preset))
        self._control.note_preset(int(preset))
        self._control.set_offset(int(preset), f"preset {preset:g}")

    def _pattern(self, number: int, q_values: dict[int, float]) -> None:
        """Define a pattern, which is executed at once; the cycle before has its clearances and surface from then on."""
        cycle = self.defined_cycle
        try:
            pattern = pattern_of(number, q_values)
            if cycle is None:
                raise CycleExecutionError(Wording("NC380", "called_before_any_defined"))
            if cycle.number not in WITH_PATTERNS:
                raise CycleExecutionError(Wording("NC380", "not_with_patterns", number=cycle.number))
        except CycleExecutionError as error:
            raise KlartextError(error.wording.within("of_cycle")) from None
        cycle.q_values |= pattern.values
        self.pattern = pattern

    # Calls

    def spindle_work(self) -> SpindleWork | None:
        """Return how the defined cycle drives the spindle; None: it turns as programmed."""
        cycle, unit = self.defined_cycle, self._control.length_unit
        if cycle is None:
            return None
        if cycle.number in LEGACY_CYCLES:
            return legacy_spindle_work(cycle.number, cycle.values, unit)
        return spindle_work(cycle.number, cycle.q_values, unit)

    def call(self, parameters: Parameters) -> list[HoleMotion]:
        """Return the motions of the defined cycle at the present position.

        Raises ``CycleExecutionError`` if no cycle is defined, or if it is not simulated or impossible.
        """
        cycle, control = self.defined_cycle, self._control
        if cycle is None:
            raise CycleExecutionError(Wording("NC380", "called_before_any_defined"))
        if cycle.number in CYCLES_NOT_SIMULATED:
            raise CycleExecutionError(
                Wording(
                    "NC220", "cycle_known_not_simulated", number=cycle.number, cycle=CYCLES_NOT_SIMULATED[cycle.number]
                )
            )
        # A pitch counts in the unit of lengths, a feed in that of feeds.
        rpm = float(control.modal.rpm.current) * control.length_unit / control.feed_unit
        cycle.take_values(parameters)
        if cycle.number in LEGACY_CYCLES:
            here = float(control.programmed_position[control.plane_axis]) / control.length_unit
            motions = legacy_cycle_motions(cycle.number, cycle.values, rpm, here)
        else:
            motions = cycle_motions(cycle.number, cycle.q_values, rpm)
            for value in unusual_values(cycle.number, cycle.q_values, control.length_unit):
                control.add_event("cycle_value", value)
        if control.feed_unit == 1.0:
            return motions
        return [
            motion if motion.feed is None else replace(motion, feed=motion.feed * control.feed_unit)
            for motion in motions
        ]


#: Older cycles that act as soon as they are defined.
_IMMEDIATE: Final = frozenset({
    DATUM, MIRROR, DWELL, ROTATION, SCALING, CONTOUR, AXIS_SCALING, ORIENTATION, TILT, TOLERANCE
})  # fmt: skip


def _axis_values(block_words: list[Word], parameters: Parameters, names: str) -> list[tuple[Word, float]]:
    """Return the words of axes with their values; no others may be there."""
    for word in block_words:
        if word.operand is None or word.name not in names:
            raise KlartextError(Wording("NC211", "unknown_word", word=word.name or word.text))
    return [(word, value_of(word.operand, parameters)) for word in block_words if word.operand is not None]
