"""Reading projects that are posted: every mistake with its line, and no file outside of their folders."""

from pathlib import Path

import pytest

import trunnion
from tests.support.projects import PROJECT, SETUPS, contents, project
from trunnion.jobs.project.file import load_project, read_project
from trunnion.jobs.project.project import Division, Judgement


def told(path: Path) -> list[tuple[int, str]]:
    with pytest.raises(trunnion.InputError) as raised:
        load_project(path)
    assert all(problem.file == str(path) for problem in raised.value.problems)
    return [(problem.line, f"{problem.what}; {problem.cure}") for problem in raised.value.problems]


def test_keys_stand_at_the_top_or_in_the_table_of_a_simulation(tmp_path: Path) -> None:
    found = load_project(project(tmp_path))
    (setup,) = found.setups
    assert (setup.cl, setup.machine, setup.output) == ((str(tmp_path / "top.cls"),), "yl569", tmp_path / "top.mpf")
    assert (setup.division, dict(setup.settings)) == (Division.ONE, {"title": "TOP"})
    assert found.checks.simulate is Judgement.OFF
    table = load_project(project(tmp_path, f"[simulation]\n{PROJECT}"))
    assert [each.output for each in table.setups] == [tmp_path / "top.mpf"]


def test_set_ups_share_what_stands_above_them_and_state_their_own(tmp_path: Path) -> None:
    shared = 'settings = { title = "ALL", tolerance = 0.02, tcp = false }\ndivide = "subprograms"\n'
    own = 'zero_mm = [0, 0, -160]\ntool_length_mm = 110\ndivide = "one"\nsettings = { title = "BELOW" }\n'
    found = load_project(project(tmp_path, shared + SETUPS + own + "[checks]\nsimulate = 'warn'\nlongest_s = 60\n"))
    top, bottom = found.setups
    assert (top.name, top.division, bottom.division) == ("top", Division.SUBPROGRAMS, Division.ONE)
    assert dict(top.settings) == {"title": "ALL", "tolerance": 0.02, "tcp": False}
    assert dict(bottom.settings) == {
        "title": "BELOW", "tolerance": 0.02, "tcp": False, "zero": [0, 0, -160], "tool_length": 110,
        "work_offset": "G55",
    }  # fmt: skip
    assert (found.checks.simulate, found.checks.longest_s) == (Judgement.WARN, 60.0)


def test_every_mistake_is_told_at_once_with_its_line(tmp_path: Path) -> None:
    text = """\
machine = "yl596"
cl = ["none.cls"]
output = "../top.mpf"
divide = "two"
hooks = ["/etc/hooks.py"]
strict = "yes"
report = ""
settings = { title = [1, "x"], zero = "0,0,0", programs = "operations" }
titel = 1
[checks]
simulate = "always"
longest_s = 0
"""
    found = told(project(tmp_path, text))
    assert [line for line, _ in found] == [1, 2, 3, 4, 5, 6, 7, 8, 8, 8, 9, 11, 12]
    words = [
        "did you mean", "there is no such file", "leads out of the folder", 'write one of "one", "subprograms"',
        "leads out of the folder", "write true or false", "name a file in the folder", "title is [1, 'x']",
        "is said by the key zero_mm", "is said by the key divide", "is not a key that is known",
        'write one of "off", "warn", "refuse"', "above 0",
    ]  # fmt: skip
    for (_, message), word in zip(found, words, strict=True):
        assert word in message


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        (PROJECT.replace('output = "top.mpf"\n', ""), 1, 'output is missing; name the program that is posted: output'),
        (PROJECT.replace('cl = ["top.cls"]\n', ""), 1, "cl is missing; name the CL files"),
        (PROJECT + 'programs = ["top.cls"]\n', 5, "programs stands beside output"),
        (PROJECT.replace("top.mpf", "below/"), 3, "is a folder; name a file in it"),
        (PROJECT.replace("top.mpf", "CON:x"), 3, "leads out of the folder"),
        (SETUPS.replace('machine = "yl569"', 'machine = "yl569"\noutput = "x.mpf"'), 2, "stands beside set-ups"),
        (SETUPS.replace('name = "bottom"', 'name = "top"'), 11, 'is "top" twice'),
        (PROJECT + 'work_offset = "G54"\n[settings.x]\ny = 1\n', 6, "is not TOML"),
        (PROJECT + 'work_offset = "G54"\nsettings.work_offset = "G55"\n', 6, "is not TOML"),
        (PROJECT.replace("{ ", '{ work_offset = "G55", ') + 'work_offset = "G54"\n', 4, "said by the key work_offset"),
        (SETUPS + "until = 10\n", 15, "is not a key"),
        ('until = 10\nchecks = { simulate = "warn" }\n' + SETUPS, 1, "ends the simulation early"),
        ('machine = "yl569"\ncl = ["top.cls"]\nprograms = ["top.cls"]\n', 1, "posts nothing"),
        (PROJECT + 'divide = "operations"\nreport = "top.html"\n', 6, "is one report, and every operation"),
        ('[[axis]]\nname = "C"\n', 0, "is a machine definition; give a project"),
        ('name = "C"\n', 0, "is no project: it has none of the keys"),
        (PROJECT.replace('["top.cls"]', f"{['top.cls'] * 1001}"), 2, "names 1001 files; name at most 1000"),
    ],
)  # fmt: skip
def test_a_mistake_is_told_where_it_stands(tmp_path: Path, text: str, line: int, words: str) -> None:
    found = told(project(tmp_path, text))
    assert any(words in message for _, message in found), found
    assert line in [number for number, _ in found]


