"""REPEAT with a label: the part from the label to its block again."""

from pathlib import Path

import numpy as np
import pytest

import trunnion

_HEAD = "G17 G90 G71\nG0 X0 Y0 Z0\nR1=0\n"


def _run(folder: Path, text: str) -> trunnion.Run:
    program = folder / "part.mpf"
    program.write_text(f"{_HEAD}{text}M30\n")
    return trunnion.read_program(program, machine="yl569")


@pytest.mark.parametrize(("times", "count"), [("", 2), (" P=1", 2), (" P=3", 4), (" P=0", 1), (" P=R2", 3)])
def test_a_part_is_repeated_as_often_as_the_block_says(times: str, count: int, tmp_path: Path) -> None:
    run = _run(tmp_path, f"R2=2\nPART: R1=R1+1\nG1 X=R1 F90\nY=R1\nREPEAT PART{times}\nG0 Z9\n")
    assert not run.errors
    steps = np.repeat(np.arange(1.0, count + 1.0), 2)
    np.testing.assert_array_equal(run.tip[1:-1, 0], steps)
    assert run.tip[-1].tolist() == [float(count), float(count), 9.0]


def test_parts_within_parts_are_repeated_anew_each_time(tmp_path: Path) -> None:
    run = _run(tmp_path, "OUTER: R1=R1+10\nINNER: R1=R1+1\nG1 X=R1 F90\nREPEAT INNER P=2\nREPEAT OUTER P=1\n")
    assert not run.errors
    assert run.tip[1:, 0].tolist() == [11.0, 12.0, 13.0, 24.0, 25.0, 26.0]


@pytest.mark.third
@pytest.mark.parametrize(
    "text",
    [
        "PART: G1 X1 F9\nREPEAT PART NOWHERE P=2\n", "PART: G1 X1 F9\nOTHER: X2\nREPEATB PART OTHER P=2\n",
        "PART: G1 X1 F9\nIF R1>2 GOTOF OUT\nR1=R1+1\nREPEAT PART P=9\nOUT: X5\n", "REPEAT PART P=2\nPART: G1 X1 F9\n",
        "PART: G1 X1 F9\nREPEAT PART P=1.5\n", "PART: G1 X1 F9\nREPEAT PART P=-1\n",
        "PART: G1 X1 F9\nREPEATB NOWHERE P=2\n", "PART: X1\nREPEATB REPEATB P=2\n",
    ],
)  # fmt: skip
def test_other_parts_are_refused_by_name(text: str, tmp_path: Path) -> None:
    assert any("REPEAT" in error.text for error in _run(tmp_path, text).errors)


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        ("PART: R1=R1+1 X=R1\nY5\nREPEATB PART P=2\nZ1\n", [[1, 0], [1, 5], [2, 5], [3, 5]]),
        ("X9\nREPEATB PART P=1\nY7\nPART: R1=R1+1 X=R1\nZ1\n", [[9, 0], [1, 0], [1, 7], [2, 7]]),
        ("PART: R1=R1+1 X=R1\nLAST: Y=R1\nX0\nREPEAT PART LAST P=1\nZ1\n", [[1, 0], [1, 1], [0, 1], [2, 1], [2, 2]]),
        ("PART: R1=R1+1 X=R1\nENDLABEL: Y=R1\nX0\nREPEAT PART\nZ1\n", [[1, 0], [1, 1], [0, 1], [2, 1], [2, 2]]),
        ("PART: R1=R1+1 X=R1\n; the end\nREPEAT PART P=1\nZ1\n", [[1, 0], [2, 0]]),
    ],
)
def test_a_block_or_a_part_with_an_end_of_its_own_is_repeated(
    text: str, wanted: list[list[int]], tmp_path: Path
) -> None:
    run = _run(tmp_path, f"G1 F90\n{text}")
    assert not run.errors
    assert run.tip[1:-1, :2].tolist() == wanted
    assert run.tip[-1, 2] == 1.0


def test_a_part_without_end_ends(tmp_path: Path) -> None:
    with pytest.raises(trunnion.InputError, match="does it end"):
        _run(tmp_path, "PART: G91 G1 X0.001 F9\nREPEAT PART P=1000000000\n")
