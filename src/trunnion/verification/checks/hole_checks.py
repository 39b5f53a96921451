"""Each hole against what the CL file's cycle asks for.

Heights are as in ``trunnion.verification.expected.holes``.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np

from trunnion.arrays import Codes, Floats, Ints
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind
from trunnion.readers import uses_length_numbers
from trunnion.verification.checks.state_checks import allowed_length_numbers, length_fault_text
from trunnion.verification.context import MAX_PLACES, Context, check_from_places
from trunnion.verification.expected.holes import Hole
from trunnion.verification.expected.path import names_tool
from trunnion.verification.matching.hole_matching import MatchedHole, clearance_between_holes, match_holes
from trunnion.verification.matching.row_ranges import RowRanges
from trunnion.verification.results import Check, Place

#: A spindle speed is printed without decimals.
_RPM = 0.5 + 1e-6

#: Half of the last digit of the feeds of threads, mm/min or mm/rev, and of pitches, mm; and rounding here.
_FEED, _PITCH, _NOISE = 0.005, 5e-6, 1e-6

#: Cycles that leave the hole at a feed.
_FED_OUT = ("TAP", "REAM")

#: Strokes of a hole are no more.
_MOST_STROKES = 100_000

#: A stroke that breaks chips is drawn back by less than this, mm.
_CHIP = 5.0


def faults(
    run: Run, hole: Hole, made: MatchedHole, waits: Mapping[int, list[float]], over: float | None = None
) -> Iterator[tuple[int, float, str]]:
    """What is wrong with one hole: row, value and words.

    ``waits`` are the dwells of the run, by row; ``over`` is as ``clearance_between_holes`` has it, from the hole
    before.
    """
    spindle = float(run.state.rpm[made.end - 1])
    rows = np.arange(max(made.first - 1, 0), made.end)
    poses = run.positions(rows)
    offset = poses.tip - hole.tip
    height = offset @ hole.axis
    aside = np.linalg.norm(offset - height[:, None] * hole.axis, axis=1)
    near = hole.near
    h, kind = height[1:], run.kind[rows[1:]].copy()
    at = rows[1:]
    if made.begins_at:
        kind[0] = Kind.RAPID  # how the tool came to a CL point is what that asks for
    if float(np.abs(poses.axis[1:] - hole.axis).max()) > 1e-6 + np.radians(4.0 * hole.tip_tolerance):
        yield int(at[0]), 0.0, "the tool does not stand along the axis of the hole"
        return
    lifted = "NODRAG" in hole.mode
    off = (aside[1:] > near) & ~(lifted & (kind == Kind.RAPID))
    if off.any():
        k = int(np.argmax(off))
        yield int(at[k]), float(aside[1:][k]), f"{aside[1:][k]:.5f} mm beside the hole that the CL file asks for"
        return
    if over is not None and over < -near:
        text = f"goes to the hole {-over:.4f} mm too low over both it and the one before"
        yield int(at[0]), over, text
    aslant = over is None and aside[0] > near and height[0] < hole.above - near
    if kind[0] != Kind.RAPID or h[0] < hole.above - near or aslant:
        low = min(float(h[0]), float(height[0]))
        yield int(at[0]), low, f"goes to the hole {low:.4f} mm above it; the CL file wants at least {hole.above:g}"
    if len(h) < 3 or (kind == Kind.RAPID).all():
        yield int(at[0]), 0.0, "the hole is not drilled"
        return
    start = int(np.argmax(kind != Kind.RAPID)) - 1  # a control may come down to it in two steps
    if abs(h[start] - hole.above) > near:
        yield int(at[start]), float(h[start]), f"begins to feed {h[start]:.4f} mm above the hole, not {hole.above:g}"
    if abs(h[-1] - hole.retract) > near:
        yield int(at[-1]), float(h[-1]), f"is drawn back to {h[-1]:.4f} mm, not to {hole.retract:g}"
    if abs(h.min() + hole.depth) > near:
        yield int(at[int(np.argmin(h))]), float(-h.min()), f"drills {-h.min():.4f} mm deep, not {hole.depth:g}"
    yield from _strokes(hole, made, at, kind, h)
    yield from _fed(run, hole, at[kind == Kind.LINEAR], spindle)
    yield from _dwells(hole, made, int(at[int(np.argmin(h))]), waits, spindle)
    yield from _spindle(run, hole, made, at[int(np.argmin(h))])


def _any_between(rows: RowRanges, first: int, last: int) -> bool:
    """Whether any of growing ``rows`` is from ``first`` to ``last``."""
    return rows.before(last + 1) > rows.before(first)


def _spindle(run: Run, hole: Hole, made: MatchedHole, bottom: int) -> Iterator[tuple[int, float, str]]:
    """The spindle is as asked; where motion makes a hole that it leaves with the spindle standing, it stands then."""
    drags = made.by_motion and "DRAG" in hole.mode
    row = int(bottom) if drags else made.end - 1
    turns, rpm = int(run.state.spindle[row]), float(run.state.rpm[row])
    if hole.rpm is not None and (turns != hole.sense or (turns and abs(rpm - hole.rpm) > _RPM)):
        yield row, rpm, f"the spindle turns with {turns * rpm:g}, not with {hole.sense * hole.rpm:g}"
    if drags and int(run.state.spindle[row + 1]):
        yield row + 1, rpm, "leaves the hole with the spindle turning; the CL file wants it to stand"


def _strokes(hole: Hole, made: MatchedHole, at: Ints, kind: Codes, h: Floats) -> Iterator[tuple[int, float, str]]:
    """Rapids stay above what is drilled; strokes and how the tool is drawn back between them are those of the cycle."""
    near, deepest = hole.near, hole.above
    ends: list[float] = []
    between: list[list[int]] = []
    for k in range(1, len(h)):
        if kind[k] == Kind.RAPID and h[k] < deepest - near:
            yield int(at[k]), float(h[k]), "goes at rapid where nothing is drilled yet"
        elif kind[k] == Kind.LINEAR and h[k] < deepest - 1e-9:
            ends.append(float(h[k]))
            between.append([])
        elif made.by_motion and kind[k] == Kind.LINEAR and k <= np.argmin(h):
            yield int(at[k]), float(h[k]), "goes at a feed where nothing is left to drill"
        elif between:
            between[-1].append(k)
        deepest = min(deepest, float(h[k]))
    if not hole.steps:
        if len(ends) > 1:
            yield int(at[2]), float(len(ends)), f"drills in {len(ends)} strokes, the CL file in one"
    elif made.by_motion:
        yield from _by_motion(hole, int(at[2]), ends)
    else:
        # Strokes count from the point of the hole, or from where the feed begins.
        begin = 0.0 if not ends or abs(ends[0] + min(hole.steps[0], hole.depth)) <= near else hole.above
        first = min(hole.steps[0], begin + hole.depth)
        strokes = np.abs(np.diff([begin, *(ends or [hole.above])]))
        if abs(strokes[0] - first) > near or (np.diff(strokes) > near).any():
            said = ", ".join(f"{stroke:.4f}" for stroke in strokes[:4])
            yield int(at[2]), float(strokes[0]), f"drills in strokes of {said}, not of {first:g} and less"
        even = len(hole.steps) < 2 or not hole.steps[1]
        if even and len(strokes) > 2 and abs(strokes[:-1] - first).max() > near:
            yield int(at[2]), float(strokes.min()), f"the strokes are not all {first:g} mm"
    for end, rows in zip(ends, between[:-1] if hole.steps else [], strict=False):
        top = max((float(h[k]) for k in rows), default=-math.inf)
        full, back = abs(top - hole.above) <= near, top - end
        if not rows or full != ("DEEP" in hole.mode) or (not full and back > _CHIP):
            how = "not drawn back" if not rows else "drawn back all the way" if full else "drawn back a little"
            yield int(at[2]), top, f"between strokes the tool is {how}; the CL file says otherwise"
            break
    bottom = int(np.argmin(h))
    if bottom + 1 < len(h) and hole.depth > 0.0:
        fed = hole.mode[0] in _FED_OUT or hole.mode == ("BORE",)
        if (kind[bottom + 1] == Kind.LINEAR) != fed:
            how = "at rapid" if fed else "at a feed"
            yield int(at[bottom + 1]), 0.0, f"leaves the hole {how}, which is not what the CL file says"
        elif made.by_motion and fed and abs(h[bottom + 1] - hole.above) > near:
            yield (
                int(at[bottom + 1]),
                float(h[bottom + 1]),
                f"leaves the hole at a feed to another height than {hole.above:g}",
            )


def _by_motion(hole: Hole, row: int, ends: list[float]) -> Iterator[tuple[int, float, str]]:
    """Strokes that the program says itself are those of STEP, one by one: from the point of the hole, or from RAPTO."""
    found = _apart([hole.above, *ends], hole.near)
    for begin in (0.0, hole.above):
        expected = _apart([hole.above, *_depths(hole, begin)], hole.near)
        if len(expected) == len(found) and float(np.abs(expected - found).max()) <= hole.near:
            return
    said = ", ".join(f"{-height:.4f}" for height in found[1:5])
    yield row, float(found[-1]), f"drills to {said} and so on, which are not the strokes of STEP in the CL file"


def _apart(heights: Sequence[float], near: float) -> Floats:
    """Falling heights without those that are as good as the one after them, but for the last."""
    all_ = np.array(heights)
    return np.asarray(all_[np.append(all_[:-1] - all_[1:] > 2.0 * near, True)])


def _depths(hole: Hole, begin: float) -> list[float]:
    """Heights to which STEP leads: the first stroke from ``begin``, each next one shorter, none below the shortest."""
    stroke, less, least = (*hole.steps, 0.0, 0.0, 0.0)[:3]
    height, ends = begin, list[float]()
    while height > -hole.depth and stroke > 0.0 and len(ends) < _MOST_STROKES:
        height = max(height - stroke, -hole.depth)
        ends.append(height)
        stroke = stroke if stroke <= least else max(stroke - less, least)
    return ends


def _fed(run: Run, hole: Hole, lines: Ints, spindle: float) -> Iterator[tuple[int, float, str]]:
    """Feeds of the cycle."""
    mode, feed = run.state.feed_mode.at(lines), run.state.feed.at(lines)
    rate = np.where(mode == 95, feed * spindle, feed)
    want = hole.feed * spindle if hole.per_rev else hole.feed
    digit = (min(hole.digit, _FEED) if hole.mode[0] == "TAP" else hole.digit) + _NOISE
    last_digit = np.where(mode == 95, digit * spindle, digit + _PITCH * spindle)
    off = ~(np.abs(rate - want) <= last_digit + 1e-9 * want)
    if off.any():
        k = int(np.argmax(off))
        unit = f" ({hole.feed:g} mm/rev)" if hole.per_rev else ""
        yield int(lines[k]), float(rate[k]), f"moves with {rate[k]:g} mm/min; the CL file wants {want:g}{unit}"


def _dwells(
    hole: Hole, made: MatchedHole, bottom: int, waits: Mapping[int, list[float]], spindle: float
) -> Iterator[tuple[int, float, str]]:
    """How long the tool waits at the bottom, and that it waits nowhere else in the hole."""
    want = 60.0 * hole.dwell / spindle if hole.dwell_turns and spindle else hole.dwell
    has = sum(wait if wait >= 0.0 else -60.0 * wait / max(spindle, 1e-9) for wait in waits.get(bottom + 1, ()))
    if abs(has - want) > 5.1e-4:
        yield bottom, has, f"waits {has:g} s at the bottom; the CL file wants {want:g}"
    elsewhere = [row for row in range(made.first + 1, made.end) if row != bottom + 1 and row in waits]
    if made.by_motion and elsewhere:
        yield elsewhere[0], 0.0, "waits in the hole where the CL file does not want it"


def holes(context: Context) -> Check:
    """Every hole of the CL file is made as its cycle asks, in its turn between the points; and no other."""
    expected, matching, run = context.expected, context.matching, context.run
    assert expected is not None
    assert matching is not None
    title = "holes as the cycles of the CL file ask"
    made = match_holes(run, expected)
    waits: dict[int, list[float]] = {}
    for event in run.events:
        if event.kind == "dwell" and isinstance(event.value, float):
            waits.setdefault(event.before_row, []).append(event.value)
    places: list[Place] = []
    count = 0
    by_hole = {there.hole: there for there in made}
    last: tuple[Hole, MatchedHole] | None = None
    for number, hole in enumerate(expected.holes):
        there = by_hole.get(number)
        if there is None:
            count += 1
            places.append(Place(context.last_line, -1, 0.0, "nothing makes this hole", hole.file, hole.line))
            continue
        asked = last is not None and _any_between(matching.nc, last[1].end, there.first)
        over = None if last is None or asked else clearance_between_holes(run, *last, hole, there)
        found = list(faults(run, hole, there, waits, over))
        last = hole, there
        names = (context.settings.tool,) if context.settings.tool else hole.tools
        has = run.tools[run.state.tool[there.first]]
        if names and not names_tool(has, names):
            text = f"tool {has or 'none'} is in the spindle; the CL file wants {names[0]}"
            found.append((there.first, 0.0, text))
        lengths = (
            allowed_length_numbers(context.settings.tool, hole.lengths) if uses_length_numbers(run.machine) else ()
        )
        if lengths and (number := int(run.state.edge[there.first])) not in lengths:
            found.append((there.first, 0.0, length_fault_text(number, lengths)))
        k = matching.cl.before(hole.row)
        first, end = there.first + there.begins_at, there.end - there.ends_at
        if (k and matching.nc[k - 1] >= first) or (k < len(matching.nc) and matching.nc[k] < end):
            found.append((there.first, 0.0, "the hole is made before or after its turn"))
        count += len(found)
        for row, value, text in found[: max(MAX_PLACES - len(places), 0)]:
            place = context.place(row, value, text)
            places.append(replace(place, cl_file=hole.file, cl_line=hole.line))
    for there in (there for there in made if there.hole >= len(expected.holes)):
        count += 1
        places.append(context.place(there.first, 0.0, "drills where the CL file has no more holes"))
    good = f"{len(made)} holes" if made else "the CL file has none"
    motion = sum(there.by_motion for there in made)
    good += f", {motion} of them by motion" if motion else ""
    return check_from_places("holes", title, places, good, count)
