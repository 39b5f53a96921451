"""Where programs go on, and that they come to an end."""

from pathlib import Path

import numpy as np
import pytest

from tests.support.reading import Runner
from trunnion.errors import InputError
from trunnion.machines import Machine
from trunnion.model.run import Run
from trunnion.readers import run_program
from trunnion.readers.program.options import RunOptions


def xs(result: Run) -> list[float]:
    """X of the rows."""
    return [float(x) for x in result.tip[:, 0]]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("R1=1\nIF R1==1\nX1\nELSE\nX2\nENDIF\nX3", [1, 3]),
        ("R1=2\nIF R1==1\nX1\nELSE\nX2\nENDIF\nX3", [2, 3]),
        ("IF FALSE\nX1\nENDIF\nX3", [3]),
        ("IF TRUE\nIF FALSE\nX1\nENDIF\nX2\nENDIF", [2]),
        ("R1=0\nIF R1>0 GOTOF ENDE\nX1\nENDE: X2", [1, 2]),
        ("GOTOF ENDE\nX1\nENDE: X2", [2]),
        ("GOTOF N30\nN20 X1\nN30 X2", [2]),
        ("X1\nGOTO ENDE\nX2\nENDE:\nX3", [1, 3]),
        ("R1=0\nAGAIN: R1=R1+1\nX=R1\nIF R1<3 GOTOB AGAIN", [1, 2, 3]),
        ("R1=0\nN10 R1=R1+1\nX=R1\nIF R1<3 GOTO N10", [1, 2, 3]),
        ("X1\nGOTOC NOWHERE\nX2", [1, 2]),
        ('DEF STRING[8] _T="ENDE"\nGOTOF _T\nX1\nENDE: X2', [2]),
        ("CASE(4+3) OF 7 GOTOF SEVEN DEFAULT GOTOF OTHER\nOTHER: X1\nM30\nSEVEN: X7", [7]),
        ("CASE(5) OF 7 GOTOF SEVEN DEFAULT GOTOF OTHER\nSEVEN: X7\nOTHER: X1", [1]),
        ("CASE 5 OF 7 GOTOF N70 5 GOTOF N50\nN70 X7\nN50 X5", [5]),
        ("DEF INT _I\nFOR _I=1 TO 3\nX=_I\nENDFOR\nX9", [1, 2, 3, 9]),
        ("FOR R1=3 TO 1\nX=R1\nENDFOR\nX9", [9]),
        ("DEF REAL _F[3]=SET(1,2)\nX=_F[0]\nX=_F[1]\nX=_F[2]", [1, 2, 0]),
        ("DEF REAL _F[3]=REP(4)\nX=_F[0]\nX9\nX=_F[2]", [4, 9, 4]),
        ("DEF INT _F[2,2]=SET(1,2,3,4)\nX=_F[0,1]\nX=_F[1,0]", [2, 3]),
        ("DEF REAL _F[2,3]\n_F[0,1]=REP(7,3)\nX=_F[0,0]\nX=_F[1,0]\nX=_F[1,1]", [0, 7, 0]),
        ("DEF REAL _F[3]\n_F[1]=SET(5,6)\nX=_F[1]\nX=_F[2]", [5, 6]),
        ("DEF REAL _F[3]=(4,5,6)\nX=_F[0]\nX=_F[2]", [4, 6]),
        ("R1=0\nWHILE R1<2\nR1=R1+1\nX=R1\nENDWHILE\nX9", [1, 2, 9]),
        ("R1=0\nREPEAT\nR1=R1+1\nX=R1\nUNTIL R1>=2\nX9", [1, 2, 9]),
        ("R1=0\nLOOP\nR1=R1+1\nX=R1\nIF R1==3 GOTOF OUT\nENDLOOP\nOUT:\nX9", [1, 2, 3, 9]),
        ("FOR R1=1 TO 2\nFOR R2=1 TO 2\nX=10*R1+R2\nENDFOR\nENDFOR", [11, 12, 21, 22]),
        ("N10 IF TRUE ; why not\nN20 X1\nN30 ENDIF", [1]),
        ("X1\nM2\nX2", [1]),
        ("X1\nM17\nX2", [1]),
        ("X1\nRET\nX2", [1]),
    ],
)
def test_flow(run: Runner, text: str, expected: list[float]) -> None:
    result = run(text)
    assert [each for each in result.diagnostics if not each.text.startswith("stands behind the end")] == []
    assert xs(result) == expected


