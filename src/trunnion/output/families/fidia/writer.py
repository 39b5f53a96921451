"""Writer of Fidia NC15: what words and templates cannot express.

Facts: the program that ran on an HS664RT, and public posts for Fidia controls; docs/controls/fidia.md lists them, with
those that are unconfirmed.
"""

import re
from collections.abc import Mapping
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.controls.family_writer import (
    FIRST_HOLE,
    ArcWords,
    Codes,
    Formats,
    UnsupportedFeatureError,
)
from trunnion.controls.template import Value
from trunnion.controls.vocabulary import (
    ALL_LEFT_ON,
    OFFSET_BEFORE_TURN,
    SAFE_START_CHOICES,
    SAFE_START_SETTING,
    TCP_USED,
)
from trunnion.controls.words import ABSENT, IncrementWords
from trunnion.messages import Wording, phrase
from trunnion.model.motion import Motion
from trunnion.model.toolpath import Arcs, Dwell, Kind, Message, Operation, Sense, Stop
from trunnion.output.shared import iso
from trunnion.output.shared.iso import event_words as event_words
from trunnion.output.shared.lines import program_stop
from trunnion.output.shared.spindle import cycle_dwell_seconds, dwell_seconds, dwell_text, running_spindle
from trunnion.output.shared.splines import spline_lines as spline_lines
from trunnion.output.shared.splines import takes_spline as takes_spline
from trunnion.planning.holes.cycles import Cycle, HoleCycleError, HoleMethod, SpindleState, UnsupportedCycleError

#: Radius compensation works in the working plane, wherever the tool points.
COMPENSATES_WITH_TCP = True

WORDS: tuple[str, ...] = (
    "cutter_comp", "plane", "motion", "I", "J", "K", "speed", "spindle", "coolant", "feed",
)  # fmt: skip
CODES: tuple[str, ...] = tuple(code for code in iso.CODES if not code.startswith("feed_"))
PLANE_COMMANDS: tuple[str, ...] = ("g154",)
PLANE_TEMPLATES_OF: Mapping[str, str] = {}
PLANES_OF_POSE: frozenset[str] = frozenset()
SETTING_CHOICES: Mapping[str, tuple[str, ...]] = {SAFE_START_SETTING: SAFE_START_CHOICES}
SETTING_MEANINGS: Mapping[str, str] = {
    SAFE_START_SETTING: "What an aborted run may have left on the start of every operation cancels: own cancels TCP "
    "(G197) where the program uses it itself; all writes G197 and G69 in every program, and the work offset before the "
    "rotary axes turn for the first time.",
}
_CANCELLING_FIELDS: Final = ("cancel_tcp", "cancel_plane", OFFSET_BEFORE_TURN)
SETTING_FIELDS: Mapping[str, tuple[str, ...]] = {SAFE_START_SETTING: _CANCELLING_FIELDS}
LINE_COMMENTS: tuple[str, ...] = ()
COMMENTS: re.Pattern[str] = re.compile(r"(\([^)]*\))")
BLOCK_NUMBER_LETTERS: tuple[str, ...] = ("N", "")
HIGHEST_BLOCK_NUMBER = 99999999
NEVER_NUMBERED = ""
INCREMENTS: IncrementWords | None = IncrementWords("G91", "G90", circles=False)
TEMPLATE_FIELDS: frozenset[str] = frozenset(_CANCELLING_FIELDS)

#: Words that switch TCP on and off: for a table with both rotary axes, and for a head.
_TCP_PAIRS: Final = (("G196", "G197"), ("G96", "G97"))

#: Characters of a comment: a line of 80 has room for them, with brackets and blanks.
_COMMENT_LENGTH: Final = 76

#: Greatest error of a thread's feed, which is printed as a whole number, mm/min.
_FEED_TOLERANCE: Final = 0.005

#: G words of cycles, without a dwell and with one.
_CYCLES: Final = {
    HoleMethod.DRILL: ("G81", "G82"),
    HoleMethod.DEEP_DRILLING: ("G83", "G83"),
    HoleMethod.TAP: ("G84", "G84"),
    HoleMethod.FLOATING_TAP: ("G84", "G84"),
    HoleMethod.REAM: ("G85", "G89"),
    HoleMethod.BORE: ("G86", "G86"),
}


def comment(text: str) -> list[str]:
    """Return the text in brackets; a long one continues in the next line."""
    clean = escape_comment(text)
    starts = range(0, max(len(clean), 1), _COMMENT_LENGTH)
    return [f"( {clean[start : start + _COMMENT_LENGTH].rstrip()} )" for start in starts]


def escape_comment(text: str) -> str:
    """Return the text with square brackets for round ones, which would end the comment."""
    return text.translate({ord("("): "[", ord(")"): "]"})


def tool_call(number: int, name: str, by_name: bool) -> str:
    """Return what follows ``T.``: a number, for tools have no names."""
    if by_name:
        raise UnsupportedFeatureError(Wording("CTL130", "tools_called_number", name=name))
    return str(number)


def template_values(settings: Mapping[str, Value], plane: Floats | None) -> dict[str, Value]:
    """Return what cancels TCP and a plane that an aborted run may have left on, and the work offset in which the rotary
    axes go home before the program needs it; a plane has no angles.
    """
    everything = settings[SAFE_START_SETTING] == ALL_LEFT_ON
    tcp_off = settings["tcp_off"] if everything or settings.get(TCP_USED) else None
    return {
        "cancel_tcp": tcp_off,
        "cancel_plane": "G69" if everything else None,
        OFFSET_BEFORE_TURN: settings.get("work_offset") if everything else None,
    }


