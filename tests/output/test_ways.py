"""Ways between operations that are longer than the settings ask for: the post says between which, and why."""

from pathlib import Path

import pytest

import trunnion
from tests.support.two_operations import PATHS

CUTS_FIRST = PATHS["three"].replace("RAPID\nGOTO/40.0,0.0,30.0", "FEDRAT/MMPM,500.0\nGOTO/40.0,0.0,30.0")
HOLE = "CYCLE/DRILL,RAPTO,3,FEDTO,-5,MMPM,100\nGOTO/50,0,0\nCYCLE/OFF\n"
HOLES = PATHS["three"].removesuffix("END-OF-PATH\n") + HOLE + "END-OF-PATH\n"
OTHER_TOLERANCE = PATHS["three"].replace("INTOL/0.01", "INTOL/0.02", 1)
TOO_HIGH = {"operation_clearance": "500", "zero": "0,0,-200", "tool_length": "100"}

CASES = [
    (PATHS["turned"], {}, "they have different machining modes"),
    (PATHS["tcp"].replace("0.0,0.5150381,0.8571673\nEND", "0.0,0.5,0.8660254\nEND", 1), {}, "the rotary axes turn"),
    (PATHS["three"], {"stop_between": "on"}, "an optional stop stands between them (stop_between=on)"),
    (PATHS["three"], {"restart": "on"}, "each operation can be entered (restart=on)"),
    (PATHS["three"], {"work_offset": "G54,SECOND:G55"}, "these change between them: work_offset"),
    (
        PATHS["three"],
        TOO_HIGH,
        "beyond the travel of Z",
    ),
    (CUTS_FIRST, {}, "the first motion cuts"),
    (HOLES, {}, "one of them has hole cycles"),
    (OTHER_TOLERANCE, {}, "these change between them: INTOL"),
]


def warned(text: str, settings: dict[str, str], folder: Path) -> tuple[list[str], trunnion.PostResult]:
    """What the post says of ways, and its result."""
    cl = folder / "part.cls"
    cl.write_text(text, encoding="utf-8")
    result = trunnion.post(cl, machine="yl569", settings=settings)
    return [problem.what for problem in result.problems if problem.code == "CTL458"], result


@pytest.mark.parametrize(("text", "settings", "why"), CASES, ids=[why for *_, why in CASES])
def test_a_way_that_is_longer_than_asked_is_told_with_its_reason(
    text: str, settings: dict[str, str], why: str, tmp_path: Path
) -> None:
    (told,), result = warned(text, {"same_tool": "clearance", **settings}, tmp_path)
    assert result.passed
    assert "from FIRST to SECOND" in told
    assert "setting same_tool=clearance asks" in told
    assert why in told
    assert ("the axes go home" in told) == (settings.get("restart") == "on")
    assert "Z=_Z_HOME" in (result.text or "").split(";Cutting")[1]


@pytest.mark.parametrize("path", ["three", "tilted", "tcp", "tools"])
def test_a_way_as_asked_and_one_to_another_tool_are_not_told(path: str, tmp_path: Path) -> None:
    assert warned(PATHS[path], {"same_tool": "clearance"}, tmp_path)[0] == []
    assert warned(PATHS[path], {"same_tool": "retract"}, tmp_path)[0] == []
    assert warned(PATHS[path], {"stop_between": "on"}, tmp_path)[0] == []


def test_subprograms_go_home(tmp_path: Path) -> None:
    cl = tmp_path / "part.cls"
    cl.write_text(PATHS["three"], encoding="utf-8")
    settings = {"same_tool": "retract", "programs": "operations"}
    result = trunnion.post(cl, machine="yl569", settings=settings, output=tmp_path / "part.mpf")
    (told,) = [problem.what for problem in result.problems if problem.code == "CTL458"]
    assert "each operation is a subprogram of its own (programs=operations)" in told


def test_what_is_proven_of_a_longer_way_is_proven_again(tmp_path: Path) -> None:
    cl, program = tmp_path / "part.cls", tmp_path / "part.mpf"
    cl.write_text(PATHS["turned"], encoding="utf-8")
    settings = {"same_tool": "clearance"}
    trunnion.post(cl, machine="yl569", settings=settings, output=program)
    assert trunnion.verify(program, machine="yl569", cl=cl, settings=settings).passed
    assert trunnion.verify(program, machine="yl569", cl=cl).passed
