"""LinuxCNC's own interpreter as the judge: its stand-alone program ``rs274`` prints the motions of a program."""

import os
import re
import shutil
import subprocess
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pytest

from trunnion.arrays import Floats

#: Where CI runs, the judge must be there: ``.ci/run`` installs it.
needs_judge = pytest.mark.skipif(
    shutil.which("rs274") is None and not os.environ.get("CI"),
    reason="LinuxCNC's interpreter is not installed (Debian package linuxcnc-uspace)",
)

_CALL = re.compile(r"^\s*\d+\s+N\S*\s+([A-Z_0-9]+)\((.*)\)\s*$")


@dataclass
class Canon:
    """Motions in positions of the machine, mm and degrees, as columns of n rows.

    kind     "traverse", "feed" or "arc"
    end      (n, 6) X Y Z A B C
    arcs     of each arc its row, the two coordinates of its centre and its turns (negative: clockwise)
    feed     (n,) the feed in force, mm/min
    unit     (n,) mm of the program's unit: the last printed digit is a ten thousandth of it
    """

    kind: list[str] = field(default_factory=list)
    end: list[list[float]] = field(default_factory=list)
    arcs: list[tuple[int, float, float, int]] = field(default_factory=list)
    feed: list[float] = field(default_factory=list)
    unit: list[float] = field(default_factory=list)
    dwells: list[float] = field(default_factory=list)

    @property
    def ends(self) -> Floats:
        """(n, 6)."""
        return np.array(self.end).reshape(-1, 6)


class Refused(Exception):  # noqa: N818 - the judge's word
    """What the judge says of a program that it does not take."""


def canonical(program: Path) -> Canon:
    """Run a program; its tools 1 to 9 have no length."""
    folder = program.parent
    variables = folder / "judge.var"
    variables.unlink(missing_ok=True)
    table = folder / "judge.tbl"
    table.write_text("".join(f"T{k} P{k} Z0 D{k}\n" for k in range(1, 10)))
    done = subprocess.run(
        ["rs274", "-g", "-v", str(variables), "-t", str(table), str(program)],
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
        env={**os.environ, "HOME": str(folder)},
    )
    if done.returncode:
        raise Refused(done.stderr)
    canon = Canon()
    unit = 1.0
    g5x, g92 = np.zeros(6), np.zeros(6)
    angle = feed = rpm = pitch = 0.0
    here = [0.0] * 6
    plane = "XY"

    def machine(point: list[float]) -> list[float]:
        p = np.array(point) + g92
        cos, sin = np.cos(np.radians(angle)), np.sin(np.radians(angle))
        p[:2] = cos * p[0] - sin * p[1], sin * p[0] + cos * p[1]
        p += g5x
        p[:3] *= unit
        return [float(value) for value in p]

    for text in done.stdout.splitlines():
        match = _CALL.match(text)
        if match is None:
            continue
        name, inside = match.groups()
        values = [float(value) for value in re.findall(r"-?\d+(?:\.\d+)?(?![A-Z])", inside)]
        match name:
            case "USE_LENGTH_UNITS":
                new = 1.0 if "MM" in inside else 25.4
                g5x[:3] *= unit / new
                g92[:3] *= unit / new
                unit = new
            case "SET_G5X_OFFSET":
                g5x = np.array(values[1:7])
            case "SET_G92_OFFSET":
                g92 = np.array(values[:6])
            case "SET_XY_ROTATION":
                angle = values[0]
            case "SELECT_PLANE":
                plane = inside.removeprefix("CANON_PLANE_").replace("CANON_PLANE::", "")
            case "SET_FEED_RATE":
                feed = values[0] * unit
            case "DWELL":
                canon.dwells.append(values[0])
            case "STRAIGHT_TRAVERSE" | "STRAIGHT_FEED":
                canon.kind.append("traverse" if name == "STRAIGHT_TRAVERSE" else "feed")
                here = values[:6]
                canon.end.append(machine(here))
                canon.feed.append(feed)
                canon.unit.append(unit)
            case "SET_SPINDLE_SPEED":
                rpm = values[1]
            case "START_SPEED_FEED_SYNC":
                pitch = values[0] * unit
            case "RIGID_TAP":  # in, and back to where it began
                for goal in ([*values[:3], *here[3:]], here):
                    canon.kind.append("feed")
                    canon.end.append(machine(goal))
                    canon.feed.append(pitch * rpm)
                    canon.unit.append(unit)
            case "ARC_FEED":
                first, second, c1, c2, turns, height, *rotary = values
                order = {"XY": (0, 1, 2), "YZ": (1, 2, 0), "XZ": (2, 0, 1)}[plane]
                end, centre = [0.0] * 6, [0.0] * 6
                for axis, value, middle in zip(order, (first, second, height), (c1, c2, height), strict=True):
                    end[axis], centre[axis] = value, middle
                end[3:] = centre[3:] = rotary
                here = end
                placed = machine(centre)
                canon.arcs.append((len(canon.kind), placed[order[0]], placed[order[1]], int(turns)))
                canon.kind.append("arc")
                canon.end.append(machine(end))
                canon.feed.append(feed)
                canon.unit.append(unit)
            case _:
                pass
    return canon
