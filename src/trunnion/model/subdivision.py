"""Positions of axes and tool between the rows of a run, as the control interpolates them.

In:     a ``Run`` and the number of pieces into which each row is cut.
Out:    axis values, tip and tool axis at the end of every piece, row after row.
Units:  mm and degrees, workpiece frame.

With TCP the tip moves on its line or circle, while the rotary angles move linearly or the tool axis on a great circle.
Without TCP the axes move linearly and the tip follows from them. On circles the tip stays on the circle in both cases,
and the rotary angles move linearly.
"""

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.machines import forward
from trunnion.model import axis_positions
from trunnion.model.run import Orientation, Run
from trunnion.model.toolpath import Kind
from trunnion.records import dataclass

#: If start and end are nearer than this, mm, the circle is a full one.
FULL_CIRCLE_GAP: float = 1e-6


@dataclass(frozen=True, slots=True, eq=False)
class Samples:
    """Positions along rows, in order; the last sample of each row is its end.

    row       (k,)   int64    row that the sample belongs to
    fraction  (k,)   float64  completed part of the row, in (0, 1]
    joints    (k, 5) float64  mm or deg, machine order
    tip       (k, 3) float64  mm, workpiece frame
    axis      (k, 3) float64  unit vectors, workpiece frame
    """

    row: Ints
    fraction: Floats
    joints: Floats
    tip: Floats
    axis: Floats


@dataclass(frozen=True, slots=True, eq=False)
class _Pieces:
    """The pieces of rows: row and completed part as in ``Samples``, and the joints (k, 5) at the start of their row."""

    row: Ints
    fraction: Floats
    start: Floats


def subdivide(run: Run, pieces: int | Ints, rows: slice = slice(None)) -> Samples:
    """Cut rows of a run into pieces of equal length.

    run     the run
    pieces  at least 1; a number for all rows, or one for each row of ``rows``
    rows    consecutive rows, all of them by default
    """
    cut = _cut(run, pieces, rows)
    row, fraction = cut.row, cut.fraction
    joints = cut.start + fraction[:, None] * (run.joints[row] - cut.start)
    tip = np.empty((len(row), 3))
    arc = run.kind[row] == Kind.ARC
    tcp = run.tcp[row] & ~run.machine_frame[row]
    by_tip = tcp | arc
    tip[by_tip] = _interpolated_tips(run, row[by_tip], fraction[by_tip], cut.start[by_tip])
    great_circle = tcp & ~arc & (run.orientation[row] == Orientation.GREAT_CIRCLE)
    if great_circle.any():
        _move_on_great_circles(run, cut, great_circle, joints)
    if by_tip.any():
        rotary = joints[np.ix_(by_tip, run.machine.rotary)]
        every = np.ones(len(rotary), np.bool_)
        joints[by_tip] = run.solved_at(row[by_tip], every, tip[by_tip], rotary)
    reached, axis = run.forward_at(row, joints)
    tip[~by_tip] = reached[~by_tip]
    ends = fraction == 1.0
    joints[ends], tip[ends], axis[ends] = run.joints[row[ends]], run.tip[row[ends]], run.axis[row[ends]]
    return Samples(row, fraction, joints, tip, axis)


def _cut(run: Run, pieces: int | Ints, rows: slice) -> _Pieces:
    first, last, step = rows.indices(len(run))
    if step != 1:
        raise ValueError("rows must be consecutive")
    count = max(last - first, 0)
    cuts = np.broadcast_to(np.asarray(pieces, np.int64), (count,))
    if count and int(cuts.min()) < 1:
        raise ValueError("every row has at least one piece")
    row = np.repeat(np.arange(first, first + count), cuts)
    begin = np.repeat(np.cumsum(cuts) - cuts, cuts)
    fraction = (np.arange(len(row)) - begin + 1) / np.repeat(cuts, cuts)
    before = np.vstack((run.start[None], run.joints[first : first + count]))
    if first:
        before[0] = run.joints[first - 1]
    return _Pieces(row, fraction, before[row - first])


def _interpolated_tips(run: Run, row: Ints, fraction: Floats, start_joints: Floats) -> Floats:
    """Return tips on lines and circles, (k, 3)."""
    start = run.forward_at(row, start_joints)[0]
    end = run.tip[row]
    tip = start + fraction[:, None] * (end - start)
    on_arc = run.kind[row] == Kind.ARC
    if on_arc.any():
        k = np.searchsorted(run.arcs.row, row)[on_arc]
        tip[on_arc] = circle_points(
            start[on_arc],
            end[on_arc],
            run.arcs.centre[k],
            run.arcs.normal[k],
            run.arcs.full_turns[k],
            fraction[on_arc],
        )
    return np.asarray(tip)


