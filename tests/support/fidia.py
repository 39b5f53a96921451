"""CL text with planes, circles and holes for Fidia programs."""

import math

import numpy as np
from hypothesis import strategies as st

from tests.support.posting import FOOT, HEAD
from trunnion.arrays import Floats

PLACE = st.floats(-80.0, 80.0)


@st.composite
def circles(draw: st.DrawFn, axis: Floats) -> str:
    """Lines and circles about a tool axis, and some that are not about it or are helices."""
    across = np.cross(axis, [1.0, 0.3, 0.1])
    x = across / np.linalg.norm(across)
    y = np.cross(axis, x)
    here = np.array([draw(PLACE), draw(PLACE), draw(PLACE)])
    head = ",".join(f"{v:.12f}" for v in axis)
    lines = [f"RAPID\nGOTO/{point(here + 20.0 * axis)},{head}", f"FEDRAT/MMPM,800\nGOTO/{point(here)}"]
    for _ in range(draw(st.integers(1, 4))):
        radius, begin = draw(st.floats(0.5, 60.0)), draw(st.floats(0.0, 6.28))
        sweep, sense = draw(st.floats(0.2, 6.0)), draw(st.sampled_from([-1.0, 1.0]))
        rise = draw(st.sampled_from([0.0, 0.0, 0.0, 5.0]))
        centre = here - radius * (math.cos(begin) * x + math.sin(begin) * y)
        end = begin + sense * sweep
        here = centre + radius * (math.cos(end) * x + math.sin(end) * y) + rise * axis
        normal = sense * axis
        lines.append(f"CIRCLE/{point(centre)},{','.join(f'{v:.12f}' for v in normal)},{radius:.6f},0.06,0.5,6.0,0.0")
        lines.append(f"GOTO/{point(here)}")
        if draw(st.booleans()):
            here = here + draw(st.floats(1.0, 9.0)) * x + draw(st.floats(-9.0, 9.0)) * axis
            lines.append(f"GOTO/{point(here)}")
    return "\n".join(lines) + "\n"


def point(place: Floats) -> str:
    return ",".join(f"{v:.6f}" for v in place)


HEIGHTS = "RAPTO,3,FEDTO,-12,"
CYCLES = {
    "DRILL": ("G81", HEIGHTS + "RTRCTO,20,MMPM,90"),
    "DRILL,DWELL": ("G82", HEIGHTS + "MMPM,90,DWELL,0.5"),
    "DRILL,DEEP": ("G83", HEIGHTS + "STEP,2.5,RTRCTO,9,MMPM,90"),
    "TAP": ("G84", HEIGHTS + "MMPR,1.25"),
    "BORE": ("G85", HEIGHTS + "MMPM,90"),
    "BORE,DWELL": ("G89", HEIGHTS + "MMPM,90,DWELL,0.5"),
    "BORE,DRAG": ("G86", HEIGHTS + "RTRCTO,5,MMPM,90"),
}


@st.composite
def holes_in(draw: st.DrawFn, axes: list[Floats]) -> str:
    """Holes of one cycle for each tool axis, some without a rapid between them."""
    lines = []
    for axis in axes:
        head = ",".join(f"{v:.12f}" for v in axis)
        place = np.array([draw(PLACE), draw(PLACE), draw(PLACE)])
        lines.append(f"RAPID\nGOTO/{point(place + 60.0 * axis)},{head}")
        mode = draw(st.sampled_from(sorted(CYCLES)))
        lines.append(f"CYCLE/{mode.removesuffix(',DWELL')},{CYCLES[mode][1]}")
        x = np.cross(axis, [0.3, 1.0, 0.1])
        for n in range(draw(st.integers(1, 4))):
            place = place + (15.0 * x if n else 0.0) + draw(st.sampled_from([0.0, 0.0, -7.0, 7.0])) * axis
            lines.append(f"GOTO/{point(place)}")
        lines.append("CYCLE/OFF")
        if draw(st.booleans()):
            lines.append(f"RAPID\nGOTO/{point(place + 60.0 * axis)}")
    return "\n".join(lines) + "\n"


START, END = HEAD.partition("RAPID")[0], FOOT
