"""What is wrong with the motions that drill one hole: approach, heights, exit, feed, dwell and spindle.

Heights are as in ``trunnion.verification.expected.holes``.
"""

from collections.abc import Iterable, Iterator, Mapping
from typing import Final

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.messages import Wording
from trunnion.model.run import Run
from trunnion.model.spindle_work import SpindleTask, SpindleWork
from trunnion.model.toolpath import Kind
from trunnion.verification.checks.drill_motions import DrillMotions, HoleFault
from trunnion.verification.checks.peck_faults import peck_faults
from trunnion.verification.checks.spindle_checks import RPM_TOLERANCE
from trunnion.verification.expected.holes import Hole
from trunnion.verification.expected.tolerances import FEED_PER_REV_SHARE, feed_per_rev_tolerance
from trunnion.verification.kinematics.positioning_moves import comes_from_home
from trunnion.verification.matching.hole_matching import MatchedHole

#: Half of the last digit of the feeds of threads, mm/min, and of pitches, mm; and the noise of computing.
_FEED, _PITCH, _NOISE = 0.005, 5e-6, 1e-6

#: In programs in inches pitches have as many digits, of inches.
_INCH: Final = 25.4

#: Dwells are the same if they differ by no more than the shortest that controls print, seconds.
_DWELL: Final = 1.01e-3

#: What a cycle does with the spindle, for messages.
_TASKS: Final[dict[SpindleTask | None, str]] = {
    None: "turns_only", SpindleTask.TAP: "cuts_thread", SpindleTask.STOP: "stops_spindle",
    SpindleTask.LIFT: "lifts_tool", SpindleTask.MANUAL: "by_hand",
}  # fmt: skip

#: Bores by the word behind BORE; those that motions of the program can make, which are judged by themselves.
_BORES: Final = {"DRAG": SpindleTask.STOP, "NODRAG": SpindleTask.LIFT, "MANUAL": SpindleTask.MANUAL}
_BY_MOTION: Final = (SpindleTask.STOP,)

_SENSES: Final = {1: "clockwise", -1: "counter_clockwise", 0: "standing"}

#: Cycles that leave the hole at feed.
_FEED_OUT: Final = ("TAP", "REAM")


def drill_motions(run: Run, hole: Hole, match: MatchedHole) -> DrillMotions:
    """Return the motions that drill a hole; one that a CL point asks for counts as a rapid."""
    rows = np.arange(match.first, match.end)
    kind = run.kind[rows].copy()
    if match.shares_first_row:
        kind[0] = Kind.RAPID
    return DrillMotions(rows, kind, hole.heights_and_offsets(run.positions(rows).tip)[0], match.by_motion)


def hole_faults(
    run: Run,
    hole: Hole,
    match: MatchedHole,
    dwells: Mapping[int, list[float]],
    spindle_work: Mapping[int, SpindleWork],
    clearance: float | None = None,
) -> Iterator[HoleFault]:
    """Yield what is wrong with one hole.

    dwells        the dwells of the run by row, in seconds, or spindle revolutions if negative
    spindle_work  what cycles do with the spindle, by the row at which they begin
    clearance     as ``clearance_between_holes`` gives it, from the hole before
    """
    rows = np.arange(max(match.first - 1, 0), match.end)
    positions = run.positions(rows)
    height, aside = hole.heights_and_offsets(positions.tip)
    kind = run.kind[rows[1:]].copy()
    if match.shares_first_row:
        kind[0] = Kind.RAPID
    motions = DrillMotions(rows[1:], kind, height[1:], match.by_motion)
    if float(np.abs(positions.axis[1:] - hole.axis).max()) > 1e-6 + np.radians(4.0 * hole.tip_tolerance):
        yield motions.fault(0, 0.0, Wording("holes", "askew"))
        return
    off_axis = (aside[1:] > hole.tolerance) & ~(("NODRAG" in hole.cycle.mode) & (kind == Kind.RAPID))
    if off_axis.any():
        k = int(np.argmax(off_axis))
        off = float(aside[1:][k])
        yield motions.fault(k, off, Wording("holes", "aside", off=off))
        return
    from_aside = bool(aside[0] > hole.tolerance) and not comes_from_home(run, match.first)
    yield from _approach_faults(hole, motions, float(height[0]), from_aside, clearance)
    if _comes_at_feed(hole, motions):
        kind[0] = Kind.RAPID  # that is named; its feed and height are not those of the hole
    if len(motions.row) < 3 or (kind == Kind.RAPID).all():
        yield motions.fault(0, 0.0, Wording("holes", "not_drilled"))
        return
    rpm = float(run.state.rpm[match.end - 1])
    bottom = int(motions.row[motions.bottom])
    yield from _height_faults(hole, motions)
    yield from peck_faults(hole, motions)
    yield from _exit_faults(hole, motions)
    yield from _repeats(hole, motions)
    way = np.linalg.norm(np.diff(positions.tip, axis=0), axis=1) if match.by_motion else np.full(len(kind), np.nan)
    yield from _feed_faults(run, hole, motions.row[kind == Kind.LINEAR], rpm, way[kind == Kind.LINEAR])
    yield from _dwell_faults(hole, match, bottom, dwells, rpm)
    yield from _spindle_faults(run, hole, match, bottom)
    yield from _work_faults(hole, match, spindle_work)


