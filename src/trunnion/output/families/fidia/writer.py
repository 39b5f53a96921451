"""What a Fidia NC15 says that words and templates alone cannot: absolute centres, comments, dwells, its own cycles.

Facts: the program that ran on an HS664RT, and public posts for Fidia controls; docs/controls/fidia.md has them one by
one, and says which are unconfirmed.
"""

from collections.abc import Mapping
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.controls.family_writer import FIRST_HOLE, ArcWords, Codes, Formats, UnsupportedFeatureError
from trunnion.controls.template import Value
from trunnion.controls.words import ABSENT, round_to_counts
from trunnion.model.motion import Motion
from trunnion.model.toolpath import Arcs, Dwell, Kind, Message, Operation, Sense, Stop
from trunnion.output.families import iso
from trunnion.output.families.iso import event_words as event_words
from trunnion.planning.holes.cycles import Cycle, HoleCycleError, HoleMethod, SpindleState, UnsupportedCycleError

WORDS: tuple[str, ...] = (
    "cutter_comp", "plane", "motion", "I", "J", "K", "speed", "spindle", "coolant", "feed",
)  # fmt: skip
CODES: tuple[str, ...] = tuple(code for code in iso.CODES if not code.startswith("feed_"))
PLANE_COMMANDS: tuple[str, ...] = ("g154",)
SETTING_CHOICES: Mapping[str, tuple[str, ...]] = {}
TEMPLATE_FIELDS: frozenset[str] = frozenset()

#: Characters between the brackets of a comment: a line of 80 has room for them, with a blank on either side.
_COMMENT_LENGTH: Final = 76

#: A thread's feed may be off its pitch by this much in mm/min when it is printed as a whole number.
_FEED_TOLERANCE: Final = 0.005

#: G words of cycles; tapping, reaming and boring to a stop have one each, with a dwell or without.
_CYCLES: Final = {
    HoleMethod.DRILL: ("G81", "G82"),
    HoleMethod.DEEP_DRILLING: ("G83", "G83"),
    HoleMethod.TAP: ("G84", "G84"),
    HoleMethod.FLOATING_TAP: ("G84", "G84"),
    HoleMethod.REAM: ("G85", "G89"),
    HoleMethod.BORE: ("G86", "G86"),
}


def comment(text: str) -> list[str]:
    """Brackets around a text without any; a long one goes on in the next line."""
    clean = escape_comment(text)
    return [f"( {clean[at : at + _COMMENT_LENGTH].rstrip()} )" for at in range(0, max(len(clean), 1), _COMMENT_LENGTH)]


def escape_comment(text: str) -> str:
    """A closing bracket would end the comment early."""
    return text.translate({ord("("): "[", ord(")"): "]"})


def tool_call(number: int, name: str, by_name: bool) -> str:
    """What stands after ``T.``: a number; tools have no names."""
    if by_name:
        raise UnsupportedFeatureError(f"a Fidia calls tools by number, and not as {name}", "write --set tool=NUMBER")
    return str(number)


def template_values(settings: Mapping[str, Value], plane: Floats | None) -> dict[str, Value]:
    """Nothing: a plane has no angles."""
    return {}


def dwell(event: Dwell, rpm: float | None, formats: Formats) -> list[str]:
    """``G4 HD`` waits seconds; turns of the spindle become the seconds that they take."""
    return [f"G4 HD{formats['dwell'].text(_dwell_seconds(event.amount, event.revolutions, rpm))}"]


def _dwell_seconds(amount: float, revolutions: bool, rpm: float | None) -> float:
    if not revolutions:
        return amount
    if rpm is None or not rpm > 0.0:
        raise UnsupportedFeatureError("a dwell in spindle revolutions while the spindle stands", "put SPINDL before it")
    return 60.0 * amount / rpm


def stop(event: Stop, codes: Codes) -> list[str]:
    """M0 or M1, after the text that the operator is to see."""
    code = codes["optional_stop" if event.optional else "stop"]
    return [*(comment(event.text) if event.text else ()), f"M{code}"]


def message(event: Message) -> list[str]:
    """A comment: nobody says how this control shows a text."""
    return comment(event.text)


def first_block_words(motion: Motion, tool: str, register: int, settings: Mapping[str, str]) -> dict[str, float]:
    """None."""
    return {}


def validate_operation(operation: Operation, spindle_known: bool) -> list[tuple[int, UnsupportedFeatureError]]:
    """F is mm/min and nothing else."""
    moves = operation.moves
    per_rev = np.flatnonzero(moves.per_rev & (moves.kind != Kind.RAPID))
    if not len(per_rev):
        return []
    why = UnsupportedFeatureError(
        "a feed per revolution, which this control does not have", "output it in mm/min (FEDRAT/MMPM)"
    )
    return [(int(moves.line[per_rev[0]]), why)]


