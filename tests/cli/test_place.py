"""``trunnion place``."""

import json
from pathlib import Path
from xml.etree import ElementTree

import pytest

from trunnion.cli import main

BLADE = "tests/golden/yl569/3_blade_finish.cls"
HUB = "tests/golden/yl569/2_hub_rough.cls"


def test_text_names_the_place_its_margins_and_what_limits_it(capsys: pytest.CaptureFixture[str]) -> None:
    code = main(["place", HUB, "--machine", "yl569", "--tool-length", "100", "--turn", "0", "--zero", "0,0,120"])
    lines = capsys.readouterr().out.splitlines()
    assert code == 0
    assert lines[0].startswith("yl569: best zero ")
    assert [line.split()[0] for line in lines[1:4]] == ["X", "Y", "Z"]
    assert all("left" in line for line in lines[1:4])
    assert lines[4].startswith("  it is held by ")
    assert f"({HUB}:" in lines[4]
    assert lines[5].startswith("  present zero 0.000,0.000,120.000: ")
    assert lines[6] == "  it fits at 1 of 1 turn"


def test_data_has_the_place_the_region_and_the_turns(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "placed.json"
    assert main(["place", BLADE, "--machine", "yl569", "--turns", "90", "--tool-length", "0", "--json", str(file)]) == 0
    data = json.loads(file.read_text("utf-8"))
    assert data["schema"] == 1
    assert data["fits"] is True
    assert data["present"] is None
    assert len(data["best"]["zero_mm"]) == 3
    assert {axis["axis"] for axis in data["best"]["axes"]} == {"X", "Y", "Z"}
    assert data["best"]["axes"][0]["low"]["limit_mm"] == -250.0
    assert data["best"]["axes"][0]["low"]["file"] == BLADE
    assert data["share_of_turns"] == 1.0
    assert [turn["turn_deg"] for turn in data["turns"]][:1] == [0.0]
    assert len(data["region"]["corners_mm"]) > 8
    capsys.readouterr()
    assert main(["place", BLADE, "--machine", "yl569", "--turn", "0", "--tool-length", "0", "--json", "-"]) == 0
    printed = json.loads(capsys.readouterr().out)
    assert [turn["turn_deg"] for turn in printed["turns"]] == [0.0]


def test_the_picture_is_svg_that_shows_the_margin_over_table_and_turn(tmp_path: Path) -> None:
    file = tmp_path / "placed.svg"
    arguments = ["place", BLADE, "--machine", "yl569", "--turns", "120", "--tool-length", "0", "--plot", str(file)]
    assert main([*arguments, "--zero", "0,0,50"]) == 0
    root = ElementTree.parse(file).getroot()
    texts = [element.text or "" for element in root.iter("{http://www.w3.org/2000/svg}text")]
    assert any(text.startswith("yl569: margin at Z ") for text in texts)
    assert any("cross" in text for text in texts)
    assert len(list(root.iter("{http://www.w3.org/2000/svg}rect"))) > 300


def test_a_part_that_fits_nowhere_is_refused_with_what_conflicts(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    machine = tmp_path / "short.toml"
    machine.write_text('extends = "yl569"\n[[axis]]\nname = "Y"\nlimits_mm = [-1, 3]\n', "utf-8")
    program = tmp_path / "never.mpf"
    code = main(["place", HUB, "--machine", str(machine), "--tool-length", "0", "--turn", "0", "--apply", str(program)])
    out = capsys.readouterr().out
    assert code == 1
    assert "fits nowhere" in out
    assert "these conflict: Y at -1 (" in out or "these conflict: Y at 3 (" in out
    assert not program.exists()


def test_travel_that_is_missing_is_told_where_one_slide_has_too_little(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The contour is 103.296 mm wide in Y, the circle of radius 51.648 mm: 80 mm are 23.296 too few."""
    machine = tmp_path / "short.toml"
    machine.write_text('extends = "yl569"\n[[axis]]\nname = "Y"\nlimits_mm = [-30, 50]\n', "utf-8")
    contour = "tests/golden/yl569/1_contour_rough.cls"
    assert main(["place", contour, "--machine", str(machine), "--tool-length", "0", "--turn", "0"]) == 1
    out = capsys.readouterr().out
    assert "fits nowhere: 11.648 mm too far at the least" in out
    assert "Y needs 23.296 mm more travel" in out


def test_a_tool_axis_out_of_reach_is_told_with_its_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    machine = tmp_path / "stiff.toml"
    machine.write_text('extends = "yl569"\n[[axis]]\nname = "B"\nlimits_deg = [-5, 20]\n', "utf-8")
    program = "tests/golden/yl569/3_blade_finish.expected.mpf"
    code = main(["place", program, "--machine", str(machine), "--tool-length", "0", "--turn", "0"])
    out = capsys.readouterr().out
    assert code == 1
    assert "the rotary axes reach the path at no turn" in out
    assert f"{program}:46: B would have to leave its travel, -5 to 20 degrees" in out


def test_apply_posts_the_part_where_it_sits_best(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    program = tmp_path / "placed.mpf"
    code = main(["place", BLADE, "--machine", "yl569", "--tool-length", "90", "--turn", "45", "--apply", str(program)])
    err = capsys.readouterr().err
    assert code == 0
    assert program.exists()
    assert "travel        ok" in err


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--turns", "0"], "is no step of turns"),
        (["--turns", "nan"], "is no step of turns"),
        (["--turn", "inf"], "is no turn"),
        (["--goal", "beauty"], "invalid choice"),
        (["--plot", "picture.png"], "FIL260"),
        (["--zero", "1,2"], "--zero"),
        (["--json", "-", "--apply", "-"], "stdout"),
        (["--tool-length", "long"], "--tool-length"),
    ],
)
def test_what_cannot_be_is_refused(arguments: list[str], message: str, capsys: pytest.CaptureFixture[str]) -> None:
    try:
        code = main(["place", BLADE, "--machine", "yl569", *arguments])
    except SystemExit as ended:
        code = int(ended.code or 0)
    assert code == 2
    assert message in capsys.readouterr().err


def test_files_that_cannot_be_placed_are_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    empty = tmp_path / "empty.cls"
    empty.write_text("", "utf-8")
    assert main(["place", str(empty), "--machine", "yl569"]) == 2
    assert main(["place", str(tmp_path / "none.cls"), "--machine", "yl569"]) == 2
    assert main(["place", BLADE, "--machine", "hs664rt"]) == 2
    assert "PLC130" in capsys.readouterr().err
    program = "tests/golden/yl569/3_blade_finish.expected.mpf"
    assert main(["place", BLADE, program, "--machine", "yl569"]) == 2
    assert "PLC110" in capsys.readouterr().err
    assert main(["place", program, "--machine", "yl569", "--turn", "0", "--apply", str(tmp_path / "x.mpf")]) == 2
    assert "PLC140" in capsys.readouterr().err
