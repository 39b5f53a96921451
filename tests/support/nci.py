"""Mastercam NCI files that tests write, and those of others beside the programs that were posted from them."""

import re
from collections.abc import Sequence
from typing import Final

import numpy as np

from tests.support.cl_dialects import Step, Z
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


def file_of(*lines: str) -> str:
    """The text of a file with its header and its end."""
    return "\n".join([*header(), *lines, "1003", "0. 0. 0."]) + "\n"


def can_say(steps: Sequence[Step]) -> bool:
    """Whether records have words for all steps: no cycles, no switches between moves, arcs upright about Z."""
    for step in steps:
        if step.word in ("CYCLE", "COOLANT", "CUTCOM"):
            return False
        if step.word == "ARC" and (step.axis != Z or abs(step.normal[2]) != 1.0):
            return False
    return True


def write(steps: Sequence[Step]) -> str:
    """A path as an NCI: rapids by -2, a feed where it changes, and -1 where it does not."""
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
                    x, y, z = step.point
                    numbers = f"{x:.6f} {y:.6f} {step.centre[0]:.6f} {step.centre[1]:.6f} {z:.6f}"
                    lines += [str(3 if step.normal[2] > 0 else 2), f"0 0 {numbers} {word:g} 0 0"]
                elif upright:
                    lines += line(1, step.point, word)
                else:
                    lines += five_axis(step.point, step.axis, word)
                axis = step.axis
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
