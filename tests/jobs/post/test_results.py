"""What results look like in a notebook, and what errors say of a program that is not written."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import trunnion
from tests.support.locations import YL569
from trunnion.jobs.post import writing

CL = YL569 / "2_hub_rough.cls"
PROGRAM = YL569 / "2_hub_rough.expected.mpf"


def test_results_are_one_line_in_a_notebook() -> None:
    result = trunnion.post(CL, machine="yl569")
    planned, run = trunnion.plan(CL, machine="yl569"), trunnion.read_program(PROGRAM, machine="yl569")
    converted = trunnion.convert(PROGRAM, machine="yl569", to_cl=True)
    standing = "19 of 21 checks; 2 not checked; stands on 5 values nobody measured; "
    standing += "assumed: the control starts with CYCLE800(); assumed: no work offset is in force at N370"
    assert repr(result.verification) == f"Verification(passed=True, {standing}, 30 motions)"
    assert repr(run) == f"Run({str(PROGRAM)!r}, yl569, 30 motions, 0 diagnostics)"
    assert repr(planned) == "Plan(1 motions, 0 errors, 0 warnings)"
    assert repr(result.toolpaths[0]) == f"Toolpath({str(CL)!r}, 1 operations, 23 points)"
    comparison = trunnion.diff(PROGRAM, PROGRAM, machine="yl569")
    for shown in (result, planned, run, converted, result.toolpaths[0], result.verification, comparison):
        assert len(repr(shown).splitlines()) == 1
        assert len(repr(shown)) < 400


def test_a_check_prints_as_the_line_of_the_command_and_the_lines_stand_under_each_other() -> None:
    checks = trunnion.verify(PROGRAM, machine="yl569", cl=CL).checks
    assert str(checks[0]) == f"{checks[0].key}         ok    {checks[0].summary}"
    assert {str(check)[:14].rstrip() for check in checks} == {check.key for check in checks}
    assert {str(check)[14:].split("  ")[0] for check in checks} == {"ok", "not checked"}
    assert "passed=True" in repr(checks[0])


def test_a_failed_verification_names_its_checks(tmp_path: Path) -> None:
    wrong = tmp_path / "p.mpf"
    wrong.write_bytes(PROGRAM.read_bytes().replace(b"G54", b"G55"))
    found = trunnion.verify(wrong, machine="yl569", cl=CL)
    assert repr(found) == "Verification(passed=False, failed: offset, 30 motions)"


#: The head of an operation, to which one adds words.
HEAD = """TOOL PATH/A,TOOL,M8
TLDATA/DRILL,8.0,0.0,100.0,118.0,50.0
MSYS/0,0,0,1,0,0,0,1,0
LOAD/TOOL,1
SPINDL/RPM,500,CLW
PAINT/PATH
RAPID
GOTO/0,0,50,0,0,1
"""

#: A coolant and a cycle that the control lacks, and what it makes of a CL file that has both.
LACKS = "COOLNT/THRU\nCYCLE/BORE,NODRAG,90,RAPTO,3.0,FEDTO,-20.0,MMPM,100\nGOTO/10,0,0\nCYCLE/OFF\n"


class Listener(trunnion.Observer):
    """Keeps what it hears."""

    def __init__(self) -> None:
        self.heard: list[trunnion.Problem] = []

    def problems(self, problems: Sequence[trunnion.Problem]) -> None:
        self.heard += problems


def test_what_a_control_cannot_make_is_told_line_by_line_and_warnings_apart(tmp_path: Path) -> None:
    file = tmp_path / "a.cls"
    file.write_text(HEAD + LACKS + LACKS + "GOTO/0,0,50\nEND-OF-PATH\n", encoding="ascii")
    listener = Listener()
    with pytest.raises(trunnion.InputError) as raised:
        trunnion.post(file, machine="ucp800", observer=listener)
    lines = [problem.line for problem in raised.value.problems]
    assert lines == sorted(lines)
    assert len(set(lines)) > 1
    assert {problem.severity for problem in raised.value.problems} == {trunnion.Severity.ERROR}
    assert any("home of X, Y, Z is not stated" in problem.what for problem in listener.heard)


def test_the_error_of_a_failed_proof_says_what_was_found(monkeypatch: pytest.MonkeyPatch) -> None:
    written = writing.write

    def spoiled(program: Any, sink: Any, *more: Any, **named: Any) -> Any:
        return written(replace(program, settings={**program.settings, "work_offset": "G55"}), sink, *more, **named)

    monkeypatch.setattr(writing, "write", spoiled)
    with pytest.raises(trunnion.RefusedError, match=r"fails its proof: .*in G55, not in G54.*\(offset\)"):
        trunnion.post(CL, machine="yl569")
