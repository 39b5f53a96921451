"""Writer of LinuxCNC: what words and templates cannot express.

Facts: LinuxCNC's G code reference; docs/controls/linuxcnc.md lists them.
"""

import re
from collections.abc import Mapping
from typing import Final

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.controls.family_writer import ArcWords, Codes, Formats, UnsupportedFeatureError
from trunnion.controls.template import Value
from trunnion.controls.words import ABSENT, IncrementWords
from trunnion.messages import Wording
from trunnion.model.motion import Motion
from trunnion.model.toolpath import Arcs, BlockSkip, CutterComp, Dwell, Message, Operation, Stop
from trunnion.output.families.linuxcnc.cycles import cycle_lines
from trunnion.output.shared import iso
from trunnion.output.shared.iso import event_words as event_words
from trunnion.output.shared.iso import row_words as row_words
from trunnion.output.shared.lines import program_stop, split_text
from trunnion.output.shared.spindle import dwell_seconds, dwell_text
from trunnion.output.shared.splines import spline_lines as spline_lines
from trunnion.output.shared.splines import takes_spline as takes_spline
from trunnion.planning.holes.cycles import Cycle, SpindleState

#: Radius compensation works in the working plane, wherever the tool points.
COMPENSATES_WITH_TCP = True

WORDS: tuple[str, ...] = iso.WORDS
CODES: tuple[str, ...] = iso.CODES
PLANE_COMMANDS: tuple[str, ...] = ()
PLANE_TEMPLATES_OF: Mapping[str, str] = {}
PLANES_OF_POSE: frozenset[str] = frozenset()
SETTING_CHOICES: Mapping[str, tuple[str, ...]] = {}
SETTING_MEANINGS: Mapping[str, str] = {}
SETTING_FIELDS: Mapping[str, tuple[str, ...]] = {}
LINE_COMMENTS: tuple[str, ...] = ("; ",)
COMMENTS: re.Pattern[str] = re.compile(r"(;.*|\([^)]*\))")
BLOCK_NUMBER_LETTERS: tuple[str, ...] = ("N", "")
HIGHEST_BLOCK_NUMBER = 99999
NEVER_NUMBERED = ""
INCREMENTS: IncrementWords | None = IncrementWords("G91", "G90")
TEMPLATE_FIELDS: frozenset[str] = frozenset()

#: How a comment begins that LinuxCNC executes, after a semicolon as in brackets: it shows or logs texts, opens files,
#: ends the program or runs Python; its screens draw or stop by others.
_EXECUTED: Final = re.compile(
    r"\s*(?:(?:msg|debug|print|log|py|pyrun|abort|axis|preview)\s*,|logopen|logappend|logclose|probeopen|probeclose|active_)",
    re.IGNORECASE,
)

#: Bytes of a text in one line: a line has room for 255, with the block number and what surrounds the text.
_TEXT_BYTES: Final = 200


def comment(text: str) -> list[str]:
    """Return lines that start with a semicolon and a blank."""
    return [f"; {part}" for part in split_text(text, _TEXT_BYTES, escape_comment)]


def escape_comment(text: str) -> str:
    """Return the text, after a dash where LinuxCNC would execute it; every character is allowed after a semicolon."""
    return f"- {text}" if _EXECUTED.match(text) else text


def tool_call(number: int, name: str, by_name: bool) -> str:
    """Return what follows ``T``: a number, for tools have no names."""
    if by_name:
        raise UnsupportedFeatureError(Wording("CTL130", "tools_called_number", name=name))
    return str(number)


def template_values(settings: Mapping[str, Value], plane: Floats | None) -> dict[str, Value]:
    """Return nothing: there are no tilted planes."""
    return {}


def tool_preselection(call: str) -> list[str]:
    """Return ``T``; ``M6`` changes to it later."""
    return [f"T{call}"]


def dwell(event: Dwell, rpm: float | None, formats: Formats) -> list[str]:
    """Return ``G4 P`` with seconds."""
    return [f"G4 P{dwell_text(dwell_seconds(event, rpm), formats['dwell'])}"]


def stop(event: Stop, codes: Codes) -> list[str]:
    """Return M0 or M1, after a message to the operator."""
    return program_stop(event, codes, _operator_message)


def message(event: Message) -> list[str]:
    """Return a comment, or ``(MSG, …)`` for the operator."""
    return _operator_message(event.text) if event.display else comment(event.text)


def _operator_message(text: str) -> list[str]:
    """Return ``(MSG, …)`` with square brackets for round ones, which would end the text."""
    return [f"(MSG, {part})" for part in split_text(text.translate({ord("("): "[", ord(")"): "]"}), _TEXT_BYTES)]


def first_block_words(motion: Motion, tool: str, register: int, settings: Mapping[str, str]) -> dict[str, float]:
    """Return nothing."""
    return {}


def validate_operation(operation: Operation, spindle_known: bool) -> list[tuple[int, UnsupportedFeatureError]]:
    """Return G95 without a spindle speed, G41 or G42 in the plane YZ, and one of them while one is on."""
    why = UnsupportedFeatureError(Wording("CTL220", "cutter_radius_compensation_plane"))
    compensated = [
        (event.line, why)
        for event in operation.events
        if isinstance(event, CutterComp) and event.plane == "YZPLAN" and event.side != "OFF"
    ]
    return [*compensated, *_begun_twice(operation), *iso.feed_per_rev_before_spindle(operation, spindle_known)]


def _begun_twice(operation: Operation) -> list[tuple[int, UnsupportedFeatureError]]:
    """Return G41 and G42 while one of them may be on; the same side again has no word, unless blocks are skipped."""
    found = []
    sides, before_skip, is_known = {"OFF"}, {"OFF"}, True
    for event in operation.events:
        if isinstance(event, BlockSkip):
            before_skip, sides = (sides, sides) if event.on else (before_skip, sides | before_skip)
            is_known = event.on and is_known
        elif isinstance(event, CutterComp):
            on = sides - {"OFF"}
            if event.side != "OFF" and on and (not is_known or on != {event.side}):
                wording = Wording("CTL220", "cutcom_begins_twice", side=event.side, before=min(on))
                found.append((event.line, UnsupportedFeatureError(wording)))
            sides, is_known = {event.side}, True
    return found


def validate_settings(settings: Mapping[str, str]) -> list[tuple[str, Wording]]:
    """Return nothing."""
    return []


def validate_plane(settings: Mapping[str, str], plane: Floats, of_pose: Floats) -> Wording | None:
    """Return None: every plane can be said."""
    return None


def cycle_call(
    cycle: Cycle, top: float, spindle: SpindleState | None, settings: Mapping[str, str], formats: Formats
) -> list[str]:
    """Return the cycle with its first hole, or the blocks of each hole of a rigid tap."""
    return cycle_lines(cycle, top, spindle, formats)


def cycle_cancel() -> list[str]:
    """Return G80."""
    return ["G80"]


def arc_words(arcs: Arcs, tip: Floats, rows: Ints, codes: Codes, formats: Formats, by_radius: bool = False) -> ArcWords:
    """Return the words as ISO has them; ``P`` counts the arc as well: P2 is one whole turn and the arc."""
    words = iso.arc_words(arcs, tip, rows, codes, formats)
    turns = words.columns["turns"]
    return ArcWords({**words.columns, "turns": np.where(turns == ABSENT, ABSENT, turns + 1)}, words.forced)
