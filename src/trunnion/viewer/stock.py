"""The stock of a view: as it is after each row, as messages for the browser, and how far it is from the design.

In:     the ``Simulation`` of the program that is shown.
Out:    what the page says of it, columns, and messages (``viewer/bricks.py``) for the page or on demand.
Units:  mm, workpiece frame.

A page holds some states, between which it shows the earlier one; the server cuts to the row that is asked for. What is
shown may be coarser than what was simulated: no picture has more than a bounded number of facets.
"""

import math
import threading
import zlib
from collections import OrderedDict
from collections.abc import Callable
from dataclasses import replace
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from trunnion.arrays import Floats, Ints
from trunnion.errors import InputError, argument_problem
from trunnion.messages import Wording
from trunnion.reporting.column_encoding import COMPRESSION_LEVEL
from trunnion.simulation.replay import Replay, changed_box
from trunnion.simulation.simulator import Simulation
from trunnion.simulation.stock.lattice import Lattice
from trunnion.simulation.stock.material import Tile
from trunnion.simulation.stock.solids import StockShape
from trunnion.simulation.stock.surface import surface_grid
from trunnion.simulation.stock.surface_points import SurfacePoints, surface_points
from trunnion.simulation.stock.vertex_deviation import vertex_deviation
from trunnion.viewer.bricks import BrickFrame, BrickRange, brick_frame, brick_values, changed_frame, message

#: Cubes that the surface of the stock's box may pass, in a picture.
_MOST_CUBES: Final = 400_000

#: States that a page holds besides the first, at most, and the bytes that they take there, packed: 4 MB in base64.
_STATES: Final = 24
_PAGE_BYTES: Final = 3_000_000

#: Surfaces that the server remembers, so that it sends what has changed only.
_REMEMBERED: Final = 6

#: Cells beyond bricks that are taken along where only some are made anew: cells that touch along edges are filled, and
#: that may ask for others beside them.
_BEYOND: Final = 6

#: Part of the stock's box from which on all of it is made anew.
_MOST_ANEW: Final = 0.6

#: Deviations are told in this part of what is not told at all.
_PART_OF_LIMIT: Final = 16.0


