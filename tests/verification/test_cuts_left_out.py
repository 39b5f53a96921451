"""A program that leaves the path in a cut, or goes on to an operation without a retract, is no proven one."""

from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest

import trunnion
from tests.support.verifying import CL_FOOT, CL_HEAD, check

#: A line and an arc at feed, and an operation with the same tool.
CL = (
    CL_HEAD
    + "GOTO/0.0,0.0,-1.0\nGOTO/10.0,0.0,-1.0\nGOTO/20.0,12.5,-2.25\n"
    + "CIRCLE/30.0,12.5,-2.25,0.0,0.0,1.0,10.0,0.06,0.5,16.0,0.0\nGOTO/30.0,2.5,-2.25\nGOTO/30.0,2.5,30.0\n"
    + CL_FOOT
    + CL_HEAD.replace("OP1", "OP2").replace("0.0,0.0,50.0", "5.0,40.0,40.0")
    + "GOTO/5.0,40.0,-1.0\nGOTO/15.0,40.0,-1.0\nGOTO/15.0,40.0,30.0\n"
    + CL_FOOT
)

Posted = Callable[[str], tuple[Path, list[str]]]


@pytest.fixture(scope="module")
def posted(tmp_path_factory: pytest.TempPathFactory) -> Posted:
    """A CL file, and the lines of its program for a machine: each is posted once."""
    cl = tmp_path_factory.mktemp("part") / "part.cls"
    cl.write_text(CL)

    @cache
    def post(machine: str) -> tuple[Path, list[str]]:
        program = cl.with_name(f"{machine}.nc")
        trunnion.post(cl, machine=machine, output=program)
        return cl, program.read_text().splitlines()

    return post


def verified(tmp_path: Path, machine: str, cl: Path, lines: list[str]) -> trunnion.Verification:
    changed = tmp_path / ("changed.h" if machine == "dmu65" else "changed.nc")
    changed.write_text("\n".join(lines) + "\n")
    return trunnion.verify(changed, machine=machine, cl=cl)


def first_with(lines: list[str], text: str) -> int:
    return next(k for k, line in enumerate(lines) if text in line)


@pytest.mark.parametrize(
    ("machine", "words"),
    [
        ("matsuura_mx330", "G28 Z0."),
        ("matsuura_mx330", "G30 P2 Z0."),
        ("matsuura_mx330", "G53 G0 Z0."),
        ("haas_umc750", "G53 G0 Z0."),
        ("yl569", "SUPA G0 Z0 D0"),
        ("dmu65", "L Z+0 R0 FMAX M91"),
        ("dmu65", "L M140 MB MAX"),
        ("linuxcnc_5axis", "G53 G0 Z0"),
        ("hs664rt", "M242"),
    ],
)
def test_the_cut_from_the_point_that_is_left_is_missing(
    machine: str, words: str, posted: Posted, tmp_path: Path
) -> None:
    cl, lines = posted(machine)
    cut = first_with(lines, "12.5")
    feed = {"dmu65": "L X+20 Y+12.5 Z-2.25", "yl569": "G1 X20. Y12.5 Z-2.25 D1"}.get(machine, "G1 X20. Y12.5 Z-2.25")
    found = check(verified(tmp_path, machine, cl, [*lines[:cut], words, feed, *lines[cut + 1 :]]), "order")
    assert not found.passed
    assert [place.nc_line for place in found.places] == [cut + 1]
    wanted = "the cut from X10.000 Y0.000 Z-1.000 to there is not made"
    assert found.places[0].text.startswith("leaves the path and goes on in ")
    assert found.places[0].text.endswith(wanted)


def test_so_is_an_arc(posted: Posted, tmp_path: Path) -> None:
    cl, lines = posted("matsuura_mx330")
    arc = first_with(lines, "G3 ")
    from_home = ["G53 G0 Z0.", "G3 X30. Y2.5 Z-2.25 I10. J0."]
    found = check(verified(tmp_path, "matsuura_mx330", cl, [*lines[:arc], *from_home, *lines[arc + 1 :]]), "order")
    assert [place.nc_line for place in found.places] == [arc + 1]


def test_words_that_leave_no_cut_are_none(posted: Posted, tmp_path: Path) -> None:
    """A stop, a dwell, or a way home after the last point of an operation."""
    cl, lines = posted("matsuura_mx330")
    cut = first_with(lines, "12.5")
    assert check(verified(tmp_path, "matsuura_mx330", cl, [*lines[:cut], "G4 P500", *lines[cut:]]), "order").passed
    end = max(k for k, line in enumerate(lines) if "Z30." in line)
    assert check(
        verified(tmp_path, "matsuura_mx330", cl, [*lines[: end + 1], "G53 G0 Z0.", *lines[end + 1 :]]), "order"
    ).passed


@pytest.mark.parametrize(
    ("machine", "home"),
    [
        ("matsuura_mx330", "G53 G0 Z0."),
        ("haas_umc750", "G53 G0 Z0."),
        ("yl569", "SUPA G0 Z"),
        ("dmu65", "M91"),
        ("linuxcnc_5axis", "G53 G0 Z0"),
        ("hs664rt", "M242"),
    ],
)
def test_an_operation_with_the_same_tool_begins_from_home(
    machine: str, home: str, posted: Posted, tmp_path: Path
) -> None:
    cl, lines = posted(machine)
    sound = verified(tmp_path, machine, cl, lines)
    assert check(sound, "home").passed
    assert sound.cl_line is not None
    rows = {
        int(cl_line): int(line) - 1
        for cl_line, line in zip(sound.cl_line.tolist(), sound.run.line.tolist(), strict=True)
    }
    last = rows[1 + CL.splitlines().index("GOTO/30.0,2.5,30.0")]
    first = rows[1 + CL.splitlines().index("GOTO/5.0,40.0,40.0,0.0,0.0,1.0")]
    lost = [line for line in lines[last + 1 : first] if home not in line]
    assert len(lost) < first - last - 1
    found = check(verified(tmp_path, machine, cl, [*lines[: last + 1], *lost, *lines[first:]]), "home")
    assert not found.passed
    assert any("goes on to the operation OP2 without a retract" in place.text for place in found.places)
