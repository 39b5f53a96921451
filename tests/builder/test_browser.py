"""The builder in a real browser: from nothing to a saved machine whose program is proven."""

import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import uvicorn
from playwright.sync_api import Browser, Locator, Page, Route

from tests.support.browser import browser as browser
from tests.support.browser import needs_browser, open_page
from tests.support.pictures import check_picture
from trunnion import load_machine, post
from trunnion.builder.likeness import definition_like
from trunnion.builder.sample import shipped_sample
from trunnion.builder.server import builder_application
from trunnion.builder.session import BuilderSession
from trunnion.jobs.inputs.stated_setup import set_up_machine
from trunnion.machines import forward
from trunnion.viewer.serving import Access, take_port

pytestmark = needs_browser


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("builder")


@pytest.fixture
def address(folder: Path) -> Iterator[str]:
    listening = take_port("127.0.0.1", 0)
    application = builder_application(BuilderSession(folder), Access(("127.0.0.1",)))
    server = uvicorn.Server(uvicorn.Config(application, log_level="critical"))
    thread = threading.Thread(target=server.run, kwargs={"sockets": [listening]})
    thread.start()
    while not server.started:
        time.sleep(0.01)
    yield f"http://127.0.0.1:{listening.getsockname()[1]}/"
    server.should_exit = True
    thread.join()
    listening.close()


@pytest.fixture
def page(address: str, browser: Browser) -> Iterator[Page]:
    with open_page(browser, address, (1440, 900)) as (page, errors):
        yield page
        assert errors == []


def wait(page: Page, what: str) -> None:
    """Wait until an expression is true."""
    page.wait_for_function(f"() => {what}")


def begin(page: Page, base: str = "", chain: str = "", control: str = "sinumerik_840d") -> None:
    page.locator("#begin-name").fill("Hall 2")
    if base:
        page.locator("#begin-base").select_option(base)
    else:
        page.locator("input[value=chain]").check()
        page.locator("#begin-chain").select_option(chain)
        page.locator("#begin-control").select_option(control)
    page.locator("#begin-go").click()
    wait(page, "builder.data && builder.edits.isIdle && document.getElementById('program').dataset.ready === 'true'")


def enter(page: Page, path: str, *values: str) -> None:
    """Type values into a field, and wait until the definition has been judged with them."""
    row = page.locator(f".field[data-path='{path}']")
    for k, value in enumerate(values):
        box = row.locator(".inputs > *").nth(k)
        if box.input_value() == value:
            continue
        box.fill(value)
        page.keyboard.press("Tab")
        wait(page, "builder.edits.isIdle")


def test_a_machine_is_built_from_nothing_and_saved(page: Page, folder: Path) -> None:
    begin(page, chain="head_table_bc", control="heidenhain_tnc640")
    assert page.locator("#verdict").inner_text().startswith("Passed in part: ")
    page.locator("[data-page=travels]").click()
    enter(page, '["axis",["X"],"limits_mm"]', "-410.5", "390")
    page.locator("[data-page=rotary]").click()
    enter(page, '["axis",["B"],"point_mm"]', "0", "0", "212.75")
    page.locator("[data-page=spindle]").click()
    enter(page, '["spindle","max_rpm"]', "18000")
    wait(page, "document.getElementById('program').dataset.ready === 'true'")
    assert page.locator("#verdict").inner_text().startswith("Passed in part: ")
    page.keyboard.press("Control+s")
    page.locator("#save-name").fill("hall2.toml")
    page.locator("#save-go").click()
    page.locator("#state:has-text('Saved as')").wait_for()
    machine = load_machine(folder / "hall2.toml")
    x = next(axis for axis in machine.axes if axis.name == "X")
    assert (x.low, x.high, machine.spindle_max_rpm) == (-410.5, 390.0, 18000.0)
    (folder / "sample.cls").write_bytes(shipped_sample())
    assert post(folder / "sample.cls", machine=folder / "hall2.toml").passed
    saved = (folder / "hall2.toml").read_text(encoding="utf-8")
    page.reload()
    page.wait_for_selector("html[data-ready=true]", state="attached")
    assert page.locator("#text").input_value() == saved
    assert page.locator("#title").inner_text() == "hall2.toml"
    assert page.locator("#mistakes").inner_text().startswith("no mistakes, 2 values")


