"""Values of settings that a program cannot hold are refused as settings, before anything is read."""

from pathlib import Path

import pytest

from trunnion.errors import InputError
from trunnion.jobs.describe.controls import describe_control
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
