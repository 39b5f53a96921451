"""What families with G and M words (ISO 6983) share: motion codes, arcs with a relative centre, M words."""

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.controls.family_writer import ArcWords, Codes, Formats, UnsupportedFeatureError, WordEvent
from trunnion.controls.words import ABSENT
from trunnion.messages import Wording
from trunnion.model.toolpath import Arcs, Coolant, Kind, Operation, Sense, SpindleOff, SpindleOn

WORDS: tuple[str, ...] = (
    "cutter_comp", "feed_mode", "plane", "motion", "I", "J", "K", "turns", "speed", "spindle", "coolant", "feed",
    "feed_per_rev", "inverse_feed",
)  # fmt: skip

CODES: tuple[str, ...] = (
    "rapid", "linear", "arc_clockwise", "arc_counterclockwise", "plane_xy", "plane_zx", "plane_yz",
    "feed_per_minute", "feed_per_revolution", "feed_inverse_time", "comp_off", "comp_left", "comp_right",
    "spindle_clockwise", "spindle_counterclockwise", "spindle_off", "stop", "optional_stop",
)  # fmt: skip

# By the axis of an arc: its plane, the words of its centre, and those of its end in that plane.
_PLANE_CODES = ("plane_yz", "plane_zx", "plane_xy")
_CENTRE_WORDS = (("J", "K"), ("K", "I"), ("I", "J"))
_END_WORDS = (("Y", "Z"), ("Z", "X"), ("X", "Y"))

_COMP_CODES = {"LEFT": "comp_left", "RIGHT": "comp_right", "OFF": "comp_off"}
_COMP_PLANE_CODES = {"XYPLAN": "plane_xy", "ZXPLAN": "plane_zx", "YZPLAN": "plane_yz"}


def event_words(event: WordEvent, codes: Codes, coolant: Codes) -> dict[str, float]:
    """Return S and M of the spindle, M of the coolant, or G of cutter radius compensation and its plane."""
    if isinstance(event, SpindleOn):
        turn = "spindle_clockwise" if event.sense is Sense.CLW else "spindle_counterclockwise"
        return {"speed": event.rpm, "spindle": codes[turn]}
    if isinstance(event, SpindleOff):
        return {"spindle": codes["spindle_off"]}
    if isinstance(event, Coolant):
        return {"coolant": coolant[event.kind]}
    words: dict[str, float] = {"cutter_comp": codes[_COMP_CODES[event.side]]} if event.side in _COMP_CODES else {}
    if event.plane in _COMP_PLANE_CODES:
        words["plane"] = codes[_COMP_PLANE_CODES[event.plane]]
    return words


def feed_per_rev_before_spindle(operation: Operation, spindle_known: bool) -> list[tuple[int, UnsupportedFeatureError]]:
    """Return the first feed per revolution before a spindle speed, as ``FamilyWriter.validate_operation`` does."""
    rows = [event.row for event in operation.events if isinstance(event, SpindleOn)]
    moves = operation.moves
    first = 0 if spindle_known else min(rows, default=len(moves))
    early = np.flatnonzero(moves.per_rev[:first] & (moves.kind[:first] != Kind.RAPID))
    if not len(early):
        return []
    why = UnsupportedFeatureError(Wording("CTL330", "feed_per_revolution_before"))
    return [(int(moves.line[early[0]]), why)]


def row_words(rapid: Flags, per_rev: Flags, codes: Codes) -> dict[str, Ints]:
    """Return G0 or G1, and the feed mode of rows that have a feed."""
    mode = np.where(per_rev, codes["feed_per_revolution"], codes["feed_per_minute"])
    return {
        "motion": np.where(rapid, codes["rapid"], codes["linear"]).astype(np.int64),
        "feed_mode": np.where(rapid, ABSENT, mode).astype(np.int64),
    }


def arc_words(arcs: Arcs, tip: Floats, rows: Ints, codes: Codes, formats: Formats, by_radius: bool = False) -> ArcWords:
    """Return G2 or G3 in G17, G18 or G19 with the centre relative to the start; as ``FamilyWriter.arc_words``.

    G2 is clockwise as seen against the normal of the plane: +Y for ZX, whose centre has the words I and K, and +X for
    YZ, whose centre has J and K. ``turns`` counts whole turns besides the arc.
    """
    normal = arcs.normal[rows]
    about = np.argmax(np.abs(normal), axis=1)
    positive = normal[np.arange(len(rows)), about] > 0
    columns = {
        "motion": np.where(positive, codes["arc_counterclockwise"], codes["arc_clockwise"]).astype(np.int64),
        "plane": np.array([codes[plane] for plane in _PLANE_CODES], np.int64)[about],
        "turns": np.where(arcs.full_turns[rows] > 0, arcs.full_turns[rows], ABSENT),
    }
    offset = arcs.centre[rows] - tip[arcs.row[rows] - 1]
    forced: dict[str, Ints] = {}
    for c, letter in enumerate("IJK"):
        used = np.array([letter in _CENTRE_WORDS[axis] for axis in range(3)])[about]
        columns[letter] = np.where(used, formats["I"].counts(offset[:, c]), ABSENT)
        forced["XYZ"[c]] = np.array(["XYZ"[c] in _END_WORDS[axis] for axis in range(3)], np.int64)[about]
    return ArcWords(columns, forced)
