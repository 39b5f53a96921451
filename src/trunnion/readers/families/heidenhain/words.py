"""The words of Klartext that the reader knows, by their effect; ``docs/controls/heidenhain.md`` describes them."""

from typing import Final

from trunnion.readers.program.word_values import between, one_of, whole


def _words(text: str) -> frozenset[str]:
    return frozenset(text.split())


#: Path functions.
PATHS: Final = _words("L LN LP C CR CP CT CTP")

#: Blocks that are not simulated: the message.
BLOCKS_NOT_SIMULATED: Final = {
    "FPOL": "free contour programming is not simulated",
    "FL": "free contour programming is not simulated",
    "FLT": "free contour programming is not simulated",
    "FC": "free contour programming is not simulated",
    "FCT": "free contour programming is not simulated",
    "FSELECT": "free contour programming is not simulated",
    "SPL": "splines are not simulated",
    "PATTERN": "point patterns are not simulated",
    "SEL": "tables, contours and programs are not selected here",
    "DECLARE": "strings are not simulated",
    "QS": "string parameters are not simulated",
    "TRANS": "is not simulated: cycles 7, 8, 10 and 11 are",
    "TCH": "touch probes measure what only the machine knows",
    "CONTOUR": "contour cycles are not simulated",
    "OPEN": "files are not written",
}

#: M functions with an effect on the path, the cycles or the program.
M_MACHINE: Final = 91
M_SECOND_MACHINE: Final = 92
M_SHORTEST: Final = 126
M_NOT_SHORTEST: Final = 127
M_TCP: Final = 128
M_DISPLAY: Final = 94
M_TCP_OFF: Final = 129
M_AT_ENDS: Final = 114
M_AT_ENDS_OFF: Final = 115
M_RETRACT: Final = 140
M_CALL: Final = 99
M_CALL_MODAL: Final = 89
M_PER_TURN: Final = 136
M_PER_MINUTE: Final = 137
M_FEED_AT_TIP: Final = 116
M_FEED_IN_DEGREES: Final = 117
M_TOOL_CHANGE: Final = 6
M_PROGRAM_ENDS: Final = frozenset({2, 30})

#: M functions that make events: kinds and values, in order.
M_EVENTS: Final = {
    0: (("stop", None),),
    1: (("optional_stop", None),),
    3: (("spindle", "clockwise"),),
    4: (("spindle", "counter-clockwise"),),
    5: (("spindle", "off"),),
    8: (("coolant", "flood"),),
    9: (("coolant", "off"),),
    13: (("spindle", "clockwise"), ("coolant", "flood")),
    14: (("spindle", "counter-clockwise"), ("coolant", "flood")),
    19: (("spindle", "oriented"),),
}

#: M functions that switch coolant and nothing else, and its word in CL files.
M_COOLANTS: Final = {
    code: str(events[0][1]).upper() for code, events in M_EVENTS.items() if {kind for kind, _ in events} == {"coolant"}
}

#: M functions that act after the motion of their block.
M_AFTER_MOTION: Final = M_PROGRAM_ENDS | {
    0, 1, 5, 9, M_TOOL_CHANGE, M_FEED_IN_DEGREES, M_NOT_SHORTEST, M_TCP_OFF, M_AT_ENDS_OFF, M_CALL,
}  # fmt: skip

#: M functions that the path does not depend on.
M_WITHOUT_PATH_EFFECT: Final = {
    90: "constant contour speed at corners",
    M_DISPLAY: "the display of rotary axes comes back below 360",
    97: "small contour steps",
    101: "replacement tools",
    102: "no replacement tools",
    103: "without F: moves down at the feed as programmed",
    107: "no message for oversize",
    108: "message for oversize again",
    111: "contour speed as usual",
    120: "look-ahead for compensated contours",
    124: "points that are left out, within T",
    134: "exact stop at corners with rotary axes",
    135: "no exact stop",
    138: "rotary axes that tilt",
    141: "touch probe monitoring",
    145: "display without it",
    148: "lift-off at a stop",
    149: "no lift-off",
}

#: What those do that no path shows, for comparisons: the mode that each sets.
M_UNSEEN_MODES: Final = {
    90: "contour speed", 101: "replacement tools", 102: "replacement tools", 103: "feed downwards",
    107: "message for oversize", 108: "message for oversize", 110: "feed at arcs", 111: "feed at arcs",
    118: "handwheel", 120: "look-ahead", 124: "points left out", 134: "exact stop of rotary axes",
    135: "exact stop of rotary axes", 138: "rotary axes that tilt", 148: "lift-off", 149: "lift-off",
}  # fmt: skip

