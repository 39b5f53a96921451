"""Points between CL points: which motions lead along the way from one to the next, and how far the tool leaves it.

A program may hold more points than its CL file, put in so that the tool stays on its path. Such a point lies on the
straight line from CL point to CL point, and under the tool axis that the great circle has there; in a rapid the tool
axis is free. Whether points enough were put in is another question: it is asked of every motion, at several places on
its way.

Units: mm, degrees outside of kernels, radians inside.
"""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from trunnion.arrays import Codes, Flags, Floats, Ints
from trunnion.jit import njit
from trunnion.machines.forward import KinematicChain, forward_row, kinematic_chain
from trunnion.model.run import Orientation, ProgrammedWord, RowPositions, Run
from trunnion.model.toolpath import Kind
from trunnion.verification.deviations.point_deviations import RotaryGeometry, axis_difference
from trunnion.verification.expected.path import ExpectedPath
from trunnion.verification.kinematics.axis_motion import WorstRows

if TYPE_CHECKING:
    from trunnion.verification.matching.path_matching import Matching

#: Two points nearer to each other than this, mm, have no line between them: the tool axis says how far it has come.
_SHORT: Final = 1e-3

#: Rotary motion below this, degrees, bends nothing.
_STILL: Final = 1e-9

#: Motions that are no more than this many times as far from a CL point as they may be are still about it.
_ABOUT: Final = 3.0

#: Parts of a motion at which it is looked at.
_LOOKS: Final = 7


@dataclass(frozen=True, slots=True, eq=False)
class FollowedPath:
    """What ``follow_path`` found.

    motions, points  how many of either side go together
    partner          (motions,) int64  CL point that each motion goes to, or leads to
    there            (motions,) bool   it goes to that point; else it lies on the way
    """

    motions: int
    points: int
    partner: Ints
    there: Flags


def follow_path(
    tilt: RotaryGeometry,
    tip: Floats,
    axis: Floats,
    joints: Floats,
    kind: Codes,
    want_tip: Floats,
    want_axis: Floats,
    want_kind: Codes,
    near: tuple[float, float],
    allowed: tuple[float, float],
    bend: float,
) -> FollowedPath:
    """Go along CL points as far as motions go to them, straight or by points between.

    Parameters
    ----------
    tilt
        The machine's rotary axes.
    tip, axis : (n, 3) float64
        Of motions in their order.
    joints : (n, 5) float64
        Positions of the axes there.
    kind : (n,) uint8
        A ``Kind``.
    want_tip, want_axis : (m, 3) float64
        Of CL points in their order, led by the one from which the first motion starts.
    want_kind : (m,) uint8
        A ``Kind``; circles are gone to straight or not at all.
    near
        How far a coordinate of the tip may be off, mm, and one of the tool axis, with a little more than is judged.
    allowed
        How far a coordinate of the tip, mm, and a rotary axis, degrees, may be off as it is judged.
    bend
        How far the tool axis of points between may be off the great circle, rad.
    """
    partner, there = np.zeros(len(tip), np.int64), np.zeros(len(tip), np.bool_)
    motions, points = _follow(
        tip, axis, joints[:, tilt.column], tilt.sense, tilt.first, tilt.second, kind, want_tip, want_axis, want_kind,
        near[0], near[1], allowed[0], allowed[1], bend, partner, there,
    )  # fmt: skip
    return FollowedPath(motions, points, partner[:motions], there[:motions])


@njit(cache=True)
def _follow(
    tip: Floats,
    axis: Floats,
    value: Floats,
    sense: float,
    first: Floats,
    second: Floats,
    kind: Codes,
    want_tip: Floats,
    want_axis: Floats,
    want_kind: Codes,
    near_tip: float,
    near_axis: float,
    allowed: float,
    allowed_angle: float,
    bend: float,
    partner: Ints,
    there: Flags,
) -> tuple[int, int]:
    """Fill ``partner`` and ``there``; returns how many motions and points end with a motion at its point."""
    motions, points = 0, 0
    i, j, done = 0, 1, 0.0
    while i < tip.shape[0] and j < want_tip.shape[0]:
        if _is_at(tip, axis, i, want_tip, want_axis, j, near_tip, near_axis):
            # More motions of that kind about the same place lead there too: the last that is there as it is judged is
            # the one. Near a pole the rotary axes turn far while the tool hardly moves.
            last, ahead = i, i + 1
            while (
                ahead < tip.shape[0]
                and kind[ahead] == kind[i]
                and _is_at(tip, axis, ahead, want_tip, want_axis, j, _ABOUT * near_tip, _ABOUT * near_axis)
            ):
                _, off = axis_difference(axis, ahead, want_axis, j, value[ahead], sense, first, second)
                if off <= allowed_angle and _is_at(tip, axis, ahead, want_tip, want_axis, j, allowed, near_axis):
                    last = ahead
                ahead += 1
            for k in range(i, last + 1):
                there[k], partner[k] = k == last, j - 1
            motions, points = last + 1, j
            i, j, done = last + 1, j + 1, 0.0
            continue
        part = -1.0
        if want_kind[j] != 2:
            part = _part_of_way(tip, axis, i, want_tip, want_axis, j, want_kind[j] == 0, near_tip, bend, done)
        if part >= 0.0:
            there[i], partner[i] = False, j - 1
            done = max(done, part)
            i += 1
            continue
        repeats = _is_at(want_tip, want_axis, j, want_tip, want_axis, j - 1, 2.0 * near_tip, 2.0 * near_axis)
        if not repeats or want_kind[j] == 2:
            break
        j, done = j + 1, 0.0
    return motions, points


