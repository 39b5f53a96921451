"""Families of paths for any machine, as CL files; made from rotary positions, so that the machine reaches them."""

import math
from collections.abc import Callable, Sequence
from typing import Final

import numpy as np
from hypothesis import strategies as st

from trunnion.arrays import Floats
from trunnion.machines import Machine, forward

_START: Final = """TOOL PATH/{name},TOOL,D10
TLDATA/MILL,10.0000,0.0000,75.0000,0.0000,0.0000
MSYS/0.0000,0.0000,0.0000,1.0000000,0.0000000,0.0000000,0.0000000,1.0000000,0.0000000
INTOL/0.01
OUTTOL/0.01
LOAD/TOOL,1,ADJUST,1
SPINDL/RPM,1000.0000,CLW
"""

#: A family draws the text of a CL file for a machine.
Family = Callable[[st.DrawFn, Machine], str]

#: All cycles, as a CL file has them.
CYCLES: Final = {
    "DRILL": "DRILL,RAPTO,3,FEDTO,-12,RTRCTO,20,MMPM,90",
    "DRILL with DWELL": "DRILL,RAPTO,3,FEDTO,-12,MMPM,90,DWELL,0.5",
    "DRILL,CSINK": "DRILL,CSINK,RAPTO,3,CSKDIA,8,TLANGL,90,MMPM,90",
    "DRILL,DEEP": "DRILL,DEEP,RAPTO,3,FEDTO,-12,STEP,2.5,RTRCTO,9,MMPM,90",
    "DRILL,DEEP, decreasing pecks": "DRILL,DEEP,RAPTO,3,FEDTO,-12,STEP,4,1,2,MMPM,90",
    "DRILL,BRKCHP": "DRILL,BRKCHP,RAPTO,3,FEDTO,-12,STEP,2.5,MMPM,90",
    "TAP": "TAP,RAPTO,3,FEDTO,-12,MMPR,1.25",
    "TAP,OPTION": "TAP,RAPTO,3,FEDTO,-12,MMPR,1.25,OPTION",
    "TAP,BRKCHP": "TAP,BRKCHP,RAPTO,3,FEDTO,-12,STEP,2.5,MMPR,1.25",
    "TAP,DEEP": "TAP,DEEP,RAPTO,3,FEDTO,-12,STEP,2.5,MMPR,1.25",
    "BORE": "BORE,RAPTO,3,FEDTO,-12,MMPM,90",
    "BORE with DWELL": "BORE,RAPTO,3,FEDTO,-12,MMPM,90,DWELL,0.5",
    "BORE,DRAG": "BORE,DRAG,RAPTO,3,FEDTO,-12,RTRCTO,5,MMPM,90",
    "BORE,NODRAG": "BORE,NODRAG,90,RAPTO,3,FEDTO,-12,MMPM,90",
    "BORE,MANUAL": "BORE,MANUAL,RAPTO,3,FEDTO,-12,MMPM,90",
}

PLACE: Final = st.floats(-60.0, 60.0).map(lambda value: round(value, 4))
LENGTH: Final = st.floats(1.0, 20.0).map(lambda value: round(value, 4))
STEP: Final = st.sampled_from([0.0, 4.0, -4.0])
SHARE: Final = st.floats(0.02, 0.98)
UPRIGHT: Final = np.array([0.0, 0.0, 1.0])


def operation(name: str, body: str) -> str:
    """One operation of a CL file."""
    return f"{_START.format(name=name)}{body}END-OF-PATH\n"


def words(*values: Floats) -> str:
    """Places and directions as a statement has them."""
    return ",".join(f"{number:.9f}" for value in values for number in value)


def reachable(machine: Machine, shares: Sequence[tuple[float, float]]) -> Floats:
    """Tool axes (n, 3) at rotary positions, each a share of what the axis has; endless axes have a turn."""
    joints = np.tile(machine.home, (len(shares), 1))
    for column, part in zip(machine.rotary, np.array(shares).T, strict=True):
        axis = machine.axes[column]
        low, high = (0.0, 360.0) if axis.endless else (axis.low, axis.high)
        joints[:, column] = low + part * (high - low)
    return forward(machine, joints)[1]


def square(axis: Floats) -> tuple[Floats, Floats]:
    """Two directions that make a right-handed frame with a tool axis."""
    x = np.cross(np.eye(3)[int(np.argmin(np.abs(axis)))], axis)
    x /= np.linalg.norm(x)
    return x, np.cross(axis, x)


def circle(here: Floats, normal: Floats, arm: Floats, sweep: float, rise: float = 0.0) -> tuple[str, Floats]:
    """The statements of a circle from a place about the end of an arm square to the normal, and where it leads."""
    centre = here + arm
    back, across = -arm, np.cross(normal, -arm)
    end = centre + math.cos(sweep) * back + math.sin(sweep) * across + rise * normal
    text = f"CIRCLE/{words(centre, normal)},{np.linalg.norm(arm):.9f},0.06,0.5,10.0,0.0\nGOTO/{words(end)}\n"
    return text, end


