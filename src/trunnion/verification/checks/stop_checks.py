"""Dwells and stops of a program against DELAY, STOP and OPSTOP in the CL files."""

from bisect import bisect_left, bisect_right
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import zip_longest
from typing import Final

import numpy as np

from trunnion.arrays import Flags
from trunnion.messages import Wording
from trunnion.model.run import Run, RunEvent
from trunnion.model.toolpath import Coolant, Dwell, Kind, Stop
from trunnion.records import dataclass
from trunnion.verification.checks.restated_modes import RestatedModes
from trunnion.verification.checks.rotary_moves_at_part import stands_away
from trunnion.verification.checks.skip_faults import skip_faults
from trunnion.verification.context import ComparedContext, check_from_places
from trunnion.verification.expected.skipped import skipped_stretches
from trunnion.verification.matching.hole_matching import match_holes
from trunnion.verification.results import Check, Place
from trunnion.wording import format_duration

_KINDS: Final = ("dwell", "stop", "optional_stop")

#: Dwells are the same if they differ by no more than the shortest that controls print, seconds.
_TOLERANCE: Final = 1.01e-3


#: The M word that changes the workpiece, unless a definition declares another meaning.
_CHANGES_PART: Final = "M60"

#: Words that open the door, or what holds the part, as readers note them.
_OPENS: Final = frozenset({"door_opens", "clamp_opens"})


@dataclass(frozen=True, slots=True, eq=False)
class _FoundStop:
    """A dwell or stop of the program, and its place among the events of the run."""

    place: int
    event: RunEvent


@dataclass(frozen=True, slots=True)
class _ExpectedStop:
    """A DELAY, STOP or OPSTOP before CL row ``row``; ``amount`` in seconds, or spindle revolutions if negative.

    coolant  what the CL file says about coolant in the next cut
    """

    row: int
    kind: str
    amount: float
    file: str
    line: int
    coolant: str

    @property
    def said(self) -> Wording:
        return _words(self.kind, self.amount)


def check_stops(context: ComparedContext) -> Check:
    """Each dwell and stop is between its two points, and there are no others within an operation.

    Between operations, where tools are changed, a program may have stops of its own, away from the part. Dwells in
    holes belong to the check of holes.
    """
    expected = _expected_stops(context)
    found: defaultdict[int, list[_FoundStop]] = defaultdict(list)
    for stop in _stops_outside_holes(context):
        found[context.matching.nc.count_before(stop.event.before_row)].append(stop)
    restarts = RestatedModes(context.run)
    places: list[Place] = [*_changes_in_holes(context), *_unknown_words_at_work(context)]
    own: list[_FoundStop] = []
    for pair in sorted(expected.keys() | found.keys()):
        places += _compare(context, restarts, pair, expected[pair], found[pair])
        if not _is_within_operation(context, pair):
            asked_for = {stop.place for stop in _asked_for(context.run, found[pair], expected[pair])}
            own += [stop for stop in found[pair] if stop.place not in asked_for]
    count = {kind: sum(each.kind == kind for at_pair in expected.values() for each in at_pair) for kind in _KINDS}
    count["opskip"] = sum(len(list(skipped_stretches(each.operation))) for each in context.expected.sections)
    asked = tuple(Wording("stops", kind, count=number) for kind, number in count.items() if number)
    good = Wording("stops", "stops", stops=asked) if asked else Wording("stops", "none_asked")
    places += _nothing_said_again(context, restarts, own)
    if parts := tuple(_own_stops(context.run, own)):
        good = Wording("stops", "with_own", asked=good, own=parts)
    places += _waits_at_part(context)
    places += _missing_between(context, found)
    places += skip_faults(context)
    return check_from_places("stops", places, good)


def _missing_between(context: ComparedContext, found: Mapping[int, list[_FoundStop]]) -> Iterator[Place]:
    """Yield the operations before which no stop stands, where the settings ask for one between all of them."""
    sections = context.expected.sections if context.settings.stop_between else ()
    wanted: defaultdict[int, int] = defaultdict(int)
    for section in sections[1:]:
        pair = context.matching.cl.count_before(section.first)
        wanted[pair] += 1
        if sum(stop.event.kind != "dwell" for stop in found.get(pair, ())) < wanted[pair]:
            yield context.place_of_missing(section.first, Wording("stops", "stop_between"))


def _nothing_said_again(context: ComparedContext, restarts: RestatedModes, stops: list[_FoundStop]) -> Iterator[Place]:
    """Yield stops of the program's own behind which spindle or coolant, on before, is not switched on again to cut."""
    for stop in stops:
        if stop.event.kind == "dwell":
            continue
        fault = restarts.unsaid(stop.place, stop.event.before_row, "ON")
        if fault is not None:
            yield context.place_of_event(stop.event, 0.0, fault)


