"""What share of harmful edits the proof reports, in six languages: ``python -m benchmarks.recall_proof``.

Is started from the project's folder. Posts four CL files for a machine of each language, edits the programs (rules in
``tests/support/recall_proof``), verifies each against its CL file, and prints a table by kind and language, and by name
what was not reported and what was refused although it is sound. ``--each N`` edits of a kind in a program, at most.
Exit code 1 if there is any.
"""

import argparse
import random
import sys
import tempfile
from collections import Counter, defaultdict
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

from tests.support.locations import ROOT
from tests.support.recall_proof.edits import Edit, harmful, sound

import trunnion

MACHINES = {
    "Sinumerik": "yl569", "Heidenhain": "dmu65", "Fanuc": "matsuura_mx330", "Haas": "haas_umc750",
    "LinuxCNC": "xyzac_trt", "Fidia": "hs664rt",
}  # fmt: skip
CL_FILES = sorted((ROOT / "tests" / "data" / "cases").glob("*.cls"))


def programs(folder: Path) -> Iterator[tuple[str, Path, Path]]:
    """Yield language, program and CL file; what a control does not take is left out."""
    for family, machine in MACHINES.items():
        for cl in CL_FILES:
            program = folder / f"{machine}_{cl.stem}.nc"
            try:
                trunnion.post(cl, machine=machine, output=program)
            except trunnion.TrunnionError as refused:
                print(f"{cl.name} is not for {machine}: {str(refused).splitlines()[0]}", file=sys.stderr)
                continue
            yield family, program, cl


def chosen(edits: Iterator[Edit], each: int, rng: random.Random) -> list[Edit]:
    """Return some edits of each kind."""
    by_kind = defaultdict[str, list[Edit]](list)
    for edit in edits:
        by_kind[edit.kind].append(edit)
    return [edit for found in by_kind.values() for edit in rng.sample(found, min(each, len(found)))]


def is_reported(machine: str, cl: Path, name: str, text: str) -> bool:
    """Whether the proof of a program fails."""
    with tempfile.TemporaryDirectory() as folder:
        program = Path(folder, name)
        program.write_bytes(text.encode())
        try:
            return not trunnion.verify(program, machine=machine, cl=cl).passed
        except trunnion.TrunnionError:
            return True


def judged(work: tuple[str, Path, str, bool, Edit]) -> tuple[str, bool, Edit, bool, str]:
    """Judge one edit."""
    family, cl, name, harms, edit = work
    return family, harms, edit, is_reported(MACHINES[family], cl, name, edit.text), name


def main() -> int:
    """Run from the command line."""
    parser = argparse.ArgumentParser(description="Measure what share of harmful edits the proof reports.")
    parser.add_argument("--each", type=int, default=10, help="edits of a kind in a program, at most (default: 10)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--family", choices=MACHINES, help="of one language only")
    parser.add_argument("--show", type=int, default=3, help="edits of each kind that are shown (default: 3)")
    arguments = parser.parse_args()
    rng, work = random.Random(arguments.seed), list[tuple[str, Path, str, bool, Edit]]()
    with tempfile.TemporaryDirectory() as folder:
        for family, program, cl in programs(Path(folder)):
            if arguments.family in (None, family):
                text = program.read_text(encoding="utf-8")
                for harms, edits in ((True, harmful(text, family)), (False, sound(text, family))):
                    work += [(family, cl, program.name, harms, e) for e in chosen(edits, arguments.each, rng)]
        with ProcessPoolExecutor(arguments.workers) as pool:
            found = list(pool.map(judged, work, chunksize=16))
    return report(found, arguments.show)


def report(found: list[tuple[str, bool, Edit, bool, str]], shown: int) -> int:
    """Print the table and what went wrong."""
    put, seen = Counter[tuple[bool, str, str]](), Counter[tuple[bool, str, str]]()
    wrong = defaultdict[tuple[bool, str, str], list[str]](list)
    for family, harms, edit, reported, name in found:
        key = (harms, edit.kind, family)
        put[key] += 1
        seen[key] += reported
        if reported is not harms:
            line = edit.text.splitlines()[min(edit.line, len(edit.text.splitlines())) - 1]
            wrong[key].append(f"{name}:{edit.line}: {line}")
    for harms, title in ((True, "edit that harms"), (False, "edit that changes nothing")):
        kinds = sorted({kind for is_harm, kind, _ in put if is_harm is harms})
        print(f"\n| {title} | " + " | ".join(MACHINES) + " |\n" + "| --- " * (len(MACHINES) + 1) + "|")
        for kind in kinds:
            cells = [(seen[harms, kind, f], put[harms, kind, f]) for f in MACHINES]
            print(f"| {kind} | " + " | ".join(f"{a} of {b}" if b else "–" for a, b in cells) + " |")
    for harms, what in ((True, "harmful edits reported"), (False, "sound edits reported")):
        total = sum(n for (is_harm, *_), n in put.items() if is_harm is harms)
        print(f"\n{sum(n for (is_harm, *_), n in seen.items() if is_harm is harms)} of {total} {what}")
    for (harms, kind, family), places in sorted(wrong.items()):
        print(f"{'not reported' if harms else 'refused'}: {family}, {kind}: {len(places)}", *places[:shown], sep="\n  ")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
