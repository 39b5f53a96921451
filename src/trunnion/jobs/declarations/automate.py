"""Commands for many files, for scripts and for editors."""

from typing import Final

from trunnion.jobs.job import Job, job
from trunnion.messages import phrase
from trunnion.options.groups import JSON, MACHINE, OTHER_MACHINE, READING, SETTINGS, STOCK, TOOLS
from trunnion.options.kinds import Choice, FileIn, FileOut, Measure, Switch, Text, seconds, whole
from trunnion.options.option import Many, Option
from trunnion.options.words import ACTIONS, MOST_TILES, PREPARED, SCHEMAS, SHELLS

_FOLDER: Final = "for a folder"

_WORKERS: Final = Option(
    "workers", "--workers",
    whole(phrase("kind_number_of_workers"), phrase("one_from_to", least=1, most=1024), "N", 1, 1024),
    "processes; by default as many as there are processors",
)  # fmt: skip

_BATCH: Final = job(
    "batch", "post, convert, verify or simulate many files, here or on a cluster",
    Option(
        "jobs", "", FileIn("JOBS.toml|FOLDER", leads="jobs"),
        "file of jobs, which states what is done; or a folder",
    ),
    Option(
        "results", "--results", Text("FOLDER|URL"),
        "where results go: a folder, or an address such as s3://bucket/folder",
    ),
    Option(
        "summary", "--summary",
        FileOut("FILE", (".sqlite", ".parquet"), phrase("summary_is_table"), told=True),
        "a table of all files with their figures: .sqlite or .parquet",
    ),
    _WORKERS,
    Option("timeout", "--timeout", seconds(1e6), "how long a file may take; by default any time"),
    Option(
        "scheduler", "--scheduler", Text("ADDRESS"),
        "let the workers of Dask do it: tcp://HOST:PORT or tls://",
    ),
    Option("wait", "--wait", seconds(1e6), "end if the scheduler is without workers for so long"),
    Option("tls_ca", "--tls-ca", FileIn(), "certificate of the authority, for tls://", own=True),
    Option("tls_cert", "--tls-cert", FileIn(), "certificate of this computer", own=True),
    Option("tls_key", "--tls-key", FileIn(), "its key", own=True),
    JSON,
    Option("action", "--action", Choice(ACTIONS), "what is done", heading=_FOLDER),
    MACHINE.but(help="machine of the programs", heading=_FOLDER),
    Option(
        "files", "--files", Text("PATTERN"), "names of the files, such as '**/*.nc'; may be repeated",
        many=Many.REPEAT, heading=_FOLDER,
    ),
    SETTINGS.but(help="settings as post has them; may be repeated", heading=_FOLDER),
    OTHER_MACHINE.but(help="convert: machine of the new programs", either="target", heading=_FOLDER),
    Option("to_cl", "--to-cl", Switch(), "convert: write CL files", either="target", heading=_FOLDER),
    Option(
        "cl", "--cl", Text("NAME"),
        "verify: CL file of each program, such as '{folder}/{stem}.cls'; may be repeated", many=Many.REPEAT,
        heading=_FOLDER,
    ),
    STOCK.but(help="simulate: as trunnion simulate has it", heading=_FOLDER),
    TOOLS.but(help="simulate: a tool; may be repeated", heading=_FOLDER),
    Option(
        "tiles", "--tiles", Measure("N", least=1, most=MOST_TILES, is_whole=True),
        "simulate: tasks among which each simulation is divided; by default one", heading=_FOLDER,
    ),
    Option("report", "--report", Choice(("html", "json")), "a report of each file", heading=_FOLDER),
    run="many_files.batch:run",
    goes_on=True,
    examples=[
        ("trunnion batch jobs.toml", "what the file states, and only what is not done yet"),
        ("trunnion batch cl --action post --machine yl569 --results nc", "every CL file of a folder"),
    ],
)  # fmt: skip

