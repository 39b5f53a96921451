"""How fast programs are read and run, and what the proof costs: ``python benchmarks/reading.py``.

Makes a CL file, posts it, and runs the program: in a process that is warm (kernels loaded, one small program run) and
as a whole process. A naive reader reads the same program. Nothing is judged by a figure alone: both must agree on
every position. Everything runs in turn and on one core where the system lets a process choose; what is judged is
processor time, which others on a busy machine have no part in. Prints tables; exit code 1 if a figure that is asked
for is not met.
"""

import argparse
import json
import math
import os
import platform
import statistics
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from throughput import MACHINE, MILLION, SMALL, Failed, Figure, Run, make_cls, run, table, trunnion

HERE = Path(__file__).resolve().parent

RATE = 500_000  # blocks/s, at least
WARM = "trunnion, warm, with tips and axes"
NAIVE = "naive reader, warm"

TIP = 1e-9  # mm, and
AXIS = 1e-9  # as far as the two readers may be apart: they only round differently


@dataclass(frozen=True, slots=True)
class Files:
    """The files of a benchmark."""

    cls: Path
    program: Path
    small: Path
    post: Path
    rows: Path


# What runs in processes of its own


class Watch:
    """Wall and processor seconds since it was made."""

    def __init__(self) -> None:
        self._wall, self._cpu = time.perf_counter(), time.process_time()

    def read(self) -> tuple[float, float]:
        """Seconds so far."""
        return time.perf_counter() - self._wall, time.process_time() - self._cpu


def stage_once(program: Path) -> dict[str, Any]:
    """Run a program once: for the time and memory of a whole process."""
    from trunnion.machines import load_machine
    from trunnion.readers import run_program

    return {"rows": len(run_program(program, load_machine(MACHINE)))}


def stage_read(small: Path, program: Path) -> dict[str, Any]:
    """Run a program in a warm process: without and with the tips and axes of all rows."""
    from trunnion.machines import load_machine
    from trunnion.readers import run_program

    machine = load_machine(MACHINE)
    run_program(small, machine).axis.sum()
    watch = Watch()
    ran = run_program(program, machine)
    bare = watch.read()
    # Columns may be worked out only when they are asked for.
    assert len(ran.tip) == len(ran.axis)
    return {"bare": bare, "whole": watch.read(), "findings": len(ran.diagnostics)}


def stage_prove(small: Path, cls: Path, program: Path) -> dict[str, Any]:
    """Post and prove with the functions that the command uses, and say what each step took."""
    post_and_prove(small, program)
    return post_and_prove(cls, program)


def post_and_prove(cls: Path, program: Path) -> dict[str, Any]:
    """Post a CL file and prove the program; processor seconds of each step."""
    from trunnion.cl import read_cl
    from trunnion.controls import load_control
    from trunnion.machines import load_machine
    from trunnion.output.program import Program
    from trunnion.output.program_writer import write_program
    from trunnion.planning import plan
    from trunnion.readers import run_program
    from trunnion.verification import ExpectedValues, Tolerances, verify

    machine = load_machine(MACHINE)
    control = load_control(machine.control)
    steps: dict[str, float] = {}

    def step(name: str, watch: Watch) -> Watch:
        steps[name] = watch.read()[1]
        return Watch()

    watch = Watch()
    toolpath = read_cl(cls)
    watch = step("read the CL file", watch)
    planned = plan([toolpath], machine, control.arcs.chord_tolerance)
    watch = step("plan", watch)
    with program.open("wb") as sink:
        write_program(Program(machine, control, planned.motions, {}, str(cls)), sink)
    watch = step("write", watch)
    ran = run_program(program, machine)
    watch = step("read back", watch)
    half = Tolerances(5e-6 + 1e-9, 5e-6 + 1e-9)
    found = verify(ran, [toolpath], tolerances=half, settings=ExpectedValues(work_offset=54, edge=1), columns=False)
    step("check", watch)
    return {"steps": steps, "passed": found.passed}