class StockView:
    """The stock of a view.

    simulation  of one program
    narrowest   diameter of the narrowest tool that cuts, mm

    Raises
    ------
    InputError
        If no picture can show it.
    """

    def __init__(self, simulation: Simulation, narrowest: float) -> None:
        (job,) = simulation.programs
        self._simulation, self._job = simulation, job
        setup = simulation.model
        cell = max(setup.cell, _picture_cell(setup.stock, narrowest))
        self._lattice = Lattice.of_box(setup.stock.low, setup.stock.high, cell)
        self._replay = Replay(replace(setup, cell=cell), job, simulation.stock if cell == setup.cell else None)
        self._frames: OrderedDict[int, BrickFrame] = OrderedDict()
        self._working, self._newest = threading.Lock(), 0
        self._packed = b""
        self._last: tuple[BrickFrame, tuple[Tile, ...]] | None = None
        self._finished = self._points()
        self._removed = np.zeros(len(job.run))
        for one in simulation.operations:
            self._removed[one.first : one.end] = one.removed
        self._unit = setup.limit / _PART_OF_LIMIT

    @property
    def rows(self) -> int:
        """Rows that were cut."""
        return self._job.end

    def scene(self) -> dict[str, Any]:
        """Return what the page says of it, and what its messages count in."""
        lattice, setup = self._lattice, self._simulation.model
        found: dict[str, Any] = {
            "low": lattice.low.tolist(), "cell": lattice.cell.tolist(), "counts": list(lattice.counts),
            "rows": self.rows, "simulated": setup.cell, "deviation": None,
        }  # fmt: skip
        if self._finished.deviation is not None:
            found["deviation"] = {"unit": self._unit, "limit": setup.limit}
        return found

    def columns(self) -> dict[str, NDArray[np.float32] | NDArray[np.int32]]:
        """Return what each row takes away, mm³; deviations in units of ``scene``: of the vertices of the finished
        stock, and
        the worst that each row has left.
        """
        if self._finished.deviation is None:
            return {"removed": self._removed.astype(np.float32)}
        self._replay.go_to(self.rows)
        grid = surface_grid(self._replay.stock)
        off = vertex_deviation(self._finished, grid.vertices, self._lattice)
        return {
            "removed": self._removed.astype(np.float32),
            "stock-deviation": self._counted(brick_values(grid, off)),
            "row-deviation": self._counted(_worst_of_rows(self._finished, len(self._job.run))),
        }

    @property
    def page_states(self) -> list[int]:
        """Rows after which a page has the stock: evenly among those that took something, the start and the end."""
        return _spread(np.flatnonzero(self._removed), self.rows)

    def packed(self, tell: Callable[[int], None] = lambda _: None) -> bytes:
        """States for a page, deflated: as many as find room, each as a message that changes the one before it.

        ``tell`` is called with 1 for each of ``page_states``; what has been packed once is kept.
        """
        if not self._packed:
            frames = []
            for rows in self.page_states:
                frames.append(self._frame(rows))
                tell(1)
            self._packed = _packed(frames)
        return self._packed

    def answer(self, rows: int, before: int) -> bytes | None:
        """Return what makes the stock after some rows of that after others, which the browser has.

        None: a later question has come, or there are no such rows. It is called by many threads.
        """
        if not 0 <= rows <= self.rows:
            return None
        self._newest += 1
        number = self._newest
        with self._working:
            if not self._replay.go_to(rows, lambda: self._newest == number) or self._newest != number:
                return None
            known = self._frames.get(before)
            return message(self._frame(rows), known)

    def leave(self) -> None:
        """End what is being answered: nobody waits for it any more."""
        self._newest += 1

    def _frame(self, rows: int) -> BrickFrame:
        """Return the surface after some rows."""
        if rows not in self._frames:
            self._replay.go_to(rows)
            self._frames[rows] = self._made(rows)
            while len(self._frames) > _REMEMBERED:
                self._frames.popitem(last=False)
        self._frames.move_to_end(rows)
        return self._frames[rows]

    def _made(self, rows: int) -> BrickFrame:
        """Return the surface of the present stock: of the last one what is the same, and the rest anew."""
        cell, counts, stock = self._lattice.cell, self._lattice.counts, self._replay.stock
        before, tiles = self._last if self._last is not None else (None, ())
        state = self._replay.state(tiles)
        box = changed_box(tiles, state) if before is not None else None
        if before is not None and box is None:
            frame = BrickFrame(rows, before.bricks)
        else:
            own = BrickRange.whole(counts)
            if box is not None:
                low, high = np.floor((box - self._lattice.low) / cell).astype(np.int64)
                own = BrickRange.around(low, high, counts)
            first, end = own.cells(_BEYOND, counts)
            if before is None or int((end - first).prod()) > _MOST_ANEW * math.prod(counts):
                frame = brick_frame(surface_grid(stock), cell, rows)
            else:
                frame = changed_frame(before, surface_grid(stock.part(first, end)), cell, rows, own, first)
        self._last = (frame, state)
        return frame

    def _points(self) -> SurfacePoints:
        part, stock = self._simulation.model.part, self._simulation.stock
        lattice = stock.lattice
        design = None if part is None else (part.spans(lattice, 0), part.spans(lattice, 1), part.spans(lattice, 2))
        return surface_points(stock, design)

    def _counted(self, off: Floats) -> NDArray[np.int32]:
        return np.round(off / self._unit).astype(np.int32)


def _picture_cell(shape: StockShape, narrowest: float) -> float:
    """Return the finest cell in which a stock is shown, mm."""
    x, y, z = shape.high - shape.low
    finest = math.sqrt(2.0 * float(x * y + y * z + z * x) / _MOST_CUBES)
    if 0.5 * narrowest < finest:
        raise InputError(
            argument_problem("stock", Wording("PAG121", "too_large_shown", narrowest=narrowest, finest=finest))
        )
    return finest


def _spread(removing: Ints, rows: int) -> list[int]:
    steps = np.linspace(0, len(removing), _STATES)[1:].astype(np.int64)
    ends = removing[steps[steps > 0] - 1] + 1
    return sorted({0, rows, *ends.tolist()})


def _packed(frames: list[BrickFrame]) -> bytes:
    """Frames as messages, deflated; every second one goes while they take too much."""
    while True:
        found = zlib.compress(b"".join(map(_with_length, _messages(frames))), COMPRESSION_LEVEL)
        if len(found) <= _PAGE_BYTES or len(frames) <= 2:
            return found
        frames = [*frames[:-1:2], frames[-1]]


def _messages(frames: list[BrickFrame]) -> list[bytes]:
    return [message(frame, before) for before, frame in zip([None, *frames[:-1]], frames, strict=True)]


def _with_length(own: bytes) -> bytes:
    return len(own).to_bytes(4, "little") + own


def _worst_of_rows(points: SurfacePoints, rows: int) -> Floats:
    """Return the greatest deviation of the points that each row made, with its sign; 0 where it made none."""
    found = np.zeros(rows)
    if points.deviation is not None:
        own = np.flatnonzero((points.row >= 0) & (points.row < rows))
        own = own[np.argsort(np.abs(points.deviation[own]), kind="stable")]
        found[points.row[own]] = points.deviation[own]
    return found
