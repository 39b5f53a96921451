"""The points of an operation: rows of the run, and blocks that say something while the tool rests.

A post writes such blocks for points that print as the point before: a feed, a phase or several words stand alone then.
They become that point once more, so that the program comes back as it was.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from trunnion.arrays import Codes, Flags, Floats, Ints, Lines
from trunnion.convert.source import Source
from trunnion.convert.timeline import Item, sorts
from trunnion.reader import Run
from trunnion.toolpath import Arcs, Kind

#: Positions are taken to so many decimals: what is beyond them comes from computing with binary fractions.
DECIMALS = 9

_OWN = frozenset({"dwell", "stop", "optional_stop", "message", "comment", "h"})
_LINE_BITS = 32


@dataclass(frozen=True, slots=True, eq=False)
class Points:
    """All columns have n rows.

    row    (n,) int64    row of the run; a block that moves nothing has that of the point before it
    line   (n,) int32    line of the program
    kind   (n,) uint8    a ``trunnion.toolpath.Kind``
    feed   (n,) float64  as programmed
    mode   (n,) uint8    93, 94 or 95
    when   (n,) int64    the point in time, as ``moment`` gives it
    twice  lines whose only event must be said twice to stand alone
    """

    row: Ints
    line: Lines
    kind: Codes
    feed: Floats
    mode: Codes
    when: Ints
    twice: frozenset[int] = frozenset()

    def at(self, row: int, line: int) -> int:
        """The point before which something stands."""
        return int(np.searchsorted(self.when, moment(row, line)))


class Still(NamedTuple):
    """A block that moves nothing: the row before which it stands, its line and words, and what it is.

    sort   "phase", "own" for events that have a block of their own, the kind of its only event, or "mixed"
    """

    row: int
    line: int
    words: tuple[str, ...]
    sort: str


def moment(row: int, line: int) -> int:
    """Row of the run before which something stands, and its line, as one number that grows with time."""
    return row << _LINE_BITS | line


def points_of(run: Run, rows: Ints, in_order: bool) -> Points:
    """The rows of a run as points; in a program with jumps the lines say nothing about time."""
    line = run.block[rows]
    when = rows << _LINE_BITS | (line if in_order else 0)
    return Points(rows, line, run.kind[rows], run.feed[rows], run.feed_mode[rows], when)


def with_rests(points: Points, still: Sequence[Still]) -> Points:
    """The points with those added that blocks without motion ask for."""
    # An event said twice makes a block of its own. All else takes a point, of which there is none before the first.
    twice = frozenset(block.line for block in still if block.sort not in ("phase", "mixed"))
    asked = [block for block in still if block.sort in ("phase", "mixed")]
    asked = [block for block in asked if moment(block.row, block.line) > points.when[0]]
    place = np.array([points.at(block.row, block.line) for block in asked], np.int64)
    source = np.insert(np.arange(len(points.row)), place, place - 1)
    new = np.insert(np.zeros(len(points.row), bool), place, True)
    line, kind = points.line[source], points.kind[source]
    feed, mode, when = points.feed[source], points.mode[source], points.when[source]
    kind[new & (kind == Kind.ARC)] = Kind.LINEAR
    for k, block in zip(np.flatnonzero(new).tolist(), asked, strict=True):
        when[k], line[k] = moment(block.row, block.line), block.line
        if new[k - 1]:
            kind[k], feed[k], mode[k] = kind[k - 1], feed[k - 1], mode[k - 1]
        for word in block.words:
            if word in ("G0", "G1"):
                kind[k] = Kind.RAPID if word == "G0" else Kind.LINEAR
            elif word in ("G94", "G95"):
                mode[k] = int(word[1:])
            elif word[0] == "F":
                feed[k] = float(word[1:])
    return Points(points.row[source], line, kind, feed, mode, when, twice)


def rests(
    source: Source, points: Points, stop: int, said: Mapping[int, Sequence[Item]], known: set[int], phases: set[str]
) -> list[Still]:
    """Blocks among the points that a post writes for points only.

    Parameters
    ----------
    source
        A program in order.
    points
        The rows of the operation.
    stop
        Line where the path ends.
    said
        Items by line.
    known
        Lines of templates.
    phases
        Comments that begin a phase.
    """
    begin = int(points.line[0])
    first = max((line for line in known if line < begin), default=begin) + 1
    found: list[Still] = []
    gap: list[Still] = []
    for line in source.resting(first, stop, points.row, known):
        row = source.row_of(line)
        if gap and gap[0].row != row:
            found += _not_said_anyhow(gap, _motion(points, gap[0].row, said))
            gap = []
        gap += _still(source, row, line, said.get(line, ()), phases)
    return found + (_not_said_anyhow(gap, _motion(points, gap[0].row, said)) if gap else [])


def _motion(points: Points, row: int, said: Mapping[int, Sequence[Item]]) -> set[str] | None:
    """The kinds of events in the motion block of a row; None behind the last one."""
    if row > points.row[-1]:
        return None
    place = int(np.searchsorted(points.row, row))
    return sorts(said.get(int(points.line[place]), ()))


def _still(source: Source, row: int, line: int, here: Sequence[Item], phases: set[str]) -> Iterator[Still]:
    """What a block without motion is, if it is anything."""
    events = sorts(here)
    if len(here) == 1 and here[0].kind == "comment" and str(here[0].value).strip() in phases:
        yield Still(row, line, (), "phase")
    elif any(item.kind in _OWN for item in here) or (here and not events):
        yield Still(row, line, (), "own")
    else:
        words = tuple(source.words(line))
        moving = any(word in ("G0", "G1") or (word[0] == "F" and word[1:2] in "-+.0123456789") for word in words)
        if events or moving:
            yield Still(row, line, words, "mixed" if moving or len(events) != 1 else next(iter(events)))


def _not_said_anyhow(gap: Sequence[Still], motion: set[str] | None) -> list[Still]:
    """Of the blocks between two motions those that a post writes for points only.

    Some events get a block of their own in any case: what stands before a dwell or a stop, before another event of its
    kind, or behind all motion.

    motion   the kinds of events in the motion block that follows; None if none follows
    """
    found = []
    for k, block in enumerate(gap):
        later = [*(other.sort for other in gap[k + 1 :]), *(motion or ())]
        pointless = motion is None and not {"phase", "mixed"} & set(later)
        if block.sort == "own":
            continue
        if block.sort == "phase":
            # the words behind it take it, or the next motion
            taken = bool(later) and later[0] not in ("own", "phase")
            if not taken and ("phase" in later or motion is None):
                found.append(block)
        elif block.sort == "mixed" or any(other.sort == "phase" for other in gap[:k]):
            found.append(block._replace(sort="mixed"))
        elif not (pointless or "own" in later or block.sort in later):
            found.append(block)
    return found


def arcs_of(run: Run, points: Points) -> Arcs:
    """The arcs among the points."""
    made = np.flatnonzero(points.kind == Kind.ARC)
    if not len(made):
        return Arcs.none()
    here = np.searchsorted(run.arcs.row, points.row[made])
    return Arcs(
        made.astype(np.int64),
        np.round(run.arcs.centre[here], DECIMALS) + 0.0,
        run.arcs.normal[here] + 0.0,
        np.round(run.arcs.radius[here], DECIMALS),
        run.arcs.turns[here],
    )


def feeds_of(run: Run, points: Points) -> tuple[Floats, Flags, list[int]]:
    """Feeds in mm/min or mm/rev, whether per revolution, and the lines whose feed has no such value.

    Rapids carry on what was in force; before the first cut there is none.
    """
    feed = points.feed.copy()
    rapid = points.kind == Kind.RAPID
    inverse = np.flatnonzero((points.mode == 93) & ~rapid)
    feed[inverse] *= _lengths(run, points.row[inverse])
    lost = [int(line) for line in points.line[inverse[feed[inverse] == 0.0]]]
    last_cut = np.maximum.accumulate(np.where(rapid, -1, np.arange(len(feed))))
    begun = last_cut >= 0
    feed = np.where(begun, feed[last_cut], np.nan)
    return feed, np.asarray((points.mode[last_cut] == 95) & ~np.isnan(feed)), lost


def _lengths(run: Run, rows: Ints) -> Floats:
    """(n,) float64: length of the tip's way to each row, mm."""
    length: Floats = np.linalg.norm(run.tip[rows] - run.tip[np.maximum(rows - 1, 0)], axis=1)
    for place in np.flatnonzero(np.isin(rows, run.arcs.row)).tolist():
        length[place] = _arc_length(run, int(rows[place]))
    return length


def _arc_length(run: Run, row: int) -> float:
    arcs = run.arcs
    place = int(np.searchsorted(arcs.row, row))
    normal = arcs.normal[place]
    start, end = run.tip[row - 1] - arcs.centre[place], run.tip[row] - arcs.centre[place]
    rise = float((end - start) @ normal)
    start, end = start - (start @ normal) * normal, end - (end @ normal) * normal
    angle = float(np.arctan2(np.cross(start, end) @ normal, start @ end)) % (2 * np.pi)
    sweep = (angle if angle > 1e-9 else 2 * np.pi) + 2 * np.pi * float(arcs.turns[place])
    return float(np.hypot(sweep * arcs.radius[place], rise))
