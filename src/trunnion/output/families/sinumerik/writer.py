"""Writer of Sinumerik 840D sl: what words and templates cannot express.

Facts: SINUMERIK 840D sl programming manuals, *Fundamentals* and *Job planning*; docs/controls/sinumerik.md lists them.
"""

import re
from collections.abc import Mapping
from typing import Final

from trunnion.arrays import Floats
from trunnion.controls.family_writer import EACH_HOLE, Codes, Formats, UnsupportedFeatureError
from trunnion.controls.template import Value
from trunnion.controls.vocabulary import (
    ALL_LEFT_ON,
    HOLES_IN_PLANES,
    HOLES_SETTING,
    LINES_FOR_SPLINES,
    OFFSET_BEFORE_TURN,
    OFFSETS_DIFFER,
    PLANES_USED,
    SAFE_START_CHOICES,
    SAFE_START_SETTING,
    SPLINES_SETTING,
    TCP_USED,
)
from trunnion.controls.words import IncrementWords
from trunnion.messages import Wording, phrase
from trunnion.model.motion import Motion
from trunnion.model.toolpath import Dwell, Message, Operation, Stop
from trunnion.output.coordinates.euler_angles import tait_bryan_angles
from trunnion.output.families.sinumerik.cycles import cycle_statement, is_valid_lift
from trunnion.output.families.sinumerik.splines import spline_lines as spline_lines
from trunnion.output.families.sinumerik.splines import takes_spline as takes_spline
from trunnion.output.shared import iso
from trunnion.output.shared.iso import arc_words as arc_words
from trunnion.output.shared.iso import event_words as event_words
from trunnion.output.shared.iso import row_words as row_words
from trunnion.output.shared.lines import program_stop, split_text
from trunnion.output.shared.spindle import dwell_text
from trunnion.planning.holes.cycles import Cycle, HoleCycleError, HoleMethod, SpindleState

#: Radius compensation works in the working plane, wherever the tool points.
COMPENSATES_WITH_TCP = True

WORDS: tuple[str, ...] = (
    *iso.WORDS, "edge", "primary_shortest", "secondary_shortest", "axis_x", "axis_y", "axis_z", "by_vector", "by_axes",
)  # fmt: skip
CODES: tuple[str, ...] = iso.CODES
PLANE_COMMANDS: tuple[str, ...] = ("cycle800", "frames")
PLANE_TEMPLATES_OF: Mapping[str, str] = {}
PLANES_OF_POSE: frozenset[str] = frozenset()
SETTING_CHOICES: Mapping[str, tuple[str, ...]] = {
    "plane": PLANE_COMMANDS,
    "swivel_mode": ("57", "27", "39", "45", "30", "54"),
    "orientation": ("angles", "vector"),
    HOLES_SETTING: (HOLES_IN_PLANES, "torot", "positions"),
    SAFE_START_SETTING: SAFE_START_CHOICES,
    SPLINES_SETTING: (LINES_FOR_SPLINES, "polynomial"),
    "cycle_form": ("classic", "long"),
}
SETTING_MEANINGS: Mapping[str, str] = {
    "plane": "The command for a tilted plane: CYCLE800, or frames (TRAORI, TRANS, AROT).",
    "swivel_mode": "Axes of the three rotations of CYCLE800: 57 X Y Z, 27 Z Y X, 39 Z X Y, 45 X Z Y, 30 Y Z X, 54 Y X "
    "Z.",
    "orientation": "How the tool axis is programmed with TCP: angles writes rotary words (ORIAXES), vector writes A3= "
    "B3= C3= (ORIVECT).",
    HOLES_SETTING: "Holes between which the tool axis changes: planes gives each tool axis a plane; torot (a frame by "
    "TOROT at each hole) and positions (MCALL and position blocks) stay under TCP. positions is for cycles that drill "
    "along the tool, which cycles_along_tool = true under [control.reading] declares.",
    SAFE_START_SETTING: "Which planes that an aborted run may have left on the start of every operation cancels: own "
    "cancels those that the program uses itself; all writes CYCLE800(), TOROTOF and TRANS in every program, for "
    "machines that have swivel data.",
    SPLINES_SETTING: "Splines of three-axis operations: linearize writes the lines between their points; polynomial "
    "writes POLY, for controls with the option of polynomial interpolation.",
    "cycle_form": "How drilling cycles are called: classic, or long with _GMODE, _DMODE and _AMODE behind all other "
    "parameters, as an 840D sl shows them in its own masks.",
}
_PLANE_FIELDS = ("plane_first", "plane_second", "plane_third", "plane_mode")
_CANCELLING_FIELDS = ("cancel_swivel", "cancel_tool_frame", "cancel_frames")
SETTING_FIELDS: Mapping[str, tuple[str, ...]] = {
    "swivel_mode": ("plane_mode",),
    SAFE_START_SETTING: (*_CANCELLING_FIELDS, OFFSET_BEFORE_TURN),
}
LINE_COMMENTS: tuple[str, ...] = (";",)
COMMENTS: re.Pattern[str] = re.compile(r'(MSG\("[^"]*"\)|;.*)|"[^"]*"')
BLOCK_NUMBER_LETTERS: tuple[str, ...] = ("N", "")
HIGHEST_BLOCK_NUMBER = 99999999
NEVER_NUMBERED = ""
INCREMENTS: IncrementWords | None = IncrementWords("G91", "G90")
TEMPLATE_FIELDS: frozenset[str] = frozenset({*_PLANE_FIELDS, *_CANCELLING_FIELDS, OFFSET_BEFORE_TURN, "interpolation"})

