"""Names of Klartext programs: what is wrong with one, and files that are called as they are named."""

from pathlib import Path

import pytest

import trunnion
from tests.support.klartext import TILTED
from trunnion.errors import InputError


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("PART.H", 'without "."; in these letters it is PART_H'),
        ("A B/C", 'without " ", "/"'),
        ("叶轮_1", 'without "叶", "轮"; in these letters it is YeLun_1'),
        ("×", 'without "×"'),
        ("X" * 30, "this has 30"),
    ],
)
def test_an_error_names_the_wrong_character(name: str, said: str, tmp_path: Path) -> None:
    part = tmp_path / "part.cls"
    part.write_text(TILTED, encoding="utf-8")
    with pytest.raises(InputError, match=said):
        trunnion.post(part, machine="dmu65", settings={"program": name})


def test_programs_of_operations_are_called_by_the_names_of_their_files(tmp_path: Path) -> None:
    part, program = tmp_path / "part.cls", tmp_path / "main.h"
    part.write_text(TILTED, encoding="utf-8")
    result = trunnion.post(part, machine="dmu65", output=program, settings={"programs": "operations"})
    names = [Path(each).name for each in result.subprograms]
    assert names
    calls = [line.split("CALL PGM ")[1] for line in program.read_text().splitlines() if "CALL PGM" in line]
    assert calls == names
