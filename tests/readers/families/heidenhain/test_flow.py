"""Labels, programs, and parameters."""

import math
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.reading import Runner
from trunnion.errors import InputError, Severity
from trunnion.machines import load_machine
from trunnion.model.run import Run
from trunnion.readers import run_program
from trunnion.readers.families.heidenhain.parameters import KlartextError, Parameters, formula
from trunnion.readers.program.options import RunOptions


def xs(run: Run) -> list[float]:
    """X of every row."""
    return [float(value) for value in run.tip[:, 0]]


def test_subprograms_and_repeats(run: Runner) -> None:
    text = (
        'L X+1\nCALL LBL 7\nL X+3\nCALL LBL "UP" \nLBL 1\nL IX+10\nCALL LBL 1 REP 2/2\nL X+99\nM30\n'
        'LBL 7\nL X+2\nLBL 0\nLBL "up"\nCALL LBL 7\nL X+5\nLBL 0\nL X+66'
    )
    found = run(text)
    assert found.diagnostics == ()
    assert xs(found) == [1, 2, 3, 2, 5, 15, 25, 35, 99]


@pytest.mark.parametrize(
    ("rest", "line"),
    [
        ("LBL 7\nL X+2\nLBL 0", 0),
        ("LBL 7\nL X+2\nLBL 0\n; of another job\nLBL 8\nL X+3\nLBL 0", 0),
        ("LBL 7\nL X+2\nLBL 0\nL X+5\nLBL 8\nL X+3\nLBL 0\nL X+6", 7),
        ("L X+4\nLBL 7\nL X+2\nLBL 0\nL X+5", 4),
    ],
)
def test_blocks_between_subprograms_behind_the_end_never_run(rest: str, line: int, run: Runner) -> None:
    found = run(f"BEGIN PGM T MM\nCALL LBL 7\nM30\n{rest}\nEND PGM T MM")
    told = [(each.code, each.line, each.severity) for each in found.diagnostics]
    assert told == ([("NC161", line, Severity.WARNING)] if line else [])


def test_repeats_inside_repeats_begin_anew(run: Runner) -> None:
    found = run("LBL 1\nLBL 2\nL IX+1\nCALL LBL 2 REP2\nCALL LBL 1 REP 1\nM2")
    assert xs(found) == [1, 2, 3, 4, 5, 6]


def test_a_label_may_be_a_parameter(run: Runner) -> None:
    assert xs(run("Q1 = 5\nCALL LBL Q1\nM30\nLBL 5\nL X+5\nLBL 0")) == [5]


@pytest.mark.parametrize("text", ["CALL LBL 8", 'CALL LBL "NO"', "FN 9: IF +1 EQU +1 GOTO LBL 8"])
def test_a_missing_label_ends_the_program(text: str, run: Runner) -> None:
    found = run(f"BEGIN PGM MAIN MM\nL X+1\n{text}\nL X+2\nEND PGM MAIN MM")
    assert xs(found) == [1]
    assert [f.line for f in found.errors] == [3]


@pytest.mark.parametrize(
    ("condition", "holds"),
    [
        ("FN 9: IF +Q1 EQU +7 GOTO LBL 1", True), ("FN9: IF +Q1 EQU -7 GOTO LBL1", False),
        ("FN 10: IF Q1 NE 7 GOTO LBL 1", False), ("FN 11: IF +Q1 GT +6,5 GOTO LBL 1", True),
        ("FN 12: IF -Q1 LT +0 GOTO LBL \"A\"", True),
    ],
)  # fmt: skip
def test_jumps(condition: str, holds: bool, run: Runner) -> None:
    found = run(f'Q1 = 7\n{condition}\nL X+1\nLBL 1\nLBL "A"\nL X+2')
    assert found.diagnostics == ()
    assert xs(found) == ([2] if holds else [1, 2])


def test_a_condition_of_something_unknown_does_not_hold_and_is_named(run: Runner) -> None:
    found = run("FN 18: SYSREAD Q1 = ID270 NR1 IDX1\nFN 9: IF +Q1 EQU +0 GOTO LBL 1\nL X+1\nLBL 1\nL X+Q1")
    assert xs(found) == [1]
    assert [(f.line, str(f.severity)) for f in found.diagnostics] == [(1, "warning"), (2, "error"), (5, "error")]


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("FN 0: Q5 = +60", 60.0), ("FN0: Q5 = -Q1", -3.0), ("FN 1: Q5 = -Q1 + -5", -8.0), ("FN 2: Q5 = +10 - +Q1", 7.0),
        ("FN 3: Q5 = +Q1 * +Q1", 9.0), ("FN 4: Q5 = +Q1 DIV +2", 1.5), ("FN 5: Q5 = SQRT 16", 4.0),
        ("FN 6: Q5 = SIN +30", 0.5), ("FN 7: Q5 = COS -60", 0.5), ("FN 8: Q5 = +3 LEN +4", 5.0),
        ("FN 13: Q5 = +1 ANG -1", 135.0), ("Q5 = Q1", 3.0), ("Q5 = (Q1 + 1,5) * 2", 9.0), ("Q5 = 2 + 3 * 4 ^ 2", 50.0),
        ("Q5 = SQ 3 + SQRT 16", 13.0), ("Q5 = SIN 30 * 2", 1.0), ("Q5 = SQRT(16)", 4.0), ("Q5 = - Q1 + 5", 2.0),
        ("Q5 = NEG 3 - ABS -4", -7.0), ("Q5 = INT 3.7 + FRAC 3.5", 3.5), ("Q5 = SGN -8", -1.0), ("Q5 = LN EXP 2", 2.0),
        ("Q5 = 7 % 4", 3.0), ("Q5 = COS PI * 0 + ATAN 1", 45.0), ("QL5 = 3\nQ5 = QL5", 3.0), ("QR5 = 4\nQ5 = QR5", 4.0),
        ("Q5 = LOG 1000", 3.0), ("Q5 = ACOS 0 + ASIN 1", 180.0),
    ],
)  # fmt: skip
def test_parameters(text: str, value: float, run: Runner) -> None:
    found = run(f"Q1 = 3\n{text}\nL X+Q5")
    assert found.diagnostics == ()
    assert xs(found) == [pytest.approx(value, abs=1e-12)]


