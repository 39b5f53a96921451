"""What a Fanuc 30i or 31i says that words and templates alone cannot: comments, dwells, planes, the tool's length.

Facts: FANUC's operator's manuals and public posts; docs/controls/fanuc.md has them one by one, and says which depend on
parameters of the control.
"""

import re
import unicodedata
from collections.abc import Mapping
from textwrap import wrap
from typing import Final

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.controls.family_writer import ArcWords, Codes, Formats, UnsupportedFeatureError, WordEvent
from trunnion.controls.template import Value
from trunnion.model.motion import MachiningMode, Motion
from trunnion.model.toolpath import Arcs, CutterComp, Dwell, Message, Operation, Stop
from trunnion.output.coordinates.euler_angles import euler_zxz_angles
from trunnion.output.families import iso
from trunnion.output.families.fanuc.cycles import cycle_lines, is_valid_shift
from trunnion.output.families.iso import row_words as row_words
from trunnion.planning.holes.cycles import Cycle, SpindleState

#: Circles have no word for whole turns; the tool's length and radius are data of the control, called by number.
WORDS: tuple[str, ...] = (
    *(word for word in iso.WORDS if word != "turns"),
    *("length", "length_number", "radius_number", "axis_x", "axis_y", "axis_z"),
)
CODES: tuple[str, ...] = iso.CODES
PLANE_COMMANDS: tuple[str, ...] = ("g68_2",)
SETTING_CHOICES: Mapping[str, tuple[str, ...]] = {
    "contour": ("none", "G05.1", "G05"),
    "orientation": ("angles", "vector"),
}
TEMPLATE_FIELDS: frozenset[str] = frozenset(
    {"plane_first", "plane_second", "plane_third", "contour_on", "contour_off", "call_word", "call_arguments"}
)

#: AI contour control on and off: in the control's own form, and in that of older controls.
_CONTOUR_CONTROL: Final = {"none": (None, None), "G05.1": ("G05.1 Q1", "G05.1 Q0"), "G05": ("G05 P10000", "G05 P0")}

#: The tool's length counts along Z, or along the tool axis while the control holds the tip, which is told rotary
#: positions or vectors.
_LENGTH_CODE: Final = 43.0
_TCP_CODES: Final = {"angles": 43.4, "vector": 43.5}

#: Characters of a comment besides letters and digits; all others become a question mark. ``%`` would end the program.
_COMMENT_SIGNS: Final = frozenset(" .,=+-*/_#[]'!?&<>@")

#: Letters that no accent makes.
_TRANSLITERATION: Final = str.maketrans(
    {"Ø": "O", "Æ": "AE", "Œ": "OE", "Ł": "L", "Đ": "D", "Þ": "TH", "(": "[", ")": "]", ":": "-", ";": "-"}
)

#: Characters between the brackets of a comment: a line of 80 has room for them.
_COMMENT_LENGTH: Final = 76

#: Digits of a program number.
_PROGRAM_NUMBER_DIGITS: Final = 8

#: The call of a program: as a subprogram, or as a macro with arguments. These have a point, without which their numbers
#: would count in increments.
_CALL_PATTERN: Final = re.compile(r"(M98|G65)((?: [A-FHIJKMQ-Z][-+]?(?:\d+\.\d*|\.\d+))*)", re.ASCII)


def comment(text: str) -> list[str]:
    """Brackets around a text in the control's characters; a long one goes on in the next line."""
    return [f"({part})" for part in wrap(escape_comment(text), _COMMENT_LENGTH) or [""]]


def escape_comment(text: str) -> str:
    """A text in capitals, without accents; characters that the control does not have become ``?``.

    Round brackets become square ones: a closing one would end the comment early.
    """
    letters = "".join(c for c in unicodedata.normalize("NFKD", text) if not unicodedata.combining(c))
    capitals = letters.upper().translate(_TRANSLITERATION)
    return "".join(c if c.isascii() and (c.isalnum() or c in _COMMENT_SIGNS) else "?" for c in capitals)


def tool_call(number: int, name: str, by_name: bool) -> str:
    """What stands after ``T``: a number; tools have no names."""
    if by_name:
        raise UnsupportedFeatureError(f"a Fanuc calls tools by number, and not as {name}", "write --set tool=NUMBER")
    return str(number)


def template_values(settings: Mapping[str, Value], plane: Floats | None) -> dict[str, Value]:
    """The Euler angles of a plane about Z, the new X and the new Z; the words that switch contour control; those of a
    call."""
    on, off = _CONTOUR_CONTROL[str(settings["contour"])]
    turned = (None, None, None) if plane is None else euler_zxz_angles(plane)
    names = "plane_first", "plane_second", "plane_third"
    call, _, arguments = str(settings.get("call") or "M98").partition(" ")
    words = {"contour_on": on, "contour_off": off, "call_word": call, "call_arguments": arguments}
    return {**dict(zip(names, turned, strict=True)), **words}


