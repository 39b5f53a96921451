"""Commands that make programs."""

from typing import Final

from trunnion.dialect_names import WRITTEN_DIALECTS
from trunnion.jobs.job import Job, job
from trunnion.messages import phrase
from trunnion.options.groups import (
    ASSUME,
    BODIES,
    CLAMPING,
    CUTTING,
    FEED,
    HOOKS,
    JSON,
    MACHINE,
    OTHER_MACHINE,
    OUTPUT,
    POSTING,
    RADIUS_REGISTER,
    READING,
    READING_AS_SETTINGS,
    REPORT,
    SETTINGS,
    SETUP_AS_SETTINGS,
    SHEET,
    SUBPROGRAMS,
    TOOL_LENGTH,
    ZERO,
)
from trunnion.options.kinds import Choice, FileIn, FileOut, Setting, Switch, Text, angle
from trunnion.options.option import Level, Many, Option
from trunnion.options.words import GOALS, POSITIONS

_SIMULATING: Final = "with --simulate"

_POST: Final = job(
    "post", "write the NC program of one or more CL files",
    Option(
        "cl", "", FileIn("CL|PROJECT", stdin=True),
        "CL file; or one project (.toml), which states all but --set", many=Many.SOME,
    ),
    MACHINE,
    OUTPUT,
    SETTINGS.but(
        help="what templates print (title, part, date, method, …), or how to read, place and plan; may be repeated"
    ),
    SUBPROGRAMS.but(help="files of the subprograms that a template calls; no others are opened"),
    HOOKS,
    READING_AS_SETTINGS,
    SETUP_AS_SETTINGS,
    FEED.but(setting="feed"),
    POSTING,
    Option("force", "--force", Switch(), "write a program that must not run; its head says so"),
    Option("explain", "--explain", Switch(), "say why the axes were planned as they are"),
    REPORT,
    SHEET,
    Option("listing", "--listing", FileOut(), "every motion as text: X Y Z, rotary axes, S, F", key="listing"),
    Option(
        "manifest", "--manifest", FileOut("FILE", (".json",), phrase("manifest_is_data")),
        "checksums of all files (.json), beside the program", key="manifest",
    ),
    Option(
        "watch", "--watch", Switch(), "post again whenever a file that is read changes", own=True, either="beside"
    ),
    Option(
        "suggest", "--suggest", FileOut("PROJECT", (".toml",), phrase("project_is_toml"), told=True),
        "write a project (.toml) to fill in: what was given, and the settings that the messages ask for",
        own=True, either="beside",
    ),
    CLAMPING.but(
        turn={
            "help": "the part is turned so about Z, counter-clockwise seen from +Z, and its toolpath with it; the head"
            " of the program says so"
        }
    ),
    JSON,
    Option(
        "simulate", "--simulate", Switch(), "cut stock with the program too, and refuse what it must not do",
        key='[checks] simulate = "refuse"', level=Level.WHOLE,
    ),
    Option(
        "project", "--project", FileIn("PROJECT"),
        "project file (.toml) that states what --simulate takes", key="its own keys", heading=_SIMULATING,
    ),
    BODIES.under(_SIMULATING),
    CUTTING.under(_SIMULATING),
    run="startup:run",
    guards=True,
    examples=[
        ("trunnion post part.cls --machine yl569 --output part.mpf", "one proven program"),
        ("trunnion post part.cls --machine dmu65 --set title=BLADE --report part.html", "with a page that proves it"),
        ("trunnion post part.cls --machine dmu65 --suggest part.toml", "a project for settings that are missing"),
    ],
)  # fmt: skip