@pytest.mark.parametrize(
    "text",
    [
        "Q5 = 1 / 0", "Q5 = SQRT -1", "Q5 = LN 0", "Q5 = ASIN 2", "Q5 = TAN 90", "Q5 = 0 ^ -1", "Q5 = -2 ^ .5",
        "Q5 = 1 +", "Q5 = (1", "Q5 = 1 2", "Q5 = X", "Q5 = Q99", "FN 4: Q5 = 1 DIV 0", "FN 1: Q5 = 1",
        "FN 5: Q5 = SQRT -4",
        "FN 99: Q5 = 1", "Q5 =", "Q5 = 10 ^ 11",
    ],
)  # fmt: skip
def test_what_a_formula_cannot_give_leaves_no_value(text: str, run: Runner) -> None:
    found = run(f"Q5 = 1\n{text}\nL X+Q5")
    assert [f.line for f in found.errors] == [2, 3]
    assert len(found) == 0


leaves = st.integers(1, 9).map(str)
formulas = st.recursive(
    leaves,
    lambda inner: st.one_of(
        st.tuples(inner, st.sampled_from("+-*/"), inner).map(lambda t: f"({t[0]} {t[1]} {t[2]})"),
        st.tuples(inner, st.sampled_from("+-*/"), leaves).map(lambda t: f"{t[0]} {t[1]} {t[2]}"),
        inner.map(lambda text: f"- ({text})"),
    ),
    max_leaves=8,
)


@settings(max_examples=examples(80))
@given(text=formulas)
def test_formulas_are_those_of_arithmetic(text: str) -> None:
    try:
        wanted = float(eval(text))  # a text of the strategy above: figures, parentheses and four operators
    except ZeroDivisionError:
        with pytest.raises(KlartextError):
            formula(text, Parameters())
        return
    if abs(wanted) < 1e9:
        assert formula(text, Parameters()) == pytest.approx(wanted, rel=1e-12, abs=1e-12)


def test_a_program_calls_another_that_is_named(run: Runner) -> None:
    files = {"SUB.H": "0 BEGIN PGM SUB MM\n1 L X+Q1\n2 Q2 = 8\n3 QL1 = 9\n4 END PGM SUB MM\nL X+77\n"}
    found = run("Q1 = 4\nCALL PGM TNC:\\PARTS\\sub.h\nL X+Q2\nCALL PGM SUB\nL X+QL1", files=files)
    assert xs(found) == [4, 8, 4]
    assert [(f.code, f.line) for f in found.errors] == [("NC161", 6), ("NC223", 5)]
    assert [Path(name).name for name in found.files] == ["MAIN.H", "SUB.H"]
    assert found.file.tolist() == [1, 0, 1]
    assert found.line.tolist() == [2, 3, 2]


def test_m30_in_a_called_program_ends_all(run: Runner) -> None:
    assert xs(run("CALL PGM SUB\nL X+2", files={"SUB.H": "L X+1\nM30\n"})) == [1]


def test_programs_that_are_not_named_are_not_found(tmp_path: Path) -> None:
    (tmp_path / "SECRET.H").write_text("L X+666\n")
    inner = tmp_path / "part"
    inner.mkdir()
    for beside in ("BESIDE.H", "NAMED.H"):
        (inner / beside).write_text("L X+666\n")
    names = ["../SECRET.H", "..\\SECRET", "BESIDE", str(tmp_path / "SECRET.H"), "TNC:\\..\\SECRET.H"]
    (inner / "MAIN.H").write_text("\n".join(f"CALL PGM {name}" for name in names))
    found = run_program(inner / "MAIN.H", load_machine("dmu65"), RunOptions(subprograms=[inner / "NAMED.H"]))
    assert len(found) == 0
    assert [f.line for f in found.errors if "BEGIN PGM" not in f.text] == [1, 2, 3, 4, 5]


def test_labels_may_not_call_themselves_for_ever(run: Runner) -> None:
    with pytest.raises(InputError, match="deeper than 20 levels; does one call itself"):
        run("LBL 1\nCALL LBL 1\nLBL 0")


def test_values_of_parameters_are_those_of_the_moment(run: Runner) -> None:
    found = run("Q1 = 1\nLBL 1\nL X+Q1\nQ1 = Q1 * 2\nFN 12: IF +Q1 LT +100 GOTO LBL 1")
    assert xs(found) == [2.0**k for k in range(math.ceil(math.log2(100)))]
