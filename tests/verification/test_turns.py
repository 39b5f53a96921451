"""The check `turns`: a retract that is missing before a rotary axis turns, in programs of every control."""

from collections.abc import Callable
from pathlib import Path

import pytest

from tests.support.block_of_holes import BLOCK, FRONT, HEAD, RIGHT, hole
from tests.support.verifying import check
from trunnion import verify
from trunnion.cli import main

#: The block between two planes that retracts, for each control.
RETRACTS = {
    "yl569": "SUPA G0 Z=_Z_HOME D0",
    "dmu65": "L Z+560 R0 FMAX M91",
    "matsuura_mx330": "G49 G53 G0 Z0.",
    "xyzac_trt": "G53 G0 Z0.",
    "linuxcnc_5axis": "G53 G0 Z0.",
    "hs664rt": "M242",
}

Programs = Callable[[str, str], list[str]]


@pytest.fixture
def program(tmp_path: Path) -> Programs:
    """The lines of a program for a machine."""

    def post(text: str, machine: str) -> list[str]:
        (tmp_path / "part.cls").write_text(text, encoding="utf-8")
        file = tmp_path / "part.nc"
        assert main(["post", str(tmp_path / "part.cls"), "--machine", machine, "--output", str(file)]) == 0
        return file.read_text(encoding="utf-8").splitlines()

    return post


@pytest.fixture
def turns(tmp_path: Path) -> Callable[..., tuple[bool, str, list[int]]]:
    """Whether the check passes for lines of a program, its summary, and the lines that it names."""

    def judge(lines: list[str], machine: str, **more: object) -> tuple[bool, str, list[int]]:
        file = tmp_path / "changed.nc"
        file.write_text("\n".join(lines) + "\n", encoding="utf-8")
        found = check(verify(file, machine=machine, **more), "turns")  # type: ignore[arg-type]
        return found.passed, found.summary, [place.nc_line for place in found.places]

    return judge


Turns = Callable[..., tuple[bool, str, list[int]]]


def between_planes(lines: list[str], retract: str) -> list[int]:
    """The blocks that retract between two planes: not the first ones, and not the last."""
    at = [k for k, line in enumerate(lines) if line.split(" ", 1)[-1] == retract or line.endswith(retract)]
    holes = [k for k, line in enumerate(lines) if "CYCLE81" in line or "CYCL DEF 200" in line or "-20." in line]
    return [k for k in at if holes[0] < k < at[-1]]


@pytest.mark.third
@pytest.mark.parametrize("machine", sorted(RETRACTS))
@pytest.mark.parametrize("with_cl", [True, False])
def test_a_retract_missing_before_the_tilt_is_found(
    program: Programs, turns: Turns, tmp_path: Path, machine: str, with_cl: bool
) -> None:
    lines = program(BLOCK, machine)
    cl = {"cl": [tmp_path / "part.cls"]} if with_cl else {}
    passed, summary, _ = turns(lines, machine, **cl)
    assert passed, summary
    found = between_planes(lines, RETRACTS[machine])
    assert len(found) == 2
    for k in found:
        passed, summary, _ = turns(lines[:k] + lines[k + 1 :], machine, **cl)
        assert not passed, summary
        assert "at the part" in summary


@pytest.mark.third
@pytest.mark.parametrize("machine", sorted(RETRACTS))
def test_a_retract_to_another_place_is_no_retract(program: Programs, turns: Turns, machine: str) -> None:
    """The tool goes up by a little instead, in the workpiece's coordinates."""
    lines = program(BLOCK, machine)
    k = between_planes(lines, RETRACTS[machine])[0]
    word = {"dmu65": "L Z+31 R0 FMAX", "hs664rt": "G1 Z31. F3000"}.get(machine, "G0 Z31.")
    assert not turns([*lines[:k], word, *lines[k + 1 :]], machine)[0]