_SURVEY: Final = job(
    "survey", "try every CL file and program of a folder, and say what stands in the way",
    Option("folder", "", Text("FOLDER"), "folder whose files are tried, and those below; nothing is written there"),
    MACHINE.but(
        help="shipped machine, or a TOML file; may be repeated; by default one for each control", many=Many.REPEAT,
        key="",
    ),
    READING.but(strict={"key": ""}),
    Option("timeout", "--timeout", seconds(1e6), "how long a file may take on each machine; by default 60 s"),
    _WORKERS,
    Option(
        "report", "--report", FileOut("FILE", (".html",), phrase("report_is_page")), "all of it as a page: .html",
        own=True,
    ),
    JSON,
    run="many_files.survey:run",
    goes_on=True,
    examples=[
        ("trunnion survey cl_files", "what becomes of the files of a folder, on a machine of each control"),
        ("trunnion survey server --machine our_mill.toml --report survey.html", "on your machine, as a page"),
    ],
)  # fmt: skip

_TEST: Final = job(
    "test", "post the projects of a folder again, and compare with what is there",
    Option(
        "folder", "", Text("FOLDER|PROJECT"),
        "every part.toml, case.toml and NAME.case.toml in it and below; or one project",
    ),
    Option("accept", "--accept", Switch(), "show what differs, and take the new programs over"),
    JSON,
    run="cases:run",
    goes_on=True,
    guards=True,
    examples=[
        ("trunnion test parts", "are all programs as they were?"),
        ("trunnion test parts --accept", "take the new ones over"),
    ],
)  # fmt: skip

_EXPLAIN: Final = job(
    "explain", "say what a code of a message, or a check, means",
    Option(
        "codes", "", Text("CODE"), "as messages end with it, such as CL110, or a check", many=Many.ANY
    ),
    JSON,
    run="explain:explain",
    examples=[
        ("trunnion explain CL110", "what the code at the end of a message means"),
        ("trunnion explain tip", "what a check proves"),
    ],
)  # fmt: skip

_SCHEMA: Final = job(
    "schema", "print the JSON Schema of definitions or projects, for editors",
    Option("kind", "", Choice(SCHEMAS, "KIND"), f"what the files are: {', '.join(SCHEMAS)}"),
    run="machine.new:schema",
    examples=[
        ("trunnion schema project", "keys of project files, as an editor takes them"),
        ("trunnion schema machine > machine.schema.json", "into a file"),
    ],
)  # fmt: skip

_COMPLETION: Final = job(
    "completion", "print what makes a shell complete commands and options",
    Option("shell", "", Choice(SHELLS, "SHELL"), f"the shell: {', '.join(SHELLS)}"),
    run="completion:run",
    examples=[
        ('eval "$(trunnion completion bash)"', "in ~/.bashrc"),
        ("trunnion completion fish > ~/.config/fish/completions/trunnion.fish", "once"),
    ],
)  # fmt: skip

_PREPARE: Final = job(
    "prepare", "compile everything for this computer now, so that no later command has to",
    Option(
        "work", "", Choice(PREPARED, "WORK"),
        f"only what this command needs: {', '.join(PREPARED)}; by default everything", many=Many.MAYBE,
    ),
    run="prepare:run",
    examples=[
        ("trunnion prepare", "once, after the installation or an update"),
        ("trunnion prepare post", "what posting needs, its proof included"),
        ("trunnion prepare --language de", "in German"),
    ],
)  # fmt: skip

_FREECAD: Final = job(
    "freecad", "put the post for FreeCAD where FreeCAD looks, or take it back",
    Option("step", "", Choice(("install",), "install"), "what is done"),
    Option("remove", "--remove", Switch(), "take it back"),
    Option("folder", "--folder", Text("FOLDER"), "folder of macros; by default that of FreeCAD's settings"),
    run="doors:run_freecad",
    examples=[
        ("trunnion freecad install", "from now on FreeCAD's jobs have the post trunnion"),
        ("trunnion freecad install --remove", "no longer"),
    ],
)  # fmt: skip

_FUSION: Final = job(
    "fusion", "put the post for Fusion, HSMWorks and Inventor CAM into a folder of posts, or take it back",
    Option("step", "", Choice(("install",), "install"), "what is done"),
    Option("remove", "--remove", Switch(), "take it back"),
    Option("folder", "--folder", Text("FOLDER"), "folder of posts; by default that of Fusion's local posts"),
    run="doors:run_fusion",
    examples=[
        ("trunnion fusion install", "from now on Fusion's local posts have Trunnion APT"),
        ("trunnion fusion install --folder .", "to import it into a library yourself"),
    ],
)  # fmt: skip

JOBS: Final[tuple[Job, ...]] = (_BATCH, _SURVEY, _TEST, _EXPLAIN, _SCHEMA, _COMPLETION, _FREECAD, _FUSION, _PREPARE)
