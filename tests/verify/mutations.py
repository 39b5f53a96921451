"""Faults put into programs that ran, one at a time, and whether verification sees them.

A mutation changes the text of a program. It changes nothing if every motion of the program stays what it was: position,
tool axis, feed, spindle, tool, coolant and all the rest that a CL file can ask for. Otherwise it has to be reported, at
the block that was changed or at the first one that does something else because of it.
"""

import random
import re
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from pathlib import Path

import numpy as np

from tests.paths import YL569
from trunnion.cl import read_cl
from trunnion.errors import InputError, Severity
from trunnion.machine import load_machine
from trunnion.reader import Run, run_program
from trunnion.toolpath import Kind, Toolpath
from trunnion.verify import Allowed, Settings, Verification, verify

CASES = ("1_contour_rough", "2_hub_rough", "3_blade_finish")
HALF_DIGIT = {"1_contour_rough": 5e-4, "2_hub_rough": 5e-6, "3_blade_finish": 5e-6}

SETTINGS = Settings(work_offset=54, edge=1)
MACHINE = load_machine("yl569")

_WORD = re.compile(r"(?<![A-Z_$])([A-Z]\d?=?)(-?\d*\.?\d+|-?\d+\.)(?![A-Z_\d])")


@dataclass(frozen=True)
class Mutation:
    """One fault: its kind, the line of the changed block (from 1), and the lines of the program with it."""

    kind: str
    line: int
    lines: tuple[str, ...]


@dataclass(frozen=True)
class Outcome:
    """What became of a mutation: CAUGHT, SAME (it changes nothing), MISPLACED or MISSED."""

    verdict: str
    checks: tuple[str, ...]


@cache
def golden(name: str) -> tuple[tuple[str, ...], Toolpath]:
    """Lines of a golden program, and what it was made from."""
    text = (YL569 / f"{name}.expected.mpf").read_text(encoding="utf-8")
    return tuple(text.splitlines()), read_cl(YL569 / f"{name}.cls")


def checked(name: str, run: Run) -> Verification:
    """A run against the golden CL file, half a digit allowed."""
    half = HALF_DIGIT[name] + 1e-9
    return verify(run, [golden(name)[1]], allowed=Allowed(half, half), settings=SETTINGS)


@cache
def untouched(name: str) -> Run:
    """The golden program as it ran."""
    return run_program(YL569 / f"{name}.expected.mpf", MACHINE)


def judge(name: str, mutation: Mutation, folder: Path) -> Outcome:
    """Run a program with a fault in it and see what verification says."""
    path = folder / "MUTANT.MPF"
    path.write_text("\n".join(mutation.lines) + "\n", encoding="utf-8")
    try:
        run = run_program(path, MACHINE)
    except InputError:
        return Outcome("CAUGHT", ("refused",))
    first = first_difference(untouched(name), run)
    if first is None:
        return Outcome("SAME", ())
    found = checked(name, run)
    failed = [check for check in found.checks if not check.passed]
    if not failed:
        return Outcome("MISSED", ())
    right = {mutation.line - 1, mutation.line, mutation.line + 1}
    after = run.block[run.block >= mutation.line]
    right |= {line + k for line in first | set(after[:1].tolist()) for k in (-1, 0, 1)}
    near = tuple(c.key for c in failed if any(place.nc_line in right for place in c.places))
    return Outcome("CAUGHT" if near else "MISPLACED", near or tuple(c.key for c in failed))


def first_difference(one: Run, two: Run) -> set[int] | None:
    """Lines of ``two`` where it first does something else, in all motions and in those at the part; None: nowhere."""
    lines: set[int] = set()
    for only_part in (False, True):
        a, b = _doings(one, only_part), _doings(two, only_part)
        length = min(len(a[0]), len(b[0]))
        same = np.ones(length, np.bool_)
        for x, y in zip(a[1:], b[1:], strict=True):
            x, y = x[:length], y[:length]
            equal = (x == y) | ((x != x) & (y != y))
            same &= equal if equal.ndim == 1 else equal.all(axis=1)
        if not same.all():
            lines.add(int(b[0][int(np.argmin(same))]))
        elif len(a[0]) != len(b[0]):
            lines.add(int(b[0][min(length, len(b[0]) - 1)]) if len(b[0]) else 0)
    if not lines and _beside(one) != _beside(two):
        return {0}
    return lines or None


