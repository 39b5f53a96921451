"""What single CL statements become in programs: stops, compensation, inverse-time feeds, coolant, shallow holes."""

from pathlib import Path

import numpy as np
import pytest

import trunnion
from tests.support.posting import CLEAR, FOOT, HEAD

#: One machine of each family of controls.
MACHINES = ("yl569", "dmu65", "matsuura_mx330", "hs664rt", "xyzac_trt")


def posted(folder: Path, text: str, machine: str = "yl569") -> trunnion.PostResult:
    (folder / "part.cls").write_text(text)
    result = trunnion.post(folder / "part.cls", machine=machine)
    assert result.passed
    return result


def words(result: trunnion.PostResult) -> list[str]:
    assert result.text is not None
    blocks = [line.lstrip("N0123456789 ") for line in result.text.splitlines()]
    return " ".join(block for block in blocks if not block.startswith((";", "("))).split()


@pytest.mark.parametrize("machine", MACHINES)
def test_the_spindle_stands_at_a_stop_and_turns_again_before_the_next_motion(tmp_path: Path, machine: str) -> None:
    result = posted(tmp_path, HEAD + "STOP/turn the part\nGOTO/20,0,5\nGOTO/30,0,5\n" + FOOT, machine)
    run = result.run
    assert run is not None
    (stop,) = (event for event in run.events if event.kind == "stop")
    switched = [(e.before_row, e.value) for e in run.events if e.kind == "spindle" and e.before_row <= stop.before_row]
    assert switched[-2][1] == "off" or switched[-1][1] == "off" or run.spindle[stop.before_row] == 1
    found = words(result)
    at = found.index("M0")
    assert "M5" in found[:at]
    assert "M3" in found[at:]
    assert run.spindle[stop.before_row] == 1


def test_an_optional_stop_and_a_standing_spindle_stay_as_they_are(tmp_path: Path) -> None:
    found = words(posted(tmp_path, HEAD + "OPSTOP\nGOTO/20,0,5\n" + FOOT))
    assert found.count("M5") == 1
    found = words(posted(tmp_path, HEAD + "RAPID\nGOTO/20,0,50\nSPINDL/OFF\nSTOP\nSPINDL/ON\nGOTO/30,0,50\n" + FOOT))
    assert (found.count("M5"), found.count("M3")) == (2, 2)


def test_a_stop_at_the_end_starts_nothing(tmp_path: Path) -> None:
    found = words(posted(tmp_path, HEAD + "STOP\n" + FOOT))
    assert found.count("M3") == 1


def test_a_stop_between_holes_starts_the_spindle_for_the_next_one(tmp_path: Path) -> None:
    holes = "CYCLE/DRILL,RAPTO,3,FEDTO,-10,MMPM,100\nGOTO/50,0,0\nSTOP\nGOTO/60,0,0\nCYCLE/OFF\n"
    for machine in MACHINES:
        found = words(posted(tmp_path, CLEAR + holes + FOOT, machine))
        assert "M3" in found[found.index("M0") :]


def test_compensation_before_the_first_point_names_its_register(tmp_path: Path) -> None:
    cut = "GOTO/20,0,5\nCUTCOM/OFF\nGOTO/30,0,5\n"
    for given, register in (("", "D1"), (",5", "D5")):
        text = HEAD.replace("RAPID\n", f"CUTCOM/LEFT{given}\nRAPID\n", 1) + cut + FOOT
        found = words(posted(tmp_path, text, "matsuura_mx330"))
        assert register in found[found.index("G41") + 1 :][:2]
        assert [word for word in found if word.startswith("D")] == [register]


@pytest.mark.parametrize("machine", ["yl569", "dmu65", "hs664rt", "xyzac_trt"])
def test_a_register_that_a_control_cannot_name_is_refused(tmp_path: Path, machine: str) -> None:
    text = HEAD + "CUTCOM/LEFT,5\nGOTO/20,0,5\nCUTCOM/OFF\nGOTO/30,0,5\n" + FOOT
    with pytest.raises(trunnion.InputError, match=r"12: error: CUTCOM names the register 5"):
        posted(tmp_path, text, machine)
    assert posted(tmp_path, text.replace("LEFT,5", "LEFT,1"), machine).passed


@pytest.mark.parametrize("word", ["INVERS,2.0", "2.0,INVERS"])
def test_inverse_time_is_one_over_the_minutes_of_each_move(tmp_path: Path, word: str) -> None:
    moves = "GOTO/20,0,5\nCIRCLE/20,10,5,0,0,1,10\nGOTO/30,10,5\nFEDRAT/MMPM,300\nGOTO/30,20,5\n"
    result = posted(tmp_path, HEAD + f"FEDRAT/{word}\n" + moves + FOOT)
    feed = result.toolpaths[0].operations[0].moves.feed
    assert feed[-3:] == pytest.approx([20.0, 2.0 * np.pi * 5.0, 300.0])


def test_inverse_time_where_nothing_moves_or_for_holes_is_refused(tmp_path: Path) -> None:
    with pytest.raises(trunnion.InputError, match=r"13: error: FEDRAT/INVERS for a move whose length is not known"):
        posted(tmp_path, HEAD + "FEDRAT/INVERS,2\nGOTO/10.0,0.0,5.0,0.0,0.6,0.8\n" + FOOT)
    with pytest.raises(trunnion.TrunnionError, match="CYCLE without a feed"):
        posted(tmp_path, CLEAR + "FEDRAT/INVERS,2\nCYCLE/DRILL,RAPTO,3,FEDTO,-10\nGOTO/50,0,0\nCYCLE/OFF\n" + FOOT)
    with pytest.raises(trunnion.InputError, match="FEDRAT/INVERS,AUTO is not a known feed"):
        posted(tmp_path, HEAD + "FEDRAT/INVERS,AUTO\nGOTO/10.0,0.0,5.0\n" + FOOT)


