"""The words of a Fanuc that the reader knows, by their effect; G codes are in tenths."""

from typing import Final

from trunnion.readers.families.fanuc.cycles import CYCLES
from trunnion.readers.program.word_values import one_of, whole
from trunnion.readers.rs274.block import Block

#: Work offsets G54 to G59.
OFFSETS: Final = (540, 550, 560, 570, 580, 590)
MORE_OFFSETS: Final = 541

DWELL: Final = 40
SET_DATA: Final = 100
HOME: Final = 280
OTHER_HOME: Final = 300
LOCAL: Final = 520
MACHINE: Final = 530
ALIGN_TOOL: Final = 531
MACRO: Final = 650
MODAL_MACRO: Final = 660
MODAL_MACRO_OFF: Final = 670
ROTATE: Final = 680
TILT: Final = 682
ROTATION_OFF: Final = 690
PRESET: Final = 920
TCP: Final = 434
TCP_VECTOR: Final = 435
LENGTH_OFF: Final = 490

#: AI contour control.
CONTOUR: Final = 51

NURBS: Final = 62

#: Meanings for which the family has no words, only some of its controls: codes that no program can write.
PLANE_OF_POSE: Final = -1
NO_PLANE_OF_POSE: Final = -2
SMOOTHNESS: Final = -3
LOOK_AHEAD: Final = -4
LOCAL_CALL: Final = -1
JUMP_ON_INPUT: Final = -2
MEANINGS: Final = {
    "G": {
        "plane of the rotary position": PLANE_OF_POSE,
        "no plane of the rotary position": NO_PLANE_OF_POSE,
        "smoothness": SMOOTHNESS,
        "look-ahead": LOOK_AHEAD,
    },
    "M": {"local subprogram": LOCAL_CALL, "jump on an input": JUMP_ON_INPUT},
}

#: G codes that take the axis words of their block, which then makes no other motion.
TAKING_AXIS_WORDS: Final = frozenset(
    {DWELL, SET_DATA, HOME, OTHER_HOME, LOCAL, MACRO, MODAL_MACRO, ROTATE, TILT, PRESET}
)

#: G codes that the path does not depend on.
WITHOUT_PATH_EFFECT: Final = frozenset(
    {50, 51, 80, 90, 110, 131, 150, 220, 230, 400, 430, 440, 500, 501, 610, 630, 640, 970}
)

#: How the control goes through the ends of blocks, by G code: ``RowRecorder.add_exact_stop``.
EXACT_STOPS: Final = {90: "block", 610: "on", 640: "off"}

#: G codes that are not simulated: the message, and whether the path is wrong without them.
NOT_SIMULATED: Final = {
    53: ("what it chooses is not known", True),
    61: ("a smooth curve is not simulated", True),
    71: ("cylindrical interpolation is not simulated", True),
    121: ("polar coordinate interpolation is not simulated", True),
    160: ("polar positions are not simulated", True),
    270: ("a check of the reference position: where it goes is not simulated", True),
    290: ("back from the reference position: not simulated", True),
    310: ("a skip is taken as a straight line", True),
    330: ("thread cutting is taken as a straight line", True),
    410: ("radius compensation is not simulated: the path is that of the tool centre as programmed", False),
    420: ("radius compensation is not simulated: the path is that of the tool centre as programmed", False),
    412: ("radius compensation in space is not simulated", False),
    422: ("radius compensation in space is not simulated", False),
    431: ("the tool length along the tool axis is not simulated", True),
    432: ("dynamic fixture offsets and rotary tool lengths are not simulated", True),
    450: ("tool position offsets are not simulated", True),
    460: ("tool position offsets are not simulated", True),
    470: ("tool position offsets are not simulated", True),
    480: ("tool position offsets are not simulated", True),
    510: ("scaling is not simulated", True),
    511: ("mirror images are not simulated", True),
    536: ("turning the tool upright while the tip stays is not simulated", True),
    544: ("workpiece setting errors are not simulated", True),
    600: ("positioning from one side, past its end and back, is not simulated", True),
    620: ("another feed at inside corners is not simulated", True),
    661: ("a modal macro call at every block is not simulated", True),
    683: ("a plane by the tool's direction is not simulated", True),
    684: ("a plane on top of another is not simulated", True),
    921: ("a preset of the work coordinates is not simulated", True),
    960: ("constant surface speed is not simulated", True),
}

#: Motions that are taken as straight lines.
TAKEN_AS_LINES: Final = frozenset({310, 330})

#: G codes whose axis words are no positions: their block makes no motion.
NO_MOTION: Final = frozenset({50, 51, 53, 61, 80, 220, 270, 290, 501, 510, 511, 536, 661, 683, 684, 921})

