"""Drilling cycles as the motions that they make at one hole.

Heights are positions along the tool axis in the program's coordinate system and units; depths count from the surface.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Final

from trunnion.readers.control.hole_motion import MAX_FEED, MAX_PECKS, CycleExecutionError, HoleMotion, finite

#: How far the tool moves off the wall of a bored hole, mm; the control has it fixed.
BORING_LIFT_OFF: Final = 0.2

#: Feeds out of the hole, which may be rapid: infinite.
MAY_BE_RAPID: Final = frozenset({208})

#: Directions of Q214: first and second axis of the plane.
_LIFT_DIRECTIONS: Final = {0: (0.0, 0.0), 1: (-1.0, 0.0), 2: (0.0, -1.0), 3: (1.0, 0.0), 4: (0.0, 1.0)}


class Hole:
    """A cycle's values: Q parameters by number, and what follows from those that all cycles have.

    sign     -1 if drilling goes to lower values
    start    set-up clearance over the surface
    back     second set-up clearance if it is higher, else the first
    """

    def __init__(self, values: Mapping[int, float], rpm: float) -> None:
        self._values = values
        self.rpm = rpm
        self.surface = self.need(203)
        self.depth = self.need(201)
        if self.depth == 0.0:
            raise CycleExecutionError("has the depth 0")
        self.sign = -1.0 if self.depth < 0.0 else 1.0
        self.total = abs(self.depth)
        self.start = self.at(-self.need(200))
        self.back = self.at(-max(self.get(204), self.need(200)))

    def get(self, number: int, default: float = 0.0) -> float:
        """A value, or a default where the cycle does not have it."""
        given = self._values.get(number, default)
        if number in MAY_BE_RAPID and given == math.inf:
            return given
        value = finite(given)
        assert value is not None
        return value

    def need(self, number: int) -> float:
        """A value that the cycle cannot do without."""
        if number not in self._values:
            raise CycleExecutionError(f"has no Q{number}")
        return self.get(number)

    def at(self, depth: float) -> float:
        """Height at a depth below the surface."""
        return self.surface + self.sign * depth

    @property
    def feed(self) -> float:
        """Q206."""
        return self.need(206)

    @property
    def out(self) -> float:
        """Q208, or Q206 if it is 0."""
        return self.get(208) or self.feed


def cycle_motions(number: int, values: Mapping[int, float], rpm: float) -> list[HoleMotion]:
    """Return the motions of a cycle of the 200 series at one hole; ``number`` is a key of ``CYCLES``.

    Parameters
    ----------
    values
        Its Q parameters by number.
    rpm
        Spindle speed in force, for rigid taps.
    """
    hole = Hole(values, rpm)
    made = [replace(step, rapid=True, feed=None) if step.feed == math.inf else step for step in CYCLES[number](hole)]
    if any(step.feed is not None and not 0.0 <= step.feed <= MAX_FEED for step in made):
        raise CycleExecutionError("has a feed that no machine has")
    made = [HoleMotion(True, hole.start), *made]
    return made if hole.back == hole.start else [*made, HoleMotion(True, hole.back)]


def peck_depths(total: float, first: float, less: float = 0.0, least: float = 0.0) -> list[float]:
    """Depths that are drilled to one after another: each stroke shorter by ``less``, none shorter than ``least``.

    A first stroke that is not positive, or that is longer than the whole, is the whole.
    """
    if not 0.0 < first < total:
        return [total]
    depths = [first]
    stroke = first
    while total - depths[-1] > 1e-9:
        stroke = max(stroke - less, least)
        if stroke <= 0.0 or len(depths) >= MAX_PECKS:
            raise CycleExecutionError(f"would peck more than {MAX_PECKS} times")
        depths.append(min(depths[-1] + stroke, total))
    depths[-1] = total
    return depths


def _drill(hole: Hole) -> list[HoleMotion]:
    """200: pecks of Q202, out to the set-up clearance after each."""
    made: list[HoleMotion] = []
    depths = peck_depths(hole.total, hole.get(202), 0.0, hole.get(202))
    for before, depth in zip([0.0, *depths], depths, strict=False):
        if before:
            made.append(HoleMotion(True, hole.start, dwell=hole.get(210)))
            made.append(HoleMotion(True, hole.at(before - hole.need(200))))
        made.append(HoleMotion(False, hole.at(depth), hole.feed, dwell=hole.get(211) if depth == hole.total else 0.0))
    return [*made, HoleMotion(True, hole.start)]


def _ream(hole: Hole) -> list[HoleMotion]:
    """201."""
    return [
        HoleMotion(False, hole.at(hole.total), hole.feed, dwell=hole.get(211)),
        HoleMotion(False, hole.start, hole.out),
    ]


def _bore(hole: Hole) -> list[HoleMotion]:
    """202: off the wall at the bottom, out at Q208, back over the hole."""
    lateral = _lift_off(hole, BORING_LIFT_OFF)
    made = [HoleMotion(False, hole.at(hole.total), hole.feed, dwell=hole.get(211))]
    if lateral == (0.0, 0.0):
        return [*made, HoleMotion(False, hole.start, hole.out)]
    return [
        *made,
        HoleMotion(False, None, hole.out, lateral=lateral),
        HoleMotion(False, hole.start, hole.out, lateral=lateral),
        HoleMotion(True, None),
    ]


def _lift_off(hole: Hole, distance: float) -> tuple[float, float]:
    direction = hole.get(214)
    if direction not in _LIFT_DIRECTIONS:
        raise CycleExecutionError(f"has Q214={direction:g}, which is no direction")
    first, second = _LIFT_DIRECTIONS[int(direction)]
    return first * distance, second * distance


def _universal(hole: Hole) -> list[HoleMotion]:
    """203: Q213 chip breaks between two full retracts, at Q208."""
    made: list[HoleMotion] = []
    breaks = 0
    depths = peck_depths(hole.total, hole.get(202), hole.get(212), hole.get(205) or (hole.get(202) - hole.get(212)))
    for before, depth in zip([0.0, *depths], depths, strict=False):
        if before and breaks < hole.get(213):
            breaks += 1
            made.append(HoleMotion(False, hole.at(before - hole.get(256)), hole.out))
        elif before:
            breaks = 0
            made.append(HoleMotion(False, hole.start, hole.out, dwell=hole.get(210)))
            made.append(HoleMotion(True, hole.at(before - hole.need(200))))
        made.append(HoleMotion(False, hole.at(depth), hole.feed, dwell=hole.get(211) if depth == hole.total else 0.0))
    return [*made, HoleMotion(False, hole.start, hole.out)]


def _back_bore(hole: Hole) -> list[HoleMotion]:
    """204: past the hole aside, and up into its lower edge; Q250 is the thickness, Q251 from tip to cutting edge."""
    lateral = _lift_off(hole, hole.need(252))
    free = hole.at(hole.need(250) + hole.get(251) + hole.need(200))
    deep = hole.at(hole.need(250) + hole.get(251) - hole.need(249))
    slow, cut = hole.get(253), hole.need(254)
    return [
        HoleMotion(True, None, lateral=lateral),
        HoleMotion(False, free, slow, lateral=lateral),
        HoleMotion(False, None, slow),
        HoleMotion(False, deep, cut, dwell=hole.get(255)),
        HoleMotion(False, free, slow),
        HoleMotion(False, None, slow, lateral=lateral),
        HoleMotion(False, hole.start, slow, lateral=lateral),
        HoleMotion(True, None),
    ]


def _deep(hole: Hole) -> list[HoleMotion]:
    """205: from Q379 on, chip breaks every Q257 by Q256, full retracts after every stroke."""
    made: list[HoleMotion] = []
    begin = hole.get(379)
    if not 0.0 <= begin < hole.total:
        raise CycleExecutionError("starts below its depth")
    if begin:
        made.append(HoleMotion(False, hole.at(begin), hole.need(253)))
    depths = [begin + depth for depth in peck_depths(hole.total - begin, hole.get(202), hole.get(212), hole.get(205))]
    count = max(len(depths) - 2, 1)
    for stroke, (before, depth) in enumerate(zip([begin, *depths], depths, strict=False)):
        if stroke:
            gap = hole.get(258) + (hole.get(259) - hole.get(258)) * min((stroke - 1) / count, 1.0)
            made.append(HoleMotion(True, hole.start))
            made.append(HoleMotion(True, hole.at(max(before - gap, 0.0))))
        pieces = peck_depths(depth - before, hole.get(257), 0.0, hole.get(257))
        for k, piece in enumerate(pieces):
            if k:
                made.append(HoleMotion(False, hole.at(before + pieces[k - 1] - hole.get(256)), hole.feed))
            last = before + piece >= hole.total - 1e-9
            made.append(HoleMotion(False, hole.at(before + piece), hole.feed, dwell=hole.get(211) if last else 0.0))
    return [*made, HoleMotion(True, hole.start)]


def _tap(hole: Hole) -> list[HoleMotion]:
    """206, with a floating holder: in and out at Q206."""
    return [
        HoleMotion(False, hole.at(hole.total), hole.feed, dwell=hole.get(211)),
        HoleMotion(False, hole.start, hole.feed),
    ]


def _pitch(hole: Hole) -> float:
    feed = abs(hole.need(239)) * hole.rpm
    if feed == 0.0:
        raise CycleExecutionError("has no pitch or no spindle speed")
    return feed


def _tap_rigid(hole: Hole) -> list[HoleMotion]:
    """207: the feed follows from pitch and spindle."""
    feed = _pitch(hole)
    return [HoleMotion(False, hole.at(hole.total), feed), HoleMotion(False, hole.start, feed)]


def _bore_mill(hole: Hole) -> list[HoleMotion]:
    """208: in helices down along the wall, no deeper a turn than Q334, once more round at the bottom, and out.

    The tool's radius is the control's: what goes round is the point of the wall. Q351 is -1 for up-cut milling.
    """
    radius, most = 0.5 * hole.need(335), hole.need(334)
    if radius <= 0.0 or most <= 0.0:
        raise CycleExecutionError("has no diameter (Q335) or no infeed (Q334)")
    share = (hole.total + hole.need(200)) / most
    if not 0.0 < share <= MAX_PECKS:
        raise CycleExecutionError(f"would turn more than {MAX_PECKS} times, or not at all")
    side, lateral = -1 if hole.get(351) < 0.0 else 1, (radius, 0.0)
    return [
        HoleMotion(False, None, hole.feed, lateral=lateral),
        HoleMotion(False, hole.at(hole.total), hole.feed, lateral=lateral, turns=side * math.ceil(round(share, 9))),
        HoleMotion(False, None, hole.feed, lateral=lateral, turns=side),
        HoleMotion(False, None, hole.feed),
        HoleMotion(True, hole.start),
    ]


def _tap_break(hole: Hole) -> list[HoleMotion]:
    """209: chip breaks every Q257; back by Q256 pitches, or all the way out if it is 0."""
    feed = _pitch(hole)
    made: list[HoleMotion] = []
    depths = peck_depths(hole.total, hole.get(257), 0.0, hole.get(257))
    back = hole.get(256) * abs(hole.need(239))
    for before, depth in zip([0.0, *depths], depths, strict=False):
        if before:
            made.append(HoleMotion(False, hole.at(before - back) if back else hole.start, feed))
        made.append(HoleMotion(False, hole.at(depth), feed))
    return [*made, HoleMotion(False, hole.start, feed)]


def _centre(hole: Hole) -> list[HoleMotion]:
    """240, by depth; by diameter it would need the tool's point angle."""
    if hole.get(343):
        raise CycleExecutionError("centres to a diameter, for which the tool's point angle is not in the program")
    return [HoleMotion(False, hole.at(hole.total), hole.feed, dwell=hole.get(211)), HoleMotion(True, hole.start)]


