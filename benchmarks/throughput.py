"""How fast ``trunnion post`` is, against a C program and against a naive post: ``python benchmarks/throughput.py``.

Every contestant runs as a whole process, from starting it to its end, in turn with the others, after one run that does
not count (it fills the file cache and Trunnion's cache of compiled kernels). Nothing is judged by a figure alone: the
motion blocks of the three programs must agree. Prints a table; exit code 1 if a figure that is asked for is not met.
"""

import argparse
import compileall
import importlib.util
import math
import os
import platform
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

HERE = Path(__file__).resolve().parent

MACHINE = "yl569"
MILLION = 1_000_000
SMALL = 200

C_RATIO = 0.16  # of the C floor's points/s, at least
NAIVE_RATIO = 4.0  # times the naive post's points/s, at least
TEMPLATE_SHARE = 0.03  # of the processor time, at most, that templates of a shop take
MEMORY_RATIO = 4.0  # peak memory in input sizes, below
SMALL_SECONDS = 0.7  # a small file from start to end, at most
FIRST_SECONDS = 15.0  # the first post of the sample, its kernels compiled on two cores, at most
REFERENCE_SECONDS = 5.94  # of the naive post, a million points, on the machine for which seconds are asked

SAMPLE = HERE.parent / "tests" / "golden" / "yl569" / "3_blade_finish.cls"

FLOOR = "C floor"
BARE = "trunnion without its proof"
SHOP = "trunnion with templates of a shop"
NAIVE = "naive post"

#: A block that moves, without its number and G word, and with the words of its position alone.
MOTION = re.compile(rb"^(?:N\d+ )?(?:G[01] )?((?:[XYZBC]-?[\d.]+ ?)+)", re.MULTILINE)
LETTERS = "XYZBC"
LAST_DIGIT = 1e-5
SLACK = 1e-9  # what rounding in the arithmetic before may move a number
SHOWN = 5

#: Passes of the loop that says how fast the machine is.
PASSES = 10_000_000

#: What contestants run in. Users have byte-compiled sources, whatever the shell of a developer says.
ENVIRONMENT = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}


@dataclass(frozen=True, slots=True)
class Run:
    """One process: wall and processor seconds, peak memory in bytes (0 where the system does not tell)."""

    wall: float
    cpu: float
    peak: int


@dataclass(slots=True)
class Contestant:
    """A program that posts, and its runs so far."""

    name: str
    command: list[str]
    output: Path
    runs: list[Run] = field(default_factory=list)

    @property
    def wall(self) -> float:
        """Median wall time, in seconds."""
        return statistics.median(run.wall for run in self.runs)

    @property
    def cpu(self) -> float:
        """Median processor time, in seconds."""
        return statistics.median(run.cpu for run in self.runs)

    @property
    def peak(self) -> int:
        """Largest peak memory, in bytes."""
        return max(run.peak for run in self.runs)


@dataclass(frozen=True, slots=True)
class Figure:
    """A measured figure beside the one that is asked for; ``met`` is None where it cannot be judged."""

    what: str
    asked: str
    measured: str
    met: bool | None


@dataclass(frozen=True, slots=True)
class Difference:
    """A word that two programs print differently: where, and what the two print."""

    block: int
    letter: str
    one: str
    other: str


class Failed(Exception):  # noqa: N818 - it is the run that failed
    """A contestant ended with an error."""


def run(command: Sequence[str], environment: Mapping[str, str] | None = None) -> Run:
    """Run a process to its end and say what it took; ``environment`` is what it has besides this one's."""
    with tempfile.TemporaryFile() as errors:
        start = time.perf_counter()
        environment = {**ENVIRONMENT, **(environment or {})}
        process = subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL, stderr=errors)
        if sys.platform == "win32":
            process.wait()
            wall = time.perf_counter() - start
            cpu, peak = math.nan, 0
        else:
            _, status, usage = os.wait4(process.pid, 0)
            wall = time.perf_counter() - start
            process.returncode = os.waitstatus_to_exitcode(status)
            cpu = usage.ru_utime + usage.ru_stime
            peak = usage.ru_maxrss * (1 if sys.platform == "darwin" else 1024)
        if process.returncode != 0:
            errors.seek(0)
            text = errors.read().decode(errors="replace").strip()
            raise Failed(f"exit code {process.returncode}\n{text[-2000:]}")
    return Run(wall, cpu, peak)


