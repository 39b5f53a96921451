"""Definitions like shipped ones, schemas, resolved definitions, and what ``trunnion check`` says is assumed."""

import json
import os
import shutil
import subprocess
import sys
import tomllib
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import trunnion
from trunnion.cli import main
from trunnion.controls.loading import with_control
from trunnion.definitions import Table, load_table
from trunnion.definitions.value_marks import marked_values
from trunnion.machines import Machine, load_machine, shipped_machines
from trunnion.machines.loading import machine_library
from trunnion.options.words import SCHEMAS
from trunnion.schemas import KINDS, file_name, first_line, put_beside, schema_text

Capture = pytest.CaptureFixture[str]

TAPLO = shutil.which("taplo", path=str(Path(sys.executable).parent)) or shutil.which("taplo")


@pytest.fixture(autouse=True)
def in_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


#: What is compared apart, or names the places where it stands.
_PLACED = ("control", "assumed", "unmeasured", "inherited")


def same_machine(one: Machine, other: Machine) -> bool:
    """Whether two machines are alike but for what they are called and where they come from."""
    bodies = [[replace(body, place=("", 0)) for body in machine.bodies] for machine in (one, other)]
    plain = [
        replace(machine, key="", name="", files=(), unmeasured=(), control=one.control, bodies=tuple(own))
        for machine, own in zip((one, other), bodies, strict=True)
    ]
    return all(getattr(plain[0], name) == getattr(plain[1], name) for name in Machine.__slots__ if name not in _PLACED)


@pytest.mark.parametrize("base", shipped_machines())
def test_a_new_definition_is_short_sound_and_its_base_until_something_is_measured(base: str, capfd: Capture) -> None:
    assert main(["new", "our_mill", "--like", base]) == 0
    text = Path("our_mill.toml").read_text(encoding="utf-8")
    assert text.startswith(f"{first_line('machine')}# Like {base} (")
    assert len(text.splitlines()) < 50
    marks = len(marked_values(text))
    assert f"our_mill.toml: extends {base}, {marks} numbers to measure" in capfd.readouterr().out
    made, shipped = load_machine("our_mill.toml"), load_machine(base)
    assert made.name == "our_mill"
    assert same_machine(made, replace(shipped, spindle_point_is_stated=made.spindle_point_is_stated))
    rotary = sum(axis.is_rotary for axis in made.axes)
    assert sum(key.endswith("point_mm") for key, _, _ in marked_values(text)) >= rotary == 2
    assert Path(file_name("machine")).read_text(encoding="utf-8") == schema_text("machine")


def test_a_new_definition_can_be_posted_with_and_says_what_it_has_from_its_base(capfd: Capture) -> None:
    assert main(["new", "ours", "--like", "yl569"]) == 0
    text = Path("ours.toml").read_text(encoding="utf-8")
    Path("ours.toml").write_text(text.replace("point_mm = [0, 0, 0] # measure", "point_mm = [0, 0, -60] # was", 1))
    capfd.readouterr()
    assert main(["check", "ours.toml"]) == 0
    told = capfd.readouterr().out.partition("What is assumed\n")[2].partition("\n\n")[0]
    assert "Still to enter: spindle max_rpm (ours.toml:9), B point_mm (ours.toml:17)" in told
    assert "C point_mm (ours.toml" not in told
    assert "From yl569.toml, which is another machine" in told
    assert "rapid traverse (C, B, X, Y, Z)" in told
    assert "which axes turn endlessly (C), how a program writes their angles (C)" in told
    assert "Acceleration of C, B, X, Y, Z: not stated" in told


@pytest.mark.parametrize(
    ("arguments", "what"),
    [
        (["new", "there", "--like", "yl569"], "there.toml: error: is there already"),
        (["new", "ours", "--like", "yl568"], 'there is no shipped machine of this name; did you mean "yl569"?'),
        (["new", "ours", "--like", "./yl569.toml"], "there is no shipped machine of this name"),
        (["new", "con", "--like", "yl569"], "con: error: is no name for a file on every system"),
        (["new", "a:b", "--like", "yl569"], "is no name for a file"),
        (["new", ".ours", "--like", "yl569"], "is no name for a file"),
        (["new", "", "--like", "yl569"], "is no name for a file"),
        (["new", "no/ours", "--like", "yl569"], "there is no folder"),
        (["machines", "--resolved"], "--resolved: error: wants a machine"),
        (["machines", "nobody", "--resolved"], "there is no shipped machine of this name"),
    ],
)  # fmt: skip
def test_what_cannot_be_made_is_told_and_nothing_is_written(arguments: list[str], what: str, capfd: Capture) -> None:
    Path("there.toml").write_text("kept", encoding="utf-8")
    assert main(arguments) == 2
    assert what in capfd.readouterr().err
    assert [each.name for each in Path().iterdir()] == ["there.toml"]
    assert Path("there.toml").read_text(encoding="utf-8") == "kept"


def plain(table: Any) -> Any:
    """A merged definition without what it extends, as TOML would give it."""
    if isinstance(table, dict):
        return {key: plain(value) for key, value in table.items() if key != "extends"}
    return [plain(item) for item in table] if isinstance(table, list) else table


