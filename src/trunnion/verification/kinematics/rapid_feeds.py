"""Rapids written as lines: shops that allow no rapid motion write a high feed in its place.

Such a line is checked as the rapid that it replaces. A cut at this very feed in the CL file stays a cut, and so does
what a cycle does at its feed: that is a hole, whatever F is in force.
"""

from dataclasses import replace

from trunnion.model.programmed_words import names_no_axis
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind
from trunnion.verification.row_ranges import chunk_bounds


def restore_rapids(run: Run, feed: float | None) -> Run:
    """Return the run with lines at the feed that replaces rapid motion as rapids.

    feed  that feed, mm/min; None where rapids are written as rapids: the run itself is returned
    """
    if feed is None:
        return run
    kind = run.kind.copy()
    for start, end in chunk_bounds(len(run)):
        fast = (run.state.feed.part(start, end) == feed) & (run.state.feed_mode.part(start, end) == 94)
        fast &= (kind[start:end] == Kind.LINEAR) & ~names_no_axis(run.programmed[start:end])
        kind[start:end][fast] = Kind.RAPID
    return replace(run, kind=kind)
