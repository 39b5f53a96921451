"""The reader that one writes in an afternoon: ``python benchmarks/naive_reader.py FILE.mpf [FILE.bin]``.

Line by line, no NumPy, nothing clever and nothing clumsy: a regular expression finds the words of a block, a
dictionary keeps what is modal, and every block with a position while TCP is on becomes a tip and a tool axis of the
YL569. It knows the words of dense motion and no others: no frames, no circles, no cycles, no jumps, no findings.

Prints the seconds and the processor seconds that reading took. With FILE.bin it writes eight doubles a row: the line, 0
for G0 or 1 for G1, X Y Z of the tip and i j k of the tool axis.
"""

import math
import re
import sys
import time
from array import array
from pathlib import Path
from typing import TextIO

WORD = re.compile(r"([A-Z])=?(-?\d+\.?\d*|-?\.\d+)")
POSITION = frozenset("XYZBC")


def read(lines: TextIO) -> "array[float]":
    """Run a program: eight numbers a row."""
    rows = array("d")
    now = {"X": 0.0, "Y": 0.0, "Z": 0.0, "B": 0.0, "C": 0.0, "F": math.nan, "G": 0.0}
    tcp = False
    for number, line in enumerate(lines, 1):
        block = line.partition(";")[0]
        if "TRAORI" in block:
            tcp = True
        elif "TRAFOOF" in block:
            tcp = False
        if "SUPA" in block or "(" in block or "_" in block:
            continue
        moves = False
        for letter, text in WORD.findall(block):
            value = float(text)
            if letter == "G" and value > 1.0:
                continue
            now[letter] = value
            moves = moves or letter in POSITION
        if moves and tcp:
            b, c = math.radians(now["B"]), math.radians(now["C"])
            sin_b = math.sin(b)
            rows.extend((number, now["G"], now["X"], now["Y"], now["Z"]))
            rows.extend((sin_b * math.cos(c), sin_b * math.sin(c), math.cos(b)))
    return rows


def main() -> int:
    """Run from the command line."""
    if len(sys.argv) not in (2, 3):
        print("usage: naive_reader.py FILE.mpf [FILE.bin]", file=sys.stderr)
        return 2
    with Path(sys.argv[1]).open(encoding="utf-8") as lines:
        start, start_cpu = time.perf_counter(), time.process_time()
        rows = read(lines)
        print(time.perf_counter() - start, time.process_time() - start_cpu)
    if len(sys.argv) == 3:
        with Path(sys.argv[2]).open("wb") as out:
            rows.tofile(out)
    return 0


if __name__ == "__main__":
    sys.exit(main())
