"""Commands that prove programs, and say what machines can do."""

from typing import Final

from trunnion.jobs.job import Job, job
from trunnion.messages import phrase
from trunnion.options.groups import (
    ASSUME,
    BODIES,
    CLAMPING,
    CUTCOM,
    CUTTING,
    FEED,
    HOOKS,
    JSON,
    MACHINE,
    OTHER_MACHINE,
    RADIUS_REGISTER,
    READING,
    READING_AS_SETTINGS,
    REPORT,
    SETTINGS,
    SETTINGS_OF_READING,
    SETUP,
    SUBPROGRAMS,
    TOOL_LENGTH,
    TOOL_LIBRARIES,
    TOOL_UNIT,
    VARIABLES,
    WORK_OFFSET,
    ZERO,
)
from trunnion.options.kinds import Choice, FileIn, FileOut, Measure, Switch, Text, any_number, length, whole
from trunnion.options.option import Level, Many, Option
from trunnion.options.words import PROOF_SETTINGS

_CL: Final = Option("cl", "--cl", FileIn("CL", stdin=True), many=Many.REPEAT, key="cl")

_TOLERANCE: Final = length(phrase("kind_tolerance"), "0.001")

_VERIFY: Final = job(
    "verify", "prove an NC program: read it, run it, compare it with its CL files",
    Option("nc", "", FileIn("NC", leads="manifest"), "NC program; or the manifest of a post (.json)"),
    MACHINE.but(help="machine that runs it; not for a manifest"),
    SUBPROGRAMS,
    _CL.but(help="CL file that it was made from; may be repeated, in the order in which they are cut"),
    HOOKS.but(
        help="Python file that it was posted with, which changes the CL files again; it is run; may be repeated"
    ),
    Option(
        "tolerance", "--tolerance", _TOLERANCE,
        "how far a coordinate may be off (in inches by default 0.0013 mm), and in degrees a rotary axis", default=0.001,
        key="tolerance_mm",
    ),
    Option(
        "span", "--span", length(phrase("kind_tolerance"), "0.001", "DEG"),
        "how far the tool axis may be off between points; by default the definition's tolerance", key="span_deg",
    ),
    Option(
        "span_tip", "--span-tip", _TOLERANCE,
        "how far the tip may be off between points without TCP, and lines off the arc that they stand for",
        key="span_tip_mm",
    ),
    Option("tool", "--tool", Text("T"), "tool that was called in place of the CL file's", default=""),
    WORK_OFFSET.but(
        help="work offset of the program; with --cl that of the control's definition", aliases=("--offset",)
    ),
    Option(
        "edge", "--edge", whole(phrase("kind_cutting_edge"), phrase("number_of_edge"), "D"),
        "cutting edge under which the tool works; with --cl that of the control's definition, if it has one",
    ),
    READING.but(
        units={"key": "units"},
        dialect={"key": "dialect"},
        strict={
            "help": "what the proof stands on and nobody has stated or measured is an error; so are unknown statements"
        },
    ),
    Option(
        "frame", "--frame", Choice(("first", "absolute")),
        "whose coordinate system the program's is: the first operation's, or the CAM's absolute one", default="first",
        key="frame",
    ),
    ZERO,
    TOOL_LENGTH,
    TOOL_LIBRARIES.but(help="tool library that has the lengths of tools, as of simulate"),
    TOOL_UNIT,
    RADIUS_REGISTER,
    CUTCOM,
    FEED.but(help="fastest: it was posted so; feeds are what the axes reach", default="programmed", key="feed"),
    Option(
        "feed_limit", "--feed-limit", length(phrase("kind_feed"), "2000", "MM_MIN"),
        "the feed_limit of that post, in place of the CL file's",
    ),
    SETTINGS.but(
        help=f"setting of its post that the CL files do not show: {', '.join(PROOF_SETTINGS[:14])}; "
        f"{', '.join(PROOF_SETTINGS[14:])};"
        " or a variable that the program reads and does not set: Q13=10; may be repeated",
    ),
    ASSUME,
    Option(
        "recorded", "--recorded", FileIn(),
        "compare with what the machine did: a recording (.csv or .parquet)",
    ),
    Option(
        "recorded_tolerance", "--recorded-tolerance", _TOLERANCE,
        "how far the recorded tip may be off the path, and in degrees its tool axis", default=0.05,
    ),
    CLAMPING.but(
        turn={
            "help": "the part is turned so about Z, counter-clockwise seen from +Z, as the head of a placed program"
            " says; the CL files are turned before they are compared"
        }
    ),
    JSON,
    REPORT.but(own=True),
    run="verify:run",
    examples=[
        ("trunnion verify part.mpf --machine yl569 --cl part.cls", "does it do what CAM asked for?"),
        ("trunnion verify part.json", "are the files still those of this manifest?"),
    ],
)  # fmt: skip

