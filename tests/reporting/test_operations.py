"""Times of operations and decisions of the planner: in the page, in JSON, and from ``trunnion post``."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import trunnion
from tests.support.locations import YL569
from tests.support.reports import Page, blade
from trunnion.cli import main
from trunnion.messages import word_said
from trunnion.model.motion import Decision, DecisionTopic
from trunnion.reporting.write import write_report
from trunnion.verification import OperationRows

DECIDED = [
    Decision("blade.cls", "BLADE", 12, 0, DecisionTopic.START, word_said("starts at C 1.000 B 2.000")),
    Decision("blade.cls", "<b>BLADE</b>", 40, 7, DecisionTopic.POLE, word_said("axis C holds & turns <script>\x00")),
]


def test_operations_and_decisions_are_in_the_data(tmp_path: Path) -> None:
    found = replace(
        blade(),
        operations=(OperationRows("ONE", "BALL", "a.cls", 0, 100), OperationRows("TWO", "BALL", "b.cls", 100, 154)),
    )
    write_report(found, tmp_path / "report.json", decisions=DECIDED)
    said: Any = json.loads((tmp_path / "report.json").read_text(encoding="utf-8"))
    assert [operation["name"] for operation in said["operations"]] == ["ONE", "TWO"]
    assert [operation["motions"] for operation in said["operations"]] == [100, 54]
    assert sum(operation["seconds"] for operation in said["operations"]) == pytest.approx(said["time"]["seconds"])
    for operation in said["operations"]:
        assert operation["seconds"] == pytest.approx(operation["cutting_seconds"] + operation["rapid_seconds"])
    assert said["decisions"][0] == {
        "operation": "BLADE", "cl_file": "blade.cls", "cl_line": 12, "about": "start",
        "text": "starts at C 1.000 B 2.000",
    }  # fmt: skip


def test_an_operation_without_motion_has_no_block(tmp_path: Path) -> None:
    found = replace(blade(), operations=(OperationRows("ONE", "", "", 0, 0), OperationRows("TWO", "", "", 0, 154)))
    write_report(found, tmp_path / "report.json")
    said: Any = json.loads((tmp_path / "report.json").read_text(encoding="utf-8"))
    assert said["operations"][0]["first"] is None
    assert said["operations"][0]["seconds"] == 0.0


def test_the_page_shows_them_as_text(tmp_path: Path) -> None:
    found = replace(blade(), operations=(OperationRows("<i>ONE</i>", "BALL", "a.cls", 0, 154),))
    write_report(found, tmp_path / "report.html", decisions=DECIDED)
    text = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert "&lt;i&gt;ONE&lt;/i&gt;" in text
    assert "axis C holds &amp; turns &lt;script&gt;\ufffd" in text
    assert "<b>BLADE</b>" not in text
    assert Page(text)


def test_post_puts_times_and_decisions_into_its_report(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    report = tmp_path / "report.json"
    source, target = YL569 / "3_blade_finish.cls", tmp_path / "blade.mpf"
    given = ["post", str(source), "--machine", "yl569", "--output", str(target), "--report", str(report)]
    assert main(given) == 0
    said: Any = json.loads(report.read_text(encoding="utf-8"))
    assert said["decisions"][0]["about"] == "start"
    assert said["decisions"][-1]["about"] == "nearest"
    assert len(said["operations"]) == 1
    assert said["operations"][0]["seconds"] == pytest.approx(said["time"]["seconds"])
    err = capfd.readouterr().err
    assert "time: " in err
    assert "starts at" not in err, "the log is printed with --explain only"


UPRIGHT = """TOOL PATH/ONE,TOOL,D10
TLDATA/MILL,10,0,75,0,0
INTOL/0.01
OUTTOL/0.01
LOAD/TOOL,1
SPINDL/RPM,1000,CLW
RAPID
GOTO/0,0,50,0,0,1
FEDRAT/MMPM,500
GOTO/0,0,5
GOTO/90,40,5
END-OF-PATH
"""


@pytest.mark.parametrize("machine", ["matsuura_mx330", "dmu65"])
def test_extents_are_those_of_the_travel_check(machine: str, tmp_path: Path) -> None:
    """The way down from home is none of the program's: its height there is not known."""
    cl, report = tmp_path / "part.cls", tmp_path / "report.json"
    cl.write_text(UPRIGHT, encoding="utf-8")
    result = trunnion.post(cl, machine=machine, report=report)
    travel = next(check for check in result.checks if check.key == "travel")
    axes = {axis["name"]: axis for axis in json.loads(report.read_text(encoding="utf-8"))["extents"]["axes"]}
    needs = {place.text.split(" ")[0]: place.value for place in travel.places if " needs " in place.text}
    assert travel.passed
    assert needs
    for name, value in needs.items():
        assert axes[name]["whole"]["high"] - axes[name]["whole"]["low"] == pytest.approx(value)
    assert min(axis["margin"] for axis in axes.values() if axis["margin"] is not None) >= 0.0


def test_an_operation_in_a_file_of_its_own_begins_there(tmp_path: Path) -> None:
    files = [YL569 / "2_hub_rough.cls", YL569 / "3_blade_finish.cls"]
    report = tmp_path / "part.json"
    done = trunnion.post(
        files, machine="yl569", output=tmp_path / "part.mpf", report=report, settings={"programs": "operations"}
    )
    said: Any = json.loads(report.read_text(encoding="utf-8"))
    assert [each["first"]["nc_file"] for each in said["operations"]] == [file.name for file in done.subprograms]
