"""Timing: a run as motion in time, under the speeds, accelerations and jerks of the axes of its machine."""

from trunnion.timing.axis_pieces import SAG, AxisPieces, axis_pieces
from trunnion.timing.dynamics import AxisDynamics
from trunnion.timing.timed_run import MachineState, TimedEvent, TimedRun, time_run

__all__ = [
    "SAG",
    "AxisDynamics",
    "AxisPieces",
    "MachineState",
    "TimedEvent",
    "TimedRun",
    "axis_pieces",
    "time_run",
]