_DIFF: Final = job(
    "diff", "compare what two NC programs make the tool do",
    Option("files", "", FileIn("NC"), "NC program", many=Many.TWO, own=True),
    MACHINE.but(help="machine that runs the first program", required=True),
    OTHER_MACHINE.but(help="machine that runs the second one, if another"),
    SUBPROGRAMS.but(help="files of the subprograms that the first program calls; no others are opened"),
    SUBPROGRAMS.but(
        name="to_subprograms", flag="--to-subprograms", aliases=("--to-with",), key="",
        help="files of the subprograms that the second one calls; no others are opened",
    ),
    Option(
        "tolerance", "--tolerance", _TOLERANCE, "how far tips may be apart, and in degrees tool axes",
        default=0.001,
    ),
    Option(
        "path", "--path", Switch(), "compare where the tool goes, but not feed, spindle, tool and coolant",
    ),
    ZERO.but(
        key="", level=Level.WHOLE,
        help="workpiece zero in the machine frame of programs that need it and whose heads state none, mm",
    ),
    TOOL_LENGTH.but(
        key="", level=Level.WHOLE,
        help="tool length of programs that need it and whose heads state none, gauge point to tip",
    ),
    VARIABLES,
    ASSUME,
    JSON,
    run="diff:run",
    examples=[
        ("trunnion diff old.mpf new.mpf --machine yl569", "is it the same, whatever the text?"),
        ("trunnion diff part.mpf part.h --machine yl569 --to-machine dmu65", "on two machines"),
    ],
)  # fmt: skip

_SIMULATE: Final = job(
    "simulate", "cut stock with NC programs: what is left, and what is hit",
    Option(
        "nc", "", FileIn("NC|PROJECT", leads="project"),
        "NC program; several cut the same stock in their order. Or a project (.toml), which may state all options",
        many=Many.SOME, key="programs",
    ),
    MACHINE.but(help="machine that runs them"),
    BODIES,
    CUTTING,
    _CL.but(help="CL file whose tools these are; may be repeated"),
    READING_AS_SETTINGS.but(strict={"key": ""}),
    HOOKS.but(help="Python file that changes the CL files, as post has it; it is run; may be repeated", key=""),
    SUBPROGRAMS.but(help="files of the subprograms that they call; no others are opened"),
    VARIABLES.but(
        help="how CL files are read, as post has it; or a variable that the program reads and does not set: Q13=10;"
        " may be repeated"
    ),
    ASSUME,
    RADIUS_REGISTER,
    SETUP,
    CLAMPING.but(
        turn={
            "help": "the part is turned so about Z, counter-clockwise seen from +Z, as the head of its program says;"
            " stock, part and fixtures are given as drawn"
        }
    ),
    Option(
        "stop_at", "--stop-at", Choice(("none", "first")), "end after the block of the first finding", key="stop_at",
        level=Level.WHOLE,
    ),
    Option(
        "until", "--until", Measure("BLOCK", least=0, is_whole=True),
        "N number of the block before which the last program ends", key="until", level=Level.WHOLE,
    ),
    JSON,
    REPORT.but(help="findings, tables and pictures as a page (.html), or data (.json)", own=True, key=""),
    Option(
        "save_stock", "--save-stock", FileOut(form="mesh"),
        "the finished stock: .stl, .ply, .3mf or .glb; .png: a picture of it", own=True,
    ),
    run="simulate:run",
    examples=[
        ("trunnion simulate part.mpf --machine yl569 --stock box:100,80,40 --tool 1=ball:10", "cut it"),
        ("trunnion simulate part.toml --report part.html", "as a project states it, with pictures"),
    ],
)  # fmt: skip

_NUMBER: Final = any_number("DEG")

