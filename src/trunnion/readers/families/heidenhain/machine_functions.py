"""M functions and TOOL CALL of Klartext."""

import math
import re
from typing import Final

from trunnion.errors import Severity
from trunnion.messages import Wording
from trunnion.readers.control.event_recorder import Note
from trunnion.readers.families.heidenhain.control import HeidenhainControl
from trunnion.readers.families.heidenhain.lexer import words
from trunnion.readers.families.heidenhain.parameters import KlartextError, Parameters, canonical
from trunnion.readers.families.heidenhain.path_blocks import MAX_FEED, Block, value_of
from trunnion.readers.families.heidenhain.words import (
    M_AFTER_MOTION,
    M_ALTERING,
    M_ARGUMENTS,
    M_AT_ENDS,
    M_AT_ENDS_OFF,
    M_CALL,
    M_CALL_MODAL,
    M_COOLANTS,
    M_DISPLAY,
    M_EVENTS,
    M_FEED_AT_TIP,
    M_FEED_IN_DEGREES,
    M_MACHINE,
    M_MODES,
    M_NOT_SHORTEST,
    M_NOT_SIMULATED,
    M_PER_MINUTE,
    M_PER_TURN,
    M_POINT_FILTER,
    M_PROGRAM_ENDS,
    M_RETRACT,
    M_SECOND_MACHINE,
    M_SHORTEST,
    M_TCP,
    M_TCP_OFF,
    M_TILTING_AXES,
    M_TOOL_CHANGE,
    M_UNSEEN_MODES,
    M_UNSEEN_ONCE,
    M_VALUES,
    M_WITHOUT_PATH_EFFECT,
    M_WORDS_NOT_SIMULATED,
)
from trunnion.readers.program.coolant_words import coolant_of
from trunnion.readers.program.interpreter import ProgramEnd
from trunnion.readers.program.word_values import fault_of_value

#: M functions that are executed elsewhere, or that the path does not depend on.
_HANDLED_ELSEWHERE: Final = frozenset({M_MACHINE, M_SECOND_MACHINE, M_CALL, *M_EVENTS, *M_WITHOUT_PATH_EFFECT})

#: The axis of the spindle has at least this component of its direction.
_ALONG: Final = 0.9

_TOOL = re.compile(
    r"[ \t]*(?P<kind>CALL|DEF)[ \t]*"
    r'(?:"(?P<name>[^"]*)"|(?P<number>[0-9]+(?:[.,][0-9]+)?)|(?P<parameter>Q[LR]?[0-9]{1,4}))?(?![0-9.,])'
)


