"""The words of a Sinumerik that the reader knows, by their effect; ``docs/reader.md`` describes them."""

from typing import Final

from trunnion.readers.control.iso_m_codes import PROGRAM_ENDS
from trunnion.readers.program.word_values import GREATEST_TURN, Values, one_of, whole


def _words(text: str) -> frozenset[str]:
    return frozenset(text.split())


#: G words with an effect on motion, besides G0 to G3.
G_PLANES: Final = {17: "Z", 18: "Y", 19: "X"}
G_UNITS: Final = {70: (True, False), 71: (False, False), 700: (True, True), 710: (False, True)}
G_FEEDS: Final = {
    93: 93,
    94: 94,
    95: 95,
    96: 95,
    961: 94,
    962: 95,
    97: 95,
    971: 94,
    972: 94,
    973: 95,
}

#: Constant surface speed.
G_SURFACE: Final = frozenset({96, 961, 962})
G_OFFSETS: Final = frozenset({54, 55, 56, 57, 500, *range(505, 600)})
G_MACHINE: Final = frozenset({53, 153})

#: Cutter radius compensation: left of the path, right of it, off.
G_RADIUS_COMPENSATION: Final = {40: 0, 41: 1, 42: -1}

#: G words to which the machine's builder gives a meaning: nobody else knows it.
G_RESERVED: Final = frozenset({*range(810, 815), *range(820, 825)})

#: G words that the path does not depend on.
G_WITHOUT_PATH_EFFECT: Final = {
    9: "exact stop, one block",
    60: "exact stop",
    601: "exact stop fine",
    602: "exact stop coarse",
    603: "exact stop at interpolation end",
    64: "continuous path",
    641: "continuous path with rounding",
    642: "continuous path, axis tolerance",
    643: "continuous path, block-internal",
    644: "continuous path, best dynamics",
    645: "continuous path, also tangential",
    110: "pole of polar positions, which are errors",
    111: "pole of polar positions, which are errors",
    112: "pole of polar positions, which are errors",
    140: "smooth approach direction",
    141: "smooth approach direction",
    142: "smooth approach direction",
    143: "smooth approach direction",
    290: "Siemens mode",
    340: "smooth approach in space",
    341: "smooth approach in the plane",
    450: "corners on arcs",
    451: "corners on intersections",
    460: "collision monitoring",
    461: "collision monitoring",
    462: "collision monitoring",
}

#: G words of which a block has one at most: the groups of the control.
G_GROUPS: Final = (
    frozenset({0, 1, 2, 3, 33, 331, 332}),
    frozenset({4, 63, 74, 75, 147, 148, 247, 248, 347, 348}),
    frozenset({25, 26, 58, 59, 110, 111, 112}),
    frozenset(G_PLANES),
    frozenset(G_RADIUS_COMPENSATION),
    G_OFFSETS,
    G_MACHINE,
    frozenset({60, 64, 641, 642, 643, 644, 645}),
    frozenset({601, 602, 603}),
    frozenset(G_UNITS),
    frozenset({90, 91}),
    frozenset(G_FEEDS),
    frozenset({450, 451}),
    frozenset({140, 141, 142, 143}),
    frozenset({340, 341}),
    frozenset({460, 461, 462}),
)

#: Modes of which the path shows the word, by their G words; ``unseen_modes`` has the others.
G_SHOWN_MODES: Final = {
    **dict.fromkeys(G_PLANES, "plane"),
    **dict.fromkeys((90, 91), "distances"),
    **dict.fromkeys(G_FEEDS, "feed"),
    **dict.fromkeys(G_RADIUS_COMPENSATION, "compensation"),
}

#: How the control goes through the ends of blocks, by G code: ``RowRecorder.add_exact_stop``.
EXACT_STOPS: Final = {9: "block", 60: "on", 64: "off", 641: "off", 642: "off", 643: "off", 644: "off", 645: "off"}

#: What the message says of radius compensation.
_COMPENSATION: Final = (
    "radius compensation: the path is read as programmed, and the tool centre goes beside it by what the register holds"
)

