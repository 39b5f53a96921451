"""What single words of a Sinumerik program do."""

from typing import Final

from trunnion.errors import Severity
from trunnion.messages import Wording
from trunnion.model.run import Orientation
from trunnion.readers.control.iso_m_codes import EVENTS, PROGRAM_ENDS, TOOL_CHANGE
from trunnion.readers.control.row_recorder import MAX_POSITION
from trunnion.readers.control.virtual_control import LINEAR, RAPID
from trunnion.readers.families.sinumerik import unseen_modes
from trunnion.readers.families.sinumerik.block import Block
from trunnion.readers.families.sinumerik.calls import CallInterpreter
from trunnion.readers.families.sinumerik.control import (
    CLOCKWISE,
    COUNTER_CLOCKWISE,
    POLYNOMIAL,
    TANGENT,
    THROUGH,
)
from trunnion.readers.families.sinumerik.expressions import Value
from trunnion.readers.families.sinumerik.frame_statements import frame_of_statement, state_of_frame
from trunnion.readers.families.sinumerik.words import (
    EXACT_STOPS,
    FRAMES,
    G_FEEDS,
    G_MACHINE,
    G_NOT_SIMULATED,
    G_OFFSETS,
    G_PLANES,
    G_RADIUS_COMPENSATION,
    G_RESERVED,
    G_SHOWN_MODES,
    G_SURFACE,
    G_UNITS,
    G_WITHOUT_PATH_EFFECT,
    M_AXIS_MODE,
    M_GEARS,
    M_RETURN,
    TOOL_FRAMES,
    WITHIN_COMPENSATION,
    WITHOUT_PATH_EFFECT,
)
from trunnion.readers.program.coolant_words import coolant_of
from trunnion.readers.program.interpreter import ProgramEnd

#: G words of threads, which are taken as lines, and of the dwell.
_THREADS: Final = (33, 63, 331, 332)
DWELL: Final = 4

#: TRAORI takes the offsets of two rotary axes.
_MOST_OFFSETS: Final = 2


