"""Surfaces as trees of cells, for ``clearance_kernel``.

In:     points and radii of balls on a grid over a surface's two parameters.
Out:    cells from the whole surface down to the smallest, each with its parts.
Units:  mm.
"""

from itertools import accumulate
from typing import Final

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from trunnion.arrays import Flags, Floats, Ints
from trunnion.records import dataclass

#: A smallest cell is measured at so many steps along each side.
STEPS: Final = 4

#: What a surface is off its cell between the points where that is measured: so much more.
_BETWEEN: Final = 1.25


@dataclass(frozen=True, slots=True, eq=False)
class Cells:
    """A tree: ``cells`` (m, 13) and ``children`` (m, 4) as in ``BodyData``; the last cell is the root."""

    cells: Floats
    children: Ints


def cell_tree(balls: Floats, kept: Flags) -> Cells:
    """Return the cells of a surface.

    balls  (STEPS i + 1, STEPS j + 1, 4): points and radii over i x j smallest cells; i and j are powers of 2
    kept   (i, j): the smallest cells that there are; at least one
    """
    levels: list[tuple[Floats, Ints]] = []
    numbers: Ints = np.full(kept.shape, -1)
    numbers[kept] = np.arange(kept.sum())
    children = np.full((int(kept.sum()), 4), -1)
    step, count = np.array([STEPS, STEPS]), 0
    while True:
        i, j = np.nonzero(numbers >= 0)
        levels.append((_flat_cells(balls, i, j, step), children))
        count += len(i)
        if numbers.size == 1:
            break
        halves = np.where(np.array(numbers.shape) > 1, 2, 1)
        shape = numbers.shape[0] // int(halves[0]), numbers.shape[1] // int(halves[1])
        parts = numbers.reshape(shape[0], halves[0], shape[1], halves[1]).swapaxes(1, 2).reshape(*shape, -1)
        is_there = (parts >= 0).any(axis=2)
        own = parts[is_there]
        children = np.full((len(own), 4), -1)
        children[:, : own.shape[1]] = -np.sort(-own, axis=1)
        numbers = np.full(shape, -1)
        numbers[is_there] = count + np.arange(len(own))
        step = step * halves
    return Cells(np.vstack([one for one, _ in levels]), np.vstack([one for _, one in levels]))


def _flat_cells(balls: Floats, i: Ints, j: Ints, step: Ints) -> Floats:
    """Cells (k, 13) of one size: those from rows ``i * step[0]`` and columns ``j * step[1]``."""
    rows, columns = i * step[0], j * step[1]
    middle = balls[rows + step[0] // 2, columns + step[1] // 2]
    along = (balls[rows + step[0], columns + step[1] // 2] - balls[rows, columns + step[1] // 2]) / 2.0
    across = (balls[rows + step[0] // 2, columns + step[1]] - balls[rows + step[0] // 2, columns]) / 2.0
    windows = sliding_window_view(balls, (step[0] + 1, step[1] + 1), axis=(0, 1))[rows, columns]
    s, t = (np.linspace(-1.0, 1.0, count + 1) for count in step)
    flat = middle[:, :, None, None] + along[:, :, None, None] * s[:, None] + across[:, :, None, None] * t
    away = windows - flat
    off = (np.linalg.norm(away[:, :3], axis=1) + np.abs(away[:, 3])).max(axis=(1, 2))
    return np.column_stack(
        (middle[:, :3], along[:, :3], across[:, :3], middle[:, 3], along[:, 3], across[:, 3], _BETWEEN * off)
    )


def joined(trees: list[Cells]) -> tuple[Floats, Ints, Ints]:
    """Cells and children of several trees together, and their roots."""
    ends = list(accumulate(len(tree.cells) for tree in trees))
    starts = [end - len(tree.cells) for end, tree in zip(ends, trees, strict=True)]
    children = [np.where(tree.children < 0, -1, tree.children + at) for tree, at in zip(trees, starts, strict=True)]
    return np.vstack([tree.cells for tree in trees]), np.vstack(children), np.array(ends) - 1