def test_a_long_program_may_jump_back_over_many_plain_blocks(run: Runner) -> None:
    body = "".join(f"N{k} X{k} Y1\n" for k in range(1, 3001))
    result = run(f"R1=0\nAGAIN:\n{body}R1=R1+1\nIF R1<3 GOTOB AGAIN\nX0")
    assert len(result) == 9001
    assert result.line[3000] == 3
    assert xs(result)[:3] == [1, 2, 3]


def test_chunks_of_the_file_leave_no_seam(run: Runner) -> None:
    body = "".join(f"N{k} X{k / 1000:.3f} Y{k % 7} ;c{k}\n" for k in range(60_000))
    assert len(body) > 1 << 20
    result = run(body)
    assert len(result) == 60_000
    np.testing.assert_allclose(result.tip[:, 0], np.arange(60_000) / 1000, atol=1e-12)
    assert result.line.tolist() == list(range(1, 60_001))
    assert [c.text for c in result.comments] == [f"c{k}" for k in range(60_000)]


SUB = {
    "L10.SPF": "X=IC(1)\nRET",
    "sub_1.spf": "PROC SUB_1(REAL _A, INT _B=5)\nX=_A Y=_B\nM17",
    "_N_OTHER_SPF": "X7\nM17",
    "OP20.MPF": "X20\nM17",
    "MAIN2.MPF": "X2\nM30",
    "MAIN3.MPF": "X3\nM2",
    "EARLY.SPF": "X3\nM17\n;ONLY THIS\nX4",
    "CHOICE.SPF": "IF R1==1 GOTOF ON\nX5\nRET\nON: X6\nRET",
    "LOCAL.SPF": "DEF REAL _MINE\n_MINE=3\nR5=8\nX=_MINE\nRET",
}


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("X0\nL10\nX5", [0, 1, 5]),
        ("X0\nL10 P3\nX9", [0, 1, 2, 3, 9]),
        ("SUB_1(4)\nX9", [4, 9]),
        ("sub_1(2,3)", [2]),
        ("OTHER\nX9", [7, 9]),
        ('EXTCALL("OP20")\nX9', [20, 9]),
        ('EXTCALL("OP20.MPF")', [20]),
        ('EXTCALL("MAIN2")\nEXTCALL("MAIN3")\nX9\nM30', [2, 3, 9]),
        ('EXTCALL "OP20"', [20]),
        ('CALL "OTHER"', [7]),
        ('EXTCALL("/_N_WKS_DIR/_N_PART_WPD/_N_OTHER_SPF")', [7]),
        ("LOCAL\nX=R5", [3, 8]),
    ],
)
def test_subprograms_that_are_named(run: Runner, text: str, expected: list[float]) -> None:
    result = run(text, files=SUB)
    assert result.diagnostics == ()
    assert xs(result) == expected


def test_blocks_behind_a_return_that_no_jump_reaches_are_told(run: Runner) -> None:
    result = run("EARLY\nEARLY\n/EARLY P2\nX9", files=SUB)
    assert xs(result) == [3, 3, 3, 3, 9]
    assert [(error.code, error.line, Path(error.file).name) for error in result.errors] == [("NC161", 4, "EARLY.SPF")]
    assert xs(run("R1=0\nCHOICE\nR1=1\nCHOICE", files=SUB)) == [5, 6]
    assert run("R1=0\nCHOICE\nR1=1\nCHOICE", files=SUB).errors == ()


def test_gotos_goes_to_the_start_of_its_program(run: Runner) -> None:
    files = {"AGAIN.SPF": "R1=R1+1\nX=R1\nIF R1<3 GOTOS\nRET\n"}
    assert xs(run("R1=0\nAGAIN\nX9", files=files)) == [1, 2, 3, 9]


def test_variables_of_a_subprogram_are_its_own(run: Runner) -> None:
    assert "_MINE has no value" in run("LOCAL\nX=_MINE", files=SUB).errors[0].text


@pytest.mark.parametrize(
    "name",
    [
        "../SECRET",
        "..\\\\SECRET",
        "/etc/passwd",
        "SECRET",
        "BESIDE",
        "BESIDE.SPF",
        "a/../../SECRET",
        "",
        "..",
        "N" * 300,
    ],
)
def test_nothing_is_ever_read_that_was_not_named(tmp_path: Path, yl569: Machine, name: str) -> None:
    inner = tmp_path / "inner"
    inner.mkdir()
    (tmp_path / "SECRET.SPF").write_text("X99\nM17")
    for beside in ("BESIDE.SPF", "NAMED.SPF"):
        (inner / beside).write_text("X98\nM17")
    (inner / "MAIN.MPF").write_text(f'EXTCALL("{name}")\nX1')
    result = run_program(inner / "MAIN.MPF", yl569, RunOptions(subprograms=[inner / "NAMED.SPF"]))
    assert xs(result) == [1]
    assert "missing subprogram" in result.errors[0].text


