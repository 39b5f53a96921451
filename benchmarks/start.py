"""How fast commands start: ``python benchmarks/start.py [--against CHECKOUT] [--cold]``.

Each command runs as a whole process on a small file. Warm, its machine code is kept, and both checkouts run in turn,
so that a busy moment hits both. Cold, nothing is kept, and all that the command calls is compiled. Sources are copied
and byte-compiled first, as where Trunnion is installed. What a command writes must be the same from both checkouts.
"""

import argparse
import compileall
import hashlib
import os
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).resolve().parent
POINTS = 200
MACHINE = ("--machine", "yl569")

#: The commands; ``{small}`` is a CL file, ``{program}`` a program of it, ``{out}`` where output goes.
COMMANDS: dict[str, tuple[str, ...]] = {
    "--version": ("--version",),
    "explain": ("explain", "CL110"),
    "info": ("info", "{small}"),
    "post": ("post", "{small}", *MACHINE, "--output", "{out}/a.mpf"),
    "verify": ("verify", "{program}", *MACHINE, "--cl", "{small}"),
    "convert": ("convert", "{program}", *MACHINE, "--to-machine", "dmu65", "--output", "{out}/a.h"),
    "diff": ("diff", "{program}", "{program}", *MACHINE),
    "simulate": ("simulate", "{program}", *MACHINE, "--stock", "cylinder:108,30,-30", "--cell", "1",
                 "--tool", "2=ball:10,length=75,flutes=40"),
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class Spent:
    """What a process took: processor and wall time, s, the largest resident size, MB, and a digest of its output."""

    processor: float
    wall: float
    memory: float
    output: str


class Checkout:
    """Sources of Trunnion, copied and byte-compiled, with a folder of their own for machine code."""

    def __init__(self, sources: Path, folder: Path) -> None:
        self.name, self._folder = folder.name, folder
        shutil.copytree(sources / "src" / "trunnion", folder / "trunnion", ignore=shutil.ignore_patterns("__pycache__"))
        compileall.compile_dir(folder / "trunnion", quiet=2)
        self.forget()

    def forget(self) -> None:
        """Throw its machine code away."""
        shutil.rmtree(self._folder / "kept", ignore_errors=True)
        (self._folder / "kept").mkdir()

    def run(self, command: Sequence[str]) -> Spent:
        """Run a command in a process, and wait for those that it leaves behind to compile."""
        out = self._folder / "out"
        shutil.rmtree(out, ignore_errors=True)
        out.mkdir()
        kept = str(self._folder / "kept")
        environment = {**os.environ, "PYTHONPATH": str(self._folder), "NUMBA_CACHE_DIR": kept}
        environment.pop("PYTHONDONTWRITEBYTECODE", None)
        words = [sys.executable, "-m", "trunnion", *(word.format(out=out) for word in command)]
        begun = time.monotonic()
        with (out / "stdout").open("wb") as stdout, (out / "stderr").open("wb") as stderr:
            process = subprocess.Popen(words, env=environment, cwd=out, stdout=stdout, stderr=stderr)
            _, status, used = os.wait4(process.pid, 0)
        wall = time.monotonic() - begun
        if os.waitstatus_to_exitcode(status) not in (0, 1):
            sys.exit((out / "stderr").read_text(encoding="utf-8"))
        digest = hashlib.sha256()
        for file in sorted(out.iterdir()):
            if file.name != "stderr":  # which says what was compiled
                digest.update(file.read_bytes().replace(str(self._folder).encode(), b""))
        size = used.ru_maxrss * (1 if sys.platform == "darwin" else 1024)
        return Spent(used.ru_utime + used.ru_stime, wall, size / 1e6, digest.hexdigest())


def main() -> int:
    """Measure, and print a table; exit code 1 if both checkouts write something else."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0] if __doc__ else "")
    parser.add_argument("--against", type=Path, help="another checkout, which runs in turn with this one")
    parser.add_argument("--runs", type=int, default=5, help="warm runs of each command")
    parser.add_argument("--cold", action="store_true", help="a run of each without machine code, too")
    parser.add_argument("--commands", nargs="*", choices=list(COMMANDS), default=list(COMMANDS), metavar="COMMAND")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        home = Path(folder)
        checkouts = [Checkout(HERE.parent, home / "now")]
        if given.against is not None:
            checkouts.append(Checkout(given.against, home / "before"))
        small, program = home / "small.cls", home / "small.mpf"
        subprocess.run([sys.executable, str(HERE / "make_cls.py"), str(POINTS), str(small)], check=True)
        checkouts[0].run(("post", str(small), *MACHINE, "--output", str(program)))
        print(f"{POINTS} points; medians of {given.runs} warm runs; this machine may have been shared")
        print("| command | start | processor s | wall s | peak MB |", "| --- | --- | ---: | ---: | ---: |", sep="\n")
        differs = False
        for name in given.commands:
            command = [
                word.replace("{small}", str(small)).replace("{program}", str(program)) for word in COMMANDS[name]
            ]
            spent = {each.name: list(_runs(each, command, cold=given.cold)) for each in checkouts}
            for _ in range(given.runs):
                for each in checkouts:
                    spent[each.name].append(each.run(command))
            differs = differs or len({run.output for runs in spent.values() for run in runs}) > 1
            _print_rows(name, spent, cold=given.cold)
    if differs:
        print("the outputs differ")
    return int(differs)


def _runs(checkout: Checkout, command: Sequence[str], *, cold: bool) -> Iterator[Spent]:
    """Yield a cold run, if it is wanted, and run once more, which does not count."""
    if cold:
        checkout.forget()
        yield checkout.run(command)
    checkout.run(command)


def _print_rows(name: str, spent: dict[str, list[Spent]], *, cold: bool) -> None:
    """Print the rows of one command: medians, those of the other checkout first."""
    for start in ("cold", "warm") if cold else ("warm",):
        runs = [each[:1] if start == "cold" else each[int(cold) :] for each in spent.values()]
        cells = [
            " → ".join(f"{statistics.median(getattr(run, what) for run in each):.{digits}f}" for each in runs[::-1])
            for what, digits in (("processor", 2), ("wall", 2), ("memory", 0))
        ]
        print(f"| `{name}` | {start} | {' | '.join(cells)} |", flush=True)


if __name__ == "__main__":
    sys.exit(main())
