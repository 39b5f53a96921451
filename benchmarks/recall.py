"""Which defects the simulation finds: ``python -m benchmarks.recall [--ribs] [IMPELLER.ngc]``.

Is started from the project's folder. Puts gouges of known depths and other defects into sound programs
(``tests/support/recall.py``), one at a time, simulates each, and writes the tables of ``docs/simulation.md``; with
``--ribs`` only that of thin ribs, whose design is made of boxes (``tests/support/recall_ribs.py``). Exit code 1 if a
gouge from half a cell deep or another defect is not found in the right block, or if anything is told that was not put
in.
"""

import argparse
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from tests.support.recall import Defect, Outcome, Reference, Sound, cut_depths, gouges, outcome, plate, simulated
from tests.support.recall_ribs import rib_gouges, ribs
from tests.support.recall_setups import (
    golden_programs,
    impeller,
    rapids,
    setups_of_contour,
    setups_of_plate,
    sound_contour_setups,
    standing,
    wrong_tools,
)

PAGE = Path(__file__).parents[1] / "docs" / "simulation.md"
BEGIN, END = "<!-- recall: made by benchmarks/recall.py -->", "<!-- end of recall -->"
RIBS_BEGIN, RIBS_END = "<!-- recall of ribs: made by benchmarks/recall.py -->", "<!-- end of recall of ribs -->"
HEAD = (
    "defect",
    "cells deep",
    "put in",
    "found",
    "in the right block",
    "told depth / real, smallest and median",
    "invented",
)

#: Gouges of each kind and depth that are put into a program, at most.
PLACES = {"YL569 contour": 4, "YL569 hub": 2, "YL569 blade": 2, "LinuxCNC impeller": 2}


def defects(sound: Sound, reference: Reference, folder: Path) -> Iterator[Defect]:
    """Yield all defects of a program."""
    yield from gouges(sound, reference, PLACES.get(sound.name, 1))
    yield from wrong_tools(sound)
    yield from rapids(sound, cut_depths(sound, folder), 4)
    yield from standing(sound, 4)
    if sound.is_cl:
        yield from setups_of_plate(sound)
    if sound.name == "YL569 contour":
        yield from setups_of_contour(sound)


def table(outcomes: list[Outcome]) -> list[str]:
    """Return the rows of the table."""
    rows = ["| " + " | ".join(HEAD) + " |", "| --- |" + " ---: |" * (len(HEAD) - 1)]
    keys = list(dict.fromkeys((each.defect.kind, str(each.defect.cells)) for each in outcomes))
    keys.sort(key=lambda key: (not key[0].startswith("gouge"), key[0], float(key[1])))
    for key in [*keys, None]:
        some = [each for each in outcomes if key in (None, (each.defect.kind, str(each.defect.cells)))]
        ratios = [each.depth / each.defect.mm for each in some if each.defect.mm and each.found and key]
        told = f"{min(ratios):.2f}, {np.median(ratios):.2f}" if ratios else ""
        kind, cells = key or ("all", "nan")
        cells = "" if cells == "nan" else cells
        counts = len(some), sum(each.found for each in some), sum(each.right for each in some)
        invented = sum(len(each.invented) for each in some)
        rows.append("| " + " | ".join((kind, cells, *map(str, counts), told, str(invented))) + " |")
    return rows


def recall_of_ribs() -> bool:
    """Write the table of thin ribs; whether all of them are found."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        sound, reference = ribs(folder)
        found = simulated(sound, folder, reference.mesh)
        outcomes = [outcome(defect, reference, folder) for defect in rib_gouges(sound)]
    told = f"Made by `python -m benchmarks.recall --ribs`. Findings in the sound program: {len(found.findings)}."
    write_table([RIBS_BEGIN, "", told, "", *table(outcomes), "", RIBS_END])
    return found.passed and not any(wrong(each) for each in outcomes)


def write_table(lines: list[str]) -> None:
    """Print a table, and put it into the page between its marks."""
    text = "\n".join(lines)
    print(text)
    before, _, rest = PAGE.read_text(encoding="utf-8").partition(lines[0])
    PAGE.write_text(before + text + rest.partition(lines[-1])[2], encoding="utf-8", newline="\n")


def wrong(each: Outcome) -> bool:
    """Whether a defect that must be found is not, or is told wrongly."""
    shallow = each.defect.cells < 0.5
    return bool(each.invented) or (not shallow and not (each.found and each.right))


def main() -> int:
    """Run from the command line."""
    parser = argparse.ArgumentParser(description="Measure which defects the simulation finds.")
    parser.add_argument("impeller", nargs="?", type=Path, help="impeller-7bl-xyzac.ngc of LinuxCNC; else left out")
    parser.add_argument("--ribs", action="store_true", help="only the thin ribs")
    arguments = parser.parse_args()
    sound_ribs = recall_of_ribs()
    if arguments.ribs:
        return 0 if sound_ribs else 1
    begin, outcomes, alarms = time.perf_counter(), list[Outcome](), list[str]()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        sounds = [*golden_programs(folder), plate("yl569", 0.5), plate("dmu65", 0.5)]
        if arguments.impeller:
            sounds.append(impeller(arguments.impeller.read_text(encoding="utf-8"), folder))
        for sound in sounds:
            reference = Reference.of(sound, folder)
            others = list(sound_contour_setups(sound)) if sound.name == "YL569 contour" else []
            for one in (sound, *others):
                design = reference if one is sound else Reference.of(one, folder)  # its stock is another
                found = simulated(one, folder, design.mesh)
                alarms += [f"{one.name}: {each.kind} in line {each.line}" for each in found.findings]
                if not found.passed:
                    alarms.append(f"{one.name} does not pass")
            for defect in defects(sound, reference, folder):
                one_outcome = outcome(defect, reference, folder)
                outcomes.append(one_outcome)
                if wrong(one_outcome):
                    found_text = f"found {one_outcome.found}, right {one_outcome.right}, {one_outcome.depth:.3f} mm"
                    print(
                        f"{sound.name}: {defect.kind} {defect.cells}, lines {defect.right}: {found_text}",
                        one_outcome.invented[:3],
                    )
            print(f"{sound.name}: {len(outcomes)} defects so far, {time.perf_counter() - begin:.0f} s", flush=True)
    told = (
        f"{len(sounds)} sound programs: {', '.join(sound.name for sound in sounds)}; findings in them: {len(alarms)}."
    )
    print("\n".join(alarms))
    command = "python -m benchmarks.recall" + (" impeller-7bl-xyzac.ngc" if arguments.impeller else "")
    write_table([BEGIN, "", f"Made by `{command}`. {told}", "", *table(outcomes), "", END])
    return 1 if alarms or not sound_ribs or any(wrong(each) for each in outcomes) else 0


if __name__ == "__main__":
    sys.exit(main())
