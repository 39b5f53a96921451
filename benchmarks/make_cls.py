"""Make a CL file of any length for the benchmarks: ``python benchmarks/make_cls.py N FILE``.

One five-axis finishing operation as NX writes it, N points, the same bytes on every run. The tip goes round and round a
part about the size of a fist while radius and height drift; the tool axis turns with it and nods between 6 and 94
degrees. On the YL569 that is B = acos(k) inside its travel and C = atan2(j, i) winding hundreds of times. The tip
stays within 120 mm of the zero point, so that no slide comes near its limits however the table stands.

Coordinates have six decimals, vectors nine: a million points make about 73 MB. Neighbouring points differ in the
printed digits, so that every point makes a block.
"""

import argparse
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import TextIO

import numpy as np
from numpy.typing import NDArray

HEAD = """\
TOOL PATH/THROUGHPUT,TOOL,UGT0203_004
TLDATA/MILL,10.0000,5.0000,70.0000,0.0000,0.0000
MSYS/0.0000,0.0000,0.0000,1.0000000,0.0000000,0.0000000,0.0000000,1.0000000,0.0000000
$$ centerline data
INTOL/0.030000
OUTTOL/0.030000
PAINT/PATH
PAINT/SPEED,10
LOAD/TOOL,2,ADJUST,2
SPINDL/RPM,2500.0000,CLW
"""
RAPID = "PAINT/COLOR,186\nRAPID\n"
ENGAGE = "PAINT/COLOR,42\nFEDRAT/MMPM,250.0000\n"
CUT = "PAINT/COLOR,31\n"
RETRACT = "PAINT/COLOR,37\n"
FOOT = "PAINT/SPEED,10\nPAINT/TOOL,NOMORE\nEND-OF-PATH\n"

GOTO = "GOTO/%.6f,%.6f,%.6f,%.9f,%.9f,%.9f\n"
CHUNK = 20_000
LINK = 9  # points of the engage and of the retract move


def path(start: int, stop: int) -> NDArray[np.float64]:
    """Points ``start`` to ``stop`` of the endless path, (n, 6): tip in mm, unit vector of the tool axis."""
    step = np.arange(start, stop, dtype=np.float64)
    turn = 0.0031 * step
    radius = 75.0 + 35.0 * np.cos(2.3e-5 * step)
    height = 5.0 + 40.0 * np.sin(3.1e-5 * step + 0.4)
    azimuth = turn + 0.35 * np.sin(1.7e-4 * step)
    tilt = np.radians(50.0 + 44.0 * np.sin(7.1e-5 * step))
    points = np.empty((stop - start, 6))
    points[:, 0] = radius * np.cos(turn)
    points[:, 1] = radius * np.sin(turn)
    points[:, 2] = height
    points[:, 3] = np.sin(tilt) * np.cos(azimuth)
    points[:, 4] = np.sin(tilt) * np.sin(azimuth)
    points[:, 5] = np.cos(tilt)
    points[:, :3] = points[:, :3].round(6)
    points[:, 3:] = points[:, 3:].round(9)
    return points + 0.0  # -0.0 becomes 0.0


def statements(start: int, stop: int) -> Iterator[str]:
    """Yield the GOTO lines of points ``start`` to ``stop``, many at a time."""
    for first in range(start, stop, CHUNK):
        points = path(first, min(first + CHUNK, stop))
        yield GOTO * len(points) % tuple(points.ravel().tolist())


def write(points: int, out: TextIO) -> None:
    """Write a whole CL file of ``points`` points: a rapid to the first, engage, cut, retract."""
    engaged = min(1 + LINK, points)
    retract = max(engaged, points - LINK)
    out.write(HEAD)
    for marks, start, stop in (
        (RAPID, 0, 1),
        (ENGAGE, 1, engaged),
        (CUT, engaged, retract),
        (RETRACT, retract, points),
    ):
        if stop > start:
            out.write(marks)
            out.writelines(statements(start, stop))
    out.write(FOOT)


def main() -> int:
    """Run from the command line."""
    parser = argparse.ArgumentParser(description="Make a five-axis CL file of N points.")
    parser.add_argument("points", type=int, metavar="N", help="number of GOTO statements, at least 1")
    parser.add_argument("file", type=Path, metavar="FILE", help="CL file to write")
    arguments = parser.parse_args()
    if arguments.points < 1:
        parser.error("N must be at least 1")
    with arguments.file.open("w", encoding="utf-8", newline="\n") as out:
        write(arguments.points, out)
    return 0


if __name__ == "__main__":
    sys.exit(main())
