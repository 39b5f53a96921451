"""A machine, or a twin, as it moves, for the viewer."""

import asyncio
import math
import tempfile
from collections.abc import AsyncGenerator, Callable, Iterable
from dataclasses import replace
from pathlib import Path, PurePath
from typing import TYPE_CHECKING, Any

from trunnion.errors import InputError, Problem
from trunnion.jobs.inputs.reading import MachineLike, as_machine
from trunnion.jobs.view.viewing import prepare_view
from trunnion.messages import Wording
from trunnion.model.recording import LINE, PROGRAM, Mark
from trunnion.viewer.content import ViewContent
from trunnion.viewer.live import LivePose

if TYPE_CHECKING:
    from trunnion.twin.recording.feed import MachineFeed


class LiveMachine:
    """A machine that a page shows as it moves.

    Parameters
    ----------
    make
        Makes a connection to it (``trunnion.jobs.twin.recording.machine_feed``).
    machine
        Its definition: the axes that are listened to.
    files
        Of the program that the page shows.
    """

    def __init__(self, make: Callable[[], "MachineFeed"], machine: MachineLike, files: Iterable[str] = ()) -> None:
        self._make, self._machine = make, as_machine(machine)
        self._files = {PurePath(name).name: k for k, name in reversed(list(enumerate(files)))}

    def check(self) -> None:
        """Connect once, to find out that the machine is there and shows its axes.

        Raises ``InputError`` if it cannot be connected to, or does not show all axes.
        """

        async def connect() -> None:
            feed = self._make()
            await feed.open()
            await feed.close()
            missing = [name for name in self._machine.names if name not in feed.names]
            if missing:
                raise InputError(
                    Problem(
                        "the machine",
                        0,
                        Wording("TWN231", "axes_not_shown", axes=tuple(missing), machine=self._machine.key),
                    )
                )

        asyncio.run(connect())

    async def poses(self) -> AsyncGenerator[LivePose | None, None]:
        """Its poses without end; None: the connection is broken."""
        while True:
            feed = self._make()
            try:
                await feed.open()
            except InputError:
                yield None
                await asyncio.sleep(1.0)
                continue
            try:
                async for rows in feed.rows():
                    for row in rows[-1:]:
                        shown = dict(zip(feed.names, row.values, strict=True))
                        if Mark.GAP in row.marks:
                            yield None
                        elif (pose := self._pose(shown)) is not None:
                            yield pose
            finally:
                await feed.close()

    def _pose(self, shown: dict[str, Any]) -> LivePose | None:
        """Return what is shown as a pose; None where an axis is not known."""
        found = [shown.get(name) for name in self._machine.names]
        values = [value for value in found if isinstance(value, float) and math.isfinite(value)]
        if len(values) < len(found):
            return None
        line = shown.get(LINE)
        file = self._files.get(PurePath(str(shown.get(PROGRAM) or "")).name, 0)
        return LivePose(tuple(values), int(line) if isinstance(line, float) and 0.0 < line < 2**31 else 0, file)


def machine_content(machine: MachineLike, title: str, **given: Any) -> ViewContent:
    """Return what a page shows of a machine without a program; arguments as ``prepare_view`` has them.

    Raises ``InputError`` when a file or an argument cannot be used.
    """
    named = as_machine(machine)
    with tempfile.TemporaryDirectory() as folder:
        nothing = Path(folder) / "no program"  # a control that has been given a blank line
        nothing.write_bytes(b"\n")
        content = prepare_view(nothing, machine=named, **given)
    scene = {**content.scene, "title": title, "files": [""], "findings": [], "checks": []}
    scene |= {"standing": "", "verdict": "", "stands": []}
    return replace(content, scene=scene)
