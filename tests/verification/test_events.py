"""Dwells, stops, coolant, radius compensation and tool lengths on a machine of each family, and faults in them."""

import shutil
from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest

from tests.support.verifying import CL_FOOT, CL_HEAD
from trunnion.cli import main

CUT = """COOLNT/FLOOD
GOTO/10,0,5
DELAY/1.5
GOTO/20,0,5
COOLNT/MIST
CUTCOM/LEFT
GOTO/30,10,5
GOTO/30,20,5
OPSTOP/look
CUTCOM/OFF
GOTO/40,40,5
STOP/turn the part
COOLNT/OFF
GOTO/40,40,30
"""

HOLES = """RAPID
GOTO/0,0,30
CYCLE/DRILL,RAPTO,3,FEDTO,-10,MMPM,100,DWELL,0.5
GOTO/50,0,0
DELAY/2
GOTO/60,0,0
CYCLE/OFF
RAPID
GOTO/0,0,30
"""

MACHINES = {
    "yl569": ("G4 F1.5", "G4 F2.5"),
    "dmu65": ("DWELL 1.5", "DWELL 2.5"),
    "hs664rt": ("G4 HD1.5", "G4 HD2.5"),
    "matsuura_mx330": ("G4 P1500", "G4 P2500"),
    "xyzac_trt": ("G4 P1.5", "G4 P2.5"),
}

Proving = Callable[..., set[str]]


@pytest.fixture(scope="module")
def once(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str, str], Path]:
    """Post the text of an operation for a machine, once for all tests that ask; it must be proven."""

    @cache
    def post(machine: str, text: str) -> Path:
        folder = tmp_path_factory.mktemp("posted")
        cl, program = folder / "part.cls", folder / "part.nc"
        cl.write_text(CL_HEAD + text + CL_FOOT, encoding="utf-8")
        assert main(["post", str(cl), "--machine", machine, "--output", str(program)]) == 0
        return folder

    return post


