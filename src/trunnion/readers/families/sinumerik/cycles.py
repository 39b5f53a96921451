"""Drilling cycles of a Sinumerik as the motions that they make at one hole.

Heights are positions along the drilling axis, mm, in the frame of the program. The parameter lists are the classic
ones; ``cycle_modes`` makes them of those of newer controls.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import Final

from trunnion.messages import Wording
from trunnion.model.spindle_work import SpindleTask, SpindleWork
from trunnion.readers.control.hole_motion import (
    MAX_FEED,
    MAX_PECKS,
    SAME_GAP,
    CycleExecutionError,
    HoleMotion,
    chip_break,
    descent,
    full_retract,
)
from trunnion.readers.families.sinumerik.cycle_modes import MODE_PLACES
from trunnion.readers.families.sinumerik.words import CYCLE_NEEDS, CYCLE_VALUES
from trunnion.records import dataclass

#: How far a chip-breaking peck backs off by default, mm.
CHIP_BREAK: Final = 1.0


@dataclass(frozen=True, slots=True)
class Heights:
    """The heights of a drilling cycle: retract, reference and start plane, and depth."""

    retract: float
    reference: float
    start: float
    depth: float

    @property
    def sign(self) -> float:
        """-1 if drilling goes to lower values."""
        return -1.0 if self.depth < self.reference else 1.0


Arguments = Sequence[float | None]

#: Places of lengths and feeds among the arguments, from 1: the heights of all cycles; the other lengths; the feeds.
_HEIGHT_PLACES: Final = (1, 2, 3, 4, 5)
_LENGTH_PLACES: Final[dict[str, tuple[int, ...]]] = {
    "CYCLE83": (6, 7, 8, 14, 15, 17),
    "CYCLE84": (9, 17, 18),
    "CYCLE840": (11,),
    "CYCLE86": (8, 9, 10),
}
_FEED_PLACES: Final[dict[str, tuple[int, ...]]] = {"CYCLE85": (7, 8)}

#: Places of the sense of the spindle after a cycle (SDAC, SDIR), and what its values say; places of the drilling axis
#: (_AXN).
_SENSE_PLACES: Final = {"CYCLE84": 7, "CYCLE840": 8, "CYCLE86": 7, "CYCLE87": 6, "CYCLE88": 7}
_SENSES: Final = {0.0: None, 3.0: 1, 4.0: -1, 5.0: 0}
_AXIS_PLACES: Final = {"CYCLE83": 13, "CYCLE84": 13, "CYCLE840": 12}

#: Pitches that differ by less are the same, mm.
_SAME_PITCH: Final = 1e-4

#: The degression of CYCLE83; the pitch of threads, and its unit (_PITA).
_DEGRESSION: Final = 8
_PITCH_PLACES: Final = {"CYCLE84": (9, 14), "CYCLE840": (11, 13)}


def cycle_motions(name: str, arguments: Arguments, rpm: float) -> list[HoleMotion]:
    """Return the motions of a cycle at one hole.

    name       a key of ``CYCLES``
    arguments  as written; None for omitted ones
    rpm        spindle speed in force, for taps without one of their own
    """
    heights = _heights(arguments)
    motions = CYCLES[name](arguments, heights, rpm)
    if any(step.feed is not None and abs(step.feed) > MAX_FEED for step in motions):
        raise CycleExecutionError(Wording("NC380", "feed_no_machine"))
    return [HoleMotion(True, heights.start), *motions, HoleMotion(True, heights.retract)]


def in_millimetres(name: str, arguments: Arguments, length_unit: float, feed_unit: float) -> list[float | None]:
    """Return the arguments of a cycle with lengths in mm and feeds in mm/min.

    A pitch (PIT) without a unit of its own is in that of lengths, and a negative degression (_DAM) is a factor.
    """
    found = list(arguments)
    for place in (*_HEIGHT_PLACES, *_LENGTH_PLACES.get(name, ())):
        value = _get(found, place)
        is_factor = name == "CYCLE83" and place == _DEGRESSION and value is not None and value < 0.0
        has_unit = place == _PITCH_PLACES.get(name, (0, 0))[0] and bool(_or(found, _PITCH_PLACES[name][1]))
        if value is not None and not is_factor and not has_unit:
            found[place - 1] = value * length_unit
    for place in _FEED_PLACES.get(name, ()):
        value = _get(found, place)
        if value is not None:
            found[place - 1] = value * feed_unit
    return found


def unusual_values(name: str, arguments: Arguments) -> Iterator[str]:
    """Yield values of pecks that no CL file states and that are not those of the control itself: ``VRT 2``.

    How far the tool lifts to break chips, and how far above the drilled depth it feeds on (DIS1).
    """
    variant = _or(arguments, {"CYCLE83": 12, "CYCLE84": 16}.get(name, 99))
    lift = _or(arguments, {"CYCLE83": 15, "CYCLE84": 18}.get(name, 99))
    breaks = variant == 0.0 if name == "CYCLE83" else variant == 1.0
    if breaks and lift and abs(lift - CHIP_BREAK) > SAME_GAP:
        yield f"VRT {lift:g}"
    if name == "CYCLE83" and variant == 1.0 and (gap := _or(arguments, 17)):
        yield f"DIS1 {gap:g}"


def spindle_work(name: str, arguments: Arguments) -> SpindleWork | None:
    """Return how a cycle drives the spindle; None: it turns as programmed."""
    clearance = abs(_or(arguments, 3))
    match name:
        case "CYCLE84":
            size, pitch = _get(arguments, 8), _get(arguments, 9)
            stroke = abs(_or(arguments, 17)) if _or(arguments, 16) else 0.0
            return SpindleWork(
                SpindleTask.TAP,
                pitch=_pitch(size, pitch, _or(arguments, 14)),
                hand=-1 if (pitch or size or 0.0) < 0.0 else 1,
                rpm=_or(arguments, 11),
                stroke=stroke,
                full=bool(stroke) and _or(arguments, 16) == 2.0,
                clearance=clearance,
                after=_sense(arguments, name),
            )
        case "CYCLE840":
            size, pitch = _get(arguments, 10), _get(arguments, 11)
            lead = _pitch(size, pitch, _or(arguments, 13)) if size or pitch else math.nan
            hand = int(math.copysign(1, pitch or size or 1.0)) if pitch or size else 0
            after = _sense(arguments, name)
            return SpindleWork(SpindleTask.TAP, lead, hand, floating=True, clearance=clearance, after=after)
        case "CYCLE86":
            lifts = any(_or(arguments, place) for place in (8, 9, 10))
            task = SpindleTask.LIFT if lifts else SpindleTask.STOP
            return SpindleWork(task, clearance=clearance, after=_sense(arguments, name))
        case "CYCLE87" | "CYCLE88":
            return SpindleWork(SpindleTask.MANUAL, clearance=clearance, after=_sense(arguments, name))
    return None


def _sense(arguments: Arguments, name: str) -> int | None:
    """Return the sense in which a cycle leaves the spindle; None: as it was."""
    code = _or(arguments, _SENSE_PLACES[name])
    if code not in _SENSES:
        raise CycleExecutionError(Wording("NC380", "bad_spindle_sense", code=code))
    return _SENSES[code]


def check_unread(name: str, arguments: Arguments, plane_axis: int) -> None:
    """Refuse values of a cycle that change the hole and are not simulated.

    plane_axis   the axis along which it drills here: that perpendicular to the working plane
    """
    most = MODE_PLACES[name] + 2
    if any(value is not None for value in arguments[most:]):
        raise CycleExecutionError(Wording("NC380", "too_many_values", most=most, given=len(arguments)))
    if name in _SENSE_PLACES and _get(arguments, _SENSE_PLACES[name]) == 0.0:
        raise CycleExecutionError(Wording("NC380", "bad_spindle_sense", code=0.0))
    for place, word in CYCLE_NEEDS.get(name, {}).items():
        if not _or(arguments, place):
            raise CycleExecutionError(Wording("NC380", "has_no_value", value=place, word=word))
    if name in _PITCH_PLACES:
        _check_tap(name, arguments)
    for place, known in CYCLE_VALUES.get(name, {}).items():
        if (value := _or(arguments, place)) not in known:
            raise CycleExecutionError(Wording("NC215", "value_control_knows", value=value, place=place, known=known))
    place = _AXIS_PLACES.get(name, 0)
    axis = _or(arguments, place) if place else 0.0
    if axis and axis != plane_axis + 1:
        raise CycleExecutionError(Wording("NC380", "wrong_axis", axis=axis, wanted=plane_axis + 1))
    if name == "CYCLE840" and _or(arguments, 7) not in (0.0, 3.0, 4.0):
        raise CycleExecutionError(Wording("NC380", "bad_sdr"))
    if name == "CYCLE840" and (back := _or(arguments, 7)):
        pitch = _get(arguments, 11) or _get(arguments, 10)
        if not pitch or (back == 3.0) is (pitch > 0.0):
            raise CycleExecutionError(Wording("NC380", "would_leave_thread_sense_sdr"))


def _check_tap(name: str, arguments: Arguments) -> None:
    """Refuse a size of thread (MPIT) beside another pitch (PIT), and a speed (SST, SST1) below zero."""
    place, unit_place = _PITCH_PLACES[name]
    size, pitch, unit = _get(arguments, place - 1), _get(arguments, place), _or(arguments, unit_place)
    if size and pitch:
        is_same = abs(_pitch(size, None, unit) - _pitch(None, pitch, unit)) < _SAME_PITCH
        if not is_same or (size > 0.0) is not (pitch > 0.0):
            raise CycleExecutionError(Wording("NC380", "two_pitches", size=size, pitch=pitch))
    if name == "CYCLE84" and (_or(arguments, 11) < 0.0 or _or(arguments, 12) < 0.0):
        raise CycleExecutionError(Wording("NC215", "speed_below_zero"))


def _get(arguments: Arguments, place: int) -> float | None:
    """Return an argument by its position in the list, from 1."""
    return arguments[place - 1] if place <= len(arguments) else None


def _or(arguments: Arguments, place: int, default: float = 0.0) -> float:
    value = _get(arguments, place)
    return default if value is None else value


def _heights(arguments: Arguments) -> Heights:
    retract, depth, deep = _get(arguments, 1), _get(arguments, 4), _get(arguments, 5)
    reference = _or(arguments, 2)
    if retract is None:
        raise CycleExecutionError(Wording("NC380", "no_retract_plane"))
    if depth is None and deep is None:
        raise CycleExecutionError(Wording("NC380", "no_depth"))
    down = -1.0 if retract >= reference else 1.0
    # If both are given, the depth relative to the reference plane counts.
    if deep:
        depth = reference + down * abs(deep)
    elif depth is None:
        raise CycleExecutionError(Wording("NC380", "no_depth"))
    sign = -1.0 if depth < reference else 1.0
    if depth == reference or sign * (retract - reference) > 0.0:
        raise CycleExecutionError(Wording("NC380", "retract_plane_below_reference_plane"))
    return Heights(retract, reference, reference - sign * abs(_or(arguments, 3)), depth)


def _drill(arguments: Arguments, heights: Heights, rpm: float) -> list[HoleMotion]:
    return [HoleMotion(False, heights.depth, dwell=_or(arguments, 6))]


def _peck(arguments: Arguments, heights: Heights, rpm: float) -> list[HoleMotion]:
    """CYCLE83: deep drilling, with full retracts (VARI 1) or chip breaks (0)."""
    first, deep = _get(arguments, 6), _get(arguments, 7)
    sign = heights.sign
    total = abs(heights.depth - heights.reference)
    if deep:
        peck = abs(deep)
    elif first is not None:
        peck = sign * (first - heights.reference)
    else:
        raise CycleExecutionError(Wording("NC380", "no_first_depth"))
    dwell, again = _or(arguments, 9), _or(arguments, 10)
    full = _or(arguments, 12) == 1.0
    back = _or(arguments, 15) or CHIP_BREAK
    entry = _or(arguments, 17) or _entry_gap(total)
    depths = peck_depths(total, peck, _or(arguments, 8), _or(arguments, 14))

    def height(depth: float) -> float:
        return heights.reference + sign * depth

    out = full_retract(heights.start, height, entry, dwell=again, least=0.0)
    between = out if full else chip_break(height, back, least=0.0)
    motions = descent(depths, height, between, dwells=(dwell, _or(arguments, 16) or dwell))
    factor = _or(arguments, 11, 1.0)
    if 0.0 < factor < 1.0:
        motions[0] = replace(motions[0], feed=-factor)
    return motions


def peck_depths(total: float, first: float, less: float, least: float) -> list[float]:
    """Return the depths of the pecks of CYCLE83, mm below the reference plane.

    Each peck is shorter by ``less`` (a factor if negative), but not shorter than ``less`` or ``least``. The last two
    pecks are of equal length if the last one would be short.
    """
    if first <= 0.0:
        raise CycleExecutionError(Wording("NC380", "first_depth_above_reference_plane"))
    depths = [min(first, total)]
    peck = first
    floor = max(abs(least), less if less > 0.0 else 0.0)
    while total - depths[-1] > 1e-9:
        left = total - depths[-1]
        if less < 0.0:
            peck = max(peck * abs(less), floor)
        elif less > 0.0:
            peck = max(peck - less, floor)
        if peck <= 0.0 or len(depths) >= MAX_PECKS:
            raise CycleExecutionError(Wording("NC380", "too_many_pecks", most=MAX_PECKS))
        if left <= peck:
            step = left
        elif left < 2.0 * floor:
            step = 0.5 * left
            depths.append(depths[-1] + step)
            step = total - depths[-1]
        else:
            step = peck
        depths.append(depths[-1] + step)
    depths[-1] = total
    return depths


def _entry_gap(total: float) -> float:
    """Return how far above the last depth the rapid approach ends by default."""
    return 0.6 if total <= 30.0 else min(total / 50.0, 7.0)


#: Pitches of M3 to M48, mm.
PITCHES: Final = {
    3: 0.5, 4: 0.7, 5: 0.8, 6: 1.0, 8: 1.25, 10: 1.5, 12: 1.75, 14: 2.0, 16: 2.0, 18: 2.5, 20: 2.5, 22: 2.5, 24: 3.0,
    27: 3.0, 30: 3.5, 33: 3.5, 36: 4.0, 39: 4.0, 42: 4.5, 45: 4.5, 48: 5.0,
}  # fmt: skip


def _pitch(size: float | None, pitch: float | None, unit: float) -> float:
    if pitch:
        value = abs(pitch)
        if unit == 2.0:
            return 25.4 / value
        return 25.4 * value if unit == 3.0 else value
    if size and abs(size) in PITCHES:
        return PITCHES[int(abs(size))]
    raise CycleExecutionError(Wording("NC380", "no_pitch"))


def _tap(arguments: Arguments, heights: Heights, rpm: float) -> list[HoleMotion]:
    """CYCLE84: rigid tapping, in pecks if VARI and DAM ask for them."""
    pitch = _pitch(_get(arguments, 8), _get(arguments, 9), _or(arguments, 14))
    down = _or(arguments, 11) * pitch
    up = (_or(arguments, 12) or _or(arguments, 11)) * pitch
    variant, peck = _or(arguments, 16), abs(_or(arguments, 17))
    total = abs(heights.depth - heights.reference)
    depths = peck_depths(total, peck, 0.0, 0.0) if variant and peck else [total]

    def height(depth: float) -> float:
        return heights.reference + heights.sign * depth

    gap = _or(arguments, 18) or CHIP_BREAK
    back = chip_break((lambda _: heights.start) if variant == 2.0 else height, gap, up, least=0.0)
    return [*descent(depths, height, back, down, (0.0, _or(arguments, 6))), HoleMotion(False, heights.start, feed=up)]


def _tap_chuck(arguments: Arguments, heights: Heights, rpm: float) -> list[HoleMotion]:
    """CYCLE840: tapping with a compensating chuck; with an encoder of the spindle (ENC 0 or 20) the feed follows from
    the pitch, without one it may be the one in force.
    """
    size, pitch = _get(arguments, 10), _get(arguments, 11)
    has_encoder = _or(arguments, 9) in (0.0, 20.0)
    feed = rpm * _pitch(size, pitch, _or(arguments, 13)) if size or pitch or has_encoder else None
    return [
        HoleMotion(False, heights.depth, feed=feed, dwell=_or(arguments, 6)),
        HoleMotion(False, heights.start, feed=feed),
    ]


def _ream(arguments: Arguments, heights: Heights, rpm: float) -> list[HoleMotion]:
    """CYCLE85: reaming, in at FFR, out at RFF."""
    down, up = _get(arguments, 7), _get(arguments, 8)
    return [
        HoleMotion(False, heights.depth, feed=down, dwell=_or(arguments, 6)),
        HoleMotion(False, heights.start, feed=up),
    ]


def _bore(arguments: Arguments, heights: Heights, rpm: float) -> list[HoleMotion]:
    """CYCLE86: boring; at depth oriented and lifted off by RPA, RPO, RPAP, out at rapid, back over the hole."""
    lateral = (_or(arguments, 8), _or(arguments, 9))
    lifted = heights.depth + _or(arguments, 10)
    return [
        HoleMotion(False, heights.depth, dwell=_or(arguments, 6)),
        HoleMotion(True, lifted, lateral=lateral),
        HoleMotion(True, heights.start, lateral=lateral),
    ]


def _bore_out(arguments: Arguments, heights: Heights, rpm: float) -> list[HoleMotion]:
    """CYCLE89: boring, out at the feed in force."""
    return [HoleMotion(False, heights.depth, dwell=_or(arguments, 6)), HoleMotion(False, heights.start)]


def _stop_and_out(arguments: Arguments, heights: Heights, rpm: float) -> list[HoleMotion]:
    """CYCLE87: spindle and program stop at depth; the argument in the place of the dwell is the spindle's sense."""
    return [HoleMotion(False, heights.depth)]


#: The drilling cycles by name.
CYCLES: Final[dict[str, Callable[[Arguments, Heights, float], list[HoleMotion]]]] = {
    "CYCLE81": _drill,
    "CYCLE82": _drill,
    "CYCLE83": _peck,
    "CYCLE84": _tap,
    "CYCLE840": _tap_chuck,
    "CYCLE85": _ream,
    "CYCLE86": _bore,
    "CYCLE87": _stop_and_out,
    "CYCLE88": _drill,
    "CYCLE89": _bore_out,
}
