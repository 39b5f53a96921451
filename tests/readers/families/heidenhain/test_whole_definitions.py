"""Definitions of cycles that lost a block, and M126 that outlives its operation."""

import re

import pytest

from tests.support.reading import Runner

#: Definitions as a control writes them: numbers on every block, none on the lines of a cycle with parameters.
WHOLE = """\
0 BEGIN PGM A MM
1 TOOL CALL 5 Z S1000
2 CYCL DEF 247 DATUM SETTING ~
  Q339=+1 ;DATUM NUMBER
3 CYCL DEF 32.0 TOLERANCE
4 CYCL DEF 32.1 T0.02
; a comment between
5 CYCL DEF 32.2 HSC-MODE:1 TA0.5
6 CYCL DEF 7.0 DATUM SHIFT
7 CYCL DEF 7.1 X+1
8 CYCL DEF 7.2 Y+2
9 L X+1 Y+2 R0 FMAX
10 CYCL DEF 9.0 DWELL TIME
11 CYCL DEF 9.1 DWELL 1.5
12 L X+2 Y+3 F100
13 CYCL DEF 1.0 PECKING
14 CYCL DEF 1.1 SET UP 2
15 CYCL DEF 1.2 DEPTH -8
16 CYCL DEF 1.3 PECKG 4
17 CYCL DEF 1.4 DWELL 0
18 CYCL DEF 1.5 F100
19 L X+5 M99
20 END PGM A MM
"""
LINES = WHOLE.splitlines()
OLDER = [k for k, line in enumerate(LINES) if re.search(r"DEF \d+\.\d", line)]


def faults(run: Runner, lines: list[str]) -> list[int]:
    return [each.line for each in run("\n".join(lines)).errors]


def test_whole_definitions_are_read(run: Runner) -> None:
    """Nothing but the datum of cycle 7 is told, which stays on at the end."""
    assert [each.code for each in run(WHOLE).diagnostics] == ["NC351"]


@pytest.mark.parametrize("fault", ["lost", "doubled", "swapped", "a motion between"])
def test_a_block_of_an_older_cycle_that_is_lost_or_elsewhere_is_found(fault: str, run: Runner) -> None:
    for k in OLDER:
        line, after = LINES[k], LINES[k + 1]
        follows = k + 1 in OLDER and ".0 " not in after
        match fault:
            case "lost":
                if not follows and ".0" not in line:
                    continue  # the last line of a cycle may be missing, as values may be left out
                changed = LINES[:k] + LINES[k + 1 :]
            case "doubled":
                changed = [*LINES[: k + 1], *LINES[k:]]
            case "swapped" if after.startswith(";"):
                continue
            case "swapped":
                changed = [*LINES[:k], after, line, *LINES[k + 2 :]]
            case _:
                if not follows:
                    continue
                changed = [*LINES[: k + 1], "99 L X+9 Y+9 R0 FMAX", "99 L X+8 Y+9 R0 FMAX", *LINES[k + 1 :]]
        assert faults(run, changed), line


def test_lines_of_a_cycle_whose_first_is_lost_are_found(run: Runner) -> None:
    assert faults(run, LINES[:2] + LINES[3:]) == [3]
    # Without block numbers such a line may as well assign a parameter.
    assert run("TOOL CALL 5 Z S1000\nQ339=+1\nL X+Q339").diagnostics == ()


M126 = "1 TOOL CALL 1 Z\n2 M126\n3 L C+10 FMAX\n4 M127\n5 TOOL CALL 2 Z\n6 M126\n7 L C+20 FMAX\n8 M127\n9 {end}\n"


@pytest.mark.parametrize("end", ["M30", "END PGM A MM"])
@pytest.mark.parametrize(("lost", "line"), [(4, 4), (8, 8)])
def test_m126_that_outlives_its_operation_is_found(end: str, lost: int, line: int, run: Runner) -> None:
    text = M126.format(end=end)
    assert run(text).diagnostics == ()
    assert faults(run, [each for each in text.splitlines() if not each.startswith(f"{lost} ")]) == [line]


def test_m126_that_a_program_never_cancels_ends_with_it(run: Runner) -> None:
    found = run(M126.format(end="M30").replace("4 M127\n", "").replace("8 M127\n", ""))
    assert found.diagnostics == ()
