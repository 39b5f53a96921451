"""Faults in programs that ran, one at a time, and whether verification reports them.

A mutation changes the text of a program. Its effect is determined here from the text and from what the reader ran,
never from what verification reports:

- it changes the work: the motions at the part, or anything else that a CL file can ask for;
- it changes something outside the work, such as how the control rounds corners (``outside_work``);
- it provably changes nothing: every axis goes where it went with every state as it was, and every word that drives the
  control is where it was.

Any change must be reported, at the changed block or at the first one that does something else.
"""

import random
import re
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from functools import cache
from itertools import pairwise
from pathlib import Path

import numpy as np

from tests.support.locations import YL569
from trunnion.arrays import Flags, Floats
from trunnion.cl import read_cl
from trunnion.errors import InputError, Severity
from trunnion.machines import load_machine
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind, Toolpath
from trunnion.readers import run_program
from trunnion.readers.families.sinumerik import words
from trunnion.verification import Check, ExpectedValues, Tolerances, Verification, verify

CASES = ("1_contour_rough", "2_hub_rough", "3_blade_finish")
HALF_DIGIT = {"1_contour_rough": 5e-4, "2_hub_rough": 5e-6, "3_blade_finish": 5e-6}

#: Numbers nearer than this are equal: whole turns and back leave that much rounding; the programs print 1e-5.
SAME = 1e-9

SETTINGS = ExpectedValues(work_offset=54, edge=1)
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
    """What became of a mutation.

    verdict  CAUGHT; SAME: it provably changes nothing; OUTSIDE: not reported, but the work is unchanged;
             MISPLACED: reported at other blocks; MISSED: the work changes and nothing is reported
    what     if CAUGHT, how near: BLOCK, NEXT or SHOWS (the first motion or tool change after it, or the first that
             differs); if OUTSIDE, what changed
    checks   the checks that failed there
    """

    verdict: str
    what: str = ""
    checks: tuple[str, ...] = ()


@cache
def golden(name: str) -> tuple[tuple[str, ...], Toolpath]:
    """Lines of a golden program, and its CL file."""
    text = (YL569 / f"{name}.expected.mpf").read_text(encoding="utf-8")
    return tuple(text.splitlines()), read_cl(YL569 / f"{name}.cls")


def checked(name: str, run: Run) -> Verification:
    """The verification of a run against the golden CL file within half a digit."""
    half = HALF_DIGIT[name] + 1e-9
    return verify(run, [golden(name)[1]], tolerances=Tolerances(half, half), settings=SETTINGS)


@cache
def untouched(name: str) -> Run:
    """The golden program as it ran."""
    return run_program(YL569 / f"{name}.expected.mpf", MACHINE)


def judge(name: str, mutation: Mutation, folder: Path) -> Outcome:
    """Run a program with a fault and judge what verification reports."""
    path = folder / "MUTANT.MPF"
    path.write_text("\n".join(mutation.lines) + "\n", encoding="utf-8")
    try:
        run = run_program(path, MACHINE)
    except InputError as error:
        near = any(abs(problem.line - mutation.line) <= 1 for problem in error.problems)
        return Outcome("CAUGHT" if near else "MISPLACED", "BLOCK", ("refused",))
    first = first_difference(untouched(name), run)
    changed = [
        what for what, is_ in outside_work(run, mutation.lines).items() if is_ != _untouched_outside_work(name)[what]
    ]
    if first is None and not changed:
        return Outcome("SAME")
    failed = [check for check in checked(name, run).checks if not check.passed]
    if not failed:
        return Outcome("MISSED") if first is not None else Outcome("OUTSIDE", changed[0])
    shows = (first or set()) | _first_in_another_offset(untouched(name), run)
    return _placed(mutation, name, failed, run, shows)


def _first_in_another_offset(one: Run, two: Run) -> set[int]:
    """The line of the first motion of ``two`` in another work offset than in ``one``, machine positions not counted.

    An offset may turn rotary axes, though nothing else says so where they are positioned alone.
    """
    if len(one) != len(two):
        return set()
    rows = np.flatnonzero((one.work_offset != two.work_offset) & ~two.machine_frame)
    return set(two.line[rows[:1]].tolist())