#: G words that are not simulated: the message, and whether the path is wrong without them.
G_NOT_SIMULATED: Final = {
    33: ("thread cutting is taken as a straight line", True),
    41: (_COMPENSATION, False),
    42: (_COMPENSATION, False),
    63: ("tapping is taken as a straight line", True),
    331: ("tapping is taken as a straight line", True),
    332: ("tapping is taken as a straight line", True),
    74: ("goes to a reference point that only the machine knows", True),
    75: ("goes to a fixed point that only the machine knows", True),
    25: ("limits the speed of the spindle or the working area: not simulated", True),
    26: ("limits the speed of the spindle or the working area: not simulated", True),
    58: ("adds to the work offset: not simulated", True),
    59: ("adds to the work offset: not simulated", True),
    621: ("another feed at corners is not simulated", True),
    147: ("smooth approach is not simulated", True),
    148: ("smooth approach is not simulated", True),
    247: ("smooth approach is not simulated", True),
    248: ("smooth approach is not simulated", True),
    291: ("ISO mode is another language", True),
    347: ("smooth approach is not simulated", True),
    348: ("smooth approach is not simulated", True),
}

#: G words whose axis words are no positions: their block makes no motion.
G_NO_MOTION: Final = frozenset({25, 26, 58, 59, 74, 75, 110, 111, 112})

#: G words that set limits, also of the spindle speed.
G_LIMITS: Final = frozenset({25, 26})

#: Words that count within radius compensation only: their group, and what they change there; empty: nothing.
WITHIN_COMPENSATION: Final = {
    "CFC": ("feed", ""),
    "CFTCP": ("feed", "F counts at the tool centre"),
    "CFIN": ("feed", "F counts at the contour on inside corners only"),
    "CFCIN": ("feed", "F counts at the contour on inside corners only"),
    "G450": ("outer", ""),
    "G451": ("outer", ""),
    "DISC": ("outer", ""),
    "NORM": ("approach", ""),
    "KONT": ("approach", ""),
    "KONTC": ("approach", "it is approached along a curve"),
    "KONTT": ("approach", "it is approached along a curve"),
    "CUTCONON": ("constant", "it is held"),
    "CUTCONOF": ("constant", ""),
    "G62": ("corners", "the feed is lowered at inside corners"),
    "FENDNORM": ("corners", ""),
    "CDON": ("bottlenecks", ""),
    "CDOF": ("bottlenecks", ""),
    "CDOF2": ("bottlenecks", ""),
}
#: With it the control leaves out blocks between which the contour is too narrow for the tool. Where the tool fits, the
#: path is the same; without it such a place is an alarm, or a damaged contour.
BOTTLENECKS: Final = "CDON"

#: Words without a value that the path does not depend on.
WITHOUT_PATH_EFFECT: Final = _words("""
    NORM KONT KONTC KONTT FNORM FENDNORM
    CFC CFTCP CFIN CFCIN
    CUT2D CUT2DF CUT3DC CUT3DF CUT3DFS CUT3DFF CUTCONON CUTCONOF CDON CDOF CDOF2
    COMPOF COMPON COMPCURV COMPCAD COMPSURF
    FFWON FFWOF SOFT BRISK DRIVE SOFTA BRISKA DRIVEA
    DYNNORM DYNPOS DYNROUGH DYNSEMIFIN DYNFINISH DYNPREC
    UPATH SPATH
    ORISON ORISOF
    STOPRE STARTFIFO STOPFIFO FIFOCTRL SPCON SPCOF WALIMON WALIMOF
    SBLON SBLOF DISPLOF DISPLON ACTBLOCNO
    PAROTOF TCOFR TCABS
    RTLION CPRECON CPRECOF
    DIAMOF DIAMCYCOF
    IPOBRKA IPOENDA FINEA COARSEA
    """)

#: Words with ``=value`` or ``[axis]=value`` that the path does not depend on.
WITHOUT_PATH_EFFECT_VALUES: Final = _words("""
    ADIS ADISPOS CTOL OTOL ATOL STOL OTOLG CTOLG FGREF OVR OVRA OVRRAP ACC VELOLIM JERKLIM ACCLIM SCC
    TOFFL TOFFR TOFF TOFFLR DISC DISCL DISR DISRP FB FD FDA FA DITS DITE FZ FP
    """)

#: Those within which the control may round off the path, mm.
TOLERANCES: Final = frozenset({"ADIS", "CTOL", "ATOL"})

#: Those that add to the length or the radius of the tool.
TOOL_DELTAS: Final = frozenset({"TOFFL", "TOFFR", "TOFF", "TOFFLR"})

#: Those that put another feed in place of F, or a share of it: their value where they change nothing, percent.
OTHER_FEEDS: Final = {"OVR": 100.0, "VELOLIM": 100.0, "FB": None, "FD": None, "FDA": None, "FZ": None}

