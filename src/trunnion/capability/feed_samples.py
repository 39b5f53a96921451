"""Axis values along the motions at feed of a run: at their ends, and between them where they bend or turn.

In:     a ``Run``.
Out:    samples, some thousand at a time: row and axis values.
Units:  mm and degrees.
"""

from collections.abc import Iterator
from typing import Final, NamedTuple

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.model.run import CHUNK_ROWS, PositionChunk, Run
from trunnion.model.subdivision import arc_frames, subdivide
from trunnion.model.toolpath import Kind

#: Between two samples rotary axes turn, and arcs bend, by no more than this, degrees. What varies with the sine of an
#: angle is then at most 0.1 % larger between two samples.
_TURN: Final = 5.0

#: Pieces of an arc need not be shorter than this, mm.
_PIECE: Final = 1.0

#: Pieces of one motion at most: a helix may have any number of turns.
_MOST: Final = 512


class FeedSamples(NamedTuple):
    """Samples in the order of the program: ``row`` (k,) int64, and ``joints`` (k, 5) in the order of the machine."""

    row: Ints
    joints: Floats


def feed_samples(run: Run) -> Iterator[FeedSamples]:
    """Yield samples of the motions at feed in coordinates of the workpiece, at least one of each that can be made."""
    for first, end, poses in run.chunks():
        at_feed = (run.kind[first:end] != Kind.RAPID) & ~run.state.machine_frame.part(first, end)
        if not at_feed.any():
            continue
        pieces = _pieces(run, first, end, poses, at_feed)
        if pieces.max() == 1:
            rows = np.arange(first, end)
            yield _chosen(rows, poses.joints[1:], at_feed)
            continue
        for start, stop in _parts(pieces):
            samples = subdivide(run, pieces[start:stop], slice(first + start, first + stop))
            yield _chosen(samples.row, samples.joints, at_feed[samples.row - first])


def _chosen(rows: Ints, joints: Floats, at_feed: Flags) -> FeedSamples:
    """Return the samples at feed; where the slides cannot follow there is no tip."""
    chosen = at_feed & np.isfinite(joints).all(axis=1)
    return FeedSamples(rows[chosen], joints[chosen])


def _parts(pieces: Ints) -> Iterator[tuple[int, int]]:
    """Stretches of rows with so few pieces that what is computed of them takes little memory."""
    part = (np.cumsum(pieces) - pieces) // CHUNK_ROWS
    bounds = np.flatnonzero(np.diff(part, prepend=-1, append=part[-1] + 1))
    yield from zip(bounds[:-1].tolist(), bounds[1:].tolist(), strict=True)


def _pieces(run: Run, first: int, end: int, poses: PositionChunk, at_feed: Flags) -> Ints:
    """Into how many pieces rows are cut, (n,)."""
    rotary = poses.joints[:, list(run.machine.rotary)]
    needed = np.abs(np.diff(rotary, axis=0)).max(axis=1) / _TURN
    part = slice(*np.searchsorted(run.arcs.row, [first, end]).tolist())
    at = run.arcs.row[part] - first
    if len(at):
        frame = arc_frames(
            poses.tip[at], poses.tip[at + 1], run.arcs.centre[part], run.arcs.normal[part], run.arcs.full_turns[part]
        )
        bend = np.minimum(np.degrees(frame.sweep) / _TURN, frame.sweep * np.linalg.norm(frame.across, axis=1) / _PIECE)
        needed[at] = np.maximum(needed[at], bend)
    pieces = np.ceil(np.nan_to_num(np.clip(needed, 1.0, _MOST), nan=1.0)).astype(np.int64)
    return np.where(at_feed, pieces, 1)
