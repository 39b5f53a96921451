"""The stock of a view, in a real browser: it is what the simulation leaves, in its colours, and findings are places."""

import re
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
import uvicorn
from playwright.sync_api import Browser, Page

import trunnion
from tests.support.browser import browser as browser
from tests.support.browser import needs_browser, open_file, open_page
from tests.support.stepped_slot import CELL, write_slot
from trunnion import InputError, write_view
from trunnion.jobs.view.viewing import prepare_view
from trunnion.simulation.stock.surface import stock_surface
from trunnion.viewer.content import ViewContent
from trunnion.viewer.server import view_application
from trunnion.viewer.serving import Access, take_port

pytestmark = needs_browser

#: Facets, volume, and the lowest and highest place of what is shown.
SHAPE = """() => {
  let count = 0, volume = 0;
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (const [{ geometry }] of page.stock.meshes.values()) {
    const { array } = geometry.attributes.position, index = geometry.index.array;
    for (let k = 0; k < index.length; k += 3, count++) {
      const [a, b, c] = [0, 1, 2].map((corner) => new THREE.Vector3().fromArray(array, 3 * index[k + corner]));
      volume += a.dot(b.clone().cross(c)) / 6;
      for (const v of [a, b, c]) v.toArray().forEach((at, axis) => {
        low[axis] = Math.min(low[axis], at);
        high[axis] = Math.max(high[axis], at);
      });
    }
  }
  return { count, volume, low, high };
}"""


#: Colour of the vertex that is nearest to a place.
def on_screen(light: list[int]) -> list[float]:
    """A colour as the screen has it, of what a vertex says, which is linear light; 0 to 255."""
    parts = [part / 255.0 for part in light]
    return [255.0 * (12.92 * part if part <= 0.0031308 else 1.055 * part ** (1 / 2.4) - 0.055) for part in parts]


COLOUR = """place => {
  let best = Infinity, found = null;
  for (const [{ geometry }] of page.stock.meshes.values()) {
    const { position, color } = geometry.attributes;
    for (let k = 0; k < position.count; k++) {
      const off = Math.hypot(...[0, 1, 2].map((axis) => position.array[3 * k + axis] - place[axis]));
      if (off < best) { best = off; found = Array.from(color.array.subarray(3 * k, 3 * k + 3)); }
    }
  }
  return found;
}"""