def _placed(mutation: Mutation, name: str, failed: list[Check], run: Run, first: set[int]) -> Outcome:
    """How near the failed checks are to the fault."""
    motions = run.line[run.line >= mutation.line][:1].tolist()
    changes = [e.line for e in run.events if e.kind == "tool_change" and e.line >= mutation.line][:1]
    shows = {line + k for line in (*first, *motions, *changes) for k in (-1, 0, 1)}
    shows |= _uses(mutation, name) | _assigned_without_definition(mutation)
    right = {"BLOCK": {mutation.line}, "NEXT": {mutation.line - 1, mutation.line + 1}, "SHOWS": shows}
    for what, lines in right.items():
        near = tuple(check.key for check in failed if any(place.nc_line in lines for place in check.places))
        if near:
            return Outcome("CAUGHT", what, near)
    return Outcome("MISPLACED", "", tuple(check.key for check in failed))


def _uses(mutation: Mutation, name: str) -> set[int]:
    """Lines of the program that use a variable which the line of the fault sets, or set in the golden program."""
    golden = (YL569 / f"{name}.expected.mpf").read_text(encoding="utf-8").splitlines()
    told = "\n".join(line for lines in (mutation.lines, golden) for line in lines[mutation.line - 1 : mutation.line])
    names = re.findall(r"(\b_\w+)=", told)
    return {k for k, line in enumerate(mutation.lines, 1) for each in names if re.search(rf"{each}\b(?!=)", line)}


def _assigned_without_definition(mutation: Mutation) -> set[int]:
    """Lines that set variables before a DEF: that is where a lost definition shows."""
    defined: set[str] = set()
    found = set()
    for k, line in enumerate(mutation.lines, 1):
        if re.search(r"\bDEF\b", line):
            defined |= set(re.findall(r"\b_\w+", line))
        elif set(re.findall(r"(\b_\w+)=", line)) - defined:
            found.add(k)
    return found


def first_difference(one: Run, two: Run) -> set[int] | None:
    """Lines at which ``two`` first differs, in all motions and in those at the part; None if it does not."""
    lines: set[int] = set()
    for only_part in (False, True):
        a, b = _actions(one, only_part), _actions(two, only_part)
        length = min(len(a[0]), len(b[0]))
        same = np.ones(length, np.bool_)
        for x, y in zip(a[1:], b[1:], strict=True):
            x, y = x[:length], y[:length]
            equal = (np.abs(x - y) < SAME) | ((x != x) & (y != y))
            same &= equal if equal.ndim == 1 else equal.all(axis=1)
        if not same.all():
            lines.add(int(b[0][int(np.argmin(same))]))
        elif len(a[0]) != len(b[0]):
            lines.add(int(b[0][min(length, len(b[0]) - 1)]) if len(b[0]) else 0)
    if not lines and _end(one) != _end(two):
        return {0}
    return lines or None


def _actions(run: Run, only_part: bool) -> list[np.ndarray]:
    """Lines of the motions that move, and columns of everything that a CL file can ask for."""
    keep = _moves(run)
    if only_part:
        keep &= ~run.machine_frame
    rapid = run.kind == Kind.RAPID
    home = run.machine_frame
    # Where no slide is programmed and TCP is off, tool length and work offset have no effect.
    lengthless = home | (((run.programmed & 7) == 0) & ~run.tcp)
    coolant = _coolant(run)
    circle = np.zeros((len(run), 8))
    circle[run.arcs.row] = np.column_stack((run.arcs.centre, run.arcs.normal, run.arcs.radius, run.arcs.full_turns))
    tools = np.array([int(tool) if tool.isdigit() else 0 for tool in run.tools])[run.tool]
    columns = [
        run.line, run.kind, run.tip, run.axis, run.joints, np.where(rapid, 0.0, run.feed),
        np.where(rapid, 0, run.feed_mode), np.where(home, 0.0, run.rpm), np.where(home, 0, run.spindle),
        np.where(home, 0, tools), np.where(lengthless, 0, run.edge),
        np.where(lengthless, 0, np.where(_offset_is_lost(run), -1, run.work_offset)),
        run.tcp, run.machine_frame, run.orientation, np.where(home, 0.0, coolant), circle,
    ]  # fmt: skip
    return [np.asarray(column, np.float64)[keep] for column in columns]


