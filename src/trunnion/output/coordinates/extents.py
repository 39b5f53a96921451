"""The box around all cuts of a program, for a block form and for lists of operations."""

from collections.abc import Sequence

import numpy as np

from trunnion.arrays import Floats
from trunnion.model.arc_extremes import operation_arcs, tip_reach
from trunnion.model.motion import Motion
from trunnion.model.toolpath import CycleOff, CycleOn, Kind
from trunnion.planning.holes.cycles import cycle_from_event


def cut_extents(motions: Sequence[Motion]) -> tuple[Floats, Floats] | None:
    """Return the lower and the upper corner of the box around all cuts of the tip, rounded outwards.

    motions  in program coordinates

    lower, upper  (3,) each, whole millimetres, at least 1 mm apart in every direction; None if nothing is cut
    """
    box = _box([point for motion in motions for point in (*_cut_points(motion), *_whole_circles(motion))])
    if box is None:
        return None
    low, high = np.floor(box[0]), np.ceil(box[1])
    return low, np.maximum(high, low + 1.0)


def cut_box(motions: Sequence[Motion]) -> tuple[Floats, Floats] | None:
    """Return the corners as they are, mm, with what arcs pass and no more; None if nothing is cut."""
    return _box([point for motion in motions for point in (*_cut_points(motion), *_passed_by_arcs(motion))])


def highest_point(motions: Sequence[Motion], axis: Floats) -> float:
    """Return how high the tip comes along a direction (3,) anywhere, at rapid too, mm from the program's zero."""
    heights = []
    for motion in motions:
        heights.append(motion.operation.moves.tip @ axis)
        low, high = _passed_by_arcs(motion)
        heights.append(np.maximum(low * axis, high * axis).sum(axis=1))
    return float(np.concatenate(heights).max())


def _box(points: Sequence[Floats]) -> tuple[Floats, Floats] | None:
    cut = np.concatenate(points) if points else np.zeros((0, 3))
    if not len(cut):
        return None
    # Column by column: NumPy takes ten times as long along the rows.
    return np.array([column.min() for column in cut.T]), np.array([column.max() for column in cut.T])


def _cut_points(motion: Motion) -> list[Floats]:
    """Points of the tip's cuts: their ends with the points before, holes top and bottom."""
    moves = motion.operation.moves
    touched = moves.kind != Kind.RAPID
    touched[:-1] |= touched[1:]
    points = [np.compress(touched, moves.tip, axis=0)]
    cycles = [event for event in motion.operation.events if isinstance(event, CycleOn | CycleOff)]
    ends = [*(event.row for event in cycles[1:]), len(moves)]
    for event, end in zip(cycles, ends, strict=True) if cycles else ():
        if isinstance(event, CycleOn):
            holes = slice(event.row, end)
            points += [moves.tip[holes], moves.tip[holes] - cycle_from_event(event).depth * moves.axis[holes]]
    return points


def _whole_circles(motion: Motion) -> list[Floats]:
    """Corners of the boxes of whole circles, where arcs start and where they end."""
    arcs = motion.operation.arcs
    half_sides = arcs.radius[:, None] * np.sqrt(np.maximum(1.0 - arcs.normal**2, 0.0))
    points, moves = [arcs.centre - half_sides, arcs.centre + half_sides], motion.operation.moves
    for tip in (moves.tip[np.maximum(arcs.row - 1, 0)], moves.tip[arcs.row]):
        height = np.einsum("ij,ij->i", tip - arcs.centre, arcs.normal)[:, None] * arcs.normal
        # The last bit of a sum must not make a box that is a whole millimetre larger.
        points += [np.round(corner + height, 9) for corner in points[:2]]
    return points


def _passed_by_arcs(motion: Motion) -> list[Floats]:
    """Corners of the boxes around what arcs pass between their ends."""
    paths = operation_arcs(motion.operation)
    start, reach = paths.start, tip_reach(paths)
    return [np.minimum(start, reach.low), np.maximum(start, reach.high)]
