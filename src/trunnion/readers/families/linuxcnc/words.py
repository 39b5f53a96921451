"""Every word of LinuxCNC that the reader knows, by what it does; G codes are in tenths."""

from typing import Final

#: Work offsets, in the order of their numbers in G10 and ``#5220``.
OFFSETS: Final = (540, 550, 560, 570, 580, 590, 591, 592, 593)

#: G codes for the length of the tool: whether it counts.
LENGTHS: Final = {430: True, 490: False}

#: G codes that change how the control drives, or what it does with tool lengths besides.
WITHOUT_PATH_EFFECT: Final = frozenset({80, 400, 431, 432, 610, 611, 640, 911, 901, 970})

#: G codes that are known and not simulated: text, and whether the path is wrong without it.
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
    330: ("thread cutting is taken as a straight line", False),
    382: ("probing is taken as a straight line", False),
    383: ("probing is taken as a straight line", False),
    384: ("probing is taken as a straight line", False),
    385: ("probing is taken as a straight line", False),
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
    960: ("constant surface speed: only the kind of feed is followed", False),
}

#: G codes whose motion is a straight line here, in force until another one.
TAKEN_AS_LINES: Final = frozenset({330, 382, 383, 384, 385})

#: Rigid tapping: in by the pitch, and by the spindle's turning back out to where it began.
RIGID_TAP: Final = 331

#: G codes whose block makes no motion here, and whose words are not positions.
NO_MOTION: Final = frozenset({431, 432, 50, 51, 52, 53, 62, 63, 700, 710, 711, 712, 720, 721, 722, 760})

#: Words that belong to a code, and that need no look here.
WORDS_OF_CODE: Final = {
    430: "H",
    431: "XYZABCUVW",
    432: "H",
    410: "D",
    411: "DL",
    420: "D",
    421: "DL",
    640: "PQ",
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

#: M codes that change how the control drives, and their words.
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

#: M codes that are known and not simulated.
NOT_SIMULATED_M: Final = {
    70: "what is in force is not kept for later",
    71: "what is in force is not kept for later",
    72: "what is in force is not brought back",
    73: "what is in force is not kept for later",
    98: "subprograms by M98 are not simulated; O words are",
    99: "subprograms by M98 are not simulated; O words are",
}

#: M codes of the user.
USERS: Final = range(100, 200)

#: Switchable kinematics as the five-axis examples remap them: TCP on, off, and a third one that nobody defined.
TCP_ON: Final = 428
TCP_OFF: Final = 429
TCP_USER: Final = 430
