"""The words of a Fidia NC15 that the reader knows, by their effect; G codes are in tenths."""

from typing import Final

from trunnion.readers.program.word_values import one_of

OFFSET: Final = 550
#: The value of the column ``work_offset`` for O0, which there is not: O1 is one more.
OFFSET_BASE: Final = 500
TAKE_PLANE: Final = 1540
NO_PLANE: Final = 690
DWELL: Final = 40
MACHINE: Final = 2900
TCP_ON: Final = frozenset({960, 1960})
TCP_OFF: Final = frozenset({970, 1970})
UNITS: Final = {700: True, 710: False}

#: G codes that the path does not depend on; feeds are in mm/min on this control.
WITHOUT_PATH_EFFECT: Final = frozenset({400, 940})

#: G codes that are not simulated: the message, and whether the path is wrong without them.
NOT_SIMULATED: Final = {
    200: ("ends a plane of G21, which is not simulated", True),
    210: ("a plane by its angles is not simulated", True),
    220: ("a helix by its angle is not simulated", True),
    230: ("a helix by its angle is not simulated", True),
    410: ("radius compensation is not simulated: the path is that of the tool centre as programmed", False),
    420: ("radius compensation is not simulated: the path is that of the tool centre as programmed", False),
}

#: G codes whose axis words are no positions: their block makes no motion.
NO_MOTION: Final = frozenset({200, 210, 220, 230})

#: Words that belong to a G code and have no effect here.
WORDS_OF_CODE: Final = {170: "Q", 180: "Q", 190: "Q", 210: "XYZ", 220: "XYZIJKP", 230: "XYZIJKP", 410: "D", 420: "D"}

#: What the values of these words may be, by G code and letter: Q1 is the tool along the positive axis.
VALUES: Final = {(code, "Q"): one_of(1) for code in (170, 180, 190)}

#: G codes that set one mode each, so that two of them in a block contradict each other.
GROUPS: Final = (
    frozenset({0, 10, 20, 30}),
    frozenset({170, 180, 190}),
    frozenset({900, 910}),
    frozenset({400, 410, 420}),
    frozenset(UNITS),
    frozenset({*TCP_ON, *TCP_OFF}),
    frozenset({TAKE_PLANE, NO_PLANE}),
)

#: M codes: the tool change with its offset, and the retract of Z.
TOOL: Final = 306
RETRACT: Final = 242

#: M codes that act after the motion of their block.
AFTER_MOTION: Final = frozenset({0, 1, 2, 5, 9, 30})
