"""``trunnion post --suggest`` writes a project that posts, once the words in capitals are filled in."""

import re
from pathlib import Path

import pytest

import trunnion
from tests.support.posting import FOOT, HEAD
from trunnion.cli import main
from trunnion.cli.suggest import NotingTerminal, suggestion
from trunnion.jobs.inputs.settings import as_texts
from trunnion.jobs.job import Given
from trunnion.jobs.project.file import load_project
from trunnion.jobs.project.project import Judgement, Project
from trunnion.jobs.registry import JOBS
from trunnion.options.kinds import FileOut, Setting
from trunnion.options.option import Option
from trunnion.options.words import WORDS_TO_FILL

_BARE = HEAD.replace("LOAD/TOOL,1,ADJUST,1\n", "").replace("SPINDL/RPM,4000.0000,CLW\n", "")
TWO = _BARE + FOOT + _BARE.replace("OP1", "OP 2").replace("D10", "D12").replace("FEDRAT/MMPM,500.0\n", "") + FOOT


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "part.cls").write_text(TWO, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_the_project_posts_once_it_is_filled_in(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    post = ["post", "part.cls", "--machine", "matsuura_mx330", "--set", "title=BLADE", "--suggest", "part.toml"]
    assert main([*post, "--output", "part.nc"]) == 2
    project = folder / "part.toml"
    text = project.read_text(encoding="utf-8")
    assert 'title = "BLADE"' in text
    assert 'tool = "OP1:NUMBER,OP 2:NUMBER"' in text
    assert 'spindle = "OP1:RPM,OP 2:RPM"' in text
    assert 'missing_feed = "OP 2:MM_MIN"' in text
    assert '\n# standing_spindle = "allowed"' in text
    assert main(["post", "part.toml"]) == 2, "nothing is filled in"
    assert main(["check", "part.toml"]) == 2
    said = capsys.readouterr().err
    for word in ("NUMBER", "RPM", "MM_MIN"):
        assert f"has the word {word}, in whose place a value is to stand" in said
    filled = text.replace("NUMBER", "7", 1).replace("NUMBER", "8").replace("RPM", "900").replace("MM_MIN", "300")
    project.write_text(filled, encoding="utf-8")
    assert main(["post", "part.toml"]) == 0
    program = (folder / "part.nc").read_text(encoding="utf-8")
    assert "S900" in program
    assert "F300." in program


def test_a_file_that_is_there_stays(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "part.toml").write_text("# mine\n", encoding="utf-8")
    assert main(["post", "part.cls", "--machine", "yl569", "--suggest", "part.toml"]) == 2
    assert "FIL250" in capsys.readouterr().err
    assert (folder / "part.toml").read_text(encoding="utf-8") == "# mine\n"


def test_what_a_project_cannot_name_is_refused(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "below").mkdir()
    assert main(["post", "part.cls", "--machine", "yl569", "--suggest", "below/part.toml"]) == 2
    assert "FIL320" in capsys.readouterr().err
    assert not (folder / "below" / "part.toml").exists()


def test_numbers_that_were_given_stand_under_their_keys(folder: Path) -> None:
    (folder / "part.cls").write_text(HEAD + FOOT, encoding="utf-8")
    post = ["post", "part.cls", "--machine", "yl569", "--zero", "0,0,-100", "--tool-length", "120.5"]
    assert main([*post, "--output", "part.mpf", "--suggest", "part.toml"]) == 0
    text = (folder / "part.toml").read_text(encoding="utf-8")
    assert "zero_mm = [0, 0, -100]" in text
    assert "tool_length_mm = 120.5" in text
    assert main(["post", "part.toml"]) == 0


MESSAGES = Path(trunnion.__file__).parent / "messages" / "en"
_SETTING = re.compile(r"\{setting:\w+=([^}]*)\}")

#: Values of the options of a post that a project states; those of files are there.
_GIVEN: dict[str, object] = {
    "machine": "matsuura_mx330", "output": "other.nc", "subprograms": ["sub.nc"], "hooks": ["hook.py"],
    "units": "mm", "dialect": "clsf", "strict": True, "zero": "G54=1,2,-3.5,G55=4,5,6", "tool_length": "1=100,2=80.25",
    "feed": "fastest", "max_tilt": 40.0, "edited": "keep", "report": "o.html", "sheet": "s.html", "listing": "o.lst",
    "manifest": "o.json", "turn": 30.0, "tilt": 10.0, "simulate": True, "stock": "box:200,100,30,-100,-50,-30",
    "part": "part.stl", "tools": ["1=flat:20,length=60", "2=ball:6,length=40"], "tool_libraries": ["tools.toml"],
    "unit": "inch", "fixtures": ["vice.stl"], "near": 0.5, "cell": 1.25, "accuracy": 0.01,
}  # fmt: skip

#: Options that are no values of a project: with its files, as a whole.
_NOT_STATED = {"project"}

_SAID = [each for each in JOBS["post"].flags if (each.key or each.setting) and not isinstance(each.kind, Setting)]


def _suggested(**given: object) -> Project:
    """The project that a post suggests to which all this was given."""
    values = {each.name: each.empty for each in JOBS["post"].options}
    values |= {"cl": ["part.cls"], "machine": "yl569", "suggest": "part.toml"} | given
    values["settings"] = [
        (each.setting, str(values[each.name])) for each in _SAID if each.setting and each.name in given
    ]
    with suggestion(Given(JOBS["post"], values), str(values["output"] or "part.nc"), NotingTerminal()):
        pass
    return load_project(Path("part.toml"))


@pytest.mark.parametrize("option", [each for each in _SAID if each.name not in _NOT_STATED], ids=lambda each: each.name)
def test_the_project_says_what_an_option_said(folder: Path, option: Option) -> None:
    for name in ("sub.nc", "hook.py", "part.stl", "vice.stl"):
        (folder / name).write_text("", encoding="utf-8")
    (folder / "tools.toml").write_text("[[tool]]\nnumber = 1\n", encoding="utf-8")
    value = _GIVEN[option.name]
    project = _suggested(
        **({option.name: value} if option.name != "simulate" else {"stock": "box:1,1,1", "simulate": 1})
    )
    (posted,), simulation = project.setups, project.simulation
    if option.setting:
        said = as_texts(posted.settings)[option.setting]
        assert said.replace(".0", "") == str(value).replace(".0", "")
    elif option.name == "simulate":
        assert project.checks.simulate is Judgement.REFUSE
    elif isinstance(option.kind, FileOut):
        written = {"output": posted.output, **posted.papers.by_name()}
        assert str(written[option.name]) == value
    else:
        places = (project, posted, simulation, simulation.setups[0])
        said = posted.arguments.get(option.name) or next(
            getattr(each, option.name) for each in places if hasattr(each, option.name)
        )
        assert (list(said) if isinstance(value, list) else said) == value


def test_what_the_project_of_a_simulation_states_is_stated_again(folder: Path) -> None:
    (folder / "simulated.toml").write_text(
        'programs = ["old.mpf"]\nstock = "box:60,40,10,-20,-20,-9"\ncell_mm = 2\n'
        'tools = ["1=flat:10,length=60,flutes=30"]\nfixtures = ["box:5,5,5,-40,0,-9"]\n',
        encoding="utf-8",
    )
    post = ["post", "part.cls", "--machine", "yl569", "--output", "part.mpf", "--simulate", "--cell", "3"]
    assert main([*post, "--project", "simulated.toml", "--suggest", "part.toml"]) == 2
    text = (folder / "part.toml").read_text(encoding="utf-8")
    assert "left out" not in text
    (folder / "part.toml").write_text(
        text.replace("NUMBER", "1").replace("RPM", "900").replace("MM_MIN", "300"), encoding="utf-8"
    )
    project = load_project(folder / "part.toml")
    assert project.checks.simulate is Judgement.REFUSE
    assert (project.simulation.stock, project.simulation.cell) == ("box:60,40,10,-20,-20,-9", 3.0)
    setup = project.simulation.setups[0]
    assert (list(setup.tools), list(setup.fixtures)) == (
        ["1=flat:10,length=60,flutes=30"], ["box:5,5,5,-40,0,-9"],
    )  # fmt: skip


def test_settings_are_written_as_a_project_takes_them(folder: Path) -> None:
    (folder / "part.cls").write_text(HEAD + FOOT, encoding="utf-8")
    post = ["post", "part.cls", "--machine", "yl569", "--zero", "G54=1,2,-3,G55=4,5,6", "--tool-length", "1=100"]
    post += ["--set", "programs=operations", "--set", "work_offset=G54", "--output", "part.mpf"]
    assert main([*post, "--suggest", "part.toml"]) == 0
    text = (folder / "part.toml").read_text(encoding="utf-8")
    assert "zero_mm = { G54 = [1, 2, -3], G55 = [4, 5, 6] }" in text
    assert "tool_length_mm = { 1 = 100 }" in text
    assert 'divide = "subprograms"' in text
    assert load_project(folder / "part.toml")


def test_what_a_project_does_not_state_is_named(folder: Path) -> None:
    assert _suggested(strict=True, explain=True, force=True, json="-")
    text = (folder / "part.toml").read_text(encoding="utf-8")
    assert "# A project does not state --force, --explain, --json: what was given there is left out." in text
    assert "strict = true" in text


def test_nothing_is_written_where_nothing_can_be_filled_in(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "part.cls").write_text(HEAD + "ORIGIN/1,2\n" + FOOT, encoding="utf-8")
    post = ["post", "part.cls", "--machine", "yl569", "--output", "part.mpf", "--suggest", "part.toml"]
    for _ in range(2):
        assert main(post) == 2
        said = capsys.readouterr().err
        assert "part.toml: not written: nothing can be filled in that ends the errors" in said
        assert "FIL250" not in said
        assert not (folder / "part.toml").exists()


def test_errors_that_no_setting_ends_are_counted(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "part.cls").write_text(
        _BARE + FOOT + HEAD.replace("MMPM,500.0", "MMPR,0.0001").replace("OP1", "OP2") + FOOT, encoding="utf-8"
    )
    post = ["post", "part.cls", "--machine", "matsuura_mx330", "--output", "part.nc", "--suggest", "part.toml"]
    assert main(post) == 2
    assert "2 settings to fill in, 1 decision behind #, 1 error to mend otherwise; then:" in capsys.readouterr().err
    assert "for a tool that does not turn" in (folder / "part.toml").read_text(encoding="utf-8"), "conditions are kept"


def test_a_file_that_no_project_names_is_refused(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "a\\b.cls").write_text(HEAD + FOOT, encoding="utf-8")
    assert main(["post", "a\\b.cls", "--machine", "yl569", "--output", "b.mpf", "--suggest", "part.toml"]) == 2
    assert "FIL320" in capsys.readouterr().err
    assert not (folder / "part.toml").exists()


def test_every_word_that_messages_ask_to_fill_in_is_known_to_projects() -> None:
    asked = [value for file in sorted(MESSAGES.glob("*.toml")) for value in _SETTING.findall(file.read_text("utf-8"))]
    words = {value.rpartition(":")[2].lstrip("-") for value in asked}
    assert {word for word in words if re.fullmatch("[A-Z_,]+|…", word)} <= {*WORDS_TO_FILL}
