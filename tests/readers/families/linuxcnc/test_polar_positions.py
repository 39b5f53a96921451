"""Positions by radius and angle, @ and ^: where LinuxCNC's own interpreter goes, and what it refuses."""

from pathlib import Path

import numpy as np
import pytest

from tests.support.linuxcnc.interpreter import RefusedByLinuxcncError, interpret, needs_linuxcnc
from tests.support.reading import Runner, close

HEAD = "G21 G17 G90 G94\nG54\nG0 X0 Y0 Z1\nF100\n"

#: Programs, and where their last motion ends.
TAKEN = {
    "G1 @10 ^30": (8.660254, 5.0),
    "G0 X3 Y4\nG1 ^90": (0.0, 5.0),
    "G0 X3 Y4\nG1 @10": (6.0, 8.0),
    "G0 @20 ^60\nG91 G1 ^10": (6.840403, 18.793852),
    "G0 X10\nG91 G0 @10 ^20": (18.793852, 6.840403),
    "G0 X10\nG2 ^-90 I-10 J0": (0.0, -10.0),
    "G0 X10\nG0 @-5 ^0": (-5.0, 0.0),
    "G0 ^90": (0.0, 0.0),
    "G0 X10 Y0\nG92 X0 Y5\nG1 ^0": (5.0, 0.0),
    "G1 @10 ^0\n^90\n^180\n": (-10.0, 0.0),
    "#1=10\nG1 @#1 ^[2*#1+70]": (0.0, 10.0),
    "G20\nG1 @1 ^90 F5": (0.0, 1.0),
}

#: Where it is as the work offset counts, if the program counts otherwise.
BY_OFFSET = {"G0 X10 Y0\nG92 X0 Y5\nG1 ^0": (15.0, -5.0)}

REFUSED = [
    "G0 X1 @20", "G0 Y1 ^20", "G91 G0 ^10", "G91 G0 @10", "G18\nG0 X1\nG0 ^90", "G53 G0 @5 ^0",
    "G80\n@5", "G0 @1 @2",
]  # fmt: skip

#: What the interpreter takes, and a program must not mean.
NOT_FOLLOWED = [
    "G0 X10\nG91 G81 ^90 Z-1 R2 L3", "G0 X10\nG92 @5", "G5.2 @10 ^90 P1 L3\nX1 Y1 P1\nX2 Y3 P1\nG5.3",
    "G5.2 X1 Y1 P1 L3\n@10 ^90 P1\nX2 Y3 P1\nG5.3", "G0 X10\nG28 @5",
]  # fmt: skip


@pytest.mark.parametrize("text", TAKEN)
def test_the_tool_goes_there(text: str, run: Runner) -> None:
    found = run(f"{HEAD}{text}\nM2\n")
    assert not found.errors
    close(
        found.tip[-1, :2] if "G20" not in text else found.tip[-1, :2] / 25.4,
        BY_OFFSET.get(text, TAKEN[text]),
        atol=1e-5,
    )


def test_holes_are_at_radius_and_angle(run: Runner) -> None:
    found = run(f"{HEAD}G81 @10 ^0 Z-1 R1\n^90\n^180\nG80\nM2\n")
    assert not found.errors
    low = found.tip[np.isclose(found.tip[:, 2], -1.0), :2]
    close(low, [(10.0, 0.0), (0.0, 10.0), (-10.0, 0.0)], atol=1e-9)


def test_what_is_not_followed_is_an_error(run: Runner) -> None:
    assert [text for text in (*REFUSED, *NOT_FOLLOWED) if not run(f"{HEAD}{text}\nM2\n").errors] == []


@needs_linuxcnc
def test_linuxcnc_goes_there_and_refuses_the_same(tmp_path: Path) -> None:
    for text, (x, y) in TAKEN.items():
        close(interpret(f"{HEAD}{text}\nM2\n", tmp_path).moves[-1].end[:2], (x, y), atol=1e-4)
    for text in REFUSED:
        with pytest.raises(RefusedByLinuxcncError):
            interpret(f"{HEAD}{text}\nM2\n", tmp_path)
