"""``trunnion check`` reports motions that stand in a branch of a template."""

import json
from pathlib import Path

import pytest

from trunnion.cli import main

_HEAD = "schema = 1\nextends = \"{base}\"\nname = \"Ours\"\n[control.templates]\nbefore_operation = '''\n{text}\n'''\n"
_IF = '{{% if operation.coolant == "THRU" %}}\n{}\n{{% endif %}}'
_ELSE = '{{% if operation.coolant == "ON" %}}\n;\n{{% else %}}\n{}\n{{% endif %}}'


def _said(folder: Path, capfd: pytest.CaptureFixture[str], base: str, text: str) -> list[str]:
    file = folder / "ours.toml"
    file.write_text(_HEAD.format(base=base, text=text), encoding="utf-8")
    code, (_, err) = main(["check", str(file)]), capfd.readouterr()
    assert code == 0, err
    return [line for line in err.splitlines() if "DEF595" in line]


@pytest.mark.parametrize(
    ("base", "motion"),
    [
        ("yl569", "G0 X100"), ("yl569", "SUPA G0 Z=_Z_HOME D0"), ("yl569", "{primary}=DC(0)"), ("yl569", "g1 z-5 f100"),
        ("dmu65", "L Z+100 R0 FMAX M91"), ("dmu65", "L M140 MB MAX"), ("matsuura_mx330", "G91 G28 Z0."),
        ("matsuura_mx330", "G53 Z{home_z}"), ("haas_umc750", "G53 G0 Y-200."), ("hs664rt", "M242"),
        ("xyzac_trt", "G30"), ("xyzac_trt", "Z#<clear>"),
    ],
)  # fmt: skip
def test_a_motion_in_a_branch_is_reported_at_its_line(
    base: str, motion: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    for branch, line in ((_IF, 7), (_ELSE, 9)):
        (said,) = _said(tmp_path, capfd, base, branch.format(motion))
        assert f"ours.toml:{line}: warning: template before_operation moves in a branch" in said


def test_a_motion_that_an_expression_chooses_is_reported(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    text = '{{ "G0 Z300" if operation.coolant == "THRU" else ";" }}'
    assert len(_said(tmp_path, capfd, "yl569", text)) == 1
    assert len(_said(tmp_path, capfd, "yl569", '{% if operation.coolant == "THRU" %}G0 Z300{% endif %}')) == 1


@pytest.mark.parametrize(
    ("base", "text"),
    [
        ("yl569", "G0 Z300"), ("yl569", _IF.format(";G0 X100")), ("yl569", _IF.format("M8 S1000")),
        ("yl569", _IF.format("MSG(\"GO\")")),
        ("yl569", "{% if operation.coolant == \"ON\" %}\n;\n{% endif %}\nG0 Z300"),
        ("dmu65", _IF.format("* - X1")), ("matsuura_mx330", _IF.format("(G0 X1.)")),
        ("matsuura_mx330", _IF.format("M98 P100")),
    ],
)  # fmt: skip
def test_what_is_in_every_program_or_moves_nothing_is_none(
    base: str, text: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    assert _said(tmp_path, capfd, base, text) == []


def test_data_has_what_stderr_says(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "ours.toml"
    text = _HEAD.format(base="yl569", text=_IF.format("G0 X100"))
    control = text.replace("yl569", "sinumerik_840d").replace("[control.templates]", "[templates]")
    for content in (text, control.replace("schema = 1", "").replace('name = "Ours"', "")):
        file.write_text(content, encoding="utf-8")
        assert main(["check", str(file), "--json"]) == 0
        told = capfd.readouterr()
        (remark,) = json.loads(told.out)["remarks"]
        assert (remark["code"], remark["severity"], remark["line"]) == ("DEF595", "warning", 7)
        assert remark["text"] in told.err
