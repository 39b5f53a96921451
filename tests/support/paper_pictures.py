"""Pictures of papers for the docs, as they are now: ``python -m tests.support.paper_pictures`` writes them anew."""

import tempfile
from contextlib import chdir
from pathlib import Path

from playwright.sync_api import Page, sync_playwright

import trunnion
from tests.support.browser import BROWSER
from tests.support.locations import YL569
from tests.support.pictures import PICTURES

#: Of a report only the first checks and plots are shown.
_EXCERPT = """for (const left of [
  "main > section:first-of-type tbody tr:nth-of-type(n+6)", "main > section:not(:first-of-type):not(.plots)",
]) document.querySelectorAll(left).forEach(it => it.remove())"""


def report(folder: Path, page: Page) -> None:
    """The report of a blade."""
    trunnion.post(
        YL569 / "3_blade_finish.cls", machine="yl569", output="3_blade_finish.mpf",
        report="report.html", settings={"zero": (0, 0, -100), "tool_length": 120},
    )  # fmt: skip
    page.set_viewport_size({"width": 1100, "height": 900})
    page.goto((folder / "report.html").as_uri())
    page.locator("#point:not(:has-text('Loading'))").wait_for()
    page.evaluate(_EXCERPT)
    page.screenshot(path=PICTURES / "report.png", full_page=True, clip={"x": 0, "y": 0, "width": 1100, "height": 1200})


def sheet(folder: Path, page: Page) -> None:
    """The first page of a setup sheet."""
    files = [YL569 / name for name in ("1_contour_rough.cls", "2_hub_rough.cls", "3_blade_finish.cls")]
    trunnion.post(
        files, machine="yl569", output="job.mpf",
        sheet="sheet.html", settings={"zero": (0, 0, -120), "tool_length": 120},
    )  # fmt: skip
    page.set_viewport_size({"width": 735, "height": 1040})
    page.goto((folder / "sheet.html").as_uri())
    page.screenshot(path=PICTURES / "sheet.png")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as place, chdir(place), sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=BROWSER, args=["--no-sandbox"])
        window = browser.new_page(locale="en")
        report(Path(place), window)
        sheet(Path(place), window)
        browser.close()