#: Of these, those that change how the machine runs, which no CL file asks for: corners at the feed of the contour,
#: another tool when the first one is worn, a lower feed at arcs, moves by the handwheel.
M_ALTERING: Final = frozenset({90, 101, 110, 118})

#: The others act once, where they stand: 94 takes a rotary axis back below 360 degrees, 97 passes small steps, 141
#: lets a probe go, 143 deletes a rotation, and 145 is of the display.
M_UNSEEN_ONCE: Final = frozenset({94, 97, 141, 143, *range(200, 205)})

#: Of these, those whose words change what the program does: the message.
M_WORDS_NOT_SIMULATED: Final = {
    (103, "F"): "moves down have another feed: not simulated",
}

#: Limits the rotary axes that tilt to those of its words.
M_TILTING_AXES: Final = 138

#: Leaves out points that are nearer to each other than its T.
M_POINT_FILTER: Final = 124

#: M functions that are not simulated: the message, and whether the path is wrong without them.
M_NOT_SIMULATED: Final = {
    98: ("ends an open contour corner: not simulated", True),
    104: ("takes the last datum again: not simulated", True),
    109: ("arcs have another feed: not simulated", True),
    110: ("lowers the feed at compensated inner arcs: not simulated", False),
    112: ("contour transitions are not simulated", True),
    118: ("handwheel superimposed: not simulated", False),
    130: ("positions in the untilted coordinate system: not simulated", True),
    142: ("deletes modal program information: not simulated", True),
    144: ("positions count with the offset of the head: not simulated", True),
    150: ("suppresses the message of a limit switch: not simulated", True),
    143: ("deletes a basic rotation, which only the control knows", True),
    200: ("laser cutting is not simulated", False),
    201: ("laser cutting is not simulated", False),
    202: ("laser cutting is not simulated", False),
    203: ("laser cutting is not simulated", False),
    204: ("laser cutting is not simulated", False),
}

#: Words that belong to an M function if they follow it.
M_ARGUMENTS: Final = {
    M_DISPLAY: _words("X Y Z A B C U V W"),
    103: _words("F"),
    M_AT_ENDS: _words("A B C"),
    118: _words("X Y Z A B C U V W VT"),
    120: _words("LA"),
    124: _words("T"),
    M_TCP: _words("F FMAX MAX AUTO"),
    138: _words("A B C"),
    M_RETRACT: _words("MB MAX F FMAX"),
}

#: M functions that stay on until a word cancels them, and those words: the function that each is about.
M_MODES: Final = {M_CALL_MODAL: 89, M_CALL: 89, M_FEED_AT_TIP: 116, M_FEED_IN_DEGREES: 116, 118: 118, 120: 120}

#: Cycles that act as soon as they are defined, by number.
DATUM: Final = 7
MIRROR: Final = 8
DWELL: Final = 9
ROTATION: Final = 10
CONTOUR: Final = 14
SCALING: Final = 11
ORIENTATION: Final = 13
TILT: Final = 19
AXIS_SCALING: Final = 26
TOLERANCE: Final = 32
PRESET: Final = 247

#: Words of cycle 32 by line, with what their values may be; True: any that is not below zero.
TOLERANCE_WORDS: Final = {(1, "T"): True, (2, "HSC-MODE"): one_of(0, 1), (2, "TA"): True}

#: Values of the words that belong to an M function.
M_VALUES: Final = {(120, "LA"): whole(0, 99), (M_RETRACT, "MB"): between(0.0, 1e5)}

#: Its path is simulated without the tool radius.
BORE_MILLING: Final = 208

#: A contour, and a slot, on a cylinder.
CYLINDER: Final = 27
CYLINDER_SLOT: Final = 28
ON_CYLINDER: Final = frozenset({CYLINDER, CYLINDER_SLOT})