@njit(cache=True)
def _is_at(
    tip: Floats, axis: Floats, i: int, want_tip: Floats, want_axis: Floats, j: int, near_tip: float, near_axis: float
) -> bool:
    for k in range(3):
        if not abs(tip[i, k] - want_tip[j, k]) <= near_tip or not abs(axis[i, k] - want_axis[j, k]) <= near_axis:
            return False
    return True


@njit(cache=True)
def _part_of_way(
    tip: Floats,
    axis: Floats,
    i: int,
    want_tip: Floats,
    want_axis: Floats,
    j: int,
    free: bool,
    near_tip: float,
    bend: float,
    done: float,
) -> float:
    """How much of the way to point ``j`` motion ``i`` has done, from ``done`` on; -1 if it is not on it."""
    near = 1.7320508075688772 * near_tip
    length, along = 0.0, 0.0
    for k in range(3):
        length += (want_tip[j, k] - want_tip[j - 1, k]) ** 2
        along += (tip[i, k] - want_tip[j - 1, k]) * (want_tip[j, k] - want_tip[j - 1, k])
    length = math.sqrt(length)
    turn = _angle(want_axis, j - 1, want_axis, j)
    unsure = 0.0
    if length > _SHORT:
        part, unsure = along / length**2, 2.0 * near / length
    else:
        part = _angle(axis, i, want_axis, j - 1) / turn if turn > 1e-9 else done
    if not (done - unsure - 1e-9 <= part <= 1.0 + unsure + 1e-9):
        if length > _SHORT or not free:
            return -1.0
        part = done
    part = min(max(part, done), 1.0)
    off = 0.0
    for k in range(3):
        off += (tip[i, k] - want_tip[j - 1, k] - part * (want_tip[j, k] - want_tip[j - 1, k])) ** 2
    if not math.sqrt(off) <= near + unsure * length:
        return -1.0
    if not free:
        first, second = _weights(turn, part)
        off = 0.0
        for k in range(3):
            off += (axis[i, k] - first * want_axis[j - 1, k] - second * want_axis[j, k]) ** 2
        if not math.sqrt(off) <= bend + unsure * turn:
            return -1.0
    return part


@njit(cache=True)
def _angle(a: Floats, i: int, b: Floats, j: int) -> float:
    less, more = 0.0, 0.0
    for k in range(3):
        less += (a[i, k] - b[j, k]) ** 2
        more += (a[i, k] + b[j, k]) ** 2
    return 2.0 * math.atan2(math.sqrt(less), math.sqrt(more))


@njit(cache=True)
def _weights(turn: float, part: float) -> tuple[float, float]:
    """Weights of both ends for the vector on a great circle of ``turn`` radians."""
    sine = math.sin(turn)
    if sine < 1e-9:
        return 1.0 - part, part
    return math.sin((1.0 - part) * turn) / sine, math.sin(part * turn) / sine


