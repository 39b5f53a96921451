"""Compare what two checkouts make of the same CL files: programs, reports and exit codes.

    python benchmarks/compare_outputs.py OLD NEW [CL_FILE_OR_FOLDER ...]

OLD and NEW are checkouts of Trunnion. Every CL file of OLD's tests, and every file named besides, is posted on every
machine that OLD ships, in several ways (``VARIANTS``), once by each checkout. Programs with their subprograms, report
data (JSON) and exit codes must be equal; differences on stderr are only counted. Exit code 1 if anything differs.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

#: Settings of the runs. One that a control does not have is refused by both checkouts, which is compared as well.
VARIANTS = (
    (),
    ("tcp=off", "zero=10,-20,30", "tool_length=83.5"),
    ("cycles=off",),
    ("orientation=vector",),
    ("programs=operations",),
)

#: Runs inside a checkout's own interpreter: one JSON list of arguments a line on stdin, exit code and stderr back.
WORKER = """
import contextlib, io, json, sys
from trunnion.cli import main
for line in sys.stdin:
    err = io.StringIO()
    with contextlib.redirect_stderr(err), contextlib.redirect_stdout(io.StringIO()):
        try:
            code = main(json.loads(line))
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

    def post(self, arguments: list[str], folder: Path) -> tuple[object, str, dict[str, bytes]]:
        """Exit code, stderr, and the files that were written into a folder."""
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._process.stdin.write(json.dumps(arguments) + "\n")
        self._process.stdin.flush()
        code, err = json.loads(self._process.stdout.readline())
        found = {file.name: file.read_bytes().replace(str(folder).encode(), b"") for file in sorted(folder.iterdir())}
        return code, err.replace(str(folder), ""), found

    def close(self) -> None:
        """End the process."""
        self._process.communicate()


def cl_files(places: list[Path]) -> list[Path]:
    """All CL files in folders, and those that are named."""
    found = [file for place in places for file in (sorted(place.rglob("*.cls")) if place.is_dir() else [place])]
    return list(dict.fromkeys(file.resolve() for file in found))


def machines(root: Path) -> list[str]:
    """The machines that a checkout ships."""
    return sorted(file.stem for file in root.glob("src/trunnion/machine*/library/*.toml"))


def main() -> int:
    """Compare; returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old", type=Path)
    parser.add_argument("new", type=Path)
    parser.add_argument("files", nargs="*", type=Path)
    given = parser.parse_args()
    files = cl_files([given.old / "tests", *given.files])
    names = machines(given.old)
    checkouts = [Checkout(root) for root in (given.old.resolve(), given.new.resolve())]
    runs = differ = messages = written = 0
    with ThreadPoolExecutor(len(checkouts)) as executor:
        for file in files:
            for machine in names:
                for variant in VARIANTS:
                    with tempfile.TemporaryDirectory() as one, tempfile.TemporaryDirectory() as two:
                        folders = [Path(one), Path(two)]
                        settings = [word for setting in variant for word in ("--set", setting)]
                        common = ["post", str(file), "--machine", machine, *settings, "--force"]
                        asked = [
                            [*common, "--output", str(folder / "PROGRAM.NC"), "--report", str(folder / "report.json")]
                            for folder in folders
                        ]
                        (code, err, found), (code_2, err_2, found_2) = executor.map(
                            Checkout.post, checkouts, asked, folders
                        )
                    runs += 1
                    written += "PROGRAM.NC" in found
                    messages += err != err_2
                    if (code, found) != (code_2, found_2) or isinstance(code_2, str):
                        differ += 1
                        print(f"DIFFERS: {file.name} on {machine} {' '.join(variant)}: {code} and {code_2}")
    for checkout in checkouts:
        checkout.close()
    print(f"{len(files)} CL files, {len(names)} machines, {len(VARIANTS)} variants: {runs} runs, {written} written")
    print(f"{differ} differ; messages on stderr differ in {messages}")
    return 1 if differ else 0


if __name__ == "__main__":
    sys.exit(main())
