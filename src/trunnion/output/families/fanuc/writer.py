"""Writer of Fanuc 30i and 31i: what words and templates cannot express.

Facts: FANUC's operator's manuals and public posts; docs/controls/fanuc.md lists them, with those that depend on
parameters of the control.
"""

import re
from collections.abc import Iterator, Mapping
from textwrap import wrap
from typing import Final

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.controls.family_writer import ArcWords, Codes, Formats, UnsupportedFeatureError, WordEvent
from trunnion.controls.template import Value
from trunnion.controls.vocabulary import LINES_FOR_SPLINES, SPLINES_SETTING
from trunnion.controls.words import IncrementWords
from trunnion.messages import Wording, phrase
from trunnion.model.motion import MachiningMode, Motion
from trunnion.model.toolpath import Arcs, CutterComp, Dwell, Kind, Message, Operation, Stop
from trunnion.output.coordinates.euler_angles import euler_zxz_angles
from trunnion.output.families.fanuc.cycles import cycle_lines, dwell_parts, is_valid_shift
from trunnion.output.families.fanuc.splines import spline_lines as spline_lines
from trunnion.output.families.fanuc.splines import takes_spline as takes_spline
from trunnion.output.shared import iso
from trunnion.output.shared.iso import row_words as row_words
from trunnion.output.shared.lines import program_stop
from trunnion.output.shared.spindle import dwell_seconds, dwell_text
from trunnion.planning.holes.cycles import Cycle, SpindleState
from trunnion.transliteration import spelled

#: Circles have no word for whole turns. Tool length and radius are data of the control, called by number.
#: Radius compensation works in the working plane, wherever the tool points.
COMPENSATES_WITH_TCP = True

WORDS: tuple[str, ...] = (
    *(word for word in iso.WORDS if word != "turns"),
    *("length", "length_number", "radius_number", "axis_x", "axis_y", "axis_z"),
)
CODES: tuple[str, ...] = iso.CODES
PLANE_COMMANDS: tuple[str, ...] = ("g68_2", "g254")
PLANE_TEMPLATES_OF: Mapping[str, str] = {}
PLANES_OF_POSE: frozenset[str] = frozenset()
SETTING_CHOICES: Mapping[str, tuple[str, ...]] = {
    "contour": ("none", "G05.1", "G05"),
    "orientation": ("angles", "vector"),
    SPLINES_SETTING: (LINES_FOR_SPLINES, "nurbs"),
    "encoding": ("ascii",),
}
SETTING_MEANINGS: Mapping[str, str] = {
    "contour": "AI contour control (look-ahead) that is on while an operation cuts: none, G05.1 Q1 or G05 P10000.",
    "orientation": "How the tool axis is programmed with TCP: angles writes rotary words (G43.4), vector writes I J K "
    "(G43.5) for whole operations.",
    SPLINES_SETTING: "Splines of three-axis operations: linearize writes the lines between their points; nurbs writes "
    "G06.2, for controls with the option of NURBS interpolation.",
    "encoding": "What names and texts are written in: comments have no other characters here. Others are "
    "transliterated, with a warning.",
}
_PLANE_FIELDS: Final = ("plane_first", "plane_second", "plane_third")
SETTING_FIELDS: Mapping[str, tuple[str, ...]] = {"contour": ("contour_on", "contour_off"), "call": ("call_word",)}
LINE_COMMENTS: tuple[str, ...] = ()
COMMENTS: re.Pattern[str] = re.compile(r"(\([^)]*\))")
BLOCK_NUMBER_LETTERS: tuple[str, ...] = ("N", "")
HIGHEST_BLOCK_NUMBER = 99999
NEVER_NUMBERED = "%O"
INCREMENTS: IncrementWords | None = IncrementWords("G91", "G90")
TEMPLATE_FIELDS: frozenset[str] = frozenset(
    {*_PLANE_FIELDS, "contour_on", "contour_off", "call_word", "call_arguments"}
)

