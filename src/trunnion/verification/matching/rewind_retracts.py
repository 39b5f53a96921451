"""Retreats in the cut: the tool draws back along its axis, turns, and comes back to where it was.

A planner puts them in where a rotary axis must rewind, and no CL point answers to them. They are known by what they do,
whoever wrote them: motions between two CL points that leave the first one along the tool axis away from the part, turn
rotary axes only out there, and end where they began, under the same tool axis, at a feed. While they turn the tip is
held, by TCP or by slides that follow. Anything else that answers to no CL point stays a fault.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from trunnion.arrays import Flags, Floats
from trunnion.machines import forward
from trunnion.model.feed_path import row_feed_path_lengths
from trunnion.model.run import PositionChunk, Run
from trunnion.model.toolpath import Kind

#: The tool has to be this far from the part before it turns, mm, and has to turn by this much, degrees.
_OFF, _TURNS = 1.0, 1.0

#: Rotary motion below this is none, degrees; rounding of printed values is less.
_STILL = 1e-3

#: How far the tip may stray while slides hold it, mm, and the parts of a motion at which it is looked at. Nearer to its
#: tolerance it is held by the check of the way between points; here it must not come back to the part.
_STRAY, _SHARES = 0.5 * _OFF, np.linspace(0.0, 1.0, 9)[1:-1]

#: How far ahead the end of a retreat is searched: most have three motions, those without TCP many more.
_AHEAD = (8, 1024, 65536)

#: A tip that moves by less than this, mm, rests. And what a feed said by time may be off.
_RESTS, _SAME_FEED = 1e-3, 1e-2


@dataclass(frozen=True, slots=True)
class RewindRetract:
    """Rows ``first`` to ``end`` (left out) of a run, and how far the tool draws back, mm."""

    first: int
    end: int
    distance: float


def find_rewind_retracts(run: Run, extra: Sequence[int], tip_tolerance: float) -> list[RewindRetract]:
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
            distance = _distance(run, int(part[0]), int(part[-1]) + 1, tip_tolerance)
            if distance is not None:
                found.append(RewindRetract(int(part[0]), int(part[-1]) + 1, distance))
    return found


def rewind_retract_length(run: Run, first: int, tip_tolerance: float) -> int:
    """How many motions from row ``first`` on leave the place before them along the tool axis, turn, and come back.

    0 if they do not. What they are worth is not judged here; ``tip_tolerance`` as for ``find_rewind_retracts``.
    """
    if first == 0 or first >= len(run):
        return 0
    near = _near(tip_tolerance)
    before = run.positions(np.array([first - 1, first]))
    away = before.tip[1] - before.tip[0]
    out = float(away @ before.axis[0])
    if out < _OFF or np.linalg.norm(away - out * before.axis[0]) > near:
        return 0
    for ahead in _AHEAD:
        rows = np.arange(first, min(first + ahead, len(run)))
        poses = run.positions(rows)
        there = (np.abs(poses.tip - before.tip[0]).max(axis=1) <= near) & _upright(poses.axis, before.axis[0])
        if there.any():
            count = int(np.argmax(there)) + 1
            turned = np.ptp(poses.joints[:count, list(run.machine.rotary)], axis=0).max()
            return count if turned > _TURNS else 0
    return 0


def _near(tip_tolerance: float) -> float:
    return 4.0 * tip_tolerance + 1e-6  # both ends are rounded, in three coordinates


def _upright(axis: Floats, expected: Floats) -> Flags:
    """Which of some tool axes (n, 3) are the one that is wanted."""
    return np.asarray(np.abs(axis - expected).max(axis=1) <= 1e-6 + np.radians(_STILL))


def _distance(run: Run, first: int, end: int, tip_tolerance: float) -> float | None:
    """How far rows ``first`` to ``end`` draw back, mm; None if they are no retreat from the row before them."""
    poses, near = run.chunk(first, end), _near(tip_tolerance)
    tip, axis = poses.tip, poses.axis
    out = (tip - tip[0]) @ axis[0]
    aside = np.linalg.norm(tip - tip[0] - out[:, None] * axis[0], axis=1)
    on_line = bool((aside <= near).all() and (out >= -near).all() and abs(out[-1]) <= near)
    moves = np.abs(np.diff(out)) > near
    upright = _upright(axis, axis[0])
    straight = bool(upright[-1] and upright[1:][moves].all() and upright[:-1][moves].all())
    turns = np.abs(np.diff(poses.joints[:, list(run.machine.rotary)], axis=0)).max(axis=1)
    held = on_line and straight and _is_held(run, first, end, poses)
    if not (held and _is_gentle(run, first, end, out, turns, near)):
        return None
    return float(out.max())


def _is_held(run: Run, first: int, end: int, poses: PositionChunk) -> bool:
    """Whether the tip stays where it is while the rotary axes turn: by TCP, or led by the slides on all the way."""
    tcp, frame = run.state.tcp.part(first - 1, end), run.state.machine_frame.part(first - 1, end)
    if frame.any() or (tcp.any() and not tcp.all()):
        return False
    if tcp.all():
        return True
    if run.machine.workpiece_zero is None:  # nobody knows where the tip is
        return False
    turning = np.flatnonzero(np.abs(np.diff(poses.joints[:, list(run.machine.rotary)], axis=0)).max(axis=1) > _STILL)
    begin, step = poses.joints[turning], poses.joints[turning + 1] - poses.joints[turning]
    off = [forward(run.machine, begin + share * step)[0] - poses.tip[turning] for share in _SHARES]
    return bool(np.linalg.norm(off, axis=2).max(initial=0.0) <= _STRAY)


def _is_gentle(run: Run, first: int, end: int, out: Floats, turns: Floats, near: float) -> bool:
    """Whether the axes turn out there only, and the tool goes there and back at a feed, back no faster than on.

    out    (end - first + 1,)  distance from the part at the row before and at all rows, mm
    turns  (end - first,)      how far the rotary axes turn in each row, degrees
    """
    away = (out[1:] >= _OFF) & (np.abs(np.diff(out)) <= near)
    lines, rapids = run.kind[first:end] == Kind.LINEAR, run.kind[first:end] == Kind.RAPID
    feed = run.state.feed.part(first, end)
    turned = bool((np.abs(np.cumsum(turns)) > _TURNS).any()) and bool((away | (turns <= _STILL)).all())
    fed = bool((lines | (rapids & away)).all()) and bool((feed[lines] > 0.0).all())
    return turned and fed and _feed(run, end - 1) <= _feed(run, end) * (1.0 + _SAME_FEED)


def _feed(run: Run, row: int) -> float:
    """Feed of the tip in a row, mm/min; as it is said where the tip rests."""
    rows = np.array([row])
    feed, way = (
        float(run.state.feed.at(rows)[0]),
        float(np.linalg.norm(np.diff(run.positions(np.array([row - 1, row])).tip, axis=0))),
    )
    said = float(row_feed_path_lengths(run, rows)[0])
    if run.state.feed_mode.at(rows)[0] == 93:
        return feed * way if way > _RESTS else np.inf
    return feed if np.isnan(said) or way <= _RESTS else feed * way / said