@pytest.mark.parametrize(
    "text",
    [
        "LOOP\nENDLOOP",
        "LOOP\nX1\nX2\nENDLOOP",
        "A_1: GOTOB A_1",
        "GOTOS",
        "WHILE TRUE\nENDWHILE",
        "REPEAT\nUNTIL FALSE",
        "LOOP\nL10\nENDLOOP",
        "L10 P999999",
        "FOR R1=1 TO 1000000000\nR1=1\nENDFOR",
    ],
)
def test_programs_without_end_are_stopped(run: Runner, text: str) -> None:
    with pytest.raises(InputError, match=r"executes more than 5[0-9]{3} blocks|no condition ends it"):
        run(text, files=SUB, step_limit=5000)


def test_motions_of_cycles_are_bounded(run: Runner) -> None:
    text = "MCALL CYCLE83(50,0,2,-20,,-.03,,0)\n" + "X1\nX2\n" * 500
    with pytest.raises(InputError, match="more than 7000 motions in cycles"):
        run(text, step_limit=5000)


@pytest.mark.parametrize(
    ("text", "what"),
    [
        ("ENDIF", "ENDIF without its IF"),
        ("LOOP\nENDWHILE", "ENDWHILE without its WHILE"),
        ("IF 1\nX1", "never ends"),
        ("IF 1\nELSE\nELSE\nENDIF", "ELSE without its IF"),
        ("LOOP\n" * 100 + "ENDLOOP\n" * 100, "deeper than 64"),
        ("SELF", "deeper than 16"),
        ("X1 " * 40000, "longer than"),
    ],
)
def test_programs_that_are_built_wrongly_are_refused(run: Runner, text: str, what: str) -> None:
    with pytest.raises(InputError, match=what):
        run(text, files={"SELF.SPF": "SELF"})


def test_deep_parentheses_are_named(run: Runner) -> None:
    assert "nests deeper" in run("X=" + "(" * 500 + "1" + ")" * 500).errors[0].text
    assert "nests deeper" in run("X=" + "-" * 500 + "1").errors[0].text


def test_a_missing_jump_target_ends_the_program(run: Runner) -> None:
    result = run("X1\nGOTOF NOWHERE\nX2")
    assert xs(result) == [1]
    assert "NOWHERE" in result.errors[0].text


def test_a_file_that_cannot_be_read_is_an_input_error(tmp_path: Path, yl569: Machine) -> None:
    for path in (tmp_path / "missing.mpf", tmp_path):
        with pytest.raises(InputError):
            run_program(path, yl569)


def test_findings_are_counted_when_they_are_too_many(run: Runner) -> None:
    result = run("G4 F99\n" * 10_050)
    assert len(result.diagnostics) == 10_001
    assert "50 findings more" in result.diagnostics[-1].text


def test_a_block_with_several_subprograms_executes_the_first(run: Runner) -> None:
    result = run("X1\nL10 OTHER M8\nX5\nQ1", files=SUB)
    assert xs(result) == [1, 2, 5]
    assert [(f.line, f.text.split(":")[0]) for f in result.diagnostics] == [
        (2, "several subprograms in one block"),
        (4, "unknown word Q=1"),
    ]
    assert all(f.file.endswith("MAIN.MPF") for f in result.diagnostics)


def test_what_a_block_says_beside_a_call_comes_before_the_subprogram(run: Runner) -> None:
    result = run("S100 M3\nX1\nL10 M5", files=SUB)
    assert result.spindle.tolist() == [1, 0]
    assert xs(run("MCALL OTHER\nX1 M9\nMCALL\nX2", files=SUB)) == [1, 7, 2]


def test_findings_after_a_subprogram_are_those_of_its_caller(run: Runner) -> None:
    result = run("\n\n\nL10\nQ1", files={"L10.SPF": "Q2\nM17"})
    assert [(f.line, f.file[-8:]) for f in result.diagnostics] == [(1, "/L10.SPF"), (5, "MAIN.MPF")]


