"""A recording in the report: the published figure, axes and spindle over time with the machine's travel."""

import json
import re
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import Browser

from tests.support.browser import browser as browser
from tests.support.browser import needs_browser, open_file
from tests.support.recordings import BLADE_FINISH, blade, recorded, with_gap
from trunnion import verify, write_report
from trunnion.arrays import Floats
from trunnion.model.recording import Recording
from trunnion.reporting.column_encoding import decode_column

GAP = (300, 360)


@pytest.fixture(scope="module")
def recording() -> Recording:
    return with_gap(recorded(blade(), np.linspace(0.0, blade().duration, 1000)), *GAP)


@pytest.fixture(scope="module")
def folder(recording: Recording, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("report")
    found = verify(BLADE_FINISH, machine="yl569", recorded=recording)
    for name in ("report.html", "report.json"):
        write_report(found, folder / name)
    return folder


def script(page: str, name: str) -> str:
    found = re.search(rf'<script type="[a-z/]+" id="{name}">(.*?)</script>', page, re.DOTALL)
    assert found is not None, name
    return found[1]


def column(page: str, name: str) -> Floats:
    return decode_column(script(page, f"recorded-full-{name}").encode()).view(np.float32).astype(np.float64)


def test_the_page_draws_axes_and_spindle_from_the_recording(folder: Path, recording: Recording) -> None:
    page = (folder / "report.html").read_text(encoding="utf-8")
    told = json.loads(script(page, "recorded-report"))
    assert [plot["title"] for plot in told["plots"]] == ["X", "Y", "Z", "C", "B", "Spindle"]
    limits = {plot["title"]: plot["lines"][0]["limits"] for plot in told["plots"]}
    assert limits["B"] == [-11.0, 100.0]
    assert limits["Spindle"] == [9000.0]
    assert limits["X"][1] - limits["X"][0] == pytest.approx(500.0)  # its place is not known without a zero
    kept = np.delete(np.arange(len(recording)), GAP[0])
    for plot in told["plots"]:
        name, own = plot["title"], plot["lines"][0]["column"]
        wanted = recording.values["spindle" if name == "Spindle" else name][kept]
        np.testing.assert_array_equal(column(page, own), wanted.astype(np.float32))
    seconds = np.cumsum(column(page, "seconds"))
    np.testing.assert_allclose(seconds, recording.elapsed()[kept], atol=1e-4)
    assert [(round(time, 3), name) for time, name in told["marks"]] == [
        (round(seconds[GAP[0] - 1], 3), "gap"), (round(seconds[GAP[0]], 3), "connected again"),
    ]  # fmt: skip


def test_the_data_have_how_far_off_each_motion_was(folder: Path) -> None:
    data = json.loads((folder / "report.json").read_text(encoding="utf-8"))
    assert data["recorded"]["gaps"] == 1
    assert data["recorded"]["positions"] == sum(data["columns"]["recorded_positions"]) > 500
    for count, tip, axis in zip(
        *(data["columns"][f"recorded_{name}"] for name in ("positions", "tip_off", "axis_off")), strict=True
    ):
        assert (tip is None) is (axis is None) is (count == 0)
        assert count == 0 or max(tip, axis) < 1e-9
    assert data["checks"][-1]["key"] == "recorded"


@needs_browser
def test_both_sections_are_drawn_and_zoomed_apart(folder: Path, browser: Browser) -> None:
    page = browser.new_page()
    errors: list[str] = []
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.goto(open_file(folder / "report.html"))
    for own in ("", "recorded-"):
        # The page's policy forbids the script that waits in it.
        while not page.evaluate(f"performance.getEntriesByName('{own}full plots').length"):
            assert errors == []
            page.wait_for_timeout(50)
        assert page.locator(f"#{own}strips canvas").count() == page.locator(f"#{own}strips .strip").count() > 5

    def drawn(own: str) -> str:
        page.evaluate("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
        return str(page.evaluate(f"document.querySelector('#{own}strips canvas').toDataURL()"))

    before = {own: drawn(own) for own in ("", "recorded-")}
    page.locator("#recorded-bar button[data-act=in]").click()
    assert drawn("") == before[""]
    assert drawn("recorded-") != before["recorded-"]
    assert errors == []
    page.close()
