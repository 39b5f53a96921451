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


def test_a_tool_table_is_checked_without_its_unit(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    table = tmp_path / "tool.tbl"
    table.write_text("T1 P1 Z10 D6 ;ok\nT2 P2 Z20 D8\n", encoding="utf-8")
    assert main(["check", str(table)]) == 0
    out, err = capfd.readouterr()
    assert "a tool library: 2 tools" in out
    assert "does not say its unit" in err
    assert "SIM175" in err
    table.write_text("T1 P1 D6 D7\n", encoding="utf-8")
    assert main(["check", str(table)]) == 2


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


def test_what_is_not_checked_is_said_so(capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["check", str(ROOT / "tests/golden/yl569/2_hub_rough.cls")]) == 2
    err = capfd.readouterr().err
    assert "is of no kind that this command checks; give a definition, a project, a tool library" in err


def test_an_empty_definition_says_which_number_to_write(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "empty.toml"
    file.write_text("", encoding="utf-8")
    assert main(["check", str(file)]) == 2
    assert "schema is missing; write 1 [" in capfd.readouterr().err


@pytest.mark.parametrize("text", ['extends = "yl569"\n', 'schema = 1\n[[axis]]\nname = "X"\n'])
def test_a_machine_in_place_of_a_project_is_named(text: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "mill.toml"
    file.write_text(text, encoding="utf-8")
    assert main(["simulate", str(file)]) == 2
    assert "mill.toml: error: is a machine definition; give a project" in capfd.readouterr().err


def test_a_definition_in_the_folder_is_meant_by_its_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("our_mill.toml").write_text('extends = "yl569"\nname = "Ours"\n', encoding="utf-8")
    for arguments in (["check", "our_mill"], ["post", "a.cls", "--machine", "our_mill"]):
        assert main(arguments) == 2
        assert 'did you mean "our_mill.toml"?' in capfd.readouterr().err


def test_a_tool_of_a_misspelt_kind_has_its_other_mistakes_too(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "lib.toml"
    file.write_text('[[tool]]\nnumber = 1\nkind = "flatt"\nfoo = 2\nlength_mm = 60\n', encoding="utf-8")
    assert main(["check", str(file)]) == 2
    err = capfd.readouterr().err
    assert all(word in err for word in ("flatt", "foo", "diameter_mm is missing"))


def test_a_project_that_posts_misses_its_output(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    file, cl = tmp_path / "part.toml", tmp_path / "a.cls"
    cl.write_text("GOTO/0,0,0\n", encoding="utf-8")
    file.write_text('machine = "yl569"\ncl = ["a.cls"]\noutptu = "a.mpf"\n', encoding="utf-8")
    assert main(["check", str(file)]) == 2
    err = capfd.readouterr().err
    assert "output is missing" in err
    assert "programs is missing" not in err


def test_a_project_means_the_definition_beside_it(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "our_mill.toml").write_text('extends = "yl569"\nname = "Ours"\n', encoding="utf-8")
    file = tmp_path / "part.toml"
    file.write_text('machine = "our_mill"\ncl = ["a.cls"]\noutput = "a.mpf"\n', encoding="utf-8")
    assert main(["check", str(file)]) == 2
    assert 'machine is "our_mill"; did you mean "our_mill.toml"?' in capfd.readouterr().err
