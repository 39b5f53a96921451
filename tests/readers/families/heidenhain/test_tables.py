"""FN 26, FN 27 and FN 28: tables that only the control has; and values that leave the program."""

import pytest

from tests.support.reading import Runner
from trunnion.errors import Severity
from trunnion.model.run import Run

READ = 'FN 28: TABREAD Q10 = 6/"X,Y,D"'


def errors(run: Run) -> list[tuple[int, str]]:
    return [(each.line, each.code) for each in run.diagnostics if each.severity is Severity.ERROR]


@pytest.mark.parametrize("name", ["Q10", "Q11", "Q12"])
def test_what_a_table_gives_is_not_known(name: str, run: Runner) -> None:
    lines = f"Q10 = 1\nQ11 = 1\nQ12 = 1\nQ13 = 1\n{READ}\n"
    found = run(f"{lines}L X+{name}")
    assert errors(found) == [(6, "NC223")]
    assert [each.code for each in found.diagnostics if each.line == 5] == ["NC222"] * 3
    assert errors(run(f"{lines}L X+Q13")) == []


@pytest.mark.parametrize(
    ("block", "code"),
    [
        ('FN 27: TABWRITE 5/"RADIUS,DEPTH" = Q5', None),
        ('FN 27: TABWRITE Q5/"RADIUS" = Q5', None),
        ('FN 27: TABWRITE 5/"RADIUS,DEPTH,D" = Q5', "NC223"),
        ('FN 27: TABWRITE Q7/"RADIUS" = Q5', "NC223"),
        ("FN 27: TABWRITE 5", "NC220"),
        ('FN 28: TABREAD Q10 = Q7/"X"', "NC223"),
        ("FN 28: TABREAD 6", "NC220"),
        ("FN 19: PLC = +10/+Q5", None),
        ("FN 19: PLC = +10/+Q7", "NC223"),
        ("FN 29: PLC LIST = +Q5/+Q7", "NC223"),
        (r"FN 26: TABOPEN TNC:\\DIR1\\TAB1.TAB", None),
        ("FN 26: TABOPEN TNC:A", None),
        (r"FN 26: TABOPEN TNC:\\table\\tool.t", "NC220"),
        (r'FN 26: TABOPEN "TNC:\\table\\preset.pr"', "NC220"),
    ],
)
def test_what_is_written_has_a_value_and_goes_to_a_table_of_programs(block: str, code: str | None, run: Runner) -> None:
    assert errors(run(f"Q5 = 1\nQ6 = 1\n{block}")) == ([] if code is None else [(3, code)])


CYCLE = "CYCL DEF 200 DRILLING ~\n%sQ200=2 ~\n%sQ201=-12 ~\nQ206=100 ~\nQ202=5 ~\nQ210=0 ~\nQ203=0 ~\nQ204=50 ~\nQ211=0"


@pytest.mark.parametrize("skip", [False, True])
@pytest.mark.parametrize(
    ("lines", "line"),
    [
        (CYCLE % ("", "/"), 3),
        (CYCLE % ("", "/  "), 3),
        ("L X+1 ~\n/Y+2", 2),
        ("CYCL DEF 9.0 DWELL TIME\n/CYCL DEF 9.1 DWELL 5", 2),
        ("/CYCL DEF 9.0 DWELL TIME\nCYCL DEF 9.1 DWELL 5", 2),
        (CYCLE % ("", ""), 0),
        ("/" + CYCLE % ("", ""), 0),
        ("/CYCL DEF 9.0 DWELL TIME\n/CYCL DEF 9.1 DWELL 5", 0),
    ],
)
def test_a_slash_takes_out_a_whole_block_or_cycle_or_is_an_error(
    lines: str, line: int, skip: bool, run: Runner
) -> None:
    found = [each.line for each in run(lines, skip=skip).diagnostics if each.wording.variant == "skip_within_block"]
    assert found == ([line] if line else [])