def _doings(run: Run, only_part: bool) -> list[np.ndarray]:
    """Lines of the motions, and columns of all that a CL file can ask for; motions that move nothing are left out."""
    before = np.vstack((run.start[None], run.joints[:-1])) if len(run) else run.joints
    keep = (np.abs(run.joints - before).max(axis=1, initial=0.0) > 0.0) | (run.kind == Kind.ARC)
    if only_part:
        keep &= ~run.machine_frame
    rapid = run.kind == Kind.RAPID
    home = run.machine_frame
    # Where no slide is named and TCP is off, the length of the tool has no say.
    lengthless = home | (((run.programmed & 7) == 0) & ~run.tcp)
    coolant = np.zeros(len(run))
    for event in run.events:
        if event.kind == "coolant":
            coolant[event.before_row :] = {"off": 0, "flood": 1, "mist": 2}[str(event.value)]
    circle = np.zeros((len(run), 8))
    circle[run.arcs.row] = np.column_stack((run.arcs.centre, run.arcs.normal, run.arcs.radius, run.arcs.turns))
    tools = np.array([int(tool) if tool.isdigit() else 0 for tool in run.tools])[run.tool]
    columns = [
        run.block, run.kind, run.tip, run.axis, run.joints, np.where(rapid, 0.0, run.feed),
        np.where(rapid, 0, run.feed_mode), np.where(home, 0.0, run.rpm), np.where(home, 0, run.spindle),
        np.where(home, 0, tools), np.where(lengthless, 0, run.edge), run.offset,
        run.tcp, run.machine_frame, np.where(home, 0.0, coolant), circle,
    ]  # fmt: skip
    return [np.asarray(column)[keep] for column in columns]


def _beside(run: Run) -> tuple[object, ...]:
    """What happens besides motion: whether the program ends, and words that are not understood."""
    ends = [event.value for event in run.events if event.kind == "end"]
    unknown = sorted(finding.text for finding in run.findings if finding.severity is Severity.ERROR)
    compensated = [f.text for f in run.findings if f.text.startswith(("G41", "G42"))]
    return bool(ends), tuple(unknown), tuple(compensated)


# The faults


def mutations(name: str, digits: int, rng: random.Random) -> Iterator[Mutation]:
    """All structural faults in a golden program, and ``digits`` changed digits."""
    lines = golden(name)[0]
    yield from _digits(lines, digits, rng)
    for k, line in enumerate(lines):
        if _is_comment(line):
            continue
        yield _changed("drop a block", lines, k, [])
        yield _changed("double a block", lines, k, [line, line])
        if k + 1 < len(lines) and not _is_comment(lines[k + 1]):
            swapped = (*lines[:k], lines[k + 1], line, *lines[k + 2 :])
            yield Mutation("swap two blocks", k + 1, swapped)
        yield from _words(lines, k)
    yield from _particular(lines)


def _is_comment(line: str) -> bool:
    return re.match(r"N\d+ ;", line) is not None


def _changed(kind: str, lines: tuple[str, ...], k: int, new: list[str]) -> Mutation:
    return Mutation(kind, k + 1, (*lines[:k], *new, *lines[k + 1 :]))


def _digits(lines: tuple[str, ...], count: int, rng: random.Random) -> Iterator[Mutation]:
    """Digits that become others, block numbers and comments left alone."""
    places = [
        (k, at)
        for k, line in enumerate(lines)
        if not _is_comment(line)
        for at, char in enumerate(line)
        if char.isdigit() and at >= line.index(" ")
    ]
    for k, at in rng.sample(places, min(count, len(places))):
        digit = rng.choice([d for d in "0123456789" if d != lines[k][at]])
        yield _changed("change a digit", lines, k, [lines[k][:at] + digit + lines[k][at + 1 :]])