class LinearizationErrors:
    """How far the tool leaves its way within motions; gathered as a run goes by, of what is off some are named.

    The way of a motion that goes to a CL point, or leads there, is the CL file's: the straight line and the great
    circle from the point before. Without a CL file, and for the tool axis in rapids, it is that from end to end.

    tip   mm from the straight line, without TCP
    axis  degrees from the great circle, wherever the control moves angles
    """

    def __init__(
        self,
        run: Run,
        max_rows: int,
        tip_limit: float,
        axis_limit: float,
        rounded: float = 0.0,
        expected: ExpectedPath | None = None,
        matching: "Matching | None" = None,
    ) -> None:
        self._run = run
        self._unsure = 2.0 * math.sqrt(3.0) * rounded
        self._chain = kinematic_chain(run.machine)
        self._rotary = np.array(run.machine.rotary, np.int64)
        self._wanted = expected
        self._leads = np.full(len(run), -1, np.int64)
        if expected is not None and matching is not None:
            for nc, cl in matching.all_pair_chunks():
                self._leads[nc] = np.where(np.isin(cl, expected.first_rows) | (expected.kind(cl) == Kind.ARC), -1, cl)
        self.tip = WorstRows(tip_limit, max_rows)
        self.axis = WorstRows(axis_limit, max_rows)

    def take(self, first: int, end: int, poses: RowPositions) -> None:
        """Add rows, in order; ``poses`` is the ``Run.chunk`` of them.

        Rapids count only where the tip is judged, and those that place nothing but rotary axes never.
        """
        run = self._run
        kind, programmed = run.kind[first:end], run.programmed[first:end]
        tcp, frame = run.state.tcp.part(first, end), run.state.machine_frame.part(first, end)
        turned = np.abs(np.diff(poses.joints[:, self._rotary], axis=0)).max(axis=1) > _STILL
        places = (programmed & int(ProgrammedWord.X | ProgrammedWord.Y | ProgrammedWord.Z | ProgrammedWord.VECTOR)) != 0
        looked = turned & ~frame & (kind != Kind.ARC)
        looked &= (kind != Kind.RAPID) | (~tcp & places & math.isfinite(self.tip.limit))
        looked &= ~tcp | (run.orientation_between(first, end) == Orientation.ANGLES)
        rows = np.flatnonzero(looked)
        # The ends of each way: of the motion itself, or of the CL file's way that it is on.
        tips = np.stack((poses.tip[rows], poses.tip[rows + 1]), axis=1)
        axes = np.stack((poses.axis[rows], poses.axis[rows + 1]), axis=1)
        led = np.flatnonzero(self._leads[first + rows] >= 0)
        if self._wanted is not None and len(led):
            cl = self._leads[first + rows[led]]
            order = np.argsort(cl, kind="stable")
            led, cl = led[order], cl[order]
            tips[led] = np.stack((self._wanted.tip(cl - 1), self._wanted.tip(cl)), axis=1)
            cuts = kind[rows[led]] != Kind.RAPID
            axes[led[cuts]] = np.stack((self._wanted.axis(cl[cuts] - 1), self._wanted.axis(cl[cuts])), axis=1)
        off_tip, off_axis = np.zeros(end - first), np.zeros(end - first)
        free = kind[rows] == Kind.RAPID
        _leave(
            self._chain, poses.joints, poses.tip, poses.axis, rows, tips, axes, free, tcp, self._unsure,
            off_tip, off_axis,
        )  # fmt: skip
        self.tip.take(first, off_tip)
        self.axis.take(first, off_axis)


@njit(cache=True)
def _leave(
    chain: KinematicChain,
    joints: Floats,
    tip_at: Floats,
    axis_at: Floats,
    rows: Ints,
    tips: Floats,
    axes: Floats,
    free: Flags,
    tcp: Flags,
    unsure: float,
    off_tip: Floats,
    off_axis: Floats,
) -> None:
    """Write how far the tool is off within ``rows``, mm and degrees.

    ``joints``, ``tip_at`` and ``axis_at`` have the place before the rows in front. ``tips`` and ``axes`` (k, 2, 3) are
    the ends of the ways that the k rows are on; ``free`` ones have their own ends for the tool axis. By
    ``unsure`` mm of its way a tip may be off.
    """
    here, tip, axis = np.empty(5), np.empty(3), np.empty(3)
    for k in range(rows.shape[0]):
        row = rows[k]
        worst_tip, worst_axis = 0.0, 0.0
        turn = _angle(axes[k], 0, axes[k], 1)
        begin, end = 0.0, 1.0
        if not free[k]:
            begin = _part_done(tip_at, axis_at, row, tips[k], axes[k], turn)
            end = _part_done(tip_at, axis_at, row + 1, tips[k], axes[k], turn)
        for look in range(1, _LOOKS + 1):
            share = look / (_LOOKS + 1.0)
            for c in range(5):
                here[c] = joints[row, c] + share * (joints[row + 1, c] - joints[row, c])
            forward_row(chain, here, tip, axis)
            part = begin + share * (end - begin)
            way, along, off = 0.0, 0.0, 0.0
            for c in range(3):
                way += (tips[k, 1, c] - tips[k, 0, c]) ** 2
                along += (tip[c] - tips[k, 0, c]) * (tips[k, 1, c] - tips[k, 0, c])
            along = min(max(along / way, 0.0), 1.0) if way > _SHORT * _SHORT else part
            for c in range(3):
                off += (tip[c] - tips[k, 0, c] - along * (tips[k, 1, c] - tips[k, 0, c])) ** 2
            if not tcp[row]:
                worst_tip = max(worst_tip, math.sqrt(off))
            first, second = _weights(turn, part)
            off = 0.0
            for c in range(3):
                off += (axis[c] - first * axes[k, 0, c] - second * axes[k, 1, c]) ** 2
            worst_axis = max(worst_axis, 2.0 * math.asin(min(0.5 * math.sqrt(off), 1.0)))
        if not free[k] and way > _SHORT * _SHORT:
            worst_axis = max(worst_axis - unsure / math.sqrt(way) * turn, 0.0)
        off_tip[row], off_axis[row] = worst_tip, math.degrees(worst_axis)


@njit(cache=True)
def _part_done(tip_at: Floats, axis_at: Floats, row: int, tips: Floats, axes: Floats, turn: float) -> float:
    """How much of a way is done at a place: by the tip, or by the tool axis where the tip rests."""
    way, along = 0.0, 0.0
    for c in range(3):
        way += (tips[1, c] - tips[0, c]) ** 2
        along += (tip_at[row, c] - tips[0, c]) * (tips[1, c] - tips[0, c])
    if way > _SHORT * _SHORT:
        return min(max(along / way, 0.0), 1.0)
    return min(_angle(axis_at, row, axes, 0) / turn, 1.0) if turn > 1e-9 else 1.0
