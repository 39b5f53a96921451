"""What a CYCLE statement of a CL file asks for at each hole.

Heights are distances along the tool axis from the point of the hole, mm, up is positive. docs/cl.md says what each
word means.
"""

import math
from bisect import bisect_left, bisect_right
from collections.abc import Mapping, Sequence
from enum import StrEnum
from typing import Final

from trunnion.messages import Wording
from trunnion.model.toolpath import CycleOn, Event, Sense, SpindleOff, SpindleOn
from trunnion.records import dataclass


class HoleMethod(StrEnum):
    """How a hole is made; values are the words of CYCLE, for messages."""

    DRILL = "DRILL"
    DEEP_DRILLING = "DRILL,DEEP"
    CHIP_BREAKING = "DRILL,BRKCHP"
    TAP = "TAP"
    FLOATING_TAP = "TAP,OPTION"
    DEEP_TAP = "TAP,DEEP"
    CHIP_BREAKING_TAP = "TAP,BRKCHP"
    REAM = "REAM"
    BORE = "BORE,DRAG"
    BORE_WITH_LIFT = "BORE,NODRAG"
    BORE_MANUAL = "BORE,MANUAL"


_METHODS: Final = {
    ("DRILL",): HoleMethod.DRILL,
    ("FACE",): HoleMethod.DRILL,
    ("DRILL", "FACE"): HoleMethod.DRILL,
    ("DRILL", "CSINK"): HoleMethod.DRILL,
    ("CSINK",): HoleMethod.DRILL,
    ("DRILL", "DEEP"): HoleMethod.DEEP_DRILLING,
    ("DRILL", "BRKCHP"): HoleMethod.CHIP_BREAKING,
    ("TAP",): HoleMethod.TAP,
    ("TAP", "DEEP"): HoleMethod.DEEP_TAP,
    ("TAP", "BRKCHP"): HoleMethod.CHIP_BREAKING_TAP,
    ("BORE",): HoleMethod.REAM,
    ("REAM",): HoleMethod.REAM,
    ("BORE", "DRAG"): HoleMethod.BORE,
    ("BORE", "NODRAG"): HoleMethod.BORE_WITH_LIFT,
    ("BORE", "MANUAL"): HoleMethod.BORE_MANUAL,
}

#: Methods that need the length of a peck.
_IN_PECKS: Final = (
    HoleMethod.DEEP_DRILLING,
    HoleMethod.CHIP_BREAKING,
    HoleMethod.DEEP_TAP,
    HoleMethod.CHIP_BREAKING_TAP,
)

#: Methods that cut threads.
_TAPS: Final = (HoleMethod.TAP, HoleMethod.FLOATING_TAP, HoleMethod.DEEP_TAP, HoleMethod.CHIP_BREAKING_TAP)

#: No length, feed or angle of a cycle is as large as this.
_FARTHEST: Final = 1e6

#: Words of modes that may end at the point itself, without a depth.
_NO_DEPTH: Final = frozenset({"DRILL", "FACE", "BORE", "DRAG", "REAM"})

#: FEDTO and the depth of a countersink may differ by this, mm.
_SAME_DEPTH: Final = 0.01


class HoleCycleError(Exception):
    """A cycle cannot be made: what is said of it, and the CL ``line`` if known (else 0)."""

    def __init__(self, wording: Wording, line: int = 0) -> None:
        super().__init__(wording)
        self.wording, self.line = wording, line


class UnsupportedCycleError(HoleCycleError):
    """A complete cycle that a control has no words for; motion may make its holes."""


@dataclass(frozen=True, slots=True)
class Cycle:
    """What a cycle asks for at each hole.

    rapid_height          height to which the tool moves at rapid
    depth                 how far below the point the hole goes
    retract_height        height to which the tool retracts, no lower than ``rapid_height``; None: where it was before
                          the first hole
    pecks               length of the first peck, by how much each next one is shorter, the shortest one
    dwell                 at the bottom: seconds, or spindle revolutions if ``dwell_in_revolutions``
    feed                  mm/min, or mm/rev if ``per_rev``; None: the modal feed
    spindle_angle         for BORE,NODRAG, degrees
    """

    method: HoleMethod
    rapid_height: float
    depth: float
    retract_height: float | None
    pecks: tuple[float, float, float]
    dwell: float
    dwell_in_revolutions: bool
    feed: float | None
    per_rev: bool
    spindle_angle: float


@dataclass(frozen=True, slots=True)
class SpindleState:
    """The running spindle: rev/min and sense of rotation."""

    rpm: float
    sense: Sense


