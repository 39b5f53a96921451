"""Faults of ``[cl.words]``: each at its line of the file that says so."""

from pathlib import Path

import pytest

import trunnion
from trunnion.cli import main

CL = Path(__file__).parents[1] / "golden" / "yl569" / "2_hub_rough.cls"


MACHINES = ("yl569", "dmu65", "ucp800", "matsuura_mx330", "haas_umc750", "hs664rt", "xyzac_trt")


@pytest.mark.parametrize("machine", MACHINES)
@pytest.mark.parametrize(
    ("entry", "what"),
    [
        ('AIRBLAST = "COOLNT/XX"', "COOLNT/XX is not an event by itself"),
        ('AIRBLAST = "GOTO/1,2,3"', "GOTO/1,2,3 is not an event by itself"),
        ('AIRBLAST = "AIR"', "AIR is not a statement"),
        ('GOTO = "COOLNT/ON"', "is a statement that is read"),
    ],
)
def test_a_fault_names_the_line_of_the_user(
    machine: str, entry: str, what: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "mine.toml"
    file.write_text(f'extends = "{machine}"\n\n[cl.words]\n{entry}\n', encoding="utf-8")
    place = f"mine.toml:4: error: cl.words.{entry.split()[0]} "
    assert main(["check", str(file)]) == 2
    told = capsys.readouterr().err
    assert place in told
    assert what in told
    with pytest.raises(trunnion.InputError) as caught:
        trunnion.post(CL, machine=file)
    assert place in str(caught.value)


def test_a_fault_in_a_base_of_the_user_is_there(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "base.toml").write_text('extends = "yl569"\n[cl.words]\nBLAST = "AIR"\n', encoding="utf-8")
    (tmp_path / "mine.toml").write_text('extends = "base.toml"\n[cl.words]\nPUFF = "COOLNT/ON"\n', encoding="utf-8")
    assert main(["check", str(tmp_path / "mine.toml")]) == 2
    assert "base.toml:3: error: cl.words.BLAST " in capsys.readouterr().err
