"""The writer of a toy control: blocks such as ``LINE X1.5 Y2. B3. F300.``; circles have absolute centres."""

import re
from collections.abc import Mapping

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.controls.family_writer import ArcWords, Codes, Formats, UnsupportedFeatureError, WordEvent
from trunnion.controls.template import Value
from trunnion.controls.words import ABSENT, IncrementWords, round_to_counts
from trunnion.messages import Wording, foreign
from trunnion.model.motion import Motion
from trunnion.model.toolpath import Arcs, Coolant, CutterComp, Dwell, Kind, Message, Operation, Sense, SpindleOn, Stop
from trunnion.planning.holes.cycles import Cycle, SpindleState, UnsupportedCycleError

WORDS: tuple[str, ...] = (
    "rapid", "line", "clockwise", "counterclockwise", "I", "J", "speed", "spindle", "coolant", "feed",
)  # fmt: skip
CODES: tuple[str, ...] = ("spindle_clockwise", "spindle_counterclockwise", "spindle_off", "stop", "optional_stop")
PLANE_COMMANDS: tuple[str, ...] = ()
PLANE_TEMPLATES_OF: dict[str, str] = {}
SETTING_FIELDS: dict[str, tuple[str, ...]] = {}
SETTING_CHOICES: Mapping[str, tuple[str, ...]] = {}
COMPENSATES_WITH_TCP = True
SETTING_MEANINGS: Mapping[str, str] = {}
LINE_COMMENTS: tuple[str, ...] = ("; ",)
COMMENTS: re.Pattern[str] = re.compile(r"(;.*)")
BLOCK_NUMBER_LETTERS: tuple[str, ...] = ("N", "")
HIGHEST_BLOCK_NUMBER = 99999999
NEVER_NUMBERED = ""
INCREMENTS: IncrementWords | None = None
TEMPLATE_FIELDS: frozenset[str] = frozenset()


def comment(text: str) -> list[str]:
    return [f"; {text}"]


def escape_comment(text: str) -> str:
    return text


def tool_call(number: int, name: str, by_name: bool) -> str:
    if by_name:
        what = f"tools are called by number, and not as {name}"
        raise UnsupportedFeatureError(foreign(what, "write --set tool=NUMBER", "CTL130"))
    return str(number)


def dwell(event: Dwell, rpm: float | None, formats: Formats) -> list[str]:
    if event.revolutions:
        raise UnsupportedFeatureError(foreign("a dwell in spindle revolutions", "write seconds", "CTL420"))
    return [f"WAIT {formats['dwell'].text(event.amount)}"]


def stop(event: Stop, codes: Codes) -> list[str]:
    return [f"M{codes['optional_stop' if event.optional else 'stop']}"]


def message(event: Message) -> list[str]:
    return comment(event.text)


def event_words(event: WordEvent, codes: Codes, coolant: Codes) -> dict[str, float]:
    if isinstance(event, SpindleOn):
        turn = "spindle_clockwise" if event.sense is Sense.CLW else "spindle_counterclockwise"
        return {"speed": event.rpm, "spindle": codes[turn]}
    if isinstance(event, Coolant):
        return {"coolant": coolant[event.kind]}
    return {} if isinstance(event, CutterComp) else {"spindle": codes["spindle_off"]}


def first_block_words(motion: Motion, tool: str, register: int, settings: Mapping[str, str]) -> dict[str, float]:
    return {}


def validate_operation(operation: Operation, spindle_known: bool) -> list[tuple[int, UnsupportedFeatureError]]:
    moves = operation.moves
    per_rev = np.flatnonzero(moves.per_rev & (moves.kind != Kind.RAPID))
    why = UnsupportedFeatureError(foreign("a feed per revolution", "output it in mm/min (FEDRAT/MMPM)", "CTL330"))
    return [(int(moves.line[row]), why) for row in per_rev[:1]]


def validate_settings(settings: Mapping[str, str]) -> list[tuple[str, Wording]]:
    return []


def cycle_call(
    cycle: Cycle, top: float, spindle: SpindleState | None, settings: Mapping[str, str], formats: Formats
) -> list[str]:
    what = f"{cycle.method}: the toy has no cycles"
    raise UnsupportedCycleError(foreign(what, "output the holes as motion", "CTL350"))


def cycle_cancel() -> list[str]:
    return []


def row_words(rapid: Flags, per_rev: Flags, codes: Codes) -> dict[str, Ints]:
    return {
        "rapid": np.where(rapid, 1, ABSENT).astype(np.int64),
        "line": np.where(rapid, ABSENT, 1).astype(np.int64),
    }


def arc_words(arcs: Arcs, tip: Floats, rows: Ints, codes: Codes, formats: Formats, by_radius: bool = False) -> ArcWords:
    left = arcs.normal[rows, 2] > 0.0
    columns = {
        "line": np.full(len(rows), ABSENT),
        "clockwise": np.where(left, ABSENT, 1),
        "counterclockwise": np.where(left, 1, ABSENT),
    }
    for c, word in enumerate("IJ"):
        columns[word] = round_to_counts(np.ascontiguousarray(arcs.centre[rows, c]), formats[word].decimals)
    always = np.ones(len(rows), np.int64)
    return ArcWords(columns, {"X": always, "Y": always})


def template_values(settings: Mapping[str, Value], plane: Floats | None) -> dict[str, Value]:
    return {}
