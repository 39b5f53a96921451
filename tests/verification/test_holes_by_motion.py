"""Rapids that are lost from holes which motions of the program drill."""

import re
from pathlib import Path

import pytest

import trunnion
from tests.support.locations import GOLDEN
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


def test_a_rapid_back_that_ends_too_early_is_a_fault(tmp_path: Path) -> None:
    text = (GOLDEN / "linuxcnc" / "plate.expected.ngc").read_text(encoding="utf-8")
    assert "N320 Z-11.5\n" in text
    for height, passes in (("-9.5", True), ("-1.5", False)):
        program = tmp_path / "other.ngc"
        program.write_text(text.replace("N320 Z-11.5\n", f"N320 Z{height}\n"), encoding="utf-8")
        found = trunnion.verify(program, machine="xyzac_trt", cl=GOLDEN / "linuxcnc" / "plate.cls")
        holes = next(check for check in found.checks if check.key == "holes")
        assert holes.passed is passes
        assert passes or "10.5000 mm where nothing is left to drill: the rapid back is missing" in holes.summary


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


_MACHINES = ["yl569", "dmu65", "matsuura_mx330", "haas_umc750", "hs664rt", "xyzac_trt", "linuxcnc_5axis"]


class _Holes:
    """Two holes by motion, under TCP: the lines of the program, and what fails in others."""

    def __init__(self, machine: str, path: str, folder: Path) -> None:
        self._machine, self._source, self._program = machine, folder / "holes.cls", folder / "holes.nc"
        self._source.write_text(path, encoding="utf-8")
        posted = trunnion.post(self._source, machine=machine, settings={"mode": "tcp", "cycles": "off"})
        self.lines = (posted.text or "").splitlines()

    def line(self, word: str) -> int:
        """The first line with a word, as each machine writes it."""
        letter, number = word[0], word[1:].lstrip("+")
        pattern = rf"{letter}\+?{re.escape(number)}(\.0*)?( |$)"
        return next(k for k, line in enumerate(self.lines) if re.search(pattern, line))

    def failing_with(self, k: int, old: str, new: str) -> set[str]:
        """The checks that fail where line ``k`` has one more before it: the same, but with another word."""
        more = re.sub(rf"{old[0]}\+?{re.escape(old[1:])}(\.0*)?( |$)", f"{new} ", self.lines[k], count=1).rstrip()
        rest = re.sub(r" F[\d.]+$", "", self.lines[k])
        text = "\n".join([*self.lines[:k], more, rest, *self.lines[k + 1 :], ""])
        self._program.write_text(text, encoding="utf-8")
        found = trunnion.verify(self._program, machine=self._machine, cl=self._source)
        return {check.key for check in found.checks if check.state == "FAIL"}


@pytest.mark.third
@pytest.mark.parametrize("retract", ["RTRCTO,10,", ""])
@pytest.mark.parametrize("machine", _MACHINES)
def test_a_rapid_between_holes_may_be_made_in_pieces(machine: str, retract: str, tmp_path: Path) -> None:
    holes = _Holes(machine, PATHS["two_holes"].replace("RTRCTO,10,", retract), tmp_path)
    across = holes.line("X-15")
    point = "" if machine == "dmu65" else "."
    assert holes.failing_with(across, "X-15", f"X-1{point}") == set()
    assert "order" in holes.failing_with(across, "X-15", f"X-20{point}")
    assert "order" in holes.failing_with(across, "X-15", f"X20{point}".replace("X20", "X+20"))
    assert "order" in holes.failing_with(across, "X-15", f"X-1{point} Y+11{point}")
    assert holes.failing_with(across, "X-15", f"X-1{point} Z+1{point}")


@pytest.mark.third
@pytest.mark.parametrize("machine", _MACHINES)
def test_a_line_into_a_hole_may_be_made_in_pieces(machine: str, tmp_path: Path) -> None:
    holes = _Holes(machine, PATHS["two_holes"], tmp_path)
    point = "" if machine == "dmu65" else "."
    plunge = holes.line("Z-8")
    assert holes.failing_with(plunge, "Z-8", f"Z-4{point}") == set()
    assert "holes" in holes.failing_with(plunge, "Z-8", f"Z-9{point}")


@pytest.mark.parametrize("mode", ["DEEP", "BRKCHP"])
def test_a_peck_may_be_made_in_pieces_but_no_two_pecks_be_joined(mode: str, tmp_path: Path) -> None:
    path = PATHS["two_holes"].replace("DRILL,RAPTO,3,FEDTO,-8", f"DRILL,{mode},RAPTO,3,FEDTO,-8,STEP,4")
    holes = _Holes("linuxcnc_5axis", path, tmp_path)
    first, second = holes.line("Z-4"), holes.line("Z-8")
    assert first < second
    assert holes.failing_with(second, "Z-8", "Z-6.") == set()
    retracts = slice(first + 1, second)
    del holes.lines[retracts]
    lost = first + 1
    assert "holes" in holes.failing_with(lost, "Z-8", "Z-7.")