def stage_agree(program: Path, rows: Path) -> dict[str, Any]:
    """Compare the rows with TCP on with those of the naive reader."""
    from trunnion.machines import load_machine
    from trunnion.readers import run_program

    ran = run_program(program, load_machine(MACHINE))
    naive = np.fromfile(rows).reshape(-1, 8)
    tcp = ran.tcp & ~ran.machine_frame
    if int(tcp.sum()) != len(naive):
        return {"rows": [int(tcp.sum()), len(naive)]}
    return {
        "rows": [len(naive), len(naive)],
        "lines": int((ran.line[tcp] != naive[:, 0]).sum()),
        "kinds": int((ran.kind[tcp] != naive[:, 1]).sum()),
        "tip": float(np.abs(ran.tip[tcp] - naive[:, 2:5]).max()),
        "axis": float(np.abs(ran.axis[tcp] - naive[:, 5:8]).max()),
    }


def stage(arguments: list[str]) -> int:
    """Do one of the stages, and print what came out."""
    name, *rest = arguments
    paths = map(Path, rest)
    match name:
        case "once":
            result = stage_once(*paths)
        case "read":
            result = stage_read(*paths)
        case "prove":
            result = stage_prove(*paths)
        case _:
            result = stage_agree(*paths)
    print(json.dumps(result))
    return 0


# What runs them


def command(name: str, *values: object) -> list[str]:
    """Return the command of a stage."""
    return [sys.executable, str(Path(__file__).resolve()), "--stage", name, *map(str, values)]


def ask(name: str, *values: object) -> dict[str, Any]:
    """Run a stage in a process of its own; return what it says."""
    done = subprocess.run(command(name, *values), capture_output=True, text=True, check=True)
    result: dict[str, Any] = json.loads(done.stdout)
    return result


def pin() -> str:
    """Keep this process and its children on one core; return how in words."""
    if not hasattr(os, "sched_setaffinity"):
        return "not pinned to a core: this system does not offer it"
    core = max(os.sched_getaffinity(0))
    os.sched_setaffinity(0, {core})
    return "pinned to one core"


def naive_command(files: Files) -> list[str]:
    """Return the command of the naive reader."""
    return [sys.executable, str(HERE / "naive_reader.py"), str(files.program), str(files.rows)]


def warm_naive(files: Files) -> Run:
    """Return what the naive reader took without its start-up."""
    done = subprocess.run(naive_command(files), capture_output=True, text=True, check=True)
    wall, seconds = map(float, done.stdout.split())
    return Run(wall, seconds, 0)


def race(files: Files, small: Path, runs: int) -> dict[str, list[Run]]:
    """Run all in turn, ``runs`` times and one that does not count."""
    laps: dict[str, list[Run]] = {}
    for _ in range(runs + 1):
        read = ask("read", small, files.program)
        for name, (wall, seconds) in (("trunnion, warm", read["bare"]), (WARM, read["whole"])):
            laps.setdefault(name, []).append(Run(wall, seconds, 0))
        laps.setdefault(NAIVE, []).append(warm_naive(files))
        laps.setdefault("trunnion, whole process", []).append(run(command("once", files.program)))
        laps.setdefault("naive reader, whole process", []).append(run(naive_command(files)))
        laps.setdefault("trunnion post, whole process", []).append(run(trunnion(files.cls, files.post)))
    return {name: some[1:] for name, some in laps.items()}


def agreement(files: Files) -> Figure:
    """Whether both readers have the same rows, and how far they are apart."""
    found = ask("agree", files.program, files.rows)
    what, asked = "positions of both readers", f"agree within {TIP:g} mm"
    if "tip" not in found:
        return Figure(what, asked, f"{found['rows'][0]:,} and {found['rows'][1]:,} rows", False)
    measured = f"{found['rows'][0]:,} rows, tip {found['tip']:.1e} mm, axis {found['axis']:.1e}"
    met = found["lines"] == found["kinds"] == 0 and found["tip"] <= TIP and found["axis"] <= AXIS
    return Figure(what, asked, measured, met)


def cpu(runs: list[Run]) -> float:
    """Median processor time, in seconds; wall time where the system does not tell."""
    seconds = statistics.median(run.cpu for run in runs)
    return statistics.median(run.wall for run in runs) if math.isnan(seconds) else seconds