_REACH: Final = job(
    "reach", "show which tool axes and points a machine reaches",
    Option("cl", "", FileIn("CL", stdin=True), "CL files whose points are judged", many=Many.ANY),
    MACHINE.but(help="machine whose reach is shown", required=True),
    Option("part", "--part", FileIn("MESH"), "part whose facets the tip is to reach along their normals"),
    Option("lean", "--lean", _NUMBER, "how far the tool may lean from a normal", default=0.0),
    SETUP,
    READING_AS_SETTINGS,
    SETTINGS_OF_READING,
    HOOKS.but(help="Python file that changes the CL files, as post has it; it is run; may be repeated", key=""),
    Option("step", "--step", _NUMBER, "degrees between tilts, and between azimuths", default=5.0),
    JSON,
    Option(
        "plot", "--plot", FileOut("FILE", (".svg",), phrase("reach_is_svg")),
        "tool axes on the sphere, and volumes over the tilt (.svg)", own=True,
    ),
    run="machine.reach:run",
    examples=[
        ("trunnion reach --machine yl569", "all tool axes"),
        ("trunnion reach part.cls --machine yl569 --zero 0,0,100", "the points of a CL file"),
    ],
)  # fmt: skip

_FIT: Final = job(
    "fit", "rank the machines that can run CL files or an NC program",
    Option(
        "files", "", FileIn("CL|NC", stdin=True), "CL files of one program; or, with --machine, a program",
        many=Many.SOME,
    ),
    Option(
        "machines", "--machines", FileIn("NAME_OR_FILE,…", leads="machines"),
        "machines that are asked; all: the shipped ones", default="all",
    ),
    MACHINE.but(help="machine that the NC program is for"),
    SUBPROGRAMS.but(help="files of the subprograms that the NC program calls; no others are opened"),
    ZERO.but(help="workpiece zero of the NC program on its own machine, mm"),
    TOOL_LENGTH.but(help="length of the tool on all machines, gauge point to tip"),
    READING_AS_SETTINGS,
    SETTINGS_OF_READING,
    HOOKS.but(help="Python file that changes the CL files, as post has it; it is run; may be repeated", key=""),
    Option(
        "turns", "--turns", _NUMBER, "try the part at every so many degrees about Z", default=5.0,
    ),
    JSON,
    run="machine.fit:run",
    examples=[
        ("trunnion fit part.cls", "which of the shipped machines can run it"),
        ("trunnion fit part.mpf --machine yl569 --machines dmu65,our_mill.toml", "where else a program runs"),
    ],
)  # fmt: skip

_SENSITIVITY: Final = job(
    "sensitivity", "rank the numbers of a machine by what they do to an NC program",
    Option("nc", "", FileIn("NC"), "NC program"),
    MACHINE.but(help="machine that runs it", required=True),
    SUBPROGRAMS,
    SETUP,
    Option(
        "length", "--length", any_number("MM"),
        "how far points and lengths are off", default=0.01,
    ),
    Option(
        "angle", "--angle", any_number("ARCSEC"),
        "how far directions and displayed angles are off, seconds of arc", default=5.0,
    ),
    Option(
        "zero_at", "--zero-at", Text("C=0,B=0|home|none"),
        "where the rotary axes stand when the workpiece zero is set; none: leave nothing to the zero", default="home",
    ),
    JSON,
    Option(
        "report", "--report", FileOut("FILE", (".html",), phrase("report_is_page")),
        "the table, and errors over the program, as a page (.html)", own=True,
    ),
    run="machine.sensitivity:run",
    examples=[
        ("trunnion sensitivity part.mpf --machine yl569", "which numbers to measure well"),
        ("trunnion sensitivity part.mpf --machine yl569 --length 0.02 --report part.html", "with curves"),
    ],
)  # fmt: skip

_KINEMATICS: Final = job(
    "kinematics", "print the formulas of a machine: frames, matrices, forward and inverse",
    Option("machine", "", FileIn("NAME_OR_FILE", leads="definition"), "machine whose formulas are printed"),
    SETUP,
    Option(
        "format", "--format", Choice(("text", "markdown", "latex")), "how they are printed", default="text", own=True
    ),
    JSON,
    run="machine.kinematics:run",
    examples=[
        ("trunnion kinematics yl569", "its matrices and formulas, compared with forward and inverse"),
        ("trunnion kinematics our_mill.toml --format latex", "a LaTeX document of them"),
    ],
)  # fmt: skip

JOBS: Final[tuple[Job, ...]] = (_VERIFY, _DIFF, _SIMULATE, _REACH, _FIT, _SENSITIVITY, _KINEMATICS)
