"""How long an operation takes on the machine: an estimate for people, by ``trunnion.timing``."""

import numpy as np

from trunnion.arrays import Floats
from trunnion.machines import Machine, slide_positions
from trunnion.model.motion import Motion
from trunnion.model.toolpath import Dwell, Kind, Stop
from trunnion.planning.linearization.arc_chords import arc_sweeps
from trunnion.planning.rotary_positions import continuous_positions
from trunnion.planning.speed.rotary_speed import REST_LENGTH, tip_speeds
from trunnion.timing import CORNER_TOLERANCE, AxisDynamics, Path, piece_seconds


def row_durations(machine: Machine, motion: Motion) -> Floats:
    """(n,) float64: duration of every row, s; that of the first one is not known and left out.

    The axes stop for dwells and program stops, and where the tip begins or ceases to rest. Dwells themselves take no
    time here.
    """
    moves, arcs = motion.operation.moves, motion.operation.arcs
    joints = slide_positions(machine, moves.tip, continuous_positions(machine, motion.rotary))
    steps = np.diff(joints, axis=0, prepend=joints[:1])
    length = np.linalg.norm(np.diff(moves.tip, axis=0, prepend=moves.tip[:1]), axis=1)
    rise = np.einsum("ij,ij->i", moves.tip[arcs.row] - moves.tip[arcs.row - 1], arcs.normal)
    length[arcs.row] = np.hypot(arc_sweeps(motion.operation) * arcs.radius, rise)
    rests = length < REST_LENGTH
    length = np.where(rests, np.abs(steps[:, list(machine.rotary)]).max(axis=1), length)
    rate = tip_speeds(motion.operation)
    rate = np.where((moves.kind == Kind.RAPID) | ~(rate > 0.0), np.inf, rate)
    stop = np.append(rests[1:] != rests[:-1], True)
    stop[[event.row - 1 for event in motion.operation.events if isinstance(event, Dwell | Stop) and event.row]] = True
    tolerance = np.full(len(steps), CORNER_TOLERANCE)
    path = Path(steps, length, rate, tolerance, stop, np.zeros(0, np.int64))
    return piece_seconds(path, AxisDynamics.of(machine))


def operation_seconds(machine: Machine, motion: Motion) -> float:
    """Duration of an operation from its first point to its last, s, with the dwells that are given in seconds."""
    dwells = [e.amount for e in motion.operation.events if isinstance(e, Dwell) and not e.revolutions]
    return float(row_durations(machine, motion).sum()) + sum(dwells)
