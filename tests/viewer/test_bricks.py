"""Bricks: what changes makes one frame of another, and values stand where vertices do."""

from pathlib import Path

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

import trunnion
from tests.support.stepped_slot import write_slot
from tests.support.sweeps import block
from trunnion.simulation.replay import Replay, changed_box
from trunnion.simulation.stock.material import Tile
from trunnion.simulation.stock.surface import surface_grid
from trunnion.viewer.bricks import (
    NOTHING,
    SIDE,
    BrickFrame,
    BrickRange,
    brick_frame,
    brick_values,
    changed_frame,
    message,
)

CENTRE_BYTES = (SIDE + 2) ** 3 // 8


def read_message(data: bytes) -> tuple[int, int, dict[int, bytes]]:
    """Rows, rows of the frame before, and bricks."""
    rows, before, count = np.frombuffer(data, "<i4", 3).tolist()
    head = np.frombuffer(data, "<i4", 2 * count, 12).reshape(-1, 2).tolist()
    at, bricks = 12 + 8 * count, {}
    for number, length in head:
        bricks[number] = data[at : at + length]
        at += length
    assert at == len(data)
    return rows, before, bricks


frames = st.dictionaries(st.integers(0, 6), st.binary(min_size=1, max_size=3)).map(lambda bricks: BrickFrame(1, bricks))


@given(frames, frames)
def test_a_message_makes_one_frame_of_the_other(before: BrickFrame, after: BrickFrame) -> None:
    rows, old, changed = read_message(message(after, before))
    assert (rows, old) == (1, 1)
    assert {number: own for number, own in {**before.bricks, **changed}.items() if own} == after.bricks
    assert all(before.bricks.get(number) != own for number, own in changed.items())
    assert read_message(message(after, None)) == (1, NOTHING, dict(after.bricks))


def test_a_box_is_in_the_bricks_that_its_faces_pass() -> None:
    stock = block((0.0, 0.0, 0.0), (100.0, 100.0, 100.0), 1.0)
    grid = surface_grid(stock)
    frame = brick_frame(grid, stock.lattice.cell, 5)
    # 101 cubes a side are four bricks; only the eight in the middle have no surface.
    assert frame.rows == 5
    assert len(frame.bricks) == 4**3 - 2**3
    heights = brick_values(grid, grid.vertices[:, 2])
    assert sum((len(own) - CENTRE_BYTES) // 3 for own in frame.bricks.values()) == len(heights)
    assert len(heights) > len(grid.vertices)  # the last layers are in two bricks
    low = frame.bricks[0]
    places = np.frombuffer(low[CENTRE_BYTES:], np.uint8).reshape(3, -1)
    first = (places[2] / 254.0 - 0.5)[0]  # of the cube at the box's corner
    assert abs(first - heights[0]) < 1.0 / 254.0


def test_nothing_is_no_brick() -> None:
    stock = block((0.0, 0.0, 0.0), (10.0, 10.0, 10.0), 1.0)
    for tile in stock.tiles:
        tile.count[:] = 0
    grid = surface_grid(stock)
    assert brick_frame(grid, stock.lattice.cell, 0).bricks == {}
    assert len(brick_values(grid, np.zeros(0))) == 0


def test_what_changes_makes_the_same_bricks_as_the_whole(tmp_path: Path) -> None:
    program, given = write_slot(tmp_path)
    steps = "".join(f"G1 X{25 + 1.5 * k:.2f} Y{(-1) ** k * 0.4 * k:.2f} Z{-3 + 0.05 * k:.2f}\n" for k in range(25))
    program.write_text(program.read_text().replace("N80 G1 X70\n", steps), encoding="utf-8")
    found = trunnion.simulate(program, **{**given, "part": None, "cell": 0.3}).simulation
    replay = Replay(found.model, found.programs[0])
    lattice, frames = replay.stock.lattice, list[BrickFrame]()
    tiles: tuple[Tile, ...] = ()
    for rows in (3, 4, 8, 9, 16, 20, 12, 29):
        replay.go_to(rows)
        whole = brick_frame(surface_grid(replay.stock), lattice.cell, rows)
        if frames:
            box = changed_box(tiles, replay.state())
            assert box is not None
            low, high = np.floor((box - lattice.low) / lattice.cell).astype(np.int64)
            own = BrickRange.around(low, high, lattice.counts)
            assert (own.end - own.first < own.many).any()
            first, end = own.cells(6, lattice.counts)
            grid = surface_grid(replay.stock.part(first, end))
            frame = changed_frame(frames[-1], grid, lattice.cell, rows, own, first)
            assert frame.bricks.keys() == whole.bricks.keys()
            for number, ours in frame.bricks.items():
                theirs = whole.bricks[number]
                assert ours[:CENTRE_BYTES] == theirs[:CENTRE_BYTES]
                places = [np.frombuffer(each[CENTRE_BYTES:], np.uint8).astype(int) for each in (ours, theirs)]
                assert np.abs(places[0] - places[1]).max() <= 1  # rounded from coordinates of another origin
        frames.append(whole)
        tiles = replay.state()