_CONVERT: Final = job(
    "convert", "turn an NC program into a CL file, or post it for another machine",
    Option("nc", "", FileIn("NC|CL", stdin=True), "NC program; without --machine, a CL file"),
    MACHINE.but(help="machine that the program is for"),
    SUBPROGRAMS,
    Option("to_cl", "--to-cl", Switch(), "write a CL file", key="to_cl", either="target!"),
    OTHER_MACHINE.but(help="write a program for this machine", key="to_machine", either="target!"),
    Option(
        "to_dialect",
        "--to-dialect",
        Choice(tuple(WRITTEN_DIALECTS)),
        "what the CL file is written in; by default clsf",
        key="to_dialect",
    ),
    READING.but(units={"key": "units"}, dialect={"key": "dialect"}),
    ZERO.but(help="the workpiece zero on the program's own machine, mm"),
    TOOL_LENGTH.but(help="length of the tool there, gauge point to tip"),
    Option(
        "positions", "--positions", Choice(POSITIONS),
        "what positions are while no tool length is in force (no G43, no D): those of the tip, or of the gauge line",
    ),
    Option(
        "registers", "--register", Setting(metavar="D21=tool"),
        "what a register of the program is on the other control: that of the tool, or another one (H11=H1)",
        many=Many.REPEAT,
    ),
    OUTPUT.but(help="result; without it a file of that name here"),
    SETTINGS.but(
        help="what templates print, in place of what the program says, and zero; or a variable that the program reads"
        " and does not set: Q13=10; may be repeated"
    ),
    ASSUME,
    Option("force", "--force", Switch(), "convert what was understood, and write a program that must not run"),
    JSON,
    run="convert:run",
    examples=[
        ("trunnion convert part.mpf --machine yl569 --to-cl", "the CL file of a program"),
        ("trunnion convert part.mpf --machine yl569 --to-machine dmu65", "the program of another machine"),
    ],
)  # fmt: skip

_PLACE: Final = job(
    "place", "find where on the table a part may sit, and where best",
    Option(
        "files", "", FileIn("CL|NC|PROJECT", leads="posted", stdin=True),
        "CL files or NC programs, which must all fit at one place of the part; or one project (.toml)", many=Many.SOME,
    ),
    MACHINE.but(help="shipped machine, or a TOML file; by default that of the project"),
    Option("setup", "--setup", Text("NAME"), "the set-up of a project with several", own=True),
    Option(
        "goal", "--goal", Choice(GOALS, "GOAL"),
        "what the best place is best for: margin to the limits, travel of rotary or linear axes, time, fewest blocks"
        " whose feed the axes cannot reach (overspeed), or bodies farthest apart (collisions)",
        default="margin",
    ),
    Option(
        "turns", "--turns", angle(phrase("kind_step_of_turns"), 0.1, 360.0, "5"),
        "try the part at every so many degrees about Z, counter-clockwise seen from above (from +Z), and more finely"
        " around the best; by default 5, with several tilts or the goal collisions 15", either="turns",
    ),
    CLAMPING.but(
        turn={
            "name": "only_turns", "many": Many.REPEAT, "either": "turns", "own": True, "key": "",
            "help": "try this turn only; 0 leaves the part as it is; may be repeated",
        },
        tilt={
            "name": "tilts", "many": Many.REPEAT, "either": "tilts", "key": "",
            "help": "the fixture angles that there are; may be repeated",
        },
    ),
    Option(
        "free", "--free", Switch(),
        "tilt the part too, by a fixture angle about X of the program, right-handed, before the turn: at every 15"
        " degrees from -90 to 90, and more finely around the best", either="tilts", own=True,
    ),
    ZERO.but(help="the present workpiece zero on the machine, mm, to compare with"),
    TOOL_LENGTH,
    RADIUS_REGISTER.but(
        help="what radius compensation of NC programs works with: a difference, or the radius of the tool"
    ),
    SETTINGS.but(help="for CL files, as post has it; may be repeated"),
    READING_AS_SETTINGS,
    HOOKS.but(help="Python file that changes the CL files, as post has it; it is run; may be repeated", key=""),
    SUBPROGRAMS.but(help="files of the subprograms that the programs call; no others are opened"),
    BODIES.but(
        stock={"help": "as simulate takes it. Seen from above it is to stay on the table that the machine states"},
        part={"help": "the finished part, for which the same holds"},
        fixtures={"help": "a fixture as the part is drawn, clamped and turned with it"},
        tool_libraries={"help": "tool library, as simulate takes it"},
    ),
    JSON,
    Option(
        "plot", "--plot", FileOut("FILE.svg", (".svg",), phrase("places_are_svg")),
        "the margin over the table and over the turns", own=True,
    ),
    Option(
        "apply", "--apply", FileOut("FILE|-", stdout=True, told=True),
        "post the CL files with the best place, and prove it; the head of the program says how the part is turned, and"
        " where its zero is", own=True,
    ),
    SHEET.but(help="setup sheet of that program (.html or .json)", own=True),
    run="machine.place:run",
    examples=[
        ("trunnion place part.cls --machine yl569", "where the part may sit, and where best"),
        ("trunnion place part.cls --machine yl569 --goal time --apply part.mpf", "post it there"),
    ],
)  # fmt: skip

JOBS: Final[tuple[Job, ...]] = (_POST, _CONVERT, _PLACE)
