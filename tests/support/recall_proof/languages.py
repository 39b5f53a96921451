"""The words of six languages that edits need, as data: what a line is, what is inserted, replaced and dropped.

A fault's text that holds ``{n}`` gets the next free block number, where the language wants one.
"""

from dataclasses import dataclass, field


@dataclass(frozen=True)
class Language:
    """How edits find and change words.

    comment     what is no code in a line
    away        lines whose coordinates are none of the part: machine positions, planes, cycles, home
    rapid       words that begin rapid motion; ``feed`` those that begin motion at feed
    arc         a block that is an arc
    inserted    kind -> block that is put before a cut
    replaced    kind -> (what is found, what takes its place), in code of any line that has it
    dropped     kind -> what a line holds that is left out whole, or the word that is
    cut_word    kind -> (what is found, what takes its place), in blocks that cut
    pole        a block that states the centre of circles for those behind it
    tcp, plane  what begins TCP and a tilted plane; ``no_tcp`` and ``no_plane`` what ends them
    """

    comment: str
    away: str
    rapid: str
    feed: str
    arc: str
    inserted: dict[str, str]
    replaced: dict[str, tuple[str, str]]
    dropped: dict[str, str] = field(default_factory=dict)
    cut_word: dict[str, tuple[str, str]] = field(default_factory=dict)
    tcp: str = "(?!)"
    no_tcp: str = "(?!)"
    plane: str = "(?!)"
    no_plane: str = "(?!)"
    skip: str = "/"
    pole: str = "(?!)"


_ISO_RAPID, _ISO_FEED, _ISO_ARC = r"\bG0?0\b", r"\bG0?[123]\b", r"\bG0?[23]\b"

_ISO_CUT_WORD = {
    "a cut at rapid": (r"\bG0?1\b", "G0"),
    "an arc the other way": (r"\bG0?([23])\b", "G~"),
    "an arc as a line": (r"\bG0?[23]\b", "G1"),
}

_ISO_REPLACED = {
    "the spindle turns the other way": (r"\bM0?3\b", "M4"),
    "other coolant": (r"\bM0?8\b", "M7"),
    "another work offset": (r"\bG54\b", "G55"),
    "rapid at feed": (r"\bG0?0(?= [XYZ])", "G1"),
    "feed by time": (r"\bG94\b", "G93"),
    "drilling for boring": (r"\bG85\b", "G86"),
    "drilling without dwell": (r"\bG82\b", "G81"),
    "drilling without pecks": (r"\bG83\b", "G81"),
    "chip breaking for pecks": (r"\bG83\b", "G73"),
    "tapping for drilling": (r"\bG8[123]\b", "G84"),
    "drilling for tapping": (r"\bG84\b", "G81"),
}

_ISO_INSERTED = {
    "incremental from here": "G91",
    "another plane of arcs": "G18",
    "feed a turn": "G95",
    "the spindle stops in the cut": "M5",
    "the spindle turns back in the cut": "M4",
    "coolant off in the cut": "M9",
    "a stop in the cut": "M0",
    "an optional stop in the cut": "M1",
    "the program ends in the cut": "M30",
    "a tool change in the cut": "T9 M6",
    "compensation in the cut": "G41 D1",
    "a jump home in the cut": "G28 Z0.",
    "a shift in the cut": "G52 X1. Y0. Z0.",
    "an offset over another": "G92 X0.",
    "another offset in the cut": "G56",
    "another speed in the cut": "S77",
    "another feed in the cut": "F7777.",
}

_FANUC_INSERTED = _ISO_INSERTED | {
    "inches in the cut": "G20",
    "a dwell in the cut": "G4 P900",
    "a mirror in the cut": "G51.1 X0.",
    "a scale in the cut": "G51 X0. Y0. Z0. P2000",
    "a rotation in the cut": "G68 X0. Y0. R5.",
    "an offset is written": "G10 L2 P1 X7. Y0. Z0.",
    "an offset is shifted": "G91 G10 L2 P1 X7.\n{n} G90",
    "an offset is written by its variable": "#5221=0.",
    "a jump that hangs on an unset variable": "IF [#577 EQ 0] GOTO 9999",
    "the length off in the cut": "G49",
    "another length in the cut": "G43 H77",
    "a tool length is written": "G10 L10 P1 R60.",
}

