"""A recording in the report: the published figure, axes and spindle over time with the machine's travel."""

import json
import re
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import Browser

from tests.support.browser import browser as browser
from tests.support.browser import needs_browser, open_file
from tests.support.locations import ROOT
from tests.support.page_columns import decode_column
from tests.support.recordings import BLADE_FINISH, IMPELLER, blade, impeller, recorded, with_gap
from trunnion import read_program, verify, write_report
from trunnion.arrays import Floats
from trunnion.jobs.inputs.stated_setup import set_up_machine
from trunnion.machines import load_machine
from trunnion.model.recording import Recording
from trunnion.timing import time_run

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


def test_recorded_velocities_and_accelerations_are_drawn_below_their_axes(tmp_path: Path) -> None:
    """The published figure: position, speed and acceleration of an axis over time."""
    found = verify(
        ROOT / "examples" / "simulation" / "plate_bottom.mpf",
        machine=str(ROOT / "examples" / "published" / "machine.toml"),
        zero=(0.0, 0.0, -200.0),
        tool_length=110.0,
        recorded=ROOT / "examples" / "published" / "plate_bottom.csv",
    )
    write_report(found, tmp_path / "report.html")
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    told = json.loads(script(page, "recorded-report"))
    titles = [plot["title"] for plot in told["plots"]]
    assert titles == [f"{axis}{what}" for axis in "XYZCB" for what in ("", " velocity", " acceleration")] + ["Spindle"]
    units = {plot["title"]: plot["unit"] for plot in told["plots"]}
    assert (units["X velocity"], units["B acceleration"]) == ("mm/s", "°/s²")
    columns = {plot["title"]: plot["lines"][0]["column"] for plot in told["plots"]}
    assert np.abs(column(page, columns["Z velocity"])).max() == pytest.approx(5000.0 / 60.0, rel=1e-3)  # its rapid
    assert np.abs(column(page, columns["Y acceleration"])).max() == pytest.approx(1000.0, rel=1e-3)


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


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Recording]:
    """Reports of the programs of the impeller, one after the other, with and without their CL files."""
    folder = tmp_path_factory.mktemp("whole")
    programs, cl = zip(*IMPELLER.values(), strict=True)
    zero, length = "0,0,-200", 150.0
    machine = set_up_machine(load_machine("yl569"), zero, length)
    timed = time_run(read_program(main := impeller(folder), machine=machine, subprograms=programs))
    recording = recorded(timed, np.linspace(0.0, timed.duration, 4000))
    for name, files in (("with.html", cl), ("with.json", cl), ("without.html", [])):
        found = verify(
            main, machine="yl569", subprograms=programs, cl=files, zero=zero, tool_length=length,
            recorded=recording,
        )  # fmt: skip
        assert found.passed
        write_report(found, folder / name)
    return folder, recording


def test_the_programs_of_an_impeller_are_drawn_with_their_names_and_the_travel(whole: tuple[Path, Recording]) -> None:
    folder, recording = whole
    page = (folder / "with.html").read_text(encoding="utf-8")
    told = json.loads(script(page, "recorded-report"))
    limits = {plot["title"]: plot["lines"][0]["limits"] for plot in told["plots"]}
    assert limits == {
        "X": [-250.0, 250.0], "Y": [-150.0, 150.0], "Z": [-250.0, 250.0], "C": [], "B": [-11.0, 100.0],
        "Spindle": [9000.0],
    }  # fmt: skip
    for plot in told["plots"]:
        assert not plot["lines"][0].get("loose")
        name = "spindle" if plot["title"] == "Spindle" else plot["title"]
        shown = column(page, plot["lines"][0]["column"])
        np.testing.assert_array_equal(shown, recording.values[name].astype(np.float32))
    assert [name for _, name in told["marks"]] == ["CAVITY_MILL", "MULTI_BLADE_ROUGH", "BLADE_FINISH"]
    # An operation begins with the way home that leads to it, at the end of the program before it.
    program = recording.texts["program"]
    begin = np.searchsorted(recording.elapsed(), [time - 1e-3 for time, _ in told["marks"]]).tolist()
    assert begin[0] == 0
    for at, before, part in zip(begin[1:], list(IMPELLER)[:-1], list(IMPELLER)[1:], strict=True):
        assert program[at].startswith(before)
        assert program[at + 60].startswith(part)
    # Who points at the curves is told the file.
    files = decode_column(script(page, "recorded-full-file").encode()).view(np.int32)
    assert [told["files"][k] for k in np.unique(files[files > 0])] == [path.name for path, _ in IMPELLER.values()]
    without = json.loads(script((folder / "without.html").read_text(encoding="utf-8"), "recorded-report"))
    assert [name for _, name in without["marks"]] == [path.name for path, _ in IMPELLER.values()]


def test_what_was_used_of_the_travel_is_told_in_numbers(whole: tuple[Path, Recording]) -> None:
    folder, recording = whole
    told = json.loads((folder / "with.json").read_text(encoding="utf-8"))["recorded"]["extents"]
    assert [each["name"] for each in told] == ["X", "Y", "Z", "C", "B", "Spindle"]
    page = (folder / "with.html").read_text(encoding="utf-8")
    table = page[page.index("<h2>Extents in made.csv</h2>") : page.index('<section id="recorded-plots"')]
    table = re.sub(r"<[^>]+>", " ", table).replace("\u2212", "-")
    for each in told:
        values = recording.values["spindle" if each["name"] == "Spindle" else each["name"]]
        low, high = float(values.min()), float(values.max())
        assert (each["whole"]["low"], each["whole"]["high"]) == (low, high)
        least, most = each["limits"]
        rooms = [
            high_room for high_room in (most - high if most else None, low - least if least else None) if high_room
        ]
        margin = "" if each["endless"] else f"{min(rooms):.3f}"
        assert each["margin"] == (pytest.approx(min(rooms)) if margin else None)
        shown = r"\s+".join([re.escape(each["name"]), r"\S+", f"{low:.3f}", r"N\d+", f"{high:.3f}", r"N\d+"])
        assert re.search(rf"{shown}\s.*?{re.escape(margin)}", table), (each, table)


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