def _end(run: Run) -> tuple[object, ...]:
    """Whether the program ends, and its words that are not understood."""
    ends = [event.value for event in run.events if event.kind == "end"]
    unknown = sorted(finding.text for finding in run.diagnostics if finding.severity is Severity.ERROR)
    compensated = [f.text for f in run.diagnostics if f.text.startswith(("G41", "G42"))]
    return bool(ends), tuple(unknown), tuple(compensated)


def _moves(run: Run) -> Flags:
    """Rows in which an axis moves."""
    before = np.vstack((run.start[None], run.joints[:-1])) if len(run) else run.joints
    moved: Flags = (np.abs(run.joints - before).max(axis=1, initial=0.0) > 0.0) | (run.kind == Kind.ARC)
    return moved


def _offset_is_lost(run: Run) -> Flags:
    """Rows after a TRAORI that cleared the work offset, until it is selected again."""
    found = np.zeros(len(run), np.bool_)
    for event in run.events:
        if event.kind == "offset":
            found[event.before_row :] = isinstance(event.value, str)
    return found


def _coolant(run: Run) -> Floats:
    coolant = np.zeros(len(run))
    for event in run.events:
        if event.kind == "coolant":
            coolant[event.before_row :] = {"off": 0, "flood": 1, "mist": 2, "through": 3}[str(event.value)]
    return coolant


# What changes outside the work

#: Words for how the control drives, and words that repeat the state in which the program began.
_DRIVES = (
    words.WITHOUT_PATH_EFFECT
    | words.WITHOUT_PATH_EFFECT_VALUES
    | {"ORIWKS", "ORIMKS"}
    | {f"G{code}" for code in words.G_WITHOUT_PATH_EFFECT}
)
_AGAIN = {"TRAFOOF", "TRAORI", *(f"G{code}" for code in (17, 18, 19, 70, 71, 700, 710, 90, 91, 93, 94, 95))}

_NAME = re.compile(r"[A-Z_$][A-Z_]+\d*|[A-Z]\d+")

DRIVES = "how the control drives between the points"
SMOOTHING = "tolerance and mode of CYCLE832"
AGAIN = "words that hold anyway, or that nothing asks after"
START = "the way home that the program begins with"
HOME = "spindle, tool, edge, offset or coolant away from the part"
AFTER = "spindle, coolant and tool after the last motion"
OTHERS = "waits, stops and words of the machine builder"

#: What a mutation may change without being reported, and why.
REASONS = {
    SMOOTHING: "the control's own smoothing between the points; no motion from point to point shows it",
    DRIVES: "`G60`, `G601`, `G64`, `COMPOF`, `FNORM`, `ORIWKS` and a `G40` where nothing was on: as before",
    AGAIN: "`G90`, `G94` or `TRAFOOF` before anything else was said, and a working plane without circles in it: "
    "the reader begins as controls are delivered",
    AFTER: "nothing moves any more; `M30` stops the spindle too, and no CL file says which tool stays in it",
    HOME: "on the way home, and where only rotary axes move without TCP: no CL file asks for it, and nothing is cut",
    START: "the machine is taken to stand at home when the program begins, so that nothing moves",
}


def outside_work(run: Run, lines: tuple[str, ...]) -> dict[str, object]:
    """What a program does outside the work, by kind: programs that agree in all of it do the same."""
    firsts = _first_positions(run)
    counts = _moves(run) | np.array(firsts, np.bool_)
    at = run.line[counts]
    rows = np.concatenate(([0], np.cumsum(counts)))
    state = np.column_stack((run.rpm, run.spindle, run.tool, run.edge, run.work_offset, _coolant(run)))[counts]
    programmed = [(int(np.searchsorted(at, k + 1)), _names(line)) for k, line in enumerate(lines)]
    changes = [event.before_row for event in run.events if event.kind == "tool_change"]
    found = [(bits, sum(k <= row for k in changes), int(run.kind[row])) for row, bits in enumerate(firsts) if bits]
    cycles = [(int(rows[e.before_row]), e.value) for e in run.events if e.kind == "cycle832"]
    # Exact stops are those of G words, which are among the drives, and of CYCLE832, which smooths.
    silent = {"tool", "tool_change", "spindle", "speed", "coolant", "message", "end", "offset"}
    silent |= {"cycle832", "tolerance", "orientation_tolerance", "exact_stop"}
    return {
        START: found,
        HOME: state.tolist(),
        DRIVES: _changes((place, names & _DRIVES) for place, names in programmed),
        SMOOTHING: _changes(cycles),
        AGAIN: _changes((place, names & _AGAIN) for place, names in programmed),
        AFTER: [[e.value for e in run.events if e.kind == kind][-1:] for kind in ("spindle", "coolant", "tool_change")],
        OTHERS: [(int(rows[e.before_row]), e.kind, e.value) for e in run.events if e.kind not in silent],
    }


