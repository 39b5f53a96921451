"""Programs read back: an independent author of what a control does with them.

This room is written from the language of the controls. It shares nothing with what writes programs but the machine.
"""

from trunnion.reader.columns import Ramps, Steps
from trunnion.reader.families import can_read, numbers_lengths, reader_of, run_program
from trunnion.reader.feeds import FeedPath, counted, ways
from trunnion.reader.poses import joint_rows, wind
from trunnion.reader.run import (
    Comment,
    Finding,
    Happening,
    Orientation,
    Poses,
    Run,
    State,
    Stretch,
    Written,
    offset_name,
)
from trunnion.reader.subdivide import Samples, subdivide

#: Kernels that every program needs.
KERNELS = (wind, joint_rows)

__all__ = [
    "KERNELS",
    "Comment",
    "FeedPath",
    "Finding",
    "Happening",
    "Orientation",
    "Poses",
    "Ramps",
    "Run",
    "Samples",
    "State",
    "Steps",
    "Stretch",
    "Written",
    "can_read",
    "counted",
    "numbers_lengths",
    "offset_name",
    "reader_of",
    "run_program",
    "subdivide",
    "ways",
]
