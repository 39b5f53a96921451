"""The viewer in a real browser: what is shown is where the machine is, and everything follows the cursor."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import Browser, Page

from tests.support.browser import browser as browser
from tests.support.browser import needs_browser, open_file, open_page
from tests.support.locations import GOLDEN
from tests.support.machines import five_axis_machines
from tests.support.pictures import check_picture
from trunnion import post, read_program, write_view
from trunnion.machines import forward

pytestmark = needs_browser

CL = GOLDEN / "yl569" / "3_blade_finish.cls"
TOOL = "2=ball:10,length=60,flutes=20,shank=10,holder=40x50"
ROWS = 200


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    file = tmp_path_factory.mktemp("view") / "view.html"
    write_view(
        CL.with_name("3_blade_finish.expected.mpf"), machine="yl569", cl=CL, tools=[TOOL], output=file,
        zero=(0.0, 0.0, -20.0), tool_length=110.0,
    )  # fmt: skip
    return file


@pytest.fixture(scope="module")
def view(file: Path, browser: Browser) -> Iterator[Page]:
    with open_page(browser, open_file(file)) as (page, errors):
        yield page
        assert errors == []


#: Two rotary axes in the table, one in the head, and two there.
EACH_CHAIN = ("dmu65", "yl569", "hs664rt", "generic_head_head_ca")


def shown(page: Page) -> str:
    """The text of the current line."""
    return str(page.locator("#listing .line.current").inner_text())


@pytest.mark.parametrize(
    "name",
    [name if name in EACH_CHAIN else pytest.param(name, marks=pytest.mark.nightly) for name in five_axis_machines()],
)
def test_the_pose_that_is_shown_is_that_of_the_forward_map(name: str, tmp_path: Path, browser: Browser) -> None:
    program = tmp_path / "program.nc"
    try:
        post(CL, machine=name, output=program)
    except Exception as error:
        pytest.skip(str(error))
    run = read_program(program, machine=name)
    write_view(program, machine=name, output=tmp_path / "view.html")
    rows = np.random.default_rng(5).permutation(np.flatnonzero(run.tcp & ~run.machine_frame))[:ROWS]
    tip, axis = forward(run.machine, run.joints[rows])
    with open_page(browser, open_file(tmp_path / "view.html")) as (page, errors):
        found = page.evaluate(
            """rows => rows.map(row => { page.goToRow(row); const { tip, axis } = page.space.shownTool();
            return [tip, axis, Array(3).fill(page.program.known[page.program.last[row]])]; })""",
            rows.tolist(),
        )
        assert errors == []
    poses = np.array(found)
    known = poses[:, 2, 0] == 1.0  # a tool that has been at a position of the machine is nowhere at the workpiece
    assert known.sum() > 0.9 * len(rows)
    tip, axis, poses = tip[known], axis[known], poses[known]
    np.testing.assert_allclose(poses[:, 0], tip, atol=1e-4)
    np.testing.assert_allclose(poses[:, 1], axis, atol=1e-6)


def test_a_line_leads_to_its_pose_and_a_pose_to_its_line(view: Page) -> None:
    view.evaluate("page.goToRow(0)")
    row = 60
    line = view.evaluate(f"page.program.line[{row}]")
    view.evaluate(f"page.listing.view.scrollTop = {18 * (line - 5)}")
    view.locator(f".line[data-line='{line}']").click()
    assert view.evaluate("page.row") == row
    place = view.evaluate(
        """row => { page.goToRow(10); page.space.shownTool();
        const p = page.space.tips.subarray(3 * (page.program.last[row] + 1));
        const v = new THREE.Vector3(p[0], p[1], p[2]).applyMatrix4(page.space.place.matrixWorld);
        page.space.controls.target.copy(v);
        page.space.camera.position.set(v.x, v.y - 0.001, v.z + 8);
        page.space.controls.update(); page.space.drawNow(); v.project(page.space.camera);
        const box = page.space.canvas.getBoundingClientRect();
        return [box.left + (v.x + 1) / 2 * box.width, box.top + (1 - v.y) / 2 * box.height]; }""",
        row,
    )
    view.mouse.click(*place)
    assert view.evaluate("page.row") == row
    assert shown(view).split()[0].startswith(str(line))


def test_the_statement_of_the_cl_file_stands_beside_its_block(view: Page) -> None:
    statements = CL.read_text(encoding="utf-8").splitlines()
    for row in (20, 60, 100):
        view.evaluate(f"page.goToRow({row})")
        line = view.evaluate(f"page.program.cl[{row}]")
        assert line > 0
        view.wait_for_function(
            "text => document.getElementById('cl').textContent.endsWith(text)", arg=statements[line - 1]
        )
        assert view.locator("#cl").inner_text() == f"CL line {line}: {statements[line - 1]}"


def test_play_moves_and_stops_at_the_end(view: Page) -> None:
    view.evaluate("page.goToRow(0); document.getElementById('speed').value = 1")
    view.locator("#play").click()
    view.wait_for_function("() => !page.playing")
    assert view.evaluate("page.time === page.program.end")
    assert view.locator("#play").get_attribute("aria-label") == "Play"


def test_keys_step_through_the_program(view: Page) -> None:
    view.evaluate("page.goToRow(20)")
    view.locator("#space").focus()
    for key, row in (("ArrowRight", 21), ("ArrowRight", 22), ("ArrowLeft", 21), ("Home", 0), ("ArrowLeft", 0)):
        view.keyboard.press(key)
        assert view.evaluate("page.row") == row
    for key, look in (("2", "top"), ("4", "right"), ("1", "iso")):
        view.keyboard.press(key)
        assert view.locator("#view").input_value() == look
    view.keyboard.press("?")
    assert view.locator("#keys").is_visible()
    view.keyboard.press("Escape")
    assert not view.locator("#keys").is_visible()


def test_values_have_units_and_a_place_within_a_motion_its_time(view: Page) -> None:
    texts = view.locator("#values dd").all_inner_texts()
    assert [text.split()[-1] for text in texts[:6]] == ["°", "°", "mm", "mm", "mm", "mm"]
    off = view.evaluate(
        """() => { const { program, space } = page, row = 60, piece = program.last[row];
        const time = (program.time[piece] + program.time[piece + 1]) / 2;
        const { tip } = space.toolOf(program.valuesAt(time), row);
        return Math.abs(program.timeNear(row, tip) - time) / (program.time[piece + 1] - program.time[piece]); }"""
    )
    assert off < 0.02


def test_controls_keep_their_own_keys(view: Page) -> None:
    view.evaluate("page.goToRow(20)")
    box = view.locator("#bodies")
    box.focus()
    view.keyboard.press(" ")
    assert not box.is_checked()
    view.keyboard.press(" ")
    assert box.is_checked()
    slider = view.locator("#speed")
    slider.focus()
    before = float(slider.input_value())
    view.keyboard.press("ArrowLeft")
    assert float(slider.input_value()) < before
    assert view.evaluate("page.row") == 20
    assert not view.evaluate("page.playing")


def test_colours_are_told(view: Page) -> None:
    view.locator("#colour").select_option("kind")
    assert view.locator("#legend .entry").all_inner_texts() == ["Rapid", "line", "circle", "Block"]
    view.locator("#colour").select_option("phase")
    assert "cut" in view.locator("#legend .entry").all_inner_texts()
    view.locator("#colour").select_option("feed")
    *_, fastest, rapid, block = view.locator("#legend .entry").all_inner_texts()
    grey = view.locator("#legend .entry").nth(-2).evaluate("it => getComputedStyle(it).borderLeftColor")
    assert (fastest.split()[-1], rapid, block, grey) == ("mm/min", "Rapid", "Block", "rgb(150, 160, 170)")
    view.locator("#colour").select_option("kind")


def test_the_curves_show_and_set_the_cursor(view: Page) -> None:
    box = view.locator("#curves").bounding_box()
    assert box is not None
    view.mouse.click(box["x"] + 76 + (box["width"] - 86) / 2, box["y"] + 40)
    assert view.evaluate("page.time / page.program.end") == pytest.approx(0.5, abs=0.01)
    assert float(view.locator("#scrub").input_value()) == pytest.approx(0.5, abs=0.01)


def test_the_curves_are_where_the_axes_are_in_the_middle_of_a_motion(view: Page) -> None:
    found = view.evaluate(
        """() => { const { program, curves } = page, axes = curves.strips.slice(0, 5);
        let worst = 0;
        for (let piece = 0; piece < program.pieces; piece++) {
          const middle = (program.time[piece] + program.time[piece + 1]) / 2, values = program.valuesAt(middle);
          if (program.time[piece + 1] > program.time[piece])
            axes.forEach((strip, k) => { worst = Math.max(worst, Math.abs(strip.at(piece, 0.5) - values[k])); });
        }
        return worst; }"""
    )
    assert found < 1e-6


@pytest.mark.parametrize("size", [(320, 256), (640, 450)], ids=["at 400 %", "at 200 %"])
def test_a_page_made_large_scrolls_down_only(size: tuple[int, int], view: Page) -> None:
    """WCAG 1.4.10: nothing is cut off, and no part is squeezed to nothing."""
    before = view.viewport_size
    assert before is not None
    view.set_viewport_size({"width": size[0], "height": size[1]})
    assert view.evaluate("document.documentElement.scrollWidth") <= size[0]
    for part in ("#space", "#curves", "#listing"):
        box = view.locator(part).bounding_box()
        assert box is not None
        assert box["width"] >= size[0] - 2
        assert box["height"] >= 200
    view.set_viewport_size(before)


def test_what_is_not_checked_is_folded_below_the_listing(view: Page) -> None:
    before = view.viewport_size
    assert before is not None
    view.set_viewport_size({"width": 1280, "height": 720})
    banner = view.locator("#basis")
    lines = "document.getElementById('listing').clientHeight / 18"
    assert view.locator("#standing").inner_text().startswith("Passed in part: ")
    assert banner.evaluate("it => parseFloat(getComputedStyle(it).paddingLeft)") >= 8
    assert not view.locator("#unchecked").is_visible()
    assert view.evaluate(lines) >= 10
    view.locator("#standing").focus()
    view.keyboard.press(" ")
    assert not view.evaluate("page.playing")
    assert "acceleration: not checked: no acceleration stated" in view.locator("#unchecked li").all_inner_texts()
    assert view.evaluate(lines) >= 8
    view.keyboard.press(" ")
    view.set_viewport_size(before)


def test_all_that_takes_the_focus_has_a_name(view: Page) -> None:
    assert view.get_by_role("img", name="3_blade_finish.expected.mpf", exact=True).get_attribute("id") == "space"
    assert view.get_by_role("img", name="3_blade_finish.expected.mpf Curves as CSV").get_attribute("id") == "curves"
    assert view.get_by_role("region", name="3_blade_finish.expected.mpf").get_attribute("id") == "listing"
    named = "each.ariaLabel || each.textContent.trim() || each.labels?.length"
    controls = view.locator("button, select, input")
    unnamed = controls.evaluate_all(f"all => all.filter(each => !({named})).map(each => each.id)")
    assert unnamed == []


def test_search_goes_round(view: Page) -> None:
    view.evaluate("page.goToRow(0)")
    view.locator("#search").fill("retract move")
    view.locator("#search").press("Enter")
    assert "Retract Move" in view.evaluate("page.listing.lineText(page.listing.current)")
    view.locator("#search").fill("no such word")
    view.locator("#search").press("Enter")
    assert view.locator("#status").inner_text() == "Not found"


def test_a_section_cuts_the_picture_open(view: Page) -> None:
    view.wait_for_function("() => !page.space.isMoving")
    view.evaluate("page.goToRow(20); page.space.look('iso')")
    # What earlier steps changed in the layout resizes the picture with the next frame of the screen only.
    view.evaluate("() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
    drawn = "(page.space.drawNow(), page.space.canvas.toDataURL())"
    view.evaluate(f"window.whole = {drawn}, 0")
    view.locator("#section").select_option("x")
    view.wait_for_function(f"() => {drawn} !== window.whole")
    view.locator("#section").select_option("")
    view.wait_for_function(f"() => {drawn} === window.whole")


def test_the_part_stands_still_in_its_own_frame(view: Page) -> None:
    view.locator("#frame").select_option("part")
    stands = "row => { page.goToRow(row); page.space.shownTool(); return page.space.place.matrixWorld.elements; }"
    first, second = (view.evaluate(stands, row) for row in (5, 90))
    np.testing.assert_allclose(first, second, atol=1e-9)
    view.locator("#frame").select_option("machine")
    first, second = (view.evaluate(stands, row) for row in (5, 90))
    assert np.abs(np.subtract(first, second)).max() > 1.0


def test_each_colouring_paints_each_segment(view: Page) -> None:
    for colour in ("phase", "operation", "tool", "feed", "rotary", "finding", "kind"):
        view.locator("#colour").select_option(colour)
        colours = view.evaluate("Array.from(page.space.colours)")
        assert len(colours) == 6 * view.evaluate("page.space.segments.length")
        assert max(colours) > 0


def test_a_finding_leads_to_its_line(tmp_path: Path, browser: Browser) -> None:
    program = tmp_path / "wrong.mpf"
    text = CL.with_name("3_blade_finish.expected.mpf").read_text(encoding="utf-8")
    wrong = text.replace("X35.72781", "X36.72781")
    assert wrong != text
    program.write_text(wrong, encoding="utf-8")
    write_view(program, machine="yl569", cl=CL, output=tmp_path / "view.html")
    with open_page(browser, open_file(tmp_path / "view.html")) as (page, errors):
        page.locator("#space").focus()
        page.keyboard.press("n")
        assert "X36.72781" in shown(page)
        page.locator("#findings button").first.click()
        assert "X36.72781" in shown(page)
        assert errors == []


ENDS = "end => document.querySelector('#listing .current')?.textContent.endsWith(end)"

LOOP = "G90 G54 G17 G710 G94\nG0 X0 Y0 Z50 B0 C0\nG91\nFOR R1=1 TO 5\nG1 X150 F1000\nENDFOR\nM30\n"


def test_a_finding_in_a_loop_leads_to_its_pass(tmp_path: Path, browser: Browser) -> None:
    (tmp_path / "loop.mpf").write_text(LOOP, encoding="utf-8")
    write_view(tmp_path / "loop.mpf", machine="yl569", output=tmp_path / "view.html")
    with open_page(browser, open_file(tmp_path / "view.html")) as (page, errors):
        page.locator("#findings button", has_text="X needs 750").click()
        assert page.evaluate("page.space.toolOf(page.program.valuesAfter(page.row), page.row).tip[0]") == pytest.approx(
            750.0
        )
        page.evaluate("page.goToRow(3); page.goToLine(5)")  # of the passes of a line, that of the cursor
        assert page.evaluate("page.row") == 3
        assert errors == []


@pytest.mark.parametrize(
    ("name", "machine", "text"),
    [
        (
            "part.nc", "matsuura_mx330",
            "%\nO1\nG90 G21 G54 G0 X0 Y0 Z50.\nM98 P1000\nG1 X20. F500\nM30\nO1000\nG1 Z40. F500\nM99\n%\n",
        ),
        (
            "part.ngc", "xyzac_trt",
            "o100 sub\nG1 Z40 F500\no100 endsub\nG90 G21 G54 G0 X0 Y0 Z50\no100 call\nG1 X20\nM2\n",
        ),
        (
            "part.h", "dmu65",
            "0 BEGIN PGM PART MM\n1 L X+0 Y+0 Z+50 R0 FMAX\n2 CALL LBL 1\n3 L X+20 F500\n4 M30\n5 LBL 1\n"
            "6 L Z+40 F500\n7 LBL 0\n8 END PGM PART MM\n",
        ),
    ],
    ids=["fanuc", "linuxcnc", "heidenhain"],
)  # fmt: skip
def test_a_line_leads_to_its_block_however_lines_are_called(
    name: str, machine: str, text: str, tmp_path: Path, browser: Browser
) -> None:
    (tmp_path / name).write_text(text, encoding="utf-8")
    write_view(tmp_path / name, machine=machine, output=tmp_path / "view.html")
    with open_page(browser, open_file(tmp_path / "view.html")) as (page, errors):
        for words, row in (("X20", 2), ("Z40", 1), ("Z50", 0)):
            line = next(k for k, each in enumerate(text.splitlines(), 1) if words in each.replace("+", ""))
            page.locator(f"#listing .line[data-line='{line}']").click()
            assert words in shown(page).replace("+", "")
            assert page.evaluate("page.row") == row
        assert errors == []


def test_a_finding_in_a_subprogram_is_shown_in_its_file(tmp_path: Path, browser: Browser) -> None:
    main, called = tmp_path / "MAIN.mpf", tmp_path / "L10.spf"
    main.write_text("G90 G54 G710 G94\nG0 X0 Y0 Z50 B0 C0\nG1 X2 F500\nL10\nG1 X1\nM30\n", encoding="utf-8")
    called.write_text("G1 Z49\nWRONGWORD\nG1 X9999\nM17\n", encoding="utf-8")
    write_view(main, machine="yl569", subprograms=[called], output=tmp_path / "view.html")
    with open_page(browser, open_file(tmp_path / "view.html")) as (page, errors):
        for words, line in (("WRONGWORD", "WRONGWORD"), ("X needs 9999", "G1 X9999")):
            page.evaluate("page.goToRow(0)")
            page.locator("#findings button", has_text=words).first.click()
            page.wait_for_function(
                "end => document.querySelector('#listing .current')?.textContent.endsWith(end)", arg=line
            )
            assert page.locator("#file option:checked").inner_text() == "L10.spf"
        assert errors == []


def test_a_program_without_motion_shows_its_text_and_its_findings(tmp_path: Path, browser: Browser) -> None:
    (tmp_path / "still.mpf").write_text("; nothing moves\nWRONGWORD\nM30\n", encoding="utf-8")
    write_view(tmp_path / "still.mpf", machine="yl569", output=tmp_path / "view.html")
    with open_page(browser, open_file(tmp_path / "view.html")) as (page, errors):
        assert page.locator("#listing .line").count() == 3
        page.locator("#findings button", has_text="WRONGWORD").first.click()
        assert shown(page).endswith("WRONGWORD")
        assert errors == []


def test_it_looks_like_the_picture_of_the_docs(file: Path, browser: Browser) -> None:
    with open_page(browser, open_file(file)) as (page, errors):
        page.wait_for_function("() => !page.space.isMoving")
        page.evaluate("page.goToRow(80); page.space.drawNow()")
        page.wait_for_function("() => page.listing.current === page.program.line[80]")
        check_picture(browser, page.screenshot(), "viewer.png")
        assert errors == []


def test_two_machines_go_along_one_tool_path(tmp_path: Path, browser: Browser) -> None:
    out = tmp_path / "view.html"
    write_view(CL, machine="yl569", against=CL, against_machine="generic_head_head_ca", output=out)
    with open_page(browser, open_file(out), (1440, 800)) as (page, errors):
        rows = page.evaluate("Array.from(page.twin.ones).filter((_, k) => k % 20 === 7)")
        assert len(rows) > 3
        poses = page.evaluate(
            """rows => rows.map(row => { page.goToRow(row); return [page.space, page.twin.space].map(space => {
            const { tip, axis } = space.shownTool(); return [tip, axis]; }); })""",
            rows,
        )
        found = np.array(poses)
        np.testing.assert_allclose(found[:, 0], found[:, 1], atol=2e-3)
        assert page.locator("#listing-b .line.current").count() == 1
        page.locator("#scrub").evaluate(
            "it => { it.value = 0.4; for (const kind of ['input', 'change']) it.dispatchEvent(new Event(kind)); }"
        )
        tips = page.evaluate("[page.space, page.twin.space].map(space => space.shownTool().tip)")
        assert np.linalg.norm(np.subtract(*tips)) < 1.0
        line = page.evaluate("page.twin.program.line[page.twin.twos[40]]")
        page.evaluate("line => page.twin.onLine(line)", line)
        assert page.evaluate("page.row === page.twin.ones[40] && page.twin.row === page.twin.twos[40]")
        page.wait_for_function("() => !page.space.isMoving && !page.twin.space.isMoving")
        check_picture(browser, page.screenshot(), "viewer-against.png")
        captions = [page.locator(f"#{name}").inner_text() for name in ("caption", "caption-b")]
        assert captions == ["3_blade_finish.mpf (Yalong YL569)", "3_blade_finish.mpf (Generic C-A fork head)"]
        assert errors == []


def test_what_two_programs_do_otherwise_is_marked_in_both(tmp_path: Path, browser: Browser) -> None:
    program, other, out = (tmp_path / name for name in ("one.mpf", "two.mpf", "view.html"))
    text = CL.with_name("3_blade_finish.expected.mpf").read_text(encoding="utf-8")
    program.write_text(text, encoding="utf-8")
    other.write_text(text.replace("X35.72781", "X36.72781"), encoding="utf-8")
    write_view(program, machine="yl569", against=other, output=out)
    with open_page(browser, open_file(out)) as (page, errors):
        page.locator("#space").focus()
        page.keyboard.press("n")
        assert "X35.72781" in shown(page)
        assert "X36.72781" in page.locator("#listing-b .line.current").inner_text()
        assert page.locator("#listing-b .line.finding").count() == 1
        assert errors == []


def test_rewinds_and_limits_are_shown(tmp_path: Path, browser: Browser) -> None:
    program, out = tmp_path / "turns.mpf", tmp_path / "view.html"
    program.write_text(
        "G54 G90 G0 X0 Y0 Z50\nTRAORI\nG0 A20 C0\nG1 X1 F500 C150\nX2 C300\nG0 Z80\nG0 C0\nG1 X3 F500\nTRAFOOF\nM30\n"
    )
    write_view(program, machine="generic_head_head_ca", zero=(0, 0, 0), tool_length=100, output=out)
    with open_page(browser, open_file(out)) as (page, errors):
        page.locator("#space").focus()
        page.keyboard.press("Home")
        page.keyboard.press("r")
        assert "C0" in shown(page)
        assert page.evaluate("page.row") > 4
        strip = page.evaluate("page.curves.strips.at(-1).name")
        assert strip == "limits"
        header, *lines = page.evaluate("page.curves.csv().trim().split('\\n')")
        assert header.startswith("seconds,line,X mm,Y mm,Z mm,C °,A °")
        assert header.split(",")[-5:] == [f"limits {axis} %" for axis in ("X", "Y", "Z", "C", "A")]
        rooms = {tuple(map(float, line.split(",")[-2:])) for line in lines if line.split(",")[1] in ("4", "5")}
        assert (round(100 * 60 / 720, 5), round(100 * 90 / 220, 5)) in rooms  # C300 of -360 to 360, A20 of -110 to 110
        assert errors == []


def test_the_path_has_the_colours_that_the_legend_tells(tmp_path: Path, browser: Browser) -> None:
    program, out = tmp_path / "frame.mpf", tmp_path / "view.html"
    lines = ["G54 G90 G17 G0 X0 Y0 Z5 S1000 M3", *(f"G1 X{k % 2 * 40} Y{k} F500" for k in range(40)), "G0 Z50", "M30"]
    program.write_text("\n".join(lines) + "\n", encoding="utf-8")
    write_view(program, machine="yl569", zero=(0, 0, 0), tool_length=100, output=out)
    with open_page(browser, open_file(out)) as (page, errors):
        page.locator("#bodies").uncheck()
        page.evaluate("page.goToRow(0); page.space.look('top', true)")
        legend = page.locator("#legend .entry").nth(1).evaluate("it => getComputedStyle(it).borderLeftColor")
        told = [int(part) for part in legend.removeprefix("rgb(").removesuffix(")").split(",")]
        nearest = page.evaluate(
            """told => { page.space.drawNow(); const gl = page.space.renderer.getContext();
            const [wide, high] = [gl.drawingBufferWidth, gl.drawingBufferHeight];
            const found = new Uint8Array(4 * wide * high);
            gl.readPixels(0, 0, wide, high, gl.RGBA, gl.UNSIGNED_BYTE, found);
            let least = 255;
            for (let i = 0; i < found.length; i += 4)
              least = Math.min(least, Math.max(...told.map((part, k) => Math.abs(found[i + k] - part))));
            return least; }""",
            told,
        )
        assert nearest <= 4
        assert errors == []


def test_rapids_are_drawn_in_dashes_and_cuts_in_one_line(view: Page) -> None:
    """Whoever does not see colours tells them by that; each row is drawn, however short."""
    rapids, cuts, missing = view.evaluate(
        """() => {
        const { program, space } = page, many = new Map(), rows = new Set();
        for (const piece of space.segments) {
            many.set(piece, (many.get(piece) ?? 0) + 1);
            rows.add(program.row[piece]);
        }
        const isRapid = (piece) => program.kind[program.row[piece]] === 0;
        const counts = (rapid) => [...many].filter(([it]) => isRapid(it) === rapid).map(([, count]) => count);
        const most = (rapid) => Math.max(...counts(rapid));
        const drawn = [...Array(program.pieces).keys()].filter((piece) => program.known[piece]);
        const known = new Set(drawn.map((piece) => program.row[piece]));
        return [most(true), most(false), [...known].filter((row) => !rows.has(row)).length];
        }"""
    )
    assert rapids > 3
    assert (cuts, missing) == (1, 0)
