"""Settings that say how CL files are read are taken by every command that reads CL files."""

from pathlib import Path

import pytest

import trunnion
from tests.support.open_cycles import CUT, CYCLE, HEAD, NEXT
from trunnion.cli import main
from trunnion.errors import InputError

#: The cycle of the first operation is still on where the second one begins.
_OPEN = f"{HEAD}{CYCLE}GOTO/10.,10.,0\n{NEXT}{CUT}FINI\n"
_ENDS = {"open_cycle": "ends"}
_BOX = ("--stock", "box:60,40,10,-20,-20,-9", "--cell", "3")

#: What a command is given besides the CL file.
_COMMANDS = {
    "info": ["info", "part.cls"],
    "post": ["post", "part.cls", "--machine", "yl569", "--output", "part.mpf"],
    "verify": ["verify", "part.mpf", "--machine", "yl569", "--cl", "part.cls"],
    "simulate": ["simulate", "part.mpf", "--machine", "yl569", "--cl", "part.cls", *_BOX],
    "fit": ["fit", "part.cls", "--machines", "yl569", "--turns", "360"],
    "place": ["place", "part.cls", "--machine", "yl569", "--turn", "0"],
    "reach": ["reach", "part.cls", "--machine", "yl569", "--step", "45"],
}


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "part.cls").write_text(_OPEN, encoding="utf-8")
    trunnion.post(tmp_path / "part.cls", machine="yl569", settings=_ENDS, output=tmp_path / "part.mpf")
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize("command", _COMMANDS)
def test_a_command_takes_them(command: str, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    main(_COMMANDS[command])
    assert "error" in (before := capsys.readouterr().err)
    assert "CL840" in before
    code = main([*_COMMANDS[command], "--set", "open_cycle=ends"])
    assert "error" not in capsys.readouterr().err
    assert code in (0, 1)


def test_a_project_states_them_for_its_simulation(folder: Path) -> None:
    (folder / "part.toml").write_text(
        'machine = "yl569"\ncl = ["part.cls"]\nprograms = ["part.mpf"]\nstock = "box:60,40,10,-20,-20,-9"\n'
        'cell_mm = 3\n[settings]\nopen_cycle = "ends"\n',
        encoding="utf-8",
    )
    assert trunnion.simulate(folder / "part.toml").operations


def test_settings_of_something_else_are_refused(folder: Path) -> None:
    for settings, said in (({"spindle": "500"}, "does not say how"), ({"cl_units": "furlong"}, "mm or")):
        with pytest.raises(InputError, match=said):
            trunnion.describe_cl("part.cls", settings=settings)
    with pytest.raises(InputError, match="which is given too"):
        trunnion.describe_cl("part.cls", units="mm", settings={"cl_units": "mm"})
    with pytest.raises(InputError, match="no variable"):
        trunnion.simulate("part.mpf", machine="yl569", stock="box:1,1,1", settings=_ENDS)
