"""Every setting is explained beside its definition, and errors, the command line and the docs all say the same."""

from pathlib import Path

import pytest

import trunnion
from tests.support.locations import YL569
from tests.support.settings_page import PAGE, page
from trunnion.controls import shipped_controls
from trunnion.controls.definition_files import load_control_table
from trunnion.controls.loading import load_control
from trunnion.families import FAMILIES, load_writer
from trunnion.jobs.inputs.run_settings import RUN_SETTINGS
from trunnion.options.groups import POSTING

#: A meaning is one or two sentences.
_SHORTEST, _LONGEST = 15, 320


def unexplained(settings: dict[str, str]) -> list[str]:
    """Settings without a meaning in sentences."""
    return [key for key, text in settings.items() if not (_SHORTEST <= len(text) <= _LONGEST and text.endswith("."))]


@pytest.mark.parametrize("name", shipped_controls())
def test_every_setting_of_a_shipped_control_is_explained(name: str) -> None:
    control = load_control(load_control_table(name))
    assert control.settings
    assert unexplained({key: control.setting_meanings.get(key, "") for key in control.settings}) == []
    assert control.setting_meanings.keys() <= control.settings.keys()
    assert control.description


@pytest.mark.parametrize("family", FAMILIES)
def test_every_setting_of_a_family_is_explained(family: str) -> None:
    writer = load_writer(family)
    assert writer.SETTING_MEANINGS.keys() == writer.SETTING_CHOICES.keys()
    assert unexplained(writer.SETTING_MEANINGS) == []


def test_every_setting_of_a_post_is_explained() -> None:
    assert unexplained({key: setting.meaning for key, setting in RUN_SETTINGS.items()}) == []
    for setting in RUN_SETTINGS.values():
        assert setting.default
        assert str(setting.allowed).strip(" ,")


def test_a_setting_without_a_meaning_would_be_noticed() -> None:
    assert unexplained({"new": "", "bare": "too short", "good": "What it changes, in a sentence."}) == ["new", "bare"]


def test_the_page_of_settings_is_what_the_definitions_say() -> None:
    assert PAGE.read_text(encoding="utf-8") == page(), "run: python -m tests.support.settings_page"


def test_the_page_of_the_commands_names_every_setting_of_a_post() -> None:
    text = (PAGE.parent.parent / "commands.md").read_text(encoding="utf-8")
    options = {option.setting for option in POSTING}  # each has a row in the table of options
    assert [key for key in RUN_SETTINGS if key not in options and f"| `{key}` |" not in text] == []


@pytest.mark.parametrize(
    ("setting", "value", "said"),
    [
        (
            "plane",
            "tilted",
            "plane is 'tilted'; write cycle800 or frames. The command for a tilted plane: CYCLE800, or",
        ),
        (
            "stock",
            "x",
            "write a number in mm of at least -1000 and of at most 1000. Stock that the operation leaves, mm",
        ),
        ("rewind", "no", "rewind is 'no'; write rewind=insert or rewind=none. Insert a retract where a rotary axis"),
        ("pole_angle", "40", "write pole_angle=DEGREES, 0.001 to 10, such as 0.1. How far the tool axis may lean"),
        (
            "clearance",
            "cube:3",
            "write clearance=MM or plane:Z or sphere:R, such as plane:120. How far the tool retracts",
        ),
        ("zero", "1,2", "write zero=X,Y,Z, such as 0,0,120.5. Position of the workpiece zero"),
    ],
)
def test_an_error_in_a_setting_says_what_the_setting_means(setting: str, value: str, said: str) -> None:
    with pytest.raises(trunnion.InputError) as caught:
        trunnion.post(YL569 / "2_hub_rough.cls", machine="yl569", settings={setting: value})
    assert said in str(caught.value)


def test_a_meaning_must_be_that_of_a_setting(tmp_path: Path) -> None:
    file = tmp_path / "mine.toml"
    file.write_text(
        'extends = "sinumerik_840d"\nname = "Ours"\n[setting_meanings]\nplane = "Ours."\nplaen = "None."\n',
        encoding="utf-8",
    )
    with pytest.raises(trunnion.InputError, match=r"mine.toml:5: error: setting_meanings.plaen explains no setting"):
        trunnion.describe_control(file)
