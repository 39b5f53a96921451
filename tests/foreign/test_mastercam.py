"""Posts of Mastercam."""

from pathlib import Path

import pytest

from tests.support.locations import ROOT
from trunnion.cli import main
from trunnion.errors import InputError
from trunnion.foreign.machine import ForeignMachine
from trunnion.foreign.mastercam import read_mastercam_post
from trunnion.machines import load_machine

POST = ROOT / "tests" / "data" / "foreign" / "mill.pst"


def left(found: ForeignMachine) -> dict[str, str]:
    return {each.what: each.why for each in found.left}


def test_codes_formats_and_coolant_of_a_post_are_taken() -> None:
    found = read_mastercam_post([POST])
    assert {".".join(key[1:]): value.value for key, value in found.values.items()} == {
        "codes.rapid": 0, "codes.linear": 1, "codes.arc_clockwise": 2, "codes.arc_counterclockwise": 3,
        "codes.spindle_clockwise": 3, "codes.spindle_counterclockwise": 4, "codes.spindle_off": 5,
        "coolant.FLOOD": 8, "coolant.MIST": 7, "coolant.OFF": 9, "block_numbers.highest": 9990,
        "format.coordinate.decimals": 3, "format.angle.decimals": 3, "format.feed.decimals": 1,
        "format.speed.decimals": 0,
    }  # fmt: skip
    assert found.values["control", "codes", "rapid"].source == "sg00, mill.pst:23"
    assert found.rotary == ()


def test_all_else_is_reported_with_a_reason() -> None:
    reported = left(read_mastercam_post([POST]))
    assert "[[axis]]" in reported["mtype = 0"]
    assert "[[axis]]" in reported["pri_limlo = -9999"]
    assert "setting" in reported["mi1 = 2"]
    assert reported["mi1 = 3"] == "2 of mill.pst:9 counts"
    assert "arcs" in reported["arcoutput = 0"]
    assert reported['"G40", "G49", "G80", e$'] == "template first_tool"
    assert reported['*t$, "M6", e$'] == "template tool_change"
    assert reported["post block pwcs of 1 line"] == "nothing of a post is run"
    assert reported["3 is no name of anything"] == "this line is not understood"
    assert "fmt Q 2" in reported
    lines = POST.read_text(encoding="utf-8").splitlines()
    stated = [line for line in lines if line.strip() and not line.lstrip().startswith("#")]
    found = read_mastercam_post([POST])
    inside = [line for line in stated if line[0] == " " and '"' not in line]  # counted in their post block
    addresses = [line for line in stated if line.startswith("fmt") and line.split()[1].strip('"') in "XCFS"]
    used = {value.line for value in found.values.values()}
    assert len(stated) == len(used) + len(found.left) + len(inside) + len(addresses)


def test_the_definition_extends_the_machine_that_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mill.psb").write_bytes(b"\0\1\2")
    files = [str(POST), "mill.psb"]
    assert main(["import", *files, "--output", "ours"]) == 2  # nothing says what the machine is
    assert "--like" in capsys.readouterr().err
    assert main(["import", *files, "--like", "matsuura_mx330", "--output", "ours"]) == 0
    out = capsys.readouterr().out
    assert "taken: control.coolant.MIST = 7  (sm08_1, mill.pst:31)" in out
    assert "not taken: encrypted part  (mill.psb:1): nobody else can read it" in out
    assert load_machine(tmp_path / "ours.toml").axes == load_machine("matsuura_mx330").axes
    assert main(["check", "ours.toml"]) == 0


def test_codes_are_compared_with_a_definition(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["import", str(POST), "--machine", "yl569"]) == 1
    out = capsys.readouterr().out
    assert "control.coolant.MIST: 7 in yl569" not in out
    assert "control.format.feed.decimals: " in out
    assert "control.codes.rapid" not in out  # 0 in both


def test_formats_without_a_number_for_mm_and_odd_codes_state_nothing(tmp_path: Path) -> None:
    file = tmp_path / "mill.pst"
    text = 'fs2 2 0.4\nfs2 3 x y\nfs2 4 0.99 0.99\nfmt X 2 a\nfmt F 3 b\nfmt S 4 c\nsg00 "G0,5"\nsg01 "$x"\n'
    file.write_text(text, encoding="utf-8")
    found = read_mastercam_post([file])
    assert {key[2]: value.value for key, value in found.values.items()} == {"coordinate": 4}
    assert {"sg00 = G0,5", "sg01 = $x", "fs2 3 = x y", "fs2 4 = 0.99 0.99"} <= left(found).keys()


def test_an_encrypted_part_alone_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError) as refused:
        read_mastercam_post([tmp_path / "mill.psb"])
    assert refused.value.problems[0].code == "DEF610"
