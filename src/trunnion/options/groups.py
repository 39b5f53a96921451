"""Options that several commands share: each is said once, and a command may say in its own words what it is for."""

from typing import Final

from trunnion.dialect_names import READ_DIALECTS
from trunnion.messages import phrase
from trunnion.options.kinds import (
    Choice,
    FileIn,
    FileOut,
    Measure,
    Number,
    Point,
    Setting,
    Switch,
    Text,
    angle,
    length,
    whole,
)
from trunnion.options.limits import LONGEST_RATE, SHORTEST_RATE
from trunnion.options.option import Group, Level, Many, Option
from trunnion.options.words import CL_SETTINGS, EDITED, FEEDS

PAGE_OR_DATA: Final = (".html", ".json")

MACHINE: Final = Option(
    "machine", "--machine", FileIn("NAME_OR_FILE", leads="machine"), "shipped machine, or a TOML file", key="machine"
)

OTHER_MACHINE: Final = MACHINE.but(name="to_machine", flag="--to-machine", key="")

SETTINGS: Final = Option("settings", "--set", Setting(), many=Many.REPEAT, key="settings")

#: What unknown words of a program do, besides what the definition says.
ASSUME: Final = Option(
    "assume",
    "--assume",
    Setting(metavar="WORD=EFFECT"),
    'what a word does that the reader does not know, as [control.known] has it: "G65 P9810=moves nothing"',
    many=Many.REPEAT,
)

#: Values of variables alone, where there is nothing else to set.
VARIABLES: Final = SETTINGS.but(
    key="", help="value of a variable that the program reads and does not set: Q13=10, R5=2, #100=1; may be repeated"
)

SUBPROGRAMS: Final = Option(
    "subprograms",
    "--subprograms",
    FileIn("NC"),
    "files of the subprograms that it calls; no others are opened",
    many=Many.LIST,
    key="subprograms",
    level=Level.OWN,
    aliases=("--with",),
)

HOOKS: Final = Option(
    "hooks",
    "--hooks",
    FileIn("FILE.py"),
    "Python file whose functions change what the CL files ask for; it is run",
    many=Many.REPEAT,
    key="hooks",
    level=Level.WHOLE,
)

#: How CL files are read; ``units`` and ``dialect`` are settings too where a command takes settings.
READING: Final = Group(
    "how CL files are read",
    (
        Option("units", "--units", Choice(("mm", "inch")), "length unit of the CL files, whatever they state"),
        Option(
            "dialect",
            "--dialect",
            Choice(READ_DIALECTS, "NAME"),
            f"what the CL files are written in: {', '.join(READ_DIALECTS)}",
        ),
        Option(
            "strict", "--strict", Switch(), "unknown CL statements are errors at once", key="strict", level=Level.WHOLE
        ),
    ),
)

#: The same where units and dialect are settings too.
READING_AS_SETTINGS: Final = READING.but(units={"setting": "cl_units"}, dialect={"setting": "dialect"})

FEED: Final = Option(
    "feed", "--feed", Choice(FEEDS), "fastest: of each block what the axes reach, within the feed of the CL file"
)

#: The other settings of reading, where a command has no settings besides.
SETTINGS_OF_READING: Final = SETTINGS.but(
    key="", help=f"how CL files are read, as post has it: {', '.join(CL_SETTINGS[2:])}; may be repeated"
)

#: Options of a post that are settings of the same name: declared here, and read as settings where they act.
POSTING: Final = Group(
    "what a post must not do",
    (
        Option(
            "max_tilt",
            "--max-tilt",
            angle(phrase("kind_tilt"), 0.0, 180.0, "30"),
            "refuse operations whose tool axis leans more than this from Z of the program",
            setting="max_tilt",
        ),
        Option(
            "edited",
            "--edited",
            Choice(EDITED),
            "a file there that is not as a job has written it: refuse, keep it as NAME.edited-DATE, or replace it",
            setting="edited",
        ),
    ),
)

#: The setting ``tool_length`` takes no more, mm.
LONGEST_TOOL: Final = 10_000.0

ZERO: Final = Option(
    "zero",
    "--zero",
    Point("X,Y,Z", by_name=True),
    "the workpiece zero in the machine frame, mm (the value of G54 only if the gauge point is at 0,0,0);"
    " G54=X,Y,Z,G55=X,Y,Z: of each work offset",
    key="zero_mm",
    level=Level.OWN,
)

TOOL_LENGTH: Final = Option(
    "tool_length",
    "--tool-length",
    Measure("MM", above=0.0, most=LONGEST_TOOL, by_name=True),
    "length of the tool, gauge point to tip; 1=MM,2=MM: of each tool",
    key="tool_length_mm",
    level=Level.OWN,
)

CUTCOM: Final = Option(
    "cutcom",
    "--cutcom",
    Choice(("centreline", "contour")),
    "what points under CUTCOM are where the CL files do not say it: the tool's centre line, or the contour",
    key="cutcom",
)

RADIUS_REGISTER: Final = Option(
    "radius_register",
    "--radius-register",
    Choice(("unknown", "difference", "radius")),
    "what radius compensation works with: a difference, or the radius of the tool; by default as the definition says",
    key="radius_register",
)

SETUP: Final = Group("where the part sits", (ZERO, TOOL_LENGTH))

#: The same where they are settings too.
SETUP_AS_SETTINGS: Final = SETUP.but(zero={"setting": "zero"}, tool_length={"setting": "tool_length"})

WORK_OFFSET: Final = Option("work_offset", "--work-offset", Text("G", example="G54"), key="work_offset")