class MFunctions:
    """Executes M functions.

    modal_call   M89: every position calls the cycle
    """

    def __init__(self, control: HeidenhainControl, note: Note) -> None:
        self._control = control
        self._note = note
        self.modal_call = False
        # Functions of ``M_MODES`` that are on, by name.
        self._on: frozenset[str] = frozenset()

    def execute_before_motion(self, block: Block) -> None:
        """Execute the M functions of a block that act before its motion."""
        for code, arguments in block.m:
            if code not in M_AFTER_MOTION:
                self._execute(code, arguments)

    def execute_after_motion(self, block: Block) -> None:
        """Execute the M functions of a block that act after its motion; may raise ``ProgramEnd``."""
        for code, arguments in block.m:
            if code in M_AFTER_MOTION:
                self._execute(code, arguments)

    def _execute(self, code: int, arguments: dict[str, float | None]) -> None:
        control = self._control
        for (owner, letter), known in M_VALUES.items():
            given = arguments.get(letter) if owner == code else None
            if given is not None and (fault := fault_of_value(f"M{code}", letter, given, known)):
                self._note(fault, Severity.ERROR)
        self._words_of_function(code, arguments)
        self._note_modes(code, arguments)
        said = " ".join(
            (f"M{code}", *(f"{name}{'' if value is None else f'{value:g}'}" for name, value in arguments.items()))
        )
        if code in M_UNSEEN_MODES:
            control.say_mode(M_UNSEEN_MODES[code], said)
            if code in M_ALTERING:
                control.add_event("unasked", said)
        elif code in M_UNSEEN_ONCE:
            control.say_once(said)
        for kind, value in M_EVENTS.get(code, ()):
            control.add_event(kind, coolant_of(control.machine, code, value) if code in M_COOLANTS else value)
        if code in (M_SHORTEST, M_NOT_SHORTEST):
            control.set_shortest_path(code == M_SHORTEST)
        elif code in (M_TCP, M_TCP_OFF):
            if code == M_TCP or control.tcp:
                control.judge_within_compensation(f"M{code}")
            control.switch_tcp_by("M128", on=code == M_TCP)
            control.spatial_angles_active = False
            control.set_tcp(code == M_TCP)
            if code == M_TCP:
                control.limit_compensating_feed(arguments.get("F"))
                control.say_tool_axis()
        elif code in (M_AT_ENDS, M_AT_ENDS_OFF):
            self._place_at_ends(code, arguments)
        elif code in (M_PER_TURN, M_PER_MINUTE):
            control.modal.feed_mode.set(control.row, 95 if code == M_PER_TURN else 94)
            if code == M_PER_TURN and control.length_unit != 1.0:
                control.note(Wording("NC241", "m136_inches_what_f_counts"), Severity.ERROR)
        elif code in (M_FEED_AT_TIP, M_FEED_IN_DEGREES):
            control.feed_at_tip(code == M_FEED_AT_TIP)
        elif code == M_RETRACT:
            self._retract(arguments)
        elif code == M_TOOL_CHANGE:
            control.add_event("spindle", "off")
            control.fetch_tool()
        elif code == M_CALL_MODAL:
            self.modal_call = True
        elif code in M_PROGRAM_ENDS:
            control.end_program(f"M{code}")
            raise ProgramEnd
        elif code in M_NOT_SIMULATED:
            text, changes_path = M_NOT_SIMULATED[code]
            self._note(
                Wording("NC220" if changes_path else "NC221", "not_simulated", word=f"M{code}", does=text),
                Severity.ERROR if changes_path else Severity.WARNING,
            )
        elif code not in _HANDLED_ELSEWHERE:
            control.add_builders_word("M", float(code))

    def _note_modes(self, code: int, arguments: dict[str, float | None]) -> None:
        """Remember the functions that the next program may begin with, if nothing moves with them in this one."""
        control = self._control
        if code in (M_PER_TURN, M_PER_MINUTE):
            after = 95 if code == M_PER_TURN else 94
            control.set_mode("feed", f"M{code}", control.modal.feed_mode.current, after)
        elif code in M_MODES:
            name = f"M{M_MODES[code]}"
            # M118 and M120 are cancelled by themselves, without words.
            on = code == M_MODES[code] and (code not in M_ARGUMENTS or bool(arguments))
            control.set_mode(name, f"M{code}", name in self._on, on)
            self._on = self._on | {name} if on else self._on - {name}

    def _words_of_function(self, code: int, arguments: dict[str, float | None]) -> None:
        """Execute the words of M functions that change feed, path or tilting axes."""
        control = self._control
        for (owner, letter), text in M_WORDS_NOT_SIMULATED.items():
            if owner == code and letter in arguments:
                self._note(Wording("NC220", "m_not_simulated", code=code, does=text), Severity.ERROR)
        if code == M_POINT_FILTER and (distance := arguments.get("T")) is not None:
            control.add_tolerance(distance * control.length_unit)
        for letter in arguments if code == M_DISPLAY else ():
            if letter not in control.rotary_names:
                self._note(Wording("NC230", "no_rotary_axis", word=f"M{code}", axis=letter), Severity.ERROR)
        if code == M_TILTING_AXES and arguments and arguments.keys() != set(control.rotary_names):
            names = " and ".join(sorted(arguments))
            self._note(Wording("NC220", "m_tilting_alone_not_simulated", code=code, names=names), Severity.ERROR)

    def _place_at_ends(self, code: int, arguments: dict[str, float | None]) -> None:
        """M114 and M115; a position of axes that the control does not drive (M114 B+45) is not simulated."""
        control = self._control
        if not control.has_m114:
            self._note(Wording("NC220", "m114_unknown", word=f"M{code}"), Severity.ERROR)
            return
        if arguments:
            self._note(Wording("NC220", "m114_position", names=tuple(sorted(arguments))), Severity.ERROR)
        if code == M_AT_ENDS or control.at_ends:
            control.judge_within_compensation(f"M{code}")
        control.set_at_ends(code == M_AT_ENDS)

    def _retract(self, arguments: dict[str, float | None]) -> None:
        control = self._control
        distance = arguments.get("MB")
        if distance is None and "MAX" not in arguments:
            raise KlartextError(Wording("NC210", "m140_needs_mb_how_far"))
        feed = arguments.get("F")
        control.retract(
            math.inf if distance is None else distance * control.length_unit,
            rapid=feed is None,
            feed=None if feed is None else feed * control.feed_unit,
        )