@pytest.mark.parametrize("name", [*shipped_machines(), "ours.toml"])
def test_a_resolved_definition_says_the_same_with_the_place_of_each_value(name: str, capfd: Capture) -> None:
    own = 'extends = "yl569"\nname = "Ours \\"2\\""\n'
    own += 'description = "a\\u202eb\\U000e0041轮 ä\\tc"\n[[axis]]\nname = "B"\nlimits_deg = [-5, 95]\n'
    own += '[control.known]\n"G65 P9810" = "comes back"\n'
    Path("ours.toml").write_text(own, encoding="utf-8")
    assert main(["machines", name, "--resolved"]) == 0
    text = capfd.readouterr().out
    table = load_table(name, machine_library(), kind="machine")
    merged = with_control(table)
    assert tomllib.loads(text) == plain(Table(merged).to_dict())
    Path("resolved.toml").write_text(text, encoding="utf-8")
    assert same_machine(load_machine("resolved.toml"), load_machine(name))
    for line in text.splitlines():
        if line.startswith("limits_deg = [-5, 95]"):
            assert line.endswith("# ours.toml:6")
    if name == "ours.toml":
        assert '"G65 P9810" = "comes back"  # ours.toml:8\n' in text
        assert "limits_deg = [-5, 95]" in text


def test_the_places_of_a_resolved_definition_are_true(capfd: Capture) -> None:
    assert main(["machines", "generic_nutated_b45_c", "--resolved"]) == 0
    lines = capfd.readouterr().out.splitlines()
    files = dict(line[2:].split(": ", 1) for line in lines if line.startswith("# ") and ": " in line)
    seen = 0
    for line in lines:
        key, _, rest = line.partition(" = ")
        name, _, number = rest.rpartition("# ")[2].rpartition(":")
        if name in files and key.isidentifier():
            source = Path(files[name]).read_text(encoding="utf-8").splitlines()[int(number) - 1]
            assert key in source, line
            seen += 1
    assert seen > 200


@pytest.mark.parametrize("kind", KINDS)
def test_a_schema_is_printed(kind: str, capfd: Capture) -> None:
    assert main(["schema", kind]) == 0
    assert json.loads(capfd.readouterr().out)["title"].startswith("Trunnion: ")
    assert SCHEMAS == KINDS


def test_a_schema_of_another_version_is_replaced_and_a_file_of_others_is_not() -> None:
    place, definition = Path(file_name("machine")), Path("ours.toml")
    assert put_beside(definition, "machine") == place
    assert put_beside(definition, "machine") is None
    place.write_text('{"title": "Trunnion: machine definition", "old": 1}', encoding="utf-8")
    assert put_beside(definition, "machine") == place
    assert place.read_text(encoding="utf-8") == schema_text("machine")
    for others in ("my notes", '{"title": "Ours"}', "[]"):
        place.write_text(others, encoding="utf-8")
        assert put_beside(definition, "machine") is None
        assert place.read_text(encoding="utf-8") == others


def test_what_a_machine_in_memory_leaves_open_is_told_without_files() -> None:
    found = trunnion.describe_machine(replace(load_machine("yl569"), spindle_max_rpm=None))
    assert "Highest spindle speed: not stated, and not checked." in found.assumed
    assert not any(".toml" in each for each in found.assumed)


def linted() -> tuple[int, str]:
    """The exit code and the messages of taplo, which editors run."""
    assert TAPLO
    done = subprocess.run([TAPLO, "lint", "ours.toml"], capture_output=True, text=True, check=False, encoding="utf-8")
    return done.returncode, done.stderr


@pytest.mark.skipif(TAPLO is None and "CI" not in os.environ, reason="taplo is not installed")
def test_an_editor_finds_the_schema_and_its_mistakes() -> None:
    assert main(["new", "ours", "--like", "yl569"]) == 0
    assert linted()[0] == 0
    with Path("ours.toml").open("a", encoding="utf-8") as stream:
        stream.write('\n[control.coolant]\nON = "off"\n\n[facts]\ntool_pokets = 3\n')
    code, told = linted()
    assert code == 1
    assert '"off" is not valid' in told
    assert "tool_pokets" in told


@pytest.mark.skipif(TAPLO is None and "CI" not in os.environ, reason="taplo is not installed")
def test_an_editor_finds_mistakes_in_a_project() -> None:
    Path(file_name("project")).write_text(schema_text("project"), encoding="utf-8")
    part = first_line("project") + 'machine = "yl569"\ncl = ["a.cls"]\noutput = "a.mpf"\n'
    Path("ours.toml").write_text(part, encoding="utf-8")
    assert linted()[0] == 0
    Path("ours.toml").write_text(part + 'divide = "both"\nreports = "a.html"\n', encoding="utf-8")
    code, told = linted()
    assert code == 1
    assert '"both" is not one of' in told
    assert "reports" in told


def test_a_definition_of_ones_own_has_no_name_of_a_shipped_machine(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["new", "yl569", "--like", "yl569"]) == 2
    assert "is the name of a shipped machine" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_the_next_command_can_be_pasted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["new", "our mill", "--like", "yl569"]) == 0
    assert "next: trunnion check 'our mill.toml'" in capfd.readouterr().out