def trunnion(source: Path, target: Path, machine: str = MACHINE) -> list[str]:
    """Return the command that posts ``source`` with Trunnion."""
    return [sys.executable, "-m", "trunnion", "post", str(source), "--machine", machine, "--output", str(target)]


def compile_sources() -> None:
    """Byte-compile Trunnion and the naive post, as an installation does."""
    found = importlib.util.find_spec("trunnion")
    if found is None:
        sys.exit("Trunnion is not installed in this Python")
    for folder in (*(found.submodule_search_locations or ()), str(HERE)):
        compileall.compile_dir(folder, quiet=2)


def machine_seconds() -> float:
    """How fast the machine is: the seconds of a plain loop of Python, the least of five runs of it."""
    times = []
    for _ in range(5):
        start, total = time.perf_counter(), 0
        for number in range(PASSES):
            total += number
        times.append(time.perf_counter() - start)
    return min(times)


def needless_packages() -> list[str]:
    """List packages that Trunnion does not need, and that Numba imports at each start where they are installed."""
    return [name for name in ("scipy", "yaml") if importlib.util.find_spec(name) is not None]


def make_cls(points: int, file: Path) -> None:
    """Make a CL file. In a process of its own: what a parent holds in memory counts in its children's peak."""
    subprocess.run([sys.executable, str(HERE / "make_cls.py"), str(points), str(file)], check=True)