@pytest.fixture(scope="module")
def slot(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("slot")


@pytest.fixture(scope="module")
def view(slot: Path, browser: Browser) -> Iterator[Page]:
    program, given = write_slot(slot)
    write_view(program, **given, output=slot / "view.html")
    with open_page(browser, open_file(slot / "view.html")) as (page, errors):
        yield page
        assert errors == []


def row_of(page: Page, block: str) -> int:
    """The row of a block of the program."""
    return int(
        page.evaluate(
            """async block => { const text = page.listing;
            for (let row = 0; row < page.program.rows; row++)
              if (text.lineText(page.program.line[row]).startsWith(block + " ")) return row;
            return -1; }""",
            block,
        )
    )


def test_the_mesh_is_that_of_a_simulation_until_the_block(view: Page, slot: Path) -> None:
    program, given = write_slot(slot)
    volumes = []
    for block in ("N55", "N70", "N95"):
        view.evaluate("row => page.goToRow(row - 1)", row_of(view, block))
        shown = view.evaluate(SHAPE)
        until = trunnion.simulate(program, **{**given, "part": None}, until=block).simulation.stock
        mesh = stock_surface(until)
        assert shown["count"] == len(mesh.faces)
        assert shown["volume"] == pytest.approx(mesh.volume, abs=0.2)  # places are told in 254ths of a cell
        assert shown["volume"] == pytest.approx(until.volume, abs=CELL / 3.0 * 400.0)
        np.testing.assert_allclose(shown["low"], (0.0, -20.0, -10.0), atol=1e-5)
        np.testing.assert_allclose(shown["high"], (50.0, 20.0, 0.0), atol=1e-5)
        volumes.append(shown["volume"])
    assert volumes[0] == pytest.approx(50 * 40 * 10, abs=0.01)
    # The slot, whose round ends are those of the tool: to X 25 at 5 mm, from there to the end at 3 mm.
    round_end = np.pi * 5.0**2 / 2.0
    assert volumes[1] == pytest.approx(volumes[0] - 5.0 * (25 * 10 + round_end), abs=CELL * 40.0)
    assert volumes[2] == pytest.approx(volumes[1] - 3.0 * (25 * 10 - round_end), abs=CELL * 40.0)


def test_within_a_block_it_is_not_yet_cut(view: Page) -> None:
    row = row_of(view, "N60")
    view.evaluate("row => page.goTo((page.program.timeOf(row - 1) + page.program.timeOf(row)) / 2)", row)
    assert view.evaluate("page.row") == row
    assert view.evaluate("page.stock.shown") <= row
    view.evaluate("row => page.goToRow(row)", row)
    assert view.evaluate("page.stock.shown") == row + 1


def test_it_stands_with_the_part_in_both_frames_and_under_a_section(view: Page) -> None:
    picture = "() => { page.space.drawNow(); return page.space.canvas.toDataURL(); }"
    for frame in ("part", "machine"):
        view.locator("#frame").select_option(frame)
        view.evaluate("page.goToRow(page.program.rows - 1); page.space.look('iso', true)")
        shown = view.evaluate(picture)
        view.locator("#section").select_option("x")
        assert view.evaluate(picture) != shown
        view.locator("#section").select_option("")
        view.locator("#stock").select_option("off")
        assert view.evaluate(picture) != shown
        view.locator("#stock").select_option("cut")
        assert view.evaluate(picture) == shown
        assert view.evaluate("page.stock.group.parent === page.space.place")


def test_deviations_have_their_colours_and_a_scale(view: Page) -> None:
    view.evaluate("page.goToRow(0)")
    view.locator("#stock").select_option("deviation")
    assert view.evaluate("page.stock.least") == pytest.approx(-1.0, abs=0.02)
    assert view.evaluate("page.stock.most") == pytest.approx(1.0, abs=0.02)
    missing, left, sound = (
        on_screen(view.evaluate(COLOUR, place)) for place in ((12, 0, -5), (42, 0, -3), (25, -15, 0))
    )
    np.testing.assert_allclose(missing, (217, 13, 26), atol=6)
    np.testing.assert_allclose(left, (20, 77, 204), atol=6)
    np.testing.assert_allclose(sound, (196, 196, 196), atol=1)
    assert re.fullmatch(r"missing (0\.99\d|1\.00\d) mm \| ± 0\.100 mm \| left (0\.99\d|1\.00\d) mm", legend(view))
    view.locator("#space").focus()
    view.keyboard.press("s")
    assert view.locator("#stock").input_value() == "off"
    assert not view.locator("#scale").is_visible()
    view.keyboard.press("s")
    assert view.locator("#stock").input_value() == "cut"


def test_the_path_has_the_colours_of_what_it_left(view: Page) -> None:
    view.locator("#colour").select_option("deviation")
    assert legend(view).startswith("missing")
    colour = """row => {
    const k = Array.from(page.space.segments).findIndex((piece) => page.program.row[piece] === row);
    return Array.from(page.space.colours.subarray(6 * k, 6 * k + 3)); }"""
    np.testing.assert_allclose(on_screen(view.evaluate(colour, row_of(view, "N60"))), (217, 13, 26), atol=6)
    np.testing.assert_allclose(on_screen(view.evaluate(colour, row_of(view, "N80"))), (20, 77, 204), atol=6)
    view.locator("#colour").select_option("kind")


def legend(page: Page) -> str:
    return str(page.locator("#scale-text").inner_text())


def test_a_finding_leads_to_its_block_from_the_list_and_from_its_place(view: Page) -> None:
    row = row_of(view, "N55")
    view.evaluate("page.goToRow(0)")
    view.locator("#findings button", has_text="rapid through stock").click()
    assert view.evaluate("page.row") == row
    assert "N55" in view.locator(".line.current").inner_text()
    assert view.evaluate("page.curves.marks").count(view.evaluate("row => page.program.timeOf(row)", row)) >= 1
    view.evaluate("page.goToRow(1); page.space.look('top', true)")
    place = view.evaluate(
        """row => { const k = page.places.numbers.findIndex((n) => page.scene.findings[n].row === row);
        page.space.drawNow();
        const v = new THREE.Vector3().fromArray(page.places.points, 3 * k);
        v.applyMatrix4(page.space.place.matrixWorld).project(page.space.camera);
        const box = page.space.canvas.getBoundingClientRect();
        return [box.left + (v.x + 1) / 2 * box.width, box.top + (1 - v.y) / 2 * box.height]; }""",
        row,
    )
    view.mouse.click(*place)
    assert view.evaluate("page.row") == row
    assert "gouge" in view.locator("#findings").inner_text()


def test_a_server_cuts_to_the_block_that_is_asked_for(slot: Path, view: Page, browser: Browser) -> None:
    program, given = write_slot(slot)
    content = prepare_view(program, **given)
    with served(content) as address, open_page(browser, address) as (page, errors):
        for row in (5, 3, 6, 0, content.scene["stock"]["rows"] - 1):
            for each in (page, view):
                each.evaluate("row => page.goToRow(row)", row)
            page.wait_for_function("rows => page.stock.shown === rows", arg=row + 1)
            ours, theirs = page.evaluate(SHAPE), view.evaluate(SHAPE)
            assert ours["count"] == theirs["count"]
            assert ours["volume"] == pytest.approx(theirs["volume"], abs=1e-6)
        page.locator("#stock").select_option("deviation")
        page.wait_for_function("() => page.stock.shown === page.stock.data.rows && page.stock.asked < 0")
        np.testing.assert_allclose(on_screen(page.evaluate(COLOUR, (12, 0, -5))), (217, 13, 26), atol=6)
        assert errors == []


@contextmanager
def served(content: ViewContent) -> Iterator[str]:
    """The address at which a view is served meanwhile."""
    listening = take_port("127.0.0.1", 0)
    host, port = listening.getsockname()
    server = uvicorn.Server(uvicorn.Config(view_application(content, Access((host,))), log_level="critical"))
    thread = threading.Thread(target=server.run, kwargs={"sockets": [listening]})
    thread.start()
    while not server.started:
        time.sleep(0.01)
    yield f"http://{host}:{port}/"
    server.should_exit = True
    thread.join()
    listening.close()


def test_what_belongs_to_stock_wants_stock(slot: Path) -> None:
    program, given = write_slot(slot)
    with pytest.raises(InputError, match="give stock as well"):
        write_view(program, machine=given["machine"], cell=1.0, output=slot / "none.html")
