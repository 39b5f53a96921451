"""Circles and helices that a program writes in pieces: each is compared with the part of the arc that it is."""

import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import trunnion
from tests.support.examples import examples
from trunnion.verification import Check

#: Machine, first line, and the words of the working planes about X, Y and Z.
ISO = {
    "yl569": ("G40 G710 G94 G90", "G19 G18 G17"),
    "matsuura_mx330": ("G21 G94 G90", "G19 G18 G17"),
    "xyzac_trt": ("G21 G94 G90", "G19 G18 G17"),
}
RADIUS, PITCH = 20.0, 2.0
JUDGED = ("order", "tip", "kind", "span")


def point(about: int, angle: float, rise: float) -> np.ndarray:
    """A point of the helix, (3,) mm."""
    at = np.zeros(3)
    at[(about + 1) % 3], at[(about + 2) % 3] = RADIUS * math.cos(angle), RADIUS * math.sin(angle)
    at[about] = rise
    return at


def cl_file(folder: Path, about: int, turns: int) -> Path:
    """Turns about an axis, counter-clockwise, that rise by the pitch each."""
    normal = ",".join("1" if k == about else "0" for k in range(3))
    start, end = point(about, 0.0, 0.0), point(about, 0.0, turns * PITCH)
    goto = ["GOTO/" + ",".join(f"{value:.4f}" for value in at) for at in (start, end)]
    path = folder / "helix.cls"
    circle = f"CIRCLE/0,0,0,{normal},{RADIUS:g},0.06,0.5,10,0,TIMES,{turns}"
    lines = ["UNITS/MM", "TOOL PATH/H,TOOL,EM", "TLDATA/MILL,10,0,80,0,0", "LOAD/TOOL,1", "RAPID", goto[0]]
    path.write_text("\n".join([*lines, "FEDRAT/MMPM,500", circle, goto[1], "END-OF-PATH"]))
    return path


def program(folder: Path, machine: str, about: int, ends: list[float], total: float) -> Path:
    """The helix in pieces that end at ``ends``, in turns; ``total`` of them rise to the height of the CL file."""
    head, planes = ISO[machine]
    lines = [head, planes.split()[about], "G0 " + words("XYZ", point(about, 0.0, 0.0)), "F500"]
    before = 0.0
    for end in ends:
        here = point(about, 2.0 * math.pi * before, 0.0)
        centre = words("IJK", -here, leave_out=about)
        lines.append("G3 " + words("XYZ", point(about, 2.0 * math.pi * end, end * total)) + " " + centre)
        before = end
    path = folder / "helix.nc"
    path.write_text("\n".join([*lines, "M30"]) + "\n")
    return path


def words(letters: str, values: np.ndarray, leave_out: int = -1) -> str:
    return " ".join(f"{a}{v + 0.0:.4f}" for k, (a, v) in enumerate(zip(letters, values, strict=True)) if k != leave_out)


def judge(
    folder: Path, machine: str, about: int, turns: int, ends: list[float], pitch: float = PITCH
) -> dict[str, Check]:
    cl, nc = cl_file(folder, about, turns), program(folder, machine, about, ends, pitch)
    found = trunnion.verify(nc, machine=machine, cl=cl, columns=False, zero=(0.0, 0.0, 0.0), tool_length=0.0)
    return {check.key: check for check in found.checks if check.key in JUDGED}


@settings(max_examples=examples(10), deadline=None)
@given(
    machine=st.sampled_from(sorted(ISO)),
    about=st.sampled_from([0, 1, 2]),
    turns=st.integers(1, 4),
    parts=st.sampled_from([[1.0], [0.5, 1.0], [0.25, 0.75, 1.0], [0.1, 1.0], [0.3, 0.45, 0.6, 0.95, 1.0]]),
)
def test_pieces_of_a_helix_are_compared_with_their_part_of_it(
    machine: str, about: int, turns: int, parts: list[float], tmp_path_factory: pytest.TempPathFactory
) -> None:
    folder = tmp_path_factory.mktemp("helix")
    ends = [turn + part for turn in range(turns) for part in parts]
    found = judge(folder, machine, about, turns, ends)
    assert [key for key, check in found.items() if not check.passed] == []
    tip = float(found["span"].summary.split()[1])
    assert tip < 1e-3
    # A turn more or less, to the same height, and a piece at another height, are no such helix.
    height = turns * PITCH
    for others in (
        [turn + part for turn in range(turns + 1) for part in parts],
        ends[len(parts) :] and ends[: -len(parts)],
    ):
        if others:
            wrong = judge(folder, machine, about, turns, others, height / others[-1])
            assert any(not check.passed for check in wrong.values())
    if len(ends) > 1:
        nc = program(folder, machine, about, ends, PITCH)
        lines = nc.read_text().splitlines()
        axis = "XYZ"[about]
        lines[4] = " ".join(
            word if word[0] != axis else f"{axis}{ends[0] * PITCH + 0.05:.4f}" for word in lines[4].split()
        )
        nc.write_text("\n".join(lines) + "\n")
        again = trunnion.verify(
            nc, machine=machine, cl=folder / "helix.cls", columns=False, zero=(0, 0, 0), tool_length=0
        )
        assert any(not check.passed for check in again.checks if check.key in JUDGED)