_FANUC_DROPPED = {
    "no tool change": r"\bM0?6\b",
    "no length": r"\bG43(?:\.4)?\b.*|\bG234\b.*",
    "no start of the spindle": r"\bM0?3\b",
    "no coolant": r"\bM0?8\b",
    "no work offset": r"\bG54\b",
    "no plane": r"^.*\bG68\.2\b.*$|^.*\bG254\b.*$",
    "no turn to the plane": r"^.*\bG53\.1\b.*$",
    "no end of the cycle": r"\bG80\b(?! G90)",
    "no end": r"^.*\bM30\b.*$",
}

FANUC = Language(
    comment=r"\([^)]*\)|^%.*$|^O\d+.*$",
    away=r"\bG53\b|\bG28\b|\bG68\.2\b|\bG10\b|\bG254\b|\bG52\b|\bG92\b",
    rapid=_ISO_RAPID,
    feed=_ISO_FEED,
    arc=_ISO_ARC,
    inserted=_FANUC_INSERTED,
    replaced={
        **_ISO_REPLACED,
        "another tool": (r"\bT(\d+)(?= M)", "+1"),
        "another length": (r"\bH(\d+)\b", "+1"),
        "another speed": (r"\bS(\d+)\b", "*2"),
        "a tenth of the feed": (r"\bF(\d+\.?\d*)", "/10"),
        "ten times the feed": (r"\bF(\d+\.?\d*)", "*10"),
        "the plane is tilted otherwise": (r"(?<=\bJ)(-?\d+\.?\d*)(?= K)", "+1"),
        "the plane is turned otherwise": (r"(?<=\bI)(-?\d+\.?\d*)(?= J-?\d+\.?\d* K)", "+1"),
        "another depth of the cycle": (r"(?<=G8[1-9] )(X[^ ]+ Y[^ ]+ Z)(-?\d+\.?\d*)", "-1"),
        "another height of the cycle": (r"(?<=\bR)(-?\d+\.?\d*)(?= [QPF])", "+1"),
        "another peck": (r"(?<=\bQ)(\d+\.?\d*)(?= F)", "*2"),
        "another dwell": (r"(?<=\bP)(\d+\.?\d*)(?= F)", "*3"),
        "back to another height": (r"\bG98\b", "G99"),
    },
    dropped=_FANUC_DROPPED,
    cut_word=_ISO_CUT_WORD | {"an unset variable": (r"(?<=[XYZ])-?\d+\.?\d*", "#577")},
    tcp=r"\bG43\.[45]\b|\bG234\b",
    no_tcp=r"\bG49\b",
)

HAAS = FANUC

LINUXCNC = Language(
    comment=r";.*$|\([^)]*\)|^%.*$",
    away=r"\bG53\b|\bG28\b|\bG10\b|\bG52\b|\bG92\b",
    rapid=_ISO_RAPID,
    feed=_ISO_FEED,
    arc=_ISO_ARC,
    inserted=_ISO_INSERTED
    | {
        "inches in the cut": "G20",
        "a dwell in the cut": "G4 P9",
        "an offset is written": "G10 L2 P1 X7 Y0 Z0",
        "an offset is shifted": "G10 L20 P1 X1",
        "an offset is written by its variable": "#5221=0",
        "a rotation in the cut": "G10 L2 P1 R5",
        "the length off in the cut": "G49",
        "another length in the cut": "G43.1 Z60",
        "TCP off in the cut": "M429",
        "compensation in the cut": "G41.1 D4",
        "another speed in the cut": "S77",
    },
    replaced={
        **_ISO_REPLACED,
        "another tool": (r"\bT(\d+)(?= M)", "+1"),
        "another length": (r"\bH(\d+)\b", "+1"),
        "another speed": (r"\bS(\d+)\b", "*2"),
        "a tenth of the feed": (r"\bF(\d+\.?\d*)", "/10"),
        "ten times the feed": (r"\bF(\d+\.?\d*)", "*10"),
        "another depth of the cycle": (r"(?<=G8[1-9] )(X[^ ]+ Y[^ ]+ Z)(-?\d+\.?\d*)", "-1"),
        "another height of the cycle": (r"(?<=\bR)(-?\d+\.?\d*)(?= [QPF])", "+1"),
        "another peck": (r"(?<=\bQ)(\d+\.?\d*)(?= F)", "*2"),
        "another dwell": (r"(?<=\bP)(\d+\.?\d*)(?= F)", "*3"),
        "back to another height": (r"\bG98\b", "G99"),
    },
    dropped={
        "no tool change": r"\bM0?6\b",
        "no length": r"^.*\bG43\b.*$",
        "no start of the spindle": r"\bM0?3\b",
        "no coolant": r"\bM0?8\b",
        "no work offset": r"\bG54\b",
        "no TCP": r"^.*\bM428\b.*$",
        "no end of the cycle": r"\bG80\b(?! G90)",
        "no end": r"^.*\bM0?2\b.*$|^.*\bM30\b.*$",
    },
    cut_word=_ISO_CUT_WORD | {"an unset variable": (r"(?<=[XYZ])-?\d+\.?\d*", "#577")},
    tcp=r"\bM428\b",
    no_tcp=r"\bM429\b",
)