@dataclass(frozen=True, slots=True, eq=False)
class ArcFrames:
    """How the tip moves on m arcs and helices.

    across  (m, 3)  from the axis to the start, mm
    height  (m,)    of the start over the centre, along the normal
    rise    (m,)    from start to end, along the normal
    sweep   (m,)    angle from start to end with all turns, rad
    growth  (m,)    radius at the end by that at the start
    """

    across: Floats
    height: Floats
    rise: Floats
    sweep: Floats
    growth: Floats


def arc_frames(start: Floats, end: Floats, centre: Floats, normal: Floats, turns: Ints) -> ArcFrames:
    """Return the frames of arcs; start, end, centre and normal (m, 3)."""
    rise = np.einsum("ij,ij->i", end - start, normal)
    a = start - centre
    a = a - np.einsum("ij,ij->i", a, normal)[:, None] * normal
    b = end - centre
    b = b - np.einsum("ij,ij->i", b, normal)[:, None] * normal
    height = np.einsum("ij,ij->i", start - centre, normal)
    sweep = np.arctan2(np.einsum("ij,ij->i", np.cross(a, b), normal), np.einsum("ij,ij->i", a, b))
    full = np.linalg.norm(a - b, axis=1) < FULL_CIRCLE_GAP
    sweep = np.where(full, 2.0 * np.pi, np.where(sweep <= 0.0, sweep + 2.0 * np.pi, sweep)) + 2.0 * np.pi * turns
    first, last = np.linalg.norm(a, axis=1), np.linalg.norm(b, axis=1)
    return ArcFrames(a, height, rise, sweep, 1.0 + (last - first) / np.where(first > 0.0, first, 1.0))


def circle_points(start: Floats, end: Floats, centre: Floats, normal: Floats, turns: Ints, fraction: Floats) -> Floats:
    """Return points of circles and helices, (k, 3) mm; the radius changes evenly from that at start to that at end."""
    frame = arc_frames(start, end, centre, normal, turns)
    a, angle = frame.across, fraction * frame.sweep
    size = (1.0 + fraction * (frame.growth - 1.0))[:, None]
    rotated = np.cos(angle)[:, None] * a + np.sin(angle)[:, None] * np.cross(normal, a)
    return np.asarray(centre + size * rotated + (frame.height + fraction * frame.rise)[:, None] * normal)


def slerp(start: Floats, end: Floats, fraction: Floats) -> Floats:
    """Return unit vectors on great circles, (k, 3); opposite vectors have no great circle and give the start."""
    cross = np.linalg.norm(np.cross(start, end), axis=1)
    angle = np.arctan2(cross, np.einsum("ij,ij->i", start, end))
    safe = np.where(cross > 1e-12, cross, 1.0)
    small = cross <= 1e-12
    one = np.where(small, 1.0, np.sin((1.0 - fraction) * angle) / safe)
    two = np.where(small, 0.0, np.sin(fraction * angle) / safe)
    vector = one[:, None] * start + two[:, None] * end
    return np.asarray(vector / np.linalg.norm(vector, axis=1)[:, None])


def _move_on_great_circles(run: Run, cut: _Pieces, great_circle: Flags, joints: Floats) -> None:
    """Write the rotary columns of the pieces whose tool axis moves on a great circle."""
    begin = forward(run.machine, cut.start[great_circle])[1]
    vector = slerp(begin, run.axis[cut.row[great_circle]], cut.fraction[great_circle])
    places = np.flatnonzero(great_circle)
    columns = np.array(run.machine.rotary)
    # The turns of every unbroken sequence continue from the row before it.
    for sequence in np.split(np.arange(len(places)), np.flatnonzero(np.diff(places) > 1) + 1):
        at = places[sequence]
        no_turn_rule = np.zeros(len(at), np.uint8)
        words = axis_positions.RotaryWords(np.empty((len(at), 2)), no_turn_rule, vector[sequence])
        axis_positions.resolve_angles(run.machine, words, cut.start[at[0], columns], no_turn_rule.copy())
        joints[np.ix_(at, columns)] = words.rotary
