"""A machine whose M7 is flood and whose M8 is mist, in every control."""

from pathlib import Path

import pytest

import trunnion
from tests.support.locations import TESTS
from trunnion.errors import InputError

CL = TESTS / "data" / "cases" / "tilted_flood.cls"
_SWAPPED = "[control.coolant]\nFLOOD = 7\nON = 7\nTAP = 7\nMIST = 8\n"


def machine_file(folder: Path, machine: str, text: str) -> Path:
    path = folder / "ours.toml"
    path.write_text(f'extends = "{machine}"\nname = "Ours"\n{text}', encoding="utf-8")
    return path


@pytest.mark.parametrize("machine", ["yl569", "dmu65", "matsuura_mx330", "haas_umc750", "xyzac_trt", "hs664rt"])
def test_the_coolant_of_the_definition_is_written_read_and_proven(machine: str, tmp_path: Path) -> None:
    ours = machine_file(tmp_path, machine, _SWAPPED + ("THRU = 50\n" if machine == "dmu65" else ""))
    program = tmp_path / ("part.h" if machine == "dmu65" else "part.nc")
    trunnion.post(CL, machine=ours, output=program)
    text = program.read_text(encoding="utf-8")
    assert "M7" in text
    assert trunnion.verify(program, machine=ours, cl=CL).passed
    assert "COOLNT/ON" in (trunnion.convert(program, machine=ours, to_cl=True).text or "")
    program.write_text(text.replace("M7", "M8"), encoding="utf-8")
    found = trunnion.verify(program, machine=ours, cl=CL)
    assert [check.key for check in found.checks if not check.passed] == ["coolant"]


def test_a_name_that_stays_behind_is_refused_with_its_cure(tmp_path: Path) -> None:
    ours = machine_file(tmp_path, "yl569", "[control.coolant]\nFLOOD = 7\nMIST = 8\nTAP = 7\n")
    with pytest.raises(InputError) as caught:
        trunnion.post(CL, machine=ours, output=tmp_path / "part.mpf")
    assert "write ON = 7, as FLOOD is" in str(caught.value)
