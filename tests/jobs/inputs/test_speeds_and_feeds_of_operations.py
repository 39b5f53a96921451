"""Speeds and feeds that settings state: each holds for its operation alone, and each tool has one of its own."""

from pathlib import Path

import pytest

import trunnion
from tests.support.posting import FOOT, HEAD
from trunnion.cli import main
from trunnion.errors import InputError, RefusedError, Severity

_SPEED = "SPINDL/RPM,4000.0000,CLW\n"
_FEED = "FEDRAT/MMPM,500.0\n"
MACHINES = ["matsuura_mx330", "haas_umc750", "xyzac_trt", "hs664rt", "yl569", "dmu65"]


def _operation(name: str, number: int, *, cycle: str = "", speed: str = "", feed: str = _FEED) -> str:
    """Return an operation with a tool of its own: a cut, or two holes."""
    text = HEAD.replace("OP1", name).replace("D10", f"T{number}").replace("TOOL,1,ADJUST,1", f"TOOL,{number}")
    text = text.replace(_SPEED, speed).replace(_FEED, feed)
    holes = f"RAPID\nGOTO/0,0,50\n{cycle}\nGOTO/10,0,0\nGOTO/20,0,0\nCYCLE/OFF\nRAPID\nGOTO/20,0,50\n"
    return text + (holes if cycle else "") + FOOT


DRILL = "CYCLE/DRILL,FEDTO,-10,RAPTO,3,MMPM,100"
TAP = "CYCLE/TAP,FEDTO,-10,RAPTO,3,MMPR,1.0"
BARE_TAP = "CYCLE/TAP,FEDTO,-10,RAPTO,3"


def _only_holes(name: str, number: int, cycle: str) -> str:
    """Return an operation of two holes without a cut and a speed."""
    head = f"TOOL PATH/{name},TOOL,T{number}\nTLDATA/MILL,10,0,75,0,0\nLOAD/TOOL,{number}\nMSYS/0,0,0,1,0,0,0,1,0\n"
    holes = f"RAPID\nGOTO/0,0,50\n{cycle}\nGOTO/10,0,0\nGOTO/20,0,0\nCYCLE/OFF\nRAPID\nGOTO/20,0,50\n"
    return head + holes + FOOT


@pytest.fixture
def part(tmp_path: Path) -> Path:
    """The file to post, to be written."""
    return tmp_path / "part.cls"


@pytest.mark.parametrize("machine", MACHINES)
def test_the_speed_of_one_operation_is_not_that_of_the_next(part: Path, machine: str) -> None:
    part.write_text(_operation("FACE", 1) + _only_holes("TAP", 2, TAP) + _operation("TILT", 3))
    settings = {"spindle": "3000,TAP:400"}
    found = trunnion.post(part, machine=machine, settings=settings)
    assert found.passed
    assert found.text is not None
    speeds = [word[1:] for word in found.text.replace("=", "").split() if word[:1] == "S" and word[1:].isdigit()]
    assert [each for k, each in enumerate(speeds) if not k or each != speeds[k - 1]] == ["3000", "400", "3000"]


def test_a_speed_stated_for_one_operation_is_refused_in_the_next(part: Path) -> None:
    part.write_text(_operation("FACE", 1) + _only_holes("HOLES", 2, DRILL) + _operation("TILT", 3))
    with pytest.raises(InputError) as caught:
        trunnion.post(part, machine="yl569", settings={"spindle": "FACE:3000"})
    assert [each.wording.parameter("operation") for each in caught.value.problems if each.code == "CTL510"] == [
        "HOLES",
        "TILT",
    ]


def test_the_same_tool_goes_on_at_its_speed(part: Path) -> None:
    part.write_text(_operation("FACE", 1) + _operation("SIDE", 1))
    found = trunnion.post(part, machine="yl569", settings={"spindle": "FACE:3000"})
    assert found.passed


def test_holes_with_the_speed_of_another_tool_are_told(part: Path) -> None:
    part.write_text(
        _operation("FACE", 1, speed=_SPEED) + _only_holes("HOLES", 2, DRILL) + _only_holes("THREAD", 3, TAP)
    )
    found = trunnion.post(part, machine="yl569")
    said = [each for each in found.problems if each.code == "CTL520"]
    assert [each.wording.parameter("operation") for each in said] == ["HOLES", "THREAD"]
    assert {each.severity for each in said} == {Severity.WARNING}
    found = trunnion.post(part, machine="yl569", settings={"spindle": "HOLES:1500,THREAD:300"})
    assert not [each for each in found.problems if each.code == "CTL520"]


@pytest.mark.parametrize("machine", MACHINES)
def test_a_speed_at_which_nothing_cuts_is_replaced_and_told(part: Path, machine: str) -> None:
    part.write_text(_only_holes("THREAD", 1, TAP).replace("RAPID", "SPINDL/RPM,0.398,CLW\nRAPID", 1))
    found = trunnion.post(part, machine=machine, settings={"spindle": "THREAD:398"})
    assert found.passed
    assert [each.code for each in found.problems if "0.398" in each.what] == ["CTL320"]
    assert found.text is not None
    assert "S398" in found.text.replace("=", "")


@pytest.mark.parametrize("speed", ["398", "THREAD:-398"])
def test_a_low_speed_is_replaced_only_as_its_operation_and_sense_are_stated(part: Path, speed: str) -> None:
    part.write_text(_only_holes("THREAD", 1, TAP).replace("RAPID", "SPINDL/RPM,0.398,CLW\nRAPID", 1))
    with pytest.raises((InputError, RefusedError), match=r"prints as 0|turns otherwise"):
        trunnion.post(part, machine="yl569", settings={"spindle": speed})


