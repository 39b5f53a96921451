"""The report as JSON, and its schema in the documentation."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.support.locations import DOCS
from tests.support.reports import CHECKS, PLACES, blade, waves, with_columns
from trunnion.messages import foreign
from trunnion.reporting import json_report
from trunnion.reporting.write import write_report
from trunnion.verification.results import Check, Verification


def data_of(verification: Verification, folder: Path) -> Any:
    def refuse(word: str) -> None:
        raise AssertionError(f"{word} is not JSON")

    write_report(verification, folder / "report.json")
    return json.loads((folder / "report.json").read_text(encoding="utf-8"), parse_constant=refuse)


def test_the_data_hold_what_the_page_says(tmp_path: Path) -> None:
    said = data_of(blade(), tmp_path)
    assert (said["schema"], said["passed"], said["program"]) == (2, False, "3_blade_finish.mpf")
    assert said["machine"] == {"key": "yl569", "name": "Yalong YL569"}
    assert said["motions"] == 154
    assert [check["key"] for check in said["checks"]] == [check.key for check in CHECKS]
    assert len(said["checks"][0]["places"]) == len(PLACES)
    assert said["checks"][0]["places"][0] == {
        "nc_line": 50, "nc_file": None, "number": 500, "cl_file": "3_blade_finish.cls", "cl_line": 45, "value": 0.0004,
        "text": "the tip is 0 off", "code": None,
    }  # fmt: skip
    assert [tool["name"] for tool in said["tools"]] == ["", "2"]
    assert said["tools"][1]["rpm"] == [2500, 2500]
    assert said["tools"][1]["feed"] == [250, 250]
    assert sum(tool["seconds"] for tool in said["tools"]) == pytest.approx(said["time"]["seconds"])


def test_the_schema_in_the_documentation_names_every_key(tmp_path: Path) -> None:
    text = (DOCS / "report.md").read_text(encoding="utf-8")

    def keys(value: Any) -> set[str]:
        if isinstance(value, dict):
            return set(value) | set().union(*map(keys, value.values()), set())
        return set().union(*map(keys, value), set()) if isinstance(value, list) else set()

    said = data_of(blade(), tmp_path)
    columns = {name.split(" ")[0] for name in said.pop("columns")}
    missing = [key for key in sorted(keys(said) | columns) if f"`{key}" not in text and f'"{key}"' not in text]
    assert not missing


def test_extents_have_their_blocks_and_margins(tmp_path: Path) -> None:
    verification = blade()
    axes = {axis["name"]: axis for axis in data_of(verification, tmp_path)["extents"]["axes"]}
    highest = verification.run.joints[:, 1].argmax()
    assert axes["B"]["whole"]["high"] == verification.run.joints[highest, 1]
    assert axes["B"]["whole"]["high_at"]["nc_line"] == verification.run.line[highest]
    assert axes["B"]["margin"] == pytest.approx(11.0)
    assert (axes["C"]["endless"], axes["C"]["margin"], axes["C"]["limits"]) == (True, None, [None, None])


def test_columns_have_one_value_a_motion(tmp_path: Path) -> None:
    verification = blade()
    columns = data_of(verification, tmp_path)["columns"]
    assert {len(column) for column in columns.values()} == {154}
    assert columns["nc_line"] == verification.run.line.tolist()
    assert columns["time"][-1] == pytest.approx(verification.seconds.sum(), abs=1e-4)
    assert columns["axis B"] == pytest.approx(verification.run.joints[:, 1], abs=1e-5)


def test_values_without_a_number_are_null(tmp_path: Path) -> None:
    places = (replace(PLACES[0], value=float("nan"), number=-1, cl_line=0, cl_file=""),)
    check = Check("speed", True, foreign("none stated"), float("inf"), float("nan"), "", places)
    verification = blade(checks=(check,))
    tip = verification.run.tip.copy()
    tip[:, 0] = np.nan
    feed = np.full(len(tip), np.nan)
    said = data_of(replace(with_columns(verification, tip=tip), tip_feed=feed), tmp_path)
    assert (said["checks"][0]["worst"], said["checks"][0]["limit"]) == (None, None)
    assert set(said["checks"][0]["places"][0].values()) == {50, None, "the tip is 0 off"}
    assert said["extents"]["tip"][0]["whole"] is None


def test_long_programs_leave_the_columns_out_and_say_so(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(json_report, "MAX_COLUMN_MOTIONS", 1000)
    assert data_of(waves(1000), tmp_path)["columns_left_out"] is None
    said = data_of(waves(1001), tmp_path)
    assert said["columns"] is None
    assert "1001 motions" in said["columns_left_out"]


def test_a_program_that_moves_nothing_has_data_too(tmp_path: Path) -> None:
    said = data_of(waves(0), tmp_path)
    assert (said["motions"], said["tools"], said["columns"]["nc_line"]) == (0, [], [])


def test_text_of_all_languages_stays_as_it_is(tmp_path: Path) -> None:
    name = '</script>"轮毂\\ Prüf\ud800'
    assert data_of(blade(name), tmp_path)["program"] == '</script>"轮毂\\ Prüf\ufffd'
    assert "轮毂" in (tmp_path / "report.json").read_text(encoding="utf-8")


def test_a_speed_that_is_not_known_is_null_and_a_gap(tmp_path: Path) -> None:
    verification = blade()
    feed = verification.tip_feed.copy()
    feed[3] = np.nan
    said = data_of(replace(verification, tip_feed=feed), tmp_path)["columns"]
    assert said["tip_feed"][3] is None
    assert said["speed B"][3] is said["speed C"][3] is None
    assert None not in said["tip_feed"][4:]
