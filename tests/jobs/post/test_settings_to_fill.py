"""What a CL file leaves to be stated is said at once, as settings to be copied and filled in."""

import shlex
from pathlib import Path

import pytest

from tests.support.posting import FOOT, HEAD
from trunnion.cli import main

#: Two operations without the number of a tool and without a speed; the name of one has a blank.
_BARE = HEAD.replace("LOAD/TOOL,1,ADJUST,1\n", "").replace("SPINDL/RPM,4000.0000,CLW\n", "")
TWO = _BARE + FOOT + _BARE.replace("OP1", "OP 2").replace("D10", "D12") + FOOT


def test_the_settings_of_the_message_are_copied_and_filled_in(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "part.cls").write_text(TWO, encoding="utf-8")
    post = ["post", str(tmp_path / "part.cls"), "--machine", "matsuura_mx330", "--output", str(tmp_path / "part.nc")]
    assert main(post) == 2
    last = capsys.readouterr().err.splitlines()[-1]
    assert last.endswith('post again: --set "tool=OP1:NUMBER,OP 2:NUMBER" --set "spindle=OP1:RPM,OP 2:RPM" [CTL570]')
    copied = last.partition("post again: ")[2].rpartition(" [")[0].replace("NUMBER", "7", 1).replace("NUMBER", "8")
    assert main([*post, *shlex.split(copied.replace("RPM", "900"))]) == 0


def test_one_operation_alone_has_its_own_messages(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "part.cls").write_text(_BARE + FOOT, encoding="utf-8")
    assert main(["post", str(tmp_path / "part.cls"), "--machine", "yl569", "--output", "-"]) == 2
    said = capsys.readouterr().err
    assert "CTL510" in said
    assert "CTL570" not in said
