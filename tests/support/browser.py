"""A real browser without a screen, for pages."""

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page, sync_playwright

BROWSER = next((path for name in ("chromium", "chromium-browser", "google-chrome") if (path := shutil.which(name))), "")

needs_browser = pytest.mark.skipif(
    not BROWSER and not os.environ.get("CI"), reason="there is no Chromium (Debian package chromium)"
)

#: It draws without a graphics card, and asks nobody for anything.
_ARGUMENTS = [
    "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-quic",
    "--disable-background-networking", "--no-first-run",
]  # fmt: skip


#: Milliseconds that a page may take for what takes an instant where the computer is idle.
PATIENCE = 120_000


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with sync_playwright() as playwright:
        found = playwright.chromium.launch(executable_path=BROWSER, args=_ARGUMENTS)
        yield found
        found.close()


@contextmanager
def open_page(browser: Browser, address: str, size: tuple[int, int] = (1280, 800)) -> Iterator[tuple[Page, list[str]]]:
    """A page that is ready, and the errors that it has told so far."""
    errors: list[str] = []
    page = browser.new_page(viewport={"width": size[0], "height": size[1]}, locale="en-GB")
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.on("console", lambda message: errors.append(message.text) if message.type == "error" else None)
    page.set_default_timeout(PATIENCE)
    page.goto(address)
    page.wait_for_selector("html[data-ready=true]", state="attached")
    yield page, errors
    page.close()


def open_file(path: Path) -> str:
    """The address of a file."""
    return path.resolve().as_uri()