def compile_floor(folder: Path) -> Path | None:
    """Compile the C floor; None if there is no compiler, or it will not."""
    names = [os.environ.get("CC", ""), "cc", "gcc", "clang"]
    compiler = next((found for name in names if name and (found := shutil.which(name))), None)
    if compiler is None:
        print("no C compiler found (CC, cc, gcc, clang): the C floor and its ratio are skipped")
        return None
    program = folder / ("floor.exe" if sys.platform == "win32" else "floor")
    command = [compiler, "-O2", str(HERE / "floor.c"), "-o", str(program), "-lm"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        print(f"{compiler} does not compile floor.c: the C floor and its ratio are skipped\n{done.stderr.strip()}")
        return None
    return program


def race(contestants: Sequence[Contestant], runs: int) -> list[Contestant]:
    """Run all in turn, ``runs`` times and one that does not count; returns those that came through."""
    able = list(contestants)
    for lap in range(runs + 1):
        for contestant in list(able):
            contestant.output.unlink(missing_ok=True)
            try:
                result = run(contestant.command)
            except Failed as failed:
                print(f"{contestant.name} failed: {failed}")
                able.remove(contestant)
                continue
            if lap:
                contestant.runs.append(result)
    return able


def motion_blocks(file: Path) -> list[bytes]:
    """Return the position words of every motion block of a program."""
    return [match[1].rstrip() for match in MOTION.finditer(file.read_bytes())]


def words(block: bytes) -> dict[str, str]:
    """Letter -> printed number."""
    return {word[0]: word[1:] for word in block.decode("ascii").split()}


def in_force(blocks: Sequence[bytes], at: int, letter: str) -> str:
    """Return what the word of ``letter`` last printed, up to block ``at``; empty if it never did."""
    for k in range(at, -1, -1):
        if (text := words(blocks[k]).get(letter)) is not None:
            return text
    return ""


def differences(one: Sequence[bytes], other: Sequence[bytes]) -> list[Difference]:
    """Return the words that differ between two programs of equally many blocks; an absent word stands for its last
    number.
    """
    found = []
    for at, (a, b) in enumerate(zip(one, other, strict=True)):
        if a == b:
            continue
        words_a, words_b = words(a), words(b)
        if words_a == words_b:  # the same words in another order
            found.append(Difference(at, "", a.decode(), b.decode()))
        for letter in LETTERS:
            if words_a.get(letter) == words_b.get(letter):
                continue
            text_a, text_b = in_force(one, at, letter), in_force(other, at, letter)
            before = at and in_force(one, at - 1, letter) != in_force(other, at - 1, letter)
            if text_a != text_b or not before:
                found.append(Difference(at, letter, text_a, text_b))
    return found


def readings(letter: str, point: Sequence[float]) -> tuple[float, ...]:
    """Return the values that a word may stand for. B has two: a vector of nine decimals is not quite a unit vector."""
    x, y, z, i, j, k = point
    match letter:
        case "B":
            return math.degrees(math.acos(k)), math.degrees(math.atan2(math.hypot(i, j), k))
        case "C":
            return (math.degrees(math.atan2(j, i)) % 360.0,)
        case _:
            return ({"X": x, "Y": y, "Z": z}[letter],)


def is_tie(difference: Difference, point: Sequence[float]) -> bool:
    """Whether two numbers that differ by one last digit are both right.

    They are when the boundary between them is where the value itself lies: a number of six decimals that ends in 5, or
    an angle whose two readings, acos(k) and the angle of the normalized vector, lie on both sides.
    """
    try:
        one, other = float(difference.one), float(difference.other)
    except ValueError:
        return False
    if difference.letter == "C" and {one, other} == {0.0, 360.0}:
        return True
    if abs(one - other) > 1.5 * LAST_DIGIT or one == other:
        return False
    boundary = (one + other) / 2.0
    values = readings(difference.letter, point)
    return min(values) - SLACK <= boundary <= max(values) + SLACK


def read_points(file: Path) -> list[str]:
    """Return the numbers of every GOTO statement, as text."""
    with file.open(encoding="utf-8") as lines:
        return [line[5:] for line in lines if line.startswith("GOTO/")]


def compare(one: Contestant, other: Contestant, points: Sequence[str]) -> Figure:
    """Compare two programs block by block, list what differs, and judge it."""
    what = f"motion blocks of {one.name} and {other.name}"
    asked = "agree but for ties"
    blocks_a, blocks_b = motion_blocks(one.output), motion_blocks(other.output)
    if len(blocks_a) != len(blocks_b) or len(blocks_a) != len(points) + 1:
        counts = f"{len(blocks_a):,} and {len(blocks_b):,} blocks of {len(points) + 1:,}"
        for at, (a, b) in enumerate(zip(blocks_a, blocks_b, strict=False)):
            if a != b:
                print(f"{what}: first difference in motion block {at}: {a.decode()} | {b.decode()}")
                break
        return Figure(what, asked, counts, False)
    ties: list[Difference] = []
    errors: list[Difference] = []
    for difference in differences(blocks_a, blocks_b):
        # block 0 turns the rotary axes to where the first point wants them
        point = [float(text) for text in points[max(0, difference.block - 1)].split(",")]
        (ties if is_tie(difference, point) else errors).append(difference)
    for name, found in (("tie", ties), ("difference", errors)):
        for d in found[:SHOWN]:
            print(f"{what}: {name} in motion block {d.block}: {d.letter}{d.one} | {d.letter}{d.other}")
        if len(found) > SHOWN:
            print(f"{what}: and {len(found) - SHOWN:,} more like these")
    by_letter = ", ".join(f"{letter} {n:,}" for letter in LETTERS if (n := sum(d.letter == letter for d in ties)))
    measured = f"{len(blocks_a):,} blocks, {len(errors):,} differ, ties: {by_letter or 'none'}"
    return Figure(what, asked, measured, not errors)


def speed_figures(product: Contestant | None, rivals: Sequence[Contestant], large: bool) -> list[Figure]:
    """Return the ratios of points per second."""
    figures = []
    for rival in rivals:
        asked = C_RATIO if rival.name == FLOOR else NAIVE_RATIO
        name = "trunnion" if product is None else product.name
        what, text = f"points/s, {name} / {rival.name}", f">= {asked:g}"
        if product is None:
            figures.append(Figure(what, text, "not measured", False))
        else:
            ratio = rival.wall / product.wall
            figures.append(Figure(what, text, f"{ratio:.3f}", ratio >= asked if large else None))
    return figures


def memory_figure(product: Contestant | None, size: int, large: bool) -> Figure:
    """Peak memory of Trunnion in sizes of its input."""
    what, asked = "peak memory / input size", f"< {MEMORY_RATIO:g}"
    if product is None:
        return Figure(what, asked, "not measured", False)
    if not product.peak:
        return Figure(what, asked, "skipped: this system does not tell", None)
    ratio = product.peak / size
    measured = f"{ratio:.2f} ({product.peak / 1e6:.0f} MB)"
    return Figure(what, asked, measured, ratio < MEMORY_RATIO if large else None)


def table(rows: Sequence[Sequence[str]]) -> None:
    """Print rows in columns, the first row as their heads."""
    widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
    for n, row in enumerate(rows):
        print("  ".join(text.ljust(width) for text, width in zip(row, widths, strict=True)).rstrip())
        if n == 0:
            print("  ".join("-" * width for width in widths))


def contestants(source: Path, folder: Path) -> list[Contestant]:
    """Everything that posts the large file: Trunnion, without its proof too, the naive post, and the C floor."""
    names = ("trunnion", SHOP, BARE, NAIVE, FLOOR)
    outputs = {name: folder / f"{name.replace(' ', '_')}.mpf" for name in names}
    bare = [sys.executable, str(HERE / "unproven.py"), str(source), MACHINE, str(outputs[BARE])]
    naive = [sys.executable, str(HERE / "naive_post.py"), str(source), str(outputs[NAIVE])]
    shop = trunnion(source, outputs[SHOP], str(HERE / "shop.toml"))
    commands = {"trunnion": trunnion(source, outputs["trunnion"]), SHOP: shop, BARE: bare, NAIVE: naive}
    if program := compile_floor(folder):
        commands[FLOOR] = [str(program), str(source), str(outputs[FLOOR])]
    return [Contestant(name, command, outputs[name]) for name, command in commands.items()]


def print_times(able: Sequence[Contestant], points: int) -> None:
    """Print what each contestant took."""
    rows = [("program", "median s", "least - most s", "processor s", "points/s", "peak MB")]
    for one in able:
        walls = [r.wall for r in one.runs]
        spread = f"{min(walls):.3f} - {max(walls):.3f}"
        peak = f"{one.peak / 1e6:.0f}" if one.peak else "-"
        rows.append((one.name, f"{one.wall:.3f}", spread, f"{one.cpu:.3f}", f"{points / one.wall:,.0f}", peak))
    table(rows)
    print()


def slowness(able: Sequence[Contestant], points: int) -> float:
    """How many times slower the naive post is here than where seconds are asked; 1 if it failed."""
    naive = [one.wall for one in able if one.name == NAIVE]
    return naive[0] * MILLION / points / REFERENCE_SECONDS if naive else 1.0


def seconds_figure(what: str, seconds: float | None, most: float, slower: float) -> Figure:
    """Wall seconds from the start of a process to its end, as on the machine for which they are asked.

    None: it failed.
    """
    if seconds is None:
        return Figure(what, f"<= {most:g} s", "not measured", False)
    scaled = seconds / slower
    return Figure(what, f"<= {most:g} s", f"{scaled:.2f} s ({seconds:.2f} s here)", scaled <= most)


def small_file(runs: int, folder: Path, slower: float) -> Figure:
    """How long a small file takes, with compiled kernels on disk."""
    source, target = folder / "small.cls", folder / "small.mpf"
    make_cls(SMALL, source)
    able = race([Contestant("small file", trunnion(source, target), target)], runs)
    return seconds_figure(f"{SMALL} points from start to end", able[0].wall if able else None, SMALL_SECONDS, slower)


def first_post(folder: Path, slower: float) -> Figure:
    """How long a newcomer's first post takes: of the sample, with no compiled kernels on disk."""
    empty = {"NUMBA_CACHE_DIR": str(folder / "kernels")}
    seconds = None
    try:
        seconds = run(trunnion(SAMPLE, folder / "sample.mpf"), empty).wall
    except Failed as failed:
        print(f"the first post failed: {failed}")
    return seconds_figure("first post of the sample", seconds, FIRST_SECONDS, slower)


def measure(points: int, runs: int, folder: Path) -> list[Figure]:
    """Make the files, run everything, print what was measured; returns the figures to judge."""
    source = folder / "throughput.cls"
    make_cls(points, source)
    size = source.stat().st_size
    large = points >= MILLION
    print(f"{points:,} points, {size / 1e6:.1f} MB; {runs} runs after a warm-up, medians of whole processes")
    print(f"{platform.platform()}, {os.cpu_count()} processors, Python {platform.python_version()}")
    compile_sources()
    print(f"this machine: {machine_seconds():.3f} s for {PASSES:,} passes of a plain loop of Python\n")

    started = contestants(source, folder)
    able = race(started, runs)
    print_times(able, points)
    product, bare, shop = (next((one for one in able if one.name == name), None) for name in ("trunnion", BARE, SHOP))
    rivals = [one for one in able if one not in (product, bare, shop)]
    figures = speed_figures(product, rivals, large)
    figures += speed_figures(bare, rivals, False)
    if product is not None and shop is not None:
        share = shop.cpu / product.cpu - 1.0
        asked = f"<= {TEMPLATE_SHARE:.0%}"
        figures.append(
            Figure("processor time for templates", asked, f"{share:.1%}", share <= TEMPLATE_SHARE if large else None)
        )
    if not any(one.name == FLOOR for one in started):
        figures.append(Figure(f"points/s, trunnion / {FLOOR}", f">= {C_RATIO:g}", f"skipped: no {FLOOR}", None))
    slower = slowness(able, points)
    figures += [memory_figure(product, size, large), small_file(runs, folder, slower), first_post(folder, slower)]
    figures += [Figure(f"{one.name} runs", "yes", "no", False) for one in started if one not in able]
    # only now, as what this process holds in memory would count as its children's
    given = read_points(source)
    figures += [compare(a, b, given) for n, a in enumerate(able) for b in able[n + 1 :]]
    return figures


def main() -> int:
    """Run from the command line."""
    parser = argparse.ArgumentParser(description="Measure the throughput of trunnion post.")
    parser.add_argument("--points", type=int, default=MILLION, help="points of the CL file (default: %(default)s)")
    parser.add_argument("--runs", type=int, default=5, help="runs that count, of each program (default: %(default)s)")
    arguments = parser.parse_args()
    if arguments.points < 1 or arguments.runs < 1:
        parser.error("--points and --runs must be at least 1")
    if needless := needless_packages():
        print(f"{' and '.join(needless)} installed here: Numba imports them at each start, which takes 0.1 s or more")
    with tempfile.TemporaryDirectory(prefix="trunnion-throughput-") as folder:
        figures = measure(arguments.points, arguments.runs, Path(folder))
    verdict = {True: "met", False: "NOT MET", None: "not judged"}
    print()
    table([("figure", "asked", "measured", ""), *((f.what, f.asked, f.measured, verdict[f.met]) for f in figures)])
    if arguments.points < MILLION:
        print(f"\nratios and memory are judged from {MILLION:,} points on: below, start-up weighs too much")
    return 1 if any(f.met is False for f in figures) else 0


if __name__ == "__main__":
    sys.exit(main())
