"""Rewind retracts: within a cut the tool retracts along its axis, the rotary axes turn, and the tool comes back.

A planner inserts them where a rotary axis must rewind, and no CL point belongs to them. They are recognized by what
they do, in programs of any origin: motions between two CL points that leave the first along the tool axis away from the
part at a feed, turn rotary axes only out there, and end where they began, under the same tool axis, at a feed. There
the tool may move along its axis at rapid with TCP, under which rapids are straight. While the rotary axes turn the tip
is held, by TCP or by slides that follow. Any other motion without a CL point stays a fault.
"""

from collections.abc import Sequence

import numpy as np

from trunnion.arrays import Flags, Floats
from trunnion.machines import forward
from trunnion.model.feed_path import row_feed_path_lengths
from trunnion.model.run import PositionChunk, Run
from trunnion.model.toolpath import Kind
from trunnion.records import dataclass

#: How far from the part rotary axes may turn and rapids go at the earliest, mm, and how much they must turn, degrees.
_MIN_RETRACT, _MIN_TURN = 1.0, 1.0

#: Smaller rotary motion is none, degrees; rounding of printed values is less.
_STILL = 1e-3

#: How far the tip may stray while slides hold it, mm, and the fractions of a motion at which it is sampled. Its
#: tolerance is left to the check of the tool between points; here it only must not come back to the part.
_MAX_STRAY, _FRACTIONS = 0.5 * _MIN_RETRACT, np.linspace(0.0, 1.0, 9)[1:-1]

#: How far ahead the end of a rewind retract is searched: most have three motions, those without TCP many more.
_WINDOWS = (8, 1024, 65536)

#: A tip that moves by less than this, mm, rests.
_TIP_RESTS = 1e-3

#: Share by which a feed that follows from a time may be off.
_FEED_SHARE = 1e-2


@dataclass(frozen=True, slots=True)
class RewindRetract:
    """Rows ``first`` to ``end`` (exclusive) of a run, and how far the tool retracts, mm."""

    first: int
    end: int
    distance: float


def find_rewind_retracts(run: Run, extra: Sequence[int], tip_tolerance: float) -> list[RewindRetract]:
    """Which of the motions without a CL point are rewind retracts.

    extra          rows of the run, increasing
    tip_tolerance  how far a coordinate may be off, mm
    """
    found = []
    rows = np.array(extra, np.int64)
    for unbroken in np.split(rows, np.flatnonzero(np.diff(rows) != 1) + 1):
        if len(unbroken) >= 2 and unbroken[0] > 0 and unbroken[-1] + 1 < len(run):
            first, end = int(unbroken[0]), int(unbroken[-1]) + 1
            distance = _retract_distance(run, first, end, tip_tolerance)
            if distance is not None:
                found.append(RewindRetract(first, end, distance))
    return found


def rewind_retract_length(run: Run, first: int, tip_tolerance: float) -> int:
    """How many motions from row ``first`` on leave along the tool axis, turn, and come back to the position before.

    0 if they do not. Whether this is safe is left to ``find_rewind_retracts``, whose ``tip_tolerance`` this is.
    """
    if first == 0 or first >= len(run):
        return 0
    near = _near(tip_tolerance)
    start = run.positions(np.array([first - 1, first]))
    step = start.tip[1] - start.tip[0]
    out = float(step @ start.axis[0])
    if out < _MIN_RETRACT or np.linalg.norm(step - out * start.axis[0]) > near:
        return 0
    for window in _WINDOWS:
        positions = run.positions(np.arange(first, min(first + window, len(run))))
        back = (np.abs(positions.tip - start.tip[0]).max(axis=1) <= near) & _same_axis(positions.axis, start.axis[0])
        if back.any():
            count = int(np.argmax(back)) + 1
            if _goes_home(run, first, first + count):
                return 0
            turned = np.ptp(positions.joints[:count, list(run.machine.rotary)], axis=0).max()
            return count if turned > _MIN_TURN else 0
    return 0


def _goes_home(run: Run, first: int, end: int) -> bool:
    """Whether rows go to machine positions, or M codes draw the tool back between them."""
    retracts = any(event.kind == "retract" and first < event.before_row < end for event in run.events)
    return retracts or bool(run.state.machine_frame.at(np.arange(first, end)).any())


def _near(tip_tolerance: float) -> float:
    return 4.0 * tip_tolerance + 1e-6  # both ends are rounded, in three coordinates


