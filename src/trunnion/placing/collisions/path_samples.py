"""A path at one turn as moments, between which every axis moves evenly.

While rotary axes turn under TCP, moments are half a degree apart at most; on arcs a chord tolerance says how far.
Slides are linear functions of the workpiece zero in each of them.
"""

import math
from collections.abc import Mapping
from functools import cached_property
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.machines import Machine
from trunnion.model.subdivision import arc_frames, circle_points
from trunnion.placing.axis_equations import axis_equations
from trunnion.placing.moving_samples import turning_samples
from trunnion.placing.path_rows import PathRows
from trunnion.records import dataclass

#: How far chords of arcs are off them, mm.
CHORD: Final = 0.01

_MOST_CHORDS: Final = 720

#: Rotary axes that turn by less stand, by more are rewound, which the planner does away from the part; degrees.
_STANDS: Final = 1e-9
_REWINDS: Final = 180.001


@dataclass(frozen=True, eq=False)
class PathSamples:
    """m moments of a path in their order.

    angles   (m, 2) positions of the rotary axes, in the order of ``machine.rotary``, degrees
    normals  (m, 3, 3), offsets (m, 3): the slides stand at normals . zero + offsets, in the order of ``machine.linear``
    row      (m,) of the path: of its end, or on the way to it
    begins   (m,) bool: no way leads there
    tool     (m,) which tool is in the spindle
    """

    angles: Floats
    normals: Floats
    offsets: Floats
    row: Ints
    begins: Flags
    tool: Ints

    def __len__(self) -> int:
        return len(self.row)

    def some(self, count: int, rows: Ints) -> "PathSamples":
        """Return some of them, and those of certain rows, without ways between: what is found there holds, but is not
        all.
        """
        keep = np.isin(self.row, rows)
        keep[:: max(1, len(self) // count)] = True
        which = np.flatnonzero(keep)
        return PathSamples(
            self.angles[which], self.normals[which], self.offsets[which], self.row[which],
            np.ones(len(which), np.bool_), self.tool[which],
        )  # fmt: skip

    @cached_property
    def turn(self) -> Floats:
        """How far both rotary axes turn on the way to each moment, (m,) radians."""
        return np.asarray(np.radians(np.abs(np.diff(self.angles, axis=0, prepend=self.angles[:1]))).sum(axis=1))

    @cached_property
    def drift(self) -> Floats:
        """How much farther bodies may move until each moment for each mm that the zero is elsewhere, (m,)."""
        changes = np.diff(self.normals, axis=0, prepend=self.normals[:1])
        changed, long = (np.sqrt((each * each).sum(axis=2)).sum(axis=1) for each in (changes, self.normals))
        return np.asarray(np.cumsum(changed + self.turn * (long + 1.0)))

    def ranges(self, tool: int) -> Ints:
        """First and end (exclusive) of the moments with a tool, (k, 2)."""
        flags = np.concatenate(([False], self.tool == tool, [False]))
        edges = np.flatnonzero(flags[1:] != flags[:-1])
        return edges.reshape(-1, 2)


def path_samples(
    machine: Machine, rows: PathRows, positions: Floats, tool: Ints, lengths: Mapping[int, float]
) -> PathSamples:
    """Return the moments of a path.

    machine    without a workpiece zero
    rows       as the part is turned
    positions  (n, 2) float64: of the rotary axes, degrees
    tool       (n,) int64: of each row
    lengths    of tools, gauge point to tip, mm; others have that of the machine
    """
    between = [turning_samples(rows, positions), _chord_samples(rows, positions)]
    tip = np.concatenate([rows.tip, *(one[0] for one in between)])
    angles = np.concatenate([positions, *(one[1] for one in between)])
    row = np.concatenate([np.arange(len(rows)), *(one[2] for one in between)])
    is_end = np.arange(len(row)) < len(rows)
    order = np.lexsort((np.arange(len(row)), is_end, row))
    tip, angles, row, is_end = tip[order], np.ascontiguousarray(angles[order]), row[order], is_end[order]
    way = np.abs(np.diff(positions, axis=0, prepend=positions[:1])).max(axis=1)
    breaks = rows.begins | (rows.straight & (way > _REWINDS))
    is_first = np.append(True, row[1:] != row[:-1])
    own = tool[row]
    normals, offsets, _ = axis_equations(machine, tip, angles, lengths_of(lengths, own))
    return PathSamples(angles, normals, offsets, row, breaks[row] & is_first, own)


def lengths_of(lengths: Mapping[int, float], tool: Ints) -> Floats:
    """Of tools (n,) their lengths, mm; NaN where they are not known."""
    found = np.full(len(tool), np.nan)
    for number, length in lengths.items():
        found[tool == number] = length
    return found


def _chord_samples(rows: PathRows, angles: Floats) -> tuple[Floats, Floats, Ints]:
    """Tips (k, 3), rotary positions (k, 2) and rows (k,) between the ends of arcs on which rotary axes stand."""
    before = np.maximum(rows.arc_row - 1, 0)
    stands = np.abs(angles[rows.arc_row] - angles[before]).max(axis=1, initial=0.0) <= _STANDS
    which = np.flatnonzero(stands & ~rows.begins[rows.arc_row])
    if not len(which):
        return np.zeros((0, 3)), np.zeros((0, 2)), np.zeros(0, np.int64)
    arcs, row = rows.arcs.select(which), rows.arc_row[which]
    sweep = arc_frames(arcs.start, arcs.end, arcs.centre, arcs.normal, arcs.full_turns).sweep
    radius = np.linalg.norm(arcs.start - arcs.centre, axis=1)
    step = 2.0 * np.arccos(np.maximum(1.0 - CHORD / np.maximum(radius, CHORD), math.cos(1.0)))
    count = np.minimum(np.ceil(np.abs(sweep) / step), _MOST_CHORDS).astype(np.int64) - 1
    count = np.maximum(count, 0)
    arc = np.repeat(np.arange(len(which)), count)
    place = np.arange(len(arc)) - np.repeat(np.cumsum(count) - count, count) + 1.0
    share = place / (count[arc] + 1.0)
    on = arcs.select(arc)
    tip = circle_points(on.start, on.end, on.centre, on.normal, on.full_turns, share)
    return np.asarray(tip), angles[row[arc]], row[arc]
