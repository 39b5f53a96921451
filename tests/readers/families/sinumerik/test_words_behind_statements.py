"""Words that stand behind a statement in its block, and that the control would not execute, are errors."""

from pathlib import Path

import pytest

import trunnion
from tests.support.program_heads import HEADS

_FORMS = {
    "dwell": "G4 F0.5{}",
    "modal call": "MCALL CYCLE82(10,0,2,-5,,0){}\nMCALL",
    "end of a modal call": "MCALL CYCLE82(10,0,2,-5,,0)\nMCALL CYCLE82(10,0,2,-5,,0){}\nMCALL",
    "jump": "GOTOF ON{}\nON:",
    "jump taken": "IF 1==1 GOTOF ON{}\nON:",
    "jump not taken": "IF 1==2 GOTOF ON{}\nON:",
    "case": "CASE 1 OF 1 GOTOF ON 2 GOTOF ON{}\nON:",
    "case without": "CASE 3 OF 1 GOTOF ON DEFAULT GOTOF ON{}\nON:",
    "if": "IF 1==1\nENDIF{}",
    "else": "IF 1==1\nELSE{}\nENDIF",
    "for": "FOR R1=1 TO 2{}\nENDFOR",
    "end of for": "FOR R1=1 TO 2\nENDFOR{}",
    "while": "WHILE 1==2{}\nENDWHILE",
    "until": "REPEAT\nUNTIL 1==1{}",
    "declaration": "EXTERN CONT1(REAL){}",
    "call": 'CALL "CONT1"{}',
    "external call": 'EXTCALL "CONT1"{}',
    "return of a subprogram": "CONT2",
    "return to a label": "CONT3",
}
_WORDS = (" M5", " M30", " D2", " X5", " CYCLE800()")


def _errors(folder: Path, line: str, returns: str) -> list[str]:
    """Return what is said of a line within a program; ``returns`` ends its subprograms."""
    files = {
        "CONT1": "PROC CONT1\nM17",
        "CONT2": "PROC CONT2\nRET" + returns,
        "CONT3": f'PROC CONT3\nRET("ON"{returns})',
    }
    for name, text in files.items():
        (folder / f"{name}.SPF").write_text(text + "\n", encoding="utf-8")
    program = folder / "part.mpf"
    program.write_text(HEADS["yl569"].format(lines=line), encoding="utf-8")
    run = trunnion.read_program(program, machine="yl569", subprograms=[folder / f"{name}.SPF" for name in files])
    return [each.text for each in run.errors]


@pytest.mark.parametrize("form", _FORMS)
def test_each_form_is_read_alone(form: str, tmp_path: Path) -> None:
    if form != "return to a label":
        assert _errors(tmp_path, _FORMS[form].format(""), "") == []


@pytest.mark.parametrize("word", _WORDS)
@pytest.mark.parametrize("form", _FORMS)
def test_a_word_behind_each_form_is_an_error(form: str, word: str, tmp_path: Path) -> None:
    assert _errors(tmp_path, _FORMS[form].format(word), word)


@pytest.mark.parametrize(
    "line", ["G1 X20 CR=5", "G1 X20 TURN=1", "G1 X20 I1=5", "G3 X20 Y0 I5 J0 I1=5", "CIP X20 Y0 I1=15 J1=5 CR=9"]
)
def test_words_of_another_motion_are_errors(line: str, tmp_path: Path) -> None:
    assert any("has no use in this block" in each for each in _errors(tmp_path, line, ""))


def test_a_frame_beside_a_cycle_is_an_error(tmp_path: Path) -> None:
    """Which of both the control executes first changes the place."""
    assert any("TRANS has its block alone" in each for each in _errors(tmp_path, "CYCLE800() TRANS Z5\nTRANS", ""))


def test_a_main_block_has_its_number_behind_a_colon(tmp_path: Path) -> None:
    assert _errors(tmp_path, ":480 G1 X20 F100\nGOTOF ON\nON:", "") == []