def _approach_faults(
    hole: Hole, motions: DrillMotions, start_height: float, from_aside: bool, clearance: float | None
) -> Iterator[HoleFault]:
    """Yield a tool that comes too low, or at feed.

    from_aside  the approach starts at a known place that is not on the axis of the hole
    """
    if clearance is not None and clearance < -hole.tolerance:
        yield motions.fault(0, clearance, Wording("holes", "too_low", low=-clearance))
    lowest = hole.cycle.clearance - hole.tolerance
    slanted = clearance is None and from_aside and start_height < lowest
    if _comes_at_feed(hole, motions):
        yield motions.fault(0, 0.0, Wording("holes", "comes_at_feed"))
    if motions.height[0] < lowest or slanted:
        low = min(float(motions.height[0]), start_height)
        yield motions.fault(0, low, Wording("holes", "low_approach", low=low, wanted=hole.cycle.clearance))


def _comes_at_feed(hole: Hole, motions: DrillMotions) -> bool:
    """Whether the way to the hole ends above it, and is a cut."""
    return bool(motions.kind[0] != Kind.RAPID and motions.height[0] >= hole.cycle.clearance - hole.tolerance)


def _height_faults(hole: Hole, motions: DrillMotions) -> Iterator[HoleFault]:
    """Yield the heights at which the feed begins and the tool leaves, and the depth."""
    h = motions.height
    start = int(np.argmax(motions.kind != Kind.RAPID)) - 1  # a control may come down to it in two steps
    if abs(h[start] - hole.cycle.clearance) > hole.tolerance:
        said = Wording("holes", "feed_begins", height=h[start], wanted=hole.cycle.clearance)
        yield motions.fault(start, float(h[start]), said)
    if abs(h[-1] - hole.cycle.retract) > hole.tolerance:
        said = Wording("holes", "drawn_back", height=h[-1], wanted=hole.cycle.retract)
        yield motions.fault(-1, float(h[-1]), said)
    depth = -h.min()
    if abs(depth - hole.cycle.depth) > hole.tolerance:
        said = Wording("holes", "other_depth", depth=depth, wanted=hole.cycle.depth)
        yield motions.fault(motions.bottom, float(depth), said)


def _exit_faults(hole: Hole, motions: DrillMotions) -> Iterator[HoleFault]:
    """Yield the way out of the hole: at rapid or at feed, and in motions of the program up to the clearance height."""
    after = motions.bottom + 1
    if after >= len(motions.row) or hole.cycle.depth <= 0.0:
        return
    at_feed = hole.cycle.mode[0] in _FEED_OUT or hole.cycle.mode == ("BORE",)
    height = float(motions.height[after])
    if (motions.kind[after] == Kind.LINEAR) != at_feed:
        yield motions.fault(after, 0.0, Wording("holes", "leaves_at_rapid" if at_feed else "leaves_at_feed"))
    elif motions.by_motion and at_feed and abs(height - hole.cycle.clearance) > hole.tolerance:
        yield motions.fault(after, height, Wording("holes", "leaves_to_height", wanted=hole.cycle.clearance))


def _repeats(hole: Hole, motions: DrillMotions) -> Iterator[HoleFault]:
    """Yield a hole that is drilled again: two cycles at one place have no motion between them, and count as one."""
    h = motions.height
    bottom = int(np.argmax(h <= h.min() + _NOISE))
    out = bottom + np.flatnonzero(h[bottom:] >= hole.cycle.clearance - hole.tolerance)
    if len(out) and hole.cycle.depth > 0.0:
        into = (motions.kind == Kind.LINEAR) & (h < hole.cycle.clearance - hole.tolerance)
        into[: int(out[0])] = False
        if into.any():
            k = int(np.argmax(into))
            yield motions.fault(k, float(h[k]), Wording("holes", "again"))