def _words(lines: tuple[str, ...], k: int) -> Iterator[Mutation]:
    """Words of one block: two of them swapped, their values swapped, a sign flipped."""
    line = lines[k]
    number, _, rest = line.partition(" ")
    words = rest.split(" ")
    for i in range(len(words) - 1):
        swapped = [*words[:i], words[i + 1], words[i], *words[i + 2 :]]
        yield _changed("swap two words", lines, k, [f"{number} {' '.join(swapped)}"])
    found = [match for match in _WORD.finditer(line) if match.start() > len(number)]
    for one, two in pairwise(found):
        text = line[: one.start(2)] + two.group(2) + line[one.end(2) : two.start(2)] + one.group(2) + line[two.end(2) :]
        if text != line:
            yield _changed("swap two values", lines, k, [text])
    for match in found:
        value = match.group(2)
        flipped = value[1:] if value.startswith("-") else f"-{value}"
        if match.group(1)[0] in "XYZBCIJ":
            yield _changed("flip a sign", lines, k, [line[: match.start(2)] + flipped + line[match.end(2) :]])


def _particular(lines: tuple[str, ...]) -> Iterator[Mutation]:
    """Faults by name."""
    swaps: list[tuple[str, str, str]] = [
        ("G0 becomes G1", r"\bG0\b", "G1"),
        ("G1 becomes G0", r"\bG1\b", "G0"),
        ("G2 becomes G3", r"\bG2\b", "G3"),
        ("G3 becomes G2", r"\bG3\b", "G2"),
        ("another tool", r"\bT=?([12])\b", "T=9"),
        ("another speed", r"\bS\d+", "S1234"),
        ("M3 becomes M4", r"\bM3\b", "M4"),
        ("another feed", r"\bF\d+\.", "F77."),
        ("no feed", r" F\d+\.", ""),
        ("another work offset", r"\bG54\b", "G55"),
        ("inches", r"\bG710\b", "G700"),
        ("inches", r"\bG710\b", "G70"),
        ("incremental", r"\bG90\b", "G91"),
        ("feed per turn", r"\bG94\b", "G95"),
        ("cutter compensation", r"\bG40\b", "G41"),
        ("no coolant", r" M8\b", ""),
        ("other coolant", r"\bM8\b", "M7"),
        ("another edge", r"\bD1 M3", "D2 M3"),
        ("no TRAORI", r"\bTRAORI\b", "TRAFOOF"),
        ("no end", r"\bM30\b", "M5"),
    ]
    for kind, pattern, new in swaps:
        for k, line in enumerate(lines):
            if not _is_comment(line) and re.search(pattern, line):
                yield _changed(kind, lines, k, [re.sub(pattern, new, line, count=1)])
    for k, line in enumerate(lines):
        if line.endswith(" TRAORI"):
            yield _changed("no TRAORI", lines, k, [])
            place = next(i for i, text in enumerate(lines) if re.search(r"G0 B\S+ C", text))
            moved = (*lines[:place], line, *lines[place:k], *lines[k + 1 :])
            yield Mutation("TRAORI before the placing", place + 1, moved)
            cut = next(i for i, text in enumerate(lines) if text.endswith(";Cutting"))
            for at in range(cut + 1, len(lines)):
                if re.search(r" X", lines[at]):
                    yield Mutation("TRAFOOF in the cut", at + 1, (*lines[:at], "TRAFOOF", *lines[at:]))
                else:
                    break


def sweep(name: str, digits: int, folder: Path, say: Callable[[str], None] = lambda _: None) -> dict[str, Counter[str]]:
    """Judge all mutations of a program: by kind, how many had which outcome. ``say`` hears of what was not caught."""
    table: dict[str, Counter[str]] = {}
    for mutation in mutations(name, digits, random.Random(569)):
        outcome = judge(name, mutation, folder)
        table.setdefault(mutation.kind, Counter())[outcome.verdict] += 1
        if outcome.verdict in ("MISSED", "MISPLACED"):
            text = mutation.lines[min(mutation.line, len(mutation.lines)) - 1]
            say(f"{name}:{mutation.line}: {mutation.kind}: {outcome.verdict} {','.join(outcome.checks)}: {text}")
    return table
