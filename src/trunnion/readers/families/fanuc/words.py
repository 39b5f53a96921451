"""The words of a Fanuc, by their meaning in its manuals."""

import math
from typing import Final

from trunnion.readers.program.word_values import one_of, whole
from trunnion.readers.rs274.block import Block
from trunnion.readers.rs274.iso_words import COMMON_WORDS, COMPENSATION
from trunnion.readers.rs274.word_table import Effect, When, Word, WordTable

_NONE, _WARNING, _ERROR = Effect.NONE, Effect.WARNING, Effect.ERROR
_BEHIND, _AFTER = When.BEHIND_MODES, When.AFTER_MOTION

_POSITION: Final = "tool position offsets are not simulated"
_REGISTER: Final = whole(0, 999)

#: P1 and P2 of G53.1 choose another of the two positions of the rotary axes than the nearest.
TABLE: Final = WordTable(
    *COMMON_WORDS,
    Word("G4", "dwell", act="dwell", letters="PXU", when=_BEHIND, moves=False),
    Word(
        "G5", effect=_NONE, act="contour_control", letters="P", values={"P": one_of(0, 10000)}, moves=False,
    ),
    Word(
        "G5.1", "AI contour control; axes are chosen by 0, as `X0`; `Q2` and `Q3`, which smooth the path: an error, or "
        "declared", effect=_NONE, act="contour_control", letters="QRXYZABC",
        values={"Q": whole(0, 3), "R": whole(1, 10), **dict.fromkeys("XYZABC", one_of(0))}, moves=False,
    ),
    Word("G5.3", "what it chooses is not known", effect=_ERROR, letters="P", moves=False),
    Word("G6.1", "a smooth curve is not simulated", effect=_ERROR, letters="XYZPR", moves=False),
    Word("G6.2", "a NURBS: see below", group="motion", letters="PKXYZR"),
    Word("G7.1", "cylindrical interpolation is not simulated", effect=_ERROR, letters="ABC"),
    Word("G8", effect=_NONE, act="contour_control", letters="P", values={"P": one_of(0, 1)}, moves=False),
    Word("G9", "event `exact_stop`: `block`", effect=_NONE, act="exact_stop", sets="block"),
    Word("G10", "sets a work offset", act="set_data", letters="LP", when=_BEHIND, moves=False, numbered=True),
    Word("G11", effect=_NONE),
    Word("G12.1", "polar coordinate interpolation is not simulated", effect=_ERROR, group="polar interpolation"),
    Word("G13.1", effect=_NONE, group="polar interpolation"),
    Word("G15", "polar positions off", act="polar_positions", sets=False, group="polar positions"),
    Word(
        "G16", "positions in the plane are radius and angle", act="polar_positions", sets=True,
        group="polar positions",
    ),
    Word(
        "G22", "stroke limits on; with positions, which limit the axes, an error", effect=_NONE, act="stroke_limits",
        sets=False, group="limits", letters="XYZIJK", moves=False,
    ),
    Word("G23", "stroke limits off", effect=_NONE, act="stroke_limits", sets=True, group="limits"),
    Word(
        "G27", "a check of the reference position: where it goes is not simulated", effect=_ERROR, letters="XYZABC",
        moves=False,
    ),
    Word("G28", "home, by the programmed point", act="go_home", when=_BEHIND, moves=False),
    Word("G29", "back from the reference position: not simulated", effect=_ERROR, letters="XYZABC", moves=False),
    Word(
        "G30", "to the reference position `P`, 2 unless it is there; one that the definition does not state is read as "
        "home, with a warning", act="go_home", when=_BEHIND, values={"P": whole(2, 4)}, moves=False, numbered=True,
    ),
    Word("G31", "a skip is taken as a straight line", effect=_ERROR, act="line", letters="P"),
    Word("G33", "thread cutting is taken as a straight line", effect=_ERROR, act="line", group="motion", letters="Q"),
    Word(
        "G41 G42", COMPENSATION, effect=_WARNING, act="compensation", sets=(1, -1), group="compensation", letters="D",
        values={"D": _REGISTER},
    ),
    Word(
        "G41.2 G42.2", "radius compensation in space is not simulated", effect=_WARNING, act="compensation_in_space",
        sets=(1, -1), group="compensation", letters="DIJK",
    ),
    Word(
        "G43 G44", "tool length on; the other sign of `G44` is not simulated: an error", effect=_NONE, act="length",
        sets=True, group="length", letters="H", values={"H": _REGISTER},
    ),
    Word("G49", "tool length and TCP off", act="length", sets=False, group="length", letters="H"),
    Word(
        "G43.1", "the tool length along the tool axis is not simulated", effect=_ERROR, group="length", letters="H",
    ),
    Word(
        "G43.2", "dynamic fixture offsets and rotary tool lengths are not simulated", effect=_ERROR, group="length",
        letters="H",
    ),
    Word(
        "G43.4 G43.5", "TCP with rotary words, with `I` `J` `K` as tool axis; `P1`: on a great circle", act="tcp",
        sets=(False, True), group="length", letters="HP", numbered=True,
    ),
    Word("G45 G46 G47 G48", _POSITION, effect=_ERROR, letters="D"),
    Word("G50", effect=_NONE, group="scaling"),
    Word(
        "G50.1", "mirror image off", act="end_mirror", group="mirror images", letters="XYZ", when=_BEHIND, moves=False,
    ),
    Word("G51", "scaling is not simulated", effect=_ERROR, group="scaling", letters="XYZPIJK", moves=False),
    Word("G51.1", "mirror image", act="mirror", group="mirror images", letters="XYZ", when=_BEHIND, moves=False),
    Word("G52", "local shift", act="local_shift", when=_BEHIND, moves=False),
    Word("G53", "positions of the machine, with `G90`"),
    Word(
        "G53.1", "turns the rotary axes so that the tool is perpendicular to the plane", act="align_with_plane",
        letters="P", values={"P": one_of(0)}, when=_AFTER, numbered=True,
    ),
    Word(
        "G53.6", "turning the tool upright while the tip stays is not simulated", effect=_ERROR, letters="HPR",
        moves=False,
    ),
    Word("G54 G55 G56 G57 G58 G59", "work offset", act="work_offset", sets=(1, 2, 3, 4, 5, 6), group="offset"),
    Word("G54.1", "work offset `P`", act="work_offset", sets=1, group="offset", letters="P", numbered=True),
    Word("G54.4", "workpiece setting errors are not simulated", effect=_ERROR, letters="P"),
    Word("G60", "positioning from one side, past its end and back, is not simulated", effect=_ERROR),
    Word("G61", "event `exact_stop`: `on`", effect=_NONE, act="exact_stop", sets="on", group="exact stop"),
    Word("G62", "another feed at inside corners is not simulated", effect=_ERROR, group="exact stop"),
    Word("G63", effect=_NONE, act="unasked", group="exact stop"),
    Word("G64", "event `exact_stop`: `off`", effect=_NONE, act="exact_stop", sets="off", group="exact stop"),
    Word("G65", "calls a macro", letters="PL", when=_BEHIND, moves=False, numbered=True, calls=True),
    Word(
        "G66", "calls a macro after every motion", group="modal macro", letters="PL", when=_BEHIND,
        moves=False, numbered=True,
    ),
    Word(
        "G66.1", "a modal macro call at every block is not simulated", effect=_ERROR, group="modal macro",
        letters="PL", moves=False,
    ),
    Word("G67", "ends `G66`", act="end_modal_macro", group="modal macro"),
    Word("G68", "rotation by `R`", act="rotate", group="rotation", letters="XYZIJKR", when=_BEHIND, moves=False),
    Word(
        "G68.2", "tilted plane by Euler angles", act="tilt", group="rotation", letters="XYZIJKPQR", when=_BEHIND,
        moves=False, numbered=True,
    ),
    Word(
        "G68.3", "a plane by the tool's direction is not simulated", effect=_ERROR, group="rotation", letters="XYZR",
        moves=False,
    ),
    Word(
        "G68.4", "a plane on top of another is not simulated", effect=_ERROR, group="rotation", letters="XYZIJK",
        moves=False,
    ),
    Word("G69", "rotation and tilted plane off", act="cancel_rotation", group="rotation"),
    Word("G74 G76 G81 G82 G84 G85 G86 G87 G88 G89", "cycle", act="cycle", group="motion", needs="ZR"),
    Word("G73 G83", "cycle with pecks", act="cycle", group="motion", needs="ZRQ"),
    Word("G92", "gives the present position new values", act="preset", when=_BEHIND, moves=False),
    Word("G92.1", "a preset of the work coordinates is not simulated", effect=_ERROR, letters="XYZABC", moves=False),
    Word(
        "G96", "constant surface speed is not simulated", effect=_ERROR, act="surface_speed", group="speed",
        letters="PRS",
    ),
    Word(
        "G: plane of the rotary position", "X Y Z along the machine's axes, as the rotary position has turned them",
        act="take_plane_of_pose", group="plane of the rotary position",
    ),
    Word(
        "G: no plane of the rotary position", "ends that plane", act="leave_plane_of_pose",
        group="plane of the rotary position",
    ),
    Word(
        "G: smoothness", "degree `P`, rough to fine; `E`: how far corners may be rounded", effect=_NONE,
        act="smoothness", letters="PE", values={"P": whole(1, 3)}, numbered=True,
    ),
    Word(
        "G: look-ahead", "how many blocks the control reads ahead; 0: as many as it can", effect=_NONE,
        act="look_ahead", letters="P", values={"P": whole(0, 15)}, numbered=True,
    ),
    Word(
        "G: bolt hole circle", "the cycle in force or of the block at `L` places of a circle of radius `I` about the "
        "tool, from the angle `J` on", act="bolt_holes", letters="IJL", when=_BEHIND, moves=False,
    ),
    Word(
        "G: bolt hole arc", "the same, with the angle `K` from one to the next", act="bolt_holes", letters="IJKL",
        when=_BEHIND, moves=False,
    ),
    Word(
        "G: bolt holes on a line", "holes on a line are not simulated: no page of the manual is at hand", effect=_ERROR,
        letters="XYIJL", moves=False,
    ),
    *(
        Word(
            f"G: circular pocket, {sense}", "a circular pocket is not simulated: its path depends on the radius in the "
            "register D", effect=_ERROR, letters="XYZIKLQD", moves=False,
        )
        for sense in ("clockwise", "counter-clockwise")
    ),
    Word(
        "G: pocket", "a pocket is not simulated: its path depends on a contour and on the radius in the register D",
        effect=_ERROR, letters="PXYZRIJKQDL", moves=False, numbered=True,
    ),
    Word("G: engraving", "engraving is not simulated", effect=_ERROR, letters="XYZIJEPR", moves=False, numbered=True),
    Word("G: cylinder", "a path on a cylinder is not simulated", effect=_ERROR, letters="XYZABCQR", moves=False),
    *(
        Word(
            f"G: {meaning} about the work offset", "mirror images about the zero of the work offset are not simulated",
            effect=_ERROR, letters="XYZABC", moves=False,
        )
        for meaning in ("mirror image", "no mirror image")
    ),
    Word("M29", "stops the spindle for a rigid thread; event `m`", act="stop_for_thread", own=False),
    Word("M98", "calls a subprogram", act="call", letters="PL", when=_AFTER, numbered=True, calls=True),
    Word("M99", "returns from a subprogram", act="return", letters="P", when=_AFTER, numbered=True),
    Word(
        "M198", "programs of other folders are not called", effect=_ERROR, letters="PL", when=_AFTER, numbered=True,
        calls=True, problem="NC132",
    ),
    Word("M: local subprogram", "calls the part from block `P` to `M99`", act="local_call", when=_AFTER, numbered=True),
    Word(
        "M: jump on an input", "a jump that only the machine can decide: an error", act="jump_on_input", when=_AFTER,
        numbered=True,
    ),
    within_compensation={
        **dict.fromkeys(
            ("plane", "M6", "tilt", "align_with_plane", "tcp", "cancel_rotation", "preset",
             "plane of the rotary position"),
            "refused",
        ),
        "local_shift": "suspends",
    },
)  # fmt: skip