SINUMERIK = Language(
    comment=r";.*$|^MSG\(.*$|(?<=\d )MSG\(.*$",
    away=r"\bSUPA\b|\bG53\b|\bG153\b|_HOME|\bCYCLE800|\bDEF\b|\b(?:MCALL|CYCLE)|\b(?:TRANS|ROT|ATRANS|AROT)\b",
    rapid=_ISO_RAPID,
    feed=_ISO_FEED,
    arc=_ISO_ARC,
    inserted={kind: text for kind, text in _ISO_INSERTED.items() if text[:3] not in ("G28", "G52", "G92", "T9 ", "G41")}
    | {
        "inches in the cut": "G700",
        "a dwell in the cut": "G4 F9",
        "a shift in the cut": "TRANS X1",
        "a mirror in the cut": "MIRROR X0",
        "a scale in the cut": "SCALE X2 Y2 Z2",
        "a rotation in the cut": "ROT RPL=5",
        "an offset is written": "$P_UIFR[1]=CTRANS(X,0,Y,0,Z,0)",
        "an offset over another": "$P_UIFR[1,X,TR]=0",
        "a jump that hangs on an unset variable": "IF R77==0 GOTOF ENDE_UNSET",
        "the edge off in the cut": "D0",
        "another edge in the cut": "D2",
        "a length is added in the cut": "TOFFL=1",
        "TCP off in the cut": "TRAFOOF",
        "offsets off in the cut": "G500",
        "compensation in the cut": "G41",
        "a tool change in the cut": "T9 M6",
        "another feed in the cut": "F7777",
    },
    replaced={
        "the spindle turns the other way": (r"\bM3\b", "M4"),
        "other coolant": (r"\bM8\b", "M7"),
        "another work offset": (r"\bG54\b", "G55"),
        "rapid at feed": (r"\bG0(?= [XYZ])", "G1"),
        "feed by time": (r"\bG94\b", "G93"),
        "another tool": (r"\bT=(\d+)", "+1"),
        "another edge": (r"\bD1\b(?=.* M3)", "D2"),
        "another speed": (r"\bS(\d+)\b", "*2"),
        "a tenth of the feed": (r"\bF(\d+\.?\d*)", "/10"),
        "ten times the feed": (r"\bF(\d+\.?\d*)", "*10"),
        "the plane is tilted otherwise": (r"(CYCLE800\(\d,\"\",\d,\d+,[^,]*,[^,]*,[^,]*,[^,]*,)(-?\d+\.\d*)", "+1"),
        "drilling without pecks": (r"MCALL CYCLE83\(([^,]*,[^,]*,[^,]*,[^,]*),.*", r"MCALL CYCLE81(\1)"),
        "drilling without dwell": (r"MCALL CYCLE82\(([^,]*,[^,]*,[^,]*,[^,]*),.*", r"MCALL CYCLE81(\1)"),
        "another depth of the cycle": (r"(MCALL CYCLE8\d\([^,]*,[^,]*,[^,]*,)(-?\d+\.?\d*)", "-1"),
        "another height of the cycle": (r"(MCALL CYCLE8\d\([^,]*,[^,]*,)(-?\d+\.?\d*)", "+1"),
        "another peck": (r"(MCALL CYCLE83\([^,]*,[^,]*,[^,]*,[^,]*,[^,]*,[^,]*,)(\d+\.?\d*)", "*2"),
    },
    dropped={
        "no tool change": r"\bM6\b",
        "no length": r"\bD1\b",
        "no start of the spindle": r"\bM3\b",
        "no coolant": r"\bM8\b",
        "no work offset": r"^.*\bG54\b.*$",
        "no TCP": r"^.*\bTRAORI\b.*$",
        "no plane": r"^.*\bCYCLE800\(0.*$",
        "no end of the cycle": r"^\S+ MCALL$",
        "no end": r"^.*\bM30\b.*$",
    },
    cut_word=_ISO_CUT_WORD | {"an unset variable": (r"(?<=[XYZ])-?\d*\.?\d+", "=R77")},
    tcp=r"\bTRAORI\b",
    no_tcp=r"\bTRAFOOF\b",
    plane=r"\bCYCLE800\(0",
    no_plane=r"\bCYCLE800\(\)",
)

