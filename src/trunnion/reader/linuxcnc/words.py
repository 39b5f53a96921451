"""Every word that the reader knows, by what it does. ``docs/reader-linuxcnc.md`` says the same to people."""

from typing import Final

#: G words by ten times their number, so that G43.1 is a whole number: what they act on.
MOTIONS: Final = {0: 0, 10: 1, 20: 2, 30: 3}
PLANES: Final = {170: 2, 180: 1, 190: 0}
UNITS: Final = {200: True, 210: False}
DISTANCES: Final = {900: True, 910: False}
ARC_DISTANCES: Final = {901: True, 911: False}
FEED_MODES: Final = {930: 93, 940: 94, 950: 95}
OFFSETS: Final = {540: 1, 550: 2, 560: 3, 570: 4, 580: 5, 590: 6, 591: 7, 592: 8, 593: 9}
RETURNS: Final = {980: True, 990: False}
DWELL: Final = 40
MACHINE: Final = 530
CANCEL: Final = 800
CYCLES: Final = frozenset({730, 740, 810, 820, 830, 840, 850, 860, 890})

#: G words for the length of the tool: whether it counts.
LENGTHS: Final = {430: True, 490: False}

#: G words that change how the control drives, or what it does with tool lengths besides.
SILENT: Final = frozenset({400, 432, 610, 611, 640, 970})

#: G words that are known and not simulated: what the reader says, and whether the path is doubtful.
NAMED: Final = {
    50: ("splines are not simulated", True),
    51: ("splines are not simulated", True),
    52: ("NURBS are not simulated", True),
    53: ("NURBS are not simulated", True),
    70: ("lathe diameters are not simulated", True),
    80: ("lathe radii", False),
    100: ("sets tables and offsets, which only the control has", True),
    171: ("a plane of U, V and W", True),
    181: ("a plane of U, V and W", True),
    191: ("a plane of U, V and W", True),
    280: ("goes to a position that only the control knows", True),
    281: ("stores a position", False),
    300: ("goes to a position that only the control knows", True),
    301: ("stores a position", False),
    330: ("thread cutting is taken as a straight line", False),
    331: ("rigid tapping is taken as a straight line in, without the way out", True),
    382: ("probes: where it ends only the machine knows", True),
    383: ("probes: where it ends only the machine knows", True),
    384: ("probes: where it ends only the machine knows", True),
    385: ("probes: where it ends only the machine knows", True),
    410: ("radius compensation is not simulated: the path is that of the tool centre as programmed", False),
    411: ("radius compensation is not simulated: the path is that of the tool centre as programmed", False),
    420: ("radius compensation is not simulated: the path is that of the tool centre as programmed", False),
    421: ("radius compensation is not simulated: the path is that of the tool centre as programmed", False),
    431: ("sets tool offsets by the program: not simulated", True),
    760: ("thread cutting is not simulated", True),
    870: ("back boring is not simulated", True),
    880: ("boring with a stop is not simulated", True),
    920: ("moves the coordinate system: not simulated", True),
    921: ("takes the G92 offsets away, which are not simulated", False),
    922: ("takes the G92 offsets away, which are not simulated", False),
    923: ("takes the G92 offsets back, which are not simulated", True),
    960: ("constant surface speed: only the path is followed", False),
}

#: G words after which the axis words of the same block are no positions.
NO_MOTION: Final = frozenset({40, 100, 280, 281, 300, 301, 431, 920, 921, 922, 923})

#: M words that become events: kind and value.
M_EVENTS: Final = {
    0: ("stop", None),
    1: ("optional_stop", None),
    3: ("spindle", "clockwise"),
    4: ("spindle", "counter-clockwise"),
    5: ("spindle", "off"),
    7: ("coolant", "mist"),
    8: ("coolant", "flood"),
    9: ("coolant", "off"),
    19: ("spindle", "oriented"),
    60: ("stop", None),
}
M_SPINDLE: Final = {3: 1, 4: -1, 5: 0}
M_CHANGE: Final = 6
M_ENDS: Final = frozenset({2, 30})

#: Switch the kinematics: tool centre point, and each axis by itself. Which is which is configured; these are those of
#: the trunnion configurations that come with LinuxCNC.
M_TCP: Final = 428
M_IDENTITY: Final = 429

#: M words that act after the motion of their block.
M_LATE: Final = frozenset({0, 1, 60}) | M_ENDS

#: M words without an effect on the path: overrides, and outputs.
M_SILENT: Final = frozenset({48, 49, 50, 51, 52, 53, 61, 62, 63, 64, 65, 67, 68})

#: M words that are known and not simulated.
M_NAMED: Final = {
    66: "waits for an input: not simulated",
    70: "saves modes: not simulated",
    71: "forgets saved modes: not simulated",
    72: "takes modes back: not simulated",
    73: "saves modes: not simulated",
}

#: M words that call and return, which end what can be followed.
M_CALLS: Final = frozenset({98, 99})
