"""Where programs begin and end: what stands outside never runs, or no control loads it."""

from pathlib import Path

import pytest

import trunnion
from trunnion.errors import Severity

BEGIN, END = "0 BEGIN PGM A MM\n", "9 END PGM A MM\n"
CUT = "1 TOOL CALL 1 Z S99\n2 L X+1 FMAX M3\n"
LABEL = "3 CALL LBL 1\n4 M30\n5 LBL 1\n6 L X+2 FMAX\n7 LBL 0\n"

#: Machine, program, the line of its error, 0 for none; below 0 that of a warning of what never runs.
PROGRAMS = [
    ("dmu65", f"{BEGIN}{CUT}3 M30\n{END}\n; the end\n", 0),
    ("dmu65", f"; first\n{BEGIN}{CUT}{LABEL}{END}", 0),
    ("dmu65", f"{CUT}{BEGIN}{END}", 3),
    ("dmu65", f"{BEGIN}{CUT}3 M30\n", 4),
    ("dmu65", f"{BEGIN}{CUT}", 3),
    ("dmu65", f"{BEGIN}{CUT}3 M30\n{END}10 L X+5 FMAX\n", -6),
    ("dmu65", f"{BEGIN}{CUT}{END}{BEGIN}{CUT}{END}", 5),
    ("dmu65", f"{BEGIN}{CUT}{BEGIN}{CUT}{END}", 4),
    ("dmu65", f"{BEGIN}{CUT}END PGM B MM\n", 4),
    ("dmu65", f"{BEGIN}{CUT}3 M30\n9 END PGM B MM\n", 5),
    ("dmu65", f"{BEGIN}{CUT}3 M30\n9 END PGM MM\n", 5),
    ("dmu65", f"{BEGIN}{CUT}3 M30\n9 END PGM a MM ; done\n", 0),
    ("dmu65", f"{CUT}3 M30\n", 3),
    ("dmu65", CUT, 2),
    ("dmu65", f"{CUT}3 M30\n{END}", 4),
    ("dmu65", f"{CUT}{END}", 3),
    ("yl569", "G710 G54\nG0 X1\nM30\n; end\n\n", 0),
    ("yl569", "G710 G54\nG0 X1\nM30\nN5 X2\n", -4),
    ("yl569", "G710 G54\nGOTOF ONE\nTWO:\nM30\nONE: X2\nGOTOB TWO\n", 0),
    ("matsuura_mx330", "%\nO1\nG21 G54\nG0 X1.\nM30\n%\n", 0),
    ("matsuura_mx330", "%\nO1\nG21 G54\nM98 P2\nM30\nO2\nX2.\nM99\n%\n", 0),
    ("matsuura_mx330", "%\nO1\nG21 G54\nG0 X1.\nM30\nO2\nG0 X2.\nM30\n%\n", 6),
    ("matsuura_mx330", "%\nO1\nG21 G54\nG0 X1.\nM30\n%\nG0 X2.\n", -7),
    ("xyzac_trt", "%\nG21 G54\nG0 X1\nM2\n%\n(end)\n", 0),
    ("xyzac_trt", "%\nG21 G54\nG0 X1\nM2\nX2\n%\n", -5),
    ("hs664rt", "G71\nG55 O1\nX1.\nM2\n(end)\n", 0),
    ("hs664rt", "G71\nG55 O1\nX1.\nM2\nX2.\n", -5),
]


@pytest.mark.parametrize(
    ("machine", "text", "line"), PROGRAMS, ids=[f"{machine}-{k}" for k, (machine, _, _) in enumerate(PROGRAMS)]
)
def test_what_stands_outside_of_a_program_is_reported(machine: str, text: str, line: int, tmp_path: Path) -> None:
    program = tmp_path / "part.nc"
    program.write_text(text)
    run = trunnion.read_program(program, machine=machine)
    never = [-each.line for each in run.diagnostics if each.wording.code == "NC161" and each not in run.errors]
    assert [*(error.line for error in run.errors), *never] == ([line] if line else []), run.diagnostics


def test_the_end_of_a_klartext_program_ends_it(tmp_path: Path) -> None:
    program = tmp_path / "part.h"
    for m30 in ("", "3 M30\n"):
        program.write_text(f"{BEGIN}{CUT}{m30}{END}")
        run = trunnion.read_program(program, machine="dmu65")
        assert [event.value for event in run.events if event.kind == "end"] == ["M30" if m30 else "END PGM"]


def test_sizes_of_a_tool_count_when_it_is_in_the_spindle(tmp_path: Path) -> None:
    program = tmp_path / "part.h"
    lines = ["TOOL DEF 2 L+5 R+0", "TOOL DEF 3 L+7", "TOOL CALL 1 Z S99", "TOOL DEF 1 R+3", "TOOL CALL 2 Z S99"]
    program.write_text("\n".join(["BEGIN PGM A MM", *lines, "END PGM A MM"]))
    run = trunnion.read_program(program, machine="dmu65")
    assert [(each.line, each.severity) for each in run.diagnostics] == [(5, Severity.WARNING), (6, Severity.WARNING)]
    deltas = [event.value for event in run.events if event.kind == "delta"]
    assert deltas == [("TOOL DEF R", 3.0), ("TOOL DEF L", 5.0)]
    program.write_text("BEGIN PGM A MM\nTOOL DEF 2 S5\nEND PGM A MM\n")
    assert [error.line for error in trunnion.read_program(program, machine="dmu65").errors] == [2]