@pytest.mark.nightly
def test_a_page_made_large_scrolls_down_only(page: Page) -> None:
    """WCAG 1.4.10, at 200 and 400 %: nothing is cut off, and no part is squeezed to nothing."""
    begin(page, base="yl569")
    for width, height in ((640, 450), (320, 256)):
        page.set_viewport_size({"width": width, "height": height})
        assert page.evaluate("document.documentElement.scrollWidth") <= width
        for part in ("#form", "#text", "#space", "#program"):
            box = page.locator(part).bounding_box()
            assert box is not None
            assert box["width"] >= 0.8 * width
            assert box["height"] >= 80


def test_a_bad_value_is_told_at_its_field_and_its_line(page: Page) -> None:
    begin(page, base="yl569")
    page.locator("[data-page=rotary]").click()
    enter(page, '["axis",["B"],"limits_deg"]', "5", "-5")
    row = page.locator('.field[data-path=\'["axis",["B"],"limits_deg"]\']')
    assert "low < high" in row.locator(".error").inner_text()
    assert row.locator("input").first.get_attribute("aria-invalid") == "true"
    lines = page.locator("#text").input_value().split("\n")
    assert page.locator("#gutter .wrong").inner_text() == str(lines.index("limits_deg = [5, -5]") + 1)
    assert "bad" in (page.locator("[data-page=rotary]").get_attribute("class") or "")
    assert "waits" in page.locator("#verdict").inner_text()
    enter(page, '["axis",["C"],"point_mm"]', "1,5")
    page.locator("[data-page=head]").click()
    page.locator("#problems button").first.click()
    assert page.locator("[data-page=rotary]").get_attribute("aria-current") == "page"
    row.locator(".reset").click()
    wait(page, "builder.data.problems.length === 1")


def test_text_and_fields_are_one_definition(page: Page) -> None:
    begin(page, base="dmu65")
    page.locator("#text").fill('# ours\nextends = "dmu65"\nname = "Typed"\n\n[spindle]\nmax_rpm = 7777 # plate\n')
    wait(page, "builder.data.text.includes('7777')")
    page.locator("[data-page=spindle]").click()
    box = page.locator('.field[data-path=\'["spindle","max_rpm"]\'] input')
    assert box.input_value() == "7777"
    enter(page, '["spindle","max_rpm"]', "8888")
    assert page.locator("#text").input_value().endswith("[spindle]\nmax_rpm = 8888 # plate\n")
    box.focus()
    assert page.locator("#gutter .here").inner_text() == "6"


class Held:
    """Requests of a page that are answered when the test says so."""

    def __init__(self, page: Page, what: str) -> None:
        self.page, self.routes = page, list[Route]()
        page.route(f"**/{what}", lambda route: self.routes.append(route))

    def answer(self) -> None:
        """Wait for the next request, let the server answer it, and wait until the page has the answer."""
        while not self.routes:
            self.page.wait_for_timeout(10)
        route = self.routes.pop(0)
        with self.page.expect_response(lambda response: response.request == route.request) as answered:
            route.continue_()
        answered.value.finished()
        self.page.evaluate("new Promise((done) => setTimeout(done))")

    def answer_all(self) -> None:
        """Answer until the page has no more to ask."""
        while not self.page.evaluate("builder.edits.isIdle"):
            if self.routes:
                self.answer()
            self.page.wait_for_timeout(10)


def box_of(page: Page, path: str, number: int = 0) -> Locator:
    return page.locator(f".field[data-path='{path}'] .inputs > *").nth(number)


def test_fields_filled_faster_than_they_are_judged_are_all_written(page: Page) -> None:
    """The answer to one field comes while the next is being typed; a last change is saved although it is on its way."""
    begin(page, base="yl569")
    page.locator("[data-page=spindle]").click()
    held = Held(page, "change")
    box_of(page, '["spindle","min_rpm"]').click()
    page.keyboard.type("200", delay=20)
    page.keyboard.press("Tab")
    box_of(page, '["spindle","max_rpm"]').focus()
    page.keyboard.press("Control+a")
    page.keyboard.type("18", delay=20)
    held.answer()
    wait(page, "builder.data.text.includes('min_rpm = 200')")
    page.keyboard.type("000", delay=20)
    for path, value in (("power_kw", "31"), ("torque_nm", "90")):
        box_of(page, f'["spindle","{path}"]').focus()
        page.keyboard.press("Control+a")
        page.keyboard.type(value)
    page.keyboard.press("Control+s")
    page.locator("#save-name").fill("fast.toml")
    page.keyboard.press("Enter")
    held.answer_all()
    page.locator("#state:has-text('Saved as')").wait_for()
    saved = page.locator("#text").input_value()
    assert "[spindle]\nmax_rpm = 18000\nmin_rpm = 200\npower_kw = 31\ntorque_nm = 90\n" in saved
    page.unroute_all()
    page.reload()
    page.wait_for_selector("html[data-ready=true]", state="attached")
    assert page.locator("#text").input_value() == saved


