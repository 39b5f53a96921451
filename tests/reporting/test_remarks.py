"""The warnings of a job in its report: each thing once."""

import json
from dataclasses import replace
from pathlib import Path

import trunnion
from tests.support.locations import YL569
from tests.support.reports import blade
from trunnion.errors import Problem, Severity
from trunnion.jobs.convert.result import ConvertResult
from trunnion.messages import Wording, foreign
from trunnion.model.toolpath import Toolpath
from trunnion.reporting.remarks import remark_data, remark_groups
from trunnion.reporting.write import write_report
from trunnion.results import to_data


def warning(line: int, operation: str) -> Problem:
    wording = Wording("CTL530", "operation_no_intol", operation=operation, fallback="0.01")
    return Problem("part.cls", line, wording, severity=Severity.WARNING)


def test_what_is_said_of_fifteen_places_is_one_line_with_a_count() -> None:
    problems = [warning(k, f"OP{k}") for k in range(1, 16)]
    other = Problem("part.cls", 3, foreign("another\x00 thing"), severity=Severity.WARNING)
    groups = remark_groups([*problems[:7], other, *problems[7:]])
    assert [(group.count, group.line, group.code) for group in groups] == [(15, 1, "CTL530"), (1, 3, "")]
    assert groups[1].text == "another\ufffd thing"


def test_what_differs_in_a_part_that_is_a_text_of_its_own_is_not_the_same() -> None:
    found = ("gouge: tool 2, part", "collision: part, shank", "gouge: tool 2, part")
    wordings = [Wording("PRJ210", "simulation_finds", finding=foreign(each)) for each in found]
    groups = remark_groups(Problem("a.mpf", 1, each, severity=Severity.WARNING) for each in wordings)
    assert [(each.text, each.count) for each in groups] == [
        ("the simulation finds: gouge: tool 2, part", 2),
        ("the simulation finds: collision: part, shank", 1),
    ]


def test_data_of_a_job_has_the_first_place_and_a_count() -> None:
    problems = tuple(warning(k, f"OP{k}") for k in range(1, 16))
    converted = ConvertResult(Toolpath("part.cls", ()), {}, problems, None, None, None)
    (remark,) = to_data(converted)["remarks"]
    assert (remark["count"], remark["code"], remark["file"], remark["line"]) == (15, "CTL530", "part.cls", 1)
    assert remark_data(problems) == [remark]


def test_page_and_data_have_every_warning(tmp_path: Path) -> None:
    found = replace(blade(), remarks=tuple(warning(k, f"<OP{k}>") for k in (1, 2)))
    write_report(found, tmp_path / "r.json")
    write_report(found, tmp_path / "r.html")
    (remark,) = json.loads((tmp_path / "r.json").read_text("utf-8"))["remarks"]
    assert (remark["severity"], remark["count"], remark["file"], remark["line"]) == ("warning", 2, "part.cls", 1)
    page = (tmp_path / "r.html").read_text("utf-8")
    assert "<h2>Warnings</h2>" in page
    assert "operation &lt;OP1&gt; has no INTOL" in page
    assert "2 warnings" in page


def test_the_report_of_a_post_has_what_the_terminal_had(tmp_path: Path) -> None:
    text = (YL569 / "2_hub_rough.cls").read_text("utf-8").replace("RAPID\n", "RAPID\nDISPLAY/ON\n", 1)
    cl = tmp_path / "part.cls"
    cl.write_text(text.replace("INTOL", "$$INTOL").replace("OUTTOL", "$$OUTTOL"), encoding="utf-8")
    report = tmp_path / "r.json"
    result = trunnion.post(cl, machine="yl569", output=tmp_path / "p.mpf", report=report)
    said = json.loads(report.read_text("utf-8"))
    told = [problem for problem in result.problems if problem.severity is Severity.WARNING]
    assert told
    assert sum(remark["count"] for remark in said["remarks"]) == len(told) == said["standing"]["warnings"]


def test_holes_need_no_tolerance(tmp_path: Path) -> None:
    cl = tmp_path / "holes.cls"
    head = "TOOL PATH/HOLES,TOOL,D8\nTLDATA/DRILL,8.0,0.0,75.0,118.0,50.0\n"
    cl.write_text(
        head + "MSYS/0.0,0.0,0.0,1.0,0.0,0.0,0.0,1.0,0.0\nLOAD/TOOL,1\nSPINDL/RPM,1000,CLW\nRAPID\n"
        "GOTO/0.0,0.0,50.0,0.0,0.0,1.0\nCYCLE/DRILL,RAPTO,3.0,FEDTO,-20.0,RTRCTO,AUTO,MMPM,200.0\n"
        "GOTO/0.0,0.0,0.0\nGOTO/20.0,0.0,0.0\nCYCLE/OFF\nRAPID\nGOTO/20.0,0.0,50.0\nEND-OF-PATH\n",
        encoding="utf-8",
    )
    result = trunnion.post(cl, machine="yl569")
    assert not [problem for problem in result.problems if "INTOL" in problem.what]