def _own_stops(run: Run, stops: list[_FoundStop]) -> Iterator[Wording]:
    """Yield how many stops and dwells of its own the program has between operations, and how long the dwells take."""
    for kind in _KINDS:
        of_kind = [stop.event for stop in stops if stop.event.kind == kind]
        seconds = sum(_seconds(_amount(event), _rpm(run, event)) for event in of_kind) if kind == "dwell" else 0.0
        if seconds:
            yield Wording("stops", "dwells_of", count=len(of_kind), time=format_duration(seconds))
        elif of_kind:
            yield Wording("stops", kind, count=len(of_kind))


def _expected_stops(context: ComparedContext) -> defaultdict[int, list[_ExpectedStop]]:
    """By the pair before which they stand."""
    expected: defaultdict[int, list[_ExpectedStop]] = defaultdict(list)
    for section in context.expected.sections:
        coolants = [event for event in section.operation.events if isinstance(event, Coolant)]
        changes = [event.row for event in coolants]
        for event in section.operation.events:
            if not isinstance(event, Dwell | Stop):
                continue
            row, amount = section.first + event.row, 0.0
            if isinstance(event, Dwell):
                kind, amount = "dwell", -event.amount if event.revolutions else event.amount
            else:
                kind = "optional_stop" if event.optional else "stop"
            before = bisect_right(changes, event.row)
            coolant = coolants[before - 1].kind if before else "OFF"
            stop = _ExpectedStop(row, kind, amount, section.file, event.line, coolant)
            expected[context.matching.cl.count_before(row)].append(stop)
    return expected


def _stops_outside_holes(context: ComparedContext) -> list[_FoundStop]:
    """Dwells of the program itself, without those that belong to a hole, and all its stops: a hole may have none."""
    stops = [_FoundStop(place, event) for place, event in enumerate(context.run.events) if event.kind in _KINDS]
    inside = _in_holes(context, [stop.event for stop in stops]).tolist()
    return [stop for stop, in_hole in zip(stops, inside, strict=True) if not in_hole or stop.event.kind != "dwell"]


def _changes_in_holes(context: ComparedContext) -> Iterator[Place]:
    """Yield the tool changes while the tool is in a hole."""
    changes = [event for event in context.run.events if event.kind == "tool_change"]
    for event, in_hole in zip(changes, _in_holes(context, changes).tolist(), strict=True):
        if in_hole:
            yield context.place_of_event(event, 0.0, Wording("stops", "change_in_hole"))


def _waits_at_part(context: ComparedContext) -> Iterator[Place]:
    """Yield words at which the machine waits for a signal, stops with an alarm, or opens its door or what holds the
    part, while the tool is at the part.
    """
    run, matching = context.run, context.matching
    noted = {(each.file, each.line): each.wording.variant for each in run.diagnostics if each.code == "NC226"}
    away = None
    for place, event in enumerate(run.events if noted else ()):
        variant = noted.get((run.files[event.file], event.line))
        if event.kind != "unasked" or variant is None:
            continue
        pair = matching.nc.count_before(event.before_row)
        away = away or stands_away(context)
        within = _is_within_operation(context, pair)
        if (within or not away(place)) and not _follows_insert(context, min(pair, len(matching.cl) - 1)):
            said = "opens_at_part" if variant in _OPENS else "waits_at_part"
            yield context.place_of_event(event, 0.0, Wording("stops", said, word=str(event.value)))


def _unknown_words_at_work(context: ComparedContext) -> Iterator[Place]:
    """Yield words of which nobody knows what they do, while the tool is in a hole; M60 within operations too.

    ISO 6983-1 has M60 for a change of the workpiece, and no cut goes on behind one. What the definition declares is
    known, and what an INSERT asks for is meant.
    """
    run, matching = context.run, context.matching
    unknown = {str(each.wording.parameter("word")) for each in run.diagnostics if each.code == "NC225"}
    events = [each for each in run.events if each.kind in ("m", "h") and _builders_word(each) in unknown]
    inside = _in_holes(context, events, behind=1).tolist()
    for event, in_hole in zip(events, inside, strict=True):
        pair, word = matching.nc.count_before(event.before_row), _builders_word(event)
        changes_part = word == _CHANGES_PART and _is_within_operation(context, pair)
        if (in_hole or changes_part) and not _follows_insert(context, min(pair, len(matching.cl) - 1)):
            variant = "changes_part" if changes_part else "unknown_in_hole"
            yield context.place_of_event(event, 0.0, Wording("stops", variant, word=word))


def _builders_word(event: RunEvent) -> str:
    return f"{event.kind.upper()}{event.value:g}" if isinstance(event.value, float) else ""


