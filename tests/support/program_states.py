"""A program with each state that a reader knows, for the table of what a conversion does with it."""

from collections.abc import Callable
from dataclasses import KW_ONLY, dataclass
from typing import Final

from trunnion.model.run import Run

#: A machine of each target that is a control.
MACHINES: Final = {
    "Sinumerik": "yl569",
    "Klartext": "dmu65",
    "iTNC 530": "mikron_600u",
    "Fanuc": "matsuura_mx330",
    "Haas": "haas_umc750",
    "Fidia": "hs664rt",
    "LinuxCNC": "xyzac_trt",
}

_FANUC: Final = """%
O0001
G90 G21 G17 G40 G49 G80 G94
T3 M6
G54
{head}
S1000 M3
G0 X0. Y0.
G43 H3 Z50.
{above}
Z5.
G1 Z-1. F100.
{cut}
X20.
G0 Z50.
{behind}
M5
M9
G49
G91 G28 Z0.
G90
{end}
%
"""

#: A program of each control, with room for a state in its head, above the part, in the cut, behind it and at the end.
PROGRAMS: Final[dict[str, str]] = {
    "Sinumerik": """G17 G90 G71
T3
M6
G54
D1
{head}
S1000 M3
G0 X0 Y0 Z50
{above}
Z5
G1 Z-1 F100
{cut}
X20
G0 Z50
{behind}
M5
M9
{end}
""",
    "Klartext": """BEGIN PGM P MM
CYCL DEF 247 DATUM SETTING ~
Q339=1
TOOL CALL 3 Z S1000
{head}
L X+0 Y+0 Z+50 R0 FMAX M3
{above}
L Z+5 FMAX
L Z-1 F100
{cut}
L X+20
L Z+50 FMAX
{behind}
M5
M9
{end}
END PGM P MM
""",
    "Fanuc": _FANUC,
    "Haas": _FANUC,
    "Fidia": """G17 Q1
G90
G71
M242
M6 T3
G55 O1
{head}
S1000 M3
G0 X0. Y0.
Z50.
{above}
Z5.
G1 Z-1. F100
{cut}
X20.
G0 Z50.
{behind}
M5
M9
M242
{end}
""",
    "LinuxCNC": """%
G21 G17 G40 G90 G94
T3 M6
G54
{head}
G43
S1000 M3
G0 X0 Y0 Z50
{above}
Z5
G1 Z-1 F100
{cut}
X20
G0 Z50
{behind}
M5
M9
G53 G0 Z0
{end}
%
""",
}

PROGRAMS["iTNC 530"] = PROGRAMS["Klartext"]

_ROOMS: Final = ("head", "above", "cut", "behind")

#: Whether a program of the target has the state.
Probe = Callable[[Run], bool]


@dataclass(frozen=True, slots=True)
class Sample:
    """A program with a state.

    source  the control that it is for
    rooms   lines of the state by the room in which they stand
    cl      what a CL file has where the state is carried: a regular expression
    probe   whether the run of a new program has it; without one its proof is enough
    says    what a report or a refusal says of it
    change  texts of the program, and what stands in their place
    also    texts of files that the program calls, by their names
    zero, tool_length  of the source, mm, where the path depends on them
    """

    source: str
    _: KW_ONLY
    rooms: dict[str, str]
    cl: str = ""
    probe: Probe | None = None
    says: str = ""
    change: tuple[tuple[str, str], ...] = ()
    also: tuple[tuple[str, str], ...] = ()
    zero: tuple[float, float, float] | None = None
    tool_length: float | None = None

    @property
    def text(self) -> str:
        """The program."""
        rooms = dict.fromkeys(_ROOMS, "") | {"end": "M30"} | self.rooms
        text = PROGRAMS[self.source].format(**rooms)
        for old, new in self.change:
            assert old in text
            text = text.replace(old, new)
        return "".join(f"{line}\n" for line in text.splitlines() if line)


