"""Dwells and stops of a program against DELAY, STOP and OPSTOP in the CL files."""

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import zip_longest
from typing import Final

from trunnion.model.run import Run, RunEvent
from trunnion.model.toolpath import Dwell, Stop
from trunnion.verification.context import MAX_PLACES, ComparedContext, check_from_places
from trunnion.verification.matching.hole_matching import match_holes
from trunnion.verification.results import Check, Place

_NAMES: Final = {"dwell": "dwells", "stop": "stops", "optional_stop": "optional stops"}

#: Half of the last digit of dwells, seconds.
_TOLERANCE: Final = 5.1e-4


@dataclass(frozen=True, slots=True)
class _ExpectedStop:
    """A DELAY, STOP or OPSTOP before CL row ``row``; ``amount`` in seconds, or spindle revolutions if negative."""

    row: int
    kind: str
    amount: float
    file: str
    line: int

    def __str__(self) -> str:
        return _words(self.kind, self.amount)


def check_stops(context: ComparedContext) -> Check:
    """Each dwell and stop is between its two points, and there are no others within an operation.

    Between operations, where tools are changed, a program may have stops of its own. Dwells in holes belong to the
    check of holes.
    """
    expected = _expected_stops(context)
    found: defaultdict[int, list[RunEvent]] = defaultdict(list)
    for event in _events_outside_holes(context):
        found[context.matching.nc.count_before(event.before_row)].append(event)
    places: list[Place] = []
    for pair in sorted(expected.keys() | found.keys()):
        places += _compare(context, pair, expected[pair], found[pair])
    count = {kind: sum(each.kind == kind for at_pair in expected.values() for each in at_pair) for kind in _NAMES}
    good = ", ".join(f"{count[kind]} {name}" for kind, name in _NAMES.items() if count[kind])
    title = "stops and dwells as the CL file says"
    return check_from_places("stops", title, places[:MAX_PLACES], good or "the CL file has none", len(places) or None)


def _expected_stops(context: ComparedContext) -> defaultdict[int, list[_ExpectedStop]]:
    """By the pair before which they stand."""
    expected: defaultdict[int, list[_ExpectedStop]] = defaultdict(list)
    for section in context.expected.sections:
        for event in section.operation.events:
            if not isinstance(event, Dwell | Stop):
                continue
            row, amount = section.first + event.row, 0.0
            if isinstance(event, Dwell):
                kind, amount = "dwell", -event.amount if event.revolutions else event.amount
            else:
                kind = "optional_stop" if event.optional else "stop"
            stop = _ExpectedStop(row, kind, amount, section.file, event.line)
            expected[context.matching.cl.count_before(row)].append(stop)
    return expected


def _events_outside_holes(context: ComparedContext) -> list[RunEvent]:
    """Dwells and stops of the program itself, without those that belong to a hole."""
    events = [event for event in context.run.events if event.kind in _NAMES]
    if not events:
        return []
    holes = match_holes(context.run, context.expected)
    return [event for event in events if not any(hole.first < event.before_row < hole.end for hole in holes)]


def _compare(
    context: ComparedContext, pair: int, expected: list[_ExpectedStop], events: list[RunEvent]
) -> Iterator[Place]:
    """What is wrong before one pair."""
    run = context.run
    if not _is_within_operation(context, pair):
        events = [event for event in events if any(_same(run, event, each) for each in expected)]
    for wanted, event in zip_longest(expected, events):
        if wanted is None:
            if not _follows_insert(context, pair):
                text = f"{_words(event.kind, _amount(event))}, which the CL file does not ask for"
                yield context.place_of_event(event, 0.0, text)
        elif event is None:
            row = min(wanted.row, len(context.expected) - 1)
            place = context.place_of_missing(row, f"the CL file wants {wanted} before this")
            yield replace(place, cl_file=wanted.file, cl_line=wanted.line)
        elif event.kind == "stop" and _spindle_turns(run, event):
            text = "stops while the spindle turns: at a STOP of the CL file it stands (M5 before it)"
            yield replace(context.place_of_event(event, 0.0, text), cl_file=wanted.file, cl_line=wanted.line)
        elif not _same(run, event, wanted):
            text = f"{_words(event.kind, _amount(event))}; the CL file wants {wanted}"
            yield replace(context.place_of_event(event, 0.0, text), cl_file=wanted.file, cl_line=wanted.line)


def _is_within_operation(context: ComparedContext, pair: int) -> bool:
    """Whether a pair and the one before it belong to one operation."""
    cl, expected = context.matching.cl, context.expected
    return 0 < pair < len(cl) and expected.section_at(cl[pair - 1]) is expected.section_at(cl[pair])


def _follows_insert(context: ComparedContext, pair: int) -> bool:
    """Whether the CL file has an INSERT before the point of a pair."""
    cl = context.matching.cl
    first = cl[pair - 1] + 1 if pair else 0
    return any(row in context.expected.insert_counts for row in range(first, cl[pair] + 1))


def _amount(event: RunEvent) -> float:
    return event.value if isinstance(event.value, float) else 0.0


def _same(run: Run, event: RunEvent, wanted: _ExpectedStop) -> bool:
    if event.kind != wanted.kind:
        return False
    rpm = float(run.state.rpm[min(event.before_row, len(run) - 1)]) if len(run) else 0.0
    return abs(_seconds(_amount(event), rpm) - _seconds(wanted.amount, rpm)) <= _TOLERANCE


def _spindle_turns(run: Run, stop: RunEvent) -> bool:
    """Whether the spindle turns at a stop: what the last word for it before the stop said."""
    turns = False
    for event in run.events:
        if event is stop:
            return turns
        if event.kind == "spindle":
            turns = event.value in ("clockwise", "counter-clockwise")
    return turns


def _seconds(amount: float, rpm: float) -> float:
    return amount if amount >= 0.0 else -60.0 * amount / max(rpm, 1e-9)


def _words(kind: str, amount: float) -> str:
    if kind == "dwell":
        return f"a dwell of {amount:g} s" if amount >= 0.0 else f"a dwell of {-amount:g} turns"
    return "a stop" if kind == "stop" else "an optional stop"
