"""Cures of messages about arguments of commands that serve, and of those that ask for others."""

from typing import Final

from tests.support.cures.scripts import script

_POST: Final = "trunnion post part.cls --machine yl569"
_SERVED: Final = "set trunnion.cli.view.serve 'lambda *_: None'\nset trunnion.cli.build.serve 'lambda *_: None'\n"
_VIEW: Final = "trunnion view part.mpf --machine yl569"
_LIVE: Final = (
    f"{_SERVED}set trunnion.cli.view.LiveMachine.check 'lambda self: None'\n"
    "trunnion view --live opc.tcp://localhost:1 --machine yl569 --port 0"
)
_BUILD: Final = f"{_SERVED}trunnion build part.cls --port 0"
_IMPELLER: Final = "trunnion impeller model part.toml"
_FIT: Final = "trunnion.fit([], machines=['yl569'], tool_length=100)"

CURES: Final = (
    script(
        "ARG120 watched_stream",
        f"set trunnion.cli.watch.follow 'lambda *_: 0'\n{_POST} --output - --watch",
        "--output -",
        "--output a.mpf",
    ),
    script("ARG120 written_twice", f"{_POST} --set cl_units=mm --set cl_units=inch", " --set cl_units=inch", ""),
    script("ARG130 builder_wants_definition", _BUILD, "part.cls", "ours.toml"),
    script("ARG130 builder_starts_from_shipped", _BUILD.replace("part.cls", "yl569"), "yl569 ", ""),
    script("ARG130 no_motion_in_files", _FIT, "[]", "['part.cls']"),
    script("ARG130 live_is_served", f"{_LIVE} --output a.html", " --output a.html", ""),
    script("ARG130 missing_live_machine", _LIVE.replace(" --machine yl569", ""), "--port", "--machine yl569 --port"),
    script(
        "ARG130 missing_program_and_machine",
        "trunnion twin --device-xml a.xml",
        "--device-xml",
        "part.mpf --machine yl569 --device-xml",
    ),
)
