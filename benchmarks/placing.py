"""Where a path of any length may sit: ``python benchmarks/placing.py [POINTS] [MACHINE …]``.

Reads and plans a CL file of ``make_cls.py``, and places it: the best place over 72 turns and those around the best one,
and the region there. Prints the table of docs/placing.md. Kernels are compiled, and warm, before anything is measured.
"""

import argparse
import tempfile
import time
from pathlib import Path

import make_cls
import trunnion
from trunnion.jobs.place.placing import place


def main() -> None:
    """Place a path on some machines."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("points", nargs="?", type=int, default=1_000_000, metavar="POINTS", help="by default a million")
    parser.add_argument("machines", nargs="*", metavar="MACHINE", help="names; by default three kinds of machines")
    asked = parser.parse_args()
    points, names = asked.points, asked.machines or ["yl569", "generic_head_head_ca", "generic_head_table_bc"]
    with tempfile.TemporaryDirectory() as folder:
        few, many = Path(folder) / "few.cls", Path(folder) / "many.cls"
        for file, count in ((few, 500), (many, points)):
            with file.open("w", encoding="ascii", newline="") as out:
                make_cls.write(count, out)
        began = time.perf_counter()
        trunnion.read_cl(many)
        print(f"reading {points} points: {time.perf_counter() - began:.1f} s")
        for name in names:
            place(few, machine=name, tool_length=100.0)
            began, worked = time.perf_counter(), time.process_time()
            found = place(many, machine=name, tool_length=100.0)
            assert found.region is not None
            seconds, work = time.perf_counter() - began, time.process_time() - worked
            told = f"{seconds:6.1f} s, {work:.1f} s of processor time"
            print(f"{name:24s} {told}; margin {found.margin_mm:.3f} mm, {len(found.turns)} turns")


if __name__ == "__main__":
    main()
