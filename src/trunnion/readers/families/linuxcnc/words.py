"""The words of LinuxCNC that the reader knows, by their effect; G codes are in tenths."""

from typing import Final

from trunnion.readers.families.linuxcnc.cycles import CYCLES
from trunnion.readers.program.word_values import one_of, whole
from trunnion.readers.rs274.block import Block
from trunnion.readers.rs274.interpreter import CANCEL

#: Work offsets, in the order of their numbers in G10 and ``#5220``.
OFFSETS: Final = (540, 550, 560, 570, 580, 590, 591, 592, 593)

MACHINE: Final = 530

#: G codes that add to the tool length.
ADDED_LENGTHS: Final = frozenset({431, 432})

#: Continuous path, within the tolerance P.
CONTINUOUS: Final = 640

#: G codes of the tool length: whether it counts.
LENGTHS: Final = {430: True, 490: False}

#: G codes that the path does not depend on.
WITHOUT_PATH_EFFECT: Final = frozenset({80, 400, 431, 432, 610, 611, 640, 911, 901, 970})

#: G codes that are not simulated: the message, and whether the path is wrong without them.
NOT_SIMULATED: Final = {
    50: ("a spline, taken as nothing", True),
    51: ("a spline, taken as nothing", True),
    52: ("a NURBS, taken as nothing", True),
    53: ("a NURBS, taken as nothing", True),
    62: ("a NURBS, taken as nothing", True),
    63: ("a NURBS, taken as nothing", True),
    70: ("turning is not simulated", True),
    171: ("a plane of U V W is not simulated", True),
    181: ("a plane of U V W is not simulated", True),
    191: ("a plane of U V W is not simulated", True),
    330: ("thread cutting is taken as a straight line", True),
    382: ("probing is taken as a straight line", True),
    383: ("probing is taken as a straight line", True),
    384: ("probing is taken as a straight line", True),
    385: ("probing is taken as a straight line", True),
    410: ("radius compensation is not simulated: the path is that of the tool centre as programmed", False),
    411: ("radius compensation is not simulated: the path is that of the tool centre as programmed", False),
    420: ("radius compensation is not simulated: the path is that of the tool centre as programmed", False),
    421: ("radius compensation is not simulated: the path is that of the tool centre as programmed", False),
    700: ("a turning cycle is not simulated", True),
    710: ("a turning cycle is not simulated", True),
    711: ("a turning cycle is not simulated", True),
    712: ("a turning cycle is not simulated", True),
    720: ("a turning cycle is not simulated", True),
    721: ("a turning cycle is not simulated", True),
    722: ("a turning cycle is not simulated", True),
    760: ("a threading cycle is not simulated", True),
    960: ("constant surface speed is not simulated", True),
}

#: Motions that are taken as straight lines.
TAKEN_AS_LINES: Final = frozenset({330, 382, 383, 384, 385})

#: Rigid tapping: in by the pitch, and out to the start with the spindle reversed.
RIGID_TAP: Final = 331

#: G codes whose axis words are no positions: their block makes no motion.
NO_MOTION: Final = frozenset({431, 432, 50, 51, 52, 53, 62, 63, 700, 710, 711, 712, 720, 721, 722, 760})

#: Words that belong to a G code and have no effect here.
WORDS_OF_CODE: Final = {
    430: "H",
    431: "XYZABCUVW",
    432: "H",
    410: "D",
    411: "DL",
    420: "D",
    421: "DL",
    960: "DS",
    330: "K",
    50: "XYIJPQ",
    51: "XYIJ",
    52: "XYPL",
    62: "XYPLDEFIJKQR",
    700: "XZDEPQIR",
    710: "XZDEPQIR",
    711: "XZDEPQIR",
    712: "XZDEPQIR",
    720: "XZDEPQIR",
    721: "XZDEPQIR",
    722: "XZDEPQIR",
    760: "XZPIJKRQHEL",
}

#: M codes that the path does not depend on, and their words.
WITHOUT_PATH_EFFECT_M: Final = {
    48: "",
    49: "",
    50: "P",
    51: "P",
    52: "P",
    53: "P",
    62: "P",
    63: "P",
    64: "P",
    65: "P",
    66: "PELQ",
    67: "EQ",
    68: "EQ",
}

#: G10: L that writes length and radius of a tool, and the one that reads the tool table again.
TOOL_DATA: Final = frozenset({1, 10, 11})
RELOAD_TOOLS: Final = 0

#: M codes that set an analog output, and the output that switches the kinematics where these can be switched.
ANALOG_OUTPUTS: Final = frozenset({67, 68})
KINEMATICS_OUTPUT: Final = 3

#: Reads an input; with L other than 0 it waits for it, up to Q seconds.
WAIT_FOR_INPUT: Final = 66

#: M codes that need to know which output or input.
INPUTS_AND_OUTPUTS: Final = range(62, 69)


