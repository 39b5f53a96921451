"""Commands of the first steps: machines and their definitions."""

from typing import Final

from trunnion.jobs.job import Job, job
from trunnion.options.groups import JSON, SERVING
from trunnion.options.kinds import FileIn, Switch, Text
from trunnion.options.option import Many, Option

_NEW: Final = job(
    "new", "write the definition of a machine that is like a shipped one",
    Option("name", "", Text("NAME"), "name of the machine: NAME.toml is written"),
    Option("like", "--like", Text("MACHINE"), "shipped machine that it extends", required=True),
    JSON,
    run="machine.new:new",
    examples=[
        ("trunnion machines", "find the one that is most like yours"),
        ("trunnion new our_mill --like dmu65", "write our_mill.toml, with the numbers to measure"),
    ],
)  # fmt: skip

_IMPORT: Final = job(
    "import", "make a definition of a post of NX or Mastercam or of data of an 840D",
    Option(
        "files", "", FileIn("FILE"),
        "files of one post (.tcl, .def, .pui; .pst), or one of machine and swivel data ($MA_…, $TC_CARR…, as text)",
        many=Many.SOME,
    ),
    Option("output", "--output", Text("NAME"), "the definition: NAME.toml is written", either="what!"),
    Option(
        "machine", "--machine", FileIn("NAME_OR_FILE", leads="machine"),
        "definition to compare with: what the files have otherwise of its axes and control is listed", either="what!",
    ),
    Option(
        "like", "--like", Text("MACHINE"),
        "shipped machine that it extends",
    ),
    JSON,
    run="machine.foreign:run",
    examples=[
        ("trunnion import mill.tcl mill.def --output our_mill", "a post of NX as a definition, line by line"),
        ("trunnion import nck.arc --machine our_mill.toml", "which numbers the control has otherwise"),
    ],
)  # fmt: skip

_CHECK: Final = job(
    "check", "validate a definition, a project or another file",
    Option(
        "file", "", FileIn("NAME_OR_FILE", leads="definition"),
        "file to validate, or a shipped definition",
    ),
    Option(
        "program", "--program", FileIn("NC"),
        "NC program of the machine: the keys of [control.reading] under which it reads best, to copy",
    ),
    JSON.but(help="what it means as data: into a file, or to stdout in place of text"),
    run="machine.definitions:check",
    examples=[
        ("trunnion check our_mill.toml", "every mistake at once, and what the numbers mean"),
        ("trunnion check part.toml", "a project, a tool library, an impeller or a file of jobs"),
    ],
)  # fmt: skip

_MACHINES: Final = job(
    "machines", "list the machines, or print one definition",
    Option(
        "name", "", FileIn("NAME", leads="definition"), "machine whose definition is printed", many=Many.MAYBE
    ),
    Option(
        "resolved", "--resolved", Switch(), "with all that it extends, and the file and line of each value"
    ),
    JSON,
    run="machine.definitions:machines",
    examples=[
        ("trunnion machines", "a line each"),
        ("trunnion machines dmu65 --resolved", "every number, and where it comes from"),
    ],
)  # fmt: skip

_CONTROLS: Final = job(
    "controls", "list the controls, or explain one with all its settings",
    Option(
        "name", "", FileIn("NAME_OR_FILE", leads="definition"), "control to explain, or a machine's",
        many=Many.MAYBE,
    ),
    JSON,
    run="controls:controls",
    examples=[
        ("trunnion controls", "a line each"),
        ("trunnion controls dmu65", "all settings of that machine's control"),
    ],
)  # fmt: skip

_BUILD: Final = job(
    "build", "set up the definition of a machine, in a browser",
    Option("file", "", FileIn("MACHINE.toml"), "definition; none: a new one", many=Many.MAYBE),
    SERVING,
    run="build:run",
    goes_on=True,
    examples=[
        ("trunnion build", "a new machine"),
        ("trunnion build our_mill.toml", "go on with one"),
    ],
)  # fmt: skip

JOBS: Final[tuple[Job, ...]] = (_NEW, _IMPORT, _CHECK, _MACHINES, _CONTROLS, _BUILD)