def test_every_operation_without_a_speed_or_feed_is_asked_at_once(
    part: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    part.write_text(
        _operation("FACE", 1, feed="")
        + _only_holes("HOLES", 2, "CYCLE/DRILL,FEDTO,-10,RAPTO,3")
        + _only_holes("THREAD", 3, BARE_TAP)
        + _operation("TILT", 4, feed="")
    )
    post = ["post", str(part), "--machine", "yl569", "--output", str(part.with_name("part.mpf"))]
    assert main(post) == 2
    last = capsys.readouterr().err.splitlines()[-1]
    assert "--set spindle=FACE:RPM,HOLES:RPM,THREAD:RPM,TILT:RPM" in last
    assert "--set missing_feed=FACE:MM_MIN,HOLES:MM_MIN,THREAD:PITCH_MMPR,TILT:MM_MIN" in last
    filled = ["--set", "spindle=FACE:3000,HOLES:1500,THREAD:300,TILT:3000"]
    filled += ["--set", "missing_feed=FACE:300,HOLES:100,THREAD:1.25MMPR,TILT:300"]
    assert main([*post, *filled]) == 0


@pytest.mark.parametrize("machine", MACHINES)
@pytest.mark.parametrize("feed", ["300", "THREAD:300"])
def test_a_tap_takes_no_feed_per_minute(part: Path, machine: str, feed: str) -> None:
    part.write_text(_operation("FACE", 1, speed=_SPEED) + _only_holes("THREAD", 2, BARE_TAP))
    settings = {"spindle": "THREAD:400", "missing_feed": feed}
    with pytest.raises((InputError, RefusedError), match="missing_feed=OPERATION:PITCH_MMPR"):
        trunnion.post(part, machine=machine, settings=settings)


_BOTH = "{}\nGOTO/30,0,0\n{}\nGOTO/10,0,0\nCYCLE/OFF\nRAPID\nGOTO/20,0,50\n"
BOTH = _only_holes("HOLES", 2, "").replace("\nGOTO/10,0,0\nGOTO/20,0,0\nCYCLE/OFF\nRAPID\nGOTO/20,0,50\n", _BOTH)
BARE_DRILL = "CYCLE/DRILL,FEDTO,-10,RAPTO,3"


@pytest.mark.parametrize("machine", MACHINES)
@pytest.mark.parametrize("feed", ["HOLES:120,HOLES:1.25MMPR", "120,HOLES:1.25MMPR", "HOLES:1.25MMPR,HOLES:120"])
def test_a_drill_and_a_tap_of_one_operation_have_a_feed_and_a_pitch(part: Path, machine: str, feed: str) -> None:
    part.write_text(BOTH.format(BARE_DRILL, BARE_TAP))
    program = part.with_suffix(".nc")
    settings = {"spindle": "400", "missing_feed": feed}
    assert trunnion.post(part, machine=machine, settings=settings, output=program).passed
    part.write_text(BOTH.format(f"{BARE_DRILL},MMPM,120", f"{BARE_TAP},MMPR,1.25"))
    assert trunnion.verify(program, machine=machine, cl=[part], settings={"spindle": "400"}).passed


def test_a_pitch_is_no_feed_of_the_drill_beside_the_tap(part: Path, capsys: pytest.CaptureFixture[str]) -> None:
    part.write_text(BOTH.format(BARE_DRILL, BARE_TAP))
    post = ["post", str(part), "--machine", "yl569", "--output", str(part.with_name("part.mpf"))]
    assert main([*post, "--set", "spindle=400"]) == 2
    assert "missing_feed=HOLES:MM_MIN,HOLES:PITCH_MMPR" in capsys.readouterr().err
    assert main([*post, "--set", "spindle=400", "--set", "missing_feed=HOLES:1.25MMPR"]) == 2
    assert "missing_feed=OPERATION:MM_MIN" in capsys.readouterr().err
    assert main([*post, "--set", "spindle=400", "--set", "missing_feed=HOLES:120"]) == 2
    assert "missing_feed=OPERATION:PITCH_MMPR" in capsys.readouterr().err


@pytest.mark.parametrize("feed", ["HOLES:1MMPR,HOLES:2MMPR", "HOLES:100,HOLES:200", "300,1.25MMPR"])
def test_two_feeds_of_one_kind_are_refused(part: Path, feed: str) -> None:
    part.write_text(BOTH.format(BARE_DRILL, BARE_TAP))
    with pytest.raises(InputError, match="two values"):
        trunnion.post(part, machine="yl569", settings={"spindle": "400", "missing_feed": feed})


@pytest.mark.parametrize("feed", ["300MMPR", "FACE:10.1MMPR"])
def test_a_feed_per_revolution_that_none_can_be_is_refused(part: Path, feed: str) -> None:
    part.write_text(_operation("FACE", 1, speed=_SPEED, feed=""))
    with pytest.raises(InputError, match="above 10 mm a revolution"):
        trunnion.post(part, machine="yl569", settings={"missing_feed": feed})


@pytest.mark.parametrize("name", ["TAP:1,2", "A:B=C"])
def test_an_operation_that_no_setting_can_name_is_said(
    part: Path, name: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    part.write_text(_operation("FACE", 1) + _operation(name, 2))
    monkeypatch.chdir(part.parent)
    project = Path("part.toml")
    assert main(["post", part.name, "--machine", "yl569", "--suggest", project.name]) == 2
    assert f"no setting can name {name}" in capsys.readouterr().err
    assert f"# No setting can name {name}" in project.read_text()