@pytest.mark.third
@pytest.mark.parametrize("key", ["cl", "output", "released", "report", "hooks", "fixtures", "machine", "stock"])
@pytest.mark.parametrize("value", ["/etc/passwd.toml", "../top.cls", "c:/top.cls", "..\\\\top.cls", "link/top.toml"])
def test_no_file_outside_of_the_folder_is_named(tmp_path: Path, key: str, value: str) -> None:
    folder = tmp_path / "part"
    (tmp_path / "outside").mkdir()
    (tmp_path / "outside" / "top.toml").write_text("secret")
    path = project(folder)
    (folder / "link").symlink_to(tmp_path / "outside", target_is_directory=True)
    stated = f'"{value}"' if key in ("output", "report", "machine", "stock") else f'["{value}"]'
    stated = stated if key != "machine" or ".toml" in stated else f'"{value}.toml"'
    lines = [line for line in PROJECT.splitlines() if not line.startswith(f"{key} ")]
    path.write_text("\n".join([f"{key} = {stated}", *lines]))
    before = contents(folder)
    assert [line for line, message in told(path) if "leads out of the folder" in message] == [1]
    assert contents(folder) == before


@pytest.mark.parametrize(
    "value", ["[]", "[[]]", "{}", "[{}]", "1", "-1", "nan", "true", '""', '["x", 1]', "2026-01-01"]
)
def test_a_value_of_any_type_is_told_with_its_line(tmp_path: Path, value: str) -> None:
    keys = ["cl", "output", "divide", "released", "report", "hooks", "strict", "settings", "checks", "work_offset"]
    for key in [*keys, "zero_mm", "tool_length_mm", "machine", "setup"]:
        lines = dict(line.split(" = ", 1) for line in PROJECT.splitlines()) | {key: value}
        path = project(tmp_path, "\n".join(f"{name} = {each}" for name, each in lines.items()))
        assert all(problem.line for problem in mistakes(path)), key


def mistakes(path: Path) -> list[trunnion.Problem]:
    try:
        load_project(path)
    except trunnion.InputError as error:
        return list(error.problems)
    return []


def test_programs_that_are_not_posted_yet_cannot_be_simulated(tmp_path: Path) -> None:
    path = project(tmp_path, SETUPS)
    with pytest.raises(trunnion.InputError, match=r"names \"top.mpf\".*no such file yet; post it first: trunnion post"):
        read_project(path)
    path.write_text(SETUPS.replace('name = "top"', 'name = "top"\ndivide = "operations"'))
    with pytest.raises(trunnion.InputError, match="becomes several files, whose names are known only"):
        read_project(path)


def test_a_project_that_would_take_forever_to_judge_is_refused(tmp_path: Path) -> None:
    names = str(["top.cls"] * 900)
    setups = "".join(f'[[setup]]\ncl = {names}\nfixtures = {names}\noutput = "{k}.mpf"\n' for k in range(50))
    (found,) = told(project(tmp_path, f'machine = "yl569"\n{setups}'))
    assert "is beyond the 10000 files" in found[1]
    many = "".join(f"k{k} = 1\n" for k in range(600))
    assert (
        "settings has 600 keys" in told(project(tmp_path, f"{PROJECT.rsplit('settings')[0]}[settings]\n{many}"))[0][1]
    )
    unknown = told(project(tmp_path, PROJECT + many))
    assert len(unknown) == 101
    assert "has 600 keys that are not known here" in unknown[0][1]
