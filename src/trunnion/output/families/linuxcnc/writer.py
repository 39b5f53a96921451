"""What LinuxCNC says that words and templates alone cannot: comments, messages, dwells, turns of a circle.

Facts: LinuxCNC's G code reference; docs/controls/linuxcnc.md has them one by one.
"""

from collections.abc import Mapping
from typing import Final

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.controls.family_writer import ArcWords, Codes, Formats, UnsupportedFeatureError
from trunnion.controls.template import Value
from trunnion.controls.words import ABSENT
from trunnion.model.motion import Motion
from trunnion.model.toolpath import Arcs, CutterComp, Dwell, Message, Operation, Stop
from trunnion.output.families import iso
from trunnion.output.families.iso import event_words as event_words
from trunnion.output.families.iso import row_words as row_words
from trunnion.output.families.linuxcnc.cycles import cycle_lines
from trunnion.planning.holes.cycles import Cycle, SpindleState

WORDS: tuple[str, ...] = iso.WORDS
CODES: tuple[str, ...] = iso.CODES
PLANE_COMMANDS: tuple[str, ...] = ()
SETTING_CHOICES: Mapping[str, tuple[str, ...]] = {}
TEMPLATE_FIELDS: frozenset[str] = frozenset()

#: Bytes of a text in one line: a line has room for 255, with its block number and what surrounds the text.
_COMMENT_LENGTH: Final = 200


def comment(text: str) -> list[str]:
    """A semicolon begins a comment, a blank after it one that does nothing; a long one goes on in the next line."""
    return [f"; {part}" for part in _split_text(text)]


def escape_comment(text: str) -> str:
    """Nothing needs to be changed in what stands after a semicolon."""
    return text


def tool_call(number: int, name: str, by_name: bool) -> str:
    """What stands after ``T``: a number; tools have no names."""
    if by_name:
        raise UnsupportedFeatureError(f"LinuxCNC calls tools by number, and not as {name}", "write --set tool=NUMBER")
    return str(number)


def template_values(settings: Mapping[str, Value], plane: Floats | None) -> dict[str, Value]:
    """Nothing: there are no tilted planes."""
    return {}


def dwell(event: Dwell, rpm: float | None, formats: Formats) -> list[str]:
    """``G4 P`` waits seconds; turns of the spindle become the seconds that they take."""
    if not event.revolutions:
        return [f"G4 P{formats['dwell'].text(event.amount)}"]
    if rpm is None or not rpm > 0.0:
        raise UnsupportedFeatureError("a dwell in spindle revolutions while the spindle stands", "put SPINDL before it")
    return [f"G4 P{formats['dwell'].text(60.0 * event.amount / rpm)}"]


def stop(event: Stop, codes: Codes) -> list[str]:
    """M0 or M1, after the text that the operator is to see."""
    code = codes["optional_stop" if event.optional else "stop"]
    return [*(_operator_message(event.text) if event.text else ()), f"M{code}"]


def first_block_words(motion: Motion, tool: str, register: int, settings: Mapping[str, str]) -> dict[str, float]:
    """None."""
    return {}


def validate_operation(operation: Operation, spindle_known: bool) -> list[tuple[int, UnsupportedFeatureError]]:
    """G95 without a spindle speed, and G41 or G42 in the plane YZ."""
    compensated = [
        (
            event.line,
            UnsupportedFeatureError("cutter radius compensation in the plane YZ", "output the path without CUTCOM"),
        )
        for event in operation.events
        if isinstance(event, CutterComp) and event.plane == "YZPLAN" and event.side != "OFF"
    ]
    return [*compensated, *iso.feed_per_rev_before_spindle(operation, spindle_known)]


def validate_settings(settings: Mapping[str, str]) -> list[tuple[str, str]]:
    """None."""
    return []


def cycle_call(
    cycle: Cycle, top: float, turning: SpindleState | None, settings: Mapping[str, str], formats: Formats
) -> list[str]:
    """The cycle with its first hole, or the blocks of each hole of a rigid tap."""
    return cycle_lines(cycle, top, turning, formats)


def cycle_cancel() -> list[str]:
    """What ends a cycle."""
    return ["G80"]


def message(event: Message) -> list[str]:
    """A comment, or for the operator ``(MSG, …)``."""
    return _operator_message(event.text) if event.display else comment(event.text)


def arc_words(arcs: Arcs, tip: Floats, rows: Ints, codes: Codes, formats: Formats, by_radius: bool = False) -> ArcWords:
    """As ISO has them; ``P`` counts the arc itself too: P2 is one whole turn besides."""
    words = iso.arc_words(arcs, tip, rows, codes, formats)
    turns = words.columns["turns"]
    return ArcWords({**words.columns, "turns": np.where(turns == ABSENT, ABSENT, turns + 1)}, words.forced)


def _operator_message(text: str) -> list[str]:
    """``(MSG, …)``; brackets inside would end the text early."""
    return [f"(MSG, {part})" for part in _split_text(text.translate({ord("("): "[", ord(")"): "]"}))]


def _split_text(text: str) -> list[str]:
    """A text in pieces of no more than ``_COMMENT_LENGTH`` bytes; never a piece less than one."""
    pieces = [""]
    for character in text:
        if len((pieces[-1] + character).encode()) > _COMMENT_LENGTH:
            pieces.append("")
        pieces[-1] += character
    return pieces
