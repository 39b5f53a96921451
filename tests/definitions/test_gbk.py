"""Definitions in GBK, as Chinese editors save them, are read; other bytes that are no UTF-8 are not."""

from pathlib import Path

import pytest

from trunnion.cli import main
from trunnion.machines import load_machine

TEXT = 'extends = "yl569"\nname = "YL569 实训机床"\n'


def test_a_definition_in_gbk_is_that_in_utf8(tmp_path: Path) -> None:
    (tmp_path / "gbk.toml").write_bytes(TEXT.encode("gbk"))
    (tmp_path / "utf8.toml").write_text(TEXT, encoding="utf-8")
    gbk, utf8 = (load_machine(tmp_path / name) for name in ("gbk.toml", "utf8.toml"))
    assert gbk.name == utf8.name == "YL569 实训机床"


@pytest.mark.parametrize(
    "data",
    [TEXT.encode("gbk") + b"\xd6", 'name = "Größe"'.encode("latin-1"), b'name = "\xff\xfe"'],
    ids=["cut off", "latin-1", "no text"],
)
def test_what_is_neither_utf8_nor_chinese_is_refused(
    data: bytes, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "odd.toml").write_bytes(data)
    assert main(["check", str(tmp_path / "odd.toml")]) == 2
    assert "DEF120" in capsys.readouterr().err
