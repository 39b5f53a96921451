"""A plane by another swivel data set than the settings give is a fault: it may be of another head or table."""

from pathlib import Path

import trunnion

CASE = Path(__file__).parents[1] / "data" / "cases" / "tilted.cls"
MACHINE = "generic_head_table_bc"


def faults(program: Path, machine: str) -> list[str]:
    result = trunnion.verify(program, machine=machine, cl=[CASE])
    return [check.key for check in result.checks if not check.passed and check.key == "turns"]


def test_the_swivel_data_set_is_that_of_the_definition(tmp_path: Path) -> None:
    program, own = tmp_path / "part.mpf", tmp_path / "own.toml"
    trunnion.post([CASE], machine=MACHINE, output=program)
    assert faults(program, MACHINE) == []
    text = program.read_text(encoding="utf-8")
    program.write_text(text.replace('CYCLE800(0,""', 'CYCLE800(0,"TABLE2"'), encoding="utf-8")
    assert faults(program, MACHINE) == ["turns"]
    own.write_text(f'extends = "{MACHINE}"\n[control.settings]\nswivel_data = \'"TABLE2"\'\n', encoding="utf-8")
    assert faults(program, str(own)) == []
