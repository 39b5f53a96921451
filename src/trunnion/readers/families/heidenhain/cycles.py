"""Drilling cycles of a TNC as the motions that they make at one hole.

Heights are positions along the tool axis, in the units of the program; depths count from the surface of the workpiece.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Final

from trunnion.messages import Wording
from trunnion.model.spindle_work import SpindleTask, SpindleWork
from trunnion.readers.control.hole_motion import (
    MAX_FEED,
    MAX_PECKS,
    CycleExecutionError,
    HoleMotion,
    chip_break,
    descent,
    finite,
    full_retract,
    peck_depths,
)
from trunnion.readers.families.heidenhain.cycle_values import check_given, check_signs
from trunnion.readers.families.heidenhain.words import CYCLE_LINES
from trunnion.readers.program.word_values import one_of

#: How far the tool moves off the wall of a bored hole, mm: a fixed value of the control.
BORING_LIFT_OFF: Final = 0.2

#: Q parameters of feeds that may be rapid, which is infinite here.
MAY_BE_RAPID: Final = frozenset({208})

#: Values of Q parameters: the depth counts from the tip of the tool (Q395), and the sense of bore milling (Q351).
Q_VALUES: Final = {395: one_of(0), 351: one_of(-1, 0, 1)}

#: Cycles whose infeed Q202 must be above 0; 241 needs none.
_WITH_INFEED: Final = (200, 203, 205)

#: Bores from below: its depth Q249 counts upwards, and it has no Q201.
_BACK_BORING: Final = 204

#: Directions of Q214 in the first and second axis of the plane.
_LIFT_DIRECTIONS: Final = {0: (0.0, 0.0), 1: (-1.0, 0.0), 2: (0.0, -1.0), 3: (1.0, 0.0), 4: (0.0, 1.0)}


class Hole:
    """The values of a cycle: Q parameters by number, and heights that all cycles have.

    values   Q parameters by number
    rpm      spindle speed
    depth    of the hole below the surface, mm, negative where drilling goes to lower values

    Heights are coordinates along the tool axis, mm; depths count from the surface, mm, with the sign of the depth.

    sign     -1 if drilling goes to lower values
    start    height of the set-up clearance
    back     height of the second set-up clearance if it is higher, else of the first
    """

    def __init__(self, values: Mapping[int, float], rpm: float, depth: float) -> None:
        self._values = values
        self.rpm = rpm
        self.surface = self.need(203)
        self.depth = depth
        if self.depth == 0.0:
            raise CycleExecutionError(Wording("NC380", "depth_0"))
        self.sign = -1.0 if self.depth < 0.0 else 1.0
        self.total = abs(self.depth)
        self.start = self.at(-self.need(200))
        self.back = self.at(-max(self.get(204), self.need(200)))

    def get(self, number: int, default: float = 0.0) -> float:
        """Return a value, or a default if the cycle does not have it."""
        given = self._values.get(number, default)
        if number in MAY_BE_RAPID and given == math.inf:
            return given
        value = finite(given)
        assert value is not None
        return value

    def need(self, number: int) -> float:
        """Return a value that the cycle must have."""
        if number not in self._values:
            raise CycleExecutionError(Wording("NC380", "has_no_parameter", missing=(f"Q{number}",)))
        return self.get(number)

    def at(self, depth: float) -> float:
        """Return the height at a depth below the surface."""
        return self.surface + self.sign * depth

    @property
    def feed(self) -> float:
        """Q206: the feed into the hole."""
        return self.need(206)

    @property
    def out(self) -> float:
        """Q208, the feed out of the hole, or Q206 if it is 0."""
        return self.get(208) or self.feed


def cycle_motions(number: int, values: Mapping[int, float], rpm: float) -> list[HoleMotion]:
    """Return the motions of a cycle of the 200 series at one hole.

    number  a key of ``CYCLES``
    values  Q parameters by number
    rpm     spindle speed, for rigid taps
    """
    check_given(number, values)
    for parameter, known in Q_VALUES.items():
        if parameter in values and values[parameter] not in known:
            raise CycleExecutionError(
                Wording("NC215", "parameter_out_of_range", parameter=parameter, value=values[parameter], known=known)
            )
    if values[200] < 0.0:
        raise CycleExecutionError(Wording("NC380", "clearance_below_zero", value=values[200]))
    check_signs(values, (202,) if number in _WITH_INFEED else ())
    if values.get(201, 0.0) > 0.0:
        raise CycleExecutionError(Wording("NC380", "depth_above_surface", value=f"Q201={values[201]:+g}"))
    hole = Hole(values, rpm, -abs(values[249]) if number == _BACK_BORING else values[201])
    motions = [
        replace(motion, rapid=True, feed=None) if motion.feed == math.inf else motion for motion in CYCLES[number](hole)
    ]
    if any(motion.feed is not None and not 0.0 <= motion.feed <= MAX_FEED for motion in motions):
        raise CycleExecutionError(Wording("NC380", "feed_no_machine"))
    motions = [HoleMotion(True, hole.start), *motions]
    return motions if hole.back == hole.start else [*motions, HoleMotion(True, hole.back)]


def _drill(hole: Hole) -> list[HoleMotion]:
    """Cycle 200: pecks of Q202, with a retract to the set-up clearance after each."""
    out = full_retract(hole.start, hole.at, hole.need(200), dwell=hole.get(210))
    depths = peck_depths(hole.total, hole.get(202))
    return [*descent(depths, hole.at, out, hole.feed, (0.0, hole.get(211))), HoleMotion(True, hole.start)]


def _ream(hole: Hole) -> list[HoleMotion]:
    """Cycle 201: reaming, out at Q208."""
    return [
        HoleMotion(False, hole.at(hole.total), hole.feed, dwell=hole.get(211)),
        HoleMotion(False, hole.start, hole.out),
    ]


def _bore(hole: Hole) -> list[HoleMotion]:
    """Cycle 202: boring, lifted off the wall at the bottom, out at Q208, and back over the hole."""
    lateral = _lift_off(hole, BORING_LIFT_OFF)
    motions = [HoleMotion(False, hole.at(hole.total), hole.feed, dwell=hole.get(211))]
    if lateral == (0.0, 0.0):
        return [*motions, HoleMotion(False, hole.start, hole.out)]
    return [
        *motions,
        HoleMotion(False, None, hole.out, lateral=lateral),
        HoleMotion(False, hole.start, hole.out, lateral=lateral),
        HoleMotion(True, None),
    ]


def _lift_off(hole: Hole, distance: float) -> tuple[float, float]:
    direction = hole.get(214)
    if direction not in _LIFT_DIRECTIONS:
        raise CycleExecutionError(Wording("NC380", "bad_direction", direction=direction))
    first, second = _LIFT_DIRECTIONS[int(direction)]
    return first * distance, second * distance


def _universal(hole: Hole) -> list[HoleMotion]:
    """Cycle 203: drilling with Q213 chip breaks between two full retracts, which are made at Q208."""
    depths = peck_depths(hole.total, hole.get(202), hole.get(212), hole.get(205) or (hole.get(202) - hole.get(212)))
    every = 1 + math.ceil(max(hole.get(213), 0.0))

    def back(depth: float) -> list[HoleMotion]:
        if (1 + depths.index(depth)) % every:
            return [HoleMotion(False, hole.at(depth - hole.get(256)), hole.out)]
        approach = HoleMotion(True, hole.at(depth - hole.need(200)))
        return [HoleMotion(False, hole.start, hole.out, dwell=hole.get(210)), approach]

    motions = descent(depths, hole.at, back, hole.feed, (0.0, hole.get(211)))
    return [*motions, HoleMotion(False, hole.start, hole.out)]


def _back_bore(hole: Hole) -> list[HoleMotion]:
    """Cycle 204: back boring, beside the hole past it, and up into its lower edge.

    Q250 is the thickness of the material, Q251 the distance from the tip to the cutting edge.
    """
    lateral = _lift_off(hole, hole.need(252))
    if lateral == (0.0, 0.0):
        raise CycleExecutionError(Wording("NC380", "not_beside_the_wall"))
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
    """Cycle 205: deep drilling from Q379 on, chip breaks every Q257 by Q256, full retracts after each peck."""
    motions: list[HoleMotion] = []
    begin = hole.get(379)
    if not 0.0 <= begin < hole.total:
        raise CycleExecutionError(Wording("NC380", "starts_below_depth"))
    if begin:
        motions.append(HoleMotion(False, hole.at(begin), hole.need(253)))
    depths = [begin + depth for depth in peck_depths(hole.total - begin, hole.get(202), hole.get(212), hole.get(205))]
    count = max(len(depths) - 2, 1)
    back = chip_break(hole.at, hole.get(256), hole.feed)
    for peck, (before, depth) in enumerate(zip([begin, *depths], depths, strict=False)):
        if peck:
            gap = hole.get(258) + (hole.get(259) - hole.get(258)) * min((peck - 1) / count, 1.0)
            motions += full_retract(hole.start, hole.at, gap, least=0.0)(before)
        pieces = [before + piece for piece in peck_depths(depth - before, hole.get(257))]
        dwell = hole.get(211) if depth == depths[-1] else 0.0
        motions += descent(pieces, hole.at, back, hole.feed, (0.0, dwell))
    return [*motions, HoleMotion(True, hole.start)]


def _tap(hole: Hole) -> list[HoleMotion]:
    """Cycle 206: tapping with a floating holder, in and out at Q206."""
    return [
        HoleMotion(False, hole.at(hole.total), hole.feed, dwell=hole.get(211)),
        HoleMotion(False, hole.start, hole.feed),
    ]


def _pitch(hole: Hole) -> float:
    feed = abs(hole.need(239)) * hole.rpm
    if feed == 0.0:
        raise CycleExecutionError(Wording("NC380", "no_pitch_no_spindle_speed"))
    return feed


def _tap_rigid(hole: Hole) -> list[HoleMotion]:
    """Cycle 207: rigid tapping; the feed follows from pitch and spindle speed."""
    feed = _pitch(hole)
    return [HoleMotion(False, hole.at(hole.total), feed), HoleMotion(False, hole.start, feed)]


def _bore_mill(hole: Hole) -> list[HoleMotion]:
    """Cycle 208: bore milling in helices along the wall, at most Q334 deep per turn, a circle at the bottom, and out.

    Only the control knows the tool radius, so these are helices of the wall. Q351 is -1 for up-cut milling.
    """
    radius, most = 0.5 * hole.need(335), hole.need(334)
    if radius <= 0.0 or most <= 0.0:
        raise CycleExecutionError(Wording("NC380", "no_diameter_q335_no_infeed"))
    share = (hole.total + hole.need(200)) / most
    if not 0.0 < share <= MAX_PECKS:
        raise CycleExecutionError(Wording("NC380", "too_many_turns", most=MAX_PECKS))
    side, lateral = -1 if hole.get(351) < 0.0 else 1, (radius, 0.0)
    return [
        HoleMotion(False, None, hole.feed, lateral=lateral),
        HoleMotion(False, hole.at(hole.total), hole.feed, lateral=lateral, turns=side * math.ceil(round(share, 9))),
        HoleMotion(False, None, hole.feed, lateral=lateral, turns=side),
        HoleMotion(False, None, hole.feed),
        HoleMotion(True, hole.start),
    ]


def _tap_break(hole: Hole) -> list[HoleMotion]:
    """Cycle 209: tapping with chip breaks every Q257, back by Q256 pitches, or all the way out if it is 0."""
    feed = _pitch(hole)
    back = hole.need(256) * abs(hole.need(239))
    break_chip = chip_break(hole.at if back else lambda _: hole.start, back, feed)
    depths = peck_depths(hole.total, hole.need(257))
    return [*descent(depths, hole.at, break_chip, feed), HoleMotion(False, hole.start, feed)]


def _centre(hole: Hole) -> list[HoleMotion]:
    """Cycle 240: centring to a depth; for a diameter the point angle of the tool would be needed."""
    if hole.get(343):
        raise CycleExecutionError(Wording("NC380", "centres_diameter_tool_point_angle"))
    return [HoleMotion(False, hole.at(hole.total), hole.feed, dwell=hole.get(211)), HoleMotion(True, hole.start)]


def _gun_drill(hole: Hole) -> list[HoleMotion]:
    """Cycle 241: gun drilling from Q379 on, in one pass."""
    motions: list[HoleMotion] = []
    begin = hole.get(379)
    if not 0.0 <= begin < hole.total:
        raise CycleExecutionError(Wording("NC380", "starts_below_depth"))
    if begin:
        motions.append(HoleMotion(False, hole.at(begin - hole.need(200)), hole.need(253)))
    motions.append(HoleMotion(False, hole.at(hole.total), hole.feed, dwell=hole.get(211)))
    return [*motions, HoleMotion(False, hole.start, hole.out)]


#: The cycles of the 200 series by number.
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


def spindle_work(number: int, values: Mapping[int, float], unit: float) -> SpindleWork | None:
    """Return how a cycle of the 200 series drives the spindle; None: it turns as programmed.

    unit   millimetres of a length
    """
    clearance = abs(values.get(200, 0.0)) * unit
    match number:
        case 206:
            return SpindleWork(SpindleTask.TAP, floating=True, clearance=clearance)
        case 207 | 209:
            pitch = values.get(239, math.nan)
            stroke = abs(values.get(257, 0.0)) * unit if number == 209 else 0.0
            hand = -1 if pitch < 0.0 else 1
            full = bool(stroke) and not values.get(256)
            return SpindleWork(SpindleTask.TAP, abs(pitch) * unit, hand, stroke=stroke, full=full, clearance=clearance)
        case 202:
            return SpindleWork(SpindleTask.LIFT if values.get(214) else SpindleTask.STOP, clearance=clearance)
        case 204:
            return SpindleWork(SpindleTask.LIFT, clearance=clearance)
    return None


def legacy_spindle_work(number: int, values: Mapping[str, float], unit: float) -> SpindleWork | None:
    """As ``spindle_work``, for cycles 1, 2 and 17."""
    clearance = abs(values.get("DIST", 0.0)) * unit
    if number == 2:
        return SpindleWork(SpindleTask.TAP, floating=True, clearance=clearance)
    if number == 17:
        pitch = values.get("PITCH", math.nan)
        return SpindleWork(SpindleTask.TAP, abs(pitch) * unit, -1 if pitch < 0.0 else 1, clearance=clearance)
    return None


def legacy_cycle_motions(number: int, values: Mapping[str, float], rpm: float, here: float) -> list[HoleMotion]:
    """Return the motions of cycle 1, 2 or 17 from the present position, ``here`` along the tool axis.

    values  DIST, DEPTH, PLNGNG, DWELL, F and PITCH
    """

    for name in CYCLE_LINES[number].values():
        if name not in values:
            raise CycleExecutionError(Wording("NC380", "has_no", word=name))

    def need(name: str) -> float:
        value = finite(values[name])
        assert value is not None
        return value

    # Older programs have a clearance and an infeed with the sign of the depth, newer ones without.
    clearance, depth = abs(need("DIST")), need("DEPTH")
    if depth == 0.0:
        raise CycleExecutionError(Wording("NC380", "depth_0"))
    if depth > 0.0:
        raise CycleExecutionError(Wording("NC380", "depth_above_surface", value=f"DEPTH {depth:+g}"))
    total, surface = -depth, here - clearance
    if number != 1:
        feed = abs(need("PITCH")) * rpm if number == 17 else need("F")
        if not 0.0 < feed <= MAX_FEED:
            raise CycleExecutionError(Wording("NC380", "no_feed_machine"))
        bottom = HoleMotion(False, surface - total, feed, dwell=need("DWELL") if number != 17 else 0.0)
        return [bottom, HoleMotion(False, here, feed)]
    feed = need("F")
    if not 0.0 <= feed <= MAX_FEED:
        raise CycleExecutionError(Wording("NC380", "feed_no_machine"))
    # How far above the last depth the rapid approach ends: fixed values of the control.
    gap = 0.6 if total <= 30.0 else min(total / 50.0, 7.0)

    def height(depth: float) -> float:
        return surface - depth

    out, depths = full_retract(here, height, gap), peck_depths(total, abs(need("PLNGNG")))
    return [*descent(depths, height, out, feed, (0.0, need("DWELL"))), HoleMotion(True, here)]


#: Cycles whose heights count from the present position.
LEGACY_CYCLES: Final = frozenset({1, 2, 17})