def tool_block(control: HeidenhainControl, rest: str, parameters: Parameters) -> float | None:
    """Execute TOOL CALL or TOOL DEF; returns its feed for F AUTO, mm/min, None if it has none.

    rest   what follows TOOL
    """
    match = _TOOL.match(rest)
    if match is None:
        raise KlartextError(Wording("NC210", "tool_needs_call_def"))
    block_words = words(rest, match.end())
    name = _tool_name(match, parameters)
    of_axis = ["tool axis" if word.operand is None else word.name for word in block_words]
    if twice := next((each for each in of_axis if of_axis.count(each) > 1), None):
        raise KlartextError(Wording("NC212", "written_twice", word=twice))
    if match["kind"] == "DEF":
        # With a length and a radius it defines a tool; without them it announces the next one.
        sizes = {word.name: value_of(word.operand, parameters) for word in block_words if word.operand is not None}
        if len(sizes) < len(block_words) or sizes.keys() - {"L", "R"}:
            raise KlartextError(Wording("NC210", "tool_def_takes_l_r"))
        if name is not None and sizes:
            control.define_tool(name, {key: value * control.length_unit for key, value in sizes.items()})
        elif name is not None:
            control.select_tool(name)
        return None
    values = {word.name: value_of(word.operand, parameters) for word in block_words if word.operand is not None}
    tool_axes = [word.name for word in block_words if word.operand is None]
    unknown = [*(set(tool_axes) - {"X", "Y", "Z"}), *(values.keys() - {"S", "F", "DL", "DR", "DR2"})]
    if unknown:
        raise KlartextError(Wording("NC211", "unknown_word", word=unknown[0] or "in quotes"))
    feed = values.get("F")
    if feed is not None and not 0.0 <= feed <= MAX_FEED:
        raise KlartextError(Wording("NC215", "feed_out_of_range", most=MAX_FEED))
    if values.get("S", 0.0) < 0.0:
        raise KlartextError(Wording("NC215", "speed_below_zero"))
    along = "XYZ".index(tool_axes[-1]) if tool_axes else None
    if along is not None and abs(control.machine.spindle_direction[along]) < _ALONG:
        control.note(Wording("NC361", "tool_axis_not_spindle", axis=tool_axes[-1]), Severity.ERROR)
    control.call_tool(name, along)
    if along is not None:
        control.say_mode("tool axis")
    if "S" in values:
        control.modal.rpm.set(control.row, values["S"])
        control.add_event("speed", values["S"])
    for key in ("DL", "DR", "DR2"):
        if values.get(key):
            control.add_tool_delta(key, values[key] * control.length_unit)
    if feed is None:
        return None
    control.programmed_feed = feed * control.feed_unit
    return control.programmed_feed


def _tool_name(match: re.Match[str], parameters: Parameters) -> str | None:
    if match["number"]:
        return f"{float(match['number'].replace(',', '.')):.10g}"
    if match["parameter"]:
        return f"{parameters[canonical(match['parameter'])]:.10g}"
    name: str | None = match["name"]
    return name