#: A block has 512 characters at most, with its number; the display shows 124 of a message.
_COMMENT_BYTES: Final = 480
_MESSAGE_BYTES: Final = 124

#: _ST of CYCLE800 with 0 as its ones digit: a new plane, not one that is added.
_NEW_SWIVEL: Final = re.compile(r"[0-9]{0,7}0")

#: _MODE of CYCLE800 for the frame words ROT and AROT, which turn about X, Y and Z.
_FRAME_MODE = "57"


def comment(text: str) -> list[str]:
    """Return lines that start with a semicolon."""
    return [f";{piece}" for piece in split_text(text, _COMMENT_BYTES)]


def escape_comment(text: str) -> str:
    """Return the text itself: after a semicolon every character is allowed."""
    return text


def tool_call(number: int, name: str, by_name: bool) -> str:
    """Return what follows ``T=``: a number, or a name in quotation marks."""
    if by_name and '"' in name:
        raise UnsupportedFeatureError(Wording("CTL130", "tool_name_quotation", name=name))
    return f'"{name}"' if by_name else str(number)


def swivel_axes(mode: int) -> tuple[int, int, int]:
    """Return the axes of the three rotations of CYCLE800, 0 for X.

    Bits 1 and 0 of ``_MODE`` name the first axis, 3 and 2 the second, 5 and 4 the third: 1 is X, 2 is Y, 3 is Z.
    """
    return (mode & 3) - 1, (mode >> 2 & 3) - 1, (mode >> 4 & 3) - 1


def template_values(settings: Mapping[str, Value], plane: Floats | None) -> dict[str, Value]:
    """Return how orientations are interpolated, the three rotations of a plane in the order of ``plane_mode``, and
    what cancels planes that an aborted run may have left on.
    """
    found: dict[str, Value] = {
        "interpolation": "VECT" if settings["orientation"] == "vector" else "AXES",
        **_cancelled_planes(settings),
        OFFSET_BEFORE_TURN: _offset_before_turn(settings),
    }
    if plane is None:
        return found | dict.fromkeys(_PLANE_FIELDS)
    mode = str(settings["swivel_mode"]) if settings["plane"] == "cycle800" else _FRAME_MODE
    angles = tait_bryan_angles(plane, swivel_axes(int(mode)))
    return found | dict(zip(_PLANE_FIELDS, (*angles, mode), strict=True))


def _cancelled_planes(settings: Mapping[str, Value]) -> dict[str, Value]:
    """Return what cancels planes that an aborted run may have left on, by ``SAFE_START_SETTING``; None:
    nothing does.
    """
    everything = settings[SAFE_START_SETTING] == ALL_LEFT_ON
    plane = settings["plane"] if settings.get(PLANES_USED) else None
    turns_frame = bool(settings.get(TCP_USED)) and settings[HOLES_SETTING] == "torot"
    return {
        "cancel_swivel": "CYCLE800()" if everything or plane == "cycle800" else None,
        "cancel_tool_frame": "TOROTOF" if everything or turns_frame else None,
        "cancel_frames": "TRANS" if everything or turns_frame or plane == "frames" else None,
    }


