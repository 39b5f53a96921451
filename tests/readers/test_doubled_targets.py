"""Targets of jumps that stand twice: controls refuse them, or choose one by their parameters."""

from pathlib import Path

import pytest

from trunnion.errors import InputError
from trunnion.machines import load_machine
from trunnion.readers import run_program
from trunnion.readers.program.options import RunOptions


def faults(folder: Path, machine: str, text: str) -> list[tuple[int, str]]:
    """Line and text of what is found about doubled targets."""
    file = folder / ("a.h" if machine == "dmu65" else "a.nc")
    file.write_text(text, encoding="utf-8")
    run = run_program(file, load_machine(machine))
    return [(found.line, found.text) for found in run.diagnostics if found.code == "NC163"]


def klartext(folder: Path, blocks: str) -> list[tuple[int, str]]:
    return faults(folder, "dmu65", f"BEGIN PGM A MM\n{blocks}\nEND PGM A MM\n")


@pytest.mark.parametrize(
    ("blocks", "found"),
    [
        ("LBL 5\nL X+1 R0 FMAX\nLBL 5\nL X+2 R0 FMAX\nLBL 05\nM30", [(4, "line 2"), (6, "line 2")]),
        ('LBL "top"\nL X+1 R0 FMAX\n7 LBL "TOP"\nM30', [(4, 'LBL "TOP" is set in line 2')]),
        ("LBL 5\nL IX+1 R0 FMAX\nCALL LBL 5 REP 3\nM30", []),
        ("LBL 5\nL IX+1 R0 FMAX\nCALL LBL 5 REP 3\nLBL 5\nM30", [(5, "line 2")]),
        # Behind the end of the run, loaded for a call and not.
        ("CALL LBL 1\nM30\nLBL 1\nLBL 0\nLBL 2\nLBL 0\nLBL 1\nLBL 0", [(8, "line 4")]),
        ("M30\nLBL 1\nLBL 0\nLBL 2\nLBL 0\nLBL 1\nLBL 0", [(7, "line 3")]),
        # A label that a jump passes over.
        ("FN 9: IF +1 EQU +1 GOTO LBL 3\nLBL 7\nLBL 7\nLBL 3\nM30", [(4, "line 3")]),
        ("CALL LBL 1\nCALL LBL 1\nM30\nLBL 1\nL X+1 R0 FMAX\nLBL 0", []),
    ],
)
def test_a_label_of_klartext_is_set_once(blocks: str, found: list[tuple[int, str]], tmp_path: Path) -> None:
    got = klartext(tmp_path, blocks)
    assert [line for line, _ in got] == [line for line, _ in found]
    assert all(part in text for (_, text), (_, part) in zip(got, found, strict=True))


def test_labels_of_a_called_program_are_its_own(tmp_path: Path) -> None:
    called = tmp_path / "sub.h"
    main = tmp_path / "main.h"
    main.write_text(
        'BEGIN PGM MAIN MM\nLBL 5\nCALL PGM "SUB.H"\nCALL PGM "SUB.H"\nM30\nEND PGM MAIN MM\n', encoding="utf-8"
    )
    for second, expected in (("LBL 6", []), ("LBL 5", [(4, str(called))])):
        called.write_text(f"BEGIN PGM SUB MM\nLBL 5\nL X+1 R0 FMAX\n{second}\nEND PGM SUB MM\n", encoding="utf-8")
        run = run_program(main, load_machine("dmu65"), RunOptions(subprograms=[called]))
        assert [(each.line, each.file) for each in run.diagnostics if each.code == "NC163"] == expected


@pytest.mark.parametrize(
    ("blocks", "lines"),
    [
        ("GOTO5\nN5 G0 X1.\nN6 X2.\nN5 X3.\nM30", [3]),
        ("N5 G0 X1.\nN5 X3.\nM30", []),
        ("GOTO5\nN5 G0 X1.\nM30\nO2\nN5\nM99", []),
        ("#1=0\nN5 G0 X1.\n#1=#1+1\nIF[#1LT3]GOTO5\nM30", []),
        ("#1=0\nN5 G0 X1.\n#1=#1+1\nIF[#1LT3]GOTO5\nN5\nM30", [6]),
    ],
)
def test_a_jump_of_a_fanuc_to_a_number_that_stands_twice(blocks: str, lines: list[int], tmp_path: Path) -> None:
    got = faults(tmp_path, "matsuura_mx330", f"%\nO1\n{blocks}\n%\n")
    assert [line for line, _ in got] == lines


def test_a_subprogram_of_linuxcnc_is_defined_once(tmp_path: Path) -> None:
    sub = "O{0} SUB\nG0 X1\nO{0} ENDSUB\n"
    twice = sub.format(100) + sub.format("0100") + "O100 CALL\nM2\n"
    with pytest.raises(InputError, match="line 1 has defined") as caught:
        faults(tmp_path, "xyzac_trt", twice)
    assert (caught.value.problems[0].line, caught.value.problems[0].code) == (4, "NC163")
    # Branches and loops may share a number.
    twice = "O1 IF [1 EQ 1]\nG0 X1\nO1 ENDIF\nO1 IF [1 EQ 1]\nG0 X2\nO1 ENDIF\nM2\n"
    assert faults(tmp_path, "xyzac_trt", twice) == []


def test_labels_of_a_sinumerik_may_stand_twice(tmp_path: Path) -> None:
    # GOTOF and GOTOB take the nearest one in their direction.
    text = "GOTOF MARK\nX1\nMARK:\nG0 X2\nGOTOF MARK\nMARK:\nM30\n"
    assert faults(tmp_path, "yl569", text) == []
