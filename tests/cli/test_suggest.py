"""``trunnion post --suggest`` writes a project that posts, once the words in capitals are filled in."""

from pathlib import Path

import pytest

from tests.support.posting import FOOT, HEAD
from trunnion.cli import main

_BARE = HEAD.replace("LOAD/TOOL,1,ADJUST,1\n", "").replace("SPINDL/RPM,4000.0000,CLW\n", "")
TWO = _BARE + FOOT + _BARE.replace("OP1", "OP 2").replace("D10", "D12").replace("FEDRAT/MMPM,500.0\n", "") + FOOT


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "part.cls").write_text(TWO, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_the_project_posts_once_it_is_filled_in(folder: Path) -> None:
    post = ["post", "part.cls", "--machine", "matsuura_mx330", "--set", "title=BLADE", "--suggest", "part.toml"]
    assert main([*post, "--output", "part.nc"]) == 2
    project = folder / "part.toml"
    text = project.read_text(encoding="utf-8")
    assert 'title = "BLADE"' in text
    assert 'tool = "OP1:NUMBER,OP 2:NUMBER"' in text
    assert 'spindle = "OP1:RPM,OP 2:RPM"' in text
    assert 'missing_feed = "OP 2:MM_MIN"' in text
    assert '\n# standing_spindle = "allowed"' in text
    assert main(["post", "part.toml"]) == 2, "nothing is filled in"
    filled = text.replace("NUMBER", "7", 1).replace("NUMBER", "8").replace("RPM", "900").replace("MM_MIN", "300")
    project.write_text(filled, encoding="utf-8")
    assert main(["post", "part.toml"]) == 0
    program = (folder / "part.nc").read_text(encoding="utf-8")
    assert "S900" in program
    assert "F300." in program


def test_a_file_that_is_there_stays(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "part.toml").write_text("# mine\n", encoding="utf-8")
    assert main(["post", "part.cls", "--machine", "yl569", "--suggest", "part.toml"]) == 2
    assert "FIL250" in capsys.readouterr().err
    assert (folder / "part.toml").read_text(encoding="utf-8") == "# mine\n"


def test_what_a_project_cannot_name_is_refused(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "below").mkdir()
    assert main(["post", "part.cls", "--machine", "yl569", "--suggest", "below/part.toml"]) == 2
    assert "FIL320" in capsys.readouterr().err
    assert not (folder / "below" / "part.toml").exists()


def test_numbers_that_were_given_stand_under_their_keys(folder: Path) -> None:
    (folder / "part.cls").write_text(HEAD + FOOT, encoding="utf-8")
    post = ["post", "part.cls", "--machine", "yl569", "--zero", "0,0,-100", "--tool-length", "120.5"]
    assert main([*post, "--output", "part.mpf", "--suggest", "part.toml"]) == 0
    text = (folder / "part.toml").read_text(encoding="utf-8")
    assert "zero_mm = [0, 0, -100]" in text
    assert "tool_length_mm = 120.5" in text
    assert main(["post", "part.toml"]) == 0