def fault_of_signal(code: int, block: Block) -> str:
    """Return why LinuxCNC refuses a block with one of ``INPUTS_AND_OUTPUTS``; empty if it does not."""
    digital, analog = (letter in block.words for letter in "PE")
    if code in ANALOG_OUTPUTS:
        return "" if analog else f"M{code} without the output E"
    if code != WAIT_FOR_INPUT:
        return "" if digital else f"M{code} without the output P"
    if digital == analog:
        return "M66 with a digital and an analog input" if digital else "M66 without the input, P or E"
    mode, seconds = (block.words[letter].value if letter in block.words else 0.0 for letter in "LQ")
    if mode and analog:
        return f"M66 E waits for no analog input: L{mode:g}"
    return f"M66 L{mode:g} without the seconds Q that it waits" if mode and seconds <= 0.0 else ""


#: Lets a signal scale the feed, unless its P is 0.
ADAPTIVE_FEED: Final = 52

#: What the values of these words may be, by G code or M code, and letter.
VALUES: Final = {(430, "H"): whole(0, 99999), (410, "D"): whole(0, 99999), (420, "D"): whole(0, 99999)}
VALUES_M: Final = {
    **{(code, "P"): one_of(0, 1) for code in (50, 51, 53)},
    **{(code, "P"): whole(0, 63) for code in (62, 63, 64, 65)},
    **{(66, letter): whole(0, 63) for letter in "PE"},
    (66, "L"): whole(0, 4),
    (67, "E"): whole(0, 63),
    (68, "E"): whole(0, 63),
    (19, "P"): whole(0, 2),
}

#: Words that belong to other M codes and have no effect here.
WORDS_OF_M_CODE: Final = {19: "RQP"}

#: M codes that are not simulated: the message.
NOT_SIMULATED_M: Final = {
    70: "what is in force is not kept for later",
    71: "what is in force is not kept for later",
    72: "what is in force is not brought back",
    73: "what is in force is not kept for later",
    98: "subprograms by M98 are not simulated; O words are",
    99: "subprograms by M98 are not simulated; O words are",
}

#: User-defined M codes, and those with which older five-axis examples switch TCP.
USERS: Final = range(100, 200)
USERS_TCP: Final = frozenset({128, 129})

#: Switchable kinematics as the five-axis examples remap them: TCP on, TCP off, and the user's kinematics.
TCP_ON: Final = 428
TCP_OFF: Final = 429
TCP_USER: Final = 430

#: G codes, in tenths: dwell, data of offsets and tools, home with the codes that store its positions, and axis offsets
#: that a block sets, switches off or on again.
DWELL: Final = 40
SET_DATA: Final = 100
HOMES: Final = {280: 281, 300: 301}
AXIS_OFFSETS: Final = frozenset({520, 920})
AXIS_OFFSET_SWITCHES: Final = frozenset({921, 922, 923})

#: All of them, and those that take the axis words of their block.
SPECIAL: Final = frozenset({DWELL, SET_DATA, *HOMES, *HOMES.values(), *AXIS_OFFSETS, *AXIS_OFFSET_SWITCHES})
TAKING_AXIS_WORDS: Final = frozenset({SET_DATA, *HOMES, *AXIS_OFFSETS})

#: Turning cycles.
_TURNING: Final = (700, 710, 711, 712, 720, 721, 722, 760)

#: G codes, in tenths, and M codes of which a block has one: the groups of LinuxCNC's interpreter. G80 may stand beside
#: a motion.
GROUPS: Final = (
    frozenset({0, 10, 20, 30, 50, 51, 52, 53, RIGID_TAP, *TAKEN_AS_LINES, *(CYCLES - {CANCEL}), *_TURNING}),
    frozenset({DWELL, SET_DATA, *HOMES, *HOMES.values(), *AXIS_OFFSETS, MACHINE}),
    AXIS_OFFSET_SWITCHES,
    frozenset({170, 171, 180, 181, 190, 191}),
    frozenset({900, 910}),
    frozenset({901, 911}),
    frozenset({930, 940, 950}),
    frozenset({200, 210}),
    frozenset({400, 410, 411, 420, 421}),
    frozenset({*LENGTHS, *ADDED_LENGTHS}),
    frozenset({980, 990}),
    frozenset(OFFSETS),
    frozenset({610, 611, CONTINUOUS}),
    frozenset({960, 970}),
    frozenset({70, 80}),
)
GROUPS_M: Final = (
    frozenset({0, 1, 2, 30, 60}),
    frozenset({6, 61}),
    frozenset({3, 4, 5, 19, *range(70, 74)}),
    frozenset({7, 8, 9}),
    frozenset(range(48, 54)),
    frozenset(INPUTS_AND_OUTPUTS),
    frozenset(range(100, 200)),
)