#: Q parameters without which the motions of a cycle are not known, by its number. A control asks for each of them, and
#: a definition without one leaves an older value in force. Those that newer software has added are not among them.
CYCLE_PARAMETERS: Final = {
    200: (200, 201, 206, 202, 210, 203, 204, 211),
    201: (200, 201, 206, 211, 208, 203, 204),
    202: (200, 201, 206, 211, 208, 203, 204, 214),
    203: (200, 201, 206, 202, 210, 203, 204, 212, 213, 205, 211, 208, 256),
    204: (200, 249, 250, 251, 252, 253, 254, 255, 203, 204, 214),
    205: (200, 201, 206, 202, 203, 204, 212, 205, 258, 259, 257, 256, 211),
    206: (200, 201, 206, 211, 203, 204),
    207: (200, 201, 239, 203, 204),
    208: (200, 201, 206, 334, 203, 204, 335),
    209: (200, 201, 239, 203, 204, 257, 256),
    240: (200, 343, 201, 206, 211, 203, 204),
    241: (200, 201, 206, 211, 203, 204, 379, 253, 208),
    220: (216, 217, 244, 245, 246, 247, 241, 200, 203, 204, 301),
    221: (225, 226, 237, 238, 242, 243, 224, 200, 203, 204, 301),
    PRESET: (339,),
    CYLINDER: (1, 3, 6, 10, 11, 12, 16, 17),
    CYLINDER_SLOT: (1, 3, 6, 10, 11, 12, 16, 17, 20),
}

#: Q parameters that newer software has added to cycles, or that some machines leave out. Any other belongs to none.
CYCLE_OPTIONS: Final = {
    200: (395,),
    202: (336, 357),
    203: (395,),
    204: (336,),
    205: (208, 253, 373, 379, 395),
    CYLINDER_SLOT: (21,),
    208: (342, 351, 370),
    209: (336, 403),
    220: (365,),
    240: (253, 342, 344),
    241: (202, 205, 212, 395, 401, 427, 428, 429, 430, 435, 436),
}

#: Lines of the older cycles that blocks call, by number: the value of each.
CYCLE_LINES: Final = {
    1: {1: "DIST", 2: "DEPTH", 3: "PLNGNG", 4: "DWELL", 5: "F"},
    2: {1: "DIST", 2: "DEPTH", 3: "DWELL", 4: "F"},
    17: {1: "DIST", 2: "DEPTH", 3: "PITCH"},
}

#: Cycles that are not simulated: their names.
CYCLES_NOT_SIMULATED: Final = {
    3: "slot milling", 4: "pocket milling", 5: "circular pocket", 6: "rough-out", 12: "program call",
    15: "pilot drilling", 16: "contour milling", 18: "thread cutting", 20: "contour data", 21: "pilot drilling",
    22: "rough-out", 23: "floor finishing", 24: "side finishing", 25: "contour train",
    29: "cylinder surface ridge", 39: "cylinder surface contour",
    225: "engraving", 230: "multipass milling", 231: "ruled surface",
    232: "face milling", 233: "face milling", 239: "load measuring", 251: "rectangular pocket",
    252: "circular pocket", 253: "slot milling", 254: "circular slot", 256: "rectangular stud", 257: "circular stud",
    258: "polygon stud", 262: "thread milling", 263: "thread milling and countersinking",
    264: "thread drilling and milling", 265: "helical thread drilling and milling", 267: "outside thread milling",
    270: "contour train data", 271: "OCM contour data", 272: "OCM roughing", 273: "OCM floor finishing",
    274: "OCM side finishing", 275: "trochoidal slot", 276: "three-dimensional contour train",
}  # fmt: skip

#: Of these, those that act as soon as they are defined.
ACT_WHEN_DEFINED: Final = frozenset({239})

#: Cycles that execute the cycle before at all positions of a pattern, as soon as they are defined.
PATTERNS: Final = frozenset({220, 221})

#: FN functions that write system data, those of tools and presets among them, which the path does not show.
FN_SYSTEM_DATA: Final = frozenset({17, 25})

#: FN functions that stop the program, or let it wait.
FN_WAITS: Final = frozenset({14, 20})

#: FN functions that stop the program, wait, or speak to the PLC, which may do anything: no path shows them.
FN_ACTS: Final = FN_WAITS | {19, 29}

#: FN functions that are not simulated: what they do.
FN_NOT_SIMULATED: Final = {
    14: "stops the program with an error message", 15: "prints", 16: "prints to a file", 17: "writes system data",
    19: "speaks to the PLC", 20: "waits for the PLC", 25: "sets a preset", 26: "opens a table",
    27: "writes to a table", 29: "speaks to the PLC", 37: "exports parameters",
    38: "sends a message",
}  # fmt: skip
