"""Looking, measuring and saving: what the tools of the viewer's page give is what the program says."""

import csv
import struct
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import Browser, Page

from tests.support.browser import browser as browser
from tests.support.browser import needs_browser, open_file, open_page
from tests.support.locations import GOLDEN
from trunnion import Run, load_machine, read_program, write_view
from trunnion.jobs.inputs.stated_setup import set_up_machine
from trunnion.machines import forward

pytestmark = needs_browser

PROGRAM = GOLDEN / "yl569" / "3_blade_finish.expected.mpf"
MACHINE = set_up_machine(load_machine("yl569"), (0.0, 0.0, -20.0), 110.0)


@pytest.fixture(scope="module")
def run() -> Run:
    return read_program(PROGRAM, machine=MACHINE)


@pytest.fixture(scope="module")
def view(tmp_path_factory: pytest.TempPathFactory, browser: Browser) -> Iterator[Page]:
    out = tmp_path_factory.mktemp("view") / "view.html"
    write_view(PROGRAM, machine=MACHINE, cl=PROGRAM.with_name("3_blade_finish.cls"), output=out)
    with open_page(browser, open_file(out)) as (page, errors):
        yield page
        assert errors == []


def direction(page: Page) -> list[float]:
    """From what is looked at to the eye, a unit vector."""
    eye = "page.space.camera.position.clone().sub(page.space.controls.target).normalize().toArray()"
    return list(page.evaluate(eye))


@pytest.mark.parametrize(
    ("view_name", "key", "wanted"),
    [
        ("top", "2", (0, 0, 1)),
        ("front", "3", (0, -1, 0)),
        ("right", "4", (1, 0, 0)),
        ("iso", "1", (-0.427, -0.776, 0.465)),
    ],
)
def test_a_standard_view_looks_along_its_axis(view_name: str, key: str, wanted: tuple[float, ...], view: Page) -> None:
    other = "front" if view_name != "front" else "right"
    for choose in (lambda: view.locator("#view").select_option(view_name), lambda: view.keyboard.press(key)):
        view.locator("#view").select_option(other)
        view.locator("#space").focus()
        choose()
        np.testing.assert_allclose(direction(view), wanted, atol=2e-3)


def test_two_clicks_measure_two_points_of_the_path(view: Page, run: Run) -> None:
    view.locator("#frame").select_option("part")
    view.locator("#view").select_option("iso")
    for pressed in ("true", "false", "true"):  # put away unused once: it must draw all the same
        view.locator("#measure").click()
        assert view.locator("#measure").get_attribute("aria-pressed") == pressed
    before = view.evaluate("page.space.picture()")
    # Rows that nothing hides: a click at the end of one must mean that one.
    rows, places = view.evaluate(
        """() => { const { space, program } = page, box = space.canvas.getBoundingClientRect(), rows = [], places = [];
        space.drawNow();
        for (const piece of space.segments) {
          const row = program.row[piece];
          if (program.last[row] !== piece) continue;
          const v = new THREE.Vector3().fromArray(space.tips, 3 * piece + 3).applyMatrix4(space.place.matrixWorld);
          v.project(space.camera);
          const x = (v.x + 1) / 2 * box.width, y = (1 - v.y) / 2 * box.height;
          if (space.pick(x, y) === piece) { rows.push(row); places.push([box.left + x, box.top + y]); }
        }
        return [rows, places]; }"""
    )
    assert len(rows) > 1
    for place in (places[0], places[-1]):
        view.mouse.click(*place)
    tips = forward(run.machine, run.joints[[rows[0], rows[-1]]])[0]
    away = tips[1] - tips[0]
    words = view.locator("#status").inner_text().replace("(", "").replace(")", "").split()
    assert (words[0], words[2], words[-1]) == ("Distance", "mm", "mm")
    np.testing.assert_allclose([float(words[1]), *map(float, words[3:-1])], [np.linalg.norm(away), *away], atol=2e-4)
    assert view.evaluate("page.space.picture()") != before
    view.locator("#measure").click()
    assert view.locator("#status").inner_text() == ""
    assert view.evaluate("page.space.picture()") == before


def test_curves_are_saved_as_the_axes_go(view: Page, run: Run) -> None:
    with view.expect_download() as saved:
        view.locator("#csv").click()
    assert saved.value.suggested_filename == "curves.csv"
    rows = list(csv.reader(Path(saved.value.path()).read_text(encoding="utf-8").splitlines()))
    assert rows[0][:7] == [
        "seconds",
        "line",
        *(f"{axis.name} {'°' if axis.is_rotary else 'mm'}" for axis in run.machine.axes),
    ]
    values = np.array(rows[1:], dtype=float)
    assert len(values) == view.evaluate("page.program.pieces")
    last = view.evaluate("Array.from(page.program.last)")
    np.testing.assert_array_equal(values[last, 1], run.line)
    np.testing.assert_allclose(values[last, 2:7], run.joints, atol=2e-5)
    assert (np.diff(values[:, 0]) >= 0).all()


def test_the_screenshot_is_a_picture_of_what_is_shown(view: Page) -> None:
    view.evaluate(
        "page.space.hurry(true); page.space.pace = 1e6; page.space.drawn = performance.now() - 400; page.space.draw()"
    )
    view.wait_for_function("() => page.space.detail < 1")  # as on a slow computer
    with view.expect_download() as saved:
        view.locator("#picture").click()
    view.evaluate("page.space.hurry(false)")
    view.wait_for_function("() => page.space.detail === 1")
    assert saved.value.suggested_filename == "view.png"
    picture = Path(saved.value.path()).read_bytes()
    assert picture[:8] == b"\x89PNG\r\n\x1a\n"
    assert list(struct.unpack(">II", picture[16:24])) == view.evaluate(
        "[page.space.canvas.width, page.space.canvas.height]"
    )
    shades = view.evaluate(
        """async () => { const picture = new Image(); picture.src = page.space.picture();
        await picture.decode(); const paper = document.createElement("canvas"); paper.width = picture.width;
        paper.height = picture.height; const pen = paper.getContext("2d"); pen.drawImage(picture, 0, 0);
        return new Set(new Uint32Array(pen.getImageData(0, 0, paper.width, paper.height).data.buffer)).size; }"""
    )
    assert shades > 10


def test_moving_on_makes_no_new_buffers(view: Page) -> None:
    """A buffer for each picture would fill the graphics card within hours."""
    made = view.evaluate(
        """() => { const gl = page.space.renderer.getContext(), create = gl.createBuffer.bind(gl); let made = 0;
        page.goToRow(page.program.rows - 1); page.space.drawNow();
        gl.createBuffer = () => { made++; return create(); };
        for (let row = 1; row < 40; row++) { page.goToRow(row); page.space.drawNow(); }
        gl.createBuffer = create; return made; }"""
    )
    assert made <= 3


def test_the_whole_of_a_long_path_follows_its_first_picture(tmp_path: Path, browser: Browser) -> None:
    program, out = tmp_path / "long.mpf", tmp_path / "view.html"
    lines = (f"X{k % 100} Y{k / 100}" for k in range(9000))
    program.write_text("\n".join(["G54 G90 G0 X0 Y0 Z50", "G1 F500 X1", *lines, "M30", ""]), encoding="ascii")
    write_view(program, machine=MACHINE, output=out)
    with open_page(browser, open_file(out)) as (page, errors):
        page.wait_for_function("() => page.space.lines.visible && !page.space.coarse.visible")
        assert page.evaluate("page.space.segments.length") >= 9000
        assert errors == []