#: G codes, in tenths, that decide how the whole block is taken.
DWELL: Final = TABLE.code("G4")
NURBS: Final = TABLE.code("G6.2")
MACHINE: Final = TABLE.code("G53")
MORE_OFFSETS: Final = TABLE.code("G54.1")
MACROS: Final = frozenset({TABLE.code("G65"), TABLE.code("G66")})
MODAL_MACRO: Final = TABLE.code("G66")
TILT: Final = TABLE.code("G68.2")
NO_PLANE_OF_POSE: Final = TABLE.code("G: no plane of the rotary position")

#: Smooth interpolation and nano smoothing, which round the path within a tolerance of the control.
SMOOTHING: Final = ("G5.1 Q2", "G5.1 Q3")

#: Words that round or chamfer the corner at the end of their block. A contour that turns by less, radians, has none.
ROUNDING: Final = ",R"
CHAMFER: Final = ",C"
CORNERS: Final = (ROUNDING, CHAMFER)
LEAST_TURN: Final = math.radians(1.0)

#: Threads.
THREADS: Final = frozenset({TABLE.code("G74"), TABLE.code("G84")})

#: M codes that lead to other blocks on the controls that have them.
LOCAL_CALL: Final = TABLE.code("M: local subprogram")
JUMP_ON_INPUT: Final = TABLE.code("M: jump on an input")

