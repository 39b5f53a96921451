"""Where a program waits or stops, against the DELAY, STOP and OPSTOP of the CL files."""

from collections import defaultdict
from dataclasses import dataclass, replace
from itertools import zip_longest
from typing import Final

from trunnion.model.run import Run, RunEvent
from trunnion.model.toolpath import Dwell, Stop
from trunnion.verification.context import MAX_PLACES, Context, check_from_places
from trunnion.verification.matching.hole_matching import match_holes
from trunnion.verification.results import Check, Place

_KINDS: Final = ("dwell", "stop", "optional_stop")

#: Half of the last digit of dwells, seconds.
_SECONDS: Final = 5.1e-4


@dataclass(frozen=True, slots=True)
class _Asked:
    """A DELAY, STOP or OPSTOP before CL row ``row``; ``amount`` in seconds, or spindle turns if negative."""

    row: int
    kind: str
    amount: float
    file: str
    line: int

    def __str__(self) -> str:
        return _words(self.kind, self.amount)


def stops(context: Context) -> Check:
    """Each dwell and stop between the two points between which it stands, and no others within an operation.

    Between operations, where tools are changed, a program may have stops of its own. Dwells at the bottom of holes are
    the business of the holes.
    """
    expected, matching, run = context.expected, context.matching, context.run
    assert expected is not None
    assert matching is not None
    asked: defaultdict[int, list[_Asked]] = defaultdict(list)
    for section in expected.sections:
        for event in section.operation.events:
            if isinstance(event, Dwell | Stop):
                row = section.first + event.row
                asked[matching.cl.before(row)].append(_asked(event, row, section.file))
    said: defaultdict[int, list[RunEvent]] = defaultdict(list)
    for happening in _outside_holes(context):
        said[matching.nc.before(happening.before_row)].append(happening)
    places: list[Place] = []
    for k in sorted(asked.keys() | said.keys()):
        here = said[k] if _within(context, k) else [event for event in said[k] if _is_asked(run, event, asked[k])]
        for want, has in zip_longest(asked[k], here):
            if want is None:
                if not _inserted(context, k):
                    text = f"{_words(has.kind, _amount(has))}, which the CL file does not ask for"
                    places.append(context.at(has, 0.0, text))
            elif has is None:
                place = context.place_of_missing(
                    min(want.row, len(expected) - 1), f"the CL file wants {want} before this"
                )
                places.append(replace(place, cl_file=want.file, cl_line=want.line))
            elif not _same(run, has, want):
                place = context.at(has, 0.0, f"{_words(has.kind, _amount(has))}; the CL file wants {want}")
                places.append(replace(place, cl_file=want.file, cl_line=want.line))
    count = {kind: sum(one.kind == kind for each in asked.values() for one in each) for kind in _KINDS}
    names = {"dwell": "dwells", "stop": "stops", "optional_stop": "optional stops"}
    good = ", ".join(f"{count[kind]} {names[kind]}" for kind in _KINDS if count[kind]) or "the CL file has none"
    return check_from_places(
        "stops", "stops and dwells as the CL file says", places[:MAX_PLACES], good, len(places) or None
    )


def _asked(event: Dwell | Stop, row: int, file: str) -> _Asked:
    if isinstance(event, Dwell):
        return _Asked(row, "dwell", -event.amount if event.revolutions else event.amount, file, event.line)
    return _Asked(row, "optional_stop" if event.optional else "stop", 0.0, file, event.line)


def _outside_holes(context: Context) -> list[RunEvent]:
    """What the program itself says of dwells and stops, without what is done in a hole."""
    events = [event for event in context.run.events if event.kind in _KINDS]
    if not events:
        return []
    made = match_holes(context.run, context.expected)
    return [event for event in events if not any(hole.first < event.before_row < hole.end for hole in made)]


def _within(context: Context, k: int) -> bool:
    """Whether pair ``k`` and the one before it belong to one operation."""
    assert context.expected is not None
    assert context.matching is not None
    if not 0 < k < len(context.matching.cl):
        return False
    return context.expected.section_at(context.matching.cl[k - 1]) is context.expected.section_at(
        context.matching.cl[k]
    )


def _inserted(context: Context, k: int) -> bool:
    """Whether the CL file puts a text of its own (INSERT) before the point of pair ``k``."""
    assert context.expected is not None
    assert context.matching is not None
    first = context.matching.cl[k - 1] + 1 if k else 0
    return any(row in context.expected.inserts for row in range(first, context.matching.cl[k] + 1))


def _is_asked(run: Run, event: RunEvent, asked: list[_Asked]) -> bool:
    return any(_same(run, event, want) for want in asked)


def _amount(event: RunEvent) -> float:
    return event.value if isinstance(event.value, float) else 0.0


def _same(run: Run, event: RunEvent, want: _Asked) -> bool:
    if event.kind != want.kind:
        return False
    rpm = float(run.state.rpm[min(event.before_row, len(run) - 1)]) if len(run) else 0.0
    return abs(_second_angle_ranges(_amount(event), rpm) - _second_angle_ranges(want.amount, rpm)) <= _SECONDS


def _second_angle_ranges(amount: float, rpm: float) -> float:
    return amount if amount >= 0.0 else -60.0 * amount / max(rpm, 1e-9)


def _words(kind: str, amount: float) -> str:
    if kind == "dwell":
        return f"a dwell of {amount:g} s" if amount >= 0.0 else f"a dwell of {-amount:g} turns"
    return "a stop" if kind == "stop" else "an optional stop"