@pytest.mark.parametrize(
    ("names", "what"),
    [
        (["LOOPY.SPF"], "LOOPY.SPF: error: cannot be read"),
        (["NOWHERE.SPF"], "NOWHERE.SPF: error: file not found"),
        (["folder"], "folder: error: is a folder, not an NC program"),
        (["notes.txt"], r"notes.txt: error: is not a name of a subprogram; let it end in one of .SPF"),
        (["ONE.SPF", "a/one.spf"], "a/one.spf: error: is called as .*/ONE.SPF is; name one of them"),
    ],
)
def test_files_that_cannot_be_named(tmp_path: Path, yl569: Machine, names: list[str], what: str) -> None:
    (tmp_path / "LOOPY.SPF").symlink_to(tmp_path / "LOOPY.SPF")
    for folder in ("folder", "a"):
        (tmp_path / folder).mkdir()
    for file in ("MAIN.MPF", "notes.txt", "ONE.SPF", "a/one.spf"):
        (tmp_path / file).write_text("X1")
    with pytest.raises(InputError, match=what):
        run_program(tmp_path / "MAIN.MPF", yl569, RunOptions(subprograms=[tmp_path / name for name in names]))


def test_a_subprogram_goes_before_a_main_program_of_its_name(run: Runner) -> None:
    assert xs(run("PART", files={"PART.MPF": "X1", "PART.SPF": "X2"})) == [2]


def test_a_long_subprogram_leaves_no_seam_and_may_be_called_again(run: Runner) -> None:
    body = "".join(f"X{k / 1000:.3f} Y{k % 7}\n" for k in range(30_000))
    result = run("X-1\nLONG\nX-2\nLONG P2\nX-3", files={"LONG.SPF": body + "M17"})
    assert result.diagnostics == ()
    once = list(range(30_000))
    assert [round(1000 * x) for x in xs(result)] == [-1000, *once, -2000, *once, *once, -3000]
    assert set(result.file[1:30_001].tolist()) == {1}
    assert result.line[30_000] == 30_000


def test_a_loop_over_all_r_parameters_is_none(run: Runner) -> None:
    result = run("FOR R=0 TO 3\nX1\nENDFOR\nX2")
    assert xs(result) == [2]
    assert "R needs a number" in result.errors[0].text


def test_long_blocks_count_for_more(run: Runner) -> None:
    long = "X1 ;" + "-" * 12_800
    assert len(run("R1=1\n" + f"{long}\n" * 50, step_limit=0)) == 50
    with pytest.raises(InputError, match="executes more than 1150 blocks"):
        # 1000, and 50 for each line.
        run(f"FOR R1=1 TO 20\n{long}\nENDFOR", step_limit=1000)


def test_comments_and_events_of_loops_are_bounded(run: Runner) -> None:
    with pytest.raises(InputError, match="makes more than 1414 comments and events") as caught:
        # 1000, and one for each byte of the file.
        run("LOOP\n" + "M1" * 200 + "\nENDLOOP", step_limit=1000)
    assert caught.value.problems[0].line == 2


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("_T=5\nX=_T", 1),
        ("DEF REAL _T\nX1\nDEF REAL _T=2", 3),
        ("DEF REAL _A, _A", 1),
        ("DEF REAL _F[3]\n_F[2]=SET(5,6)", 2),
        ("DEF REAL _F[3]\n_F[2]=REP(5,2)", 2),
        ("DEF REAL _F=SET(5)", 1),
        ("DEF REAL _F[30000,30000]=REP(1)", 1),
        ("DEF REAL _F[3]\n_F[1,1]=SET(5)", 2),
        # Smoothing within nothing, as when the line with the tolerance is lost.
        ("DEF REAL _T\nCYCLE832(_T,_ORI_ROUGH,1)\nX1", 2),
        ("CYCLE832(,3)\nX1", 1),
        ("CYCLE832(-.1,1,1)\nX1", 1),
    ],
)
def test_variables_without_def_with_two_and_without_their_value_are_named(run: Runner, text: str, line: int) -> None:
    assert [each.line for each in run(text).errors] == [line]


