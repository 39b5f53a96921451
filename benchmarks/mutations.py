"""What share of the faults in programs is caught: ``python -m benchmarks.mutations``, from the project's folder.

Puts every fault of ``tests/support/mutations.py`` into every golden program, at every place where it can be and one at
a time, and each digit becomes each of the nine others. Prints the table of ``docs/checks.md`` and, by reason, what is
not caught. ``--digits N`` changes N digits of each program instead of all. Exit code 1 if a fault that changes the work
is not reported, or is reported at another block.
"""

import argparse
import random
import sys
import tempfile
from collections import Counter
from pathlib import Path

from tests.support.mutations import CASES, REASONS, Tally, mutations, sweep

#: Examples that are shown of each reason.
SHOWN = 6

HEAD = ("fault", "put in", "nothing changes", "caught of the others", "at the block", "next to it", "where it shows")


def merged(tables: list[dict[str, Tally]]) -> dict[str, Tally]:
    """Return the tallies of all programs, by kind."""
    together: dict[str, Tally] = {}
    for table in tables:
        for kind, tally in table.items():
            total = together.setdefault(kind, Tally())
            total.outcomes += tally.outcomes
            total.near += tally.near
            total.outside += tally.outside
            for what, texts in tally.not_caught.items():
                total.not_caught.setdefault(what, []).extend(texts)
    return together


def row(kind: str, tally: Tally) -> tuple[str, ...]:
    """Return a row of the table."""
    put, same, caught = tally.outcomes.total(), tally.outcomes["SAME"], tally.outcomes["CAUGHT"]
    share = f"{100.0 * caught / (put - same):.1f} %".replace("100.0", "100") if put > same else "–"
    near = (str(tally.near[what]) for what in ("BLOCK", "NEXT", "SHOWS"))
    return kind, str(put), str(same), f"{caught} of {put - same}, {share}", *near


def whole(tallies: list[Tally]) -> Tally:
    """Return the sum of tallies."""
    return Tally(
        sum((tally.outcomes for tally in tallies), Counter()),
        sum((tally.near for tally in tallies), Counter()),
        sum((tally.outside for tally in tallies), Counter()),
    )


def main() -> int:
    """Run from the command line."""
    parser = argparse.ArgumentParser(description="Measure what share of the faults in programs is caught.")
    parser.add_argument("--digits", type=int, help="digits changed in each program (default: each to each other)")
    arguments = parser.parse_args()
    tables = []
    with tempfile.TemporaryDirectory() as folder:
        for name in CASES:
            faults = mutations(name, arguments.digits, random.Random(569))
            tables.append(sweep(name, faults, Path(folder)))
    for name, table in zip(CASES, tables, strict=True):
        print(f"{name}: {', '.join(row('', whole(list(table.values())))[1:4])}", file=sys.stderr)
    together = merged(tables)
    print("| " + " | ".join(HEAD) + " |")
    print("| --- " * len(HEAD) + "|")
    for kind, tally in together.items():
        print("| " + " | ".join(row(kind, tally)) + " |")
    total = whole(list(together.values()))
    print("| " + " | ".join(row("together", total)) + " |")
    print("\n| not caught | times | why |\n| --- | --- | --- |")
    for what, count in total.outside.most_common():
        print(f"| {what} | {count} | {REASONS.get(what, '')} |")
    for what in total.outside:
        texts = [text for tally in together.values() for text in tally.not_caught.get(what, [])]
        print(f"\n{what}: {len(texts)}", *texts[:SHOWN], sep="\n  ", file=sys.stderr)
    return 1 if set(total.outcomes) - {"CAUGHT", "SAME", "OUTSIDE"} else 0


if __name__ == "__main__":
    sys.exit(main())
