"""Programs that never end, or that are made to take long, end by a limit: counted in blocks, not in seconds."""

from pathlib import Path

import pytest

from trunnion.errors import InputError
from trunnion.machines import load_machine
from trunnion.readers import run_program
from trunnion.readers.program import interpreter, limits
from trunnion.readers.program.options import DEFAULT_OPTIONS, RunOptions

KLARTEXT = "0 BEGIN PGM A MM\n"
FANUC = "%\nO1\nG21 G90 G94 F100.\n"

#: Machine and text of programs that go on without end.
ENDLESS = {
    "loop": ("yl569", "LOOP\nG0 X1\nENDLOOP\n"),
    "while": ("yl569", "WHILE 1==1\nR1=R1+SIN(R1)\nENDWHILE\n"),
    "goto": ("yl569", "MARK:\nG0 X1\nGOTOB MARK\n"),
    "for in for": ("yl569", "FOR R1=1 TO 1000000\nFOR R2=1 TO 1000000\nX1\nENDFOR\nENDFOR\n"),
    "messages": ("yl569", 'LOOP\nMSG("' + 300 * "A" + '")\nENDLOOP\n'),
    "swivel": ("yl569", 'LOOP\nCYCLE800(0,"",0,57,0,0,0,10,20,30,0,0,0,0,0,1)\nX1\nENDLOOP\n'),
    "frames": ("yl569", "LOOP\nAROT X10\nX1 Y2\nENDLOOP\n"),
    "transformation": ("yl569", "LOOP\nTRAORI\nX1\nTRAFOOF\nX2 B3\nENDLOOP\n"),
    "labels": ("dmu65", KLARTEXT + "LBL 1\nL IX+0.001 FMAX\nCALL LBL 1 REP 65534\nCALL LBL 1 REP 65534\n"),
    "labels in labels": (
        "dmu65",
        KLARTEXT
        + "CALL LBL 1\nM30\n"
        + "".join(f"LBL {k}\n" + 2 * f"CALL LBL {k + 1}\n" + "LBL 0\n" for k in range(1, 19))
        + "LBL 19\nL X+1 FMAX\nLBL 0\n",
    ),
    "planes": (
        "dmu65",
        KLARTEXT + "LBL 1\nPLANE SPATIAL SPA-9 SPB+0 SPC+9 TURN FMAX SEQ-\nL X+1\nCALL LBL 1 REP 65534\n",
    ),
    "jumps": ("dmu65", KLARTEXT + "LBL 1\nFN 9: IF +1 EQU +1 GOTO LBL 1\n"),
    "while of a Fanuc": ("matsuura_mx330", FANUC + "WHILE[1EQ1]DO1\nG1X1.\nEND1\n"),
    "goto of a Fanuc": ("matsuura_mx330", FANUC + "N1 G1X1.\nGOTO1\n"),
    "holes of a Fanuc": ("matsuura_mx330", FANUC + "G83 X0. Y0. Z-9. R0. Q.01\n" + 10 * "X1. K9999\n"),
    "while of LinuxCNC": ("xyzac_trt", "G21 F100\no1 while [1]\nG1 X1\no1 endwhile\n"),
    "repeat of LinuxCNC": (
        "xyzac_trt",
        "G21\no1 repeat [1000000]\no2 repeat [1000000]\nG0 X1\no2 endrepeat\no1 endrepeat\n",
    ),
}


#: Which is run up to the limit that users have; all interpreters count their steps in one place.
TO_THE_END = "loop"


@pytest.mark.third
@pytest.mark.parametrize("name", ENDLESS)
def test_what_never_ends_is_ended_with_its_line(name: str, tmp_path: Path) -> None:
    machine, text = ENDLESS[name]
    limit = DEFAULT_OPTIONS.step_limit if name == TO_THE_END else 5_000
    path = tmp_path / ("A.H" if machine == "dmu65" else "A.MPF" if machine == "yl569" else "A.NC")
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match="does it end") as raised:
        run_program(path, load_machine(machine), RunOptions(step_limit=limit))
    assert all(problem.line > 0 for problem in raised.value.problems)


@pytest.mark.parametrize("name", ["while", "goto", "jumps", "goto of a Fanuc", "while of LinuxCNC"])
def test_what_goes_in_circles_is_ended_sooner(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(limits, "MOST_BLOCKS_IN_CIRCLES", 1_000)
    monkeypatch.setattr(interpreter, "MOST_JUMPS_WITHOUT_CHOICE", 1_000_000)
    machine, text = ENDLESS[name]
    path = tmp_path / ("A.H" if machine == "dmu65" else "A.MPF" if machine == "yl569" else "A.NC")
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match="goes nowhere new; does it end"):
        run_program(path, load_machine(machine))


