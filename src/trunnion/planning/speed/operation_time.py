"""How long an operation takes on the machine: an estimate for people, by ``trunnion.timing``."""

from typing import Final

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.machines import Machine, slide_positions
from trunnion.model.motion import Motion
from trunnion.model.subdivision import circle_points
from trunnion.model.toolpath import Dwell, Kind, Stop
from trunnion.planning.linearization.arc_chords import arc_sweeps
from trunnion.planning.rotary_positions import continuous_positions
from trunnion.planning.speed.rotary_speed import REST_LENGTH, tip_speeds
from trunnion.timing import CORNER_TOLERANCE, AxisDynamics, Path, piece_seconds

#: How far the pieces of an arc are from it, mm, and how many it has at most.
_SAG: Final = 0.01
_MOST_PIECES: Final = 4096


def row_durations(machine: Machine, motion: Motion) -> Floats:
    """(n,) float64: duration of every row, s; that of the first one is not known and left out.

    The axes stop for dwells and program stops, and where the tip begins or ceases to rest. Dwells themselves take no
    time here.
    """
    moves, arcs = motion.operation.moves, motion.operation.arcs
    rotary = continuous_positions(machine, motion.rotary)
    joints = slide_positions(machine, moves.tip, rotary)
    steps = np.diff(joints, axis=0, prepend=joints[:1])
    length = np.linalg.norm(np.diff(moves.tip, axis=0, prepend=moves.tip[:1]), axis=1)
    rise = np.einsum("ij,ij->i", moves.tip[arcs.row] - moves.tip[arcs.row - 1], arcs.normal)
    sweeps = arc_sweeps(motion.operation)
    length[arcs.row] = np.hypot(sweeps * arcs.radius, rise)
    rests = length < REST_LENGTH
    length = np.where(rests, np.abs(steps[:, list(machine.rotary)]).max(axis=1), length)
    rate = tip_speeds(motion.operation)
    rate = np.where((moves.kind == Kind.RAPID) | ~(rate > 0.0), np.inf, rate)
    stop = np.append(rests[1:] != rests[:-1], True)
    stop[[event.row - 1 for event in motion.operation.events if isinstance(event, Dwell | Stop) and event.row]] = True
    tolerance = np.full(len(steps), CORNER_TOLERANCE)
    counts = np.ones(len(steps), np.int64)
    counts[arcs.row] = np.clip(np.ceil(sweeps * np.sqrt(arcs.radius / (8.0 * _SAG))), 1, _MOST_PIECES)
    row = np.repeat(np.arange(len(steps)), counts)
    last = np.cumsum(counts) - 1
    ends = np.zeros(len(row), np.bool_)
    ends[last] = True
    cut = _cut_steps(machine, motion, rotary, row, (np.arange(len(row)) - last[row] + counts[row]) / counts[row])
    path = Path(
        cut, (length / counts)[row], rate[row], tolerance[row], ends & stop[row], ~ends, counts,
    )  # fmt: skip
    return path.of_rows(piece_seconds(path, AxisDynamics.of(machine)))


def _cut_steps(machine: Machine, motion: Motion, rotary: Floats, row: Ints, done: Floats) -> Floats:
    """How far axes go in pieces of rows, (m, 5); ``done`` (m,): share of its row that is done at the end of each."""
    moves, arcs = motion.operation.moves, motion.operation.arcs
    before = np.maximum(row - 1, 0)
    share = done[:, None]
    tips = moves.tip[before] + share * (moves.tip[row] - moves.tip[before])
    on_arc = np.isin(row, arcs.row)
    if on_arc.any():
        k = np.searchsorted(arcs.row, row[on_arc])
        tips[on_arc] = circle_points(
            moves.tip[before[on_arc]], moves.tip[row[on_arc]], arcs.centre[k], arcs.normal[k], arcs.full_turns[k],
            done[on_arc],
        )  # fmt: skip
    whole = done == 1.0
    tips[whole] = moves.tip[row[whole]]
    joints = slide_positions(machine, tips, rotary[before] + share * (rotary[row] - rotary[before]))
    return np.asarray(np.diff(joints, axis=0, prepend=joints[:1]))


def operation_seconds(machine: Machine, motion: Motion) -> float:
    """Duration of an operation from its first point to its last, s, with the dwells that are given in seconds."""
    dwells = [e.amount for e in motion.operation.events if isinstance(e, Dwell) and not e.revolutions]
    return float(row_durations(machine, motion).sum()) + sum(dwells)
