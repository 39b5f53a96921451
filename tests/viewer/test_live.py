"""The viewer follows a machine as it moves: what is shown is where the machine says that it is."""

import asyncio
import json
import os
import re
import subprocess
import sys
from collections.abc import AsyncIterator, Iterator
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import Browser

from tests.support.browser import browser as browser
from tests.support.browser import needs_browser, open_page
from tests.support.locations import ROOT
from tests.support.twins import BLADE_FINISH, served
from trunnion import load_machine
from trunnion.cli import main
from trunnion.jobs.view.live import machine_content
from trunnion.machines import forward
from trunnion.viewer.live import LivePose, LiveView
from trunnion.viewer.server import view_application
from trunnion.viewer.serving import Access


def events(count: int, poses: list[LivePose | None]) -> list[object]:
    """The first events that a page is sent of a machine."""

    class Told:
        async def poses(self) -> AsyncIterator[LivePose | None]:
            for pose in poses:
                yield pose
                await asyncio.sleep(0.1)

    async def run() -> list[object]:
        view = LiveView(Told())
        listening = asyncio.create_task(view.listen())
        found = []
        async for event in view.events():
            found.append(json.loads(event.removeprefix(b"data: ")))
            if len(found) == count:
                break
        await listening
        return found

    return asyncio.run(run())


def test_a_page_is_sent_each_pose_and_that_the_connection_is_broken() -> None:
    pose = LivePose((1.0, 2.0, 3.0, 4.0, 5.0), 7, 1)
    assert events(4, [pose, None, pose]) == [
        {"values": None}, {"values": [1.0, 2.0, 3.0, 4.0, 5.0], "line": 7, "file": 1}, {"values": None},
        {"values": [1.0, 2.0, 3.0, 4.0, 5.0], "line": 7, "file": 1},
    ]  # fmt: skip


def test_a_machine_that_misses_that_it_is_to_end_is_asked_again() -> None:
    class Deaf:
        async def poses(self) -> AsyncIterator[LivePose | None]:
            with suppress(asyncio.CancelledError):
                await asyncio.sleep(3600.0)
            yield None
            await asyncio.sleep(3600.0)

    async def run() -> None:
        application = view_application(machine_content("yl569", "yl569"), Access(("127.0.0.1",)), LiveView(Deaf()))
        async with application.router.lifespan_context(application):
            await asyncio.sleep(0.1)

    asyncio.run(run())


@pytest.fixture(scope="module")
def twin() -> Iterator[str]:
    with served(BLADE_FINISH, "--speed", "20", "--loop", "--no-mtconnect") as serving:
        yield serving.opcua


# A page that is open in the browser keeps a loop of its own: what needs one comes before.


def test_a_machine_that_is_not_there_is_an_error_of_input(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["view", "--live", "opc.tcp://127.0.0.1:1/", "--machine", "yl569", "--no-browser"]) == 2
    assert "cannot be connected to" in capsys.readouterr().err
    assert main(["view", "--machine", "yl569", "--no-browser"]) == 2
    assert "name a program" in capsys.readouterr().err


def test_axes_that_are_not_shown_are_named(twin: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    nodes = tmp_path / "mine.toml"
    nodes.write_text('[columns]\nX = { path = "CncInterface/CncAxisList/X/PosDirect/ActPos" }\n', encoding="utf-8")
    arguments = ["view", "--live", twin, "--machine", "yl569", "--nodes", str(nodes), "--no-browser"]
    assert main(arguments) == 2
    assert "does not show the axes C, B, Y, Z" in capsys.readouterr().err


PAGES = {
    "with its program": ([str(BLADE_FINISH), "--tool-length", "100"], 100.0),
    "alone": (["--tool-length", "100"], 100.0),
    "with its program and no length": ([str(BLADE_FINISH)], 0.0),
}


@pytest.fixture(
    scope="module",
    params=[name if name == "with its program" else pytest.param(name, marks=pytest.mark.nightly) for name in PAGES],
)
def serving(twin: str, request: pytest.FixtureRequest) -> Iterator[tuple[subprocess.Popen[str], str, float]]:
    arguments, length = PAGES[request.param]
    command = [sys.executable, "-m", "trunnion", "view", *arguments, "--live", twin, "--machine", "yl569"]
    command += ["--no-browser"]
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "src")}
    process = subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment, encoding="utf-8"
    )
    try:
        assert process.stdout is not None
        address = process.stdout.readline().strip()
        assert re.match(r"http://127\.0\.0\.1:\d+/", address), process.communicate()
        yield process, address, length
    finally:
        process.terminate()
        process.communicate()


@needs_browser
def test_the_pose_that_is_shown_is_that_of_the_machine(
    serving: tuple[subprocess.Popen[str], str, float], browser: Browser
) -> None:
    machine = load_machine("yl569")
    process, page_address, length = serving
    with open_page(browser, page_address) as (page, errors):
        page.wait_for_function("() => page.space.values.some(value => value !== 0)")
        shown = page.evaluate(
            """async () => { const found = [], places = new Set();
            while (found.length < 12 || places.size < 5) {
              places.add(page.space.values.join());
              const { tip, axis } = page.space.shownTool();
              found.push([...page.space.values, ...tip, ...axis]);
              await new Promise(done => setTimeout(done, 60)); }
            return found; }"""
        )
        assert errors == []
        rows = np.array(shown)
        for row in rows:
            tip, axis = forward(machine, row[None, :5], tool_length=length)
            np.testing.assert_allclose(row[5:8], tip[0], atol=1e-4)
            np.testing.assert_allclose(row[8:11], axis[0], atol=1e-6)
        assert len(np.unique(rows[:, :5], axis=0)) > 3
        page.locator("#live").uncheck()
        page.wait_for_timeout(100)
        first = page.evaluate("page.space.values")
        page.wait_for_timeout(200)
        assert page.evaluate("page.space.values") == first
        assert page.locator("#live-state").inner_text() == ""
        page.locator("#live").check()
        page.wait_for_function(f"() => page.space.values.join() !== '{','.join(map(str, first))}'")
        assert len(set(page.evaluate("[page.time, page.curves.cursor, page.program.timeOf(page.row)]"))) == 1
        process.terminate()
        process.wait()
        page.locator("body.gone").wait_for()
        assert page.locator("#live-state").inner_text() == "The machine is not connected."
        assert float(page.locator("#values").evaluate("it => getComputedStyle(it).opacity")) < 0.5
