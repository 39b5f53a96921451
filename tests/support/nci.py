"""Mastercam NCI files that tests write, and those of others beside the programs that were posted from them."""

import re
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, Final, NamedTuple

import numpy as np

from tests.support.cl_dialects import Step, Vector, Z
from tests.support.locations import SHARED
from trunnion.arrays import Floats

#: A file of others, and the program of a Fagor 8070 that was posted from it.
REAL: Final = SHARED / "data" / "mastercam" / "surf_test_1.nci"
POSTED: Final = REAL.with_name("surf_test_1.fagor.nc")

TOP: Final = "1. 0. 0. 0. 1. 0. 0. 0. 1."

#: A head-head machine as that program has it: tool axis = (sin B cos C, sin B sin C, cos B).
MACHINE: Final = (
    """schema = 1
name = "B-C head"
[control]
extends = "linuxcnc"
[spindle]
gauge_point_mm = [0, 0, 0]
"""
    + "".join(
        f'[[axis]]\nname = "{name}"\nkind = "linear"\ncarries = "tool"\ndirection = {direction}\n'
        "limits_mm = [-500, 500]\nhome_mm = 400\nrapid_mm_min = 12000\n"
        for name, direction in (("X", [1, 0, 0]), ("Y", [0, 1, 0]), ("Z", [0, 0, 1]))
    )
    + """[[axis]]
name = "C"
kind = "rotary"
carries = "tool"
direction = [0, 0, 1]
point_mm = [0, 0, 0]
limits_deg = [-360, 360]
rapid_deg_min = 3600
[[axis]]
name = "B"
kind = "rotary"
carries = "tool"
direction = [0, 1, 0]
point_mm = [0, 0, 0]
limits_deg = [-120, 120]
rapid_deg_min = 3600
"""
)


def header(name: str = "PART") -> list[str]:
    """The first records of a file."""
    return ["1050", f"9 34 10 12 2015 11 38 29 C:\\MCAM9\\MILL\\{name}.MC9"]


def tool(number: int, diameter: float, corner: float, rpm: float = 0.0, coolant: int = 0, name: str = "") -> list[str]:
    """The records of an operation with a tool change."""
    lines = ["1013", f"0 {diameter:g} {corner:g} 1 1 0. 0. 0. 17 NONE", "1014", TOP, "1027", f"{TOP} 0. 0. 0."]
    lines += ["20001", name] if name else []
    return [*lines, "1002", f"0 100 2 {number} 0 0 0 {rpm:g} 0. {coolant} 0. 0. 0."]


def five_axis(point: Sequence[float], axis: Sequence[float], feed: float, place: int = 22) -> list[str]:
    """A record 11."""
    second = [p + a for p, a in zip(point, axis, strict=True)]
    numbers = " ".join(f"{value:.6f}" for value in (*point, *second))
    flag = {12: 1000, 32: 100}.get(place, 0)
    return ["11", f"{numbers} {feed:g} {place} {flag} " + " ".join(f"{value:.9f}" for value in axis)]


def line(code: int, point: Sequence[float], feed: float) -> list[str]:
    """A record 0 or 1."""
    return [str(code), "0 " + " ".join(f"{value:.6f}" for value in point) + f" {feed:g} 0"]


class Hole(NamedTuple):
    """A hole: its point in the surface, its tool axis, and along it depth, height of the feed and of the upper point.

    ``surface`` is the coordinate that the surface has along the axis: only differences of heights count.
    """

    point: Sequence[float]
    axis: Sequence[float]
    depth: float
    feeds: float
    begin: float
    surface: float = 0.0
    dwell: float = 0.0

    def at(self, height: float) -> str:
        """A point of it, printed."""
        return " ".join(f"{p + height * a:.9f}" for p, a in zip(self.point, self.axis, strict=True))


def cycle(kind: int, holes: Sequence[Hole], feed: float, peck: float = 0.0) -> list[str]:
    """The records 81, 100 for each further hole, and 80."""
    lines = []
    for number, hole in enumerate(holes):
        bottom, upper = hole.at(-hole.depth), hole.at(hole.begin)
        heights = f"{hole.surface + hole.begin:.6f} {hole.surface + hole.feeds:.6f}"
        if number == 0:
            before = f"{kind} {bottom} {hole.dwell:g} {feed:g} {peck:g} 0. 0. 0."
            lines += ["81", f"{before} {heights} {hole.surface:.6f} 0. {upper} 0 0"]
        else:
            lines += ["100", f"0 {bottom} {heights} {hole.dwell:g} {feed:g} {upper} 0 0"]
    return [*lines, "80", ""]


#: Types of cycles by their words in APT.
KINDS: Final = {"DRILL": 0, "FACE": 0, "DEEP": 1, "BRKCHP": 2, "TAP": 3, "REAM": 4}