def show_race(blocks: int, laps: dict[str, list[Run]]) -> None:
    """Print the table of the contestants."""
    rows = [("reading and running", "wall s", "processor s", "least - most", "blocks/s", "peak MB")]
    for name, runs in laps.items():
        wall = f"{statistics.median(r.wall for r in runs):.3f}"
        spread = f"{min(r.cpu for r in runs):.3f} - {max(r.cpu for r in runs):.3f}"
        peak = max(r.peak for r in runs)
        rate = f"{blocks / cpu(runs):,.0f}"
        rows.append((name, wall, f"{cpu(runs):.3f}", spread, rate, f"{peak / 1e6:.0f}" if peak else "-"))
    table(rows)


def show_proof(steps: dict[str, float]) -> Figure:
    """Print what each step of posting and proving took; return the cost of the proof."""
    total = sum(steps.values())
    print()
    rows = [("posting, in a warm process", "processor s", "share")]
    rows += [(name, f"{seconds:.3f}", f"{100.0 * seconds / total:.0f} %") for name, seconds in steps.items()]
    table([*rows, ("together", f"{total:.3f}", "")])
    proof = steps["read back"] + steps["check"]
    return Figure("proof / post without it", "shown", f"{proof / (total - proof):.2f}", None)


def measure(points: int, runs: int, folder: Path) -> list[Figure]:
    """Make the files, run everything, print what was measured; returns the figures to judge."""
    cls, program = folder / "reading.cls", folder / "reading.mpf"
    files = Files(cls, program, folder / "small.cls", folder / "post.mpf", folder / "rows.bin")
    make_cls(points, files.cls)
    make_cls(SMALL, files.small)
    how = pin()
    small = folder / "small.mpf"
    ask("prove", files.small, files.small, small)
    proofs = [ask("prove", files.small, files.cls, files.program) for _ in range(runs)]
    with files.program.open("rb") as lines:
        blocks = sum(1 for _ in lines)
    size = files.program.stat().st_size
    print(f"{points:,} points, {blocks:,} blocks, {size / 1e6:.1f} MB; medians of {runs} runs after a warm-up, {how}")
    print(f"{platform.platform()}, {os.cpu_count()} processors, Python {platform.python_version()}\n")
    laps = race(files, small, runs)
    show_race(blocks, laps)
    proof = show_proof({name: statistics.median(p["steps"][name] for p in proofs) for name in proofs[0]["steps"]})
    proven = all(found["passed"] for found in proofs)
    rate = blocks / cpu(laps[WARM])
    met = rate >= RATE if points >= MILLION else None
    return [
        Figure("blocks/s on one core, with tips and axes", f">= {RATE:,}", f"{rate:,.0f}", met),
        Figure("blocks/s, trunnion / naive reader", "shown", f"{cpu(laps[NAIVE]) / cpu(laps[WARM]):.1f}", None),
        proof,
        Figure("the program is proven", "yes", "yes" if proven else "no", proven),
        agreement(files),
    ]


def main() -> int:
    """Run from the command line."""
    if sys.argv[1:2] == ["--stage"]:
        return stage(sys.argv[2:])
    parser = argparse.ArgumentParser(description="Measure how fast programs are read and proven.")
    parser.add_argument("--points", type=int, default=MILLION, help="points of the CL file (default: %(default)s)")
    parser.add_argument("--runs", type=int, default=5, help="runs that count, of each program (default: %(default)s)")
    arguments = parser.parse_args()
    if arguments.points < 1 or arguments.runs < 1:
        parser.error("--points and --runs must be at least 1")
    with tempfile.TemporaryDirectory(prefix="trunnion-reading-") as folder:
        try:
            figures = measure(arguments.points, arguments.runs, Path(folder))
        except (Failed, subprocess.CalledProcessError) as failed:
            print(f"a process failed: {getattr(failed, 'stderr', None) or failed}", file=sys.stderr)
            return 1
    verdict = {True: "met", False: "NOT MET", None: "not judged"}
    print()
    table([("figure", "asked", "measured", ""), *((f.what, f.asked, f.measured, verdict[f.met]) for f in figures)])
    return 1 if any(f.met is False for f in figures) else 0


if __name__ == "__main__":
    sys.exit(main())
