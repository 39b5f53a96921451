"""``trunnion controls``: the shipped ones, and one with everything that can be set."""

import json
from pathlib import Path

import pytest

import trunnion
from trunnion.cli import main
from trunnion.controls import shipped_controls

Capture = pytest.CaptureFixture[str]


def test_the_list_names_every_shipped_control_with_its_family_and_the_number_of_its_settings(capfd: Capture) -> None:
    assert main(["controls"]) == 0
    lines = capfd.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == shipped_controls()
    for line, control in zip(lines, trunnion.describe_controls(), strict=True):
        assert line.split()[1:4] == [control.family, str(len(control.settings)), "settings"]
        assert line.endswith(f"{control.name}: {control.description}")


@pytest.mark.parametrize("name", shipped_controls())
def test_one_control_is_shown_with_all_of_its_settings_words_and_texts(name: str, capfd: Capture) -> None:
    assert main(["controls", name]) == 0
    out = capfd.readouterr().out
    control = trunnion.describe_control(name)
    for setting in (*control.settings, *control.run_settings):
        assert f"  {setting.name} = {setting.default}  [{setting.allowed}" in out
        assert f"      {setting.meaning}\n" in out
    assert "not explained" not in out
    texts = [text.name for text in control.texts]
    assert [line.strip() for line in out.splitlines() if line.strip() in texts] == texts
    assert texts[0] == "program_start"
    assert texts.index("tool_change") < texts.index("approach_three_axis") < texts.index("operation_end_three_axis")
    assert all(line in out for text in control.texts for line in text.lines)
    assert {"X", "Y", "Z", "primary", "secondary"} <= {word.name for word in control.words}


def test_what_a_control_can_do_follows_from_its_definition() -> None:
    told = {control.key: "\n".join(control.abilities) for control in trunnion.describe_controls()}
    assert "TCP: yes" in told["fanuc_31i"]
    assert "TCP: no" in told["fanuc_31i_basic"]
    assert "tilted planes: cycle800, frames" in told["sinumerik_840d"]
    assert (
        "tilted planes: spatial, vector, euler, points, relativ, axial, projected, cycle19" in told["heidenhain_tnc640"]
    )
    assert "tilted planes: no" in told["linuxcnc"]
    assert "five axes without TCP: no: what F counts there is not known" in told["fidia_nc15"]
    assert "surface normals: yes" in told["heidenhain_tnc640"]


def test_the_data_are_those_of_the_library(capfd: Capture) -> None:
    assert main(["controls", "--json"]) == 0
    listed = json.loads(capfd.readouterr().out)
    assert [entry["key"] for entry in listed] == shipped_controls()
    assert main(["controls", "linuxcnc", "--json"]) == 0
    shown, control = json.loads(capfd.readouterr().out), trunnion.describe_control("linuxcnc")
    assert [setting["name"] for setting in shown["settings"]] == [setting.name for setting in control.settings]
    assert shown["settings"][0].keys() == {"name", "meaning", "default", "allowed", "by_operation"}
    assert shown["texts"][0]["lines"] == list(control.texts[0].lines)


def test_a_definition_of_ones_own_is_explained_too_be_it_of_a_machine_or_of_a_control(
    tmp_path: Path, capfd: Capture
) -> None:
    settings = '[{0}settings]\nprobe = "off"\n[{0}setting_rules]\nprobe = {{ one_of = ["on", "off"] }}\n'
    meaning = '[{0}setting_meanings]\nprobe = "Probes the tool."\n'
    control, machine = tmp_path / "control.toml", tmp_path / "machine.toml"
    control.write_text(
        f'extends = "fanuc_31i"\nname = "Ours"\n{settings.format("")}{meaning.format("")}', encoding="utf-8"
    )
    machine.write_text(f'extends = "yl569"\n{settings.format("control.")}', encoding="utf-8")
    assert main(["controls", str(control)]) == 0
    out = capfd.readouterr().out
    assert out.startswith("Ours (")
    assert "  probe = off  [on or off; by operation]\n      Probes the tool.\n" in out
    assert main(["controls", str(machine)]) == 0
    out = capfd.readouterr().out
    assert "  probe = off  [on or off; by operation]\n      not explained in its definition" in out
    assert main(["controls", "yl569"]) == 0
    assert capfd.readouterr().out.startswith("Sinumerik 840D sl (yl569)")


def test_a_control_that_does_not_exist_is_named_with_those_that_do(capfd: Capture) -> None:
    assert main(["controls", "sinumerik_840"]) == 2
    err = capfd.readouterr().err
    assert "sinumerik_840: error: there is no shipped control of this name; did you mean" in err
