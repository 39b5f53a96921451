"""Compare what two checkouts make of the same CL files: programs, papers, data, messages and exit codes.

    python benchmarks/compare_outputs.py OLD NEW [CL_FILE_OR_FOLDER ...] [--machines NAME,NAME] [--every N]

OLD and NEW are checkouts of Trunnion. Every CL file of OLD's tests, and every file named besides, is posted on every
machine that OLD ships, or on those named, in several ways (``VARIANTS``), once by each checkout; what is written is
verified with its CL file. Projects (``.toml``) in the folders are posted too, each in a copy of its folder. Programs
with their subprograms, papers, the data of the verification, messages and exit codes must be equal. ``--every`` takes
every Nth run only. Exit code 1 if anything differs.
"""

import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

#: Options of the runs. A setting that a control does not have is refused by both checkouts, which is compared as well.
VARIANTS = (
    ("--force",),
    ("--set", "tcp=off", "--set", "zero=10,-20,30", "--set", "tool_length=83.5", "--force"),
    ("--set", "cycles=off"),
    ("--set", "orientation=vector", "--force"),
    ("--set", "programs=operations", "--explain"),
    ("--set", "feed=fastest", "--turn", "20"),
)

#: Endings of CL files; a revision may stand behind them, as Creo writes it.
ENDINGS = (".cls", ".apt", ".ncl", ".cl", ".aptsource")

#: Files of a run, but for the program.
PAPERS = {"--report": "report.json", "--sheet": "sheet.json", "--listing": "listing.txt", "--manifest": "manifest.json"}

#: Runs inside a checkout's own interpreter: one JSON list of arguments a line on stdin, exit code and stderr back.
WORKER = """
import contextlib, io, json, os, sys
from trunnion.cli import main
for line in sys.stdin:
    folder, arguments = json.loads(line)
    os.chdir(folder)  # names in papers and messages are the same in both
    err = io.StringIO()
    with contextlib.redirect_stderr(err), contextlib.redirect_stdout(io.StringIO()):
        try:
            code = main(arguments)
        except SystemExit as end:
            code = end.code
        except Exception as error:  # a crash is a result too, and never an equal one
            code = f"{type(error).__name__}: {error}"
    print(json.dumps([code, err.getvalue()]), flush=True)
"""


class Checkout:
    """A checkout whose ``trunnion post`` is run again and again in one process."""

    def __init__(self, root: Path) -> None:
        environment = {**os.environ, "PYTHONPATH": str(root / "src"), "PYTHONUTF8": "1"}
        self._process = subprocess.Popen(
            [sys.executable, "-c", WORKER], stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=environment, text=True
        )

    def run(self, arguments: list[str], folder: Path) -> tuple[object, str, dict[str, bytes]]:
        """Exit code, stderr, and the files that a command left in a folder."""
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._process.stdin.write(json.dumps([str(folder), arguments]) + "\n")
        self._process.stdin.flush()
        code, err = json.loads(self._process.stdout.readline())
        files = sorted(file for file in folder.rglob("*") if file.is_file())
        found = {str(file.relative_to(folder)): file.read_bytes().replace(str(folder).encode(), b"") for file in files}
        return code, err.replace(str(folder), ""), found

    def close(self) -> None:
        """End the process."""
        self._process.communicate()


class Comparison:
    """Two checkouts that run the same commands, and what differed."""

    def __init__(self, old: Path, new: Path) -> None:
        self._checkouts = [Checkout(old.resolve()), Checkout(new.resolve())]
        self._executor = ThreadPoolExecutor(2)
        self.runs = self.written = self.differ = 0

    def compare(self, name: str, commands: list[list[str]], copied: Path | None = None) -> None:
        """Run commands in an empty folder, or in a copy of one, and say what differs."""
        with tempfile.TemporaryDirectory() as one, tempfile.TemporaryDirectory() as two:
            folders = [Path(one), Path(two)]
            if copied is not None:
                for folder in folders:
                    shutil.copytree(copied, folder, dirs_exist_ok=True)
            for command in commands:
                old, new = self._executor.map(Checkout.run, self._checkouts, [command, command], folders)
                self.runs += 1
                if old != new or isinstance(new[0], str):
                    self.differ += 1
                    pairs = zip(("exit code", "messages", "files"), old, new, strict=True)
                    parts = ", ".join(what for what, before, after in pairs if before != after)
                    parts += "".join(
                        f" {each}" for each in sorted({*old[2], *new[2]}) if old[2].get(each) != new[2].get(each)
                    )
                    print(f"DIFFERS: {name}: {' '.join(command)}: {parts}; {old[0]} and {new[0]}", flush=True)
            self.written += "PROGRAM.NC" in old[2]

    def close(self) -> None:
        """End the processes."""
        for checkout in self._checkouts:
            checkout.close()


def cl_files(places: list[Path]) -> list[Path]:
    """All CL files in folders, and those that are named."""
    found = [file for place in places for file in (sorted(place.rglob("*")) if place.is_dir() else [place])]
    return list(dict.fromkeys(file.resolve() for file in found if file in places or is_cl(file)))


def is_cl(file: Path) -> bool:
    """Whether a file has the name of a CL file."""
    return any(suffix.lower() in ENDINGS for suffix in file.suffixes[-2:])


def projects(places: list[Path]) -> list[Path]:
    """Return the project files in folders: those that state a machine and CL files."""
    found = [file for place in places if place.is_dir() for file in sorted(place.rglob("*.toml"))]
    texts = ((file, file.read_text("utf-8", "replace")) for file in found)
    return [file for file, text in texts if "machine =" in text and "cl =" in text]


def machines(root: Path) -> list[str]:
    """Return the machines that a checkout ships."""
    return sorted(file.stem for file in root.glob("src/trunnion/machine*/library/*.toml"))


def commands(file: Path, machine: str, options: tuple[str, ...]) -> list[list[str]]:
    """Return a post with all papers, and a verification of its program."""
    papers = [word for option, name in PAPERS.items() for word in (option, f"{name}")]
    program = "PROGRAM.NC"
    post = ["post", str(file), "--machine", machine, "--output", program, *papers, *options]
    placed: list[str] = []
    for key, _, value in (word.partition("=") for word in options if word.startswith(("zero=", "tool_length="))):
        placed += ["--" + key.replace("_", "-"), value]
    verify = ["verify", program, "--machine", machine, "--cl", str(file), "--report", "verified.json", *placed]
    return [post, verify]


def main() -> int:
    """Compare; returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old", type=Path)
    parser.add_argument("new", type=Path)
    parser.add_argument("files", nargs="*", type=Path)
    parser.add_argument("--machines", help="names, with commas between them; all by default")
    parser.add_argument("--every", type=int, default=1, help="take every Nth run only")
    given = parser.parse_args()
    places = [given.old / "tests", *given.files]
    names = given.machines.split(",") if given.machines else machines(given.old)
    posts = [(file, name, options) for file in cl_files(places) for name in names for options in VARIANTS]
    comparison = Comparison(given.old, given.new)
    for file, name, options in posts[:: given.every]:
        comparison.compare(f"{file.name} on {name}", commands(file, name, options))
    for file in projects(places)[:: given.every]:
        comparison.compare(str(file), [["post", f"{file.name}"], ["test", f"{file.name}"]], file.parent)
    comparison.close()
    print(f"{comparison.runs} runs, {comparison.written} programs written, {comparison.differ} differ")
    return 1 if comparison.differ else 0


if __name__ == "__main__":
    sys.exit(main())
