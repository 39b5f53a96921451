"""What share of harmful edits is reported, in six languages: ``python -m benchmarks.recall_proof [--judge …]``.

Is started from the project's folder. Edits golden programs and those of ``tests/support/recall_proof``, one place at a
time, and asks a judge: the ``proof`` against the CL file, ``diff`` with the sound program, ``convert`` to a CL file,
or ``simulate``. ``--part K/N`` judges each N-th edit, from the K-th; ``--results FILE`` adds what was found to a file,
from which ``--report`` prints the tables, and ``--write`` puts them into ``docs/checks.md``. Exit code 1 if a harmful
edit is not reported, or a sound one is.
"""

import argparse
import json
import random
import sys
import tempfile
import time
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TypeAlias

from tests.support.locations import DOCS
from tests.support.recall_proof.bases import MACHINES, Base, bases
from tests.support.recall_proof.edits import Edit, harmful
from tests.support.recall_proof.judges import convert, diff, is_convertible, proof
from tests.support.recall_proof.removal import removal_bases, removal_edits, simulate
from tests.support.recall_proof.sound_edits import sound

PAGE = DOCS / "checks.md"
BEGIN, END = "<!-- recall: made by benchmarks/recall_proof.py -->", "<!-- end of recall -->"
JUDGES = {"proof": proof, "diff": diff, "convert": convert, "simulate": simulate}
TITLES = {
    "proof": "Proof against the CL file",
    "diff": "`diff` with the sound program",
    "convert": "`convert` to a CL file",
    "simulate": "`simulate`",
}


#: Judge, language, program, kind of edit, whether it harms, its line and the text there.
Key: TypeAlias = tuple[str, str, str, str, bool, int, str]


@dataclass(frozen=True)
class Outcome:
    """What became of an edit."""

    judge: str
    family: str
    base: str
    kind: str
    harms: bool
    line: int
    text: str
    reported: bool
    by: str

    @property
    def key(self) -> Key:
        """What it is an outcome of."""
        return self.judge, self.family, self.base, self.kind, self.harms, self.line, self.text

    @property
    def is_right(self) -> bool:
        """Whether it is reported if it harms, and only then."""
        return self.reported is self.harms


def chosen(edits: Iterable[Edit], each: int, seed: str) -> Iterator[Edit]:
    """Yield some edits of each kind."""
    by_kind = defaultdict[str, list[Edit]](list)
    for edit in edits:
        by_kind[edit.kind].append(edit)
    for kind, some in by_kind.items():
        yield from random.Random(f"{seed} {kind}").sample(some, min(each, len(some)))


def edits_of(base: Base, arguments: argparse.Namespace) -> Iterator[tuple[bool, Edit]]:
    """Yield the edits of a program, and whether they harm."""
    seed = f"{arguments.seed} {base.family} {base.name}"
    is_cut = arguments.judge == "simulate"
    harms = removal_edits(base) if is_cut else harmful(base.text, base.family, base.tolerance)
    # The proof refuses points that nothing asks for.
    left_out = {"a line in two"} if arguments.judge in ("proof", "convert") else set()
    yield from ((True, edit) for edit in chosen(harms, arguments.each, seed))
    sounds = (edit for edit in sound(base.text, base.family) if edit.kind not in left_out)
    yield from ((False, edit) for edit in chosen(sounds, arguments.each, seed))


def outcomes(arguments: argparse.Namespace, known: set[Key], folder: Path) -> Iterator[Outcome]:
    """Judge the edits of a part that nobody has judged yet."""
    part, parts = (int(number) for number in arguments.part.split("/"))
    count, judge = 0, JUDGES[arguments.judge]
    mutant = folder / "mutant.nc"
    for base in (removal_bases if arguments.judge == "simulate" else bases)(folder, arguments.family):
        if arguments.base not in (None, base.name):
            continue
        if arguments.judge == "convert" and not is_convertible(base, folder):
            print(f"left out, as its CL file is not what it does: {base.family} {base.name}", file=sys.stderr)
            continue
        for harms, edit in edits_of(base, arguments):
            count += 1
            if count % parts != part % parts or arguments.kind not in (None, edit.kind):
                continue
            lines = edit.text.splitlines()
            text = lines[min(edit.line, len(lines)) - 1]
            if (arguments.judge, base.family, base.name, edit.kind, harms, edit.line, text) in known:
                continue
            program = mutant.with_suffix(".h") if base.family == "Heidenhain" else mutant
            program.write_bytes(edit.text.encode())
            told = judge(base, program)
            yield Outcome(
                arguments.judge, base.family, base.name, edit.kind, harms, edit.line, text, told.reported, told.by
            )


def kept(path: Path) -> list[Outcome]:
    """Return what earlier parts have found, each edit once."""
    lines = path.read_text(encoding="utf-8").splitlines() if path.exists() else []
    found = [Outcome(**json.loads(line)) for line in lines]
    return list({each.key: each for each in found}.values())


