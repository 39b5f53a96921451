"""Settings of a definition that nothing reads are told where their names resemble those of others."""

import json
from pathlib import Path

import pytest

import trunnion
from trunnion import schemas
from trunnion.controls import load_control
from trunnion.controls.vocabulary import READING_KEYS
from trunnion.errors import InputError
from trunnion.machines import load_machine, shipped_machines

PROGRAM = "%\nO0001\nG21 G17 G40 G80 G90 G94\nT1 M6\nG54\nG0 X0. Y0. S900 M3\nG43 H1 Z50.\nM5\nG49 G53 G0 Z0.\nM30\n%\n"


def defined(folder: Path, text: str, base: str = "matsuura_mx330") -> Path:
    file = folder / "own.toml"
    file.write_text(f'extends = "{base}"\n{text}\n', encoding="utf-8")
    return file


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("[control.settings]\ntolerence = 0.02", "tolerence is a setting that nothing reads"),
        ('[control.settings]\nwork_ofset = "G55"', "work_ofset is a setting that nothing reads; write work_offset"),
        ('[control.settings]\nstart_modes = "G18"', "start_modes is a key of [control.reading], and no setting"),
        ('[control.settings]\nstart_distances = "incremental"', "start_distances is a key of [control.reading]"),
        ("[spindle]\nmin_rpm = 500\nmax_rpm = 100", "min_rpm is 500, above max_rpm 100"),
    ],
)
def test_a_mistake_is_told_by_every_command_that_needs_the_control(text: str, fault: str, tmp_path: Path) -> None:
    machine, program = defined(tmp_path, text), tmp_path / "part.nc"
    program.write_text(PROGRAM, encoding="utf-8")
    for run in (
        lambda: trunnion.verify(program, machine=machine),
        lambda: trunnion.diff(program, program, machine=machine),
        lambda: load_control(load_machine(machine).control),
    ):
        with pytest.raises(InputError) as refused:
            run()
        assert fault in str(refused.value)


def test_a_setting_of_its_own_for_a_function_of_the_user_stays(tmp_path: Path) -> None:
    machine = defined(tmp_path, '[control.settings]\nour_cell = "7"')
    assert load_control(load_machine(machine).control).settings["our_cell"] == "7"


def test_no_shipped_definition_has_a_misspelt_setting() -> None:
    for name in shipped_machines():
        load_control(load_machine(name).control)


def test_the_keys_of_reading_are_those_of_the_schema() -> None:
    file = Path(schemas.__file__).with_name("trunnion-machine.schema.json")
    control = json.loads(file.read_text(encoding="utf-8"))["properties"]["control"]["properties"]
    assert set(control["reading"]["properties"]) == READING_KEYS