@pytest.mark.nightly
def test_a_field_being_typed_outlives_new_rows_and_another_page(page: Page) -> None:
    begin(page, chain="table_table_bc")
    held = Held(page, "change")
    box_of(page, '["axis",["X"],"direction"]', 0).fill("2")
    box_of(page, '["description"]').focus()
    page.keyboard.type("hall")
    held.answer()
    wait(page, "builder.data.text.includes('[2, 0, 0]')")
    page.keyboard.type(" two")
    page.locator("[data-page=spindle]").click()
    page.locator("[data-page=structure]").click()
    assert box_of(page, '["description"]').input_value() == "hall two"
    held.answer_all()
    assert 'description = "hall two"' in page.locator("#text").input_value()
    page.locator("button[title^='X: One place towards the tool']").press("Enter")
    held.answer_all()
    assert page.evaluate("document.activeElement.dataset.key") == "X 1"


@pytest.mark.nightly
def test_typing_in_the_text_loses_no_letter(page: Page) -> None:
    """Each answer comes while the next letters are typed; a change of a field meanwhile is made in the typed text."""
    begin(page, base="yl569")
    judged, changed = Held(page, "judge"), Held(page, "change")
    area = page.locator("#text")
    area.evaluate("(area) => { area.focus(); area.setSelectionRange(area.value.length, area.value.length); }")
    for word in ("# one", " two", " three"):
        page.keyboard.type(word)
        while not judged.routes:
            page.wait_for_timeout(10)
        page.keyboard.type("!")
        judged.answer()
    judged.answer_all()
    assert area.input_value().endswith("# one! two! three!")
    page.locator("[data-page=spindle]").click()
    box_of(page, '["spindle","min_rpm"]').fill("200")
    area.focus()
    page.keyboard.type("?")
    changed.answer()
    changed.answer_all()
    text = area.input_value()
    assert "min_rpm = 200" in text
    begun = definition_like(load_machine("yl569"), "Hall 2")
    assert sorted(text.replace("min_rpm = 200\n", "").replace("\n", "")) == sorted(
        begun.replace("\n", "") + "# one! two! three!?"
    )


def test_enter_saves_and_a_new_machine_is_another_file(page: Page, folder: Path, address: str) -> None:
    """Enter is what the button of the dialog is; New never leads to writing over the file that was open."""
    page.locator("#begin-name").fill("Hall 3")
    page.locator("#begin-base").select_option("yl569")
    page.locator("#begin-name").press("Enter")
    wait(page, "builder.data && builder.edits.isIdle")
    page.keyboard.press("Control+s")
    page.locator("#save-name").fill("hall3.toml")
    page.keyboard.press("Enter")
    page.locator("#state:has-text('Saved as')").wait_for()
    first = (folder / "hall3.toml").read_text(encoding="utf-8")
    page.locator("#start").click()
    assert page.locator("#begin-why").inner_text() == ""
    begin(page, base="dmu65")
    assert page.locator("#title").inner_text() == "machine.toml"
    page.locator("#start").click()
    assert "not been saved" in page.locator("#begin-why").inner_text()
    page.keyboard.press("Escape")
    page.keyboard.press("Control+s")
    page.locator("#save-name").fill("hall3.toml")
    page.keyboard.press("Control+s")
    page.locator("#save-why:has-text('There is a file')").wait_for()
    assert (folder / "hall3.toml").read_text(encoding="utf-8") == first
    page.locator("#save-name").fill("hall4.toml")
    page.keyboard.press("Enter")
    page.locator("#state:has-text('Saved as')").wait_for()
    page.goto(f"{address}?file=hall3.toml")
    page.wait_for_selector("html[data-ready=true]", state="attached")
    assert page.locator("#text").input_value() == first


def test_what_is_refused_is_not_shown_as_proven(page: Page) -> None:
    begin(page, base="yl569")
    verdict = page.locator("#verdict").inner_text()
    assert "not checked: travel: " in verdict, verdict
    assert "tip: " in page.locator("#checks").inner_text()
    page.locator("[data-page=spindle]").click()
    enter(page, '["spindle","max_rpm"]', "5999")
    wait(page, "document.getElementById('program').dataset.ready === 'true'")
    assert page.locator("#verdict").inner_text().startswith("The sample is refused")
    assert "6000" in page.locator("#verdict").inner_text()
    assert page.locator("#program div").count() == 0
    assert not page.locator("#checks").is_visible()


