"""A slash before one line of a loop or a branch, which block skip would take apart, is refused in every control."""

from pathlib import Path

import pytest

from trunnion.errors import InputError
from trunnion.machines import load_machine
from trunnion.readers import run_program
from trunnion.readers.program.options import RunOptions

#: A machine, the lines of a structure whose keywords stand in the places of {}, and how many these are.
STRUCTURES = [
    ("matsuura_mx330", "%\nO1\n#1=0\n{}WHILE[#1LT2]DO1\n#1=#1+1\n{}END1\nM30", 2),
    ("haas_umc750", "%\nO1\n#1=0\n{}WHILE[#1LT2]DO1\n#1=#1+1\n{}END1\nM30", 2),
    ("linuxcnc_5axis", "#1=0\n{}o1 if [#1 EQ 0]\nG0 X1\n{}o1 else\nG0 X2\n{}o1 endif\nM2", 3),
    ("linuxcnc_5axis", "#1=0\n{}o1 while [#1 LT 2]\n#1=[#1+1]\n{}o1 endwhile\nM2", 2),
    ("linuxcnc_5axis", "{}o1 repeat [2]\nG0 X1\n{}o1 endrepeat\nM2", 2),
    ("yl569", "R1=0\n{}IF R1==0\nG0 X1\n{}ELSE\nG0 X2\n{}ENDIF\nM30", 3),
    ("yl569", "R1=0\n{}WHILE R1<2\nR1=R1+1\n{}ENDWHILE\nM30", 2),
    ("yl569", "R1=0\n{}FOR R1=1 TO 2\nG0 X1\n{}ENDFOR\nM30", 2),
    ("yl569", "R1=0\n{}REPEAT\nR1=R1+1\n{}UNTIL R1>2\nM30", 2),
    ("yl569", "R1=0\n{}LOOP\nR1=R1+1\nIF R1>2 GOTOF OUT\n{}ENDLOOP\nOUT: M30", 2),
]  # fmt: skip


@pytest.mark.parametrize(("machine", "lines", "count"), STRUCTURES)
@pytest.mark.parametrize("skip", [False, True])
def test_a_slash_stands_before_all_lines_of_a_structure_or_none(
    machine: str, lines: str, count: int, skip: bool, tmp_path: Path
) -> None:
    path = tmp_path / "part.nc"

    def read(*signs: str) -> None:
        path.write_text(lines.format(*signs) + "\n", encoding="utf-8")
        run_program(path, load_machine(machine), RunOptions(skip=skip))

    for slashed in range(count):
        with pytest.raises(InputError, match="block skip would take the structure apart"):
            read(*("/" if each == slashed else "" for each in range(count)))
    read(*[""] * count)
    if "LOOP" not in lines:
        read(*["/"] * count)