@pytest.mark.parametrize("machine", ["matsuura_mx330", "hs664rt", "xyzac_trt"])
def test_a_coolant_without_a_code_names_the_key_to_write(tmp_path: Path, machine: str) -> None:
    text = HEAD + "COOLNT/THRU\nGOTO/20,0,5\n" + FOOT
    with pytest.raises(trunnion.InputError) as caught:
        posted(tmp_path, text, machine)
    assert "THRU = … under [control.coolant]" in str(caught.value)
    if machine == "xyzac_trt":
        return  # LinuxCNC has no M code for it
    own = tmp_path / "own.toml"
    own.write_text(f'extends = "{machine}"\n[control.coolant]\nTHRU = 88\n')
    assert "M88" in words(posted(tmp_path, text, str(own)))


@pytest.mark.third
@pytest.mark.parametrize("machine", MACHINES)
@pytest.mark.parametrize("tilt", ["0.0,0.0,1.0", "0.6,0.0,0.8"])
@pytest.mark.parametrize("statement", ["SPINDL/RPM,4000.0000,CLW\n", "COOLNT/ON\n", "CUTCOM/LEFT\n"])
def test_a_statement_that_is_said_twice_is_written_where_one_is(
    tmp_path: Path, machine: str, tilt: str, statement: str
) -> None:
    cut = "GOTO/20,4,5\nCUTCOM/OFF\nGOTO/30,4,5\n"
    text = HEAD.replace("0.0,50.0,0.0,0.0,1.0", f"4.0,50.0,{tilt}").replace("10.0,0.0,5.0", "10.0,4.0,5.0") + cut + FOOT
    text = text if statement in text else text.replace("RAPID\n", f"{statement}RAPID\n", 1)
    twice = text.replace(statement, 2 * statement, 1)
    if "CUTCOM" in statement and machine == "xyzac_trt" and "0.6" in tilt:
        with pytest.raises(trunnion.InputError, match="it would offset along the tool"):
            posted(tmp_path, twice, machine)
        return  # with TCP, and without planes, there is no compensation where the tool leans
    assert words(posted(tmp_path, twice, machine)) == words(posted(tmp_path, text, machine))


@pytest.mark.parametrize("machine", MACHINES)
def test_a_hole_of_no_depth_is_made_as_motion_to_its_point(tmp_path: Path, machine: str) -> None:
    holes = "CYCLE/DRILL,RAPTO,3,FEDTO,0,RTRCTO,20,MMPM,100\nGOTO/50,0,0\nGOTO/60,0,0\nCYCLE/OFF\n"
    result = posted(tmp_path, CLEAR + holes + FOOT, machine)
    assert result.run is not None
    assert {50.0, 60.0} <= {float(x) for x, z in result.run.tip[:, ::2].round(6) if z == 0.0}


@pytest.mark.parametrize(
    "cycle", ["DRILL,RAPTO,0,FEDTO,0", "TAP,RAPTO,3,FEDTO,0,MMPR,1", "DRILL,DEEP,RAPTO,3,FEDTO,0,STEP,1"]
)
def test_a_cycle_that_would_make_nothing_is_refused(tmp_path: Path, cycle: str) -> None:
    with pytest.raises(trunnion.TrunnionError, match="FEDTO,0, which leaves nothing to make"):
        posted(tmp_path, CLEAR + f"CYCLE/{cycle}\nGOTO/50,0,0\nCYCLE/OFF\n" + FOOT)


def test_a_tilted_msys_of_the_first_operation_is_named_where_axes_are_out_of_reach(tmp_path: Path) -> None:
    flipped = HEAD.replace("0.0000000,1.0000000,0.0000000\n", "0.0000000,-1.0000000,0.0000000\n")
    with pytest.raises(trunnion.RefusedError, match=r"setting frame=absolute: .* tilted by 180 degrees"):
        posted(tmp_path, flipped + FOOT + HEAD.replace("OP1", "OP2") + FOOT)
    (tmp_path / "part.cls").write_text(HEAD.replace("0.0,0.0,1.0", "0.0,0.0,-1.0") + FOOT)
    with pytest.raises(trunnion.RefusedError) as caught:
        trunnion.post(tmp_path / "part.cls", machine="yl569")
    assert "frame=absolute" not in str(caught.value)


def test_a_warning_comes_once_with_its_number(tmp_path: Path) -> None:
    result = posted(tmp_path, HEAD + "FEDRAT/MMPM,0\nFEDRAT/MMPM,500\nGOTO/20,0,5\n" * 62 + FOOT)
    (warning,) = (problem.what for problem in result.problems if "FEDRAT is 0" in problem.what)
    assert "(62 times, first here)" in warning


@pytest.mark.parametrize("machine", MACHINES)
@pytest.mark.parametrize("stands", ["STOP\n", "SPINDL/OFF\n"])
def test_a_dwell_in_revolutions_of_a_spindle_that_stands_is_refused(tmp_path: Path, machine: str, stands: str) -> None:
    with pytest.raises(trunnion.InputError, match="a dwell in spindle revolutions while the spindle stands"):
        posted(tmp_path, HEAD + FOOT.replace("END-OF-PATH", f"{stands}DELAY/2,REV\nEND-OF-PATH"), machine)