def _feed_faults(run: Run, hole: Hole, lines: Ints, rpm: float, way: Floats) -> Iterator[HoleFault]:
    """Yield the feed of the cycle, in all lines; what inverse time means within a cycle is not known.

    way  (k,) length of the lines, NaN within a cycle
    """
    mode, programmed = run.state.feed_mode.at(lines), run.state.feed.at(lines)
    feed = np.where(mode == 95, programmed * rpm, np.where(mode == 93, programmed * way, programmed))
    wanted = hole.cycle.feed * rpm if hole.cycle.per_rev else hole.cycle.feed
    pitch = _PITCH * np.where(run.state.inches.at(lines), _INCH, 1.0)
    digit = (min(hole.feed_tolerance, _FEED) if hole.cycle.mode[0] == "TAP" else hole.feed_tolerance) + _NOISE
    is_thread = hole.cycle.mode[0] == "TAP" or not hole.cycle.per_rev
    share = FEED_PER_REV_SHARE * wanted if is_thread else rpm * feed_per_rev_tolerance(np.array(hole.cycle.feed))
    allowed = np.where(mode == 95, share + _NOISE, digit + pitch * rpm)
    off = ~(np.abs(feed - wanted) <= allowed + 1e-9 * wanted)
    if off.any():
        k = int(np.argmax(off))
        has = Wording("holes", "moves_with", feed=feed[k]) if feed[k] == feed[k] else Wording("holes", "by_time")
        asked = Wording("holes", "feed", feed=wanted)
        if hole.cycle.per_rev:
            asked = Wording("holes", "feed_per_revolution", feed=wanted, per_revolution=hole.cycle.feed)
        said = Wording("holes", "other_feed", has=has, wanted=asked)
        yield HoleFault(int(lines[k]), float(np.nan_to_num(feed[k])), said)


def _dwell_faults(
    hole: Hole, match: MatchedHole, bottom: int, dwells: Mapping[int, list[float]], rpm: float
) -> Iterator[HoleFault]:
    """Yield the dwell at the bottom, and dwells elsewhere in the hole; ``bottom`` is the deepest row."""
    wanted = 60.0 * hole.cycle.dwell / rpm if hole.cycle.dwell_turns and rpm else hole.cycle.dwell
    has = _seconds(dwells.get(bottom + 1, ()), rpm)
    if abs(has - wanted) > _DWELL:
        yield HoleFault(bottom, has, Wording("holes", "other_dwell", seconds=has, wanted=wanted))
    for row in range(match.first + 1, match.end):
        if row == bottom + 1 or row not in dwells:
            continue
        waits = _seconds(dwells[row], rpm)
        if match.by_motion or abs(waits - wanted) > _DWELL:  # some cycles wait after every peck
            yield HoleFault(row, waits, Wording("holes", "waits", seconds=waits))
            return


def _seconds(dwells: Iterable[float], rpm: float) -> float:
    """Dwells together; negative ones are spindle revolutions."""
    return sum(dwell if dwell >= 0.0 else -60.0 * dwell / max(rpm, 1e-9) for dwell in dwells)


def _work_faults(hole: Hole, match: MatchedHole, spindle_work: Mapping[int, SpindleWork]) -> Iterator[HoleFault]:
    """Yield a cycle of another kind than that of the CL file, a thread of the other hand, and a spindle left
    otherwise.
    """
    row = next((row for row in range(match.first, match.end) if row in spindle_work), None)
    work = None if row is None else spindle_work[row]
    at = match.end - 1 if row is None else min(row, match.end - 1)
    has, wants = None if work is None else work.task, _task(hole.cycle.mode)
    if has is not wants and not (match.by_motion and wants in _BY_MOTION):
        tasks = {"has": Wording("holes", _TASKS[has]), "wanted": Wording("holes", _TASKS[wants])}
        yield HoleFault(at, 0.0, Wording("holes", "other_task", **tasks))
        return
    if work is not None and work.stroke and not hole.cycle.pecks:
        yield HoleFault(at, work.stroke, Wording("holes", "in_strokes", stroke=work.stroke))
    if work is None or hole.spindle is None or not hole.spindle.sense:
        return
    hand, sense = work.hand, hole.spindle.sense  # 0: that of the spindle, which is judged by itself
    if hand and hand != sense:
        yield HoleFault(at, hand, Wording("holes", "left_hand" if hand < 0 else "right_hand"))
    if work.after is not None and work.after != sense:
        senses = {"has": Wording("holes", _SENSES[work.after]), "wanted": Wording("holes", _SENSES[sense])}
        yield HoleFault(at, work.after, Wording("holes", "other_sense", **senses))


def _task(mode: tuple[str, ...]) -> SpindleTask | None:
    """Return what the cycle of a hole does with the spindle besides turning it, by the words of CYCLE."""
    if mode[:1] == ("TAP",):
        return SpindleTask.TAP
    return next((_BORES[word] for word in mode[1:] if word in _BORES), None) if mode[:1] == ("BORE",) else None


def _spindle_faults(run: Run, hole: Hole, match: MatchedHole, bottom: int) -> Iterator[HoleFault]:
    """Speed and sense of the spindle; where motions drill a hole that it leaves without turning, it is off then."""
    leaves_off = match.by_motion and "DRAG" in hole.cycle.mode
    row = bottom if leaves_off else match.end - 1
    sense, rpm, wanted = int(run.state.spindle[row]), float(run.state.rpm[row]), hole.spindle
    if wanted is not None and (sense != wanted.sense or (sense and abs(rpm - wanted.rpm) > RPM_TOLERANCE)):
        said = Wording("holes", "other_speed", speed=sense * rpm, wanted=wanted.sense * wanted.rpm)
        yield HoleFault(row, rpm, said)
    if leaves_off and int(run.state.spindle[row + 1]):
        yield HoleFault(row + 1, rpm, Wording("holes", "left_turning"))
