"""Rapids that are lines: shops that allow no rapid motion write a high feed in its place.

What such a program does is judged as what it stands for. A cut that the CL file wants at this very feed stays a cut.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from trunnion.reader import Run
from trunnion.toolpath import Kind
from trunnion.verify.align import CHUNK
from trunnion.verify.rows import Rows

#: Two tips are the same place within this, mm.
_SAME = 1e-6


def with_rapids(run: Run, feed: float | None) -> Run:
    """The run with every line at the feed, mm/min, that stands for rapid motion as a rapid; itself without one."""
    if feed is None:
        return run
    kind = run.kind.copy()
    for start in range(0, len(run), CHUNK):
        end = min(start + CHUNK, len(run))
        fast = (run.state.feed.part(start, end) == feed) & (run.state.feed_mode.part(start, end) == 94)
        kind[start:end][fast & (kind[start:end] == Kind.LINEAR)] = Kind.RAPID
    return replace(run, kind=kind)


def levels(run: Run, extra: Sequence[int], nc: Rows) -> set[int]:
    """Which of the motions that answer to no CL point are the first leg of an approach.

    The tool has been drawn back since the last point (``retract``), goes across its axis at rapid, and then along its
    axis to the point, at rapid too. Where the machine's travel is not known, nobody knows from how high it comes.
    """
    drawn_back = np.array([event.before_row for event in run.events if event.kind == "retract"], np.int64)
    lawful = set()
    for row in extra:
        if row < 1 or row + 1 >= len(run) or row + 1 not in nc or (run.kind[row : row + 2] != Kind.RAPID).any():
            continue
        k = nc.before(row)
        last = nc[k - 1] if k else -1
        poses = run.poses(np.array([row - 1, row, row + 1]))
        across, along = np.diff(poses.tip, axis=0)
        upright = float(np.abs(poses.axis - poses.axis[0]).max()) < _SAME
        legs = abs(float(across @ poses.axis[1])) < _SAME
        legs &= float(np.linalg.norm(np.cross(along, poses.axis[1]))) < _SAME
        if upright and legs and ((drawn_back > last) & (drawn_back <= row)).any():
            lawful.add(row)
    return lawful
