"""Which rotary positions the program of a placed part takes, where they are others than those of its place."""

from typing import Final

import numpy as np

from trunnion.arrays import Ints
from trunnion.model.arc_extremes import RunArcs
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind
from trunnion.placing.placement import Placement, RotaryUse
from trunnion.records import dataclass

#: Rotary positions that are nearer to those of the place are the same, degrees: programs are rounded.
_SAME_DEG: Final = 0.01


@dataclass(frozen=True, slots=True)
class ProgramUse:
    """How a program uses the travel of the axes at feed.

    rotary     least and greatest position of each rotary axis, degrees
    margin_mm  what the slide that is nearest to a limit has left, mm
    """

    rotary: tuple[tuple[str, float, float], ...]
    margin_mm: float


def other_positions(found: Placement, run: Run) -> ProgramUse | None:
    """Return what a proven program does at feed; None where its rotary axes stay within what the place says of them."""
    rows = np.flatnonzero(run.kind != Kind.RAPID)
    if found.best is None or not len(rows):
        return None
    machine = run.machine
    turned = run.joints[rows][:, list(machine.rotary)]
    ends = list(zip(turned.min(axis=0).tolist(), turned.max(axis=0).tolist(), strict=True))
    if all(_is_within(low, high, use) for (low, high), use in zip(ends, found.best.rotary, strict=True)):
        return None
    names = [machine.names[k] for k in machine.own_rotary]
    rotary = tuple((name, low, high) for name, (low, high) in zip(names, ends, strict=False))
    return ProgramUse(rotary, _slide_margin(run, rows))


def _is_within(low: float, high: float, use: RotaryUse) -> bool:
    """Whether a range is within that of a place; whole turns of an axis without end stops do not count."""
    whole = 360.0 * round((low - use.least_deg) / 360.0) if use.margin_deg == float("inf") else 0.0
    return low - whole >= use.least_deg - _SAME_DEG and high - whole <= use.greatest_deg + _SAME_DEG


def _slide_margin(run: Run, rows: Ints) -> float:
    """Return what the nearest slide has left in some rows, at their ends and on arcs, mm."""
    arcs, slides = RunArcs.of(run), list(run.machine.linear)
    reached, count = run.joints[rows][:, slides], np.isin(arcs.rows, rows)
    low = np.concatenate((reached, arcs.axes.low[count][:, slides])).min(axis=0)
    high = np.concatenate((reached, arcs.axes.high[count][:, slides])).max(axis=0)
    limits = run.machine.limits[slides]
    return float(np.minimum(low - limits[:, 0], limits[:, 1] - high).min())