def test_a_change_of_a_field_can_be_undone_in_the_text(page: Page) -> None:
    begin(page, base="yl569")
    text = page.locator("#text")
    first = text.input_value()
    page.locator("[data-page=spindle]").click()
    enter(page, '["spindle","min_rpm"]', "200")
    second = text.input_value()
    text.focus()
    text.press("Control+End")
    page.keyboard.type("# x")
    for _ in range(4):
        if text.input_value() != second:
            page.keyboard.press("Control+z")
    assert text.input_value() == second
    page.keyboard.press("Control+z")
    assert text.input_value() == first
    wait(page, "builder.edits.isIdle")
    assert box_of(page, '["spindle","min_rpm"]').input_value() == ""
    page.keyboard.press("Control+y")
    wait(page, "builder.edits.isIdle")
    assert (text.input_value(), box_of(page, '["spindle","min_rpm"]').input_value()) == (second, "200")


@pytest.mark.nightly
def test_jog_boxes_keep_what_is_typed_and_show_what_is_wrong(page: Page) -> None:
    begin(page, base="yl569")
    box = page.locator("#jog label:has-text('X') input[type=text]")
    for typed, shown, wrong in (("12.5", "12.50", "false"), ("9999", "9999.00", "true"), ("1,5", "1,5", "true")):
        box.fill(typed)
        page.keyboard.press("Tab")
        assert (box.input_value(), box.get_attribute("aria-invalid")) == (shown, wrong)
    box.fill("3")
    page.locator("#text").evaluate("(area) => { area.focus(); area.setSelectionRange(0, 0); }")
    page.keyboard.type("x")
    wait(page, "builder.edits.isIdle && builder.data.problems.length")
    page.locator("#jog label:has-text('Y') input[type=text]").fill("4")
    page.keyboard.press("Tab")
    assert page.evaluate("builder.stage.values").count(4) == 1


def test_a_change_is_marked_in_the_sample(page: Page) -> None:
    begin(page, base="yl569")
    page.locator("[data-page=tool_change]").click()
    box = page.locator('.field[data-path=\'["control","templates","tool_change"]\'] textarea')
    box.fill(box.input_value() + ";clamps checked\n")
    page.keyboard.press("Tab")
    page.locator("#program .new").first.wait_for()
    assert page.locator("#program .new").all_inner_texts()[0].endswith(";clamps checked")


def test_jogging_shows_where_the_tool_is(page: Page, browser: Browser) -> None:
    begin(page, base="generic_nutated_b45_c")
    machine = load_machine("generic_nutated_b45_c")
    low = np.array([max(axis.low, -150.0) for axis in machine.axes])
    high = np.array([min(axis.high, 150.0) for axis in machine.axes])
    poses = np.random.default_rng(3).uniform(low, high, (20, 5))
    found: Any = page.evaluate(
        """poses => poses.map(values => { builder.jog(values);
        const { tip, axis } = builder.stage.tool(); return [tip, axis]; })""",
        poses.tolist(),
    )
    tip, axis = forward(set_up_machine(machine, None, 100.0), poses)
    np.testing.assert_allclose(np.array(found)[:, 0], tip, atol=1e-4)
    np.testing.assert_allclose(np.array(found)[:, 1], axis, atol=1e-6)


def test_it_looks_like_the_picture_of_the_docs(page: Page, browser: Browser) -> None:
    begin(page, base="yl569")
    page.locator("[data-page=rotary]").click()
    enter(page, '["axis",["B"],"limits_deg"]', "-5", "95")
    wait(page, "document.getElementById('program').dataset.ready === 'true'")
    page.evaluate("builder.jog([30, 40, 0, 0, 60])")
    page.wait_for_timeout(300)
    page.evaluate("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
    check_picture(browser, page.screenshot(), "builder.png")


@pytest.mark.nightly
def test_each_field_says_axis_part_and_unit_to_a_screen_reader(page: Page) -> None:
    begin(page, base="yl569")
    page.locator("[data-page=travels]").click()
    for name in ("X Travel lowest mm", "X Travel highest mm", "Y Travel lowest mm"):
        assert page.get_by_label(name, exact=True).count() == 1, name
    unnamed = "all => all.filter(each => !each.ariaLabel).map(each => each.id)"
    for each in ("structure", "travels", "rotary", "spindle", "home", "control"):
        page.locator(f"[data-page={each}]").click()
        boxes = page.locator(".field .inputs > *")
        assert boxes.count() > 0
        assert boxes.evaluate_all(unnamed) == []
        named = boxes.evaluate_all("all => all.map(each => each.ariaLabel)")
        assert len(set(named)) == len(named), [name for name in named if named.count(name) > 1]
