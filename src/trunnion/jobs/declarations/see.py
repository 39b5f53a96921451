"""Commands that show programs, CL files and machines."""

from typing import Final

from trunnion.jobs.job import Job, job
from trunnion.messages import phrase
from trunnion.options.groups import (
    ASSUME,
    BODIES,
    CUTTING,
    HOOKS,
    JSON,
    LIVE,
    MACHINE,
    OUTPUT,
    RADIUS_REGISTER,
    RATE,
    READING_AS_SETTINGS,
    SERVING,
    SETTINGS,
    SETTINGS_OF_READING,
    SETUP,
    SUBPROGRAMS,
    TOOL_LIBRARIES,
    TOOL_UNIT,
    TOOLS,
)
from trunnion.options.kinds import Choice, FileIn, FileOut, Number, Switch, Text, seconds, whole
from trunnion.options.limits import FASTEST, SLOWEST
from trunnion.options.option import Many, Option

_INFO: Final = job(
    "info", "show what CL files hold; no machine is needed",
    Option("cl", "", FileIn("CL", stdin=True), "CL file; several are one job in their order", many=Many.SOME),
    READING_AS_SETTINGS,
    SETTINGS_OF_READING,
    JSON,
    Option(
        "plot", "--plot", FileOut("FILE", (".html",), phrase("path_is_page")),
        "the path by operation in space, as a page (.html)", own=True,
    ),
    run="info:info",
    examples=[
        ("trunnion info part.cls", "operations, tools, times"),
        ("trunnion info part.cls --plot part.html", "its path, on a page"),
    ],
)  # fmt: skip

_CONNECTING: Final = "with --live"

_VIEW: Final = job(
    "view", "show an NC program on its machine, in a browser",
    Option(
        "nc", "", FileIn("NC|CL|PROJECT", leads="project"),
        "NC program, with its subprograms behind it; CL files, which are posted; or a project (.toml)", many=Many.ANY,
    ),
    MACHINE.but(help="machine that runs it; a project may state it"),
    Option("against", "--against", FileIn("NC|CL"), "a second program, beside it on the same tool path"),
    MACHINE.but(
        name="against_machine", flag="--against-machine", help="machine of that, if it is another", key=""
    ),
    Option("setup", "--setup", Text("NAME"), "set-up of a project, if it has several: its name or number"),
    SETTINGS.but(
        help="for CL files, as post has it; or a variable that the program reads and does not set: Q13=10; may be"
        " repeated"
    ),
    ASSUME,
    READING_AS_SETTINGS,
    HOOKS.but(help="Python file that changes the CL files, as post has it; it is run; may be repeated", key=""),
    Option("cl", "--cl", FileIn("CL", stdin=True), "CL file that it was made from", many=Many.REPEAT),
    SUBPROGRAMS,
    BODIES,
    CUTTING,
    RADIUS_REGISTER,
    SETUP,
    OUTPUT.but(
        kind=FileOut("FILE.html", (".html",), phrase("view_is_page")),
        help="write a page that works offline, and serve nothing",
    ),
    Option(
        "live", "--live", Text("ADDRESS"),
        "follow a machine, or a twin, by OPC UA (opc.tcp://HOST:PORT/…), as it moves; no program is needed", own=True,
    ),
    LIVE.under(_CONNECTING),
    SERVING,
    run="view:run",
    goes_on=True,
    examples=[
        ("trunnion view part.mpf --machine yl569", "block by block, in a browser"),
        ("trunnion view part.toml --output part.html", "a project, as one page that works offline"),
    ],
)  # fmt: skip

_TWIN: Final = job(
    "twin", "serve an NC program as a running machine: OPC UA and MTConnect",
    Option("nc", "", FileIn("NC"), "NC program that the machine runs", many=Many.MAYBE),
    MACHINE.but(help="machine that runs it"),
    SUBPROGRAMS,
    SETUP,
    RADIUS_REGISTER,
    TOOLS.but(help="a tool, for its radius under radius compensation, such as 1=flat:12,length=75,flutes=30"),
    TOOL_LIBRARIES,
    TOOL_UNIT,
    Option(
        "speed", "--speed",
        Number(
            "N|max", phrase("kind_speed"), phrase("speed_from_to", least=SLOWEST, most=FASTEST),
            least=SLOWEST, most=FASTEST, words={"max": None},
        ),
        "times real time, 0.1 to 1000, or max: as fast as clients can follow", default=1.0,
    ),
    Option("loop", "--loop", Switch(), "begin anew at the end of the program"),
    Option("hold", "--hold", Switch(), "wait for a client to start the program"),
    RATE.but(help="milliseconds between samples, besides the ends of blocks"),
    Option(
        "host", "--host", Text("ADDRESS"),
        "serve OPC UA on this address, encrypted and for users only, unless it is this computer's own",
        default="127.0.0.1",
    ),
    Option(
        "port", "--port", whole(phrase("kind_port"), phrase("number_or_free"), "N", most=65535),
        "port of OPC UA, 0: a free one", default=4840,
    ),
    Option(
        "adapter_port", "--adapter-port", whole(phrase("kind_port"), phrase("number_or_free"), "N", most=65535),
        "port of the MTConnect adapter", default=7878,
    ),
    Option(
        "agent_port", "--agent-port", whole(phrase("kind_port"), phrase("number_or_free"), "N", most=65535),
        "serve an MTConnect agent as well, on this port (5000 is usual)",
    ),
    Option("no_mtconnect", "--no-mtconnect", Switch(), "serve OPC UA alone", own=True),
    Option(
        "device_xml", "--device-xml", FileOut("FILE.xml", (".xml",), phrase("device_model_is_xml")),
        "write the devices of an MTConnect agent, and end", own=True,
    ),
    Option("users", "--users", FileIn(), "file of users; by default that in your folder for data"),
    Option(
        "add_user", "--add-user", Text("NAME"),
        "add a user, whose password is asked for or read from stdin, and end", own=True,
    ),
    Option(
        "role", "--role", Choice(("operator", "viewer")),
        "of the user who is added: operates the twin, or only looks", default="operator", own=True,
    ),
    run="twin:run",
    goes_on=True,
    examples=[
        ("trunnion twin part.mpf --machine yl569 --loop", "a machine that runs it again and again"),
        ("trunnion twin --add-user anna", "a user for other computers"),
    ],
)  # fmt: skip

_RECORD: Final = job(
    "record", "record what a machine, or a twin, shows by OPC UA",
    Option("address", "", Text("ADDRESS"), "of the machine's OPC UA server: opc.tcp://HOST:PORT/…"),
    Option(
        "output", "--output", FileOut("FILE", (".csv", ".parquet"), phrase("recording_is_table"), told=True),
        "recording (.csv or .parquet); never written over", required=True,
    ),
    Option("seconds", "--seconds", seconds(1e9, "N"), "how long; without it until Ctrl-C"),
    LIVE,
    run="record:run",
    goes_on=True,
    examples=[
        ("trunnion record opc.tcp://localhost:4840 --output run.csv", "until Ctrl-C"),
        ("trunnion verify part.mpf --machine yl569 --recorded run.csv", "then compare it with the program"),
    ],
)  # fmt: skip

JOBS: Final[tuple[Job, ...]] = (_VIEW, _INFO, _TWIN, _RECORD)