FIDIA = Language(
    comment=r"\([^)]*\)",
    away=r"\bM242\b|\bG8[0-9]\b|\bG154\b|\bG01 [AC]",
    rapid=r"\bF3000\b",
    feed=r"\bF(?!3000)\d+",
    arc=_ISO_ARC,
    inserted={
        "incremental from here": "G91",
        "another plane of arcs": "G18",
        "inches in the cut": "G70",
        "the spindle stops in the cut": "M5",
        "the spindle turns back in the cut": "M4",
        "coolant off in the cut": "M9",
        "a stop in the cut": "M0",
        "the program ends in the cut": "M30",
        "a tool change in the cut": "M306 T.9",
        "a dwell in the cut": "G4 HD9",
        "home in the cut": "M242",
        "another offset in the cut": "G55 O2",
        "offsets off in the cut": "G53",
        "another speed in the cut": "S77",
        "another feed in the cut": "F7777",
        "compensation in the cut": "G41",
    },
    replaced={
        "the spindle turns the other way": (r"\bM3\b", "M4"),
        "other coolant": (r"\bM8\b", "M7"),
        "another work offset": (r"\bO1\b", "O2"),
        "another tool": (r"(?<=M306 T\.)(\d+)", "+1"),
        "another speed": (r"\bS(\d+)\b", "*2"),
        "a tenth of the feed": (r"\bF((?!3000)\d+)", "/10"),
        "ten times the feed": (r"\bF((?!3000)\d+)", "*10"),
        "drilling without pecks": (r"\bG83\b", "G81"),
        "another depth of the cycle": (r"(?<=\bE)(-?\d+\.?\d*)(?= R)", "-1"),
        "another height of the cycle": (r"(?<=\bR)(-?\d+\.?\d*)(?= [DHF])", "+1"),
        "another peck": (r"(?<=\bD)(\d+\.?\d*)(?= F)", "*2"),
    },
    dropped={
        "no tool change": r"^.*\bM306\b.*$",
        "no start of the spindle": r"\bM3\b",
        "no coolant": r"\bM8\b",
        "no work offset": r"^.*\bG55\b.*$",
        "no TCP": r"^.*\bG96\b.*$",
        "no end of the cycle": r"\bG80\b",
        "no end": r"^.*\bM30\b.*$",
    },
    cut_word={
        "an arc the other way": (r"\bG0?([23])\b", "G~"),
        "an arc as a line": (r"\bG0?[23]\b", "G1"),
    },
    tcp=r"\bG1?96\b",
    no_tcp=r"\bG1?97\b",
)