def milling(draw: st.DrawFn, axis: Floats, planes: bool) -> str:
    """Lines, circles either way, a whole one and one that rises; with ``planes`` also circles about X and Y."""
    x, y = square(axis)
    here = np.array([draw(PLACE), draw(PLACE), draw(PLACE)])
    text = f"RAPID\nGOTO/{words(here + 50.0 * axis, axis)}\nRAPID\nGOTO/{words(here + 2.0 * axis)}\n"
    text += f"FEDRAT/MMPM,500\nGOTO/{words(here)}\n"
    about = [axis, -axis, axis, axis] + ([x, -y] if planes else [])
    for k, normal in enumerate(about):
        arm = draw(LENGTH) * np.cross(normal, [y, x, x, y, y, x][k])
        if np.linalg.norm(arm) < 0.5:
            arm = draw(LENGTH) * [y, x, x, y, y, x][k]
        sweep = 2.0 * math.pi if k == 2 else draw(st.floats(0.3, 6.0))
        arc, here = circle(here, normal, arm, sweep, draw(LENGTH) if k == 3 else 0.0)
        here = here + draw(LENGTH) * x + draw(LENGTH) * axis
        text += f"{arc}FEDRAT/MMPM,{draw(st.integers(50, 2000))}\nGOTO/{words(here)}\n"
    return text + f"RAPID\nGOTO/{words(here + 100.0 * axis)}\n"


def three_axis(draw: st.DrawFn, machine: Machine) -> str:
    """Milling with the tool along +Z: circles in three planes, either way, whole and rising."""
    return operation("MILL", milling(draw, UPRIGHT, planes=True))


def tilted_milling(draw: st.DrawFn, machine: Machine) -> str:
    """Milling in two tilted planes, with circles about the tool axis; an upright operation before."""
    axes = [UPRIGHT, *reachable(machine, [(draw(SHARE), draw(SHARE)) for _ in range(2)])]
    return "".join(operation(f"MILL_{k}", milling(draw, axis, planes=False)) for k, axis in enumerate(axes))


def tilted_drilling(draw: st.DrawFn, machine: Machine) -> str:
    """Holes on five planes in one operation; the tool is drawn back between some of them by the CL file."""
    text = ""
    for axis in reachable(machine, [(draw(SHARE), draw(SHARE)) for _ in range(5)]):
        place = np.array([draw(PLACE), draw(PLACE), draw(PLACE)])
        x, _ = square(axis)
        text += f"RAPID\nGOTO/{words(place + 60.0 * axis, axis)}\n"
        text += f"CYCLE/{CYCLES[draw(st.sampled_from(['DRILL', 'DRILL,DEEP']))]}\n"
        text += f"GOTO/{words(place)}\nGOTO/{words(place + 15.0 * x)}\nCYCLE/OFF\n"
        text += f"RAPID\nGOTO/{words(place + 15.0 * x + 60.0 * axis)}\n" if draw(st.booleans()) else ""
    return operation("HOLES", text)


def simultaneous(draw: st.DrawFn, machine: Machine) -> str:
    """A cut on which both rotary axes turn, from one rotary position towards another, there and back."""
    return _cut(draw, machine, (0.02, 0.98))


def off_the_pole(draw: st.DrawFn, machine: Machine) -> str:
    """As ``simultaneous``, with the second rotary axis on one side of its zero, where the pole is.

    A machine with one rotary axis has no pole.
    """
    axis = machine.axes[machine.rotary[1]]
    if axis.is_missing:
        return simultaneous(draw, machine)
    share = -axis.low / (axis.high - axis.low)
    above = axis.high > -axis.low
    return _cut(draw, machine, (share + 0.1 * (1.0 - share), 0.98) if above else (0.02, 0.9 * share))


def _cut(draw: st.DrawFn, machine: Machine, between: tuple[float, float]) -> str:
    """A cut with the second rotary axis in some part of what it has."""
    first, last = np.array([(draw(SHARE), draw(st.floats(*between))) for _ in range(2)])
    part = 0.5 - 0.5 * np.cos(np.linspace(0.0, 2.0 * np.pi, 13))[:, None]
    axes = reachable(machine, [(float(a), float(b)) for a, b in first + 0.3 * part * (last - first)])
    begin = np.array([draw(PLACE), draw(PLACE), draw(PLACE)])
    tips = begin + np.arange(13)[:, None] * [draw(LENGTH), draw(LENGTH), -draw(LENGTH)] * 0.3
    text = f"RAPID\nGOTO/{words(tips[0] + 50.0 * axes[0], axes[0])}\nFEDRAT/MMPM,800\n"
    text += "".join(f"GOTO/{words(tip, axis)}\n" for tip, axis in zip(tips, axes, strict=True))
    return operation("CUT", text + f"RAPID\nGOTO/{words(tips[-1] + 50.0 * axes[-1], axes[-1])}\n")


def cycles(modes: Sequence[str]) -> Family:
    """Two holes with each of some cycles, upright."""

    def text_of(draw: st.DrawFn, machine: Machine) -> str:
        return holes(modes, [(draw(PLACE), draw(PLACE), draw(PLACE), draw(STEP)) for _ in modes])

    return text_of


def holes(modes: Sequence[str], places: Sequence[tuple[float, float, float, float]]) -> str:
    """Two upright holes with each of some cycles; ``places``: where the first is, and how much higher the second."""
    text = ""
    for mode, (x, y, z, step) in zip(modes, places, strict=True):
        place, aside = np.array([x, y, z]), np.array([x + 15.0, y, z + step])
        text += f"RAPID\nGOTO/{words(place + 50.0 * UPRIGHT, UPRIGHT)}\nFEDRAT/MMPM,90\nCYCLE/{CYCLES[mode]}\n"
        text += f"GOTO/{words(place)}\nGOTO/{words(aside)}\nCYCLE/OFF\nRAPID\nGOTO/{words(aside + 50.0 * UPRIGHT)}\n"
    return operation("HOLES", text)
