"""Operations without a tolerance of the control, where the programs of the definition state one."""

from pathlib import Path

import pytest

import trunnion

JOB = """TOOL PATH/FACE,TOOL,D6
TLDATA/MILL,6.0,0.0,75.0,0.0,0.0
INTOL/0.01
OUTTOL/0.01
LOAD/TOOL,1
SPINDL/RPM,4000,CLW
RAPID
GOTO/0.0,0.0,60.0,0.0,0.0,1.0
FEDRAT/MMPM,500.0
GOTO/0.0,0.0,10.0
GOTO/10.0,0.0,10.0
RAPID
GOTO/10.0,0.0,60.0
END-OF-PATH
"""


@pytest.mark.parametrize(
    ("machine", "word", "line"),
    [("yl569", "CYCLE832", "CYCLE832("), ("dmu65", "CYCL DEF 32", "CYCL DEF 32."), ("xyzac_trt", "G64 P", "G64 P")],
)
def test_a_tolerance_that_no_block_states_is_not_checked(machine: str, word: str, line: str, tmp_path: Path) -> None:
    cl, program = tmp_path / "part.cls", tmp_path / "part.nc"
    cl.write_text(JOB, encoding="utf-8")
    text = trunnion.post(cl, machine=machine).text or ""

    def said(blocks: str) -> list[str]:
        program.write_text(blocks, encoding="utf-8")
        checks = trunnion.verify(program, machine=machine, cl=cl, tolerance=0.005).checks
        return [str(each) for each in next(each for each in checks if each.key == "modal").missing]

    without = "\n".join(block for block in text.splitlines() if line not in block)
    assert said(text) == []
    assert [word in each for each in said(f"{without}\n")] == [True]
