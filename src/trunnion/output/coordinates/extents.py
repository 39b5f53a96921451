"""The box around all cuts of a program, for a block form and for lists of operations."""

from collections.abc import Sequence

import numpy as np

from trunnion.arrays import Floats
from trunnion.model.motion import Motion
from trunnion.model.subdivision import FULL_CIRCLE_GAP
from trunnion.model.toolpath import CycleOff, CycleOn, Kind
from trunnion.planning.holes.cycles import cycle_from_event


def cut_extents(motions: Sequence[Motion]) -> tuple[Floats, Floats] | None:
    """Return the lower and the upper corner of the box around all cuts of the tip, rounded outwards.

    Parameters
    ----------
    motions
        In program coordinates.

    Returns
    -------
    lower, upper
        (3,) each, whole millimetres, at least 1 mm apart in every direction; None if nothing is cut.
    """
    box = _box([point for motion in motions for point in (*_cut_points(motion), *_whole_circles(motion))])
    if box is None:
        return None
    low, high = np.floor(box[0]), np.ceil(box[1])
    return low, np.maximum(high, low + 1.0)


def cut_box(motions: Sequence[Motion]) -> tuple[Floats, Floats] | None:
    """Return the corners as they are, mm, with what arcs pass and no more; None if nothing is cut."""
    return _box([point for motion in motions for point in (*_cut_points(motion), *_passed_by_arcs(motion))])


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
    """Corners of the boxes of whole circles."""
    arcs = motion.operation.arcs
    half_sides = arcs.radius[:, None] * np.sqrt(np.maximum(1.0 - arcs.normal**2, 0.0))
    return [arcs.centre - half_sides, arcs.centre + half_sides]


def _passed_by_arcs(motion: Motion) -> list[Floats]:
    """The extreme points in X, Y and Z of circles, as far as their arcs pass them; of helices at their end's height."""
    moves, arcs = motion.operation.moves, motion.operation.arcs
    if not len(arcs.row):
        return []
    normal, end = arcs.normal, moves.tip[arcs.row] - arcs.centre
    rise = np.einsum("ij,ij->i", end, normal)[:, None] * normal
    start = moves.tip[np.maximum(arcs.row - 1, 0)] - arcs.centre
    start = start - np.einsum("ij,ij->i", start, normal)[:, None] * normal
    sweep = _turned(start, end - rise, normal)
    is_whole = (arcs.full_turns > 0) | (np.linalg.norm(end - rise - start, axis=1) < FULL_CIRCLE_GAP)
    points: list[Floats] = []
    for direction in np.concatenate((np.eye(3), -np.eye(3))):
        across = direction - (normal @ direction)[:, None] * normal
        size = np.linalg.norm(across, axis=1)
        towards = across / np.maximum(size, 1e-9)[:, None]
        passed = (size > 1e-9) & (is_whole | (_turned(start, towards, normal) <= sweep))
        points.append((arcs.centre + arcs.radius[:, None] * towards + rise)[passed])
    return points


def _turned(start: Floats, end: Floats, normal: Floats) -> Floats:
    """Angles from one direction to another about a normal, (n,), 0 to a whole turn, rad."""
    sine = np.einsum("ij,ij->i", np.cross(start, end), normal)
    found: Floats = np.arctan2(sine, np.einsum("ij,ij->i", start, end)) % (2.0 * np.pi)
    return found
