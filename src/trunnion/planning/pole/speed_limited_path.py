"""Lean: rotary positions that keep both axes within their speed, with the least lean that does.

What is within an angle of lean is an interval of first angles in each row (``trunnion.planning.pole.lean_limits``).
Backwards from the last row, the values from which the rest of the path can be made are intervals, too; forwards, each
row takes the value nearest to the CAM's among them. The least angle is found by halving.
"""

from collections.abc import Sequence
from typing import Final

import numpy as np

from trunnion.arrays import Codes, Flags, Floats, Ints
from trunnion.planning.pole.lean_limits import StepLimits, least_lean, second_angles_within
from trunnion.planning.pole.lean_task import LeanTask, PoleRegion, axis_deviation
from trunnion.planning.pole.passages import PolePassage, remaining_passages
from trunnion.planning.poses.states import REWIND_STEP
from trunnion.planning.rotary_positions import is_endless

#: Degrees that an axis can turn before and after rows that are too fast: among these rows a path is looked for first.
_WINDOW_DEGREES: Final = 400.0

#: The most that an endless axis can be sent in one row, degrees, as it takes the shorter way.
_LONGEST_SHORT_WAY: Final = 179.999


def limit_speed(
    task: LeanTask, exact: Floats, state: Codes, passages: Sequence[PolePassage]
) -> tuple[Floats, list[PoleRegion], list[PolePassage]]:
    """Lean where an axis would be too fast: in a window around these rows or, if that fails, up to the next breaks.

    exact  (n, 2) float64: positions under which nothing leans, as they wind, degrees
    state  (n,) uint8: as in ``PlannedPoses``

    positions, regions, passages  (n, 2); the regions, solved or not; and what remains of passages that are not solved
    """
    leaned, regions, done = exact.copy(), list[PoleRegion](), 0
    too_fast = task.exceeds_speed(exact, state)
    solved = np.zeros(len(too_fast), bool)
    for first, end in _windows(task, too_fast, state):
        if first < done:  # all rows up to there were planned together
            continue
        path, lean = _path(task, exact, np.arange(first, end))
        if path is None:
            start, stop = _unbroken_rows(task, state, first)
            path, lean = _path(task, exact, np.arange(start, stop))
            if path is None:
                regions.append(_unsolved_region(too_fast, passages, first, end))
                continue
            first, end, done = start, stop, stop
            regions = [region for region in regions if region.end <= start]
        leaned[first:end] = path
        changed = first + np.flatnonzero(np.abs(path - exact[first:end]).max(axis=1) > 1e-9)
        regions.append(PoleRegion(int(changed[0]), int(changed[-1]) + 1, lean, True))
        too_fast[first:end], solved[first:end] = False, True
    return leaned, regions, list(remaining_passages(passages, too_fast, solved))


def _unsolved_region(too_fast: Flags, passages: Sequence[PolePassage], first: int, end: int) -> PoleRegion:
    """Return the rows from ``first`` to ``end`` that are too fast, with the passages around them."""
    rows = first + np.flatnonzero(too_fast[first:end])
    around = [p for p in passages if first <= p.first < end and too_fast[p.first : p.end + 1].any()]
    start = min([int(rows[0]), *(passage.first for passage in around)])
    stop = max([int(rows[-1]), *(passage.end for passage in around)]) + 1
    return PoleRegion(start, min(stop, len(too_fast)), 0.0, False)


def _breaks(task: LeanTask, state: Codes) -> Flags:
    """(n,) bool: rows before which the axes have all the time they need."""
    return np.asarray(task.unbound | (state & REWIND_STEP != 0))


def _windows(task: LeanTask, too_fast: Flags, state: Codes) -> list[tuple[int, int]]:
    """Rows, first and end, around those that are too fast; both axes can turn by ``_WINDOW_DEGREES`` on either side.

    Windows that overlap become one.
    """
    breaks = _breaks(task, state)
    reach = np.cumsum(np.where(breaks, 0.0, np.minimum(task.max_step.min(axis=1), _WINDOW_DEGREES)))
    starts = np.append(np.flatnonzero(breaks), len(breaks))
    at = np.flatnonzero(too_fast)
    segment = np.searchsorted(starts, at, "right") - 1
    first = np.maximum(np.searchsorted(reach, reach[at] - _WINDOW_DEGREES), starts[segment])
    end = np.minimum(np.searchsorted(reach, reach[at] + _WINDOW_DEGREES, "right"), starts[segment + 1])
    windows: list[tuple[int, int]] = []
    for start, stop in zip(first.tolist(), end.tolist(), strict=True):
        if windows and start < windows[-1][1]:
            windows[-1] = (windows[-1][0], max(stop, windows[-1][1]))
        else:
            windows.append((start, stop))
    return windows


def _unbroken_rows(task: LeanTask, state: Codes, first: int) -> tuple[int, int]:
    """Rows, first and end, from the last break before a row to the next one after it."""
    breaks = np.flatnonzero(_breaks(task, state))
    k = int(np.searchsorted(breaks, first, "right"))
    return int(breaks[k - 1]), int(breaks[k]) if k < len(breaks) else len(task.moves)


def _path(task: LeanTask, exact: Floats, rows: Ints) -> tuple[Floats | None, float]:
    """Positions (k, 2) for consecutive rows, and the most that the tool axis leans; None and NaN if there are none.

    Both ends stay where they are, unless a break is before or after them.
    """
    axis, target = task.moves.axis[rows], exact[rows]
    max_step = task.max_step[rows]
    max_step = np.where(is_endless(task.machine), np.minimum(max_step, _LONGEST_SHORT_WAY), max_step)
    fixed = task.fixed[rows].copy()
    fixed[0] |= not task.unbound[rows[0]]
    after = int(rows[-1]) + 1
    fixed[-1] |= after < len(exact) and not task.unbound[after]
    limits = [
        StepLimits(target[:, r], max_step[:, r], fixed, task.machine.axes[column].low, task.machine.axes[column].high)
        for r, column in enumerate(task.machine.rotary)
    ]
    first, lean = least_lean(task.kinematics, axis, limits[0], task.angle)
    if first is None:
        return None, np.nan
    for allowed in (lean, task.angle):
        second = second_angles_within(task.kinematics, axis, first, limits[1], allowed)
        if second is not None:
            path = np.column_stack((first, second))
            deviation = float(axis_deviation(task.machine, path, axis).max())
            if deviation <= task.angle + 1e-9:
                return path, deviation
    return None, np.nan