def first_block_words(motion: Motion, tool: str, register: int, settings: Mapping[str, str]) -> dict[str, float]:
    """G43, or G43.4 or G43.5, with H, and D where there is a radius compensation.

    H is the register that LOAD/TOOL names, or else the tool's own number; D is that number.

    They stand with the motion to the first point, and so mean the same whether or not the control moves by itself
    where they stand alone (parameter TOS).
    """
    length = _TCP_CODES[settings["orientation"]] if motion.mode is MachiningMode.TCP else _LENGTH_CODE
    words = {"length": length, "length_number": float(register or tool)}
    compensated = any(isinstance(event, CutterComp) for event in motion.operation.events)
    return {**words, "radius_number": float(tool)} if compensated else words


def event_words(event: WordEvent, codes: Codes, coolant: Codes) -> dict[str, float]:
    """As ISO has them; radius compensation with D where CUTCOM names a register."""
    words = iso.event_words(event, codes, coolant)
    if isinstance(event, CutterComp) and event.register:
        words["radius_number"] = event.register
    return words


def dwell(event: Dwell, rpm: float | None, formats: Formats) -> list[str]:
    """``G4 P`` waits milliseconds; turns of the spindle become the time that they take."""
    seconds = event.amount
    if event.revolutions:
        if rpm is None or not rpm > 0.0:
            raise UnsupportedFeatureError(
                "a dwell in spindle revolutions while the spindle stands", "put SPINDL before it"
            )
        seconds = 60.0 * event.amount / rpm
    return [f"G4 P{formats['dwell'].text(1000.0 * seconds)}"]


def stop(event: Stop, codes: Codes) -> list[str]:
    """M0 or M1, after the text that the operator is to see."""
    code = codes["optional_stop" if event.optional else "stop"]
    return [*(comment(event.text) if event.text else ()), f"M{code}"]


def message(event: Message) -> list[str]:
    """A comment: to show it, the control would have to stop."""
    return comment(event.text)


def validate_operation(operation: Operation, spindle_known: bool) -> list[tuple[int, UnsupportedFeatureError]]:
    """G95 without a spindle speed; G41 and G42 while the tool axis changes, where they would need G41.2 and vectors."""
    found = iso.feed_per_rev_before_spindle(operation, spindle_known)
    changes = np.ptp(operation.moves.axis, axis=0).max(initial=0.0) > 0.0
    why = UnsupportedFeatureError(
        "cutter radius compensation while the tool axis changes", "output the path without CUTCOM"
    )
    return [
        *found,
        *(
            (event.line, why)
            for event in operation.events
            if isinstance(event, CutterComp) and event.side != "OFF" and changes
        ),
    ]


def validate_settings(settings: Mapping[str, str]) -> list[tuple[str, str]]:
    """Numbers that are none."""
    program, tool = settings.get("program", "1"), settings.get("tool", "")
    wrong = []
    if not (program.isdecimal() and program.isascii() and 0 < int(program) < 10**_PROGRAM_NUMBER_DIGITS):
        wrong.append(
            ("program", f"write the program's number, at most {_PROGRAM_NUMBER_DIGITS} digits, such as program=1234")
        )
    if tool and not (tool.isdecimal() and tool.isascii()):
        wrong.append(("tool", "write the tool's number, such as tool=5"))
    if not _is_call(settings.get("call", "M98")):
        wrong.append(("call", "write M98, or G65, with arguments such as G65 A1. B-2.5, each letter once"))
    if not is_valid_shift(settings.get("bore_lift", "")):
        wrong.append(("bore_lift", "write millimetres above 0, such as 0.5, or nothing"))
    return wrong


def _is_call(text: str) -> bool:
    """Whether programs can be called so: M98 takes no arguments, and G65 each letter once."""
    match = _CALL_PATTERN.fullmatch(text)
    letters = [word[0] for word in match[2].split()] if match else []
    return bool(match) and len(set(letters)) == len(letters) and not (letters and text.startswith("M98"))


def cycle_call(
    cycle: Cycle, top: float, turning: SpindleState | None, settings: Mapping[str, str], formats: Formats
) -> list[str]:
    """The cycle with its first hole, and for a tap the word before it that holds the spindle to the feed."""
    return cycle_lines(cycle, top, turning, settings, formats)


def cycle_cancel() -> list[str]:
    """What ends a cycle."""
    return ["G80"]


def arc_words(arcs: Arcs, tip: Floats, rows: Ints, codes: Codes, formats: Formats, by_radius: bool = False) -> ArcWords:
    """As ISO has them; circles of more than one turn do not come here."""
    words = iso.arc_words(arcs, tip, rows, codes, formats)
    return ArcWords({word: column for word, column in words.columns.items() if word != "turns"}, words.forced)
