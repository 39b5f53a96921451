"""Rapids that are lost from holes which motions of the program drill."""

import re
from pathlib import Path

import pytest

import trunnion
from tests.support.recall_proof.parts import cl_text
from tests.support.two_operations import PATHS


@pytest.fixture(scope="module")
def holes(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, list[str]]:
    """Deep holes along tilted axes, for which LinuxCNC has no cycles: the CL file, and the lines of the program."""
    folder = tmp_path_factory.mktemp("holes")
    cl, program = folder / "holes.cls", folder / "holes.ngc"
    cl.write_text(cl_text("tilted_holes"), encoding="utf-8")
    trunnion.post(cl, machine="xyzac_trt", output=program)
    return cl, program.read_text(encoding="utf-8").splitlines()


def _without(holes: tuple[Path, list[str]], pattern: str, folder: Path) -> str:
    """What the check of holes says of the program without its first line of a pattern."""
    cl, lines = holes
    at = next(k for k, line in enumerate(lines) if re.search(pattern, line))
    program = folder / "other.ngc"
    program.write_text("\n".join([*lines[:at], *lines[at + 1 :], ""]), encoding="utf-8")
    found = trunnion.verify(program, machine="xyzac_trt", cl=cl)
    return next(check.summary for check in found.checks if check.key == "holes")


@pytest.mark.parametrize(
    ("pattern", "said"),
    [
        (r"^N290 X10\.09568 Y5\.80288", "down at once: a rapid between holes is missing"),
        (r"^N890 X-10\.63469 Y-15\.57668", "down at once: a rapid between holes is missing"),
        (r"^N200 X1\.19173", "mm where nothing is left to drill: the rapid back is missing"),
        (r"^N490 X-7\.80462", "mm where nothing is left to drill: the rapid back is missing"),
    ],
)
def test_a_lost_rapid_of_holes_by_motion_is_a_fault(
    holes: tuple[Path, list[str]], pattern: str, said: str, tmp_path: Path
) -> None:
    assert said in _without(holes, pattern, tmp_path)


@pytest.mark.parametrize("machine", ["yl569", "dmu65", "matsuura_mx330", "haas_umc750", "hs664rt"])
def test_holes_without_cycles_pass_on_every_control(machine: str, tmp_path: Path) -> None:
    for part in ("pecks", "spots", "reamed"):
        cl = tmp_path / f"{part}.cls"
        cl.write_text(cl_text(part), encoding="utf-8")
        trunnion.post(cl, machine=machine, settings={"cycles": "off"})


@pytest.mark.parametrize("machine", ["yl569", "dmu65", "matsuura_mx330", "haas_umc750", "hs664rt", "linuxcnc_5axis"])
def test_from_a_retract_the_tool_goes_straight_to_a_hole_in_another_plane(machine: str, tmp_path: Path) -> None:
    source = tmp_path / "holes.cls"
    source.write_text(PATHS["holes"], encoding="utf-8")
    assert trunnion.post(source, machine=machine, settings={"mode": "tcp"}).passed
