"""The words of LinuxCNC."""

import re
from typing import Final

from trunnion.messages import Wording
from trunnion.readers.program.word_values import ABOVE_ZERO, between, one_of, whole
from trunnion.readers.rs274.block import Block
from trunnion.readers.rs274.iso_words import COMMON_WORDS, COMPENSATION
from trunnion.readers.rs274.word_table import Effect, When, Word, WordTable

_NONE, _WARNING, _ERROR = Effect.NONE, Effect.WARNING, Effect.ERROR
_BEHIND, _AFTER = When.BEHIND_MODES, When.AFTER_MOTION

_SWITCH, _BIT, _REGISTER = one_of(0, 1), whole(0, 63), whole(0, 99999)

#: What the interpreter refuses while radius compensation is on.
_WITHIN_COMPENSATION: Final = dict.fromkeys(
    (
        "offset", "plane", "length", "path control", "M6", "axis_offset", "set_data", "go_home", "store_home", "cycle",
        "line", "G33.1", "G53", "compensation", "signal", "wait_for_input", "analog_output", "tcp",
    ),
    "refused",
)  # fmt: skip

#: Which code has which letters, values and group: LinuxCNC's own list, and its interpreter.
TABLE: Final = WordTable(
    *COMMON_WORDS,
    Word("G4", "dwell, seconds", act="dwell", sets="P", group="non-modal", letters="P", when=_BEHIND),
    Word("G5", "a cubic spline", act="motion", group="motion", letters="IJPQ"),
    Word("G5.1", "a quadratic spline", act="motion", group="motion", letters="IJ"),
    Word("G5.2", "control points of a NURBS", act="motion", group="motion", letters="PL"),
    Word("G5.3", "ends the NURBS, and moves along it", act="motion", group="motion"),
    Word("G6.2", "a NURBS, taken as nothing", effect=_ERROR, letters="XYPLDEFIJKQR", moves=False),
    Word("G6.3", "a NURBS, taken as nothing", effect=_ERROR, moves=False),
    Word("G7", "turning is not simulated", effect=_ERROR, group="diameters"),
    Word("G8", effect=_NONE, group="diameters"),
    Word(
        "G10", "sets a work offset", act="set_data", group="non-modal", letters="LPR", when=_BEHIND, moves=False,
    ),
    Word("G17.1 G18.1 G19.1", "a plane of U V W is not simulated", effect=_ERROR, group="plane"),
    Word("G20 G21", "inches, millimetres; also of feeds", act="units", sets=(True, False), group="units"),
    Word(
        "G28 G30", "by the programmed point to a stored position", act="go_home", group="non-modal", when=_BEHIND,
        moves=False,
    ),
    Word(
        "G28.1 G30.1", "stores the present position", act="store_home", sets=("G28", "G30"), group="non-modal",
        when=_BEHIND,
    ),
    Word("G33", "thread cutting is taken as a straight line", effect=_ERROR, act="line", group="motion", letters="K"),
    Word("G33.1", "rigid tapping", act="motion", group="motion"),
    Word("G38.2 G38.3 G38.4 G38.5", "probing is taken as a straight line", effect=_ERROR, act="line", group="motion"),
    Word(
        "G41 G42", COMPENSATION, effect=_WARNING, act="compensation", sets=(1, -1), group="compensation", letters="D",
        values={"D": _REGISTER},
    ),
    Word(
        "G41.1 G42.1", COMPENSATION, effect=_WARNING, act="compensation", sets=(1, -1), group="compensation",
        letters="DL",
    ),
    Word(
        "G43", "tool length along Z, of `H` or of the tool in the spindle", act="length", sets=True, group="length",
        letters="H", values={"H": _REGISTER},
    ),
    Word("G49", "tool length off", act="length", sets=False, group="length"),
    Word(
        "G43.1", "`Z` in the place of the tool length; an error where another is stated", effect=_NONE,
        act="added_length", group="length", letters="XYZABCUVW", moves=False,
    ),
    Word(
        "G43.2", "adds to the tool length: event `delta`; `H`: an error", effect=_NONE, act="added_length",
        group="length", letters="H", moves=False,
    ),
    Word("G52", "shift of all work offsets", act="axis_offset", group="non-modal", when=_BEHIND, moves=False),
    Word("G53", "positions of the machine, with `G90` and `G0` or `G1`", group="non-modal"),
    Word(
        "G54 G55 G56 G57 G58 G59 G59.1 G59.2 G59.3", "work offset", act="work_offset", sets=(1, 2, 3, 4, 5, 6, 7, 8, 9),
        group="offset",
    ),
    Word(
        "G61 G61.1", "events `tolerance` 0 and `exact_stop`: `path`, `on`", effect=_NONE, act="exact_path",
        sets=("path", "on"), group="path control",
    ),
    Word(
        "G64", "events `tolerance`, the wider of `P` and `Q`, and `exact_stop`: `off`", effect=_NONE, act="blending",
        group="path control", letters="PQ",
    ),
    Word(
        "G70 G71 G71.1 G71.2 G72 G72.1 G72.2", "a turning cycle is not simulated", effect=_ERROR, group="motion",
        letters="XZDEPQIR", moves=False,
    ),
    Word(
        "G76", "a threading cycle is not simulated", effect=_ERROR, group="motion", letters="XZPIJKRQHEL", moves=False,
    ),
    Word("G74 G81 G84 G85 G87", "cycle", act="cycle", group="motion", needs="ZR"),
    Word("G82 G86 G88 G89", "cycle with a dwell", act="cycle", group="motion", needs="ZRP"),
    Word("G73 G83", "cycle with pecks", act="cycle", group="motion", needs="ZRQ"),
    Word("G90.1 G91.1", "centres of circles: absolute, relative", effect=_NONE, act="centres", sets=(False, True),
         group="centres"),
    Word(
        "G92", "gives the present position new values by such a shift", act="axis_offset", group="non-modal",
        when=_BEHIND, moves=False,
    ),
    Word(
        "G92.1 G92.2 G92.3", "the shift is cleared, suspended, on again", act="switch_axis_offset",
        group="axis offset switches", when=_BEHIND,
    ),
    Word(
        "G96", "constant surface speed is not simulated", effect=_ERROR, act="surface_speed", group="speed",
        letters="DS",
    ),
    Word("M5", "event `spindle`: off", act="iso", group="spindle"),
    Word("M9", "event `coolant`: off", act="iso", group="coolant"),
    Word("M19", "event `spindle`: oriented", act="iso", group="spindle", letters="RQP",
         values={"P": whole(0, 2), "R": between(0.0, 360.0), "Q": ABOVE_ZERO}),
    Word("M48 M49", effect=_NONE, act="overrides", sets=(1.0, 0.0), group="overrides"),
    Word("M50 M51 M53", effect=_NONE, act="override", group="overrides", letters="P", values={"P": _SWITCH}),
    Word("M52", "off with `P0`; else a signal of the machine scales the feed: a warning", effect=_NONE,
         act="adaptive_feed", group="overrides", letters="P"),
    Word("M60", "event `stop`", act="change_pallet", group="stop", when=_AFTER),
    Word("M61", "renames the tool in the spindle: an error for another than the one that was loaded", effect=_NONE,
         act="rename_tool", group="tool", letters="Q"),
    Word("M62 M63 M64 M65", "digital outputs", effect=_NONE, act="signal", group="signals", letters="P",
         values={"P": _BIT}),
    Word("M66", "an input; with `L` it waits", effect=_NONE, act="wait_for_input", group="signals", letters="PELQ",
         values={"P": _BIT, "E": _BIT, "L": whole(0, 4)}),
    Word("M67 M68", "analog outputs; `E3`, which switches the kinematics: an error", effect=_NONE,
         act="analog_output", group="signals", letters="EQ", values={"E": _BIT}),
    Word("M70 M71 M73", "what is in force is not kept for later", effect=_ERROR, group="spindle"),
    Word("M72", "what is in force is not brought back", effect=_ERROR, group="spindle"),
    Word("M98 M99", "subprograms by M98 are not simulated; O words are", effect=_ERROR),
    Word("M100..M199", "event `m`: programs of the machine builder", act="builders_program", group="users",
         letters="PQ", own=False),
    Word("M428 M429", "TCP on, off", act="tcp", sets=(True, False)),
    Word("M430", "kinematics of the user are not known", effect=_ERROR, problem="NC224"),
    within_compensation=_WITHIN_COMPENSATION,
)  # fmt: skip