#: The radius at which F counts for rotary axes, and the one at which a degree is a millimetre, mm.
FEED_RADIUS: Final = "FGREF"
DEGREE_AS_MILLIMETRE: Final = 57.296

#: Those within which the control may leave rapids, mm, or the tool axis, degrees: the greatest value that the checks
#: allow for. STOL is a factor.
GREATEST: Final = {"ADISPOS": 1.0, "CTOLG": 1.0, "STOL": 10.0, "OTOL": GREATEST_TURN, "OTOLG": GREATEST_TURN}

#: That of the tool axis in cuts.
ORIENTATION_TOLERANCE: Final = "OTOL"

#: Mode of CYCLE832: the machining type, in tens whether the second tolerance is that of the orientation, in millions
#: the smoothing of surfaces. The digits in between are those of older software.
SMOOTHING_TYPES: Final = whole(0, 4)
SMOOTHING_ORIENTATION: Final = one_of(0, 1)
SMOOTHING_SURFACES: Final = whole(0, 2)

#: CYCLE800: what the retract (_FR), the last digit of _ST and the direction (_DIR) may be.
SWIVEL_RETRACTS: Final = whole(0, 8)
SWIVEL_STYLES: Final = one_of(0, 1)
SWIVEL_DIRECTIONS: Final = one_of(-1, 0, 1)

#: Values of drilling cycles by their place in the list, from 1: the kinds of pecks (VARI), units of pitches (_PITA).
CYCLE_VALUES: Final[dict[str, dict[int, Values]]] = {
    "CYCLE83": {12: one_of(0, 1)},
    "CYCLE84": {14: whole(0, 4), 16: whole(0, 2)},
    "CYCLE840": {13: whole(0, 4)},
}

#: Values that a call cannot do without, by their places: omitted ones count as 0, which is no speed, feed or sense.
CYCLE_NEEDS: Final[dict[str, dict[int, str]]] = {
    "CYCLE84": {7: "SDAC", 11: "SST"},
    "CYCLE85": {7: "FFR", 8: "RFF"},
    "CYCLE86": {7: "SDIR"},
    "CYCLE87": {6: "SDIR"},
    "CYCLE88": {7: "SDIR"},
}

#: Words with arguments that the path does not depend on.
WITHOUT_PATH_EFFECT_CALLS: Final = _words("""
    WORKPIECE EXTERN SOFTA BRISKA DRIVEA FIFOCTRL SPCON SPCOF GETD GET RELEASE WAITM SETM CLEARM WAITP WAITS
    ORISOF ORISON GROUP_BEGIN GROUP_END GROUP_ADDEND TOFFOF
    """)

#: Of these, those with which a program waits for another channel.
WAITS: Final = frozenset({"WAITM", "GET"})

#: Chooses the axes that F counts for.
FEED_GROUP: Final = "FGROUP"

#: Words that are not simulated, and without which the path is wrong.
NOT_SIMULATED: Final = _words("""
    ROTS AROTS CROTS CROT CTRANS CSCALE CMIRROR TOFRAMEX TOFRAMEY TOROTX TOROTY PAROT
    TRANSMIT TRACYL TRAANG TRACON
    AP RP BSPLINE ASPLINE CSPLINE POLYPATH PW SD INVCW INVCCW
    ORIPATH ORIPATHS ORICURVE ORICONCW ORICONCCW ORICONIO ORICONTO ORIVIRT1 ORIVIRT2 ORIRESET
    TCARR CPON MEAS MEAW POS POSA SPOSA FXS COUPON COUPONC COUPOF DRFOF
    TOFFON
    FLIN FCUB FPO FL SVC LIMS RTLIOF DIAMON DIAM90 SAVE
    """)

