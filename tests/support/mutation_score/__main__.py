"""How many changes of the sources the tests notice: ``python -m tests.support.mutation_score --count 300 --seed 1``.

Mutants are drawn at random from all modules, as many of each kind. For each, the tests run that may run its line,
nearest first, until one fails or hangs. A mutant survives where all have passed; where the processor seconds end
before, it is not killed in time. A test that fails without the mutant too kills nothing. A mutant that no test notices
may be one that changes nothing. Wants ``os.fork``.
"""

import argparse
import os
import random
import shutil
import tempfile
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import cache_from_source
from math import sqrt
from pathlib import Path

from tests.support.durations import SLOW, kept
from tests.support.locations import ROOT
from tests.support.mutation_score.mutants import KINDS, Mutant, draw_mutants
from tests.support.mutation_score.reach import Sources, rounds
from tests.support.mutation_score.trial import Watch, compile_kernels, first_failure, prepare

#: What a mutant comes to.
KILLED, SURVIVED, NOT_IN_TIME, NO_TESTS = "killed", "survived", "not killed in time", "no tests"

#: Processor seconds besides, where kernels are compiled.
COMPILING = 20.0


class Trial:
    """A copy of a tree, in which mutants are tried.

    folder   has the copy, with the machine code of its kernels; it is made once
    seconds  of a processor, for each mutant; a test that takes half of them, and without it less than a third, hangs
    """

    def __init__(self, tree: Path, folder: Path, seconds: float) -> None:
        prepare()
        self.root, self.seconds = folder / "tree", seconds
        if not self.root.exists():
            ignored = shutil.ignore_patterns(".*", "__pycache__", "build", "dist")
            shutil.copytree(tree, self.root, ignore=ignored, symlinks=True)
            compile_kernels(self.root)
        self.root = self.root.resolve()
        self.sources = Sources(self.root, [file for file, taken in kept().items() if taken > SLOW])
        self.fails_anyway, self.excluded = dict[str, bool](), set[str]()

    def outcome(self, mutant: Mutant) -> tuple[str, str]:
        """What a mutant comes to, and the test that killed it."""
        name = mutant.file.relative_to(self.root).as_posix()
        more = COMPILING if name in self.sources.compiled else 0.0
        tests, left = self.sources.tests_of(name, mutant.line), self.seconds + more
        for part in rounds(tests):
            while rest := [test for test in part if self.excluded.isdisjoint((test, test.partition("::")[0]))]:
                with as_it_was(mutant.file):
                    mutant.file.write_bytes(mutant.source())
                    failed, spent = first_failure(self.root, rest, Watch(0.5 * self.seconds + more), left)
                left -= spent
                if failed and self.kills(failed):
                    return KILLED, failed
                if failed is None or left <= 0.0:
                    return NOT_IN_TIME, ""
                if not failed:
                    break
        return (SURVIVED if tests else NO_TESTS), ""

    def kills(self, test: str) -> bool:
        """Whether a test passes without any mutant; else it, or all of its module, is left out from now on."""
        if test not in self.fails_anyway:
            self.fails_anyway[test] = first_failure(self.root, [test], Watch(self.seconds / 3.0), 300.0)[0] != ""
        if self.fails_anyway[test]:
            self.excluded.add(test.partition("[")[0])
        return not self.fails_anyway[test]


@contextmanager
def as_it_was(file: Path) -> Iterator[None]:
    """Let a module change meanwhile; Numba looks at its time, and what Python has compiled may be as old as it."""
    source, time, compiled = file.read_bytes(), file.stat().st_mtime_ns, Path(cache_from_source(str(file)))
    compiled.unlink(missing_ok=True)
    try:
        yield
    finally:
        file.write_bytes(source)
        os.utime(file, ns=(time, time))
        compiled.unlink(missing_ok=True)


def table(outcomes: Counter[tuple[str, str]]) -> str:
    """Kinds of changes with what they came to, and the score with its interval of 95 % (Wilson)."""
    columns = (KILLED, SURVIVED, NOT_IN_TIME, NO_TESTS)
    lines = [f"{'':18}" + "".join(f"{each:>20}" for each in columns)]
    for kind in (*KINDS, "all"):
        counts = [sum(outcomes[each, column] for each in KINDS if kind in (each, "all")) for column in columns]
        lines.append(f"{kind:18}" + "".join(f"{each:20}" for each in counts))
    count, z = max(outcomes.total(), 1), 1.96
    score = sum(outcomes[kind, KILLED] for kind in KINDS) / count
    middle, half = score + z * z / (2 * count), z * sqrt(score * (1.0 - score) / count + (0.5 * z / count) ** 2)
    low, high = ((middle + side * half) / (1.0 + z * z / count) for side in (-1, 1))
    return "\n".join([*lines, f"score: {score:.0%} of {count}, {low:.0%} to {high:.0%} with 95 %"])


def main() -> None:
    """Draw mutants, try them, and print a line of each and the table."""
    parser = argparse.ArgumentParser(description="How many changes of the sources the tests notice.")
    parser.add_argument("--count", type=int, default=300)
    parser.add_argument("--skip", type=int, default=0, help="the first of these that another run has tried")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--seconds", type=float, default=20.0, help="processor seconds of one mutant")
    parser.add_argument("--under", default="", help="where to draw from, such as planning or arrays.py")
    parser.add_argument("--tree", type=Path, default=ROOT, help="the checkout that is judged")
    parser.add_argument("--work", type=Path, help="a folder that keeps the copy and its machine code")
    arguments = parser.parse_args()
    outcomes = Counter[tuple[str, str]]()
    with tempfile.TemporaryDirectory(prefix="trunnion-mutants-") as folder:
        trial = Trial(arguments.tree, (arguments.work or Path(folder)).resolve(), arguments.seconds)
        under = trial.root / "src" / "trunnion" / arguments.under
        drawn = draw_mutants(under, arguments.count, random.Random(arguments.seed))
        print(f"{len(drawn)} mutants, seed {arguments.seed}", flush=True)
        for mutant in drawn[arguments.skip :]:
            outcome, test = trial.outcome(mutant)
            outcomes[mutant.kind, outcome] += 1
            place = f"{mutant.file.relative_to(trial.root).as_posix()}:{mutant.line}"
            before, after = (" ".join(text.split())[:60] for text in (mutant.before, mutant.after))
            print(f"{outcome}: {place}: {before} -> {after}" + (f"  ({test})" if test else ""), flush=True)
    print(table(outcomes))


if __name__ == "__main__":
    main()