@pytest.mark.parametrize(
    ("text", "line", "what"),
    [
        ("DEF REAL _F[3]\nX=_F[3]", 2, "_F[3] does not exist: _F has elements 0 to 2"),
        ("DEF REAL _F[3]\n_F[5]=7", 2, "_F[5] does not exist: _F has elements 0 to 2"),
        ("DEF REAL _F[3]\nX=_F[-1]", 2, "_F[-1] does not exist: _F has elements 0 to 2"),
        ("DEF REAL _F[2,2]\nX=_F[0,2]", 2, "_F[0,2] does not exist: _F has elements 0 to 1, 0 to 1"),
        ("DEF REAL _F[2,2]\n_F[0,2]=SET(1)", 2, "_F[0,2] does not exist: _F has elements 0 to 1, 0 to 1"),
        ("DEF REAL _F[2,2]\nX=_F[1]", 2, "_F[1] does not exist: _F has elements 0 to 1, 0 to 1"),
        ("DEF REAL _F[3]\nX=_F", 2, "_F does not exist: _F has elements 0 to 2"),
        ("DEF REAL _F[3]\nFOR R1=0 TO 3\n_F[R1]=R1\nENDFOR", 3, "_F[3] does not exist: _F has elements 0 to 2"),
        ("DEF REAL _N=5\nX=_N[0]", 2, "_N[0]: _N is no field"),
    ],
)
def test_elements_that_a_field_does_not_have_are_named(run: Runner, text: str, line: int, what: str) -> None:
    assert [(each.line, each.text.endswith(f": {what}")) for each in run(text).errors] == [(line, True)]


def test_a_def_that_a_jump_leads_to_again_and_smoothing_that_is_off_are_no_mistakes(run: Runner) -> None:
    text = "R1=0\nBACK: DEF INT _N\n_N=_N+1 R1=R1+1\nX=_N\nIF R1<3 GOTOB BACK\n"
    found = run(text + "CYCLE832()\nCYCLE832(0,_OFF,1)\nCYCLE832(0,0,1)\nCYCLE832(0)\nX5")
    assert found.errors == ()


FIELD = "DEF REAL LIST[3]=SET(1,2,3)\n"
SQUARE = "DEF REAL LIST[2,2]=SET(1,2,3,4)\n"

#: A program, its subprogram, and the values of X.
PARAMETERS = [
    (f"{FIELD}TAKE(LIST)\nX=LIST[1]", "PROC TAKE(VAR REAL _A[3])\nX=_A[2]\n_A[1]=9", [3, 9]),
    (f"{FIELD}TAKE(LIST)\nX=LIST[1]", "PROC TAKE(VAR REAL _A[])\nX=_A[2]\n_A[1]=9", [3, 9]),
    (f"{FIELD}TAKE(LIST)\nX=LIST[1]", "PROC TAKE(REAL _A[3])\nX=_A[2]\n_A[1]=9", [3, 2]),
    (f"{SQUARE}TAKE(LIST,7)\nX=LIST[1,1]", "PROC TAKE(VAR REAL _A[,],REAL _B)\nX=_A[1,0]+_B\n_A[1,1]=9", [10, 9]),
    ("DEF REAL _V=3\nTAKE(_V)\nX=_V", "PROC TAKE(VAR REAL _A)\nX=_A\n_A=_A+5", [3, 8]),
    ("DEF REAL _V=3\nTAKE(_V)\nX=_V", "PROC TAKE(REAL _A)\nX=_A\n_A=_A+5", [3, 3]),
    ("TAKE()", "PROC TAKE(VAR REAL _A,REAL _B=4)\nX=_A+_B", [4]),
]


def test_fields_and_variables_are_parameters_by_their_names(run: Runner) -> None:
    for text, subprogram, expected in PARAMETERS:
        found = run(text, files={"TAKE.SPF": f"{subprogram}\nM17"})
        assert (found.diagnostics, xs(found)) == ((), expected), subprogram


def test_arguments_that_a_subprogram_does_not_take_are_errors(run: Runner) -> None:
    cases = [
        (f"{FIELD}TAKE(LIST)", "VAR REAL _A[4]", "_A is a field of another size than LIST"),
        (f"{FIELD}TAKE(LIST)", "REAL _A[,]", "_A is a field of another size than LIST"),
        ("TAKE(5)", "REAL _A[3]", "_A is a field of another size than 5"),
        (f"{FIELD}TAKE(LIST)", "REAL _A", "_A takes a value, and not the field LIST"),
        (f"{FIELD}TAKE(LIST[1])", "VAR REAL _A", "VAR _A gives its value back to LIST [ 1 ]"),
        ("R5=3\nTAKE(R5)", "VAR REAL _A", "VAR _A gives its value back to R 5"),
        ("TAKE(1,2)", "REAL _A", "a call with 2 values of a subprogram that takes 1"),
    ]
    for text, parameters, told in cases:
        found = run(text, files={"TAKE.SPF": f"PROC TAKE({parameters})\nM17"})
        assert [told in error.text for error in found.errors] == [True], (parameters, found.errors)
