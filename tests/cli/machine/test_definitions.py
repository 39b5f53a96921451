"""``trunnion machines`` and ``trunnion check``."""

import json
import re
from pathlib import Path

import pytest

from tests.support.locations import YL569
from trunnion.cli import main
from trunnion.machines import shipped_machines


def test_the_list_names_every_shipped_machine(capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["machines"]) == 0
    heads, *lines = capfd.readouterr().out.splitlines()
    assert re.split(r" {2,}", heads)[:3] == ["machine", "part to tool", "rotary axes"]
    listed = [line.split()[0] for line in lines]
    assert listed == shipped_machines()
    assert {"yl569", "ucp800", "hs664rt", "dmu65", "mikron_600u"} < set(listed)
    told = {line.split()[0]: re.split(r" {2,}", line)[1:] for line in lines}
    assert told["dmu65"] == [
        "C A bed X Y Z", "table/table", "A -90 to 0°, C endless",
        "X 735, Y 650, Z 560 mm", "Heidenhain TNC 640", "DMG DMU 65",
    ]  # fmt: skip
    assert told["generic_head_head_ca"][:2] == ["X bed Y Z C A", "head/head"]
    assert told["yl569"][1:3] == ["table/table", "B -11 to 100°, C endless"]
    assert told["generic_head_table_bc"][1] == "head/table"
    assert told["hs664rt"][3] == "travel not stated"


def test_a_definition_is_printed_as_it_is(capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["machines", "yl569"]) == 0
    out = capfd.readouterr().out
    assert 'name = "Yalong YL569"' in out
    assert "limits_deg = [-11, 100]" in out


@pytest.mark.parametrize("name", shipped_machines())
def test_every_shipped_machine_is_good(name: str, capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["check", name]) == 0


def test_the_file_of_a_control_is_checked_as_one(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "ours.toml"
    file.write_text('extends = "fanuc_31i"\nname = "Ours"\n', encoding="utf-8")
    assert main(["check", str(file)]) == 0
    assert "ours.toml: good" in capfd.readouterr().out
    file.write_text(
        'extends = "fanuc_31i"\nname = "Ours"\n[codes]\nrapidd = 0\n[known]\nM60 = "no efect"\n', encoding="utf-8"
    )
    assert main(["check", str(file)]) == 2
    err = capfd.readouterr().err
    assert "ours.toml:4: error: codes.rapidd is not a key" in err
    assert "ours.toml:6: error: known.M60 has no effect 'no efect'" in err


def test_what_a_definition_means_is_shown_as_text_and_as_data(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "mine.toml"
    file.write_text(
        'extends = "dmu65"\nname = "Ours"\n[workpiece]\nzero_mm = [0, 0, 5]\n'
        '[[axis]]\nname = "A"\nprefer = "negative"\n',
        encoding="utf-8",
    )
    assert main(["check", str(file)]) == 0
    lines = capfd.readouterr().out.splitlines()
    assert lines[0].endswith("mine.toml: good")
    assert "From the workpiece to the tool: C A bed X Y Z" in lines
    assert "Workpiece zero: (0, 0, 5) mm." in lines
    assert "A+ 10°     the tool axis points to (0, -0.174, 0.985) of the workpiece, leaning to -Y" in lines
    assert "  A-30 C+0   tool axis (0, 0.5, 0.866)           gauge point (0, 0, -5)" in lines
    assert "Of two such positions cuts begin in the one with A negative, where that needs no more rewinds." in lines
    assert (
        "           turns about the line through (0, 0, 0) along +X; travel -90 to 0°; home 0°, which is not stated"
        in lines
    )
    assert "  approach_five_axis" in lines
    assert any(line.startswith("    BEGIN PGM {program} ") for line in lines)
    assert main(["check", str(file), "--json"]) == 0
    data = json.loads(capfd.readouterr().out)
    assert data["jogs"]["order"] == ["C", "A", "bed", "X", "Y", "Z"]
    assert data["jogs"]["axes"][0]["axis"]["low"] is None
    assert data["jogs"]["axes"][1]["iron"].startswith("the table turns 10° clockwise seen from +X")
    assert data["workpiece_zero_mm"] == [0, 0, 5]


def test_mistakes_of_machine_and_control_come_all_at_once_with_their_lines(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "mine.toml"
    file.write_text(
        'schema = 1\nextends = "yl569"\n'
        '[[axis]]\nname = "B"\nlimits_deg = [100, -11]\n'
        '[[axis]]\nname = "X"\nlimits_inch = [-10, 10]\n'
        '[control.codes]\nrapidd = 0\n[control.templates]\nprogram_end = "M30 {datum}"\n',
        encoding="utf-8",
    )
    assert main(["check", str(file)]) == 2
    err = capfd.readouterr().err.replace(str(file), "mine.toml")
    assert "mine.toml:5: error: axis" in err
    assert "mine.toml:8: error: axis" in err
    assert "mine.toml:10: error: control.codes.rapidd" in err
    assert "mine.toml:12: error: control.templates.program_end" in err
    assert "{datum}" in err


def test_a_machine_of_ones_own_extends_a_shipped_one_and_changes_its_texts(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "mine.toml"
    file.write_text(
        'schema = 1\nextends = "yl569"\nname = "Ours"\n'
        '[control]\nextends = "sinumerik_840d"\n'
        '[control.templates]\nprogram_end = "; the end of {machine}\\nM2"\n'
        '[[control.format]]\nname = "coordinate"\ndecimals = 4\n[control.block_numbers]\nletter = ""\n',
        encoding="utf-8",
    )
    assert main(["check", str(file)]) == 0
    capfd.readouterr()
    golden = YL569 / "2_hub_rough.cls"
    assert main(["post", str(golden), "--machine", str(file), "--output", "-"]) == 0
    lines = capfd.readouterr().out.splitlines()
    assert lines[-2:] == ["; the end of Ours", "M2"]
    assert any(line.startswith("G0 X50.1536 Y11.4572 Z-20.309 S2000") for line in lines)