def _event(kind: str, *values: object) -> Probe:
    """Whether the run has an event, of one of the values if there are any."""
    return lambda run: any(event.kind == kind and (not values or event.value in values) for event in run.events)


def _column(name: str, *values: object) -> Probe:
    return lambda run: any(value in values for value in getattr(run.state, name).values.tolist())


def _m_word(run: Run) -> bool:
    """Whether coolant comes through the tool: a word of the builder, or the control's own."""
    return _event("m", 26.0, 7.0)(run) or _event("coolant", "through")(run)


_FROM_HEIGHT: Final = "G0 Z50."

SAMPLES: Final = {
    "work offset that most controls have": Sample(
        "Sinumerik", rooms={"head": "G55"}, cl="work_offset=G55", probe=_column("work_offset", 55),
        says="the work offset is G55, which",
    ),
    "work offset of a family": Sample(
        "Haas", rooms={"head": "G154 P3"}, cl="work_offset=G154 P3", probe=_column("work_offset", 603),
        says="the work offset is G154 P3, which",
    ),
    "edge of the tool": Sample(
        "Sinumerik", rooms={"head": "D2"}, cl="edge=2", probe=_column("edge", 2), says="edge is '2', which",
    ),
    "number of the tool length that is not the tool's": Sample(
        "Fanuc", rooms={}, change=(("H3", "H5"),), cl="LOAD/TOOL,3,ADJUST,5", probe=_column("edge", 5),
        says="names the length register 5",
    ),
    "tool": Sample("Fanuc", rooms={}, cl="LOAD/TOOL,3", probe=_event("tool_change", "3")),
    "next tool": Sample(
        "Sinumerik", rooms={"above": "T4"}, cl="SELECT/TOOL,4", probe=_event("tool", "4"),
        says="SELECT/TOOL,4 is not written",
    ),
    "tool without motion behind it": Sample(
        "Sinumerik", rooms={"behind": "T7\nM6"}, says="no motion follows the change to tool 7",
    ),
    "what is added to the tool": Sample(
        "Klartext", rooms={}, change=(("S1000", "S1000 DL+0.5"),), says="DL or DR of TOOL CALL",
    ),
    "tilted plane": Sample(
        "Haas", rooms={"head": "G0 B30. C0.\nG254"}, change=((_FROM_HEIGHT, f"{_FROM_HEIGHT}\nG255"),),
    ),
    "frame and shift": Sample("Sinumerik", rooms={"head": "TRANS X5"}, cl=r"GOTO/25\.0"),
    "TCP": Sample("Sinumerik", rooms={"head": "G0 B30 C0\nTRAORI\nG54"}, cl=r"GOTO/[^,]*,[^,]*,[^,]*,0\.5"),
    "limit of the compensating motions": Sample(
        "iTNC 530", rooms={"head": "M128 F1000", "behind": "M129"}, says="M128 F1000 is not carried over",
    ),
    "tip at the ends of blocks": Sample(
        "iTNC 530", rooms={"head": "L B-30 C+0 R0 FMAX\nM114", "behind": "M115"}, cl=r"GOTO/[^,]*,[^,]*,[^,]*,-0\.5",
    ),
    "turn of the tool on a great circle": Sample(
        "Sinumerik", rooms={"head": "TRAORI\nG54\nORIWKS\nORIVECT", "cut": "X10 B10 C0"},
        change=(("G0 X0 Y0 Z50", "G0 X0 Y0 Z50 B0 C0"),), says="the tool turns on a great circle",
    ),
    "other rotary positions than the tool axis gives": Sample(
        "Sinumerik", rooms={"head": "TRAORI\nG54", "cut": "X10 C90"},
        change=(("G0 X0 Y0 Z50", "G0 X0 Y0 Z50 B0 C0"),), says="other rotary positions than the tool axis gives",
    ),
    "smoothing cycle": Sample(
        "Sinumerik", rooms={"head": "CYCLE832(0.05,_FINISH,1)"}, says="CYCLE832 is not carried over",
    ),
    "smoothing words": Sample("Fanuc", rooms={"head": "G8 P1"}, says="G8 is not carried over"),
    "exact stop": Sample("Sinumerik", rooms={"above": "G60"}, says="G60 is not carried over"),
    "tolerance of the path": Sample("Haas", rooms={"above": "G187 E0.05"}, says="G187 is not carried over"),
    "flood": Sample("Fanuc", rooms={"above": "M8"}, cl="COOLNT/(ON|FLOOD)", probe=_event("coolant", "flood")),
    "mist": Sample(
        "Sinumerik", rooms={"above": "M7"}, cl="COOLNT/MIST", says="no coolant MIST",
        probe=lambda run: _event("coolant", "mist")(run) or _event("m", 25.0)(run),
    ),
    "coolant through the tool": Sample(
        "Sinumerik", rooms={"above": "M26"}, cl="COOLNT/THRU", probe=_m_word, says="no coolant THRU",
    ),
    "clamps and other words of the builder": Sample(
        "Fidia", rooms={"above": "M10"}, cl="INSERT/M10", says="M10 is a word of the machine's builder",
    ),
    "words that a definition declares": Sample(
        "Haas", rooms={"above": "M10"}, cl="INSERT/M10", says="M10 (brake of the fourth axis on) is not carried over",
    ),
    "feed": Sample("Fanuc", rooms={"cut": "X10. F250."}, cl="MMPM,250", probe=_column("feed", 250.0)),
    "feed per revolution": Sample(
        "Sinumerik", rooms={"cut": "G95 X10 F0.2\nG94 F100"}, cl=r"MMPR,0\.2", probe=_column("feed_mode", 95),
        says="a feed per revolution",
    ),
    "inverse time": Sample("LinuxCNC", rooms={"cut": "G93\nX10 F20\nG94 F100"}, cl=r"MMPM,200\.0"),
    "feed along another way than the tip's": Sample(
        "Klartext", rooms={"cut": "M116\nL X+10 A+5 F100\nL X+11 A+0\nM117"}, zero=(0.0, 0.0, 0.0), tool_length=100.0,
    ),
    "speed and sense of the spindle": Sample(
        "Fanuc", rooms={}, change=(("S1000 M3", "S900 M4"),), cl="SPINDL/RPM,900.*CCLW",
        probe=lambda run: _column("rpm", 900.0)(run) and _column("spindle", -1)(run),
    ),
    "spindle off": Sample(
        "Fanuc", rooms={"above": "M5\nX1.\nM3"}, cl=r"SPINDL/OFF(?s:.*)SPINDL/RPM", probe=_event("spindle", "off"),
    ),
    "spindle at an angle": Sample("Fanuc", rooms={"behind": "M19"}, says="the spindle stops at an angle"),
    "constant surface speed": Sample(
        "Sinumerik", rooms={}, change=(("S1000 M3", "G96 S100 M3"),), says="constant surface speed",
    ),
    "jump, loop, subprogram": Sample(
        "Sinumerik", rooms={"cut": "R1=0\nAGAIN:\nX=10+R1\nR1=R1+1\nIF R1<3 GOTOB AGAIN"}, cl=r"GOTO/12\.0",
    ),
    "subprogram in a file of its own": Sample(
        "Sinumerik", rooms={"cut": "HOLE"}, also=(("HOLE.SPF", "X12\nM17\n"),), says="2 files become one program",
    ),
    "block skip": Sample("Sinumerik", rooms={"cut": "/X10"}, cl="OPSKIP/ON", probe=_event("block_skip")),
    "block skip of a tool change, a length, a head or an end": Sample(
        "Fanuc", rooms={}, change=(("T3 M6", "/T3 M6"),), says="the tool change may be skipped",
    ),
    "block skip in a program with jumps": Sample(
        "Sinumerik", rooms={"cut": "R1=0\nAGAIN:\n/X=10+R1\nY=R1\nR1=R1+1\nIF R1<3 GOTOB AGAIN"},
        says="block skip signs in",
    ),
    "radius compensation": Sample(
        "Sinumerik", rooms={"cut": "G41 X2 Y2\nY3", "behind": "G40 X0 Y0"}, cl="CUTCOM/LEFT",
        probe=_column("compensation", 1),
    ),
    "register of the radius that is not the tool's": Sample(
        "Fanuc", rooms={"cut": "G41 D13 X2. Y2.\nY3.", "behind": "G40 X0. Y0."}, cl="CUTCOM/.*13",
        probe=_column("radius", 13), says="D13: registers of the radius",
    ),
    "dwell": Sample("Fanuc", rooms={"behind": "G4 P2000"}, cl=r"DELAY/2\.0", probe=_event("dwell", 2.0)),
    "stop": Sample("Fanuc", rooms={"behind": "M0"}, cl="STOP", probe=_event("stop")),
    "change of the pallet": Sample("LinuxCNC", rooms={"behind": "M60"}, says="M60 changes the pallet"),
    "message": Sample(
        "Sinumerik", rooms={"behind": 'MSG("LOOK HERE")'}, cl="DISPLY/.*LOOK HERE",
        probe=lambda run: any("LOOK HERE" in str(each) for each in (*run.events, *run.comments)),
    ),
    "comment": Sample(
        "Fanuc", rooms={"behind": "(LOOK HERE)"}, cl="PPRINT/.*LOOK HERE",
        probe=lambda run: any("LOOK HERE" in each.text for each in run.comments),
    ),
    "stock for the control's graphics": Sample(
        "Klartext", rooms={"head": "BLK FORM 0.1 Z X+0 Y+0 Z-10\nBLK FORM 0.2 X+50 Y+50 Z+0"}, says="(BLK FORM) is not",
    ),
    "limits of the axes off": Sample("Fanuc", rooms={"head": "G23"}, says="G23 is not carried over"),
    "override of the feed": Sample("LinuxCNC", rooms={"above": "M49"}, says="M49 is not carried over"),
    "output of the machine": Sample("LinuxCNC", rooms={"above": "M67 E0 Q1"}, says="M67 is not carried over"),
    "function that prints, waits, or speaks to the PLC": Sample(
        "Klartext", rooms={"above": "FN 20: WAIT FOR I16==1"}, says="FN 20 is not carried over",
    ),
    "unit": Sample("LinuxCNC", rooms={"cut": "G20\nX0.5\nG21"}, cl=r"GOTO/12\.7"),
    "position of the machine": Sample(
        "Sinumerik", rooms={"head": "SUPA G0 Z300 D0\nD1"}, says="Z goes to the machine position 300",
    ),
    "rotary axes between operations and at the end": Sample(
        "Sinumerik", rooms={"behind": "SUPA G0 Z0 D0\nG0 B30"}, says="B goes to the machine position 30",
    ),
    "drilling cycle": Sample(
        "Sinumerik", rooms={"cut": "G0 Z50\nF100\nMCALL CYCLE81(5,0,2,-3)\nX12\nMCALL\nG1 Z-1"},
        says="1 hole of drilling cycles becomes motion",
    ),
    "variable": Sample("Fanuc", rooms={"cut": "#1=12.\nX#1"}, cl=r"GOTO/12\.0"),
    "variable that outlives the program": Sample(
        "Fanuc", rooms={"head": "#500=7."}, says="#500 = 7 is not carried over",
    ),
    "end": Sample("Fanuc", rooms={"end": "M2"}, probe=_event("end")),
    "begin anew": Sample("Fanuc", rooms={"end": "M99"}, says="M99 begins the program anew"),
}  # fmt: skip