def test_a_loop_that_goes_on_is_not_in_circles(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(limits, "MOST_BLOCKS_IN_CIRCLES", 1_000)
    path = tmp_path / "A.MPF"
    path.write_text("G0 X0 Y0\nFOR R1=1 TO 500\nY=.001*R1\nX1\nX0\nENDFOR\nM30\n", encoding="utf-8")
    assert len(run_program(path, load_machine("yl569"))) == 1501


def test_long_lines_without_motion_are_not_in_circles(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(limits, "MOST_BLOCKS_IN_CIRCLES", 1_000)
    path = tmp_path / "A.NC"
    path.write_text("G21 F100\n" + 500 * f"; {1000 * 'A'}\n" + "G1 X1\nM2\n", encoding="utf-8")
    assert len(run_program(path, load_machine("xyzac_trt"))) == 1


HOLES = {
    "yl569": ("G0 X0 Y0 Z50 F100\nMCALL CYCLE81(10,0,2,-5)", "X{0}", "MCALL\nM30"),
    "dmu65": (
        "BEGIN PGM A MM\nTOOL CALL 1 Z S100 F100\nCYCL DEF 200 DRILLING Q200=+2 Q201=-5 Q206=+100 Q202=+5 Q210=+0"
        " Q203=+0 Q204=+10 Q211=+0",
        "L X+{0} FMAX M99",
        "M30\nEND PGM A MM",
    ),
    "matsuura_mx330": ("G21 G0 X0. Y0. Z50.\nG81 X0. R2. Z-5. F100", "X{0}.", "G80\nM30"),
    "linuxcnc_5axis": ("G21 G0 X0 Y0 Z50\nG81 X0 R2 Z-5 F100", "X{0}", "G80\nM2"),
}


@pytest.mark.parametrize("machine", HOLES)
def test_a_program_of_many_holes_is_not_taken_for_a_loop(machine: str, tmp_path: Path) -> None:
    begin, hole, end = HOLES[machine]
    path = tmp_path / ("A.H" if machine == "dmu65" else "A.MPF" if machine == "yl569" else "A.NC")
    path.write_text("\n".join([begin, *(hole.format(k % 100) for k in range(1000)), end]), encoding="utf-8")
    run = run_program(path, load_machine(machine), RunOptions(step_limit=100))
    assert len(run) >= 3000


def test_holes_of_a_loop_are_bounded_by_its_lines(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(limits, "MOTIONS_PER_LINE", 20)
    path = tmp_path / "A.NC"
    path.write_text("%\nO1\nG21 G0 X0. Y0. Z50.\nG91 G81 X1. R-2. Z-5. F100. K500\nG80\nM30\n", encoding="utf-8")
    with pytest.raises(InputError, match="more than 200 motions in cycles"):
        run_program(path, load_machine("matsuura_mx330"), RunOptions(step_limit=100))


def test_calls_of_a_macro_in_many_lines_are_sound(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    macro = "O9\n" + 9 * "G91 G1 X.001\nX-.001\n" + "Y.01\nG90\nM99\n%\n"
    path = tmp_path / "A.NC"
    path.write_text("%\nO1\nG21 G94 F100.\n" + 300 * "M98 P9\n" + "M30\n" + macro, encoding="utf-8")
    # 300 calls of 22 blocks, 100 of which every program may execute.
    run = run_program(path, load_machine("matsuura_mx330"), RunOptions(step_limit=100))
    assert len(run) == 300 * 19
    monkeypatch.setattr(limits, "BLOCKS_PER_LINE", 10)
    with pytest.raises(InputError, match=r"executes more than 3[0-9]{3} blocks; does it end\? if it does, divide it"):
        run_program(path, load_machine("matsuura_mx330"), RunOptions(step_limit=100))
    monkeypatch.undo()
    monkeypatch.setattr(limits, "MOST_BLOCKS", 1_000)
    with pytest.raises(InputError, match="executes more than 1100 blocks"):
        run_program(path, load_machine("matsuura_mx330"), RunOptions(step_limit=100))


def test_turns_of_helices_are_bounded_by_the_lines(tmp_path: Path) -> None:
    path = tmp_path / "A.MPF"
    begin = "G17 G90 G94 G710\nG0 X10 Y0 Z0\nF1000\n"
    sound = begin + "".join(f"G2 X10 Y0 Z{-k} I-10 J0 TURN=50\n" for k in range(100)) + "M30\n"
    path.write_text(sound, encoding="utf-8")
    assert int(run_program(path, load_machine("yl569"), RunOptions(step_limit=100)).arcs.full_turns.sum()) == 5000
    path.write_text(sound.replace("TURN=50", "TURN=999"), encoding="utf-8")
    with pytest.raises(InputError, match="turns in helices") as raised:
        run_program(path, load_machine("yl569"), RunOptions(step_limit=100))
    assert raised.value.problems[0].code == "NC140"


def test_the_limit_is_a_few_seconds_of_blocks() -> None:
    # An interpreter executes 20,000 to 50,000 blocks a second.
    assert DEFAULT_OPTIONS.step_limit <= 50_000
