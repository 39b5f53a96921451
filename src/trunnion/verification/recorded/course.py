"""How a recording goes through a program: in time, in order, with which spindle, and how much of it.

In:     a ``Run`` and its ``RecordedComparison``.
Out:    what is wrong, and what was not recorded.
Units:  mm and degrees, seconds, rev/min.
"""

from collections.abc import Iterator
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.messages import Wording
from trunnion.model.recording import NO_TIME, SPINDLE, Mark
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind
from trunnion.records import dataclass
from trunnion.verification.recorded.compared import RecordedComparison

#: A spindle may differ from its programmed speed by this share and rev/min: overrides up to a tenth are usual.
SPINDLE_SHARE: Final = 0.1
SPINDLE_SLACK: Final = 5.0

#: Positions at feed that say which speed the spindle had; fewer may be in a ramp.
_LEAST_POSITIONS: Final = 3

#: Nothing was recorded between two positions that are further apart in time: seconds, and times the usual distance.
_UNSEEN: Final = (0.1, 5.0)

#: How much further than the machine goes in that time the path may lead it between two positions: a factor, and mm.
_FURTHER: Final = 3.0
_NEAR: Final = 2.0


@dataclass(frozen=True, slots=True)
class Fault:
    """Something wrong: where in the recording and in the run (-1: nowhere), and what."""

    at: int
    row: int
    said: Wording


def faults(run: Run, compared: RecordedComparison) -> Iterator[Fault]:
    """Yield what is wrong with the time, the order and the spindle of a recording."""
    recording = compared.recording
    stated = np.flatnonzero(recording.source != NO_TIME)
    if len(recording) and not len(stated):
        yield Fault(0, -1, Wording("recorded", "no_time"))
    # What is read first after a gap may be older than the gap: values that have not changed since.
    marks = np.cumsum(recording.marked(Mark.BACK, Mark.GAP))[stated]
    falls = stated[1:][(np.diff(recording.source[stated]) < 0) & (np.diff(marks) == 0)]
    if len(falls):
        many = Wording("recorded", "time_falls_often", count=len(falls))
        said = many if len(falls) > 1 else Wording("recorded", "time_falls")
        yield Fault(int(falls[0]), int(compared.row[falls[0]]), said)
    if len(compared.strange):
        at = int(compared.strange[0])
        line = recording.values["line"][at]
        many = Wording("recorded", "strange_lines", count=len(compared.strange), line=line)
        yield Fault(at, -1, many if len(compared.strange) > 1 else Wording("recorded", "strange_line", line=line))
    if len(compared.back):
        at = int(compared.back[0])
        many = Wording("recorded", "went_back_often", count=len(compared.back) - 1)
        said = many if len(compared.back) > 1 else Wording("recorded", "went_back")
        yield Fault(at, int(compared.row[at]), said)
    yield from _spindle(run, compared)


def _spindle(run: Run, compared: RecordedComparison) -> Iterator[Fault]:
    """Yield where the spindle had another speed than the program's in most positions at feed."""
    turned = compared.recording.values.get(SPINDLE)
    if turned is None:
        return
    at = compared.compared
    at = at[np.isfinite(turned[at]) & (run.kind[compared.row[at]] != Kind.RAPID)]
    for hole in run.spindle_holes:
        at = at[(compared.row[at] < hole.first) | (compared.row[at] >= hole.end)]
    rows = compared.row[at]
    wanted = np.abs(run.state.rpm.at(rows) * run.state.spindle.at(rows)) if len(rows) else np.zeros(0)
    bounds = np.flatnonzero(np.diff(wanted)) + 1
    for part in np.split(np.arange(len(at)), bounds):
        if len(part) < _LEAST_POSITIONS:
            continue
        told, was = float(wanted[part[0]]), float(np.median(np.abs(turned[at[part]])))
        if abs(was - told) > SPINDLE_SHARE * told + SPINDLE_SLACK:
            said = Wording("recorded", "other_speed", speed=was, wanted=told)
            yield Fault(int(at[part[0]]), int(rows[part[0]]), said)