#: Words that belong to a G code and have no effect here.
WORDS_OF_CODE: Final = {
    50: "P",
    51: "QRXYZABC",
    53: "P",
    61: "XYZPR",
    80: "P",
    71: "ABC",
    220: "XYZIJK",
    270: "XYZABC",
    290: "XYZABC",
    310: "P",
    330: "Q",
    410: "D",
    420: "D",
    412: "DIJK",
    422: "DIJK",
    430: "H",
    440: "H",
    431: "H",
    432: "H",
    450: "D",
    460: "D",
    470: "D",
    480: "D",
    501: "XYZ",
    510: "XYZPIJK",
    511: "XYZ",
    536: "HPR",
    544: "P",
    661: "PL",
    683: "XYZR",
    684: "XYZIJK",
    921: "XYZABC",
    960: "PRS",
}

#: What the values of these words may be, by G code and letter. They count as written, also without a point. G5.1 Q2 and
#: Q3 (smooth interpolation, nano smoothing) round within the tolerance of the control.
VALUES: Final = {
    (50, "P"): one_of(0, 10000),
    (CONTOUR, "Q"): whole(0, 3),
    (CONTOUR, "R"): whole(1, 10),
    (80, "P"): one_of(0, 1),
    (430, "H"): whole(0, 999),
    (440, "H"): whole(0, 999),
    (410, "D"): whole(0, 999),
    (420, "D"): whole(0, 999),
    # P1 and P2 choose another of the two positions of the rotary axes than the nearest.
    (ALIGN_TOOL, "P"): one_of(0),
    (OTHER_HOME, "P"): whole(2, 4),
}

#: Forbids an area, if words of positions follow; and the words that have such areas watched, and not.
STROKE_LIMITS: Final = 220
STROKE_LIMIT_SWITCHES: Final = frozenset({STROKE_LIMITS, 230})

#: The degrees of smoothness, rough to fine.
SMOOTHNESSES: Final = whole(1, 3)

#: How many blocks a control reads ahead; 0, as many as it can.
BLOCKS_AHEAD: Final = whole(0, 15)

#: Words whose P is a number of something, also where a cycle is in force.
_WITH_NUMBER: Final = frozenset(
    {SET_DATA, OTHER_HOME, MORE_OFFSETS, ALIGN_TOOL, MACRO, MODAL_MACRO, TILT, TCP, TCP_VECTOR, SMOOTHNESS, LOOK_AHEAD}
)
_WITH_NUMBER_M: Final = frozenset({98, 99, 198, LOCAL_CALL, JUMP_ON_INPUT})


def takes_number(block: Block) -> bool:
    """Whether P of a block is the number of a program, a block or an offset, or chooses something: no time."""
    return not (_WITH_NUMBER.isdisjoint(block.g) and _WITH_NUMBER_M.isdisjoint(block.m))


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

#: M codes that act after the motion of their block.
AFTER_MOTION: Final = frozenset({0, 1, 2, 5, 9, 30, 98, 99, 198, LOCAL_CALL, JUMP_ON_INPUT})

#: Stops the spindle, for a rigid thread.
RIGID_TAP: Final = 29

CALL: Final = 98
RETURN: Final = 99
CALL_FILE: Final = 198

#: Local variables of a macro by the letter of its call.
ARGUMENTS: Final = {
    "A": 1, "B": 2, "C": 3, "I": 4, "J": 5, "K": 6, "D": 7, "E": 8, "F": 9, "H": 11, "M": 13, "Q": 17, "R": 18,
    "S": 19, "T": 20, "U": 21, "V": 22, "W": 23, "X": 24, "Y": 25, "Z": 26,
}  # fmt: skip

#: System variables that act when a program sets them: stop with a message, and raise an alarm.
MESSAGE_VARIABLE: Final = 3006
ALARM_VARIABLE: Final = 3000

#: G codes of which the control takes one a block, the last, for the whole block (groups 1 to 16 of the manuals).
GROUPS: Final = (
    frozenset({0, 10, 20, 30, NURBS, 330, *CYCLES}),
    frozenset({170, 180, 190}),
    frozenset({900, 910}),
    frozenset({930, 940, 950}),
    frozenset({200, 210}),
    frozenset({400, 410, 412, 420, 422}),
    frozenset({430, 431, 432, TCP, TCP_VECTOR, 440, LENGTH_OFF}),
    frozenset({980, 990}),
    frozenset({*OFFSETS, MORE_OFFSETS}),
    frozenset({610, 620, 630, 640}),
    frozenset({ROTATE, TILT, 683, 684, ROTATION_OFF}),
    frozenset({MODAL_MACRO, 661, MODAL_MACRO_OFF}),
    frozenset({220, 230}),
    frozenset({500, 510}),
    frozenset({501, 511}),
    frozenset({150, 160}),
    frozenset({121, 131}),
    frozenset({960, 970}),
    frozenset({PLANE_OF_POSE, NO_PLANE_OF_POSE}),
)

#: Keywords of control flow.
FLOW: Final = ("IF", "GOTO", "WHILE", "DO", "END", "THEN")