def _offset_before_turn(settings: Mapping[str, Value]) -> Value:
    """Return the work offset in which the rotary axes turn before TRAORI; None: the one that is in force.

    The rotary axes of a work offset count too. The published programs turn before they select their only offset, G54.
    A control without the setting leaves all that to its templates.
    """
    offset = settings.get("work_offset")
    left_on = settings[SAFE_START_SETTING] == ALL_LEFT_ON or settings.get("restart") == "on"
    return offset if left_on or settings.get(OFFSETS_DIFFER) or offset != "G54" else None


def tool_preselection(call: str) -> list[str]:
    """Return ``T=``; ``M6`` changes to it later."""
    return [f"T={call}"]


def dwell(event: Dwell, rpm: float | None, formats: Formats) -> list[str]:
    """Return ``G4 F`` for seconds or ``G4 S`` for spindle revolutions, in a block of its own."""
    letter, unit = ("S", "turns") if event.revolutions else ("F", "s")
    return [f"G4 {letter}{dwell_text(event.amount, formats['dwell'], unit=unit)}"]


def stop(event: Stop, codes: Codes) -> list[str]:
    """Return M0 or M1 after the text for the operator, which the control displays until the program goes on.

    A text that is longer than a message stands in comments, too.
    """
    lines = program_stop(event, codes, _stop_text)
    return [*lines, "MSG()"] if event.text else lines


def _stop_text(text: str) -> list[str]:
    pieces = split_text(text.replace('"', "'"), _MESSAGE_BYTES)
    return [*(comment(text) if len(pieces) > 1 else ()), f'MSG("{pieces[0]}")']


def message(event: Message) -> list[str]:
    """Return a comment, or MSG for the operator; a quotation mark would end its text."""
    if not event.display:
        return comment(event.text)
    if not event.text:
        return ["MSG()"]
    return [f'MSG("{piece}")' for piece in split_text(event.text.replace('"', "'"), _MESSAGE_BYTES)]


def first_block_words(motion: Motion, tool: str, register: int, settings: Mapping[str, str]) -> dict[str, float]:
    """Return the cutting edge, which activates the tool length."""
    return {"edge": int(settings["edge"])} if "edge" in settings else {}


def validate_operation(operation: Operation, spindle_known: bool) -> list[tuple[int, UnsupportedFeatureError]]:
    """Return nothing."""
    return []


def validate_settings(settings: Mapping[str, str]) -> list[tuple[str, Wording]]:
    """Return an invalid lift-off or style of swivelling."""
    wrong = []
    if not is_valid_lift(settings.get("bore_lift", "")):
        wrong.append(("bore_lift", phrase("lift_from_bore")))
    if not _NEW_SWIVEL.fullmatch(settings.get("swivel_style", "0")):
        wrong.append(("swivel_style", phrase("style_of_swivelling")))
    return wrong


def validate_plane(settings: Mapping[str, str], plane: Floats, of_pose: Floats) -> Wording | None:
    """Return None: every plane can be said."""
    return None


def cycle_call(
    cycle: Cycle, top: float, spindle: SpindleState | None, settings: Mapping[str, str], formats: Formats
) -> list[str]:
    """Return ``MCALL`` with the cycle; or for each hole a frame turned to the tool, and the cycle."""
    lift = float(settings["bore_lift"]) if settings.get("bore_lift") else None
    if settings[HOLES_SETTING] != HOLES_IN_PLANES and cycle.method is HoleMethod.BORE_WITH_LIFT:
        raise HoleCycleError(Wording("CTL370", "bore_nodrag_while"))
    is_long = settings.get("cycle_form") == "long"
    call = cycle_statement(cycle, top, spindle, lift, formats, is_long=is_long)
    if settings[HOLES_SETTING] == "torot":
        return [EACH_HOLE, "TOROT", call, "TOROTOF", "TRANS"]
    return [f"MCALL {call}"]


def cycle_cancel() -> list[str]:
    """Return ``MCALL`` alone."""
    return ["MCALL"]
