"""Retreats in the cut: the tool draws back along its axis, turns, and comes back to where it was.

A planner puts them in where a rotary axis must rewind, and no CL point answers to them. They are known by what they do,
whoever wrote them: motions between two CL points that leave the first one along the tool axis away from the part, turn
rotary axes only out there, and end where they began, under the same tool axis, at a feed. Anything else that answers to
no CL point stays a fault.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from trunnion.arrays import Floats
from trunnion.reader import Run
from trunnion.toolpath import Kind

#: The tool has to be this far from the part before it turns, mm, and has to turn by this much, degrees.
_OFF, _TURNS = 1.0, 1.0

#: Rotary motion below this is none, degrees; rounding of printed values is less.
_STILL = 1e-3


@dataclass(frozen=True, slots=True)
class Retreat:
    """Rows ``first`` to ``end`` (left out) of a run, and how far the tool draws back, mm."""

    first: int
    end: int
    distance: float


def retreats(run: Run, extra: Sequence[int], allowed: float) -> list[Retreat]:
    """Which of the motions that answer to no CL point are retreats.

    Parameters
    ----------
    extra
        Rows of the run, growing.
    allowed
        How far a coordinate may be off, mm.
    """
    found = []
    rows = np.array(extra, np.int64)
    for part in np.split(rows, np.flatnonzero(np.diff(rows) != 1) + 1):
        if len(part) >= 2 and part[0] > 0 and part[-1] + 1 < len(run):
            distance = _distance(run, int(part[0]), int(part[-1]) + 1, allowed)
            if distance is not None:
                found.append(Retreat(int(part[0]), int(part[-1]) + 1, distance))
    return found


def _distance(run: Run, first: int, end: int, allowed: float) -> float | None:
    """How far rows ``first`` to ``end`` draw back, mm; None if they are no retreat from the row before them."""
    poses = run.stretch(first, end)
    tip, axis = poses.tip, poses.axis
    out = (tip - tip[0]) @ axis[0]
    aside = np.linalg.norm(tip - tip[0] - out[:, None] * axis[0], axis=1)
    near = 4.0 * allowed + 1e-6  # both ends are rounded, in three coordinates
    on_line = bool((aside <= near).all() and (out >= -near).all() and abs(out[-1]) <= near)
    upright = bool((np.abs(axis - axis[0]).max(axis=1) <= 1e-6 + np.radians(_STILL)).all())
    state = run.state
    held = bool(state.tcp.part(first - 1, end).all()) and not bool(state.machine_frame.part(first - 1, end).any())
    turns = np.abs(np.diff(poses.joints[:, list(run.machine.rotary)], axis=0)).max(axis=1)
    if not (on_line and upright and held and _is_gentle(run, first, end, out, turns, near)):
        return None
    return float(out.max())


def _is_gentle(run: Run, first: int, end: int, out: Floats, turns: Floats, near: float) -> bool:
    """Whether the axes turn out there only, and the tool goes there and back at a feed, back no faster than on.

    out    (end - first + 1,)  distance from the part at the row before and at all rows, mm
    turns  (end - first,)      how far the rotary axes turn in each row, degrees
    """
    away = (out[1:] >= _OFF) & (np.abs(np.diff(out)) <= near)
    lines, rapids = run.kind[first:end] == Kind.LINEAR, run.kind[first:end] == Kind.RAPID
    feed = run.state.feed.part(first, end + 1)
    turned = bool((turns > _TURNS).any()) and bool((away | (turns <= _STILL)).all())
    fed = bool((lines | (rapids & away)).all()) and bool((feed[:-1][lines] > 0.0).all())
    return turned and fed and bool(feed[-2] <= feed[-1])
