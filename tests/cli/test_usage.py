"""Arguments that cannot be understood: usage of the command, what is wrong, and the cure."""

import re
from pathlib import Path

import pytest

from tests.support.locations import DOCS, YL569
from trunnion.cli import main
from trunnion.cli.command_line.parser import parse
from trunnion.controls.loading import shipped_controls

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
        (["--cl", "a.cls", "b.cls"], "trunnion verify: error: 'b.cls' is one argument too many; repeat an option"),
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