def run(arguments: argparse.Namespace, known: list[Outcome]) -> list[Outcome]:
    """Return the outcomes of a part, which are added to the results."""
    begin, found = time.monotonic(), list[Outcome]()
    with tempfile.TemporaryDirectory() as name:
        for each in outcomes(arguments, {other.key for other in known}, Path(name)):
            found.append(each)
            if arguments.results:
                with arguments.results.open("a", encoding="utf-8") as results:
                    results.write(json.dumps(asdict(each)) + "\n")
            if time.monotonic() - begin > arguments.seconds:
                print("stopped: run it again to go on", file=sys.stderr)
                break
    return found


def report(found: list[Outcome]) -> list[str]:
    """Return the tables of all judges that were asked."""
    lines = list[str]()
    for judge, title in TITLES.items():
        of_judge = [each for each in found if each.judge == judge]
        if of_judge:
            lines += [f"**{title}**", "", *summary(of_judge), "", *by_kind(of_judge), ""]
    return lines


def summary(found: list[Outcome]) -> list[str]:
    """Return how many were reported, by language."""
    lines = ["| | programs | harmful edits, of kinds | reported | not reported | sound variants | false alarms |"]
    lines.append("| --- " * 7 + "|")
    for family in (*MACHINES, "together"):
        some = [each for each in found if family in (each.family, "together")]
        harms, sounds = [each for each in some if each.harms], [each for each in some if not each.harms]
        seen = sum(each.reported for each in harms)
        kinds = len({each.kind for each in harms})
        programs = len({(each.family, each.base) for each in some})
        alarms = sum(each.reported for each in sounds)
        cells = (programs, f"{len(harms)}, {kinds}", seen, len(harms) - seen, len(sounds), alarms)
        if some:
            lines.append(f"| {family} | " + " | ".join(map(str, cells)) + " |")
    return lines


def by_kind(found: list[Outcome]) -> list[str]:
    """Return how many of each kind were reported, and by name what was judged wrongly."""
    lines = list[str]()
    for harms, title in ((True, "harmful edit"), (False, "sound variant")):
        put = Counter((each.kind, each.family) for each in found if each.harms is harms)
        right = Counter((each.kind, each.family) for each in found if each.harms is harms and each.is_right)
        if not put:
            continue
        lines += [f"| {title} | " + " | ".join(MACHINES) + " |", "| --- " * (len(MACHINES) + 1) + "|"]
        for kind in sorted({kind for kind, _ in put}):
            cells = [(right[kind, family], put[kind, family]) for family in MACHINES]
            lines.append(f"| {kind} | " + " | ".join(f"{a} of {b}" if b else "–" for a, b in cells) + " |")
        lines.append("")
    wrong = [each for each in found if not each.is_right]
    for each in sorted(wrong, key=lambda each: (not each.harms, each.family, each.kind, each.base, each.line)):
        what = "not reported" if each.harms else "false alarm"
        lines.append(f"- {what}: {each.family}, {each.kind}, `{each.base}`, line {each.line}: `{each.text}`")
    return lines


def write(lines: list[str]) -> None:
    """Put the tables into the page between its marks."""
    before, _, rest = PAGE.read_text(encoding="utf-8").partition(BEGIN)
    text = "\n".join([BEGIN, "", *lines, END])
    PAGE.write_text(before + text + rest.partition(END)[2], encoding="utf-8", newline="\n")


def main() -> int:
    """Run from the command line."""
    parser = argparse.ArgumentParser(description="Measure what share of harmful edits is reported.")
    parser.add_argument("--judge", choices=TITLES, default="proof", help="who is asked (default: proof)")
    parser.add_argument("--each", type=int, default=1, help="edits of a kind in a program, at most (default: 1)")
    parser.add_argument("--part", default="1/1", metavar="K/N", help="each N-th edit, from the K-th")
    parser.add_argument("--seconds", type=float, default=1e9, help="stop after that; the next run goes on")
    parser.add_argument("--results", type=Path, help="file to which outcomes are added; what is in it is not run again")
    parser.add_argument("--again", action="store_true", help="judge anew what was judged wrongly")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--family", choices=MACHINES, help="of one language only")
    parser.add_argument("--base", help="of one program only")
    parser.add_argument("--kind", help="of one kind only")
    parser.add_argument("--report", action="store_true", help="only report what is in the results")
    parser.add_argument("--write", action="store_true", help="put the tables into docs/checks.md")
    arguments = parser.parse_args()
    found = kept(arguments.results) if arguments.results else []
    if arguments.again:
        found = [each for each in found if each.is_right or each.judge != arguments.judge]
        arguments.results.write_text("".join(json.dumps(asdict(each)) + "\n" for each in found), encoding="utf-8")
    if not arguments.report:
        found += run(arguments, found)
    lines = report(found)
    print("\n".join(lines))
    if arguments.write:
        write(lines)
    return 0 if all(each.is_right for each in found) else 1


if __name__ == "__main__":
    sys.exit(main())