@pytest.fixture
def posted(
    once: Callable[[str, str], Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> Callable[[str, str], Path]:
    """A test's own copy of a CL file and its program."""

    def copied(machine: str, text: str) -> Path:
        for file in once(machine, text).iterdir():
            shutil.copy(file, tmp_path)
        capsys.readouterr()
        return tmp_path / "part.nc"

    return copied


@pytest.fixture
def failed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> Proving:
    """The checks that a text fails as a machine's program for the posted CL file."""

    def prove(machine: str, program: str) -> set[str]:
        path = tmp_path / "changed.nc"
        path.write_text(program, encoding="utf-8")
        main(["verify", str(path), "--machine", machine, "--cl", str(tmp_path / "part.cls"), "--tolerance", "0.002"])
        lines = capsys.readouterr().out.splitlines()
        return {line.split()[0] for line in lines if line.split()[1:2] == ["FAIL"]}

    return prove


def without(program: str, word: str) -> str:
    """The program without the last occurrence of a word; its block goes if nothing else is in it."""
    at = program.rindex(word)
    return program[:at] + program[at + len(word) :]


@pytest.mark.parametrize("machine", MACHINES)
def test_dwells_and_stops_are_proven_and_missed(
    machine: str, posted: Callable[[str, str], Path], failed: Proving
) -> None:
    program = posted(machine, CUT).read_text(encoding="utf-8")
    dwell, longer = MACHINES[machine]
    assert failed(machine, program) == set()
    assert failed(machine, program.replace(dwell, longer)) == {"stops"}
    for word, other in (("M0\n", "M1\n"), ("M1\n", "M0\n"), ("M0\n", "\n"), ("M1\n", "\n")):
        assert program.count(" " + word) == 1
        assert failed(machine, program.replace(" " + word, " " + other)) == {"stops"}, word


@pytest.mark.parametrize("machine", MACHINES)
def test_an_unexpected_stop_is_a_fault_within_an_operation_only(
    machine: str, posted: Callable[[str, str], Path], failed: Proving
) -> None:
    program = posted(machine, CUT).read_text(encoding="utf-8")
    lines = program.splitlines()
    first = next(k for k, line in enumerate(lines) if "F500" in line)
    more = [*lines[: first + 1], "M1", *lines[first + 1 :]]
    assert failed(machine, "\n".join(more) + "\n") == {"stops"}
    change = next(k for k, line in enumerate(lines) if "M6" in line or "M306" in line or "TOOL CALL" in line)
    more = [*lines[: change + 1], "M1", *lines[change + 1 :]]
    assert failed(machine, "\n".join(more) + "\n") == set()


@pytest.mark.parametrize("machine", MACHINES)
def test_dwells_in_holes_belong_to_the_holes(machine: str, posted: Callable[[str, str], Path], failed: Proving) -> None:
    program = posted(machine, HOLES).read_text(encoding="utf-8")
    assert failed(machine, program) == set()


@pytest.mark.parametrize("machine", MACHINES)
def test_radius_compensation_is_on_the_expected_side_in_the_expected_blocks(
    machine: str, posted: Callable[[str, str], Path], failed: Proving
) -> None:
    program = posted(machine, CUT).read_text(encoding="utf-8")
    left, right, off = ("RL", "RR", "R0") if machine == "dmu65" else ("G41", "G42", "G40")
    assert failed(machine, program.replace(left, right)) == {"compensation"}
    assert failed(machine, without(program, left)) == {"compensation"}
    at = program.index(left)
    later = program[:at] + program[at:].replace(off, "", 1)
    assert failed(machine, later) >= {"compensation"}


@pytest.mark.parametrize("machine", MACHINES)
def test_coolant_by_a_word_of_the_machine_builder_is_missed(
    machine: str, posted: Callable[[str, str], Path], failed: Proving
) -> None:
    program = posted(machine, CUT).read_text(encoding="utf-8")
    mist = "M25" if machine == "dmu65" else "M7"
    assert failed(machine, program.replace(mist, "", 1)) == {"coolant"}
    assert failed(machine, without(program, mist)) == {"stops"}


def test_coolant_that_stays_on_to_the_end_of_an_operation_is_reported(
    posted: Callable[[str, str], Path], failed: Proving
) -> None:
    program = posted("yl569", CUT).read_text(encoding="utf-8")
    assert program.count(" M9\n") == 1
    assert failed("yl569", program.replace(" M9\n", "\n")) == {"coolant"}


@pytest.mark.parametrize("machine", ["yl569", "dmu65"])
def test_coolant_through_the_tool_is_missed_in_each_operation(
    machine: str, posted: Callable[[str, str], Path], failed: Proving
) -> None:
    program = posted(machine, CUT.replace("COOLNT/MIST", "COOLNT/THRU")).read_text(encoding="utf-8")
    word = "M26" if machine == "yl569" else "M7"
    assert failed(machine, program) == set()
    assert failed(machine, program.replace(word, "", 1)) == {"coolant"}
    assert failed(machine, without(program, word)) == {"stops"}


@pytest.mark.parametrize("machine", ["matsuura_mx330", "xyzac_trt"])
@pytest.mark.parametrize(("text", "check"), [(CUT, "tool"), (HOLES, "holes")])
def test_the_length_of_another_tool_or_of_none_is_a_fault(
    machine: str, text: str, check: str, posted: Callable[[str, str], Path], failed: Proving
) -> None:
    program = posted(machine, text).read_text(encoding="utf-8")
    assert check in failed(machine, program.replace(" H1", " H2"))
    assert check in failed(machine, program.replace("G43 H1", ""))


@pytest.mark.parametrize("machine", MACHINES)
def test_a_rapid_that_comes_back_to_where_it_was_before_holes_is_missed(
    machine: str, posted: Callable[[str, str], Path], failed: Proving
) -> None:
    program = posted(machine, HOLES).read_text(encoding="utf-8")
    lines = program.splitlines()
    last = max(k for k, line in enumerate(lines) if "Z30" in line.replace("+", "") or "Z+30" in line)
    assert "order" in failed(machine, "\n".join(lines[:last] + lines[last + 1 :]) + "\n")


def test_whole_turns_of_a_table_make_no_difference(posted: Callable[[str, str], Path], failed: Proving) -> None:
    turned = "END-OF-PATH\nTOOL PATH/OP2,TOOL,D10\nTLDATA/MILL,10,0,75,0,0\nINTOL/0.01\nOUTTOL/0.01\nFEDRAT/MMPM,500\n"
    text = (
        "END-OF-PATH\nTOOL PATH/SIDES,TOOL,D10\nTLDATA/MILL,10,0,75,0,0\nINTOL/0.01\nOUTTOL/0.01\nRAPID\n"
        "GOTO/0,0,50,-0.5,0,0.8660254038\nFEDRAT/MMPM,500\nGOTO/0,0,5,-0.5,0.1,0.8602325267\n"
        "GOTO/1,0,5,0.5,0.1,0.8602325267\n" + turned + "RAPID\nGOTO/0,0,50,0,0,1\nGOTO/5,0,5\n"
    )
    program = posted("hs664rt", "GOTO/10,0,5\n" + text).read_text(encoding="utf-8")
    assert " C2" in program, "C stands beyond half a turn, from where home is nearer by way of 360"
    assert failed("hs664rt", program) == set()


def test_an_approach_to_a_hole_is_not_taken_for_the_point_after_it(
    posted: Callable[[str, str], Path], failed: Proving
) -> None:
    point = "GOTO/34.641554,-7.892697,-10.698013,-0.448915173576,0.685189928849,-0.573576436351\n"
    text = (
        f"RAPID\n{point}CYCLE/DRILL,DEEP,RAPTO,3,FEDTO,-12,STEP,2.5,RTRCTO,9,MMPM,90\n"
        f"GOTO/61.576465,-49.004093,23.716574\nCYCLE/OFF\nRAPID\n{point}"
    )
    program = posted("matsuura_mx330", text).read_text(encoding="utf-8")
    assert failed("matsuura_mx330", program) == set()


@pytest.mark.parametrize("machine", ["yl569", "matsuura_mx330", "xyzac_trt"])
def test_a_constant_surface_speed_is_no_feed_per_turn(
    machine: str, posted: Callable[[str, str], Path], failed: Proving
) -> None:
    program = posted(machine, "GOTO/10,0,5\nFEDRAT/MMPR,0.25\nGOTO/20,0,5\n").read_text(encoding="utf-8")
    assert failed(machine, program) == set()
    assert failed(machine, program.replace("G95 ", "G96 ")) == {"words"}