CLAMPING: Final = Group(
    "how the part is clamped",
    (
        Option("turn", "--turn", angle(phrase("kind_turn"), -360.0, 360.0, "45"), key="turn_deg", level=Level.OWN),
        Option(
            "tilt",
            "--tilt",
            angle(phrase("kind_tilt"), -90.0, 90.0, "30"),
            "before that it is tilted about X of the program, right-handed",
            key="tilt_deg",
            level=Level.OWN,
        ),
    ),
)

STOCK: Final = Option(
    "stock",
    "--stock",
    FileIn("STOCK", leads="stock"),
    "box:X,Y,Z[,x0,y0,z0] (sizes, lowest corner; by default 0,0,0), cylinder:D,H[,z0] (by default 0), or a mesh file;"
    " mm. cl: as the CL files state it",
    key="stock",
    level=Level.WHOLE,
)

TOOLS: Final = Option(
    "tools",
    "--tool",
    Text("N=KIND:SIZES"),
    "a tool, such as 3=ball:10,length=60,flutes=20,shank=12,holder=40x50",
    many=Many.REPEAT,
    key="tools",
)

TOOL_LIBRARIES: Final = Option(
    "tool_libraries",
    "--tool-library",
    FileIn("LIBRARY", leads="library"),
    "tool library: TOML, .tools or .json of Autodesk, FreeCAD's .fctb, LinuxCNC's tool.tbl",
    many=Many.REPEAT,
    key="tool_libraries",
    aliases=("--tools",),
)

TOOL_UNIT: Final = Option(
    "unit", "--unit", Choice(("mm", "inch")), "length unit of tool tables, which state none", key="unit"
)

#: Stock, part, fixtures and tools: what is cut, and what must not be met.
BODIES: Final = Group(
    "stock, part, fixtures and tools",
    (
        STOCK,
        Option(
            "part",
            "--part",
            FileIn("MESH"),
            "the finished part, to compare with what is left of the stock",
            key="part",
            level=Level.OWN,
        ),
        TOOLS,
        TOOL_LIBRARIES,
        TOOL_UNIT,
        Option(
            "fixtures",
            "--fixture",
            FileIn("FIXTURE", leads="fixture"),
            "a fixture, as the program counts: a mesh file, box:X,Y,Z[,x0,y0,z0], cylinder:D,H[,z0],"
            " chuck:D,height=MM,grip=D,jaw=LxWxH or vice:W,opening=MM,jaw=TxH,base=LxH",
            many=Many.REPEAT,
            key="fixtures",
            level=Level.OWN,
        ),
    ),
)

#: How fine a simulation is.
CUTTING: Final = Group(
    "how fine",
    (
        Option(
            "near",
            "--near",
            length(phrase("kind_distance"), "0.5"),
            "report bodies that come as near as this, too",
            key="near_mm",
            level=Level.WHOLE,
        ),
        Option(
            "cell",
            "--cell",
            length(phrase("kind_width_of_cells"), "0.25"),
            "width of the cells; by default a 200th of the stock's side",
            key="cell_mm",
            level=Level.WHOLE,
        ),
        Option(
            "accuracy",
            "--accuracy",
            length(phrase("kind_tolerance"), "0.001"),
            "of motions and tools; by default a tenth of a cell",
            key="accuracy_mm",
            level=Level.WHOLE,
        ),
    ),
)

#: Everything as data; ``--json`` alone is stdout.
JSON: Final = Option(
    "json",
    "--json",
    FileOut("FILE|-", (".json",), phrase("data_is_json"), stdout=True),
    "the result as data: into a file, or with - to stdout in place of text",
    many=Many.MAYBE,
    own=True,
)

REPORT: Final = Option(
    "report",
    "--report",
    FileOut("FILE", PAGE_OR_DATA, phrase("report_is_page_or_data")),
    "what was checked, as a page (.html) or data (.json)",
    key="report",
)

SHEET: Final = Option(
    "sheet",
    "--sheet",
    FileOut("FILE", PAGE_OR_DATA, phrase("sheet_is_page_or_data")),
    "setup sheet to print (.html), or its data (.json)",
    key="sheet",
)

OUTPUT: Final = Option(
    "output",
    "--output",
    FileOut("FILE|-|FOLDER", stdout=True, folder=True, told=True),
    "program, stdout, or a folder: one program per CL file",
    key="output",
)

#: A page that is served.
SERVING: Final = Group(
    "serving",
    (
        Option("browser", "--no-browser", Switch(value=False), "only print the address", own=True),
        Option(
            "host",
            "--host",
            Text("ADDRESS"),
            "with a token, serve other computers, too, on this address",
            default="127.0.0.1",
            own=True,
        ),
        Option(
            "port",
            "--port",
            whole(phrase("kind_port"), phrase("number_or_free"), "N", most=65535),
            "port of the page, 0: a free one",
            default=0,
            own=True,
        ),
    ),
)

RATE: Final = Option(
    "rate",
    "--rate",
    Number(
        "MS",
        phrase("kind_rate"),
        phrase("milliseconds_from_to", least=SHORTEST_RATE, most=LONGEST_RATE),
        least=SHORTEST_RATE,
        most=LONGEST_RATE,
    ),
    "milliseconds between two looks of the server",
    default=20.0,
)

#: How a command connects to a machine.
LIVE: Final = Group(
    "how to connect to the machine",
    (
        Option(
            "nodes",
            "--nodes",
            FileIn("NAME_OR_FILE", leads="named"),
            "what is read: cnc (OPC 40502), twin (and how its axes move), sinumerik, heidenhain, or a file (.toml)",
            default="cnc",
        ),
        RATE,
        Option("secure", "--secure", Switch(), "sign and encrypt the channel"),
        Option("trust", "--trust", Text("FINGERPRINT"), "of the server's certificate; with --secure", default=""),
        Option(
            "user",
            "--user",
            Text("NAME"),
            "user at the machine; the password is asked for or read from stdin",
            default="",
        ),
    ),
)
