"""Timing: a run as motion in time, under the speeds, accelerations and jerks of the axes of its machine."""

from trunnion.timing.axis_pieces import MOST_PIECES, AxisPieces, axis_pieces
from trunnion.timing.dynamics import AxisDynamics
from trunnion.timing.fastest import AxisMotion, FastestRun, SmoothPath, fastest_run
from trunnion.timing.path import Path, steady
from trunnion.timing.path_modes import CORNER_TOLERANCE
from trunnion.timing.planner import piece_seconds, timed_pieces
from trunnion.timing.reached_feeds import HARDLY_MOVES, ReachedFeeds, reached_feeds
from trunnion.timing.row_feeds import RowFeeds, fill_feeds
from trunnion.timing.row_interpolation import SAG
from trunnion.timing.run_timer import RowTimes, RunTimer
from trunnion.timing.schedule import TimedEvent
from trunnion.timing.speed_kernel import plan_speeds
from trunnion.timing.timed_run import MachineState, TimedRun, time_run

#: Kernels that time most programs.
KERNELS = (fill_feeds, plan_speeds)

__all__ = [
    "CORNER_TOLERANCE",
    "HARDLY_MOVES",
    "KERNELS",
    "MOST_PIECES",
    "SAG",
    "AxisDynamics",
    "AxisMotion",
    "AxisPieces",
    "FastestRun",
    "MachineState",
    "Path",
    "ReachedFeeds",
    "RowFeeds",
    "RowTimes",
    "RunTimer",
    "SmoothPath",
    "TimedEvent",
    "TimedRun",
    "axis_pieces",
    "fastest_run",
    "piece_seconds",
    "reached_feeds",
    "steady",
    "time_run",
    "timed_pieces",
]
