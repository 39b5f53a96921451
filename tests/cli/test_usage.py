"""Arguments that cannot be understood: usage of the command, what is wrong, and the cure."""

import re
from pathlib import Path

import pytest

import trunnion
from tests.support.locations import DOCS, YL569
from tests.support.usage_table import good_line
from trunnion.cli import main
from trunnion.cli.command_line.help_texts import command_help, overview
from trunnion.cli.command_line.parser import parse
from trunnion.controls.loading import shipped_controls
from trunnion.errors import InputError
from trunnion.jobs.guard import check_names
from trunnion.jobs.registry import JOBS
from trunnion.options.option import Many

PROGRAM = str(YL569 / "2_hub_rough.expected.mpf")
VERIFY = ["verify", PROGRAM, "--machine", "yl569"]

#: Commands that the page of them explains.
COMMANDS = re.findall(r"^## trunnion (\w+)$", (DOCS / "commands.md").read_text(encoding="utf-8"), re.MULTILINE)


def error_of(command: list[str], capsys: pytest.CaptureFixture[str]) -> str:
    """What a command that ends with exit code 2 says."""
    try:
        code: object = main(command)
    except SystemExit as stop:
        code = stop.code
    assert code == 2
    return capsys.readouterr().err


@pytest.mark.parametrize(
    ("more", "said"),
    [
        (
            ["--cl", "a.cls", "b.cls"],
            "trunnion verify: error: 'b.cls' is one argument too many; name files before the options",
        ),
        (["--accept"], "trunnion verify: error: --accept is no option of this command; trunnion test has it; trunnion"),
        (["--edge", "x"], "'x' is not a cutting edge; write its D number, such as 1"),
    ],
    ids=["two values", "option of another command", "edge"],
)
def test_a_usage_error_names_the_command_and_the_cure(
    more: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    err = error_of([*VERIFY, *more], capsys)
    assert err.count("\n") == 1
    assert said in err


@pytest.mark.parametrize("command", [VERIFY, ["convert", PROGRAM, "--machine", "yl569", "--to-cl"]], ids=lambda c: c[0])
def test_options_of_the_setup_are_named_as_they_are(command: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert error_of([*command, "--zero", "0,0"], capsys).startswith("--zero: error: is '0,0'; write X,Y,Z, such as ")
    assert error_of([*command, "--tool-length", "abc"], capsys).startswith("--tool-length: error: is 'abc'; write MM")


def test_a_misspelt_option_is_named_before_those_that_are_missing(capsys: pytest.CaptureFixture[str]) -> None:
    said = error_of(["post", PROGRAM, "--mashine", "yl569"], capsys)
    assert "trunnion post: error: --mashine is no option of this command" in said
    assert "required: --machine" in error_of(["post", PROGRAM, "--out", "x.mpf"], capsys)


@pytest.mark.parametrize(
    ("command", "said"),
    [
        (["new"], "required: NAME, --like MACHINE; for example: trunnion new our_mill --like dmu65"),
        (["post", PROGRAM], "required: --machine NAME_OR_FILE; for example: trunnion post part.cls --machine yl569"),
        (["convert", PROGRAM], "required: --to-cl or --to-machine NAME_OR_FILE; for example: trunnion convert"),
        (["diff", PROGRAM, "--machine", "yl569"], "required: NC; for example: trunnion diff old.mpf new.mpf --machine"),
        (["post", PROGRAM, "--machine"], "argument --machine has no value; write --machine NAME_OR_FILE"),
        (["post", PROGRAM, "--force=x"], "argument --force takes no value; write --force alone"),
        (["post", PROGRAM, "--ma", "yl569"], "--ma may be --machine or --max-tilt or --manifest; write one of them"),
        (["schema", "foo"], "argument KIND: 'foo' is unknown; write machine, control, project"),
    ],
    ids=lambda each: each if isinstance(each, str) else "",
)
def test_what_is_missing_is_named_with_a_cure(
    command: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert said in error_of(command, capsys)


@pytest.mark.parametrize("name", [job.name for job in JOBS.values() if job.option("json")])
def test_data_goes_to_a_file_of_data_in_every_command(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """What follows ``--json`` is its file, or - for stdout: never an input of the command."""
    monkeypatch.chdir(tmp_path)
    Path("part.cls").write_text("PARTNO/P\n", encoding="utf-8")
    option = JOBS[name].option("json")
    assert option is not None
    assert (option.flag, option.value_name, option.many) == ("--json", "FILE|-", Many.MAYBE)
    good = good_line(JOBS[name])
    assert parse([*good, "--json"]).json == "-"
    assert parse([*good, "--json", "-"]).json == "-"
    given = parse([*good, "--json", "part.cls"])
    assert given.json == "part.cls"
    with pytest.raises(InputError, match=r"data is JSON; let its name end in \.json"):
        check_names(given)
    check_names(parse([*good, "--json", "/dev/null"]))


def test_an_input_behind_json_is_not_written_over(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "part.cls"
    file.write_bytes((YL569 / "2_hub_rough.cls").read_bytes())
    said = error_of(["info", "--json", str(file)], capsys)
    assert f"required: CL; {file} is taken for the file of --json; write --json - for stdout" in said
    assert "data is JSON" in error_of(["info", PROGRAM, "--json", str(file)], capsys)
    assert file.read_bytes() == (YL569 / "2_hub_rough.cls").read_bytes()


@pytest.mark.parametrize("command", ["post", "place", "view"])
def test_a_wrong_option_that_is_a_setting_is_named_as_it_was_typed(
    command: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = str(YL569 / "2_hub_rough.cls")
    line = [
        command,
        file,
        "--machine",
        "yl569",
        *([] if command == "place" else ["--output", str(tmp_path / "o.html")]),
    ]
    assert error_of([*line, "--zero", "1,2"], capsys).startswith("--zero: error: is '1,2'; write X,Y,Z, such as")
    assert "--set: error: zero is '1,2'; write zero=X,Y,Z" in error_of([*line, "--set", "zero=1,2"], capsys)


def test_a_wrong_argument_that_is_a_setting_is_named_as_it_was_given() -> None:
    with pytest.raises(InputError, match=r"^tool_length: error: is 'abc'; write MM, 0 to 10000"):
        trunnion.post(YL569 / "2_hub_rough.cls", machine="yl569", tool_length="abc")
    with pytest.raises(InputError, match=r"^settings: error: tool_length is 'abc'; write tool_length=MM"):
        trunnion.post(YL569 / "2_hub_rough.cls", machine="yl569", settings={"tool_length": "abc"})


def test_help_states_defaults_and_what_is_required_alike() -> None:
    for job in JOBS.values():
        shown = " ".join(command_help(job).split())
        for option in job.flags:
            if option.default not in (None, ""):
                default = re.escape(str(option.default).removesuffix(".0"))
                assert re.search(rf"{option.flag} .*?; by default {default}", shown)
        assert not re.search(r"; [0-9.]+ (--|Options|Examples)", shown), job.name
    shown = command_help(JOBS["convert"])
    assert "(--to-cl | --to-machine NAME_OR_FILE)" in shown
    assert "(this or --to-machine is required)" in shown
    assert "\n  sensitivity  rank" in overview()


def test_a_line_without_a_command_is_told_where_they_are(capsys: pytest.CaptureFixture[str]) -> None:
    assert "trunnion: error: name a command; trunnion --help lists them" in error_of([], capsys)


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_has_help(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as stop:
        main([name, "--help"])
    assert stop.value.code == 0
    told = capsys.readouterr()
    assert told.out.startswith(f"usage: trunnion {name} ")
    assert told.err == ""


def test_check_takes_every_shipped_control(capsys: pytest.CaptureFixture[str]) -> None:
    for name in shipped_controls():
        assert main(["check", name]) == 0
        assert capsys.readouterr().out.startswith(f"{name}: good")


def test_no_page_names_the_zero_by_another_key() -> None:
    for page in (each for each in Path(DOCS).rglob("*.md") if each.name != "data.md"):  # keys of JSON have other rules
        rest = page.read_text(encoding="utf-8").replace("`spindle_point_mm`, `workpiece_zero_mm` | vectors", "")
        assert "workpiece_zero_mm" not in rest, page.name


def test_a_command_line_leaves_nothing_for_the_next_one() -> None:
    post = ["post", "a.cls", "--machine", "yl569"]
    more = parse([*post, "--set", "tool=7", "--subprograms", "a.spf", "--dialect", "apt"])
    again = parse(post)
    assert (more.settings, more.subprograms) == ([("tool", "7"), ("dialect", "apt")], ["a.spf"])
    assert (again.settings, again.subprograms, again.dialect) == ([], [], None)


@pytest.mark.parametrize(
    ("words", "cure"),
    [
        (["--zero", "0", "0", "0"], "numbers of one value are joined by commas: --zero 1,2,3"),
        (["-o", "x.nc"], "did you mean --output?"),
    ],
)
def test_what_is_typed_as_elsewhere_has_a_cure(words: list[str], cure: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["post", "x.cls", "--machine", "yl569", *words])
    assert cure in capsys.readouterr().err


def test_help_is_a_word_too(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["help", "post"])
    assert not ended.value.code
    assert "trunnion post" in capsys.readouterr().out
