"""The viewer in a browser without a graphics card: ``python benchmarks/viewer.py [BLOCKS]``.

A program of a million blocks is served, and opened in the system's Chromium, which draws on the processor. Then one of
a tenth of that is written as a page and opened from disk. Prints seconds until a page is ready, memory of its scripts,
pictures a second while the cursor is dragged, the view is turned and the text scrolls, and the size of the page.
"""

import sys
import tempfile
import threading
import time
from pathlib import Path

import uvicorn
from playwright.sync_api import Page, ViewportSize, sync_playwright

import trunnion
from make_cls import write
from trunnion.jobs.view.viewing import prepare_view
from trunnion.viewer.server import view_application
from trunnion.viewer.serving import Access, take_port

BLOCKS = 1_000_000
MACHINE = "yl569"
SIZE: ViewportSize = {"width": 1280, "height": 720}
PICTURES = 60
ARGUMENTS = [
    "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
    "--disable-background-networking", "--enable-precise-memory-info",
]  # fmt: skip

#: What is done for each picture, ``share`` going from 0 to 1.
MOTIONS = {
    "dragging the cursor": "page.goTo(page.program.end * share)",
    "turning the view": "page.space.camera.position.applyAxisAngle({ x: 0, y: 0, z: 1 }, 0.02); page.space.draw()",
    "scrolling the text": "view.scrollTop = view.scrollHeight * share",
}


def pictures_per_second(page: Page, motion: str) -> float:
    """How many pictures the browser shows in a second while something moves."""
    seconds = page.evaluate(
        """async ([count, motion]) => {
          const view = document.getElementById("listing"), move = new Function("page", "view", "share", motion);
          page.space.hurry(true);
          const start = performance.now();
          for (let k = 0; k < count; k++) {
            move(page, view, k / count);
            await new Promise((done) => requestAnimationFrame(done));
          }
          page.space.hurry(false);
          return (performance.now() - start) / 1000;
        }""",
        [PICTURES, motion],
    )
    return PICTURES / float(seconds)


def open_view(page: Page, address: str) -> float:
    """Seconds until a page shows its first picture."""
    start = time.perf_counter()
    page.goto(address)
    page.wait_for_selector("html[data-ready=true]", state="attached", timeout=120_000)
    return time.perf_counter() - start


def post(blocks: int, folder: Path) -> Path:
    """Return a program of so many five-axis blocks."""
    cl_file, program = folder / f"{blocks}.cls", folder / f"{blocks}.mpf"
    with cl_file.open("w", encoding="ascii", newline="\n") as sink:
        write(blocks, sink)
    trunnion.post(cl_file, machine=MACHINE, output=program, columns=False)
    return program


def main() -> None:
    """Print the figures."""
    blocks = int(sys.argv[1]) if len(sys.argv) > 1 else BLOCKS
    with tempfile.TemporaryDirectory() as name, sync_playwright() as playwright:
        folder = Path(name)
        content = prepare_view(post(blocks, folder), machine=MACHINE)
        page_file = folder / "view.html"
        trunnion.write_view(post(blocks // 10, folder), machine=MACHINE, output=page_file)
        with take_port("127.0.0.1", 0) as listening:
            application = view_application(content, Access(("127.0.0.1",)))
            server = uvicorn.Server(uvicorn.Config(application, log_level="error"))
            thread = threading.Thread(target=server.run, kwargs={"sockets": [listening]})
            thread.start()
            while not server.started:
                time.sleep(0.01)
            # The page's policy forbids code out of texts, which the motions here are.
            browser = playwright.chromium.launch(executable_path="/usr/bin/chromium", args=ARGUMENTS)
            page = browser.new_context(viewport=SIZE, bypass_csp=True).new_page()
            seconds = open_view(page, f"http://127.0.0.1:{listening.getsockname()[1]}/")
            print(f"served, {blocks} blocks: ready after {seconds:.2f} s")
            memory = page.evaluate("performance.memory.usedJSHeapSize") / 1e6
            print(f"memory of its scripts: {memory:.0f} MB")
            for what, motion in MOTIONS.items():
                print(f"{what}: {pictures_per_second(page, motion):.0f} pictures/s")
            seconds = open_view(page, page_file.as_uri())
            size = page_file.stat().st_size / 1e6
            print(f"from disk, {blocks // 10} blocks: {size:.1f} MB, ready after {seconds:.2f} s")
            browser.close()
            server.should_exit = True
            thread.join()


if __name__ == "__main__":
    main()
