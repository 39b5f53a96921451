"""The stock as it is after any row of a program: cut again from the nearest state that is kept.

In:     a set-up and a program that were simulated.
Out:    ``Stock``.
Units:  mm, workpiece frame.

A state that is kept shares with the one before it the tiles that nothing has cut in between. Where all of them take
more than their bound, every second one goes.
"""

import bisect
from collections.abc import Callable, Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trunnion.arrays import Floats
from trunnion.simulation.cutting.removal import CutRows, Cutter, measure
from trunnion.simulation.simulator import CuttingModel, SimulatedProgram, tool_pieces
from trunnion.simulation.stock.lattice import BUNDLE_AXES
from trunnion.simulation.stock.material import Stock, Tile
from trunnion.simulation.stock.solids import make_stock

#: States that are kept of a long program at first, and rows between those of a short one.
_STATES: Final = 64
_FEWEST_ROWS: Final = 50

#: More than any program has rows.
_ROWS: Final = 2.0**32

#: Bytes that they may take together.
_MOST_BYTES: Final = 300_000_000


class Replay:
    """The states of one stock that one program cuts.

    model     the solids and the accuracy
    program   the program
    finished  what it leaves, where that is known
    bound     bytes that the states may take
    """

    def __init__(
        self, model: CuttingModel, program: SimulatedProgram, finished: Stock | None = None, bound: int = _MOST_BYTES
    ) -> None:
        self._model, self._program, self._bound = model, program, bound
        self._pieces = tool_pieces(program, model)[0]
        self._stock = make_stock(model.stock, model.cell)
        self._done = 0
        self._step = max(_FEWEST_ROWS, program.end // _STATES)
        self._kept: dict[int, tuple[Tile, ...]] = {}
        self._keep()
        if finished is not None:
            self._kept[program.end] = tuple(map(_copy, finished.tiles))

    @property
    def done(self) -> int:
        """Rows after which the stock is as ``stock`` has it."""
        return self._done

    @property
    def stock(self) -> Stock:
        """The stock at present; the next ``go_to`` changes it."""
        return self._stock

    @property
    def kept(self) -> tuple[int, ...]:
        """Rows after which states are kept, in order."""
        return tuple(sorted(self._kept))

    def go_to(self, rows: int, go_on: Callable[[], bool] = lambda: True) -> bool:
        """Cut the first ``rows`` rows, or as many of the program as there are.

        ``go_on`` is asked now and then; where it says no, False is returned, and what was cut so far is kept.
        """
        rows = min(max(rows, 0), self._program.end)
        at = self.kept
        nearest = at[bisect.bisect_right(at, rows) - 1]
        if nearest > self._done or rows < self._done:
            self._stock = Stock(self._stock.lattice, tuple(map(_copy, self._kept[nearest])))
            self._done = nearest
        while self._done < rows:
            if not go_on():
                return False
            end = min(self._done - self._done % self._step + self._step, rows)
            cutter = Cutter(self._stock, None, self._model.tolerance)
            for chunk in measure(cutter, self._program.run, self._pieces, CutRows(self._done, end)):
                for _ in chunk.tiles:  # each is cut when it is taken
                    pass
            self._done = end
            if end % self._step == 0:
                self._keep()
        return True

    def state(self, before: Sequence[Tile] = ()) -> tuple[Tile, ...]:
        """Return the present tiles, which nothing will change; those of an earlier state where nothing has cut them
        since.
        """
        tiles = self._stock.tiles
        if not before:
            return tuple(map(_copy, tiles))
        return tuple(old if _is_same(old, tile) else _copy(tile) for old, tile in zip(before, tiles, strict=True))

    def _keep(self) -> None:
        """Keep the present state."""
        at = self.kept
        place = bisect.bisect_right(at, self._done) - 1
        self._kept[self._done] = self.state(self._kept[at[place]] if place >= 0 else ())
        while self._bytes() > self._bound and len(self._kept) > 2:
            self._step *= 2
            for row in self.kept[1::2]:
                del self._kept[row]

    def _bytes(self) -> int:
        """Return what all states take."""
        tiles = {id(tile): tile for state in self._kept.values() for tile in state}
        return sum(each.ends.nbytes + each.rows.nbytes + each.normals.nbytes for each in tiles.values())


def changed_box(before: Sequence[Tile], after: Sequence[Tile]) -> Floats | None:
    """Return the lowest and the highest place at which two states differ, (2, 3), mm; None: nowhere."""
    boxes = [_changes(old, new) for old, new in zip(before, after, strict=True) if not _is_same(old, new)]
    found = [box for box in boxes if box is not None]
    if not found:
        return None
    return np.stack((np.min([box[0] for box in found], axis=0), np.max([box[1] for box in found], axis=0)))


def _changes(old: Tile, new: Tile) -> Floats | None:
    """Return the box of the ends of a tile that one of two states has only, (2, 3), mm; None without any."""
    differ = np.setxor1d(_end_keys(old), _end_keys(new))
    if not len(differ):
        return None
    ray = (differ.real // _ROWS).astype(np.int64)
    u, v, w = new.u[ray // len(new.v)], new.v[ray % len(new.v)], differ.imag
    box = np.empty((2, 3))
    box[:, list(BUNDLE_AXES[new.bundle])] = np.column_stack([(own.min(), own.max()) for own in (u, v, w)])
    return box


def _end_keys(tile: Tile) -> NDArray[np.complex128]:
    """Ray, row and place of each end as one number."""
    ray, end = np.nonzero(np.arange(tile.ends.shape[1]) < 2 * tile.count[:, None])
    return np.asarray(ray * _ROWS + tile.rows[ray, end] + 1 + 1j * tile.ends[ray, end])


def _copy(tile: Tile) -> Tile:
    """Return a tile with arrays of its own."""
    return Tile(
        tile.bundle, tile.first_u, tile.first_v, tile.u, tile.v, tile.count.copy(), tile.ends.copy(),
        tile.rows.copy(), tile.normals.copy(),
    )  # fmt: skip


def _is_same(one: Tile, other: Tile) -> bool:
    """Whether nothing has cut a tile since it was copied."""
    return all(np.array_equal(getattr(one, name), getattr(other, name)) for name in ("count", "rows", "ends"))