#: Cycles of the control that are not simulated: what they do. A file of the name that is given is called all the same.
CYCLES_NOT_SIMULATED: Final = {
    "CYCLE60": "engraving", "CYCLE61": "face milling", "CYCLE62": "choice of a contour", "CYCLE63": "contour pocket",
    "CYCLE64": "pilot holes of a contour pocket", "CYCLE70": "thread milling", "CYCLE71": "face milling",
    "CYCLE72": "contour milling", "CYCLE73": "pocket with islands", "CYCLE74": "edge of a pocket",
    "CYCLE75": "edge of an island", "CYCLE76": "rectangular stud", "CYCLE77": "circular stud",
    "CYCLE78": "drilling and milling of a thread", "CYCLE79": "polygon stud", "CYCLE90": "thread milling",
    "CYCLE801": "cycle at a grid of positions", "CYCLE802": "cycle at positions", "CYCLE899": "open slot",
    "CYCLE930": "turned groove", "CYCLE940": "undercut", "CYCLE951": "stock removal", "CYCLE952": "contour turning",
    "HOLES1": "cycle at a row of positions", "HOLES2": "cycle at a circle of positions",
    "LONGHOLE": "slots on a circle", "SLOT1": "slots on a circle", "SLOT2": "slots along a circle",
    "POCKET1": "rectangular pocket", "POCKET2": "circular pocket", "POCKET3": "rectangular pocket",
    "POCKET4": "circular pocket",
    "CYCLE971": "measuring of a tool", "CYCLE976": "calibrating of a probe", "CYCLE977": "measuring of a hole or stud",
    "CYCLE978": "measuring of a surface", "CYCLE979": "measuring of a hole or stud",
    "CYCLE996": "measuring of the kinematics", "CYCLE997": "measuring of balls", "CYCLE998": "measuring of an angle",
}  # fmt: skip

#: Words that round or chamfer the corner at the end of their block, and the feed there: RNDM and FRCM until they are 0.
CORNERS: Final = frozenset({"RND", "RNDM", "CHF", "CHR"})
CORNER_FEEDS: Final = frozenset({"FRC", "FRCM"})

#: The control looks past so many blocks without motion for the other side of a corner (MD20200 as it is delivered).
BLOCKS_IN_CORNER: Final = 3

#: Words that control the orientation.
ORIENTATION: Final = frozenset({"ORIWKS", "ORIMKS", "ORIAXES", "ORIVECT", "ORIPLANE", "ORIEULER", "ORIRPY", "ORIRPY2"})

#: Frame statements, each in a block of its own.
FRAMES: Final = frozenset({"TRANS", "ATRANS", "ROT", "AROT", "SCALE", "ASCALE", "MIRROR", "AMIRROR"})

#: Words that turn the frame so that its Z is along the tool, and back.
TOOL_FRAMES: Final = frozenset({"TOROT", "TOROTZ", "TOFRAME", "TOFRAMEZ", "TOROTOF", "TOFRAMEOF"})

#: Keywords of control flow.
FLOW: Final = _words("""
    IF ELSE ENDIF FOR TO ENDFOR WHILE ENDWHILE LOOP ENDLOOP REPEAT REPEATB UNTIL
    GOTO GOTOF GOTOB GOTOC GOTOS CASE OF DEFAULT
    PROC ENDPROC RET DEF EXTERN CALL EXTCALL MCALL
    """)

#: Types of variables.
TYPES: Final = frozenset({"REAL", "INT", "BOOL", "CHAR", "STRING", "AXIS", "FRAME"})

#: Functions that give the mode of a position.
POSITION_MODES: Final = frozenset({"AC", "IC", "DC", "ACP", "ACN"})

#: Words without a value that set a mode of the motion.
MODES: Final = frozenset({"TRAORI", "TRAFOOF", "SUPA", "CIP", "CT", "POLY"})

#: Other words with an effect: circles, polynomials, corners, messages.
ACTIVE: Final = (
    MODES | CORNERS | CORNER_FEEDS | frozenset({"CR", "TURN", "AR", "ANG", "RPL", "PO", "PL", "SPOS", "MSG", "SETAL"})
)

#: Values of predefined names; modes of CYCLE832 as the digits of S_TOLM.
CONSTANTS: Final = {
    "TRUE": 1,
    "FALSE": 0,
    "$PI": 3.141592653589793,
    "PI": 3.141592653589793,
    "_OFF": 0,
    "_FINISH": 1,
    "_SEMIFIN": 2,
    "_ROUGH": 3,
    "_PRECISION": 4,
    "_ORI_FINISH": 11,
    "_ORI_SEMIFIN": 12,
    "_ORI_ROUGH": 13,
    "_ORI_PRECISION": 14,
    "_TOP_SURFACE_SMOOTH_OFF": 1000000,
    "_TOP_SURFACE_SMOOTH_ON": 2000000,
}

#: Gears of the spindle; M40 lets the control choose.
M_GEARS: Final = range(41, 46)

#: The spindle becomes an axis.
M_AXIS_MODE: Final = 70

#: The M code that ends a subprogram. Those that are not in ``iso_m_codes`` are the machine builder's: events "m".
M_RETURN: Final = 17

#: M codes that act after the motion of their block.
M_AFTER_MOTION: Final = frozenset({0, 1, 5, 9, M_RETURN}) | PROGRAM_ENDS
