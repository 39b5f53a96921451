"""``trunnion check`` of what is no definition: it says what a file is, and each of its mistakes."""

import json
from pathlib import Path

import pytest

from tests.support.locations import ROOT
from trunnion.cli import main

EXAMPLES = ROOT / "examples"


@pytest.mark.parametrize(
    ("file", "said"),
    [
        ("project/part.toml", "a project: 2 set-ups; it posts plate_top.mpf, plate_bottom.mpf"),
        ("simulation/plate.toml", "a project: 2 set-ups to simulate"),
        ("project/tools.toml", "a tool library: 2 tools"),
        ("impeller/impeller.toml", "an impeller: "),
        ("batch/jobs.toml", "a file of jobs: "),
    ],
)
def test_a_file_is_said_to_be_what_it_is(file: str, said: str, capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["check", str(EXAMPLES / file)]) == 0
    assert said in capfd.readouterr().out


def test_a_mistake_is_that_of_its_own_kind(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    tools = tmp_path / "tools.toml"
    tools.write_text('[[tool]]\nnumber = 1\nkind = "flat"\ndiametre_mm = 10\nlength_mm = 60\n', encoding="utf-8")
    assert main(["check", str(tools)]) == 2
    err = capfd.readouterr().err
    assert "tools.toml:4" in err
    assert "diametre_mm" in err
    jobs = tmp_path / "jobs.toml"
    jobs.write_text('[[job]]\nfiles = ["*.cls"]\nmashine = "yl569"\n', encoding="utf-8")
    assert main(["check", str(jobs)]) == 2
    assert "jobs.toml:3" in capfd.readouterr().err


def test_a_schema_at_the_top_says_the_kind(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "empty.toml"
    file.write_text("#:schema ./trunnion-tools.schema.json\n", encoding="utf-8")
    main(["check", str(file)])
    assert "axis" not in "".join(capfd.readouterr())


def test_what_it_is_comes_as_data(capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["check", str(EXAMPLES / "project" / "tools.toml"), "--json"]) == 0
    data = json.loads(capfd.readouterr().out)
    assert (data["kind"], data["text"]) == ("tools", "a tool library: 2 tools")


def test_a_definition_is_still_a_definition(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "own.toml"
    file.write_text('extends = "yl569"\nname = "Ours"\n', encoding="utf-8")
    assert main(["check", str(file)]) == 0
    assert "From the workpiece to the tool" in capfd.readouterr().out