#: Planes of arcs by the coordinate across: the number of the plane, and the coordinates within it.
PLANES: Final = {2: (0, (0, 1)), 0: (1, (1, 2)), 1: (2, (0, 2))}


def arc(step: Step, feed: float) -> list[str]:
    """A record 2 or 3 about an axis of coordinates."""
    across = next(k for k in range(3) if step.normal[k])
    plane, (one, other) = PLANES[across]
    numbers = (step.point[one], step.point[other], step.centre[one], step.centre[other], step.point[across])
    shown = " ".join(f"{number:.6f}" for number in numbers)
    return [str(3 if step.normal[across] > 0 else 2), f"{plane} 0 {shown} {feed:g} 0 0"]


def file_of(*lines: str) -> str:
    """The text of a file with its header and its end."""
    return "\n".join([*header(), *lines, "1003", "0. 0. 0."]) + "\n"


def can_say(steps: Sequence[Step]) -> bool:
    """Whether records have words for all steps: no switches between moves, arcs about coordinates, tool upright."""
    for step in steps:
        if step.word in ("COOLANT", "CUTCOM"):
            return False
        if step.word == "ARC" and (step.axis != Z or sorted(map(abs, step.normal)) != [0.0, 0.0, 1.0]):
            return False
    return True


def in_plane(step: Step, plane: Floats) -> Step:
    """A step in the coordinates of a tool plane: (3, 3), its rows are the axes of the plane."""
    names = ("point", "axis", "centre", "normal", "start")
    moved: dict[str, Any] = {name: _rounded(plane @ np.array(getattr(step, name))) for name in names}
    return replace(step, **moved, holes=tuple(_rounded(plane @ np.array(hole)) for hole in step.holes))


def _rounded(vector: Floats) -> Vector:
    """Without the noise of a turn, which would hide that a tool is upright."""
    x, y, z = (round(value, 12) + 0.0 for value in vector.tolist())
    return (x, y, z)


def write(steps: Sequence[Step], plane: Floats | None = None) -> str:
    """A path as an NCI: rapids by -2, a feed where it changes, and -1 where it does not; all in a tool plane."""
    turned = TOP if plane is None else " ".join(f"{value:.9f}" for value in plane.ravel())
    text = _write([step if plane is None else in_plane(step, plane) for step in steps])
    return text.replace(f"1014\n{TOP}\n", f"1014\n{turned}\n")


def _write(steps: Sequence[Step]) -> str:
    lines: list[str] = []
    feed, given, cuts = 0.0, 0.0, False
    pending: Step | None = None
    axis = Z
    for step in steps:
        upright = step.axis == Z == axis
        match step.word:
            case "TOOL":
                pending, given, cuts, axis = step, 0.0, False, Z
            case "SPINDLE":
                assert pending is not None
                sign = 1.0 if step.text == "CLW" else -1.0
                number, diameter, corner = pending.numbers
                lines += tool(int(number), diameter, corner, rpm=sign * step.numbers[0])
            case "FEED":
                feed = step.numbers[0]
            case "DWELL":
                lines += ["4", f"{step.numbers[0]:.3f}"]
            case "COMMENT":
                lines += ["1005", step.text]
            case "RAPID":
                lines += line(0, step.point, -2) if upright else five_axis(step.point, step.axis, -2, 42)
                cuts, axis = False, step.axis
            case "GOTO" | "ARC":
                word = -1.0 if cuts and feed == given else feed
                given, cuts = feed, True
                if step.word == "ARC":
                    lines += arc(step, word)
                elif upright:
                    lines += line(1, step.point, word)
                else:
                    lines += five_axis(step.point, step.axis, word)
                axis = step.axis
            case "CYCLE":
                depth, clear, drilled, peck = step.numbers
                holes = [Hole(point, step.axis, depth, clear, clear, 7.5) for point in step.holes]
                lines += cycle(KINDS[step.text], holes, drilled, peck)
                given, cuts, axis = 0.0, False, step.axis
    return file_of(*lines)


def fagor_axes() -> tuple[Floats, Floats, Floats]:
    """Points, tool axes and feeds of the program of the Fagor, its words modal."""
    now = dict.fromkeys("XYZBCF", 0.0)
    rows = []
    for block in POSTED.read_text(encoding="utf-8").splitlines():
        if not re.match(r"N\d+ G01", block):
            continue
        now |= {letter: float(value) for letter, value in re.findall(r"([XYZBCF])(-?[\d.]+)", block)}
        rows.append([now[letter] for letter in "XYZBCF"])
    table = np.array(rows)
    b, c = np.radians(table[:, 3]), np.radians(table[:, 4])
    axes = np.column_stack((np.sin(b) * np.cos(c), np.sin(b) * np.sin(c), np.cos(b)))
    return table[:, :3], axes, table[:, 5]
