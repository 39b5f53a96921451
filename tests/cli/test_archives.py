"""Archives, stdin and several files as CL files of the commands."""

import io
import zipfile
from pathlib import Path

import pytest

from tests.support.cl_dialects import WRITERS, Step
from tests.support.locations import YL569
from trunnion.cli import main

PATH = [
    Step("TOOL", (5.0, 0.5, 0.0)),
    Step("SPINDLE", (900.0,), "CLW"),
    Step("RAPID", point=(1.0, 0.0, 3.0)),
    Step("FEED", (10.0,)),
    Step("GOTO", point=(1.0, 0.0, 0.5)),
    Step("GOTO", point=(10.0, 0.0, 0.5)),
    Step("RAPID", point=(10.0, 0.0, 3.0)),
]
BLADE = (YL569 / "3_blade_finish.cls").read_bytes()


class _Stdin:
    def __init__(self, content: bytes) -> None:
        self.buffer = io.BytesIO(content)


def stdin(monkeypatch: pytest.MonkeyPatch, content: bytes) -> None:
    monkeypatch.setattr("sys.stdin", _Stdin(content))


def test_an_archive_is_posted_as_one_program_and_proven(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    archive = tmp_path / "blade.zip"
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as out:
        out.writestr("1.cls", BLADE)
        out.writestr("2.ncl", WRITERS["ncl"](True).write(PATH))  # another dialect, and inches
    monkeypatch.chdir(tmp_path)
    assert main(["post", str(archive), "--machine", "yl569"]) == 0
    err = capsys.readouterr().err
    assert f"{archive}/1.cls: read as NX CLSF" in err
    assert f"{archive}/2.ncl: read as Creo NCL" in err
    assert "X254." in (tmp_path / "blade.mpf").read_text(encoding="utf-8")
    assert main(["verify", "blade.mpf", "--machine", "yl569", "--cl", str(archive)]) == 0
    stdin(monkeypatch, archive.read_bytes())
    assert main(["verify", "blade.mpf", "--machine", "yl569", "--cl", "-"]) == 0
    assert main(["post", str(archive), "--machine", "yl569", "--output", str(archive)]) == 2
    assert "although it is read" in capsys.readouterr().err


def test_stdin_is_a_cl_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    stdin(monkeypatch, BLADE)
    assert main(["info", "-"]) == 0
    assert "stdin: NX CLSF" in capsys.readouterr().out
    stdin(monkeypatch, BLADE.replace(b"GOTO/", b"GOTO/X", 1))
    assert main(["info", "-"]) == 2
    assert capsys.readouterr().err.startswith("stdin:")
    stdin(monkeypatch, BLADE)
    assert main(["post", "-", "--machine", "yl569"]) == 2
    assert "stdin: error: has no name" in capsys.readouterr().err
    assert main(["info", "-", "-"]) == 2
    assert "is named twice" in capsys.readouterr().err