#: AI contour control on and off: in the control's own form, and in that of older controls.
_CONTOUR_CONTROL: Final = {"none": (None, None), "G05.1": ("G05.1 Q1", "G05.1 Q0"), "G05": ("G05 P10000", "G05 P0")}

#: G word of the tool length along Z, and the setting that has the one with TCP, by the setting ``orientation``.
_LENGTH_CODE: Final = 43.0
_TCP_SETTINGS: Final = {"angles": "tcp_on", "vector": "tcp_on_vector"}

#: Characters of a comment besides letters and digits; others become a dash. ``%`` would end the program.
_COMMENT_SIGNS: Final = frozenset(" .,=+-*/_#[]'!?&<>@")

#: What stands for signs that a comment cannot have.
_OTHER_SIGNS: Final = str.maketrans('(){}"|\\', "[][]'//")

#: Characters of a comment: a line of 80 has room for them, with brackets.
_COMMENT_LENGTH: Final = 76

_PROGRAM_NUMBER_DIGITS: Final = 8

#: The call of a subprogram, or of a macro with arguments. These have a point: without it they would be increments.
_CALL_PATTERN: Final = re.compile(r"(M98|G65)((?: [A-FHIJKMQ-Z][-+]?(?:\d+\.\d*|\.\d+))*)", re.ASCII)


def comment(text: str) -> list[str]:
    """Return the text in brackets; a long one continues in the next line."""
    return [f"({part})" for part in wrap(escape_comment(text), _COMMENT_LENGTH) or [""]]


def escape_comment(text: str) -> str:
    """Return the text in the capitals and signs that a comment can have.

    Round brackets become square ones: a closing one would end the comment.
    """
    capitals = spelled(text, "ascii").upper().translate(_OTHER_SIGNS)
    return "".join(c if c.isalnum() or c in _COMMENT_SIGNS else "-" for c in capitals)


def tool_call(number: int, name: str, by_name: bool) -> str:
    """Return what follows ``T``: a number, for tools have no names."""
    if by_name:
        raise UnsupportedFeatureError(Wording("CTL130", "tools_called_number", name=name))
    return str(number)


def template_values(settings: Mapping[str, Value], plane: Floats | None) -> dict[str, Value]:
    """Return the Euler angles of a plane, the words of contour control, and those of a call."""
    angles = (None, None, None) if plane is None else euler_zxz_angles(plane)
    on, off = _CONTOUR_CONTROL[str(settings["contour"])]
    call, _, arguments = str(settings.get("call") or "M98").partition(" ")
    words = {"contour_on": on, "contour_off": off, "call_word": call, "call_arguments": arguments}
    return {**dict(zip(_PLANE_FIELDS, angles, strict=True)), **words}


def tool_preselection(call: str) -> list[str]:
    """Return ``T``; ``M6`` changes to it later."""
    return [f"T{call}"]


def dwell(event: Dwell, rpm: float | None, formats: Formats) -> list[str]:
    """Return ``G4 P`` with milliseconds, or with seconds where the format has decimals."""
    return [f"G4 P{dwell_text(dwell_seconds(event, rpm), formats['dwell'], dwell_parts(formats))}"]


def stop(event: Stop, codes: Codes) -> list[str]:
    """Return M0 or M1, after a comment for the operator."""
    return program_stop(event, codes, comment)


def message(event: Message) -> list[str]:
    """Return a comment: the control would have to stop to display it."""
    return comment(event.text)


def event_words(event: WordEvent, codes: Codes, coolant: Codes) -> dict[str, float]:
    """Return the words as ISO has them; radius compensation with D, the register that CUTCOM names or the tool's."""
    words = iso.event_words(event, codes, coolant)
    if isinstance(event, CutterComp) and event.register:
        words["radius_number"] = event.register
    return words


