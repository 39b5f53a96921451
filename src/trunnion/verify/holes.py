"""Each hole against what the CL file's cycle asks for. Heights are as in ``trunnion.verify.cycles``."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.reader import Run, numbers_lengths
from trunnion.toolpath import Kind
from trunnion.verify.case import NAMED, Case, judged
from trunnion.verify.cycles import Hole, Made, made_in, straight_over
from trunnion.verify.in_force import lacks_length, lengths_of
from trunnion.verify.model import Check, Place
from trunnion.verify.rows import Rows
from trunnion.verify.wanted import is_called

#: A spindle speed is printed without decimals.
_RPM = 0.5 + 1e-6

#: Half of the last digit of the feeds of threads, mm/min or mm/rev, and of pitches, mm; and rounding here.
_FEED, _PITCH, _NOISE = 0.005, 5e-6, 1e-6

#: Cycles that leave the hole at a feed.
_FED_OUT = ("TAP", "REAM")

#: A stroke that breaks chips is drawn back by less than this, mm.
_CHIP = 5.0


def faults(
    run: Run, hole: Hole, made: Made, waits: Mapping[int, list[float]], over: float | None = None
) -> Iterator[tuple[int, float, str]]:
    """What is wrong with one hole: row, value and words.

    ``waits`` are the dwells of the run, by row; ``over`` is as ``straight_over`` has it, from the hole before.
    """
    spindle = float(run.state.rpm[made.end - 1])
    rows = np.arange(max(made.first - 1, 0), made.end)
    poses = run.poses(rows)
    offset = poses.tip - hole.tip
    height = offset @ hole.axis
    aside = np.linalg.norm(offset - height[:, None] * hole.axis, axis=1)
    near = 3.0 * hole.allowed + 2e-6  # points and heights are rounded, each in three coordinates
    h, kind = height[1:], run.kind[rows[1:]]
    at = rows[1:]
    if float(np.abs(poses.axis[1:] - hole.axis).max()) > 1e-6 + np.radians(4.0 * hole.allowed):
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
    yield from _strokes(run, hole, at, h, near)
    yield from _fed(run, hole, at, h, spindle)
    yield from _dwells(hole, int(at[int(np.argmin(h))]), waits, spindle)
    turns = int(run.state.spindle[made.end - 1])
    if hole.rpm is not None and (turns != hole.sense or (turns and abs(spindle - hole.rpm) > _RPM)):
        yield int(at[1]), spindle, f"the spindle turns with {turns * spindle:g}, not with {hole.sense * hole.rpm:g}"


def _any_between(rows: Rows, first: int, last: int) -> bool:
    """Whether any of growing ``rows`` is from ``first`` to ``last``."""
    return rows.before(last + 1) > rows.before(first)


def _strokes(run: Run, hole: Hole, at: Ints, h: Floats, near: float) -> Iterator[tuple[int, float, str]]:
    """Rapids stay above what is drilled; strokes and how the tool is drawn back between them are those of the cycle."""
    kind = run.kind[at]
    deepest = hole.above
    ends: list[float] = []
    between: list[list[int]] = []
    for k in range(1, len(h)):
        if kind[k] == Kind.RAPID and h[k] < deepest - near:
            yield int(at[k]), float(h[k]), "goes at rapid where nothing is drilled yet"
        elif kind[k] == Kind.LINEAR and h[k] < deepest - 1e-9:
            ends.append(float(h[k]))
            between.append([])
        elif between:
            between[-1].append(k)
        deepest = min(deepest, float(h[k]))
    if not hole.steps:
        if len(ends) > 1:
            yield int(at[2]), float(len(ends)), f"drills in {len(ends)} strokes, the CL file in one"
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
        for end, rows in zip(ends, between[:-1], strict=False):
            top = max((float(h[k]) for k in rows), default=-math.inf)
            full, back = abs(top - hole.above) <= near, top - end
            if full != ("DEEP" in hole.mode) or (not full and back > _CHIP):
                how = "all the way" if full else "a little"
                yield (
                    int(at[2]),
                    top,
                    f"between strokes the tool is drawn back {how}; the CL file says otherwise",
                )
                break
    bottom = int(np.argmin(h))
    if bottom + 1 < len(h) and hole.depth > 0.0:
        fed = hole.mode[0] in _FED_OUT or hole.mode == ("BORE",)
        if (kind[bottom + 1] == Kind.LINEAR) != fed:
            how = "at rapid" if fed else "at a feed"
            yield int(at[bottom + 1]), 0.0, f"leaves the hole {how}, which is not what the CL file says"


def _fed(run: Run, hole: Hole, at: Ints, h: Floats, spindle: float) -> Iterator[tuple[int, float, str]]:
    """Feeds of the cycle."""
    lines = at[run.kind[at] == Kind.LINEAR]
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
    hole: Hole, bottom: int, waits: Mapping[int, list[float]], spindle: float
) -> Iterator[tuple[int, float, str]]:
    """How long the tool waits at the bottom."""
    want = 60.0 * hole.dwell / spindle if hole.dwell_turns and spindle else hole.dwell
    has = sum(wait if wait >= 0.0 else -60.0 * wait / max(spindle, 1e-9) for wait in waits.get(bottom + 1, ()))
    if abs(has - want) > 5.1e-4:
        yield bottom, has, f"waits {has:g} s at the bottom; the CL file wants {want:g}"


def holes(case: Case) -> Check:
    """Every hole of the CL file is made as its cycle asks, in its turn between the points; and no other."""
    wanted, pairs, run = case.wanted, case.pairs, case.run
    assert wanted is not None
    assert pairs is not None
    title = "holes as the cycles of the CL file ask"
    made = made_in(run, wanted.holes)
    waits: dict[int, list[float]] = {}
    for event in run.events:
        if event.kind == "dwell" and isinstance(event.value, float):
            waits.setdefault(event.before_row, []).append(event.value)
    places: list[Place] = []
    count = 0
    last: tuple[Hole, Made] | None = None
    for hole, there in zip(wanted.holes, made, strict=False):
        asked = last is not None and _any_between(pairs.nc, last[1].end, there.first)
        over = None if last is None or asked else straight_over(run, *last, hole, there)
        found = list(faults(run, hole, there, waits, over))
        last = hole, there
        names = (case.settings.tool,) if case.settings.tool else hole.tools
        has = run.tools[run.state.tool[there.first]]
        if names and not is_called(has, names):
            text = f"tool {has or 'none'} is in the spindle; the CL file wants {names[0]}"
            found.append((there.first, 0.0, text))
        lengths = lengths_of(case.settings.tool, hole.lengths) if numbers_lengths(run.machine) else ()
        if lengths and (number := int(run.state.edge[there.first])) not in lengths:
            found.append((there.first, 0.0, lacks_length(number, lengths)))
        k = pairs.cl.before(hole.row)
        if (k and pairs.nc[k - 1] >= there.first) or (k < len(pairs.nc) and pairs.nc[k] < there.end):
            found.append((there.first, 0.0, "the hole is made before or after its turn"))
        count += len(found)
        for row, value, text in found[: max(NAMED - len(places), 0)]:
            place = case.place(row, value, text)
            places.append(replace(place, cl_file=hole.file, cl_line=hole.line))
    for there in made[len(wanted.holes) :]:
        count += 1
        places.append(case.place(there.first, 0.0, "drills where the CL file has no more holes"))
    for hole in wanted.holes[len(made) :]:
        count += 1
        places.append(Place(case.last_line, -1, 0.0, "no cycle makes this hole", hole.file, hole.line))
    good = f"{len(made)} holes" if made else "the CL file has none"
    return judged("holes", title, places, good, count)
