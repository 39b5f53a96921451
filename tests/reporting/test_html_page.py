"""The HTML page: its content, its plots, and that text from outside cannot become code."""

import base64
import hashlib
import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tests.support.page_columns import decode_column
from tests.support.reports import CHECKS, PLACES, Page, blade, waves, with_columns, with_seconds
from trunnion.messages import foreign
from trunnion.model.columns import StepColumn
from trunnion.reporting.html_text import capitalised, format_number, prose, table
from trunnion.reporting.write import write_report
from trunnion.verification.results import Check, Verification
from trunnion.wording import format_duration

HOSTILE = "</script><script>alert(1)</script><img src=x onerror=alert(2)>\"'--><!--&amp;"


def page_of(verification: Verification, folder: Path) -> Page:
    write_report(verification, folder / "report.html")
    return Page((folder / "report.html").read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Page:
    return page_of(blade(), tmp_path_factory.mktemp("report"))


def test_the_head_says_what_was_checked_and_how_it_came_out(page: Page) -> None:
    for words in ("Failed", "1 of 3 checks", "3_blade_finish.mpf", "Yalong YL569", "sinumerik_840d", "154"):
        assert words in page.text


def test_a_program_without_faults_is_passed_at_first_sight(tmp_path: Path) -> None:
    good = page_of(blade(checks=CHECKS[:1]), tmp_path).text
    assert "Passed" in good
    assert "failed" not in good.lower()
    assert "Nothing checked" in page_of(blade(checks=()), tmp_path).text


def test_each_check_has_a_row_and_the_worst_places_have_theirs(page: Page) -> None:
    for check in CHECKS:
        assert capitalised(check.title) in page.text
        assert check.summary in page.text
    assert "N500" in page.text
    assert "and 8 more" in page.text
    assert PLACES[11].text in page.text
    assert PLACES[12].text not in page.text


def test_failed_checks_show_their_places_first(page: Page) -> None:
    places = page.text[page.text.index("Worst places") :]
    assert places.index("Travel of the axes") < places.index("Tool tip against")


def test_tools_times_and_extents_are_there(page: Page) -> None:
    assert re.search(r"Tool\s*Motions\s*Time", page.text)
    assert re.search(r"before the first tool\s*2", page.text)
    assert "−11 … 100" in page.text
    assert "travel 500" in page.text
    assert "475.763" in page.text
    assert "endless" in page.text


#: Of X, Y and Z.
LIMITS = [[-250, 250], [-150, 150], [-250, 250]]


def test_slides_have_their_limits_where_the_workpiece_zero_is_known(tmp_path: Path) -> None:
    verification = blade()
    machine = replace(verification.machine, workpiece_zero=(0.0, 0.0, 0.0), tool_length=0.0)
    known = replace(verification, machine=machine, run=replace(verification.run, machine=machine))
    page = page_of(known, tmp_path)
    plots = json.loads(page.script("report"))["plots"]
    assert [plot["lines"][0]["limits"] for plot in plots[:3]] == LIMITS
    assert "−250 … 250" in page.text
    assert "no workpiece zero" not in page.text
    assert "no workpiece zero" in page_of(verification, tmp_path).text
    machine = replace(machine, tool_length=None)
    partly = replace(verification, machine=machine, run=replace(verification.run, machine=machine))
    limits = [
        plot["lines"][0]["limits"] for plot in json.loads(page_of(partly, tmp_path).script("report"))["plots"][:3]
    ]
    assert limits[:2] == [[-250, 250], [-150, 150]]
    assert limits[2] != [-250, 250]


def test_an_axis_beyond_its_travel_has_a_negative_margin(tmp_path: Path) -> None:
    verification = blade()
    joints = verification.run.joints.copy()
    joints[10, 1] = 104.5
    page = page_of(with_columns(verification, joints=joints), tmp_path)
    assert "−4.500" in page.text


def test_names_and_texts_cannot_leave_their_place(tmp_path: Path) -> None:
    check = Check(HOSTILE, False, foreign(HOSTILE), 1.0, 2.0, HOSTILE, (replace(PLACES[0], wording=foreign(HOSTILE)),))
    plain = page_of(blade(), tmp_path)
    verification = blade(HOSTILE, (check,))
    state = replace(verification.run.state, file=StepColumn.constant(len(verification.run), 1, np.uint16))
    run = replace(verification.run, tools=("", HOSTILE), files=(HOSTILE, HOSTILE), state=state)
    machine = replace(verification.machine, name=HOSTILE)
    page = page_of(replace(verification, run=run, machine=machine), tmp_path)
    assert page.running == plain.running
    assert page.text.count(HOSTILE) >= 6
    assert {tag for tag, _ in page.elements} <= {tag for tag, _ in plain.elements}
    assert not any(name.startswith("on") for _, attributes in page.elements for name in attributes)
    assert json.loads(page.script("report"))["files"] == [Path(HOSTILE).name] * 2


def test_characters_that_no_file_can_carry_are_replaced(tmp_path: Path) -> None:
    page = page_of(blade("hub\x00\x1b\udcff 轮毂 Prüfstück.mpf"), tmp_path)
    assert "hub\ufffd\ufffd\ufffd 轮毂 Prüfstück.mpf" in page.text


def test_nothing_is_loaded_from_elsewhere(page: Page) -> None:
    loading = {"src", "href", "srcset", "data", "action", "poster", "background", "style", "xlink:href"}
    for tag, attributes in page.elements:
        assert tag not in {"link", "img", "iframe", "object", "embed", "base"}
        assert not loading & set(attributes), (tag, attributes)
    assert not any(re.search(r"url\(|@import", style) for style in page.styles)
    for script in page.running:
        code = re.sub(r"/\*.*?\*/", "", script, flags=re.S)
        assert "://" not in code
        assert not re.search(r"\b(fetch|XMLHttpRequest|WebSocket|importScripts|import|eval)\b *\(", code)


def test_the_policy_lets_our_scripts_and_styles_run_and_nothing_else(page: Page) -> None:
    policy = next(
        attributes["content"] for _, attributes in page.elements if attributes.get("http-equiv", "") and attributes
    )
    assert policy is not None
    hashes = [
        base64.b64encode(hashlib.sha256(source.encode()).digest()).decode() for source in (*page.running, *page.styles)
    ]
    assert policy.startswith("default-src 'none'; script-src ")
    assert re.findall(r"'sha256-([^']+)'", policy) == hashes
    assert "unsafe" not in policy


def test_the_licence_of_the_plot_library_goes_along(page: Page) -> None:
    assert page.running[0].strip().startswith("/*\nThe MIT License (MIT)\n\nCopyright (c) 2022 Leon Sorokin")


def test_the_columns_are_those_of_the_run(page: Page) -> None:
    verification = blade()
    run = verification.run
    for k in range(5):
        column = decode_column(page.script(f"full-axis{k}").encode()).view(np.float32)
        assert column[0] == run.start[k]
        assert np.array_equal(column[1:], run.joints[:, k].astype(np.float32))
    assert np.array_equal(decode_column(page.script("full-block").encode())[1:], run.line)
    assert np.array_equal(decode_column(page.script("full-number").encode())[1:], run.block_number)
    assert np.array_equal(decode_column(page.script("full-cl").encode())[1:], verification.cl_line)


def test_every_plot_has_its_columns_and_limits(page: Page) -> None:
    spec = json.loads(page.script("report"))
    assert [plot["title"] for plot in spec["plots"]] == ["X", "Y", "Z", "C", "B", "Rotary speeds", "Tip feed"]
    limits = {line["name"]: line["limits"] for plot in spec["plots"][:5] for line in plot["lines"]}
    assert (limits["B"], limits["C"]) == ([-11, 100], [])
    assert [limits[name][1] - limits[name][0] for name in "XYZ"] == [500, 300, 500]
    assert [line["limits"] for line in spec["plots"][5]["lines"]] == [[9720], [5760]]
    for plot in spec["plots"]:
        for line in plot["lines"]:
            assert page.script(f"full-{line['column']}")


def test_short_programs_have_no_levels_and_long_ones_a_coarse_one_before_all_else(page: Page, tmp_path: Path) -> None:
    assert not any(attributes.get("id", "") == "coarse-axis0" for attributes, _ in page.scripts)
    write_report(waves(60_000), tmp_path / "long.html")
    long = Page((tmp_path / "long.html").read_text(encoding="utf-8"))
    names = [attributes.get("id") for attributes, _ in long.scripts]
    assert names.index("coarse-cl") < names.index(None) < names.index("full-seconds")
    levels = json.loads(long.script("report"))["levels"]
    assert levels == [1000]
    assert len(decode_column(long.script("coarse-block").encode())) < 30_000


def test_the_same_input_makes_the_same_bytes_and_no_date(tmp_path: Path) -> None:
    for name in ("a.html", "b.html"):
        write_report(blade(), tmp_path / name)
    assert (tmp_path / "a.html").read_bytes() == (tmp_path / "b.html").read_bytes()
    write_report(blade(), tmp_path / "c.html", control="Sinumerik 840D sl", made="2026-01-02, shift B")
    made = Page((tmp_path / "c.html").read_text(encoding="utf-8")).text
    assert "Sinumerik 840D sl" in made
    assert "2026-01-02, shift B" in made


def test_times_that_nobody_knows_are_said_and_counted_as_none(tmp_path: Path) -> None:
    verification = blade()
    seconds = verification.seconds.copy()
    seconds[3:5] = np.nan, np.inf
    page = page_of(with_seconds(verification, seconds), tmp_path)
    assert "2 motions without a known time" in page.text
    nothing = page_of(with_seconds(verification, np.full(len(seconds), np.nan)), tmp_path)
    assert "over motions: no times are known" in nothing.text
    assert json.loads(nothing.script("report"))["total"] == len(seconds)


def test_a_program_that_moves_nothing_has_a_report_without_plots(tmp_path: Path) -> None:
    page = page_of(waves(0), tmp_path)
    assert "Failed" in page.text
    assert "over time" not in page.text


def test_times_and_numbers_read_well() -> None:
    assert [format_duration(x) for x in (0, 59.94, 59.96, 75, 7384)] == [
        "0.0 s",
        "59.9 s",
        "1:00 min",
        "1:15 min",
        "2:03:04 h",
    ]
    said = {0.00123456: "0.001235", 12345.6: "12346", -0.5: "−0.5", 3e-9: "3e−09", 0.0: "0", 5000.0: "5000"}
    assert {value: format_number(value) for value in said} == said
    assert [format_number(None), format_number(float("nan")), format_number(float("-inf"))] == ["", "", "−∞"]


def test_no_minus_is_parted_from_its_number_and_names_stay_whole() -> None:
    assert prose("goes to X-41.5, Y -0.25 in part-2.mpf") == (
        'goes to <span class="nb">X-41.5</span>, Y <span class="nb">-0.25</span> in part-2.mpf'
    )


def test_each_cell_says_its_column_for_pages_too_narrow_for_columns() -> None:
    text = table(("Check", "#Worst", "-"), ["<tr><th scope=row>tip</th><td class=n>3</td><td></td></tr>"], "tight")
    assert '<th data-of="Check" scope=row>tip</th><td data-of="Worst" class=n>3</td><td data-of="">' in text
