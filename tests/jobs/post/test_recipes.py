"""What the page of templates shows: each recipe's program is proven, and has the lines that the page promises."""

import re
import shlex
from pathlib import Path

import pytest

from tests.support.locations import ROOT, TESTS
from trunnion.cli import main

PAGE = (ROOT / "docs" / "templates.md").read_text(encoding="utf-8")
RECIPES = dict(re.findall(r"^### (.+?)\n(.*?)(?=^### |\Z)", PAGE.partition("## Recipes")[2], re.MULTILINE | re.DOTALL))


def blocks(text: str) -> list[str]:
    """The samples of a part of the page, in their order."""
    return re.findall(r"^```\w*\n(.*?)^```", text, re.MULTILINE | re.DOTALL)


def test_the_page_has_twelve_recipes() -> None:
    assert len(RECIPES) == 12


@pytest.mark.parametrize("name", RECIPES)
def test_a_recipe_makes_a_proven_program_with_the_lines_that_it_shows(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    recipe = RECIPES[name]
    definition, command, shown = blocks(recipe)
    monkeypatch.chdir(tmp_path)
    cl = (TESTS / "data" / "shop.cls").read_text(encoding="utf-8")
    if "event_BORHED" not in recipe:
        cl = cl.replace("BORHED/40.5,DEEP\n", "")
    Path("part.cls").write_text(cl, encoding="utf-8")
    Path("ours.toml").write_text(definition, encoding="utf-8")
    name_of_command, *arguments = shlex.split(command)
    assert name_of_command == "trunnion"
    code = main([*arguments, "--output", "part.nc"])
    assert code == 0, capsys.readouterr().err
    lines = [re.sub(r"^N\d+ ", "", line) for line in Path("part.nc").read_text(encoding="utf-8").splitlines()]
    at = 0
    for line in shown.splitlines():
        assert line in lines[at:], f"{line} is not behind the lines before it"
        at = lines.index(line, at) + 1


def test_the_first_sample_of_the_page_is_proven(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    definition, part = tmp_path / "ours.toml", tmp_path / "part.cls"
    definition.write_text(blocks(PAGE)[0], encoding="utf-8")
    cl = (TESTS / "data" / "shop.cls").read_text(encoding="utf-8").replace("BORHED/40.5,DEEP\n", "")
    part.write_text(cl.replace("COOLNT/FLOOD", "COOLNT/THRU").replace("FEDRAT/MMPM,500", "FEDRAT/MMPM,2500"))
    assert main(["post", str(part), "--machine", str(definition), "--output", "-"]) == 0
    program = capsys.readouterr().out
    assert ";OPERATION 1: ROUGH TOP WITH D10" in program
    assert program.count(";WATCH THE PRESSURE") == 1