def test_turning_the_table_alone_is_judged_by_the_distance_from_the_turned_part(
    program: Programs, turns: Turns
) -> None:
    """As the published program does it, where the tool is outside what the part sweeps."""
    holes = "".join(hole((0, -100, -50), FRONT, 60.0) + hole((100, 0, -50), RIGHT, 60.0))
    lines = program(HEAD + holes + "END-OF-PATH\n", "hs664rt")
    assert sum("M242" in line for line in lines) == 3, "the corner of the box sweeps by closer than 20 mm"
    far = "".join(hole((0, -100, -50), FRONT, 90.0) + hole((100, 0, -50), RIGHT, 90.0))
    lines = program(HEAD + far + "END-OF-PATH\n", "hs664rt")
    assert sum("M242" in line for line in lines) == 2
    passed, summary, _ = turns(lines, "hs664rt")
    assert passed
    # The box's corner is 103 sqrt(2) mm from the axis, counted from where the feed begins; the tool is 190 mm from it.
    assert "1 44.3 mm or more from the turned part (at least 20)" in summary
    lower = [line.replace("Z190.", "Z150.") for line in lines]
    passed, summary, _ = turns(lower, "hs664rt")
    assert not passed
    assert "4.3 mm from the turned part and not 20" in summary


def test_with_a_known_zero_the_number_decides_for_a_tilt(program: Programs, turns: Turns) -> None:
    lines = program(BLOCK, "dmu65")
    k = between_planes(lines, RETRACTS["dmu65"])[0]
    for height, safe in ((31, False), (60, False), (150, True)):
        changed = [*lines[:k], f"L Z+{height} R0 FMAX", *lines[k + 1 :]]
        passed, summary, _ = turns(changed, "dmu65", zero=(0.0, 0.0, 300.0))
        assert passed is safe, summary
        assert not turns(changed, "dmu65")[0], "without the zero nobody knows where the part turns to"


def test_stock_that_the_program_states_counts(program: Programs, turns: Turns) -> None:
    """BLK FORM: the corner of the stock is farther out than any hole."""
    far = "".join(hole((0, -100, -50), FRONT, 90.0) + hole((100, 0, -50), RIGHT, 90.0))
    lines = program(HEAD + far + "END-OF-PATH\n", "dmu65")
    k = between_planes(lines, RETRACTS["dmu65"])[0]
    without = [*lines[:k], *lines[k + 1 :]]
    assert turns(without, "dmu65", zero=(0.0, 0.0, 300.0))[0]
    stock = ["BLK FORM 0.1 Z X-180 Y-180 Z-300", "BLK FORM 0.2 X+180 Y+180 Z+0"]
    passed, summary, _ = turns([without[0], *stock, *without[1:]], "dmu65", zero=(0.0, 0.0, 300.0))
    assert not passed, summary


def test_a_program_with_positions_of_its_own_retracts_to_the_highest(program: Programs, turns: Turns) -> None:
    lines = [line.replace("Z+560 R0 FMAX M91", "Z+540 R0 FMAX M91") for line in program(BLOCK, "dmu65")]
    assert turns(lines, "dmu65")[0]
    k = between_planes(lines, "L Z+540 R0 FMAX M91")[0]
    for low in ("L Z+200 R0 FMAX M91", "L Z+31 R0 FMAX"):
        assert not turns([*lines[:k], low, *lines[k + 1 :]], "dmu65")[0]


def test_a_tool_change_in_a_klartext_plane_is_found(tmp_path: Path) -> None:
    file = tmp_path / "block.h"
    again = "TOOL PATH/AGAIN,TOOL,DRILL_6\n" + BLOCK.split("\n", 1)[1].replace("LOAD/TOOL,1", "LOAD/TOOL,2")
    (tmp_path / "block.cls").write_text(BLOCK + again)
    assert main(["post", str(tmp_path / "block.cls"), "--machine", "dmu65", "--output", str(file)]) == 0
    lines = file.read_text().splitlines()
    changes = [n for n, line in enumerate(lines) if "TOOL CALL 2" in line]
    last = max(n for n, line in enumerate(lines) if "PLANE SPATIAL" in line and n < changes[0])
    left = [line for n, line in enumerate(lines) if not ("PLANE RESET" in line and last < n < changes[0])]
    file.write_text("\n".join(left) + "\n")
    found = verify(file, machine="dmu65")

    assert not found.passed
    assert "changes the tool in a tilted plane" in " ".join(place.text for place in check(found, "turns").places)
