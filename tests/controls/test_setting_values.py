"""Values of settings that a program cannot hold are refused as settings, before anything is read."""

from pathlib import Path

import pytest

import trunnion
from tests.support.posting import FOOT, HEAD
from trunnion.controls import load_control
from trunnion.errors import InputError
from trunnion.jobs.describe.controls import describe_control
from trunnion.jobs.inputs.settings import as_texts
from trunnion.jobs.post.post_job import prepare
from trunnion.machines import load_machine

MACHINES = ["yl569", "dmu65", "matsuura_mx330", "haas_umc750", "xyzac_trt", "hs664rt"]


def problem(machine: str, **settings: str) -> str:
    """What is wrong with settings of a post; empty if nothing is."""
    try:
        prepare(load_machine(machine), settings)
    except InputError as error:
        return "; ".join(f"{found.what}: {found.cure}" for found in error.problems)
    return ""


@pytest.mark.parametrize("machine", MACHINES)
def test_only_the_number_of_a_tool_as_programs_write_it_is_one(machine: str) -> None:
    for tool in ("05", "0", "-1", "1.5", " 5", "5 ", "\uff15", "99999999999", "+5", "1,5"):
        assert f"tool is {tool!r}: write the tool's number, such as 5" in problem(machine, tool=tool)
    assert not problem(machine, tool="5")


def test_the_greatest_number_of_a_tool_is_that_of_the_control() -> None:
    assert "and at most 9999" in problem("matsuura_mx330", tool="10000")
    assert not problem("matsuura_mx330", tool="9999")
    assert not problem("yl569", tool="MILL 20")
    assert not problem("yl569", tool='"1.5"')


def test_the_number_of_a_program_is_one_that_the_control_takes() -> None:
    assert "of at least 1 and of at most 99999" in problem("haas_umc750", program="12345678")
    assert not problem("haas_umc750", program="12345")
    assert not problem("matsuura_mx330", program="1234")
    assert "of at most 9999." in problem("matsuura_mx330", program="12345")  # eight digits are an option of the control


@pytest.mark.parametrize(
    ("machine", "setting"),
    [
        *(("yl569", f"bore_lift={value}") for value in ("0", "0.0000001", "-0.0004", "x")),
        *(("matsuura_mx330", f"bore_lift={value}") for value in ("0", "0.0000001", "-0.5")),
        ("yl569", "swivel_style="),
        ("dmu65", "program="),
        ("matsuura_mx330", "program="),
        ("haas_umc750", "program="),
        ("matsuura_mx330", "call="),
        ("hs664rt", "preselect=on"),
        ("hs664rt", "series=AB"),
        ("matsuura_mx330", "tool_call=name"),
        ("hs664rt", "tool_call=name"),
        ("xyzac_trt", "tool_call=name"),
        ("yl569", "preselect=perhaps"),
    ],
)
def test_values_that_do_nothing_or_cannot_be_are_refused(machine: str, setting: str) -> None:
    name, _, value = setting.partition("=")
    assert f"{name} is {value!r}: " in problem(machine, **{name: value})


@pytest.mark.parametrize(
    ("machine", "settings"),
    [
        ("yl569", {"bore_lift": "0.5"}),
        ("yl569", {"bore_lift": "-0.5"}),
        ("matsuura_mx330", {"bore_lift": "0.5", "program": "0001"}),
        ("hs664rt", {"series": "AB", "program": "7"}),
        ("dmu65", {"preselect": "on", "tool_call": "name"}),
    ],
)
def test_other_values_are_taken(machine: str, settings: dict[str, str]) -> None:
    assert not problem(machine, **settings)


def test_a_setting_that_a_definition_gives_a_default_is_listed_once(tmp_path: Path) -> None:
    file = tmp_path / "inches.toml"
    file.write_text('extends = "yl569"\n[control.settings]\nunits = "inch"\n', encoding="utf-8")
    control = describe_control(str(file))
    (units,) = [each for each in (*control.settings, *control.run_settings) if each.name == "units"]
    assert (units.default, units.allowed) == ("inch", "mm or inch")
    assert units.meaning


def own_control(folder: Path, *lines: str) -> list[str]:
    """What is wrong with the settings of a definition; each line of it is one."""
    file = folder / "ours.toml"
    file.write_text("\n".join(['extends = "yl569"', "[control.settings]", *lines]) + "\n", encoding="utf-8")
    try:
        load_machine(str(file))
        load_control(load_machine(str(file)).control)
    except InputError as error:
        return [f"{found.line}: {found.what}: {found.cure}" for found in error.problems]
    return []


def test_a_definition_states_a_setting_as_text_or_as_what_it_is(tmp_path: Path) -> None:
    lines = ("operation_clearance = 25", "tolerance = 1e-3", "edge = 2", "stop_between = true", "date = 2026-05-04")
    assert own_control(tmp_path, *lines) == []
    settings = load_control(load_machine(str(tmp_path / "ours.toml")).control).settings
    assert [settings[line.split()[0]] for line in lines] == ["25", "0.001", "2", "on", "2026-05-04"]
    assert settings["safe_start"] == "own"


@pytest.mark.parametrize(
    ("line", "told"),
    [
        ("edge = [2]", "is [2]: write a text in quotes, or a number"),
        ("operation_clearance = inf", "is inf: write a text in quotes, or a number"),
        ("operation_clearance = true", "is true: write a text in quotes, or a number"),
        ("same_tool = true", 'is true: write one of "home", "retract", "clearance"'),
        ("operation_clearance = 2500", "is '2500': write a number in mm of at least 1 and of at most 1000"),
        ("swivel_retract = 3", "is '3': write 0 or 1 or 2 or 4 or 5"),
    ],
)
def test_a_setting_that_is_wrong_is_told_once(line: str, told: str, tmp_path: Path) -> None:
    assert own_control(tmp_path, line) == [f"3: control.settings.{line.split()[0]} {told}"]


def test_a_switch_of_a_setting_without_one_is_told_with_its_words() -> None:
    with pytest.raises(InputError, match="same_tool is True") as found:
        as_texts({"same_tool": True})
    assert "write same_tool=home or same_tool=retract" in found.value.problems[0].cure


@pytest.mark.nightly
def test_what_a_definition_sets_can_be_left_out_again(tmp_path: Path) -> None:
    cl = tmp_path / "part.cls"
    cl.write_text(HEAD + "RAPID\nGOTO/0,0,50\nFEDRAT/MMPM,200\nGOTO/0,0,5\n" + FOOT, encoding="utf-8")
    texts = [trunnion.post(cl, machine="yl569", settings=given).text or "" for given in ({}, {"method": ""})]
    assert ['MSG("' in text for text in texts] == [True, False]
    assert ["TECHNOLOGY" in text for text in texts] == [True, False]
