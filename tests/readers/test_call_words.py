"""Which programs a text calls, and whether it looks like a subprogram: by words of calls and ends alone."""

from pathlib import Path

import pytest

import trunnion
from trunnion.jobs.inputs.reading import as_machine
from trunnion.readers import reader_of
from trunnion.readers.program.call_words import CallWords

FANUC, SINUMERIK, LINUXCNC, KLARTEXT = "haas_umc750", "yl569", "xyzac_trt", "ucp800"

#: A machine, a program, the word by which it looks like a subprogram, and the names of what it calls.
TEXTS = [
    (FANUC, "O77\nG91 X1.\nM99\n", ("M99", 3), set()),
    (FANUC, "O77\nG91 X1.\nM99\nM30\n", None, set()),
    (FANUC, "O77\nX1. (M30)\nM99\n", ("M99", 3), set()),
    (FANUC, "M98 P77\nM98 P30012 L2\nG65 P9810 X1.\n(M98 P5)\nM30\n", None, {"77", "30012", "12", "9810"}),
    (SINUMERIK, "PROC POCKET(REAL _A)\nX=_A\nM17\n", ("PROC", 1), {"PROC", "POCKET", "REAL", "_A"}),
    (SINUMERIK, "X1\nM2=3\nRET\n", ("RET", 3), {"RET"}),
    (SINUMERIK, "L12 P3\nPOCKET(5) ;OTHER\nM30\n", None, {"L12", "POCKET"}),
    (LINUXCNC, "o<pocket> sub\nG1 X1\no<pocket> endsub\nM2\n", ("O<POCKET> ENDSUB", 3), set()),
    (LINUXCNC, "o7 sub\nG1 X1\no7 endsub\nG21\no7 call [1]\nM2\n", None, {"7"}),
    (LINUXCNC, "o<pocket> call\nM2\n", None, {"POCKET"}),
    (KLARTEXT, "BEGIN PGM A MM\nL IX+1\nEND PGM A MM\n", ("END PGM", 3), set()),
    (KLARTEXT, "BEGIN PGM A MM\nCALL PGM TNC:\\NC\\SUB.H ;X\nM30\nEND PGM A MM\n", None, {"SUB.H"}),
]  # fmt: skip


def words_of(machine: str) -> CallWords:
    found = reader_of(as_machine(machine)).call_words
    assert found is not None
    return found


@pytest.mark.parametrize(("machine", "text", "mark", "called"), TEXTS)
def test_a_text_calls_and_returns(machine: str, text: str, mark: tuple[str, int] | None, called: set[str]) -> None:
    words = words_of(machine)
    assert words.subprogram_mark(text.encode()) == mark
    assert words.called(text.encode()) == called


def test_long_lines_of_a_hostile_file_end() -> None:
    for machine in (FANUC, SINUMERIK, LINUXCNC, KLARTEXT):
        words = words_of(machine)
        for piece in (b"(", b"M98 ", b"o<", b"o1 sub\n", b"M \t", b"CALL PGM ", b'"', b"A_"):
            text = piece * (200_000 // len(piece))
            words.called(text)
            assert words.subprogram_mark(text) is None


def test_a_subprogram_in_place_of_a_program_is_named_in_one_line(tmp_path: Path) -> None:
    for machine, text, mark, _ in TEXTS:
        file = tmp_path / "part.nc"
        file.write_text(text, encoding="utf-8")
        told = [each for each in trunnion.read_program(file, machine=machine).diagnostics if each.code == "NC114"]
        assert len(told) == bool(mark), text
        assert mark is None or f"this looks like a subprogram, by {mark[0]} in line {mark[1]}" in told[0].text
