"""How fast CL files of each dialect are read: ``python benchmarks/dialects.py [POINTS]``.

The same five-axis path is written in every dialect and read in a warm process. Prints a table; exit code 1 if a
dialect is read at less than half of the points per second of an NX CLSF.
"""

import sys
import tempfile
import time
from pathlib import Path
from typing import Final

from make_cls import path
from trunnion.cl import DIALECTS, read_cl

POINTS: Final = 300_000
CHUNK: Final = 20_000
LEAST: Final = 0.5

#: Head, point and foot of a file in each dialect, as the systems write them.
FORMS: Final = {
    "clsf": (
        "TOOL PATH/A,TOOL,T\nLOAD/TOOL,2\nFEDRAT/MMPM,250.\n",
        "GOTO/%.4f,%.4f,%.4f,%.7f,%.7f,%.7f\n",
        "END-OF-PATH\n",
    ),
    "ncl": (
        "$$* Pro/CLfile  Version 8.0\nUNITS / MM\nLOADTL / 2\nMULTAX / ON\nFEDRAT / 250., MMPM\n",
        "GOTO / %.10f, %.10f, %.10f,  $\n%.10f, %.10f, %.10f\n",
        "$$-> END /\nFINI\n",
    ),
    "solidworks": (
        "UNIT/MM\nCUTTER/10.,0,5.,0,0,0,60.\nLOAD/TOOL,2\nTRNTYP/WORLD,0,0,0\nFEDRAT/250.,MMPM\n",
        "GOTO/%.6f,%.6f,%.6f,%.6f,%.6f,%.6f\n",
        "FINI\n",
    ),
    "catia": (
        "$$     CATIA APT VERSION 1.0\nMULTAX\nLOADTL/2\nFEDRAT/  250.0000,MMPM\n",
        "GOTO  / %11.5f,%11.5f,%11.5f,%9.6f,%9.6f,%9.6f\n",
        "END\n",
    ),
    "apt": (
        "PARTNO A\nUNITS/MM\nLOADTL/2\nMULTAX/ON\nFEDRAT/250.0,MMPM\n",
        "GOTO/%.6f, %.6f, %.6f, %.9f, %.9f, %.9f\n",
        "FINI\n",
    ),
}


def write(file: Path, dialect: str, points: int) -> None:
    """Write a file of so many points."""
    head, form, foot = FORMS[dialect]
    with file.open("w", encoding="ascii") as out:
        out.write(head)
        for start in range(0, points, CHUNK):
            rows = path(start, min(start + CHUNK, points))
            out.write((form * len(rows)) % tuple(rows.ravel().tolist()))
        out.write(foot)


def rate(file: Path, points: int) -> float:
    """Points per second of the best of three readings."""
    best = 0.0
    for _ in range(3):
        began = time.process_time()
        toolpath = read_cl(file)
        best = max(best, points / (time.process_time() - began))
        assert sum(len(operation.moves) for operation in toolpath.operations) == points
        assert toolpath.dialect == file.stem
    return best


def main() -> int:
    """Print the table; 1 if a dialect is too slow."""
    points = int(sys.argv[1]) if len(sys.argv) > 1 else POINTS
    rates = {}
    with tempfile.TemporaryDirectory() as folder:
        for dialect in DIALECTS:
            file = Path(folder) / f"{dialect}.txt"
            write(file, dialect, points)
            rates[dialect] = rate(file, points)
            share = rates[dialect] / rates["clsf"]
            size = file.stat().st_size / 1e6
            print(f"{dialect:12}{size:8.1f} MB{rates[dialect] / 1e6:8.2f} million points/s{share:8.2f} of clsf")
    return int(min(rates.values()) < LEAST * rates["clsf"])


if __name__ == "__main__":
    sys.exit(main())
