"""Ctrl-C while stock is cut, or is saved: no file is left, and an older one stays."""

import signal
import threading
from pathlib import Path
from typing import Any

import pytest

from trunnion.cli import main
from trunnion.simulation.cutting.removal import Cutter
from trunnion.simulation.stock import surface

SLOT = "G21 G90 G17 G40 G49 G80\nT1 M6\nG43 H1\nS1000 M3\nG0 X-20 Y0 Z20\nG0 Z-5\nG1 X70 F500\nG0 Z20\nM5\nM30\n"


#: A body without a triangle, as an older run may have left it.
OLDER = bytes(84)


@pytest.mark.parametrize("where", ["cutting", "saving"])
def test_ctrl_c_leaves_no_file(
    tmp_path: Path, where: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    nc, stock, data = tmp_path / "slot.ngc", tmp_path / "stock.stl", tmp_path / "found.json"
    nc.write_text(SLOT)
    stock.write_bytes(OLDER)
    owner, name = (Cutter, "measure") if where == "cutting" else (surface, "_triangles")
    own, called, threads = getattr(owner, name), list[bool](), set(threading.enumerate())

    def stopped(*arguments: Any) -> Any:
        called.append(True)
        signal.raise_signal(signal.SIGINT)
        return own(*arguments)

    monkeypatch.setattr(owner, name, stopped)
    command = ["simulate", str(nc), "--machine", "xyzac_trt", "--stock", "box:50,40,10,0,-20,-10", "--cell", "1"]
    command += ["--tool", "1=flat:10,length=60,flutes=20", "--save-stock", str(stock), "--json", str(data)]
    code = main(command)
    assert called
    assert code == 2
    assert "stopped" in capsys.readouterr().err
    assert {path.name for path in tmp_path.iterdir()} == {"slot.ngc", "stock.stl"}
    assert stock.read_bytes() == OLDER
    assert set(threading.enumerate()) <= threads  # others may end meanwhile