HEIDENHAIN = Language(
    comment=r";.*$|^\d+ \* -.*$",
    away=r"\bM91\b|\bM92\b|\bCYCL DEF\b|\bPLANE\b|^  Q|\bL [AC][-+]",
    rapid=r"\bFMAX\b",
    feed=r"\bF\d+|\bC X|\bCP\b",
    arc=r"^\d+ (?:C|CR|CP|CC)\b",
    inserted={
        "the spindle stops in the cut": "M5",
        "the spindle turns back in the cut": "M4",
        "coolant off in the cut": "M9",
        "a stop in the cut": "M0",
        "an optional stop in the cut": "M1",
        "the program ends in the cut": "M30",
        "a tool change in the cut": "TOOL CALL 9 Z S1000",
        "a dwell in the cut": "CYCL DEF 9.0 DWELL TIME\n{n} CYCL DEF 9.1 DWELL 9",
        "a shift in the cut": "CYCL DEF 7.0 DATUM SHIFT\n{n} CYCL DEF 7.1 IX+1",
        "a mirror in the cut": "CYCL DEF 8.0 MIRROR IMAGE\n{n} CYCL DEF 8.1 X",
        "a scale in the cut": "CYCL DEF 11.0 SCALING\n{n} CYCL DEF 11.1 SCL 2",
        "a rotation in the cut": "CYCL DEF 10.0 ROTATION\n{n} CYCL DEF 10.1 ROT+5",
        "another offset in the cut": "CYCL DEF 247 DATUM SETTING ~\n  Q339=+2 ;DATUM NUMBER",
        "an offset is written": "FN 25: PRESET = X / +0 / +0",
        "another speed in the cut": "TOOL CALL Z S77",
        "a length is added in the cut": "TOOL CALL Z S1500 DL+1",
        "a radius is added in the cut": "TOOL CALL Z S1500 DR+1",
        "TCP off in the cut": "M129",
        "the plane off in the cut": "PLANE RESET STAY",
        "a lift in the cut": "L M140 MB MAX",
        "a jump that hangs on an unset variable": 'FN 9: IF +Q77 EQU +0 GOTO LBL "X"',
        "another feed in the cut": "L F7777",
        "feed a turn": "L M136",
    },
    replaced={
        "the spindle turns the other way": (r"\bM3\b", "M4"),
        "other coolant": (r"\bM8\b", "M7"),
        "another work offset": (r"(?<=Q339=\+)(\d+)", "+1"),
        "another tool": (r"(?<=TOOL CALL )(\d+)", "+1"),
        "another speed": (r"\bS(\d+)\b", "*2"),
        "a tenth of the feed": (r"\bF(\d+\.?\d*)", "/10"),
        "ten times the feed": (r"\bF(\d+\.?\d*)", "*10"),
        "rapid at feed": (r"(?<=\d )FMAX", "F500"),
        "the plane is tilted otherwise": (r"(?<=SPA)([-+]\d+\.?\d*)", "+1"),
        "the plane is turned otherwise": (r"(?<=SPC)([-+]\d+\.?\d*)", "+1"),
        "another depth of the cycle": (r"(?<=Q201=)([-+]\d+\.?\d*)", "-1"),
        "another height of the cycle": (r"(?<=Q200=)([-+]\d+\.?\d*)", "+1"),
        "another surface of the cycle": (r"(?<=Q203=)([-+]\d+\.?\d*)", "+1"),
        "another peck": (r"(?<=Q202=)([-+]\d+\.?\d*)(?= ;PLUNG)", "/2"),
        "another dwell": (r"(?<=Q211=)([-+]\d*\.\d+)", "*3"),
        "another feed of the cycle": (r"(?<=Q206=)([-+]\d+\.?\d*)", "*2"),
    },
    dropped={
        "no tool change": r"^.*\bTOOL CALL \d.*$",
        "no start of the spindle": r"\bM3\b",
        "no coolant": r"\bM8\b",
        "no work offset": r"^.*CYCL DEF 247.*$\n^  Q339.*$",
        "no TCP": r"\bM128\b.*",
        "no plane": r"^.*\bPLANE SPATIAL\b.*$",
        "no call of the cycle": r"\bM99\b",
        "no centre": r"^\d+ CC .*$",
    },
    cut_word={
        "a cut at rapid": (r"\bF\d+\.?\d*", "FMAX"),
        "an arc the other way": (r"\bDR([-+])", "DR~"),
        "compensation in the cut": (r"(?<!R[LR])(?<= )(?=F\d)(?<!R[LR] )", "RL "),
        "a coordinate counts from here": (r"(?<=L )(?=[XYZ])", "I"),
        "an unset variable": (r"(?<=[XYZ])[-+]\d+\.?\d*", "+Q77"),
    },
    tcp=r"\bM128\b",
    no_tcp=r"\bM129\b",
    plane=r"\bPLANE SPATIAL\b",
    no_plane=r"\bPLANE RESET\b",
    pole=r"^\d+ CC\b",
)

LANGUAGES = {
    "Sinumerik": SINUMERIK,
    "Heidenhain": HEIDENHAIN,
    "Fanuc": FANUC,
    "Haas": HAAS,
    "LinuxCNC": LINUXCNC,
    "Fidia": FIDIA,
}
