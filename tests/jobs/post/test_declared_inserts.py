"""Raw text (INSERT) may hold words that the definition declares, unless they take the machine elsewhere."""

from pathlib import Path

import pytest

from tests.support.posting import FOOT, HEAD
from trunnion.cli import main


@pytest.mark.parametrize(
    ("effect", "code", "what"),
    [("comes back: probing", 0, ""), ("comes back home", 1, "it moves the machine")],
)
def test_a_declared_word_may_stand_in_raw_text(
    effect: str, code: int, what: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    machine, cl = tmp_path / "ours.toml", tmp_path / "part.cls"
    text = f'extends = "matsuura_mx330"\nname = "OURS"\n[control.known]\n"G65 P9810" = "{effect}"\n'
    machine.write_text(text, encoding="utf-8")
    cl.write_text(HEAD + "INSERT/G65 P9810 Z3.\nGOTO/20.0,0.0,5.0\n" + FOOT, encoding="utf-8")
    assert main(["post", str(cl), "--machine", str(machine), "--output", str(tmp_path / "part.nc")]) == code
    assert what in capsys.readouterr().err
    if not code:
        assert "G65 P9810 Z3." in (tmp_path / "part.nc").read_text(encoding="utf-8")


def test_settings_of_an_operation_whose_name_others_have_are_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    cl = tmp_path / "part.cls"
    cl.write_text((HEAD + FOOT) * 2, encoding="utf-8")
    out = str(tmp_path / "part.mpf")
    assert main(["post", str(cl), "--machine", "yl569", "--set", "work_offset=OP1:G55", "--output", out]) == 0
    assert "warning: 2 operations are called OP1: all have its settings" in capsys.readouterr().err
