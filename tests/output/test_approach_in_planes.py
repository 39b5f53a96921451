"""From home into a tilted plane: X and Y first, then along the tool."""

import re
from pathlib import Path

import pytest

from tests.support.posting import FOOT, HEAD
from trunnion import verify
from trunnion.cli import main

#: A cut and a hole under a tilted tool.
TILTED = HEAD.replace("50.0,0.0,0.0,1.0", "50.0,0.6,0.0,0.8").replace("GOTO/10.0,0.0,5.0\n", "GOTO/10.0,4.0,5.0\n")
HOLE = HEAD.partition("FEDRAT")[0].replace("OP1", "OP2").replace("50.0,0.0,0.0,1.0", "50.0,0.6,0.0,0.8") + (
    "CYCLE/DRILL,RAPTO,3,FEDTO,-5,RTRCTO,20,MMPM,90\nGOTO/30.0,4.0,5.0\nCYCLE/OFF\n"
)


@pytest.mark.parametrize(
    ("machine", "settings"),
    [
        ("yl569", ()),
        ("yl569", ("--set", "plane=frames")),
        ("generic_head_table_bc", ()),
        ("dmu65", ()),
        ("dmu65", ("--set", "plane=vector")),
        ("mikron_600u", ("--set", "plane=cycle19")),
        ("matsuura_mx330", ()),
        ("hs664rt", ()),
    ],
)
@pytest.mark.parametrize("text", [TILTED + FOOT, HOLE + FOOT], ids=["cut", "hole"])
def test_x_and_y_come_before_z(tmp_path: Path, machine: str, settings: tuple[str, ...], text: str) -> None:
    file, program = tmp_path / "part.cls", tmp_path / "part.nc"
    file.write_text(text, encoding="utf-8")
    assert main(["post", str(file), "--machine", machine, "--output", str(program), *settings]) == 0
    lines = program.read_text(encoding="utf-8").splitlines()
    command = re.compile(r"CYCLE800\([^)]|AROT Z|PLANE (SPA|VEC)|G53\.1|G154|19\.1")
    plane = next(k for k, line in enumerate(lines) if command.search(line))
    moves = [
        line for line in lines[plane + 1 :] if re.search(r"\b[XYZ][-+.\d]", line) and not re.search(r"CYCL|AROT", line)
    ]
    assert "Z" not in moves[0].replace("FMAX", ""), moves[:2]
    assert re.search(r"\bX", moves[0])
    assert not re.search(r"\b[XY][-+.\d]", moves[1])
    assert re.search(r"\bZ", moves[1])
    assert verify(program, machine=machine, cl=file, work_offset=None).passed
