"""Where the tool is between the rows of a run, as the control interpolates.

In:     a ``Run`` and how many pieces each row is cut into.
Out:    axis values, tip and tool axis at the end of every piece, row after row.
Units:  mm and degrees, workpiece frame.

With TCP the tip moves on its line or circle, and the tool axis with it: angles linear, or the vector on a great
circle. Without it the axes themselves move linearly, and the tip goes where they take it. On circles the tip stays on
the circle in both cases; the rotary angles are linear.
"""

from dataclasses import dataclass

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.machines import forward
from trunnion.machines.inverse import kinematic_parameters
from trunnion.model import axis_positions
from trunnion.model.run import Orientation, Run
from trunnion.model.toolpath import Kind

#: Start and end nearer than this, mm, make a full circle.
FULL_CIRCLE_GAP: float = 1e-6


@dataclass(frozen=True, slots=True, eq=False)
class Samples:
    """Positions along rows, in order; the last one of each row is its end.

    row       (k,)   int64    row that the sample belongs to
    fraction  (k,)   float64  how much of the row is done, in (0, 1]
    joints    (k, 5) float64  mm or deg, machine order
    tip       (k, 3) float64  mm, workpiece frame
    axis      (k, 3) float64  unit vectors, workpiece frame
    """

    row: Ints
    fraction: Floats
    joints: Floats
    tip: Floats
    axis: Floats


def subdivide(run: Run, pieces: int | Ints, rows: slice = slice(None)) -> Samples:
    """Cut rows of a run into pieces, equal parts of each block.

    Parameters
    ----------
    run
        The run.
    pieces
        At least 1; a number for all rows, or one for each row of ``rows``.
    rows
        Consecutive rows, all of them by default.
    """
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
    start = before[row - first]
    joints = start + fraction[:, None] * (run.joints[row] - start)
    tip, axis = np.empty((len(row), 3)), np.empty((len(row), 3))
    arc = run.kind[row] == Kind.ARC
    xyz_is_tip = (run.tcp[row] & ~run.machine_frame[row]) | arc
    tip[xyz_is_tip] = _interpolated_tips(run, row[xyz_is_tip], fraction[xyz_is_tip], before[row[xyz_is_tip] - first])
    great = run.tcp[row] & ~run.machine_frame[row] & ~arc & (run.orientation[row] == Orientation.GREAT_CIRCLE)
    if great.any():
        _great_circle(run, row, fraction, before, first, great, joints)
    if xyz_is_tip.any():
        turned = joints[np.ix_(xyz_is_tip, run.machine.rotary)]
        every = np.ones(len(turned), np.bool_)
        joints[xyz_is_tip] = axis_positions.joints_from_rows(
            run.machine, kinematic_parameters(run.machine), every, tip[xyz_is_tip], turned
        )
    reached, axis = forward(run.machine, joints)
    tip[~xyz_is_tip] = reached[~xyz_is_tip]
    ends = fraction == 1.0
    joints[ends], tip[ends], axis[ends] = run.joints[row[ends]], run.tip[row[ends]], run.axis[row[ends]]
    return Samples(row, fraction, joints, tip, axis)


def _interpolated_tips(run: Run, row: Ints, fraction: Floats, before: Floats) -> Floats:
    """Tips on lines and circles, (k, 3)."""
    start = forward(run.machine, before)[0]
    end = run.tip[row]
    tip = start + fraction[:, None] * (end - start)
    which = np.searchsorted(run.arcs.row, row)
    on_arc = run.kind[row] == Kind.ARC
    if on_arc.any():
        k = which[on_arc]
        tip[on_arc] = circle_points(
            start[on_arc],
            end[on_arc],
            run.arcs.centre[k],
            run.arcs.normal[k],
            run.arcs.full_turns[k],
            fraction[on_arc],
        )
    return np.asarray(tip)


def circle_points(start: Floats, end: Floats, centre: Floats, normal: Floats, turns: Ints, fraction: Floats) -> Floats:
    """Points of circles and helices, (k, 3) mm; the radius goes evenly from that of the start to that of the end."""
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
    angle = fraction * sweep
    size = (1.0 + fraction * (last - first) / np.where(first > 0.0, first, 1.0))[:, None]
    turned = np.cos(angle)[:, None] * a + np.sin(angle)[:, None] * np.cross(normal, a)
    return np.asarray(centre + size * turned + (height + fraction * rise)[:, None] * normal)


def slerp(start: Floats, end: Floats, fraction: Floats) -> Floats:
    """Unit vectors on great circles, (k, 3); opposite ones have no great circle and give the start."""
    cross = np.linalg.norm(np.cross(start, end), axis=1)
    angle = np.arctan2(cross, np.einsum("ij,ij->i", start, end))
    safe = np.where(cross > 1e-12, cross, 1.0)
    small = cross <= 1e-12
    one = np.where(small, 1.0, np.sin((1.0 - fraction) * angle) / safe)
    two = np.where(small, 0.0, np.sin(fraction * angle) / safe)
    vector = one[:, None] * start + two[:, None] * end
    return np.asarray(vector / np.linalg.norm(vector, axis=1)[:, None])


def _great_circle(
    run: Run, row: Ints, fraction: Floats, before: Floats, first: int, great: Flags, joints: Floats
) -> None:
    """Write the rotary columns of samples whose tool axis moves on a great circle."""
    begin = forward(run.machine, before[row[great] - first])[1]
    vector = slerp(begin, run.axis[row[great]], fraction[great])
    places = np.flatnonzero(great)
    # Each unbroken stretch of rows winds from where the row before it ended.
    for stretch in np.split(np.arange(len(places)), np.flatnonzero(np.diff(places) > 1) + 1):
        at = places[stretch]
        columns = np.array(run.machine.rotary)
        rotary = np.empty((len(at), 2))
        zero = np.zeros(len(at), np.uint8)
        axis_positions.resolve_angles(
            run.machine, rotary, zero, vector[stretch], before[row[at[0]] - first, columns], zero.copy()
        )
        joints[np.ix_(at, columns)] = rotary