@cache
def _untouched_outside_work(name: str) -> dict[str, object]:
    return outside_work(untouched(name), golden(name)[0])


def _names(line: str) -> frozenset[str]:
    """Words of a line without its comment and its texts."""
    return frozenset(_NAME.findall(re.sub(r'"[^"]*"', "", line).partition(";")[0]))


def _changes(values: Iterable[tuple[int, object]]) -> list[tuple[int, object]]:
    """Values and where they are, without those that repeat the last one."""
    kept: list[tuple[int, object]] = []
    for place, what in values:
        if what and (not kept or kept[-1][1] != what):
            kept.append((place, what))
    return kept


def _first_positions(run: Run) -> list[int]:
    """For every row the axes that are positioned for the first time, as bits of ``Run.programmed``."""
    known = 0
    firsts = []
    for bits in (run.programmed & 31).tolist():
        firsts.append(bits & ~known)
        known |= bits
    return firsts


# The faults


def mutations(name: str, digits: int | None, rng: random.Random) -> Iterator[Mutation]:
    """All structural faults in a golden program, and ``digits`` changed digits; None: each digit, to each other one."""
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


def sample(name: str, most: int, rng: random.Random) -> list[Mutation]:
    """At most ``most`` mutations of each kind."""
    by_kind: dict[str, list[Mutation]] = {}
    for mutation in mutations(name, most, rng):
        by_kind.setdefault(mutation.kind, []).append(mutation)
    return [mutation for some in by_kind.values() for mutation in rng.sample(some, min(most, len(some)))]


def _is_comment(line: str) -> bool:
    return re.match(r"N\d+ ;", line) is not None


def _changed(kind: str, lines: tuple[str, ...], k: int, new: list[str]) -> Mutation:
    return Mutation(kind, k + 1, (*lines[:k], *new, *lines[k + 1 :]))


def _digits(lines: tuple[str, ...], count: int | None, rng: random.Random) -> Iterator[Mutation]:
    """Digits that become others, except in block numbers and comments."""
    places = [
        (k, at)
        for k, line in enumerate(lines)
        if not _is_comment(line)
        for at, char in enumerate(line)
        if char.isdigit() and at >= line.index(" ")
    ]
    for k, at in places if count is None else rng.sample(places, min(count, len(places))):
        others = [digit for digit in "0123456789" if digit != lines[k][at]]
        for digit in others if count is None else [rng.choice(others)]:
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
    """Faults of particular words."""
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
        ("no work offset", r"\bG54\b", "G500"),
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


@dataclass
class Tally:
    """Outcomes of the mutations of one kind, and the texts of those that were not caught."""

    outcomes: Counter[str] = field(default_factory=Counter)
    near: Counter[str] = field(default_factory=Counter)
    outside: Counter[str] = field(default_factory=Counter)
    not_caught: dict[str, list[str]] = field(default_factory=dict)

    def add(self, name: str, mutation: Mutation, outcome: Outcome) -> None:
        """Count one mutation."""
        self.outcomes[outcome.verdict] += 1
        if outcome.verdict == "CAUGHT":
            self.near[outcome.what] += 1
        elif outcome.verdict != "SAME":
            what = outcome.what or outcome.verdict
            self.outside[what] += 1
            lines = golden(name)[0]
            text = lines[min(mutation.line, len(lines)) - 1]
            self.not_caught.setdefault(what, []).append(f"{name}:{mutation.line}: {mutation.kind}: {text}")


def sweep(name: str, faults: Iterable[Mutation], folder: Path) -> dict[str, Tally]:
    """Judge mutations of a program, by kind."""
    table: dict[str, Tally] = {}
    for mutation in faults:
        table.setdefault(mutation.kind, Tally()).add(name, mutation, judge(name, mutation, folder))
    return table
