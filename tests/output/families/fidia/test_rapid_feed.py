"""Cuts at the feed at which lines are rapids: they get the next lower feed, in the writer and its proof alike."""

from pathlib import Path

import pytest

import trunnion
from tests.support.verifying import check
from trunnion.cli import main
from trunnion.model.toolpath import Kind

CUTS = """TOOL PATH/ONE,TOOL,D10
TLDATA/MILL,10,0,75,0,0
LOAD/TOOL,1
SPINDL/RPM,1000,CLW
RAPID
GOTO/0,0,20,0,0,1
FEDRAT/MMPM,{feed}
GOTO/0,0,0,0,0,1
GOTO/10,0,0,0,0,1
GOTO/10,10,0,0.1736481777,0,0.9848077530
FEDRAT/MMPM,900
GOTO/0,10,0,0.1736481777,0,0.9848077530
RAPID
GOTO/0,10,20,0.1736481777,0,0.9848077530
END-OF-PATH
"""


@pytest.mark.parametrize(
    ("feed", "written", "told"), [("3000", 2999.0, True), ("2999", 2999.0, False), ("3001", 3001.0, False)]
)
def test_cuts_at_the_feed_of_rapids_post_and_are_read_as_cuts(
    feed: str, written: float, told: bool, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    cl, program = tmp_path / "part.cls", tmp_path / "part.nc"
    cl.write_text(CUTS.format(feed=feed), encoding="utf-8")
    assert main(["post", str(cl), "--machine", "hs664rt", "--output", str(program)]) == 0
    err = capfd.readouterr().err
    assert ("lines at 3000 mm/min are rapids on this machine: cuts at that feed get 2999" in err) is told
    assert ("[CTL315]" in err) is told
    found = trunnion.verify(program, machine="hs664rt", cl=cl)
    assert found.passed
    assert sorted(set(found.run.feed[found.run.kind == Kind.LINEAR].tolist())) == [900.0, written]
    assert int((found.run.feed == written).sum()) >= 3  # the tilt has a point between


def test_another_feed_than_the_next_one_is_a_fault(tmp_path: Path) -> None:
    cl, program = tmp_path / "part.cls", tmp_path / "part.nc"
    cl.write_text(CUTS.format(feed="3000"), encoding="utf-8")
    assert main(["post", str(cl), "--machine", "hs664rt", "--output", str(program)]) == 0
    program.write_text(program.read_text(encoding="utf-8").replace("F2999", "F2998"), encoding="utf-8")
    assert not check(trunnion.verify(program, machine="hs664rt", cl=cl), "feed").passed


def test_where_the_setting_is_another_such_cuts_keep_their_feed(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    cl, program = tmp_path / "part.cls", tmp_path / "part.nc"
    cl.write_text(CUTS.format(feed="3000"), encoding="utf-8")
    arguments = ["post", str(cl), "--machine", "hs664rt", "--set", "rapid_feed=5000", "--output", str(program)]
    assert main(arguments) == 0
    assert "CTL315" not in capfd.readouterr().err
    assert "F3000" in program.read_text(encoding="utf-8")
