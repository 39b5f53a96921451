"""Circles as blocks: one a turn, flat ones flat, and those of real files whose radii differ by their last digits."""

import re
from pathlib import Path

import numpy as np
import pytest

import trunnion
from trunnion.arrays import Floats
from trunnion.model.toolpath import Kind

OPERATION = """TOOL PATH/OP,TOOL,D10
TLDATA/MILL,10,0,75,0,0
INTOL/0.01
OUTTOL/0.01
LOAD/TOOL,1
SPINDL/RPM,1000,CLW
RAPID
GOTO/{above},{axis}
FEDRAT/MMPM,300
GOTO/{start}
CIRCLE/{centre},{axis},20,0.06,0.5,10,0{times}
GOTO/{end}
GOTO/{away}
END-OF-PATH
"""

MACHINES = ["yl569", "dmu65", "matsuura_mx330", "hs664rt", "xyzac_trt"]


def circle(tilt: float, end: tuple[float, float, float], turns: int = 0, decimals: int = 4) -> str:
    """An arc from (20, 0, 0) about Z, turned about Z by 20 degrees and tilted."""
    tilted, turned = _rotation(0, tilt), _rotation(2, 20.0)

    def place(*point: float) -> str:
        return ",".join(f"{number:.{decimals}f}" for number in turned @ tilted @ np.array(point))

    return OPERATION.format(
        above=place(20, 0, 20),
        start=place(20, 0, 0),
        centre=place(0, 0, 0),
        end=place(*end),
        away=place(end[0], end[1], end[2] + 20),
        axis=",".join(f"{number:.7f}" for number in turned @ tilted @ np.array([0.0, 0.0, 1.0])),
        times=f",TIMES,{turns}" if turns else "",
    )


def _rotation(axis: int, angle: float) -> Floats:
    cos, sin = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    matrix, (one, two) = np.eye(3), ((axis + 1) % 3, (axis + 2) % 3)
    matrix[[one, two], [one, two]] = cos
    matrix[one, two], matrix[two, one] = -sin, sin
    return matrix


def blocks(text: str, machine: str, folder: Path) -> tuple[list[str], int]:
    """The cutting blocks of a proven program on the circle, and how many are circles."""
    file = folder / "part.cls"
    file.write_text(text, encoding="utf-8")
    result = trunnion.post(file, machine=machine)
    assert result.passed
    assert result.run is not None
    lines = (result.text or "").splitlines()
    circles = int((result.run.kind == Kind.ARC).sum())
    return [line for line in lines if re.search(r"\b(?:G1|G2|G3|C|CP|L)? ?[XI]\S*", line)], circles


@pytest.mark.third
@pytest.mark.parametrize("machine", MACHINES)
@pytest.mark.parametrize("tilt", [0.0, 35.0])
@pytest.mark.parametrize(
    ("end", "turns", "each"),
    [((20, 0, -3), 1, 1), ((20, 0, -9), 3, 3), ((0, 20, -9), 3, 3), ((20, 0, 0), 3, 3), ((20, 0, 0), 0, 1)],
)
def test_a_helix_has_one_block_a_turn_at_most(
    machine: str, tilt: float, end: tuple[float, float, float], turns: int, each: int, tmp_path: Path
) -> None:
    if machine == "xyzac_trt" and tilt:
        pytest.skip("LinuxCNC has no tilted planes")
    if machine == "hs664rt" and end[2]:
        pytest.skip("the words of a helix are unconfirmed on a Fidia")
    lines, circles = blocks(circle(tilt, end, turns), machine, tmp_path)
    has_word = machine in ("yl569", "dmu65", "xyzac_trt")
    assert circles == (1 if has_word else each)
    assert len(lines) < 30


@pytest.mark.parametrize("machine", MACHINES)
@pytest.mark.parametrize("rise", [1e-5, -1e-5, 5e-5])
def test_an_arc_that_rises_by_a_last_digit_stays_one(machine: str, rise: float, tmp_path: Path) -> None:
    lines, circles = blocks(circle(0.0, (0, 20, rise), decimals=5), machine, tmp_path)
    assert circles == 1
    assert not [line for line in lines if "CP " in line]


@pytest.mark.third
@pytest.mark.parametrize("machine", MACHINES)
@pytest.mark.parametrize("tilt", [0.0, 35.0])
@pytest.mark.parametrize("off", [0.0003, 0.001, 0.0029, 0.0035, 0.015, -0.0195])
def test_what_the_reader_takes_is_planned_and_proven(machine: str, tilt: float, off: float, tmp_path: Path) -> None:
    """Up to 0.02 mm off the radius; controls take 0.003 mm as a circle, more becomes lines."""
    _, circles = blocks(circle(tilt, (0, 20 + off, 0)), machine, tmp_path)
    assert circles == (1 if abs(off) < 0.003 and not (machine == "xyzac_trt" and tilt) else 0)


def test_what_the_reader_does_not_take_is_refused_with_its_line(tmp_path: Path) -> None:
    with pytest.raises(trunnion.InputError, match=r"part\.cls:11: .* off its radius"):
        blocks(circle(0.0, (0, 20.021, 0)), "yl569", tmp_path)


@pytest.mark.parametrize(
    ("found", "instead"),
    [(" Z-6.", " Z-5."), (r"\nN\d+ [^\n]* Z-6\.[^\n]*", ""), (r"I(\S+) J(\S+)(?=\n[^\n]* Z-9)", r"I\1 J-7.")],
)
def test_a_turn_that_is_missing_or_wrong_is_noticed(found: str, instead: str, tmp_path: Path) -> None:
    cl, program = tmp_path / "part.cls", tmp_path / "part.nc"
    cl.write_text(circle(0.0, (20, 0, -9), 3), encoding="utf-8")
    text = trunnion.post(cl, machine="matsuura_mx330").text
    assert text is not None
    wrong = re.sub(found, instead, text, count=1)
    assert wrong != text
    program.write_text(wrong, encoding="utf-8")
    failed = trunnion.verify(program, cl=cl, machine="matsuura_mx330").checks
    assert [check.key for check in failed if not check.passed]