class SpindleStates:
    """The spindle along an operation; ``before``: at its start."""

    def __init__(self, events: Sequence[Event], before: SpindleState | None) -> None:
        self._rows: list[int] = []
        self._states = [before]
        for event in events:
            if isinstance(event, SpindleOn | SpindleOff):
                self._rows.append(event.row)
                self._states.append(SpindleState(event.rpm, event.sense) if isinstance(event, SpindleOn) else None)

    def at(self, row: int) -> SpindleState | None:
        """Return the spindle at a row; None: it stands still."""
        return self._states[bisect_right(self._rows, row)]

    def changes_between(self, first: int, end: int) -> list[int]:
        """Rows after ``first`` and before ``end`` at which the spindle is switched, increasing."""
        low, high = bisect_right(self._rows, first), bisect_left(self._rows, end)
        return list(dict.fromkeys(self._rows[low:high]))


def cycle_from_event(event: CycleOn) -> Cycle:
    """Read a CYCLE statement.

    Raises ``HoleCycleError`` when the cycle is unknown, or leaves out something that it needs.
    """
    values, words = dict(event.values), dict(event.words)
    if any(not abs(number) < _FARTHEST for given in values.values() for number in given):
        raise HoleCycleError(Wording("PLN620", "cycle_number_no"))
    method = _method(event.mode, words)
    rapid_height = _first(values, "RAPTO", _first(values, "CLEAR", math.nan))
    if not rapid_height >= 0.0:
        raise HoleCycleError(Wording("PLN610", "cycle_without_rapto"))
    pecks = (*values.get("STEP", ()), 0.0, 0.0, 0.0)[:3]
    if method in _IN_PECKS and not pecks[0] > 0.0:
        raise HoleCycleError(Wording("PLN610", "cycle_without_step", method=method))
    if words.get("RTRCTO") == "MANUAL":
        raise HoleCycleError(Wording("PLN610", "rtrcto_manual_does"))
    is_auto = words.get("RTRCTO") == "AUTO"
    per_rev = "MMPR" in values
    return Cycle(
        method=method,
        rapid_height=rapid_height,
        depth=_depth(event.mode, values),
        retract_height=None if is_auto else max(_first(values, "RTRCTO", rapid_height), rapid_height),
        pecks=(pecks[0], pecks[1], pecks[2]),
        dwell=_first(values, "DWELL", 0.0),
        dwell_in_revolutions=words.get("DWELL") == "REV",
        feed=_first(values, "MMPR" if per_rev else "MMPM", math.nan) if per_rev or "MMPM" in values else None,
        per_rev=per_rev,
        spindle_angle=_first(values, "NODRAG", 0.0),
    )


def cycle_feed(cycle: Cycle, spindle: SpindleState | None, modal: float, modal_per_rev: bool) -> tuple[float, bool]:
    """Return the feed in force in a cycle, and whether it is per revolution: the cycle's own, or else the modal one.

    A tap's feed per revolution is returned per minute if the speed of the spindle is known.
    """
    if cycle.feed is None:
        return modal, modal_per_rev
    if cycle.method in _TAPS and cycle.per_rev and spindle is not None:
        return cycle.feed * spindle.rpm, False
    return cycle.feed, cycle.per_rev


def _method(mode: tuple[str, ...], words: Mapping[str, str]) -> HoleMethod:
    method = _METHODS.get(mode)
    if mode == ("BORE", "BACK"):
        raise HoleCycleError(Wording("PLN630", "cycle_bore_back"))
    if method is None:
        raise HoleCycleError(Wording("PLN630", "cycle_cycle_cannot", mode=tuple(mode)))
    if "OPTION" not in words:
        return method
    if method in (HoleMethod.DEEP_TAP, HoleMethod.CHIP_BREAKING_TAP):
        raise HoleCycleError(Wording("PLN630", "cycle_option_compensating", method=method))
    return HoleMethod.FLOATING_TAP if method is HoleMethod.TAP else method


def _first(values: Mapping[str, tuple[float, ...]], word: str, default: float) -> float:
    """Return the first number after a word."""
    given = values.get(word)
    return given[0] if given else default


def _depth(mode: Sequence[str], values: Mapping[str, tuple[float, ...]]) -> float:
    """FEDTO without its sign; for a countersink the depth that follows from its diameter and the tool's angle."""
    depth = abs(_first(values, "FEDTO", 0.0))
    if "CSINK" in mode and "CSKDIA" in values:
        angle = _first(values, "TLANGL", 0.0)
        if not 0.0 < angle < 180.0:
            raise HoleCycleError(Wording("PLN610", "cycle_drill_csink"))
        countersunk = 0.5 * values["CSKDIA"][0] / math.tan(math.radians(0.5 * angle))
        if depth and abs(depth - countersunk) > _SAME_DEPTH:
            raise HoleCycleError(Wording("PLN620", "cycle_drill_csink", depth=depth, countersunk=countersunk))
        depth = countersunk
    if depth > 0.0:
        return depth
    if "FEDTO" not in values:
        raise HoleCycleError(Wording("PLN610", "cycle_without_depth"))
    if not _first(values, "RAPTO", _first(values, "CLEAR", 0.0)) > 0.0 or not _NO_DEPTH.issuperset(mode):
        raise HoleCycleError(Wording("PLN620", "cycle_fedto_0", mode=tuple(mode)))
    return 0.0  # from RAPTO down to the point itself
