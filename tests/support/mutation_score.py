"""How many changes of the sources the tests notice: ``python -m tests.support.mutation_score --count 300 --seed 1``.

Mutants are drawn at random from all modules, as many of each kind. For each, the tests run that reach its module
through imports, nearest first, until one fails. A mutant that no test notices may be one that changes nothing. Tests
run in a copy of the tree with draws of one seed; one that fails without the mutant too kills nothing.
"""

import argparse
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from importlib.util import cache_from_source
from itertools import zip_longest
from pathlib import Path

import grimp

from tests.support.locations import ROOT
from tests.support.reached import import_graph, is_test, package_of
from tests.support.source_mutants import KINDS, Mutant, mutants_of

#: Files of the first round of tests; each round has twice as many as the one before.
FIRST_ROUND = 6

#: What a mutant comes to.
KILLED, SURVIVED, NOT_KILLED_IN_TIME, NO_TESTS = "killed", "survived", "not killed in time", "no tests"

_FAILED = re.compile(r"^(?:FAILED|ERROR) (.+?)(?: - .*)?$", re.MULTILINE)


class Trial:
    """A copy of the tree, in which mutants are tried."""

    def __init__(self, folder: Path, seconds: float) -> None:
        self.root, self.seconds, self.graph = folder / "tree", seconds, import_graph()
        ignored = shutil.ignore_patterns(".*", "__pycache__", "node_modules", "build", "dist")
        shutil.copytree(ROOT, self.root, ignore=ignored)
        for linked in ("tests/twin/node/node_modules",):
            if (ROOT / linked).exists():
                (self.root / linked).symlink_to(ROOT / linked)
        self._fails_anyway = dict[str, bool]()

    def outcome(self, mutant: Mutant) -> tuple[str, str]:
        """What a mutant comes to, and the test that killed it."""
        file = self.root / mutant.file.relative_to(ROOT)
        tests = nearest_tests(module_name(mutant.file), self.graph)
        whole, end = file.read_bytes(), time.monotonic() + self.seconds
        try:
            write_source(file, mutant.source())
            for files in rounds(tests):
                failed = self.first_failure(files, end - time.monotonic())
                if failed is None:
                    return NOT_KILLED_IN_TIME, ""
                if failed:
                    write_source(file, whole)
                    if not self.fails_anyway(failed):
                        return KILLED, failed
                    write_source(file, mutant.source())
        finally:
            write_source(file, whole)
        return (SURVIVED if tests else NO_TESTS), ""

    def fails_anyway(self, test: str) -> bool:
        """Whether a test fails without any mutant."""
        if test not in self._fails_anyway:
            self._fails_anyway[test] = self.first_failure([test], 600.0) != ""
        return self._fails_anyway[test]

    def first_failure(self, tests: list[str], seconds: float) -> str | None:
        """The first test that fails; empty: none does; None: they do not end in time."""
        path = os.pathsep.join((str(self.root / "src"), str(self.root)))
        environment = {**os.environ, "PYTHONPATH": path, "PYTHONDONTWRITEBYTECODE": ""}
        leave = [f"--deselect={test}" for test, fails in self._fails_anyway.items() if fails]
        command = [sys.executable, "-m", "pytest", "-x", "-rfE", "--tb=no", "--hypothesis-seed=0", *leave, *tests]
        try:
            done = subprocess.run(
                command, cwd=self.root, env=environment, capture_output=True, encoding="utf-8", errors="replace",
                timeout=max(seconds, 0.1), check=False,
            )  # fmt: skip
        except subprocess.TimeoutExpired:
            return None
        found = _FAILED.search(done.stdout)
        return found[1] if found else "" if done.returncode in (0, 5) else tests[0]


def write_source(file: Path, source: bytes) -> None:
    """Write a module; what Python has compiled of it may be as old and as long."""
    file.write_bytes(source)
    Path(cache_from_source(str(file))).unlink(missing_ok=True)


def module_name(file: Path) -> str:
    """The dotted name of a module of the sources."""
    return ".".join(file.relative_to(ROOT / "src").with_suffix("").parts).removesuffix(".__init__")


def nearest_tests(module: str, graph: grimp.ImportGraph) -> list[str]:
    """Files of tests that reach a module: those of its package first, then by the length of the way of imports."""

    def far(test: str) -> tuple[bool, int, str]:
        package = package_of(test, graph)
        chain = graph.find_shortest_chain(importer=test, imported=module) or ()
        return not (package and f"{module}.".startswith(f"{package}.")), len(chain), test

    reaching = filter(is_test, graph.find_downstream_modules(module))
    return [f"{test.replace('.', '/')}.py" for test in sorted(reaching, key=far)]


def rounds(files: list[str]) -> Iterator[list[str]]:
    """Files in rounds, few first: most mutants die in the first one."""
    count = FIRST_ROUND
    while files:
        yield files[:count]
        files, count = files[count:], 2 * count


def draw_mutants(folder: Path, count: int, rng: random.Random) -> list[Mutant]:
    """Mutants of the modules in a folder, or of one module, as many of each kind."""
    places = dict[str, list[Mutant]]()
    for file in sorted(folder.rglob("*.py")) or [folder]:
        for mutant in mutants_of(file):
            places.setdefault(mutant.kind, []).append(mutant)
    for each in places.values():
        rng.shuffle(each)
    turns = [mutant for turn in zip_longest(*(places.get(kind, []) for kind in KINDS)) for mutant in turn if mutant]
    return turns[:count]


def table(outcomes: Counter[tuple[str, str]]) -> str:
    """Kinds of changes with what they came to, and the score."""
    columns = (KILLED, SURVIVED, NOT_KILLED_IN_TIME, NO_TESTS)
    lines = [f"{'':18}" + "".join(f"{each:>20}" for each in columns)]
    for kind in (*KINDS, "all"):
        counts = [sum(outcomes[each, column] for each in KINDS if kind in (each, "all")) for column in columns]
        lines.append(f"{kind:18}" + "".join(f"{each:20}" for each in counts))
    killed = sum(outcomes[kind, KILLED] for kind in KINDS)
    return "\n".join([*lines, f"score: {killed} of {outcomes.total()}, {killed / max(outcomes.total(), 1):.0%}"])


def main() -> None:
    """Draw mutants, try them, and print a line of each and the table."""
    parser = argparse.ArgumentParser(description="How many changes of the sources the tests notice.")
    parser.add_argument("--count", type=int, default=300)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--seconds", type=float, default=300.0, help="time of one mutant")
    parser.add_argument("--under", default="", help="where to draw from, such as planning or arrays.py")
    arguments = parser.parse_args()
    drawn = draw_mutants(ROOT / "src" / "trunnion" / arguments.under, arguments.count, random.Random(arguments.seed))
    print(f"{len(drawn)} mutants, seed {arguments.seed}", flush=True)
    outcomes = Counter[tuple[str, str]]()
    with tempfile.TemporaryDirectory(prefix="trunnion-mutants-") as folder:
        trial = Trial(Path(folder), arguments.seconds)
        for mutant in drawn:
            outcome, test = trial.outcome(mutant)
            outcomes[mutant.kind, outcome] += 1
            place = f"{mutant.file.relative_to(ROOT).as_posix()}:{mutant.line}"
            before, after = (" ".join(text.split())[:60] for text in (mutant.before, mutant.after))
            print(f"{outcome}: {place}: {before} -> {after}" + (f"  ({test})" if test else ""), flush=True)
    print(table(outcomes))


if __name__ == "__main__":
    main()