MACHINE: Final = TABLE.code("G53")
RIGID_TAP: Final = TABLE.code("G33.1")

#: What the operator may do, by the word that lets him or not.
OVERRIDES: Final = {"M50": "override of the feed", "M51": "override of the spindle", "M53": "feed hold"}

#: The words of splines. G5 and G5.1 count for their block alone, and leave the motion that was in force.
CUBIC: Final = TABLE.code("G5")
NURBS: Final = TABLE.code("G5.2")
END_NURBS: Final = TABLE.code("G5.3")
SPLINES: Final = frozenset({CUBIC, TABLE.code("G5.1"), NURBS, END_NURBS})

#: Taps, which without a P of their own dwell as long as the last cycle that dwelled.
TAPS: Final = frozenset({TABLE.code("G74"), TABLE.code("G84")})

#: G10: L that writes length and radius of a tool, and the one that reads the tool table again.
TOOL_DATA: Final = frozenset({1, 10, 11})
RELOAD_TOOLS: Final = 0

#: The analog output that switches the kinematics where these can be switched.
KINEMATICS_OUTPUT: Final = 3

#: Programs of the builder with which older five-axis examples switch TCP.
USERS_TCP: Final = ("M128", "M129")

#: A call of a subprogram by its number.
_CALL: Final = re.compile(r"O[0-9]+ CALL( .*)?")


def is_own_word(word: str) -> bool:
    """Whether a declared word begins with one of the control; a call of a numbered subprogram does not."""
    return _CALL.fullmatch(word) is None and TABLE.is_own(word)


def fault_of_signal(word: Word, block: Block) -> Wording | None:
    """Return why LinuxCNC refuses a block with M62 to M68; None if it does not."""
    digital, analog = (letter in block.words for letter in "PE")
    if "P" not in word.letters:
        return None if analog else Wording("NC218", "signal_without_output", word=word.text, letter="E")
    if "E" not in word.letters:
        return None if digital else Wording("NC218", "signal_without_output", word=word.text, letter="P")
    if digital == analog:
        return Wording("NC218", "two_inputs" if digital else "no_input")
    mode, seconds = (block.words[letter].value if letter in block.words else 0.0 for letter in "LQ")
    if mode and analog:
        return Wording("NC218", "waits_for_analog_input", mode=mode)
    return Wording("NC218", "wait_without_seconds", mode=mode) if mode and seconds <= 0.0 else None