class WordInterpreter(CallInterpreter):
    """Executes the words of blocks one by one."""

    def _g_code(self, code: int) -> None:
        control = self.control
        if code in G_SHOWN_MODES:
            control.say_mode(G_SHOWN_MODES[code])
        unseen_modes.say(control, f"G{code}")
        if code in G_RADIUS_COMPENSATION:
            control.compensate(G_RADIUS_COMPENSATION[code])
        if code in (RAPID, LINEAR, CLOCKWISE, COUNTER_CLOCKWISE):
            control.motion = code
        elif code in G_PLANES:
            control.set_working_plane("XYZ".index(G_PLANES[code]))
        elif code in G_UNITS:
            control.set_units(*G_UNITS[code])
        elif code in (90, 91):
            control.absolute = code == 90
        elif code in G_FEEDS:
            control.modal.feed_mode.set(control.row, G_FEEDS[code])
            if code in G_SURFACE:
                self._note(Wording("NC220", "g_constant_surface_speed_not", code=code), Severity.ERROR)
        elif code in G_OFFSETS:
            # With no offset any program may end, as with the first one.
            after = control.usual("offset") if code == control.no_offset else code
            control.set_mode("offset", f"G{code}", control.modal.work_offset.current, after)
            control.set_offset(code, f"G{code}")
            control.regain_offset(code)
        elif code in G_NOT_SIMULATED:
            text, changes_path = G_NOT_SIMULATED[code]
            self._note(
                Wording("NC220" if changes_path else "NC221", "not_simulated", word=f"G{code}", does=text),
                Severity.ERROR if changes_path else Severity.WARNING,
            )
            if code in _THREADS:
                control.motion = LINEAR
        elif code in EXACT_STOPS:
            control.add_exact_stop(EXACT_STOPS[code])
        elif f"G{code}" in WITHIN_COMPENSATION:
            control.modify_compensation(f"G{code}")
        elif code in G_RESERVED:
            text = "belongs to the machine's builder: what it does is not known; a definition can declare it"
            self._note(Wording("NC224", "g_unknown_here", code=code, does=text), Severity.ERROR)
        elif not (code in G_WITHOUT_PATH_EFFECT or code in G_RADIUS_COMPENSATION or code in G_MACHINE or code == DWELL):
            self._note(Wording("NC211", "unknown_g_word", code=code), Severity.ERROR)

    def _word(self, word: str, block: Block) -> None:
        control = self.control
        unseen_modes.say(control, word)
        match word:
            case "TRAORI":
                control.judge_within_compensation(word)
                if fault := _fault_of_traori(block.traori):
                    self._note(fault, Severity.ERROR)
                control.set_tcp(True)
                control.lose_offset()
            case "TRAFOOF":
                if control.tcp:
                    control.judge_within_compensation(word)
                control.set_tcp(False)
            case "CIP":
                control.motion = THROUGH
            case "CT":
                control.motion = TANGENT
            case "POLY":
                control.motion = POLYNOMIAL
            case "ORIAXES":
                control.set_orientation(Orientation.ANGLES)
            case "ORIVECT" | "ORIPLANE":
                control.set_orientation(Orientation.GREAT_CIRCLE)
            case "ORIMKS" | "ORIWKS":
                control.set_machine_vectors(word == "ORIMKS")
            case _ if word in TOOL_FRAMES:
                if control.tool_frame or not word.endswith("OF"):
                    control.judge_within_compensation(word)
                control.turn_frame(word)
            case _ if word.startswith("CUT2D") or word.startswith("CUT3D"):
                control.compensates_in_space = word.startswith("CUT3D")
            case "SPOS":
                control.add_event("spindle", "oriented")
            case _ if word in WITHIN_COMPENSATION:
                control.modify_compensation(word)
            case _:
                # Frames and SUPA belong to the motion; the path does not depend on the others.
                assert word in FRAMES or word in WITHOUT_PATH_EFFECT or word == "SUPA" or word.startswith("ORI")

    def _dwell(self, block: Block) -> None:
        if block.feed is not None and block.speed is not None:
            self._note(Wording("NC216", "two_times", word="G4"), Severity.ERROR)
        elif block.feed is not None:
            self.control.add_event("dwell", block.feed)
        elif block.speed is not None:
            self.control.add_event("dwell", -block.speed)
        else:
            self._note(Wording("NC218", "g4_without_time"), Severity.ERROR)
        others = block.beside({"g", "feed", "speed"}) + [f"G{code}" for code in block.g if code != DWELL]
        if others:
            self._note(Wording("NC212", "alone_in_block", word="G4", words=tuple(others)), Severity.ERROR)

    def _m_code(self, code: int) -> None:
        control = self.control
        if code in EVENTS:
            kind, value = EVENTS[code]
            control.add_event(kind, coolant_of(control.machine, code, value) if kind == "coolant" else value)
        elif code == M_AXIS_MODE:
            control.add_event("spindle", "axis")
        elif code == TOOL_CHANGE:
            control.judge_within_compensation(f"M{code}")
            control.change_tool()
        elif code == M_RETURN or (code in PROGRAM_ENDS and len(self._stack) > 1):
            self._check_behind_return(self._stack[-1])
            self._leave_program()  # M2 and M30 of a program that another one has called end only itself
        elif code in PROGRAM_ENDS:
            control.report_trailing_modes()
            control.add_event("end", f"M{code}")
            raise ProgramEnd
        elif code in M_GEARS:
            text = "chooses a gear, whose speeds only the machine knows; a definition can declare it"
            self._note(Wording("NC224", "m_unknown_here", code=code, does=text), Severity.ERROR)
        else:
            control.add_builders_word("M", float(code))

    def _frame(self, words: list[str], block: Block) -> None:
        control = self.control
        if len(words) > 1:
            self._note(Wording("NC212", "several_frame_words_block_last"), Severity.ERROR)
        word = words[-1]
        additive = word.startswith("A")
        statement = word.removeprefix("A")
        values: dict[str, float] = {}
        for name, (value, _) in {**block.axes, **block.params}.items():
            if abs(value) * control.length_unit > MAX_POSITION:
                self._note(Wording("NC330", "frame_value_too_large", word=word, name=name), Severity.ERROR)
                return
            if name in ("X", "Y", "Z"):
                values[name] = value * control.length_unit if statement == "TRANS" else value
            elif name == "RPL":
                values[name] = value
            else:
                self._note(Wording("NC220", "frame_word_not_simulated", word=word, name=name), Severity.ERROR)
        frame = frame_of_statement(statement, values, control.plane_axis)
        result = control.program_frame.compose(frame) if additive else frame
        control.set_program_frame(result)
        control.add_event("frame", state_of_frame(word, result))


def _fault_of_traori(arguments: list[Value | None]) -> Wording | None:
    """Return what is wrong with TRAORI(n,X,Y,Z,A,B): it is followed for the first transformation, and a tool along Z.

    X, Y, Z are the direction of the tool in the basic position, A and B the offsets of the rotary axes.
    """
    number, *rest = arguments or [None]
    if number not in (None, 1.0):
        return Wording("NC224", "traori_only_machine_knows_what", traori=str(number).removesuffix(".0"))
    direction, offsets = rest[:3], rest[3:]
    x, y, z = (*(value or 0.0 for value in direction), 0.0, 0.0, 0.0)[:3]
    is_along_z = direction.count(None) == len(direction) or (x == y == 0.0 and not isinstance(z, str) and z > 0.0)
    if is_along_z and not any(offsets) and len(offsets) <= _MOST_OFFSETS:
        return None
    written = ",".join("" if value is None else str(value).removesuffix(".0") for value in arguments)
    return Wording("NC224", "traori_turns_basic_position", arguments=written)