def first_block_words(motion: Motion, tool: str, register: int, settings: Mapping[str, str]) -> dict[str, float]:
    """Return G43, or the word for TCP, with H: the register that LOAD/TOOL names, or else the tool number.

    With the motion to the first point they work whether or not the control moves where they are alone (parameter TOS).
    """
    tcp = motion.mode is MachiningMode.TCP
    length = float(settings[_TCP_SETTINGS[settings["orientation"]]].removeprefix("G")) if tcp else _LENGTH_CODE
    return {"length": length, "length_number": float(register or tool)}


def validate_operation(operation: Operation, spindle_known: bool) -> list[tuple[int, UnsupportedFeatureError]]:
    """Return G95 without a spindle speed, and radius compensation while the tool axis changes: that is G41.2.

    And radius compensation that begins or ends on a circle, at which the control stops with an alarm.
    """
    problems = iso.feed_per_rev_before_spindle(operation, spindle_known)
    problems += list(_compensation_on_arcs(operation))
    if np.ptp(operation.moves.axis, axis=0).max(initial=0.0) > 0.0:
        why = UnsupportedFeatureError(Wording("CTL220", "cutter_radius_compensation"))
        events = [event for event in operation.events if isinstance(event, CutterComp) and event.side != "OFF"]
        problems += [(event.line, why) for event in events]
    return problems


def _compensation_on_arcs(operation: Operation) -> Iterator[tuple[int, UnsupportedFeatureError]]:
    """Yield each CUTCOM that switches radius compensation on or off for a circle."""
    kind, is_on = operation.moves.kind, False
    for event in operation.events:
        if not isinstance(event, CutterComp):
            continue
        switches, is_on = is_on != (event.side != "OFF"), event.side != "OFF"
        if switches and event.row < len(kind) and kind[event.row] == Kind.ARC:
            yield event.line, UnsupportedFeatureError(Wording("CTL220", "cutcom_before_circle", side=event.side))


def validate_settings(settings: Mapping[str, str]) -> list[tuple[str, Wording]]:
    """Return invalid numbers, calls and shifts, and tool vectors on a control that has no word for them."""
    program = settings.get("program", "1")
    wrong = []
    if not (program.isdecimal() and program.isascii() and 0 < int(program) < 10**_PROGRAM_NUMBER_DIGITS):
        wrong.append(("program", phrase("number_of_program", digits=_PROGRAM_NUMBER_DIGITS)))
    if not _is_call(settings.get("call", "M98")):
        wrong.append(("call", phrase("call_of_subprogram")))
    if settings.get("orientation") == "vector" and not settings.get("tcp_on_vector", ""):
        wrong.append(("orientation", phrase("angles_without_vectors")))
    if not is_valid_shift(settings.get("bore_lift", "")):
        wrong.append(("bore_lift", phrase("shift_from_bore")))
    return wrong


def _is_call(text: str) -> bool:
    """Whether a text can call programs: M98 without arguments, or G65 with each letter once."""
    match = _CALL_PATTERN.fullmatch(text)
    letters = [word[0] for word in match[2].split()] if match else []
    return bool(match) and len(set(letters)) == len(letters) and not (letters and text.startswith("M98"))


def validate_plane(settings: Mapping[str, str], plane: Floats, of_pose: Floats) -> Wording | None:
    """Return None: every plane can be said."""
    return None


def cycle_call(
    cycle: Cycle, top: float, spindle: SpindleState | None, settings: Mapping[str, str], formats: Formats
) -> list[str]:
    """Return the cycle with its first hole; a rigid tap after the word that couples the spindle to the feed."""
    return cycle_lines(cycle, top, spindle, settings, formats)


def cycle_cancel() -> list[str]:
    """Return G80."""
    return ["G80"]


def arc_words(arcs: Arcs, tip: Floats, rows: Ints, codes: Codes, formats: Formats, by_radius: bool = False) -> ArcWords:
    """Return the words as ISO has them, for circles of one turn at most."""
    words = iso.arc_words(arcs, tip, rows, codes, formats)
    return ArcWords({word: column for word, column in words.columns.items() if word != "turns"}, words.forced)