def validate_settings(settings: Mapping[str, str]) -> list[tuple[str, str]]:
    """A rapid feed that is none; it is printed as a whole number."""
    text = settings.get("rapid_feed", "1")
    return [] if text.isdigit() and int(text) > 0 else [("rapid_feed", "write mm/min, a whole number such as 3000")]


def cycle_call(
    cycle: Cycle, top: float, turning: SpindleState | None, settings: Mapping[str, str], formats: Formats
) -> list[str]:
    """The cycle with its first hole. Z is the height of rapid positioning, R where the feed begins, E the depth."""
    assert cycle.retract_height is not None
    if cycle.method not in _CYCLES:
        what = f"{cycle.method} has no cycle on this control whose words are known"
        raise UnsupportedCycleError(what, "output the holes as motion")
    _check_thread(cycle, turning)
    try:
        dwell = _dwell_seconds(cycle.dwell, cycle.dwell_in_revolutions, None if turning is None else turning.rpm)
    except UnsupportedFeatureError as why:
        raise HoleCycleError(why.what, why.cure) from None
    number = formats["coordinate"].text
    heights = (("Z", top + cycle.retract_height), ("E", top - cycle.depth), ("R", top + cycle.rapid_height))
    words = [letter + number(height) for letter, height in heights]
    if cycle.method is HoleMethod.DEEP_DRILLING:
        words.append(f"D{number(_peck_depth(cycle))}")
    if dwell:
        words.append(f"H{formats['dwell'].text(dwell)}")
    return [" ".join((_CYCLES[cycle.method][bool(dwell)], FIRST_HOLE, *words))]


def _peck_depth(cycle: Cycle) -> float:
    """D is one stroke: all are alike, and counted from where the feed begins."""
    if any(cycle.strokes[1:]):
        raise UnsupportedCycleError("strokes that become shorter, where D is one stroke", "write STEP with one number")
    return cycle.strokes[0]


def _check_thread(cycle: Cycle, turning: SpindleState | None) -> None:
    """Raise ``HoleCycleError`` for a thread that F cannot cut."""
    if cycle.method not in (HoleMethod.TAP, HoleMethod.FLOATING_TAP):
        return
    if turning is None or not turning.rpm > 0.0:
        raise HoleCycleError("CYCLE/TAP while the spindle stands still", "put SPINDL before the cycle")
    if turning.sense is not Sense.CLW:
        raise HoleCycleError("a thread with a left hand, for which no cycle is known", "output it as motion")
    if cycle.feed is None or not cycle.feed > 0.0:
        raise HoleCycleError("CYCLE/TAP without a feed", "write MMPR,pitch")
    feed = cycle.feed * turning.rpm if cycle.per_rev else cycle.feed
    if abs(feed - round(feed)) > _FEED_TOLERANCE:
        what = f"a thread at {feed:.3f} mm/min, and F is a whole number: the pitch would be wrong"
        raise HoleCycleError(what, "choose a speed at which pitch times speed is whole")


def cycle_cancel() -> list[str]:
    """What ends a cycle."""
    return ["G80"]


def row_words(rapid: Flags, per_rev: Flags, codes: Codes) -> dict[str, Ints]:
    """The motion alone: F has but one meaning."""
    return {"motion": np.where(rapid, codes["rapid"], codes["linear"]).astype(np.int64)}


def arc_words(arcs: Arcs, tip: Floats, rows: Ints, codes: Codes, formats: Formats, by_radius: bool = False) -> ArcWords:
    """As ISO has them, but with the centre itself instead of the way to it.

    Only flat circles come here. Theirs is no word for the axis across the plane: rounding it would make them rise.
    """
    words = iso.arc_words(arcs, tip, rows, codes, formats)
    columns = {word: column for word, column in words.columns.items() if word != "turns"}
    decimals = formats["I"].decimals
    for c, letter in enumerate("IJK"):
        centre = round_to_counts(np.ascontiguousarray(arcs.centre[rows, c]), decimals)
        columns[letter] = np.where(columns[letter] == ABSENT, ABSENT, centre)
    for c, letter in enumerate("XYZ"):
        end = round_to_counts(np.ascontiguousarray(tip[arcs.row[rows], c]), decimals)
        columns[letter] = np.where(words.forced[letter] == 1, end, ABSENT)
    return ArcWords(columns, words.forced)