def _gun_drill(hole: Hole) -> list[HoleMotion]:
    """241: from Q379 on, in one stroke."""
    made: list[HoleMotion] = []
    begin = hole.get(379)
    if not 0.0 <= begin < hole.total:
        raise CycleExecutionError("starts below its depth")
    if begin:
        made.append(HoleMotion(False, hole.at(begin - hole.need(200)), hole.need(253)))
    made.append(HoleMotion(False, hole.at(hole.total), hole.feed, dwell=hole.get(211)))
    return [*made, HoleMotion(False, hole.start, hole.out)]


#: Cycles of the 200 series by number.
CYCLES: Final[dict[int, Callable[[Hole], list[HoleMotion]]]] = {
    200: _drill,
    201: _ream,
    202: _bore,
    203: _universal,
    204: _back_bore,
    205: _deep,
    206: _tap,
    207: _tap_rigid,
    208: _bore_mill,
    209: _tap_break,
    240: _centre,
    241: _gun_drill,
}


def legacy_cycle_motions(number: int, values: Mapping[str, float], rpm: float, here: float) -> list[HoleMotion]:
    """Return the motions of cycle 1, 2 or 17 from where the tool stands, ``here`` along its axis.

    Parameters
    ----------
    values
        DIST, DEPTH, PLNGNG, DWELL, F and PITCH of its lines.
    """

    def need(name: str) -> float:
        if name not in values:
            raise CycleExecutionError(f"has no {name}")
        value = finite(values[name])
        assert value is not None
        return value

    clearance, depth = abs(need("DIST")), need("DEPTH")
    if depth == 0.0:
        raise CycleExecutionError("has the depth 0")
    sign = -1.0 if depth < 0.0 else 1.0
    total = abs(depth)
    surface = here + sign * clearance
    if number != 1:
        feed = abs(need("PITCH")) * rpm if number == 17 else need("F")
        if not 0.0 < feed <= MAX_FEED:
            raise CycleExecutionError("has no feed that a machine has")
        bottom = HoleMotion(False, surface + sign * total, feed, dwell=values.get("DWELL", 0.0))
        return [bottom, HoleMotion(False, here, feed)]
    feed = need("F")
    if not 0.0 <= feed <= MAX_FEED:
        raise CycleExecutionError("has a feed that no machine has")
    # How far above the last depth the rapid ends, as the control has it built in.
    gap = 0.6 if total <= 30.0 else min(total / 50.0, 7.0)
    made: list[HoleMotion] = []
    depths = peck_depths(total, abs(need("PLNGNG")), 0.0, abs(need("PLNGNG")))
    for before, reached in zip([0.0, *depths], depths, strict=False):
        if before:
            made.append(HoleMotion(True, here))
            made.append(HoleMotion(True, surface + sign * (before - gap)))
        last = reached == total
        made.append(HoleMotion(False, surface + sign * reached, feed, dwell=values.get("DWELL", 0.0) if last else 0.0))
    return [*made, HoleMotion(True, here)]


#: Cycles that count from where the tool stands.
LEGACY_CYCLES: Final = frozenset({1, 2, 17})
