"""Nothing but the program and the files that were named is opened, whatever a program asks for.

The proof is Python's own account of what it opens (audit events), kept in a process of its own: once such an account is
kept it cannot be ended.
"""

import json
import os
import random
import subprocess
import sys
from pathlib import Path

import pytest

from tests.support.fuzz import pieces
from tests.support.locations import ROOT

#: Definitions that come with the package.
SHIPPED = ROOT / "src" / "trunnion"

#: Runs the programs of a folder and prints what was opened, listed or started meanwhile. The first run is not watched:
#: it loads what is needed once; the texts of messages are read with pkgutil.
WATCHER = """
import json, pkgutil, sys
from pathlib import Path
from trunnion.errors import InputError
from trunnion.machines import load_machine
from trunnion.readers import RunOptions, run_program

folder = Path(sys.argv[1])
machine = load_machine("yl569")
seen = []
watching = False
WATCHED = ("open", "os.", "subprocess.", "socket.", "shutil.", "glob.", "ctypes.", "exec", "compile", "import", "mmap.")

def watch(event, values):
    if watching and event.startswith(WATCHED):
        seen.append((event, [str(value) for value in values]))

def run(path):
    try:
        named = [folder / "L10.SPF"]
        run = run_program(path, machine, RunOptions(subprograms=named, step_limit=2000), family="sinumerik_840d")
        return len(run.diagnostics)
    except InputError:
        return -1

programs = sorted(folder.glob("*.MPF"))
blocks = ["TRAORI", "X1 A3=0 C3=1", "TRAFOOF", "L10", "MCALL CYCLE81(5,0,1,-3)", "X1", "C5", "IF 1", "ENDIF", "M30"]
(folder / "WARM.MPF").write_text("\\n".join(blocks))
run(folder / "WARM.MPF")
for name, module in list(sys.modules.items()):  # whose classes make their methods when first used
    for each in list(vars(module).values()) if name.startswith("trunnion") else ():
        if isinstance(each, type):
            [getattr(each, method) for method in ("__init__", "__repr__", "__eq__", "__hash__")]
sys.addaudithook(watch)
watching = True
outcomes = [run(path) for path in programs]
watching = False
print(json.dumps({"seen": seen, "outcomes": outcomes}))
"""

SECRET = "X666\nM17\n"

NAMES = (
    "../SECRET", "../SECRET.SPF", "..\\SECRET", "/etc/passwd", "/etc/passwd.SPF", "C:\\SECRET.SPF", "\\\\host\\SECRET",
    "SECRET", "LINK", "LINKED/SECRET", "LINKED/", "LOOPY", "CIRCLE_A", "DANGLING", "FOLDER", "PIPE", "DEVICE",
    "a/../../SECRET",
    "/_N_MPF_DIR/../_N_SECRET_SPF", "/_N_WKS_DIR/_N_OUT_WPD/_N_SECRET_SPF", "_N_.._DIR/SECRET", "./SECRET", "//SECRET",
    "%2e%2e/SECRET", "..", ".", "", "/", "~/SECRET", "$HOME/SECRET", "SECRET\0.SPF", "ＳＥＣＲＥＴ", "CON", "NUL",
    "file:///etc/passwd",
    "/proc/self/environ", "/dev/stdin", "HARD", "A" * 3000,
)  # fmt: skip


def _folder(root: Path) -> Path:
    """Return a folder with everything in it that nobody has named, and that could lead out of it."""
    folder = root / "part"
    folder.mkdir()
    (root / "SECRET.SPF").write_text(SECRET)
    (root / "out").mkdir()
    (root / "out" / "SECRET.SPF").write_text(SECRET)
    (folder / "L10.SPF").write_text("X1\nRET\n")
    (folder / "FOLDER.SPF").mkdir()
    (folder / "FOLDER.SPF" / "SECRET.SPF").write_text(SECRET)
    if hasattr(os, "mkfifo"):
        os.mkfifo(folder / "PIPE.SPF")
        for link, target in {
            "LINK.SPF": root / "SECRET.SPF",
            "LINKED": root / "out",
            "LOOPY.SPF": folder / "LOOPY.SPF",
            "CIRCLE_A.SPF": folder / "CIRCLE_B.SPF",
            "CIRCLE_B.SPF": folder / "CIRCLE_A.SPF",
            "DANGLING.SPF": root / "nowhere",
            "DEVICE.SPF": Path("/dev/zero"),
        }.items():
            (folder / link).symlink_to(target)
    return folder


def _programs() -> list[str]:
    """Programs that ask for files by every name, in every way."""
    made = [f'{word}("{name}")\nX1\n' for name in NAMES for word in ("EXTCALL", "CALL")]
    made += [f'DEF STRING[200] _S="{name}"\nEXTCALL(_S)\nX1\n' for name in NAMES]
    made += ["SECRET\nLINK\nLOOPY\nFOLDER\nPIPE\nMCALL LINK\nX1\nMCALL PIPE\nX2\nL10\n", "MCALL SECRET\nX1\n"]
    for seed in range(40):
        rng = random.Random(seed)
        parts = ("..", "/", "\\", ":", "SECRET", "LINK", "out", ".SPF", "_N_", "_DIR", "_SPF", "~", ".", "part", "\0")
        made.append("".join(f'EXTCALL("{"".join(rng.choices(parts, k=6))}")\n' for _ in range(20)))
        made.append(pieces.program(30, rng.choice))
    return made


@pytest.fixture(scope="module")
def watched(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, list[tuple[str, list[str]]], list[int]]:
    """The folder, what happened in the process that ran its programs, and how many findings each had."""
    folder = _folder(tmp_path_factory.mktemp("access"))
    for k, text in enumerate(_programs()):
        (folder / f"ASK{k:04}.MPF").write_bytes(text.encode())
    # A pipe that was opened would wait for ever.
    done = subprocess.run(
        [sys.executable, "-c", WATCHER, str(folder)], capture_output=True, text=True, check=True, timeout=600
    )
    found = json.loads(done.stdout)
    return folder, found["seen"], found["outcomes"]


def test_only_files_that_were_named_are_opened(watched: tuple[Path, list[tuple[str, list[str]]], list[int]]) -> None:
    folder, seen, outcomes = watched
    opened = {Path(values[0]) for event, values in seen if event == "open"}
    opened = {path for path in opened if not path.is_relative_to(SHIPPED)}
    assert opened == {*folder.glob("ASK*.MPF"), folder / "L10.SPF"}
    assert len(opened) >= len(outcomes)


def test_nothing_is_listed_and_nothing_is_started(
    watched: tuple[Path, list[tuple[str, list[str]]], list[int]],
) -> None:
    assert {event for event, _ in watched[1]} <= {"open"}


def test_asking_for_what_is_not_there_is_a_finding(
    watched: tuple[Path, list[tuple[str, list[str]]], list[int]],
) -> None:
    outcomes = watched[2]
    assert all(count != 0 for count in outcomes[: 3 * len(NAMES)])
