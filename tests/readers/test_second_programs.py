"""A second program that begins within one, and a file that is none for the control at all."""

import random
from pathlib import Path

import pytest

import trunnion
from trunnion.readers.program.limits import MAX_ERRORS

_CUT = "G0 X0. Y0. Z5.\nG1 Z0. F100.\nX9.\n"
_HEADS = {
    "yl569": "G17 G90 G71\n",
    "matsuura_mx330": "%\nG21 G17 G40 G80 G90 G94 G54\n",
    "haas_umc750": "%\nG21 G17 G40 G80 G90 G94 G54\n",
}


def _codes(machine: str, text: str, folder: Path, *files: str) -> list[str]:
    program = folder / "MAIN.MPF"
    program.write_text(text, encoding="utf-8")
    run = trunnion.read_program(program, machine=machine, subprograms=[folder / name for name in files])
    return [each.code for each in run.errors]


@pytest.mark.parametrize("begin", ["PROC NAME", "N5 PROC NAME(REAL X)", "ENDPROC"])
def test_a_proc_in_the_midst_is_an_error(begin: str, tmp_path: Path) -> None:
    assert _codes("yl569", f"{_HEADS['yl569']}{_CUT}{begin}\nX20.\nM30\n", tmp_path) == ["NC160"]


def test_a_proc_comes_first(tmp_path: Path) -> None:
    (tmp_path / "SUB.SPF").write_text("; comment\n\nPROC SUB(REAL X)\nG1 X=X\nM17\n", encoding="utf-8")
    (tmp_path / "LATE.SPF").write_text("G1 X7\nPROC LATE\nM17\n", encoding="utf-8")
    head = f"%_N_MAIN_MPF\n;$PATH=/_N_WKS_DIR\nPROC MAIN\n{_HEADS['yl569']}{_CUT}"
    assert _codes("yl569", f"{head}SUB(12)\nSUB(13)\nM30\nENDPROC\n", tmp_path, "SUB.SPF") in ([], ["NC161"])
    assert _codes("yl569", f"{head}LATE\nM30\n", tmp_path, "LATE.SPF") == ["NC160"]


def test_many_of_them_take_no_time(tmp_path: Path) -> None:
    with pytest.raises(trunnion.InputError, match="NC150"):
        _codes("yl569", ";\n" * 50_000 + "PROC A\n" * 50_000, tmp_path)


@pytest.mark.parametrize("machine", ["matsuura_mx330", "haas_umc750"])
def test_an_o_number_begins_the_next_program_also_behind_one_without_number(machine: str, tmp_path: Path) -> None:
    assert _codes(machine, f"{_HEADS[machine]}{_CUT}O5\nX20.\nM30\n%\n", tmp_path)[:1] == ["NC160"]
    assert _codes(machine, f"{_HEADS[machine]}{_CUT}M98 P5\nM30\nO5\nX20.\nM99\n%\n", tmp_path) == []


@pytest.mark.parametrize("machine", [*_HEADS, "xyzac_trt"])
@pytest.mark.parametrize("end", ["M30\nM30\n", "M2\n\nN5 M02 (END)\n", "M30\nM30"])
def test_a_second_end_alone_takes_nothing_away(machine: str, end: str, tmp_path: Path) -> None:
    comment = "; END" if machine == "yl569" else "(END)"
    program = tmp_path / "MAIN.MPF"
    program.write_text(
        f"{_HEADS.get(machine, 'G21 G90 G17 G94')}\n{_CUT}{end.replace('(END)', comment)}", encoding="utf-8"
    )
    run = trunnion.read_program(program, machine=machine)
    assert [each.code for each in run.errors] == []
    assert "NC161" in [each.code for each in run.diagnostics]
    program.write_text(f"{_HEADS.get(machine, 'G21 G90 G17 G94')}\n{_CUT}M30\nX20.\nM30\n", encoding="utf-8")
    assert "NC161" in [each.code for each in trunnion.read_program(program, machine=machine).errors]


@pytest.mark.third
@pytest.mark.parametrize("machine", ["yl569", "dmu65", "matsuura_mx330", "haas_umc750", "xyzac_trt", "hs664rt"])
def test_a_text_of_many_lines_is_not_read_to_its_end(machine: str, tmp_path: Path) -> None:
    letters = random.Random(5)
    words = ("".join(letters.choices("ABCDEFGHIKLOPQRSTUVW", k=6)) for _ in range(3 * MAX_ERRORS))
    with pytest.raises(trunnion.InputError) as refused:
        _codes(machine, "\n".join(words), tmp_path)
    last = refused.value.problems[-1]
    assert last.code == "NC150"
    assert last.line < 2 * MAX_ERRORS
    assert "as in line 1 (" in str(last)
