"""The sample of ``make.py simulate``: the published programs of one part, one after another."""

from pathlib import Path

import pytest
from make import CUT, SAMPLE

from tests.support.locations import ROOT
from trunnion.cli import main


def test_the_sample_cuts_and_tells_what_it_finds(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    programs = [str(ROOT / SAMPLE.with_name(f"{name}.expected.mpf")) for name in CUT]
    picture = tmp_path / "stock.png"
    tools = ["--tool", "1=flat:16,length=75,flutes=40", "--tool", "2=ball:10,length=75,flutes=40"]
    stock = ["--stock", "cylinder:108,30,-30", "--cell", "0.5", "--save-stock", str(picture)]
    assert main(["simulate", *programs, "--machine", "yl569", *tools, *stock]) == 1
    said = capsys.readouterr().out.splitlines()
    removed = float(next(line for line in said if "mm³ removed; cells" in line).split()[0])
    assert removed == pytest.approx(99464.0, abs=1.0)
    (found,) = [line for line in said if "rapid through stock" in line]
    assert "2_hub_rough.expected.mpf:46: N460 " in found
    assert picture.read_bytes().startswith(b"\x89PNG")
