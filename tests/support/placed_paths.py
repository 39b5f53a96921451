"""Machines with limits and paths to place, and a slow way to judge a place that shares nothing with placing."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from hypothesis import strategies as st

from tests.support.machine_strategies import machines
from trunnion.arrays import Floats
from trunnion.machines import Machine, inverse
from trunnion.placing.best_turn import Grid, TurnResult, best_orientations
from trunnion.placing.goals import Goal
from trunnion.placing.path_rows import PathRows, Stretch, no_arcs
from trunnion.placing.turns import TurnedPath

#: Tool axes of a path lean as much to each side of a middle one, so that few machines fail to reach some.
_LEAN = 0.35


@st.composite
def limited_machines(draw: st.DrawFn) -> Machine:
    """Any machine, with limits of its slides and some of its rotary axes; some slides have one limit or none."""
    machine = draw(machines())
    axes = []
    for axis in machine.axes:
        if axis.is_rotary:
            low, span = draw(st.sampled_from([(-np.inf, np.inf), (-360.0, 720.0), (-130.0, 300.0), (-90.0, 200.0)]))
            axes.append(replace(axis, low=low, high=low + span if np.isfinite(low) else np.inf))
        else:
            low, high = draw(st.floats(-800.0, -100.0)), draw(st.floats(100.0, 800.0))
            kind = draw(st.sampled_from(["both", "both", "both", "low", "high", "none"]))
            axes.append(
                replace(
                    axis,
                    low=low if kind in ("both", "low") else -np.inf,
                    high=high if kind in ("both", "high") else np.inf,
                )
            )
    return replace(machine, axes=tuple(axes))


def random_rows(seed: int, count: int) -> PathRows:
    """A path of rows that are judged alone: tool axes around a random one, tips in a cube of 120 mm."""
    random = np.random.default_rng(seed)
    axis = random.normal(size=3) + _LEAN * random.uniform(-1.0, 1.0, (count, 3))
    axis /= np.linalg.norm(axis, axis=1)[:, None]
    return path_rows(random.uniform(-60.0, 60.0, (count, 3)), axis, random.integers(0, 2, count).astype(np.uint8))


def path_rows(tip: Floats, axis: Floats, branch: Floats, *, straight: bool = False) -> PathRows:
    """One stretch of rows; ``straight``: the ways between them count."""
    count = len(tip)
    return PathRows(
        tip,
        axis,
        branch.astype(np.uint8),
        np.arange(1, count + 1),
        np.full(count, straight),
        np.zeros(count),
        (Stretch(0, "made.cls"),),
        np.zeros((1, 2)),
        no_arcs(),
        np.zeros(0, np.int64),
    )


def turned_by(degrees: float, vectors: Floats) -> Floats:
    """Vectors (n, 3) turned about Z, in the plainest way."""
    angle = np.radians(degrees)
    x, y = vectors[:, 0], vectors[:, 1]
    return np.column_stack(
        (np.cos(angle) * x - np.sin(angle) * y, np.sin(angle) * x + np.cos(angle) * y, vectors[:, 2])
    )


def brute_margin(machine: Machine, rows: PathRows, turn: float, zero: Floats) -> float:
    """The margin of a place by the inverse map of each row, mm; minus infinity if a rotary axis cannot be so."""
    x, y, z = zero.tolist()
    there = replace(machine, workpiece_zero=(x, y, z))
    found = inverse(there, turned_by(turn, rows.tip), turned_by(turn, rows.axis))
    if not found.reachable.all():
        return -np.inf
    joints = found.joints[rows.branch, np.arange(len(rows))]
    for column in machine.rotary:
        axis = machine.axes[column]
        turns = joints[:, column, None] + 360.0 * np.arange(-4, 5)
        inside = (turns >= axis.low - 1e-5) & (turns <= axis.high + 1e-5)
        if not inside.any(axis=1).all():
            return -np.inf
    least = np.inf
    for column in machine.linear:
        axis = machine.axes[column]
        least = min(least, joints[:, column].min() - axis.low, axis.high - joints[:, column].max())
    return float(least)


def best_turns(
    paths: Sequence[TurnedPath], turns: Floats, *, refine: bool, goal: Goal = Goal.MARGIN
) -> tuple[list[TurnResult], TurnResult]:
    """What each turn (k,) allows, in their order and refined about the best; and the best of all."""
    return best_orientations(lambda _: paths, Grid(turns, refines_turns=refine), lambda _: None, goal=goal)