def _same_axis(axis: Floats, expected: Floats) -> Flags:
    """Which tool axes (n, 3) are the expected one, (n,) bool."""
    return np.asarray(np.abs(axis - expected).max(axis=1) <= 1e-6 + np.radians(_STILL))


def _rotary_steps(run: Run, positions: PositionChunk) -> Floats:
    """How far the rotary axes turn in each row, degrees: that of the one that turns farthest, (k,)."""
    return np.asarray(np.abs(np.diff(positions.joints[:, list(run.machine.rotary)], axis=0)).max(axis=1))


def _retract_distance(run: Run, first: int, end: int, tip_tolerance: float) -> float | None:
    """How far rows ``first`` to ``end`` retract, mm; None if they are no rewind retract."""
    positions, near = run.chunk(first, end), _near(tip_tolerance)
    tip, axis = positions.tip, positions.axis
    out = (tip - tip[0]) @ axis[0]
    aside = np.linalg.norm(tip - tip[0] - out[:, None] * axis[0], axis=1)
    on_line = bool((aside <= near).all() and (out >= -near).all() and abs(out[-1]) <= near)
    moves = np.abs(np.diff(out)) > near
    same_axis = _same_axis(axis, axis[0])
    straight = bool(same_axis[-1] and same_axis[1:][moves].all() and same_axis[:-1][moves].all())
    if not (on_line and straight and _holds_tip(run, first, end, positions)):
        return None
    if not _turns_outside_at_feed(run, first, end, out, _rotary_steps(run, positions), near):
        return None
    return float(out.max())


def _holds_tip(run: Run, first: int, end: int, positions: PositionChunk) -> bool:
    """Whether the tip stays where it is while the rotary axes turn: by TCP, or because the slides follow."""
    tcp, frame = run.state.tcp.part(first - 1, end), run.state.machine_frame.part(first - 1, end)
    if frame.any() or (tcp.any() and not tcp.all()):
        return False
    if tcp.all():
        return True
    machine = run.machine_at(first)
    if machine.workpiece_zero is None:  # where the tip is, is not known
        return False
    turning = np.flatnonzero(_rotary_steps(run, positions) > _STILL)
    begin, step = positions.joints[turning], positions.joints[turning + 1] - positions.joints[turning]
    off = [forward(machine, begin + fraction * step)[0] - positions.tip[turning] for fraction in _FRACTIONS]
    return bool(np.linalg.norm(off, axis=2).max(initial=0.0) <= _MAX_STRAY)


def _turns_outside_at_feed(run: Run, first: int, end: int, out: Floats, turns: Floats, near: float) -> bool:
    """Whether the rotary axes turn away from the part only, and the tool leaves it and comes back to it at a feed.

    It must not come back faster than the cut goes on.

    out    (end - first + 1,)  distance from the part in the row before and in all rows, mm
    turns  (end - first,)      rotary motion in each row, degrees
    """
    outside = (out[1:] >= _MIN_RETRACT) & (np.abs(np.diff(out)) <= near)
    straight = (np.minimum(out[1:], out[:-1]) >= _MIN_RETRACT - near) & run.state.tcp.part(first, end)
    lines, rapids = run.kind[first:end] == Kind.LINEAR, run.kind[first:end] == Kind.RAPID
    feed = run.state.feed.part(first, end)
    turns_outside = bool((np.abs(np.cumsum(turns)) > _MIN_TURN).any()) and bool((outside | (turns <= _STILL)).all())
    at_feed = bool((lines | (rapids & (outside | straight))).all()) and bool((feed[lines] > 0.0).all())
    return turns_outside and at_feed and _tip_feed(run, end - 1) <= _tip_feed(run, end) * (1.0 + _FEED_SHARE)


def _tip_feed(run: Run, row: int) -> float:
    """Feed of the tip in a row, mm/min; as programmed where the tip rests."""
    rows = np.array([row])
    feed = float(run.state.feed.at(rows)[0])
    travel = float(np.linalg.norm(np.diff(run.positions(np.array([row - 1, row])).tip, axis=0)))
    counted = float(row_feed_path_lengths(run, rows)[0])
    if run.state.feed_mode.at(rows)[0] == 93:
        return feed * travel if travel > _TIP_RESTS else np.inf
    return feed if np.isnan(counted) or travel <= _TIP_RESTS else feed * travel / counted
