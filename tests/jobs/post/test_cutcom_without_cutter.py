"""Radius compensation of a CL file that does not state its tool: nobody can say what the operator enters."""

from pathlib import Path

import pytest

import trunnion

LINES = (
    "PARTNO A", "UNITS/MM", "{tool}LOADTL/1", "SPINDL/3000,CLW", "FEDRAT/800,MMPM", "RAPID", "GOTO/0,0,50", "RAPID",
    "GOTO/0,0,5", "CUTCOM/LEFT", "GOTO/30,0,5", "GOTO/30,60,5", "CUTCOM/OFF", "GOTO/-30,60,5", "RAPID", "GOTO/30,0,50",
    "FINI",
)  # fmt: skip


@pytest.mark.parametrize(("tool", "told"), [("", 1), ("CUTTER/10\n", 0)])
def test_the_post_warns_where_the_radius_is_not_known(tool: str, told: int, tmp_path: Path) -> None:
    file = tmp_path / "part.cls"
    file.write_text("\n".join(LINES).format(tool=tool) + "\n", encoding="utf-8")
    warnings = [each for each in trunnion.post(file, machine="yl569").problems if each.code == "SIM147"]
    assert len(warnings) == told
    assert all("CUTCOM is on, and the CL file does not state the diameter" in each.what for each in warnings)
