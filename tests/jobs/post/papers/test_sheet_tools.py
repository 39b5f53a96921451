"""The tools of a sheet, with what libraries and ``--tool`` say of them, where nothing is simulated."""

import json
from pathlib import Path

import pytest

import trunnion
from tests.support.locations import YL569
from trunnion.cli import main

CL = YL569 / "2_hub_rough.cls"

LIBRARY = """[[tool]]
number = 2
description = "BALL NOSE 6, LONG"
kind = "ball"
diameter_mm = 6
flute_length_mm = 20
length_mm = 60

[[tool.holder]]
diameter_mm = 40
height_mm = 50
"""

PROJECT = """machine = "yl569"
tool_libraries = ["tools.toml"]

[[setup]]
name = "hub"
cl = ["hub.cls"]
output = "hub.mpf"
sheet = "sheet.json"
"""


def tools_of(sheet: Path) -> list[dict[str, object]]:
    found: list[dict[str, object]] = json.loads(sheet.read_text(encoding="utf-8"))["tools"]
    return found


def test_a_sheet_names_what_a_tool_says(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    sheet, output = tmp_path / "sheet.json", str(tmp_path / "a.mpf")
    command = ["post", str(CL), "--machine", "yl569", "--output", output]
    tools = ["--tool", "2=ball:6,length=60,flutes=20,holder=40x50"]
    assert main([*command, "--sheet", str(sheet)]) == 0
    (before,) = tools_of(sheet)
    assert main([*command, "--sheet", str(sheet), *tools]) == 0, capfd.readouterr().err
    (after,) = tools_of(sheet)
    assert (before["holder"], after["holder"]) == ("", "Ø40 × 50 mm")
    assert {key for key in after if after[key] != before[key]} >= {"holder"}
    # Without a sheet, it is for a simulation alone.
    assert main([*command, *tools]) == 2
    assert "is only for a simulation" in capfd.readouterr().err


def test_a_tool_that_nothing_describes_stays_as_it_is(tmp_path: Path) -> None:
    sheet, other = tmp_path / "sheet.json", {"tools": ["7=flat:16,length=60,holder=40x50"]}
    trunnion.post(CL, machine="yl569", output=tmp_path / "a.mpf", sheet=sheet, sheet_tools=other)
    assert [tool["holder"] for tool in tools_of(sheet)] == [""]


def test_tools_of_a_library_have_their_titles_in_a_project_too(tmp_path: Path) -> None:
    (tmp_path / "tools.toml").write_text(LIBRARY, encoding="utf-8")
    (tmp_path / "part.toml").write_text(PROJECT, encoding="utf-8")
    text = CL.read_text(encoding="utf-8")
    (tmp_path / "hub.cls").write_text(text.replace(",TOOL,UGT0203_004", ""), encoding="utf-8")
    trunnion.post_project(tmp_path / "part.toml")
    (tool,) = tools_of(tmp_path / "sheet.json")
    assert (tool["name"], tool["holder"]) == ("BALL NOSE 6, LONG", "Ø40 × 50 mm")