def tool_preselection(call: str) -> list[str]:
    """Return nothing: the words of this control are not known."""
    return []


def dwell(event: Dwell, rpm: float | None, formats: Formats) -> list[str]:
    """Return ``G4 HD`` with seconds."""
    return [f"G4 HD{dwell_text(dwell_seconds(event, rpm), formats['dwell'])}"]


def stop(event: Stop, codes: Codes) -> list[str]:
    """Return M0 or M1, after a comment for the operator."""
    return program_stop(event, codes, comment)


def message(event: Message) -> list[str]:
    """Return a comment: it is not known how this control displays a text."""
    return comment(event.text)


def first_block_words(motion: Motion, tool: str, register: int, settings: Mapping[str, str]) -> dict[str, float]:
    """Return nothing."""
    return {}


def validate_operation(operation: Operation, spindle_known: bool) -> list[tuple[int, UnsupportedFeatureError]]:
    """Return a feed per revolution: F is mm/min only."""
    moves = operation.moves
    per_rev = np.flatnonzero(moves.per_rev & (moves.kind != Kind.RAPID))
    if not len(per_rev):
        return []
    return [(int(moves.line[per_rev[0]]), UnsupportedFeatureError(Wording("CTL330", "feed_per_revolution")))]


def validate_settings(settings: Mapping[str, str]) -> list[tuple[str, Wording]]:
    """Return words that switch TCP on and off for different machines."""
    pair = settings.get("tcp_on", "G196"), settings.get("tcp_off", "G197")
    if pair in _TCP_PAIRS or pair[1] not in dict(_TCP_PAIRS).values():
        return []
    return [("tcp_on", phrase("pair_of_tcp_words"))]


def validate_plane(settings: Mapping[str, str], plane: Floats, of_pose: Floats) -> Wording | None:
    """Return None: every plane can be said."""
    return None


def cycle_call(
    cycle: Cycle, top: float, spindle: SpindleState | None, settings: Mapping[str, str], formats: Formats
) -> list[str]:
    """Return the cycle with its first hole: Z is the height of rapid positioning, R the feed start, E the depth."""
    assert cycle.retract_height is not None
    if cycle.method not in _CYCLES:
        raise UnsupportedCycleError(Wording("CTL350", "no_documented_cycle", method=cycle.method))
    _check_thread(cycle, spindle)
    seconds = cycle_dwell_seconds(cycle, spindle)
    number = formats["coordinate"].text
    heights = (("Z", top + cycle.retract_height), ("E", top - cycle.depth), ("R", top + cycle.rapid_height))
    words = [letter + number(height) for letter, height in heights]
    if cycle.method is HoleMethod.DEEP_DRILLING:
        words.append(f"D{number(_peck_depth(cycle))}")
    if seconds:
        words.append(f"H{formats['dwell'].text(seconds)}")
    return [" ".join((_CYCLES[cycle.method][bool(seconds)], FIRST_HOLE, *words))]


def cycle_cancel() -> list[str]:
    """Return G80."""
    return ["G80"]


def _peck_depth(cycle: Cycle) -> float:
    """D: the depth of every peck, the first measured from where the feed begins."""
    if any(cycle.pecks[1:]):
        raise UnsupportedCycleError(Wording("CTL350", "decreasing_peck_depths_d"))
    return cycle.pecks[0]


def _check_thread(cycle: Cycle, spindle: SpindleState | None) -> None:
    """Raise ``HoleCycleError`` for a thread that F cannot cut."""
    if cycle.method not in (HoleMethod.TAP, HoleMethod.FLOATING_TAP):
        return
    running = running_spindle(spindle, "CYCLE/TAP")
    if running.sense is not Sense.CLW:
        raise HoleCycleError(Wording("CTL350", "thread_left_hand"))
    if cycle.feed is None or not cycle.feed > 0.0:
        raise HoleCycleError(Wording("PLN610", "cycle_tap_without"))
    feed = cycle.feed * running.rpm if cycle.per_rev else cycle.feed
    if abs(feed - round(feed)) > _FEED_TOLERANCE:
        raise HoleCycleError(Wording("CTL320", "thread_mm_min", feed=feed))


def row_words(rapid: Flags, per_rev: Flags, codes: Codes) -> dict[str, Ints]:
    """Return G0 or G1; there is one feed mode."""
    return {"motion": np.where(rapid, codes["rapid"], codes["linear"]).astype(np.int64)}


def arc_words(arcs: Arcs, tip: Floats, rows: Ints, codes: Codes, formats: Formats, by_radius: bool = False) -> ArcWords:
    """Return the words of flat circles as ISO has them, but with the centre itself instead of its offset.

    They have no word for the axis across the plane: rounding it would make a helix of them.
    """
    words = iso.arc_words(arcs, tip, rows, codes, formats)
    columns = {word: column for word, column in words.columns.items() if word != "turns"}
    for c, letter in enumerate("IJK"):
        centre = formats["I"].counts(arcs.centre[rows, c])
        columns[letter] = np.where(columns[letter] == ABSENT, ABSENT, centre)
    for c, letter in enumerate("XYZ"):
        end = formats["I"].counts(tip[arcs.row[rows], c])
        columns[letter] = np.where(words.forced[letter] == 1, end, ABSENT)
    return ArcWords(columns, words.forced)