#: G10: what it writes into the data of tools, by L.
TOOL_DATA: Final = {
    1: "writes the offset of a tool",
    3: "writes the groups of the tool life, which call other tools",
    10: "writes the length of a tool",
    11: "writes the wear of a tool's length",
    12: "writes the radius of a tool",
    13: "writes the wear of a tool's radius",
}

#: G10: what P may be, by L.
DATA_NUMBERS: Final = {2: whole(1, 6), 20: whole(1, 300), **dict.fromkeys(TOOL_DATA, whole(1, 999))}

#: Local variables of a macro by the letter of its call.
ARGUMENTS: Final = {
    "A": 1, "B": 2, "C": 3, "I": 4, "J": 5, "K": 6, "D": 7, "E": 8, "F": 9, "H": 11, "M": 13, "Q": 17, "R": 18,
    "S": 19, "T": 20, "U": 21, "V": 22, "W": 23, "X": 24, "Y": 25, "Z": 26,
}  # fmt: skip

#: System variables that act when a program sets them: stop with a message, and raise an alarm.
MESSAGE_VARIABLE: Final = 3006
ALARM_VARIABLE: Final = 3000

#: Keywords of control flow.
FLOW: Final = ("IF", "GOTO", "WHILE", "DO", "END", "THEN")


def is_own_word(word: str) -> bool:
    """Whether a declared word begins with one of the control; a call of a named program does not.

    How far smooth interpolation leaves the path is up to the control: a definition may answer for it.
    """
    if word in SMOOTHING:
        return False
    return word.partition(" ")[0].rstrip("0123456789") in FLOW or TABLE.is_own(word)


def takes_number(block: Block) -> bool:
    """Whether P of a block is the number of a program, a block or an offset, or chooses something: no time."""
    return any(word.numbered for word in (*TABLE.words("G", block.g), *TABLE.words("M", block.m)))