@dataclass(frozen=True, slots=True, eq=False)
class Coverage:
    """What was recorded of n rows.

    share    of the path's length that nobody knows nothing of, 0 to 1
    first, last  rows at which the recording begins and ends
    holes    rows between them that were not recorded, though no broken connection was marked there
    gaps     rows that were not recorded while the connection was broken
    """

    share: float
    first: int
    last: int
    holes: Ints
    gaps: Ints


def coverage(run: Run, compared: RecordedComparison) -> Coverage:
    """Say what was recorded; positions have to be there."""
    n, at = len(run), compared.compared
    covered, broken = compared.positions > 0, np.zeros(n, np.bool_)
    elapsed, gaps = compared.recording.elapsed(), np.cumsum(compared.recording.marked(Mark.GAP, Mark.LOST))
    step = np.diff(elapsed[at])
    moved = np.diff(compared.row[at]) != 0
    usual = float(np.median(step[moved])) if moved.any() else 0.0
    most = max(_UNSEEN[0], _UNSEEN[1] * usual)
    together = (np.diff(at) == 1) & (step <= most)
    # Blocks were left out where the machine cannot have gone so far in that time.
    gone = np.linalg.norm(np.diff(compared.tips[at], axis=0), axis=1)
    feed = run.kind != Kind.RAPID
    rates = [_usual_rate(gone, step, part) for part in (np.ones(len(step), np.bool_), feed[compared.row[at[1:]]])]
    ways = np.concatenate(([0.0], np.cumsum(np.where(compared.moves, compared.lengths, 0.0))))
    for k in np.flatnonzero(np.diff(compared.row[at]) > 1).tolist():
        between = slice(int(compared.row[at[k]]) + 1, int(compared.row[at[k + 1]]))
        skipped = ways[between.stop] - ways[between.start]
        rate = rates[bool(feed[between].all())]
        if together[k] and skipped <= _FURTHER * rate * step[k] + _NEAR:
            covered[between] = True
        elif gaps[at[k + 1]] > gaps[at[k]]:
            broken[between] = True
    for k in np.flatnonzero((np.diff(compared.row[at]) < 0) & (np.diff(gaps[at]) > 0)).tolist():
        broken[int(compared.row[at[k]]) + 1 :] = True  # the program went to its end unseen, and ran once more
        broken[: int(compared.row[at[k + 1]])] = True
    moves = compared.moves
    rows = np.flatnonzero(covered & moves)
    first, last = (int(rows[0]), int(rows[-1])) if len(rows) else (0, -1)
    lengths = np.where(moves, compared.lengths, 0.0)
    whole = float(lengths.sum())
    missing = np.flatnonzero(moves & ~covered)
    missing = missing[(missing > first) & (missing < last)]
    share = float(lengths[covered].sum()) / whole if whole > 0.0 else 1.0
    return Coverage(share, first, last, missing[~broken[missing]], missing[broken[missing]])


def _usual_rate(gone: Floats, step: Floats, part: Flags) -> float:
    """How fast the machine goes in some steps, mm/s, but for the few fastest ones."""
    of = part & (step > 0.0)
    return float(np.quantile(gone[of] / step[of], 0.9)) if of.any() else 0.0


def longest_stand(compared: RecordedComparison) -> tuple[float, int]:
    """Return the longest time that several rows in a row show the same place, seconds, and where it begins."""
    at = compared.compared
    if len(at) < 2:
        return 0.0, 0
    same: Floats = np.abs(np.diff(compared.tips[at], axis=0)).max(axis=1)
    still = (same == 0.0) & (np.diff(at) == 1)
    begins = np.flatnonzero(still & ~np.concatenate(([False], still[:-1])))
    ends = np.flatnonzero(still & ~np.concatenate((still[1:], [False]))) + 1
    if not len(begins):
        return 0.0, 0
    elapsed = compared.recording.elapsed()[at]
    seconds = elapsed[ends] - elapsed[begins]
    k = int(np.argmax(seconds))
    return float(seconds[k]), int(at[begins[k]])