def _in_holes(context: ComparedContext, events: Sequence[RunEvent], behind: int = 0) -> Flags:
    """Which events happen while the tool is in a hole, (k,); ``behind`` 1: but for those before it drills."""
    holes = match_holes(context.run, context.expected) if events else []
    if not holes:
        return np.zeros(len(events), np.bool_)
    first, end = np.array([hole.first for hole in holes]), np.array([hole.end for hole in holes])
    rows = np.array([event.before_row for event in events]) - behind
    hole = np.searchsorted(first, rows) - 1  # the last one that begins before the row
    return np.asarray((hole >= 0) & (rows + behind < end[hole]))


def _compare(
    context: ComparedContext, restarts: RestatedModes, pair: int, expected: list[_ExpectedStop], stops: list[_FoundStop]
) -> Iterator[Place]:
    """Yield what is wrong before one pair."""
    run = context.run
    if not _is_within_operation(context, pair):
        every, stops = stops, _asked_for(run, stops, expected)
        asked_for = {stop.place for stop in stops}
        yield from _at_the_part(context, [stop for stop in every if stop.place not in asked_for])
    for wanted, stop in zip_longest(expected, stops):
        if wanted is None:
            if not _follows_insert(context, pair):
                said = Wording("stops", "not_asked", stop=_words(stop.event.kind, _amount(stop.event)))
                yield context.place_of_event(stop.event, 0.0, said)
        elif stop is None:
            row = min(wanted.row, len(context.expected) - 1)
            place = context.place_of_missing(row, Wording("stops", "missing", stop=wanted.said))
            yield replace(place, cl_file=wanted.file, cl_line=wanted.line)
        else:
            fault = _fault(run, restarts, wanted, stop)
            if fault is not None:
                place = context.place_of_event(stop.event, 0.0, fault)
                yield replace(place, cl_file=wanted.file, cl_line=wanted.line)


def _at_the_part(context: ComparedContext, stops: list[_FoundStop]) -> Iterator[Place]:
    """Yield stops of the program's own while the tool is at the part, where nobody expects it to wait.

    A dwell lets the tool rub where the motion before it is a cut.
    """
    run, away = context.run, None
    for stop in stops:
        row = stop.event.before_row - 1
        if stop.event.kind == "dwell" and (row < 0 or run.kind[row] == Kind.RAPID or not run.spindle[row]):
            continue
        away = away or stands_away(context)
        if not away(stop.place):
            said = Wording("stops", "at_part", stop=_words(stop.event.kind, _amount(stop.event)))
            yield context.place_of_event(stop.event, 0.0, said)


def _asked_for(run: Run, stops: list[_FoundStop], expected: list[_ExpectedStop]) -> list[_FoundStop]:
    """Return the stops that are the same as one that the CL file wants."""
    seconds = {stop.place: _seconds(_amount(stop.event), _rpm(run, stop.event)) for stop in stops}
    wanted: dict[tuple[str, float], list[float]] = {}
    for stop in stops:
        rpm = _rpm(run, stop.event)
        if (stop.event.kind, rpm) not in wanted:
            same_kind = (_seconds(each.amount, rpm) for each in expected if each.kind == stop.event.kind)
            wanted[stop.event.kind, rpm] = sorted(same_kind)
    return [stop for stop in stops if _is_in(wanted[stop.event.kind, _rpm(run, stop.event)], seconds[stop.place])]


def _is_in(values: list[float], value: float) -> bool:
    """Whether one of increasing values is the same."""
    k = bisect_left(values, value - _TOLERANCE)
    return k < len(values) and values[k] <= value + _TOLERANCE


def _fault(run: Run, restarts: RestatedModes, wanted: _ExpectedStop, stop: _FoundStop) -> Wording | None:
    """Return what is wrong with a stop or dwell in the place of one that the CL file wants; None if it is right."""
    event = stop.event
    if event.kind == "stop" and restarts.spindle_turns(stop.place):
        return Wording("stops", "while_turning")
    if not _same(run, event, wanted):
        return Wording("stops", "other", stop=_words(event.kind, _amount(event)), wanted=wanted.said)
    return None if event.kind == "dwell" else restarts.unsaid(stop.place, event.before_row, wanted.coolant)


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
    rpm = _rpm(run, event)
    return abs(_seconds(_amount(event), rpm) - _seconds(wanted.amount, rpm)) <= _TOLERANCE


def _rpm(run: Run, event: RunEvent) -> float:
    return float(run.state.rpm[min(event.before_row, len(run) - 1)]) if len(run) else 0.0


def _seconds(amount: float, rpm: float) -> float:
    return amount if amount >= 0.0 else -60.0 * amount / max(rpm, 1e-9)


def _words(kind: str, amount: float) -> Wording:
    if kind == "dwell":
        return Wording("stops", "of_seconds" if amount >= 0.0 else "of_turns", amount=abs(amount))
    return Wording("stops", "a_stop" if kind == "stop" else "an_optional_stop")
